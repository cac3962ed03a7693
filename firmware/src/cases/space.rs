//! The memory that cases run in: one block, fixed, and the same on the host and on a device.
//!
//! A case lays it out as it needs. A buffer gets exactly the length that is asked for, and the
//! bytes right behind it hold a pattern: a write past the end of what was lent changes it, and
//! [`Space::check`] says so.

use core::mem::{MaybeUninit, align_of, size_of, take};
use core::slice;

use octruss::mesh::{Arena, MeshError};

use super::Status;

/// What memory is dealt out in. The alignment suits everything that core asks for, so that a
/// buffer takes equally much of it on the host and on a device.
#[repr(C, align(16))]
struct Unit([u8; 16]);

/// Bytes of the whole block.
const BLOCK_BYTES: usize = 98 * 1024;

/// All memory of all kinds of cases.
pub struct Memory([MaybeUninit<Unit>; BLOCK_BYTES / size_of::<Unit>()]);

impl Memory {
    /// Memory that has not been used.
    #[must_use]
    pub const fn new() -> Self {
        Memory([const { MaybeUninit::uninit() }; BLOCK_BYTES / size_of::<Unit>()])
    }

    /// All of it.
    pub(super) fn space(&mut self) -> Space<'_> {
        Space::over(&mut self.0)
    }

    /// Two parts, the first of them this long.
    pub(super) fn split(&mut self, first_bytes: usize) -> [Space<'_>; 2] {
        let units = first_bytes.div_ceil(size_of::<Unit>()).min(self.0.len());
        let (first, second) = self.0.split_at_mut(units);
        [Space::over(first), Space::over(second)]
    }
}

impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}

/// Types of which a copy of the bits is a value of its own.
///
/// # Safety
///
/// The type owns nothing outside itself, points to nothing, and dropping it does nothing.
pub(super) unsafe trait Plain: 'static {}

/// The pattern behind a buffer: no index and hardly any coordinate is made of it.
const PATTERN: u8 = 0xa5;

/// What lies behind a buffer. It stands before the buffer in the block itself, so that the list of
/// all guards takes nothing of the stack, which a device has little of.
struct Guard<'a> {
    bytes: &'a [u8],
    /// The buffer's number.
    buffer: u32,
    /// That of the buffer lent before.
    before: Option<&'a Guard<'a>>,
}

/// Units before a buffer, the same on every machine.
const GUARD_UNITS: usize = 2;

/// Memory that has not been lent yet.
pub(super) struct Space<'a> {
    free: &'a mut [MaybeUninit<Unit>],
    /// That of the last buffer.
    guards: Option<&'a Guard<'a>>,
}

impl<'a> Space<'a> {
    fn over(free: &'a mut [MaybeUninit<Unit>]) -> Self {
        Space { free, guards: None }
    }

