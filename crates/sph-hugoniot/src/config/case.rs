//! A case: everything that a run needs, checked, in SI.

use std::path::PathBuf;

use serde::Serialize;
use sph_materials::Material;
use sph_riemann::Settings;
use sph_window::{InletKind, Search};

use crate::zone::AutoLength;

pub use super::medium::{Medium, Packing, Pores};

/// A case that can be run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// What it is called in reports.
    pub name: String,
    /// The solid between the pores; with several materials the first.
    pub material: Material,
    /// Further materials; particles name them from 1 on.
    pub further_materials: Vec<Material>,
    /// Cell, pores and particles.
    pub medium: Medium,
    /// How the equations are solved.
    pub scheme: Settings,
    /// The moving window.
    pub window: WindowCase,
    /// How the frame in which the front stands is found.
    pub search: Search,
    /// Particle velocities u_p [m/s], rising; with a refinement those of the first round.
    pub points: Vec<f64>,
    /// How further points are chosen from finished ones; `None`: there are no further ones.
    pub refinement: Option<Refinement>,
    /// When a point has settled.
    pub stop: Stop,
    /// Measured curves to lay beside the computed one.
    pub data: Vec<DataSource>,
    /// What is written.
    pub output: Output,
}

/// When points are added between finished ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Refinement {
    /// Relative error of linear interpolation of u_s between neighbors [-].
    pub tolerance: f64,
    /// Points at most.
    pub max_points: usize,
}

/// A measured curve.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub enum DataSource {
    /// Pressed copper powder: the compaction curve of Boade (1970).
    Boade1970,
    /// Points from a CSV file.
    Csv {
        /// The file.
        file: PathBuf,
        /// Name in the legend, if given.
        name: Option<String>,
    },
}

impl Case {
    /// All materials, in the order of the particles' indices.
    pub fn materials(&self) -> Vec<Material> {
        std::iter::once(&self.material).chain(&self.further_materials).cloned().collect()
    }

    /// The material if there is but one: theory of one solid with pores then holds.
    pub(crate) fn single_material(&self) -> Option<&Material> {
        self.further_materials.is_empty().then_some(&self.material)
    }
}

/// The moving window.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WindowCase {
    /// Length in cells; `None`: from u_p.
    pub cells: Option<usize>,
    /// The length from u_p, where none is given.
    pub automatic: AutoLength,
    /// Width of the inlet and of each outlet region [D].
    pub region_width: f64,
    /// What is imposed at the inlet.
    pub inlet: InletKind,
    /// Wanted place of the front as a part of the length [-].
    pub front_place: f64,
}

impl WindowCase {
    /// Length of the window at u_p [m/s], in cells: as given, else what the medium needs to relax (`zone`).
    pub fn cells_at(&self, particle_velocity: f64) -> usize {
        self.cells.unwrap_or_else(|| self.automatic.cells_at(particle_velocity))
    }
}

/// When a point has settled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stop {
    /// Cells fed before the first block; `None`: until the window sees that the start-up material has left.
    pub startup_cells: Option<usize>,
    /// Cells fed in a block.
    pub block_cells: usize,
    /// Successive blocks that must agree.
    pub blocks: usize,
    /// Relative agreement of u_s between blocks [-].
    pub tolerance: f64,
    /// Cells fed at most.
    pub max_fed_cells: usize,
}

impl Stop {
    /// About how many cells are fed before the first block in a window of `window_cells` cells.
    ///
    /// While the front runs to its place it leaves half a window of compacted start-up material behind; that takes
    /// about as long to leave as the front took.
    pub(crate) fn startup_at(&self, window_cells: usize) -> usize {
        self.startup_cells.unwrap_or(window_cells)
    }

    /// Fewest cells that a point feeds in a window of `window_cells` cells.
    pub(crate) fn least_fed_cells(&self, window_cells: usize) -> usize {
        self.startup_at(window_cells) + self.blocks * self.block_cells
    }
}

/// What is written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Output {
    /// Folder of the results.
    pub directory: String,
    /// Profile bins in a cell.
    pub bins_per_cell: usize,
    /// Field images.
    pub images: bool,
    /// A series of moments for ParaView; `None`: none.
    pub snapshots: Option<Snapshots>,
}

/// A series of moments of each point for ParaView.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Snapshots {
    /// Cells that the front sweeps between two moments [-].
    pub every_cells: f64,
    /// What a point may write [bytes].
    pub limit_bytes: f64,
}
