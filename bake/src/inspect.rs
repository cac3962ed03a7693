//! What there is to know about a solid mesh before anything is built on it.

use crate::check::{self, Volumes};
use crate::error::Result;
use crate::geometry::bounds;
use crate::mesh::{Point, SolidMesh, Vertex};
use crate::overlap::overlapping_cells;
use crate::refine::{Interior, Level, MixedLevelCounts, Scheme};
use octruss::mesh::Counts;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// How many there are of each number of neighbours.
pub type Histogram = BTreeMap<u32, usize>;

/// What the box-spline schemes ask of a mesh.
#[derive(Clone, Debug, Serialize)]
pub struct BoxSplineFigures {
    /// Numbers of cells with the major diagonals 0, 1 and 2; none in the averaged scheme.
    pub cells_by_diagonal: Option<[usize; 3]>,
    /// Faces at which the diagonals of two cells clash, by their corners.
    pub improper_faces: Vec<[Vertex; 3]>,
    /// Triples of neighbours (`N`) that refining the mesh once takes.
    pub scratch_neighbours: usize,
}

/// The figures of a mesh.
#[derive(Clone, Debug, Serialize)]
pub struct Inspection {
    /// Vertices.
    pub vertices: usize,
    /// Tetrahedra.
    pub tetrahedra: usize,
    /// Octahedra.
    pub octahedra: usize,
    /// Prisms.
    pub prisms: usize,
    /// Hexahedra.
    pub hexahedra: usize,
    /// Edges of cells; not the diagonals of quadrilaterals on which triangles lie.
    pub edges: usize,
    /// Faces of cells; a quadrilateral counts as one, with the triangles that lie on it.
    pub faces: usize,
    /// Quadrilaterals among them, by how many halves triangles of other cells cover: none, one, two.
    pub quadrilaterals_by_covered_halves: [usize; 3],
    /// Least and greatest coordinates.
    pub bounds: Option<[Point; 2]>,
    /// Interior edges by the number of cells round them.
    pub interior_edge_valences: Histogram,
    /// Boundary edges by the number of cells round them.
    pub boundary_edge_valences: Histogram,
    /// Interior vertices by the number of cells at them.
    pub interior_vertex_valences: Histogram,
    /// Boundary vertices by the number of cells at them.
    pub boundary_vertex_valences: Histogram,
    /// Boundary vertices by the number of boundary edges at them: the valence that Loop's rule
    /// takes.
    pub surface_vertex_valences: Histogram,
    /// Triangles of the boundary.
    pub boundary_triangles: usize,
    /// Quadrilaterals of the boundary.
    pub boundary_quadrilaterals: usize,
    /// Edges of boundary faces.
    pub boundary_edges: usize,
    /// Boundary edges that do not belong to exactly two boundary faces.
    pub irregular_boundary_edges: usize,
    /// Interior edges of three cells, along which the scheme tet-oct is not smooth.
    pub interior_edges_of_valence_3: Vec<[Vertex; 2]>,
    /// Of the box-spline schemes, if one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub box_spline: Option<BoxSplineFigures>,
    /// Crease edges.
    pub creases: usize,
    /// Vertices by the number of crease edges at them (0 left out).
    pub crease_vertex_valences: Histogram,
    /// Corners.
    pub corners: usize,
    /// Faces of crease surfaces inside.
    pub crease_faces: usize,
    /// Triangles of sheets.
    pub sheets: usize,
    /// How many cells have each label; empty if cells have none.
    pub labels: BTreeMap<i32, usize>,
    /// Names of the scalar channels.
    pub channels: Vec<String>,
    /// Vertices of no cell.
    pub unused_vertices: Vec<usize>,
    /// Cells of negative volume, by name.
    pub inverted_cells: Vec<String>,
    /// Cells without volume, by name.
    pub flat_cells: Vec<String>,
    /// Octahedra that no diagonal cuts into four tetrahedra of positive volume, and prisms and
    /// hexahedra without positive volume at a corner, by name.
    pub folded_cells: Vec<String>,
    /// Pairs of cells that share space, by name.
    pub overlapping_cells: Vec<[String; 2]>,
    /// Arena capacities, level by level; empty for the scheme mixed.
    pub capacities: Vec<Capacities>,
    /// Arena capacities of the scheme mixed, level by level; else empty.
    pub mixed_capacities: Vec<MixedCapacities>,
    /// What the reader left out or found odd.
    pub notes: Vec<String>,
}

