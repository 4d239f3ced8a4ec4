//! A crush curve `α(P)`: how a porous medium is compacted by pressure.
//!
//! ```text
//! α(P) = 1 + (α0 - 1) ( (P_s - P)/(P_s - P_e) )ⁿ      (P_e < P < P_s),
//! α = α0  (P ≤ P_e),      α = 1  (P ≥ P_s)
//! ```
//!
//! `α = ρ_s/ρ` with the density `ρ_s` of the solid at the same pressure and energy. n = 2 is
//! the quadratic form that hydrocodes take; the elastic change of `α` below `P_e` is left out, as in
//! the source.
//!
//! # Source
//!
//! M. Jutzi, W. Benz & P. Michel, "Numerical simulations of impacts involving porous bodies. I", Icarus 198 (2008)
//! 242-255. The form with n = 2: W. Herrmann, J. Appl. Phys. 40 (1969) 2490-2499, and M. M. Carroll & A. C. Holt, J.
//! Appl. Phys. 43 (1972) 1626-1636.

use crate::error::HugoniotError;

/// A crush curve; formula and source: [its module](self).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct CrushCurve {
    /// `P_e`: pressure at which compaction begins [Pa].
    pub elastic_pressure: f64,
    /// `P_s`: pressure from which on the medium is solid [Pa].
    pub solid_pressure: f64,
    /// `α0`: distension of the undisturbed medium [1].
    pub initial_distension: f64,
    /// n; 2 in the source [1].
    pub exponent: f64,
}

impl CrushCurve {
    /// The quadratic form of the source.
    ///
    /// # Errors
    ///
    /// As [`CrushCurve::check`].
    pub fn quadratic(
        elastic_pressure: f64,
        solid_pressure: f64,
        initial_distension: f64,
    ) -> Result<Self, HugoniotError> {
        let curve = Self { elastic_pressure, solid_pressure, initial_distension, exponent: 2.0 };
        curve.check()?;
        Ok(curve)
    }

    /// Whether the numbers make a curve.
    ///
    /// # Errors
    ///
    /// [`HugoniotError::NotFinite`] for a pressure `P_e` without end, [`HugoniotError::NotAbove`] for pressures that do not
    /// rise, [`HugoniotError::BadNumber`] for a distension or an exponent below 1.
    pub fn check(&self) -> Result<(), HugoniotError> {
        if !self.elastic_pressure.is_finite() {
            let (field, value) = ("elastic_pressure", self.elastic_pressure);
            return Err(HugoniotError::NotFinite { field, value, unit: "Pa" });
        }
        let least = self.elastic_pressure.max(0.0);
        if !(self.solid_pressure.is_finite() && self.solid_pressure > least) {
            let (field, value) = ("solid_pressure", self.solid_pressure);
            return Err(HugoniotError::NotAbove { field, value, unit: "Pa", least });
        }
        for (field, value) in [("initial_distension", self.initial_distension), ("exponent", self.exponent)] {
            if !(value.is_finite() && value >= 1.0) {
                return Err(HugoniotError::BadNumber { field, value, unit: "", least: 1.0 });
            }
        }
        Ok(())
    }

    /// `α` at a pressure [Pa] of first loading [1].
    pub fn distension(&self, pressure: f64) -> f64 {
        let left = (self.solid_pressure - pressure) / (self.solid_pressure - self.elastic_pressure);
        1.0 + (self.initial_distension - 1.0) * left.clamp(0.0, 1.0).powf(self.exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_falls_from_its_initial_distension_to_one() {
        let curve = CrushCurve::quadratic(0.2e9, 0.8e9, 1.35).unwrap();
        assert_eq!((curve.distension(0.1e9), curve.distension(0.9e9)), (1.35, 1.0));
        // Half way the quadratic form has a quarter of the distension left.
        assert!((curve.distension(0.5e9) - 1.0875).abs() < 1e-12);
        let values: Vec<f64> = (0..100).map(|k| curve.distension(1e7 * f64::from(k))).collect();
        assert!(values.is_sorted_by(|a, b| a >= b));
    }

    #[test]
    fn impossible_curves_are_named() {
        let field = |e, s, a| match CrushCurve::quadratic(e, s, a) {
            Err(HugoniotError::NotFinite { field, .. }) => (field, "finite"),
            Err(HugoniotError::NotAbove { field, .. }) => (field, "above"),
            Err(HugoniotError::BadNumber { field, .. }) => (field, "at least"),
            other => panic!("{other:?}"),
        };
        assert_eq!(field(0.8e9, 0.8e9, 1.35), ("solid_pressure", "above"));
        assert_eq!(field(0.2e9, 0.8e9, 0.9), ("initial_distension", "at least"));
        assert_eq!(field(f64::NEG_INFINITY, 0.8e9, 1.35), ("elastic_pressure", "finite"));
        assert_eq!(field(f64::NAN, 0.8e9, 1.35), ("elastic_pressure", "finite"));
        assert_eq!(field(0.2e9, f64::NAN, 1.35), ("solid_pressure", "above"));
    }
}
