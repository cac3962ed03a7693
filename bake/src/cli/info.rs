//! `octruss info`.

use super::print_figures;
use super::scheme as schemes;
use octruss_bake::error::{Error, Result};
use octruss_bake::inspect::{Histogram, Inspection, inspect};
use octruss_bake::refine::{Interior, Level, Scheme};
use octruss_bake::{read, write};
use std::fmt::Write;
use std::path::PathBuf;

/// Prints what there is to know about a mesh
///
/// Cells by shape; valences of edges and vertices; creases and corners found; the boundary; cells
/// that are inverted (negative volume), flat or folded; and the arena capacities that refining the
/// mesh on a device needs, level by level.
#[derive(clap::Args)]
pub struct Arguments {
    /// The mesh: Gmsh .msh, VTK .vtu or .vtk, Medit .mesh, TetGen .node with .ele
    mesh: PathBuf,
    /// File with features: a line each, `crease A B`, `crease-face A B C` or `corner A`
    #[arg(long, value_name = "FILE")]
    features: Option<PathBuf>,
    /// The scheme that the mesh is to be refined with: box-spline adds the choice of major diagonals;
    /// by default tet-oct, or mixed for a mesh with prisms or hexahedra
    #[arg(long, value_enum)]
    scheme: Option<Scheme>,
    /// File with the major diagonals of the cells, for `box-spline`: 0, 1 or 2 for each
    /// tetrahedron, then each octahedron, in file order; by default they are chosen
    #[arg(long, value_name = "FILE")]
    diagonals: Option<PathBuf>,
    /// Also write the major diagonals, given or chosen, to a file that --diagonals reads
    #[arg(long, value_name = "OUT")]
    write_diagonals: Option<PathBuf>,
    /// Levels of refinement to list capacities for
    #[arg(long, value_name = "K", default_value_t = 3)]
    levels: u32,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let mesh = read::solid_with_features(&arguments.mesh, arguments.features.as_deref())?;
    let of_mesh = |error: Error| error.in_file(&arguments.mesh);
    let by_cells = if mesh.cells.is_tetrahedral() {
        Scheme::TetOct
    } else {
        Scheme::Mixed
    };
    let scheme = arguments.scheme.unwrap_or(by_cells);
    let mut inspection = inspect(&mesh, scheme, arguments.levels).map_err(of_mesh)?;
    let diagonals = schemes::diagonals(scheme, arguments.diagonals.as_deref(), &mesh)?;
    let level = Level::of_scheme(&mesh, scheme, diagonals.as_ref()).map_err(of_mesh)?;
    inspection.add_scheme(&level).map_err(of_mesh)?;
    if let Some(file) = &arguments.write_diagonals {
        let Interior::BoxSpline(diagonals) = &level.interior else {
            return Err(Error::new("only the scheme box-spline has major diagonals")
                .advise("add --scheme box-spline")
                .in_file(file));
        };
        write::atomically(file, |out| read::diagonals::write(diagonals, out))?;
    }
    print_figures(&inspection, arguments.json, || words(&inspection))
}

