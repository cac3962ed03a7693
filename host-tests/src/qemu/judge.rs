//! Holds core on a device, core on the host and the reference against one another, bit for bit.
//!
//! Random cases from seeds: refinement in slices and in core's own arenas, the apply of random
//! tables in both forms, and damaged cases whose errors must be the same everywhere. A case's
//! number is its seed, so any case can be run again alone.

use std::fmt;
use std::path::Path;
use std::time::Duration;

use octruss_bake::pack::Layout;
use octruss_firmware::cases::{APPLY, REFINE, REFINE_OWNED, SECTION_POINTS, SECTION_ROWS, Status};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::conformance::{Case, CaseResults, on_device, on_host};
use super::{Error, Machine};
use crate::random_bundle::{BundleCase, layout};
use crate::random_mesh::{Limits, RefineCase};
use crate::random_table::ApplyCase;
use crate::reference::{self, Boundary, Table};

/// One random case with what the reference expects of it.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The case.
    pub case: Case,
    /// The sections that hold coordinates, each a tag and words as in the results, if the case is
    /// sound; the sections about cells are left to the comparison with core on the host.
    pub expected: Option<Vec<(u32, Vec<u32>)>>,
}

impl Judged {
    /// The case of a seed. Of every ten, six refine in slices, one refines in core's own arenas,
    /// two apply a table, and one is damaged.
    #[must_use]
    pub fn new(seed: u32) -> Self {
        match seed % 10 {
            0 => Self::damaged(seed),
            1 | 2 => Self::apply(seed),
            3 => Self::refine(seed, REFINE_OWNED, &OWNED_LIMITS),
            _ => Self::refine(seed, REFINE, &Limits::default()),
        }
    }

    fn refine(seed: u32, kind: u32, limits: &Limits) -> Self {
        // Boundary choices take turns by fives, and kinds of cases by tens: without the division
        // one kind would always meet the same choice.
        let random = RefineCase::new(u64::from(seed) + u64::from(seed) / 10, limits);
        Judged {
            case: Case {
                kind,
                number: seed,
                words: refine_words(&random),
            },
            expected: Some(refined(&random)),
        }
    }

    fn apply(seed: u32) -> Self {
        const ROWS: usize = 16;
        const POINTS: u16 = 48;
        let layout = layout(u64::from(seed / 10));
        let bundle = BundleCase::new(u64::from(seed), ROWS, POINTS, layout);
        let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
        let start = rng.random_range(0..=bundle.order.len());
        let end = rng.random_range(start..=bundle.order.len());
        let form = match layout {
            Layout::Compact { .. } => COMPACT,
            _ if rng.random() => ABSOLUTE,
            _ => DISPLACEMENT,
        };
        let pose = &bundle.case.pose;
        let numbers = [start, end, end - start, pose.len(), bundle.bytes.len()];
        let mut words = vec![form];
        words.extend(numbers.map(word));
        words.extend(bundle.bytes.chunks(4).map(|chunk| {
            let mut bytes = [0; 4];
            bytes[..chunk.len()].copy_from_slice(chunk);
            u32::from_le_bytes(bytes)
        }));
        words.extend(bits(pose));
        // These rows alone, for only they may count what saturates.
        let part = rows_of(&bundle, start, end);
        let (applied, clamped) = match form {
            ABSOLUTE => (part.absolute(), 0),
            _ => part.displaced(),
        };
        let mut rows = vec![word(applied.saturated), clamped];
        rows.extend(bits(&applied.points));
        Judged {
            case: Case {
                kind: APPLY,
                number: seed,
                words,
            },
            expected: Some(vec![(SECTION_ROWS, rows)]),
        }
    }

