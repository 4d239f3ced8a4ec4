//! Godunov-type smoothed particle hydrodynamics for elastic-plastic solids: contact, reconstruction, rates, one step.
//!
//! ```text
//! dε_i/dt = 2 Σ V_j (U*_ij - U_i)·K_i ∇_iW_ij                                            (paper eq. (9))
//! dU_i/dt = -2 Σ m_j t*_ij W'_ij/(ρ_i ρ_j h_ij)                                          (paper eq. (10))
//! dE_i/dt = -2 Σ m_j (t*_ij·U*_ij) W'_ij/(ρ_i ρ_j h_ij)                                  (paper eq. (11))
//! ```
//!
//! Each pair of particles meets in a Riemann problem ([`contact`]) between values reconstructed from corrected gradients
//! ([`limiter`], [`pass`]); the named schemes ([`Scheme`]) share one step, which stands in [`simulation`].
//!
//! | room | what is in it |
//! |---|---|
//! | [`contact`] | the acoustic contact, scalars only |
//! | [`limiter`] | slope limiters |
//! | [`scheme`] | what can be chosen: scheme, limiter, kernel, θ, Courant number, surfaces, volume consistency |
//! | [`pass`] | pair loops in lanes: gradients and half step, contacts, time-centering |
//! | [`matter`] | materials in lanes |
//! | [`prepare`], [`update`] | equations of state and records before the pair loops; the state at the end of the step and, in one go, the records of the next |
//! | [`surface`], [`volume`] | printed rules at free surfaces; density kept at that of the packing |
//! | [`time_step`], [`stage_times`], [`interventions`], [`restart`], [`error`] | what their names say |
//!
//! Units are SI; stress is positive in tension, pressure in compression; the plane is plane strain, with masses and
//! energies per meter of depth. This crate does not know where particles enter or leave, and touches no files.
//!
//! Invariants, each held by a test: momentum and total energy of a closed system are conserved to round-off; results
//! have the same bits for any number of threads and any set of instructions, and after a restart; a step between two
//! rebuilds of the lists allocates nothing.
//!
//! A block of copper that flies apart, a step of it:
//!
//! ```
//! use glam::DVec2;
//! use sph_core::{Dim2, Domain, Particle, Particles};
//! use sph_riemann::{Settings, Simulation};
//!
//! let copper = sph_materials::library::material("porous-copper")?;
//! let (size, density) = (1e-6, copper.reference_density);
//! let mut particles = Particles::<Dim2>::default();
//! for k in 0..100_u64 {
//!     let place = DVec2::new((k % 10) as f64 - 4.5, (k / 10) as f64 - 4.5) * size;
//!     let at_rest = Particle::at_rest(k, place, density * size * size, size, density);
//!     particles.push(Particle { velocity: place * 1e6, ..at_rest });
//! }
//! let mut simulation = Simulation::new(Domain::open(), vec![copper], particles, Settings::default())?;
//! let energy = |s: &Simulation<Dim2>| s.totals().kinetic_energy + s.totals().internal_energy;
//! let before = energy(&simulation);
//! let report = simulation.step()?;
//! assert!(report.time_step > 0.0);
//! assert!((energy(&simulation) / before - 1.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source: Rublev & Murzov, arXiv 2410.14646; Parshikov & Medin, J. Comput. Phys. 180 (2002) 358.

mod check;
pub mod contact;
pub mod dimension;
pub mod error;
pub mod interventions;
pub mod limiter;
pub mod matter;
pub mod pass;
pub mod prepare;
pub mod record;
pub mod restart;
pub mod scheme;
pub mod simulation;
pub mod stage_times;
mod stages;
pub mod surface;
pub mod time_step;
pub mod update;
pub mod volume;

pub use dimension::SolidDimension;
pub use error::{SetupError, StepError};
pub use interventions::Interventions;
pub use limiter::Limiter;
pub use restart::Clock;
pub use scheme::{FaceClosure, PackingReference, Scheme, Settings, SurfaceTreatment, VolumeConsistency};
pub use simulation::{Simulation, StepReport, Totals};
pub use stage_times::{StageTimes, StepStage};
pub use time_step::TimeStepReason;

/// The example of the README, compiled by the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
