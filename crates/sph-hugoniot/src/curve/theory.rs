//! What theory says of u_s(u_p) and of the states behind the wave, in all planes.
//!
//! All curves are those of the medium behind the measured precursor, taken as standing ([`Precursor::Standing`]): u_p and
//! u_s are relative to the matter ahead of the compaction wave, as the window has them. Boade's powder has its own
//! density and precursor; its curve is given relative to the matter behind that precursor, to compare with the others.

use sph_materials::hugoniot;
use sph_materials::porous::{CompactionCurve, CrushCurve, PorousMedium, Precursor, ShearBehind};
use sph_materials::{HugoniotError, Jump, Material};

/// A state behind a wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TheoryState {
    /// u_p relative to the matter ahead [m/s].
    pub particle_velocity: f64,
    /// u_s relative to the matter ahead [m/s].
    pub shock_velocity: f64,
    /// -σ_xx [Pa].
    pub stress: f64,
    /// Density [kg/m³].
    pub density: f64,
}

impl From<Jump> for TheoryState {
    fn from(jump: Jump) -> Self {
        Self {
            particle_velocity: jump.velocity_jump(),
            shock_velocity: jump.shock_velocity(),
            stress: -jump.behind.longitudinal_stress,
            density: jump.behind.density,
        }
    }
}

/// States of one theory, in the order of u_p; those that cannot be are left out.
pub type TheoryCurve = Vec<TheoryState>;

/// The theories of a medium.
#[derive(Clone, Debug)]
pub struct Theory<'m> {
    /// The only solid; none of a medium of several materials, which no theory here describes.
    solid: Option<&'m Material>,
    /// The medium behind its precursor; none if the sample has no pores, or compaction would be anomalous.
    pub medium: Option<PorousMedium>,
}

impl<'m> Theory<'m> {
    /// Of a medium of density ρ00 [kg/m³] behind a standing precursor [Pa].
    pub fn new(solid: &'m Material, bulk_density: f64, precursor_stress: f64) -> Self {
        let standing = Precursor::Standing { stress: precursor_stress };
        Self { solid: Some(solid), medium: PorousMedium::new(solid, bulk_density, standing).ok() }
    }

    /// Of a medium of several materials: no curve at all, rather than that of one of them.
    pub fn none() -> Self {
        Self { solid: None, medium: None }
    }

    /// The solid without pores and strength.
    pub fn solid(&self, speeds: &[f64]) -> TheoryCurve {
        self.solid.map_or_else(Vec::new, |solid| states(speeds, |u| hugoniot::principal(solid, u)))
    }

    /// Pores shut, with the mean deviator behind as asked.
    pub fn shut_pores(&self, speeds: &[f64], shear: ShearBehind) -> TheoryCurve {
        self.medium.as_ref().map_or_else(Vec::new, |m| states(speeds, |u| m.shut_pores(u, shear)))
    }

    /// Pores shut, the solid incompressible.
    pub fn snow_plow(&self, speeds: &[f64]) -> TheoryCurve {
        self.medium.as_ref().map_or_else(Vec::new, |m| states(speeds, |u| m.snow_plow(u)))
    }

    /// P-α with a crush curve of the longitudinal stress.
    pub fn crushed(&self, speeds: &[f64], curve: CrushCurve) -> TheoryCurve {
        let Some(medium) = &self.medium else { return Vec::new() };
        // Beyond any stress that a point can have; the curve is α = 1 there.
        let greatest = 100.0 * curve.solid_pressure;
        match CompactionCurve::crush(medium.clone(), curve, greatest) {
            Ok(crushed) => states(speeds, |u| crushed.wave(u)),
            Err(_) => Vec::new(),
        }
    }

    /// Pressed copper powder of Boade (1970), with the solid of the case.
    pub fn boade(&self, speeds: &[f64]) -> TheoryCurve {
        let powder = self.solid.map(CompactionCurve::pressed_copper_powder);
        let Some(Ok(powder)) = powder else { return Vec::new() };
        let ahead = powder.precursor_state().particle_velocity;
        states(speeds, |u| powder.wave(u + ahead))
    }
}

fn states(speeds: &[f64], wave: impl Fn(f64) -> Result<Jump, HugoniotError>) -> TheoryCurve {
    speeds.iter().filter_map(|&u| wave(u).ok()).map(TheoryState::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::crush::calibrate;
    use crate::curve::crush::tests::medium;
    use crate::curve::points::tests::{DENSITY, shipped};

    const SPEEDS: [f64; 4] = [75.0, 150.0, 200.0, 300.0];

    fn copper() -> Material {
        sph_materials::library::material("porous-copper").unwrap()
    }

    #[test]
    fn every_curve_obeys_the_jump_conditions() {
        let copper = copper();
        let theory = Theory::new(&copper, DENSITY, 0.2e9);
        let shear = [ShearBehind::None, ShearBehind::Yielded];
        let curves =
            [theory.snow_plow(&SPEEDS)].into_iter().chain(shear.map(|s| theory.shut_pores(&SPEEDS, s)));
        for state in curves.flatten() {
            let TheoryState { particle_velocity: u_p, shock_velocity: u_s, stress, density } = state;
            assert!((DENSITY * u_s / (u_s - u_p) / density - 1.0).abs() < 1e-9, "{state:?}");
            assert!(((0.2e9 + DENSITY * u_s * u_p) / stress - 1.0).abs() < 1e-9, "{state:?}");
        }
        assert_eq!(theory.boade(&SPEEDS).len(), 4);
        assert!(
            theory.boade(&SPEEDS).iter().zip(SPEEDS).all(|(s, u)| (s.particle_velocity - u).abs() < 1e-6)
        );
        assert!((theory.solid(&SPEEDS)[3].shock_velocity - (3930.0 + 1.5 * 300.0)).abs() < 1e-9);
    }

    /// P-α gives the points back that it was calibrated on: closely where pores are shut, to some percent where α(P) has
    /// another form than the crush curve.
    #[test]
    fn the_calibrated_curve_gives_its_points_back() {
        let (copper, curve) = (copper(), shipped());
        let found = calibrate(&curve, &medium(), None).unwrap();
        let theory = Theory::new(&copper, DENSITY, curve.precursor_stress);
        for p in &curve.points {
            let state = theory.crushed(&[p.particle_velocity], found.curve)[0];
            let misfit = state.shock_velocity / p.shock_velocity.value - 1.0;
            let allowed = if p.particle_velocity < 140.0 { 0.06 } else { 0.005 };
            assert!(misfit.abs() < allowed, "{}: {misfit}", p.particle_velocity);
        }
    }

    #[test]
    fn a_solid_has_no_curve_of_pores() {
        let copper = copper();
        let theory = Theory::new(&copper, copper.reference_density, 0.0);
        assert!(
            theory.shut_pores(&SPEEDS, ShearBehind::None).is_empty() && theory.snow_plow(&SPEEDS).is_empty()
        );
        assert_eq!(theory.solid(&SPEEDS).len(), 4);
    }
}
