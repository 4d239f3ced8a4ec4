//! The window: a simulation, its feed, and everything that keeps a shock front in view.
//!
//! One step ([`Window::step`]): when the neighbor lists are due anyway, or the matter at the ends has moved by a particle
//! size, particles are exchanged at both ends; then one step of the simulation; what it put in is booked; after an
//! exchange the front is looked at, and the frame boosted if a boost is due.
//!
//! At the start the box holds the medium moving with `-u_in`, and the outlet, moving with `-u_out`, is the
//! piston: a front leaves it towards +x.

use crate::error::WindowError;
use crate::feed::{Feed, FeedSample};
use crate::frame::Frame;
use crate::inlet::{self, InletKind, Layer, LayerPlace};
use crate::ledger::{Content, Ledger, impose_velocity};
use crate::outlet;
use crate::region::Regions;
use crate::search::Search;
use crate::search::frame_tracking::Observation;
use crate::settings::WindowSettings;
use crate::shock::ShockHistory;
use crate::state::{Progress, Snapshot, WindowState};
use sph_core::dimension::{Components, Dimension};
use sph_core::domain::Domain;
use sph_core::particles::{Constraint, Particles};
use sph_materials::Material;
use sph_riemann::{Settings, Simulation, SolidDimension, StageTimes, StepReport};

/// Length of the layer inside of the inlet whose stress an impedance-matched inlet reads, at least [D].
const INLET_LAYER: f64 = 8.0;
/// Distance of that layer from the inlet, at least [D]: a solid takes up its stress on about five particle sizes.
const INLET_GAP: f64 = 8.0;
/// Swept length, in lengths of the box, after which a front that is not at its place never will be.
const APPROACH_LIMIT: f64 = 20.0;

/// What one step did.
#[derive(Clone, Debug)]
pub struct WindowReport<D: SolidDimension> {
    /// The simulation's report.
    pub step: StepReport<D>,
    /// The look at the front, after an exchange at the ends; where a search takes its trial back, that of the state that it
    /// has come back to.
    pub observation: Option<Observation>,
    /// The velocity that was added to everything along x, if any [m/s].
    pub boost: Option<f64>,
}

/// A box with a shock front in it, through which the medium streams.
pub struct Window<D: SolidDimension> {
    pub(crate) simulation: Simulation<D>,
    pub(crate) feed: Feed<D>,
    pub(crate) settings: WindowSettings,
    pub(crate) regions: Regions,
    pub(crate) progress: Progress,
    /// The state that the trials of a bisection start from.
    pub(crate) snapshot: Option<Snapshot<D>>,
    /// Time by stage of simulations that were taken back.
    pub(crate) stages_before: StageTimes,
}

impl<D: SolidDimension> Window<D> {
    /// A window on a medium at rest, at the moment when the piston starts.
    ///
    /// # Errors
    ///
    /// [`WindowError::Setting`] for a number out of its bounds, [`WindowError::Setup`] when the solver refuses.
    pub fn new(
        sample: FeedSample<D>,
        materials: Vec<Material>,
        solver: Settings,
        settings: WindowSettings,
    ) -> Result<Self, WindowError> {
        settings.validate(sample.particle_size())?;
        check_layer(&sample, &settings)?;
        let regions = settings.regions_for(sample.particle_size());
        let frame = Frame::new(settings.particle_velocity, settings.start_velocity());
        let mut feed = Feed::new(sample);
        let particles = fill(&mut feed, &regions, &frame);
        let ledger = Ledger::new(Content::of_particles(&particles));
        let block = settings.block * feed.sample().particle_size();
        let history = ShockHistory::new(feed.sample().whole_periods(block));
        let progress = Progress::new(frame, ledger, history);
        let regions = settings.regions_for(feed.sample().particle_size());
        let simulation = Simulation::new(domain(&feed, regions.length), materials, particles, solver)?;
        Ok(Self::assemble(simulation, feed, settings, regions, progress))
    }

    fn assemble(
        simulation: Simulation<D>,
        feed: Feed<D>,
        settings: WindowSettings,
        regions: Regions,
        progress: Progress,
    ) -> Self {
        let (snapshot, stages_before) = (None, StageTimes::default());
        Self { simulation, feed, settings, regions, progress, snapshot, stages_before }
    }

    /// A window that goes on from a saved state with the same bits: its particles in their saved order, and the
    /// positions that its neighbor lists were built from, if it had any ([`Simulation::list_positions`]).
    ///
    /// # Errors
    ///
    /// As [`Window::new`], and [`WindowError::State`] when the state was saved with another sample.
    pub fn restore(
        sample: FeedSample<D>,
        materials: Vec<Material>,
        solver: Settings,
        settings: WindowSettings,
        saved: WindowState,
        particles: Particles<D>,
        list_positions: Option<&[Vec<f64>]>,
    ) -> Result<Self, WindowError> {
        settings.validate(sample.particle_size())?;
        let feed = Feed::restore(sample, saved.feed)?;
        let regions = settings.regions_for(feed.sample().particle_size());
        let domain = domain(&feed, regions.length);
        let simulation =
            Simulation::restore(domain, materials, particles, solver, saved.clock, list_positions)?;
        Ok(Self::assemble(simulation, feed, settings, regions, saved.progress))
    }