/// How much memory a level needs on a device: the const parameters of core's arenas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Capacities {
    /// The level; 0 is the mesh itself.
    pub level: u32,
    /// Vertices: values of this level.
    pub vertices: usize,
    /// Tetrahedra, `T` of `SolidArena`.
    pub tetrahedra: usize,
    /// Octahedra, `O` of `SolidArena` and, to refine this level, of `Scratch`.
    pub octahedra: usize,
    /// Surface triangles, `S` of `SolidArena`.
    pub surface: usize,
    /// Crease edges, `C` of `SolidArena`.
    pub creases: usize,
    /// Corners, `K` of `SolidArena`.
    pub corners: usize,
    /// Edges with repetitions, `E` of `Scratch` to refine this level.
    pub scratch_edges: usize,
    /// Vertices of the next level, `V` of `Scratch` to refine this level.
    pub scratch_vertices: usize,
    /// Faces with repetitions: scratch to find the boundary of this level.
    pub faces_to_find_boundary: usize,
}

impl Capacities {
    fn of(level: u32, counts: Counts) -> Option<Self> {
        let weighted = |terms: [(usize, usize); 3]| {
            terms.into_iter().try_fold(0_usize, |sum, (factor, count)| {
                sum.checked_add(factor.checked_mul(count)?)
            })
        };
        let (tetrahedra, octahedra) = (counts.tetrahedra, counts.octahedra);
        Some(Self {
            level,
            vertices: counts.vertices,
            tetrahedra: counts.tetrahedra,
            octahedra: counts.octahedra,
            surface: counts.surface,
            creases: counts.creases,
            corners: counts.corners,
            scratch_edges: weighted([(6, tetrahedra), (12, octahedra), (3, counts.surface)])?,
            scratch_vertices: counts.refined()?.vertices,
            faces_to_find_boundary: weighted([(4, tetrahedra), (8, octahedra), (0, 0)])?,
        })
    }
}

/// How much memory a level of the scheme mixed needs on a device: the const parameters of core's
/// arenas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MixedCapacities {
    /// The level; 0 is the mesh itself.
    pub level: u32,
    /// Vertices, `N` of `PointScratch` to refine this level.
    pub vertices: usize,
    /// Tetrahedra, `T` of `MixedArena`.
    pub tetrahedra: usize,
    /// Octahedra, `O` of `MixedArena` and, to refine this level, of `NumberingScratch`.
    pub octahedra: usize,
    /// Prisms, `P` of `MixedArena`.
    pub prisms: usize,
    /// Hexahedra, `H` of `MixedArena` and, to refine this level, of `NumberingScratch`.
    pub hexahedra: usize,
    /// Surface triangles, `S` of `MixedArena`.
    pub surface: usize,
    /// Surface quadrilaterals, `Q` of `MixedArena`.
    pub surface_quads: usize,
    /// Crease edges, `C` of `MixedArena`.
    pub creases: usize,
    /// Corners, `K` of `MixedArena`.
    pub corners: usize,
    /// Edges with repetitions, `E` of `NumberingScratch` to refine this level.
    pub scratch_edges: usize,
    /// Quadrilateral faces with repetitions, `F` of `NumberingScratch` to refine this level; `D`, for
    /// their diagonals, is twice as much.
    pub scratch_quads: usize,
    /// Triangles of prisms, `R` of `NumberingScratch` to refine this level.
    pub scratch_prism_triangles: usize,
    /// Vertices of the next level, `V` of `PointScratch` to refine this level.
    pub scratch_vertices: usize,
    /// Triangles and quadrilaterals: scratch to find the boundary of this level.
    pub faces_to_find_boundary: [usize; 2],
}

impl MixedCapacities {
    fn of(level: u32, counts: MixedLevelCounts, next_vertices: usize) -> Option<Self> {
        let sum = |terms: &[(usize, usize)]| {
            terms.iter().try_fold(0_usize, |sum, (factor, count)| {
                sum.checked_add(factor.checked_mul(*count)?)
            })
        };
        let MixedLevelCounts {
            tetrahedra,
            octahedra,
            prisms,
            hexahedra,
            surface,
            surface_quads,
            ..
        } = counts;
        let cell_quads = sum(&[(3, prisms), (6, hexahedra)])?;
        Some(Self {
            level,
            vertices: counts.vertices,
            tetrahedra,
            octahedra,
            prisms,
            hexahedra,
            surface,
            surface_quads,
            creases: counts.creases,
            corners: counts.corners,
            scratch_edges: sum(&[
                (6, tetrahedra),
                (12, octahedra),
                (9, prisms),
                (12, hexahedra),
                (3, surface),
                (4, surface_quads),
            ])?,
            scratch_quads: sum(&[(1, cell_quads), (1, surface_quads)])?,
            scratch_prism_triangles: sum(&[(2, prisms)])?,
            scratch_vertices: next_vertices,
            faces_to_find_boundary: [
                sum(&[
                    (4, tetrahedra),
                    (8, octahedra),
                    (2, prisms),
                    (4, cell_quads),
                ])?,
                cell_quads,
            ],
        })
    }
}

