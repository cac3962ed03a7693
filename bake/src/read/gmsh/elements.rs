//! Gmsh's element types: which are read, which are ignored, which are refused.

use crate::error::{Error, Place, Result, count};

/// An element type.
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
    /// Second or higher order, by Gmsh's number.
    Curved(u8),
}

/// The types of second and higher order whose length is known: Gmsh's number and the number of
/// nodes.
const CURVED: [(u8, usize); 25] = [
    (8, 3),
    (9, 6),
    (10, 9),
    (11, 10),
    (12, 27),
    (13, 18),
    (14, 14),
    (16, 8),
    (17, 20),
    (18, 15),
    (19, 13),
    (20, 9),
    (21, 10),
    (22, 12),
    (23, 15),
    (24, 15),
    (25, 21),
    (26, 4),
    (27, 5),
    (28, 6),
    (29, 20),
    (30, 35),
    (31, 56),
    (92, 64),
    (93, 125),
];

/// What the user can do about elements of second or higher order.
pub const ORDER_ADVICE: &str =
    "mesh at first order: Mesh.ElementOrder = 1 in Gmsh, or `gmsh -order 1`";

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
            _ if let Some((known, _)) =
                CURVED.iter().find(|(known, _)| u32::from(*known) == number) =>
            {
                Self::Curved(*known)
            }
            32 | 33 | 36..=66 | 71..=75 | 79..=83 | 94..=105 | 118..=131 | 137 => {
                return Err(Error::new(format!(
                    "element type {number} is of second or higher order; a cage has cells with straight edges"
                ))
                .at(place)
                .advise(ORDER_ADVICE));
            }
            _ => {
                return Err(Error::new(format!("element type {number} is not known"))
                    .at(place)
                    .advise("a cage consists of tetrahedra (Gmsh element type 4)"));
            }
        })
    }

    /// The greatest number of nodes of a type.
    pub const MOST_NODES: usize = 125;

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
            Self::Curved(number) => {
                let known = CURVED.iter().find(|(known, _)| *known == number);
                known.map_or(0, |(_, nodes)| *nodes)
            }
        }
    }

    /// Whether a cage cannot hold it and must not lose it: a volume that is no tetrahedron, or anything curved.
    pub fn is_foreign(self) -> bool {
        matches!(self, Self::Curved(_))
    }

    /// So many elements of this type, for messages.
    pub fn counted(self, number: usize) -> String {
        let (singular, plural) = match self {
            Self::Point => ("point", "points"),
            Self::Line => ("line", "lines"),
            Self::Triangle => ("triangle", "triangles"),
            Self::Quadrangle => ("quadrangle", "quadrangles"),
            Self::Tetrahedron => ("tetrahedron", "tetrahedra"),
            Self::Hexahedron => ("hexahedron", "hexahedra"),
            Self::Prism => ("prism", "prisms"),
            Self::Pyramid => ("pyramid", "pyramids"),
            Self::Curved(kind) => {
                let elements = count(number, "element", "elements");
                return format!("{elements} of second or higher order (type {kind})");
            }
        };
        count(number, singular, plural)
    }
}
