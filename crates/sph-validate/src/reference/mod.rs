//! Reference solutions: nothing here uses particles.

pub mod beam;
pub mod ideal_gas;
pub mod lagrangian;
pub mod riemann;
pub mod staircase;
pub mod verney;
