//! The volume of the cells with a label, or of all cells, under the smooth map.
//!
//! Only a boundary that follows a surface scheme with a form has an exact volume. A region's border inside
//! the cage, and a boundary that has no rule of its own, follow the solid's scheme, so the volume is that of
//! the polyhedra of successive levels,
//! extrapolated: their error falls by four a level.

use super::control::ControlForm;
use crate::error::{Error, Result};
use crate::mesh::{Cells, SolidMesh, Vertex};
use crate::refine::rows::{Row, RowBlend, compose, identity};
use crate::refine::{BoundaryRule, DiagonalLists, Level, Refinement, Scheme};
use std::collections::HashMap;

/// A region is refined so many times at least...
const FEWEST_LEVELS: usize = 3;
/// ...and further while the whole cage has no more cells than this.
const MOST_CELLS: usize = 50_000;

/// A level has about so many cells for each of the one before.
const CHILDREN: usize = 8;

/// How the cage is refined.
#[derive(Clone, Copy, Debug)]
pub struct Rules<'a> {
    /// The scheme.
    pub scheme: Scheme,
    /// Major diagonals, for box splines.
    pub diagonals: Option<&'a DiagonalLists>,
    /// What the boundary follows.
    pub boundary: BoundaryRule,
}

/// The border of a region at one level: a closed polyhedron.
#[derive(Clone, Debug)]
pub struct Border {
    /// Counter-clockwise from outside; vertices are places in `rows`.
    pub triangles: Vec<[u32; 3]>,
    /// The vertices as sums over the control points.
    pub rows: Vec<Vec<(usize, f64)>>,
}

/// The volume of the cells with this label, or of all cells, as one form over the control points, and a
/// second one from the levels before that it should agree with.
///
/// # Errors
/// If no cell has the label, or the form depends on too many control points.
pub fn forms(cage: &SolidMesh, rules: Rules<'_>, label: Option<i32>) -> Result<[ControlForm; 2]> {
    let mut forms = Vec::new();
    for border in borders(cage, rules, label)? {
        let form = ControlForm::of_triangles(&border.triangles, &border.rows);
        forms.push(form.map_err(|error| Error::new(error.to_string()))?);
    }
    let [first, second, third] = &forms[..] else {
        return Err(Error::new("a region is refined at least three times"));
    };
    Ok([
        ControlForm::extrapolated(second, third),
        ControlForm::extrapolated(first, second),
    ])
}

/// The borders of the cells with this label, or of all cells, at the last three levels.
///
/// # Errors
/// If no cell has the label, or the cage cannot be refined.
pub fn borders(cage: &SolidMesh, rules: Rules<'_>, label: Option<i32>) -> Result<Vec<Border>> {
    let is_own = |own: i32| label.is_none_or(|label| own == label);
    let mut labels = cage.labels.clone();
    if let Some(label) = label.filter(|_| !labels.iter().any(is_own)) {
        return Err(Error::new(format!("no cell has the label {label}")).advise(
            "labels are the numbers of physical groups or references; `octruss info` lists them",
        ));
    }
    let mut level = Level::of_scheme(cage, rules.scheme, rules.diagonals)?;
    let control_points = level.vertex_count;
    let (mut matrices, mut borders) = (Vec::new(), Vec::new());
    while matrices.len() < FEWEST_LEVELS || level.cells.len() * CHILDREN <= MOST_CELLS {
        let mut refinement = Refinement::new(&level, rules.boundary.to_core())?;
        matrices.push(refinement.values(&mut RowBlend, &identity(level.vertex_count))?);
        level = refinement.split()?;
        labels = labels.refined();
        let own: Vec<bool> = match label {
            None => vec![true; level.cells.len()],
            Some(_) => labels.iter().map(is_own).collect(),
        };
        borders.push(border_of(&level.cells, &own, &matrices, control_points));
        if borders.len() > 3 {
            borders.remove(0);
        }
    }
    Ok(borders)
}

/// The border of these cells, with its vertices over the control points.
fn border_of(cells: &Cells, own: &[bool], matrices: &[Vec<Row>], control_points: u32) -> Border {
    let border = border(cells, own);
    let mut vertices: Vec<u32> = border.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let wanted: Vec<Row> = vertices.iter().map(|vertex| vec![(*vertex, 1.0)]).collect();
    let rows = compose(&wanted, matrices, control_points);
    let wide = |(point, weight): &(u32, f64)| (*point as usize, *weight);
    let local = |vertex: u32| vertices.binary_search(&vertex).unwrap_or_default() as u32;
    Border {
        triangles: border.iter().map(|face| face.map(local)).collect(),
        rows: rows
            .iter()
            .map(|row| row.iter().map(wide).collect())
            .collect(),
    }
}

/// The faces that one of these cells has and no other, counter-clockwise from outside.
fn border(cells: &Cells, own: &[bool]) -> Vec<[Vertex; 3]> {
    let mut kept: HashMap<[Vertex; 3], Option<[Vertex; 3]>> = HashMap::new();
    let mut order = Vec::new();
    for face in faces(cells, own) {
        let mut key = face;
        key.sort_unstable();
        kept.entry(key)
            .and_modify(|face| *face = None)
            .or_insert_with(|| {
                order.push(key);
                Some(face)
            });
    }
    order.iter().filter_map(|key| kept[key]).collect()
}

/// The faces of these cells, counter-clockwise from outside of a positive cell. Quadrilaterals are cut
/// along the diagonal of their least vertex, so that those between two cells go away as triangles do;
/// what that is off from the bilinear face falls by four a level, as the polyhedron's error does.
fn faces(cells: &Cells, own: &[bool]) -> Vec<[Vertex; 3]> {
    let mut faces = Vec::new();
    for ((shape, corners), _) in cells.iter().zip(own).filter(|(_, own)| **own) {
        let triangles = shape.triangles().iter();
        faces.extend(triangles.map(|face| face.map(|place| corners[place])));
        for face in shape.quads() {
            let [a, b, c, d] = face.map(|place| corners[place]);
            if a.min(c) < b.min(d) {
                faces.extend([[a, b, c], [a, c, d]]);
            } else {
                faces.extend([[b, c, d], [b, d, a]]);
            }
        }
    }
    faces
}
