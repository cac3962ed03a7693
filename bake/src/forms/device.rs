//! A form in the device's integers.

use octruss::enclosed::{VolumeFormParts, VolumeRecord, WEIGHT_LIMIT};
use zerocopy::IntoBytes;

use super::control::ControlForm;
use super::error::FormError;
use super::form::triples;

/// A volume form for [`octruss::enclosed`], owned, with its units.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceForm {
    /// Control points of the region, the base first.
    pub points: Vec<u16>,
    /// Pairs of points after the base.
    pub pairs: Vec<[u16; 2]>,
    /// First tap of each pair, and the number of taps.
    pub pair_starts: Vec<u32>,
    /// Third point of each tap.
    pub thirds: Vec<u16>,
    /// Weight of each tap.
    pub weights: Vec<i32>,
    /// A weight of one stands for `2^-weight_bits`.
    pub weight_bits: i32,
    /// See [`VolumeFormParts`].
    pub difference_shift: u32,
    /// See [`VolumeFormParts`].
    pub pair_bits: u32,
    /// See [`VolumeFormParts`].
    pub volume_shift: u32,
    /// See [`VolumeFormParts`].
    pub gradient_bits: u32,
    /// The magnitudes of what the weights' rounding changed, added up, in weights of one.
    pub rounding: f64,
}

/// The rest pose's volume fills this many bits of 63.
const VOLUME_BITS: i32 = 56;

/// The rest pose's greatest gradient fills this many bits of 47.
const GRADIENT_BITS: i32 = 41;

impl DeviceForm {
    /// Rounds a form for coordinates with this rest pose: raw bits of all control points.
    ///
    /// The weights are multiples of a power of two, as small as the device's limit on their sum
    /// allows. The base is the control point with most taps, which are then left out.
    ///
    /// # Errors
    ///
    /// [`FormError::TooManyPoints`] if there are more control points than 16-bit indices.
    pub fn new(form: &ControlForm, rest: &[[i32; 3]]) -> Result<Self, FormError> {
        let base = busiest(form);
        let mut order = vec![base];
        order.extend((0..form.points.len()).filter(|&place| place != base));
        let name = |&place: &usize| {
            u16::try_from(form.points[place]).map_err(|_| FormError::TooManyPoints {
                points: form.points[place],
            })
        };
        let points = order.iter().map(name).collect::<Result<Vec<_>, _>>()?;
        let real = triples(order.len().saturating_sub(1)).map(|[i, j, k]| {
            let [a, b, c] = [i, j, k].map(|index| order[index + 1]);
            ([i, j, k], form.form.get(a, b, c))
        });
        let real = real
            .filter(|(_, weight)| *weight != 0.0)
            .collect::<Vec<_>>();
        let mut device = Self {
            points,
            pairs: Vec::new(),
            pair_starts: Vec::new(),
            thirds: Vec::new(),
            weights: Vec::new(),
            weight_bits: 0,
            difference_shift: 2,
            pair_bits: 0,
            volume_shift: 1,
            gradient_bits: 0,
            rounding: 0.0,
        };
        device.round_weights(&real);
        device.choose_shifts(form, rest);
        Ok(device)
    }

