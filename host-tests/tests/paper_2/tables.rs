//! Tables 2 and 3, and the case of nine tetrahedra with diagonals toward the edge.

use crate::printed::{TABLE_2, TABLE_3};
use crate::stars::{edge_matrix, edge_star, eigenvalues, vertex_matrix, vertex_order, vertex_star};

/// The arrangement of each case of table 2: its name, vertices in a ring, rings.
const ARRANGEMENTS: [(&str, u32, u32); 22] = [
    ("5", 3, 1),
    ("6", 4, 1),
    ("7", 5, 1),
    ("8b", 6, 1),
    ("9", 7, 1),
    ("10b", 8, 1),
    ("11", 9, 1),
    ("13", 11, 1),
    ("15", 13, 1),
    ("8a", 3, 2),
    ("10a", 4, 2),
    ("12", 5, 2),
    ("14b", 6, 2),
    ("16", 7, 2),
    ("18b", 8, 2),
    ("20b", 9, 2),
    ("22b", 10, 2),
    ("14a", 4, 3),
    ("17", 5, 3),
    ("20a", 6, 3),
    ("18a", 4, 4),
    ("22", 5, 4),
];

fn greatest_difference(got: &[f64], printed: &[f64; 6]) -> f64 {
    let differences = got
        .iter()
        .zip(printed)
        .map(|(got, want)| (got - want).abs());
    differences.fold(0.0, f64::max)
}

/// Table 2, to the accuracy that it was printed with (the paper computed in single precision).
#[test]
fn eigenvalues_at_vertices() {
    for (name, n, rings) in ARRANGEMENTS {
        let (_, printed) = TABLE_2.iter().find(|row| row.0 == name).expect("a row");
        // As in appendix B.1: toward the apex above, toward the ring elsewhere.
        let (star, link) = vertex_star(n, rings, |[first, ..]| if first == 1 { 0 } else { 1 });
        let got = eigenvalues(&vertex_matrix(&star, &vertex_order(&star, &link)));
        let difference = greatest_difference(&got, printed);
        assert!(difference < 3e-6, "valence {name}: {:?}", &got[..6]);
    }
}

/// Table 3: skew diagonals.
#[test]
fn eigenvalues_at_edges() {
    for (n, printed) in &TABLE_3 {
        let got = eigenvalues(&edge_matrix(&edge_star(*n, 1)));
        let difference = greatest_difference(&got, printed);
        assert!(difference < 1.1e-6, "valence {n}: {:?}", &got[..6]);
    }
}

/// Section 4.3, the second row of figure 23: nine tetrahedra, diagonals toward the edge.
#[test]
fn nine_toward_the_edge() {
    let got = eigenvalues(&edge_matrix(&edge_star(9, 0)));
    let printed = [1.0, 0.619939, 0.619939, 0.528431, 0.528431, 0.5];
    assert!(
        greatest_difference(&got, &printed) < 1e-6,
        "{:?}",
        &got[..6]
    );
}
