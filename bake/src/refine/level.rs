//! One level of a solid in memory, and the step to the next.

use super::{DiagonalLists, Interior, RealBlend, Scheme};
use crate::error::{Error, Result};
use crate::mesh::{Cells, Point, SolidMesh, Vertex};
use octruss::blend::{Blend, FixedBlend};
use octruss::mesh::{
    Counts, MeshError, Numbering, Part, Solid, SolidBuffers, boundary_triangles, edge_capacity,
    face_capacity,
};
use octruss::solid::box_spline::{self, Neighbours, neighbour_capacity};
use octruss::solid::tet_oct::{
    Boundary, PointBuffers, VertexState, refine_points, split, split_counts,
};
use octruss::surface::LoopWeights;
use std::collections::{BTreeMap, HashSet};

/// Connectivity of a solid at one level of refinement, owned.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Level {
    /// Number of vertices.
    pub vertex_count: u32,
    /// The cells.
    pub cells: Cells,
    /// Boundary triangles, counter-clockwise from outside; behind them those of crease surfaces
    /// inside, and last those of sheets.
    pub surface: Vec<[u32; 3]>,
    /// How many triangles of `surface` are on the boundary.
    pub boundary_count: usize,
    /// How many triangles behind those are of crease surfaces.
    pub crease_face_count: usize,
    /// Crease edges.
    pub creases: Vec<[u32; 2]>,
    /// Corners.
    pub corners: Vec<u32>,
    /// What the interior follows.
    pub interior: Interior,
}

impl Level {
    /// The solid as it stands in its file, with its boundary found, for a scheme. Box splines
    /// take the diagonals that are given, or choose them.
    pub fn of_scheme(
        mesh: &SolidMesh,
        scheme: Scheme,
        diagonals: Option<&DiagonalLists>,
    ) -> Result<Self> {
        let mut level = Self::new(mesh)?;
        level.interior = Interior::new(scheme, &level.solid(), diagonals)?;
        Ok(level)
    }

    /// The faces at which major diagonals clash, by their corners; none where there are no
    /// diagonals.
    pub fn improper_faces(&self) -> Result<Vec<[u32; 3]>> {
        match &self.interior {
            Interior::BoxSpline(diagonals) => diagonals.improper(&self.solid()),
            Interior::TetOct | Interior::BoxSplineAveraged => Ok(Vec::new()),
        }
    }

    /// The solid as it stands in its file, with its boundary found, for the scheme tet-oct.
    pub fn new(mesh: &SolidMesh) -> Result<Self> {
        let vertex_count = u32::try_from(mesh.points.len())
            .map_err(|_| Error::new("the mesh has more than 2^32 - 1 vertices"))?;
        let mut level = Self {
            vertex_count,
            cells: mesh.cells.clone(),
            surface: Vec::new(),
            boundary_count: 0,
            crease_face_count: 0,
            creases: mesh.features.creases.clone(),
            corners: mesh.features.corners.clone(),
            interior: Interior::TetOct,
        };
        let solid = level.solid();
        let faces = face_capacity(&solid).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
        let mut scratch = vec![[0; 3]; faces];
        level.surface = boundary_triangles(&solid, &mut scratch)
            .map_err(mesh_error)?
            .to_vec();
        level.boundary_count = level.surface.len();
        let inside = inside_faces(mesh, &level.surface)?;
        level.crease_face_count = inside.len();
        level.surface.extend(inside);
        require_no_cell_has(mesh)?;
        level.surface.extend(&mesh.features.sheets);
        // Without a rule of their own the open edges of a sheet would shrink.
        level.creases.extend(level.open_edges());
        level.creases.sort_unstable();
        level.creases.dedup();
        // Checks that every crease is an edge of a cell before any work is done.
        EdgeMemory::new(&level.solid())?.number(&level.solid())?;
        Ok(level)
    }

