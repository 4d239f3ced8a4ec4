//! How a window follows its front: boosts by frame tracking, or the trials of a bisection.

use crate::error::WindowError;
use crate::feed::Feed;
use crate::search::bisection::{Look, Order, Surroundings};
use crate::search::frame_tracking::{Observation, Target};
use crate::search::{Bisection, FrameTracking, Search};
use crate::state::Snapshot;
use crate::window::{Window, domain};
use sph_riemann::{Clock, Simulation, SolidDimension};

impl<D: SolidDimension> Window<D> {
    /// Does what the search asks for; returns the velocity that was added to everything, if any [m/s].
    pub(crate) fn steer(&mut self, now: &Observation) -> Result<Option<f64>, WindowError> {
        match self.settings.search {
            Search::FrameTracking(tracking) => Ok(self.track(now, &tracking)),
            Search::Bisection(bisection) => self.bisect(now, &bisection),
            Search::FixedFrame => Ok(None),
        }
    }

    /// Boosts the frame if frame tracking asks for it.
    fn track(&mut self, now: &Observation, tracking: &FrameTracking) -> Option<f64> {
        let target = self.target(tracking);
        let had_arrived = self.progress.tracker.arrived();
        let wanted = self.progress.tracker.observe(now, &target, tracking)?;
        // An outlet that moves to the right would bring matter back in.
        let most = self.progress.frame.outlet_velocity();
        self.progress.boosts_bounded += u64::from(wanted > most);
        let velocity = wanted.min(most);
        self.boost(velocity);
        if !had_arrived {
            self.progress.settled_from = Some(self.startup_left_at(now));
        }
        Some(velocity)
    }

    fn target(&self, tracking: &FrameTracking) -> Target {
        let sample = self.feed.sample();
        Target {
            front: self.settings.wanted_front(),
            interval: sample.whole_periods(tracking.interval * sample.particle_size()),
            inlet_velocity: self.inlet_velocity(),
        }
    }

    /// Swept length at which what is behind the front now will have left: it leaves with u_out, while the front sweeps
    /// with u_in [m].
    fn startup_left_at(&self, now: &Observation) -> f64 {
        let ratio = self.progress.frame.inlet_velocity() / self.progress.frame.outlet_velocity();
        now.swept + now.front * ratio
    }

    /// Does what the bisection asks for.
    fn bisect(&mut self, now: &Observation, bisection: &Bisection) -> Result<Option<f64>, WindowError> {
        let look = Look {
            now: *now,
            fed: self.feed.fed_length(),
            particles: self.simulation.particles().len(),
            particle_steps: self.simulation.particle_steps(),
        };
        let around = Surroundings {
            target: self.target(&FrameTracking::default()),
            particle_velocity: self.progress.frame.particle_velocity(),
            period: self.feed.sample().period(),
            length: self.regions.length,
        };
        let Some(order) = self.progress.bisector.observe(&look, &around, bisection) else { return Ok(None) };
        let outlet_velocity = match order {
            Order::SaveAndTry(velocity) => {
                self.snapshot = Some(self.take_snapshot());
                velocity
            }
            Order::Restore(velocity) => {
                self.take_back()?;
                velocity
            }
            Order::Finish(velocity) => {
                self.take_back()?;
                self.snapshot = None;
                velocity
            }
            Order::GiveUp => {
                let (low, high) = self.audit().last().map_or((f64::NAN, f64::NAN), |trial| trial.bracket);
                return Err(WindowError::NoBracket { time: now.time, low, high });
            }
        };
        let velocity = self.progress.frame.outlet_velocity() - outlet_velocity;
        self.boost(velocity);
        if let (Order::Finish(_), Some(now)) = (order, self.progress.observation) {
            self.progress.settled_from = Some(self.startup_end(&now));
        }
        Ok(Some(velocity))
    }

    /// What was behind the front when it came to its place leaves with u_out, while the front sweeps with u_in. The box is
    /// fed half a length between two rounds, so that a part of it has left already.
    fn startup_end(&self, now: &Observation) -> f64 {
        let ratio = self.progress.frame.inlet_velocity() / self.progress.frame.outlet_velocity();
        (self.progress.bisector.arrival() + self.settings.wanted_front() * ratio).max(now.swept)
    }

    fn take_snapshot(&self) -> Snapshot<D> {
        Snapshot {
            state: self.save(),
            particles: self.simulation.particles().clone(),
            list_positions: self.simulation.list_positions().map(<[Vec<f64>]>::to_vec),
        }
    }

    /// Takes the saved state back. The counts of what was spent, and the log of the bisection, go on.
    fn take_back(&mut self) -> Result<(), WindowError> {
        let Some(saved) = self.snapshot.clone() else {
            return Err(WindowError::State(
                "the state that the bisection started from is missing".to_string(),
            ));
        };
        self.stages_before.merge(self.simulation.stage_times());
        let spent = self.simulation.clock();
        let clock =
            Clock { step_count: spent.step_count, particle_steps: spent.particle_steps, ..saved.state.clock };
        let materials = self.simulation.materials().to_vec();
        let settings = *self.simulation.settings();
        self.feed = Feed::restore(self.feed.sample().clone(), saved.state.feed)?;
        let domain = domain(&self.feed, self.regions.length);
        let lists = saved.list_positions.as_deref();
        self.simulation = Simulation::restore(domain, materials, saved.particles, settings, clock, lists)?;
        let bisector = std::mem::take(&mut self.progress.bisector);
        let steps = self.progress.steps;
        self.progress = saved.state.progress;
        (self.progress.bisector, self.progress.steps) = (bisector, steps);
        Ok(())
    }

    /// Gives a restored window the state that the trials of its bisection start from.
    #[must_use]
    pub fn with_snapshot(mut self, snapshot: Option<Snapshot<D>>) -> Self {
        self.snapshot = snapshot;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::WindowSettings;
    use crate::testing::lattice;
    use sph_core::Dim2;
    use sph_materials::library;
    use sph_riemann::{Scheme, Settings};

    /// A front that is brought to its place at some speed [m/s], in a window whose outlet rests until then.
    fn arrival(speed: f64) -> Window<Dim2> {
        let copper = library::material("porous-copper").expect("the library has it");
        let solver = Settings::for_scheme(Scheme::TkcHancock);
        let settings = WindowSettings::new(1e-4, 300.0);
        let mut window =
            Window::new(lattice(1e-6, [8, 8, 1]), vec![copper], solver, settings).expect("a window");
        let place = window.settings.wanted_front();
        for (time, front) in [(0.0, 0.0), (place / speed, place)] {
            window.track(&Observation { time, front, swept: front }, &FrameTracking::default());
        }
        window
    }

    #[test]
    fn a_boost_that_would_push_the_outlet_in_is_bounded_and_counted() {
        let slow = arrival(50.0);
        assert_eq!((slow.boosts_bounded(), slow.frame().outlet_velocity()), (1, 0.0));
        assert_eq!(slow.save().progress.boosts_bounded, 1);
        let fast = arrival(4000.0);
        assert_eq!(fast.boosts_bounded(), 0);
        assert!((fast.frame().outlet_velocity() - 3700.0).abs() < 1e-6);
    }
}
