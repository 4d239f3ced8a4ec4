//! A simulation and its step.
//!
//! [`Simulation::step`] is the only place where the order of a step stands. State lives in [`Particles`], in cell order
//! with stable ids; scratch is kept from step to step. Results have the same bits for any number of threads.

use std::time::Instant;

use rayon::prelude::*;
use sph_core::dimension::{Components, Vector};
use sph_core::domain::Domain;
use sph_core::lanes::{InstructionSet, LANES, Line};
use sph_core::neighbors::cell_grid::sort_particles;
use sph_core::neighbors::{DisplacementRange, NeighborLists, Reach, TILE};
use sph_core::particles::{Constraint, Particles};
use sph_core::reduce;
use sph_materials::Material;

use crate::dimension::SolidDimension;
use crate::error::{SetupError, StepError};
use crate::interventions::Interventions;
use crate::pass::{CenteredPairs, Pass, PassKind, Smoothing, find_pairs};
use crate::record::Row;
use crate::restart::Clock;
use crate::scheme::{FaceClosure, Scheme, Settings, SurfaceTreatment};
use crate::stage_times::{StageTimes, StepStage};
use crate::time_step::{TimeStepReason, courant_step, signal_speed};
use crate::update::{StepEnd, TileReport, first_broken, update};
use crate::{prepare, surface, volume};

/// Below this eigenvalue of L the half step is centred on the true acceleration.
const CENTERING_EIGENVALUE: f64 = 0.75;

/// Particles that move by the equations of a scheme.
pub struct Simulation<D: SolidDimension> {
    domain: Domain<D>,
    materials: Vec<Material>,
    settings: Settings,
    particles: Particles<D>,
    time: f64,
    step_count: u64,
    particle_steps: u64,
    relaxation_work: f64,
    interventions: Interventions,
    lists: NeighborLists<D>,
    lists_valid: bool,
    scratch: Scratch,
    stage_times: StageTimes,
    instructions: InstructionSet,
}

/// Arrays that live as long as the neighbour lists.
#[derive(Default)]
struct Scratch {
    state: Vec<Line>,
    sides: Vec<Line>,
    rows: Vec<Line>,
    size: Vec<f64>,
    rule: Vec<f64>,
    faces: [Vec<Line>; 2],
    delta: Vec<Vec<f64>>,
    moved: Vec<bool>,
    centered: Vec<CenteredPairs>,
    reports: Vec<TileReport>,
    steps: Vec<(f64, u32)>,
    ranges: Vec<DisplacementRange>,
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport<D: SolidDimension> {
    /// Length of the step τ [s].
    pub time_step: f64,
    /// Why it was as long as it was.
    pub reason: TimeStepReason,
    /// True if the neighbour lists were rebuilt, and the particles sorted anew, before the step.
    pub rebuilt: bool,
    /// Momentum that imposed velocities put in [kg m/s], per metre of depth in the plane.
    pub constraint_impulse: D::Vector,
    /// Energy that imposed velocities put in [J], per metre of depth in the plane.
    pub constraint_work: f64,
}

/// Sums over all particles, per metre of depth in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals<D: SolidDimension> {
    /// Mass [kg].
    pub mass: f64,
    /// Momentum [kg m/s].
    pub momentum: D::Vector,
    /// Kinetic energy [J].
    pub kinetic_energy: f64,
    /// Internal energy, elastic energy included [J].
    pub internal_energy: f64,
}

impl<D: SolidDimension> Simulation<D> {
    /// A simulation of `particles` in `domain`.
    ///
    /// # Errors
    /// Settings outside their range, materials or particles that cannot be.
    pub fn new(
        domain: Domain<D>,
        materials: Vec<Material>,
        particles: Particles<D>,
        settings: Settings,
    ) -> Result<Self, SetupError> {
        check(&domain, &materials, &particles, &settings)?;
        Ok(Self {
            domain,
            materials,
            settings,
            particles,
            time: 0.0,
            step_count: 0,
            particle_steps: 0,
            relaxation_work: 0.0,
            interventions: Interventions::default(),
            lists: NeighborLists::default(),
            lists_valid: false,
            scratch: Scratch::default(),
            stage_times: StageTimes::default(),
            instructions: InstructionSet::detect(),
        })
    }

