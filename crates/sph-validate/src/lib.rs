//! Problems with known answers, errors against them, gates.
//!
//! A suite ([`suites`]) sets up one problem, runs it with the real program and measures it ([`metric`]) against a
//! reference solution that shares no code with the particle method ([`mod@reference`]): the exact elastic-plastic Riemann
//! solution, or a converged one-dimensional Lagrangian solution. The figures are held against gates ([`gate`]), which
//! are data in `validation/<suite>/gates.ron`, and reported ([`report`], [`summary`], [`plots`]). The binary
//! `sph-validate` and the tests run the same code ([`runner`]).
//!
//! ```no_run
//! use sph_validate::case::{Case, SchemeName, SuiteName};
//!
//! let case = Case { suite: SuiteName::Riemann, scheme: SchemeName::TkcHancock, n: 100 };
//! let outcome = sph_validate::suites::run(case, &|_| ())?;
//! println!("{:?}", outcome.measurements);
//! # Ok::<(), sph_validate::error::ValidateError>(())
//! ```

// Units in brackets, such as [Pa], read as links to rustdoc.
#![allow(rustdoc::broken_intra_doc_links)]

pub mod case;
pub mod disorder;
pub mod error;
pub mod gate;
pub mod metric;
pub mod plots;
pub mod reference;
pub mod report;
pub mod runner;
pub mod suites;
pub mod summary;
