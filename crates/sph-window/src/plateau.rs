//! The shock velocity from the mass balance of the plateau behind the front.
//!
//! Mass conservation across a front that moves with `v_f` in the box, between the medium ahead (density
//! `ρ00`, velocity `-u_b`) and matter behind it (packing density `ρ`, velocity `u_x`),
//! `ρ00(u_b + v_f) = ρ(v_f - u_x)`, gives
//!
//! ```text
//! u_s = u_b + v_f = Σ ρ (u_b + u_x) / Σ (ρ - ρ00)
//! ```
//!
//! in any frame, from sums over the plateau alone: independent of the front's place, and hardly noisy. It holds where the
//! plateau is steady; both estimates must agree.

use crate::profile::Slab;
use crate::region::Regions;
use crate::settings::PlateauMargins;
use serde::{Deserialize, Serialize};

/// Bounds of the plateau [m] for a front at a place [m]; `None` when it is shorter than ten particle sizes.
pub(crate) fn bounds(
    front: f64,
    regions: &Regions,
    margins: &PlateauMargins,
    particle_size: f64,
) -> Option<(f64, f64)> {
    let from = regions.outlet_end + margins.outlet * particle_size;
    let to = front - margins.front * particle_size;
    (to - from >= 10.0 * particle_size).then_some((from, to))
}

/// Sums over the plateau and over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MassBalance {
    flow: f64,
    compaction: f64,
}

impl MassBalance {
    /// Adds the plateau of one moment, which stands for a duration [s]. Moments are not equally far apart: steps are short
    /// while a pore shuts, and a plain mean would count those moments too often (0.5 % of the shock velocity in
    /// strengthless copper at 300 m/s).
    pub fn observe(&mut self, plateau: &Slab, inlet_velocity: f64, medium_density: f64, duration: f64) {
        self.flow += duration * (plateau.mass * inlet_velocity + plateau.momentum);
        self.compaction += duration * (plateau.mass - medium_density * plateau.length);
    }

    /// Shock velocity [m/s]; `None` before anything was compacted.
    pub fn shock_velocity(&self) -> Option<f64> {
        (self.compaction > 0.0).then(|| self.flow / self.compaction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::RegionWidths;

    #[test]
    fn the_balance_is_exact_in_any_frame() {
        let (shock, piston, rho00) = (940.0, 250.0, 6637.0);
        let rho = rho00 * shock / (shock - piston);
        for inlet_velocity in [250.0, 940.0, 1300.0] {
            let velocity = piston - inlet_velocity;
            let plateau =
                Slab { length: 3e-5, mass: rho * 3e-5, momentum: rho * 3e-5 * velocity, ..Slab::default() };
            let mut balance = MassBalance::default();
            assert_eq!(balance.shock_velocity(), None);
            balance.observe(&plateau, inlet_velocity, rho00, 1e-9);
            assert!((balance.shock_velocity().unwrap() - shock).abs() < 1e-8);
        }
    }

    /// A plateau whose density is high for a short and low for a long time: the mean over time counts, not over moments.
    #[test]
    fn moments_weigh_as_long_as_they_last() {
        let rho00 = 6637.0;
        let slab = |rho: f64, u: f64| Slab {
            length: 3e-5,
            mass: rho * 3e-5,
            momentum: rho * 3e-5 * u,
            ..Slab::default()
        };
        let (mut once, mut twice) = (MassBalance::default(), MassBalance::default());
        once.observe(&slab(9000.0, -700.0), 940.0, rho00, 3e-10);
        once.observe(&slab(9200.0, -690.0), 940.0, rho00, 1e-10);
        for duration in [1e-10, 2e-10] {
            twice.observe(&slab(9000.0, -700.0), 940.0, rho00, duration);
        }
        twice.observe(&slab(9200.0, -690.0), 940.0, rho00, 1e-10);
        let [once, twice] = [once, twice].map(|balance| balance.shock_velocity().unwrap());
        assert!((once - twice).abs() < 1e-9, "{once} {twice}");
    }

    #[test]
    fn a_short_plateau_is_none() {
        let regions = Regions::new(2e-4, &RegionWidths::default(), 1e-6);
        let margins = PlateauMargins::default();
        assert_eq!(bounds(6e-5, &regions, &margins, 1e-6), None);
        let (from, to) = bounds(1e-4, &regions, &margins, 1e-6).unwrap();
        assert!((from - 1.8e-5).abs() < 1e-15 && (to - 6e-5).abs() < 1e-15);
    }
}
