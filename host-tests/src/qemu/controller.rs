//! Drives the interactive controller on emulated boards: a motion with disturbances, silence and a host that goes away,
//! a replay on another processor, and wrong frames without end. Every record of telemetry is held against the
//! controller's code on the host and against the reference.

use std::net::TcpListener;
use std::path::{Path, PathBuf};

use octruss::bundle::Bundle;
use octruss_bake::bundle::BundleBytes;
use octruss_bake::drive::goals;
use octruss_bake::drive::mirror::{Mirror, MirrorMemory};
use octruss_bake::drive::port;
use octruss_bake::drive::record::{self, Line};
use octruss_bake::drive::report::{Collector, Report};
use octruss_bake::drive::run::{self, Each, Plan};
use octruss_bake::drive::session::{Session, frame};
use octruss_firmware::link::wire::ENCODED_BYTES;
use octruss_firmware::link::{Command, Goal, Header, Target, Telemetry};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::demo::Failure;
use super::{Machine, Run, Running};
use crate::reference_motion::{Expected, ReferenceMotion};

/// 4 ns an instruction: 5 million a tick, of which the controller takes a third. While it waits for the tick the emulator
/// sleeps, and on a busy machine it wakes late, by milliseconds; they must fit the tick too.
const SHIFT: u8 = 2;
/// Ticks from a frame of the motion to the next.
const TICKS_A_FRAME: u32 = 8;
/// Ticks from one set of goals that is sent to the next: what the emulator's serial port lets through.
const EVERY: u32 = 4;
/// Ticks of silence until the pose is held.
const SILENCE: u32 = 25;
/// Bytes of wrong frames a tick.
const WRONG_BYTES: usize = 140;

/// One run and what the reference says of it.
pub struct Driven {
    /// What was done.
    pub title: &'static str,
    /// The figures.
    pub report: Report,
    /// Records that are not the reference's.
    pub not_reference: u64,
    /// The first of them.
    pub first: Option<String>,
    /// What must hold of the figures and does not.
    pub failures: Vec<String>,
    /// Ticks missed since the board was started.
    pub missed: u32,
}

impl Driven {
    /// Whether all is as it must be.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.report.agrees()
            && self.not_reference == 0
            && self.failures.is_empty()
            && self.missed == 0
    }

    fn demand(&mut self, holds: bool, what: impl Into<String>) {
        if !holds {
            self.failures.push(what.into());
        }
    }

    fn fault(&self, name: &str) -> u32 {
        self.report.faults.get(name).copied().unwrap_or(0)
    }

    fn demand_faults(&mut self, expected: &[(&str, u32)]) {
        for &(name, count) in expected {
            let found = self.fault(name);
            let what = format!("{found} frames were counted as {name}, not {count}");
            self.demand(found == count, what);
        }
    }
}

/// A board that runs the controller.
struct Board {
    running: Running,
    port: u16,
}

impl Board {
    fn start(machine: Machine) -> Result<Self, Failure> {
        // Nobody else takes a port that was free a moment ago.
        let port = TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
        let running = Run::new(machine, machine.image("controller"))
            .instruction_shift(SHIFT)
            .serial_tcp(port)
            .start()?;
        Ok(Board { running, port })
    }

    fn connect(&self, sequence: u16) -> Result<Session, Failure> {
        let port = port::tcp(&format!("127.0.0.1:{}", self.port))?;
        Ok(Session::new(port, sequence))
    }

    /// Stops it. An image that has ended by itself is an error, which says why.
    fn stop(self) -> Result<(), Failure> {
        self.running.stop()?;
        Ok(())
    }
}

/// Everything that belongs to one bundle.
struct Bench<'a> {
    bundle: Bundle<'a>,
    directory: PathBuf,
}

