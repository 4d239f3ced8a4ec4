//! Where the time of a run goes.

use std::time::Instant;

/// Stages of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepStage {
    /// Sorting particles, building neighbor lists, and finding how long they still hold.
    Lists,
    /// Volume sums.
    Volume,
    /// Images of records across periodic sides, time step; after a rebuild equations of state and records too.
    Prepare,
    /// First pass: gradients and half step; printed surface rules.
    Gradient,
    /// Second pass: contacts.
    Contact,
    /// Time-centering at free surfaces.
    Centering,
    /// Update of the state, equations of state and records of the next step.
    Update,
}

impl StepStage {
    /// Every stage, in the order of a step.
    pub const ALL: [Self; 7] = [
        Self::Lists,
        Self::Volume,
        Self::Prepare,
        Self::Gradient,
        Self::Contact,
        Self::Centering,
        Self::Update,
    ];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lists => "neighbor lists",
            Self::Volume => "volume sums",
            Self::Prepare => "images, time step",
            Self::Gradient => "gradients",
            Self::Contact => "contacts",
            Self::Centering => "time-centering",
            Self::Update => "update",
        }
    }
}

/// Seconds spent in each stage, and rebuilds of the lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StageTimes {
    seconds: [f64; 7],
    /// Number of rebuilds of the neighbor lists.
    pub rebuilds: u64,
}

impl StageTimes {
    /// Adds the time since `from` to a stage and starts the next.
    pub(crate) fn add(&mut self, stage: StepStage, from: &mut Instant) {
        let now = Instant::now();
        self.seconds[stage as usize] += (now - *from).as_secs_f64();
        *from = now;
    }

    /// Time spent in a stage [s].
    pub fn seconds(&self, stage: StepStage) -> f64 {
        self.seconds[stage as usize]
    }

    /// Time spent in all stages [s].
    pub fn total(&self) -> f64 {
        self.seconds.iter().sum()
    }

    /// Stages with their times [s] and their shares of the total.
    pub fn table(&self) -> Vec<(&'static str, f64, f64)> {
        let total = self.total().max(f64::MIN_POSITIVE);
        StepStage::ALL.iter().map(|&s| (s.name(), self.seconds(s), self.seconds(s) / total)).collect()
    }

    /// What has been added since an earlier reading.
    pub fn since(&self, earlier: &Self) -> Self {
        let seconds = std::array::from_fn(|s| self.seconds[s] - earlier.seconds[s]);
        Self { seconds, rebuilds: self.rebuilds - earlier.rebuilds }
    }

    /// Adds the times of another simulation.
    pub fn merge(&mut self, other: &Self) {
        (0..self.seconds.len()).for_each(|s| self.seconds[s] += other.seconds[s]);
        self.rebuilds += other.rebuilds;
    }
}
