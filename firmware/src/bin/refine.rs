//! Instructions and arena bytes of core's `refine` on a device, level by level.
//!
//! The cage comes from the host (`cage.bin`: numbers of vertices and tetrahedra, the tetrahedra, the
//! vertices' raw bits), the arenas lie in the board's large memory (16 MiB that only the emulated boards
//! have). Counted as in the image `rivals`; built by `cargo xtask bench`.
#![no_std]
#![no_main]

use core::mem::{MaybeUninit, align_of, size_of};
use core::slice;

use cortex_m_rt::entry;
use octruss::blend::FixedBlend;
use octruss::mesh::{
    MeshError, Numbering, Solid, SolidBuffers, boundary_triangles, edge_capacity, face_capacity,
};
use octruss::solid::tet_oct::{
    Boundary, PointBuffers, VertexState, refine_points, split, split_counts,
};
use octruss::surface::LoopWeights;
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::files::Input;
use octruss_firmware::instructions::InstructionCounter;
use zerocopy::FromBytes;

/// The boards' memory beyond what the linker knows of.
const LARGE_MEMORY: usize = 0x2100_0000;
/// Its bytes.
const LARGE_BYTES: usize = 16 << 20;
/// Levels that are measured.
const LEVELS: [[&str; 2]; 2] = [
    ["refine 1 instructions", "refine 1 bytes"],
    ["refine 2 instructions", "refine 2 bytes"],
];

/// Deals the large memory out, and counts its bytes.
struct Memory {
    used: usize,
}

impl Memory {
    fn slice<T: Copy>(&mut self, count: usize, value: T) -> &'static mut [T] {
        let first = self.used.next_multiple_of(align_of::<T>());
        let bytes = count.saturating_mul(size_of::<T>());
        if bytes > LARGE_BYTES - first {
            refuse("the arenas do not fit the memory");
        }
        self.used = first + bytes;
        // SAFETY: the board has this memory, nothing else uses it, and no part of it is dealt out twice;
        // `MaybeUninit` needs no values there.
        let elements: &'static mut [MaybeUninit<T>] =
            unsafe { slice::from_raw_parts_mut((LARGE_MEMORY + first) as *mut _, count) };
        for element in elements.iter_mut() {
            element.write(value);
        }
        // SAFETY: every element was just written.
        unsafe { elements.assume_init_mut() }
    }
}

#[entry]
fn main() -> ! {
    let Some(core) = cortex_m::Peripherals::take() else {
        refuse("the peripherals have been taken before")
    };
    let Ok(mut counter) = InstructionCounter::start(core.SYST) else {
        refuse("the clock does not follow the instructions: run with -icount shift=7")
    };
    let mut memory = Memory { used: 0 };
    match measure(&mut counter, &mut memory) {
        Some(Ok(())) => exit::finish(),
        Some(Err(error)) => {
            defmt::error!("{}", error);
            exit::stop(Ending::Refused)
        }
        None => refuse("cage.bin is cut short"),
    }
}

/// Refines the cage; `None` if the file is none.
fn measure(counter: &mut InstructionCounter, memory: &mut Memory) -> Option<Result<(), MeshError>> {
    let bytes = memory.slice(1 << 16, 0_u64);
    let bytes = zerocopy::IntoBytes::as_mut_bytes(bytes);
    let length = Input::open(c"cage.bin").read(bytes);
    let bytes: &'static [u8] = bytes.get(..length)?;
    let (counts, rest) = <[u32; 2]>::ref_from_prefix(bytes).ok()?;
    let &[vertices, tetrahedra] = counts;
    let (tetrahedra, rest) =
        <[[u32; 4]]>::ref_from_prefix_with_elems(rest, tetrahedra as usize).ok()?;
    let (points, _) = <[[i32; 3]]>::ref_from_prefix_with_elems(rest, vertices as usize).ok()?;
    let cage = Solid {
        vertex_count: vertices,
        tetrahedra,
        ..Solid::default()
    };
    Some(levels(counter, memory, cage, points))
}

fn levels(
    counter: &mut InstructionCounter,
    memory: &mut Memory,
    cage: Solid<'static>,
    mut points: &'static [[i32; 3]],
) -> Result<(), MeshError> {
    let faces = memory.slice(face_capacity(&cage).ok_or(MeshError::TooLarge)?, [0; 3]);
    let mut solid = Solid {
        surface: boundary_triangles(&cage, faces)?,
        ..cage
    };
    let mut blend = FixedBlend::<i32, 3>::new();
    for [instructions, bytes] in LEVELS {
        let before = memory.used;
        let edges = memory.slice(edge_capacity(&solid).ok_or(MeshError::TooLarge)?, [0; 2]);
        let order = memory.slice(solid.octahedra.len(), 0);
        // Arenas are lent before the count starts; how long they are takes a numbering, which is counted
        // below once more.
        let sizes = Numbering::new(&solid, edges, order)?;
        let counts = split_counts(&solid, &sizes).ok_or(MeshError::TooLarge)?;
        let vertices = sizes.vertex_count() as usize;
        let buffers = SolidBuffers {
            tetrahedra: memory.slice(counts.tetrahedra, [0; 4]),
            octahedra: memory.slice(counts.octahedra, [0; 6]),
            surface: memory.slice(counts.surface, [0; 3]),
            creases: memory.slice(counts.creases, [0; 2]),
            corners: memory.slice(counts.corners, 0),
        };
        let values = PointBuffers {
            out: memory.slice(vertices, [0; 3]),
            sums: memory.slice(vertices, [0; 3]),
            states: memory.slice(vertices, VertexState::default()),
        };
        figure(bytes, (memory.used - before) as u32);
        let edges = memory.slice(edge_capacity(&solid).ok_or(MeshError::TooLarge)?, [0; 2]);
        let order = memory.slice(solid.octahedra.len(), 0);
        let boundary = Boundary::Surface(LoopWeights::Loop);
        let (refined, counted) = counter.count(|| {
            let numbering = Numbering::new(&solid, edges, order)?;
            let next = split(&solid, &numbering, buffers)?;
            let points = refine_points(&mut blend, &solid, &numbering, boundary, points, values)?;
            Ok((next, points))
        });
        figure(instructions, counted);
        let (next, refined): (Solid<'static>, &'static mut [[i32; 3]]) = refined?;
        (solid, points) = (next, refined);
    }
    Ok(())
}

/// Says why nothing can be measured and ends the image.
fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}
