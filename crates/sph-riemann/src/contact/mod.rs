//! Solvers of the Riemann problem at the contact of two particles: one file a solver, scalars only.

pub mod acoustic;
