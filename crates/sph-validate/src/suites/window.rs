//! What suites with a moving window share: steps, means behind and ahead of the front, the outcome.

use std::time::Instant;

use sph_core::Dim2;
use sph_window::Window;

use crate::case::Case;
use crate::conservation::Conservation;
use crate::error::ValidateError;
use crate::metric::Measurement;
use crate::outcome::{Cost, Curve, Field, Outcome};
use crate::watch::Watch;

/// Means over time of the second half of a run, from the looks at the front; each stands for the time since the last.
#[derive(Clone, Copy, Debug, Default)]
pub struct Averages {
    /// Time that the means are over [s].
    duration: f64,
    /// σ_xx of the plateau behind the front [Pa].
    pub stress: f64,
    /// Density of the packing there, mass over area [kg/m³].
    pub packing_density: f64,
    /// The particles' own density there [kg/m³].
    pub own_density: f64,
    /// σ_xx ahead of the front [Pa].
    pub stress_ahead: f64,
}

impl Averages {
    fn look(&mut self, window: &Window<Dim2>, since_last: f64) {
        let (Some(behind), Some(ahead)) = (window.plateau(), window.ahead()) else { return };
        let profile = window.profile();
        let plateau = profile.between(behind.0, behind.1);
        self.duration += since_last;
        let weight = since_last / self.duration;
        let mean = |old: f64, new: f64| old + weight * (new - old);
        self.stress = mean(self.stress, plateau.stress());
        self.packing_density = mean(self.packing_density, plateau.packing_density());
        self.own_density = mean(self.own_density, plateau.own_density());
        self.stress_ahead = mean(self.stress_ahead, profile.between(ahead.0, ahead.1).stress());
    }

    /// Shock velocity from the front [m/s]; not a number where there is none.
    pub fn front_velocity(&self, window: &Window<Dim2>) -> f64 {
        window.shock_velocity().map_or(f64::NAN, |estimate| estimate.velocity)
    }

    /// Shock velocity from the balance of mass [m/s]; not a number where there is none.
    pub fn balance_velocity(&self, window: &Window<Dim2>) -> f64 {
        window.mass_balance_velocity().unwrap_or(f64::NAN)
    }
}

/// Steps until `length` [m] of the medium has been fed; means of the second half of that.
pub fn advance(
    case: &Case,
    window: &mut Window<Dim2>,
    watch: Watch<'_>,
    length: f64,
) -> Result<Averages, ValidateError> {
    let mut means = Averages::default();
    let mut last = 0.0;
    while window.fed_length() < length {
        watch.check()?;
        let report = window
            .step()
            .map_err(|source| ValidateError::Window { case: case.to_string(), source: Box::new(source) })?;
        if let Some(look) = report.observation {
            let since_last = look.time - last;
            last = look.time;
            watch.tell((window.fed_length() / length).clamp(0.0, 1.0));
            if window.fed_length() > 0.5 * length && window.is_settled() {
                means.look(window, since_last);
            }
        }
    }
    if means.duration == 0.0 {
        let reason = "the front has not settled in the second half of what was fed".into();
        return Err(ValidateError::NotReached { case: case.to_string(), reason });
    }
    Ok(means)
}

/// The outcome of a run with a window: the ledger's largest gap stands for mass, momentum and energy.
pub fn outcome(
    case: &Case,
    window: &Window<Dim2>,
    measurements: Vec<Measurement>,
    curves: Vec<Curve>,
    fields: Vec<Field>,
    started: Instant,
) -> Outcome {
    let gap = window.ledger_residual();
    let simulation = window.simulation();
    Outcome {
        case: case.clone(),
        measurements,
        conservation: Conservation { mass: gap, momentum: gap, energy: gap, angular_momentum: None },
        curves,
        fields,
        cost: Cost {
            particles: simulation.particles().len(),
            steps: window.steps(),
            particle_steps: simulation.particle_steps(),
            seconds: started.elapsed().as_secs_f64(),
        },
    }
}
