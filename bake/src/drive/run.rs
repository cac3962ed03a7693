//! One run from the restart to the last tick.

use super::goals::{self, Goals};
use super::mirror::Mirror;
use super::record::Line;
use super::report::Collector;
use super::session::Session;
use crate::error::{Error, Result};
use octruss_firmware::link::{Command, Telemetry};
use std::collections::VecDeque;
use std::time::Instant;

/// How many ticks ahead commands are sent: what the device's memory holds of goals for all effectors.
pub const LEAD: u32 = 16;
/// Bytes that are sent for each record that comes, so that the device's ring never fills: goals for 32 effectors take
/// 500.
const BYTES_A_RECORD: usize = 700;
/// And at most at once.
const BYTES_AT_ONCE: usize = 1400;
/// How often the watchdog is told, in ticks.
const WATCH_EVERY: u32 = 10;

/// What is to be sent, and until when.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Commands with the ticks on which they take effect, which ascend from 1.
    pub commands: VecDeque<(u32, Command)>,
    /// The last tick.
    pub last: u32,
}

impl Plan {
    /// Follows goals of every tick from tick [`LEAD`] on, of which each `every`th is sent and the last, and stays there
    /// for `rest` ticks. The pose is held after `silence` ticks without a command; 0 for never.
    #[must_use]
    pub fn follow(all: &[Goals], every: u32, rest: u32, silence: u32) -> Self {
        let mut plan = Plan::default();
        let count = all.len() as u32;
        plan.last = LEAD + count + rest;
        for tick in 1..=plan.last {
            if tick % WATCH_EVERY == 1 {
                let watch = Command::Watch {
                    host_clock_us: 0,
                    silence_ticks: silence,
                };
                plan.commands.push_back((tick, watch));
            }
            let at = tick.checked_sub(LEAD).map(|at| at as usize);
            let is_sent =
                |at: &usize| at.is_multiple_of(every.max(1) as usize) || at + 1 == all.len();
            let goals = at.filter(is_sent).and_then(|at| all.get(at));
            for command in goals.into_iter().flat_map(|goals| goals::commands(goals)) {
                plan.commands.push_back((tick, command));
            }
        }
        plan
    }

    /// The commands of a recorded run.
    ///
    /// # Errors
    /// If it does not begin with a restart.
    pub fn replay(lines: &[Line]) -> Result<Self> {
        let begins = lines
            .first()
            .is_some_and(|line| line.commands == [Command::Restart]);
        if !begins {
            return Err(Error::new("the run does not begin with a restart alone")
                .advise("record it with `octruss drive --record`"));
        }
        let of_line = |line: &Line| {
            let tick = line.tick;
            line.commands
                .clone()
                .into_iter()
                .map(move |command| (tick, command))
        };
        Ok(Plan {
            commands: lines.iter().skip(1).flat_map(of_line).collect(),
            last: lines.last().map_or(0, |line| line.tick),
        })
    }
}

/// What happens on each record, after it was compared: things are shown, or more is sent.
pub type Each<'e> = &'e mut dyn FnMut(&Telemetry, &Collector, &mut Session) -> Result<()>;

/// Restarts the controller, carries out a plan, and hands every record from the restart on to `each`. Returns what
/// happened, tick by tick.
///
/// # Errors
/// If the line breaks, or the controller does what it was not told.
pub fn run(
    session: &mut Session,
    mirror: &mut Mirror<'_, '_>,
    mut plan: Plan,
    collector: &mut Collector,
    each: Each<'_>,
) -> Result<Vec<Line>> {
    let begun = Instant::now();
    // Who does not listen yet loses what is sent; who speaks listens.
    session.receive()?;
    session.send(Command::Restart, 0)?;
    let restart = session.sequence();
    let mut credit = BYTES_AT_ONCE;
    send(session, &mut plan, LEAD, &mut credit, begun)?;
    let mut lines: Vec<Line> = Vec::new();
    loop {
        let record = session.receive()?;
        let is_start = record.accepted > 0 && record.sequences[0] == restart && record.tick == 0;
        if lines.is_empty() && !is_start {
            continue;
        }
        let commands = mirror.follow(&record, session)?;
        collector.take(&record);
        each(&record, collector, session)?;
        lines.push(Line::of(&record, commands));
        if record.tick >= plan.last {
            collector.spoilt(session.spoilt());
            return Ok(lines);
        }
        credit = (credit + BYTES_A_RECORD).min(BYTES_AT_ONCE);
        let until = record.tick.saturating_add(LEAD);
        send(session, &mut plan, until, &mut credit, begun)?;
    }
}

/// Sends what is due until a tick, as long as there is credit.
fn send(
    session: &mut Session,
    plan: &mut Plan,
    until: u32,
    credit: &mut usize,
    begun: Instant,
) -> Result<()> {
    // A frame has at most 198 bytes.
    while *credit >= 200
        && let Some((due, _)) = plan.commands.front()
        && *due <= until
        && let Some((due, mut command)) = plan.commands.pop_front()
    {
        if let Command::Watch { host_clock_us, .. } = &mut command
            && *host_clock_us == 0
        {
            // Modulo 2^32, as the protocol has it.
            *host_clock_us = begun.elapsed().as_micros() as u32;
        }
        *credit = credit.saturating_sub(session.send(command, due)?);
    }
    Ok(())
}
