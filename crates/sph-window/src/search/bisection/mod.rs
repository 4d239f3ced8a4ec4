//! The published search: bisection of the outlet velocity on the drift of the front.
//!
//! The place of the front is measured by the number N of particles in the box,
//!
//! ```text
//! ω = (N - N0)/(ν N0)
//! ```
//!
//! with `N0` particles at the start and `ν` such that `ω = 1` when the front is at its wanted
//! place. It grows when the front moves ahead, so that the mean slope `⟨dω/dt⟩` falls as
//! `u_out` rises, and is zero where the front stands.
//!
//! 1. The front runs to its place, `ω = 1`; that state is saved.
//! 2. Bisection: each trial starts from the saved state with the middle of the bracket as its `u_out`, runs until
//!    `samples` periods of the medium are fed, and fits the slope of `ω(t)`. It ends when the bracket is
//!    narrower than `tolerance`.
//! 3. With the result the window runs until `settle` lengths of the box are fed; that state is saved.
//! 4. Bisection once more, from there. The frame that it finds stays.
//!
//! The source leaves three things open. A trial **boosts** all matter to its frame: an outlet velocity that is changed
//! alone sends a wave through the box and no slope means anything. The first bracket, unless it is given, lies about the
//! speed of the front on its way. And a bracket that had no change of sign is seen by a result at one of its ends: the
//! search then goes on beyond that end.
//!
//! The slope over a few cells is noisy (the front is late in one cell and early in the next), so that the width of the
//! bracket is no uncertainty; [`Trial`] tells what each decision was made of.
//!
//! Source: Rublev & Murzov, arXiv 2410.14646, section 3.1.

mod audit;

use serde::{Deserialize, Serialize};

use super::frame_tracking::{FrameTracking, Observation, Target, Tracker};
pub use audit::{Decision, Stage, Trial};

/// A result nearer to an end of its bracket than this many tolerances has probably been cut off there.
const END: f64 = 2.0;
/// Times that a bracket may be moved before the search gives up.
const MOVES: u32 = 6;
/// Farther from the front's own speed on its way than this part of it a bracket has run away: the slopes are noise.
const AWAY: f64 = 0.75;

/// Settings of the bisection.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Bisection {
    /// Bounds of `u_out` [m/s]; by default those about the speed of the front on its way.
    pub bracket: Option<(f64, f64)>,
    /// Half the width of a bracket that is not given, as a part of `u_s` [-].
    pub half_width: f64,
    /// Periods of the medium that are fed in a trial [-].
    pub samples: f64,
    /// Width of the bracket at which a round ends [m/s].
    pub tolerance: f64,
    /// Length that is fed between two rounds, in lengths of the box [-].
    pub settle: f64,
    /// Rounds of bisection.
    pub rounds: u32,
}

impl Default for Bisection {
    fn default() -> Self {
        Self { bracket: None, half_width: 0.2, samples: 3.0, tolerance: 1.0, settle: 0.5, rounds: 2 }
    }
}

/// One look, as the bisection needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    /// Time, and where the front is.
    pub now: Observation,
    /// Length of the medium that has come in [m].
    pub fed: f64,
    /// Particles in the box.
    pub particles: usize,
    /// Particles advanced since the start, those of trials that were taken back included.
    pub particle_steps: u64,
}

/// What the bisection wants and knows beside its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Surroundings {
    /// Wanted place of the front, and how the medium comes in.
    pub target: Target,
    /// Velocity of the piston relative to the medium ahead [m/s].
    pub particle_velocity: f64,
    /// Period of the medium [m].
    pub period: f64,
    /// Length of the box [m].
    pub length: f64,
}

/// What the window is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Order {
    /// Save this state, and go to a frame with this outlet velocity [m/s].
    SaveAndTry(f64),
    /// Take the saved state back, in a frame with this outlet velocity [m/s].
    Restore(f64),
    /// Like [`Order::Restore`], and the search has ended.
    Finish(f64),
    /// The search has failed: no bracket with a change of sign.
    GiveUp,
}

/// Least squares of ω against time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Slope {
    count: f64,
    time: f64,
    value: f64,
    time_squared: f64,
    product: f64,
}