    /// The state beside [`Simulation::particles`] and [`Simulation::list_positions`]. Saving changes nothing: a run that
    /// was saved on the way has the bits of one that was not.
    pub fn save(&self) -> WindowState {
        WindowState {
            feed: self.feed.state(),
            clock: self.simulation.clock(),
            progress: self.progress.clone(),
        }
    }

    /// One step.
    ///
    /// # Errors
    ///
    /// [`WindowError::Step`] when the solver fails, and an error when the front is lost, runs into the inlet, or never
    /// comes to its place.
    pub fn step(&mut self) -> Result<WindowReport<D>, WindowError> {
        let exchange = self.exchange_is_due();
        if exchange {
            self.exchange();
        }
        let step = self.simulation.step()?;
        self.book(&step);
        let observation = if exchange { Some(self.observe()?) } else { None };
        let boost = match &observation {
            Some(observation) => self.steer(observation)?,
            None => None,
        };
        // A trial that was taken back takes its last look with it.
        let observation = observation.and(self.progress.observation);
        Ok(WindowReport { step, observation, boost })
    }

    fn exchange_is_due(&self) -> bool {
        let limit = self.settings.exchange_drift * self.feed.sample().particle_size();
        self.simulation.lists_stale() || self.progress.drift > limit
    }

    /// Lets particles in and out, and brings what is imposed up to date.
    fn exchange(&mut self) {
        self.read_inlet();
        let (inlet_velocity, outlet_velocity) =
            (self.inlet_velocity(), self.progress.frame.outlet_velocity());
        let (regions, ledger) = (&self.regions, &mut self.progress.ledger);
        let particles = self.simulation.particles_mut();
        ledger.impose(outlet::impose(particles, regions, outlet_velocity));
        outlet::remove(particles, ledger);
        inlet::release(particles, regions);
        ledger.impose(inlet::impose(particles, regions, inlet_velocity));
        for particle in self.feed.next_layer(regions.length, -inlet_velocity, Constraint::ImposedVelocity) {
            ledger.feed(Content::of_particle(&particle));
            particles.push(particle);
        }
        self.progress.drift = 0.0;
        self.progress.exchanged = self.progress.time;
    }

    /// Reads the stress that arrives at an impedance-matched inlet.
    fn read_inlet(&mut self) {
        let InletKind::ImpedanceMatched { wave_speed } = self.settings.inlet else { return };
        let simulation = &self.simulation;
        let place = layer_place(self.feed.sample(), &self.regions);
        let matter = |i| (simulation.stress(i)[0], simulation.longitudinal_sound_speed(i));
        let layer = Layer::measure(simulation.particles(), matter, place, wave_speed);
        self.progress.inlet.update(&layer, self.progress.time - self.progress.exchanged);
    }

    /// Books what a step did.
    fn book(&mut self, step: &StepReport<D>) {
        self.progress.ledger.impose(Content::new::<D>(0.0, step.constraint_impulse, step.constraint_work));
        self.progress.time += step.time_step;
        self.progress.steps += 1;
        let inlet_velocity = self.inlet_velocity();
        self.feed.advance(-inlet_velocity * step.time_step);
        let fastest = inlet_velocity.abs().max(self.progress.frame.outlet_velocity().abs());
        self.progress.drift += fastest * step.time_step;
    }

    /// Looks at the front and takes it into the history.
    fn observe(&mut self) -> Result<Observation, WindowError> {
        let time = self.progress.time;
        let profile = self.velocity_profile();
        let level = -0.5 * (self.ahead_velocity() + self.progress.frame.outlet_velocity());
        let front = match profile.rightmost_crossing(level) {
            Some(front) => front,
            // Before the front has left the piston, the mean over a period may not show it yet.
            None if self.progress.observation.is_none_or(|o| o.front <= self.regions.outlet_end) => {
                self.regions.outlet_end
            }
            None => return Err(WindowError::FrontLost { time }),
        };
        let observation = Observation { time, front, swept: self.feed.fed_length() + front };
        self.check_front(&observation)?;
        self.progress.history.observe(time, observation.swept);
        let last = self.progress.observation.replace(observation);
        if self.is_settled()
            && let Some((from, to)) = self.plateau()
        {
            let duration = last.map_or(0.0, |last| time - last.time);
            let (inlet_velocity, density) = (self.inlet_velocity(), self.feed.sample().mean_density());
            self.progress.balance.observe(&profile.between(from, to), inlet_velocity, density, duration);
        }
        Ok(observation)
    }

