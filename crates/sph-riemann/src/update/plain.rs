//! The update of one particle, in plain code: what the lanes are held to.

use sph_core::dimension::{Components, Dimension};
use sph_core::lanes::{LANES, Line};
use sph_core::particles::Constraint;
use sph_materials::{Damage, Material};

use super::{Context, Fixed, LARGEST_RELAXATION, Outcome, TileColumns, TileReport, UpdateTile};
use crate::dimension::{SolidDimension, symmetric};
use crate::record::{Prepared, Row, Sides, Sums};
use crate::scheme::{Settings, SurfaceTreatment, VolumeConsistency};

/// What the passes found for one particle.
#[derive(Clone, Copy)]
struct Found<'a> {
    rows: &'a [Line],
    sides: &'a [Line],
    sums: &'a [Line],
    lane: usize,
}

impl<'a> Found<'a> {
    fn of<D: SolidDimension>(context: &Context<'a>, i: usize, rows: &'a [Line], sums: &'a [Line]) -> Self {
        // There are none without reconstruction.
        let first = (i * D::SIDES_LINES).min(context.sides.len());
        Self { rows, sides: &context.sides[first..], sums, lane: i % LANES }
    }
    fn row(&self, r: usize) -> f64 {
        self.rows[r].0[self.lane]
    }
    fn side(&self, k: usize) -> f64 {
        self.sides[k / LANES].0[k % LANES]
    }
    fn sum(&self, k: usize) -> f64 {
        self.sums[k / LANES].0[k % LANES]
    }
}

/// Updates all particles of a tile.
fn update_tile<D: SolidDimension>(tile: UpdateTile<'_, D>) {
    let UpdateTile { mut columns, first, fixed, context, written } = tile;
    for k in 0..columns.density.len() {
        let rows = &written.rows[k / LANES * Row::count::<D>()..][..Row::count::<D>()];
        let found = Found::of::<D>(context, first + k, rows, &written.sums[k * D::SUM_LINES..]);
        columns.particle(k, first + k, fixed, context, found, written.report);
    }
}

