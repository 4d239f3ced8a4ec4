//! Settings of a window.

use crate::error::WindowError;
use crate::inlet::InletKind;
use crate::region::{RegionWidths, Regions};
use crate::search::{Bisection, Search};
use serde::{Deserialize, Serialize};

/// Settings of a window. Lengths in particle sizes D refer to the largest particle of the sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindowSettings {
    /// Length of the box along x [m].
    pub length: f64,
    /// Velocity of the piston relative to the medium ahead, `u_p = u_in - u_out` [m/s].
    pub particle_velocity: f64,
    /// `u_in` at the start [m/s]; by default `u_p`, that is an outlet at rest. A guess near the shock
    /// velocity starts with a front that moves slowly through the box; it must not pass the shock velocity.
    #[serde(default)]
    pub inlet_velocity: Option<f64>,
    /// Wanted place of the front, as a part of the length [-].
    #[serde(default = "default_front_place")]
    pub front_place: f64,
    /// Widths of the regions with imposed velocity.
    #[serde(default)]
    pub regions: RegionWidths,
    /// What the inlet imposes.
    #[serde(default)]
    pub inlet: InletKind,
    /// How the frame is chosen.
    #[serde(default)]
    pub search: Search,
    /// Way of the matter at the ends after which particles are exchanged at the latest [D]; they are exchanged at each
    /// rebuild of the neighbor lists too.
    #[serde(default = "default_exchange_drift")]
    pub exchange_drift: f64,
    /// Least length of a block of the shock velocity's history [D]; rounded up to whole periods of the medium.
    #[serde(default = "default_block")]
    pub block: f64,
    /// The plateau behind the front, for the mass balance.
    #[serde(default)]
    pub plateau: PlateauMargins,
}

/// What is left out of the plateau at its ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PlateauMargins {
    /// Behind the front [D].
    pub front: f64,
    /// Before the outlet [D].
    pub outlet: f64,
}

impl Default for PlateauMargins {
    fn default() -> Self {
        Self { front: 40.0, outlet: 10.0 }
    }
}

fn default_front_place() -> f64 {
    0.5
}

fn default_exchange_drift() -> f64 {
    1.0
}

fn default_block() -> f64 {
    10.0
}

impl WindowSettings {
    /// Defaults for a box of a length [m] and a particle velocity [m/s].
    pub fn new(length: f64, particle_velocity: f64) -> Self {
        Self {
            length,
            particle_velocity,
            inlet_velocity: None,
            front_place: default_front_place(),
            regions: RegionWidths::default(),
            inlet: InletKind::default(),
            search: Search::default(),
            exchange_drift: default_exchange_drift(),
            block: default_block(),
            plateau: PlateauMargins::default(),
        }
    }

    /// `u_in` at the start [m/s].
    pub fn start_velocity(&self) -> f64 {
        self.inlet_velocity.unwrap_or(self.particle_velocity)
    }

    /// Wanted place of the front [m].
    pub fn wanted_front(&self) -> f64 {
        self.front_place * self.length
    }

    /// Bounds of the regions for particles of a size [m].
    pub fn regions_for(&self, particle_size: f64) -> Regions {
        Regions::new(self.length, &self.regions, particle_size)
    }

    /// Checks every number against a particle size [m].
    ///
    /// # Errors
    ///
    /// [`WindowError::Setting`] for the first number out of its bounds.
    pub fn validate(&self, particle_size: f64) -> Result<(), WindowError> {
        let regions = self.regions_for(particle_size);
        let widths = self.regions;
        let front = self.wanted_front();
        let wave_speed = match self.inlet {
            InletKind::ImpedanceMatched { wave_speed: Some(speed) } => speed,
            _ => 1.0,
        };
        let checks = [
            ("length", self.length, "m", self.length > 0.0, "must be positive"),
            (
                "particle_velocity",
                self.particle_velocity,
                "m/s",
                self.particle_velocity > 0.0,
                "must be positive",
            ),
            (
                "inlet_velocity",
                self.start_velocity(),
                "m/s",
                self.start_velocity() >= self.particle_velocity,
                "must not be below particle_velocity, or matter would enter through the outlet",
            ),
            ("regions.inlet", widths.inlet, "D", widths.inlet > 0.0, "must be positive"),
            (
                "regions.outlet_velocity",
                widths.outlet_velocity,
                "D",
                widths.outlet_velocity > 0.0,
                "must be positive",
            ),
            (
                "regions.outlet_frozen",
                widths.outlet_frozen,
                "D",
                widths.outlet_frozen >= 0.0,
                "must not be negative",
            ),
            (
                "length",
                self.length,
                "m",
                regions.flow_length() > 20.0 * particle_size,
                "must leave a flow of more than 20 particle sizes between the regions",
            ),
            (
                "front_place",
                self.front_place,
                "",
                front > regions.outlet_end + 4.0 * particle_size
                    && front < regions.inlet_start - 4.0 * particle_size,
                "must lie in the flow, four particle sizes or more from its ends",
            ),
            ("inlet.wave_speed", wave_speed, "m/s", wave_speed > 0.0, "must be positive"),
            (
                "exchange_drift",
                self.exchange_drift,
                "D",
                self.exchange_drift > 0.0 && self.exchange_drift < widths.inlet.min(widths.outlet_velocity),
                "must be positive and below the widths of the inlet and of outlet 1",
            ),
            ("block", self.block, "D", self.block > 0.0, "must be positive"),
            ("plateau.front", self.plateau.front, "D", self.plateau.front >= 0.0, "must not be negative"),
            ("plateau.outlet", self.plateau.outlet, "D", self.plateau.outlet >= 0.0, "must not be negative"),
        ];
        for (field, value, unit, good, reason) in checks.into_iter().chain(self.search_checks()) {
            if !good || !value.is_finite() {
                return Err(WindowError::Setting { field, value, unit, reason });
            }
        }
        Ok(())
    }

