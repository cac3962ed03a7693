//! `octruss forms`.

use super::print;
use octruss_bake::error::{Error, Result};
use octruss_bake::forms::exact::Field;
use octruss_bake::forms::make::{exact_form, real_form};
use octruss_bake::forms::{Scheme, TrilinearForm};
use serde::Serialize;

/// Prints the trilinear form of a facet's volume
///
/// The volume of the cone from the origin over a facet of the limit surface is the sum over i < j < k of
/// a coefficient times the determinant of the control points i, j, k. Control points are counted from 0
/// in the order of Hakenberg, Reif, Schaefer and Warren (who count from 1). The cones of a closed
/// surface add up to the volume inside.
#[derive(clap::Args)]
pub struct Arguments {
    /// The subdivision scheme
    #[arg(long, value_enum)]
    scheme: Scheme,
    /// Edges at the facet's irregular vertex; for doo-sabin corners of its irregular face
    #[arg(long, value_name = "N")]
    valence: usize,
    /// Print exact fractions and roots, where there are such
    #[arg(long)]
    exact: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Figures {
    scheme: &'static str,
    valence: usize,
    control_points: usize,
    coefficients: Vec<(usize, usize, usize, String)>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let coefficients = coefficients(arguments)?;
    if arguments.json {
        let figures = Figures {
            scheme: arguments.scheme.name(),
            valence: arguments.valence,
            control_points: arguments.scheme.control_point_count(arguments.valence),
            coefficients,
        };
        return super::print_figures(&figures, true, String::new);
    }
    let line = |(i, j, k, value): (usize, usize, usize, String)| format!("{i} {j} {k} {value}");
    let lines = coefficients.into_iter().map(line).collect::<Vec<_>>();
    print(&lines.join("\n"))
}

fn coefficients(arguments: &Arguments) -> Result<Vec<(usize, usize, usize, String)>> {
    let failed = |error: octruss_bake::forms::FormError| Error::new(error.to_string());
    if arguments.exact {
        let form = exact_form(arguments.scheme, arguments.valence).map_err(failed)?;
        return Ok(listed(&form, ToString::to_string));
    }
    let form = real_form(arguments.scheme, arguments.valence).map_err(failed)?;
    Ok(listed(&form, |value| format!("{value:e}")))
}

fn listed<F: Field>(
    form: &TrilinearForm<F>,
    text: impl Fn(&F) -> String,
) -> Vec<(usize, usize, usize, String)> {
    let mut list = Vec::new();
    for i in 0..form.size() {
        for j in i + 1..form.size() {
            for k in j + 1..form.size() {
                let value = form.get(i, j, k);
                if !value.is_zero() {
                    list.push((i, j, k, text(&value)));
                }
            }
        }
    }
    list
}
