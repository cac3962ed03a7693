//! The linear split of section 2.1: new vertices, child cells, child creases.

use super::solid::{Solid, edge};
use super::surface::{OCTAHEDRON_FACES, split_triangles};

/// A solid after its linear split, before any smoothing.
#[derive(Clone, Debug)]
pub struct LinearSplit {
    /// The refined connectivity: old vertices, then edge midpoints, then octahedron centroids.
    pub solid: Solid,
    /// Number of vertices before the split; they keep their indices.
    pub old_vertex_count: usize,
    /// The edges whose midpoints are new, in the order of the new vertices.
    pub edges: Vec<[u32; 2]>,
    /// The sorted corners of the octahedra whose centroids are new, in the order of the new
    /// vertices, each with its place in the solid's list. Octahedra with the same corners have
    /// centroids of their own, in the order of that list.
    pub octahedra: Vec<([u32; 6], usize)>,
}

impl LinearSplit {
    /// The new vertex at the middle of an edge of the solid before the split.
    ///
    /// # Panics
    /// If `a b` is not an edge.
    pub fn midpoint(&self, a: u32, b: u32) -> u32 {
        let place = self
            .edges
            .binary_search(&edge(a, b))
            .expect("an edge of the solid");
        to_index(self.old_vertex_count + place)
    }

    fn centroid(&self, cell: [u32; 6], place_in_list: usize) -> u32 {
        let place = self
            .octahedra
            .binary_search(&(sorted(cell), place_in_list))
            .expect("a cell of the solid");
        to_index(self.old_vertex_count + self.edges.len() + place)
    }
}

fn to_index(count: usize) -> u32 {
    u32::try_from(count).expect("fewer than 2^32 vertices")
}

fn sorted(mut cell: [u32; 6]) -> [u32; 6] {
    cell.sort_unstable();
    cell
}

/// Splits every cell once. Cells, creases and vertices come in the project's order.
///
/// The solid must be sound ([`Solid::check`]).
pub fn split(solid: &Solid) -> LinearSplit {
    let sorted_cells = solid.octahedra.iter().map(|cell| sorted(*cell));
    let mut octahedra: Vec<_> = sorted_cells.zip(0..).collect();
    octahedra.sort_unstable();
    let mut linear = LinearSplit {
        solid: Solid::default(),
        old_vertex_count: solid.vertex_count,
        edges: solid.edges(),
        octahedra,
    };
    let mut refined = Solid {
        vertex_count: solid.vertex_count + linear.edges.len() + linear.octahedra.len(),
        corners: solid.corners.clone(),
        ..Solid::default()
    };
    for cell in &solid.tetrahedra {
        split_tetrahedron(&linear, *cell, &mut refined);
    }
    for (place, cell) in solid.octahedra.iter().enumerate() {
        split_octahedron(*cell, linear.centroid(*cell, place), &linear, &mut refined);
    }
    refined.sheets = split_triangles(&solid.sheets, |a, b| linear.midpoint(a, b));
    for &[a, b] in &solid.creases {
        let middle = linear.midpoint(a, b);
        refined.creases.extend([[a, middle], [middle, b]]);
    }
    linear.solid = refined;
    linear
}

/// Four tetrahedra at the corners and the octahedron that is left.
fn split_tetrahedron(linear: &LinearSplit, v: [u32; 4], refined: &mut Solid) {
    for corner in v {
        // Corner k of child i is the midpoint of v_i and v_k; corner i is v_i itself.
        let child = v.map(|other| {
            if other == corner {
                corner
            } else {
                linear.midpoint(corner, other)
            }
        });
        refined.tetrahedra.push(child);
    }
    let middle = [[0, 1], [0, 2], [0, 3], [2, 3], [1, 3], [1, 2]];
    refined
        .octahedra
        .push(middle.map(|[i, k]: [usize; 2]| linear.midpoint(v[i], v[k])));
}

/// Six octahedra at the corners and eight tetrahedra at the faces.
fn split_octahedron(v: [u32; 6], centroid: u32, linear: &LinearSplit, refined: &mut Solid) {
    for [a, b, c] in OCTAHEDRON_FACES.map(|face| face.map(|place| v[place])) {
        let child = [
            centroid,
            linear.midpoint(b, c),
            linear.midpoint(c, a),
            linear.midpoint(a, b),
        ];
        refined.tetrahedra.push(child);
    }
    for (place, corner) in v.into_iter().enumerate() {
        let opposite = v[(place + 3) % 6];
        let child = v.map(|other| {
            if other == corner {
                corner
            } else if other == opposite {
                centroid
            } else {
                linear.midpoint(corner, other)
            }
        });
        refined.octahedra.push(child);
    }
}

/// How many of everything a solid has; enough to foretell the counts after a split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Vertices.
    pub vertices: usize,
    /// Edges of cells.
    pub edges: usize,
    /// Different triangles of cells.
    pub faces: usize,
    /// Tetrahedra.
    pub tetrahedra: usize,
    /// Octahedra.
    pub octahedra: usize,
}

impl Counts {
    /// Counts what a solid has; sheets must be triangles of its cells.
    pub fn of(solid: &Solid) -> Self {
        let mut faces: Vec<_> = super::surface::cell_faces(solid)
            .into_iter()
            .map(|mut face| {
                face.sort_unstable();
                face
            })
            .collect();
        faces.sort_unstable();
        faces.dedup();
        Self {
            vertices: solid.vertex_count,
            edges: solid.edges().len(),
            faces: faces.len(),
            tetrahedra: solid.tetrahedra.len(),
            octahedra: solid.octahedra.len(),
        }
    }

    /// The counts after one split.
    ///
    /// An edge falls in two and every face adds three; an octahedron adds the twelve edges from its
    /// centroid. A face falls in four, a tetrahedron adds the four that cut its
    /// corners off, an octahedron the 24 triangles around its centroid.
    pub fn after_split(self) -> Self {
        Self {
            vertices: self.vertices + self.edges + self.octahedra,
            edges: 2 * self.edges + 3 * self.faces + 12 * self.octahedra,
            faces: 4 * self.faces + 4 * self.tetrahedra + 24 * self.octahedra,
            tetrahedra: 4 * self.tetrahedra + 8 * self.octahedra,
            octahedra: self.tetrahedra + 6 * self.octahedra,
        }
    }
}
