//! A crush curve α(P) calibrated on the points of a run.
//!
//! ```text
//! α(P) = 1 + (α0 - 1) ( (P_s - P)/(P_s - P_e) )ⁿ
//! ```
//!
//! Each point gives one pair by the jump conditions: P is -σ_xx behind the wave, σ_HEL included, and α the density of
//! the solid at that stress over the density behind the wave ([`PorousMedium::distension_behind`]). With this P the jump
//! conditions give u_s(u_p) back; the mean pressure is lower by the deviator. α_0 is the porosity of the sample, known
//! exactly; P_e and P_s (and n, in the free form) are fitted.
//!
//! All points count alike: the form misses the points by more than their scatter, so that standard errors would only say
//! which points to miss least. The scatter about the fit gives the errors of the parameters.
//!
//! Source of the form: M. Jutzi, W. Benz & P. Michel, Icarus 198 (2008) 242-255.

use serde::Serialize;
use sph_materials::porous::{CrushCurve, PorousMedium};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::least_squares;
use super::points::{Curve, CurvePoint};

/// α - 1 below which the pores of a point count as shut.
const SHUT: f64 = 2e-3;
/// A gigapascal [Pa].
const GIGA: f64 = 1e9;

/// A calibrated crush curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Calibration {
    /// The curve.
    pub curve: CrushCurve,
    /// Standard error of P_e [Pa].
    pub elastic_pressure_error: f64,
    /// Standard error of P_s [Pa].
    pub solid_pressure_error: f64,
    /// Standard error of n [-]; none where it is given.
    pub exponent_error: Option<f64>,
    /// Points with open pores that were used; (P [Pa], α).
    pub open: Vec<(f64, f64)>,
    /// Points with shut pores; (P [Pa], α).
    pub shut: Vec<(f64, f64)>,
    /// Root mean square of the misfit of α over the open points [-].
    pub misfit: f64,
}

