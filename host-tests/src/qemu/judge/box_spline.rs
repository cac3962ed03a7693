//! Box-spline solids.

use octruss_firmware::cases::{
    BOX_SPLINE, BOX_SPLINE_OWNED, SECTION_DIAGONALS, SECTION_IMPROPER_FACES, summary,
};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::tet_oct::{boundary_word, push_solid};
use super::{Expected, Judged};
use crate::box_spline_cases::Case;
use crate::qemu::conformance::Section;
use crate::random_mesh::Limits;
use crate::reference::Solid;
use crate::reference_box_spline::{Cells, Scheme, choose, improper, refine};

/// Small enough for the image's memory, which neighbours take much of.
const LIMITS: Limits = Limits {
    cells: 6,
    vertices: 600,
    levels: 3,
    sheets: true,
};

/// Small enough for core's own arenas as the image has them.
const OWNED_LIMITS: Limits = Limits {
    cells: 2,
    vertices: 120,
    levels: 2,
    sheets: true,
};

/// The case of a seed. Of every ten, eight refine in slices, one in core's own arenas, and one is
/// damaged.
pub(super) fn case(seed: u32) -> Judged {
    match seed % 10 {
        0 => damaged(seed),
        1 => box_spline(seed, BOX_SPLINE_OWNED, &OWNED_LIMITS),
        _ => box_spline(seed, BOX_SPLINE, &LIMITS),
    }
}

fn damaged(seed: u32) -> Judged {
    let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
    let sound = if rng.random() {
        box_spline(seed, BOX_SPLINE_OWNED, &OWNED_LIMITS)
    } else {
        box_spline(seed, BOX_SPLINE, &LIMITS)
    };
    sound.damaged(&mut rng)
}

fn box_spline(seed: u32, kind: u32, limits: &Limits) -> Judged {
    // Boundary choices take turns by fives, and kinds of cases by tens: without the division one
    // kind would always meet the same choice.
    let mut case = Case::within(u64::from(seed) + u64::from(seed) / 10, limits);
    let (source, given) = match case.scheme {
        Scheme::Averaged => (2, Vec::new()),
        Scheme::MajorDiagonals if case.is_chosen => (0, Vec::new()),
        Scheme::MajorDiagonals => (1, diagonals(&case.cells).concat()),
    };
    let mut words = vec![source, boundary_word(case.boundary), case.levels];
    push_solid(&mut words, &solid(&case.cells), &case.points);
    words.extend(given.into_iter().map(u32::from));
    if case.is_chosen {
        let chosen = choose(&case.cells);
        let tetrahedra = case.cells.tetrahedra.iter_mut().map(|cell| &mut cell.1);
        let slots = tetrahedra.chain(case.cells.octahedra.iter_mut().map(|cell| &mut cell.1));
        slots
            .zip(chosen)
            .for_each(|(slot, diagonal)| *slot = diagonal);
    }
    let is_owned = kind == BOX_SPLINE_OWNED;
    Judged::sound(kind, seed, words, refined(case, is_owned))
}

/// The major diagonals of tetrahedra and octahedra.
fn diagonals(cells: &Cells) -> [Vec<u8>; 2] {
    let tetrahedra = cells.tetrahedra.iter().map(|cell| cell.1).collect();
    [
        tetrahedra,
        cells.octahedra.iter().map(|cell| cell.1).collect(),
    ]
}

/// The cells without their diagonals.
fn solid(cells: &Cells) -> Solid {
    Solid {
        vertex_count: cells.vertex_count as usize,
        tetrahedra: cells.tetrahedra.iter().map(|cell| cell.0).collect(),
        octahedra: cells.octahedra.iter().map(|cell| cell.0).collect(),
        sheets: cells.sheets.clone(),
        creases: cells.creases.clone(),
        corners: cells.corners.clone(),
    }
}

/// What the reference gives. Core's own arenas leave the last level's diagonals out.
fn refined(case: Case, is_owned: bool) -> Expected {
    let mut expected = Expected::default();
    let has_diagonals = case.scheme == Scheme::MajorDiagonals;
    let (mut cells, mut points) = (case.cells, case.points);
    if has_diagonals {
        expected.sections.push(Section {
            tag: SECTION_IMPROPER_FACES,
            words: improper(&cells).concat(),
        });
        expected.push_diagonals(0, &cells);
    }
    for level in 1..=case.levels {
        let refined = refine(&cells, &points, case.scheme, case.boundary);
        (cells, points) = (refined.cells, refined.points);
        if has_diagonals && !(is_owned && level == case.levels) {
            expected.push_diagonals(level, &cells);
        }
        expected.push_points(level, &points, refined.saturated);
    }
    expected
}

impl Expected {
    fn push_diagonals(&mut self, level: u32, cells: &Cells) {
        let lists = diagonals(cells).map(|list| summary(&list));
        let mut words = vec![level];
        words.extend(lists.as_flattened());
        self.sections.push(Section {
            tag: SECTION_DIAGONALS,
            words,
        });
    }
}
