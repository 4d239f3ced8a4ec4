//! The stages of a step, and the arrays that they hand on to each other.

use std::time::Instant;

use sph_core::lanes::{LANES, Line};
use sph_core::memory::resize_scratch;
use sph_core::neighbors::cell_grid::sort_particles;
use sph_core::neighbors::{NeighborLists, Reach};

use crate::check::check_particles;
use crate::dimension::SolidDimension;
use crate::error::StepError;
use crate::pass::{Deltas, Pass, Sizes, Smoothing, TilePairs};
use crate::record::{Prepared, Row};
use crate::scheme::{FaceClosure, SurfaceTreatment};
use crate::simulation::{Simulation, StepReport};
use crate::stage_times::StepStage;
use crate::time_step::{LeastStep, TimeStepReason, courant_step, signal_speed};
use crate::update::{Outcome, StepEnd, TileReport, first_broken, update};
use crate::{prepare, surface, volume};

/// By how much particles move against each other from one volume sum to the next, in particle sizes [-].
const MOTION_BETWEEN_MEASURES: f64 = 0.2 / 3.0;

/// Arrays that live as long as the neighbor lists.
#[derive(Default)]
pub(crate) struct Scratch {
    /// Records of the first pass; once it is over, what the pairs of the others add up to.
    pub(crate) state: Vec<Line>,
    /// Records of the second pass, and of time-centering.
    pub(crate) sides: Vec<Line>,
    pub(crate) rows: Vec<Line>,
    /// What the pairs of each tile leave behind.
    pub(crate) pairs: Vec<TilePairs>,
    /// Sizes of the particles that records show, if they are not all the same.
    size: Vec<f64>,
    uniform_size: Option<f64>,
    rule: Vec<f64>,
    /// Face records, twice, where faces are closed.
    faces: [Vec<Line>; 2],
    reports: Vec<TileReport>,
    /// Least step that each tile allows.
    pub(crate) least: Vec<LeastStep>,
}

impl Scratch {
    fn sizes(&self) -> Sizes<'_> {
        self.uniform_size.map_or(Sizes::Each(&self.size), Sizes::Uniform)
    }

    /// Bytes in use.
    pub(crate) fn bytes(&self) -> usize {
        let faces: usize = self.faces.iter().map(Vec::len).sum();
        let lines = self.state.len() + self.sides.len() + self.rows.len() + faces;
        let pairs: usize = self.pairs.iter().map(TilePairs::bytes).sum();
        lines * size_of::<Line>() + pairs + (self.size.len() + self.rule.len()) * 8
    }
}

impl<D: SolidDimension> Simulation<D> {
    /// Fails if a step of at most `limit` [s] cannot be made: with the first particle that cannot be, if any may have been changed
    /// from outside.
    pub(crate) fn check_step(&mut self, limit: f64) -> Result<(), StepError> {
        if limit.is_nan() || limit <= 0.0 {
            return Err(StepError::Limit { limit });
        }
        if self.particles.is_empty() {
            return Err(StepError::Empty);
        }
        if !self.is_checked {
            check_particles(&self.particles, self.matter.materials().len()).map_err(StepError::Particle)?;
            self.is_checked = true;
        }
        Ok(())
    }

    /// Sorts the particles in cell order and finds their neighbors.
    pub(crate) fn rebuild_lists(&mut self) {
        let reach = self.reach();
        let largest = self.particles.size.iter().fold(0.0_f64, |a, &b| a.max(b));
        sort_particles(&mut self.particles, &self.domain, 2.0 * reach.factor * largest + reach.skin);
        let (positions, sizes) = (&self.particles.position, &self.particles.size);
        self.lists.rebuild_with(self.instructions, positions, sizes, &self.domain, reach);
        self.fit_scratch();
        self.stage_times.rebuilds += 1;
    }

    fn reach(&self) -> Reach {
        let largest = self.particles.size.iter().fold(0.0_f64, |a, &b| a.max(b));
        Reach {
            factor: self.settings.kernel.support() * self.settings.smoothing,
            skin: self.settings.skin_width(D::COUNT) * largest,
        }
    }