    /// A sound case with one word changed. What comes of it is for core on the host to say.
    fn damaged(seed: u32) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
        let mut case = match rng.random_range(0..3) {
            0 => Self::apply(seed),
            1 => Self::refine(seed, REFINE_OWNED, &OWNED_LIMITS),
            _ => Self::refine(seed, REFINE, &Limits::default()),
        }
        .case;
        // The first words hold the lengths and the first cells, where damage tells most.
        let place = rng.random_range(0..case.words.len().min(64));
        case.words[place] = match rng.random_range(0..3) {
            0 => rng.random_range(0..16),
            1 => case.words[place] ^ (1 << rng.random_range(0..32)),
            _ => rng.random(),
        };
        Judged {
            case,
            expected: None,
        }
    }
}

/// Forms of the apply as the case says them.
const DISPLACEMENT: u32 = 0;
const ABSOLUTE: u32 = 1;
const COMPACT: u32 = 2;

/// Small enough for core's own arenas as the image has them.
const OWNED_LIMITS: Limits = Limits {
    cells: 2,
    vertices: 192,
    levels: 2,
    sheets: true,
};

fn word(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

fn bits(points: &[[i32; 3]]) -> impl Iterator<Item = u32> {
    points
        .as_flattened()
        .iter()
        .map(|bits| bits.cast_unsigned())
}

fn refine_words(case: &RefineCase) -> Vec<u32> {
    let boundary = match case.boundary {
        Boundary::Loop => 1,
        Boundary::LoopWarren => 2,
        Boundary::TriQuad => 3,
        Boundary::Interior => 4,
        Boundary::Fixed => 5,
    };
    let solid = &case.solid;
    let mut words = vec![boundary, case.levels];
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
    words.extend(bits(&case.points));
    words
}

/// The sections of points that the reference gives.
fn refined(case: &RefineCase) -> Vec<(u32, Vec<u32>)> {
    let (mut solid, mut points) = (case.solid.clone(), case.points.clone());
    let mut saturated = 0;
    let mut sections = Vec::new();
    for level in 1..=case.levels {
        let refined = match reference::refine(&solid, &points, case.boundary) {
            Ok(refined) => refined,
            // A case that the reference refuses is no sound one, and nothing will match.
            Err(_) => return Vec::new(),
        };
        saturated += refined.saturated;
        (solid, points) = (refined.solid, refined.points);
        let mut words = vec![level, word(saturated)];
        words.extend(bits(&points));
        sections.push((SECTION_POINTS, words));
    }
    sections
}

/// A range of a bundle's rows as a case of its own, in the bundle's order.
fn rows_of(bundle: &BundleCase, start: usize, end: usize) -> BundleCase {
    let whole = &bundle.case;
    let mut table = Table {
        offsets: vec![0],
        ..Table::default()
    };
    let rows = &bundle.order[start..end];
    for &row in rows {
        for (point, weight) in whole.table.row(row) {
            table.indices.push(point);
            table.weights.push(weight);
        }
        table.offsets.push(word(table.indices.len()));
    }
    BundleCase {
        layout: bundle.layout,
        case: ApplyCase {
            seed: whole.seed,
            table,
            pose: whole.pose.clone(),
            rest_pose: whole.rest_pose.clone(),
            rest: rows.iter().map(|&row| whole.rest[row]).collect(),
        },
        bytes: Vec::new(),
        order: (0..rows.len()).collect(),
    }
}

/// What a comparison has counted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// Cases held against the reference.
    pub sound: usize,
    /// Damaged cases, held against core on the host.
    pub damaged: usize,
    /// Coordinates held against the reference.
    pub coordinates: usize,
    /// Coordinates that saturated, and had to.
    pub saturated: usize,
    /// What did not match, a sentence each.
    pub mismatches: Vec<String>,
}

