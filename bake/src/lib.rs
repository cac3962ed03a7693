//! Host tools of octruss: from a cage and a model to a bundle, and back to a deformed model.
//!
//! Data goes down this list:
//!
//! * [`read`]: meshes, models, features and motions from files, one reader a format, into
//!   [`mesh::SolidMesh`], [`read::obj::Model`] and frames of points.
//! * [`check`], [`overlap`], [`inspect`]: is it a sound solid, and what is there to know about it.
//! * [`refine`]: core's subdivision over vectors, in double precision, in the device's bits, or as
//!   sparse matrices.
//! * [`surface`]: the same for control meshes of polygons.
//! * [`locate`]: which refined cell holds a point, and the point's coordinates in it.
//! * [`table`]: the weights of every model point on the control points, as integers, with a proved
//!   bound of their error.
//! * [`dynamics`]: rigs and springs, which move the control points.
//! * [`pack`]: rows in groups, in the order in which the kernels read them.
//! * [`forms`]: the exact volume that a subdivision surface encloses, and its moments.
//! * [`bundle`]: the bytes for the device's flash.
//! * [`mod@deform`]: the device's own code applied on the host.
//! * [`mod@slice`]: values on a plane and along a line, and the picture of them.
//! * [`drive`]: the host's end of a running controller.
//! * [`mod@write`], [`picture`], [`animation`]: files to look at.
//!
//! No mathematics that a device could also need is written here: masks, numbering, rounding and the
//! apply come from the crate `octruss`. Nothing panics on bad input; errors ([`error::Error`]) say
//! what, where in which file, and what to do. The binary `octruss` is a thin layer above.

pub mod animation;
pub mod bundle;
pub mod check;
pub mod deform;
pub mod drive;
pub mod dynamics;
pub mod error;
pub mod forms;
pub mod geometry;
pub mod inspect;
pub mod locate;
pub mod mesh;
pub mod overlap;
pub mod pack;
pub mod picture;
pub mod progress;
pub mod read;
pub mod refine;
pub mod slice;
pub mod surface;
pub mod table;
pub mod write;
