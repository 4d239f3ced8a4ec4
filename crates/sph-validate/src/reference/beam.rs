//! First bending frequency of a free beam or plate strip: thin (Euler-Bernoulli) and with shear and rotary inertia
//! (Timoshenko).
//!
//! Plane strain along the third axis: the plate modulus E/(1 - ν²) stands for E. A strip of length L and thickness h:
//! I/A = h²/12, Ω = ω L² sqrt(ρ A/(E' I)), r² = I/(A L²), s² = E' I/(κ G A L²), κ = 5/6. Both ends free:
//!
//! ```text
//! 2 - 2 cosh(Ωα) cos(Ωβ)
//!     + Ω/√(1 - Ω² r² s²) [Ω² r² (r² - s²)² + 3 r² - s²] sinh(Ωα) sin(Ωβ) = 0
//! ```
//!
//! with α, β = sqrt(½(∓(r² + s²) + sqrt((r² - s²)² + 4/Ω²))). For r, s → 0: cosh k cos k = 1, k = 4.7300, Ω = k².
//!
//! Validity: first modes of plates whose thickness is below about a fifth of the length; κ = 5/6 leaves some 0.2 %.
//!
//! Source: T. C. Huang, J. Appl. Mech. 28 (1961) 579.

/// A strip with free ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreePlate {
    /// Length L [m].
    pub length: f64,
    /// Thickness h [m].
    pub thickness: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Bulk modulus K [Pa].
    pub bulk_modulus: f64,
    /// Shear modulus G [Pa].
    pub shear_modulus: f64,
}

impl FreePlate {
    /// E/(1 - ν²) [Pa].
    fn plate_modulus(&self) -> f64 {
        let (k, g) = (self.bulk_modulus, self.shear_modulus);
        let young = 9.0 * k * g / (3.0 * k + g);
        let poisson = (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g));
        young / (1.0 - poisson * poisson)
    }

    /// Angular frequency [1/s] of the first mode of a thin plate.
    pub fn thin_frequency(&self) -> f64 {
        4.730_040_745_f64.powi(2) * self.unit()
    }

    /// Angular frequency [1/s] of the first mode, with shear and rotary inertia.
    pub fn frequency(&self) -> f64 {
        let (mut low, mut high) = (1.0, 4.730_040_745_f64.powi(2));
        // The function falls through zero once between rest and the thin plate's frequency.
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            let same = self.characteristic(middle).signum() == self.characteristic(low).signum();
            if same { low = middle } else { high = middle }
        }
        0.5 * (low + high) * self.unit()
    }

    /// ω at Ω = 1 [1/s].
    fn unit(&self) -> f64 {
        (self.plate_modulus() * self.thickness.powi(2) / (12.0 * self.density)).sqrt() / self.length.powi(2)
    }

    fn characteristic(&self, omega: f64) -> f64 {
        let r2 = (self.thickness / self.length).powi(2) / 12.0;
        let s2 = r2 * self.plate_modulus() / (5.0 / 6.0 * self.shear_modulus);
        let root = ((r2 - s2).powi(2) + 4.0 / (omega * omega)).sqrt();
        let (alpha, beta) = ((0.5 * (root - r2 - s2)).sqrt(), (0.5 * (root + r2 + s2)).sqrt());
        let (a, b) = (omega * alpha, omega * beta);
        let bracket = omega * omega * r2 * (r2 - s2).powi(2) + 3.0 * r2 - s2;
        2.0 - 2.0 * a.cosh() * b.cos()
            + omega / (1.0 - omega * omega * r2 * s2).sqrt() * bracket * a.sinh() * b.sin()
    }

    /// Shape of the first mode of the thin plate at x from the left end: 2 at both ends, negative in the middle.
    pub fn shape(&self, x: f64) -> f64 {
        let k = 4.730_040_745_f64;
        let z = k * x / self.length;
        let ratio = (k.cosh() - k.cos()) / (k.sinh() - k.sin());
        z.cosh() + z.cos() - ratio * (z.sinh() + z.sin())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The beryllium plate of the literature: 0.2359739922 per µs for the thin plate.
    const BERYLLIUM: FreePlate = FreePlate {
        length: 0.06,
        thickness: 0.01,
        density: 1845.0,
        bulk_modulus: 118.896e9,
        shear_modulus: 151e9,
    };

    #[test]
    fn thin_plate_has_the_published_frequency() {
        let frequency = 1e-6 * BERYLLIUM.thin_frequency();
        assert!((frequency / 0.235_974 - 1.0).abs() < 2e-3, "{frequency}");
    }

    #[test]
    fn shear_slows_a_thick_plate_and_not_a_thin_one() {
        let period = std::f64::consts::TAU / BERYLLIUM.frequency();
        println!("period: {:.3} µs", 1e6 * period);
        assert!((28e-6..31e-6).contains(&period), "{period}");
        let thin = FreePlate { thickness: 1e-4, ..BERYLLIUM };
        assert!((thin.frequency() / thin.thin_frequency() - 1.0).abs() < 1e-4);
    }

    #[test]
    fn shape_has_no_momentum() {
        let n = 10_000;
        let mean = (0..n).map(|k| BERYLLIUM.shape(0.06 * (f64::from(k) + 0.5) / f64::from(n))).sum::<f64>();
        assert!((mean / f64::from(n)).abs() < 1e-6, "{mean}");
        assert!((BERYLLIUM.shape(0.0) - 2.0).abs() < 1e-12 && (BERYLLIUM.shape(0.06) - 2.0).abs() < 1e-6);
    }
}
