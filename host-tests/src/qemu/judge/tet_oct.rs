//! Solids of tetrahedra and octahedra.

use octruss_firmware::cases::{REFINE, REFINE_OWNED, SECTION_POINTS};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::{Expected, Judged, bits, word};
use crate::qemu::conformance::Section;
use crate::random_mesh::{Limits, RefineCase};
use crate::reference::{self, Boundary, Solid};

/// Small enough for core's own arenas as the image has them.
const OWNED_LIMITS: Limits = Limits {
    cells: 2,
    vertices: 192,
    levels: 2,
    sheets: true,
};

/// The case of a seed. Of every ten, eight refine in slices, one in core's own arenas, and one is
/// damaged.
pub(super) fn case(seed: u32) -> Judged {
    match seed % 10 {
        0 => damaged(seed),
        1 => refine(seed, REFINE_OWNED, &OWNED_LIMITS),
        _ => refine(seed, REFINE, &Limits::default()),
    }
}

fn damaged(seed: u32) -> Judged {
    let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
    let sound = if rng.random() {
        refine(seed, REFINE_OWNED, &OWNED_LIMITS)
    } else {
        refine(seed, REFINE, &Limits::default())
    };
    sound.damaged(&mut rng)
}

fn refine(seed: u32, kind: u32, limits: &Limits) -> Judged {
    // Boundary choices take turns by fives, and kinds of cases by tens: without the division one
    // kind would always meet the same choice.
    let random = RefineCase::new(u64::from(seed) + u64::from(seed) / 10, limits);
    let mut words = vec![boundary_word(random.boundary), random.levels];
    push_solid(&mut words, &random.solid, &random.points);
    Judged::sound(kind, seed, words, refined(&random))
}

pub(super) fn boundary_word(boundary: Boundary) -> u32 {
    match boundary {
        Boundary::Loop => 1,
        Boundary::LoopWarren => 2,
        Boundary::TriQuad => 3,
        Boundary::Interior => 4,
        Boundary::Fixed => 5,
    }
}

/// The solid as a case tells it.
pub(super) fn push_solid(words: &mut Vec<u32>, solid: &Solid, points: &[[i32; 3]]) {
    let counts = [
        solid.vertex_count,
        solid.tetrahedra.len(),
        solid.octahedra.len(),
        solid.sheets.len(),
        solid.creases.len(),
        solid.corners.len(),
    ];
    words.extend(counts.map(word));
    words.extend(solid.tetrahedra.as_flattened());
    words.extend(solid.octahedra.as_flattened());
    words.extend(solid.sheets.as_flattened());
    words.extend(solid.creases.as_flattened());
    words.extend(&solid.corners);
    words.extend(bits(points));
}

/// The sections of points that the reference gives.
fn refined(case: &RefineCase) -> Expected {
    let (mut solid, mut points) = (case.solid.clone(), case.points.clone());
    let mut expected = Expected::default();
    for level in 1..=case.levels {
        let refined = match reference::refine(&solid, &points, case.boundary) {
            Ok(refined) => refined,
            // A case that the reference refuses is no sound one, and nothing will match.
            Err(_) => return Expected::default(),
        };
        (solid, points) = (refined.solid, refined.points);
        expected.push_points(level, &points, refined.saturated);
    }
    expected
}

impl Expected {
    /// The section of a level's points; `saturated` of them did not fit.
    pub(super) fn push_points(&mut self, level: u32, points: &[[i32; 3]], saturated: usize) {
        self.saturated += saturated;
        self.coordinates += 3 * points.len();
        let mut words = vec![level, word(self.saturated)];
        words.extend(bits(points));
        self.sections.push(Section {
            tag: SECTION_POINTS,
            words,
        });
    }
}
