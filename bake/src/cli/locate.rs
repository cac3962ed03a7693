//! `octruss locate`.

use super::{print_figures, progress::Bars, scheme, show_notes};
use octruss_bake::error::{Error, Result, count};
use octruss_bake::locate::{Located, RefinedCage};
use octruss_bake::mesh::Cells;
use octruss_bake::read;
use octruss_bake::refine::{BoundaryRule, Scheme};
use octruss_bake::table::Outside;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Says in which refined cell of a cage each point lies
///
/// The cage at rest is refined as `octruss bake` does it, and each point is looked up: the refined
/// cell that holds it, the cell of the cage that this is a part of, the cell's label, and the weights
/// of the cell's corners that give the point (vertices are numbered as `octruss refine` writes them).
/// Of several cells that share a point the lowest is named, tetrahedra before octahedra. A point
/// outside is given the nearest point of the refined boundary, the cell behind that, and its
/// distance.
#[derive(clap::Args)]
pub struct Arguments {
    /// The cage at rest: Gmsh .msh, VTK .vtu or .vtk, Medit .mesh, TetGen .node with .ele
    cage: PathBuf,
    /// The points, in the cage's unit: .csv with the columns x, y, z, or the vertices of an .obj,
    /// .ply, .stl or .off
    #[arg(long, value_name = "FILE")]
    points: PathBuf,
    /// The subdivision scheme
    #[arg(long, value_enum, default_value_t)]
    scheme: Scheme,
    /// File with the major diagonals of the cage's cells, for `box-spline`: 0, 1 or 2 for each
    /// tetrahedron, then each octahedron, in file order; by default they are chosen
    #[arg(long, value_name = "FILE")]
    diagonals: Option<PathBuf>,
    /// How many times to refine the cage
    #[arg(long, value_name = "K", default_value_t = 2)]
    levels: u32,
    /// What the boundary follows: loop by default, with --scheme mixed tri-quad
    #[arg(long, value_enum)]
    boundary: Option<BoundaryRule>,
    /// File with features of the cage: a line each, `crease A B`, `crease-face A B C` or `corner A`
    #[arg(long, value_name = "FILE")]
    features: Option<PathBuf>,
    /// What to do with points outside the refined cage: `extrapolate` gives weights of the point itself
    /// in the cell behind the nearest place of the boundary, some of them negative
    #[arg(long, value_enum, default_value_t = Outside::Nearest)]
    outside: Outside,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// What is printed.
#[derive(Serialize)]
struct Figures {
    levels: u32,
    points: Vec<PointFigures>,
    points_outside: usize,
}

#[derive(Serialize)]
struct PointFigures {
    cell: CellName,
    cage_cell: CellName,
    /// `null` if the cage has no labels.
    label: Option<i32>,
    /// The corners of the refined cell.
    vertices: Vec<u32>,
    /// A weight for each of them.
    coordinates: Vec<f64>,
    /// 0 inside.
    distance_outside: f64,
}

#[derive(Serialize)]
struct CellName {
    shape: &'static str,
    /// Counted from 0 within the shape.
    index: usize,
}

impl CellName {
    fn of(cells: &Cells, place: usize) -> Self {
        let (shape, index) = cells.place(place);
        Self {
            shape: shape.names().0,
            index,
        }
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let cage = read::solid_with_features(&arguments.cage, arguments.features.as_deref())?;
    show_notes(&cage.notes);
    let points = read::points::read(&arguments.points)?;
    let diagonals = scheme::diagonals(arguments.scheme, arguments.diagonals.as_deref(), &cage)?;
    let of_cage = |error: Error| error.in_file(&arguments.cage);
    let refined = RefinedCage::new(
        &cage,
        arguments.scheme,
        diagonals.as_ref(),
        arguments.scheme.boundary(arguments.boundary)?,
        arguments.levels,
    )
    .map_err(of_cage)?;
    let located = refined
        .locate(&points, arguments.outside, &mut Bars::default())
        .map_err(|error| error.in_file(&arguments.points))?;
    let labels = refined.labels();
    let cells = &refined.level().cells;
    let corners: Vec<&[u32]> = cells.corners().collect();
    let figures = |point: &Located| PointFigures {
        cell: CellName::of(cells, point.cell),
        cage_cell: CellName::of(&cage.cells, refined.ancestor(point.cell)),
        label: labels.get(point.cell).copied(),
        vertices: corners[point.cell].to_vec(),
        coordinates: point.coordinates.clone(),
        distance_outside: point.distance,
    };
    let figures = Figures {
        levels: arguments.levels,
        points: located.iter().map(figures).collect(),
        points_outside: located.iter().filter(|point| point.distance > 0.0).count(),
    };
    print_figures(&figures, arguments.json, || words(&figures))
}

/// A line for each point, and how many lie outside. Writing to a string cannot fail.
fn words(figures: &Figures) -> String {
    let mut text = String::new();
    for (index, point) in figures.points.iter().enumerate() {
        let (cell, parent) = (&point.cell, &point.cage_cell);
        let _ = write!(text, "point {index}: {} {}", cell.shape, cell.index);
        let _ = write!(text, " of the cage's {} {}", parent.shape, parent.index);
        if let Some(label) = point.label {
            let _ = write!(text, ", label {label}");
        }
        if point.distance_outside > 0.0 {
            let _ = write!(text, ", outside by {}", point.distance_outside);
        }
        let mut separator = ": ";
        for (vertex, weight) in point.vertices.iter().zip(&point.coordinates) {
            let _ = write!(text, "{separator}{weight} of vertex {vertex}");
            separator = ", ";
        }
        text.push('\n');
    }
    let _ = write!(
        text,
        "{}, {} outside",
        count(figures.points.len(), "point", "points"),
        figures.points_outside
    );
    text
}
