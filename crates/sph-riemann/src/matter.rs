//! Materials as the update and the equations of state need them: eight particles at a time.
//!
//! Where every material has the Mie-Grüneisen equation of state and at most the tensile cut-off, the formulas of
//! [`sph_materials`] stand here once more, in lanes; else its functions are called lane by lane. Tests hold the two to each
//! other.

use sph_core::lanes::{LANES, Lanes, Real};
use sph_materials::sound::THERMODYNAMIC_FLOOR;
use sph_materials::{Damage, EquationOfState, Failure, Material, SoundSpeedModel};

/// The materials, and their numbers as lanes need them.
#[derive(Clone, Debug)]
pub struct Matter {
    materials: Vec<Material>,
    numbers: Vec<Numbers<f64>>,
    in_lanes: bool,
}

/// Numbers of the material of each of eight particles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers<R> {
    /// ρ_0 [kg/m³].
    reference_density: R,
    /// c_a [m/s], s_a [-], γ [-] of the Mie-Grüneisen equation of state.
    bulk_sound_speed: R,
    hugoniot_slope: R,
    gruneisen: R,
    /// B [Pa].
    bulk_modulus: R,
    /// 1 if the sound speed is that of the state, 0 if that of the reference state.
    thermodynamic: R,
    /// -T [Pa]; -∞ without a cut-off.
    least_pressure: R,
    /// G [Pa].
    pub shear_modulus: R,
    /// Y [Pa].
    pub yield_strength: R,
}

impl Numbers<f64> {
    fn of(material: &Material) -> Self {
        let rho0 = material.reference_density;
        let (c, s, gamma) = match material.equation_of_state {
            EquationOfState::MieGruneisen(m) => {
                (m.bulk_sound_speed, m.hugoniot_slope, m.gruneisen_coefficient)
            }
            _ => (0.0, 0.0, 0.0), // Not asked for.
        };
        Self {
            reference_density: rho0,
            bulk_sound_speed: c,
            hugoniot_slope: s,
            gruneisen: gamma,
            bulk_modulus: material.equation_of_state.reference_bulk_modulus(rho0),
            thermodynamic: f64::from(material.sound_speed == SoundSpeedModel::Thermodynamic),
            least_pressure: -material.failure.tensile_strength(),
            shear_modulus: material.strength.shear_modulus(),
            yield_strength: material.strength.yield_strength(),
        }
    }
}

impl<L: Lanes> Numbers<L> {
    #[inline(always)]
    fn splat(n: &Numbers<f64>) -> Self {
        Self {
            reference_density: L::splat(n.reference_density),
            bulk_sound_speed: L::splat(n.bulk_sound_speed),
            hugoniot_slope: L::splat(n.hugoniot_slope),
            gruneisen: L::splat(n.gruneisen),
            bulk_modulus: L::splat(n.bulk_modulus),
            thermodynamic: L::splat(n.thermodynamic),
            least_pressure: L::splat(n.least_pressure),
            shear_modulus: L::splat(n.shear_modulus),
            yield_strength: L::splat(n.yield_strength),
        }
    }
}

/// What eight particles are made of and what tension has done to them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eight<'a, L> {
    /// Index of the material of each; as many as there are particles.
    pub material: &'a [u16],
    /// Whether each has failed.
    pub failed: &'a [bool],
    /// Distension of each [-].
    pub distension: &'a [f64],
    /// Numbers of the materials.
    pub numbers: Numbers<L>,
}

impl<L: Lanes> Eight<'_, L> {
    /// 1 where a particle has failed, else 0.
    #[inline(always)]
    pub fn failed_lanes(&self) -> L {
        if !self.failed.contains(&true) {
            return L::zero();
        }
        let mut lanes = [0.0; LANES];
        for l in 0..self.failed.len() {
            lanes[l] = f64::from(self.failed[l]);
        }
        L::load(&lanes)
    }
}

/// Failure and voids of eight particles at the end of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tension {
    /// Bit l: particle l has failed.
    pub failed: u8,
    /// Bit l: the pressure of the equation of state is finite.
    pub finite: u8,
    /// Distension [-] and share of the strength that is left [-], where the failure model has more to say than the cut-off,
    /// which leaves no strength to what has failed.
    pub detail: Option<[[f64; LANES]; 2]>,
}

impl Matter {
    /// Looks at the materials once.
    pub fn new(materials: Vec<Material>) -> Self {
        let numbers = materials.iter().map(Numbers::of).collect();
        let in_lanes = materials.iter().all(|m| {
            matches!(m.equation_of_state, EquationOfState::MieGruneisen(_))
                && matches!(m.failure, Failure::None | Failure::TensileCutoff { .. })
        });
        Self { materials, numbers, in_lanes }
    }

    /// The same materials, every formula lane by lane.
    #[cfg(test)]
    pub(crate) fn one_by_one(mut self) -> Self {
        self.in_lanes = false;
        self
    }

