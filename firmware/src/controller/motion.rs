//! What moves: goals or targets in, a pose and set-points out, the same bits for the same commands on the same ticks.

use octruss::control::inverse::{InverseState, MOST_ACTUATORS, MOST_EFFECTORS, VolumeGoal};

use super::parts::Parts;
use super::set_point::set_point;
use crate::checksum;
use crate::link::{CHANNELS, Command};
use crate::player::ROWS_A_PIECE;

const _: () = assert!(
    CHANNELS == MOST_ACTUATORS,
    "telemetry has a channel for each actuator"
);

/// Memory of a [`Motion`]: the pose and a piece of the deformed model.
pub struct Memory<'m> {
    /// As many as the cage has control points.
    pub pose: &'m mut [[i32; 3]],
    /// Where rows of the model are deformed, a piece after the other.
    pub piece: &'m mut [[i32; 3]; ROWS_A_PIECE],
}

/// What the amplitudes follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Follow {
    /// The effectors' goals, with the volume held.
    Goals,
    /// Targets of the amplitudes.
    Targets,
    /// Nothing.
    Nothing,
}

/// What a tick has come to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moved {
    /// Whether the pose was held.
    pub is_held: bool,
    /// Whether because the host was silent.
    pub is_silent: bool,
    /// Whether the silence begins with this tick.
    pub silence_begins: bool,
    /// What the solver gave up, the bits of `GaveUp`.
    pub gave_up: u32,
    /// Coordinates of control points and of the model that did not fit.
    pub saturated: u32,
    /// CRC-32 of the pose.
    pub pose_hash: u32,
    /// CRC-32 of the deformed model, rows in the bundle's order.
    pub skin_hash: u32,
    /// The volume; 0 if the bundle has none.
    pub volume: i64,
    /// The greatest distance of an effector's coordinate from its goal.
    pub effector_error: u32,
    /// The actuators' set-points.
    pub set_points: [u16; CHANNELS],
}

/// The state between ticks.
///
/// Nothing but commands and ticks changes it: the same commands taken before the same ticks give the same bits on every
/// machine.
pub struct Motion<'a, 'm> {
    parts: Parts<'a>,
    memory: Memory<'m>,
    rest_volume: i64,
    follow: Follow,
    state: InverseState,
    goals: [[i32; 3]; MOST_EFFECTORS],
    targets: [i32; MOST_ACTUATORS],
    host_clock_us: u32,
    silence_ticks: u32,
    silent_for: u32,
}

impl<'a, 'm> Motion<'a, 'm> {
    /// At rest. `None` if the pose's memory is not that of the cage.
    #[must_use]
    pub fn new(parts: Parts<'a>, memory: Memory<'m>) -> Option<Self> {
        if memory.pose.len() != parts.actuation.control_points() {
            return None;
        }
        let mut motion = Motion {
            state: InverseState::new(&parts.solver),
            rest_volume: parts.rest_volume(),
            parts,
            memory,
            follow: Follow::Goals,
            goals: [[0; 3]; MOST_EFFECTORS],
            targets: [0; MOST_ACTUATORS],
            host_clock_us: 0,
            silence_ticks: 0,
            silent_for: 0,
        };
        motion.restart();
        Some(motion)
    }

