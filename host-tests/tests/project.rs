//! The crate's projection of poses against the independent reference, bit for bit, on random problems up to the
//! ends of all ranges.
//!
//! `OCTRUSS_CASES` sets how many cases; the default keeps the suite quick.

use octruss::control::project::{
    GaveUp, Limits, MOST_REGIONS, ProjectError, ProjectReport, ProjectScratch, RegionGoal,
    ScratchLengths,
};
use octruss::enclosed::VolumeForm;
use octruss_host_tests::random_project::ProjectCase;
use octruss_host_tests::reference_project::{LimitsTable, Projected, RegionTable, project};
use octruss_host_tests::reference_volume::VolumeTable;
use octruss_host_tests::sections;

/// What guards a buffer's end.
const GUARD: i32 = 0x5afe_5afe;

fn case_count() -> u64 {
    let wanted = std::env::var("OCTRUSS_CASES").ok();
    wanted.and_then(|count| count.parse().ok()).unwrap_or(150)
}

/// Bytes at an address that is a multiple of four, as in a bundle.
fn aligned(bytes: &[u8]) -> Vec<u32> {
    let padded = bytes.chunks(4).map(|chunk| {
        let mut word = [0; 4];
        word[..chunk.len()].copy_from_slice(chunk);
        u32::from_le_bytes(word)
    });
    padded.collect()
}

/// Runs the crate with guard words behind what is written.
fn run(case: &ProjectCase) -> Result<(Vec<[i32; 3]>, ProjectReport), ProjectError> {
    use zerocopy::IntoBytes as _;
    let points = case.goal.len();
    let sections: Vec<(Vec<u32>, usize)> = case
        .regions
        .iter()
        .map(|region| sections::volume_form(&region.form))
        .chain([sections::limits(&case.limits)])
        .map(|bytes| (aligned(&bytes), bytes.len()))
        .collect();
    let bytes = |place: usize| &sections[place].0.as_bytes()[..sections[place].1];
    let forms: Vec<VolumeForm<'_>> = (0..case.regions.len())
        .map(|place| VolumeForm::from_section(bytes(place), points).expect("a sound form"))
        .collect();
    let regions = case.regions.iter().zip(&forms);
    let regions: Vec<RegionGoal<'_>> = regions
        .map(|(region, form)| RegionGoal {
            form,
            least: region.least,
            greatest: region.greatest,
        })
        .collect();
    let limits = Limits::from_section(bytes(forms.len()), points)?;
    let lengths = ScratchLengths::of(&regions);
    let mut narrow = [
        points,
        points,
        points,
        points,
        lengths.gradients,
        lengths.form,
    ]
    .map(|length| vec![[GUARD; 3]; length + 1]);
    let mut wide = [points, lengths.form].map(|length| vec![[i64::from(GUARD); 3]; length + 1]);
    let mut pose = case.before.clone();
    let report = {
        let [lower, upper, current, candidate, gradients, form_workspace] = &mut narrow;
        let [forces, form_gradient] = &mut wide;
        let scratch = ProjectScratch {
            lower,
            upper,
            current,
            candidate,
            forces,
            gradients,
            form_workspace,
            form_gradient,
        };
        limits.project(&case.goal, &regions, scratch, &mut pose)?
    };
    assert!(
        narrow
            .iter()
            .all(|buffer| buffer.last() == Some(&[GUARD; 3]))
    );
    assert!(
        wide.iter()
            .all(|buffer| buffer.last() == Some(&[i64::from(GUARD); 3]))
    );
    Ok((pose, report))
}

/// The crate's results in the reference's words.
fn named(pose: Vec<[i32; 3]>, report: &ProjectReport, regions: usize) -> Projected {
    assert_eq!(report.volumes[regions..], [0; MOST_REGIONS][regions..]);
    Projected {
        pose,
        volumes: report.volumes[..regions].to_vec(),
        missed: report.missed,
        steps: report.steps,
        gave_up: [
            GaveUp::GOAL_CUT,
            GaveUp::OUTSIDE_BOX,
            GaveUp::VOLUME_MISSED,
            GaveUp::ZERO_GRADIENT,
            GaveUp::BAND_EMPTY,
            GaveUp::NOT_SETTLED,
            GaveUp::SATURATED,
        ]
        .map(|reason| report.gave_up.contains(reason)),
    }
}

