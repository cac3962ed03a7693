//! Amplitudes as what drivers of parts take.

/// The greatest set-point: 12 bits, as the timers and converters of usual parts have them.
pub const SET_POINT_MOST: u16 = 4095;

/// The set-point of an amplitude: 0 at the lower bound, [`SET_POINT_MOST`] at the upper one,
/// `floor((amplitude - lower) * 4095 / (upper - lower) + 1/2)` between. Amplitudes beyond a bound count as the bound; if
/// both are the same the set-point is 0.
#[must_use]
pub fn set_point(amplitude: i32, lower: i32, upper: i32) -> u16 {
    // Differences have at most 32 bits, products at most 44.
    let range = u64::from(upper.abs_diff(lower));
    if range == 0 || upper < lower {
        return 0;
    }
    let way = u64::from(amplitude.clamp(lower, upper).abs_diff(lower));
    let twice = 2 * way * u64::from(SET_POINT_MOST) + range;
    (twice / (2 * range)) as u16
}

#[cfg(test)]
mod tests {
    use super::set_point;

    #[test]
    fn bounds_and_halves() {
        assert_eq!(set_point(-5, -5, 10), 0);
        assert_eq!(set_point(10, -5, 10), 4095);
        assert_eq!(set_point(i32::MAX, -5, 10), 4095);
        // 4095 * 5 / 15 = 1365; 4095 / 2 = 2047.5, up.
        assert_eq!(set_point(0, -5, 10), 1365);
        assert_eq!(set_point(0, -1, 1), 2048);
        assert_eq!(set_point(0, i32::MIN, i32::MAX), 2048);
        assert_eq!(set_point(3, 3, 3), 0);
    }
}
