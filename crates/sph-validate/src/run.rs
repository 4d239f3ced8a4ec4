//! One simulation of a suite: steps, progress, conservation, cost. Every suite without a moving window runs by this.

use std::time::Instant;

use sph_core::{Constraint, Dimension, Domain, Particle, Particles, Vector, reduce};
use sph_materials::{Material, library};
use sph_riemann::{Settings, Simulation, SolidDimension};

use crate::case::Case;
use crate::conservation::Conservation;
use crate::error::ValidateError;
use crate::metric::Measurement;
use crate::outcome::{Cost, Curve, Field, Outcome};
use crate::watch::Watch;

/// A simulation that knows its case, what must be conserved, and its cost.
pub struct Run<'w, D: SolidDimension> {
    /// Which run.
    pub case: Case,
    /// The solver.
    pub simulation: Simulation<D>,
    watch: Watch<'w>,
    started: Instant,
    start: Content<D>,
    /// Momentum [kg m/s] and energy [J] that constraints have put in.
    put_in: (D::Vector, f64),
}

impl<'w, D: SolidDimension> Run<'w, D> {
    /// The solver with one material and the given settings; [`SchemeName::settings`](crate::case::SchemeName::settings)
    /// are the usual ones.
    ///
    /// # Errors
    /// [`ValidateError::Setup`] for particles, materials or settings that the solver refuses.
    pub fn new(
        case: &Case,
        watch: Watch<'w>,
        domain: Domain<D>,
        material: Material,
        particles: Particles<D>,
        settings: Settings,
    ) -> Result<Self, ValidateError> {
        let simulation = Simulation::new(domain, vec![material], particles, settings)
            .map_err(|source| ValidateError::Setup { case: case.to_string(), source })?;
        let start = Content::of(&simulation);
        let put_in = (D::vector(|_| 0.0), 0.0);
        Ok(Self { case: case.clone(), simulation, watch, started: Instant::now(), start, put_in })
    }

    /// One step, ending at `end` [s] at the latest.
    ///
    /// # Errors
    /// [`ValidateError::Interrupted`]; [`ValidateError::Numerical`] where the step fails.
    pub fn step(&mut self, end: f64) -> Result<(), ValidateError> {
        self.watch.check()?;
        let time = self.simulation.time();
        let report = self.simulation.step_at_most(end - time).map_err(|source| ValidateError::Numerical {
            case: self.case.to_string(),
            time,
            source: Box::new(source),
        })?;
        self.put_in.0 += report.constraint_impulse;
        self.put_in.1 += report.constraint_work;
        Ok(())
    }

    /// Changes particles by hand; what that puts in of momentum and energy counts as put in by a constraint.
    pub fn change(&mut self, change: impl FnOnce(&mut Particles<D>)) {
        let before = self.simulation.totals();
        change(self.simulation.particles_mut());
        let after = self.simulation.totals();
        self.put_in.0 += after.momentum - before.momentum;
        let kinetic = after.kinetic_energy - before.kinetic_energy;
        self.put_in.1 += kinetic + (after.internal_energy - before.internal_energy);
    }

    /// Steps to `end` [s]; progress is told as the share of `end`.
    ///
    /// # Errors
    /// As [`Run::step`].
    pub fn advance(&mut self, end: f64) -> Result<(), ValidateError> {
        // A remainder of round-off size is no step.
        while self.simulation.time() < end * (1.0 - 1e-12) {
            self.step(end)?;
            self.tell(self.simulation.time() / end);
        }
        Ok(())
    }

    /// Tells the share of the run that is done, 0 to 1.
    pub fn tell(&self, share: f64) {
        self.watch.tell(share.clamp(0.0, 1.0));
    }

    /// What was lost since the start.
    pub fn conservation(&self) -> Conservation {
        let (start, end) = (&self.start, &Content::of(&self.simulation));
        let momentum = (end.momentum - start.momentum - self.put_in.0).length();
        let energy = (end.kinetic - start.kinetic) + (end.internal - start.internal) - self.put_in.1;
        let domain = self.simulation.domain();
        let is_closed = (0..D::COUNT).all(|axis| !domain.periodic[axis])
            && self.simulation.particles().constraint.iter().all(|&c| c == Constraint::Free);
        let turn = || {
            let square = |k: usize| (end.angular_momentum[k] - start.angular_momentum[k]).powi(2);
            let change = (0..3).map(square).sum::<f64>().sqrt();
            share(change, start.turning.max(end.turning))
        };
        Conservation {
            mass: share(end.mass - start.mass, start.mass),
            momentum: share(momentum, start.motion.max(end.motion)),
            energy: share(energy, start.kinetic.max(end.kinetic)),
            angular_momentum: is_closed.then(turn),
        }
    }

    /// What it cost so far.
    pub fn cost(&self) -> Cost {
        Cost {
            particles: self.simulation.particles().len(),
            steps: self.simulation.step_count(),
            particle_steps: self.simulation.particle_steps(),
            seconds: self.started.elapsed().as_secs_f64(),
        }
    }

    /// The outcome of the run: its figures with conservation and cost.
    pub fn outcome(self, measurements: Vec<Measurement>, curves: Vec<Curve>, fields: Vec<Field>) -> Outcome {
        let (conservation, cost) = (self.conservation(), self.cost());
        Outcome { case: self.case, measurements, conservation, curves, fields, cost }
    }
}

/// Nothing lost of nothing is no loss.
fn share(change: f64, size: f64) -> f64 {
    if change == 0.0 { 0.0 } else { change / size }
}

/// What must be conserved, and by what it is measured; per meter of depth in the plane.
struct Content<D: Dimension> {
    mass: f64,
    momentum: D::Vector,
    kinetic: f64,
    internal: f64,
    /// Σ m r × u about the origin; in the plane the third component only.
    angular_momentum: [f64; 3],
    /// Σ m |u|.
    motion: f64,
    /// Σ m |r| |u|.
    turning: f64,
}

impl<D: SolidDimension> Content<D> {
    fn of(simulation: &Simulation<D>) -> Self {
        let (particles, totals) = (simulation.particles(), simulation.totals());
        let count = particles.len();
        let component = |column: &D::AxisColumns, axis: usize, i: usize| {
            if axis < D::COUNT { column[axis][i] } else { 0.0 }
        };
        let moment = |i: usize, a: usize, b: usize| {
            component(&particles.position, a, i) * component(&particles.velocity, b, i)
        };
        let angular = |k: usize| {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            reduce::sum_of(count, |i| particles.mass[i] * (moment(i, a, b) - moment(i, b, a)))
        };
        let speed = |i: usize| particles.mass[i] * particles.velocity_of(i).length();
        Self {
            mass: totals.mass,
            momentum: totals.momentum,
            kinetic: totals.kinetic_energy,
            internal: totals.internal_energy,
            angular_momentum: std::array::from_fn(angular),
            motion: reduce::sum_of(count, speed),
            turning: reduce::sum_of(count, |i| speed(i) * particles.position_of(i).length()),
        }
    }
}

/// A named material of the library.
///
/// # Errors
/// [`ValidateError::Material`] for an unknown name, with the nearest one.
pub fn material(name: &str) -> Result<Material, ValidateError> {
    library::material(name).map_err(|error| ValidateError::Material(error.to_string()))
}

/// A free particle of the first material on a square or cubic lattice of the edge `size` [m], at rest and without
/// stress.
pub fn particle_at<D: Dimension>(id: usize, position: D::Vector, size: f64, density: f64) -> Particle<D> {
    Particle::at_rest(id as u64, position, density * size.powi(D::COUNT as i32), size, density)
}
