//! What goes along when a solid is refined: crease surfaces, labels of cells, channels of vertices.

use octruss_bake::mesh::{Cells, Channel, Features, Labels, Point, SolidMesh};
use octruss_bake::refine::{BoundaryRule, Channels, Level, Refinement};
use octruss_bake::table::format::Format;

/// Two tetrahedra above and below the plane z = 0, the lower one flatter. Every axis has the
/// largest magnitude 2, so that the format of a channel with the values of an axis is that of the points.
fn two_tetrahedra(faces: Vec<[u32; 3]>) -> SolidMesh {
    SolidMesh {
        points: vec![
            [0.0, 0.0, 0.0],
            [2.0, 0.25, 0.0],
            [0.0, 2.0, 0.0],
            [0.5, 0.25, 2.0],
            [0.5, 0.5, -1.0],
        ],
        cells: Cells {
            tetrahedra: vec![[0, 1, 2, 3], [0, 2, 1, 4]],
            octahedra: vec![],
            ..Cells::default()
        },
        features: Features {
            faces,
            ..Features::default()
        },
        labels: Labels {
            tetrahedra: vec![1, -2],
            octahedra: vec![],
            ..Labels::default()
        },
        ..SolidMesh::default()
    }
}

/// The points, the last level and its labels after two refinements.
fn refined(mesh: &SolidMesh, rule: BoundaryRule) -> (Vec<Point>, Level, Labels) {
    let mut level = Level::new(mesh).unwrap();
    let (mut points, mut labels) = (mesh.points.clone(), mesh.labels.clone());
    for _ in 0..2 {
        let mut step = Refinement::new(&level, rule.to_core()).unwrap();
        points = step.points(&points).unwrap();
        labels = labels.refined();
        level = step.split().unwrap();
    }
    (points, level, labels)
}

/// A crease's rule takes points of the crease alone, and a surface rule, at edges of two triangles,
/// those of the surface alone. So a flat crease surface whose rim is a crease stays in its plane,
/// exactly, and every cell stays on its parent's side, which its label names. Without the surface
/// the flatter side pulls the vertices inside the rim out of the plane.
#[test]
fn a_crease_surface_keeps_its_plane_and_labels_their_side() {
    for rule in [
        BoundaryRule::Loop,
        BoundaryRule::LoopWarren,
        BoundaryRule::TriQuad,
        BoundaryRule::Interior,
    ] {
        let with_rim = |faces: Vec<[u32; 3]>| {
            let mut mesh = two_tetrahedra(faces);
            mesh.features.creases = vec![[0, 1], [0, 2], [1, 2]];
            mesh
        };
        let (points, level, labels) = refined(&with_rim(vec![[0, 1, 2]]), rule);
        assert_eq!(level.crease_faces().len(), 16);
        for vertex in level.crease_faces().iter().flatten() {
            assert_eq!(points[*vertex as usize][2], 0.0, "{rule:?}");
        }
        assert_eq!(labels.tetrahedra.len(), level.cells.tetrahedra.len());
        assert_eq!(labels.octahedra.len(), level.cells.octahedra.len());
        for (cell, label) in level.cells.corners().zip(labels.iter()) {
            let height: f64 = cell.iter().map(|vertex| points[*vertex as usize][2]).sum();
            assert_eq!(label, if height > 0.0 { 1 } else { -2 }, "{rule:?}");
        }
        let (smooth, ..) = refined(&with_rim(vec![]), rule);
        let moves = |vertex: &u32| smooth[*vertex as usize][2] != 0.0;
        assert!(level.crease_faces().iter().flatten().any(moves), "{rule:?}");
    }
}

#[test]
fn a_crease_face_is_a_face_of_a_cell() {
    let error = Level::new(&two_tetrahedra(vec![[1, 3, 4]])).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the crease face of vertices 1, 3 and 4 (counted from 0) is no face of a cell\n  help: a crease surface runs along faces of the mesh; mesh the surface together with the volume"
    );
    // On the boundary it changes nothing.
    let plain = refined(&two_tetrahedra(vec![]), BoundaryRule::Loop);
    let faced = refined(&two_tetrahedra(vec![[0, 1, 3]]), BoundaryRule::Loop);
    assert_eq!(plain, faced);
}

/// A channel with the values of a coordinate stays equal to that coordinate, bit for bit, in double
/// precision and in the device's numbers: both go through the same masks.
#[test]
fn channels_follow_the_masks_of_the_coordinates() {
    let mesh = two_tetrahedra(vec![[0, 1, 2]]);
    // More than three, so that one group of three is full and one is not.
    let axes = [2, 0, 1, 0];
    let channels: Vec<Channel> = axes
        .iter()
        .map(|axis| Channel {
            name: format!("axis {axis}"),
            values: mesh.points.iter().map(|point| point[*axis]).collect(),
        })
        .collect();
    let format = Format::with_headroom(&mesh.points);
    let (mut real, mut fixed) = (
        Channels::real(&channels),
        Channels::fixed(&channels).unwrap(),
    );
    let mut points = mesh.points.clone();
    let mut bits = format.bits_of(&mesh.points, "vertex").unwrap();
    let mut level = Level::new(&mesh).unwrap();
    let mut saturated = 0;
    for _ in 0..2 {
        let mut step = Refinement::new(&level, BoundaryRule::Loop.to_core()).unwrap();
        points = step.points(&points).unwrap();
        bits = step.bits(&bits, &mut saturated).unwrap();
        real.refine(&mut step, &mut saturated).unwrap();
        fixed.refine(&mut step, &mut saturated).unwrap();
        level = step.split().unwrap();
    }
    assert_eq!(saturated, 0);
    let device = format.points_of(&bits);
    for (values, expected) in [(real.values(), points), (fixed.values(), device)] {
        assert_eq!(values.len(), axes.len());
        for (channel, axis) in values.iter().zip(axes) {
            assert_eq!(channel.name, format!("axis {axis}"));
            let expected: Vec<f64> = expected.iter().map(|point| point[axis]).collect();
            assert_eq!(channel.values, expected);
        }
    }
}
