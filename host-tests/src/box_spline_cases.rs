//! Random box-spline solids: core against the reference, bit for bit.

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::box_spline::{BoxSolid, refine_bits};
use crate::random_mesh::{Limits, random_points, random_solid};
use crate::reference::Boundary;
use crate::reference_box_spline::{Cells, Scheme, choose, improper, refine};
use crate::subject::core_boundary;

/// One random case.
#[derive(Clone, Debug)]
pub struct Case {
    /// The seed that made it.
    pub seed: u64,
    /// Connectivity at level 0, with the diagonals that were drawn.
    pub cells: Cells,
    /// Whether Algorithm 2 is to replace the diagonals that were drawn.
    pub is_chosen: bool,
    /// Which of the two schemes.
    pub scheme: Scheme,
    /// What the surface follows.
    pub boundary: Boundary,
    /// How often to refine.
    pub levels: u32,
    /// Points at level 0, raw bits.
    pub points: Vec<[i32; 3]>,
}

/// What was compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compared {
    /// Cases.
    pub cases: u64,
    /// Coordinates.
    pub coordinates: u64,
    /// Diagonals chosen.
    pub diagonals: u64,
    /// Cases with sheets.
    pub with_sheets: u64,
}

impl Case {
    /// The case of a seed: boundary choices take turns, and of twelve cases four have diagonals
    /// chosen, four given, four the averaged scheme.
    pub fn new(seed: u64) -> Self {
        Self::within(seed, &Limits::default())
    }

    /// The case of a seed within limits; sheets that are hung on later may add some vertices more.
    pub fn within(seed: u64, limits: &Limits) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let levels = rng.random_range(1..=limits.levels);
        let limits = Limits { levels, ..*limits };
        let solid = random_solid(&mut rng, &limits);
        let mut diagonal = || rng.random_range(0..3);
        let tetrahedra = solid.tetrahedra.iter().map(|&cell| (cell, diagonal()));
        let tetrahedra = tetrahedra.collect();
        let octahedra = solid.octahedra.iter().map(|&cell| (cell, diagonal()));
        let octahedra = octahedra.collect();
        let mut cells = Cells {
            vertex_count: u32::try_from(solid.vertex_count).expect("few vertices"),
            tetrahedra,
            octahedra,
            sheets: solid.sheets,
            creases: solid.creases,
            corners: solid.corners,
        };
        if rng.random_ratio(1, 3) {
            add_sheets(&mut rng, &mut cells);
        }
        let points = random_points(&mut rng, cells.vertex_count as usize);
        Self {
            seed,
            cells,
            is_chosen: seed.is_multiple_of(3),
            scheme: if seed % 3 == 1 {
                Scheme::Averaged
            } else {
                Scheme::MajorDiagonals
            },
            boundary: Boundary::ALL[(seed % 5) as usize],
            levels,
            points,
        }
    }
}

/// Hangs up to four triangles on the solid or beside it, each on two vertices that exist.
fn add_sheets(rng: &mut ChaCha8Rng, cells: &mut Cells) {
    for _ in 0..rng.random_range(1..=4) {
        let a = rng.random_range(0..cells.vertex_count);
        let b = rng.random_range(0..cells.vertex_count);
        let c = if rng.random() {
            rng.random_range(0..cells.vertex_count)
        } else {
            cells.vertex_count
        };
        if a == b || b == c || c == a {
            continue;
        }
        cells.vertex_count = cells.vertex_count.max(c + 1);
        cells.sheets.push([a, b, c]);
        if rng.random_ratio(1, 4) {
            cells.creases.push([a, b]);
        }
    }
}

/// Core's form of a solid, without its boundary.
pub fn core_solid(cells: &Cells, scheme: Scheme) -> BoxSolid {
    BoxSolid {
        vertex_count: cells.vertex_count,
        tetrahedra: cells.tetrahedra.iter().map(|cell| cell.0).collect(),
        octahedra: cells.octahedra.iter().map(|cell| cell.0).collect(),
        surface: cells.sheets.clone(),
        creases: cells.creases.clone(),
        corners: cells.corners.clone(),
        of_tetrahedra: cells.tetrahedra.iter().map(|cell| cell.1).collect(),
        of_octahedra: cells.octahedra.iter().map(|cell| cell.1).collect(),
        is_averaged: scheme == Scheme::Averaged,
    }
}

/// Runs the cases of these seeds.
///
/// # Panics
/// At the first difference, with the seed, the level and the place.
pub fn compare(seeds: std::ops::Range<u64>) -> Compared {
    let mut compared = Compared::default();
    for seed in seeds {
        compare_case(Case::new(seed), &mut compared);
    }
    compared
}

fn compare_case(case: Case, compared: &mut Compared) {
    let seed = case.seed;
    let mut reference = case.cells;
    let mut solid = core_solid(&reference, case.scheme);
    if case.is_chosen {
        let chosen = choose(&reference);
        solid.choose().expect("a sound solid");
        let of_core: Vec<u8> = solid
            .of_tetrahedra
            .iter()
            .chain(&solid.of_octahedra)
            .copied()
            .collect();
        assert_eq!(of_core, chosen, "seed {seed}: diagonals");
        let slots = reference.tetrahedra.iter_mut().map(|cell| &mut cell.1);
        let slots = slots.chain(reference.octahedra.iter_mut().map(|cell| &mut cell.1));
        for (slot, diagonal) in slots.zip(&chosen) {
            *slot = *diagonal;
        }
        compared.diagonals += chosen.len() as u64;
    }
    let faces = solid.improper().expect("a sound solid");
    assert_eq!(faces, improper(&reference), "seed {seed}: improper faces");
    solid.find_boundary().expect("a sound solid");

    let boundary = core_boundary(case.boundary);
    let mut points = case.points;
    for level in 1..=case.levels {
        let want = refine(&reference, &points, case.scheme, case.boundary);
        let (next, got, saturated) = refine_bits(&solid, boundary, &points).expect("sound");
        let mut carried = core_solid(&want.cells, case.scheme);
        if solid.is_averaged {
            carried.of_tetrahedra.clear();
            carried.of_octahedra.clear();
        }
        carried.surface = next.surface.clone();
        assert_eq!(next, carried, "seed {seed} level {level}: connectivity");
        assert_eq!(
            saturated as usize, want.saturated,
            "seed {seed} level {level}"
        );
        assert_eq!(got.len(), want.points.len(), "seed {seed} level {level}");
        for (vertex, (got, want)) in got.iter().zip(&want.points).enumerate() {
            assert!(
                got == want,
                "seed {seed} level {level} vertex {vertex}: core {got:?}, reference {want:?}"
            );
        }
        compared.coordinates += 3 * got.len() as u64;
        (solid, reference, points) = (next, want.cells, got);
    }
    compared.cases += 1;
    compared.with_sheets += u64::from(!reference.sheets.is_empty());
}
