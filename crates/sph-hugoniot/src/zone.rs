//! How long the window must be: from the zone in which the medium relaxes behind the front.
//!
//! Behind a compaction front pores shut over a length that scales with their distance
//!
//! ```text
//! s = √(L H / n)
//! ```
//!
//! for n pores (or inclusions) in a cell of L × H. Whether they shut at all is decided by the stress of the front against
//! the one that makes a thick-walled cylinder yield throughout,
//!
//! ```text
//! P_c = (Y/√3) ln(1/φ),      φ = 1 - 1/m,      u_c = √(P_c/(ρ00 a)),      a = m/(m - 1)
//! ```
//!
//! where `ρ00 a u²` is the stress of a front that shuts all pores. Measured with the shipped porous copper
//! (s = 14.1 µm, u_c = 103 m/s, D = 1 and 2 µm): the zone is 7 to 14 s long up to 130 m/s, where pores stay open, and at
//! most 4.4 s from 150 m/s on. So 17 s stand behind the front up to u_c, and half of that from 2 u_c on. A medium without
//! pores has the numerical width of a front alone: 120 D.
//!
//! What a run then measures is held against it ([`crate::observe::States::warnings`]).
//!
//! Source of P_c: R. Hill, *The Mathematical Theory of Plasticity* (1950), ch. V.

use serde::Serialize;
use sph_materials::{Material, Strength};

use crate::config::case::{Medium, Pores};
use crate::microstructure::layout::Fill;
use crate::microstructure::measure;

/// Length behind the front up to u_c, in distances of the pores; from 2 u_c on half of it.
const OPEN: f64 = 17.0;
/// Length behind the front in a medium without pores [D].
const SOLID: f64 = 120.0;
/// Room ahead of the front: what the state there needs, and half a cell [cells].
const AHEAD: f64 = 4.0;
/// Fewest cells that the front relaxes in [cells].
const FEWEST: f64 = 4.0;

/// Length of the window from u_p.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AutoLength {
    /// Length while pores stay open [cells].
    pub open: f64,
    /// Length when they shut at once [cells].
    pub shut: f64,
    /// u_c, from which on they begin to shut [m/s].
    pub closing: f64,
    /// Length at the least [cells].
    pub least: f64,
}

impl AutoLength {
    /// While the medium is not known, because it has faults: those of the shipped case.
    pub const UNKNOWN: Self = Self { open: 24.0, shut: 12.0, closing: 103.0, least: 8.0 };

    /// For a medium whose front is wanted at a part of the length.
    pub fn new(medium: &Medium, material: &Material, front_place: f64) -> Self {
        let in_cells = |behind: f64| behind / medium.cell / front_place;
        let least = (AHEAD / (1.0 - front_place)).max(FEWEST / front_place).ceil();
        let (open, shut) = match spacing(medium) {
            Some(s) => (in_cells(OPEN * s), in_cells(0.5 * OPEN * s)),
            None => (in_cells(SOLID * medium.particle_size), in_cells(SOLID * medium.particle_size)),
        };
        Self { open, shut, closing: closing_velocity(material, medium.porosity), least }
    }

    /// Whole cells at u_p [m/s].
    pub fn cells_at(&self, particle_velocity: f64) -> usize {
        let shut = (particle_velocity / self.closing - 1.0).clamp(0.0, 1.0);
        // A medium that offers no resistance shuts at once: u_c = 0.
        let shut = if self.closing > 0.0 { shut } else { 1.0 };
        (self.open + shut * (self.shut - self.open)).max(self.least).floor() as usize
    }
}

/// Distance s of pores, else of what else is painted into the solid [m].
fn spacing(medium: &Medium) -> Option<f64> {
    let pores = match medium.pores {
        Pores::None | Pores::Placed => measure::features(medium).pores,
        lattice => lattice.count(),
    };
    let painted = medium.layout.painted.iter().filter(|p| p.fill != Fill::Void).count();
    let count = if pores > 0 { pores } else { painted };
    (count > 0).then(|| (medium.cell * medium.height / count as f64).sqrt())
}

/// Stress P_c at which pores begin to shut [Pa]; zero without strength, infinite without pores.
pub fn crush_stress(material: &Material, porosity: f64) -> f64 {
    let void = 1.0 - 1.0 / porosity;
    match material.strength {
        Strength::PerfectPlastic { yield_strength, .. } => -yield_strength / 3.0_f64.sqrt() * libm::log(void),
        Strength::Fluid | Strength::Elastic { .. } => 0.0,
    }
}

/// u_c [m/s]: zero without strength or without pores.
fn closing_velocity(material: &Material, porosity: f64) -> f64 {
    if porosity <= 1.0 + 1e-9 {
        return 0.0;
    }
    // ρ00 a = (ρ0/m) m/(m - 1)
    let inertia = material.reference_density / (porosity - 1.0);
    (crush_stress(material, porosity) / inertia).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config;

    fn auto(medium: &str) -> AutoLength {
        let text = format!(
            "Case(name: \"x\", material: Library(name: \"porous-copper\"), medium: ({medium}), points: [\"200 m/s\"])"
        );
        config::parse(&text, "x.ron").unwrap().window.automatic
    }

    #[test]
    fn the_shipped_window_is_what_its_pores_need() {
        let law = auto("cell: \"20 um\", pores: CenteredSquare(), porosity: 1.35, particle_size: \"2 um\"");
        assert!((law.closing - 103.0).abs() < 1.0, "{law:?}");
        let cells = [50.0, 100.0, 130.0, 150.0, 200.0, 300.0].map(|u| law.cells_at(u));
        assert_eq!(cells, [24, 24, 20, 18, 12, 12]);
    }

    /// The same medium at twice the scale, or with the cell that holds one pore, wants the same distances of pores.
    #[test]
    fn the_length_goes_with_the_distance_of_the_pores() {
        let length = |medium: &str, cell: f64| auto(medium).open * cell;
        let centered =
            length("cell: \"20 um\", pores: CenteredSquare(), porosity: 1.35, particle_size: \"2 um\"", 20.0);
        let twice =
            length("cell: \"40 um\", pores: CenteredSquare(), porosity: 1.35, particle_size: \"2 um\"", 40.0);
        let square =
            length("cell: \"20 um\", pores: Square(), porosity: 1.35, particle_size: \"2 um\"", 20.0);
        assert!((twice / centered - 2.0).abs() < 1e-12);
        assert!((square / centered - 2.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn few_large_cells_still_leave_room_on_both_sides() {
        let law = auto("cell: \"20 um\", pores: None, particle_size: \"0.5 um\"");
        assert_eq!(law.cells_at(200.0), 8, "{law:?}");
        assert!(law.closing == 0.0 && law.open == law.shut);
    }
}
