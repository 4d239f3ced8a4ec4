//! A simulation and its step.
//!
//! [`Simulation::step`] is the only place where the order of a step stands; its stages are in the module `stages`. State
//! lives in [`Particles`], in cell order with stable ids; scratch is kept from step to step. Results have the same bits for
//! any number of threads.

use std::time::Instant;

use sph_core::dimension::Vector;
use sph_core::domain::Domain;
use sph_core::lanes::InstructionSet;
use sph_core::neighbors::NeighborLists;
use sph_core::particles::Particles;
use sph_core::reduce;
use sph_materials::Material;

use crate::check::check;
use crate::dimension::SolidDimension;
use crate::error::{SetupError, StepError};
use crate::interventions::Interventions;
use crate::matter::Matter;
use crate::prepare;
use crate::restart::Clock;
use crate::scheme::Settings;
use crate::stage_times::{StageTimes, StepStage};
use crate::stages::Scratch;
use crate::time_step::TimeStepReason;

/// Particles that move by the equations of a scheme.
pub struct Simulation<D: SolidDimension> {
    pub(crate) domain: Domain<D>,
    pub(crate) matter: Matter,
    pub(crate) settings: Settings,
    pub(crate) particles: Particles<D>,
    pub(crate) time: f64,
    pub(crate) step_count: u64,
    pub(crate) particle_steps: u64,
    pub(crate) relaxation_work: f64,
    pub(crate) interventions: Interventions,
    pub(crate) lists: NeighborLists<D>,
    pub(crate) lists_valid: bool,
    /// How much of what the lists allow particles have moved against each other.
    pub(crate) motion_share: f64,
    /// True until particles are lent out to be changed.
    pub(crate) is_checked: bool,
    /// True if the last update has left the records behind that the next step begins with.
    pub(crate) is_prepared: bool,
    pub(crate) scratch: Scratch,
    pub(crate) stage_times: StageTimes,
    pub(crate) instructions: InstructionSet,
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport<D: SolidDimension> {
    /// Length of the step τ [s].
    pub time_step: f64,
    /// Why it was as long as it was.
    pub reason: TimeStepReason,
    /// True if the neighbor lists were rebuilt, and the particles sorted anew, before the step.
    pub rebuilt: bool,
    /// Momentum that imposed velocities put in [kg m/s], per meter of depth in the plane.
    pub constraint_impulse: D::Vector,
    /// Energy that imposed velocities put in [J], per meter of depth in the plane.
    pub constraint_work: f64,
}

/// Sums over all particles, per meter of depth in the plane.
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
            matter: Matter::new(materials),
            settings,
            particles,
            time: 0.0,
            step_count: 0,
            particle_steps: 0,
            relaxation_work: 0.0,
            interventions: Interventions::default(),
            lists: NeighborLists::default(),
            lists_valid: false,
            motion_share: 0.0,
            is_checked: true,
            is_prepared: false,
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
    /// A particle whose state cannot be, no particles at all, or a time step that has fallen to nothing.
    ///
    /// # Panics
    /// As [`NeighborLists::build`].
    pub fn step(&mut self) -> Result<StepReport<D>, StepError> {
        self.step_at_most(f64::INFINITY)
    }

    /// One step, not longer than `limit` [s].
    ///
    /// # Errors
    /// As [`Simulation::step`]; a limit that is not above zero.
    ///
    /// # Panics
    /// As [`Simulation::step`].
    pub fn step_at_most(&mut self, limit: f64) -> Result<StepReport<D>, StepError> {
        self.check_step(limit)?;
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

    /// True when the next step will rebuild the neighbor lists: the moment to insert and remove particles.
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

    /// The particles, to insert, remove and change: the next step checks them and rebuilds the lists.
    pub fn particles_mut(&mut self) -> &mut Particles<D> {
        (self.lists_valid, self.is_prepared, self.is_checked) = (false, false, false);
        &mut self.particles
    }

    /// Adds one velocity [m/s] to every particle: a change of frame.
    pub fn boost(&mut self, velocity: D::Vector) {
        self.is_prepared = false;
        for a in 0..D::COUNT {
            self.particles.velocity[a].iter_mut().for_each(|u| *u += velocity[a]);
        }
    }

    /// Stress of particle `i` [Pa].
    pub fn stress(&self, i: usize) -> D::Tensor<f64> {
        prepare::stress(&self.particles, self.materials(), i)
    }

    /// Pressure of particle `i` [Pa].
    pub fn pressure(&self, i: usize) -> f64 {
        prepare::pressure(&self.particles, self.materials(), i)
    }

    /// Longitudinal sound speed of particle `i` [m/s], that of the contacts and of the time step: where voids have grown, c_b is
    /// that of the solid between them.
    pub fn longitudinal_sound_speed(&self, i: usize) -> f64 {
        let p = &self.particles;
        let material = &self.materials()[p.material[i] as usize];
        material.longitudinal_sound_speed_with(p.distension[i], p.density[i], p.specific_internal_energy[i])
    }

    /// The materials.
    pub fn materials(&self) -> &[Material] {
        self.matter.materials()
    }

    /// The settings of the scheme.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The box.
    pub fn domain(&self) -> &Domain<D> {
        &self.domain
    }

    /// The neighbor lists of the last step.
    pub fn lists(&self) -> &NeighborLists<D> {
        &self.lists
    }

    /// Seconds by stage.
    pub fn stage_times(&self) -> &StageTimes {
        &self.stage_times
    }

    /// ∫ P |dV| of the density that volume consistency changed [J], per meter of depth in the plane.
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
        let columns = self.particles.columns().len() * 8 + 8 + 2 + 1 + 1;
        n * columns + self.scratch.bytes() + self.lists.bytes()
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