impl Inspection {
    /// Adds what the scheme of a level asks for.
    ///
    /// # Errors
    /// If the connectivity is none of a solid.
    pub fn add_scheme(&mut self, level: &Level) -> Result<()> {
        let spokes = match &level.interior {
            Interior::TetOct | Interior::Mixed => return Ok(()),
            Interior::BoxSpline(_) => 4,
            Interior::BoxSplineAveraged => 12,
        };
        let cells_by_diagonal = match &level.interior {
            Interior::BoxSpline(lists) => {
                let mut counts = [0; 3];
                for diagonal in lists.tetrahedra.iter().chain(&lists.octahedra) {
                    counts[usize::from(*diagonal)] += 1;
                }
                Some(counts)
            }
            Interior::TetOct | Interior::BoxSplineAveraged | Interior::Mixed => None,
        };
        self.box_spline = Some(BoxSplineFigures {
            cells_by_diagonal,
            improper_faces: level.improper_faces()?,
            scratch_neighbours: 4 * self.tetrahedra + (8 + spokes) * self.octahedra,
        });
        Ok(())
    }
}

/// Looks at a mesh; capacities are predicted up to `levels`, of the scheme mixed if that is asked for.
///
/// # Errors
/// If the connectivity is none of a solid, or there are prisms or hexahedra and another scheme is
/// asked for.
pub fn inspect(mesh: &SolidMesh, scheme: Scheme, levels: u32) -> Result<Inspection> {
    check::require_sound_connectivity(mesh)?;
    let level = match scheme {
        Scheme::Mixed => Level::of_scheme(mesh, scheme, None)?,
        _ => Level::of_scheme(mesh, Scheme::TetOct, None)?,
    };
    let counts = MixedLevelCounts::of(&level)?;
    let (capacities, mixed_capacities) = match scheme {
        Scheme::Mixed => (Vec::new(), mixed_capacities(counts, levels)),
        _ => (capacities(level.counts()?, levels), Vec::new()),
    };
    let volumes = Volumes::of(&mesh.cells, &mesh.points);
    let names = |cells: &[usize]| cells.iter().map(|cell| mesh.cells.name(*cell)).collect();
    let edge_cells = edge_cells(mesh);
    let surface = SurfaceEdges::of(&level);
    let on_boundary = |edge: &[Vertex; 2]| surface.faces.contains_key(edge);
    let (boundary, interior): (Vec<_>, Vec<_>) =
        edge_cells.iter().partition(|(edge, _)| on_boundary(edge));
    let vertex_cells = count_each(mesh.cells.corners().flatten().copied());
    let (boundary_vertices, interior_vertices): (Vec<_>, Vec<_>) = vertex_cells
        .iter()
        .partition(|(vertex, _)| surface.vertices.contains(vertex));
    Ok(Inspection {
        vertices: mesh.points.len(),
        tetrahedra: mesh.cells.tetrahedra.len(),
        octahedra: mesh.cells.octahedra.len(),
        prisms: mesh.cells.prisms.len(),
        hexahedra: mesh.cells.hexahedra.len(),
        edges: counts.edges,
        faces: counts.triangles - level.sheets().len() + counts.quads(),
        quadrilaterals_by_covered_halves: [
            counts.free_quads,
            counts.half_covered_quads,
            counts.covered_quads,
        ],
        bounds: bounds(&mesh.points),
        interior_edges_of_valence_3: of_three_cells(&interior),
        interior_edge_valences: count_each(interior.into_iter().map(|(_, cells)| *cells)),
        boundary_edge_valences: count_each(boundary.into_iter().map(|(_, cells)| *cells)),
        interior_vertex_valences: count_each(interior_vertices.into_iter().map(|(_, n)| *n as u32)),
        boundary_vertex_valences: count_each(boundary_vertices.into_iter().map(|(_, n)| *n as u32)),
        surface_vertex_valences: edge_valences(surface.faces.keys()),
        boundary_triangles: level.boundary().len(),
        boundary_quadrilaterals: level.boundary_quads().len(),
        boundary_edges: surface.faces.len(),
        irregular_boundary_edges: surface.faces.values().filter(|n| **n != 2).count(),
        box_spline: None,
        creases: mesh.features.creases.len(),
        crease_vertex_valences: edge_valences(mesh.features.creases.iter()),
        corners: mesh.features.corners.len(),
        crease_faces: level.crease_faces().len() + level.crease_quads().len(),
        sheets: level.sheets().len(),
        labels: count_each(mesh.labels.iter()),
        channels: mesh
            .channels
            .iter()
            .map(|channel| channel.name.clone())
            .collect(),
        unused_vertices: check::unused_vertices(mesh),
        inverted_cells: names(&volumes.inverted),
        flat_cells: names(&volumes.flat),
        folded_cells: names(&volumes.folded),
        overlapping_cells: overlapping_cells(&mesh.cells, &mesh.points)
            .into_iter()
            .map(|pair| pair.map(|cell| mesh.cells.name(cell)))
            .collect(),
        capacities,
        mixed_capacities,
        notes: mesh.notes.clone(),
    })
}