impl Verdict {
    /// Holds results against the reference and, where given, against those of core on the host.
    #[must_use]
    pub fn of(cases: &[Judged], results: &[CaseResults], host: Option<&[CaseResults]>) -> Self {
        let mut verdict = Verdict::default();
        if results.len() != cases.len() {
            let (got, want) = (results.len(), cases.len());
            verdict
                .mismatches
                .push(format!("{got} results for {want} cases"));
        }
        for (place, (judged, result)) in cases.iter().zip(results).enumerate() {
            let seed = judged.case.number;
            match &judged.expected {
                Some(expected) => verdict.against_reference(seed, expected, result),
                None => verdict.damaged += 1,
            }
            let same = host.and_then(|host| host.get(place));
            if let Some(difference) = same.and_then(|same| result.first_difference(same)) {
                let sentence = format!("seed {seed}, against core on the host: {difference}");
                verdict.mismatches.push(sentence);
            }
        }
        verdict
    }

    fn against_reference(&mut self, seed: u32, expected: &[(u32, Vec<u32>)], result: &CaseResults) {
        self.sound += 1;
        if result.status != Status::Done.words() {
            let sentence = format!("seed {seed}: status {:?}", result.status);
            self.mismatches.push(sentence);
            return;
        }
        let is_compared = |tag| tag == SECTION_POINTS || tag == SECTION_ROWS;
        let sections = result
            .sections
            .iter()
            .filter(|section| is_compared(section.tag));
        let wanted = CaseResults {
            number: seed,
            sections: expected
                .iter()
                .map(|(tag, words)| super::conformance::Section {
                    tag: *tag,
                    words: words.clone(),
                })
                .collect(),
            status: result.status,
        };
        let got = CaseResults {
            number: result.number,
            sections: sections.cloned().collect(),
            status: result.status,
        };
        if let Some(difference) = got.first_difference(&wanted) {
            let sentence = format!("seed {seed}, against the reference: {difference}");
            self.mismatches.push(sentence);
        }
        for (_, words) in expected {
            // Two words come before the coordinates in either section.
            self.coordinates += words.len().saturating_sub(2);
        }
        // The count runs on from level to level; the last is that of the case.
        if let Some((tag, words)) = expected.last() {
            let place = if *tag == SECTION_POINTS { 1 } else { 0 };
            self.saturated += words[place] as usize;
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} cases and {} coordinates against the reference ({} saturated), {} damaged cases \
             against the host, {} mismatches",
            self.sound,
            self.coordinates,
            self.saturated,
            self.damaged,
            self.mismatches.len()
        )?;
        let shown = self.mismatches.iter().take(10);
        shown
            .clone()
            .try_for_each(|sentence| write!(f, "\n    {sentence}"))
    }
}

/// What was found of the same cases on the host and on every machine.
pub struct Found {
    /// Core on the host.
    pub host: Verdict,
    /// Core on the machines.
    pub machines: Vec<(Machine, Verdict)>,
}

impl Found {
    /// Whether nothing was unequal.
    #[must_use]
    pub fn is_equal(&self) -> bool {
        let machines = self.machines.iter().map(|(_, verdict)| verdict);
        std::iter::once(&self.host)
            .chain(machines)
            .all(|verdict| verdict.mismatches.is_empty())
    }
}

/// Runs the cases of `count` seeds from `first` on the host and on the machines. `directory` is
/// for the files.
///
/// # Errors
///
/// Those of the runner; unequal results are no error but part of what is found.
pub fn judge(
    machines: &[Machine],
    image: &Path,
    directory: &Path,
    first: u32,
    count: u32,
) -> Result<Found, Error> {
    let cases: Vec<Judged> = (0..count)
        .map(|place| Judged::new(first.wrapping_add(place)))
        .collect();
    let sent: Vec<Case> = cases.iter().map(|judged| judged.case.clone()).collect();
    let host = on_host(&sent);
    // Some thousand cases a second; a machine that is busy with other things gets its time.
    let limit = Duration::from_secs(60) + Duration::from_millis(20) * count;
    let mut found = Found {
        host: Verdict::of(&cases, &host, None),
        machines: Vec::new(),
    };
    for &machine in machines {
        let directory = directory.join(machine.name());
        let (results, _) = on_device(machine, image, &directory, &sent, limit)?;
        let verdict = Verdict::of(&cases, &results, Some(&host));
        found.machines.push((machine, verdict));
    }
    Ok(found)
}
