//! The crate under test on the host, over any value type, with buffers that are exactly as long as
//! it says it needs.

use octruss::blend::{Blend, FixedBlend, GuardedBlend};
use octruss::mesh::{
    ControlMesh, ControlMeshBuffers, FaceOrder, Fans, MeshError, Side, SurfaceEdges,
};
use octruss::surface::limit_normals::{
    NormalBuffers, TangentBlend, TangentMasks, face_normals, limit_normals,
};
use octruss::surface::{
    LoopWeights, PointBuffers, Rim, SurfaceCounts, VertexState, butterfly, catmull_clark,
    doo_sabin, loop_scheme, sqrt3, tri_quad,
};

use crate::reference_surface::{Border, Family, Polygons};

/// The lists that a [`ControlMesh`] views.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lists {
    vertex_count: u32,
    offsets: Vec<u32>,
    indices: Vec<u32>,
    creases: Vec<[u32; 2]>,
    corners: Vec<u32>,
    odd: bool,
}

impl Lists {
    /// The lists of a mesh.
    pub fn of(mesh: &Polygons) -> Self {
        let mut lists = Self {
            vertex_count: mesh.vertex_count,
            offsets: vec![0],
            creases: mesh.creases.clone(),
            corners: mesh.corners.clone(),
            odd: mesh.odd,
            ..Self::default()
        };
        for face in &mesh.faces {
            lists.indices.extend(face);
            lists.offsets.push(lists.indices.len() as u32);
        }
        lists
    }

    fn of_counts(counts: &SurfaceCounts) -> Self {
        Self {
            offsets: vec![0; counts.faces + 1],
            indices: vec![0; counts.indices],
            creases: vec![[0; 2]; counts.creases],
            corners: vec![0; counts.corners],
            ..Self::default()
        }
    }

    fn buffers(&mut self) -> ControlMeshBuffers<'_> {
        ControlMeshBuffers {
            offsets: &mut self.offsets,
            indices: &mut self.indices,
            creases: &mut self.creases,
            corners: &mut self.corners,
        }
    }

    /// The view.
    pub fn mesh(&self) -> ControlMesh<'_> {
        ControlMesh {
            vertex_count: self.vertex_count,
            offsets: &self.offsets,
            indices: &self.indices,
            creases: &self.creases,
            corners: &self.corners,
            odd: self.odd,
        }
    }
}

/// A view as polygons.
pub fn polygons(mesh: &ControlMesh<'_>) -> Polygons {
    Polygons {
        vertex_count: mesh.vertex_count,
        faces: mesh.faces().map(<[u32]>::to_vec).collect(),
        creases: mesh.creases.to_vec(),
        corners: mesh.corners.to_vec(),
        odd: mesh.odd,
    }
}

/// The scheme to drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// Catmull and Clark's.
    CatmullClark,
    /// Loop's with a weight family.
    Loop(Family),
    /// Kobbelt's square-root-3 scheme.
    Sqrt3,
    /// Doo and Sabin's.
    DooSabin,
    /// The butterfly of 1990, or the modified one.
    Butterfly {
        /// The stencils of 1996 at vertices of valence other than 6.
        modified: bool,
    },
}

/// The crate's name for a rim.
pub fn rim(border: Border) -> Rim {
    match border {
        Border::Spline => Rim::Spline,
        Border::SplineWithCorners => Rim::SplineWithCorners,
        Border::Fixed => Rim::Fixed,
    }
}

/// The crate's name for a weight family.
pub fn weights(family: Family) -> LoopWeights {
    match family {
        Family::Loop => LoopWeights::Loop,
        Family::Warren => LoopWeights::Warren,
        Family::TriQuad => LoopWeights::TriQuad,
    }
}

/// Scratch and output for `count` vertices.
struct Memory<B: Blend> {
    out: Vec<B::Point>,
    sums: Vec<B::Sum>,
    states: Vec<VertexState>,
}