    /// What it runs on.
    #[must_use]
    pub fn parts(&self) -> &Parts<'a> {
        &self.parts
    }

    /// The host's clock as it was last told.
    #[must_use]
    pub fn host_clock_us(&self) -> u32 {
        self.host_clock_us
    }

    /// Whether a command names only effectors and actuators that are there.
    #[must_use]
    pub fn knows(&self, command: &Command) -> bool {
        let (effectors, actuators) = (self.parts.solver.effectors(), self.parts.solver.actuators());
        match command {
            Command::Goals(goals) => goals
                .iter()
                .all(|goal| usize::from(goal.effector) < effectors),
            Command::Actuators(targets) => targets
                .iter()
                .all(|target| usize::from(target.channel) < actuators),
            _ => true,
        }
    }

    /// A command takes effect. What [`knows`](Self::knows) refuses is passed over.
    pub fn take(&mut self, command: &Command) {
        self.silent_for = 0;
        match command {
            Command::Goals(goals) => {
                for goal in goals {
                    if let Some(own) = self.goals.get_mut(usize::from(goal.effector)) {
                        *own = goal.place;
                    }
                }
                self.follow = Follow::Goals;
            }
            Command::Actuators(targets) => {
                if self.follow != Follow::Targets {
                    self.targets = *self.state.amplitudes();
                }
                for target in targets {
                    if let Some(own) = self.targets.get_mut(usize::from(target.channel)) {
                        *own = target.amplitude;
                    }
                }
                self.follow = Follow::Targets;
            }
            Command::Hold => self.follow = Follow::Nothing,
            Command::Query => {}
            Command::Watch {
                host_clock_us,
                silence_ticks,
            } => {
                self.host_clock_us = *host_clock_us;
                self.silence_ticks = *silence_ticks;
            }
            Command::Restart => self.restart(),
        }
    }

    fn restart(&mut self) {
        self.state = InverseState::new(&self.parts.solver);
        self.follow = Follow::Goals;
        let rest = self.parts.solver.parts().rest;
        self.goals = [[0; 3]; MOST_EFFECTORS];
        for (goal, rest) in self.goals.iter_mut().zip(rest) {
            *goal = *rest;
        }
        self.targets = [0; MOST_ACTUATORS];
        (self.host_clock_us, self.silence_ticks, self.silent_for) = (0, 0, 0);
    }

    /// One tick: moves the amplitudes, poses the control points, deforms the model.
    pub fn advance(&mut self) -> Moved {
        let is_silent = self.silence_ticks != 0 && self.silent_for >= self.silence_ticks;
        let mut moved = Moved {
            is_silent,
            is_held: is_silent || self.follow == Follow::Nothing,
            silence_begins: is_silent && self.silent_for == self.silence_ticks,
            ..Moved::default()
        };
        self.silent_for = self.silent_for.saturating_add(1);
        let follow = if moved.is_held {
            Follow::Nothing
        } else {
            self.follow
        };
        match follow {
            Follow::Goals => self.follow_goals(&mut moved),
            Follow::Targets => self.follow_targets(),
            Follow::Nothing => {}
        }
        if follow != Follow::Goals {
            moved.volume = self.parts.volume_at(self.state.amplitudes());
        }
        self.pose(&mut moved);
        self.deform(&mut moved);
        let parts = self.parts.solver.parts();
        let bounds = parts.lower.iter().zip(parts.upper);
        let channels = moved.set_points.iter_mut().zip(self.state.amplitudes());
        for ((own, &amplitude), (&lower, &upper)) in channels.zip(bounds) {
            *own = set_point(amplitude, lower, upper);
        }
        moved
    }

    fn follow_goals(&mut self, moved: &mut Moved) {
        let hold = VolumeGoal::Hold(self.rest_volume);
        let volume = self.parts.volume.as_ref().map(|volume| (volume, hold));
        let goals = self.goals.get(..self.parts.solver.effectors());
        // Goals and modes have the right numbers: `Parts::open` saw to it.
        let ticked = goals.map(|goals| self.parts.solver.tick(goals, volume, &mut self.state));
        if let Some(Ok(report)) = ticked {
            // That of the amplitudes which are kept; 0 if there is none.
            (moved.gave_up, moved.volume) = (report.gave_up.bits(), report.volume);
        }
    }

    /// Every amplitude goes towards its target, at most by its rate and never out of its bounds.
    fn follow_targets(&mut self) {
        let parts = self.parts.solver.parts();
        let mut amplitudes = *self.state.amplitudes();
        let bounds = parts.lower.iter().zip(parts.upper).zip(parts.rates);
        let moving = amplitudes.iter_mut().zip(&self.targets);
        for ((own, &target), ((&lower, &upper), &rate)) in moving.zip(bounds) {
            let target = i64::from(target.clamp(lower, upper));
            let (here, rate) = (i64::from(*own), i64::from(rate));
            // Between two numbers of 32 bits.
            *own = target.clamp(here - rate, here + rate) as i32;
        }
        self.state.set_amplitudes(&amplitudes);
    }

    fn pose(&mut self, moved: &mut Moved) {
        let pose = &mut *self.memory.pose;
        let posed = self.parts.actuation.pose(self.state.amplitudes(), pose);
        moved.saturated = posed.unwrap_or_default();
        moved.pose_hash = checksum::of_points(pose);
    }

    fn deform(&mut self, moved: &mut Moved) {
        let table = &self.parts.table;
        let Memory { pose, piece } = &mut self.memory;
        // The table is that of the pose: `Parts::open` saw to it.
        let (sum, saturated) = checksum::of_model(table, pose, piece).unwrap_or_default();
        moved.skin_hash = sum;
        moved.saturated = moved.saturated.saturating_add(saturated);
        let rows = self.parts.actuation.effector_rows();
        for (&row, goal) in rows.iter().zip(&self.goals) {
            let (row, mut place) = (row as usize, [[0; 3]]);
            // Rows are the table's: `Actuation` was proved for it.
            let _ = table.apply(row..row + 1, pose, &mut place);
            let differences = place.as_flattened().iter().zip(goal);
            let greatest = differences.map(|(own, goal)| own.abs_diff(*goal)).max();
            moved.effector_error = moved.effector_error.max(greatest.unwrap_or(0));
        }
    }
}