    /// The same simulation with other instructions than the widest of this machine: the bits do not change, the speed
    /// does.
    ///
    /// # Panics
    /// Later, in a step, if the machine does not have them.
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.instructions = instructions;
        self
    }

    /// One step, as long as the Courant number allows.
    ///
    /// # Errors
    /// A particle whose state cannot be, or a time step that has fallen to nothing.
    pub fn step(&mut self) -> Result<StepReport<D>, StepError> {
        self.step_at_most(f64::INFINITY)
    }

    /// One step, not longer than `limit` [s].
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn step_at_most(&mut self, limit: f64) -> Result<StepReport<D>, StepError> {
        let mut clock = Instant::now();
        let rebuilt = self.lists_stale();
        if rebuilt {
            self.rebuild_lists();
            self.stage_times.add(StepStage::Lists, &mut clock);
            self.measure_volumes();
            self.stage_times.add(StepStage::Volume, &mut clock);
        }
        self.prepare();
        let (time_step, reason) = self.choose_time_step(limit)?;
        self.stage_times.add(StepStage::Prepare, &mut clock);
        self.find_sides(time_step);
        self.stage_times.add(StepStage::Gradient, &mut clock);
        self.solve_contacts();
        self.stage_times.add(StepStage::Contact, &mut clock);
        self.center_in_time(time_step);
        self.stage_times.add(StepStage::Centering, &mut clock);
        let report = self.update(time_step);
        self.stage_times.add(StepStage::Update, &mut clock);
        self.finish(report, time_step, reason, rebuilt)
    }

    /// Sorts the particles in cell order and finds their neighbours.
    fn rebuild_lists(&mut self) {
        let reach = self.reach();
        let largest = self.particles.size.iter().fold(0.0_f64, |a, &b| a.max(b));
        sort_particles(&mut self.particles, &self.domain, 2.0 * reach.factor * largest + reach.skin);
        let positions = self.particles.position.clone();
        self.find_neighbors(&positions);
        self.stage_times.rebuilds += 1;
    }

    fn reach(&self) -> Reach {
        let largest = self.particles.size.iter().fold(0.0_f64, |a, &b| a.max(b));
        Reach {
            factor: self.settings.kernel.support() * self.settings.smoothing,
            skin: self.settings.skin * largest,
        }
    }

    /// Lists for the particles at the given positions, and scratch of their size.
    pub(crate) fn find_neighbors(&mut self, positions: &D::AxisColumns) {
        self.lists = NeighborLists::build(positions, &self.particles.size, &self.domain, self.reach());
        self.lists_valid = true;
        let (records, padded) = (self.lists.n_records(), self.lists.n_padded());
        let tiles = self.lists.n_particles.div_ceil(TILE);
        let s = &mut self.scratch;
        s.state.resize(records * D::STATE_LINES, Line::default());
        s.sides.resize(records * D::SIDES_LINES, Line::default());
        s.rows.resize(padded / LANES * Row::count::<D>(), Line::default());
        s.size.clear();
        s.size.extend_from_slice(&self.particles.size);
        s.size.resize(padded, self.particles.size.first().copied().unwrap_or(1.0));
        s.size.extend(self.lists.halo.owner.iter().map(|&o| self.particles.size[o as usize]));
        s.delta.resize(D::COUNT, Vec::new());
        s.delta.iter_mut().for_each(|d| d.resize(records, 0.0));
        s.moved.resize(records, false);
        s.centered.resize(tiles, CenteredPairs::default());
        s.reports.resize(tiles, TileReport::default());
        s.steps.resize(tiles, (0.0, 0));
    }

    fn measure_volumes(&mut self) {
        if let Some(settings) = self.settings.volume_consistency {
            volume::measure(&mut self.particles, &self.domain, &settings, self.instructions);
        }
    }

    /// Equations of state, and the records that the first pass reads.
    fn prepare(&mut self) {
        let s = &mut self.scratch;
        prepare::prepare(&self.particles, &self.materials, &mut s.state, &mut s.rows);
        self.lists.halo.refresh(&mut s.state, D::STATE_LINES, self.lists.n_padded());
    }

    fn choose_time_step(&mut self, limit: f64) -> Result<(f64, TimeStepReason), StepError> {
        let s = &mut self.scratch;
        let (step, reason) = courant_step(&self.particles, &s.rows, self.settings.courant, &mut s.steps);
        let (step, reason) = if step > limit { (limit, TimeStepReason::Limit) } else { (step, reason) };
        if !(step > 0.0 && step.is_finite()) || self.time + step == self.time {
            let TimeStepReason::Courant { particle, .. } = reason else { return Ok((step, reason)) };
            return Err(StepError::TimeStep {
                time_step: step,
                time: self.time,
                particle,
                signal_speed: signal_speed(reason),
            });
        }
        Ok((step, reason))
    }

    /// The records that the contact pass reads: sides half a step later with their slopes, or the state as it is.
    fn find_sides(&mut self, time_step: f64) {
        let padded = self.lists.n_padded();
        let s = &mut self.scratch;
        if self.settings.scheme.reconstructs() {
            let by_rule = surface::marks(&self.lists, &self.settings, &s.state, &s.size, &mut s.rule);
            let pass = Pass {
                kind: PassKind::Gradient(by_rule.then_some(s.rule.as_slice())),
                lists: &self.lists,
                smoothing: Smoothing::new(self.settings.kernel, self.settings.smoothing, D::COUNT, &s.size),
                surface: self.settings.surface,
                records: &s.state,
                half_step: if self.settings.scheme.is_time_centered() { 0.5 * time_step } else { 0.0 },
                instructions: self.instructions,
            };
            pass.run(&mut s.sides, &mut s.rows);
        } else {
            prepare::piecewise_constant_sides::<D>(
                &s.state,
                &s.rows,
                &mut s.sides[..padded * D::SIDES_LINES],
            );
        }
        self.lists.halo.refresh(&mut s.sides, D::SIDES_LINES, padded);
    }

    fn solve_contacts(&mut self) {
        let kind = match self.settings.scheme {
            Scheme::Csph => PassKind::PlainContact,
            Scheme::TkcMuscl | Scheme::TkcHancock => PassKind::Contact(self.settings.limiter),
        };
        let pass = Pass {
            kind,
            lists: &self.lists,
            smoothing: Smoothing::new(
                self.settings.kernel,
                self.settings.smoothing,
                D::COUNT,
                &self.scratch.size,
            ),
            surface: self.effective_surface(),
            records: &self.scratch.sides,
            half_step: 0.0,
            instructions: self.instructions,
        };
        pass.run(&mut [], &mut self.scratch.rows);
        if let Some(FaceClosure { sweeps }) = self.settings.face_closure {
            pass.close_faces(sweeps, &mut self.scratch.faces, &mut self.scratch.rows);
        }
    }

    /// The half step of the velocity follows the true acceleration near free surfaces.
    fn center_in_time(&mut self, time_step: f64) {
        let capped = matches!(self.settings.surface, SurfaceTreatment::SpectralCap { .. });
        if !capped || !self.settings.scheme.is_time_centered() || !self.find_deltas(time_step) {
            return;
        }
        let s = &mut self.scratch;
        let mut pass = Pass {
            kind: PassKind::Contact(self.settings.limiter),
            lists: &self.lists,
            smoothing: Smoothing::new(self.settings.kernel, self.settings.smoothing, D::COUNT, &s.size),
            surface: self.settings.surface,
            records: &s.sides,
            half_step: 0.0,
            instructions: self.instructions,
        };
        find_pairs(&pass, &s.moved, &mut s.centered);
        pass.kind = PassKind::Centering(self.settings.limiter, &s.delta, &s.centered);
        pass.run(&mut [], &mut s.rows);
    }

    /// δ of free particles at free surfaces. False if there is none.
    fn find_deltas(&mut self, time_step: f64) -> bool {
        let s = &mut self.scratch;
        let (n, padded) = (self.lists.n_particles, self.lists.n_padded());
        let (rows, constraint) = (&s.rows, &self.particles.constraint);
        let row = |i: usize, r: usize| rows[i / LANES * Row::count::<D>() + r].0[i % LANES];
        s.moved[..n].par_iter_mut().with_min_len(TILE).enumerate().for_each(|(i, moved)| {
            let at_surface = row(i, Row::LEAST_EIGENVALUE) < CENTERING_EIGENVALUE;
            *moved = at_surface && constraint[i] == Constraint::Free;
        });
        let moved = &s.moved;
        for (a, delta) in s.delta.iter_mut().enumerate() {
            delta[..n].par_iter_mut().with_min_len(TILE).enumerate().for_each(|(i, delta)| {
                let change = || {
                    let acceleration = row(i, Row::FORCE + a) * row(i, Row::INVERSE_DENSITY);
                    0.5 * time_step * acceleration - row(i, Row::half_step::<D>() + a)
                };
                *delta = if moved[i] { change() } else { 0.0 };
            });
        }
        for (h, &owner) in self.lists.halo.owner.iter().enumerate() {
            s.moved[padded + h] = s.moved[owner as usize];
            s.delta.iter_mut().for_each(|delta| delta[padded + h] = delta[owner as usize]);
        }
        s.moved[..n].contains(&true)
    }

    fn update(&mut self, time_step: f64) -> TileReport {
        let s = &mut self.scratch;
        update(&mut self.particles, &self.materials, &self.settings, &s.rows, time_step, &mut s.reports);
        let mut sum = TileReport::default();
        for report in &s.reports {
            (0..3).for_each(|a| sum.input.impulse[a] += report.input.impulse[a]);
            sum.input.work += report.input.work;
            sum.relaxation_work += report.relaxation_work;
            sum.interventions += report.interventions;
        }
        sum
    }

    fn finish(
        &mut self,
        report: TileReport,
        time_step: f64,
        reason: TimeStepReason,
        rebuilt: bool,
    ) -> Result<StepReport<D>, StepError> {
        self.time += time_step;
        self.step_count += 1;
        self.particle_steps += self.particles.len() as u64;
        self.relaxation_work += report.relaxation_work;
        self.interventions += report.interventions;
        let end = StepEnd { time: self.time, time_step, reason };
        if let Some(error) = first_broken(&self.scratch.reports, &self.particles, end) {
            return Err(error);
        }
        self.lists_valid = !self.lists.outlived(&self.particles.position, &mut self.scratch.ranges);
        let impulse = D::vector(|a| report.input.impulse[a]);
        Ok(StepReport {
            time_step,
            reason,
            rebuilt,
            constraint_impulse: impulse,
            constraint_work: report.input.work,
        })
    }

    /// CSPH knows no correction: no treatment either.
    fn effective_surface(&self) -> SurfaceTreatment {
        if self.settings.scheme.reconstructs() { self.settings.surface } else { SurfaceTreatment::None }
    }

    /// True when the next step will rebuild the neighbour lists: the moment to insert and remove particles.
    pub fn lists_stale(&self) -> bool {
        !self.lists_valid
    }

    /// True if there are lists that the next step will use.
    pub(crate) fn lists_hold(&self) -> bool {
        self.lists_valid
    }

    pub(crate) fn set_clock(&mut self, clock: Clock) {
        self.time = clock.time;
        self.step_count = clock.step_count;
        self.particle_steps = clock.particle_steps;
        self.relaxation_work = clock.relaxation_work;
        self.interventions = clock.interventions;
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Number of steps.
    pub fn step_count(&self) -> u64 {
        self.step_count
    }

    /// Sum over the steps of the number of particles.
    pub fn particle_steps(&self) -> u64 {
        self.particle_steps
    }

    /// The particles, in cell order.
    pub fn particles(&self) -> &Particles<D> {
        &self.particles
    }

    /// The particles, to insert, remove and change: lists are rebuilt before the next step.
    pub fn particles_mut(&mut self) -> &mut Particles<D> {
        self.lists_valid = false;
        &mut self.particles
    }

    /// The velocities, to change their values only: lists stay.
    pub fn velocities_mut(&mut self) -> &mut D::AxisColumns {
        &mut self.particles.velocity
    }

    /// Adds one velocity [m/s] to every particle: a change of frame.
    pub fn boost(&mut self, velocity: D::Vector) {
        for a in 0..D::COUNT {
            self.particles.velocity[a].iter_mut().for_each(|u| *u += velocity[a]);
        }
    }

    /// Stress of particle `i` [Pa].
    pub fn stress(&self, i: usize) -> D::Tensor<f64> {
        prepare::stress(&self.particles, &self.materials, i)
    }

    /// Pressure of particle `i` [Pa].
    pub fn pressure(&self, i: usize) -> f64 {
        prepare::pressure(&self.particles, &self.materials, i)
    }

    /// Longitudinal sound speed of particle `i` [m/s].
    pub fn longitudinal_sound_speed(&self, i: usize) -> f64 {
        let material = &self.materials[self.particles.material[i] as usize];
        material
            .longitudinal_sound_speed(self.particles.density[i], self.particles.specific_internal_energy[i])
    }

    /// The materials.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The settings of the scheme.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The box.
    pub fn domain(&self) -> &Domain<D> {
        &self.domain
    }

    /// The neighbour lists of the last step.
    pub fn lists(&self) -> &NeighborLists<D> {
        &self.lists
    }

    /// Seconds by stage.
    pub fn stage_times(&self) -> &StageTimes {
        &self.stage_times
    }

    /// ∫ |P dV| of the density that volume consistency changed [J], per metre of depth in the plane.
    pub fn relaxation_work(&self) -> f64 {
        self.relaxation_work
    }

    /// How often a bound acted since the start.
    pub fn interventions(&self) -> Interventions {
        self.interventions
    }

    /// Bytes of particles, lists and scratch.
    pub fn bytes(&self) -> usize {
        let n = self.particles.len();
        let s = &self.scratch;
        let lines = s.state.len() + s.sides.len() + s.rows.len();
        let columns = self.particles.columns().len() * 8 + 8 + 2 + 1 + 1;
        lines * 64 + s.size.len() * 8 + s.delta.len() * s.size.len() * 8 + n * columns + self.lists.bytes()
    }

    /// Sums over all particles, in an order of their own: the same bits for any number of threads.
    pub fn totals(&self) -> Totals<D> {
        let p = &self.particles;
        let n = p.len();
        let kinetic = |i: usize| 0.5 * p.mass[i] * p.velocity_of(i).dot(p.velocity_of(i));
        Totals {
            mass: reduce::sum(&p.mass),
            momentum: D::vector(|a| reduce::sum_of(n, |i| p.mass[i] * p.velocity[a][i])),
            kinetic_energy: reduce::sum_of(n, kinetic),
            internal_energy: reduce::sum_of(n, |i| p.mass[i] * p.specific_internal_energy[i]),
        }
    }
}