impl<B: Blend> Memory<B> {
    fn new(blend: &mut B, count: usize) -> Self {
        let zero = blend.zero();
        Self {
            out: vec![blend.divide(&zero, 1); count],
            sums: vec![zero; count],
            states: vec![VertexState::default(); count],
        }
    }

    fn buffers(&mut self) -> PointBuffers<'_, B> {
        PointBuffers {
            out: &mut self.out,
            sums: &mut self.sums,
            states: &mut self.states,
        }
    }
}

/// Memory for the numbering of a square-root-3 step.
#[derive(Default)]
struct Sqrt3Memory {
    states: Vec<VertexState>,
    edge_vertices: Vec<u32>,
    face_vertices: Vec<u32>,
}

impl Sqrt3Memory {
    fn new(mesh: &ControlMesh<'_>, edges: &SurfaceEdges<'_>) -> Self {
        let edge_count = edges.count() as usize;
        Self {
            states: vec![VertexState::default(); mesh.vertex_count as usize + edge_count],
            edge_vertices: vec![0; edge_count],
            face_vertices: vec![0; mesh.face_count()],
        }
    }

    fn buffers(&mut self) -> sqrt3::NumberingBuffers<'_> {
        sqrt3::NumberingBuffers {
            states: &mut self.states,
            edge_vertices: &mut self.edge_vertices,
            face_vertices: &mut self.face_vertices,
        }
    }
}

/// One level of any value type.
pub fn refine<B: Blend>(
    blend: &mut B,
    scheme: Scheme,
    border: Border,
    mesh: &Polygons,
    points: &[B::Point],
) -> Result<(Polygons, Vec<B::Point>), MeshError> {
    let lists = Lists::of(mesh);
    let mesh = lists.mesh();
    let mut sides = vec![Side::default(); mesh.indices.len()];
    let edges = SurfaceEdges::new(&mesh, &mut sides)?;
    let mut order = vec![0; mesh.face_count()];
    let order = FaceOrder::new(&mesh, &mut order)?;
    let rim = rim(border);
    match scheme {
        Scheme::CatmullClark => {
            let counts = catmull_clark::split_counts(&mesh, &edges);
            let mut refined = Lists::of_counts(&counts.ok_or(MeshError::TooLarge)?);
            let next = catmull_clark::split(&mesh, &edges, &order, refined.buffers())?;
            let mut memory = Memory::new(blend, next.vertex_count as usize);
            let buffers = memory.buffers();
            catmull_clark::refine_points(blend, &mesh, &edges, &order, rim, points, buffers)?;
            Ok((polygons(&next), memory.out))
        }
        Scheme::Loop(family) => {
            let counts = loop_scheme::split_counts(&mesh, &edges);
            let mut refined = Lists::of_counts(&counts.ok_or(MeshError::TooLarge)?);
            let next = loop_scheme::split(&mesh, &edges, refined.buffers())?;
            let mut memory = Memory::new(blend, next.vertex_count as usize);
            let (weights, buffers) = (weights(family), memory.buffers());
            loop_scheme::refine_points(blend, &mesh, &edges, weights, rim, points, buffers)?;
            Ok((polygons(&next), memory.out))
        }
        Scheme::Sqrt3 => {
            let mut numbers = Sqrt3Memory::new(&mesh, &edges);
            let numbering = sqrt3::Numbering::new(&mesh, edges, &order, numbers.buffers())?;
            let counts = sqrt3::split_counts(&mesh, &numbering);
            let mut refined = Lists::of_counts(&counts.ok_or(MeshError::TooLarge)?);
            let next = sqrt3::split(&mesh, &numbering, refined.buffers())?;
            let mut memory = Memory::new(blend, next.vertex_count as usize);
            sqrt3::refine_points(blend, &mesh, &numbering, points, memory.buffers())?;
            Ok((polygons(&next), memory.out))
        }
        Scheme::DooSabin => {
            let mut starts = vec![0; mesh.vertex_count as usize];
            let fans = Fans::new(mesh, edges, &mut starts)?;
            let counts = doo_sabin::split_counts(&fans).ok_or(MeshError::TooLarge)?;
            let mut refined = Lists::of_counts(&counts);
            let next = doo_sabin::split(&fans, refined.buffers())?;
            let mut memory = Memory::new(blend, next.vertex_count as usize);
            let Memory { out, sums, .. } = &mut memory;
            doo_sabin::refine_points(blend, &mesh, points, out, sums)?;
            Ok((polygons(&next), memory.out))
        }
        Scheme::Butterfly { modified } => {
            let counts = butterfly::split_counts(&mesh, &edges);
            let mut refined = Lists::of_counts(&counts.ok_or(MeshError::TooLarge)?);
            let next = butterfly::split(&mesh, &edges, refined.buffers())?;
            let mut memory = Memory::new(blend, next.vertex_count as usize);
            let variant = if modified {
                butterfly::Variant::Modified
            } else {
                butterfly::Variant::Original
            };
            let buffers = memory.buffers();
            butterfly::refine_points(blend, &mesh, &edges, variant, rim, points, buffers)?;
            Ok((polygons(&next), memory.out))
        }
    }
}

