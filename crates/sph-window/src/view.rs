//! What a window shows: profiles, the front, the shock velocity, and its parts.

use crate::feed::FeedSample;
use crate::frame::Frame;
use crate::inlet::InletState;
use crate::ledger::{Content, Ledger};
use crate::plateau;
use crate::profile::{Grid, Profile};
use crate::region::Regions;
use crate::search::Search;
use crate::search::bisection::Trial;
use crate::settings::WindowSettings;
use crate::shock::{Block, Estimate};
use crate::state::Snapshot;
use crate::window::Window;
use sph_riemann::{Simulation, SolidDimension, StageTimes};

/// Length of the moving mean that finds the front, at least [D].
const FRONT_WINDOW: f64 = 4.0;
/// Distance of the nodes of a profile, at most [D].
const NODE_SPACING: f64 = 0.5;

impl<D: SolidDimension> Window<D> {
    /// What the box holds now.
    pub fn content(&self) -> Content {
        Content::of_particles(self.simulation.particles())
    }

    /// Largest gap of the ledger, relative to all that was booked [-]; round-off.
    pub fn ledger_residual(&self) -> f64 {
        self.progress.ledger.relative_residual(&self.content())
    }

    pub(crate) fn grid(&self) -> Grid {
        let sample = self.feed.sample();
        let window = sample.whole_periods(FRONT_WINDOW * sample.particle_size());
        Grid { length: self.regions.length, window, resolution: NODE_SPACING * sample.particle_size() }
    }

    pub(crate) fn velocity_profile(&self) -> Profile {
        Profile::new(self.simulation.particles(), |_| 0.0, self.grid(), self.feed.sample().cross_section())
    }

    /// Moving means of density, velocity and stress along x, at this moment.
    pub fn profile(&self) -> Profile {
        let stress = |i| self.simulation.stress(i)[0];
        Profile::new(self.simulation.particles(), stress, self.grid(), self.feed.sample().cross_section())
    }

    /// Bounds of the plateau behind the front [m]; `None` without a front or when it is too short.
    pub fn plateau(&self) -> Option<(f64, f64)> {
        let front = self.front_position()?;
        plateau::bounds(front, &self.regions, &self.settings.plateau, self.feed.sample().particle_size())
    }

    /// Shock velocity relative to the medium ahead, from the blocks of the medium that the front swept after the
    /// start-up material had left; before that, from the second half of all blocks. `None` before the first block.
    pub fn shock_velocity(&self) -> Option<Estimate> {
        let settled = self.progress.settled_from.map(|swept| self.progress.history.blocks_from(swept));
        match settled {
            Some(blocks) if blocks.len() > 1 => Estimate::from_blocks(blocks),
            _ => {
                let blocks = self.blocks();
                Estimate::from_blocks(blocks[blocks.len() / 2..].to_vec())
            }
        }
    }

    /// Shock velocity from the mass balance of the plateau since the start-up material left [m/s].
    pub fn mass_balance_velocity(&self) -> Option<f64> {
        self.progress.balance.shock_velocity()
    }

    /// All blocks of the shock velocity's history.
    pub fn blocks(&self) -> Vec<Block> {
        self.progress.history.blocks()
    }

    /// True once the matter that was shocked on the way to the front's place has left.
    pub fn is_settled(&self) -> bool {
        self.progress
            .settled_from
            .zip(self.progress.history.swept())
            .is_some_and(|(from, swept)| swept >= from)
    }

    /// Place of the front in the box at the last look [m].
    pub fn front_position(&self) -> Option<f64> {
        self.progress.observation.map(|observation| observation.front)
    }

    /// Velocity `u_b` with which the medium is fed [m/s].
    pub fn inlet_velocity(&self) -> f64 {
        self.progress.inlet.feed_velocity(self.progress.frame.inlet_velocity())
    }

    /// Velocity `u_a` that the inlet gives to the medium ahead of the front [m/s]; it moves with its negative.
    pub fn ahead_velocity(&self) -> f64 {
        self.progress.inlet.ahead_velocity(self.progress.frame.inlet_velocity())
    }

    /// `u_b - u_out` [m/s]: the particle velocity that goes with [`Window::shock_velocity`], both relative to the
    /// medium as it is fed, of density `ρ00`. It is `u_p` with an inlet of fixed velocity, and less with a
    /// matched one once the precursor has arrived.
    pub fn effective_particle_velocity(&self) -> f64 {
        self.inlet_velocity() - self.progress.frame.outlet_velocity()
    }

    /// `u_in - u_b` [m/s]: velocity of the medium as it is fed relative to the undisturbed medium that the precursor
    /// has not reached. With a matched inlet, the shock velocity of [`Window::shock_velocity`] plus this is the speed of the
    /// front relative to the undisturbed medium, and `u_p` the velocity of the piston in the same frame.
    pub fn feed_deficit(&self) -> f64 {
        self.progress.frame.inlet_velocity() - self.inlet_velocity()
    }

    /// Bounds of the medium ahead of the front [m], as far from the front and from the inlet as the front's moving mean
    /// is long; `None` without a front or where nothing is left.
    pub fn ahead(&self) -> Option<(f64, f64)> {
        let margin = self.grid().window;
        let (from, to) = (self.front_position()? + margin, self.regions.inlet_start - margin);
        (to > from).then_some((from, to))
    }

    /// Length of the medium that has come in since the start [m].
    pub fn fed_length(&self) -> f64 {
        self.feed.fed_length()
    }

    /// Number of periods of the medium that have come in since the start [-].
    pub fn fed_cells(&self) -> f64 {
        self.feed.fed_length() / self.feed.sample().period()
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.progress.time
    }

    /// Steps made.
    pub fn steps(&self) -> u64 {
        self.progress.steps
    }

    /// The frame of reference.
    pub fn frame(&self) -> &Frame {
        &self.progress.frame
    }

    /// The inlet's state.
    pub fn inlet(&self) -> &InletState {
        &self.progress.inlet
    }

    /// Mass, momentum and energy in and out.
    pub fn ledger(&self) -> &Ledger {
        &self.progress.ledger
    }

    /// Boosts of frame tracking that were bounded since the start, so that the outlet would not bring matter back in.
    pub fn boosts_bounded(&self) -> u64 {
        self.progress.boosts_bounded
    }

    /// Bounds of the regions.
    pub fn regions(&self) -> &Regions {
        &self.regions
    }

    /// The settings.
    pub fn settings(&self) -> &WindowSettings {
        &self.settings
    }

    /// One period of the medium.
    pub fn sample(&self) -> &FeedSample<D> {
        self.feed.sample()
    }

    /// What the bisection has tried so far; empty with another search.
    pub fn audit(&self) -> &[Trial] {
        self.progress.bisector.audit()
    }

    /// True while a bisection goes back to its saved state time and again: nothing is measured then.
    pub fn is_searching(&self) -> bool {
        matches!(self.settings.search, Search::Bisection(_)) && !self.progress.bisector.is_done()
    }

    /// The state that the trials of a bisection start from; a restart needs it.
    pub fn snapshot(&self) -> Option<&Snapshot<D>> {
        self.snapshot.as_ref()
    }

    /// Time by stage of the solver, that of trials which were taken back included.
    pub fn stage_times(&self) -> StageTimes {
        let mut stages = self.stages_before;
        stages.merge(self.simulation.stage_times());
        stages
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation<D> {
        &self.simulation
    }
}
