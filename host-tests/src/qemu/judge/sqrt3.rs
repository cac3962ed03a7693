//! What the square-root-3 scheme has beside uniform refinement.

use std::collections::BTreeMap;

use octruss_firmware::cases::{SECTION_TRIANGLE, SQRT3_ADAPTIVE, SQRT3_STEPS};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use super::surface::push_mesh;
use super::{Expected, Judged, bits};
use crate::qemu::conformance::{CaseResults, Section};
use crate::random_surface::{Shape, SurfaceCase, Wishes};
use crate::reference_surface::{Grid, after_steps, apply, beside_limit, sqrt3, sqrt3_limit};

/// Triangles that an adaptive mesh can have in the image, which one of eight cases may use, and
/// what the others do with, for time.
const TRIANGLES: [usize; 2] = [1000, 200];

type Corner = [i32; 3];

/// A case of several steps at once. One of every ten is damaged.
pub(super) fn steps(seed: u32) -> Judged {
    let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
    let valence = rng.random_range(1..=12_u32);
    let steps = rng.random_range(0..=40_u32);
    let reach: i64 = [3, 1 << 12, 1 << 26, 1 << 31][rng.random_range(0..4)];
    let mut coordinate = || i32::try_from(rng.random_range(-reach..reach)).unwrap_or(i32::MIN);
    let points: Vec<Corner> = (0..=valence)
        .map(|_| [coordinate(), coordinate(), coordinate()])
        .collect();
    let mut words = vec![steps, valence];
    words.extend(bits(&points));
    let moved = apply(
        &[
            after_steps(valence, Some(steps)),
            after_steps(valence, None),
        ],
        &points,
    );
    let again = apply(&[beside_limit(valence, steps)], &[points[0], moved[1]]);
    let mut expected = Expected::default();
    expected.push_points(0, &[moved, again].concat(), 0);
    let judged = Judged::sound(SQRT3_STEPS, seed, words, expected);
    if seed.is_multiple_of(10) {
        judged.damaged(&mut rng)
    } else {
        judged
    }
}

/// Which triangles are refined, as cases number them.
const WISHES: u32 = 4;

/// The control mesh, the levels, the wish and its threshold of a seed.
fn adaptive_case(seed: u32) -> (SurfaceCase, u32, u32, i32) {
    let wishes = Wishes {
        shape: Shape::Triangles,
        open: false,
        features: false,
        tangled: false,
    };
    let case = SurfaceCase::new(u64::from(seed), wishes);
    let faces = case.mesh.faces.len();
    let triangles = TRIANGLES[usize::from(seed % 8 != 5)];
    let most = (1..=4)
        .rev()
        .find(|&levels| faces * 3_usize.pow(levels) <= triangles);
    let levels = most.unwrap_or(1).min(1 + seed / 4 % 4);
    let wish = seed % WISHES;
    let threshold = match wish {
        // A part of the mesh's own size.
        3 => {
            let x = case.points.iter().map(|[x, ..]| i64::from(*x));
            let size = x.clone().max().unwrap_or(0) - x.min().unwrap_or(0);
            i32::try_from(size >> 5).unwrap_or(i32::MAX)
        }
        _ => case.points[0][0],
    };
    (case, levels, wish, threshold)
}

/// A case of adaptive refinement. One of every ten is damaged.
pub(super) fn adaptive(seed: u32) -> Judged {
    let (case, levels, wish, threshold) = adaptive_case(seed);
    let mut words = vec![levels, wish, threshold.cast_unsigned()];
    push_mesh(&mut words, &case.mesh, &case.points);
    let expected = Expected {
        examine: Some(examine),
        ..Expected::default()
    };
    let judged = Judged::sound(SQRT3_ADAPTIVE, seed, words, expected);
    if seed.is_multiple_of(10) {
        judged.damaged(&mut ChaCha8Rng::seed_from_u64(u64::from(seed)))
    } else {
        judged
    }
}