    /// Lists as they were built for the particles at the given positions.
    pub(crate) fn find_neighbors(&mut self, positions: &D::AxisColumns) {
        self.lists = NeighborLists::default();
        let (sizes, reach) = (&self.particles.size, self.reach());
        self.lists.rebuild_with(self.instructions, positions, sizes, &self.domain, reach);
        self.fit_scratch();
    }

    /// Scratch of the size of the lists.
    fn fit_scratch(&mut self) {
        (self.lists_valid, self.motion_share) = (true, 0.0);
        let (records, padded) = (self.lists.n_records(), self.lists.n_padded());
        let tiles = self.lists.tiles().len();
        let s = &mut self.scratch;
        let [of_state, of_sides] = match self.settings.scheme.prepared() {
            Prepared::State => [D::STATE_LINES, D::SIDES_LINES],
            Prepared::ConstantSides => [0, D::CONSTANT_SIDES_LINES],
        };
        let of_state = (records * of_state).max(padded * D::SUM_LINES);
        resize_scratch(&mut s.state, of_state, Line::default());
        resize_scratch(&mut s.sides, records * of_sides, Line::default());
        resize_scratch(&mut s.rows, padded / LANES * Row::count::<D>(), Line::default());
        s.pairs.resize(tiles, TilePairs::default());
        let size = &self.particles.size;
        s.uniform_size =
            Some(size.first().copied().unwrap_or(1.0)).filter(|first| size.iter().all(|s| s == first));
        s.size.clear();
        if s.uniform_size.is_none() {
            s.size.extend_from_slice(size);
            s.size.resize(padded, size[0]);
            s.size.extend(self.lists.halo().owner.iter().map(|&o| size[o as usize]));
        }
        s.reports.resize(tiles, TileReport::default());
        s.least.resize(tiles, (0.0, 0));
        self.is_prepared = false;
    }

    /// Whether the lists still hold, and volume sums anew where particles have moved further against each other: how closely a
    /// density follows its packing must not hang on how long lists live.
    fn look_at_motion(&mut self) {
        let mut clock = Instant::now();
        let before =
            std::mem::replace(&mut self.motion_share, self.lists.motion_share(&self.particles.position));
        self.stage_times.add(StepStage::Lists, &mut clock);
        self.lists_valid = self.motion_share <= 1.0;
        let skin = self.settings.skin_width(D::COUNT);
        let part = |share: f64| (share * skin / MOTION_BETWEEN_MEASURES).floor();
        if self.lists_valid && part(self.motion_share) > part(before) {
            self.measure_volumes();
            self.stage_times.add(StepStage::Volume, &mut clock);
        }
    }

    pub(crate) fn measure_volumes(&mut self) {
        if let Some(settings) = self.settings.volume_consistency {
            let workspace = self.lists.workspace_mut();
            volume::measure(&mut self.particles, &self.domain, &settings, self.instructions, workspace);
        }
    }

    /// Equations of state, and the records that the first pair loop reads, unless the last update has left them behind; and
    /// the images of the records.
    pub(crate) fn prepare(&mut self) {
        let (s, prepared) = (&mut self.scratch, self.settings.scheme.prepared());
        let records = if prepared == Prepared::State { &mut s.state } else { &mut s.sides };
        if !self.is_prepared {
            let (rows, least) = (&mut s.rows, &mut s.least);
            prepare::prepare(
                &self.particles,
                &self.matter,
                self.instructions,
                prepared,
                records,
                rows,
                least,
            );
        }
        self.lists.halo().refresh(records, prepared.lines::<D>(), self.lists.n_padded());
    }

