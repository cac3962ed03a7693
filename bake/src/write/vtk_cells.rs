//! What VTK calls the cells.

use crate::mesh::{Shape, SolidMesh, Vertex};

/// VTK's number of a polyhedron.
pub const POLYHEDRON: u8 = 42;

/// One of all that is written.
pub struct Element {
    /// VTK's number of its type; octahedra are polyhedra.
    pub kind: u8,
    /// The corners in VTK's order, which is ours but for the wedge: its triangles turn the other
    /// way.
    pub corners: Vec<Vertex>,
}

impl Element {
    fn of_cell((shape, corners): (Shape, &[Vertex])) -> Self {
        let kind = match shape {
            Shape::Tetrahedron => 10,
            Shape::Octahedron => POLYHEDRON,
            Shape::Prism => 13,
            Shape::Hexahedron => 12,
        };
        let corners = match (shape, corners) {
            (Shape::Prism, &[a, b, c, d, e, f]) => vec![a, c, b, d, f, e],
            _ => corners.to_vec(),
        };
        Self { kind, corners }
    }

    /// A polygon of a surface.
    pub fn of_polygon(corners: &[Vertex]) -> Self {
        let kind = match corners.len() {
            3 => 5,
            4 => 9,
            _ => 7,
        };
        Self {
            kind,
            corners: corners.to_vec(),
        }
    }

    fn of_sheet(corners: &[Vertex; 3]) -> Self {
        Self::of_polygon(corners)
    }
}

/// All that is written: the cells, then the triangles of sheets.
pub fn elements(mesh: &SolidMesh) -> impl Iterator<Item = Element> {
    let sheets = mesh.features.sheets.iter().map(Element::of_sheet);
    mesh.cells.iter().map(Element::of_cell).chain(sheets)
}

/// The labels of all that is written.
pub fn labels(mesh: &SolidMesh) -> impl Iterator<Item = i32> {
    let sheets = mesh.features.sheets.iter().map(|_| 0);
    mesh.labels.iter().chain(sheets)
}
