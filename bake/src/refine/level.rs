//! One level of a solid in memory, and the step to the next.

use super::counts::MixedLevelCounts;
use super::crease_faces::{inside_faces, require_no_cell_has};
use super::mixed::{self, MixedMemory};
use super::{DiagonalLists, Interior, RealBlend, Scheme};
use crate::error::{Error, Result, count};
use crate::mesh::{Cells, Faces, Point, Shape, SolidMesh};
use octruss::blend::{FixedBlend, GuardedBlend};
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
    /// Boundary quadrilaterals, counter-clockwise from outside, and behind them those of crease
    /// surfaces inside.
    pub surface_quads: Vec<[u32; 4]>,
    /// How many quadrilaterals of `surface_quads` are on the boundary.
    pub boundary_quad_count: usize,
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
    ///
    /// # Errors
    /// If the connectivity is none of a solid, or the scheme does not take all of the cells.
    pub fn of_scheme(
        mesh: &SolidMesh,
        scheme: Scheme,
        diagonals: Option<&DiagonalLists>,
    ) -> Result<Self> {
        if scheme != Scheme::Mixed {
            require_tetrahedral(&mesh.cells, scheme)?;
        }
        let mut level = Self::new(mesh)?;
        level.interior = Interior::new(scheme, &level.solid(), diagonals)?;
        Ok(level)
    }

    /// The faces at which major diagonals clash, by their corners; none where there are no
    /// diagonals.
    pub fn improper_faces(&self) -> Result<Vec<[u32; 3]>> {
        match &self.interior {
            Interior::BoxSpline(diagonals) => diagonals.improper(&self.solid()),
            Interior::TetOct | Interior::BoxSplineAveraged | Interior::Mixed => Ok(Vec::new()),
        }
    }

    /// The solid as it stands in its file, with its boundary found: for the scheme tet-oct, or for
    /// mixed if it has prisms or hexahedra.
    ///
    /// # Errors
    /// If the connectivity is none of a solid.
    pub fn new(mesh: &SolidMesh) -> Result<Self> {
        let vertex_count = u32::try_from(mesh.points.len())
            .map_err(|_| Error::new("the mesh has more than 2^32 - 1 vertices"))?;
        let mut level = Self {
            vertex_count,
            cells: mesh.cells.clone(),
            creases: mesh.features.creases.clone(),
            corners: mesh.features.corners.clone(),
            ..Self::default()
        };
        let boundary = if level.cells.is_tetrahedral() {
            boundary_of(&level.solid())?
        } else {
            level.interior = Interior::Mixed;
            mixed::boundary_of(&level.solid())?
        };
        let inside = inside_faces(mesh, &boundary)?;
        level.boundary_count = boundary.triangles.len();
        level.boundary_quad_count = boundary.quads.len();
        level.crease_face_count = inside.triangles.len();
        level.surface = [boundary.triangles, inside.triangles].concat();
        level.surface_quads = [boundary.quads, inside.quads].concat();
        require_no_cell_has(mesh)?;
        level.surface.extend(&mesh.features.sheets);
        // Without a rule of their own the open edges of a sheet would shrink.
        level.creases.extend(level.open_edges());
        level.creases.sort_unstable();
        level.creases.dedup();
        // Checks that every crease is an edge of a cell before any work is done.
        Memory::new(&level)?.check(&level)?;
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
    pub fn skin(&self) -> Faces {
        Faces {
            triangles: [self.boundary(), self.sheets()].concat(),
            quads: self.boundary_quads().to_vec(),
        }
    }

    /// The boundary alone.
    pub fn boundary_faces(&self) -> Faces {
        Faces {
            triangles: self.boundary().to_vec(),
            quads: self.boundary_quads().to_vec(),
        }
    }

    /// Error if sheets hang on the boundary: its shape then is not its own business alone.
    pub fn require_bare_boundary(&self) -> Result<()> {
        let triangles = self.boundary().as_flattened().iter();
        let quads = self.boundary_quads().as_flattened().iter();
        let boundary: HashSet<u32> = triangles.chain(quads).copied().collect();
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
        let of_quads = self.surface_quads.iter().flat_map(edges_of_quad);
        for edge in self.surface.iter().flat_map(edges_of).chain(of_quads) {
            *uses.entry(edge).or_default() += 1;
        }
        let edges = self.sheets().iter().flat_map(edges_of);
        edges.filter(|edge| uses.get(edge) == Some(&1)).collect()
    }

    /// The boundary quadrilaterals, counter-clockwise from outside.
    pub fn boundary_quads(&self) -> &[[u32; 4]] {
        &self.surface_quads[..self.boundary_quad_count]
    }

    /// The quadrilaterals of crease surfaces inside.
    pub fn crease_quads(&self) -> &[[u32; 4]] {
        &self.surface_quads[self.boundary_quad_count..]
    }

    /// The view that core takes.
    pub fn solid(&self) -> Solid<'_> {
        Solid {
            vertex_count: self.vertex_count,
            tetrahedra: &self.cells.tetrahedra,
            octahedra: &self.cells.octahedra,
            prisms: &self.cells.prisms,
            hexahedra: &self.cells.hexahedra,
            surface: &self.surface,
            surface_quads: &self.surface_quads,
            creases: &self.creases,
            corners: &self.corners,
        }
    }

    /// Error if refining so many times would take more memory than is sensible.
    pub fn require_levels(&self, levels: u32) -> Result<()> {
        let mut counts = MixedLevelCounts::of(self)?;
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

    /// Numbers of everything, edges and faces included, of a solid of tetrahedra and octahedra.
    ///
    /// # Errors
    /// If the connectivity is none of such a solid.
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

/// Error if there are cells that the tetrahedral schemes do not know.
fn require_tetrahedral(cells: &Cells, scheme: Scheme) -> Result<()> {
    let foreign = [Shape::Prism, Shape::Hexahedron];
    let words: Vec<String> = foreign
        .into_iter()
        .filter(|shape| cells.count(*shape) > 0)
        .map(|shape| {
            let (singular, plural) = shape.names();
            count(cells.count(shape), singular, plural)
        })
        .collect();
    if words.is_empty() {
        return Ok(());
    }
    Err(Error::new(format!(
        "the mesh has {}; a cage of the scheme {} consists of tetrahedra and octahedra",
        words.join(" and "),
        scheme.name()
    ))
    .advise("add --scheme mixed, or mesh the volume with tetrahedra alone (no transfinite, recombined or extruded layers)"))
}

/// Memory for the numbering of one split, of either kind of scheme.
enum Memory {
    Tetrahedral(EdgeMemory),
    Mixed(MixedMemory),
}

impl Memory {
    fn new(level: &Level) -> Result<Self> {
        let solid = level.solid();
        match level.interior {
            Interior::Mixed => MixedMemory::new(&solid).map(Self::Mixed),
            _ => EdgeMemory::new(&solid).map(Self::Tetrahedral),
        }
    }

    fn check(&mut self, level: &Level) -> Result<()> {
        let solid = level.solid();
        match self {
            Self::Tetrahedral(memory) => memory.number(&solid).map(|_| ()),
            Self::Mixed(memory) => memory.number(&solid).map(|_| ()),
        }
    }
}

/// The edges of a triangle, ends ascending.
fn edges_of(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// The boundary that core finds.
fn boundary_of(solid: &Solid<'_>) -> Result<Faces> {
    let capacity = face_capacity(solid).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
    let mut scratch = vec![[0; 3]; capacity];
    let triangles = boundary_triangles(solid, &mut scratch).map_err(mesh_error)?;
    Ok(Faces {
        triangles: triangles.to_vec(),
        quads: Vec::new(),
    })
}

/// The edges of a quadrilateral, ends ascending.
fn edges_of_quad(&[a, b, c, d]: &[u32; 4]) -> [[u32; 2]; 4] {
    [[a, b], [b, c], [c, d], [d, a]].map(|[a, b]| [a.min(b), a.max(b)])
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
    memory: Memory,
    boundary: Boundary,
}

impl<'a> Refinement<'a> {
    /// Prepares the step from `from`.
    ///
    /// # Errors
    /// If the boundary rule is none of the scheme's.
    pub fn new(from: &'a Level, boundary: Boundary) -> Result<Self> {
        if from.interior == Interior::Mixed {
            mixed::mixed_boundary(boundary)?;
        }
        Ok(Self {
            from,
            memory: Memory::new(from)?,
            boundary,
        })
    }

    /// The connectivity of the next level.
    pub fn split(&mut self) -> Result<Level> {
        let memory = match &mut self.memory {
            Memory::Tetrahedral(memory) => memory,
            Memory::Mixed(memory) => return mixed::split_level(self.from, memory),
        };
        let solid = self.from.solid();
        let numbering = memory.number(&solid)?;
        let counts =
            split_counts(&solid, &numbering).ok_or_else(|| mesh_error(MeshError::TooLarge))?;
        let mut next = Level {
            vertex_count: numbering.vertex_count(),
            cells: Cells {
                tetrahedra: vec![[0; 4]; counts.tetrahedra],
                octahedra: vec![[0; 6]; counts.octahedra],
                ..Cells::default()
            },
            surface: vec![[0; 3]; counts.surface],
            boundary_count: FACE_CHILDREN * self.from.boundary_count,
            crease_face_count: FACE_CHILDREN * self.from.crease_face_count,
            surface_quads: Vec::new(),
            boundary_quad_count: 0,
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
    pub fn values<B: GuardedBlend>(
        &mut self,
        blend: &mut B,
        values: &[B::Point],
    ) -> Result<Vec<B::Point>> {
        let memory = match &mut self.memory {
            Memory::Tetrahedral(memory) => memory,
            Memory::Mixed(memory) => {
                return mixed::values(self.from, memory, self.boundary, blend, values);
            }
        };
        let mut solid = self.from.solid();
        let mut boundary = self.boundary;
        let inside_and_sheets = &self.from.surface[self.from.boundary_count..];
        if boundary == Boundary::Interior && !inside_and_sheets.is_empty() {
            // The boundary has no rule of its own, crease surfaces and sheets keep theirs.
            solid.surface = inside_and_sheets;
            boundary = Boundary::Surface(LoopWeights::Loop);
        }
        let numbering = memory.number(&solid)?;
        let length = numbering.vertex_count() as usize;
        let zero = blend.zero();
        let mut out = vec![blend.divide(&zero, 1); length];
        let buffers = PointBuffers {
            out: &mut out,
            sums: &mut vec![zero; length],
            states: &mut vec![VertexState::default(); length],
        };
        let scheme = match &self.from.interior {
            Interior::TetOct | Interior::Mixed => {
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
        MeshError::CrossedDiagonals {
            corners: [a, b, c, d],
        } => Error::new(format!(
            "triangles of cells lie on the quadrilateral face {a}-{b}-{c}-{d} (vertices counted from 0) along both of its diagonals"
        ))
        .advise("cut what lies on the face along one diagonal"),
        MeshError::TooLarge => Error::new("the refined mesh needs more than 2^32 - 1 vertices")
            .advise("take fewer levels"),
        other => Error::new(other.to_string()),
    }
}