/// One level of the scheme of triangles and quads, of any value type.
pub fn refine_tri_quad<B: GuardedBlend>(
    blend: &mut B,
    border: Border,
    mesh: &Polygons,
    points: &[B::Point],
) -> Result<(Polygons, Vec<B::Point>), MeshError> {
    let lists = Lists::of(mesh);
    let mesh = lists.mesh();
    let mut sides = vec![Side::default(); mesh.indices.len()];
    let edges = SurfaceEdges::new(&mesh, &mut sides)?;
    let mut order = vec![0; mesh.face_count()];
    let order = FaceOrder::new(&mesh, &mut order)?;
    let counts = tri_quad::split_counts(&mesh, &edges).ok_or(MeshError::TooLarge)?;
    let mut refined = Lists::of_counts(&counts);
    let next = tri_quad::split(&mesh, &edges, &order, refined.buffers())?;
    let zero = blend.zero();
    let mut out = vec![blend.divide(&zero, 1); counts.vertices];
    let buffers = tri_quad::PointBuffers {
        out: &mut out,
        sums: &mut vec![blend.guarded_zero(); counts.vertices],
        states: &mut vec![VertexState::default(); counts.vertices],
        distortions: &mut vec![tri_quad::VertexDistortion::new(zero); points.len()],
    };
    tri_quad::refine_points(blend, &mesh, &edges, &order, rim(border), points, buffers)?;
    Ok((polygons(&next), out))
}

/// One level in raw bits; saturated coordinates are clamped.
pub fn refine_bits(
    scheme: Scheme,
    border: Border,
    mesh: &Polygons,
    points: &[[i32; 3]],
) -> Result<(Polygons, Vec<[i32; 3]>), MeshError> {
    refine(
        &mut FixedBlend::<i32, 3>::new(),
        scheme,
        border,
        mesh,
        points,
    )
}

/// Limit positions of any value type: of vertices, for Doo-Sabin of faces.
pub fn limit<B: Blend>(
    blend: &mut B,
    scheme: Scheme,
    border: Border,
    mesh: &Polygons,
    points: &[B::Point],
) -> Result<Vec<B::Point>, MeshError> {
    let lists = Lists::of(mesh);
    let mesh = lists.mesh();
    let mut sides = vec![Side::default(); mesh.indices.len()];
    let edges = SurfaceEdges::new(&mesh, &mut sides)?;
    let rim = rim(border);
    let count = mesh.vertex_count as usize + edges.count() as usize;
    let mut memory = Memory::new(blend, count);
    let buffers = memory.buffers();
    let limit = match scheme {
        Scheme::DooSabin => {
            let mut out = memory.out[..1].to_vec();
            out.resize(mesh.face_count(), memory.out[0].clone());
            return doo_sabin::limit_points(blend, &mesh, points, &mut out)
                .map(|limit| limit.to_vec());
        }
        // It goes through all vertices.
        Scheme::Butterfly { .. } => return Ok(points.to_vec()),
        Scheme::CatmullClark => {
            catmull_clark::limit_points(blend, &mesh, &edges, rim, points, buffers)?
        }
        Scheme::Loop(family) => {
            let weights = weights(family);
            loop_scheme::limit_points(blend, &mesh, &edges, weights, rim, points, buffers)?
        }
        Scheme::Sqrt3 => {
            let mut order = vec![0; mesh.face_count()];
            let order = FaceOrder::new(&mesh, &mut order)?;
            let mut numbers = Sqrt3Memory::new(&mesh, &edges);
            let numbering = sqrt3::Numbering::new(&mesh, edges, &order, numbers.buffers())?;
            return sqrt3::limit_points(blend, &mesh, &numbering, points, buffers)
                .map(|limit| limit.to_vec());
        }
    };
    Ok(limit.to_vec())
}

