//! The fixed period of a control loop.

/// A timer that ticks at a fixed period, whether the loop keeps up or not.
pub trait Tick {
    /// Starts ticking: the first tick comes `period_us` microseconds from now. The period is at
    /// least 1 and at most what the board's timer holds; a longer one is cut to that.
    fn start(&mut self, period_us: u32);

    /// Sleeps until the next tick and returns the number of ticks since the last call: 1 if the
    /// loop kept up (at once, if the tick came a moment ago), more if it missed some.
    fn wait(&mut self) -> u32;

    /// Microseconds since the last tick, counted by the same timer. It starts again with every tick.
    fn elapsed_us(&self) -> u32;
}
