//! The shock velocity, from the way of the front through the medium.
//!
//! Let `x_f` be the place of the front in the box and `X_fed` the length of the medium that has come in.
//! Lengths of the medium are those of the medium as it is fed, of density `ρ00`: in a steady state
//! `ρ00 u_s` is the mass flux through the front. Their sum, the *swept length* `X = X_fed + x_f = ∫ (u_b + v_f) dt`, is the place of the front relative to
//! that medium. It does not know the frame, and boosts leave it continuous: `u_s = dX/dt`, whatever the
//! frame.
//!
//! The history keeps the times at which X first passes whole multiples of a block length, itself a whole number of
//! periods of the medium: each [`Block`] gives one value of `u_s`, their scatter its uncertainty.

use serde::{Deserialize, Serialize};

/// The front's way through one block of the medium.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// When the front entered it [s].
    pub start: f64,
    /// When the front left it [s].
    pub end: f64,
    /// Swept length where it starts [m].
    pub swept: f64,
    /// Its length [m].
    pub length: f64,
}

impl Block {
    /// Mean shock velocity over the block [m/s].
    pub fn velocity(&self) -> f64 {
        self.length / (self.end - self.start)
    }
}

/// A shock velocity with its uncertainty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// `u_s` relative to the medium ahead [m/s]: length of all blocks over their time.
    pub velocity: f64,
    /// Standard deviation of the blocks over the root of their number [m/s]; infinite for one block.
    pub standard_error: f64,
    /// The blocks that it is made of.
    pub blocks: Vec<Block>,
}

impl Estimate {
    /// The estimate from consecutive blocks; `None` without any.
    ///
    /// Times at which the front passes are noisy, so that neighboring blocks err in opposite directions: the standard
    /// error from their scatter is on the safe side.
    pub fn from_blocks(blocks: Vec<Block>) -> Option<Self> {
        let (first, last) = (blocks.first()?, blocks.last()?);
        let count = blocks.len() as f64;
        let velocity = blocks.iter().map(|b| b.length).sum::<f64>() / (last.end - first.start);
        let squares: f64 = blocks.iter().map(|b| (b.velocity() - velocity).powi(2)).sum();
        let standard_error =
            if blocks.len() > 1 { (squares / (count - 1.0) / count).sqrt() } else { f64::INFINITY };
        Some(Self { velocity, standard_error, blocks })
    }
}

/// When the front passed which length of the medium.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShockHistory {
    block_length: f64,
    start: f64,
    last: Option<(f64, f64)>,
    passages: Vec<f64>,
}

impl ShockHistory {
    /// A history of blocks of a length [m].
    pub fn new(block_length: f64) -> Self {
        Self { block_length, start: 0.0, last: None, passages: Vec::new() }
    }

    /// Takes in the swept length X [m] at a time [s]. The first observation is the first passage.
    pub fn observe(&mut self, time: f64, swept: f64) {
        if let Some((time_before, swept_before)) = self.last {
            let mut mark = self.start + self.passages.len() as f64 * self.block_length;
            while swept >= mark {
                let part = (mark - swept_before) / (swept - swept_before);
                self.passages.push(time_before + part * (time - time_before));
                mark = self.start + self.passages.len() as f64 * self.block_length;
            }
        } else {
            self.start = swept;
            self.passages.push(time);
        }
        self.last = Some((time, swept));
    }

    /// Length of a block [m].
    pub fn block_length(&self) -> f64 {
        self.block_length
    }

    /// Last swept length [m].
    pub fn swept(&self) -> Option<f64> {
        self.last.map(|(_, swept)| swept)
    }

    /// All blocks so far.
    pub fn blocks(&self) -> Vec<Block> {
        let block = |(k, pair): (usize, &[f64])| Block {
            start: pair[0],
            end: pair[1],
            swept: self.start + k as f64 * self.block_length,
            length: self.block_length,
        };
        self.passages.windows(2).enumerate().map(block).collect()
    }

    /// The blocks that start at a swept length [m] or later.
    pub fn blocks_from(&self, swept: f64) -> Vec<Block> {
        let mut blocks = self.blocks();
        blocks.retain(|block| block.swept >= swept);
        blocks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_give_the_speed_and_its_scatter() {
        let mut history = ShockHistory::new(20.0);
        for k in 0..4_001 {
            let time = 0.1 * k as f64;
            history.observe(time, 5.0 + 7.0 * time + 0.5 * (0.9 * time).sin());
        }
        let blocks = history.blocks();
        assert_eq!(blocks.len(), 140, "2800 over 20");
        let estimate = Estimate::from_blocks(blocks).unwrap();
        assert!((estimate.velocity - 7.0).abs() < 0.01, "{}", estimate.velocity);
        assert!(estimate.standard_error > 0.0 && estimate.standard_error < 0.05);
        assert_eq!(history.blocks_from(1005.0).len(), history.blocks().len() - 50);
        assert!(Estimate::from_blocks(Vec::new()).is_none());
    }

    #[test]
    fn several_blocks_may_pass_between_two_observations() {
        let mut history = ShockHistory::new(1.0);
        history.observe(0.0, 0.0);
        history.observe(10.0, 5.0);
        let blocks = history.blocks();
        assert_eq!(blocks.len(), 5);
        assert!(blocks.iter().all(|b| (b.velocity() - 0.5).abs() < 1e-12));
    }
}
