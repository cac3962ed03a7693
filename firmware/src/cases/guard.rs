//! Guards behind the buffers that core writes to.
//!
//! A buffer is lent at exactly the length that is needed. The elements right behind it get a
//! pattern first; a write past the end of what was lent changes it.

use super::Status;

/// Elements behind each lent buffer that must not change.
pub const GUARD_ELEMENTS: usize = 2;

/// A word that no index and hardly any coordinate has.
const PATTERN: u32 = 0xa5c3_96e1;

/// What buffers hold.
pub trait Element: Copy + PartialEq {
    /// The guard's pattern.
    const GUARD: Self;
}

impl Element for u32 {
    const GUARD: Self = PATTERN;
}

impl<const N: usize> Element for [u32; N] {
    const GUARD: Self = [PATTERN; N];
}

impl<const N: usize> Element for [i32; N] {
    const GUARD: Self = [PATTERN.cast_signed(); N];
}

impl<const N: usize> Element for [i64; N] {
    const GUARD: Self = [0x5a3c_691e_a5c3_96e1; N];
}

/// The elements behind a lent buffer.
pub struct Guard<'a, T: Element>(&'a [T]);

impl<T: Element> Guard<'_, T> {
    /// Says whether the buffer with this number was left alone behind its end.
    pub fn check(&self, buffer: u32) -> Result<(), Status> {
        if self.0.iter().all(|element| *element == T::GUARD) {
            Ok(())
        } else {
            Err(Status::GuardBroken { buffer })
        }
    }
}

/// Lends the first `needed` elements of `buffer`, or as many as there are without those kept back
/// for the guard: then core finds its arena too small and says so.
pub fn lend<T: Element>(buffer: &mut [T], needed: usize) -> (&mut [T], Guard<'_, T>) {
    let capacity = buffer.len().saturating_sub(GUARD_ELEMENTS);
    let (lent, behind) = buffer.split_at_mut(needed.min(capacity));
    let behind = behind.get_mut(..GUARD_ELEMENTS).unwrap_or_default();
    behind.fill(T::GUARD);
    (lent, Guard(behind))
}

#[cfg(test)]
mod tests {
    use super::{Element, GUARD_ELEMENTS, Status, lend};

    #[test]
    fn a_write_behind_the_end_is_found() {
        for place in 0..GUARD_ELEMENTS {
            let mut buffer = [[0_i32; 3]; 8];
            let (lent, guard) = lend(&mut buffer, 5);
            assert_eq!(lent.len(), 5);
            guard.check(4).unwrap();
            buffer[5 + place][2] ^= 1;
            let behind = super::Guard(&buffer[5..7]);
            assert_eq!(behind.check(4), Err(Status::GuardBroken { buffer: 4 }));
        }
    }

    #[test]
    fn the_guard_is_kept_back() {
        let mut buffer = [0_u32; 8];
        let (lent, guard) = lend(&mut buffer, 100);
        assert_eq!(lent.len(), 8 - GUARD_ELEMENTS);
        guard.check(0).unwrap();
        assert_eq!(buffer[6..], [u32::GUARD; 2]);
    }
}
