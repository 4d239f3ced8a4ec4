//! The finished points of a run as a curve in all planes.
//!
//! From u_s and u_p the jump conditions give stress and density behind the compaction wave, as they do from an experiment:
//!
//! ```text
//! σ = σ_HEL + ρ00 u_s u_p,      ρ = ρ00 u_s/(u_s - u_p),      V = 1/ρ
//! ```
//!
//! with the standard error of u_s carried along. The averaged profiles give states by another way, without errors; both
//! stand in the table. They agree where the plateau behind the front has come to u_p. Where pores stay open the wave is
//! as wide as the window, the mean over the plateau holds matter that is still being compacted, and its density and stress
//! are lower than those that belong to u_p; the jump conditions do not care, as the wave is steady.
//!
//! Only settled points are measurements: fits and calibrations use them alone.
//!
//! Source: Rublev & Murzov, arXiv 2410.14646, eqs. (28), (29), and section 4 for the standing precursor.

use super::fit::FitPoint;
use crate::outcome::{PointOutcome, Status};

/// A value with its standard error, both in the same unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// Its standard error; `NaN` if unknown.
    pub error: f64,
}

/// One finished point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// u_p that the ends of the window imposed [m/s].
    pub particle_velocity: f64,
    /// u_s [m/s].
    pub shock_velocity: Measured,
    /// -σ_xx ahead of the compaction wave, σ_HEL [Pa].
    pub stress_ahead: f64,
    /// -σ_xx behind it by the jump condition [Pa].
    pub stress: Measured,
    /// Density behind it by the jump condition [kg/m³].
    pub density: Measured,
    /// -σ_xx behind it in the averaged profile [Pa].
    pub profile_stress: f64,
    /// Density of the packing behind it in the averaged profile [kg/m³].
    pub profile_density: f64,
    /// Whether the point settled.
    pub settled: bool,
}

impl CurvePoint {
    /// Volume per mass behind the wave [m³/kg].
    pub fn volume(&self) -> Measured {
        let Measured { value, error } = self.density;
        Measured { value: 1.0 / value, error: error / (value * value) }
    }
}

/// The finished points of a medium, in the order of u_p.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Density ρ00 of the undisturbed medium [kg/m³].
    pub bulk_density: f64,
    /// Mean of σ_HEL over the points [Pa]; zero if no point has one.
    pub precursor_stress: f64,
    /// All points that have a u_s.
    pub points: Vec<CurvePoint>,
}

impl Curve {
    /// The curve of a medium of density ρ00 [kg/m³].
    pub fn new(bulk_density: f64, outcomes: &[&PointOutcome]) -> Self {
        let stresses: Vec<f64> = outcomes.iter().filter_map(|o| o.states).map(|s| -s.ahead.stress).collect();
        let precursor_stress =
            if stresses.is_empty() { 0.0 } else { crate::statistics::mean(&stresses).max(0.0) };
        let measured = outcomes.iter().filter(|o| o.shock_velocity.is_finite());
        let mut points: Vec<CurvePoint> =
            measured.map(|o| point(bulk_density, precursor_stress, o)).collect();
        points.sort_by(|a, b| a.particle_velocity.total_cmp(&b.particle_velocity));
        Self { bulk_density, precursor_stress, points }
    }

    /// The points that settled.
    pub fn settled(&self) -> impl Iterator<Item = &CurvePoint> {
        self.points.iter().filter(|p| p.settled)
    }

    /// The points that settled, to be fitted.
    pub fn to_fit(&self) -> Vec<FitPoint> {
        let fit_point = |p: &CurvePoint| FitPoint {
            particle_velocity: p.particle_velocity,
            shock_velocity: p.shock_velocity.value,
            standard_error: p.shock_velocity.error,
        };
        self.settled().map(fit_point).collect()
    }

    /// Least and greatest u_p [m/s]; `None` without points.
    pub fn range(&self) -> Option<(f64, f64)> {
        Some((self.points.first()?.particle_velocity, self.points.last()?.particle_velocity))
    }
}

