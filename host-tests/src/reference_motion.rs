//! The controller's motion written again from `docs/protocol.md` and `docs/numerics.md`, in integers of 128 bits and the
//! f64 reference of tables, without a bit of the crates that are judged but the commands' own type.
//!
//! What it is made of comes out of the bundle as lists of numbers.

use octruss::bundle::Bundle;
use octruss_firmware::controller::Parts;
use octruss_firmware::link::{Command, Telemetry};

use crate::qemu::demo::{Failure, reference_table, rest_model};
use crate::reference::{Table, apply_displacement};
use crate::reference_control::{InverseTable, Memory, VolumeWanted};
use crate::reference_volume;

/// What the amplitudes follow.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Follow {
    Goals,
    Targets,
    Nothing,
}

/// The controller.
pub struct ReferenceMotion {
    solver: InverseTable,
    coefficients: Option<Vec<i32>>,
    displacements: Vec<i32>,
    rest_cage: Vec<[i32; 3]>,
    rest_model: Vec<[i32; 3]>,
    rows: Table,
    effector_rows: Vec<u32>,
    memory: Memory,
    follow: Follow,
    goals: Vec<[i32; 3]>,
    targets: Vec<i32>,
    silence_ticks: u32,
    quiet: u32,
    outputs: Vec<u16>,
}

/// What a tick must come to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expected {
    /// Held, silent, has a volume, clamped, and from bit 8 what was given up.
    pub flags: u32,
    /// CRC-32 of the pose.
    pub pose: u32,
    /// CRC-32 of the deformed model.
    pub model: u32,
    /// The volume.
    pub volume: i64,
    /// The greatest distance of a coordinate from its goal.
    pub effector_error: u32,
    /// What the outputs hold: the set-points of the tick before.
    pub outputs: Vec<u16>,
}

impl Expected {
    /// What telemetry says of the same; channels without an actuator are zero.
    pub fn of(record: &Telemetry) -> Self {
        Expected {
            flags: record.flags,
            pose: record.pose_hash,
            model: record.skin_hash,
            volume: record.volume,
            effector_error: record.effector_error,
            outputs: record.outputs.to_vec(),
        }
    }
}

/// CRC-32/ISO-HDLC of coordinates, least significant byte first, from the polynomial's definition.
fn checksum(points: &[[i32; 3]]) -> u32 {
    let mut register = u32::MAX;
    for byte in points
        .as_flattened()
        .iter()
        .flat_map(|own| own.to_le_bytes())
    {
        register ^= u32::from(byte);
        for _ in 0..8 {
            let carry = register & 1;
            register >>= 1;
            if carry == 1 {
                register ^= 0xedb8_8320;
            }
        }
    }
    !register
}

impl ReferenceMotion {
    /// Takes the numbers out of a bundle.
    ///
    /// # Errors
    /// If it holds no controller.
    pub fn of(bundle: &Bundle<'_>) -> Result<Self, Failure> {
        let parts = Parts::open(bundle)?;
        let (own, actuation) = (*parts.solver.parts(), *parts.actuation.parts());
        let solver = InverseTable {
            actuators: own.lower.len(),
            hessian: own.hessian.to_vec(),
            gains: own.gains.to_vec(),
            rest: own.rest.to_vec(),
            lower: own.lower.to_vec(),
            upper: own.upper.to_vec(),
            rates: own.rates.to_vec(),
            difference_shift: own.difference_shift,
            gain_shift: own.gain_shift,
        };
        let rest_cage = bundle.rest_cage().to_vec();
        Ok(ReferenceMotion {
            memory: solver.memory(),
            coefficients: parts.volume.map(|own| own.coefficients().to_vec()),
            displacements: actuation.displacements.to_vec(),
            rest_model: rest_model(&parts.table, &rest_cage)?,
            rest_cage,
            rows: reference_table(&parts.table)?,
            effector_rows: actuation.effector_rows.to_vec(),
            follow: Follow::Goals,
            goals: solver.rest.clone(),
            targets: vec![0; solver.actuators],
            silence_ticks: 0,
            quiet: 0,
            outputs: vec![0; 16],
            solver,
        })
    }

    /// A command takes effect.
    pub fn take(&mut self, command: &Command) {
        self.quiet = 0;
        match command {
            Command::Goals(goals) => {
                self.follow = Follow::Goals;
                for goal in goals {
                    self.goals[usize::from(goal.effector)] = goal.place;
                }
            }
            Command::Actuators(targets) => {
                if self.follow != Follow::Targets {
                    self.targets = self.amplitudes();
                }
                self.follow = Follow::Targets;
                for target in targets {
                    self.targets[usize::from(target.channel)] = target.amplitude;
                }
            }
            Command::Hold => self.follow = Follow::Nothing,
            Command::Query => {}
            Command::Watch { silence_ticks, .. } => self.silence_ticks = *silence_ticks,
            Command::Restart => {
                self.memory = self.solver.memory();
                self.follow = Follow::Goals;
                self.goals = self.solver.rest.clone();
                (self.silence_ticks, self.quiet) = (0, 0);
            }
        }
    }

