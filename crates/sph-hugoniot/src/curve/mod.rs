//! The Hugoniot as a curve: fits, theory and measurements beside it, and what other programs take over.
//!
//! | module | what it gives |
//! |---|---|
//! | [`points`] | the finished points in all planes, with errors |
//! | [`fit`] | linear, quadratic and two-piece fits of u_s(u_p), with covariance and χ² |
//! | `theory` | the solid, shut pores, snow-plow, P-α, and Boade's powder |
//! | `crush` | a crush curve α(P) calibrated on the points |
//! | [`measured`] | measured points from CSV files |
//! | `least_squares` | the fits' own linear algebra |

pub(crate) mod crush;
pub mod fit;
pub(crate) mod least_squares;
pub mod measured;
pub mod points;
pub(crate) mod theory;
