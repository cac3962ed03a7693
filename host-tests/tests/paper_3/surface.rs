//! The triangle/quadrilateral scheme (examples 4.2 and 5.2), on sheets: surfaces without cells. Every
//! figure is held against both of the crate's: the sheets of mixed solids, and the surface scheme.

use std::collections::BTreeMap;

use num_rational::BigRational;
use octruss_host_tests::mixed_subject::{ExactRows, Row, masks, ratio, unit_rows};
use octruss_host_tests::reference_mixed::{Boundary, Mesh, Names};
use octruss_host_tests::reference_surface::{Border, Polygons, edge};
use octruss_host_tests::surface_subject::refine_tri_quad;

/// The masks of a sheet's vertices by the surface scheme, and the sheet as it takes it.
fn surface_masks(mesh: &Mesh) -> (Polygons, Vec<Row>) {
    let triangles = mesh.triangles.iter().map(|face| face.to_vec());
    let quads = mesh.quads.iter().map(|face| face.to_vec());
    let surface = Polygons {
        vertex_count: mesh.vertex_count,
        faces: triangles.chain(quads).collect(),
        ..Polygons::default()
    };
    let points = unit_rows(mesh.vertex_count);
    let blend = &mut ExactRows::default();
    let (_, rows) = refine_tri_quad(blend, Border::Spline, &surface, &points).expect("a surface");
    (surface, rows)
}

/// The mask of a vertex that the surface scheme numbers as it stands.
fn surface_mask(mesh: &Mesh, vertex: usize) -> Row {
    surface_masks(mesh).1[vertex].clone()
}

/// A sheet of squares below a line and triangles above it: vertices by column and row, the line is
/// row 0; triangles have edges along columns, rows and from (1, 0) to (0, 1).
struct Sheet {
    mesh: Mesh,
    vertices: BTreeMap<[i32; 2], u32>,
}

