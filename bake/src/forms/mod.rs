//! The exact volume enclosed by a subdivision surface, from its control points alone.
//!
//! After Hakenberg, Reif, Schaefer and Warren, *Volume Enclosed by Subdivision Surfaces* (2014).
//! The limit surface falls into *facets*, each determined by a few control points. The volume
//! of the cone from the origin over a facet is an alternating trilinear form of them, a sum of
//! determinants `c_ijk det(p_i, p_j, p_k)`; the cones of a closed surface add up to the volume
//! that it encloses. The coefficients depend on the scheme and on the facet's valence only.
//!
//! * [`exact`]: the numbers, double precision or exact ones of Q(sqrt d).
//! * [`mesh`]: the connectivity of closed surfaces.
//! * [`scheme`]: refinement, facets and the order of their control points.
//! * [`form`], [`local`], [`make`], [`cache`]: forms, how they are found, and where they are kept.
//! * [`neighbourhood`]: forms of schemes whose facets lie in surroundings of many kinds.
//! * [`surface`], [`moments`], [`target`]: the volume of a whole mesh and its gradient, centroid and
//!   inertia, and the nearest mesh that encloses a given volume.
//! * [`control`], [`device`]: the volume as one form over the control points, and in integers.
//! * [`modes`], [`centroid`]: volume and centroid as polynomials of a few modes; [`region`]: of the
//!   cells with a label.
//! * [`polyhedra`]: surfaces without an exact form, by extrapolation.
//! * [`solid`], [`portrait`]: the surfaces of files, and their picture.

pub mod cache;
pub mod centroid;
pub mod control;
pub mod device;
pub mod error;
pub mod exact;
pub mod form;
pub mod local;
pub mod make;
pub mod mesh;
pub mod modes;
pub mod moments;
pub mod neighbourhood;
mod patch;
pub mod polyhedra;
mod polynomial;
pub mod portrait;
pub mod region;
pub mod scheme;
pub mod solid;
pub mod surface;
pub mod target;

pub use centroid::{DeviceCentroid, MOST_CENTROID_MODES, ModeMoments};
pub use control::ControlForm;
pub use device::DeviceForm;
pub use error::FormError;
pub use form::TrilinearForm;
pub use local::MAX_VALENCE;
pub use mesh::ClosedMesh;
pub use modes::{DeviceModes, MOST_MODES, ModeVolume};
pub use moments::Moments;
pub use scheme::Scheme;
pub use surface::LimitSurface;
