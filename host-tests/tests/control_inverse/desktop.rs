//! The same problems in double precision, with Clarabel.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver as _, NonnegativeConeT, SolverStatus,
    SupportedConeT, ZeroConeT,
};
use octruss_host_tests::random_inverse::InverseCase;
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;

const ONE: f64 = 1_073_741_824.0;

/// Minimise `q'Hq / 2 - b'q` within bounds: the integers of a solver as real numbers.
pub struct Program {
    hessian: Vec<Vec<f64>>,
    forces: Vec<f64>,
    lower: Vec<i32>,
    upper: Vec<i32>,
    coefficients: Vec<f64>,
    target: f64,
}

/// A linear constraint: slopes and the value.
type Line = (Vec<f64>, f64);

impl Program {
    /// The problem of the case's first goals.
    pub fn new(case: &InverseCase) -> Self {
        let table = &case.table;
        let rows = table.hessian.chunks(table.actuators);
        let hessian = rows
            .map(|row| row.iter().map(|own| f64::from(*own) / ONE).collect())
            .collect();
        // b = A (goal - rest) 2^(gain_shift - difference_shift) in units of 2^-60.
        let scale = 2.0_f64.powi(table.gain_shift - table.difference_shift as i32 - 60);
        let pairs = case.goals[0]
            .as_flattened()
            .iter()
            .zip(table.rest.as_flattened());
        let differences: Vec<f64> = pairs
            .map(|(goal, rest)| f64::from(*goal) - f64::from(*rest))
            .collect();
        let forces = table.gains.chunks(differences.len()).map(|row| {
            let terms = row.iter().zip(&differences);
            terms.map(|(gain, own)| f64::from(*gain) * own).sum::<f64>() * scale
        });
        let wanted = case.wanted.as_ref();
        let coefficients = wanted.map_or_else(Vec::new, |wanted| {
            wanted
                .coefficients
                .iter()
                .map(|own| f64::from(*own))
                .collect()
        });
        Self {
            hessian,
            forces: forces.collect(),
            lower: table.lower.clone(),
            upper: table.upper.clone(),
            coefficients,
            target: wanted.map_or(0.0, |wanted| wanted.low as f64 / 268_435_456.0),
        }
    }

    fn length(&self) -> usize {
        self.forces.len()
    }

    /// Amplitudes as real numbers.
    pub fn real(&self, amplitudes: &[i32]) -> Vec<f64> {
        let used = &amplitudes[..self.length()];
        used.iter().map(|own| f64::from(*own) / ONE).collect()
    }

    /// Whether amplitudes are within the bounds, exactly.
    pub fn is_inside(&self, amplitudes: &[i32]) -> bool {
        let bounds = self.lower.iter().zip(&self.upper);
        amplitudes
            .iter()
            .zip(bounds)
            .all(|(own, (lower, upper))| lower <= own && own <= upper)
    }

    /// The amplitudes at rest.
    pub fn rest(&self) -> Vec<f64> {
        let bounds = self.lower.iter().zip(&self.upper);
        bounds
            .map(|(&lower, &upper)| f64::from(0.clamp(lower, upper)) / ONE)
            .collect()
    }

    /// `q'Hq / 2 - b'q`.
    pub fn objective(&self, amplitudes: &[f64]) -> f64 {
        let gradient = self.gradient(amplitudes);
        let terms = gradient.iter().zip(&self.forces).zip(amplitudes);
        terms
            .map(|((slope, force), own)| (slope - force) * own / 2.0)
            .sum()
    }

    fn gradient(&self, amplitudes: &[f64]) -> Vec<f64> {
        let rows = self.hessian.iter().zip(&self.forces);
        rows.map(|(row, force)| dot(row, amplitudes) - force)
            .collect()
    }

    /// The best amplitudes without a volume.
    pub fn solve(&self) -> Vec<f64> {
        self.program(None).expect("a box is never empty")
    }

    fn bounds(&self) -> Vec<[f64; 2]> {
        let bounds = self.lower.iter().zip(&self.upper);
        bounds
            .map(|(&lower, &upper)| [f64::from(lower) / ONE, f64::from(upper) / ONE])
            .collect()
    }

