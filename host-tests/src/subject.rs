//! The crate under test, driven on the host over the reference's types.
//!
//! Every buffer that core is lent is longer than it needs, and what lies behind the part that
//! core promises to fill is held against guard words afterwards.

use std::fmt::Debug;

use octruss::blend::{Blend, FixedBlend};
use octruss::mesh::{
    MeshError, Numbering, SolidBuffers, boundary_triangles, edge_capacity, face_capacity,
};
use octruss::solid::tet_oct::{refine_points, split, split_counts};
use octruss::solid::{Boundary as CoreBoundary, PointBuffers, VertexState};
use octruss::surface::LoopWeights;

use crate::rational::{Row, RowBlend, compose, ratio, unit_row};
use crate::reference::{self, Boundary, Solid};

/// How many guard elements lie behind every buffer.
const GUARDS: usize = 5;

/// A number that no index, coordinate or sum of a test mesh has.
const GUARD: u32 = 0xdead_beef;

/// Core's name of a boundary choice.
pub fn core_boundary(boundary: Boundary) -> CoreBoundary {
    match boundary {
        Boundary::Loop => CoreBoundary::Surface(LoopWeights::Loop),
        Boundary::LoopWarren => CoreBoundary::Surface(LoopWeights::Warren),
        Boundary::TriQuad => CoreBoundary::Surface(LoopWeights::TriQuad),
        Boundary::Interior => CoreBoundary::Interior,
        Boundary::Fixed => CoreBoundary::Fixed,
    }
}

/// A solid with the surface triangles that core carries along with it: those of the boundary,
/// then the solid's sheets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoreSolid {
    /// Connectivity, creases and corners.
    pub solid: Solid,
    /// Surface triangles in core's order.
    pub surface: Vec<[u32; 3]>,
}

impl CoreSolid {
    /// A solid of level 0, with the boundary that core finds.
    ///
    /// # Errors
    /// Core's own.
    pub fn new(solid: &Solid) -> Result<Self, MeshError> {
        let mut level = Self {
            solid: solid.clone(),
            surface: Vec::new(),
        };
        let needed = face_capacity(&level.view()).ok_or(MeshError::TooLarge)?;
        let mut faces = guarded(needed, [GUARD; 3]);
        let mut surface = boundary_triangles(&level.view(), &mut faces)?.to_vec();
        check_guards("faces", &faces, needed, &[GUARD; 3]);
        surface.extend_from_slice(&solid.sheets);
        level.surface = surface;
        Ok(level)
    }

    /// Core's view of it.
    pub fn view(&self) -> octruss::mesh::Solid<'_> {
        octruss::mesh::Solid {
            vertex_count: u32::try_from(self.solid.vertex_count).expect("fewer than 2^32"),
            tetrahedra: &self.solid.tetrahedra,
            octahedra: &self.solid.octahedra,
            surface: &self.surface,
            creases: &self.solid.creases,
            corners: &self.solid.corners,
            ..octruss::mesh::Solid::default()
        }
    }
}

/// A buffer of `needed` elements and the guards behind them.
fn guarded<T: Clone>(needed: usize, guard: T) -> Vec<T> {
    vec![guard; needed + GUARDS]
}

/// Holds what lies behind the filled part of a buffer against the guard.
///
/// # Panics
/// If core wrote past what it says it fills.
fn check_guards<T: PartialEq + Debug>(name: &str, buffer: &[T], filled: usize, guard: &T) {
    for (place, element) in buffer.iter().enumerate().skip(filled) {
        if element != guard {
            panic!("{name}: element {place} is {element:?}, only {filled} may be written");
        }
    }
}

/// A vertex state that is not the one core starts with, to stand guard.
fn used_state() -> VertexState {
    let level = CoreSolid::new(&crate::meshes::fan(1, false)).expect("a tetrahedron");
    let edges_needed = edge_capacity(&level.view()).expect("a small number");
    let mut edges = vec![[0; 2]; edges_needed];
    let numbering = Numbering::new(&level.view(), &mut edges, &mut []).expect("enough memory");
    let mut states = [VertexState::default(); 10];
    let buffers = PointBuffers {
        out: &mut [[0; 1]; 10],
        sums: &mut [[0; 1]; 10],
        states: &mut states,
    };
    let mut blend = FixedBlend::<i32, 1>::new();
    refine_points(
        &mut blend,
        &level.view(),
        &numbering,
        CoreBoundary::Interior,
        &[[0]; 4],
        buffers,
    )
    .expect("enough memory");
    assert_ne!(states[0], VertexState::default());
    states[0]
}

/// What stands behind values and sums while core refines.
#[derive(Clone, Debug)]
pub struct Guards<P, S> {
    /// Behind the refined values.
    pub point: P,
    /// Behind the sums.
    pub sum: S,
}

/// Refines once with core over any value type.
///
/// # Errors
/// Core's own.
///
/// # Panics
/// If core wrote past the part of a buffer that it says it fills.
pub fn refine_with<B: Blend>(
    blend: &mut B,
    level: &CoreSolid,
    boundary: CoreBoundary,
    points: &[B::Point],
    guards: &Guards<B::Point, B::Sum>,
) -> Result<(CoreSolid, Vec<B::Point>), MeshError>
where
    B::Point: PartialEq + Debug,
    B::Sum: PartialEq + Debug,
{
    let view = level.view();
    let edges_needed = edge_capacity(&view).ok_or(MeshError::TooLarge)?;
    let mut edges = guarded(edges_needed, [GUARD; 2]);
    let mut order = guarded(view.octahedra.len(), GUARD);
    let numbering = Numbering::new(&view, &mut edges, &mut order)?;
    let next = split_with_guards(level, &numbering)?;

    let vertices = next.solid.vertex_count;
    let mut out = guarded(vertices, guards.point.clone());
    let mut sums = guarded(vertices, guards.sum.clone());
    let state = used_state();
    let mut states = guarded(vertices, state);
    let buffers = PointBuffers {
        out: &mut out,
        sums: &mut sums,
        states: &mut states,
    };
    let filled = refine_points(blend, &view, &numbering, boundary, points, buffers)?.len();
    assert_eq!(filled, vertices, "number of refined values");
    check_guards("edges", &edges, edges_needed, &[GUARD; 2]);
    check_guards("octahedron order", &order, view.octahedra.len(), &GUARD);
    check_guards("points", &out, vertices, &guards.point);
    check_guards("sums", &sums, vertices, &guards.sum);
    check_guards("states", &states, vertices, &state);
    out.truncate(vertices);
    Ok((next, out))
}

