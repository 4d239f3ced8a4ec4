//! The printed rules for free surfaces: I in place of L⁻¹ at boundary particles and beside them.
//!
//! A particle is on the boundary where the least eigenvalue of **L** (as the rule's source has it) or of **L⁻¹** (as the
//! paper prints it) is below 0.75. I stands for L⁻¹ there, within a smoothing length of such particles, and where det L
//! is below a floor; see [`sph_core::correction`]. The spectral cap needs no rule.
//!
//! Plain code for one particle at a time: these rules are kept for comparison.

use rayon::prelude::*;
use sph_core::correction::{Neighbor, SurfaceRule, gradient_matrix, within_smoothing_length};
use sph_core::lanes::{LANES, Line};
use sph_core::matrix::SquareMatrix;
use sph_core::neighbors::NeighborLists;

use crate::dimension::SolidDimension;
use crate::pass::Sizes;
use crate::record::State;
use crate::scheme::{Settings, SurfaceTreatment};

/// Boundary particle.
const BOUNDARY: f64 = 1.0;
/// Not on the boundary, but without an inverse that could be trusted.
const SINGULAR: f64 = 0.9;
/// Within a smoothing length of the boundary.
const NEAR: f64 = 0.8;

/// Marks the particles that get I for L⁻¹ with numbers above one half; `None` where the treatment has no rule. `size`
/// has one entry a record.
pub fn marks<D: SolidDimension>(
    lists: &NeighborLists<D>,
    settings: &Settings,
    state: &[Line],
    sizes: Sizes<'_>,
    marks: &mut Vec<f64>,
) -> bool {
    let (rule, determinant_floor) = match settings.surface {
        SurfaceTreatment::Printed { determinant_floor } => (SurfaceRule::Printed, determinant_floor),
        SurfaceTreatment::Intended { determinant_floor } => (SurfaceRule::Intended, determinant_floor),
        SurfaceTreatment::None | SurfaceTreatment::SpectralCap { .. } => return false,
    };
    let cloud = Cloud { lists, settings, state, sizes };
    marks.resize(lists.n_padded(), 0.0);
    marks.par_iter_mut().enumerate().for_each(|(i, mark)| {
        *mark = 0.0;
        if i < lists.n_particles() {
            let matrix = cloud.matrix(i);
            if rule.marks(matrix) {
                *mark = BOUNDARY;
            } else if matrix.determinant() < determinant_floor {
                *mark = SINGULAR;
            }
        }
    });
    let boundary: Vec<bool> = marks.iter().map(|&m| m == BOUNDARY).collect();
    marks.par_iter_mut().take(lists.n_particles()).enumerate().for_each(|(i, mark)| {
        let near = |j: u32| boundary[lists.owner(j as usize)] && cloud.within_smoothing_length(i, j as usize);
        if *mark == 0.0 && lists.neighbors(i).any(near) {
            *mark = NEAR;
        }
    });
    true
}

struct Cloud<'a, D: SolidDimension> {
    lists: &'a NeighborLists<D>,
    settings: &'a Settings,
    state: &'a [Line],
    sizes: Sizes<'a>,
}

impl<D: SolidDimension> Cloud<'_, D> {
    fn number(&self, record: usize, k: usize) -> f64 {
        self.state[record * D::STATE_LINES + k / LANES].0[k % LANES]
    }

    fn offset(&self, i: usize, j: usize) -> D::Vector {
        D::vector(|a| self.number(j, a) - self.number(i, a))
    }

    fn smoothing_length(&self, i: usize, j: usize) -> f64 {
        self.settings.smoothing * (self.sizes.of(i) + self.sizes.of(j))
    }

    fn within_smoothing_length(&self, i: usize, j: usize) -> bool {
        use sph_core::dimension::Vector;
        within_smoothing_length(self.offset(i, j).length(), self.smoothing_length(i, j))
    }

    fn matrix(&self, i: usize) -> SquareMatrix<D> {
        gradient_matrix(self.lists.neighbors(i).map(|j| {
            let j = j as usize;
            let volume = self.number(j, State::volume::<D>());
            Neighbor::new(self.settings.kernel, self.offset(i, j), self.smoothing_length(i, j), volume)
        }))
    }
}
