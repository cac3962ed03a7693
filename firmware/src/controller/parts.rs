//! What a controller takes from a bundle.

use octruss::bundle::{Bundle, BundleError};
use octruss::control::actuation::Actuation;
use octruss::control::inverse::{Inverse, MOST_ACTUATORS};
use octruss::deform::Table;
use octruss::enclosed::VolumeModes;

/// The parts of a bundle that a controller runs on, proved sound.
#[derive(Clone, Copy, Debug)]
pub struct Parts<'a> {
    /// Deforms the model.
    pub table: Table<'a, i32>,
    /// Brings effectors to their goals.
    pub solver: Inverse<'a>,
    /// Poses the control points, and says where the effectors are.
    pub actuation: Actuation<'a>,
    /// The volume that is held; `None` if the bundle has none.
    pub volume: Option<VolumeModes<'a>>,
}

/// Why a bundle is not enough for a controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(target_os = "none", derive(defmt::Format))]
pub enum OpenError {
    /// A part of the bundle is not sound.
    Bundle(BundleError),
    /// The bundle has no solver for goals, or no actuators: bake it with `--modes`, `--actuators` and `--effectors`.
    NoSolver,
    /// Solver, actuators and volume are not for the same modes, or not for the same effectors.
    Mismatch,
}

impl core::fmt::Display for OpenError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            OpenError::Bundle(error) => core::fmt::Display::fmt(error, out),
            OpenError::NoSolver => out.write_str(
                "the bundle has no solver for goals; bake it with --modes, --actuators and --effectors",
            ),
            OpenError::Mismatch => out.write_str(
                "solver, actuators and volume of the bundle are not of the same modes and effectors; bake it anew",
            ),
        }
    }
}

impl core::error::Error for OpenError {}

impl<'a> Parts<'a> {
    /// The volume at rest, that is held; 0 if the bundle has none.
    #[must_use]
    pub fn rest_volume(&self) -> i64 {
        self.volume_at(&[0; MOST_ACTUATORS])
    }

    /// The volume at amplitudes; 0 if the bundle has none.
    pub(super) fn volume_at(&self, amplitudes: &[i32; MOST_ACTUATORS]) -> i64 {
        // A solver has as many modes as the volume, and at most as many as there are amplitudes: `open` saw to it.
        let volume = self.volume.and_then(|volume| {
            let amplitudes = amplitudes.get(..volume.modes())?;
            volume.volume(amplitudes).ok()
        });
        volume.unwrap_or(0)
    }

    /// Takes the parts out of a bundle.
    ///
    /// # Errors
    ///
    /// [`OpenError`].
    pub fn open(bundle: &Bundle<'a>) -> Result<Self, OpenError> {
        let table = bundle.table::<i32>().map_err(OpenError::Bundle)?;
        let solver = bundle.inverse::<i32>().map_err(OpenError::Bundle)?;
        let actuation = bundle.actuation::<i32>().map_err(OpenError::Bundle)?;
        let volume = bundle.volume_modes::<i32>(0).map_err(OpenError::Bundle)?;
        let (Some(solver), Some(actuation)) = (solver, actuation) else {
            return Err(OpenError::NoSolver);
        };
        let fits = solver.actuators() == actuation.actuators()
            && solver.effectors() == actuation.effector_rows().len()
            && volume.is_none_or(|volume| volume.modes() == solver.actuators());
        if !fits {
            return Err(OpenError::Mismatch);
        }
        Ok(Parts {
            table,
            solver,
            actuation,
            volume,
        })
    }
}