    /// What is free, to be lent for a while.
    pub fn rest(&mut self) -> Space<'_> {
        Space::over(self.free)
    }

    /// What is free, to be lent for a while in two parts of the same size.
    pub fn halves(&mut self) -> [Space<'_>; 2] {
        let (first, second) = self.free.split_at_mut(self.free.len() / 2);
        [Space::over(first), Space::over(second)]
    }

    /// Lends a buffer of `count` elements, all `value`. If they do not fit, the error names
    /// `arena`. The elements are never dropped.
    pub fn slice<T: Clone>(
        &mut self,
        arena: Arena,
        count: usize,
        value: T,
    ) -> Result<&'a mut [T], Status> {
        let too_small = |given| {
            Status::Mesh(MeshError::ArenaTooSmall {
                arena,
                needed: count,
                given,
            })
        };
        let given = self.bytes_free() / size_of::<T>().max(1);
        let bytes = count.checked_mul(size_of::<T>()).ok_or(too_small(given))?;
        let memory = self.bytes::<T>(bytes).ok_or(too_small(given))?;
        // SAFETY: the memory is aligned for `T`, as `bytes` promises, has room for `count`
        // elements, and is lent once. `MaybeUninit` needs no values there.
        let elements: &'a mut [MaybeUninit<T>] =
            unsafe { slice::from_raw_parts_mut(memory.as_mut_ptr().cast(), count) };
        for element in elements.iter_mut() {
            element.write(value.clone());
        }
        // SAFETY: every element was just written.
        Ok(unsafe { elements.assume_init_mut() })
    }

    /// Lends room for a large value and copies `first` to it, without passing the stack.
    pub fn place<T: Plain>(&mut self, first: &'static T) -> Result<&'a mut T, Status> {
        let memory = self.bytes::<T>(size_of::<T>()).ok_or(Status::Memory)?;
        let slot: *mut T = memory.as_mut_ptr().cast();
        // SAFETY: the memory is aligned for `T` and has its size, as `bytes` promises, and is lent
        // once; it overlaps no static. A copy of the bits is a value, as `Plain` promises.
        unsafe {
            slot.copy_from_nonoverlapping(first, 1);
            Ok(&mut *slot)
        }
    }

    /// Whether everything behind the buffers that this space lent is as it was.
    pub fn check(&self) -> Result<(), Status> {
        let mut next = self.guards;
        while let Some(guard) = next {
            if guard.bytes.iter().any(|byte| *byte != PATTERN) {
                let buffer = guard.buffer;
                return Err(Status::GuardBroken { buffer });
            }
            next = guard.before;
        }
        Ok(())
    }

    /// Bytes that a buffer could have.
    fn bytes_free(&self) -> usize {
        let units = self.free.len().saturating_sub(GUARD_UNITS + 1);
        units.saturating_mul(size_of::<Unit>())
    }

    /// Takes memory aligned for `T`, with a guard behind it; `None` if there is not enough.
    fn bytes<T>(&mut self, count: usize) -> Option<&'a mut [MaybeUninit<u8>]> {
        const { assert!(align_of::<T>() <= align_of::<Unit>()) };
        const { assert!(size_of::<Guard<'_>>() <= GUARD_UNITS * size_of::<Unit>()) };
        const { assert!(align_of::<Guard<'_>>() <= align_of::<Unit>()) };
        // One unit more than needed, so that the pattern has 16 bytes at least.
        let units = count.div_ceil(size_of::<Unit>()).saturating_add(1);
        if units.saturating_add(GUARD_UNITS) > self.free.len() {
            return None;
        }
        let (guard, rest) = take(&mut self.free).split_at_mut(GUARD_UNITS);
        let (own, rest) = rest.split_at_mut(units);
        self.free = rest;
        // SAFETY: these are the units' own bytes, and they need no values.
        let own: &'a mut [MaybeUninit<u8>] =
            unsafe { slice::from_raw_parts_mut(own.as_mut_ptr().cast(), size_of_val(own)) };
        let (memory, behind) = own.split_at_mut(count);
        for byte in behind.iter_mut() {
            byte.write(PATTERN);
        }
        // SAFETY: every byte was just written.
        let bytes = unsafe { behind.assume_init_ref() };
        // SAFETY: the units have room for a guard and its alignment, see above, and are lent once.
        let guard: &'a mut MaybeUninit<Guard<'a>> = unsafe { &mut *guard.as_mut_ptr().cast() };
        self.guards = Some(guard.write(Guard {
            bytes,
            buffer: self.guards.map_or(0, |last| last.buffer.wrapping_add(1)),
            before: self.guards,
        }));
        Some(memory)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::boxed::Box;

    use super::{Arena, Memory, PATTERN, Space, Status};
    use octruss::mesh::MeshError;

    #[test]
    fn buffers_have_their_length_and_a_guard_right_behind() {
        let mut memory = Box::new(Memory::new());
        let mut space = memory.space();
        let bytes = space.slice(Arena::Edges, 13, 7_u8).unwrap();
        assert_eq!(bytes, [7; 13]);
        let end = bytes.as_ptr_range().end;
        let words = space.slice(Arena::Sums, 3, [1_i64; 3]).unwrap();
        assert_eq!(words, [[1; 3]; 3]);
        assert!(words.as_ptr().is_aligned());
        let last = space.guards.unwrap();
        assert_eq!((last.buffer, last.bytes.len()), (1, 24));
        let first = last.before.unwrap();
        assert_eq!((first.buffer, first.bytes.as_ptr()), (0, end));
        assert!(first.bytes.len() >= 16 && first.before.is_none());
        assert_eq!(space.check(), Ok(()));
    }

    #[test]
    fn a_write_behind_the_end_is_found() {
        for place in 0..16 {
            let mut changed = [PATTERN; 16];
            changed[place] ^= 1;
            let mut memory = Box::new(Memory::new());
            let mut space = memory.space();
            space.slice(Arena::Edges, 5, [0_u32; 3]).unwrap();
            space.slice(Arena::Edges, 5, [0_u32; 3]).unwrap();
            space.check().unwrap();
            let broken = super::Guard {
                bytes: &changed,
                buffer: 1,
                before: space.guards,
            };
            space.guards = Some(&broken);
            assert_eq!(space.check(), Err(Status::GuardBroken { buffer: 1 }));
        }
    }

    #[test]
    fn what_does_not_fit_is_refused_and_takes_nothing() {
        let mut memory = Box::new(Memory::new());
        let [mut first, second] = memory.split(140);
        // Nine units, three of them for the guard.
        assert_eq!(first.bytes_free(), 96);
        let error = first.slice(Arena::Sums, 5, [0_i64; 3]).map(|_| ());
        let expected = MeshError::ArenaTooSmall {
            arena: Arena::Sums,
            needed: 5,
            given: 4,
        };
        assert_eq!(error, Err(Status::Mesh(expected)));
        assert!(first.slice(Arena::Sums, usize::MAX, 0_u64).is_err());
        assert_eq!(
            first.slice(Arena::Sums, 4, [9_i64; 3]),
            Ok(&mut [[9; 3]; 4][..])
        );
        assert_eq!(first.bytes_free(), 0);
        // Not even the guard of an empty buffer fits now.
        assert!(first.slice(Arena::Corners, 0, 0_u32).is_err());
        assert_eq!(second.bytes_free(), super::BLOCK_BYTES - (9 + 3) * 16);
    }

    #[test]
    fn what_was_lent_for_a_while_comes_back() {
        let mut memory = Box::new(Memory::new());
        let mut space: Space<'_> = memory.space();
        let before = space.bytes_free();
        space.rest().slice(Arena::Edges, 100, 0_u64).unwrap();
        assert_eq!(space.bytes_free(), before);
    }
}