impl Bench<'_> {
    /// Carries out a plan and judges every record.
    fn drive(
        &self,
        title: &'static str,
        session: &mut Session,
        plan: Plan,
        each: Each<'_>,
    ) -> Result<(Driven, Vec<Line>), Failure> {
        let mut memory = MirrorMemory::of(&self.bundle);
        let mut mirror = Mirror::new(&self.bundle, &mut memory)?;
        let bits = self.bundle.header().fraction_bits.get();
        let mut collector = Collector::new(mirror.parts(), bits);
        let mut records: Vec<Telemetry> = Vec::new();
        let lines = run::run(
            session,
            &mut mirror,
            plan,
            &mut collector,
            &mut |record, collector, session| {
                records.push(*record);
                each(record, collector, session)
            },
        )?;
        let mut driven = Driven {
            title,
            report: collector.finish(&mirror),
            not_reference: 0,
            first: None,
            failures: Vec::new(),
            missed: records.last().map_or(0, |record| record.missed),
        };
        let mut reference = ReferenceMotion::of(&self.bundle)?;
        for (record, line) in records.iter().zip(&lines) {
            line.commands.iter().for_each(|own| reference.take(own));
            let mut expected = reference.advance()?;
            let found = Expected::of(record);
            if record.tick == 0 {
                // The outputs are still those of what ran before.
                expected.outputs.clone_from(&found.outputs);
            }
            if found != expected {
                driven.not_reference += 1;
                let words = format!("tick {}: {found:?}, not {expected:?}", record.tick);
                driven.first.get_or_insert(words);
            }
        }
        let consecutive = (0..).zip(&lines).all(|(tick, line)| line.tick == tick);
        driven.demand(consecutive, "records of some ticks did not arrive");
        let spoilt = driven.report.spoilt;
        driven.demand(spoilt == 0, format!("{spoilt} records arrived spoilt"));
        Ok((driven, lines))
    }
}

/// Runs everything. `directory` holds `controller.oct`, and the recorded run goes there. `wrong_frames` is how many
/// frames are sent that must be refused. Every run is handed to `each` when it has ended.
///
/// # Errors
/// If an image or a line breaks; what differs is told in the results.
pub fn play(
    directory: &Path,
    motion: &Path,
    wrong_frames: u32,
    each: &mut dyn FnMut(Driven),
) -> Result<(), Failure> {
    let bytes = BundleBytes::read(&directory.join("controller.oct"))?;
    let bench = Bench {
        bundle: bytes.open()?,
        directory: directory.to_path_buf(),
    };
    let board = Board::start(Machine::Mps2An386)?;
    let mut session = board.connect(100)?;
    let (disturbed, lines) = disturb(&bench, &mut session, motion)?;
    each(disturbed);
    let silent = fall_silent("targets, silence, hold (Cortex-M4)", &bench, &mut session)?;
    each(silent);
    // The host goes away in the middle of a frame, and another one comes.
    let cut = frame(&Command::Hold.payload(Header::default()));
    session.send_bytes(&cut[..5])?;
    drop(session);
    let mut session = board.connect(40_000)?;
    each(come_back(&bench, &mut session)?);
    each(send_wrong_frames(&bench, &mut session, wrong_frames)?);
    drop(session);
    board.stop()?;

    let board = Board::start(Machine::Mps2An500)?;
    let mut session = board.connect(7)?;
    each(replay(&bench, &mut session, &lines)?);
    drop(session);
    board.stop()?;

    let board = Board::start(Machine::Netduinoplus2)?;
    let mut session = board.connect(9)?;
    let title = "targets, silence, hold (STM32F405)";
    each(fall_silent(title, &bench, &mut session)?);
    drop(session);
    board.stop()
}

