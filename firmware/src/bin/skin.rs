//! A surface from its few control points in two ways, side by side: by the baked table, and refined on the
//! device level by level. Instructions and bytes of both, and how far their points are apart.
//!
//! The bundle `skin.oct` (a Catmull-Clark surface, rows in the order of the refined vertices), the
//! control mesh `skin.bin` (numbers of vertices, faces, corners of all faces and levels; where each
//! face's corners start and where the last one's end; the corners) and the poses `skin.poses` (raw bits
//! of every control point, frame after frame) come from the host. All memory is the board's large one
//! (16 MiB that only the emulated boards have), so that every arena has exactly the length it needs.
#![no_std]
#![no_main]

use core::mem::{MaybeUninit, align_of, size_of};
use core::slice;

use cortex_m_rt::entry;
use octruss::blend::FixedBlend;
use octruss::bundle::Bundle;
use octruss::deform::Table;
use octruss::mesh::{ControlMesh, ControlMeshBuffers, FaceOrder, MeshError, Side, SurfaceEdges};
use octruss::surface::catmull_clark::{refine_points, split, split_counts};
use octruss::surface::{PointBuffers, Rim, VertexState};
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::files::Input;
use octruss_firmware::instructions::InstructionCounter;
use zerocopy::{FromBytes, IntoBytes};

/// The boards' memory beyond what the linker knows of.
const LARGE_MEMORY: usize = 0x2100_0000;
/// Its bytes.
const LARGE_BYTES: usize = 16 << 20;
/// What a file may have, in units of eight bytes.
const FILE_UNITS: usize = 1 << 18;
/// Levels at most, with the names of their figures.
const LEVELS: [&str; 3] = ["skin points 1", "skin points 2", "skin points 3"];

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

    fn file(&mut self, name: &'static core::ffi::CStr) -> &'static [u8] {
        let bytes = self.slice(FILE_UNITS, 0_u64).as_mut_bytes();
        let length = Input::open(name).read(bytes);
        bytes.get(..length).unwrap_or_default()
    }
}

/// A level's connectivity, kept from frame to frame, and what its values are computed in.
struct Level {
    mesh: ControlMesh<'static>,
    edges: SurfaceEdges<'static>,
    order: FaceOrder<'static>,
    out: &'static mut [[i32; 3]],
    sums: &'static mut [[i64; 3]],
    states: &'static mut [VertexState],
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
    let bundle = memory.file(c"skin.oct");
    let Ok(bundle) = Bundle::new_checked(bundle) else {
        refuse("skin.oct does not open")
    };
    let Ok(table) = bundle.table::<i32>() else {
        refuse("skin.oct holds no table of 32-bit coordinates")
    };
    let Some((mesh, levels)) = control_mesh(memory.file(c"skin.bin")) else {
        refuse("skin.bin is cut short")
    };
    let poses = memory.file(c"skin.poses");
    match build(&mut counter, &mut memory, mesh, levels) {
        Ok(levels) => {
            animate(&mut counter, &mut memory, &table, levels, poses);
            exit::finish()
        }
        Err(error) => {
            defmt::error!("{}", error);
            exit::stop(Ending::Refused)
        }
    }
}

/// The control mesh of a file, and how often it is refined.
fn control_mesh(bytes: &'static [u8]) -> Option<(ControlMesh<'static>, usize)> {
    let (counts, rest) = <[u32; 4]>::ref_from_prefix(bytes).ok()?;
    let [vertices, faces, corners, levels] = *counts;
    let (offsets, rest) = <[u32]>::ref_from_prefix_with_elems(rest, faces as usize + 1).ok()?;
    let (indices, _) = <[u32]>::ref_from_prefix_with_elems(rest, corners as usize).ok()?;
    let mesh = ControlMesh {
        vertex_count: vertices,
        offsets,
        indices,
        ..ControlMesh::default()
    };
    Some((mesh, levels as usize))
}

