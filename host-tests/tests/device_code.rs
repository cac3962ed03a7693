//! Code of the firmware that runs on the host too: the player of frames, and the runner of cases.

use std::convert::Infallible;

use embedded_hal::digital::{ErrorType, OutputPin};
use octruss::deform::ApplyError;
use octruss_bake::bundle::BundleBytes;
use octruss_bake::pack::Layout;
use octruss_firmware::cases::Status;
use octruss_firmware::frame::FrameReader;
use octruss_firmware::player::{Meter, PlayError, Player, ROWS_A_PIECE};
use octruss_host_tests::qemu::conformance::{Case, ResultsError, decode, on_host};
use octruss_host_tests::qemu::judge::{Judged, Verdict};
use octruss_host_tests::random_bundle::BundleCase;

/// Notes every level that the LED's pin was set to.
#[derive(Default)]
struct Led(Vec<bool>);

impl ErrorType for &mut Led {
    type Error = Infallible;
}

impl OutputPin for &mut Led {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.push(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.push(true);
        Ok(())
    }
}

/// Counts measurements, and complains if they are not closed one by one.
#[derive(Default)]
struct Count {
    runs: usize,
    is_running: bool,
}

impl Meter for Count {
    fn start(&mut self) {
        assert!(!self.is_running);
        self.is_running = true;
    }

    fn stop(&mut self) {
        assert!(self.is_running);
        (self.is_running, self.runs) = (false, self.runs + 1);
    }
}

/// A table of more than one piece, but no whole number of them.
fn case() -> BundleCase {
    const MORE_THAN_TWO_PIECES: usize = 2 * ROWS_A_PIECE + 100;
    let seeds = 0..100;
    let cases = seeds.map(|seed| BundleCase::new(seed, MORE_THAN_TWO_PIECES, 60, Layout::Q30));
    let mut long = cases.filter(|case| case.order.len() > 2 * ROWS_A_PIECE);
    long.next().expect("one of a hundred seeds")
}

#[test]
fn a_frame_in_pieces_is_the_reference_s() {
    let case = case();
    let bytes = BundleBytes::new(&case.bytes);
    let table = bytes.open().unwrap().table::<i32>().unwrap();
    let (want, _) = case.displaced();
    let (mut led, mut line) = (Led::default(), vec![0; 1 << 16]);
    let mut piece = [[0; 3]; ROWS_A_PIECE];
    let mut count = Count::default();
    let mut port = line.as_mut_slice();
    let mut player = Player::new(table, &mut led, &mut port, &mut piece);
    for number in 0..3 {
        let saturated = player.play(number, &case.case.pose, &mut count).unwrap();
        assert_eq!(saturated as usize, want.saturated);
    }
    let left = port.len();
    let sent = line.len() - left;
    assert_eq!(led.0, [false, true, false]);
    assert_eq!(count.runs, 3 * case.order.len().div_ceil(ROWS_A_PIECE));
    let in_order: Vec<[i32; 3]> = case.order.iter().map(|&row| want.points[row]).collect();
    let mut frames = FrameReader::new(&line[..sent]);
    for number in 0..3 {
        let frame = frames.next().unwrap().unwrap();
        assert_eq!(frame.number, number);
        assert_eq!(frame.saturated as usize, want.saturated);
        assert!(frame.rows().eq(in_order.iter().copied()));
    }
    assert_eq!(frames.next(), None);
}

#[test]
fn a_pose_of_another_cage_is_refused() {
    let case = case();
    let bytes = BundleBytes::new(&case.bytes);
    let table = bytes.open().unwrap().table::<i32>().unwrap();
    let (mut led, mut line) = (Led::default(), [0; 64]);
    let mut piece = [[0; 3]; ROWS_A_PIECE];
    let mut player = Player::new(table, &mut led, line.as_mut_slice(), &mut piece);
    let (needed, given) = (case.case.pose.len(), case.case.pose.len() - 1);
    let refused = player.play(0, &case.case.pose[..given], &mut ());
    let expected = ApplyError::PoseLength { needed, given };
    assert_eq!(refused, Err(PlayError::Apply(expected)));
}

/// The cases that `cargo xtask test` hands to the emulated processors, on this machine.
#[test]
fn cases_on_the_host_give_what_the_reference_gives() {
    let cases: Vec<Judged> = (0..200).map(Judged::new).collect();
    let sent: Vec<Case> = cases.iter().map(|judged| judged.case.clone()).collect();
    let mut results = on_host(&sent);
    let verdict = Verdict::of(&cases, &results, Some(&results));
    assert_eq!(verdict.mismatches, [""; 0]);
    assert_eq!((verdict.sound, verdict.damaged), (180, 20));

    // One unit in one coordinate is found, in sound cases and in damaged ones.
    let host = results.clone();
    let last_word = |results: &mut [_], place: usize| {
        let case: &mut octruss_host_tests::qemu::conformance::CaseResults = &mut results[place];
        let word = case
            .sections
            .last_mut()
            .and_then(|section| section.words.last_mut());
        *word.expect("a case with results") ^= 1;
    };
    last_word(&mut results, 14);
    let found = Verdict::of(&cases, &results, None).mismatches;
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].starts_with("seed 14, against the reference: "),
        "{found:?}"
    );
    let found = Verdict::of(&cases, &results, Some(&host)).mismatches;
    assert_eq!(found.len(), 2, "{found:?}");
}

#[test]
fn a_case_that_is_none_has_results_that_say_so() {
    let case = |kind, words| Case {
        kind,
        number: 9,
        words,
    };
    let cases = [
        case(0, vec![]),
        case(1, vec![]),
        case(1, vec![6, 1, 0, 0, 0, 0, 0, 0]),
        case(1, vec![1, 9, 0, 0, 0, 0, 0, 0]),
        case(1, vec![1, 1, 0, u32::MAX, 0, 0, 0, 0]),
        case(3, vec![0, 0, 0, 0, 0, 1]),
        case(1, vec![1; 5000]),
    ];
    let statuses: Vec<[u32; 4]> = on_host(&cases).iter().map(|result| result.status).collect();
    let malformed = Status::Malformed.words();
    assert_eq!(statuses[..6], [malformed; 6]);
    assert_eq!(statuses[6], Status::TooLong { words: 5000 }.words());
}

#[test]
fn a_file_that_is_no_results_is_refused() {
    let words =
        |words: &[u32]| -> Vec<u8> { words.iter().flat_map(|word| word.to_le_bytes()).collect() };
    let magic = u32::from_le_bytes(*b"OCTR");
    assert_eq!(decode(b"OCTR"), Err(ResultsError::CutShort));
    assert_eq!(decode(&words(&[1, 1, 0])), Err(ResultsError::Header));
    assert_eq!(decode(&words(&[magic, 2, 0])), Err(ResultsError::Header));
    assert_eq!(decode(&words(&[magic, 1, 0])), Ok(vec![]));
    assert_eq!(
        decode(&words(&[magic, 1, 0, 7])),
        Err(ResultsError::Trailing)
    );
    let case = [magic, 1, 1, 5, 2, 2, 1, 0, 0, 4, 0, 0, 0, 0];
    let results = decode(&words(&case)).unwrap();
    assert_eq!((results[0].number, results[0].is_done()), (5, true));
    for cut in 3..case.len() {
        assert_eq!(
            decode(&words(&case[..cut])),
            Err(ResultsError::CutShort),
            "{cut}"
        );
    }
}