    fn amplitudes(&self) -> Vec<i32> {
        // The solver keeps them within 32 bits.
        self.memory
            .amplitudes
            .iter()
            .map(|own| *own as i32)
            .collect()
    }

    fn volume(&self, amplitudes: &[i32]) -> i64 {
        let coefficients = self.coefficients.as_ref();
        coefficients.map_or(0, |own| {
            reference_volume::modes(amplitudes.len(), own, amplitudes).0
        })
    }

    /// One tick.
    ///
    /// # Errors
    /// If the table does not fit the cage.
    pub fn advance(&mut self) -> Result<Expected, Failure> {
        let is_silent = self.silence_ticks > 0 && self.quiet >= self.silence_ticks;
        self.quiet += 1;
        let is_held = is_silent || self.follow == Follow::Nothing;
        let mut gave_up = 0;
        if !is_held && self.follow == Follow::Goals {
            let rest = self.volume(&vec![0; self.solver.actuators]);
            let wanted = self.coefficients.as_ref().map(|own| VolumeWanted {
                coefficients: own.clone(),
                low: rest,
                high: rest,
            });
            let said = self
                .solver
                .tick(&self.goals, wanted.as_ref(), &mut self.memory);
            gave_up = said.gave_up;
        } else if !is_held {
            self.approach();
        }
        let amplitudes = self.amplitudes();
        let (pose, clamped) = self.pose(&amplitudes);
        let deformed = apply_displacement(&self.rows, &pose, &self.rest_cage, &self.rest_model)?;
        let is_clamped = clamped || deformed.saturated != 0;
        let flags = [
            (1, is_held),
            (2, is_silent),
            (4, self.coefficients.is_some()),
            (8, is_clamped),
        ];
        let flags = flags.iter().filter(|(_, is)| *is).map(|(bit, _)| bit);
        let rows = self.effector_rows.iter().zip(&self.goals);
        let distances = rows.flat_map(|(row, goal)| {
            let place = deformed.points[*row as usize];
            [0, 1, 2].map(|axis| place[axis].abs_diff(goal[axis]))
        });
        let outputs = self.set_points(&amplitudes);
        Ok(Expected {
            flags: flags.sum::<u32>() + 256 * gave_up,
            pose: checksum(&pose),
            model: checksum(&deformed.points),
            volume: self.volume(&amplitudes),
            effector_error: distances.max().unwrap_or(0),
            outputs: std::mem::replace(&mut self.outputs, outputs),
        })
    }

    /// Amplitudes go to their targets by at most a rate, within bounds.
    fn approach(&mut self) {
        let now = self.amplitudes();
        let mut next = Vec::new();
        for (place, own) in now.iter().enumerate() {
            let solver = &self.solver;
            let target = self.targets[place]
                .max(solver.lower[place])
                .min(solver.upper[place]);
            let way = i64::from(target) - i64::from(*own);
            let rate = i64::from(solver.rates[place]);
            next.push((i64::from(*own) + way.max(-rate).min(rate)) as i32);
        }
        self.memory.start_from(&next);
    }

    /// `rest + floor(sum of amplitude * displacement / 2^30 + 1/2)`, clamped.
    fn pose(&self, amplitudes: &[i32]) -> (Vec<[i32; 3]>, bool) {
        let mut clamped = false;
        let mut pose = self.rest_cage.clone();
        let ways = self.displacements.chunks(amplitudes.len());
        for (own, ways) in pose.as_flattened_mut().iter_mut().zip(ways) {
            let products = ways.iter().zip(amplitudes);
            let sum: i128 = products
                .map(|(way, part)| i128::from(*way) * i128::from(*part))
                .sum();
            let exact = i128::from(*own) + (2 * sum + (1 << 30)).div_euclid(1 << 31);
            let kept = exact.clamp(i128::from(i32::MIN), i128::from(i32::MAX));
            clamped |= kept != exact;
            *own = kept as i32;
        }
        (pose, clamped)
    }

    /// `floor(4095 * part of the range + 1/2)`.
    fn set_points(&self, amplitudes: &[i32]) -> Vec<u16> {
        let mut set_points = vec![0; 16];
        for (place, own) in amplitudes.iter().enumerate() {
            let [lower, upper] =
                [&self.solver.lower, &self.solver.upper].map(|list| i128::from(list[place]));
            let own = i128::from(*own).clamp(lower, upper);
            if upper > lower {
                let exact = 2 * 4095 * (own - lower) + (upper - lower);
                set_points[place] = exact.div_euclid(2 * (upper - lower)) as u16;
            }
        }
        set_points
    }
}
