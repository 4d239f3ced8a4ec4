//! What one point of solid matter does: pressure, strength, failure, sound speeds, and the shock waves that
//! follow from them in closed form.
//!
//! Everything here is scalar or a small array; nothing knows of particles, grids or files.
//!
//! # Conventions
//!
//! SI units. Stress is positive in tension, pressure positive in compression: `σ = -P I + S`. The
//! specific internal energy `e` is counted from the reference state `ρ = ρ0, P = 0` and
//! holds all of the internal energy, that of elastic shear included.
//!
//! # Rooms
//!
//! | module | question it answers |
//! |---|---|
//! | [`material`] | the whole material: reference density and one choice of each model |
//! | [`eos`] | `P(ρ, e)` and the exact sound speed of each equation of state |
//! | [`strength`] | elasticity, von Mises yield, return to the yield surface |
//! | [`failure`] | what happens when the tensile strength is passed: cut-off or growth of voids |
//! | [`spin`] | how a stress deviator turns with the matter (Jaumann rate) |
//! | [`sound`] | which sound speed a contact between particles uses |
//! | [`jump`] | states on both sides of a shock, and the residuals of its three conservation laws |
//! | [`hugoniot`] | exact waves ahead of a piston: elastic, two-wave, overdriven |
//! | [`porous`] | jump conditions of a porous medium: shut pores, snow-plow, P-α curve |
//! | [`library`] | named materials, each number with its unit and source |
//!
//! # Example
//!
//! ```
//! use sph_materials::library;
//!
//! let copper = library::material("porous-copper")?;
//! let pressure = copper.pressure(9_000.0, 0.0);
//! assert!(pressure > 0.0 && copper.longitudinal_sound_speed(9_000.0, 0.0) > 4_000.0);
//! # Ok::<(), sph_materials::LibraryError>(())
//! ```

// Units in brackets, such as [Pa], read as links to rustdoc.
#![allow(rustdoc::broken_intra_doc_links)]

pub mod eos;
pub mod error;
pub mod failure;
pub mod hugoniot;
pub mod jump;
pub mod library;
pub mod material;
pub mod porous;
mod root;
mod shock;
pub mod sound;
pub mod spin;
pub mod strength;

pub use eos::EquationOfState;
pub use error::{HugoniotError, LibraryError, MaterialError};
pub use failure::{Damage, Failure, TensileState, VoidGrowth};
pub use jump::{Jump, ShockState};
pub use material::Material;
pub use sound::SoundSpeedModel;
pub use strength::Strength;

/// The example of the README, compiled by the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
