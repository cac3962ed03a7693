//! The connectivity of a closed, oriented surface of polygons.

use std::collections::HashMap;

use super::error::FormError;

/// A half-edge: a directed edge of one face.
///
/// Half-edges are numbered face by face, so that half-edge `face_start + k` runs from a face's
/// corner `k` to its next corner. A half-edge also stands for the face's corner that it leaves.
pub type HalfEdge = usize;

/// A closed, oriented, manifold surface of polygons, connectivity only.
#[derive(Clone, Debug)]
pub struct ClosedMesh {
    vertices: usize,
    face_starts: Vec<usize>,
    origins: Vec<usize>,
    faces: Vec<usize>,
    twins: Vec<HalfEdge>,
    edges: Vec<usize>,
    edge_sides: Vec<HalfEdge>,
    outgoing: Vec<HalfEdge>,
}

impl ClosedMesh {
    /// Builds the connectivity from faces: corners counter-clockwise seen from outside.
    ///
    /// # Errors
    ///
    /// A [`FormError`] that names an edge if the surface is open, is not a manifold, or has
    /// neighbouring faces with opposite orientations; or one that names the face or vertex if a
    /// face has fewer than three corners, a corner twice, or a vertex that does not exist, or
    /// if a vertex has no face.
    pub fn new(vertices: usize, faces: &[Vec<u32>]) -> Result<Self, FormError> {
        let mut mesh = Self::corners(vertices, faces)?;
        mesh.pair()?;
        mesh.find_outgoing()?;
        Ok(mesh)
    }

    fn corners(vertices: usize, faces: &[Vec<u32>]) -> Result<Self, FormError> {
        let mut mesh = Self {
            vertices,
            face_starts: vec![0],
            origins: Vec::new(),
            faces: Vec::new(),
            twins: Vec::new(),
            edges: Vec::new(),
            edge_sides: Vec::new(),
            outgoing: Vec::new(),
        };
        for (face, corners) in faces.iter().enumerate() {
            let mut sorted = corners.clone();
            sorted.sort_unstable();
            sorted.dedup();
            let exist = sorted.iter().all(|&corner| (corner as usize) < vertices);
            if corners.len() < 3 || sorted.len() != corners.len() || !exist {
                return Err(FormError::Face { face });
            }
            mesh.origins.extend(corners.iter().map(|&v| v as usize));
            mesh.faces.resize(mesh.origins.len(), face);
            mesh.face_starts.push(mesh.origins.len());
        }
        Ok(mesh)
    }

