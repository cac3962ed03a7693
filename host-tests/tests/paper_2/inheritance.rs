//! Children keep the direction of the major diagonal: on a refined regular region at level 4 the
//! box spline's own masks come back.

use octruss::solid::box_spline::Boundary;
use octruss_host_tests::box_spline::{BoxSolid, masks, refine_bits};

use crate::regular::{AXES, Point, check_all, generating_function};

/// Three splits: the masks of the fourth are looked at.
const SPLITS: u32 = 3;

/// The level before the fourth, with its places on the lattice of that level.
fn refined(mut solid: BoxSolid, corners: &[Point]) -> (BoxSolid, Vec<Point>) {
    solid.find_boundary().expect("a sound solid");
    let mut points: Vec<Point> = corners.iter().map(|p| p.map(|x| x << SPLITS)).collect();
    for _ in 0..SPLITS {
        // A fixed boundary keeps the polyhedron, and inside the masks are symmetric, so points
        // stay where the linear split puts them.
        let (next, out, _) = refine_bits(&solid, Boundary::Fixed, &points).expect("sound");
        (solid, points) = (next, out);
    }
    (solid, points)
}

/// "Once subdivided, the sub-structure inside each cell becomes regular again" (section 3.5): in
/// one tetrahedron and one octahedron, for every choice of their diagonal.
#[test]
fn the_masks_come_back_at_level_4() {
    // The tetrahedron of the lattice in the cube at the origin; pair 0 runs along x, and so on.
    let tetrahedron = [[0, 0, 0], [0, 1, 1], [1, 0, 1], [1, 1, 0]];
    let octahedron = [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
        [-1, 0, 0],
        [0, -1, 0],
        [0, 0, -1],
    ];
    for axis in AXES {
        let diagonal = u8::try_from(axis).expect("0, 1, 2");
        let mask = generating_function(axis);
        let one = BoxSolid {
            vertex_count: 4,
            tetrahedra: vec![[0, 1, 2, 3]],
            of_tetrahedra: vec![diagonal],
            ..BoxSolid::default()
        };
        let (solid, points) = refined(one, &tetrahedron);
        // The points inside a tetrahedron whose edges are cut into 16: 15 * 14 * 13 / 6.
        assert_eq!(check_all(&solid, &points, &mask, 32), 455);

        let one = BoxSolid {
            vertex_count: 6,
            octahedra: vec![[0, 1, 2, 3, 4, 5]],
            of_octahedra: vec![diagonal],
            ..BoxSolid::default()
        };
        let (solid, points) = refined(one, &octahedron);
        // 17 (2 * 17 * 17 + 1) / 3 points, less 4 * 16 * 16 + 2 on the boundary.
        assert_eq!(check_all(&solid, &points, &mask, 32), 3281 - 1026);
    }
}

/// Two cells of the lattice whose diagonals are parallel see no seam: the tetrahedron and the
/// octahedron share a triangle, and masks across it are those of the spline too.
#[test]
fn no_seam_where_parallel_cells_meet() {
    // Octahedron round (1, 1, 1) with the tetrahedron on its face toward the origin.
    let points = [
        [2, 1, 1],
        [1, 2, 1],
        [1, 1, 2],
        [0, 1, 1],
        [1, 0, 1],
        [1, 1, 0],
        [0, 0, 0],
    ];
    for axis in AXES {
        let diagonal = u8::try_from(axis).expect("0, 1, 2");
        // In the tetrahedron (origin, 3, 4, 5) the pair of origin and 3 runs along x.
        let solid = BoxSolid {
            vertex_count: 7,
            tetrahedra: vec![[6, 3, 4, 5]],
            octahedra: vec![[0, 1, 2, 3, 4, 5]],
            of_tetrahedra: vec![diagonal],
            of_octahedra: vec![diagonal],
            ..BoxSolid::default()
        };
        assert_eq!(solid.improper(), Ok(Vec::new()));
        let (solid, points) = refined(solid, &points);
        // Both interiors and the 15 * 14 / 2 points inside the triangle between them.
        let inside = check_all(&solid, &points, &generating_function(axis), 32);
        assert_eq!(inside, 455 + 2255 + 105);
    }
}

/// Masks add up to one and are not negative, also where nothing is regular: no coordinate can
/// leave the range of its parents.
#[test]
fn masks_are_convex() {
    let (solid, _) = crate::stars::vertex_star(5, 2, |_| 0);
    for is_averaged in [false, true] {
        let solid = BoxSolid {
            is_averaged,
            ..solid.clone()
        };
        for row in masks(&solid, Boundary::Interior).1 {
            let zero = octruss_host_tests::rational::ratio(0, 1);
            assert!(row.values().all(|weight| *weight > zero));
            let sum = row
                .values()
                .sum::<octruss_host_tests::rational::BigRational>();
            assert_eq!(sum, octruss_host_tests::rational::ratio(1, 1));
        }
    }
}
