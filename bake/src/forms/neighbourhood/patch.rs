//! The kind of a facet: the faces around it, numbered from the facet outward.

use std::collections::HashMap;

use crate::forms::mesh::{ClosedMesh, HalfEdge};
use crate::surface::SurfaceScheme;

/// The faces around a facet, up to the rings that its limit surface depends on. Equal patches have the
/// same form: a patch is the *kind* of a facet.
///
/// Vertices are numbered outward: the facet's corners counter-clockwise, then, vertex by vertex in this
/// order, the new vertices of the faces round it, counter-clockwise. Of the numberings that begin at one
/// of the facet's corners the one with the least list of faces is taken, so that it does not matter how
/// a mesh lists its faces. The first face is the facet.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Patch {
    /// Number of vertices.
    pub vertices: usize,
    /// The faces, corners counter-clockwise.
    pub faces: Vec<Vec<u32>>,
}

/// A facet of a mesh: its kind, and where that kind's vertices are.
#[derive(Clone, Debug)]
pub struct Neighbourhood {
    /// The kind.
    pub patch: Patch,
    /// The mesh's vertex for each of the patch's.
    pub points: Vec<usize>,
}

/// How many rings of vertices around a facet its kind takes in: what a child's ring of the same number is
/// made from lies within it.
///
/// Loop and Catmull-Clark need one ring. A midpoint of the butterflies reaches two edges far, and so does
/// a double step of square-root-3. Where triangles meet quadrilaterals, a vertex of `tri-quad` depends on
/// the faces at it, whose corners depend on the ends of the edges at which the kinds of faces meet,
/// one ring farther: three rings hold what three rings of a child need. Where all faces at
/// the facet's ring are alike, `tri-quad` moves nothing apart and one ring is enough, for its children
/// too.
fn reach(scheme: SurfaceScheme, mesh: &ClosedMesh, face: usize) -> usize {
    match scheme {
        SurfaceScheme::Loop
        | SurfaceScheme::LoopWarren
        | SurfaceScheme::CatmullClark
        | SurfaceScheme::DooSabin => 1,
        SurfaceScheme::Sqrt3 | SurfaceScheme::Butterfly | SurfaceScheme::ButterflyModified => 2,
        SurfaceScheme::TriQuad => {
            let sides = mesh.face(face).len();
            let around = |vertex: usize| {
                let spokes = mesh.around(vertex).into_iter();
                spokes.map(|spoke| mesh.face_of(spoke)).collect::<Vec<_>>()
            };
            let touching = mesh.face_vertices(face).flat_map(around);
            let ring = touching.flat_map(|face| mesh.face_vertices(face));
            let alike = { ring }.all(|vertex| {
                let spokes = mesh.around(vertex).into_iter();
                { spokes }.all(|spoke| mesh.sides(spoke) == sides)
            });
            if alike { 1 } else { 3 }
        }
    }
}

impl Neighbourhood {
    /// The neighbourhood of a face of a mesh.
    #[must_use]
    pub fn new(scheme: SurfaceScheme, mesh: &ClosedMesh, face: usize) -> Self {
        let reach = reach(scheme, mesh, face);
        let from = mesh.face(face).map(|first| Self::from(mesh, first, reach));
        from.min_by(|a, b| a.patch.cmp(&b.patch))
            .expect("a face has corners")
    }

    /// The same in the numbering that begins with the corner that a half-edge leaves.
    #[must_use]
    pub fn beginning(scheme: SurfaceScheme, mesh: &ClosedMesh, first: HalfEdge) -> Self {
        Self::from(mesh, first, reach(scheme, mesh, mesh.face_of(first)))
    }

