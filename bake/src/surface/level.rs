//! One level of a surface in memory, and the step to the next.

use super::{RimRule, SurfaceMesh, SurfaceScheme};
use crate::error::{Error, Result};
use octruss::blend::{Blend, GuardedBlend};
use octruss::mesh::{
    ControlMesh, ControlMeshBuffers, FaceOrder, Fans, MeshError, Part, Side, SurfaceEdges,
};
use octruss::surface::butterfly::Variant;
use octruss::surface::limit_normals::{
    NormalBuffers, TangentBlend, TangentMasks, face_normals, limit_normals,
};
use octruss::surface::{
    PointBuffers, Rim, SurfaceCounts, VertexState, butterfly, catmull_clark, doo_sabin,
    loop_scheme, sqrt3, tri_quad,
};

/// Connectivity of a surface at one level, owned.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SurfaceLevel {
    /// Number of vertices.
    pub vertex_count: u32,
    offsets: Vec<u32>,
    indices: Vec<u32>,
    /// Crease edges.
    pub creases: Vec<[u32; 2]>,
    /// Corners.
    pub corners: Vec<u32>,
    odd: bool,
}

impl SurfaceLevel {
    /// The control mesh as it stands in its file, checked.
    ///
    /// # Errors
    /// If an index is out of range, a face names a vertex twice, or a crease is no edge.
    pub fn new(mesh: &SurfaceMesh) -> Result<Self> {
        let fits = |count: usize| u32::try_from(count).map_err(|_| complaint(MeshError::TooLarge));
        let mut level = Self {
            vertex_count: fits(mesh.points.len())?,
            offsets: vec![0],
            creases: mesh.features.creases.clone(),
            corners: mesh.features.corners.clone(),
            ..Self::default()
        };
        for face in &mesh.faces {
            level.indices.extend(face);
            level.offsets.push(fits(level.indices.len())?);
        }
        let view = level.mesh();
        SurfaceEdges::new(&view, &mut vec![Side::default(); view.indices.len()])
            .map_err(complaint)?;
        Ok(level)
    }

    /// The view that core takes.
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

    /// The corners of every face.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        self.mesh().faces()
    }

    /// The mesh with a vertex for each face and a face for each vertex that faces go all round, in their order.
    #[must_use]
    pub fn dual(&self) -> Self {
        let mut next_face = std::collections::HashMap::new();
        let mut first = vec![None; self.vertex_count as usize];
        for (number, face) in (0_u32..).zip(self.faces()) {
            let befores = face.iter().cycle().skip(face.len() - 1);
            let afters = face.iter().cycle().skip(1);
            for ((&vertex, &before), &after) in face.iter().zip(befores).zip(afters) {
                // Entering over the edge to `after`, counter-clockwise.
                next_face.insert((vertex, after), (number, before));
                first[vertex as usize].get_or_insert((number, after));
            }
        }
        let mut dual = Self {
            vertex_count: u32::try_from(self.mesh().face_count()).unwrap_or(u32::MAX),
            offsets: vec![0],
            ..Self::default()
        };
        for (vertex, start) in (0_u32..).zip(first) {
            let Some((_, start)) = start else { continue };
            let mut round = Vec::new();
            let mut over = start;
            while let Some(&(face, before)) = next_face.get(&(vertex, over)) {
                round.push(face);
                over = before;
                if over == start {
                    break;
                }
            }
            // A face of fewer corners has no area; two faces all round leave such.
            if over == start && round.len() >= 3 {
                dual.indices.extend(round);
                dual.offsets.push(dual.indices.len() as u32);
            }
        }
        dual
    }

    fn with_counts(counts: &SurfaceCounts) -> Self {
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
}

/// Scratch of a step.
struct Memory {
    sides: Vec<Side>,
    order: Vec<u32>,
    states: Vec<VertexState>,
    edge_vertices: Vec<u32>,
    face_vertices: Vec<u32>,
    fan_starts: Vec<u32>,
}

impl Memory {
    fn new(mesh: &ControlMesh<'_>) -> Self {
        let (vertices, sides) = (mesh.vertex_count as usize, mesh.indices.len());
        Self {
            sides: vec![Side::default(); sides],
            order: vec![0; mesh.face_count()],
            // There are at most as many edges as sides.
            states: vec![VertexState::default(); vertices + sides],
            edge_vertices: vec![0; sides],
            face_vertices: vec![0; mesh.face_count()],
            fan_starts: vec![0; vertices],
        }
    }
}

