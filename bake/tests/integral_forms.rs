//! The paper's forms with a bar, `A_ijk = integral of B_i dB_j/ds dB_k/dt`, which are not alternating
//! and are not shipped: they tie the alternating ones to the surface's own parameterisation.

use num_rational::BigRational;
use num_traits::{One, ToPrimitive, Zero};
use octruss_bake::forms::Scheme;
use octruss_bake::forms::local::children;
use octruss_bake::forms::make::real_form;
use octruss_bake::forms::scheme::Row;

type Polynomial = Vec<BigRational>;

fn fraction(text: &str) -> BigRational {
    text.parse().expect("a fraction")
}

/// The pieces of the uniform B-splines, as the paper prints them.
fn pieces(scheme: Scheme) -> Vec<Polynomial> {
    let (rows, denominator): (&[&[i64]], i64) = match scheme {
        Scheme::DooSabin => (&[&[1, -2, 1], &[1, 2, -2], &[0, 0, 1]], 2),
        _ => (
            &[
                &[1, -3, 3, -1],
                &[4, 0, -6, 3],
                &[1, 3, 3, -3],
                &[0, 0, 0, 1],
            ],
            6,
        ),
    };
    let number = |c: &i64| BigRational::new((*c).into(), denominator.into());
    rows.iter()
        .map(|row| row.iter().map(number).collect())
        .collect()
}

fn times(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut product = vec![BigRational::zero(); a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            product[i + j] += x * y;
        }
    }
    product
}

fn derivative(a: &Polynomial) -> Polynomial {
    let terms = a.iter().enumerate().skip(1);
    terms
        .map(|(degree, c)| c * BigRational::from_integer(degree.into()))
        .collect()
}

/// Over the interval from 0 to 1.
fn integral(a: &Polynomial) -> BigRational {
    let terms = a.iter().enumerate();
    terms
        .map(|(degree, c)| c / BigRational::from_integer((degree + 1).into()))
        .sum()
}

/// The paper's A-bar of the regular facet.
struct Integrals {
    side: usize,
    /// Integrals of `b_i b_j' b_k` and of `b_i b_j b_k'`, where k's derivative swaps with j's.
    middle: Vec<Vec<Vec<BigRational>>>,
}

impl Integrals {
    fn new(scheme: Scheme) -> Self {
        let pieces = pieces(scheme);
        let line = |i: &Polynomial, j: &Polynomial| {
            let both = times(i, &derivative(j));
            pieces
                .iter()
                .map(|k| integral(&times(&both, k)))
                .collect::<Vec<_>>()
        };
        let plane = |i| pieces.iter().map(|j| line(i, j)).collect::<Vec<_>>();
        Self {
            side: pieces.len(),
            middle: pieces.iter().map(plane).collect(),
        }
    }

    fn at(&self, i: usize, j: usize, k: usize) -> BigRational {
        let [(it, is), (jt, js), (kt, ks)] = [i, j, k].map(|p| (p / self.side, p % self.side));
        &self.middle[is][js][ks] * &self.middle[it][kt][jt]
    }
}

#[test]
fn regular_integrals_are_the_printed_ones() {
    let doo_sabin = Integrals::new(Scheme::DooSabin);
    assert_eq!(doo_sabin.at(7, 0, 1), fraction("3/3200"));
    let catmull_clark = Integrals::new(Scheme::CatmullClark);
    assert_eq!(catmull_clark.at(4, 0, 5), fraction("3103/48771072"));
    assert!(fraction("1").is_one());
}

type Tensor = Vec<Vec<Vec<f64>>>;

fn pull_back(form: &Tensor, rows: &[Row<f64>], size: usize) -> Tensor {
    let mut tensor = form.clone();
    // Three times: the first index through the rows, then the indices in turn.
    for _ in 0..3 {
        let (columns, depth) = (tensor[0].len(), tensor[0][0].len());
        let mut next = vec![vec![vec![0.0; size]; depth]; columns];
        for (a, row) in rows.iter().enumerate() {
            for (i, weight) in row {
                for b in 0..columns {
                    for c in 0..depth {
                        next[b][c][*i] += weight * tensor[a][b][c];
                    }
                }
            }
        }
        tensor = next;
    }
    tensor
}