impl Slope {
    fn add(&mut self, time: f64, value: f64) {
        self.count += 1.0;
        self.time += time;
        self.value += value;
        self.time_squared += time * time;
        self.product += time * value;
    }

    fn get(&self) -> f64 {
        let variance = self.count * self.time_squared - self.time * self.time;
        (self.count * self.product - self.time * self.value) / variance
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
enum Phase {
    #[default]
    Approach,
    Trial,
    Settle,
    Found,
}

/// State of the bisection.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bisector {
    phase: Phase,
    approach: Tracker,
    /// Round, from 1 on.
    round: u32,
    moves: u32,
    bracket: (f64, f64),
    /// Length that the front had swept when it came to its wanted place [m].
    arrival: f64,
    /// u_s on the way of the front to its place [m/s].
    speed: f64,
    /// The bracket as it was at the start of the round.
    whole: (f64, f64),
    outlet_velocity: f64,
    /// `N0`, once known, and `ν`.
    particles: Option<usize>,
    scale: f64,
    slope: Slope,
    start: f64,
    fed: f64,
    particle_steps: u64,
    audit: Vec<Trial>,
}

impl Bisector {
    /// True once the front has been at its wanted place.
    pub fn arrived(&self) -> bool {
        self.phase != Phase::Approach
    }

    /// Length that the front had swept when it came to its wanted place; zero before [m].
    pub(crate) fn arrival(&self) -> f64 {
        self.arrival
    }

    /// True once the search has ended.
    pub fn is_done(&self) -> bool {
        self.phase == Phase::Found
    }

    /// All that was tried, in order.
    pub fn audit(&self) -> &[Trial] {
        &self.audit
    }

    /// Takes a look in; returns what the window is to do, if anything.
    pub(crate) fn observe(
        &mut self,
        look: &Look,
        around: &Surroundings,
        settings: &Bisection,
    ) -> Option<Order> {
        let first = *self.particles.get_or_insert(look.particles);
        match self.phase {
            Phase::Found => return None,
            Phase::Approach => return self.approach(look, around, settings, first),
            Phase::Trial | Phase::Settle => {}
        }
        let omega = (look.particles as f64 - first as f64) / (self.scale * first as f64);
        self.slope.add(look.now.time - self.start, omega);
        let wanted = match self.phase {
            Phase::Settle => settings.settle * around.length,
            _ => settings.samples * around.period,
        };
        if look.fed - self.fed < wanted {
            return None;
        }
        Some(match self.phase {
            Phase::Settle => self.next_round(look, around, settings),
            _ => self.judge(look, around, settings),
        })
    }

    /// On the way to the wanted place: as frame tracking does it.
    fn approach(
        &mut self,
        look: &Look,
        around: &Surroundings,
        settings: &Bisection,
        first: usize,
    ) -> Option<Order> {
        let boost = self.approach.observe(&look.now, &around.target, &FrameTracking::default())?;
        let speed = around.target.inlet_velocity - boost;
        self.outlet_velocity = around.target.inlet_velocity - around.particle_velocity;
        self.scale = (look.particles as f64 / first as f64 - 1.0).max(1.0 / first as f64);
        self.book(look, around, Stage::Approach, None, Decision::Saved);
        let middle = speed - around.particle_velocity;
        let half = settings.half_width * speed;
        (self.speed, self.arrival) = (speed, look.now.swept);
        self.bracket = settings.bracket.unwrap_or(((middle - half).max(0.0), middle + half));
        Some(self.begin_round(look))
    }

    /// A new round, from the present state.
    fn begin_round(&mut self, look: &Look) -> Order {
        self.whole = self.bracket;
        self.round += 1;
        self.phase = Phase::Trial;
        self.fed = look.fed;
        self.begin(look.now.time, look.particle_steps);
        Order::SaveAndTry(self.outlet_velocity)
    }

    /// A trial in the middle of the bracket, from the state of `start` [s].
    fn begin(&mut self, start: f64, particle_steps: u64) {
        self.outlet_velocity = 0.5 * (self.bracket.0 + self.bracket.1);
        self.slope = Slope::default();
        (self.start, self.particle_steps) = (start, particle_steps);
    }

