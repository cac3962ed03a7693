//! A solid mesh as it stands in a file: vertices in file order, cells by shape, features.
//!
//! Readers fill it, `check` judges it, `refine` hands it to core. A new cell shape is one more
//! field of [`Cells`] and of [`Labels`].

use std::collections::HashSet;

/// Index of a vertex, counted from 0 in file order.
pub type Vertex = u32;

/// Position of a point in the units of its file.
pub type Point = [f64; 3];

/// The cells of a solid mesh, by shape, each in file order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    /// Corners of the tetrahedra: positive if `det(v1-v0, v2-v0, v3-v0) > 0`.
    pub tetrahedra: Vec<[Vertex; 4]>,
    /// Corners of the octahedra: opposite pairs are (0,3), (1,4) and (2,5), and seen from outside
    /// a positive octahedron the face (0,2,1) runs counter-clockwise.
    pub octahedra: Vec<[Vertex; 6]>,
}

impl Cells {
    /// Number of cells of all shapes.
    pub fn len(&self) -> usize {
        self.tetrahedra.len() + self.octahedra.len()
    }

    /// True if there is no cell of any shape.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The corners of every cell: tetrahedra first, then octahedra.
    pub fn corners(&self) -> impl Iterator<Item = &[Vertex]> {
        let tetrahedra = self.tetrahedra.iter().map(|cell| cell.as_slice());
        tetrahedra.chain(self.octahedra.iter().map(|cell| cell.as_slice()))
    }

    /// "tetrahedron 7" or "octahedron 2", counted from 0 in file order within the shape, for the
    /// cell at `index` of [`Cells::corners`].
    pub fn name(&self, index: usize) -> String {
        match index.checked_sub(self.tetrahedra.len()) {
            None => format!("tetrahedron {index}"),
            Some(octahedron) => format!("octahedron {octahedron}"),
        }
    }
}

/// Where the smooth map is meant not to be smooth.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Features {
    /// Crease edges, each with its lesser vertex first, ascending, none twice.
    pub creases: Vec<[Vertex; 2]>,
    /// Vertices that keep their place, ascending, none twice.
    pub corners: Vec<Vertex>,
    /// Faces of cells that make up crease surfaces inside the solid, each with ascending vertices,
    /// ascending, none twice. A face on the boundary changes nothing.
    pub faces: Vec<[Vertex; 3]>,
    /// Triangles of no cell: sheets that hang on the solid, or stand alone, and follow the
    /// boundary's rule. Corners and triangles in file order, none twice.
    pub sheets: Vec<[Vertex; 3]>,
}

/// What cells are made of or belong to: a number for each, or none at all.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Labels {
    /// Of the tetrahedra, in their order.
    pub tetrahedra: Vec<i32>,
    /// Of the octahedra, in their order.
    pub octahedra: Vec<i32>,
}

impl Labels {
    /// True if cells have no labels.
    pub fn is_empty(&self) -> bool {
        self.tetrahedra.is_empty() && self.octahedra.is_empty()
    }

    /// The labels in the order of [`Cells::corners`].
    pub fn iter(&self) -> impl Iterator<Item = i32> {
        self.tetrahedra.iter().chain(&self.octahedra).copied()
    }

    /// Forgets labels that tell no cell from another that has none: all zero.
    pub fn drop_if_zero(&mut self) {
        if self.iter().all(|label| label == 0) {
            *self = Self::default();
        }
    }

    /// The labels of the cells of the next level: every child has its parent's.
    #[must_use]
    pub fn refined(&self) -> Self {
        let each = |labels: &[i32], children: usize| -> Vec<i32> {
            let repeated = |label: &i32| std::iter::repeat_n(*label, children);
            labels.iter().flat_map(repeated).collect()
        };
        // Core's order: four tetrahedra of each tetrahedron, eight of each octahedron; one
        // octahedron of each tetrahedron, six of each octahedron.
        Self {
            tetrahedra: [each(&self.tetrahedra, 4), each(&self.octahedra, 8)].concat(),
            octahedra: [each(&self.tetrahedra, 1), each(&self.octahedra, 6)].concat(),
        }
    }
}

/// A quantity beside the coordinates, such as a density or a temperature.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channel {
    /// Its name in the file.
    pub name: String,
    /// A value for each vertex. All finite.
    pub values: Vec<f64>,
}

impl Features {
    /// Brings the features into their one canonical order.
    pub fn normalise(&mut self) {
        for edge in &mut self.creases {
            edge.sort_unstable();
        }
        self.creases.sort_unstable();
        self.creases.dedup();
        self.corners.sort_unstable();
        self.corners.dedup();
        for face in &mut self.faces {
            face.sort_unstable();
        }
        self.faces.sort_unstable();
        self.faces.dedup();
        let mut seen = HashSet::new();
        self.sheets.retain(|sheet| {
            let mut corners = *sheet;
            corners.sort_unstable();
            seen.insert(corners)
        });
    }
}

/// A solid mesh: a cage, a posed cage, or a refined one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolidMesh {
    /// Vertex positions, in file order, in the file's units. All finite.
    pub points: Vec<Point>,
    /// The cells.
    pub cells: Cells,
    /// Creases and corners.
    pub features: Features,
    /// Labels of the cells; empty if the file has none.
    pub labels: Labels,
    /// Scalar channels, in file order, each name once.
    pub channels: Vec<Channel>,
    /// What a reader left out or found odd, a sentence each.
    pub notes: Vec<String>,
}

impl SolidMesh {
    /// Adds features that were read from elsewhere.
    pub fn add_features(&mut self, more: Features) {
        self.features.creases.extend(more.creases);
        self.features.corners.extend(more.corners);
        self.features.faces.extend(more.faces);
        self.features.sheets.extend(more.sheets);
        self.features.normalise();
    }
}
