//! The nearest control mesh that encloses a given volume.

use super::error::FormError;
use super::surface::{LimitSurface, centred};

/// Steps that the search takes at most; each of a sound search gains several digits.
const MAX_STEPS: usize = 100;

impl LimitSurface<f64> {
    /// The control points that enclose `target` and whose sum of squared distances from the given
    /// ones is least among those near them.
    ///
    /// At the answer the displacement is a multiple of the gradient of the volume there. Each step
    /// takes the gradient at the last attempt and chooses the multiple by Newton's method.
    ///
    /// # Errors
    ///
    /// [`FormError::Target`] if the search does not reach the volume to 12 digits (no mesh near
    /// this one encloses it), [`FormError::Points`] if the number of control points is not that of the
    /// mesh.
    pub fn enclosing(&self, points: &[[f64; 3]], target: f64) -> Result<Vec<[f64; 3]>, FormError> {
        let (start, middle) = centred(points);
        let mut attempt = start.clone();
        let mut settled = 0;
        for _ in 0..MAX_STEPS {
            let volume = self.volume(&attempt)?;
            let gradient = self.gradient(&attempt)?;
            let missing = target - volume;
            // On the line start + multiple * gradient the volume is, to first order,
            // volume + gradient . (start + multiple * gradient - attempt).
            let mut along = 0.0;
            let mut square = 0.0;
            for ((slope, own), tried) in gradient.iter().zip(&start).zip(&attempt) {
                for axis in 0..3 {
                    along += slope[axis] * (tried[axis] - own[axis]);
                    square += slope[axis] * slope[axis];
                }
            }
            let multiple = (missing + along) / square;
            if !multiple.is_finite() {
                break;
            }
            let mut change: f64 = 0.0;
            for ((slope, own), tried) in gradient.iter().zip(&start).zip(&mut attempt) {
                for axis in 0..3 {
                    let next = own[axis] + multiple * slope[axis];
                    change = change.max((next - tried[axis]).abs());
                    tried[axis] = next;
                }
            }
            let size = start
                .iter()
                .flatten()
                .fold(0.0_f64, |size, c| size.max(c.abs()));
            settled = if change <= 1e-13 * size {
                settled + 1
            } else {
                0
            };
            if settled == 2 {
                break;
            }
        }
        let reached = self.volume(&attempt)?;
        if (reached - target).abs() <= 1e-12 * target.abs() {
            let back = |point: [f64; 3]| [0, 1, 2].map(|axis| point[axis] + middle[axis]);
            return Ok(attempt.into_iter().map(back).collect());
        }
        Err(FormError::Target {
            reached: reached.to_string(),
        })
    }
}
