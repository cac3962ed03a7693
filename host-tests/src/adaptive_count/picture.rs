//! The comparison as a picture and as a table for people.

use std::fmt::Write as _;

use octruss_bake::error::Result;
use octruss_bake::picture::{LogCurve, LogPlot, log_plot};

use super::meshes::Closed;
use super::{Count, saving};

/// Draws triangles over tolerances, all meshes and both schemes, as PNG.
///
/// # Errors
/// If the drawing fails.
pub fn draw(meshes: &[(Closed, Vec<Count>)]) -> Result<Vec<u8>> {
    let mut curves = Vec::new();
    for (place, (mesh, counts)) in meshes.iter().enumerate() {
        let points = |of: fn(&Count) -> usize| {
            let pairs = counts.iter().map(|own| (own.tolerance, of(own) as f64));
            pairs.collect()
        };
        curves.push(LogCurve {
            name: format!("{}, square-root-3", mesh.name),
            points: points(|own| own.sqrt3),
            colour: place,
            is_thin: false,
        });
        curves.push(LogCurve {
            name: format!("{}, Loop red-green", mesh.name),
            points: points(|own| own.loop_rule),
            colour: place,
            is_thin: true,
        });
    }
    log_plot(&LogPlot {
        title: "Triangles that adaptive refinement needs",
        across: "tolerance, as a part of the mesh's extent",
        upward: "triangles",
        curves: &curves,
    })
}

/// A table of the counts.
pub fn table(meshes: &[(Closed, Vec<Count>)]) -> String {
    let mut text = String::new();
    for (mesh, counts) in meshes {
        let percent = 100.0 * saving(counts);
        let _ = writeln!(
            text,
            "{}: {percent:.1} % fewer triangles, geometric mean\n  tolerance  square-root-3  Loop",
            mesh.name
        );
        for own in counts {
            let (sqrt3, rival) = (own.sqrt3, own.loop_rule);
            let _ = writeln!(text, "  {:9.5}  {sqrt3:13}  {rival}", own.tolerance);
        }
    }
    text
}