/// What core numbers for a step of a scheme.
enum Numbers<'a> {
    Edges(SurfaceEdges<'a>, FaceOrder<'a>),
    Fans(Fans<'a>),
    Sqrt3(sqrt3::Numbering<'a>),
}

/// A step from one level to the next: any values may be taken along it.
pub struct SurfaceStep<'a> {
    from: ControlMesh<'a>,
    scheme: SurfaceScheme,
    rim: RimRule,
    memory: Memory,
}

impl<'a> SurfaceStep<'a> {
    /// Prepares the step from `from`.
    pub fn new(from: &'a SurfaceLevel, scheme: SurfaceScheme, rim: RimRule) -> Self {
        let from = from.mesh();
        Self {
            from,
            scheme,
            rim,
            memory: Memory::new(&from),
        }
    }

    fn numbers(&mut self) -> std::result::Result<Numbers<'_>, MeshError> {
        let memory = &mut self.memory;
        let edges = SurfaceEdges::new(&self.from, &mut memory.sides)?;
        if self.scheme == SurfaceScheme::DooSabin {
            let fans = Fans::new(self.from, edges, &mut memory.fan_starts)?;
            return Ok(Numbers::Fans(fans));
        }
        let order = FaceOrder::new(&self.from, &mut memory.order)?;
        if self.scheme != SurfaceScheme::Sqrt3 {
            return Ok(Numbers::Edges(edges, order));
        }
        let buffers = sqrt3::NumberingBuffers {
            states: &mut memory.states,
            edge_vertices: &mut memory.edge_vertices,
            face_vertices: &mut memory.face_vertices,
        };
        sqrt3::Numbering::new(&self.from, edges, &order, buffers).map(Numbers::Sqrt3)
    }

    /// The connectivity of the next level.
    ///
    /// # Errors
    /// If the scheme does not take the mesh.
    pub fn split(&mut self) -> Result<SurfaceLevel> {
        let (mesh, scheme) = (self.from, self.scheme);
        let numbers = self.numbers().map_err(complaint)?;
        let counts = match &numbers {
            Numbers::Edges(edges, _) if scheme == SurfaceScheme::CatmullClark => {
                catmull_clark::split_counts(&mesh, edges)
            }
            Numbers::Edges(edges, _) if scheme == SurfaceScheme::TriQuad => {
                tri_quad::split_counts(&mesh, edges)
            }
            Numbers::Edges(edges, _) => loop_scheme::split_counts(&mesh, edges),
            Numbers::Fans(fans) => doo_sabin::split_counts(fans),
            Numbers::Sqrt3(numbering) => sqrt3::split_counts(&mesh, numbering),
        };
        let counts = counts.ok_or_else(|| complaint(MeshError::TooLarge))?;
        let mut next = SurfaceLevel::with_counts(&counts);
        let view = match &numbers {
            Numbers::Edges(edges, order) if scheme == SurfaceScheme::CatmullClark => {
                catmull_clark::split(&mesh, edges, order, next.buffers())
            }
            Numbers::Edges(edges, order) if scheme == SurfaceScheme::TriQuad => {
                tri_quad::split(&mesh, edges, order, next.buffers())
            }
            Numbers::Edges(edges, _) => loop_scheme::split(&mesh, edges, next.buffers()),
            Numbers::Fans(fans) => doo_sabin::split(fans, next.buffers()),
            Numbers::Sqrt3(numbering) => sqrt3::split(&mesh, numbering, next.buffers()),
        };
        let view = view.map_err(complaint)?;
        let (vertex_count, odd) = (view.vertex_count, view.odd);
        Ok(SurfaceLevel {
            vertex_count,
            odd,
            ..next
        })
    }

    /// The values at the next level's vertices.
    ///
    /// # Errors
    /// If the scheme does not take the mesh.
    pub fn values<B: GuardedBlend>(
        &mut self,
        blend: &mut B,
        values: &[B::Point],
    ) -> Result<Vec<B::Point>> {
        let (mesh, scheme, rim) = (self.from, self.scheme, self.rim.to_core());
        let numbers = self.numbers().map_err(complaint)?;
        if let (SurfaceScheme::TriQuad, Numbers::Edges(edges, order)) = (scheme, &numbers) {
            return tri_quad_values(blend, &mesh, edges, order, rim, values).map_err(complaint);
        }
        let length = match &numbers {
            Numbers::Edges(edges, _) if scheme == SurfaceScheme::CatmullClark => {
                mesh.vertex_count as usize + edges.count() as usize + mesh.face_count()
            }
            Numbers::Edges(edges, _) => mesh.vertex_count as usize + edges.count() as usize,
            Numbers::Fans(_) => mesh.indices.len(),
            Numbers::Sqrt3(numbering) => numbering.vertex_count() as usize,
        };
        let mut buffers = Buffers::new(blend, length);
        let lent = buffers.lend();
        match &numbers {
            Numbers::Fans(_) => doo_sabin::refine_points(blend, &mesh, values, lent.out, lent.sums),
            Numbers::Sqrt3(numbering) => {
                sqrt3::refine_points(blend, &mesh, numbering, values, lent)
            }
            Numbers::Edges(edges, order) => match scheme.loop_weights() {
                Some(weights) => {
                    loop_scheme::refine_points(blend, &mesh, edges, weights, rim, values, lent)
                }
                None if scheme == SurfaceScheme::CatmullClark => {
                    catmull_clark::refine_points(blend, &mesh, edges, order, rim, values, lent)
                }
                None => {
                    let variant = match scheme {
                        SurfaceScheme::ButterflyModified => Variant::Modified,
                        _ => Variant::Original,
                    };
                    butterfly::refine_points(blend, &mesh, edges, variant, rim, values, lent)
                }
            },
        }
        .map_err(complaint)?;
        Ok(buffers.out)
    }

    /// Limit normals from the values of this level's vertices: one for each corner of each face, face by face, of
    /// Doo-Sabin surfaces one for each face. None of schemes that have no masks of tangents: square-root-3, the
    /// butterflies and `tri-quad`.
    ///
    /// # Errors
    /// If the scheme has no masks of tangents on the mesh.
    pub fn normals<T: TangentBlend>(
        &mut self,
        blend: &mut T,
        values: &[T::Point],
    ) -> Result<Option<Vec<T::Normal>>> {
        let mesh = self.from;
        let masks = match self.scheme {
            SurfaceScheme::CatmullClark => TangentMasks::CatmullClark,
            SurfaceScheme::DooSabin => {
                let mut out = vec![blend.no_normal(); mesh.face_count()];
                face_normals(blend, &mesh, values, &mut out).map_err(complaint)?;
                return Ok(Some(out));
            }
            scheme if scheme.loop_weights().is_some() => TangentMasks::Loop,
            _ => return Ok(None),
        };
        let memory = &mut self.memory;
        let edges = SurfaceEdges::new(&mesh, &mut memory.sides).map_err(complaint)?;
        let mut out = vec![blend.no_normal(); mesh.indices.len()];
        let buffers = NormalBuffers {
            out: &mut out,
            done: &mut vec![false; mesh.indices.len()],
            states: &mut memory.states,
        };
        let rim = self.rim.to_core();
        limit_normals(blend, &mesh, &edges, masks, rim, values, buffers).map_err(complaint)?;
        Ok(Some(out))
    }

    /// The values in the limit at this level's faces, for Doo-Sabin surfaces.
    ///
    /// # Errors
    /// If the scheme does not take the mesh.
    pub fn face_limit<B: Blend>(
        &mut self,
        blend: &mut B,
        values: &[B::Point],
    ) -> Result<Vec<B::Point>> {
        // Refuses what no level could be made of.
        self.numbers().map_err(complaint)?;
        let mut buffers = Buffers::new(blend, self.from.face_count());
        let out = &mut buffers.out;
        doo_sabin::limit_points(blend, &self.from, values, out).map_err(complaint)?;
        Ok(buffers.out)
    }

    /// The values in the limit at this level's vertices.
    ///
    /// # Errors
    /// If the scheme does not take the mesh, or has no limit mask on it; Doo-Sabin's limit points
    /// belong to faces, not to vertices (see [`SurfaceStep::face_limit`]), and `tri-quad` has no limit masks.
    pub fn limit<B: Blend>(&mut self, blend: &mut B, values: &[B::Point]) -> Result<Vec<B::Point>> {
        let (mesh, scheme, rim) = (self.from, self.scheme, self.rim.to_core());
        if scheme == SurfaceScheme::TriQuad {
            return Err(Error::new(
                "surfaces of triangles and quads together (tri-quad) have no limit masks",
            )
            .advise("leave --limit out and take a level more, or take catmull-clark or loop"));
        }
        let numbers = self.numbers().map_err(complaint)?;
        let vertices = mesh.vertex_count as usize;
        let mut buffers = Buffers::new(blend, vertices + mesh.indices.len());
        let lent = buffers.lend();
        match &numbers {
            Numbers::Fans(_) => {
                return Err(Error::new(
                    "Doo-Sabin surfaces have limit points at their faces' centres, not at vertices",
                )
                .advise("leave --limit out, take catmull-clark, or refine it with --limit"));
            }
            Numbers::Sqrt3(numbering) => {
                sqrt3::limit_points(blend, &mesh, numbering, values, lent).map_err(complaint)?;
            }
            Numbers::Edges(edges, _) => match scheme.loop_weights() {
                Some(weights) => {
                    loop_scheme::limit_points(blend, &mesh, edges, weights, rim, values, lent)
                        .map_err(complaint)?;
                }
                None if scheme == SurfaceScheme::CatmullClark => {
                    catmull_clark::limit_points(blend, &mesh, edges, rim, values, lent)
                        .map_err(complaint)?;
                }
                // A butterfly surface goes through all its vertices.
                None => return Ok(values.to_vec()),
            },
        }
        buffers.out.truncate(vertices);
        Ok(buffers.out)
    }
}

