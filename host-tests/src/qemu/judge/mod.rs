//! Holds core on a device, core on the host and the reference against one another, bit for bit.
//!
//! Random cases from seeds, in groups ([`Subject`]), one file each; one case in ten is damaged, and
//! its errors must be the same everywhere. A case's number is its seed, so any case can be run again
//! alone.

mod apply;
mod box_spline;
mod data;
mod health;
mod inverse;
mod mixed;
mod project;
mod rig;
mod scalars;
pub mod springs;
mod sqrt3;
mod surface;
mod tet_oct;
mod update;
mod volume;

use std::fmt;
use std::path::Path;
use std::thread;
use std::time::Duration;

use clap::ValueEnum;
use octruss_firmware::cases::{SECTION_CELLS, Status};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;

use super::conformance::{Case, CaseResults, Section, on_device, on_host};
use super::{Error, Machine};
use surface::Scheme;

/// What a group of random cases is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Subject {
    /// Solids of tetrahedra and octahedra, refined in slices and in core's own arenas
    TetOct,
    /// Scalar channels, labels of cells and crease surfaces between materials
    Data,
    /// Tables, applied in every format and form
    Apply,
    /// Box-spline solids and their averaged variant, major diagonals chosen and given
    BoxSpline,
    /// Loop's surfaces
    Loop,
    /// Loop's surfaces with Warren's weights
    LoopWarren,
    /// Loop's surfaces with the triangles' weights of the triangle/quadrilateral scheme
    TriQuad,
    /// Catmull and Clark's surfaces
    CatmullClark,
    /// Doo and Sabin's surfaces
    DooSabin,
    /// Square-root-3 surfaces
    Sqrt3,
    /// Butterfly surfaces
    Butterfly,
    /// Modified butterfly surfaces
    ButterflyModified,
    /// Square-root-3 surfaces refined where a predicate wants it
    Sqrt3Adaptive,
    /// Several square-root-3 steps at once
    Sqrt3Steps,
    /// Normals of Loop's, Catmull-Clark and Doo-Sabin surfaces in the limit
    LimitNormals,
    /// Mixed solids of tetrahedra, octahedra, prisms and hexahedra
    Mixed,
    /// Volume forms and their gradients
    Volume,
    /// Volumes as polynomials in modes, and their derivatives
    VolumeModes,
    /// Centroids by modes
    CentroidModes,
    /// Tables updated in part, factored tables, normals of their points
    Update,
    /// Scalar channels through tables of every format
    Scalars,
    /// Surfaces of triangles and quads by the triangle/quadrilateral scheme
    TriQuadSurface,
    /// Skeletons and the control points that they carry
    Rig,
    /// Sines and cosines
    Turn,
    /// Control points on springs, pushed and among obstacles
    Springs,
    /// Control points on springs, shaken at random
    Shakes,
    /// Amplitudes for goals while a volume is held
    Inverse,
    /// Amplitudes for measured points, without a volume
    Sensors,
    /// Cells that poses fold over
    Health,
    /// The nearest poses under pins, boxes, rates and volumes
    Project,
}

impl Subject {
    /// The case of a seed.
    #[must_use]
    pub fn case(self, seed: u32) -> Judged {
        match self {
            Subject::TetOct => tet_oct::case(seed),
            Subject::Data => data::case(seed),
            Subject::Apply => apply::case(seed),
            Subject::BoxSpline => box_spline::case(seed),
            Subject::Loop => surface::case(Scheme::Loop, seed),
            Subject::LoopWarren => surface::case(Scheme::LoopWarren, seed),
            Subject::TriQuad => surface::case(Scheme::TriQuad, seed),
            Subject::CatmullClark => surface::case(Scheme::CatmullClark, seed),
            Subject::DooSabin => surface::case(Scheme::DooSabin, seed),
            Subject::Sqrt3 => surface::case(Scheme::Sqrt3, seed),
            Subject::Butterfly => surface::case(Scheme::Butterfly, seed),
            Subject::ButterflyModified => surface::case(Scheme::ButterflyModified, seed),
            Subject::Sqrt3Adaptive => sqrt3::adaptive(seed),
            Subject::Sqrt3Steps => sqrt3::steps(seed),
            Subject::LimitNormals => surface::normals(seed),
            Subject::Mixed => mixed::case(seed),
            Subject::Volume => volume::form(seed),
            Subject::VolumeModes => volume::polynomial(seed),
            Subject::CentroidModes => volume::centroid(seed),
            Subject::Update => update::case(seed),
            Subject::Scalars => scalars::case(seed),
            Subject::TriQuadSurface => surface::case(Scheme::TriQuadSurface, seed),
            Subject::Rig => rig::case(seed),
            Subject::Turn => rig::turn(seed),
            Subject::Springs => springs::case(seed),
            Subject::Shakes => springs::shakes(seed),
            Subject::Inverse => inverse::case(seed, true),
            Subject::Sensors => inverse::case(seed, false),
            Subject::Health => health::case(seed),
            Subject::Project => project::case(seed),
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.to_possible_value();
        f.write_str(value.as_ref().map_or("", |value| value.get_name()))
    }
}

/// One random case with what the reference expects of it.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The case.
    pub case: Case,
    /// What must come of it; nothing is known of a damaged case but that all machines agree.
    pub expected: Option<Expected>,
}

