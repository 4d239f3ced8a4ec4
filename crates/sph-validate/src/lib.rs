//! Problems with known answers, errors against them, gates.
//!
//! A suite sets up one problem, runs it with the real program and measures its errors against a reference solution
//! that shares no code with the particle method: the exact elastic-plastic Riemann solution
//! ([`reference::riemann`]) or a converged one-dimensional Lagrangian solution ([`reference::lagrangian`]).

pub mod reference;
