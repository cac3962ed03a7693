//! Gmsh's element types: which are read, which are ignored, which are refused.

use crate::error::{Error, Place, Result};

/// An element type of first order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ElementType {
    /// One node.
    Point,
    /// Two nodes.
    Line,
    /// Three nodes.
    Triangle,
    /// Four nodes round a face.
    Quadrangle,
    /// Four nodes, a volume.
    Tetrahedron,
    /// Eight nodes, a volume.
    Hexahedron,
    /// Six nodes, a volume.
    Prism,
    /// Five nodes, a volume.
    Pyramid,
}

impl ElementType {
    /// The type behind Gmsh's number, or an error at `place` that says what to do.
    pub fn from_number(number: u32, place: Place) -> Result<Self> {
        Ok(match number {
            15 => Self::Point,
            1 => Self::Line,
            2 => Self::Triangle,
            3 => Self::Quadrangle,
            4 => Self::Tetrahedron,
            5 => Self::Hexahedron,
            6 => Self::Prism,
            7 => Self::Pyramid,
            8..=14 | 16..=33 | 36..=66 | 71..=75 | 79..=83 | 92..=105 | 118..=131 | 137 => {
                return Err(Error::new(format!(
                    "element type {number} is of second or higher order; a cage has cells with straight edges"
                ))
                .at(place)
                .advise("mesh at first order: Mesh.ElementOrder = 1 in Gmsh, or `gmsh -order 1`"));
            }
            _ => {
                return Err(Error::new(format!("element type {number} is not known"))
                    .at(place)
                    .advise("a cage consists of tetrahedra (Gmsh element type 4)"));
            }
        })
    }

    /// The greatest number of nodes of a type.
    pub const MOST_NODES: usize = 8;

    /// Number of nodes.
    pub fn node_count(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Quadrangle | Self::Tetrahedron => 4,
            Self::Pyramid => 5,
            Self::Prism => 6,
            Self::Hexahedron => 8,
        }
    }

    /// Dimension of the element: 0 for a point to 3 for a volume.
    pub fn dimension(self) -> u8 {
        match self {
            Self::Point => 0,
            Self::Line => 1,
            Self::Triangle | Self::Quadrangle => 2,
            Self::Tetrahedron | Self::Hexahedron | Self::Prism | Self::Pyramid => 3,
        }
    }

    /// Name for messages: singular and plural.
    pub fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Point => ("point", "points"),
            Self::Line => ("line", "lines"),
            Self::Triangle => ("triangle", "triangles"),
            Self::Quadrangle => ("quadrangle", "quadrangles"),
            Self::Tetrahedron => ("tetrahedron", "tetrahedra"),
            Self::Hexahedron => ("hexahedron", "hexahedra"),
            Self::Prism => ("prism", "prisms"),
            Self::Pyramid => ("pyramid", "pyramids"),
        }
    }
}
