//! Runs the steps of a job one by one, names each and prints how long it took.

use std::time::{Duration, Instant};

use crate::command::Failure;

/// The steps of a job that have been done.
#[derive(Default)]
pub struct Steps {
    done: Vec<(&'static str, Duration)>,
}

impl Steps {
    /// Runs one step. The first that fails ends the job.
    pub fn step(
        &mut self,
        name: &'static str,
        work: impl FnOnce() -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        println!("\n== {name}");
        let started = Instant::now();
        work().map_err(|failure| format!("{name}: {failure}"))?;
        self.done.push((name, started.elapsed()));
        Ok(())
    }

    /// Prints the time of each step.
    pub fn print_times(&self) {
        println!("\nTime of each step:");
        for (name, time) in &self.done {
            println!("  {:6.1} s  {name}", time.as_secs_f32());
        }
        let sum: Duration = self.done.iter().map(|(_, time)| *time).sum();
        println!("  {:6.1} s  in all", sum.as_secs_f32());
    }
}