    /// The boundary triangles, counter-clockwise from outside.
    pub fn boundary(&self) -> &[[u32; 3]] {
        &self.surface[..self.boundary_count]
    }

    /// The triangles of crease surfaces inside.
    pub fn crease_faces(&self) -> &[[u32; 3]] {
        &self.surface[self.boundary_count..][..self.crease_face_count]
    }

    /// The triangles of sheets, which no cell has.
    pub fn sheets(&self) -> &[[u32; 3]] {
        &self.surface[self.boundary_count + self.crease_face_count..]
    }

    /// What is seen from outside: the boundary, then the sheets.
    pub fn skin(&self) -> Vec<[u32; 3]> {
        [self.boundary(), self.sheets()].concat()
    }

    /// Error if sheets hang on the boundary, whose shape then is not its own business alone.
    pub fn require_bare_boundary(&self) -> Result<()> {
        let boundary: HashSet<u32> = self.boundary().iter().flatten().copied().collect();
        let mut corners = self.sheets().iter().flatten();
        match corners.find(|corner| boundary.contains(corner)) {
            Some(corner) => Err(Error::new(format!(
                "a sheet hangs on the boundary at vertex {corner} (counted from 0): the volume that such a boundary encloses has no form"
            ))
            .advise("leave the sheets out")),
            None => Ok(()),
        }
    }

    /// Edges of a sheet that no other triangle of a surface has, ends ascending.
    fn open_edges(&self) -> Vec<[u32; 2]> {
        let mut uses: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        for edge in self.surface.iter().flat_map(edges_of) {
            *uses.entry(edge).or_default() += 1;
        }
        let edges = self.sheets().iter().flat_map(edges_of);
        edges.filter(|edge| uses.get(edge) == Some(&1)).collect()
    }

    /// The view that core takes.
    pub fn solid(&self) -> Solid<'_> {
        Solid {
            vertex_count: self.vertex_count,
            tetrahedra: &self.cells.tetrahedra,
            octahedra: &self.cells.octahedra,
            surface: &self.surface,
            creases: &self.creases,
            corners: &self.corners,
            ..Solid::default()
        }
    }

    /// Error if refining so many times would take more memory than is sensible.
    pub fn require_levels(&self, levels: u32) -> Result<()> {
        let mut counts = self.counts()?;
        for level in 1..=levels {
            match counts.refined() {
                Some(refined) if refined.vertices <= MOST_VERTICES => counts = refined,
                _ => {
                    return Err(Error::new(format!(
                        "level {level} of {levels} would have more than {MOST_VERTICES} vertices"
                    ))
                    .advise(
                        "take fewer levels: each has about eight times the cells of the one before",
                    ));
                }
            }
        }
        Ok(())
    }

    /// Numbers of everything, edges and faces included.
    pub fn counts(&self) -> Result<Counts> {
        let solid = self.solid();
        let mut memory = EdgeMemory::new(&solid)?;
        let edges = memory.number(&solid)?.edges().len();
        // A face belongs to one cell on the boundary, else to two.
        let of_cells = face_capacity(&solid).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
        Ok(Counts {
            vertices: self.vertex_count as usize,
            edges,
            // Those of sheets split as those of cells do.
            faces: (of_cells + self.boundary_count) / 2 + self.sheets().len(),
            tetrahedra: self.cells.tetrahedra.len(),
            octahedra: self.cells.octahedra.len(),
            surface: self.surface.len(),
            creases: self.creases.len(),
            corners: self.corners.len(),
        })
    }
}

/// A refined mesh of more vertices than this is refused before memory is asked for it: that is some
/// 600 million cells, far beyond what this is for.
const MOST_VERTICES: usize = 1 << 27;

/// A triangle splits into four, which follow one another.
const FACE_CHILDREN: usize = 4;