    pub(crate) fn choose_time_step(&mut self, limit: f64) -> Result<(f64, TimeStepReason), StepError> {
        let s = &self.scratch;
        let (step, reason) = courant_step(&self.particles, &s.rows, self.settings.courant, &s.least);
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

    /// A pass that reads the given records.
    fn pass<'a>(&'a self, records: &'a [Line], surface: SurfaceTreatment, half_step: f64) -> Pass<'a, D> {
        let settings = &self.settings;
        let smoothing = Smoothing::new(settings.kernel, settings.smoothing, D::COUNT, self.scratch.sizes());
        let instructions = self.instructions;
        Pass { lists: &self.lists, smoothing, surface, records, half_step, instructions }
    }

    /// The records that the contact pass reads: sides half a step later with their slopes. Without reconstruction the
    /// equations of state have filled them.
    pub(crate) fn find_sides(&mut self, time_step: f64) {
        if !self.settings.scheme.reconstructs() {
            return;
        }
        let mut sides = std::mem::take(&mut self.scratch.sides);
        let mut rows = std::mem::take(&mut self.scratch.rows);
        let mut rule = std::mem::take(&mut self.scratch.rule);
        let s = &self.scratch;
        let by_rule = surface::marks(&self.lists, &self.settings, &s.state, s.sizes(), &mut rule);
        let half_step = if self.settings.scheme.is_time_centered() { 0.5 * time_step } else { 0.0 };
        self.pass(&s.state, self.settings.surface, half_step).gradients(
            by_rule.then_some(rule.as_slice()),
            &mut sides,
            &mut rows,
        );
        self.lists.halo().refresh(&mut sides, D::SIDES_LINES, self.lists.n_padded());
        (self.scratch.sides, self.scratch.rows, self.scratch.rule) = (sides, rows, rule);
    }

    /// Forces, powers and raw velocity gradients, without what tiles have for each other.
    pub(crate) fn solve_contacts(&mut self) {
        let reconstructs = self.settings.scheme.reconstructs();
        let surface = if reconstructs { self.settings.surface } else { SurfaceTreatment::None };
        let limiter = reconstructs.then_some(self.settings.limiter);
        let mut state = std::mem::take(&mut self.scratch.state);
        let mut pairs = std::mem::take(&mut self.scratch.pairs);
        let mut faces = std::mem::take(&mut self.scratch.faces);
        let sums = &mut state[..self.lists.n_padded() * D::SUM_LINES];
        let pass = self.pass(&self.scratch.sides, surface, 0.0);
        pass.contacts(limiter, sums, &mut pairs);
        if let Some(FaceClosure { sweeps }) = self.settings.face_closure {
            pass.close_faces(sweeps, &mut faces, &self.scratch.rows, sums);
        }
        (self.scratch.state, self.scratch.pairs, self.scratch.faces) = (state, pairs, faces);
    }

    /// The half step of the velocity follows the true acceleration near free surfaces. Where there are none, sums stay as
    /// they are.
    pub(crate) fn center_in_time(&mut self, time_step: f64) {
        let s = &mut self.scratch;
        let deltas = Deltas {
            lists: &self.lists,
            pairs: &s.pairs,
            velocity: &self.particles.velocity,
            mass: &self.particles.mass,
            half_step: 0.5 * time_step,
            instructions: self.instructions,
        };
        let of_sums = ..self.lists.n_padded() * D::SUM_LINES;
        if !deltas.fill(&s.rows, &mut s.state[of_sums], &mut s.sides) {
            return;
        }
        let mut state = std::mem::take(&mut s.state);
        let mut pairs = std::mem::take(&mut s.pairs);
        let pass = self.pass(&self.scratch.sides, self.settings.surface, 0.0);
        pass.centering(&mut state[of_sums], &mut pairs);
        (self.scratch.state, self.scratch.pairs) = (state, pairs);
    }

    pub(crate) fn update(&mut self, time_step: f64) -> TileReport {
        let s = &mut self.scratch;
        let of_sums = ..self.lists.n_padded() * D::SUM_LINES;
        let (lists, pairs) = (&self.lists, s.pairs.as_slice());
        let (rows, sides, sums) = (&mut s.rows, &mut s.sides, &mut s.state[of_sums]);
        let outcome = Outcome { rows, sides, sums, lists, pairs, least: &mut s.least };
        let how = (time_step, self.instructions);
        update(&mut self.particles, &self.matter, &self.settings, outcome, how, &mut s.reports);
        self.is_prepared = true;
        let mut sum = TileReport::default();
        for report in &s.reports {
            (0..3).for_each(|a| sum.input.impulse[a] += report.input.impulse[a]);
            sum.input.work += report.input.work;
            sum.relaxation_work += report.relaxation_work;
            sum.interventions += report.interventions;
        }
        sum
    }

    pub(crate) fn finish(
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
        self.look_at_motion();
        let impulse = D::vector(|a| report.input.impulse[a]);
        Ok(StepReport {
            time_step,
            reason,
            rebuilt,
            constraint_impulse: impulse,
            constraint_work: report.input.work,
        })
    }
}