impl Sheet {
    fn new(reach: i32) -> Self {
        let mut sheet = Self {
            mesh: Mesh::default(),
            vertices: BTreeMap::new(),
        };
        for x in -reach..=reach {
            for y in -reach..=reach {
                let next = sheet.vertices.len() as u32;
                sheet.vertices.insert([x, y], next);
            }
        }
        sheet.mesh.vertex_count = sheet.vertices.len() as u32;
        for x in -reach..reach {
            for y in -reach..reach {
                let [a, b, c, d] =
                    [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]].map(|at| sheet.vertices[&at]);
                if y < 0 {
                    sheet.mesh.quads.push([a, b, c, d]);
                } else {
                    sheet.mesh.triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
        sheet
    }

    /// The mask of the mean of some vertices, by place.
    fn mask(&self, parents: &[[i32; 2]]) -> BTreeMap<[i32; 2], BigRational> {
        let (_, rows) = masks(&self.mesh, Boundary::TriQuad, &mut ExactRows::default());
        let parents: Vec<u32> = parents.iter().map(|at| self.vertices[at]).collect();
        let row: &Row = &rows[Names::new(&self.mesh).vertex(&parents, 0) as usize];
        let (surface, rows) = surface_masks(&self.mesh);
        let vertex = match parents.as_slice() {
            [a, b] => surface.middles()[&edge(*a, *b)],
            _ => parents[0],
        };
        assert_eq!(&rows[vertex as usize], row, "the two masks");
        let place = |vertex: u32| {
            let found = self.vertices.iter().find(|(_, other)| **other == vertex);
            *found.expect("a vertex").0
        };
        let entries = row.iter();
        entries
            .map(|(vertex, weight)| (place(*vertex), weight.clone()))
            .collect()
    }
}

fn expected(entries: &[([i32; 2], i64, i64)]) -> BTreeMap<[i32; 2], BigRational> {
    entries
        .iter()
        .map(|(place, numerator, denominator)| (*place, ratio(*numerator, *denominator)))
        .collect()
}

/// The stencil printed below (4.2.4) as 1/8, 3/8, 1/128, 139/348, 49/348, 1/384, whose two middle
/// denominators are misprints of 384: an edge from the line to the row of triangles above.
#[test]
fn an_edge_beside_the_line_has_the_printed_stencil() {
    let mask = Sheet::new(3).mask(&[[0, 0], [0, 1]]);
    let want = expected(&[
        ([-1, 1], 1, 8),
        ([0, 1], 3, 8),
        ([-1, 0], 1, 128),
        ([0, 0], 139, 384),
        ([1, 0], 49, 384),
        ([2, 0], 1, 384),
    ]);
    assert_eq!(mask, want);
}

/// Pure triangles: 5/8 of the vertex and 3/8 of the mean of its neighbours, at every valence.
#[test]
fn triangles_alone_have_three_over_eight_n() {
    for valence in 3..10_u32 {
        let mesh = Mesh {
            vertex_count: valence + 1,
            triangles: (0..valence)
                .map(|place| [0, 1 + place, 1 + (place + 1) % valence])
                .collect(),
            ..Mesh::default()
        };
        let (_, rows) = masks(&mesh, Boundary::TriQuad, &mut ExactRows::default());
        let mut want = Row::from([(0, ratio(5, 8))]);
        for neighbour in 1..=valence {
            want.insert(neighbour, ratio(3, 8 * i64::from(valence)));
        }
        assert_eq!(rows[0], want);
        assert_eq!(surface_mask(&mesh, 0), want);
    }
}

/// Pure quadrilaterals: 9/16 of the vertex, 6/16 of the mean of its edge neighbours and 1/16 of that
/// of the opposite corners, at every valence; at 4 that is Catmull-Clark.
#[test]
fn quadrilaterals_alone_have_nine_six_one() {
    for valence in 3..9_u32 {
        let mesh = Mesh {
            vertex_count: 2 * valence + 1,
            quads: (0..valence)
                .map(|place| {
                    let next = (place + 1) % valence;
                    [0, 1 + place, 1 + valence + place, 1 + next]
                })
                .collect(),
            ..Mesh::default()
        };
        let (_, rows) = masks(&mesh, Boundary::TriQuad, &mut ExactRows::default());
        let count = i64::from(valence);
        let mut want = Row::from([(0, ratio(9, 16))]);
        for place in 0..valence {
            want.insert(1 + place, ratio(6, 16 * count));
            want.insert(1 + valence + place, ratio(1, 16 * count));
        }
        assert_eq!(rows[0], want);
        assert_eq!(surface_mask(&mesh, 0), want);
    }
}

/// A regular vertex on the line, worked out by hand from (5.3.3) and the collapse: three triangles
/// and two squares. Weights of the clones: triangles 3/6 of (5/8, 3/16, 3/16), squares 2/4 of
/// (9/16, 3/16, 3/16, 1/16), over 3/6 + 2/4.
#[test]
fn a_vertex_on_the_line_is_the_mean_of_both_sides() {
    let mask = Sheet::new(3).mask(&[[0, 0]]);
    // Triangles (a, b, d) and (b, c, d) at the origin: two quarters of the ring above.
    let triangle_clones = [
        ([0, 0], 5, 8),
        ([1, 0], 1, 16),
        ([0, 1], 1, 8),
        ([-1, 1], 1, 8),
        ([-1, 0], 1, 16),
    ];
    let square_clones = [
        ([0, 0], 9, 16),
        ([1, 0], 3, 32),
        ([-1, 0], 3, 32),
        ([0, -1], 3, 16),
        ([1, -1], 1, 32),
        ([-1, -1], 1, 32),
    ];
    let mut want: BTreeMap<[i32; 2], BigRational> = BTreeMap::new();
    for (entries, sign) in [(&triangle_clones[..], 1), (&square_clones[..], -1)] {
        for ([x, y], numerator, denominator) in entries {
            let weight = ratio(*numerator, 2 * denominator);
            // The clone of a vertex on the line: 1 -+ 1/24, +- 1/48 of both neighbours.
            let spread = if *y == 0 {
                [(-1, 1), (0, -2), (1, 1)]
            } else {
                [(0, 0); 3]
            };
            *want.entry([*x, *y]).or_insert(ratio(0, 1)) += weight.clone();
            for (step, share) in spread {
                let part = &weight * ratio(sign * share, 48);
                *want.entry([x + step, *y]).or_insert(ratio(0, 1)) += part;
            }
        }
    }
    want.retain(|_, weight| *weight != ratio(0, 1));
    assert_eq!(mask, want);
}