    fn search_checks(&self) -> Vec<(&'static str, f64, &'static str, bool, &'static str)> {
        let tracking = match self.search {
            Search::FixedFrame => return Vec::new(),
            Search::Bisection(bisection) => return bisection_checks(&bisection),
            Search::FrameTracking(tracking) => tracking,
        };
        let (gain, pull, interval) = (tracking.gain, tracking.pull, tracking.interval);
        vec![
            ("search.gain", gain, "", gain > 0.0 && gain <= 1.0, "must lie above 0 and not above 1"),
            ("search.pull", pull, "", (0.0..=0.5).contains(&pull), "must lie between 0 and 0.5"),
            ("search.interval", interval, "D", interval > 0.0, "must be positive"),
        ]
    }
}

fn bisection_checks(b: &Bisection) -> Vec<(&'static str, f64, &'static str, bool, &'static str)> {
    let (low, high) = b.bracket.unwrap_or((0.0, f64::MAX));
    let part = b.half_width;
    vec![
        ("search.bracket", low, "m/s", low >= 0.0, "must not be negative"),
        ("search.bracket", high, "m/s", high > low + b.tolerance, "must lie above the lower end"),
        ("search.half_width", part, "", part > 0.0 && part < 1.0, "must lie between 0 and 1"),
        ("search.samples", b.samples, "", b.samples >= 1.0, "must be 1 or more"),
        ("search.tolerance", b.tolerance, "m/s", b.tolerance > 0.0, "must be positive"),
        ("search.settle", b.settle, "", b.settle >= 0.0, "must not be negative"),
        ("search.rounds", f64::from(b.rounds), "", b.rounds >= 1, "must be 1 or more"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_named() {
        let good = WindowSettings::new(2e-4, 100.0);
        assert!(good.validate(1e-6).is_ok());
        let fault = |settings: WindowSettings| settings.validate(1e-6).unwrap_err().to_string();
        assert!(fault(WindowSettings { length: f64::NAN, ..good }).starts_with("length = NaN m"));
        assert!(fault(WindowSettings { length: 3e-5, ..good }).contains("more than 20 particle sizes"));
        assert!(fault(WindowSettings { particle_velocity: 0.0, ..good }).starts_with("particle_velocity"));
        assert!(fault(WindowSettings { inlet_velocity: Some(99.0), ..good }).contains("through the outlet"));
        assert!(fault(WindowSettings { front_place: 0.99, ..good }).starts_with("front_place = 0.99"));
        assert!(fault(WindowSettings { exchange_drift: 5.0, ..good }).starts_with("exchange_drift = 5 D"));
        let inlet = InletKind::ImpedanceMatched { wave_speed: Some(-2.0) };
        assert!(fault(WindowSettings { inlet, ..good }).starts_with("inlet.wave_speed = -2 m/s"));
    }

    #[test]
    fn what_is_not_given_has_its_default() {
        let read = |text: &str| ron::from_str::<WindowSettings>(text);
        assert_eq!(read("(length: 2e-4, particle_velocity: 100)").unwrap(), WindowSettings::new(2e-4, 100.0));
        let settings = WindowSettings {
            inlet: InletKind::ImpedanceMatched { wave_speed: Some(2100.0) },
            search: Search::FixedFrame,
            ..WindowSettings::new(1e-3, 250.0)
        };
        assert_eq!(read(&ron::to_string(&settings).unwrap()).unwrap(), settings);
        assert!(read("(length: 2e-4, particle_velocity: 100, frontplace: 0.5)").is_err());
    }
}
