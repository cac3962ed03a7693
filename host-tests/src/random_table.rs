//! Random tables of rows and random poses, from a seed.

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::random_mesh::random_points;
use crate::reference::Table;

/// One in the weights' 30 fraction bits.
const ONE: i64 = 1 << 30;

/// What the weights of each row add up to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowSum {
    /// Exactly one: what a bundle holds.
    One,
    /// Anything.
    Any,
}

/// One random case of the table's apply with `D` channels.
#[derive(Clone, Debug)]
pub struct ApplyCase<const D: usize> {
    /// The seed that made it.
    pub seed: u64,
    /// The rows.
    pub table: Table,
    /// Control points.
    pub pose: Vec<[i32; D]>,
    /// Control points at rest.
    pub rest_pose: Vec<[i32; D]>,
    /// Results at rest.
    pub rest: Vec<[i32; D]>,
}

impl<const D: usize> ApplyCase<D> {
    /// The case of a seed, with at most `rows` rows and `points` control points (one at least).
    pub fn new(seed: u64, rows: usize, points: u16, sum: RowSum) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let point_count = rng.random_range(1..=points);
        let row_count = rng.random_range(0..=rows);
        let mut table = Table {
            offsets: vec![0],
            ..Table::default()
        };
        for _ in 0..row_count {
            push_row(&mut rng, &mut table, point_count, sum);
            table.offsets.push(table.indices.len() as u32);
        }
        let point_count = usize::from(point_count);
        Self {
            seed,
            table,
            pose: random_points(&mut rng, point_count),
            rest_pose: random_points(&mut rng, point_count),
            rest: random_points(&mut rng, row_count),
        }
    }
}

/// Appends the taps of one row, control points in ascending order and each at most once.
fn push_row(rng: &mut ChaCha8Rng, table: &mut Table, point_count: u16, sum: RowSum) {
    let most = usize::from(point_count).min(40);
    let taps = rng.random_range(1..=most);
    let mut indices = rand::seq::index::sample(rng, usize::from(point_count), taps).into_vec();
    indices.sort_unstable();
    table
        .indices
        .extend(indices.into_iter().map(|index| index as u16));
    table.weights.extend(random_weights(rng, taps, sum));
}

/// Weights whose magnitudes add up to at most two, and to exactly that in a third of the rows.
fn random_weights(rng: &mut ChaCha8Rng, taps: usize, sum: RowSum) -> Vec<i32> {
    let negative_taps = if taps > 1 {
        rng.random_range(0..taps)
    } else {
        0
    };
    let (positive, negative) = match sum {
        // One is all that a single sign can add up to.
        RowSum::One if negative_taps == 0 => (ONE, 0),
        RowSum::One => {
            let negative = match rng.random_range(0..3) {
                0 => ONE / 2,
                1 => rng.random_range(0..=ONE / 2),
                _ => rng.random_range(0..=1000),
            };
            (ONE + negative, negative)
        }
        // The one weight of magnitude two that there is.
        RowSum::Any if taps == 1 && rng.random_ratio(1, 3) => return vec![i32::MIN],
        RowSum::Any if negative_taps == 0 => (rng.random_range(0..2 * ONE), 0),
        RowSum::Any => {
            let total = if rng.random() {
                2 * ONE
            } else {
                rng.random_range(2..2 * ONE)
            };
            let negative = rng.random_range(1..total);
            (total - negative, negative)
        }
    };
    let mut weights = partition(rng, positive, taps - negative_taps);
    weights.extend(
        partition(rng, negative, negative_taps)
            .into_iter()
            .map(|weight| -weight),
    );
    rand::seq::SliceRandom::shuffle(weights.as_mut_slice(), rng);
    weights
}

/// Random non-negative parts of a total below 2^31.
fn partition(rng: &mut ChaCha8Rng, total: i64, parts: usize) -> Vec<i32> {
    let mut cuts: Vec<i64> = (1..parts).map(|_| rng.random_range(0..=total)).collect();
    cuts.sort_unstable();
    cuts.push(total);
    let mut start = 0;
    let mut sizes = Vec::with_capacity(parts);
    for cut in cuts.into_iter().take(parts) {
        sizes.push(i32::try_from(cut - start).expect("a part of a total below 2^31"));
        start = cut;
    }
    sizes
}

#[cfg(test)]
mod tests {
    use super::{ApplyCase, ONE, RowSum};

    #[test]
    fn rows_add_up_as_asked() {
        let mut extreme_rows = 0;
        for seed in 0..200 {
            let case = ApplyCase::<3>::new(seed, 20, 60, RowSum::One);
            case.table.check(case.pose.len()).expect("a sound table");
            for row in 0..case.table.row_count() {
                let weights = || case.table.row(row).map(|(_, weight)| i64::from(weight));
                assert_eq!(weights().sum::<i64>(), ONE);
                extreme_rows += usize::from(weights().map(i64::abs).sum::<i64>() == 2 * ONE);
            }
            let case = ApplyCase::<2>::new(seed, 20, 60, RowSum::Any);
            case.table.check(case.pose.len()).expect("a sound table");
        }
        assert!(extreme_rows > 100, "{extreme_rows} rows at the bound");
    }
}
