//! u_s at vanishing particle size, with an uncertainty.
//!
//! ```text
//! u_s(D) = u0 + A D^p
//! ```
//!
//! For an assumed order p this is a straight line in `D^p`, fitted by least squares with the standard errors of u_s
//! (for two particle sizes: Richardson's formula). The order is rarely known: with pores that shut it is 1 or less, in smooth
//! flow it is 2. So p = 1 and p = 2 are both taken, and with three sizes or more also the order that fits best, where it lies
//! within [½, 3] and the changes of u_s go one way and exceed their noise. The result is the fit of the observed order,
//! or the mean of both assumed ones. Its uncertainty is the root of the sum of squares of
//!
//! * the standard error of the fit, widened by √(χ²/ν) where the points scatter more than their errors say;
//! * half the spread of u_0 over all orders taken.
//!
//! Source: P. J. Roache, *Verification and Validation in Computational Science and Engineering* (1998), ch. 5; L. Eça & M.
//! Hoekstra, J. Comput. Phys. 262 (2014) 104-130.

use nalgebra::DMatrix;
use serde::Serialize;

use crate::curve::least_squares;

/// Orders that are always taken.
const ASSUMED: [f64; 2] = [1.0, 2.0];
/// Orders that an observed one may have.
const OBSERVABLE: (f64, f64) = (0.5, 3.0);
/// Places at which the observed order is looked for.
const SCAN: u32 = 250;

/// u_s at one particle size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtSize {
    /// D [m].
    pub particle_size: f64,
    /// u_s [m/s].
    pub shock_velocity: f64,
    /// Its standard error [m/s]; zero or `NaN` if unknown.
    pub standard_error: f64,
}

/// u_s at D → 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Extrapolated {
    /// u_s [m/s].
    pub shock_velocity: f64,
    /// Its standard uncertainty [m/s].
    pub uncertainty: f64,
    /// Part of it from the standard errors of the points [m/s].
    pub statistical: f64,
    /// Part of it from the orders that were taken [m/s].
    pub order_spread: f64,
    /// Order that fits best [-]; none where the points do not show one.
    pub observed_order: Option<f64>,
}

/// One fit: (u_0, its standard error, χ²).
type OneFit = (f64, f64, f64);

/// Extrapolates; `None` for fewer than two different particle sizes.
pub fn extrapolate(points: &[AtSize]) -> Option<Extrapolated> {
    let mut points: Vec<AtSize> = points.iter().copied().filter(|p| p.shock_velocity.is_finite()).collect();
    points.sort_by(|a, b| b.particle_size.total_cmp(&a.particle_size));
    let fits: Vec<OneFit> = ASSUMED.iter().filter_map(|&p| fit(&points, p)).collect();
    if fits.len() < ASSUMED.len() {
        return None;
    }
    let observed = observed_order(&points);
    let best = observed.and_then(|p| fit(&points, p));
    let all: Vec<f64> = fits.iter().chain(&best).map(|f| f.0).collect();
    let spread = 0.5
        * (all.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - all.iter().copied().fold(f64::INFINITY, f64::min));
    let (shock_velocity, statistical) = match best {
        Some((value, error, _)) => (value, error),
        None => (0.5 * (fits[0].0 + fits[1].0), fits[0].1.max(fits[1].1)),
    };
    let uncertainty = statistical.hypot(spread);
    Some(Extrapolated {
        shock_velocity,
        uncertainty,
        statistical,
        order_spread: spread,
        observed_order: observed,
    })
}

/// The line in D^p; errors widened where the points scatter more.
fn fit(points: &[AtSize], order: f64) -> Option<OneFit> {
    let greatest = points.first()?.particle_size;
    let known = points.iter().all(|p| p.standard_error.is_finite() && p.standard_error > 0.0);
    let sigma: Vec<f64> = points.iter().map(|p| if known { p.standard_error } else { 1.0 }).collect();
    let design = DMatrix::from_fn(points.len(), 2, |i, k| match k {
        0 => 1.0,
        _ => (points[i].particle_size / greatest).powf(order),
    });
    let values: Vec<f64> = points.iter().map(|p| p.shock_velocity).collect();
    let solution = least_squares::linear(&design, &values, &sigma)?;
    let freedom = points.len() - 2;
    let reduced = if freedom > 0 { solution.chi_squared / freedom as f64 } else { f64::NAN };
    let widening = match (known, freedom) {
        (true, 0) => 1.0,
        (true, _) => reduced.max(1.0).sqrt(),
        // Without errors and without a third size nothing tells the scatter: the spread of orders alone is left.
        (false, 0) => 0.0,
        (false, _) => reduced.sqrt(),
    };
    Some((solution.parameters[0], widening * solution.covariance[(0, 0)].sqrt(), solution.chi_squared))
}

