//! Surface schemes once more, as masks written out vertex by vertex in `f64` that is exact.
//!
//! The reference exists to be compared with `!=`. It is written from the papers' formulas with
//! explicit meshes, maps and masks; it shares no line with the crate that it judges.
//!
//! Every refined vertex is a [`Row`]: integer numerators over a denominator, found from the rule's
//! own words ("the mean of the face points, twice the mean of the midpoints"). [`Row::round`]
//! applies it to 32-bit integers, exactly, and rounds once. The scheme of triangles and quads has
//! clones between, which are rounded too: [`TriQuad`].

mod butterfly;
mod catmull_clark;
mod doo_sabin;
mod loop_rule;
mod multi_step;
mod polygons;
mod row;
mod sqrt3;
mod tangents;
mod tri_quad;

pub use butterfly::butterfly;
pub use catmull_clark::{catmull_clark, catmull_clark_limit};
pub use doo_sabin::doo_sabin;
pub use loop_rule::{Family, loop_limit, loop_rule};
pub use multi_step::{after_steps, beside_limit};
pub use polygons::{Border, Kind, Polygons, edge, sides};
pub use row::{Grid, Row, WEIGHT_UNIT};
pub use sqrt3::{sqrt3, sqrt3_limit};
pub use tangents::{face_normals, limit_normals};
pub use tri_quad::{TriQuad, tri_quad};

/// A refined mesh and the mask of each of its vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// Connectivity.
    pub mesh: Polygons,
    /// Masks over the vertices of the level before.
    pub rows: Vec<Row>,
}

impl Refined {
    fn new(mesh: &Polygons, rows: Vec<Row>, faces: Vec<Vec<u32>>, creases: Vec<[u32; 2]>) -> Self {
        Self {
            mesh: Polygons {
                vertex_count: rows.len() as u32,
                faces,
                creases,
                corners: mesh.corners.clone(),
                odd: mesh.odd,
            },
            rows,
        }
    }

    /// The refined positions, rounded once.
    pub fn points(&self, points: &[[i32; 3]]) -> Vec<[i32; 3]> {
        apply(&self.rows, points)
    }
}

/// Masks on positions, rounded once.
pub fn apply(rows: &[Row], points: &[[i32; 3]]) -> Vec<[i32; 3]> {
    let value = |row: &Row, axis: usize| row.round(|vertex| points[vertex as usize][axis]);
    rows.iter()
        .map(|row| [value(row, 0), value(row, 1), value(row, 2)])
        .collect()
}

/// How many coordinates the masks take out of 32 bits.
pub fn count_saturated(rows: &[Row], points: &[[i32; 3]]) -> usize {
    let fits = |value: f64| value >= f64::from(i32::MIN) && value <= f64::from(i32::MAX);
    let value = |row: &Row, axis: usize| row.rounded(|vertex| points[vertex as usize][axis]);
    let values = rows
        .iter()
        .flat_map(|row| [0, 1, 2].map(|axis| value(row, axis)));
    values.filter(|value| !fits(*value)).count()
}

/// The row of a vertex that is not smooth.
fn crease_row(vertex: u32, kind: &Kind) -> Row {
    let Kind::Crease(a, b) = *kind else {
        return Row::vertex(vertex);
    };
    let ends = [(1.0, Row::vertex(a)), (1.0, Row::vertex(b))];
    let [one, other] = ends;
    Row::sum(&[(6.0, Row::vertex(vertex)), one, other], 8.0)
}

/// The limit of a vertex that is not smooth.
fn crease_limit_row(vertex: u32, kind: &Kind) -> Row {
    let Kind::Crease(a, b) = *kind else {
        return Row::vertex(vertex);
    };
    let ends = [(1.0, Row::vertex(a)), (1.0, Row::vertex(b))];
    let [one, other] = ends;
    Row::sum(&[(4.0, Row::vertex(vertex)), one, other], 6.0)
}
