//! The numbers that forms are made of: double precision, and the exact field Q(sqrt d).

mod field;
mod quadratic;
mod solve;

pub use field::Field;
pub use quadratic::Quadratic;
pub(crate) use solve::{QuadraticInteger, common_denominator, solve};
