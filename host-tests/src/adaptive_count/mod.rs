//! How many triangles two adaptive schemes need for the same tolerance: Kobbelt's comparison of the square-root-3
//! scheme with Loop's, red-green.
//!
//! Both meshes have their vertices on the limit surface, and both are refined until no limit point over a triangle
//! is farther from it than the tolerance ([`measure`]). Both are written again here, over real numbers.

pub mod loop_rule;
pub mod measure;
pub mod meshes;
pub mod picture;
pub mod sqrt3;
pub mod surface;

use loop_rule::{Green, LoopMesh};
use meshes::Closed;
use sqrt3::Sqrt3Mesh;

/// Triangles for one tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Count {
    /// The tolerance, as a part of the mesh's greatest extent.
    pub tolerance: f64,
    /// Of the square-root-3 mesh.
    pub sqrt3: usize,
    /// Of the Loop mesh.
    pub loop_rule: usize,
}

/// Tolerances of the comparison, log-spaced over one and a half decades, as parts of a mesh's greatest extent.
pub fn tolerances() -> impl Iterator<Item = f64> {
    (0..13).map(|step| 10.0_f64.powf(-2.0 - f64::from(step) / 8.0))
}

/// Counts the triangles of both schemes.
pub fn counts(mesh: &Closed, green: Green) -> Vec<Count> {
    let mut sqrt3 = Sqrt3Mesh::new(&mesh.points, &mesh.triangles);
    let mut rival = LoopMesh::new(green, &mesh.points, &mesh.triangles);
    let extent = mesh.extent();
    let count = |tolerance: f64| Count {
        tolerance,
        sqrt3: sqrt3.count(tolerance * extent),
        loop_rule: rival.count(tolerance * extent),
    };
    tolerances().map(count).collect()
}

/// The part of the triangles that the square-root-3 scheme saves, as a geometric mean over the tolerances.
pub fn saving(counts: &[Count]) -> f64 {
    let ratio = |count: &Count| (count.sqrt3 as f64 / count.loop_rule as f64).ln();
    1.0 - (counts.iter().map(ratio).sum::<f64>() / counts.len() as f64).exp()
}
