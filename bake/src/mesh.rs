//! A solid mesh as it stands in a file: vertices in file order, cells by shape, features.
//!
//! Readers fill it, `check` judges it, `refine` hands it to core.

use crate::error::count;
use octruss::mesh as core;
use std::collections::HashSet;

/// Index of a vertex, counted from 0 in file order.
pub type Vertex = u32;

/// Position of a point in the units of its file.
pub type Point = [f64; 3];

/// The shape of a cell. Cells of a mesh are told apart by shape in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Shape {
    /// Four corners.
    Tetrahedron,
    /// Six corners, eight triangles.
    Octahedron,
    /// Six corners, two triangles and three quadrilaterals.
    Prism,
    /// Eight corners, six quadrilaterals.
    Hexahedron,
}

impl Shape {
    /// All shapes, in order.
    pub const ALL: [Self; 4] = [
        Self::Tetrahedron,
        Self::Octahedron,
        Self::Prism,
        Self::Hexahedron,
    ];

    /// Name for messages: singular and plural.
    pub fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Tetrahedron => ("tetrahedron", "tetrahedra"),
            Self::Octahedron => ("octahedron", "octahedra"),
            Self::Prism => ("prism", "prisms"),
            Self::Hexahedron => ("hexahedron", "hexahedra"),
        }
    }

    /// Places of the corners of each edge.
    pub fn edges(self) -> &'static [[usize; 2]] {
        match self {
            Self::Tetrahedron => &core::TETRAHEDRON_EDGES,
            Self::Octahedron => &core::OCTAHEDRON_EDGES,
            Self::Prism => &core::PRISM_EDGES,
            Self::Hexahedron => &core::HEXAHEDRON_EDGES,
        }
    }

    /// Places of the corners of each triangle, counter-clockwise from outside of a positive cell.
    pub fn triangles(self) -> &'static [[usize; 3]] {
        match self {
            Self::Tetrahedron => &core::TETRAHEDRON_FACES,
            Self::Octahedron => &core::OCTAHEDRON_FACES,
            Self::Prism => &core::PRISM_TRIANGLES,
            Self::Hexahedron => &[],
        }
    }

    /// Places of the corners of each quadrilateral, counter-clockwise from outside of a positive
    /// cell.
    pub fn quads(self) -> &'static [[usize; 4]] {
        match self {
            Self::Tetrahedron | Self::Octahedron => &[],
            Self::Prism => &core::PRISM_QUADS,
            Self::Hexahedron => &core::HEXAHEDRON_QUADS,
        }
    }
}

/// The cells of a solid mesh, by shape, each in file order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    /// Corners of the tetrahedra: positive if `det(v1-v0, v2-v0, v3-v0) > 0`.
    pub tetrahedra: Vec<[Vertex; 4]>,
    /// Corners of the octahedra: opposite pairs are (0,3), (1,4) and (2,5), and seen from outside
    /// a positive octahedron the face (0,2,1) runs counter-clockwise.
    pub octahedra: Vec<[Vertex; 6]>,
    /// Corners of the triangular prisms as Gmsh lists them: triangles (0,1,2) and (3,4,5), joined
    /// by the edges 0-3, 1-4 and 2-5; positive if `det(v1-v0, v2-v0, v3-v0) > 0`.
    pub prisms: Vec<[Vertex; 6]>,
    /// Corners of the hexahedra as Gmsh and VTK list them: quadrilaterals (0,1,2,3) and (4,5,6,7),
    /// joined by the edges 0-4, 1-5, 2-6 and 3-7; positive if `det(v1-v0, v3-v0, v4-v0) > 0`.
    pub hexahedra: Vec<[Vertex; 8]>,
}

impl Cells {
    /// Number of cells of one shape.
    pub fn count(&self, shape: Shape) -> usize {
        match shape {
            Shape::Tetrahedron => self.tetrahedra.len(),
            Shape::Octahedron => self.octahedra.len(),
            Shape::Prism => self.prisms.len(),
            Shape::Hexahedron => self.hexahedra.len(),
        }
    }

    /// Number of cells of all shapes.
    pub fn len(&self) -> usize {
        Shape::ALL.iter().map(|shape| self.count(*shape)).sum()
    }

    /// True if there is no cell of any shape.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// True if there is no prism and no hexahedron.
    pub fn is_tetrahedral(&self) -> bool {
        self.prisms.is_empty() && self.hexahedra.is_empty()
    }

    /// Every cell's shape and corners: tetrahedra first, then octahedra, prisms and hexahedra.
    pub fn iter(&self) -> impl Iterator<Item = (Shape, &[Vertex])> {
        let of = |shape| move |corners| (shape, corners);
        let tetrahedra = self.tetrahedra.iter().map(<[Vertex; 4]>::as_slice);
        let octahedra = self.octahedra.iter().map(<[Vertex; 6]>::as_slice);
        let prisms = self.prisms.iter().map(<[Vertex; 6]>::as_slice);
        let hexahedra = self.hexahedra.iter().map(<[Vertex; 8]>::as_slice);
        tetrahedra
            .map(of(Shape::Tetrahedron))
            .chain(octahedra.map(of(Shape::Octahedron)))
            .chain(prisms.map(of(Shape::Prism)))
            .chain(hexahedra.map(of(Shape::Hexahedron)))
    }