    /// Finds the other side of every half-edge and numbers the edges.
    fn pair(&mut self) -> Result<(), FormError> {
        let count = self.origins.len();
        let mut directed = HashMap::with_capacity(count);
        let mut uses: HashMap<[usize; 2], usize> = HashMap::with_capacity(count);
        for half_edge in 0..count {
            let [from, to] = self.ends(half_edge);
            *uses.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
        for half_edge in 0..count {
            let ends = self.ends(half_edge);
            let edge = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            match uses.get(&edge) {
                Some(1) => return Err(FormError::Open { edge }),
                Some(2) => {}
                _ => return Err(FormError::NonManifold { edge }),
            }
            if directed.insert(ends, half_edge).is_some() {
                return Err(FormError::Orientation { edge });
            }
        }
        self.twins = vec![0; count];
        self.edges = vec![0; count];
        for half_edge in 0..count {
            let [from, to] = self.ends(half_edge);
            let twin = directed[&[to, from]];
            self.twins[half_edge] = twin;
            if half_edge < twin {
                self.edges[half_edge] = self.edge_sides.len();
                self.edges[twin] = self.edge_sides.len();
                self.edge_sides.push(half_edge);
            }
        }
        Ok(())
    }

    /// Chooses a half-edge out of every vertex, and makes sure that turning round it meets them
    /// all.
    fn find_outgoing(&mut self) -> Result<(), FormError> {
        let mut valences = vec![0_usize; self.vertices];
        self.outgoing = vec![usize::MAX; self.vertices];
        for (half_edge, &origin) in self.origins.iter().enumerate() {
            valences[origin] += 1;
            if self.outgoing[origin] == usize::MAX {
                self.outgoing[origin] = half_edge;
            }
        }
        for (vertex, &valence) in valences.iter().enumerate() {
            if valence == 0 {
                return Err(FormError::LoneVertex { vertex });
            }
            if self.valence(vertex) != valence {
                let [from, to] = self.ends(self.outgoing[vertex]);
                let edge = [from.min(to), from.max(to)];
                return Err(FormError::VertexFans { vertex, edge });
            }
        }
        Ok(())
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Number of faces.
    #[must_use]
    pub fn faces(&self) -> usize {
        self.face_starts.len() - 1
    }

    /// Number of edges.
    #[must_use]
    pub fn edges(&self) -> usize {
        self.edge_sides.len()
    }

    /// Number of half-edges, which is that of all faces' corners.
    #[must_use]
    pub fn half_edges(&self) -> usize {
        self.origins.len()
    }

    /// The half-edges of a face, in its order.
    #[must_use]
    pub fn face(&self, face: usize) -> std::ops::Range<HalfEdge> {
        self.face_starts[face]..self.face_starts[face + 1]
    }

    /// The vertices of a face, in its order.
    pub fn face_vertices(&self, face: usize) -> impl Iterator<Item = usize> {
        self.face(face).map(|half_edge| self.origins[half_edge])
    }

    /// The number of corners of the face that a half-edge belongs to.
    #[must_use]
    pub fn sides(&self, half_edge: HalfEdge) -> usize {
        self.face(self.faces[half_edge]).len()
    }

    /// The face that a half-edge belongs to.
    #[must_use]
    pub fn face_of(&self, half_edge: HalfEdge) -> usize {
        self.faces[half_edge]
    }

    /// The edge that a half-edge is a side of.
    #[must_use]
    pub fn edge_of(&self, half_edge: HalfEdge) -> usize {
        self.edges[half_edge]
    }

    /// The side of an edge with the lower number.
    #[must_use]
    pub fn edge_side(&self, edge: usize) -> HalfEdge {
        self.edge_sides[edge]
    }

    /// The vertex that a half-edge leaves.
    #[must_use]
    pub fn origin(&self, half_edge: HalfEdge) -> usize {
        self.origins[half_edge]
    }

    /// The vertex that a half-edge reaches.
    #[must_use]
    pub fn end(&self, half_edge: HalfEdge) -> usize {
        self.origins[self.next(half_edge)]
    }

    /// The half-edge after this one in its face.
    #[must_use]
    pub fn next(&self, half_edge: HalfEdge) -> HalfEdge {
        let face = self.face(self.faces[half_edge]);
        if half_edge + 1 == face.end {
            face.start
        } else {
            half_edge + 1
        }
    }

    /// The half-edge before this one in its face.
    #[must_use]
    pub fn previous(&self, half_edge: HalfEdge) -> HalfEdge {
        let face = self.face(self.faces[half_edge]);
        if half_edge == face.start {
            face.end - 1
        } else {
            half_edge - 1
        }
    }

    /// The other side of the same edge.
    #[must_use]
    pub fn twin(&self, half_edge: HalfEdge) -> HalfEdge {
        self.twins[half_edge]
    }

    /// The next half-edge out of the same vertex, counter-clockwise seen from outside.
    #[must_use]
    pub fn turn(&self, half_edge: HalfEdge) -> HalfEdge {
        self.twin(self.previous(half_edge))
    }

    /// The half-edges out of a vertex, counter-clockwise, from one that is the same each time.
    #[must_use]
    pub fn around(&self, vertex: usize) -> Vec<HalfEdge> {
        self.turned_from(self.outgoing[vertex])
    }

    /// The half-edges out of the vertex that `first` leaves, counter-clockwise from `first`.
    #[must_use]
    pub fn turned_from(&self, first: HalfEdge) -> Vec<HalfEdge> {
        let mut found = vec![first];
        let mut half_edge = self.turn(first);
        while half_edge != first {
            found.push(half_edge);
            half_edge = self.turn(half_edge);
        }
        found
    }

    /// The number of edges at a vertex.
    #[must_use]
    pub fn valence(&self, vertex: usize) -> usize {
        self.around(vertex).len()
    }

    fn ends(&self, half_edge: HalfEdge) -> [usize; 2] {
        [self.origin(half_edge), self.end(half_edge)]
    }
}
