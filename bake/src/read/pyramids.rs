//! Pyramids become two tetrahedra each.
//!
//! The base is cut along the diagonal on which a triangle of a tetrahedron, an octahedron or a prism
//! of the file already lies; if none does, along the diagonal of its least vertex. So two pyramids on
//! one quadrilateral choose the same diagonal, and a cage and its poses, which have the same
//! connectivity, are cut alike. A prism or hexahedron behind the base is then covered by two triangles.

use crate::check::FaceUses;
use crate::error::count;
use crate::mesh::{SolidMesh, Vertex};

/// A pyramid as Gmsh, VTK and Medit list it: the base counter-clockwise as seen from the apex, which
/// comes last.
#[derive(Clone, Copy, Debug)]
pub struct Pyramid {
    /// The corners.
    pub corners: [Vertex; 5],
    /// Its label.
    pub label: i32,
}

/// Adds two tetrahedra for each pyramid, behind those that are there, with their labels if
/// `has_labels`, and a note.
pub fn add(pyramids: &[Pyramid], has_labels: bool, mesh: &mut SolidMesh) {
    if pyramids.is_empty() {
        return;
    }
    let uses = FaceUses::of(&mesh.cells);
    for Pyramid { corners, label } in pyramids {
        let [a, b, c, d, apex] = *corners;
        let base = [a, b, c, d];
        let lies = |left_out: usize| uses.on_half(&base, left_out) > 0;
        let along_first = lies(1) || lies(3);
        let along_second = lies(0) || lies(2);
        let halves = if along_first || (!along_second && a.min(c) < b.min(d)) {
            [[a, b, c, apex], [a, c, d, apex]]
        } else {
            [[b, c, d, apex], [b, d, a, apex]]
        };
        mesh.cells.tetrahedra.extend(halves);
        if has_labels {
            mesh.labels.tetrahedra.extend([*label; 2]);
        }
    }
    mesh.notes.push(format!(
        "{} cut into two tetrahedra each",
        count(pyramids.len(), "pyramid is", "pyramids are")
    ));
}
