//! Paper 1 and the numeric contract once more, in double precision that is exact.
//!
//! The reference exists to be compared with `!=`. It is written from the paper's text and
//! pseudocode and from the project's numeric contract; it does not look at, call or share a
//! line with the crate that it judges. Where the other side inherits something from the level
//! before (the boundary), the reference finds it anew.
//!
//! # Why the arithmetic is exact
//!
//! All arithmetic is `f64`, and an `f64` holds every integer of magnitude up to 2^53. So it
//! is enough that every input, every partial sum and every product is such an integer:
//!
//! * A coordinate is a raw 32-bit integer, magnitude at most 2^31.
//! * **Linear split.** Old vertices, edge midpoints and octahedron centroids have the
//!   denominators 1, 2 and 6. Six times a linearly split position is an integer of magnitude at
//!   most 6 * 2^31.
//! * **Smoothing.** The paper's two matrices have the denominator 48. The magnitudes of a row of
//!   48 times a matrix add up to 54 (tetrahedron) or 48 (octahedron). So each cell adds
//!   an integer of magnitude at most 324 * 2^31 to a vertex's sum over the denominator 288, and
//!   the sum over `c` cells, with its denominator `288 c` added one and a half times for the
//!   rounding, stays below 2^53 while `c` is at most [`CELLS_AT_A_VERTEX_MAXIMUM`]. A mesh with
//!   more cells at one vertex is refused.
//! * **Loop's rules and creases** with rational weights have a denominator `d` (8, 16, 64, 128, 256,
//!   8n, or 8m at an edge of m triangles) and weights that add up to `d` and are not
//!   negative; the sums have magnitude at most `d * 2^31`, below 2^53 while `d < 2^22`, which a
//!   mesh with at most 2^16 vertices cannot reach.
//! * **Weights with 30 fraction bits** times 32-bit coordinates need 62 bits. There each
//!   coordinate is split into a low limb in `0 .. 2^16` and a high limb that is the floor of the
//!   coordinate over 2^16. With magnitudes of weights that add up to at most 2^31 and
//!   coordinates (or displacements, 33 bits) below 2^32, both limb sums stay within 2^47.
//!
//! Rounding happens once for each coordinate, `floor(x + 1/2)`: half of the (always even)
//! denominator is added to the integer numerator and the quotient is floored exactly
//! ([`exact::floor_quotient`]), because a quotient estimate that is at most one too great is
//! corrected by its exact remainder. Then the result saturates to 32 bits, and how many
//! coordinates did is counted.
//!
//! All weights of refinement are non-negative once the split and the smoothing are combined,
//! and they add up to one, so refinement never saturates; the count is there to show it. The
//! table's rows may have negative weights, and do.

mod arithmetic;
mod classify;
pub mod exact;
mod labels;
mod loop_weight;
mod masks;
pub mod normals;
mod refine;
mod smooth;
mod solid;
mod split;
mod surface;
mod table;

pub use labels::{parents, split_labels};
pub use loop_weight::{LoopWeight, WEIGHT_UNIT};
pub use masks::{MaskEntry, level_masks, linear_masks};
pub use refine::{Refined, RefinedReal, refine, refine_real};
pub use smooth::{OCTAHEDRON_TIMES_48, TETRAHEDRON_TIMES_48};
pub use solid::{Boundary, CELLS_AT_A_VERTEX_MAXIMUM, Solid, SolidError};
pub use split::{Counts, LinearSplit, split};
pub use surface::{
    BoundarySurface, boundary_triangles, cell_faces, split_triangles, surface_triangles,
};
pub use table::{Applied, Table, TableError, apply_absolute, apply_displacement};