#[test]
fn equals_the_reference_bit_for_bit() {
    let (mut coordinates, mut met, mut missed, mut reasons) = (0, 0, 0, [0; 7]);
    for seed in 0..case_count() {
        let case = ProjectCase::new(seed, 16);
        let (pose, report) = run(&case).expect("a sound problem");
        let got = named(pose, &report, case.regions.len());
        let want = project(&case.limits, &case.regions, &case.goal, &case.before);
        assert!(got == want, "seed {seed}: got {got:?}, want {want:?}");
        coordinates += 3 * got.pose.len();
        met += case.regions.len() as u32 - got.missed.count_ones();
        missed += got.missed.count_ones();
        // A volume that was clamped is said to be, wherever the steps end.
        let mut forms = case.regions.iter().map(|region| &region.form);
        let is_clamped = forms.any(|form| form.evaluate(&got.pose).volume_saturated > 0);
        assert!(!is_clamped || got.gave_up[6], "seed {seed}: {got:?}");
        for (count, gave_up) in reasons.iter_mut().zip(got.gave_up) {
            *count += u32::from(gave_up);
        }
    }
    println!(
        "{coordinates} coordinates, 0 mismatches; {met} volumes met, {missed} missed; reasons {reasons:?}"
    );
    // Every reason must have been seen.
    assert!(reasons.iter().all(|&count| count > 0), "{reasons:?}");
}

/// Boxes are kept wherever the pose before lay in them, and no coordinate moves by more than its rate.
#[test]
fn hard_limits_are_never_broken() {
    for seed in 0..case_count() {
        let case = ProjectCase::new(seed, 16);
        let (pose, report) = run(&case).expect("a sound problem");
        let outside = report.gave_up.contains(GaveUp::OUTSIDE_BOX);
        for (point, (after, before)) in pose.iter().zip(&case.before).enumerate() {
            for axis in 0..3 {
                assert!(after[axis].abs_diff(before[axis]) <= case.limits.rates[point]);
                let (lower, upper) = (
                    case.limits.lower[point][axis],
                    case.limits.upper[point][axis],
                );
                let inside = (lower..=upper).contains(&after[axis]);
                let was_inside = (lower..=upper).contains(&before[axis]);
                assert!(
                    inside || (outside && !was_inside),
                    "seed {seed}, point {point}"
                );
            }
        }
    }
}

/// A tetrahedron of edge 2^20 whose first three corners are pinned, with its volume's form.
fn tetrahedron() -> ProjectCase {
    let edge = 1 << 20;
    let rest = vec![[0; 3], [edge, 0, 0], [0, edge, 0], [0, 0, edge]];
    let form = VolumeTable {
        points: vec![0, 1, 2, 3],
        taps: vec![([0, 1, 2], 1 << 20)],
        difference_shift: 4,
        pair_bits: 20,
        volume_shift: 28,
        gradient_bits: 20,
        ..VolumeTable::default()
    };
    // 2^48 * 2^20 / 2^28: the determinant of the rounded edges, times the weight.
    let volume = 1 << 40;
    let (mut lower, mut upper) = (rest.clone(), rest.clone());
    (lower[3], upper[3]) = ([i32::MIN; 3], [i32::MAX; 3]);
    ProjectCase {
        limits: LimitsTable {
            lower,
            upper,
            rates: vec![u32::MAX; 4],
            mobilities: vec![1 << 15; 4],
            settled: 16,
        },
        regions: vec![RegionTable {
            form,
            least: volume,
            greatest: volume,
        }],
        goal: rest.clone(),
        before: rest,
    }
}