/// The crease faces that lie inside the solid.
fn inside_faces(mesh: &SolidMesh, boundary: &[[Vertex; 3]]) -> Result<Vec<[Vertex; 3]>> {
    if mesh.features.faces.is_empty() {
        return Ok(Vec::new());
    }
    let sorted = |mut face: [Vertex; 3]| {
        face.sort_unstable();
        face
    };
    let of_cells: HashSet<[Vertex; 3]> = crate::check::faces(mesh).map(sorted).collect();
    let on_boundary: HashSet<[Vertex; 3]> = boundary.iter().copied().map(sorted).collect();
    let faces = &mesh.features.faces;
    if let Some([a, b, c]) = faces
        .iter()
        .find(|face| !of_cells.contains(&sorted(**face)))
    {
        return Err(Error::new(format!(
            "the crease face of vertices {a}, {b} and {c} (counted from 0) is no face of a cell"
        ))
        .advise("a crease surface runs along faces of the mesh; mesh the surface together with the volume"));
    }
    let inside = faces
        .iter()
        .filter(|face| !on_boundary.contains(&sorted(**face)));
    Ok(inside.copied().collect())
}

/// Error if a triangle of a sheet is a face of a cell.
fn require_no_cell_has(mesh: &SolidMesh) -> Result<()> {
    let sorted = |mut face: [Vertex; 3]| {
        face.sort_unstable();
        face
    };
    let sheets: HashSet<[Vertex; 3]> = mesh.features.sheets.iter().copied().map(sorted).collect();
    let mut faces = crate::check::faces(mesh).map(sorted);
    match faces.find(|face| sheets.contains(face)) {
        Some([a, b, c]) => Err(Error::new(format!(
            "the sheet's triangle of vertices {a}, {b} and {c} (counted from 0) is a face of a cell"
        ))
        .advise("sheets hang on a solid by edges and vertices; inside it or on its boundary a surface is a crease surface")),
        None => Ok(()),
    }
}

