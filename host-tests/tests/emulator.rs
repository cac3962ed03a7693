//! The runner tells every kind of failure from success, on an image that fails on purpose.
//!
//! `cargo xtask test` builds the image and runs these.

use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use octruss_firmware::exit::{END_MARKER, Ending};
use octruss_host_tests::qemu::{Error, Machine, Outcome, Run, image};

/// Runs the image `faults` with the order to fail in the way `fault`.
fn run(machine: Machine, fault: &str) -> Result<Outcome, Error> {
    let directory = scratch(&format!("faults-{}-{fault}", machine.name()));
    fs::write(directory.join("fault.txt"), fault).unwrap();
    Run::new(machine, image("faults"))
        .directory(directory)
        .time_limit(Duration::from_secs(if fault == "hang" { 2 } else { 20 }))
        .run()
}

/// A directory of this test's own, below cargo's directory for the purpose.
fn scratch(name: &str) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// The ending that an exit code names, and the log's last message.
#[track_caller]
fn failure(result: &Result<Outcome, Error>) -> (Option<Ending>, String) {
    match result {
        Err(Error::Failed { code, log, .. }) => {
            let last = log.0.last().cloned().unwrap_or_default();
            (Ending::from_code(*code), last)
        }
        other => panic!("not a failure with an exit code: {other:?}"),
    }
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn an_image_that_finishes_passes() {
    let machines = [
        Machine::Mps2An386,
        Machine::Mps2An500,
        Machine::Netduinoplus2,
    ];
    for machine in machines {
        let outcome = run(machine, "nothing").unwrap();
        assert_eq!(outcome.log.messages.last().unwrap().text, END_MARKER);
    }
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn a_panic_fails_and_names_its_place() {
    let (ending, last) = failure(&run(Machine::Mps2An386, "panic"));
    assert_eq!(ending, Some(Ending::Panicked));
    assert!(last.contains("a panic on purpose, number 7"), "{last}");
    assert!(last.contains("faults.rs"), "{last}");
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn a_fault_fails_and_gives_the_registers() {
    let (ending, last) = failure(&run(Machine::Mps2An500, "bad-address"));
    assert_eq!(ending, Some(Ending::Faulted));
    assert!(last.contains("hard fault at pc 0x0000"), "{last}");
    assert!(last.contains("bfar 0xfffffff0"), "{last}");
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn an_interrupt_that_nobody_handles_fails() {
    let (ending, last) = failure(&run(Machine::Mps2An386, "interrupt"));
    assert_eq!(ending, Some(Ending::Faulted));
    assert!(last.contains("interrupt 31"), "{last}");
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn a_stack_without_room_fails() {
    let (ending, last) = failure(&run(Machine::Mps2An386, "overflow"));
    assert_eq!(ending, Some(Ending::StackOverflowed));
    assert!(last.contains("the stack used its space up"), "{last}");
}

/// A board whose memory ends where its stack does: the processor faults, and the image says so from a new
/// stack.
#[test]
#[ignore = "needs the images: cargo xtask test"]
fn a_stack_that_leaves_the_memory_faults() {
    let machine = Machine::Netduinoplus2;
    let directory = scratch("faults-leave-memory");
    fs::write(directory.join("fault.txt"), "leave-memory").unwrap();
    let result = Run::new(machine, machine.image("faults"))
        .directory(directory)
        .run();
    let (ending, last) = failure(&result);
    assert_eq!(ending, Some(Ending::StackOverflowed));
    assert!(
        last.contains("the stack overflowed, which faulted"),
        "{last}"
    );
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn a_hanging_image_is_stopped() {
    match run(Machine::Mps2An386, "hang") {
        Err(Error::TimedOut { limit, log }) => {
            assert_eq!(limit, Duration::from_secs(2));
            assert_eq!(log.0, ["info  told to: hang"]);
        }
        other => panic!("not stopped: {other:?}"),
    }
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn success_without_the_end_marker_fails() {
    let result = run(Machine::Mps2An386, "silence");
    assert!(
        matches!(result, Err(Error::NoEndMarker { .. })),
        "{result:?}"
    );
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn foreign_bytes_in_the_log_fail() {
    let result = run(Machine::Mps2An386, "corrupt-log");
    assert!(
        matches!(result, Err(Error::LogCorrupt { .. })),
        "{result:?}"
    );
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn a_missing_file_fails_and_is_named() {
    let directory = scratch("faults-no-file");
    let result = Run::new(Machine::Mps2An386, image("faults"))
        .directory(directory)
        .run();
    let (ending, last) = failure(&result);
    assert_eq!(ending, Some(Ending::Refused));
    assert!(
        last.contains("cannot open the host's file fault.txt"),
        "{last}"
    );
}

#[test]
fn an_image_that_is_not_there_is_named() {
    let run = Run::new(Machine::Mps2An386, "no/such/image");
    let words = run.run().unwrap_err().to_string();
    assert!(
        words.starts_with("cannot read ") && words.contains("no/such/image"),
        "{words}"
    );
}

#[test]
#[ignore = "needs the images: cargo xtask test"]
fn a_missing_emulator_says_what_to_do() {
    let run = Run::new(Machine::Mps2An386, image("faults")).emulator("no-such-emulator");
    let error = run.run().unwrap_err();
    assert!(matches!(error, Error::EmulatorMissing), "{error}");
    assert!(error.to_string().contains("cargo xtask setup"), "{error}");
}

/// The processor locks up when a fault has no handler to go to; QEMU then aborts itself.
#[cfg(unix)]
#[test]
#[ignore = "needs the images: cargo xtask test"]
fn an_emulator_that_dies_by_a_signal_fails() {
    const ABORT: i32 = 6;
    match run(Machine::Mps2An386, "lock-up") {
        Err(Error::Killed {
            signal, emulator, ..
        }) => {
            assert_eq!(signal, Some(ABORT));
            assert!(emulator.contains("Lockup"), "{emulator}");
        }
        other => panic!("not a signal: {other:?}"),
    }
}
