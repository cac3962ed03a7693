//! What a solid carries beside its shape, core against the reference, bit for bit: scalar channels
//! refined by the masks, labels handed on to children, crease surfaces between materials.

use std::collections::BTreeSet;

use octruss::solid::{CellLabels, LabelBuffers, split_labels};
use octruss_host_tests::compare::compare;
use octruss_host_tests::random_data::{DataCase, interfaces};
use octruss_host_tests::random_mesh::Limits;
use octruss_host_tests::reference::{self, Solid, refine, split};
use octruss_host_tests::subject::{CoreSolid, refine_bits};

/// How many random cases; `cargo xtask verify` asks for more.
fn cases() -> u64 {
    std::env::var("OCTRUSS_CASES").map_or(300, |count| count.parse().expect("a number"))
}

/// Refines `D` channels along a case's levels with core and with the reference.
fn channels_are_equal<const D: usize>(seed: u64) -> Result<usize, String> {
    let case = DataCase::<D>::new(seed, &Limits::default());
    let mut core = CoreSolid::new(&case.solid).map_err(|error| error.to_string())?;
    let (mut solid, mut channels) = (case.solid, case.channels);
    let mut compared = 0;
    for level in 1..=case.levels {
        let want = refine(&solid, &channels, case.boundary).map_err(|error| error.to_string())?;
        let (next, got, saturated) =
            refine_bits(&core, case.boundary, &channels).map_err(|error| error.to_string())?;
        compare(&format!("channels at level {level}"), &got, &want.points)?;
        compare("crease surface", &next.solid.sheets, &want.solid.sheets)?;
        compare("saturated", &[saturated], &[want.saturated])?;
        compared += D * got.len();
        (core, solid, channels) = (next, want.solid, want.points);
    }
    Ok(compared)
}

/// Channels of four numbers, and alone, over solids with crease surfaces inside.
#[test]
fn channels_follow_the_masks() {
    let mut compared = 0;
    for seed in 0..cases() {
        let one = channels_are_equal::<1>(seed);
        let four = channels_are_equal::<4>(seed);
        let both = one.and_then(|one| Ok(one + four?));
        compared += both.unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
    }
    println!("{} solids, {compared} values, 0 mismatches", cases());
}

/// The labels of the next level by core, between guard labels.
fn labels_by_core(solid: &Solid, labels: &[u32]) -> Vec<u32> {
    const GUARD: u32 = 0xdead_beef;
    let (tetrahedra, octahedra) = labels.split_at(solid.tetrahedra.len());
    let labels = CellLabels {
        tetrahedra,
        octahedra,
        ..CellLabels::default()
    };
    let refined = split(solid).solid;
    let mut of_tetrahedra = vec![GUARD; refined.tetrahedra.len() + 1];
    let mut of_octahedra = vec![GUARD; refined.octahedra.len() + 1];
    let buffers = LabelBuffers {
        tetrahedra: &mut of_tetrahedra,
        octahedra: &mut of_octahedra,
        ..LabelBuffers::default()
    };
    let filled = split_labels(&labels, buffers).expect("enough memory");
    let filled = [filled.tetrahedra, filled.octahedra].concat();
    assert_eq!(
        (of_tetrahedra.pop(), of_octahedra.pop()),
        (Some(GUARD), Some(GUARD))
    );
    filled
}

fn sorted(faces: &[[u32; 3]]) -> BTreeSet<[u32; 3]> {
    let sorted = |face: &[u32; 3]| {
        let mut face = *face;
        face.sort_unstable();
        face
    };
    faces.iter().map(sorted).collect()
}

/// Children have the label of the cell that they lie in, and at every level the crease surface is
/// where materials meet.
#[test]
fn labels_are_inherited_and_crease_surfaces_stay_between_materials() {
    let (mut labels_compared, mut faces_compared) = (0, 0);
    for seed in 0..cases() {
        let case = DataCase::<1>::new(seed, &Limits::default());
        let (mut solid, mut labels) = (case.solid, case.labels);
        for level in 1..=case.levels {
            let linear = split(&solid);
            let want = reference::split_labels(&solid, &linear, &labels);
            let got = labels_by_core(&solid, &labels);
            compare(&format!("labels at level {level}"), &got, &want)
                .unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
            (solid, labels) = (linear.solid, got);
            let between = interfaces(&solid, &labels);
            assert_eq!(
                sorted(&solid.sheets),
                sorted(&between),
                "seed {seed}, level {level}"
            );
            labels_compared += labels.len();
            faces_compared += between.len();
        }
    }
    println!(
        "{} solids, {labels_compared} labels and {faces_compared} triangles of crease surfaces, \
         0 mismatches",
        cases()
    );
}