    /// The end of a trial.
    fn judge(&mut self, look: &Look, around: &Surroundings, settings: &Bisection) -> Order {
        let (drift, tried) = (self.slope.get(), self.outlet_velocity);
        let decision = if drift > 0.0 { Decision::Raise } else { Decision::Lower };
        match decision {
            Decision::Raise => self.bracket.0 = tried,
            _ => self.bracket.1 = tried,
        }
        if self.bracket.1 - self.bracket.0 >= settings.tolerance {
            self.book(look, around, Stage::Trial, Some(drift), decision);
            self.begin(self.start, look.particle_steps);
            return Order::Restore(self.outlet_velocity);
        }
        if self.is_cut_off(settings.tolerance) {
            return self.move_on(look, around, drift, settings.tolerance);
        }
        self.book(look, around, Stage::Trial, Some(drift), Decision::Found);
        self.begin(self.start, look.particle_steps);
        if self.round >= settings.rounds {
            self.phase = Phase::Found;
            return Order::Finish(self.outlet_velocity);
        }
        self.phase = Phase::Settle;
        Order::Restore(self.outlet_velocity)
    }

    /// The result stands at an end of the bracket of this round; an outlet that stands is no result at all.
    fn is_cut_off(&self, tolerance: f64) -> bool {
        let low = self.bracket.0 - self.whole.0 < END * tolerance && self.whole.0 > 0.0;
        low || self.whole.1 - self.bracket.1 < END * tolerance || self.bracket.0 <= 0.0
    }

    /// The bracket is far from the speed that the front had on its way.
    fn has_run_away(&self, particle_velocity: f64) -> bool {
        let seen = self.speed - particle_velocity;
        let distance = (self.bracket.0 - seen).max(seen - self.bracket.1);
        distance > AWAY * self.speed
    }

    /// Goes on beyond the end of the bracket where the result stands.
    fn move_on(&mut self, look: &Look, around: &Surroundings, drift: f64, tolerance: f64) -> Order {
        let stands = self.bracket.0 <= 0.0;
        let width = self.whole.1 - self.whole.0;
        let margin = 2.0 * END * tolerance;
        self.bracket = if self.bracket.0 - self.whole.0 < END * tolerance {
            ((self.whole.0 - width).max(0.0), self.whole.0 + margin)
        } else {
            (self.whole.1 - margin, self.whole.1 + width)
        };
        self.whole = self.bracket;
        self.moves += 1;
        self.book(look, around, Stage::Trial, Some(drift), Decision::Moved);
        if stands || self.moves > MOVES || self.has_run_away(around.particle_velocity) {
            return Order::GiveUp;
        }
        self.begin(self.start, look.particle_steps);
        Order::Restore(self.outlet_velocity)
    }

    /// The end of the run between two rounds: the next bracket is as wide as the first and lies about the result.
    fn next_round(&mut self, look: &Look, around: &Surroundings, settings: &Bisection) -> Order {
        let drift = self.slope.get();
        let half = settings.bracket.map_or(
            settings.half_width * (self.outlet_velocity + around.particle_velocity),
            |(low, high)| 0.5 * (high - low),
        );
        self.bracket = ((self.outlet_velocity - half).max(0.0), self.outlet_velocity + half);
        self.book(look, around, Stage::Settle, Some(drift), Decision::Saved);
        self.begin_round(look)
    }

    fn book(
        &mut self,
        look: &Look,
        around: &Surroundings,
        stage: Stage,
        drift: Option<f64>,
        decision: Decision,
    ) {
        self.audit.push(Trial {
            round: self.round,
            stage,
            start: self.start,
            outlet_velocity: self.outlet_velocity,
            inlet_velocity: self.outlet_velocity + around.particle_velocity,
            drift,
            fed: (look.fed - self.fed) / around.period,
            particle_steps: look.particle_steps - self.particle_steps,
            bracket: self.bracket,
            decision,
        });
    }
}

#[cfg(test)]
mod tests;
