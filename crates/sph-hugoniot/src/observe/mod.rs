//! What a point is looked at for: averaged profiles in the frame of the front, the states ahead of it and behind it,
//! and the particles at the end.

mod fields;
pub mod precursor;
pub mod profile;
mod states;

pub use fields::{Fields, drawn_size};
pub use precursor::{Precursor, PrecursorWatch};
pub use profile::{Bin, FrontProfile, ProfileGrid};
pub use states::{MeanState, States, Zone};
