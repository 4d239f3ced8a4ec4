//! Problems with known answers, errors against them, gates.
//!
//! A suite ([`suites`]) sets up one problem, runs it with the real program and measures it ([`metric`]) against a
//! reference solution that shares no code with the particle method ([`mod@reference`]): the exact elastic-plastic Riemann
//! solution, or a converged one-dimensional Lagrangian solution. The figures are held against gates ([`gate`]), which
//! are data in `validation/<suite>/gates.ron`, and reported ([`report`], `summary`, `plots`). The binary
//! `sph-validate` and the tests run the same code ([`runner`]).
//!
//! ```
//! use sph_validate::case::{Case, SchemeName};
//! use sph_validate::{suites, watch::Watch};
//!
//! let case = Case::new("riemann", SchemeName::TkcHancock, 50);
//! let suite = suites::find("riemann").expect("it is in the list");
//! let outcome = suite.run(&case, Watch::silent())?;
//! assert!(outcome.figure("stress_l1").is_some_and(|figure| figure.value < 0.1));
//! # Ok::<(), sph_validate::error::ValidateError>(())
//! ```

// Units in brackets, such as [Pa], read as links to rustdoc.
#![allow(rustdoc::broken_intra_doc_links)]

pub mod case;
pub mod cli;
pub mod conservation;
pub mod error;
pub mod gate;
pub mod metric;
pub mod outcome;
mod page;
mod plots;
mod provenance;
pub mod reference;
pub mod report;
mod run;
pub mod runner;
mod store;
pub mod suites;
mod summary;
pub mod user;
pub mod watch;