/// Every triangle must be one of the reference's uniform hierarchy, looked up by the bits of its
/// corners, and every limit that of the same vertex from its ring at birth; no triangle that was to be
/// refined may be left. Returns how many coordinates were compared.
fn examine(seed: u32, results: &CaseResults) -> Result<usize, String> {
    let (case, levels, wish, threshold) = adaptive_case(seed);
    let hierarchy = hierarchy(&case, levels);
    let triangles = results.sections.iter();
    let mut compared = 0;
    for (place, section) in triangles.enumerate() {
        let (generation, corners, limits) =
            triangle(section).ok_or_else(|| format!("section {place} is no triangle"))?;
        let level = hierarchy
            .get(generation as usize / 2)
            .ok_or_else(|| format!("triangle {place} has generation {generation}"))?;
        let known = match generation % 2 {
            0 => level.faces.get(&corners),
            _ => level.halves.get(&corners),
        };
        let known = known.ok_or_else(|| {
            format!(
                "triangle {place}, {corners:?}, is none of level {}",
                generation / 2
            )
        })?;
        if !known.contains(&limits) {
            return Err(format!(
                "triangle {place} has limits {limits:?}, not {known:?}"
            ));
        }
        if generation < 2 * levels && wants(wish, threshold, &corners, &limits) {
            return Err(format!(
                "triangle {place} of generation {generation} was to be refined"
            ));
        }
        compared += 18;
    }
    let most = case.mesh.faces.len() * 3_usize.pow(levels);
    let count = results.sections.len();
    match wish {
        0 if count != most => Err(format!("{count} triangles, not {most}")),
        _ if count < case.mesh.faces.len() => Err(format!("{count} triangles are too few")),
        _ => Ok(compared),
    }
}

fn wants(wish: u32, threshold: i32, corners: &[Corner; 3], limits: &[Corner; 3]) -> bool {
    let x = corners.map(|[x, ..]| x);
    match wish {
        0 => true,
        1 => x.iter().min() < Some(&threshold),
        2 => x.iter().min() <= Some(&threshold) && x.iter().max() >= Some(&threshold),
        _ => {
            let pairs = corners.as_flattened().iter().zip(limits.as_flattened());
            let distance = |(a, b): (&i32, &i32)| (i64::from(*a) - i64::from(*b)).abs();
            pairs.map(distance).max() > Some(i64::from(threshold).abs())
        }
    }
}

/// Generation, corners and limits.
fn triangle(section: &Section) -> Option<(u32, [Corner; 3], [Corner; 3])> {
    if section.tag != SECTION_TRIANGLE || section.words.len() != 25 {
        return None;
    }
    let signed: Vec<i32> = section.words[7..].iter().map(|w| w.cast_signed()).collect();
    let (points, _) = signed.as_chunks::<3>();
    let corner = |place: usize| points.get(place).copied();
    let three = |first: usize| Some([corner(first)?, corner(first + 1)?, corner(first + 2)?]);
    Some((section.words[0], three(0)?, three(3)?))
}

/// A level's triangles by the bits of their corners, each turn of them, with the limits of these.
#[derive(Default)]
struct Level {
    faces: BTreeMap<[Corner; 3], Vec<[Corner; 3]>>,
    /// What the next level puts into them: the new vertex and a side.
    halves: BTreeMap<[Corner; 3], Vec<[Corner; 3]>>,
}

fn hierarchy(case: &SurfaceCase, levels: u32) -> Vec<Level> {
    let (mut mesh, mut points) = (case.mesh.clone(), case.points.clone());
    let mut limits: Vec<Corner> = Vec::new();
    let mut hierarchy = Vec::new();
    for _ in 0..=levels {
        let at_birth = apply(&sqrt3_limit(&mesh, Grid::Device), &points);
        limits.extend(&at_birth[limits.len()..]);
        let next = sqrt3(&mesh, Grid::Device);
        let next_points = next.points(&points);
        let next_limits = apply(&sqrt3_limit(&next.mesh, Grid::Device), &next_points);
        let first = mesh.vertex_count as usize;
        let mut level = Level::default();
        for (rank, face) in mesh.sorted_faces().into_iter().enumerate() {
            let vertex = |i: usize| mesh.faces[face][i % 3] as usize;
            let centre = first + rank;
            for i in 0..3 {
                let [a, b, c] = [vertex(i), vertex(i + 1), vertex(i + 2)];
                let own = level.faces.entry([points[a], points[b], points[c]]);
                own.or_default().push([limits[a], limits[b], limits[c]]);
                let half = level
                    .halves
                    .entry([next_points[centre], points[a], points[b]]);
                half.or_default()
                    .push([next_limits[centre], limits[a], limits[b]]);
            }
        }
        hierarchy.push(level);
        (mesh, points) = (next.mesh, next_points);
    }
    hierarchy
}
