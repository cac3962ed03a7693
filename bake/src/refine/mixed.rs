//! Memory and steps of the mixed scheme.

use super::Level;
use super::level::mesh_error;
use crate::error::{Error, Result};
use crate::mesh::{Cells, Faces};
use octruss::blend::GuardedBlend;
use octruss::mesh::{
    BoundarySizes, MeshError, MixedBoundaryBuffers, MixedNumbering, MixedNumberingBuffers,
    MixedNumberingSizes, QuadDiagonal, QuadFace, Solid, boundary_faces,
};
use octruss::solid::mixed::{
    Boundary, MixedBuffers, PointBuffers, VertexDistortion, VertexState, refine_points, split,
    split_counts,
};
use octruss::solid::tet_oct;
use octruss::surface::LoopWeights;

/// Memory for the numbering of one split.
pub(super) struct MixedMemory {
    edges: Vec<[u32; 2]>,
    quads: Vec<QuadFace>,
    diagonals: Vec<QuadDiagonal>,
    prism_triangles: Vec<[u32; 3]>,
    octahedra: Vec<u32>,
    hexahedra: Vec<u32>,
}

impl MixedMemory {
    pub fn new(solid: &Solid<'_>) -> Result<Self> {
        let sizes =
            MixedNumberingSizes::of(solid).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
        Ok(Self {
            edges: vec![[0; 2]; sizes.edges],
            quads: vec![QuadFace::default(); sizes.quads],
            diagonals: vec![QuadDiagonal::default(); sizes.diagonals],
            prism_triangles: vec![[0; 3]; sizes.prism_triangles],
            octahedra: vec![0; sizes.octahedra],
            hexahedra: vec![0; sizes.hexahedra],
        })
    }

    pub fn number(&mut self, solid: &Solid<'_>) -> Result<MixedNumbering<'_>> {
        let buffers = MixedNumberingBuffers {
            edges: &mut self.edges,
            quads: &mut self.quads,
            diagonals: &mut self.diagonals,
            prism_triangles: &mut self.prism_triangles,
            octahedra: &mut self.octahedra,
            hexahedra: &mut self.hexahedra,
        };
        MixedNumbering::new(solid, buffers).map_err(mesh_error)
    }
}

/// The boundary that core finds.
pub(super) fn boundary_of(solid: &Solid<'_>) -> Result<Faces> {
    let sizes = BoundarySizes::of(solid).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
    let mut triangles = vec![[0; 3]; sizes.triangles];
    let mut quads = vec![[0; 4]; sizes.quads];
    let buffers = MixedBoundaryBuffers {
        triangles: &mut triangles,
        quads: &mut quads,
    };
    let faces = boundary_faces(solid, buffers).map_err(mesh_error)?;
    Ok(Faces {
        triangles: faces.triangles.to_vec(),
        quads: faces.quads.to_vec(),
    })
}

/// What core's mixed scheme calls this rule.
pub(super) fn mixed_boundary(boundary: tet_oct::Boundary) -> Result<Boundary> {
    match boundary {
        tet_oct::Boundary::Surface(LoopWeights::TriQuad) => Ok(Boundary::TriQuad),
        tet_oct::Boundary::Interior => Ok(Boundary::Interior),
        tet_oct::Boundary::Fixed => Ok(Boundary::Fixed),
        tet_oct::Boundary::Surface(_) => Err(Error::new(
            "Loop's scheme has no rule for the quadrilaterals of a mixed solid's boundary",
        )
        .advise("take --boundary tri-quad, interior or fixed")),
    }
}

/// The connectivity of the next level.
pub(super) fn split_level(from: &Level, memory: &mut MixedMemory) -> Result<Level> {
    let solid = from.solid();
    let numbering = memory.number(&solid)?;
    let too_large = || mesh_error(MeshError::TooLarge);
    let counts = split_counts(&solid, &numbering).ok_or_else(too_large)?;
    let boundary = Solid {
        surface: from.boundary(),
        surface_quads: from.boundary_quads(),
        ..solid
    };
    let of_boundary = split_counts(&boundary, &numbering).ok_or_else(too_large)?;
    let mut next = Level {
        vertex_count: numbering.vertex_count(),
        cells: Cells {
            tetrahedra: vec![[0; 4]; counts.tetrahedra],
            octahedra: vec![[0; 6]; counts.octahedra],
            prisms: vec![[0; 6]; counts.prisms],
            hexahedra: vec![[0; 8]; counts.hexahedra],
        },
        surface: vec![[0; 3]; counts.surface],
        boundary_count: of_boundary.surface,
        crease_face_count: 4 * from.crease_face_count,
        surface_quads: vec![[0; 4]; counts.surface_quads],
        boundary_quad_count: of_boundary.surface_quads,
        creases: vec![[0; 2]; counts.creases],
        corners: vec![0; counts.corners],
        interior: from.interior.clone(),
    };
    let buffers = MixedBuffers {
        tetrahedra: &mut next.cells.tetrahedra,
        octahedra: &mut next.cells.octahedra,
        prisms: &mut next.cells.prisms,
        hexahedra: &mut next.cells.hexahedra,
        surface: &mut next.surface,
        surface_quads: &mut next.surface_quads,
        creases: &mut next.creases,
        corners: &mut next.corners,
    };
    split(&solid, &numbering, buffers).map_err(mesh_error)?;
    // Core puts the quadrilaterals of open halves last. All are on the boundary (a triangle of a
    // crease surface is a cell's, so it covers a half, and a sheet's lies on no face), and the
    // boundary comes first here.
    let of_quads = 4 * from.boundary_quad_count;
    let open = of_boundary.surface_quads - of_quads;
    next.surface_quads[of_quads..].rotate_right(open);
    Ok(next)
}

/// The values at the next level's vertices.
pub(super) fn values<B: GuardedBlend>(
    from: &Level,
    memory: &mut MixedMemory,
    boundary: tet_oct::Boundary,
    blend: &mut B,
    values: &[B::Point],
) -> Result<Vec<B::Point>> {
    let mut solid = from.solid();
    let mut boundary = mixed_boundary(boundary)?;
    // The numbering is of the whole surface, whichever part of it has a rule.
    let numbering = memory.number(&solid)?;
    let inside_and_sheets = &from.surface[from.boundary_count..];
    let has_others = !inside_and_sheets.is_empty() || !from.crease_quads().is_empty();
    if boundary == Boundary::Interior && has_others {
        // The boundary has no rule of its own, crease surfaces and sheets keep theirs.
        solid.surface = inside_and_sheets;
        solid.surface_quads = from.crease_quads();
        boundary = Boundary::TriQuad;
    }
    let length = numbering.vertex_count() as usize;
    let zero = blend.zero();
    let mut out = vec![blend.divide(&zero, 1); length];
    let buffers = PointBuffers {
        out: &mut out,
        sums: &mut vec![blend.guarded_zero(); length],
        states: &mut vec![VertexState::default(); length],
        distortions: &mut vec![VertexDistortion::new(&zero); from.vertex_count as usize],
    };
    refine_points(blend, &solid, &numbering, boundary, values, buffers).map_err(mesh_error)?;
    Ok(out)
}