fn check<D: SolidDimension>(
    domain: &Domain<D>,
    materials: &[Material],
    particles: &Particles<D>,
    settings: &Settings,
) -> Result<(), SetupError> {
    let faults = settings.faults();
    if !faults.is_empty() {
        return Err(SetupError::Settings(faults));
    }
    for material in materials {
        material.validate().map_err(|faults| SetupError::Material {
            name: material.name.clone(),
            faults: faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "),
        })?;
    }
    for axis in (0..D::COUNT).filter(|&a| domain.periodic[a]) {
        let period = domain.period(axis);
        if !(period > 0.0 && period.is_finite()) {
            return Err(SetupError::Period { axis, period });
        }
    }
    (0..particles.len()).try_for_each(|i| check_particle(particles, i, materials.len()))
}

fn check_particle<D: SolidDimension>(
    particles: &Particles<D>,
    i: usize,
    count: usize,
) -> Result<(), SetupError> {
    let particle = particles.id[i];
    let material = particles.material[i];
    if material as usize >= count {
        return Err(SetupError::NoSuchMaterial { particle, material, count });
    }
    let fault = |field, value, unit| Err(SetupError::Particle { particle, field, value, unit });
    for (field, value, unit) in [
        ("mass", particles.mass[i], "kg"),
        ("size", particles.size[i], "m"),
        ("density", particles.density[i], "kg/m3"),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return fault(field, value, unit);
        }
    }
    let energy = particles.specific_internal_energy[i];
    if !energy.is_finite() {
        return fault("specific internal energy", energy, "J/kg");
    }
    let coordinates: D::Axes<f64> =
        Components::from_fn(|a| particles.position[a][i] + particles.velocity[a][i]);
    match (0..D::COUNT).find(|&a| !coordinates[a].is_finite()) {
        Some(a) => fault("position or velocity", coordinates[a], "m or m/s"),
        None => Ok(()),
    }
}