/// The interior edges of three cells, along which the scheme tet-oct is not smooth.
///
/// # Errors
/// If the connectivity is none of a solid.
pub fn interior_edges_of_valence_3(mesh: &SolidMesh) -> Result<Vec<[Vertex; 2]>> {
    let surface = SurfaceEdges::of(&Level::new(mesh)?);
    let edges = edge_cells(mesh);
    let interior = edges
        .iter()
        .filter(|(edge, _)| !surface.faces.contains_key(*edge));
    Ok(of_three_cells(&interior.collect::<Vec<_>>()))
}

/// The boundary edges at which other than two boundary triangles meet: the boundary touches itself.
///
/// # Errors
/// If the connectivity is none of a solid.
pub fn irregular_boundary_edges(mesh: &SolidMesh) -> Result<Vec<[Vertex; 2]>> {
    let surface = SurfaceEdges::of(&Level::new(mesh)?);
    let irregular = surface.faces.iter().filter(|(_, n)| **n != 2);
    Ok(irregular.map(|(edge, _)| *edge).collect())
}

fn of_three_cells(edges: &[(&[Vertex; 2], &u32)]) -> Vec<[Vertex; 2]> {
    edges
        .iter()
        .filter(|(_, cells)| **cells == 3)
        .map(|(edge, _)| **edge)
        .collect()
}

fn mixed_capacities(mut counts: MixedLevelCounts, levels: u32) -> Vec<MixedCapacities> {
    let mut list = Vec::new();
    for level in 0..=levels {
        let refined = counts.refined();
        let Some(capacities) =
            refined.and_then(|refined| MixedCapacities::of(level, counts, refined.vertices))
        else {
            break;
        };
        list.push(capacities);
        counts = refined.unwrap_or(counts);
    }
    list
}

fn capacities(mut counts: Counts, levels: u32) -> Vec<Capacities> {
    let mut list = Vec::new();
    for level in 0..=levels {
        let Some(capacities) = Capacities::of(level, counts) else {
            break;
        };
        list.push(capacities);
        let Some(refined) = counts.refined() else {
            break;
        };
        counts = refined;
    }
    list
}

/// The edges of all cells, ends ascending, with the number of cells round each.
fn edge_cells(mesh: &SolidMesh) -> BTreeMap<[Vertex; 2], u32> {
    let mut edges = BTreeMap::new();
    for (shape, corners) in mesh.cells.iter() {
        for [a, b] in shape.edges() {
            let (a, b) = (corners[*a], corners[*b]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    edges
}

/// The edges of the boundary with the number of boundary faces at each, and its vertices.
struct SurfaceEdges {
    faces: BTreeMap<[Vertex; 2], u32>,
    vertices: BTreeSet<Vertex>,
}

impl SurfaceEdges {
    fn of(level: &Level) -> Self {
        let triangles = level.boundary().iter().map(<[Vertex; 3]>::as_slice);
        let quads = level.boundary_quads().iter().map(<[Vertex; 4]>::as_slice);
        let (mut faces, mut vertices) = (BTreeMap::new(), BTreeSet::new());
        for face in triangles.chain(quads) {
            for (a, b) in face.iter().zip(face.iter().cycle().skip(1)) {
                *faces.entry([*a.min(b), *a.max(b)]).or_default() += 1;
            }
            vertices.extend(face);
        }
        Self { faces, vertices }
    }
}

fn count_each<Item: Ord>(items: impl Iterator<Item = Item>) -> BTreeMap<Item, usize> {
    let mut counts = BTreeMap::new();
    for item in items {
        *counts.entry(item).or_default() += 1;
    }
    counts
}

/// Vertices by the number of these edges at them.
fn edge_valences<'a>(edges: impl Iterator<Item = &'a [Vertex; 2]>) -> Histogram {
    count_each(
        count_each(edges.flatten().copied())
            .into_values()
            .map(|number| number as u32),
    )
}