    /// The materials.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Eight particles, or as many as there are.
    #[inline(always)]
    pub(crate) fn eight<'a, L: Lanes>(
        &self,
        material: &'a [u16],
        failed: &'a [bool],
        distension: &'a [f64],
    ) -> Eight<'a, L> {
        Eight { material, failed, distension, numbers: self.numbers(material) }
    }

    /// Numbers of the materials of eight particles, or as many as there are.
    #[inline(always)]
    pub(crate) fn numbers<L: Lanes>(&self, material: &[u16]) -> Numbers<L> {
        if self.numbers.len() == 1 {
            Numbers::splat(&self.numbers[0])
        } else {
            let mut of = [&self.numbers[material[0] as usize]; LANES];
            for l in 0..material.len() {
                of[l] = &self.numbers[material[l] as usize];
            }
            gather(of)
        }
    }

    /// Pressure [Pa] with the failure rule, and ρ c_b² [Pa].
    #[inline(always)]
    pub(crate) fn pressure_and_bulk_modulus<L: Lanes>(
        &self,
        eight: &Eight<'_, L>,
        density: L,
        energy: L,
    ) -> (L, L) {
        if !self.in_lanes {
            let (pressure, modulus) = self.slow_pressure(
                (eight.material, eight.failed, eight.distension),
                &density.to_array(),
                &energy.to_array(),
            );
            return (L::load(&pressure), L::load(&modulus));
        }
        let n = &eight.numbers;
        let (solid, exact) = mie_gruneisen(n, density, energy);
        let floor = L::splat(THERMODYNAMIC_FLOOR) * n.bulk_modulus;
        let floored = exact.select_less(floor, floor, exact);
        let modulus = L::splat(0.5).select_less(n.thermodynamic, floored, n.bulk_modulus);
        (cut_off(n, eight.failed_lanes(), solid).0, modulus)
    }

    /// Failure at the end of a step of `time_step` [s].
    #[inline(always)]
    pub(crate) fn advance_tension<L: Lanes>(
        &self,
        eight: &Eight<'_, L>,
        density: L,
        energy: L,
        time_step: f64,
    ) -> Tension {
        if !self.in_lanes {
            return self.slow_tension(eight, &density.to_array(), &energy.to_array(), time_step);
        }
        let (solid, _) = mie_gruneisen(&eight.numbers, density, energy);
        let (_, failed) = cut_off(&eight.numbers, eight.failed_lanes(), solid);
        let finite = solid.abs().less_mask(L::splat(f64::INFINITY));
        Tension { failed: L::splat(0.5).less_mask(failed), finite, detail: None }
    }

    #[cold]
    #[inline(never)]
    fn slow_pressure(
        &self,
        (material, failed, distension): (&[u16], &[bool], &[f64]),
        density: &[f64; LANES],
        energy: &[f64; LANES],
    ) -> ([f64; LANES], [f64; LANES]) {
        let (mut pressure, mut modulus) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..material.len() {
            let of = &self.materials[material[l] as usize];
            let damage = Damage { failed: failed[l], distension: distension[l] };
            pressure[l] = of.pressure_with(damage, density[l], energy[l]);
            // Of the solid between voids.
            let speed = of.bulk_sound_speed(density[l] * distension[l], energy[l]);
            modulus[l] = density[l] * speed * speed;
        }
        (pressure, modulus)
    }

    #[cold]
    #[inline(never)]
    fn slow_tension<L: Lanes>(
        &self,
        eight: &Eight<'_, L>,
        density: &[f64; LANES],
        energy: &[f64; LANES],
        time_step: f64,
    ) -> Tension {
        let (mut finite, mut failed, mut detail) = (0, 0, [[1.0; LANES]; 2]);
        for l in 0..eight.material.len() {
            let of = &self.materials[eight.material[l] as usize];
            let damage = Damage { failed: eight.failed[l], distension: eight.distension[l] };
            let state = of.advance_failure(damage, density[l], energy[l], time_step);
            finite |= u8::from(state.pressure.is_finite()) << l;
            failed |= u8::from(state.damage.failed) << l;
            (detail[0][l], detail[1][l]) = (state.damage.distension, state.strength_left);
        }
        Tension { failed, finite, detail: Some(detail) }
    }
}

#[inline(always)]
fn gather<L: Lanes>(of: [&Numbers<f64>; LANES]) -> Numbers<L> {
    #[inline(always)]
    fn lanes<L: Lanes>(of: &[&Numbers<f64>; LANES], number: fn(&Numbers<f64>) -> f64) -> L {
        L::load(&of.map(number))
    }
    Numbers {
        reference_density: lanes(&of, |n| n.reference_density),
        bulk_sound_speed: lanes(&of, |n| n.bulk_sound_speed),
        hugoniot_slope: lanes(&of, |n| n.hugoniot_slope),
        gruneisen: lanes(&of, |n| n.gruneisen),
        bulk_modulus: lanes(&of, |n| n.bulk_modulus),
        thermodynamic: lanes(&of, |n| n.thermodynamic),
        least_pressure: lanes(&of, |n| n.least_pressure),
        shear_modulus: lanes(&of, |n| n.shear_modulus),
        yield_strength: lanes(&of, |n| n.yield_strength),
    }
}

