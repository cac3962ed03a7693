//! How far the device's bits are from the real-number answer, in units of the last place.
//!
//! # The bound
//!
//! A level's weights are not negative and add up to one, so a level does not enlarge the
//! distance that its input has; rounding adds at most 1/2. Where a vertex weight is irrational
//! (Loop's of 1987 at valences other than 1, 2, 3, 4 and 6), each of its `n` weights is off by
//! the same `e`, at most 2^-31, which moves the vertex by at most `n e` times the distance to its
//! neighbours, and that is at most the range `d` of the level-0 coordinates (plus one unit for
//! roundings). So after `k` levels the distance is at most the sum over them of
//! `1/2 + n e (d + 1)`, with the greatest `n e` of the level.
//!
//! The double-precision answer itself is off by less than [`DOUBLE_PRECISION`] a level: at most
//! 2000 terms a sum, each rounded by 2^-53 of at most 2^32.

use std::fmt;

use crate::reference::{Boundary, LoopWeight, WEIGHT_UNIT};

/// What double precision may add to a distance at every level.
pub const DOUBLE_PRECISION: f64 = 1.0 / 512.0;

/// Distances of many coordinates at one level.
#[derive(Clone, Copy, Debug, Default)]
struct Level {
    greatest: f64,
    squares: f64,
    count: usize,
    greatest_bound: f64,
}

/// Distances per level, apart for cases with rational weights only and for others.
#[derive(Clone, Debug, Default)]
pub struct Distances {
    rational: Vec<Level>,
    irrational: Vec<Level>,
}

/// Distances of one case while its levels come in.
#[derive(Clone, Debug)]
pub struct CaseDistances {
    range: f64,
    bound: f64,
    is_irrational: bool,
    levels: Vec<Level>,
}

impl Distances {
    /// Starts a case with these points at level 0.
    pub fn of_case(&self, points: &[[i32; 3]]) -> CaseDistances {
        let span = |axis: usize| {
            let coordinates = || points.iter().map(|point| f64::from(point[axis]));
            coordinates().fold(f64::MIN, f64::max) - coordinates().fold(f64::MAX, f64::min)
        };
        CaseDistances {
            range: [0, 1, 2].map(span).into_iter().fold(0.0, f64::max),
            bound: 0.0,
            is_irrational: false,
            levels: Vec::new(),
        }
    }

    /// Adds the distances of a case.
    pub fn add(&mut self, case: &CaseDistances) {
        let totals = if case.is_irrational {
            &mut self.irrational
        } else {
            &mut self.rational
        };
        if totals.len() < case.levels.len() {
            totals.resize(case.levels.len(), Level::default());
        }
        for (total, level) in totals.iter_mut().zip(&case.levels) {
            total.greatest = total.greatest.max(level.greatest);
            total.greatest_bound = total.greatest_bound.max(level.greatest_bound);
            total.squares += level.squares;
            total.count += level.count;
        }
    }
}

impl CaseDistances {
    /// Takes the next level in: the valences of the surface before it, and both answers.
    ///
    /// # Errors
    /// If a coordinate is farther away than the bound.
    pub fn level(
        &mut self,
        boundary: Boundary,
        valences: &[usize],
        fixed: &[[i32; 3]],
        real: &[[f64; 3]],
    ) -> Result<(), String> {
        // What the weights of a vertex miss together, if they are irrational.
        let missed = |valence: &usize| {
            let weight = LoopWeight::new(boundary, *valence)?;
            let error = weight.neighbour / WEIGHT_UNIT - weight.real_neighbour;
            let is_irrational = weight.denominator == WEIGHT_UNIT;
            is_irrational.then_some(error.abs() * *valence as f64)
        };
        let missed = valences.iter().filter_map(missed).reduce(f64::max);
        self.is_irrational |= missed.is_some();
        self.bound += 0.5 + missed.unwrap_or(0.0) * (self.range + 1.0) + DOUBLE_PRECISION;
        let mut level = Level {
            greatest_bound: self.bound,
            ..Level::default()
        };
        for (fixed, real) in fixed.iter().flatten().zip(real.iter().flatten()) {
            let distance = (f64::from(*fixed) - real).abs();
            if distance > self.bound {
                return Err(format!(
                    "{fixed} is {distance} from {real}, the bound is {}",
                    self.bound
                ));
            }
            level.greatest = level.greatest.max(distance);
            level.squares += distance * distance;
            level.count += 1;
        }
        self.levels.push(level);
        Ok(())
    }
}

impl fmt::Display for Distances {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "weights     level  greatest  root mean square  bound"
        )?;
        for (name, levels) in [
            ("rational", &self.rational),
            ("irrational", &self.irrational),
        ] {
            for (number, level) in (1..).zip(levels) {
                let mean = (level.squares / level.count.max(1) as f64).sqrt();
                writeln!(
                    formatter,
                    "{name:<12}{number:<7}{:<10.3}{mean:<18.3}{:.3}",
                    level.greatest, level.greatest_bound
                )?;
            }
        }
        Ok(())
    }
}