/// The finger's motion, while wrong frames of every kind come between.
fn disturb(
    bench: &Bench<'_>,
    session: &mut Session,
    motion: &Path,
) -> Result<(Driven, Vec<Line>), Failure> {
    let mut memory = MirrorMemory::of(&bench.bundle);
    let parts = *Mirror::new(&bench.bundle, &mut memory)?.parts();
    let frames = goals::from_motion(motion, &bench.bundle, &parts)?;
    let all = goals::between(&frames, TICKS_A_FRAME);
    let plan = Plan::follow(&all, EVERY, 60, SILENCE);
    let title = "a motion with disturbances (Cortex-M4)";
    let (mut driven, lines) = bench.drive(title, session, plan, &mut |record, _, session| {
        disturbance(record.tick, session)
    })?;
    driven.demand_faults(&[
        ("oversize", 1),
        ("unknown", 1),
        ("repeated", 1),
        ("out of order", 1),
        ("rejected", 2),
    ]);
    let cut = driven.fault("truncated") + driven.fault("checksum");
    driven.demand(cut == 3, format!("{cut} spoilt frames were counted, not 3"));
    driven.demand(driven.fault("flood") > 0, "the flood was not counted");
    let off = driven.report.volume_error.unwrap_or(1.0);
    driven.demand(off < 1e-4, format!("the volume is off by {off:.1e}"));
    let left = driven.report.last_effector_error;
    driven.demand(
        left < 0.01,
        format!("effectors end {left} from their goals"),
    );
    record::write(&bench.directory.join("run.csv"), &bench.bundle, &lines)?;
    let again = record::read(&bench.directory.join("run.csv"), &bench.bundle)?;
    driven.demand(again == lines, "the recorded run is not read back");
    Ok((driven, lines))
}

/// One wrong thing every twenty ticks.
fn disturbance(tick: u32, session: &mut Session) -> octruss_bake::error::Result<()> {
    let with = |sequence| Header { sequence, due: 0 };
    let last = session.sequence();
    let query = |sequence| frame(&Command::Query.payload(with(sequence)));
    match tick {
        30 => session.send_bytes(&[[0x5a; 60].as_slice(), &[0]].concat()),
        50 => {
            let whole = query(last.wrapping_add(1));
            session.send_bytes(&[&whole[..7], &[0]].concat())
        }
        70 => {
            let mut changed = query(last.wrapping_add(1));
            changed[4] ^= 0x40;
            session.send_bytes(&changed)
        }
        90 => session.send_bytes(&[[1; ENCODED_BYTES + 50].as_slice(), &[0]].concat()),
        110 => {
            let mut payload = Command::Query.payload(with(last.wrapping_add(1)));
            payload[6] = 99;
            session.send_bytes(&frame(&payload))
        }
        130 => session.send_bytes(&query(last)),
        150 => session.send_bytes(&query(last.wrapping_sub(5))),
        170 => {
            let goal = Goal {
                effector: 999,
                place: [0; 3],
            };
            session.send(Command::Goals([goal].into_iter().collect()), 0)?;
            // A tick that has passed.
            session.send(Command::Query, 1).map(|_| ())
        }
        190 => (0..60).try_for_each(|_| session.send(Command::Query, 0).map(|_| ())),
        _ => Ok(()),
    }
}

/// Actuators' targets; a host that is silent for longer than it said; a pose that is held; goals again.
fn fall_silent(
    title: &'static str,
    bench: &Bench<'_>,
    session: &mut Session,
) -> Result<Driven, Failure> {
    let watch = Command::Watch {
        host_clock_us: 1,
        silence_ticks: SILENCE,
    };
    let targets = |part: i32| {
        let target = |channel: u8| Target {
            channel,
            amplitude: part * (i32::from(channel) - 7) * (1 << 24),
        };
        Command::Actuators((0..16).map(target).collect())
    };
    let goal = Goal {
        effector: 0,
        place: [0; 3],
    };
    let goals = Command::Goals([goal].into_iter().collect());
    let plan = Plan {
        commands: [
            (1, watch),
            (20, targets(3)),
            // Silence begins on tick 45 and ends on tick 90.
            (90, targets(-5)),
            (110, Command::Hold),
            (120, Command::Query),
            (130, goals),
            (150, Command::Query),
        ]
        .into(),
        last: 170,
    };
    let (mut driven, _) = bench.drive(title, session, plan, &mut |_, _, _| Ok(()))?;
    driven.demand_faults(&[("silence", 1), ("rejected", 0)]);
    let held = driven.report.held_ticks;
    driven.demand(
        held == 65,
        format!("the pose was held on {held} ticks, not 65"),
    );
    Ok(driven)
}