/// Pressure [Pa] and ρ c_b² [Pa]; see [`sph_materials::eos::MieGruneisen`].
#[inline(always)]
fn mie_gruneisen<R: Real>(n: &Numbers<R>, density: R, energy: R) -> (R, R) {
    let (one, half) = (R::one(), R::splat(0.5));
    let x = n.reference_density / density;
    let eta = one - x;
    let slope = n.hugoniot_slope * eta.max(R::zero());
    let inverse = one / (one - slope);
    // On the Hugoniot: the particle velocity.
    let u = n.bulk_sound_speed * eta * inverse;
    let thermal = n.gruneisen * density * (energy - half * u * u);
    let impedance = n.reference_density * n.bulk_sound_speed * inverse;
    let pressure = impedance.mul_add(u, thermal);
    // dP_ref/dη and de_ref/dη; dη/dρ = x/ρ.
    let pressure_slope = impedance * n.bulk_sound_speed * inverse * inverse * (one + slope);
    let energy_slope = n.bulk_sound_speed * u * inverse * inverse;
    let cold = (pressure_slope - n.gruneisen * density * energy_slope) * x;
    (pressure, n.gruneisen.mul_add(pressure, cold + thermal))
}

/// Pressure with the tensile cut-off, and 1 where failed: see [`Failure`].
#[inline(always)]
fn cut_off<R: Real>(n: &Numbers<R>, was_failed: R, solid: R) -> (R, R) {
    let (zero, one) = (R::zero(), R::one());
    let breaks = solid.select_less(n.least_pressure, one, zero);
    let stays_open = zero.select_less(solid, zero, one);
    // Without a cut-off nothing stays failed.
    let has_cut_off = R::splat(-f64::MAX).select_less(n.least_pressure, one, zero);
    let failed = has_cut_off * R::splat(0.5).select_less(was_failed, stays_open, breaks);
    (R::splat(0.5).select_less(failed, zero, solid), failed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph_core::lanes::{InstructionSet, LaneKernel, dispatch_with};
    use sph_materials::library;

    /// Compares both ways over densities, energies and memories of failure.
    struct Compare<'a>(&'a Matter, &'a Matter);

    impl LaneKernel for Compare<'_> {
        #[inline(always)]
        fn run<L: Lanes>(self) {
            let material: [u16; LANES] = std::array::from_fn(|l| (l % self.0.materials().len()) as u16);
            for k in 0..2000 {
                let density: [f64; LANES] =
                    std::array::from_fn(|l| 6000.0 + 3.0 * k as f64 + 130.0 * l as f64);
                let energy: [f64; LANES] = std::array::from_fn(|l| (k % 37) as f64 * 3e3 - 200.0 * l as f64);
                let failed: [bool; LANES] = std::array::from_fn(|l| (k + l) % 3 == 0);
                let eight = |matter: &Matter| matter.eight::<L>(&material, &failed, &[1.0; LANES]);
                let (rho, e) = (L::load(&density), L::load(&energy));
                let pressures = [self.0, self.1].map(|m| m.pressure_and_bulk_modulus(&eight(m), rho, e));
                near(pressures[0].0, pressures[1].0);
                near(pressures[0].1, pressures[1].1);
                let tension = [self.0, self.1].map(|m| m.advance_tension(&eight(m), rho, e, 1e-9));
                assert_eq!(tension[0].failed, tension[1].failed);
                assert_eq!(tension[0].finite, tension[1].finite);
                for (l, left) in tension[1].detail.expect("one by one")[1].iter().enumerate() {
                    assert_eq!(*left, f64::from(tension[0].failed >> l & 1 == 0));
                }
            }
        }
    }

    fn near<L: Lanes>(a: L, b: L) {
        for (a, b) in a.to_array().iter().zip(b.to_array()) {
            assert!((a - b).abs() <= 1e-12 * b.abs().max(1e9), "{a:e} in lanes, {b:e} one by one");
        }
    }

    #[test]
    fn lanes_are_the_formulas_of_the_materials() {
        let copper = library::material("porous-copper").expect("a library material");
        let mut other = copper.clone();
        other.failure = Failure::None;
        other.sound_speed = SoundSpeedModel::QuasiAcoustic;
        other.reference_density = 8000.0;
        for materials in [vec![copper.clone()], vec![copper, other]] {
            let lanes = Matter::new(materials.clone());
            assert!(lanes.in_lanes);
            let plain = Matter::new(materials).one_by_one();
            for set in InstructionSet::available() {
                dispatch_with(set, Compare(&lanes, &plain));
            }
        }
    }
}
