//! How long work tells how far it is.

/// Receives the progress of long work. Every method may do nothing.
pub trait Progress {
    /// A stage of so many steps begins; the one before has ended.
    fn stage(&mut self, name: &str, steps: usize);
    /// One more step of the stage is done.
    fn step(&mut self);
    /// The last stage has ended.
    fn finish(&mut self);
}

/// Tells nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&mut self, _name: &str, _steps: usize) {}
    fn step(&mut self) {}
    fn finish(&mut self) {}
}
