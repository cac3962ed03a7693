//! Example 5.1 on figure 5.3, rebuilt from the text.
//!
//! Four hexahedra lie below the vertices 1 to 9, a square of three by three with 5 in the middle.
//! Above stand two prisms, from the triangles 5 7 4 and 5 2 4 up to 12 14 11 and 12 10 11, and one
//! from the triangle 5 8 12 across to 6 9 13. A tetrahedron fills 5 7 8 12; a tetrahedron and an
//! octahedron fill what is left around 5 between 2, 12, 13, 6 and 3. (Which of the faces between
//! those two the figure has does not matter: they touch no other class.)

use num_rational::BigRational;
use octruss_host_tests::mixed_subject::{Row, add_scaled, clones, ratio};
use octruss_host_tests::reference_mixed::Mesh;

/// The vertices of the layer below 1 to 9 are 21 to 29; 15 is the octahedron's far corner.
fn figure_5_3() -> Mesh {
    let cube = |top: [u32; 4]| {
        let [a, b, c, d] = top;
        [a + 20, b + 20, c + 20, d + 20, a, b, c, d]
    };
    Mesh {
        vertex_count: 30,
        tetrahedra: vec![[5, 7, 8, 12], [5, 3, 6, 13]],
        octahedra: vec![[5, 2, 12, 15, 13, 3]],
        prisms: vec![
            [4, 5, 7, 11, 12, 14],
            [4, 2, 5, 11, 10, 12],
            [5, 8, 12, 6, 9, 13],
        ],
        hexahedra: vec![
            cube([1, 2, 5, 4]),
            cube([2, 3, 6, 5]),
            cube([4, 5, 8, 7]),
            cube([5, 6, 9, 8]),
        ],
        ..Mesh::default()
    }
}

/// The sum of terms, each over the number of pairs.
fn distortion(pairs: &[&[(i64, i64, u32)]]) -> Row {
    let mut row = Row::new();
    for (numerator, denominator, vertex) in pairs.iter().copied().flatten() {
        let weight = ratio(*numerator, *denominator * pairs.len() as i64);
        add_scaled(&mut row, &weight, &Row::from([(*vertex, ratio(1, 1))]));
    }
    row
}

/// Vertex 5 plus or minus some distortions.
fn clone(terms: &[(i64, &Row)]) -> Row {
    let mut row = Row::from([(5, ratio(1, 1))]);
    for (sign, term) in terms {
        add_scaled(&mut row, &BigRational::from_integer((*sign).into()), term);
    }
    row
}

#[test]
fn the_five_distortions_make_the_three_clones() {
    let on_prism_triangle = distortion(&[&[(-1, 36, 5), (1, 72, 8), (1, 72, 12)]]);
    let on_prism_quad = distortion(&[
        &[(5, 144, 5), (-1, 9, 13), (11, 144, 12)],
        &[(-31, 144, 5), (11, 144, 7), (5, 36, 12)],
        &[(-31, 144, 5), (11, 144, 2), (5, 36, 12)],
        &[(-1, 36, 5), (5, 36, 6), (-1, 9, 13)],
    ]);
    let on_cube = distortion(&[
        &[(-1, 36, 5), (-1, 9, 7), (5, 36, 8)],
        &[(-1, 36, 5), (-1, 9, 3), (5, 36, 6)],
        &[(-1, 36, 5), (-1, 9, 3), (5, 36, 2)],
    ]);
    let prism_on_cube = distortion(&[
        &[(-1, 8, 7), (1, 8, 4)],
        &[(-1, 4, 5), (1, 8, 2), (1, 8, 4)],
    ]);
    let quads = distortion(&[&[(-1, 24, 5), (1, 24, 8)]]);

    let expected = [
        clone(&[(1, &on_prism_triangle), (1, &on_prism_quad), (1, &on_cube)]),
        // (5.2.2) prints this without the second term.
        clone(&[
            (-1, &on_prism_triangle),
            (-1, &on_prism_quad),
            (1, &prism_on_cube),
            (1, &quads),
        ]),
        clone(&[(-1, &on_cube), (-1, &prism_on_cube), (-1, &quads)]),
    ];
    assert_eq!(clones(&figure_5_3())[5], expected);
}