    /// The corners of every cell, in the order of [`Cells::iter`].
    pub fn corners(&self) -> impl Iterator<Item = &[Vertex]> {
        self.iter().map(|(_, corners)| corners)
    }

    /// The shape of the cell at `index` of [`Cells::iter`], and its place among the cells of this
    /// shape. An index behind the last cell counts on among the hexahedra.
    pub fn place(&self, index: usize) -> (Shape, usize) {
        let mut place = index;
        for shape in [Shape::Tetrahedron, Shape::Octahedron, Shape::Prism] {
            match place.checked_sub(self.count(shape)) {
                None => return (shape, place),
                Some(rest) => place = rest,
            }
        }
        (Shape::Hexahedron, place)
    }

    /// The corners of the cell at `index` of [`Cells::iter`].
    pub fn corners_of(&self, index: usize) -> &[Vertex] {
        match self.place(index) {
            (Shape::Tetrahedron, place) => &self.tetrahedra[place],
            (Shape::Octahedron, place) => &self.octahedra[place],
            (Shape::Prism, place) => &self.prisms[place],
            (Shape::Hexahedron, place) => &self.hexahedra[place],
        }
    }

    /// "tetrahedron 7" or "prism 2", counted from 0 in file order within the shape, for the cell at
    /// `index` of [`Cells::iter`].
    pub fn name(&self, index: usize) -> String {
        let (shape, place) = self.place(index);
        format!("{} {place}", shape.names().0)
    }

    /// "168 tetrahedra, 0 octahedra", and prisms and hexahedra where there are any.
    pub fn words(&self) -> String {
        let always = [Shape::Tetrahedron, Shape::Octahedron];
        let shown = Shape::ALL
            .into_iter()
            .filter(|shape| always.contains(shape) || self.count(*shape) > 0);
        let words = shown.map(|shape| {
            let (singular, plural) = shape.names();
            count(self.count(shape), singular, plural)
        });
        words.collect::<Vec<_>>().join(", ")
    }

    /// The triangles of all cells, counter-clockwise from outside of a positive cell.
    pub fn triangles(&self) -> impl Iterator<Item = [Vertex; 3]> {
        self.iter().flat_map(|(shape, corners)| {
            let faces = shape.triangles().iter();
            faces.map(move |face| face.map(|place| corners[place]))
        })
    }

    /// The quadrilaterals of all cells, counter-clockwise from outside of a positive cell.
    pub fn quads(&self) -> impl Iterator<Item = [Vertex; 4]> {
        self.iter().flat_map(|(shape, corners)| {
            let faces = shape.quads().iter();
            faces.map(move |face| face.map(|place| corners[place]))
        })
    }
}

/// Faces of a surface, triangles and quadrilaterals.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faces {
    /// Triangles.
    pub triangles: Vec<[Vertex; 3]>,
    /// Quadrilaterals, corners in cyclic order.
    pub quads: Vec<[Vertex; 4]>,
}

/// Where the smooth map is meant not to be smooth.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Features {
    /// Crease edges, each with its lesser vertex first, ascending, none twice.
    pub creases: Vec<[Vertex; 2]>,
    /// Vertices that keep their place, ascending, none twice.
    pub corners: Vec<Vertex>,
    /// Triangles of cells that make up crease surfaces inside the solid, each with ascending
    /// vertices, ascending, none twice. A face on the boundary changes nothing.
    pub faces: Vec<[Vertex; 3]>,
    /// Quadrilaterals of cells that do so too, each in cyclic order with its least vertex first and
    /// the lesser neighbour of that second, ascending, none twice.
    pub quads: Vec<[Vertex; 4]>,
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
    /// Of the prisms, in their order.
    pub prisms: Vec<i32>,
    /// Of the hexahedra, in their order.
    pub hexahedra: Vec<i32>,
}

impl Labels {
    /// True if cells have no labels.
    pub fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }

    /// The labels in the order of [`Cells::iter`].
    pub fn iter(&self) -> impl Iterator<Item = i32> {
        let lists = [
            &self.tetrahedra,
            &self.octahedra,
            &self.prisms,
            &self.hexahedra,
        ];
        lists.into_iter().flatten().copied()
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
        // octahedron of each tetrahedron, six of each octahedron; eight of each prism and hexahedron.
        Self {
            tetrahedra: [each(&self.tetrahedra, 4), each(&self.octahedra, 8)].concat(),
            octahedra: [each(&self.tetrahedra, 1), each(&self.octahedra, 6)].concat(),
            prisms: each(&self.prisms, 8),
            hexahedra: each(&self.hexahedra, 8),
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
        for quad in &mut self.quads {
            *quad = canonical_quad(*quad);
        }
        self.quads.sort_unstable();
        self.quads.dedup();
    }
}

/// The same cycle, whichever way round, with its least vertex first and the lesser neighbour of
/// that second: equal for the two sides of a face.
pub fn canonical_quad(mut quad: [Vertex; 4]) -> [Vertex; 4] {
    let least = (1..4).fold(0, |best, place| {
        if quad[place] < quad[best] {
            place
        } else {
            best
        }
    });
    quad.rotate_left(least);
    if quad[3] < quad[1] {
        quad.swap(1, 3);
    }
    quad
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
        self.features.quads.extend(more.quads);
        self.features.normalise();
    }
}
