//! Locating: points on faces, edges and vertices between cells are found, in the lowest cell, and
//! what the cell gives leads back to them.

mod common;

use common::model;
use octruss_bake::locate::{Embedding, Locator};
use octruss_bake::mesh::Point;
use octruss_bake::read;
use octruss_bake::refine::{BoundaryRule, Level, Refinement};

/// The finger refined twice: tetrahedra and octahedra of all shapes.
fn refined() -> (Level, Vec<Point>) {
    let cage = read::solid(&model("finger.msh")).unwrap();
    let (mut level, mut points) = (Level::new(&cage).unwrap(), cage.points);
    for _ in 0..2 {
        let mut step = Refinement::new(&level, BoundaryRule::Loop.to_core()).unwrap();
        points = step.points(&points).unwrap();
        level = step.split().unwrap();
    }
    (level, points)
}

fn at(points: &[Point], embedding: &Embedding) -> Point {
    let mut point = [0.0; 3];
    for (vertex, weight) in embedding {
        for axis in 0..3 {
            point[axis] += weight * points[*vertex as usize][axis];
        }
    }
    point
}

fn assert_found(points: &[Point], point: Point, embedding: &Embedding) {
    // A few roundings of coordinates of up to 103.
    const BOUND: f64 = 103.0 * 8.0 * f64::EPSILON;
    let again = at(points, embedding);
    assert!(
        (0..3).all(|axis| (again[axis] - point[axis]).abs() <= BOUND),
        "{point:?} {again:?}"
    );
    assert!(
        embedding.iter().all(|(_, weight)| *weight >= -1e-12),
        "{embedding:?}"
    );
}

#[test]
fn every_vertex_is_found_as_itself() {
    let (level, points) = refined();
    let boundary = level.boundary_faces();
    let locator = Locator::new(&level.cells, &boundary, &points);
    for (vertex, point) in points.iter().enumerate() {
        let embedding = locator
            .inside(*point)
            .unwrap_or_else(|| panic!("vertex {vertex} is lost"));
        assert_found(&points, *point, &embedding);
        let own = embedding
            .iter()
            .find(|(corner, _)| *corner as usize == vertex);
        assert!(
            own.is_some_and(|(_, weight)| (weight - 1.0).abs() <= 1e-12),
            "{embedding:?}"
        );
    }
}

/// Midpoints of edges and centroids of faces, as doubles round them, lie on one side or the other,
/// or in between: some cell has each, unless it is on the boundary and was rounded outward.
#[test]
fn points_between_cells_are_never_lost() {
    let (level, points) = refined();
    let boundary = level.boundary_faces();
    let locator = Locator::new(&level.cells, &boundary, &points);
    let faces: std::collections::BTreeSet<[u32; 3]> = level
        .cells
        .tetrahedra
        .iter()
        .flat_map(|cell| {
            octruss::mesh::TETRAHEDRON_FACES.map(|face| face.map(|corner| cell[corner]))
        })
        .map(|mut face| {
            face.sort_unstable();
            face
        })
        .collect();
    let mut lost = 0;
    for face in &faces {
        let corners = face.map(|vertex| points[vertex as usize]);
        let mean = |weights: [f64; 3]| -> Point {
            std::array::from_fn(|axis| {
                (0..3)
                    .map(|corner| weights[corner] * corners[corner][axis])
                    .sum()
            })
        };
        for point in [
            mean([0.5, 0.5, 0.0]),
            mean([0.25, 0.25, 0.5]),
            mean([0.1, 0.2, 0.7]),
        ] {
            match locator.inside(point) {
                Some(embedding) => assert_found(&points, point, &embedding),
                None => {
                    lost += 1;
                    let nearest = locator.nearest(point).unwrap();
                    assert!(
                        nearest.distance <= 103.0 * f64::EPSILON,
                        "{point:?} {nearest:?}"
                    );
                    assert_found(
                        &points,
                        point,
                        &locator.extrapolated(&nearest, point).unwrap(),
                    );
                }
            }
        }
    }
    assert!(lost < faces.len() / 10, "{lost} of {} faces", faces.len());
}

#[test]
fn the_lowest_cell_wins() {
    let (level, points) = refined();
    let boundary = level.boundary_faces();
    let locator = Locator::new(&level.cells, &boundary, &points);
    // Every vertex lies in a tetrahedron (each child of a tetrahedron has four corners of them).
    for (vertex, point) in points.iter().enumerate() {
        let lowest = level
            .cells
            .corners()
            .position(|cell| cell.contains(&(vertex as u32)))
            .unwrap();
        let cell: Vec<u32> = level.cells.corners().nth(lowest).unwrap().to_vec();
        let embedding = locator.inside(*point).unwrap();
        assert!(
            embedding.iter().all(|(corner, _)| cell.contains(corner)),
            "{vertex}: {embedding:?}"
        );
    }
}
