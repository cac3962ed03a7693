//! What there is to know about a solid mesh before anything is built on it.

use crate::check::{self, Volumes};
use crate::error::Result;
use crate::geometry::bounds;
use crate::mesh::{Point, SolidMesh, Vertex};
use crate::overlap::overlapping_cells;
use crate::refine::{Interior, Level};
use octruss::mesh::{Counts, OCTAHEDRON_EDGES, TETRAHEDRON_EDGES};
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
    /// Edges of cells.
    pub edges: usize,
    /// Faces of cells.
    pub faces: usize,
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
    /// Edges of boundary triangles.
    pub boundary_edges: usize,
    /// Boundary edges that do not belong to exactly two boundary triangles.
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
    /// Octahedra that no diagonal cuts into four tetrahedra of positive volume, by name.
    pub folded_cells: Vec<String>,
    /// Pairs of cells that share space, by name.
    pub overlapping_cells: Vec<[String; 2]>,
    /// Arena capacities, level by level.
    pub capacities: Vec<Capacities>,
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

impl Inspection {
    /// Adds what the scheme of a level asks for.
    ///
    /// # Errors
    /// If the connectivity is none of a solid.
    pub fn add_scheme(&mut self, level: &Level) -> Result<()> {
        let spokes = match &level.interior {
            Interior::TetOct => return Ok(()),
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
            Interior::TetOct | Interior::BoxSplineAveraged => None,
        };
        self.box_spline = Some(BoxSplineFigures {
            cells_by_diagonal,
            improper_faces: level.improper_faces()?,
            scratch_neighbours: 4 * self.tetrahedra + (8 + spokes) * self.octahedra,
        });
        Ok(())
    }
}

/// Looks at a mesh; capacities are predicted up to `levels`.
///
/// # Errors
/// If the connectivity is none of a solid.
pub fn inspect(mesh: &SolidMesh, levels: u32) -> Result<Inspection> {
    check::require_sound_connectivity(mesh)?;
    let level = Level::new(mesh)?;
    let counts = level.counts()?;
    let volumes = Volumes::of(&mesh.cells, &mesh.points);
    let names = |cells: &[usize]| cells.iter().map(|cell| mesh.cells.name(*cell)).collect();
    let edge_cells = edge_cells(mesh);
    let surface = SurfaceEdges::of(level.boundary());
    let on_boundary = |edge: &[Vertex; 2]| surface.triangles.contains_key(edge);
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
        edges: counts.edges,
        faces: counts.faces - level.sheets().len(),
        bounds: bounds(&mesh.points),
        interior_edges_of_valence_3: of_three_cells(&interior),
        interior_edge_valences: count_each(interior.into_iter().map(|(_, cells)| *cells)),
        boundary_edge_valences: count_each(boundary.into_iter().map(|(_, cells)| *cells)),
        interior_vertex_valences: count_each(interior_vertices.into_iter().map(|(_, n)| *n as u32)),
        boundary_vertex_valences: count_each(boundary_vertices.into_iter().map(|(_, n)| *n as u32)),
        surface_vertex_valences: edge_valences(surface.triangles.keys()),
        boundary_triangles: level.boundary().len(),
        boundary_edges: surface.triangles.len(),
        irregular_boundary_edges: surface.triangles.values().filter(|n| **n != 2).count(),
        box_spline: None,
        creases: mesh.features.creases.len(),
        crease_vertex_valences: edge_valences(mesh.features.creases.iter()),
        corners: mesh.features.corners.len(),
        crease_faces: level.crease_faces().len(),
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
        capacities: capacities(counts, levels),
        notes: mesh.notes.clone(),
    })
}

/// The interior edges of three cells, along which the scheme tet-oct is not smooth.
///
/// # Errors
/// If the connectivity is none of a solid.
pub fn interior_edges_of_valence_3(mesh: &SolidMesh) -> Result<Vec<[Vertex; 2]>> {
    let surface = SurfaceEdges::of(Level::new(mesh)?.boundary());
    let edges = edge_cells(mesh);
    let interior = edges
        .iter()
        .filter(|(edge, _)| !surface.triangles.contains_key(*edge));
    Ok(of_three_cells(&interior.collect::<Vec<_>>()))
}

/// The boundary edges at which other than two boundary triangles meet: the boundary touches itself.
///
/// # Errors
/// If the connectivity is none of a solid.
pub fn irregular_boundary_edges(mesh: &SolidMesh) -> Result<Vec<[Vertex; 2]>> {
    let surface = SurfaceEdges::of(Level::new(mesh)?.boundary());
    let irregular = surface.triangles.iter().filter(|(_, n)| **n != 2);
    Ok(irregular.map(|(edge, _)| *edge).collect())
}

fn of_three_cells(edges: &[(&[Vertex; 2], &u32)]) -> Vec<[Vertex; 2]> {
    edges
        .iter()
        .filter(|(_, cells)| **cells == 3)
        .map(|(edge, _)| **edge)
        .collect()
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
    for corners in mesh.cells.corners() {
        let pairs: &[[usize; 2]] = match corners.len() {
            4 => &TETRAHEDRON_EDGES,
            _ => &OCTAHEDRON_EDGES,
        };
        for [a, b] in pairs {
            let (a, b) = (corners[*a], corners[*b]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    edges
}

/// The edges of the boundary with the number of boundary triangles at each, and its vertices.
struct SurfaceEdges {
    triangles: BTreeMap<[Vertex; 2], u32>,
    vertices: BTreeSet<Vertex>,
}

impl SurfaceEdges {
    fn of(surface: &[[Vertex; 3]]) -> Self {
        let mut triangles = BTreeMap::new();
        for [a, b, c] in surface {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                *triangles.entry([*a.min(b), *a.max(b)]).or_default() += 1;
            }
        }
        Self {
            triangles,
            vertices: surface.iter().flatten().copied().collect(),
        }
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
