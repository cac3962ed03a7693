//! Crease surfaces inside a solid, and sheets outside it.

use crate::check::FaceUses;
use crate::error::{Error, Result};
use crate::mesh::{Faces, SolidMesh, Vertex, canonical_quad};
use std::collections::HashSet;

/// The crease faces that lie inside the solid.
pub(super) fn inside_faces(mesh: &SolidMesh, boundary: &Faces) -> Result<Faces> {
    let (faces, quads) = (&mesh.features.faces, &mesh.features.quads);
    if faces.is_empty() && quads.is_empty() {
        return Ok(Faces::default());
    }
    let sorted = |mut face: [Vertex; 3]| {
        face.sort_unstable();
        face
    };
    let of_cells = FaceUses::of(&mesh.cells);
    if let Some([a, b, c]) = faces
        .iter()
        .find(|face| !of_cells.triangles.contains_key(&sorted(**face)))
    {
        return Err(no_face(&format!("{a}, {b} and {c}")));
    }
    if let Some([a, b, c, d]) = quads
        .iter()
        .find(|face| !of_cells.quads.contains_key(&canonical_quad(**face)))
    {
        return Err(no_face(&format!("{a}, {b}, {c} and {d}")));
    }
    let boundary_triangles = boundary.triangles.iter().copied();
    let on_boundary: HashSet<[Vertex; 3]> = boundary_triangles.map(sorted).collect();
    let boundary_quads = boundary.quads.iter().copied();
    let quads_on_boundary: HashSet<[Vertex; 4]> = boundary_quads.map(canonical_quad).collect();
    let inside = faces
        .iter()
        .filter(|face| !on_boundary.contains(&sorted(**face)));
    let quads_inside = quads
        .iter()
        .filter(|face| !quads_on_boundary.contains(&canonical_quad(**face)));
    Ok(Faces {
        triangles: inside.copied().collect(),
        quads: quads_inside.copied().collect(),
    })
}

/// Error if a triangle of a sheet is a face of a cell, or lies on one.
pub(super) fn require_no_cell_has(mesh: &SolidMesh) -> Result<()> {
    let sheets = &mesh.features.sheets;
    if sheets.is_empty() {
        return Ok(());
    }
    let of_cells = FaceUses::of(&mesh.cells);
    let halves = of_cells
        .quads
        .keys()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*b, *c, *d], [*c, *d, *a], [*d, *a, *b]]);
    let sorted = |mut face: [Vertex; 3]| {
        face.sort_unstable();
        face
    };
    let taken: HashSet<[Vertex; 3]> = of_cells
        .triangles
        .keys()
        .copied()
        .chain(halves.map(sorted))
        .collect();
    let mut in_order = sheets.iter().copied().map(sorted);
    match in_order.find(|face| taken.contains(face)) {
        Some([a, b, c]) => Err(Error::new(format!(
            "the sheet's triangle of vertices {a}, {b} and {c} (counted from 0) is a face of a cell"
        ))
        .advise("sheets hang on a solid by edges and vertices; inside it or on its boundary a surface is a crease surface")),
        None => Ok(()),
    }
}

fn no_face(corners: &str) -> Error {
    Error::new(format!(
        "the crease face of vertices {corners} (counted from 0) is no face of a cell"
    ))
    .advise(
        "a crease surface runs along faces of the mesh; mesh the surface together with the volume",
    )
}