    fn from(mesh: &ClosedMesh, first: HalfEdge, reach: usize) -> Self {
        let mut names: HashMap<usize, u32> = HashMap::new();
        // Of each vertex a half-edge that leaves it, and its ring.
        let mut order: Vec<(HalfEdge, usize)> = Vec::new();
        let mut name = |half_edge: HalfEdge, ring: usize, order: &mut Vec<(HalfEdge, usize)>| {
            *names.entry(mesh.origin(half_edge)).or_insert_with(|| {
                order.push((half_edge, ring));
                u32::try_from(order.len() - 1).expect("meshes fit 32-bit indices")
            })
        };
        for corner in walk(mesh, first) {
            name(corner, 0, &mut order);
        }
        let (mut faces, mut listed) = (Vec::new(), Vec::new());
        let mut place = 0;
        while let Some(&(start, ring)) = order.get(place).filter(|(_, ring)| *ring < reach) {
            for spoke in mesh.turned_from(start) {
                let face = mesh.face_of(spoke);
                if !listed.contains(&face) {
                    listed.push(face);
                    let corners = walk(mesh, spoke);
                    let corners = corners.map(|corner| name(corner, ring + 1, &mut order));
                    faces.push(corners.collect());
                }
            }
            place += 1;
        }
        Self {
            patch: Patch {
                vertices: order.len(),
                faces,
            },
            points: order.iter().map(|(start, _)| mesh.origin(*start)).collect(),
        }
    }
}

/// The half-edges of a face, from one of them on.
fn walk(mesh: &ClosedMesh, first: HalfEdge) -> impl Iterator<Item = HalfEdge> {
    let sides = mesh.sides(first);
    std::iter::successors(Some(first), |&half_edge| Some(mesh.next(half_edge))).take(sides)
}

impl Patch {
    /// Corners of the facet.
    #[must_use]
    pub fn corners(&self) -> usize {
        self.faces[0].len()
    }

    /// A closed mesh that begins with the patch: every hole is closed by a collar, of triangles or
    /// quadrilaterals as the facet is one, and a fan of triangles.
    ///
    /// Every vertex of a hole has a vertex of the collar for each time that the hole's border passes it, so
    /// the mesh is closed whatever the patch is.
    #[must_use]
    pub fn closed(&self) -> (usize, Vec<Vec<u32>>) {
        let mut faces = self.faces.clone();
        let mut vertices = u32::try_from(self.vertices).expect("patches are small");
        for hole in self.holes() {
            let length = u32::try_from(hole.len()).expect("patches are small");
            let apex = vertices + length;
            for (own, &[from, to]) in (vertices..).zip(&hole) {
                let next = if own + 1 == apex { vertices } else { own + 1 };
                if self.corners() == 4 {
                    faces.push(vec![to, from, own, next]);
                } else {
                    faces.extend([vec![to, from, own], vec![to, own, next]]);
                }
                faces.push(vec![next, own, apex]);
            }
            vertices = apex + 1;
        }
        (vertices as usize, faces)
    }

    /// The borders, each the directed edges that run along it with the patch on the left, in turn.
    fn holes(&self) -> Vec<Vec<[u32; 2]>> {
        let mut after = HashMap::new();
        let mut edges = Vec::new();
        for face in &self.faces {
            for (place, &from) in face.iter().enumerate() {
                let to = face[(place + 1) % face.len()];
                let beyond = face[(place + 2) % face.len()];
                after.insert([from, to], [to, beyond]);
                edges.push([from, to]);
            }
        }
        let is_border = |[from, to]: &[u32; 2]| !after.contains_key(&[*to, *from]);
        let mut left = edges.iter().copied().filter(is_border).collect::<Vec<_>>();
        let mut holes = Vec::new();
        while let Some(&first) = left.first() {
            let mut hole = Vec::new();
            let mut edge = first;
            while let Some(place) = left.iter().position(|own| *own == edge) {
                hole.push(left.remove(place));
                // Turn about the end, within the patch, to its next edge along the hole.
                edge = after[&edge];
                while let Some(&turned) = after.get(&[edge[1], edge[0]]) {
                    edge = turned;
                }
            }
            holes.push(hole);
        }
        holes
    }
}
