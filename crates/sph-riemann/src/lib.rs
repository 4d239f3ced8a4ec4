//! Godunov-type smoothed particle hydrodynamics for elastic-plastic solids: contact, reconstruction, rates, one step.

pub mod contact;
pub mod dimension;
pub mod error;
pub mod limiter;
pub mod pass;
pub mod prepare;
pub mod record;
pub mod restart;
pub mod scheme;
pub mod simulation;
pub mod stage_times;
pub mod surface;
pub mod time_step;
pub mod update;
pub mod volume;

pub use dimension::SolidDimension;
pub use error::{SetupError, StepError};
pub use limiter::Limiter;
pub use restart::Clock;
pub use scheme::{Scheme, Settings, SurfaceTreatment, VolumeConsistency};
pub use simulation::{Simulation, StepReport, Totals};
pub use stage_times::{StageTimes, StepStage};
pub use time_step::TimeStepReason;