/// The order of least χ², where the points show one.
fn observed_order(points: &[AtSize]) -> Option<f64> {
    if points.len() < 3 {
        return None;
    }
    let changes: Vec<(f64, f64)> = points
        .windows(2)
        .map(|w| {
            let noise =
                [w[0].standard_error, w[1].standard_error].map(|e| if e.is_finite() { e } else { 0.0 });
            (w[1].shock_velocity - w[0].shock_velocity, noise[0].hypot(noise[1]))
        })
        .collect();
    let one_way = changes.iter().all(|c| c.0 > 0.0) || changes.iter().all(|c| c.0 < 0.0);
    if !one_way || changes.iter().any(|(change, noise)| change.abs() < 2.0 * noise) {
        return None;
    }
    let (low, high) = OBSERVABLE;
    let orders = (0..=SCAN).map(|k| low + (high - low) * f64::from(k) / f64::from(SCAN));
    let chi = orders.filter_map(|p| Some((p, fit(points, p)?.2)));
    let (best, _) = chi.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (best > low && best < high).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(sizes: &[f64], u: impl Fn(f64) -> f64, error: f64) -> Vec<AtSize> {
        let at = |&d: &f64| AtSize { particle_size: d * 1e-6, shock_velocity: u(d), standard_error: error };
        sizes.iter().map(at).collect()
    }

    #[test]
    fn an_exact_order_is_observed_and_extrapolated() {
        for order in [1.0, 1.5, 2.0] {
            let found =
                extrapolate(&points(&[2.0, 1.0, 0.5], |d| 425.0 + 8.0 * d.powf(order), 0.01)).unwrap();
            assert!((found.observed_order.unwrap() - order).abs() < 0.02, "{found:?}");
            assert!((found.shock_velocity - 425.0).abs() < 0.1 + found.statistical, "{found:?}");
            assert!((found.shock_velocity - 425.0).abs() <= found.uncertainty, "{found:?}");
        }
    }

    /// Richardson's formula: (2^p u_fine - u_coarse)/(2^p - 1), for p = 1 and 2, and their half spread.
    #[test]
    fn two_sizes_give_both_assumed_orders() {
        let found = extrapolate(&points(&[1.0, 2.0], |d| 420.0 + 6.0 * d, 0.3)).unwrap();
        let (first, second) = (2.0 * 426.0 - 432.0, (4.0 * 426.0 - 432.0) / 3.0);
        assert!((found.shock_velocity - 0.5 * (first + second)).abs() < 1e-9, "{found:?}");
        assert!((found.order_spread - 0.5 * (second - first)).abs() < 1e-9);
        assert!((found.statistical - 0.3 * 5f64.sqrt()).abs() < 1e-9, "the larger of both: {found:?}");
        assert_eq!(found.observed_order, None);
    }

    #[test]
    fn noise_shows_no_order_and_widens_the_error() {
        let noisy = |d: f64| 425.0 + if d == 1.0 { 3.0 } else { 0.0 };
        let found = extrapolate(&points(&[2.0, 1.0, 0.5], noisy, 0.1)).unwrap();
        assert_eq!(found.observed_order, None);
        assert!(found.statistical > 1.0, "{found:?}");
    }

    #[test]
    fn one_size_extrapolates_nothing() {
        assert_eq!(extrapolate(&points(&[1.0], |_| 425.0, 0.1)), None);
        assert_eq!(extrapolate(&points(&[1.0, 1.0], |_| 425.0, 0.1)), None);
        assert_eq!(extrapolate(&[]), None);
    }
}
