//! Random cages and poses whose health is told, from a seed.

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

use crate::random_mixed::MixedCase;
use crate::reference_mixed::Mesh;

/// A cage, its rest and a pose.
#[derive(Clone, Debug)]
pub struct HealthCase {
    /// The cells.
    pub mesh: Mesh,
    /// Control points at rest.
    pub rest: Vec<[i32; 3]>,
    /// The pose.
    pub pose: Vec<[i32; 3]>,
}

impl HealthCase {
    /// The case of a seed, with at most so many cells: a sound cage, or points anywhere; the pose is near, far, flat, or the
    /// rest itself.
    pub fn new(seed: u64, cells: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x4ea1);
        let MixedCase { mesh, points, .. } = MixedCase::new(seed, cells);
        let mut rest = points;
        if seed.is_multiple_of(4) {
            rest.iter_mut().for_each(|point| *point = rng.random());
        }
        let bits = rng.random_range(0..=32);
        let reach = (1_i64 << bits) - 1;
        let style = rng.random_range(0..8);
        let moved = |rng: &mut ChaCha8Rng, own: i32| {
            let moved = i64::from(own) + rng.random_range(-reach..=reach);
            moved.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
        };
        let pose = rest.iter().map(|point| match style {
            0 => *point,
            1 => [point[0], point[1], 0],
            2 => [0; 3].map(|_: i32| if rng.random() { i32::MIN } else { i32::MAX }),
            _ => point.map(|own| moved(&mut rng, own)),
        });
        let pose = pose.collect();
        Self { mesh, rest, pose }
    }

    /// The cells as they lie in a bundle, in words: the layout of `octruss::control::health::CellsRecord`.
    pub fn section(&self) -> Vec<u32> {
        let Mesh {
            tetrahedra,
            octahedra,
            prisms,
            hexahedra,
            ..
        } = &self.mesh;
        let counts = [
            tetrahedra.len(),
            octahedra.len(),
            prisms.len(),
            hexahedra.len(),
        ];
        let mut words: Vec<u32> = counts.iter().map(|count| *count as u32).collect();
        words.extend(tetrahedra.as_flattened());
        words.extend(octahedra.as_flattened());
        words.extend(prisms.as_flattened());
        words.extend(hexahedra.as_flattened());
        words
    }
}
