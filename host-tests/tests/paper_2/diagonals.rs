//! Algorithm 2, worked by hand, and what it leaves improper.

use octruss::mesh::{MeshError, Part};
use octruss_host_tests::box_spline::BoxSolid;
use octruss_host_tests::meshes::{fan, two_tetrahedra};
use octruss_host_tests::reference::Solid;

use crate::regular::{AXES, along};

fn without_diagonals(solid: &Solid) -> BoxSolid {
    BoxSolid {
        vertex_count: u32::try_from(solid.vertex_count).expect("few vertices"),
        tetrahedra: solid.tetrahedra.clone(),
        octahedra: solid.octahedra.clone(),
        ..BoxSolid::default()
    }
}

/// Cell 0 takes pair 0 (01 23). Of cell 1 (0 2 1 4) no edge but 01 could be in use, which is its
/// pair 1; pair 0 (02 14) has none, and is the lowest.
#[test]
fn two_tetrahedra_by_hand() {
    let mut solid = without_diagonals(&two_tetrahedra());
    solid.choose().expect("a sound solid");
    assert_eq!(solid.of_tetrahedra, [0, 0]);
    assert_eq!(solid.improper(), Ok(Vec::new()));
    // Both at 01: 01 23 in the first, 01 24 (pair 1) in the second.
    solid.of_tetrahedra = vec![0, 1];
    assert_eq!(solid.improper(), Ok(vec![[0, 1, 2]]));
}

/// Cell 0 (0 1 2 3) takes 01 23. Cell 1 (0 1 3 4) avoids 01 and takes 03 14. Cell 2 (0 1 4 2)
/// sees 01 in use, and 14 by its pair 2 (02 14): 04 12 is free.
#[test]
fn three_tetrahedra_around_an_edge_by_hand() {
    let mut solid = without_diagonals(&fan(3, true));
    assert_eq!(solid.tetrahedra, [[0, 1, 2, 3], [0, 1, 3, 4], [0, 1, 4, 2]]);
    solid.choose().expect("a sound solid");
    assert_eq!(solid.of_tetrahedra, [0, 1, 1]);
    assert_eq!(solid.improper(), Ok(Vec::new()));
}

/// The same cells in another order get other diagonals: here the cell that was last comes first
/// and takes pair 0 (01 24), where it had 04 12.
#[test]
fn diagonals_depend_on_the_order_of_cells() {
    let mut solid = without_diagonals(&fan(3, true));
    solid.tetrahedra.rotate_right(1);
    solid.choose().expect("a sound solid");
    solid.of_tetrahedra.rotate_left(1);
    assert_ne!(solid.of_tetrahedra, [0, 1, 1]);
}

/// Two components: the second starts afresh at its lowest cell.
#[test]
fn every_component_starts_with_pair_0() {
    let mut solid = without_diagonals(&fan(1, false));
    solid.tetrahedra.push([4, 5, 6, 7]);
    solid.vertex_count = 8;
    solid.choose().expect("a sound solid");
    assert_eq!(solid.of_tetrahedra, [0, 0]);
}

/// On the regular lattice all diagonals come out parallel and no face is improper.
#[test]
fn the_lattice_is_proper() {
    let (mut solid, _) = along(0);
    solid.choose().expect("a sound solid");
    assert_eq!(solid.improper(), Ok(Vec::new()));
    let is_one_of_three = AXES.iter().any(|axis| {
        let (parallel, _) = along(*axis);
        parallel.of_tetrahedra == solid.of_tetrahedra && parallel.of_octahedra == solid.of_octahedra
    });
    assert!(is_one_of_three);
}

#[test]
fn wrong_diagonals_are_named() {
    let mut solid = without_diagonals(&two_tetrahedra());
    solid.of_tetrahedra = vec![0];
    let wrong = MeshError::DiagonalCount {
        part: Part::Tetrahedron,
        needed: 2,
        given: 1,
    };
    assert_eq!(solid.improper(), Err(wrong));
    solid.of_tetrahedra = vec![0, 3];
    let wrong = MeshError::DiagonalOutOfRange {
        part: Part::Tetrahedron,
        index: 1,
        value: 3,
    };
    assert_eq!(solid.improper(), Err(wrong));
    assert_eq!(
        wrong.to_string(),
        "the major diagonal of tetrahedron 1 is 3; it must be 0, 1 or 2"
    );
}
