//! The volume of the cells with a label, under the smooth map.
//!
//! Only a boundary that follows a surface scheme has an exact form. A region's border inside the
//! cage follows the solid's scheme, so its volume is that of the polyhedra of successive levels,
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

/// The volume of the cells with this label as one form over the control points, and a second one
/// from the levels before that it should agree with.
///
/// # Errors
/// If no cell has the label, or the form depends on too many control points.
pub fn forms(cage: &SolidMesh, rules: Rules<'_>, label: i32) -> Result<[ControlForm; 2]> {
    let mut labels = cage.labels.clone();
    if !labels.iter().any(|own| own == label) {
        return Err(Error::new(format!("no cell has the label {label}")).advise(
            "labels are the numbers of physical groups or references; `octruss info` lists them",
        ));
    }
    let mut level = Level::of_scheme(cage, rules.scheme, rules.diagonals)?;
    let control_points = level.vertex_count;
    let (mut matrices, mut forms) = (Vec::new(), Vec::new());
    while matrices.len() < FEWEST_LEVELS || level.cells.len() * CHILDREN <= MOST_CELLS {
        let mut refinement = Refinement::new(&level, rules.boundary.to_core())?;
        matrices.push(refinement.values(&mut RowBlend, &identity(level.vertex_count))?);
        level = refinement.split()?;
        labels = labels.refined();
        let own: Vec<bool> = labels.iter().map(|own| own == label).collect();
        forms.push(form(&level.cells, &own, &matrices, control_points)?);
    }
    let [.., first, second, third] = &forms[..] else {
        return Err(Error::new("a region is refined at least three times"));
    };
    Ok([
        ControlForm::extrapolated(second, third),
        ControlForm::extrapolated(first, second),
    ])
}

/// The volume of a polyhedron of cells: one determinant for each triangle of its border.
fn form(
    cells: &Cells,
    own: &[bool],
    matrices: &[Vec<Row>],
    control_points: u32,
) -> Result<ControlForm> {
    let border = border(cells, own);
    let mut vertices: Vec<u32> = border.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let wanted: Vec<Row> = vertices.iter().map(|vertex| vec![(*vertex, 1.0)]).collect();
    let rows = compose(&wanted, matrices, control_points);
    let wide = |(point, weight): &(u32, f64)| (*point as usize, *weight);
    let rows: Vec<Vec<(usize, f64)>> = rows
        .iter()
        .map(|row| row.iter().map(wide).collect())
        .collect();
    let local = |vertex: u32| vertices.binary_search(&vertex).unwrap_or_default() as u32;
    let triangles: Vec<[u32; 3]> = border.iter().map(|face| face.map(local)).collect();
    ControlForm::of_triangles(&triangles, &rows).map_err(|error| Error::new(error.to_string()))
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