/// The volume is the height over the pinned base: by geometry the apex keeps it and takes the rest of its goal.
#[test]
fn the_apex_of_a_pinned_tetrahedron_moves_in_its_plane() {
    let mut case = tetrahedron();
    case.goal[3] = [1 << 19, -5, 1 << 21];
    let (pose, report) = run(&case).unwrap();
    assert_eq!(pose[3], [1 << 19, -5, 1 << 20]);
    assert_eq!(report.gave_up, GaveUp::NOTHING);
    // In a band the nearest end is taken: half as much again.
    case.regions[0].greatest = 3 << 39;
    let (pose, report) = run(&case).unwrap();
    assert_eq!(pose[3], [1 << 19, -5, 3 << 19]);
    assert_eq!(report.gave_up, GaveUp::NOTHING);
}

#[test]
fn what_cannot_be_met_is_given_up_and_said() {
    // All is pinned: nothing changes the volume.
    let mut case = tetrahedron();
    case.regions[0].least *= 2;
    case.regions[0].greatest *= 2;
    case.limits.lower[3] = case.before[3];
    case.limits.upper[3] = case.before[3];
    let (pose, report) = run(&case).unwrap();
    assert_eq!(pose, case.before);
    assert!(
        report
            .gave_up
            .contains(GaveUp::ZERO_GRADIENT | GaveUp::VOLUME_MISSED)
    );
    assert_eq!((report.missed, report.volumes[0]), (1, 1 << 40));
    // The box lets the apex rise a quarter only: it goes to the box's end.
    case.limits.upper[3] = [0, 0, 5 << 18];
    let (pose, report) = run(&case).unwrap();
    assert_eq!(pose[3], [0, 0, 5 << 18]);
    assert_eq!(report.gave_up, GaveUp::VOLUME_MISSED);
    // The box lies further away than the rate reaches: back at the rate.
    let mut case = tetrahedron();
    case.regions.clear();
    (case.limits.lower[3], case.limits.upper[3]) = ([100, 0, 0], [100, 0, 1 << 20]);
    case.limits.rates[3] = 7;
    let (pose, report) = run(&case).unwrap();
    assert_eq!(pose[3], [7, 0, 1 << 20]);
    assert_eq!(report.gave_up, GaveUp::OUTSIDE_BOX | GaveUp::GOAL_CUT);
    // An empty band: its middle, which is 1.5 times the volume.
    let mut case = tetrahedron();
    case.regions[0].least *= 2;
    let (pose, report) = run(&case).unwrap();
    assert_eq!(pose[3], [0, 0, 3 << 19]);
    assert_eq!(report.gave_up, GaveUp::BAND_EMPTY);
    // A goal without volume, and no gradient at it: flat on the base's axis, all four in one line.
    let mut case = tetrahedron();
    case.limits.lower.fill([i32::MIN; 3]);
    case.limits.upper.fill([i32::MAX; 3]);
    case.goal = vec![[5; 3]; 4];
    let (pose, report) = run(&case).unwrap();
    assert_eq!(pose, case.goal);
    assert!(
        report
            .gave_up
            .contains(GaveUp::ZERO_GRADIENT | GaveUp::VOLUME_MISSED)
    );
}

#[test]
fn unsound_limits_are_refused_and_named() {
    type Damage = fn(&mut ProjectCase);
    let damages: [(Damage, ProjectError); 5] = [
        (
            |case| case.limits.lower[2][1] += 1,
            ProjectError::Box { point: 2 },
        ),
        (
            |case| case.limits.mobilities[1] += 1,
            ProjectError::Mobility { point: 1 },
        ),
        (|case| case.limits.rates.truncate(2), ProjectError::Layout),
        (
            |case| case.regions = vec![case.regions[0].clone(); 5],
            ProjectError::Regions { given: 5 },
        ),
        (
            |case| case.regions[0].form.points[2] = 1,
            ProjectError::RepeatedPoint { point: 1 },
        ),
    ];
    for (damage, want) in damages {
        let mut case = tetrahedron();
        damage(&mut case);
        assert_eq!(run(&case).err(), Some(want));
        assert!(want.to_string().len() > 20);
    }
    assert_eq!(
        Limits::from_section(&[0; 16], 0).err(),
        Some(ProjectError::Points)
    );
}