/// The edges of a triangle, ends ascending.
fn edges_of(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// Memory for the numbering of one split.
struct EdgeMemory {
    edges: Vec<[u32; 2]>,
    octahedra: Vec<u32>,
}

impl EdgeMemory {
    fn new(solid: &Solid<'_>) -> Result<Self> {
        let edges = edge_capacity(solid).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
        Ok(Self {
            edges: vec![[0; 2]; edges],
            octahedra: vec![0; solid.octahedra.len()],
        })
    }

    fn number(&mut self, solid: &Solid<'_>) -> Result<Numbering<'_>> {
        Numbering::new(solid, &mut self.edges, &mut self.octahedra).map_err(mesh_error)
    }
}

/// A step from one level to the next: any values may be taken along it.
pub struct Refinement<'a> {
    from: &'a Level,
    memory: EdgeMemory,
    boundary: Boundary,
}

impl<'a> Refinement<'a> {
    /// Prepares the step from `from`.
    pub fn new(from: &'a Level, boundary: Boundary) -> Result<Self> {
        Ok(Self {
            from,
            memory: EdgeMemory::new(&from.solid())?,
            boundary,
        })
    }

    /// The connectivity of the next level.
    pub fn split(&mut self) -> Result<Level> {
        let solid = self.from.solid();
        let numbering = self.memory.number(&solid)?;
        let counts =
            split_counts(&solid, &numbering).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
        let mut next = Level {
            vertex_count: numbering.vertex_count(),
            cells: Cells {
                tetrahedra: vec![[0; 4]; counts.tetrahedra],
                octahedra: vec![[0; 6]; counts.octahedra],
            },
            surface: vec![[0; 3]; counts.surface],
            boundary_count: FACE_CHILDREN * self.from.boundary_count,
            crease_face_count: FACE_CHILDREN * self.from.crease_face_count,
            creases: vec![[0; 2]; counts.creases],
            corners: vec![0; counts.corners],
            interior: match &self.from.interior {
                Interior::BoxSpline(diagonals) => {
                    Interior::BoxSpline(diagonals.split(counts.tetrahedra, counts.octahedra)?)
                }
                same => same.clone(),
            },
        };
        let buffers = SolidBuffers {
            tetrahedra: &mut next.cells.tetrahedra,
            octahedra: &mut next.cells.octahedra,
            surface: &mut next.surface,
            creases: &mut next.creases,
            corners: &mut next.corners,
        };
        split(&solid, &numbering, buffers).map_err(mesh_error)?;
        Ok(next)
    }

    /// The values at the next level's vertices.
    pub fn values<B: Blend>(
        &mut self,
        blend: &mut B,
        values: &[B::Point],
    ) -> Result<Vec<B::Point>> {
        let mut solid = self.from.solid();
        let mut boundary = self.boundary;
        let inside_and_sheets = &self.from.surface[self.from.boundary_count..];
        if boundary == Boundary::Interior && !inside_and_sheets.is_empty() {
            // The boundary has no rule of its own, crease surfaces and sheets keep theirs.
            solid.surface = inside_and_sheets;
            boundary = Boundary::Surface(LoopWeights::Loop);
        }
        let numbering = self.memory.number(&solid)?;
        let length = numbering.vertex_count() as usize;
        let zero = blend.zero();
        let mut out = vec![blend.divide(&zero, 1); length];
        let buffers = PointBuffers {
            out: &mut out,
            sums: &mut vec![zero; length],
            states: &mut vec![VertexState::default(); length],
        };
        let scheme = match &self.from.interior {
            Interior::TetOct => {
                refine_points(blend, &solid, &numbering, boundary, values, buffers)
                    .map_err(mesh_error)?;
                return Ok(out);
            }
            Interior::BoxSpline(diagonals) => box_spline::Scheme::MajorDiagonals(diagonals.view()),
            Interior::BoxSplineAveraged => box_spline::Scheme::Averaged,
        };
        let needed =
            neighbour_capacity(&solid, &scheme).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
        let mut arena = vec![[0; 3]; needed];
        let neighbours = Neighbours::new(&solid, scheme, &mut arena).map_err(mesh_error)?;
        box_spline::refine_points(
            blend,
            &solid,
            &numbering,
            &neighbours,
            boundary,
            values,
            buffers,
        )
        .map_err(mesh_error)?;
        Ok(out)
    }

    /// Positions in double precision.
    pub fn points(&mut self, points: &[Point]) -> Result<Vec<Point>> {
        self.values(&mut RealBlend, points)
    }

    /// Positions as the device computes them from raw bits; counts saturated coordinates.
    pub fn bits(&mut self, bits: &[[i32; 3]], saturated: &mut usize) -> Result<Vec<[i32; 3]>> {
        let mut blend = FixedBlend::<i32, 3>::new();
        let out = self.values(&mut blend, bits)?;
        *saturated += blend.saturated() as usize;
        Ok(out)
    }
}

/// Core's complaint about a mesh in the words of a file's user.
pub(super) fn mesh_error(error: MeshError) -> Error {
    match error {
        MeshError::NotAnEdge {
            part: Part::Crease,
            edge: [a, b],
            ..
        } => Error::new(format!(
            "the crease from vertex {a} to vertex {b} (counted from 0) is no edge of a cell"
        ))
        .advise("a crease runs along edges of the mesh; mesh the curve together with the volume"),
        MeshError::RepeatedVertex {
            part,
            index,
            vertex,
        } => Error::new(format!(
            "{part} {index} (counted from 0) names vertex {vertex} twice"
        ))
        .advise("remove the degenerate cell"),
        MeshError::DiagonalCount {
            part,
            needed,
            given,
        } => Error::new(format!(
            "{given} major diagonals are given for cells of the kind {part}, of which there are {needed}"
        )),
        MeshError::TooLarge => Error::new("the refined mesh needs more than 2^32 - 1 vertices")
            .advise("take fewer levels"),
        other => Error::new(other.to_string()),
    }
}
