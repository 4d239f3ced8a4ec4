//! What a run leaves in its folder.
//!
//! ```text
//! report.html         everything on one page
//! case.ron            the case file, as it was read
//! case.json           the resolved case in SI
//! hugoniot.csv, .json the table of all finished points
//! points/up_0100/     profile, history, monitors and blocks (and search) .csv of one point; its outcome, or its last states
//!                     (crate::restart)
//! curve/              the curve in all planes, fits, P-α parameters ([`export`])
//! plots/              hugoniot, profiles, histories, fields
//! ```
//!
//! The table is written anew after each finished point, atomically: whatever ends a run, what was computed is there.

pub mod belief;
pub mod curves;
pub mod earlier;
pub mod export;
pub mod html;
pub mod machine;
pub mod monitors;
pub mod planes;
pub mod plots;
pub mod point_tables;
pub mod profile_plots;
pub mod summary;
pub mod table;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use self::curves::Curves;
use crate::config::Case;
use crate::microstructure::{Sample, picture};
use crate::outcome::{PointOutcome, file_stem};

/// The folder of a run.
#[derive(Clone, Debug)]
pub struct Report {
    folder: PathBuf,
}

impl Report {
    /// Makes the folder and puts the case into it.
    ///
    /// # Errors
    /// If a file or folder cannot be written.
    pub fn create(folder: &Path, case: &Case, case_text: &str) -> Result<Self> {
        for part in ["", "plots", "points"] {
            let path = folder.join(part);
            std::fs::create_dir_all(&path)
                .with_context(|| format!("{}: the folder cannot be made", path.display()))?;
        }
        sph_io::write_atomic(folder.join("case.ron"), case_text.as_bytes())?;
        sph_io::write_atomic(folder.join("case.json"), earlier::case_json(case)?.as_bytes())?;
        Ok(Self { folder: folder.to_path_buf() })
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Folder of one point.
    pub fn point_folder(&self, particle_velocity: f64) -> PathBuf {
        self.folder.join("points").join(file_stem(particle_velocity))
    }

    /// Writes the table of the points that are finished.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write_table(&self, case: &Case, sample: &Sample, outcomes: &[&PointOutcome]) -> Result<()> {
        let table = table::hugoniot(case, sample, outcomes);
        table.write_csv(self.folder.join("hugoniot.csv"))?;
        Ok(table.write_json(self.folder.join("hugoniot.json"))?)
    }

    /// Writes the tables and pictures of one point.
    ///
    /// # Errors
    /// If a file or folder cannot be written.
    pub fn write_point(&self, case: &Case, outcome: &PointOutcome) -> Result<()> {
        let stem = outcome.file_stem();
        let folder = self.point_folder(outcome.particle_velocity);
        std::fs::create_dir_all(&folder)?;
        if !outcome.profile.is_empty() {
            table::profile(outcome).write_csv(folder.join("profile.csv"))?;
            self.write_figure(&profile_plots::profile(outcome), &format!("profile_{stem}"))?;
        }
        if !outcome.cell_velocities.is_empty() {
            table::history(outcome).write_csv(folder.join("history.csv"))?;
            self.write_figure(&plots::history(outcome, case.medium.cell), &format!("history_{stem}"))?;
        }
        if !outcome.monitors.is_empty() {
            monitors::table(outcome).write_csv(folder.join("monitors.csv"))?;
        }
        if !outcome.blocks.is_empty() {
            point_tables::blocks(outcome).write_csv(folder.join("blocks.csv"))?;
        }
        if !outcome.search.is_empty() {
            point_tables::search(outcome).write_csv(folder.join("search.csv"))?;
        }
        if case.output.images && !outcome.fields.x.is_empty() {
            profile_plots::fields(outcome).write_png(self.plot(&format!("fields_{stem}.png")))?;
        }
        Ok(())
    }

    /// Writes what is made of all points together: tables, exports, pictures; nothing without a measured one.
    ///
    /// # Errors
    /// If a file or folder cannot be written.
    pub fn write_curves(&self, curves: &Curves<'_>) -> Result<()> {
        if curves.curve.points.is_empty() { Ok(()) } else { curves.write(self) }
    }

    /// Writes the page with everything on it.
    ///
    /// # Errors
    /// If a file or folder cannot be written.
    pub fn write_page(
        &self,
        curves: &Curves<'_>,
        sample: &Sample,
        outcomes: &[&PointOutcome],
        facts: &html::RunFacts,
    ) -> Result<()> {
        if curves.case.output.images {
            picture::write(curves.case, sample, &self.folder.join("sample.png"))?;
        }
        Ok(html::page(curves, sample, outcomes, facts).write(self.folder.join("report.html"))?)
    }

    /// Writes a picture as SVG and PNG.
    pub(crate) fn write_figure(&self, figure: &sph_io::plot::Figure, name: &str) -> Result<()> {
        figure.write_svg(self.plot(&format!("{name}.svg")))?;
        Ok(figure.write_png(self.plot(&format!("{name}.png")))?)
    }

    fn plot(&self, name: &str) -> PathBuf {
        self.folder.join("plots").join(name)
    }
}
