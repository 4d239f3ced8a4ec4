//! From rates to the state at the end of the step.
//!
//! ```text
//! U ← U + τ f/ρ
//! x ← x + τ ½(U + U_new)                    (explicit schemes: x + τ U)
//! ρ ← ρ exp(-τ ∇·U) exp(τ r)                (paper eq. (16); r: volume consistency)
//! e ← e + τ p/ρ - τ a·(U + ½τ a)            E = e + U²/2 changes by τ p/ρ exactly
//! S ← return(Q (S + 2G τ dev D) Qᵀ)         Q turns by ½ curl U τ, exactly orthogonal (Cayley)
//! ```
//!
//! Where the velocity is imposed, e takes what is left after the *unconstrained* change of ½U², and the velocity stays;
//! momentum and energy that the constraint puts in are reported. Frozen particles only translate.

use rayon::prelude::*;
use sph_core::dimension::{Components, Dimension};
use sph_core::lanes::{LANES, Line};
use sph_core::neighbors::TILE;
use sph_core::particles::{Constraint, Particles};
use sph_core::tiles::TiledColumn;
use sph_materials::{Damage, Material};

use crate::dimension::{SolidDimension, symmetric};
use crate::error::{Stage, StepError};
use crate::interventions::Interventions;
use crate::record::{Row, Sides, Sums};
use crate::scheme::{Settings, SurfaceTreatment, VolumeConsistency};
use crate::time_step::TimeStepReason;

/// Largest relative change of density that volume consistency makes in a step [-].
const LARGEST_RELAXATION: f64 = 1e-3;

/// What imposed velocities put into the particles in a step, tile by tile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConstraintInput {
    /// Momentum [kg m/s], per metre of depth in the plane.
    pub impulse: [f64; 3],
    /// Total energy [J], per metre of depth in the plane.
    pub work: f64,
}

/// What the update of a tile found.
#[derive(Clone, Copy, Debug, Default)]
pub struct TileReport {
    /// What imposed velocities put in.
    pub input: ConstraintInput,
    /// First particle with a state that cannot be.
    pub broken: Option<u32>,
    /// Work of the volume consistency: ∫ P dV of the density it changes [J], per metre of depth in the plane.
    pub relaxation_work: f64,
    /// Bounds that acted.
    pub interventions: Interventions,
}

/// The step at whose end something was found.
#[derive(Clone, Copy, Debug)]
pub struct StepEnd {
    /// Time at its end [s].
    pub time: f64,
    /// Its length [s].
    pub time_step: f64,
    /// Why it was as long.
    pub reason: TimeStepReason,
}

/// What the passes found.
#[derive(Clone, Copy)]
pub struct Outcome<'a> {
    /// Rows of blocks.
    pub rows: &'a [Line],
    /// Records of the contact pass.
    pub sides: &'a [Line],
    /// What pairs added up to.
    pub sums: &'a [Line],
}

/// What the passes found for one particle.
#[derive(Clone, Copy)]
struct Found<'a> {
    rows: &'a [Line],
    sides: &'a [Line],
    sums: &'a [Line],
    lane: usize,
}

impl<'a> Found<'a> {
    #[inline(always)]
    fn of<D: SolidDimension>(outcome: &Outcome<'a>, i: usize) -> Self {
        Self {
            rows: &outcome.rows[i / LANES * Row::count::<D>()..][..Row::count::<D>()],
            sides: &outcome.sides[i * D::SIDES_LINES..][..D::SIDES_LINES],
            sums: &outcome.sums[i * D::SUM_LINES..][..D::SUM_LINES],
            lane: i % LANES,
        }
    }
    #[inline(always)]
    fn row(&self, r: usize) -> f64 {
        self.rows[r].0[self.lane]
    }
    #[inline(always)]
    fn side(&self, k: usize) -> f64 {
        self.sides[k / LANES].0[k % LANES]
    }
    #[inline(always)]
    fn sum(&self, k: usize) -> f64 {
        self.sums[k / LANES].0[k % LANES]
    }
}

/// Columns of particles that a step changes.
struct Columns<'a, D: Dimension> {
    position: D::Axes<TiledColumn<'a, f64>>,
    velocity: D::Axes<TiledColumn<'a, f64>>,
    deviator: D::Tensor<TiledColumn<'a, f64>>,
    density: TiledColumn<'a, f64>,
    energy: TiledColumn<'a, f64>,
    plastic_strain: TiledColumn<'a, f64>,
    relative_speed: TiledColumn<'a, f64>,
    failed: TiledColumn<'a, bool>,
    distension: TiledColumn<'a, f64>,
}

