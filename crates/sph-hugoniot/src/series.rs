//! A series of moments of a point for ParaView: `output: (snapshots: Every(cells: 0.5))`.
//!
//! A moment each time that the front has swept another part of a cell, as `.vtp`, strung together by a `.pvd`. Which
//! moments are taken depends on the front's way only, so that a run that was stopped and goes on has the same files. A
//! point writes no more than `limit_mb`; that it met the limit is told at the end.

use std::path::Path;

use serde::{Deserialize, Serialize};
use sph_core::Dim2;
use sph_io::IoError;
use sph_io::snapshot::SnapshotSeries;
use sph_window::Window;

use crate::config::case::Snapshots;
use crate::paraview::Moment;

/// Name of the folder within a point's, and of the series.
pub const FOLDER: &str = "snapshots";
/// Bytes of a particle in a file: 45 in the smoke case once it is shocked, and more where fields are rougher.
pub const BYTES_PER_PARTICLE: f64 = 65.0;

/// What was written of a point.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SeriesLog {
    /// Time of each moment [s].
    times: Vec<f64>,
    /// Bytes of all files.
    bytes: u64,
    /// Parts of cells swept at the last moment.
    parts: Option<i64>,
    /// Whether the limit was met.
    is_full: bool,
}

impl SeriesLog {
    /// Writes a moment into the point's folder if one is due; the front has swept `swept_cells` cells.
    ///
    /// # Errors
    /// If the folder cannot be made, or a file not be written.
    pub fn look(
        &mut self,
        settings: &Snapshots,
        window: &Window<Dim2>,
        swept_cells: f64,
        folder: &Path,
    ) -> Result<(), IoError> {
        let parts = (swept_cells / settings.every_cells).floor() as i64;
        if self.is_full || self.parts.is_some_and(|last| parts <= last) {
            return Ok(());
        }
        self.parts = Some(parts);
        let expected = window.simulation().particles().len() as f64 * BYTES_PER_PARTICLE;
        if self.bytes as f64 + expected > settings.limit_bytes {
            self.is_full = true;
            return Ok(());
        }
        let folder = folder.join(FOLDER);
        let moment = Moment::of(window, |_| true);
        let mut series = SnapshotSeries::resume(&folder, FOLDER, &self.times)?;
        let path = series.add(&moment.snapshot())?;
        self.times.push(window.time());
        self.bytes += std::fs::metadata(&path).map_or(0, |m| m.len());
        Ok(())
    }

    /// Number of moments written.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether nothing was written.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Bytes of all files.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Whether the limit was met, and later moments left out.
    pub fn is_full(&self) -> bool {
        self.is_full
    }
}