/// A host that has come back begins anew, and what the last one left on the line is refused.
fn come_back(bench: &Bench<'_>, session: &mut Session) -> Result<Driven, Failure> {
    let plan = Plan {
        commands: (1..=30).map(|tick| (tick, Command::Query)).collect(),
        last: 40,
    };
    // The end of the frame that was cut.
    session.send_bytes(&[0])?;
    let title = "a host that went away comes back (Cortex-M4)";
    let (driven, _) = bench.drive(title, session, plan, &mut |_, _, _| Ok(()))?;
    Ok(driven)
}

/// Frames that must be refused, as fast as the line takes them, each counted once.
fn send_wrong_frames(
    bench: &Bench<'_>,
    session: &mut Session,
    count: u32,
) -> Result<Driven, Failure> {
    let mut random = ChaCha8Rng::seed_from_u64(10);
    let mut open = count;
    let mut wrong = Vec::new();
    let mut bytes = 0_usize;
    while open > 0 {
        let kind = random.random_range(0..7_u32);
        let length = match kind {
            0 => random.random_range(1..12),
            2 => random.random_range(1..24),
            3 if open.is_multiple_of(50) => ENCODED_BYTES + 1 + random.random_range(0..60),
            _ => 12,
        };
        wrong.push((kind, length));
        bytes += length + 1;
        open -= 1;
    }
    let ticks = 40 + (bytes / WRONG_BYTES) as u32;
    let watch = |tick| {
        let watch = Command::Watch {
            host_clock_us: tick,
            silence_ticks: 0,
        };
        (tick, watch)
    };
    let plan = Plan {
        commands: (1..ticks).step_by(10).map(watch).collect(),
        last: ticks,
    };
    let mut wrong = wrong.into_iter();
    let title = "wrong frames alone (Cortex-M4)";
    let (mut driven, _) = bench.drive(title, session, plan, &mut |_, _, session| {
        let mut bytes = Vec::new();
        while bytes.len() < WRONG_BYTES
            && let Some((kind, length)) = wrong.next()
        {
            bytes.extend(wrong_frame(kind, length, session.sequence(), &mut random));
        }
        session.send_bytes(&bytes)
    })?;
    let refused = driven.report.refused;
    let words = format!("{refused} frames were refused of {count} wrong ones");
    driven.demand(refused == count, words);
    Ok(driven)
}

/// A wrong frame with its zero, of about a length.
fn wrong_frame(kind: u32, length: usize, last: u16, random: &mut ChaCha8Rng) -> Vec<u8> {
    let query = |sequence| frame(&Command::Query.payload(Header { sequence, due: 0 }));
    let next = last.wrapping_add(1);
    let mut bytes = match kind {
        // Cut.
        0 => {
            let mut whole = query(next);
            whole.truncate(length.min(whole.len() - 2));
            whole
        }
        // Changed by a bit that leaves no zero.
        1 => {
            let mut changed = query(next);
            changed.pop();
            loop {
                let place = random.random_range(0..changed.len());
                let own = changed[place] ^ (1 << random.random_range(0..8));
                if own != 0 {
                    changed[place] = own;
                    break changed;
                }
            }
        }
        // The last number again.
        4 => return query(last),
        // A number that has passed.
        5 => return query(last.wrapping_sub(random.random_range(1..1000))),
        // An unknown command with a sound checksum.
        6 => {
            let header = Header {
                sequence: next,
                due: 0,
            };
            let mut payload = Command::Query.payload(header);
            payload[6] = random.random_range(7..=255);
            return frame(&payload);
        }
        // Garbage, short or longer than a frame may be.
        _ => (0..length).map(|_| random.random_range(1..=255)).collect(),
    };
    bytes.push(0);
    bytes
}

/// The recorded run again, on another processor.
fn replay(bench: &Bench<'_>, session: &mut Session, lines: &[Line]) -> Result<Driven, Failure> {
    let plan = Plan::replay(lines)?;
    let title = "the recorded motion again (Cortex-M7)";
    let (mut driven, again) = bench.drive(title, session, plan, &mut |_, _, _| Ok(()))?;
    let pairs = lines.iter().zip(&again);
    let differing = pairs.filter(|(was, is)| was != is).count() + lines.len().abs_diff(again.len());
    driven.demand(
        differing == 0,
        format!("{differing} ticks are not as they were recorded"),
    );
    Ok(driven)
}