    fn check_front(&self, now: &Observation) -> Result<(), WindowError> {
        let (time, front, inlet) = (now.time, now.front, self.regions.inlet_start);
        if front + 0.5 * self.grid().window > inlet {
            return Err(WindowError::FrontAtInlet { time, front, inlet });
        }
        let waiting = match self.settings.search {
            Search::FrameTracking(_) => !self.progress.tracker.arrived(),
            Search::Bisection(_) => !self.progress.bisector.arrived(),
            Search::FixedFrame => false,
        };
        if waiting && now.swept > APPROACH_LIMIT * self.regions.length {
            let wanted = self.settings.wanted_front();
            return Err(WindowError::FrontNotArrived { time, swept: now.swept, front, wanted });
        }
        Ok(())
    }

    /// Holds a part of the medium where it is: a body in the stream. The particles for whose place `inside` holds get the
    /// velocity zero, which nothing changes from then on. For windows of a fixed frame.
    ///
    /// # Errors
    ///
    /// [`WindowError::Setting`] when the search changes the frame, and when the body is nowhere, or not between the outlet
    /// and the middle of the flow: further right the inlet would set it free.
    pub fn hold(&mut self, inside: impl Fn(D::Vector) -> bool) -> Result<(), WindowError> {
        let (from, to) = (self.regions.outlet_end, self.regions.middle());
        let bad = |field, value, reason| Err(WindowError::Setting { field, value, unit: "m", reason });
        if self.settings.search != Search::FixedFrame {
            return bad("search", 0.0, "must be FixedFrame, or the body would move with the frame");
        }
        let particles = self.simulation.particles_mut();
        let body: Vec<usize> = (0..particles.len()).filter(|&i| inside(particles.position_of(i))).collect();
        if body.is_empty() {
            return bad("body", 0.0, "must hold a particle of the medium");
        }
        let outside = |&&i: &&usize| !(from..to).contains(&particles.position[0][i]);
        if let Some(&i) = body.iter().find(outside) {
            return bad(
                "body",
                particles.position[0][i],
                "must lie between the outlet and the middle of the flow",
            );
        }
        for i in body {
            self.progress.ledger.impose(impose_velocity(particles, i, D::vector(|_| 0.0)));
            particles.constraint[i] = Constraint::ImposedVelocity;
        }
        Ok(())
    }

    /// Changes the frame: adds one velocity along x [m/s] to everything, imposed velocities included.
    pub fn boost(&mut self, velocity: f64) {
        self.progress.ledger.boost(velocity, &self.content());
        self.simulation.boost(D::vector(|axis| if axis == 0 { velocity } else { 0.0 }));
        self.progress.frame.boost(velocity);
    }
}

/// The layer whose stress an impedance-matched inlet reads.
fn layer_place<D: Dimension>(sample: &FeedSample<D>, regions: &Regions) -> LayerPlace {
    LayerPlace {
        end: regions.inlet_start - sample.whole_periods(INLET_GAP * sample.particle_size()),
        length: sample.whole_periods(INLET_LAYER * sample.particle_size()),
        cross_section: sample.cross_section(),
        medium_density: sample.mean_density(),
    }
}

/// The front must stand left of the layer that a matched inlet reads.
fn check_layer<D: Dimension>(sample: &FeedSample<D>, settings: &WindowSettings) -> Result<(), WindowError> {
    let place = layer_place(sample, &settings.regions_for(sample.particle_size()));
    let matched = matches!(settings.inlet, InletKind::ImpedanceMatched { .. });
    if matched && settings.wanted_front() > place.end - place.length {
        return Err(WindowError::Setting {
            field: "front_place",
            value: settings.front_place,
            unit: "",
            reason: "must leave two layers between the front and an impedance-matched inlet, each of whole periods of the \
                     medium and at least eight particle sizes long",
        });
    }
    Ok(())
}

/// The box: periodic across, open along x.
pub(crate) fn domain<D: Dimension>(feed: &Feed<D>, length: f64) -> Domain<D> {
    let cell = feed.sample().cell();
    let along = |axis: usize, x: f64, across: f64| if axis == 0 { x } else { across };
    Domain::new(
        D::vector(|axis| along(axis, 0.0, cell.lower[axis])),
        D::vector(|axis| along(axis, length, cell.upper[axis])),
        Components::from_fn(|axis| axis > 0),
    )
}

/// The box at the start: the medium streams, the outlet is the piston.
fn fill<D: Dimension>(feed: &mut Feed<D>, regions: &Regions, frame: &Frame) -> Particles<D> {
    let mut particles = Particles::default();
    let medium = -frame.inlet_velocity();
    for mut particle in feed.next_layer(regions.length, medium, Constraint::Free) {
        let x = particle.position[0];
        particle.constraint = regions.region_of(x).constraint();
        if x < regions.outlet_end {
            particle.velocity[0] = -frame.outlet_velocity();
        }
        particles.push(particle);
    }
    particles
}
