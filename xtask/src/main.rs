//! Runs the jobs of octruss.
fn main() {}