/// The values at the next level's vertices of the scheme of triangles and quads, whose sums have
/// guard bits.
fn tri_quad_values<B: GuardedBlend>(
    blend: &mut B,
    mesh: &ControlMesh<'_>,
    edges: &SurfaceEdges<'_>,
    order: &FaceOrder<'_>,
    rim: Rim,
    values: &[B::Point],
) -> std::result::Result<Vec<B::Point>, MeshError> {
    let counts = tri_quad::split_counts(mesh, edges).ok_or(MeshError::TooLarge)?;
    let (zero, vertices) = (blend.zero(), counts.vertices);
    let mut out = vec![blend.divide(&zero, 1); vertices];
    let buffers = tri_quad::PointBuffers {
        out: &mut out,
        sums: &mut vec![blend.guarded_zero(); vertices],
        states: &mut vec![VertexState::default(); vertices],
        distortions: &mut vec![tri_quad::VertexDistortion::new(zero); mesh.vertex_count as usize],
    };
    tri_quad::refine_points(blend, mesh, edges, order, rim, values, buffers)?;
    Ok(out)
}

/// Output and scratch of a step.
struct Buffers<B: Blend> {
    out: Vec<B::Point>,
    sums: Vec<B::Sum>,
    states: Vec<VertexState>,
}

impl<B: Blend> Buffers<B> {
    fn new(blend: &mut B, length: usize) -> Self {
        let zero = blend.zero();
        Self {
            out: vec![blend.divide(&zero, 1); length],
            sums: vec![zero; length],
            states: vec![VertexState::default(); length],
        }
    }

    fn lend(&mut self) -> PointBuffers<'_, B> {
        PointBuffers {
            out: &mut self.out,
            sums: &mut self.sums,
            states: &mut self.states,
        }
    }
}

/// Core's complaint about a control mesh in the words of a file's user.
fn complaint(error: MeshError) -> Error {
    match error {
        MeshError::NotAnEdge {
            part: Part::Crease,
            edge: [a, b],
            ..
        } => Error::new(format!(
            "the crease from vertex {a} to vertex {b} (counted from 0) is no edge of a face"
        ))
        .advise("a crease runs along edges of the control mesh"),
        MeshError::TooLarge => Error::new("the refined mesh needs more than 2^32 - 1 vertices")
            .advise("take fewer levels"),
        other => {
            // Core's sentences end in the advice, after a colon.
            let text = other.to_string();
            match text.split_once(": ") {
                Some((what, advice)) => {
                    Error::new(format!("{what} (counted from 0)")).advise(advice)
                }
                None => Error::new(format!("{text} (counted from 0)")),
            }
        }
    }
}
