//! What a zone goes through in one step: its volume, its rates, its deviator and its energy.
//!
//! Units are SI, stress is positive in tension; the equations stand in the module above. Nodes and their forces are not known
//! here.

use super::{Scheme, Solid, Symmetry, Zone};

/// Volume of a zone per unit area, per unit depth and radian, or per steradian.
pub(super) fn area(symmetry: Symmetry, r: &[f64]) -> f64 {
    match symmetry {
        Symmetry::Planar => r[1] - r[0],
        Symmetry::Cylindrical => 0.5 * (r[1] + r[0]) * (r[1] - r[0]),
        Symmetry::Spherical => (r[0] * r[0] + r[0] * r[1] + r[1] * r[1]) * (r[1] - r[0]) / 3.0,
    }
}

/// Strain rates D_rr and D_θθ [1/s] of a zone, and its volume change in the step.
pub(super) struct Rates {
    radial: f64,
    hoop: f64,
    /// Hoop rate of the third direction: that of the second around a point, zero else.
    third: f64,
    /// Volume at the end over volume at the beginning [-].
    expansion: f64,
}

impl Rates {
    /// Those of a zone between two nodes, in the middle of the step.
    pub(super) fn at_half_step(symmetry: Symmetry, r: &[f64], u: &[f64], tau: f64) -> Self {
        let half = [r[0] + 0.5 * tau * u[0], r[1] + 0.5 * tau * u[1]];
        let end = [r[0] + tau * u[0], r[1] + tau * u[1]];
        let radial = (u[1] - u[0]) / (half[1] - half[0]);
        let growth = |k: i32| (half[1].powi(k) * u[1] - half[0].powi(k) * u[0]) / area(symmetry, &half);
        let (hoop, third) = match symmetry {
            Symmetry::Planar => (0.0, 0.0),
            Symmetry::Cylindrical => ((u[0] + u[1]) / (half[0] + half[1]), 0.0),
            Symmetry::Spherical => {
                let hoop = 0.5 * (growth(2) - radial);
                (hoop, hoop)
            }
        };
        Self { radial, hoop, third, expansion: area(symmetry, &end) / area(symmetry, r) }
    }
}

/// The zone at the end of the step: deviator with von Mises return, energy with the mean stress of the step.
pub(super) fn advanced(zone: &Zone, solid: &Solid<'_>, rates: &Rates, viscous: f64, tau: f64) -> Zone {
    let mean = (rates.radial + rates.hoop + rates.third) / 3.0;
    let rate = [rates.radial - mean, rates.hoop - mean, rates.third - mean];
    let trial: [f64; 3] =
        std::array::from_fn(|a| zone.deviator[a] + 2.0 * solid.shear_modulus * rate[a] * tau);
    let mises = (1.5 * trial.iter().map(|s| s * s).sum::<f64>()).sqrt();
    let factor = if mises > solid.yield_strength { solid.yield_strength / mises } else { 1.0 };
    let deviator = trial.map(|s| factor * s);

    let density = zone.density / rates.expansion;
    let shear_work: f64 = (0..3).map(|a| 0.5 * (zone.deviator[a] + deviator[a]) * rate[a] * tau).sum();
    let specific_volume_change = 1.0 / density - 1.0 / zone.density;
    let mean_volume = 0.5 * (1.0 / density + 1.0 / zone.density);
    let before = (solid.pressure)(zone.density, zone.energy);
    let work_against = |after: f64| {
        zone.energy + mean_volume * shear_work - (0.5 * (before + after) + viscous) * specific_volume_change
    };
    // Two passes solve the implicit mean pressure to third order in the step.
    let guess = work_against(before);
    let energy = work_against((solid.pressure)(density, work_against((solid.pressure)(density, guess))));
    Zone { density, energy, deviator }
}

/// Artificial viscosity of a zone that closes [Pa].
pub(super) fn viscous_pressure(scheme: &Scheme, solid: &Solid<'_>, density: f64, u: &[f64]) -> f64 {
    let closing = (u[0] - u[1]).max(0.0);
    let viscosity = scheme.viscosity;
    density * closing * (viscosity.quadratic * closing + viscosity.linear * solid.sound_speed)
}