/// The connectivity of all levels: what a device does once, before the first frame.
fn build(
    counter: &mut InstructionCounter,
    memory: &mut Memory,
    mut mesh: ControlMesh<'static>,
    count: usize,
) -> Result<heapless::Vec<Level, { LEVELS.len() }>, MeshError> {
    let mut levels = heapless::Vec::new();
    let (mut kept, mut scratch, mut instructions) = (0, 0, 0);
    for _ in 0..count {
        let before = memory.used;
        let sides = memory.slice(mesh.indices.len(), Side::default());
        let order = memory.slice(mesh.face_count(), 0);
        // Arenas are lent before the count starts; how long they are takes the edges, which are found
        // again below and counted.
        let counts = split_counts(&mesh, &SurfaceEdges::new(&mesh, &mut *sides)?);
        let counts = counts.ok_or(MeshError::TooLarge)?;
        let buffers = ControlMeshBuffers {
            offsets: memory.slice(counts.faces + 1, 0),
            indices: memory.slice(counts.indices, 0),
            creases: memory.slice(counts.creases, [0; 2]),
            corners: memory.slice(counts.corners, 0),
        };
        let out = memory.slice(counts.vertices, [0; 3]);
        kept += memory.used - before;
        let before = memory.used;
        let sums = memory.slice(counts.vertices, [0; 3]);
        let states = memory.slice(counts.vertices, VertexState::default());
        // The levels take turns: the scratch of the last is enough for all.
        scratch = memory.used - before;
        let (made, counted) = counter.count(|| {
            let edges = SurfaceEdges::new(&mesh, sides)?;
            let order = FaceOrder::new(&mesh, order)?;
            let next = split(&mesh, &edges, &order, buffers)?;
            Ok((edges, order, next))
        });
        let (edges, order, next) = made?;
        instructions += counted;
        let level = Level {
            mesh,
            edges,
            order,
            out,
            sums,
            states,
        };
        if levels.push(level).is_err() {
            refuse("there are more levels than this image holds");
        }
        mesh = next;
    }
    figure("skin connectivity", instructions);
    figure("skin arenas", kept as u32);
    figure("skin scratch", scratch as u32);
    Ok(levels)
}

/// Every frame in both ways.
fn animate(
    counter: &mut InstructionCounter,
    memory: &mut Memory,
    table: &Table<'_, i32>,
    mut levels: heapless::Vec<Level, { LEVELS.len() }>,
    poses: &[u8],
) {
    let skin = memory.slice(table.rows(), [0; 3]);
    let pose_bytes = table.control_points() * size_of::<[i32; 3]>();
    figure("skin rows", skin.len() as u32);
    figure("skin table memory", (size_of_val(skin) + pose_bytes) as u32);
    let (mut frames, mut greatest, mut unequal) = (0, 0, 0);
    for pose in poses.chunks_exact(pose_bytes) {
        let Ok(pose) = <[[i32; 3]]>::ref_from_bytes(pose) else {
            refuse("skin.poses is not aligned")
        };
        let (applied, counted) = counter.count(|| table.apply(0..skin.len(), pose, skin));
        let (refined, of_levels) = refine(counter, &mut levels, pose);
        if applied != Ok(0) || refined.len() != skin.len() {
            refuse("the table and the levels do not belong together, or a coordinate saturated");
        }
        if frames == 0 {
            figure("skin table", counted);
            for (name, counted) in LEVELS.iter().zip(of_levels) {
                figure(name, counted);
            }
        }
        let pairs = skin.as_flattened().iter().zip(refined.as_flattened());
        for (one, other) in pairs {
            let apart = one.abs_diff(*other);
            greatest = apart.max(greatest);
            unequal += u32::from(apart != 0);
        }
        frames += 1;
    }
    figure("skin frames", frames);
    figure("skin greatest difference", greatest);
    figure("skin unequal coordinates", unequal);
}

/// The values of all levels of a pose, and the instructions of each.
fn refine<'l>(
    counter: &mut InstructionCounter,
    levels: &'l mut [Level],
    pose: &'l [[i32; 3]],
) -> (&'l [[i32; 3]], heapless::Vec<u32, { LEVELS.len() }>) {
    let mut points = pose;
    let mut instructions = heapless::Vec::new();
    for level in levels {
        let mut blend = FixedBlend::<i32, 3>::new();
        let (mesh, edges, order) = (&level.mesh, &level.edges, &level.order);
        let buffers = PointBuffers {
            out: &mut *level.out,
            sums: &mut *level.sums,
            states: &mut *level.states,
        };
        let (refined, counted) = counter
            .count(|| refine_points(&mut blend, mesh, edges, order, Rim::Spline, points, buffers));
        match refined {
            Ok(refined) if blend.saturated() == 0 => points = refined,
            _ => refuse("a level cannot be refined, or a coordinate saturated"),
        }
        // There are no more levels than it holds.
        let _ = instructions.push(counted);
    }
    (points, instructions)
}

/// Says why nothing can be measured and ends the image.
fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}
