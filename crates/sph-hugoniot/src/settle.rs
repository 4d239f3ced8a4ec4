//! When a point has settled, and what its u_s is worth.
//!
//! From the end of start-up on the front's way is cut into blocks of whole cells. After each block the last of them, the
//! *stretch*, are judged:
//!
//! 1. **Agreement.** The u_s of the stretch's blocks spread by at most `tolerance`.
//! 2. **No drift.** The straight line through the u_s of its cells rises or falls by at most `tolerance` from its first
//!    cell to its last.
//!
//! The first alone is deceived by a slow oscillation: at its turning point two blocks agree by chance. The second sees
//! that most cells before the turning point lie on one side. A stretch is at least [`LEAST_PART`] of the window long,
//! because the slowest motion of the front takes about as long as the matter needs to pass the box.
//!
//! The uncertainty of u_s is made of two parts, added in squares: the standard error of the mean of the stretch by batch
//! means ([`crate::statistics`]), which counts autocorrelation within it, and [`DRIFT_PART`] of the drift, which stands for
//! all that is slower than the stretch: the larger of the change within it and the change against what was measured
//! before it, since start-up.
//!
//! Every block leaves a [`BlockRecord`]: the table `blocks.csv` of a point says why it went on or ended.

use serde::{Deserialize, Serialize};

use crate::config::case::Stop;
use crate::statistics::{harmonic_mean, line_slope, mean, relative_spread, standard_error};

/// Part of a drift that counts as uncertainty of the mean.
const DRIFT_PART: f64 = 0.5;

/// What followed from a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Decision {
    /// Before the start-up material had left: not counted.
    StartUp,
    /// Fewer blocks than must agree.
    TooFew,
    /// The blocks of the stretch disagree.
    Disagree,
    /// They agree, and u_s drifts.
    Drifts,
    /// The point has settled.
    Settled,
}

impl std::fmt::Display for Decision {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::StartUp => "start-up",
            Self::TooFew => "too few blocks",
            Self::Disagree => "blocks disagree",
            Self::Drifts => "drifts",
            Self::Settled => "settled",
        })
    }
}

/// One block of cells, and what was concluded when it was full. `NaN` where nothing could be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BlockRecord {
    /// Cells swept when it started.
    pub from: f64,
    /// Cells swept when it ended.
    pub to: f64,
    /// u_s over it [m/s].
    pub shock_velocity: f64,
    /// u_s over the stretch [m/s].
    pub mean: f64,
    /// Spread of the blocks of the stretch, relative to the mean [-].
    pub spread: f64,
    /// Change of u_s along the stretch, relative to the mean [-].
    pub drift: f64,
    /// Uncertainty of the mean [m/s].
    pub error: f64,
    /// What followed.
    pub decision: Decision,
}

/// The blocks that start-up consists of, from the velocities of its cells [m/s].
pub fn startup_records(cells: &[f64], first: f64, block_cells: usize) -> Vec<BlockRecord> {
    let record = |(k, block): (usize, &[f64])| BlockRecord {
        from: first + (k * block_cells) as f64,
        to: first + (k * block_cells + block.len()) as f64,
        shock_velocity: harmonic_mean(block),
        mean: f64::NAN,
        spread: f64::NAN,
        drift: f64::NAN,
        error: f64::NAN,
        decision: Decision::StartUp,
    };
    cells.chunks(block_cells).enumerate().map(record).collect()
}

/// The cells at the end that u_s is averaged over: whole blocks, at most those that must agree; all there are while
/// there is no whole block.
pub fn stretch<'c>(cells: &'c [f64], stop: &Stop, blocks: usize) -> &'c [f64] {
    let full = cells.len() / stop.block_cells * stop.block_cells;
    if full == 0 {
        return cells;
    }
    &cells[full.saturating_sub(blocks * stop.block_cells)..full]
}

