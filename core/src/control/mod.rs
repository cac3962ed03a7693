//! Control: from goals to a pose, under constraints that always hold.
//!
//! Every part has its configuration in flash, borrowed from a bundle, and its state in the caller's
//! memory. A call ends after a bounded number of steps, respects the hard limits (bounds, rates)
//! whatever it is asked for, and says what it had to give up.
//!
//! * [`actuation`]: the pose that actuators make, and which rows of the table the effectors are.
//! * [`health`]: the cells that a pose folds over, and how far it is from that.
//! * [`inverse`]: amplitudes of a few actuation modes that bring points of the model to their goals while the
//!   enclosed volume is held; or, the other way round, the amplitudes that measured points tell of.
//! * [`project`]: the nearest pose to a goal for every control point, under pins, boxes, rates and the volumes of
//!   regions.
//! * [`rig`]: a skeleton of joints that carries control points.
//! * [`springs`]: the control points as masses on damped springs that strive for a goal shape, are pushed
//!   and hit things.

pub mod actuation;
pub mod health;
pub mod inverse;
pub mod project;
pub mod rig;
pub mod springs;
