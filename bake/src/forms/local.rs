//! The refinement of one facet: the matrices that map its control points to those of its children.

use super::error::FormError;
use super::exact::Field;
use super::scheme::{Row, Scheme};

/// The control points of each of a facet's four children as rows over the facet's own; the last
/// child keeps the irregular place.
pub type Children<F> = [Vec<Row<F>>; 4];

/// The children of a facet of this valence.
///
/// # Errors
///
/// [`FormError::NotExact`] if the weights do not lie in the field, [`FormError::Valence`] if there
/// is no such facet.
pub fn children<F: Field>(scheme: Scheme, valence: usize) -> Result<Children<F>, FormError> {
    if !(3..=MAX_VALENCE).contains(&valence) {
        return Err(FormError::Valence { valence });
    }
    let (mesh, facet) = scheme.template(valence);
    let own = scheme.control_points(&mesh, facet);
    let refined = scheme.refine(&mesh);
    let child = |facet| {
        let points = scheme.control_points(&refined, facet);
        let rows = points.into_iter().map(|vertex| {
            let row = scheme.row::<F>(&mesh, vertex)?;
            let local = row.into_iter().map(|(vertex, weight)| {
                let place = own.iter().position(|&point| point == vertex);
                (
                    place.expect("a facet's control points determine its children"),
                    weight,
                )
            });
            let mut local = local.collect::<Vec<_>>();
            local.sort_unstable_by_key(|entry| entry.0);
            Some(local)
        });
        rows.collect::<Option<Vec<_>>>()
            .ok_or(FormError::NotExact { valence })
    };
    let [one, two, three, last] = scheme.children(&mesh, facet);
    Ok([child(one)?, child(two)?, child(three)?, child(last)?])
}

/// The greatest valence that a form is made for.
pub const MAX_VALENCE: usize = 64;