/// Limit normals: of every corner of every face, for Doo-Sabin of every face.
pub fn normals<T: TangentBlend>(
    blend: &mut T,
    scheme: Scheme,
    border: Border,
    mesh: &Polygons,
    points: &[T::Point],
) -> Result<Vec<T::Normal>, MeshError> {
    let lists = Lists::of(mesh);
    let mesh = lists.mesh();
    let mut out = vec![blend.no_normal(); mesh.indices.len()];
    let masks = match scheme {
        Scheme::DooSabin => {
            out.truncate(mesh.face_count());
            return face_normals(blend, &mesh, points, &mut out).map(|normals| normals.to_vec());
        }
        Scheme::CatmullClark => TangentMasks::CatmullClark,
        _ => TangentMasks::Loop,
    };
    let mut sides = vec![Side::default(); mesh.indices.len()];
    let edges = SurfaceEdges::new(&mesh, &mut sides)?;
    let count = mesh.vertex_count as usize + edges.count() as usize;
    let buffers = NormalBuffers {
        out: &mut out,
        done: &mut vec![true; mesh.indices.len()],
        states: &mut vec![VertexState::default(); count],
    };
    let rim = rim(border);
    limit_normals(blend, &mesh, &edges, masks, rim, points, buffers).map(|normals| normals.to_vec())
}

/// An adaptive mesh with memory on the host.
pub struct AdaptiveMemory<P> {
    triangles: Vec<sqrt3::adaptive::AdaptiveTriangle>,
    vertices: Vec<sqrt3::adaptive::AdaptiveVertex>,
    positions: Vec<P>,
    rings: Vec<P>,
    ring_scratch: Vec<P>,
}

impl<P: Clone> AdaptiveMemory<P> {
    /// Memory for this many triangles and vertices.
    pub fn new(triangles: usize, vertices: usize, rings: usize, nothing: P) -> Self {
        Self {
            triangles: vec![sqrt3::adaptive::AdaptiveTriangle::default(); triangles],
            vertices: vec![sqrt3::adaptive::AdaptiveVertex::default(); vertices],
            positions: vec![nothing.clone(); vertices],
            rings: vec![nothing.clone(); rings],
            ring_scratch: vec![nothing; 64],
        }
    }

    /// Starts an adaptive mesh in this memory.
    pub fn start<B: Blend<Point = P>>(
        &mut self,
        mesh: &Polygons,
        points: &[P],
    ) -> Result<sqrt3::adaptive::AdaptiveMesh<'_, B>, MeshError> {
        let lists = Lists::of(mesh);
        let mesh = lists.mesh();
        let mut sides = vec![Side::default(); mesh.indices.len()];
        let edges = SurfaceEdges::new(&mesh, &mut sides)?;
        let memory = sqrt3::adaptive::AdaptiveBuffers {
            triangles: &mut self.triangles,
            vertices: &mut self.vertices,
            positions: &mut self.positions,
            rings: &mut self.rings,
            ring_scratch: &mut self.ring_scratch,
        };
        sqrt3::adaptive::AdaptiveMesh::new(&mesh, &edges, points, memory)
    }
}