/// The figures as text. Writing to a string cannot fail.
fn words(inspection: &Inspection) -> String {
    let mut text = String::new();
    let mut line = |name: &str, content: String| {
        let _ = writeln!(text, "{name:<28}{content}");
    };
    line("vertices", inspection.vertices.to_string());
    let mut cells = format!(
        "{} tetrahedra, {} octahedra",
        inspection.tetrahedra, inspection.octahedra
    );
    let is_mixed = inspection.prisms + inspection.hexahedra > 0;
    if is_mixed {
        cells += &format!(
            ", {} prisms, {} hexahedra",
            inspection.prisms, inspection.hexahedra
        );
    }
    line("cells", cells);
    line(
        "edges, faces",
        format!("{}, {}", inspection.edges, inspection.faces),
    );
    if is_mixed {
        let [free, half, full] = inspection.quadrilaterals_by_covered_halves;
        line(
            "quadrilaterals",
            format!("{free} free, {half} half covered by a triangle, {full} covered by triangles"),
        );
    }
    if let Some([low, high]) = inspection.bounds {
        line("extent", format!("{low:?} to {high:?}"));
    }
    line(
        "interior edges",
        histogram(&inspection.interior_edge_valences, "cells"),
    );
    line(
        "boundary edges",
        histogram(&inspection.boundary_edge_valences, "cells"),
    );
    line(
        "interior vertices",
        histogram(&inspection.interior_vertex_valences, "cells"),
    );
    line(
        "boundary vertices",
        histogram(&inspection.boundary_vertex_valences, "cells"),
    );
    line(
        "",
        histogram(&inspection.surface_vertex_valences, "boundary edges"),
    );
    let quads = match inspection.boundary_quadrilaterals {
        0 => String::new(),
        quads => format!("{quads} quadrilaterals, "),
    };
    line(
        "boundary",
        format!(
            "{} triangles, {quads}{} edges",
            inspection.boundary_triangles, inspection.boundary_edges
        ),
    );
    features_and_volumes(&mut text, inspection);
    box_spline(&mut text, inspection);
    capacities(&mut text, inspection);
    for note in &inspection.notes {
        let _ = writeln!(text, "note: {note}");
    }
    for warning in warnings(inspection) {
        let _ = writeln!(text, "warning: {warning}");
    }
    text.truncate(text.trim_end().len());
    text
}

fn features_and_volumes(text: &mut String, inspection: &Inspection) {
    let mut line = |name: &str, content: String| {
        let _ = writeln!(text, "{name:<28}{content}");
    };
    line("creases", format!("{} edges", inspection.creases));
    if inspection.creases > 0 {
        line(
            "  their vertices",
            histogram(&inspection.crease_vertex_valences, "crease edges"),
        );
    }
    line("corners", inspection.corners.to_string());
    line("crease faces inside", inspection.crease_faces.to_string());
    if inspection.sheets > 0 {
        line("sheets", format!("{} triangles", inspection.sheets));
    }
    let labels: Vec<String> = inspection
        .labels
        .iter()
        .map(|(label, cells)| format!("{label} ({cells} cells)"))
        .collect();
    for (name, list) in [("labels", &labels), ("channels", &inspection.channels)] {
        if !list.is_empty() {
            line(name, some(list));
        }
    }
    for (name, cells) in [
        ("inverted cells", &inspection.inverted_cells),
        ("flat cells", &inspection.flat_cells),
        ("folded cells", &inspection.folded_cells),
    ] {
        line(name, some(cells));
    }
    let pairs: Vec<String> = inspection
        .overlapping_cells
        .iter()
        .map(|[a, b]| format!("{a} with {b}"))
        .collect();
    line("cells that share space", some(&pairs));
}

/// "12 with 4 cells, 3 with 6".
fn histogram(histogram: &Histogram, what: &str) -> String {
    let total: usize = histogram.values().sum();
    let entries: Vec<String> = histogram
        .iter()
        .map(|(valence, number)| format!("{number} with {valence}"))
        .collect();
    match entries.as_slice() {
        [] => "0".to_owned(),
        entries => format!("{total}: {} {what}", entries.join(", ")),
    }
}

/// How many, and the first few.
fn some(names: &[String]) -> String {
    const SHOWN: usize = 5;
    let shown: Vec<&str> = names.iter().take(SHOWN).map(String::as_str).collect();
    match names.len() {
        0 => "0".to_owned(),
        number if number > SHOWN => format!("{number}: {}, ...", shown.join(", ")),
        number => format!("{number}: {}", shown.join(", ")),
    }
}

/// What the box-spline schemes add.
fn box_spline(text: &mut String, inspection: &Inspection) {
    let Some(figures) = &inspection.box_spline else {
        return;
    };
    if let Some([first, second, third]) = figures.cells_by_diagonal {
        let _ = writeln!(
            text,
            "{:<28}0 in {first} cells, 1 in {second}, 2 in {third}",
            "major diagonals"
        );
        let faces: Vec<String> = figures
            .improper_faces
            .iter()
            .map(|[a, b, c]| format!("{a}-{b}-{c}"))
            .collect();
        let _ = writeln!(text, "{:<28}{}", "faces where they clash", some(&faces));
    }
    let _ = writeln!(
        text,
        "{:<28}{} at level 0, box_spline::Scratch<_, E, O, V, N>",
        "capacity N for neighbours", figures.scratch_neighbours
    );
}