fn split_with_guards(level: &CoreSolid, numbering: &Numbering<'_>) -> Result<CoreSolid, MeshError> {
    let view = &level.view();
    let counts = split_counts(view, numbering).ok_or(MeshError::TooLarge)?;
    let mut tetrahedra = guarded(counts.tetrahedra, [GUARD; 4]);
    let mut octahedra = guarded(counts.octahedra, [GUARD; 6]);
    let mut surface = guarded(counts.surface, [GUARD; 3]);
    let mut creases = guarded(counts.creases, [GUARD; 2]);
    let mut corners = guarded(counts.corners, GUARD);
    let buffers = SolidBuffers {
        tetrahedra: &mut tetrahedra,
        octahedra: &mut octahedra,
        surface: &mut surface,
        creases: &mut creases,
        corners: &mut corners,
    };
    let refined = split(view, numbering, buffers)?;
    let of_boundary = 4 * (level.surface.len() - level.solid.sheets.len());
    let next = CoreSolid {
        solid: Solid {
            vertex_count: refined.vertex_count as usize,
            tetrahedra: refined.tetrahedra.to_vec(),
            octahedra: refined.octahedra.to_vec(),
            sheets: refined.surface[of_boundary..].to_vec(),
            creases: refined.creases.to_vec(),
            corners: refined.corners.to_vec(),
        },
        surface: refined.surface.to_vec(),
    };
    check_guards("tetrahedra", &tetrahedra, counts.tetrahedra, &[GUARD; 4]);
    check_guards("octahedra", &octahedra, counts.octahedra, &[GUARD; 6]);
    check_guards("surface", &surface, counts.surface, &[GUARD; 3]);
    check_guards("creases", &creases, counts.creases, &[GUARD; 2]);
    check_guards("corners", &corners, counts.corners, &GUARD);
    Ok(next)
}

/// One level of core in raw 32-bit coordinates: the solid, its points, how many saturated.
///
/// # Errors
/// Core's own.
pub fn refine_bits<const D: usize>(
    level: &CoreSolid,
    boundary: Boundary,
    points: &[[i32; D]],
) -> Result<(CoreSolid, Vec<[i32; D]>, usize), MeshError> {
    let mut blend = FixedBlend::<i32, D>::new();
    let guards = Guards {
        point: [GUARD.cast_signed(); D],
        sum: [i64::from(GUARD); D],
    };
    let (next, points) = refine_with(&mut blend, level, core_boundary(boundary), points, &guards)?;
    Ok((next, points, blend.saturated() as usize))
}

/// Something that hands out its masks exactly: the reference or core.
pub trait Scheme {
    /// Its name in messages.
    fn name(&self) -> &'static str;

    /// The refined solid and the mask of each of its vertices over those of `solid`.
    fn masks(&self, solid: &Solid, boundary: Boundary) -> (Solid, Vec<Row>);

    /// The masks of several levels together, over the vertices of `solid`.
    fn masks_of_levels(
        &self,
        solid: &Solid,
        boundary: Boundary,
        levels: usize,
    ) -> (Solid, Vec<Row>) {
        let points = (0..).take(solid.vertex_count).map(unit_row);
        let start = (solid.clone(), points.collect::<Vec<_>>());
        (0..levels).fold(start, |(solid, rows), _| {
            let (next, masks) = self.masks(&solid, boundary);
            (next, compose(&masks, &rows))
        })
    }
}

/// The independent reference.
#[derive(Clone, Copy, Debug)]
pub struct Reference;

impl Scheme for Reference {
    fn name(&self) -> &'static str {
        "reference"
    }

    fn masks(&self, solid: &Solid, boundary: Boundary) -> (Solid, Vec<Row>) {
        let (solid, masks) = reference::level_masks(solid, boundary).expect("a sound solid");
        let row = |mask: Vec<reference::MaskEntry>| {
            let entries = mask.into_iter();
            entries.map(|(vertex, numerator, denominator)| (vertex, ratio(numerator, denominator)))
        };
        (
            solid,
            masks.into_iter().map(|mask| row(mask).collect()).collect(),
        )
    }
}

/// Core, refining sparse rows of rational numbers instead of coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Core;

impl Scheme for Core {
    fn name(&self) -> &'static str {
        "core"
    }

    fn masks(&self, solid: &Solid, boundary: Boundary) -> (Solid, Vec<Row>) {
        let level = CoreSolid::new(solid).expect("a sound solid");
        let points: Vec<_> = (0..).take(solid.vertex_count).map(unit_row).collect();
        let guards = Guards {
            point: unit_row(GUARD),
            sum: unit_row(GUARD),
        };
        let boundary = core_boundary(boundary);
        let (next, rows) =
            refine_with(&mut RowBlend, &level, boundary, &points, &guards).expect("a sound solid");
        (next.solid, rows)
    }
}

/// Both, so that every check of the papers' figures runs over both.
pub const SCHEMES: [&dyn Scheme; 2] = [&Reference, &Core];
