//! When a point has settled, and what its u_s is worth.
//!
//! From the end of start-up on the front's way is cut into blocks of whole cells. After each block the last of them, the
//! *stretch*, are judged:
//!
//! 1. **Agreement.** The u_s of the stretch's blocks spread by at most `tolerance`.
//! 2. **No drift.** The straight line through the u_s of its cells rises or falls by at most twice that from its first cell
//!    to its last.
//! 3. **Known well enough.** The uncertainty of its mean is at most twice `tolerance`.
//!
//! The first alone is deceived by a slow oscillation: at its turning point two blocks agree by chance, and where the stretch
//! lies about that point like a mirror image there is no drift either. The third sees it: the uncertainty looks further back.
//!
//! It is made of two parts, added in squares: the standard error of the mean of the stretch by batch means
//! ([`crate::statistics`]), which counts autocorrelation within it, and `DRIFT_PART` of the drift, which stands for all
//! that is slower than the stretch: the larger of the change within it and the change against the stretch before it, as far
//! as that lies after start-up.
//!
//! Every block leaves a [`BlockRecord`]: the table `blocks.csv` of a point says why it went on or ended.

use serde::{Deserialize, Serialize};

use crate::config::case::Stop;
use crate::statistics::{harmonic_mean, line_slope, mean, relative_spread, standard_error};

/// Part of a drift that counts as uncertainty of the mean.
const DRIFT_PART: f64 = 0.5;

/// Drift and uncertainty that are accepted, in units of `tolerance`.
const ACCEPTED: f64 = 2.0;

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
    /// They agree without drift, and differ from what was before.
    Uncertain,
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
            Self::Uncertain => "uncertain",
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
pub(crate) fn startup_records(cells: &[f64], first: f64, block_cells: usize) -> Vec<BlockRecord> {
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
pub(crate) fn stretch<'c>(cells: &'c [f64], stop: &Stop, blocks: usize) -> &'c [f64] {
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
    let (mean, error) = (harmonic_mean(counted), uncertainty(cells, stop, blocks));
    let decision = if speeds.len() < blocks {
        Decision::TooFew
    } else if spread > stop.tolerance {
        Decision::Disagree
    } else if drift.abs() > ACCEPTED * stop.tolerance {
        Decision::Drifts
    } else if error > ACCEPTED * stop.tolerance * mean {
        Decision::Uncertain
    } else {
        Decision::Settled
    };
    BlockRecord {
        from: from + (full - stop.block_cells) as f64,
        to: from + full as f64,
        shock_velocity: speeds.last().copied().unwrap_or(f64::NAN),
        mean,
        spread,
        drift,
        error,
        decision,
    }
}

/// Change of u_s from the first cell to the last along the straight line through them, relative to their mean [-].
fn drift(cells: &[f64]) -> f64 {
    line_slope(cells) * (cells.len() as f64 - 1.0) / mean(cells)
}

/// Uncertainty of the u_s of the stretch [m/s]; `NaN` for fewer than two cells.
pub(crate) fn uncertainty(cells: &[f64], stop: &Stop, blocks: usize) -> f64 {
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

    /// u_s of the porous copper at u_p = 50 m/s, cell by cell after start-up, from a run of this program. About its 20th
    /// cell here the slow oscillation turns, and two blocks agree within half a percent; what it settles to is 316 m/s.
    const TURNING: [f64; 48] = [
        377.2, 352.7, 354.9, 353.2, 343.1, 328.6, 315.4, 305.6, 302.3, 304.1, 305.4, 306.5, 307.7, 309.2,
        311.5, 312.8, 314.9, 319.1, 320.4, 320.2, 319.6, 320.8, 320.5, 319.5, 318.7, 318.4, 318.4, 317.2,
        316.6, 315.4, 316.5, 316.5, 315.4, 317.0, 315.0, 314.1, 315.2, 314.7, 316.0, 318.0, 316.6, 316.2,
        314.9, 315.3, 316.1, 315.8, 317.0, 316.5,
    ];
    const LIMIT: f64 = 316.0;

    /// Wherever the blocks begin, the uncertainty covers what is still to come.
    #[test]
    fn a_turning_point_is_not_the_end() {
        for start in 0..6 {
            let cells = &TURNING[start..];
            let counts = (4..=cells.len()).step_by(4);
            let records: Vec<BlockRecord> = counts.map(|n| judge(&cells[..n], 0.0, &stop(), 2)).collect();
            let agree = records.iter().skip(1).find(|r| r.spread <= 0.005).unwrap();
            let end = records.iter().find(|r| r.decision == Decision::Settled).unwrap();
            println!("agree {agree:?}\nend {end:?}");
            for record in [agree, end] {
                assert!((record.mean - LIMIT).abs() < 1.3 * record.error, "{start}: {record:?}");
            }
            assert!((end.mean / LIMIT - 1.0).abs() < 0.0125, "{start}: {end:?}");
        }
        // Here the last eight cells lie about the turning point like a mirror image.
        let mirror = judge(&TURNING[1..25], 0.0, &stop(), 2);
        assert!(mirror.spread < 5e-4 && mirror.drift.abs() < 2e-3, "{mirror:?}");
        assert!(mirror.decision == Decision::Uncertain && mirror.error > 5.0, "{mirror:?}");
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