/// Of the scheme mixed.
fn mixed_capacities(text: &mut String, inspection: &Inspection) {
    let _ = writeln!(
        text,
        "\ncapacities: MixedArena<T, O, P, H, S, Q, C, K> holds a level, NumberingScratch<E, F, D, R, O, H>\n\
         and PointScratch<_, N, V> refine it; N is the number of vertices, D = 2 F, R = 2 P\n\
         level          N          T          O          P          H          S          Q          C          K          E          F          V"
    );
    for row in &inspection.mixed_capacities {
        let _ = write!(text, "{:>5}", row.level);
        for number in [
            row.vertices,
            row.tetrahedra,
            row.octahedra,
            row.prisms,
            row.hexahedra,
            row.surface,
            row.surface_quads,
            row.creases,
            row.corners,
            row.scratch_edges,
            row.scratch_quads,
            row.scratch_vertices,
        ] {
            let _ = write!(text, " {number:>10}");
        }
        let _ = writeln!(text);
    }
    if let Some(first) = inspection.mixed_capacities.first() {
        let [triangles, quads] = first.faces_to_find_boundary;
        let _ = writeln!(
            text,
            "finding the boundary of level 0 takes a scratch of {triangles} triangles and {quads} quadrilaterals\n"
        );
    }
}

fn capacities(text: &mut String, inspection: &Inspection) {
    if !inspection.mixed_capacities.is_empty() {
        return mixed_capacities(text, inspection);
    }
    let _ = writeln!(
        text,
        "\ncapacities: SolidArena<T, O, S, C, K> holds a level, Scratch<_, E, O, V> refines it\n\
         level   vertices          T          O          S          C          K          E          V"
    );
    for row in &inspection.capacities {
        let _ = writeln!(
            text,
            "{:>5} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}",
            row.level,
            row.vertices,
            row.tetrahedra,
            row.octahedra,
            row.surface,
            row.creases,
            row.corners,
            row.scratch_edges,
            row.scratch_vertices
        );
    }
    if let Some(first) = inspection.capacities.first() {
        let _ = writeln!(
            text,
            "finding the boundary of level 0 takes a scratch of {} faces\n",
            first.faces_to_find_boundary
        );
    }
}

fn warnings(inspection: &Inspection) -> Vec<String> {
    let mut warnings = Vec::new();
    let edges: Vec<String> = inspection
        .interior_edges_of_valence_3
        .iter()
        .map(|[a, b]| format!("{a}-{b}"))
        .collect();
    if !edges.is_empty() {
        warnings.push(format!(
            "interior edges of three cells, along which the scheme is not smooth: {}",
            some(&edges)
        ));
    }
    if inspection.irregular_boundary_edges > 0 {
        warnings.push(format!(
            "{} boundary edges do not belong to exactly two boundary faces: the boundary touches itself there",
            inspection.irregular_boundary_edges
        ));
    }
    let unused: Vec<String> = inspection
        .unused_vertices
        .iter()
        .map(ToString::to_string)
        .collect();
    if !unused.is_empty() {
        warnings.push(format!(
            "vertices of no cell, control points that move nothing: {}",
            some(&unused)
        ));
    }
    let bad = [
        &inspection.inverted_cells,
        &inspection.flat_cells,
        &inspection.folded_cells,
    ];
    if !inspection.overlapping_cells.is_empty() {
        warnings.push("cells that share space are refused by `octruss bake`: a point there would belong to both".to_owned());
    }
    if bad.iter().any(|cells| !cells.is_empty()) {
        warnings.push(
            "inverted, flat and folded cells are refused by `octruss bake`; a cell that is only listed in the other order is mended by exchanging two of its corners".to_owned(),
        );
    }
    warnings
}