    /// Clarabel's answer, with or without a linear constraint.
    fn program(&self, line: Option<&Line>) -> Option<Vec<f64>> {
        let n = self.length();
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in 0..n {
            for row in 0..=column {
                rows.push(row);
                values.push(self.hessian[row][column]);
            }
            starts.push(rows.len());
        }
        let quadratic = CscMatrix::new(n, n, starts, rows, values);
        let linear: Vec<f64> = self.forces.iter().map(|force| -force).collect();
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in 0..n {
            rows.extend([column, n + column]);
            values.extend([1.0, -1.0]);
            if let Some((slopes, _)) = line {
                rows.push(2 * n);
                values.push(slopes[column]);
            }
            starts.push(rows.len());
        }
        let bounds = self.bounds();
        let mut right: Vec<f64> = bounds.iter().map(|[_, upper]| *upper).collect();
        right.extend(bounds.iter().map(|[lower, _]| -lower));
        let mut cones: Vec<SupportedConeT<f64>> = vec![NonnegativeConeT(2 * n)];
        if let Some((_, value)) = line {
            right.push(*value);
            cones.push(ZeroConeT(1));
        }
        let constraints = CscMatrix::new(right.len(), n, starts, rows, values);
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .tol_gap_abs(1e-12)
            .tol_gap_rel(1e-12)
            .tol_feas(1e-11)
            .build()
            .unwrap();
        let solver =
            DefaultSolver::new(&quadratic, &linear, &constraints, &right, &cones, settings);
        let mut solver = solver.unwrap();
        solver.solve();
        let solved = [
            SolverStatus::Solved,
            SolverStatus::AlmostSolved,
            SolverStatus::InsufficientProgress,
        ];
        solved
            .contains(&solver.solution.status)
            .then(|| solver.solution.x.clone())
    }

    /// What the polynomial encloses, in units of a coefficient.
    pub fn volume(&self, amplitudes: &[f64]) -> f64 {
        self.volume_and_gradient(amplitudes).0
    }

    /// The volume that is asked for.
    pub fn target(&self) -> f64 {
        self.target
    }

    fn volume_and_gradient(&self, amplitudes: &[f64]) -> (f64, Vec<f64>) {
        let n = self.length();
        let q: Vec<f64> = std::iter::once(1.0)
            .chain(amplitudes.iter().copied())
            .collect();
        let mut next = self.coefficients.iter();
        let (mut volume, mut slopes) = (0.0, vec![0.0; n + 1]);
        for a in 0..=n {
            for b in a..=n {
                for (c, k) in (b..=n).zip(&mut next) {
                    volume += k * q[a] * q[b] * q[c];
                    slopes[a] += k * q[b] * q[c];
                    slopes[b] += k * q[a] * q[c];
                    slopes[c] += k * q[a] * q[b];
                }
            }
        }
        (volume, slopes.split_off(1))
    }

    /// Sequential quadratic programming from a random start; `None` if it finds no feasible point.
    pub fn solve_with_volume(&self, rng: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let bounds = self.bounds();
        let start = bounds
            .iter()
            .map(|&[lower, upper]| rng.random_range(lower..=upper));
        let mut here: Vec<f64> = start.collect();
        let off = |place: &[f64]| (self.volume(place) / self.target - 1.0).abs();
        // An exact penalty, heavier than any multiplier of these problems.
        let merit = |place: &[f64]| self.objective(place) + 1e3 * off(place);
        for _ in 0..60 {
            let (volume, slopes) = self.volume_and_gradient(&here);
            // Scaled to the target, so that the constraint is as large as the bounds.
            let slopes: Vec<f64> = slopes.iter().map(|own| own / self.target).collect();
            let value = 1.0 - volume / self.target + dot(&slopes, &here);
            let next = self.program(Some(&(slopes, value)))?;
            let mut part = 1.0;
            let along = |part: f64| -> Vec<f64> {
                let pairs = here.iter().zip(&next);
                pairs.map(|(from, to)| from + part * (to - from)).collect()
            };
            while part > 1e-6 && merit(&along(part)) > merit(&here) {
                part /= 2.0;
            }
            let moved = along(part);
            let step = moved
                .iter()
                .zip(&here)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            here = moved;
            if step < 1e-10 {
                break;
            }
        }
        (off(&here) < 1e-7).then_some(here)
    }

    /// The residual of the optimality conditions: the greatest part of the gradient that neither the volume's multiplier nor a
    /// bound holds, over the greatest force.
    pub fn residual(&self, amplitudes: &[f64]) -> f64 {
        let (_, slopes) = self.volume_and_gradient(amplitudes);
        let gradient = self.gradient(amplitudes);
        let bounds = self.bounds();
        let side = |place: usize| {
            let [lower, upper] = bounds[place];
            let near = 1e-7;
            match amplitudes[place] {
                own if own <= lower + near => -1,
                own if own >= upper - near => 1,
                _ => 0,
            }
        };
        let free = (0..self.length()).filter(|&place| side(place) == 0);
        let (mut above, mut below) = (0.0, 0.0);
        for place in free {
            above += gradient[place] * slopes[place];
            below += slopes[place] * slopes[place];
        }
        let multiplier = if below > 0.0 { above / below } else { 0.0 };
        let scale = self.forces.iter().map(|own| own.abs()).fold(0.0, f64::max);
        let left = (0..self.length()).map(|place| {
            let left = gradient[place] - multiplier * slopes[place];
            match side(place) {
                0 => left.abs(),
                -1 => (-left).max(0.0),
                _ => left.max(0.0),
            }
        });
        left.fold(0.0, f64::max) / scale
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
