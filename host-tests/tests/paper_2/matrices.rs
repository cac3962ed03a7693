//! Appendix B, entry by entry.

use octruss_host_tests::rational::ratio;

use crate::printed;
use crate::stars::{
    Matrix, edge_matrix, edge_star, eigenvalues, parse, vertex_matrix, vertex_star,
};

/// Holds rows against the printed ones; `exceptions` are not looked at, `lost` columns at the end
/// were lost in print.
fn compare(got: &Matrix, printed: &Matrix, exceptions: &[usize], lost: usize) {
    assert_eq!(got.len(), printed.len());
    for (place, (got, want)) in got.iter().zip(printed).enumerate() {
        if !exceptions.contains(&place) {
            assert_eq!(got[..got.len() - lost], want[..], "row {place}");
        }
    }
}

fn has_close(values: &[f64], wanted: &[f64], bound: f64) {
    for (got, want) in values.iter().zip(wanted) {
        assert!((got - want).abs() < bound, "{values:?}, printed {wanted:?}");
    }
}

/// B.1: a vertex of valence 5. Its neighbours are 1 above, the ring 2 3 4, and 5 below; above the
/// diagonals run toward vertex 1, below toward the first of the ring.
///
/// Rows 6, 11, 13 and 15 leave out the neighbours along major diagonals, against definition
/// 3.3; the definition is followed. The last column is lost, which only row 19 has entries in.
#[test]
fn the_vertex_matrix_of_valence_5() {
    let (star, _) = vertex_star(3, 1, |[apex, ..]| if apex == 1 { 0 } else { 1 });
    let order = [
        [0, 0],
        [0, 1],
        [0, 2],
        [0, 3],
        [0, 4],
        [0, 5],
        [1, 1],
        [1, 2],
        [1, 3],
        [1, 4],
        [2, 4],
        [2, 2],
        [2, 3],
        [3, 3],
        [3, 4],
        [4, 4],
        [2, 5],
        [3, 5],
        [4, 5],
        [5, 5],
    ];
    let got = vertex_matrix(&star, &order);
    let printed = parse(printed::VERTEX);
    compare(&got, &printed, &[6, 11, 13, 15], 1);
    assert_eq!(got[19][19], ratio(7, 128));
    // What definition 3.3 gives where the print leaves diagonals out.
    for (row, weight, added) in [
        (6, ratio(7, 176), [10, 12, 14].as_slice()),
        (11, ratio(7, 176), &[17]),
        (13, ratio(7, 176), &[18]),
        (15, ratio(7, 176), &[16]),
    ] {
        for column in 0..19 {
            let zero = ratio(0, 1);
            let is_own = printed[row][column] == ratio(9, 16);
            let counts = printed[row][column] != zero || added.contains(&column);
            let want = match (is_own, counts) {
                (true, _) => ratio(9, 16),
                (false, true) => weight.clone(),
                (false, false) => zero,
            };
            assert_eq!(got[row][column], want, "row {row} column {column}");
        }
    }
    let root = 70_f64.sqrt();
    let wanted = [
        1.0,
        5.0 / 16.0,
        (15.0 + root) / 80.0,
        3.0 / 20.0,
        0.125,
        0.125,
    ];
    has_close(&eigenvalues(&got), &wanted, 1e-9);
    // 3/20 belongs to the outer block: the 6 x 6 block has (15 - sqrt 70)/80 instead.
    let block: Matrix = got[..6].iter().map(|row| row[..6].to_vec()).collect();
    let wanted = [
        1.0,
        5.0 / 16.0,
        (15.0 + root) / 80.0,
        0.125,
        0.125,
        (15.0 - root) / 80.0,
    ];
    has_close(&eigenvalues(&block), &wanted, 1e-9);
}

/// B.2: an edge of four tetrahedra with skew diagonals, all 19 x 19 entries and the first eleven
/// eigenvalues.
#[test]
fn the_edge_matrix_of_valence_4() {
    let got = edge_matrix(&edge_star(4, 1));
    compare(&got, &parse(printed::EDGE_SKEW), &[], 0);
    let (one, two) = (985_f64.sqrt(), 6.0 * 2_f64.sqrt());
    let mut wanted = vec![
        1.0,
        (45.0 + one) / 160.0,
        19.0 / 80.0,
        3.0 / 16.0,
        1.0 / 8.0,
    ];
    wanted.extend([(25.0 + two) / 80.0, (25.0 - two) / 80.0, 13.0 / 80.0].repeat(2));
    wanted.sort_by(|a, b| b.total_cmp(a));
    has_close(&eigenvalues(&got)[..11], &wanted, 1e-7);
    // 1/8 belongs to the outer block: the 11 x 11 block has (45 - sqrt 985)/160 instead.
    let block: Matrix = got[..11].iter().map(|row| row[..11].to_vec()).collect();
    wanted[10] = (45.0 - one) / 160.0;
    has_close(&eigenvalues(&block), &wanted, 1e-7);
}

/// `S'_e`: all diagonals toward the edge. Row 0 leaves the neighbours along diagonals out (and is
/// printed with an entry too many), and so does its eigenvalue (25 + sqrt 385)/160.
#[test]
fn the_edge_matrix_with_diagonals_toward_the_edge() {
    let got = edge_matrix(&edge_star(4, 0));
    compare(&got, &parse(printed::EDGE_TOWARD), &[0], 0);
    for (column, weight) in got[0].iter().enumerate() {
        let want = match column {
            0 => ratio(9, 16),
            1..=10 | 12 | 14 | 16 | 18 => ratio(1, 32),
            _ => ratio(0, 1),
        };
        assert_eq!(*weight, want, "column {column}");
    }
    has_close(&eigenvalues(&got), &[1.0, 0.5, 0.5, 0.5], 1e-7);
}