/// What the reference expects of a case.
#[derive(Clone, Debug, Default)]
pub struct Expected {
    /// The sections, but those about cells of solids: these are left to the comparison with core on
    /// the host, whose connectivity the host's tests hold against the reference.
    pub sections: Vec<Section>,
    /// How many numbers of theirs are results of arithmetic.
    pub coordinates: usize,
    /// How many of these do not fit and must be clamped.
    pub saturated: usize,
    /// Where the reference does not say what the sections must be but what must hold of them: a
    /// function of the seed and the results, which returns how many numbers it compared.
    pub examine: Option<Examine>,
}

/// Says what does not hold of the results of a seed's case, or how many numbers were compared.
pub type Examine = fn(u32, &CaseResults) -> Result<usize, String>;

impl Judged {
    fn sound(kind: u32, seed: u32, words: Vec<u32>, expected: Expected) -> Self {
        Judged {
            case: Case {
                kind,
                number: seed,
                words,
            },
            expected: Some(expected),
        }
    }

    /// The same with one word changed. What comes of it is for core on the host to say.
    fn damaged(mut self, rng: &mut ChaCha8Rng) -> Self {
        let words = &mut self.case.words;
        // The first words hold the lengths and the first cells, where damage tells most.
        let place = rng.random_range(0..words.len().min(64));
        words[place] = match rng.random_range(0..3) {
            0 => rng.random_range(0..16),
            1 => words[place] ^ (1 << rng.random_range(0..32)),
            _ => rng.random(),
        };
        self.expected = None;
        self
    }
}

fn word(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

fn bits<const D: usize>(points: &[[i32; D]]) -> impl Iterator<Item = u32> {
    points
        .as_flattened()
        .iter()
        .map(|bits| bits.cast_unsigned())
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

    fn against_reference(&mut self, seed: u32, expected: &Expected, result: &CaseResults) {
        self.sound += 1;
        if result.status != Status::Done.words() {
            let sentence = format!("seed {seed}: status {:?}", result.status);
            self.mismatches.push(sentence);
            return;
        }
        if let Some(examine) = expected.examine {
            match examine(seed, result) {
                Ok(compared) => self.coordinates += compared,
                Err(fault) => {
                    let sentence = format!("seed {seed}, against the reference: {fault}");
                    self.mismatches.push(sentence);
                }
            }
            return;
        }
        let sections = result.sections.iter();
        let compared = sections.filter(|section| section.tag != SECTION_CELLS);
        let want = CaseResults {
            number: seed,
            sections: expected.sections.clone(),
            status: result.status,
        };
        let got = CaseResults {
            number: result.number,
            sections: compared.cloned().collect(),
            status: result.status,
        };
        if let Some(difference) = got.first_difference(&want) {
            let sentence = format!("seed {seed}, against the reference: {difference}");
            self.mismatches.push(sentence);
        }
        self.coordinates += expected.coordinates;
        self.saturated += expected.saturated;
    }

    fn add(&mut self, other: Verdict) {
        self.sound += other.sound;
        self.damaged += other.damaged;
        self.coordinates += other.coordinates;
        self.saturated += other.saturated;
        self.mismatches.extend(other.mismatches);
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
#[derive(Default)]
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

/// Cases that are made, run and compared at a time: a bound of the memory that this takes.
const BATCH: u32 = 1_000;

/// Runs the cases of `count` seeds from `first` on the host and on the machines, each with its image
/// `conformance`. `directory` is for the files.
///
/// # Errors
///
/// Those of the runner; unequal results are no error but part of what is found.
pub fn judge(
    subject: Subject,
    machines: &[Machine],
    directory: &Path,
    first: u32,
    count: u32,
) -> Result<Found, Error> {
    let mut found = Found::default();
    for start in (0..count).step_by(BATCH as usize) {
        let seeds = start..count.min(start.saturating_add(BATCH));
        let cases: Vec<Judged> = seeds
            .map(|place| subject.case(first.wrapping_add(place)))
            .collect();
        let batch = judge_batch(&cases, machines, directory)?;
        found.host.add(batch.host);
        if found.machines.is_empty() {
            found.machines = batch.machines;
        } else {
            let sums = found.machines.iter_mut().zip(batch.machines);
            sums.for_each(|((_, sum), (_, verdict))| sum.add(verdict));
        }
    }
    Ok(found)
}

/// Runs cases on the host and, at the same time on each, on the machines.
fn judge_batch(cases: &[Judged], machines: &[Machine], directory: &Path) -> Result<Found, Error> {
    let sent: Vec<Case> = cases.iter().map(|judged| judged.case.clone()).collect();
    // Some thousand cases a second; a machine that is busy with other things gets its time.
    let limit = Duration::from_secs(60) + Duration::from_millis(50) * word(sent.len());
    thread::scope(|scope| {
        let sent = &sent;
        let runs: Vec<_> = machines
            .iter()
            .map(|&machine| {
                let directory = directory.join(machine.name());
                let image = machine.image("conformance");
                scope.spawn(move || on_device(machine, &image, &directory, sent, limit))
            })
            .collect();
        let host = on_host(sent);
        let mut found = Found {
            host: Verdict::of(cases, &host, None),
            machines: Vec::new(),
        };
        for (&machine, run) in machines.iter().zip(runs) {
            let joined = run.join();
            let (results, _) = joined.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
            let verdict = Verdict::of(cases, &results, Some(&host));
            found.machines.push((machine, verdict));
        }
        Ok(found)
    })
}