/// Judges the cells since start-up when a block is full: `from` cells were swept at the end of start-up, and `blocks`
/// blocks must agree.
pub fn judge(cells: &[f64], from: f64, stop: &Stop, blocks: usize) -> BlockRecord {
    let counted = stretch(cells, stop, blocks);
    let full = cells.len() / stop.block_cells * stop.block_cells;
    let speeds: Vec<f64> = counted.chunks(stop.block_cells).map(harmonic_mean).collect();
    let (spread, drift) = (relative_spread(&speeds), drift(counted));
    let decision = if speeds.len() < blocks {
        Decision::TooFew
    } else if spread > stop.tolerance {
        Decision::Disagree
    } else if drift.abs() > stop.tolerance {
        Decision::Drifts
    } else {
        Decision::Settled
    };
    BlockRecord {
        from: from + (full - stop.block_cells) as f64,
        to: from + full as f64,
        shock_velocity: speeds.last().copied().unwrap_or(f64::NAN),
        mean: harmonic_mean(counted),
        spread,
        drift,
        error: uncertainty(cells, stop, blocks),
        decision,
    }
}

/// Change of u_s from the first cell to the last along the straight line through them, relative to their mean [-].
fn drift(cells: &[f64]) -> f64 {
    line_slope(cells) * (cells.len() as f64 - 1.0) / mean(cells)
}

/// Uncertainty of the u_s of the stretch [m/s]; `NaN` for fewer than two cells.
pub fn uncertainty(cells: &[f64], stop: &Stop, blocks: usize) -> f64 {
    let counted = stretch(cells, stop, blocks);
    let end = cells.len() / stop.block_cells * stop.block_cells;
    let before = &cells[..end.saturating_sub(counted.len()).min(cells.len())];
    let before = &before[before.len().saturating_sub(counted.len())..];
    let within = (drift(counted) * mean(counted)).abs();
    let against = if before.is_empty() { 0.0 } else { (mean(counted) - mean(before)).abs() };
    standard_error(counted).hypot(DRIFT_PART * within.max(against))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stop() -> Stop {
        Stop { startup_cells: None, block_cells: 4, blocks: 2, tolerance: 0.005, max_fed_cells: 60 }
    }

    /// u_s of the porous copper at u_p = 50 m/s, cell by cell after start-up, from a run of this program. At its 24th cell
    /// here the slow oscillation turns, and two blocks agree within half a percent; the mean falls to 315 m/s later.
    const TURNING: [f64; 36] = [
        377.1, 352.7, 355.0, 353.1, 343.1, 329.9, 316.6, 305.7, 302.1, 304.1, 307.3, 307.2, 306.7, 308.2, 310.0, 311.7,
        314.5, 317.0, 318.2, 320.3, 322.6, 321.9, 320.1, 319.3, 318.7, 318.3, 317.9, 317.3, 316.1, 316.5, 315.8, 315.6,
        316.0, 314.9, 315.0, 315.9,
    ];

    #[test]
    fn a_turning_point_is_not_the_end() {
        let settled_at = |tolerance: f64| {
            let stop = Stop { tolerance, ..stop() };
            (4..=TURNING.len())
                .step_by(4)
                .find(|&n| judge(&TURNING[..n], 26.0, &stop, 2).decision == Decision::Settled)
        };
        assert_eq!(settled_at(0.005), Some(36));
        let at = judge(&TURNING[..24], 26.0, &stop(), 2);
        assert!((at.mean - 319.2).abs() < 0.1, "{at:?}");
        assert!(at.error > 4.0, "the error covers what is still to come: {at:?}");
        let end = judge(&TURNING, 26.0, &stop(), 2);
        assert!(end.error < 2.0 && (end.to - 62.0).abs() < 1e-12, "{end:?}");
    }

    #[test]
    fn steady_noise_settles_and_keeps_its_error() {
        let cells: Vec<f64> = (0..16).map(|k| 940.0 + [0.4, -0.5, 0.3, -0.2][k % 4]).collect();
        assert_eq!(judge(&cells[..4], 14.0, &stop(), 2).decision, Decision::TooFew);
        let record = judge(&cells, 14.0, &stop(), 2);
        assert_eq!(record.decision, Decision::Settled);
        assert!(record.error < 0.4 && record.spread < 1e-4, "{record:?}");
        assert_eq!(stretch(&cells[..14], &stop(), 2).len(), 8);
        assert_eq!(stretch(&cells[..3], &stop(), 2).len(), 3);
        assert_eq!(startup_records(&cells[..6], 0.4, 4).len(), 2);
    }
}