fn point(bulk_density: f64, mean_ahead: f64, outcome: &PointOutcome) -> CurvePoint {
    let (u_p, u_s, error) =
        (outcome.effective_particle_velocity, outcome.shock_velocity, outcome.standard_error);
    let stress_ahead = outcome.states.map_or(mean_ahead, |s| -s.ahead.stress);
    let behind = outcome.states.map(|s| s.behind);
    let of = |f: fn(&crate::observe::MeanState) -> f64| behind.as_ref().map_or(f64::NAN, f);
    CurvePoint {
        particle_velocity: u_p,
        shock_velocity: Measured { value: u_s, error },
        stress_ahead,
        stress: Measured {
            value: stress_ahead + bulk_density * u_s * u_p,
            error: bulk_density * u_p * error,
        },
        density: Measured {
            value: bulk_density * u_s / (u_s - u_p),
            error: bulk_density * u_p / (u_s - u_p).powi(2) * error,
        },
        profile_stress: of(|s| -s.stress),
        profile_density: of(|s| s.packing_density),
        settled: outcome.status == Status::Settled,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Points of the shipped case: u_p, u_s, error [m/s], stress jump, σ_HEL [GPa], packing density [g/cm³].
    pub const SHIPPED: [[f64; 6]; 8] = [
        [50.0, 319.37, 0.80, 0.0686, 0.2219, 7.6762],
        [75.0, 367.63, 0.21, 0.1417, 0.2185, 8.1207],
        [100.0, 425.10, 0.47, 0.2471, 0.2113, 8.5493],
        [130.0, 501.13, 0.14, 0.4025, 0.2080, 8.8993],
        [150.0, 571.39, 0.13, 0.5434, 0.2055, 8.9859],
        [200.0, 757.06, 0.06, 0.9716, 0.2012, 9.0098],
        [250.0, 939.58, 0.20, 1.5164, 0.1950, 9.0338],
        [300.0, 1117.74, 0.36, 2.1737, 0.1879, 9.0642],
    ];

    /// Density of the shipped medium [kg/m³].
    pub const DENSITY: f64 = 8960.0 / 1.351_351;

    /// The curve of the shipped case.
    pub fn shipped() -> Curve {
        let points = SHIPPED.map(|[u_p, u_s, error, jump, ahead, packing]| CurvePoint {
            particle_velocity: u_p,
            shock_velocity: Measured { value: u_s, error },
            stress_ahead: 1e9 * ahead,
            stress: Measured { value: 1e9 * ahead + DENSITY * u_s * u_p, error: DENSITY * u_p * error },
            density: Measured {
                value: DENSITY * u_s / (u_s - u_p),
                error: DENSITY * u_p / (u_s - u_p).powi(2) * error,
            },
            profile_stress: 1e9 * (ahead + jump),
            profile_density: 1e3 * packing,
            settled: true,
        });
        Curve { bulk_density: DENSITY, precursor_stress: 0.206e9, points: points.to_vec() }
    }

    /// Where pores are shut; where they are open the plateau has not come to u_p. The stress of the profile lacks the
    /// momentum flux of the motion that is left behind the front, 2 to 4 % of the rise.
    #[test]
    fn states_by_the_jump_conditions_agree_with_those_of_the_profiles() {
        for p in shipped().points.into_iter().filter(|p| p.particle_velocity > 140.0) {
            assert!((p.density.value / p.profile_density - 1.0).abs() < 0.004, "{p:?}");
            assert!((p.stress.value / p.profile_stress - 1.0).abs() < 0.04, "{p:?}");
        }
    }

    #[test]
    fn errors_are_those_of_a_small_change_of_u_s() {
        let mut outcome = PointOutcome::failed(100.0, String::new());
        outcome.effective_particle_velocity = 100.0;
        (outcome.shock_velocity, outcome.standard_error) = (425.0, 0.5);
        let a = Curve::new(DENSITY, &[&outcome]).points[0];
        outcome.shock_velocity += 0.5;
        let b = Curve::new(DENSITY, &[&outcome]).points[0];
        assert!(((b.stress.value - a.stress.value) / a.stress.error - 1.0).abs() < 1e-9);
        assert!(((a.density.value - b.density.value) / a.density.error - 1.0).abs() < 0.01);
        assert!(((b.volume().value - a.volume().value) / a.volume().error - 1.0).abs() < 0.01);
        assert!(!a.settled && Curve::new(DENSITY, &[&outcome]).to_fit().is_empty());
    }

    #[test]
    fn points_without_a_velocity_are_left_out() {
        let failed = PointOutcome::failed(100.0, "too fast".into());
        let curve = Curve::new(DENSITY, &[&failed]);
        assert!(curve.points.is_empty() && curve.range().is_none());
    }
}
