//! The time step and its reason.
//!
//! τ = C min D/(c_l + |U_rel|): c_l of the current state, U_rel the largest speed relative to a neighbor in the last step
//! (paper: no time step is given; the Courant number bounds it).

use std::fmt;

use sph_core::lanes::{LANES, Lanes, Line};
use sph_core::particles::Particles;

use crate::dimension::SolidDimension;
use crate::record::Row;

/// Why a step was as long as it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeStepReason {
    /// The Courant condition of a particle.
    Courant {
        /// Its id.
        particle: u64,
        /// Its longitudinal sound speed [m/s].
        sound_speed: f64,
        /// Its largest speed relative to a neighbor [m/s].
        relative_speed: f64,
    },
    /// The caller's limit.
    Limit,
}

impl fmt::Display for TimeStepReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Courant { particle, sound_speed, relative_speed } => write!(
                f,
                "Courant condition of particle {particle}: sound speed {sound_speed:.0} m/s, largest speed relative to a \
                 neighbor {relative_speed:.0} m/s"
            ),
            Self::Limit => f.write_str("the caller's limit"),
        }
    }
}

/// Least D/(c_l + |U_rel|) [s] of some particles, and the index of the first that has it.
pub type LeastStep = (f64, u32);

/// The smaller of two; a NaN wins: it is an error to be seen.
fn smaller(a: LeastStep, b: LeastStep) -> LeastStep {
    if a.0.is_nan() || b.0 >= a.0 { a } else { b }
}

/// The least steps among particles that come in blocks of eight, lane by lane.
pub(crate) struct LeastSteps<L> {
    step: L,
    /// Index of the first particle of the block that has the least step of the lane.
    block: L,
    /// A step that is not a number.
    broken: Option<LeastStep>,
}

impl<L: Lanes> LeastSteps<L> {
    #[inline(always)]
    pub fn none() -> Self {
        Self { step: L::splat(f64::INFINITY), block: L::zero(), broken: None }
    }

    /// Takes in the steps of the first `count` of eight particles from index `i` on.
    #[inline(always)]
    pub fn add(&mut self, i: usize, steps: L, count: usize) {
        let valid = u8::MAX >> (LANES - count);
        if steps.less_mask(L::splat(f64::INFINITY)) & valid != u8::MAX {
            return self.add_each(i, &steps.to_array()[..count]);
        }
        self.block = steps.select_less(self.step, L::splat(i as f64), self.block);
        self.step = steps.select_less(self.step, steps, self.step);
    }

    /// The same where a particle is missing, or a step is not finite.
    #[cold]
    fn add_each(&mut self, i: usize, steps: &[f64]) {
        let (mut least, mut block) = (self.step.to_array(), self.block.to_array());
        for (l, &step) in steps.iter().enumerate() {
            if step.is_nan() {
                self.broken.get_or_insert((step, (i + l) as u32));
            } else if step < least[l] {
                (least[l], block[l]) = (step, i as f64);
            }
        }
        (self.step, self.block) = (L::load(&least), L::load(&block));
    }

    #[inline(always)]
    pub fn of_tile(&self) -> LeastStep {
        let (step, block) = (self.step.to_array(), self.block.to_array());
        let mut least = self.broken.unwrap_or((f64::INFINITY, 0));
        for l in 0..LANES {
            let other = (step[l], block[l] as u32 + l as u32);
            let earlier = other.0 == least.0 && other.1 < least.1;
            least = if earlier { other } else { smaller(least, other) };
        }
        least
    }
}

/// The largest step [s] that the Courant number allows, from the least steps of the tiles, and its reason.
pub fn courant_step<D: SolidDimension>(
    particles: &Particles<D>,
    rows: &[Line],
    courant: f64,
    tiles: &[LeastStep],
) -> (f64, TimeStepReason) {
    let (step, i) = tiles.iter().copied().fold((f64::INFINITY, 0), smaller);
    let i = i as usize;
    let sound_speed = |i: usize| {
        let rows = &rows[i / LANES * Row::count::<D>()..];
        rows[Row::LONGITUDINAL].0[i % LANES] * rows[Row::INVERSE_DENSITY].0[i % LANES]
    };
    let reason = TimeStepReason::Courant {
        particle: particles.id.get(i).copied().unwrap_or(0),
        sound_speed: if particles.is_empty() { 0.0 } else { sound_speed(i) },
        relative_speed: particles.relative_speed.get(i).copied().unwrap_or(0.0),
    };
    (courant * step, reason)
}

/// Signal speed c_l + |U_rel| [m/s] of a Courant reason; zero for a limit.
pub fn signal_speed(reason: TimeStepReason) -> f64 {
    match reason {
        TimeStepReason::Courant { sound_speed, relative_speed, .. } => sound_speed + relative_speed,
        TimeStepReason::Limit => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph_core::lanes::{InstructionSet, LaneKernel, dispatch_with};

    /// Goes through the steps of a tile in lanes, and compares with one after the other.
    struct Compare<'a>(&'a [f64]);

    impl LaneKernel for Compare<'_> {
        #[inline(always)]
        fn run<L: Lanes>(self) {
            let mut lanes = LeastSteps::<L>::none();
            for (b, steps) in self.0.chunks(LANES).enumerate() {
                lanes.add(b * LANES, L::load_from(steps, 0), steps.len());
            }
            let each = self.0.iter().zip(0..).map(|(&step, i)| (step, i));
            let plain = each.fold((f64::INFINITY, 0), smaller);
            let seen = lanes.of_tile();
            assert_eq!((seen.0.to_bits(), seen.1), (plain.0.to_bits(), plain.1), "{:?}", self.0);
        }
    }

    #[test]
    fn the_first_of_the_least_steps_is_found_and_a_nan_wins() {
        let mut steps: Vec<f64> = (0..35).map(|i| 2.0 + f64::from((i * 11) % 7)).collect();
        let mut cases = vec![steps.clone(), steps[..1].to_vec(), vec![f64::INFINITY; 9], vec![]];
        steps[33] = f64::NAN;
        cases.push(steps.clone());
        (steps[4], steps[20]) = (f64::INFINITY, 1.0);
        cases.push(steps);
        for set in InstructionSet::available() {
            cases.iter().for_each(|steps| dispatch_with(set, Compare(steps)));
        }
    }
}