/// What the update of one particle reads besides its own state.
struct Context<'a> {
    materials: &'a [Material],
    settings: &'a Settings,
    time_step: f64,
    /// Eigenvalue of L below which its inverse is capped [-]; zero where nothing is.
    least_eigenvalue: f64,
}

/// Advances all particles by one step. `reports` has one entry a tile.
pub fn update<D: SolidDimension>(
    particles: &mut Particles<D>,
    materials: &[Material],
    settings: &Settings,
    outcome: Outcome<'_>,
    time_step: f64,
    reports: &mut [TileReport],
) {
    fn tiled<D: Dimension>(columns: &mut D::AxisColumns) -> D::Axes<TiledColumn<'_, f64>> {
        let mut columns = columns.as_mut().iter_mut();
        Components::from_fn(|_| TiledColumn::new(columns.next().expect("one column an axis")))
    }
    let mut deviator = particles.deviator.as_mut().iter_mut();
    let columns = Columns::<D> {
        position: tiled::<D>(&mut particles.position),
        velocity: tiled::<D>(&mut particles.velocity),
        deviator: Components::from_fn(|_| TiledColumn::new(deviator.next().expect("one column a component"))),
        density: TiledColumn::new(&mut particles.density),
        energy: TiledColumn::new(&mut particles.specific_internal_energy),
        plastic_strain: TiledColumn::new(&mut particles.plastic_strain),
        relative_speed: TiledColumn::new(&mut particles.relative_speed),
        failed: TiledColumn::new(&mut particles.failed),
        distension: TiledColumn::new(&mut particles.distension),
    };
    let least_eigenvalue = match settings.surface {
        SurfaceTreatment::SpectralCap { cap } if settings.scheme.reconstructs() => 1.0 / cap,
        _ => 0.0,
    };
    let context = Context { materials, settings, time_step, least_eigenvalue };
    let fixed = Fixed {
        material: &particles.material,
        constraint: &particles.constraint,
        mass: &particles.mass,
        size: &particles.size,
        packing_excess: &particles.packing_excess,
    };
    reports.par_iter_mut().enumerate().for_each(|(t, report)| {
        // SAFETY: the parallel iterator visits every tile once, and these are the only parts taken.
        let mut tile = unsafe { TileColumns::<D>::take(&columns, t) };
        *report = TileReport::default();
        for k in 0..tile.density.len() {
            let i = t * TILE + k;
            tile.particle(k, i, &fixed, &context, Found::of::<D>(&outcome, i), report);
        }
    });
}

/// Columns that a step leaves as they are.
struct Fixed<'a> {
    material: &'a [u16],
    constraint: &'a [Constraint],
    mass: &'a [f64],
    size: &'a [f64],
    packing_excess: &'a [f64],
}

