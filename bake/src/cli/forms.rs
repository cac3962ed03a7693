//! `octruss forms`.

use super::print;
use octruss_bake::error::{Error, Result};
use octruss_bake::forms::exact::Field;
use octruss_bake::forms::make::{exact_form, real_form};
use octruss_bake::forms::neighbourhood::VertexFacet;
use octruss_bake::forms::{FormError, Scheme, TrilinearForm};
use octruss_bake::surface::SurfaceScheme;
use serde::Serialize;

/// Prints the trilinear form of a facet's volume
///
/// The volume of the cone from the origin over a facet of the limit surface is the sum over i < j < k of
/// a coefficient times the determinant of the control points i, j, k. Control points are counted from 0
/// in the order of Hakenberg, Reif, Schaefer and Warren (who count from 1). The cones of a closed
/// surface add up to the volume inside.
///
/// With tri-quad, sqrt3 and the butterflies the facet is a face, its corners are control points 0, 1, 2 (and 3),
/// counter-clockwise from the irregular vertex, and the others follow outward: for each point in this
/// order, the new vertices of the faces round it, counter-clockwise. --json lists those faces. What is printed
/// is the facet at the vertex; the facets in the next rings have forms of their own.
#[derive(clap::Args)]
pub struct Arguments {
    /// The subdivision scheme
    #[arg(long, value_enum)]
    scheme: SurfaceScheme,
    /// Edges at the facet's irregular vertex; for doo-sabin corners of its irregular face
    #[arg(long, value_name = "N", required_unless_present = "around")]
    valence: Option<usize>,
    /// For tri-quad: corners (3 or 4) of the faces round the irregular vertex, counter-clockwise, the
    /// facet's own first; --valence alone means triangles
    #[arg(
        long,
        value_name = "3,4,..",
        value_delimiter = ',',
        conflicts_with = "valence"
    )]
    around: Vec<usize>,
    /// Print exact fractions and roots, where there are such
    #[arg(long)]
    exact: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Figures {
    scheme: SurfaceScheme,
    valence: usize,
    control_points: usize,
    /// The faces that the control points are numbered in.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    faces: Vec<Vec<u32>>,
    coefficients: Vec<(usize, usize, usize, String)>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    let figures = match Scheme::of_surface(arguments.scheme) {
        Some(scheme) => of_valence(arguments, scheme)?,
        None => of_neighbourhood(arguments)?,
    };
    if arguments.json {
        return super::print_figures(&figures, true, String::new);
    }
    let line = |(i, j, k, value): &(usize, usize, usize, String)| format!("{i} {j} {k} {value}");
    let lines = figures.coefficients.iter().map(line).collect::<Vec<_>>();
    print(&lines.join("\n"))
}

fn failed(error: FormError) -> Error {
    Error::new(error.to_string())
}

fn of_valence(arguments: &Arguments, scheme: Scheme) -> Result<Figures> {
    let Some(valence) = arguments.valence else {
        return Err(
            Error::new("--around is for tri-quad, whose faces are of two kinds")
                .advise("give --valence"),
        );
    };
    let coefficients = if arguments.exact {
        let form = exact_form(scheme, valence).map_err(failed)?;
        listed(&form, ToString::to_string)
    } else {
        let form = real_form(scheme, valence).map_err(failed)?;
        listed(&form, |value| format!("{value:e}"))
    };
    Ok(Figures {
        scheme: arguments.scheme,
        valence,
        control_points: scheme.control_point_count(valence),
        faces: Vec::new(),
        coefficients,
    })
}

fn of_neighbourhood(arguments: &Arguments) -> Result<Figures> {
    if arguments.exact {
        return Err(
            Error::new("forms of this scheme are found by iteration in double precision")
                .advise("leave --exact out"),
        );
    }
    let is_mixed = arguments.scheme == SurfaceScheme::TriQuad;
    let takes = |corners: &usize| *corners == 3 || (is_mixed && *corners == 4);
    if let Some(other) = arguments.around.iter().find(|corners| !takes(corners)) {
        return Err(Error::new(format!(
            "the scheme takes no face of {other} corners: --around has {}",
            if is_mixed { "3 and 4" } else { "3 only" }
        )));
    }
    let around = match arguments.valence {
        Some(valence) => vec![3; valence],
        None => arguments.around.clone(),
    };
    let facet = VertexFacet::new(arguments.scheme, &around).map_err(failed)?;
    let list = listed(&facet.form, |value| format!("{value:e}"));
    let named = list.into_iter().map(|(i, j, k, value)| {
        let [i, j, k] = [i, j, k].map(|index| facet.places[index]);
        (i, j, k, value)
    });
    Ok(Figures {
        scheme: arguments.scheme,
        valence: around.len(),
        control_points: facet.places.len(),
        faces: facet.patch.faces.clone(),
        coefficients: named.collect(),
    })
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