    /// The finest power of two at which the rounded weights' magnitudes stay within the limit.
    fn round_weights(&mut self, real: &[([usize; 3], f64)]) {
        let total: f64 = real.iter().map(|(_, weight)| weight.abs()).sum();
        if total == 0.0 {
            self.pair_starts = vec![0];
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "the limit is below 2^53")]
        let limit = WEIGHT_LIMIT as f64;
        // Every rounding may add a half.
        let mut bits = exponent(limit) - exponent(total) + 1;
        let sum = |bits: i32| {
            let scale = 2.0_f64.powi(bits);
            real.iter()
                .map(|(_, weight)| (weight * scale).round().abs())
                .sum::<f64>()
        };
        while sum(bits) > limit {
            bits -= 1;
        }
        self.weight_bits = bits;
        let scale = 2.0_f64.powi(bits);
        let mut pair_sum = 0_i64;
        let mut greatest = 0_i64;
        for (triple, weight) in real {
            let rounded = (weight * scale).round();
            self.rounding += (weight * scale - rounded).abs();
            #[expect(
                clippy::cast_possible_truncation,
                reason = "magnitudes are below the limit of 2^31 - 1, points were counted"
            )]
            let (rounded, [i, j, k]) = (rounded as i32, triple.map(|index| index as u16));
            if rounded == 0 {
                continue;
            }
            if self.pairs.last() != Some(&[i, j]) {
                self.pairs.push([i, j]);
                self.pair_starts.push(length(&self.thirds));
                pair_sum = 0;
            }
            pair_sum += i64::from(rounded.unsigned_abs());
            greatest = greatest.max(pair_sum);
            self.thirds.push(k);
            self.weights.push(rounded);
        }
        self.pair_starts.push(length(&self.thirds));
        self.pair_bits = (0..31).find(|&bits| greatest <= 1 << bits).unwrap_or(31);
    }

    /// Chooses the units so that the rest pose's results leave headroom.
    fn choose_shifts(&mut self, form: &ControlForm, rest: &[[i32; 3]]) {
        let points = rest
            .iter()
            .map(|point| point.map(f64::from))
            .collect::<Vec<_>>();
        let (points, _) = super::surface::centred(&points);
        let difference = i32::try_from(self.difference_shift).unwrap_or_default();
        let volume = form.volume(&points).abs();
        let shift = exponent(volume) + self.weight_bits - 3 * difference - VOLUME_BITS;
        self.volume_shift = u32::try_from(shift.clamp(1, 122)).unwrap_or(1);
        let greatest = form
            .gradient(&points)
            .iter()
            .flatten()
            .fold(0.0_f64, |most, slope| most.max(slope.abs()));
        let exact = exponent(greatest) + self.weight_bits - 2 * difference - 31;
        self.gradient_bits = u32::try_from((GRADIENT_BITS - exact).clamp(0, 60)).unwrap_or(0);
    }

    /// The parts as core takes them.
    #[must_use]
    pub fn parts(&self) -> VolumeFormParts<'_> {
        VolumeFormParts {
            points: &self.points,
            pairs: &self.pairs,
            pair_starts: &self.pair_starts,
            thirds: &self.thirds,
            weights: &self.weights,
            difference_shift: self.difference_shift,
            pair_bits: self.pair_bits,
            volume_shift: self.volume_shift,
            gradient_bits: self.gradient_bits,
            weight_bits: self.weight_bits,
        }
    }

    /// The bytes of a bundle's section.
    #[must_use]
    pub fn section(&self) -> Vec<u8> {
        let count = |length: usize| u32::try_from(length).unwrap_or(u32::MAX).into();
        let record = VolumeRecord {
            points: count(self.points.len()),
            pairs: count(self.pairs.len()),
            taps: count(self.weights.len()),
            difference_shift: self.difference_shift.into(),
            pair_bits: self.pair_bits.into(),
            volume_shift: self.volume_shift.into(),
            gradient_bits: self.gradient_bits.into(),
            weight_bits: self.weight_bits.into(),
        };
        [
            record.as_bytes(),
            self.weights.as_bytes(),
            self.pair_starts.as_bytes(),
            self.pairs.as_bytes(),
            self.points.as_bytes(),
            self.thirds.as_bytes(),
        ]
        .concat()
    }

    /// A device's volume in cubes of the coordinates' last place.
    #[must_use]
    pub fn volume_unit(&self) -> f64 {
        let shifts = self.volume_shift + 3 * self.difference_shift;
        2.0_f64.powi(i32::try_from(shifts).unwrap_or_default() - self.weight_bits)
    }

    /// A device's gradient in squares of the coordinates' last place.
    #[must_use]
    pub fn gradient_unit(&self) -> f64 {
        let shifts = 31 + 2 * self.difference_shift;
        let fine = i32::try_from(self.gradient_bits).unwrap_or_default();
        2.0_f64.powi(i32::try_from(shifts).unwrap_or_default() - fine - self.weight_bits)
    }

    /// Bytes in flash: the record, weights, starts, pairs, points and thirds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of::<VolumeRecord>()
            + 2 * self.points.len()
            + 4 * self.pairs.len()
            + 4 * self.pair_starts.len()
            + 6 * self.weights.len()
    }

    /// How far the device's volume can be from the form's, in cubes of the coordinates' last place,
    /// for poses whose differences to the base are at most `reach` last places along each axis.
    ///
    /// A determinant has six products of one number of each axis. It is at most 6 times the product of
    /// their limits, and numbers that are off by a half each change it by at most 6 times what the
    /// product grows by when the limits grow by a half.
    #[must_use]
    pub fn volume_bound(&self, reach: [f64; 3]) -> f64 {
        let step = 2.0_f64.powi(i32::try_from(self.difference_shift).unwrap_or_default());
        let product = |more: f64| reach.iter().map(|axis| axis / step + more).product::<f64>();
        let weights: f64 = self
            .weights
            .iter()
            .map(|&weight| f64::from(weight).abs())
            .sum();
        let from_differences = weights * 6.0 * (product(0.5) - product(0.0));
        let from_weights = self.rounding * 6.0 * product(0.0);
        let from_result = 0.5 * 2.0_f64.powi(i32::try_from(self.volume_shift).unwrap_or_default());
        let unit = step.powi(3) * 2.0_f64.powi(-self.weight_bits);
        (from_differences + from_weights + from_result) * unit
    }

    /// How far a coordinate of the device's gradient can be from the form's, in squares of the coordinates' last place,
    /// for poses as in [`volume_bound`](Self::volume_bound): of every point but the base, and of the base, whose gradient is
    /// minus the sum of the others. Coordinates that were clamped are not meant.
    ///
    /// Differences are off by a half each; doubled `n` times they fill 30 bits, and cross products are rounded by `2^31`.
    /// A cross product has two products of numbers of the two other axes. A point that is the third of a triple gets the
    /// weight times a rounded product; the first and second of a pair get the product with the pair's weighted
    /// sum, which is rounded by `2^pair_bits`, and rounded once more. The result is rounded to its unit.
    #[must_use]
    pub fn gradient_bound(&self, reach: [f64; 3]) -> [f64; 2] {
        let power = |exponent: i32| 2.0_f64.powi(exponent);
        let small = |bits: u32| i32::try_from(bits).unwrap_or_default();
        let step = power(small(self.difference_shift));
        let greatest = reach.iter().fold(0.0_f64, |most, own| most.max(*own)) / step + 0.5;
        // A pose of less reach is doubled more often, and its products are rounded finer.
        let doublings = (30 - exponent(greatest)).clamp(0, 30);
        let scale = power(doublings);
        let (limits, half) = (reach.map(|own| own / step * scale), scale / 2.0);
        let area = power(31);
        let (weights, thirds, pairs) = self.shares();
        let mut others = 0.0_f64;
        let mut base = 0.0_f64;
        for (b, c) in [(1, 2), (2, 0), (0, 1)] {
            let (b, c) = (limits[b], limits[c]);
            let product = 2.0 * ((b + half) * (c + half) - b * c) / area;
            let of_sum = (b + c + 2.0 * half) / 2.0 / power(31 - small(self.pair_bits)) + 0.5;
            let of_weights = self.rounding * 2.0 * b * c / area;
            let mut total = 0.0;
            for (place, weight) in weights.iter().enumerate() {
                let own =
                    weight * product + thirds[place] / 2.0 + pairs[place] * of_sum + of_weights;
                let back = power(31 + 2 * small(self.difference_shift) - self.weight_bits);
                let own = own * back / (scale * scale) + self.gradient_unit() / 2.0;
                others = others.max(own);
                total += own;
            }
            base = base.max(total);
        }
        [others, base]
    }

    /// For each point but the base: the magnitudes of the weights of its triples, of those that it is the third of, and the
    /// number of pairs that it is in.
    fn shares(&self) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let count = self.points.len().saturating_sub(1);
        let mut shares = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        let (weights, thirds, pairs) = (&mut shares.0, &mut shares.1, &mut shares.2);
        for (pair, range) in self.pairs.iter().zip(self.pair_starts.windows(2)) {
            let taps = range[0] as usize..range[1] as usize;
            let [first, second] = pair.map(usize::from);
            pairs[first] += 1.0;
            pairs[second] += 1.0;
            for (third, weight) in self.thirds[taps.clone()].iter().zip(&self.weights[taps]) {
                let (third, weight) = (usize::from(*third), f64::from(*weight).abs());
                thirds[third] += weight;
                for place in [first, second, third] {
                    weights[place] += weight;
                }
            }
        }
        shares
    }

    /// The greatest differences to the base along each axis, in last places: the reach of a pose.
    #[must_use]
    pub fn reach(&self, pose: &[[i32; 3]]) -> [f64; 3] {
        let at = |point: &u16| pose.get(usize::from(*point)).copied().unwrap_or_default();
        let base = self.points.first().map(at).unwrap_or_default();
        [0, 1, 2].map(|axis| {
            let own = self.points.iter().map(|point| f64::from(at(point)[axis]));
            own.fold(0.0, |most, own| {
                (own - f64::from(base[axis])).abs().max(most)
            })
        })
    }
}

/// The place of the control point that occurs in most taps.
fn busiest(form: &ControlForm) -> usize {
    let size = form.points.len();
    let mut taps = vec![0_usize; size];
    for (triple, value) in triples(size).zip(form.form.coefficients()) {
        if *value != 0.0 {
            for index in triple {
                taps[index] += 1;
            }
        }
    }
    (0..size)
        .rev()
        .max_by_key(|&place| taps[place])
        .unwrap_or(0)
}

fn length(thirds: &[u16]) -> u32 {
    u32::try_from(thirds.len()).unwrap_or(u32::MAX)
}

/// The least `n` with `value < 2^n`; 0 for 0.
fn exponent(value: f64) -> i32 {
    if value == 0.0 {
        return 0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "exponents are small")]
    let floor = value.abs().log2().floor() as i32;
    floor + 1
}
