//! Verney's cylindrical shell in the rigid-plastic limit.
//!
//! A shell of an incompressible, rigid, perfectly plastic material moves inwards with u = -U0 R0/r. Its kinetic energy
//! is spent in plastic work when the inner radius has come to r'0:
//!
//! ```text
//! U0 = √[2 Y F(α, λ) / (√3 ρ ln(R1/R0))],      F = ∫_λ^1 x ln(1 + (2α + α²)/x²) dx,
//! α = (R1 - R0)/R0,      λ = r0'/R0
//! ```
//!
//! Real material is elastic and compressible: it stops 0.3 % further in (see [`super::lagrangian`]).
//!
//! Source: Howell and Ball, J. Comput. Phys. 175 (2002) 128; Rublev and Murzov (2024), section 2.1.3.

/// A shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    /// Inner radius R0 [m].
    pub inner_radius: f64,
    /// Outer radius R1 [m].
    pub outer_radius: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Yield strength Y [Pa].
    pub yield_strength: f64,
}

impl Shell {
    /// F(α, λ) [-], integrated exactly: ½[(x² + a) ln(x² + a) - x² ln x²] between λ and 1, a = 2α + α².
    fn work(&self, lambda: f64) -> f64 {
        let a = (self.outer_radius / self.inner_radius).powi(2) - 1.0;
        let primitive = |x: f64| {
            let square = x * x;
            let own = if square > 0.0 { square * square.ln() } else { 0.0 };
            0.5 * ((square + a) * (square + a).ln() - own)
        };
        primitive(1.0) - primitive(lambda)
    }

    /// Velocity U0 [m/s] at the inner surface that brings it to `stop` [m].
    pub fn velocity(&self, stop: f64) -> f64 {
        let logarithm = (self.outer_radius / self.inner_radius).ln();
        let work = self.work(stop / self.inner_radius);
        (2.0 * self.yield_strength * work / (3f64.sqrt() * self.density * logarithm)).sqrt()
    }

    /// Inner radius r'0 [m] at the stop for the velocity U0 [m/s] of the inner surface; `None` where the shell has too
    /// much energy to stop at all.
    pub fn stop_radius(&self, velocity: f64) -> Option<f64> {
        if !(0.0..=self.velocity(0.0)).contains(&velocity) {
            return None;
        }
        let (mut low, mut high) = (0.0, self.inner_radius);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if self.velocity(middle) > velocity { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }
}

/// A hollow sphere of the same kind: u = -U0 (R0/r)², work Y · 2 ln(R/r) a volume on the way from R to r, r³ = R³ - R0³ + r0³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Inner radius R0 [m].
    pub inner_radius: f64,
    /// Outer radius R1 [m].
    pub outer_radius: f64,
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Yield strength Y [Pa].
    pub yield_strength: f64,
}

impl Sphere {
    /// Velocity U0 [m/s] at the inner surface that brings it to `stop` [m].
    pub fn velocity(&self, stop: f64) -> f64 {
        let (inner, outer) = (self.inner_radius, self.outer_radius);
        let lost = inner.powi(3) - stop.powi(3);
        let work = |r: f64| 2.0 * self.yield_strength * r * r * (r / (r.powi(3) - lost).cbrt()).ln();
        // Midpoints: the integrand is smooth but for a logarithm at the inner surface of a shell that shuts.
        const PARTS: u32 = 20_000;
        let width = (outer - inner) / f64::from(PARTS);
        let middles = (0..PARTS).map(|k| inner + (f64::from(k) + 0.5) * width);
        let total: f64 = middles.map(|r| work(r) * width).sum();
        // Kinetic energy: ½ ρ U0² R0⁴ (1/R0 - 1/R1) per steradian.
        let inertia = 0.5 * self.density * inner.powi(4) * (1.0 / inner - 1.0 / outer);
        (total / inertia).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed form of Verney's problem in space (LA-14379), U0² = 4 Y R1 F/(3 ρ δ), F = ∫_λ^1 x² ln(1 + ((1+α)³ - 1)/x³) dx.
    #[test]
    fn velocity_of_the_sphere_is_that_of_the_closed_form() {
        let sphere =
            Sphere { inner_radius: 0.08, outer_radius: 0.1, density: 1845.0, yield_strength: 0.33e9 };
        let (lambda, a) = (0.5, 1.25f64.powi(3) - 1.0);
        let width = (1.0 - lambda) / 20_000.0;
        let middles = (0..20_000).map(|k| lambda + (f64::from(k) + 0.5) * width);
        let work: f64 = middles.map(|x| x * x * (1.0 + a / x.powi(3)).ln() * width).sum();
        let exact = (4.0 * 0.33e9 * 0.1 * work / (3.0 * 1845.0 * 0.02)).sqrt();
        let velocity = sphere.velocity(0.04);
        println!("U0 of the sphere {velocity:.3} m/s, closed form {exact:.3} m/s");
        assert!((velocity / exact - 1.0).abs() < 1e-3, "{velocity} {exact}");
    }

    const SHELL: Shell =
        Shell { inner_radius: 0.08, outer_radius: 0.1, density: 2785.0, yield_strength: 0.3e9 };

    #[test]
    fn published_velocity_gives_the_published_radius() {
        let stop = SHELL.stop_radius(208.55).expect("the shell stops");
        assert!((stop - 0.066716).abs() < 5e-7, "{stop}");
    }

    #[test]
    fn closed_form_of_the_work_is_its_integral() {
        let (lambda, n) = (0.8339, 2000);
        let width = (1.0 - lambda) / f64::from(n);
        let integrand = |x: f64| x * (1.0 + 0.5625 / (x * x)).ln();
        let sum: f64 = (0..n).map(|k| integrand(lambda + (f64::from(k) + 0.5) * width) * width).sum();
        assert!((SHELL.work(lambda) - sum).abs() < 1e-9);
    }

    #[test]
    fn shell_with_too_much_energy_does_not_stop() {
        assert_eq!(SHELL.stop_radius(1e4), None);
        assert_eq!(SHELL.stop_radius(f64::NAN), None);
        assert!((SHELL.stop_radius(0.0).expect("at rest") - 0.08).abs() < 1e-12);
    }
}
