//! What a point is looked at for: averaged profiles in the frame of the front, the states ahead of it and behind it,
//! and the particles at the end.

mod fields;
pub(crate) mod precursor;
pub(crate) mod profile;
mod states;

pub use fields::Fields;
pub(crate) use fields::drawn_size;
pub use precursor::Precursor;
pub(crate) use precursor::PrecursorWatch;
pub use profile::Bin;
pub(crate) use profile::{FrontProfile, ProfileGrid};
pub use states::{MeanState, States, Zone};
