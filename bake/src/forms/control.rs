//! The enclosed volume as one form over the control points.
//!
//! What is shipped to a device: every facet's form, or every triangle's determinant, carried back
//! through the refinement to the control points and added up.

use std::collections::{BTreeMap, BTreeSet};

use super::error::FormError;
use super::form::{TrilinearForm, triples};
use super::scheme::Row;
use super::surface::LimitSurface;

/// The enclosed volume as an alternating form over the control points that it depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlForm {
    /// The control points, ascending.
    pub points: Vec<usize>,
    /// The form over them, in this order.
    pub form: TrilinearForm<f64>,
}

/// The most control points that one form is made over: its coefficients then fill 86 megabytes.
pub const MOST_CONTROL_POINTS: usize = 400;

impl ControlForm {
    /// The volume that a limit surface encloses.
    ///
    /// # Errors
    ///
    /// [`FormError::TooManyPoints`] if it depends on more than [`MOST_CONTROL_POINTS`].
    pub fn of_surface(surface: &LimitSurface<f64>) -> Result<Self, FormError> {
        let rows = compose(surface.refinements());
        let all = surface.facets().iter().flat_map(|facet| &facet.points);
        let mut sum = Sum::new(all.map(|&vertex| &rows[vertex]))?;
        for facet in surface.facets() {
            let own = facet.points.iter().map(|&vertex| rows[vertex].clone());
            sum.add(surface.form_of(facet), own.collect());
        }
        Ok(sum.finish())
    }

    /// The volume of a closed triangle mesh whose vertices are these rows over the control points.
    ///
    /// # Errors
    ///
    /// [`FormError::TooManyPoints`] if it depends on more than [`MOST_CONTROL_POINTS`].
    pub fn of_triangles(triangles: &[[u32; 3]], rows: &[Row<f64>]) -> Result<Self, FormError> {
        Self::of_faces(triangles.iter().map(<[u32; 3]>::as_slice), rows)
    }

    /// The same of a closed mesh of polygons, each a fan of triangles round the mean of its corners.
    ///
    /// # Errors
    ///
    /// [`FormError::TooManyPoints`] if it depends on more than [`MOST_CONTROL_POINTS`].
    pub fn of_faces<'a>(
        faces: impl Iterator<Item = &'a [u32]>,
        rows: &[Row<f64>],
    ) -> Result<Self, FormError> {
        let faces = faces.collect::<Vec<_>>();
        let all = faces.iter().copied().flatten();
        let mut sum = Sum::new(all.map(|&vertex| &rows[vertex as usize]))?;
        let mut fans = BTreeMap::new();
        for face in faces {
            let fan = fans.entry(face.len()).or_insert_with(|| fan(face.len()));
            let own = face.iter().map(|&vertex| rows[vertex as usize].clone());
            sum.add(fan, own.collect());
        }
        Ok(sum.finish())
    }

    /// The limit of two forms over the same points, of which the finer has a quarter of the
    /// coarser's error.
    #[must_use]
    pub fn extrapolated(coarser: &Self, finer: &Self) -> Self {
        Self::combined(coarser, finer, |coarse, fine| (4.0 * fine - coarse) / 3.0)
    }

    /// Two forms over the same points made one, coefficient by coefficient.
    #[must_use]
    pub fn combined(coarser: &Self, finer: &Self, combine: impl Fn(f64, f64) -> f64) -> Self {
        let pairs = coarser
            .form
            .coefficients()
            .iter()
            .zip(finer.form.coefficients());
        let mut limits = pairs.map(|(coarse, fine)| combine(*coarse, *fine));
        Self {
            points: finer.points.clone(),
            form: TrilinearForm::from_fn(finer.points.len(), |_, _, _| {
                limits.next().unwrap_or_default()
            }),
        }
    }

    /// The volume, for positions of all control points.
    #[must_use]
    pub fn volume(&self, points: &[[f64; 3]]) -> f64 {
        self.form.value(&self.own(points))
    }

    /// The derivative by each of [`ControlForm::points`].
    #[must_use]
    pub fn gradient(&self, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut gradient = vec![[0.0; 3]; self.points.len()];
        self.form.add_gradient(&self.own(points), &mut gradient);
        gradient
    }

    fn own(&self, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
        self.points.iter().map(|&point| points[point]).collect()
    }
}

/// The cone over a polygon: six times `n` times its volume is the sum over edges and other corners of
/// their determinants.
pub(super) fn fan(corners: usize) -> TrilinearForm<f64> {
    let mut form = TrilinearForm::zero(corners);
    let share = 1.0 / (6.0 * corners as f64);
    for from in 0..corners {
        let to = (from + 1) % corners;
        for other in (0..corners).filter(|other| ![from, to].contains(other)) {
            let mut triple = [other, from, to];
            triple.sort_unstable();
            let [a, b, c] = triple;
            let even = [[a, b, c], [b, c, a], [c, a, b]].contains(&[other, from, to]);
            form.add_to(triple, if even { share } else { -share });
        }
    }
    form
}

/// A form under construction.
struct Sum {
    points: Vec<usize>,
    form: TrilinearForm<f64>,
}

impl Sum {
    fn new<'a>(rows: impl Iterator<Item = &'a Row<f64>>) -> Result<Self, FormError> {
        let points = rows.flatten().map(|(point, _)| *point);
        let points = points
            .collect::<BTreeSet<_>>()
            .into_iter()
            .collect::<Vec<_>>();
        if points.len() > MOST_CONTROL_POINTS {
            return Err(FormError::TooManyPoints {
                points: points.len(),
            });
        }
        let form = TrilinearForm::zero(points.len());
        Ok(Self { points, form })
    }

    /// Adds a local form whose control points are these rows.
    fn add(&mut self, local: &TrilinearForm<f64>, mut rows: Vec<Row<f64>>) {
        let near = rows.iter().flatten().map(|(point, _)| *point);
        let near = near
            .collect::<BTreeSet<_>>()
            .into_iter()
            .collect::<Vec<_>>();
        for (point, _) in rows.iter_mut().flatten() {
            *point = near.binary_search(point).unwrap_or_default();
        }
        let pulled = local.pull_back(&rows, near.len());
        let places = near.iter().map(|point| self.points.binary_search(point));
        let places = places.map(Result::unwrap_or_default).collect::<Vec<_>>();
        for (triple, value) in triples(near.len()).zip(pulled.coefficients()) {
            self.form.add_to(triple.map(|index| places[index]), *value);
        }
    }

    fn finish(self) -> ControlForm {
        ControlForm {
            points: self.points,
            form: self.form,
        }
    }
}

/// The refined vertices as rows over the control points.
fn compose(refinements: &[Vec<Row<f64>>]) -> Vec<Row<f64>> {
    let mut composed: Option<Vec<Row<f64>>> = None;
    for rows in refinements {
        composed = Some(match composed {
            None => rows.clone(),
            Some(before) => rows.iter().map(|row| product(row, &before)).collect(),
        });
    }
    composed.unwrap_or_default()
}

fn product(row: &Row<f64>, before: &[Row<f64>]) -> Row<f64> {
    let mut builder = super::scheme::RowBuilder::new();
    for (vertex, weight) in row {
        for (point, own) in &before[*vertex] {
            builder.add(*point, &(weight * own));
        }
    }
    builder.finish()
}