impl<D: SolidDimension> TileColumns<'_, D> {
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
        let material = &context.matter.materials()[fixed.material[i] as usize];
        let gradient = velocity_gradient::<D>(found, fixed.mass[i], context.settings);
        let divergence: f64 = (0..D::COUNT).map(|a| gradient[a][a]).sum();
        let relaxation = match context.settings.volume_consistency {
            Some(v) => relaxation_rate(&v, context, fixed, i, found),
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
fn velocity_gradient<D: SolidDimension>(found: Found<'_>, mass: f64, settings: &Settings) -> [[f64; 3]; 3] {
    let inverse_volume = 1.0 / (mass * found.row(Row::INVERSE_DENSITY));
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
fn relaxation_rate(
    v: &VolumeConsistency,
    context: &Context<'_>,
    fixed: &Fixed<'_>,
    i: usize,
    found: Found<'_>,
) -> f64 {
    let (settings, tau) = (context.settings, context.time_step);
    let excess = fixed.packing_excess[i];
    let row = |r: usize| found.row(r);
    let yield_strength = context.matter.materials()[fixed.material[i] as usize].strength.yield_strength();
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

mod tests {
    use sph_core::domain::Domain;
    use sph_core::lanes::InstructionSet;
    use sph_core::particles::{Particle, Particles};
    use sph_core::{Dim2, Dim3, Vector};
    use sph_materials::{Failure, Strength, VoidGrowth, library};

    use super::super::for_each_tile;
    use super::*;
    use crate::matter::Matter;
    use crate::simulation::Simulation;

    const SIZE: f64 = 1e-6;

    /// Copper, a copper with voids, a fluid.
    fn materials(with_voids: bool) -> Vec<Material> {
        let copper = library::material("porous-copper").expect("a library material");
        let mut other = copper.clone();
        if with_voids {
            other.failure = Failure::VoidGrowth(VoidGrowth::of_strength(0.35e9));
        }
        let fluid = Material { strength: Strength::Fluid, failure: Failure::None, ..copper.clone() };
        vec![copper, other, fluid]
    }

    /// A ball that tears itself apart on one side and is pressed on the other, some of it held, with a pore.
    fn ball<D: SolidDimension>(cells: usize, settings: Settings, materials: Vec<Material>) -> Simulation<D> {
        let mut particles = Particles::<D>::default();
        for cell in 0..cells.pow(D::COUNT as u32) {
            let index = |a: usize| (cell / cells.pow(a as u32) % cells) as f64;
            let position = D::vector(|a| (index(a) + 0.5 + 0.05 * (index(0) + a as f64).sin()) * SIZE);
            let middle = D::vector(|_| 0.5 * cells as f64 * SIZE);
            if (position - middle).length() < 2.0 * SIZE {
                continue;
            }
            let mass = 8960.0 * SIZE.powi(D::COUNT as i32);
            let mut particle = Particle::at_rest(cell as u64, position, mass, SIZE, 8960.0);
            particle.velocity = (position - middle) * (40.0 * (index(0) - 3.0) / SIZE);
            particle.material = (cell % 11 / 4) as u16;
            particle.constraint = match cell % 17 {
                3 => Constraint::ImposedVelocity,
                5 => Constraint::Frozen,
                _ => Constraint::Free,
            };
            particles.push(particle);
        }
        Simulation::new(Domain::open(), materials, particles, settings).expect("a sound set-up")
    }

    fn lanes_agree<D: SolidDimension>(cells: usize, settings: Settings, with_voids: bool) {
        let mut simulation = ball::<D>(cells, settings, materials(with_voids));
        let (mut failed, mut yielded) = (0, 0);
        for step in 0..12 {
            if simulation.lists_stale() {
                simulation.rebuild_lists();
                simulation.measure_volumes();
            }
            simulation.prepare();
            let (time_step, _) = simulation.choose_time_step(f64::INFINITY).expect("a sound step");
            simulation.find_sides(time_step);
            simulation.solve_contacts();
            simulation.center_in_time(time_step);
            let mut plain = simulation.particles.clone();
            let mut reports = vec![TileReport::default(); plain.len().div_ceil(256)];
            let scratch = &simulation.scratch;
            let (mut rows, mut sides) = (scratch.rows.clone(), scratch.sides.clone());
            let (mut sums, mut least) = (scratch.state.clone(), scratch.least.clone());
            sums.truncate(simulation.lists.n_padded() * D::SUM_LINES);
            let outcome = Outcome {
                rows: &mut rows,
                sides: &mut sides,
                sums: &mut sums,
                lists: &simulation.lists,
                pairs: &scratch.pairs,
                least: &mut least,
            };
            let matter = Matter::new(simulation.materials().to_vec());
            let how = (time_step, InstructionSet::Plain);
            for_each_tile::<D>(&mut plain, &matter, &settings, outcome, how, &mut reports, update_tile);
            let lanes = simulation.update(time_step);
            same(&simulation.particles, &plain, step);
            leaves_what_preparation_fills(&mut simulation);
            let mut sum = TileReport::default();
            for report in &reports {
                assert_eq!(report.broken, None);
                (0..3).for_each(|a| sum.input.impulse[a] += report.input.impulse[a]);
                sum.input.work += report.input.work;
                sum.relaxation_work += report.relaxation_work;
                sum.interventions += report.interventions;
            }
            assert_eq!(lanes.interventions, sum.interventions);
            let scale = 1e-9 * (sum.input.work.abs() + sum.relaxation_work + 1e-12);
            assert!((lanes.input.work - sum.input.work).abs() < scale);
            assert!((lanes.relaxation_work - sum.relaxation_work).abs() < scale);
            simulation.lists_valid = step % 4 != 3;
            failed = failed.max(plain.failed.iter().filter(|&&f| f).count());
            yielded = yielded.max(plain.plastic_strain.iter().filter(|&&s| s > 0.0).count());
        }
        assert!(failed > 5 && yielded > 5, "{failed} have failed, {yielded} have yielded");
    }

    /// The update leaves the bits behind that the preparation of the next step would fill in.
    fn leaves_what_preparation_fills<D: SolidDimension>(simulation: &mut Simulation<D>) {
        let bits = |simulation: &Simulation<D>| {
            let prepared = simulation.settings.scheme.prepared();
            let scratch = &simulation.scratch;
            let records = if prepared == Prepared::State { &scratch.state } else { &scratch.sides };
            let records = &records[..simulation.lists.n_padded() * prepared.lines::<D>()];
            let of_lines = |lines: &[Line]| lines.iter().flat_map(|l| l.0.map(f64::to_bits)).collect();
            let least: Vec<_> = scratch.least.iter().map(|least| (least.0.to_bits(), least.1)).collect();
            let before = simulation.particles.len().div_ceil(LANES) * Row::count::<D>();
            let (rows, count) = (&scratch.rows[..before], Row::count::<D>());
            let rows: Vec<Vec<u64>> = rows.chunks(count).map(|r| of_lines(&r[..Row::COUNT_BEFORE])).collect();
            let records: Vec<u64> = of_lines(records);
            (records, rows, least)
        };
        assert!(simulation.is_prepared);
        let left = bits(simulation);
        simulation.is_prepared = false;
        simulation.prepare();
        assert!(left == bits(simulation));
    }

    /// Columns agree to rounding, as seen from the largest value of each.
    fn same<D: SolidDimension>(lanes: &Particles<D>, plain: &Particles<D>, step: usize) {
        assert_eq!(lanes.failed, plain.failed, "step {step}");
        for ((name, a), (_, b)) in lanes.columns().iter().zip(plain.columns()) {
            let scale = b.iter().fold(1e-300_f64, |m, x| m.max(x.abs()));
            for (i, (x, y)) in a.iter().zip(b).enumerate() {
                let near = (x - y).abs() <= 1e-11 * scale;
                assert!(near, "{name} of particle {i} in step {step}: {x:e} in lanes, {y:e} in plain code");
            }
        }
    }

    #[test]
    fn the_update_in_lanes_is_that_of_one_particle() {
        for with_voids in [false, true] {
            lanes_agree::<Dim2>(15, Settings::default(), with_voids);
            lanes_agree::<Dim3>(8, Settings::default(), with_voids);
        }
        lanes_agree::<Dim2>(15, Settings::for_scheme(crate::Scheme::Csph), false);
        lanes_agree::<Dim2>(15, Settings::for_scheme(crate::Scheme::TkcMuscl), false);
    }
}
