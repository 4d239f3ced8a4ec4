//! Reference solutions: nothing here uses particles.

pub mod lagrangian;
pub mod riemann;
pub mod verney;