/// The parts of one tile. The components of vectors and tensors stand in fixed arrays, three and six being the most.
struct TileColumns<'a, D: Dimension> {
    position: [&'a mut [f64]; 3],
    velocity: [&'a mut [f64]; 3],
    deviator: [&'a mut [f64]; 6],
    density: &'a mut [f64],
    energy: &'a mut [f64],
    plastic_strain: &'a mut [f64],
    relative_speed: &'a mut [f64],
    failed: &'a mut [bool],
    distension: &'a mut [f64],
    dimension: std::marker::PhantomData<D>,
}

impl<'a, D: SolidDimension> TileColumns<'a, D> {
    /// # Safety
    /// As [`TiledColumn::tile`].
    unsafe fn take(columns: &Columns<'a, D>, t: usize) -> Self {
        // SAFETY: the caller's promise; each column is taken once below.
        unsafe {
            Self {
                position: std::array::from_fn(|a| {
                    if a < D::COUNT { columns.position[a].tile(t) } else { &mut [] }
                }),
                velocity: std::array::from_fn(|a| {
                    if a < D::COUNT { columns.velocity[a].tile(t) } else { &mut [] }
                }),
                deviator: std::array::from_fn(|k| {
                    if k < D::TENSOR_COUNT { columns.deviator[k].tile(t) } else { &mut [] }
                }),
                density: columns.density.tile(t),
                energy: columns.energy.tile(t),
                plastic_strain: columns.plastic_strain.tile(t),
                relative_speed: columns.relative_speed.tile(t),
                failed: columns.failed.tile(t),
                distension: columns.distension.tile(t),
                dimension: std::marker::PhantomData,
            }
        }
    }

    #[inline(always)]
    fn particle(
        &mut self,
        k: usize,
        i: usize,
        fixed: &Fixed<'_>,
        context: &Context<'_>,
        found: Found<'_>,
        report: &mut TileReport,
    ) {
        let tau = context.time_step;
        self.relative_speed[k] = found.sum(Sums::relative_speed_squared::<D>()).sqrt();
        let inverse_mass = 1.0 / fixed.mass[i];
        let acceleration: D::Axes<f64> = Components::from_fn(|a| found.sum(Sums::FORCE + a) * inverse_mass);
        let energy_change = tau * found.sum(Sums::power::<D>()) * inverse_mass;
        let centered = context.settings.scheme.is_time_centered();
        let constraint = fixed.constraint[i];
        let free = constraint == Constraint::Free;
        let mut kinetic = 0.0;
        for a in 0..D::COUNT {
            let (u, change) = (self.velocity[a][k], tau * acceleration[a]);
            kinetic += change * (u + 0.5 * change);
            if free {
                self.position[a][k] += tau * if centered { u + 0.5 * change } else { u };
                self.velocity[a][k] = u + change;
            } else {
                self.position[a][k] += tau * u;
                report.input.impulse[a] -= fixed.mass[i] * change;
            }
        }
        if constraint == Constraint::Frozen {
            report.input.work -= fixed.mass[i] * energy_change;
            return;
        }
        if !free {
            report.input.work -= fixed.mass[i] * kinetic;
        }
        let material = &context.materials[fixed.material[i] as usize];
        let gradient = velocity_gradient::<D>(found, context.settings);
        let divergence: f64 = (0..D::COUNT).map(|a| gradient[a][a]).sum();
        let relaxation = match context.settings.volume_consistency {
            Some(v) => relaxation_rate(&v, context.settings, fixed, i, found, tau),
            None => 0.0,
        };
        let acted = &mut report.interventions;
        acted.relaxation_bounded += u64::from(relaxation.abs() >= LARGEST_RELAXATION / tau);
        acted.inverse_capped += u64::from(found.row(Row::LEAST_EIGENVALUE) < context.least_eigenvalue);
        let flow_density = self.density[k] * (-tau * divergence).exp();
        self.density[k] =
            if relaxation == 0.0 { flow_density } else { flow_density * (tau * relaxation).exp() };
        report.relaxation_work += found.row(Row::PRESSURE)
            * fixed.mass[i]
            * found.row(Row::INVERSE_DENSITY)
            * relaxation.abs()
            * tau;
        self.energy[k] += energy_change - kinetic;
        self.advance_deviator(k, &gradient, material, tau);
        let damage = Damage { failed: self.failed[k], distension: self.distension[k] };
        let state = material.advance_failure(damage, self.density[k], self.energy[k], tau);
        report.interventions.failures += u64::from(state.damage.failed && !self.failed[k]);
        self.failed[k] = state.damage.failed;
        self.distension[k] = state.damage.distension;
        if state.strength_left < 1.0 {
            self.soften(k, state.strength_left, material);
        }
        // One sum finds what is not finite anywhere.
        let all = self.density[k]
            + self.energy[k]
            + kinetic
            + self.deviator[0][k]
            + self.deviator[D::TENSOR_COUNT - 1][k];
        if !(all.is_finite() && self.density[k] > 0.0 && state.pressure.is_finite())
            && report.broken.is_none()
        {
            report.broken = Some(i as u32);
        }
    }

    /// Brings the deviator back to what is left of the yield surface after failure.
    #[cold]
    fn soften(&mut self, k: usize, strength_left: f64, material: &Material) {
        let s: [f64; 6] =
            std::array::from_fn(|c| if c < D::TENSOR_COUNT { self.deviator[c][k] } else { 0.0 });
        let twice = |c: usize| if D::TENSOR_AXES[c].0 == D::TENSOR_AXES[c].1 { 1.0 } else { 2.0 };
        let invariant: f64 = (0..D::TENSOR_COUNT).map(|c| twice(c) * s[c] * s[c]).sum();
        // Yield at the share f of Y: at S:S/f² of the whole surface.
        let factor = match strength_left {
            0.0 => 0.0,
            share => material.strength.return_factor(invariant / (share * share)),
        };
        self.deviator.iter_mut().take(D::TENSOR_COUNT).for_each(|s| s[k] *= factor);
    }

    /// Elastic trial, rotation, return to the yield surface; equivalent plastic strain (σ_vM - Y)/(3 G).
    #[inline(always)]
    fn advance_deviator(&mut self, k: usize, gradient: &[[f64; 3]; 3], material: &Material, tau: f64) {
        let shear = material.strength.shear_modulus();
        if shear == 0.0 {
            return;
        }
        let mut s = [[0.0; 3]; 3];
        for (c, &(a, b)) in D::TENSOR_AXES.iter().enumerate() {
            s[a][b] = self.deviator[c][k];
            s[b][a] = s[a][b];
        }
        let third = (gradient[0][0] + gradient[1][1] + gradient[2][2]) / 3.0;
        for a in 0..3 {
            for b in 0..3 {
                let rate = 0.5 * (gradient[a][b] + gradient[b][a]) - if a == b { third } else { 0.0 };
                s[a][b] += 2.0 * shear * tau * rate;
            }
        }
        turn::<D>(&mut s, gradient, tau);
        let mut invariant = s[0][0] * s[0][0] + s[1][1] * s[1][1] + s[2][2] * s[2][2];
        invariant += 2.0 * (s[0][1] * s[0][1] + s[1][2] * s[1][2] + s[2][0] * s[2][0]);
        let factor = material.strength.return_factor(invariant);
        if factor < 1.0 {
            self.plastic_strain[k] += (1.5 * invariant).sqrt() * (1.0 - factor) / (3.0 * shear);
        }
        for (c, &(a, b)) in D::TENSOR_AXES.iter().enumerate() {
            self.deviator[c][k] = s[a][b] * factor;
        }
    }
}

/// S ← Q S Qᵀ with the Cayley rotation Q = I + 2/(1 + t²)(T + T²), T = ½τ W, W_kl = ½(∂U_k/∂x_l - ∂U_l/∂x_k).
#[inline(always)]
fn turn<D: Dimension>(s: &mut [[f64; 3]; 3], gradient: &[[f64; 3]; 3], tau: f64) {
    // gradient[a][b] = ∂U_b/∂x_a; half the angle about the axis that leads a to b.
    let half = |a: usize, b: usize| 0.25 * tau * (gradient[a][b] - gradient[b][a]);
    if D::COUNT == 2 {
        let t = half(0, 1);
        let inverse = 1.0 / (1.0 + t * t);
        let (cos, sin) = ((1.0 - t * t) * inverse, 2.0 * t * inverse);
        let (mean, difference) = (0.5 * (s[0][0] + s[1][1]), 0.5 * (s[0][0] - s[1][1]));
        let (cos2, sin2) = (cos * cos - sin * sin, 2.0 * cos * sin);
        let turned = difference * cos2 - s[0][1] * sin2;
        s[0][1] = difference * sin2 + s[0][1] * cos2;
        s[1][0] = s[0][1];
        s[0][0] = mean + turned;
        s[1][1] = mean - turned;
        return;
    }
    let t = [half(1, 2), half(2, 0), half(0, 1)];
    let square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    let scale = 2.0 / (1.0 + square);
    let cross = [[0.0, -t[2], t[1]], [t[2], 0.0, -t[0]], [-t[1], t[0], 0.0]];
    let mut q = [[0.0; 3]; 3];
    for a in 0..3 {
        for b in 0..3 {
            let identity = if a == b { 1.0 } else { 0.0 };
            q[a][b] = identity + scale * (cross[a][b] + t[a] * t[b] - identity * square);
        }
    }
    let old = *s;
    for a in 0..3 {
        for b in 0..3 {
            s[a][b] = (0..3).map(|c| (0..3).map(|d| q[a][c] * old[c][d] * q[b][d]).sum::<f64>()).sum();
        }
    }
}

/// ∂U_b/∂x_a at [a][b], from the raw sum R of the contact pass.
#[inline(always)]
fn velocity_gradient<D: SolidDimension>(found: Found<'_>, settings: &Settings) -> [[f64; 3]; 3] {
    let inverse_volume = 1.0 / found.side(Sides::volume::<D>()).abs();
    let raw = |a: usize, b: usize| found.sum(Sums::gradient::<D>() + a * D::COUNT + b) * inverse_volume;
    let k = |a: usize, b: usize| found.side(Sides::correction::<D>() + symmetric(D::COUNT, a, b));
    let l = |a: usize, b: usize| found.row(Row::gradient_matrix::<D>() + symmetric(D::COUNT, a, b));
    let mut turn = [[0.0; 3]; 3];
    if !settings.scheme.reconstructs() {
        // No correction: the raw sum is the gradient.
        for (a, b) in (0..D::COUNT).flat_map(|a| (0..D::COUNT).map(move |b| (a, b))) {
            turn[a][b] = raw(a, b);
        }
        return turn;
    }
    if matches!(settings.surface, SurfaceTreatment::SpectralCap { .. }) {
        turn = rigid_turn::<D>(raw, l);
    }
    let mut gradient = turn;
    for b in 0..D::COUNT {
        let mut rest = [0.0; 3];
        for a in 0..D::COUNT {
            rest[a] = raw(a, b) - (0..D::COUNT).map(|c| l(a, c) * turn[c][b]).sum::<f64>();
        }
        for a in 0..D::COUNT {
            gradient[a][b] += (0..D::COUNT).map(|c| k(a, c) * rest[c]).sum::<f64>();
        }
    }
    gradient
}

/// W_ab = ε_bca Ω_c with Ω = (tr L I - L)⁻¹ ε_eab R_ab.
#[inline(always)]
fn rigid_turn<D: SolidDimension>(
    raw: impl Fn(usize, usize) -> f64,
    matrix: impl Fn(usize, usize) -> f64,
) -> [[f64; 3]; 3] {
    let symmetric: D::Symmetric<f64> = Components::from_fn(|k| {
        let (a, b) = if k < D::COUNT { (k, k) } else { [(0, 1), (1, 2), (2, 0)][k - D::COUNT] };
        matrix(a, b)
    });
    let raw: D::Axes<D::Axes<f64>> = Components::from_fn(|a| Components::from_fn(|b| raw(a, b)));
    let spin = D::spin_solve(symmetric, crate::dimension::dual::<D, f64>(&raw));
    let mut turn = [[0.0; 3]; 3];
    for a in 0..D::COUNT {
        for b in 0..D::COUNT {
            turn[a][b] = crate::dimension::spin_matrix::<D, f64>(&spin, a, b);
        }
    }
    turn
}

/// r = d(ln ρ)/dt of the volume consistency [1/s]; see [`crate::volume`].
#[inline(always)]
fn relaxation_rate(
    v: &VolumeConsistency,
    settings: &Settings,
    fixed: &Fixed<'_>,
    i: usize,
    found: Found<'_>,
    tau: f64,
) -> f64 {
    let excess = fixed.packing_excess[i];
    let row = |r: usize| found.row(r);
    let yield_strength = row(Row::YIELD_STRENGTH);
    let share = if excess > v.tolerance {
        excess - v.tolerance
    } else if excess < -v.tolerance && excess > -v.void_deficit && row(Row::PRESSURE) > yield_strength {
        (excess + v.tolerance) * (1.0 + excess / v.void_deficit)
    } else {
        return 0.0;
    };
    let yields = yield_strength > 0.0 && yield_strength.is_finite();
    if !yields || fixed.constraint[i] != Constraint::Free {
        return 0.0;
    }
    let sound_speed = row(Row::LONGITUDINAL) * row(Row::INVERSE_DENSITY);
    let h = 2.0 * settings.smoothing * fixed.size[i];
    let largest = LARGEST_RELAXATION / tau;
    (v.rate * sound_speed / h * share).clamp(-largest, largest)
}

/// The error of the first broken particle, if any.
pub fn first_broken<D: SolidDimension>(
    reports: &[TileReport],
    particles: &Particles<D>,
    end: StepEnd,
) -> Option<StepError> {
    let i = reports.iter().find_map(|report| report.broken)? as usize;
    Some(StepError::Broken {
        particle: particles.id[i],
        position: (0..D::COUNT).map(|a| particles.position[a][i]).collect(),
        stage: Stage::Update,
        time: end.time,
        time_step: end.time_step,
        reason: end.reason,
        density: particles.density[i],
        specific_internal_energy: particles.specific_internal_energy[i],
    })
}