fn add(sum: &mut Tensor, other: &Tensor) {
    let values = other.iter().flatten().flatten();
    for (total, value) in sum.iter_mut().flatten().flatten().zip(values) {
        *total += value;
    }
}

/// A child's control points in the order that aligns its parameters with its parent's: each child
/// names its own outer corner last, a quarter turn further than the one before.
fn turned(rows: &[Row<f64>], side: usize, turns: usize) -> Vec<Row<f64>> {
    let mut aligned = rows.to_vec();
    for _ in 0..turns {
        let before = aligned.clone();
        for (place, row) in before.into_iter().enumerate() {
            let (t, s) = (place / side, place % side);
            aligned[s * side + (side - 1 - t)] = row;
        }
    }
    aligned
}

/// The series of the integrals over the regular children on the way to the irregular place.
fn irregular(scheme: Scheme, valence: usize) -> Tensor {
    let integrals = Integrals::new(scheme);
    let own = scheme.control_point_count(scheme.regular_valence());
    let real = |value: BigRational| value.to_f64().expect("a number");
    let line = |i: usize, j: usize| {
        (0..own)
            .map(|k| real(integrals.at(i, j, k)))
            .collect::<Vec<_>>()
    };
    let regular = (0..own)
        .map(|i| (0..own).map(|j| line(i, j)).collect::<Vec<_>>())
        .collect::<Tensor>();
    let size = scheme.control_point_count(valence);
    let matrices = children::<f64>(scheme, valence).expect("a facet");
    let mut step = vec![vec![vec![0.0; size]; size]; size];
    for (turns, rows) in matrices[..3].iter().enumerate() {
        let aligned = turned(rows, integrals.side, turns + 1);
        add(&mut step, &pull_back(&regular, &aligned, size));
    }
    let mut total = step.clone();
    for _ in 0..60 {
        step = pull_back(&step, &matrices[3], size);
        add(&mut total, &step);
    }
    total
}

/// The two figures that the paper prints for irregular facets. The second stands there as Y-bar,
/// but is A-bar; the true Y-bar was found independently.
#[test]
fn irregular_integrals_are_the_printed_ones() {
    let close = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 1e-12, "{got} {want}");
    let a = irregular(Scheme::DooSabin, 3);
    close(a[7][6][1] - a[7][1][6], 9_660_923.0 / 5_782_665_600.0);
    let a = irregular(Scheme::CatmullClark, 5);
    let printed = fraction(
        "555157620972704545156972240729805393939048761580669/\
         981547964721533145894588000817830293184287837041075200",
    );
    close(a[10][4][2], printed.to_f64().expect("a number"));
    close(a[10][4][2] - a[10][2][4], 0.000_597_277_110_471_067);
}

/// The average over all six orders is the alternating form.
#[test]
fn their_alternating_part_is_the_form() {
    for scheme in [Scheme::DooSabin, Scheme::CatmullClark] {
        for valence in [3, 5, 7] {
            let a = irregular(scheme, valence);
            let form = real_form(scheme, valence).expect("a form");
            let at = |i: usize, j: usize, k: usize| a[i][j][k];
            for i in 0..form.size() {
                for j in i + 1..form.size() {
                    for k in j + 1..form.size() {
                        let even = at(i, j, k) + at(j, k, i) + at(k, i, j);
                        let odd = at(i, k, j) + at(j, i, k) + at(k, j, i);
                        let want = (even - odd) / 3.0;
                        let got = form.get(i, j, k);
                        assert!(
                            (got - want).abs() < 1e-16,
                            "{scheme} {valence}: {got} {want}"
                        );
                    }
                }
            }
        }
    }
}