/// Calibrates a curve on the settled points; with `exponent` given P_e and P_s are fitted, else n as well.
///
/// `None` where fewer points have open pores than there are parameters and one, where the solid cannot come to the stress
/// of a point, or where the fit ends at no curve.
pub fn calibrate(curve: &Curve, medium: &PorousMedium, exponent: Option<f64>) -> Option<Calibration> {
    let initial = medium.porosity();
    let state = |p: &CurvePoint| {
        let alpha = medium.distension_behind(p.stress.value, p.density.value).ok()?;
        Some((p.stress.value, alpha))
    };
    let states: Vec<_> = curve.settled().map(state).collect::<Option<_>>()?;
    let (shut, open): (Vec<_>, Vec<_>) = states.into_iter().partition(|(_, alpha)| alpha - 1.0 < SHUT);
    let parameters = 2 + usize::from(exponent.is_none());
    if open.len() <= parameters {
        return None;
    }
    let build = |a: &[f64]| CrushCurve {
        elastic_pressure: a[0] * GIGA,
        solid_pressure: a[1] * GIGA,
        initial_distension: initial,
        exponent: exponent.unwrap_or_else(|| a[2]),
    };
    // Shut points belong to the fit: the curve must have ended before them.
    let all: Vec<(f64, f64)> = open.iter().chain(&shut).copied().collect();
    let residuals =
        |a: &[f64]| all.iter().map(|&(p, alpha)| build(a).distension(p) - alpha).collect::<Vec<_>>();
    let highest = open.iter().map(|(p, _)| p / GIGA).fold(0.0, f64::max);
    let start: Vec<f64> = [0.3 * highest, 1.2 * highest, 2.5].into_iter().take(parameters).collect();
    let solution = least_squares::nonlinear(&start, residuals)?;
    let found = build(&solution.parameters);
    found.check().ok()?;
    // Shut points far beyond P_s carry no knowledge: only the open ones count as degrees of freedom.
    let freedom = open.len() - parameters;
    let variance = solution.chi_squared / freedom as f64;
    let widening = StudentsT::new(0.0, 1.0, freedom as f64).map_or(f64::NAN, |t| t.inverse_cdf(0.841_345));
    let error = |k: usize| widening * (variance * solution.covariance[(k, k)]).sqrt();
    Some(Calibration {
        curve: found,
        elastic_pressure_error: error(0) * GIGA,
        solid_pressure_error: error(1) * GIGA,
        exponent_error: exponent.is_none().then(|| error(2)),
        misfit: (solution.chi_squared / open.len() as f64).sqrt(),
        open,
        shut,
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::curve::points::Measured;
    use crate::curve::points::tests::{DENSITY, shipped};
    use sph_materials::porous::{CompactionCurve, Precursor};

    /// The medium of the shipped case.
    pub fn medium() -> PorousMedium {
        let copper = sph_materials::library::material("porous-copper").unwrap();
        PorousMedium::new(&copper, DENSITY, Precursor::Standing { stress: 0.206e9 }).unwrap()
    }

    /// Points of a medium that follows a crush curve, with alternating errors of u_s in parts of it
    /// where pores are open.
    fn synthetic(exponent: f64, noise: f64) -> Curve {
        let exact = CrushCurve {
            elastic_pressure: 0.18e9,
            solid_pressure: 0.75e9,
            initial_distension: medium().porosity(),
            exponent,
        };
        let crushed = CompactionCurve::crush(medium(), exact, 1e10).unwrap();
        let mut curve = shipped();
        for (k, p) in curve.points.iter_mut().enumerate() {
            let u_p = p.particle_velocity;
            let sign = if u_p < 140.0 { [1.0, -1.0, -1.0, 1.0][k % 4] } else { 0.0 };
            let u_s = crushed.wave(u_p).unwrap().shock_velocity() * (1.0 + sign * noise);
            p.stress_ahead = 0.206e9;
            p.stress = Measured { value: 0.206e9 + DENSITY * u_s * u_p, error: f64::NAN };
            p.density = Measured { value: DENSITY * u_s / (u_s - u_p), error: f64::NAN };
        }
        curve
    }

    #[test]
    fn an_exact_curve_is_found_again() {
        let found = calibrate(&synthetic(2.0, 0.0), &medium(), Some(2.0)).unwrap();
        assert!((found.curve.elastic_pressure / 0.18e9 - 1.0).abs() < 1e-5, "{found:?}");
        assert!((found.curve.solid_pressure / 0.75e9 - 1.0).abs() < 1e-5);
        assert!(found.misfit < 1e-8 && found.exponent_error.is_none());
        let free = calibrate(&synthetic(2.6, 0.0), &medium(), None).unwrap();
        assert!((free.curve.exponent - 2.6).abs() < 1e-3, "{free:?}");
    }

    #[test]
    fn errors_grow_with_the_misfit_and_hold_the_true_values() {
        let fit = |noise| calibrate(&synthetic(2.0, noise), &medium(), Some(2.0)).unwrap();
        let (small, large) = (fit(2e-3), fit(8e-3));
        assert!(large.elastic_pressure_error > 2.5 * small.elastic_pressure_error, "{small:?} {large:?}");
        assert!(
            (large.curve.elastic_pressure - 0.18e9).abs() < 2.0 * large.elastic_pressure_error,
            "{large:?}"
        );
        assert!((large.curve.solid_pressure - 0.75e9).abs() < 2.0 * large.solid_pressure_error, "{large:?}");
    }

    #[test]
    fn shut_points_alone_calibrate_nothing() {
        let mut curve = shipped();
        curve.points.retain(|p| p.particle_velocity > 140.0);
        assert_eq!(calibrate(&curve, &medium(), Some(2.0)), None);
    }

    /// The quadratic form misses the α of this medium by a hundredth; with n free it follows them.
    #[test]
    fn the_shipped_medium_wants_a_steeper_form() {
        let fit = |n| calibrate(&shipped(), &medium(), n).unwrap();
        let (quadratic, free) = (fit(Some(2.0)), fit(None));
        assert!(quadratic.misfit < 0.02 && free.misfit < 0.5 * quadratic.misfit, "{quadratic:?} {free:?}");
        assert!(free.curve.exponent > 2.3, "{free:?}");
    }
}
