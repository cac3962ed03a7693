//! The boundary of a solid: found from the cells' faces at every level anew.

use super::solid::{Solid, edge};

/// Outward counter-clockwise triangles of a positive tetrahedron, by corner position.
pub const TETRAHEDRON_FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// Outward counter-clockwise triangles of a positive octahedron, by corner position, in the
/// order in which its eight face tetrahedra are made.
pub const OCTAHEDRON_FACES: [[usize; 3]; 8] = [
    [0, 2, 1],
    [0, 1, 5],
    [0, 4, 2],
    [0, 5, 4],
    [3, 1, 2],
    [3, 5, 1],
    [3, 2, 4],
    [3, 4, 5],
];

/// All triangles of all cells, as oriented by their cells, four of each tetrahedron and then eight of
/// each octahedron; shared ones occur more than once.
pub fn cell_faces(solid: &Solid) -> Vec<[u32; 3]> {
    let mut faces = Vec::with_capacity(4 * solid.tetrahedra.len() + 8 * solid.octahedra.len());
    for cell in &solid.tetrahedra {
        faces.extend(TETRAHEDRON_FACES.map(|face| face.map(|place| cell[place])));
    }
    for cell in &solid.octahedra {
        faces.extend(OCTAHEDRON_FACES.map(|face| face.map(|place| cell[place])));
    }
    faces
}

/// The triangles that belong to exactly one cell, outward, in ascending order of their sorted
/// corners, each starting with its least corner.
pub fn boundary_triangles(solid: &Solid) -> Vec<[u32; 3]> {
    let mut faces: Vec<_> = cell_faces(solid)
        .into_iter()
        .map(|face| {
            let mut key = face;
            key.sort_unstable();
            (key, least_first(face))
        })
        .collect();
    faces.sort_unstable();
    let groups = faces.chunk_by(|one, other| one.0 == other.0);
    groups
        .filter(|group| group.len() == 1)
        .map(|group| group[0].1)
        .collect()
}

/// The same oriented triangle with its least corner first.
fn least_first(face: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = face;
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// The four children of each triangle, in order: at its three corners, then the middle one.
///
/// `midpoint` gives the new vertex of an edge.
pub fn split_triangles(
    triangles: &[[u32; 3]],
    midpoint: impl Fn(u32, u32) -> u32,
) -> Vec<[u32; 3]> {
    let mut children = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let (ab, bc, ca) = (midpoint(a, b), midpoint(b, c), midpoint(c, a));
        children.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    children
}

/// The triangles of a solid that follow the surface rule: the boundary, found anew, and sheets.
pub fn surface_triangles(solid: &Solid) -> Vec<[u32; 3]> {
    let mut triangles = boundary_triangles(solid);
    triangles.extend_from_slice(&solid.sheets);
    triangles
}

/// Neighbourhoods on a boundary, as Loop's rules need them.
#[derive(Clone, Debug)]
pub struct BoundarySurface {
    /// Each edge of each triangle with the corner opposite it, in ascending order; an edge that
    /// `m` triangles share occurs `m` times.
    sides: Vec<([u32; 2], u32)>,
    /// Both directions of each boundary edge, each once, in ascending order.
    neighbours: Vec<[u32; 2]>,
}

impl BoundarySurface {
    /// Collects the edges of triangles.
    pub fn new(triangles: &[[u32; 3]]) -> Self {
        let mut sides: Vec<_> = triangles
            .iter()
            .flat_map(|&[a, b, c]| [(edge(a, b), c), (edge(b, c), a), (edge(c, a), b)])
            .collect();
        sides.sort_unstable();
        let mut neighbours: Vec<_> = sides
            .iter()
            .flat_map(|&([a, b], _)| [[a, b], [b, a]])
            .collect();
        neighbours.sort_unstable();
        neighbours.dedup();
        Self { sides, neighbours }
    }

    /// The corners opposite an edge in the boundary triangles on it; none if it is no boundary edge.
    pub fn opposite(&self, edge: [u32; 2]) -> impl Iterator<Item = u32> {
        let start = self.sides.partition_point(|side| side.0 < edge);
        self.sides[start..]
            .iter()
            .take_while(move |side| side.0 == edge)
            .map(|side| side.1)
    }

    /// The numbers of neighbours that occur, in ascending order.
    pub fn valences(&self) -> Vec<usize> {
        let vertices = self.neighbours.chunk_by(|one, other| one[0] == other[0]);
        let mut valences: Vec<_> = vertices.map(<[_]>::len).collect();
        valences.sort_unstable();
        valences.dedup();
        valences
    }

    /// The other ends of the boundary edges at a vertex; none if it is no boundary vertex.
    pub fn neighbours(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let start = self.neighbours.partition_point(|[from, _]| *from < vertex);
        let from_vertex = self.neighbours[start..]
            .iter()
            .take_while(move |pair| pair[0] == vertex);
        from_vertex.map(|pair| pair[1])
    }
}

#[cfg(test)]
mod tests {
    use super::{OCTAHEDRON_FACES, TETRAHEDRON_FACES};

    fn volume(corners: [[f64; 3]; 4]) -> f64 {
        let [o, a, b, c] = corners;
        let [a, b, c] = [a, b, c].map(|p| [p[0] - o[0], p[1] - o[1], p[2] - o[2]]);
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    /// Geometry: a triangle is outward if it sees a point inside the cell behind it.
    #[test]
    fn faces_are_outward() {
        let tetrahedron = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(volume(tetrahedron) > 0.0);
        for face in TETRAHEDRON_FACES {
            let [a, b, c] = face.map(|place| tetrahedron[place]);
            assert!(volume([[0.1; 3], a, b, c]) > 0.0);
        }
        let pairs = [[0, 1], [0, 2], [0, 3], [2, 3], [1, 3], [1, 2]];
        let octahedron = pairs.map(|[i, k]: [usize; 2]| {
            let (p, q): ([f64; 3], [f64; 3]) = (tetrahedron[i], tetrahedron[k]);
            [
                (p[0] + q[0]) / 2.0,
                (p[1] + q[1]) / 2.0,
                (p[2] + q[2]) / 2.0,
            ]
        });
        for face in OCTAHEDRON_FACES {
            let [a, b, c] = face.map(|place| octahedron[place]);
            assert!(volume([[0.25; 3], a, b, c]) > 0.0);
        }
    }
}
