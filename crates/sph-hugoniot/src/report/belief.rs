//! Whether a point can be believed: what is asked of it, and from where on the answer is yes.
//!
//! The bounds stand where the known runs leave them: porous copper with D = 1 and 2 µm at u_p ≥ 150 m/s, where the jump
//! conditions give u_s, agrees within 0.2 %, and passes, but for its pores at 2 µm ("Reading the report" in the guide has
//! the figures). What was as large there as anywhere else says nothing about u_s and is not judged: the virtual work of
//! volume consistency, and the coldest particle. A verdict is a hint where to look, not a proof.

use sph_io::html::{Check, Verdict};
use sph_window::ledger::larger;

use crate::config::Case;
use crate::microstructure::measure;
use crate::outcome::{PointOutcome, Status};
use crate::separation;

/// Bounds of a figure of which less is better: good up to the first, to be looked at up to the second.
type Bounds = (f64, f64);

const STANDARD_ERROR: Bounds = (0.01, 0.03);
const MASS_BALANCE: Bounds = (0.01, 0.03);
const JUMP_RESIDUAL: Bounds = (0.01, 0.03);
const BOOKS: Bounds = (1e-11, 1e-8);
const PACKING_EXCESS: Bounds = (0.005, 0.02);
const FAILED: Bounds = (0.02, 0.1);
/// Relaxed matter that must be left between the front and the outlet [cells].
const RELAXED_CELLS: f64 = 3.0;
/// Particles across a pore: good from the first on, to be looked at from the second on.
const PORE: Bounds = (8.0, 4.0);

/// Names of the checks, in the order of [`answers`].
pub const NAMES: [&str; 10] = [
    "settled",
    "scatter",
    "mass balance",
    "jump conditions",
    "books",
    "packing",
    "two waves",
    "room",
    "tension",
    "pores",
];

/// An answer, and how bad it is.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The answer.
    pub check: Check,
    /// Larger is worse: to tell the worst of several points.
    pub severity: f64,
}

fn answer(verdict: Verdict, severity: f64, name: &str, value: String, meaning: impl Into<String>) -> Answer {
    Answer { check: Check::new(verdict, name, value, meaning), severity }
}

fn judged(value: f64, (good, fair): Bounds) -> Verdict {
    match value {
        v if v.is_nan() => Verdict::Unknown,
        v if v <= good => Verdict::Good,
        v if v <= fair => Verdict::Caution,
        _ => Verdict::Bad,
    }
}

fn percent(value: f64) -> String {
    if value.is_nan() { "not measured".into() } else { format!("{:.2} %", 100.0 * value) }
}

/// What is asked of a point, in the order of [`NAMES`].
pub fn answers(case: &Case, outcome: &PointOutcome) -> Vec<Answer> {
    vec![
        settled(outcome),
        scatter(outcome),
        mass_balance(outcome),
        jump_conditions(outcome),
        books(outcome),
        packing(outcome),
        two_waves(case, outcome),
        room(case, outcome),
        tension(outcome),
        pores(case),
    ]
}

/// The answers without their severity.
pub fn checks(case: &Case, outcome: &PointOutcome) -> Vec<Check> {
    answers(case, outcome).into_iter().map(|answer| answer.check).collect()
}

/// The worst of all checks of a point.
pub fn verdict(case: &Case, outcome: &PointOutcome) -> Verdict {
    Verdict::worst(checks(case, outcome).iter().map(|check| check.verdict))
}

fn settled(outcome: &PointOutcome) -> Answer {
    let (verdict, meaning) = match &outcome.status {
        Status::Settled => (Verdict::Good, "Successive blocks of cells gave the same u_s.".to_owned()),
        Status::NotSettled => (
            Verdict::Caution,
            "`max_fed_cells` came before successive blocks agreed: allow more cells, and look at the history.".into(),
        ),
        Status::Interrupted => {
            (Verdict::Caution, "Stopped on the way: go on with `--resume`. What is shown is not final.".into())
        }
        Status::Failed(reason) => (Verdict::Bad, reason.clone()),
    };
    let value = if outcome.has_failed() { "failed".to_owned() } else { outcome.status.to_string() };
    answer(verdict, f64::from(verdict as u8), "Settled", value, meaning)
}

fn scatter(outcome: &PointOutcome) -> Answer {
    let share = outcome.standard_error / outcome.shock_velocity;
    answer(
        judged(share, STANDARD_ERROR),
        share,
        "Scatter of u_s",
        percent(share),
        format!(
            "Standard error over u_s, from {} cells, with what of a slow settling the blocks show: look at the history.",
            outcome.averaged_cells
        ),
    )
}

fn mass_balance(outcome: &PointOutcome) -> Answer {
    let share = (outcome.mass_balance_velocity / outcome.shock_velocity - 1.0).abs();
    answer(
        judged(share, MASS_BALANCE),
        share,
        "Front against mass balance",
        percent(share),
        "u_s from the front's way against u_s from the mass that piles up behind it: two readings that know nothing of \
         each other.",
    )
}

fn jump_conditions(outcome: &PointOutcome) -> Answer {
    let residuals = outcome.residuals.map(|r| [r.mass, r.momentum, r.energy]);
    let worst = outcome.residuals.map_or(f64::NAN, |r| r.worst());
    let value = residuals.map_or("not measured".to_owned(), |r| {
        let [mass, momentum, energy] = r.map(|x| 100.0 * x);
        format!("mass {mass:.2} %, momentum {momentum:.2} %, energy {energy:.2} %")
    });
    answer(
        judged(worst, JUMP_RESIDUAL),
        worst,
        "Jump conditions",
        value,
        "What the states on both sides miss the jump conditions by at this u_s. A large miss: the window is too short, or \
         the front is not steady.",
    )
}

fn books(outcome: &PointOutcome) -> Answer {
    let gap = outcome.worst().map_or(outcome.ledger_residual, |w| {
        larger(larger(w.momentum_gap, w.energy_gap), outcome.ledger_residual)
    });
    answer(
        judged(gap, BOOKS),
        gap,
        "Books of mass, momentum and energy",
        format!("gap {gap:.1e}"),
        "What came in, went out and was put in against what is in the window; round-off, or the program is wrong.",
    )
}

fn packing(outcome: &PointOutcome) -> Answer {
    let ratio = outcome.states.map_or(f64::NAN, |s| s.behind.packing_density / s.behind.own_density);
    let (verdict, value) = (judged(ratio - 1.0, PACKING_EXCESS), format!("{ratio:.4}"));
    answer(
        verdict,
        ratio,
        "Packing against own density",
        if ratio.is_nan() { "not measured".into() } else { value },
        "Behind the front: below 1 with open pores, 1 with shut ones; above 1 the particles are denser than they know, and \
         u_s is too low.",
    )
}

fn two_waves(case: &Case, outcome: &PointOutcome) -> Answer {
    let (u_p, u_s) = (outcome.particle_velocity, outcome.shock_velocity);
    let precursor = outcome.precursor.as_ref();
    let one = separation::finding(&case.materials(), case.medium.porosity, u_p, u_s, precursor);
    let (verdict, value) = match (one, &outcome.precursor, &outcome.states) {
        (Some(words), _, _) => (Verdict::Bad, words),
        (None, Some(p), Some(states)) => (
            Verdict::Good,
            format!(
                "precursor {:.0} m/s, σ_HEL {:.3} GPa; front {u_s:.0} m/s",
                p.speed,
                -states.ahead.stress * 1e-9
            ),
        ),
        (None, ..) => {
            let reason =
                outcome.precursor_missing.clone().unwrap_or_else(|| "the point did not start".into());
            (Verdict::Unknown, format!("precursor not read: {reason}"))
        }
    };
    answer(
        verdict,
        f64::from(verdict as u8),
        "Two waves",
        value,
        "The compaction front must run behind the elastic precursor: else σ_HEL and the stress jump mean nothing.",
    )
}

fn room(case: &Case, outcome: &PointOutcome) -> Answer {
    let cell = case.medium.cell;
    let relaxed = outcome.states.map_or(f64::NAN, |s| s.relaxation_length / cell);
    let room = outcome.states.map_or(f64::NAN, |s| s.room_behind / cell);
    let verdict = match room - relaxed {
        left if left.is_nan() => Verdict::Unknown,
        left if left >= RELAXED_CELLS => Verdict::Good,
        _ => Verdict::Caution,
    };
    let value = match verdict {
        Verdict::Unknown => "not measured".to_owned(),
        _ => format!("relaxes over {relaxed:.1} of {room:.1} cells"),
    };
    answer(
        verdict,
        relaxed - room,
        "Room behind the front",
        value,
        "Three cells of relaxed matter must be left before the outlet. Else the length of the window is in the result: the \
         warning says what to take.",
    )
}

fn tension(outcome: &PointOutcome) -> Answer {
    let failed = outcome.worst().map_or(f64::NAN, |w| w.failed_share);
    answer(
        judged(failed, FAILED),
        failed,
        "Failed in tension",
        percent(failed),
        "Largest share of particles at any moment. More than jets where pores shut: a tensile instability.",
    )
}

fn pores(case: &Case) -> Answer {
    let features = measure::features(&case.medium);
    let across = features.smallest_pore.unwrap_or(0.0);
    let value = match features.smallest_gap {
        Some(gap) => {
            format!("{across:.1} particles across the smallest pore, {gap:.1} across the narrowest wall")
        }
        None => format!("{across:.1} particles across the smallest pore"),
    };
    let (verdict, value) = match across {
        a if a <= 0.0 => (Verdict::Good, "no pores".to_owned()),
        a if a >= PORE.0 => (Verdict::Good, value),
        a if a >= PORE.1 => (Verdict::Caution, value),
        _ => (Verdict::Bad, value),
    };
    answer(
        verdict,
        -across,
        "Resolution of the pores",
        value,
        "Measured where pores stay open: with 4 particles across u_s misses that of 16 by up to 12 %, with 8 by up to 5 %. \
         Where they shut 4 suffice. No number of them proves that u_s has converged: run `--resolutions`.",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_follow_the_bounds_and_not_a_number_is_not_judged() {
        assert_eq!(judged(0.009, MASS_BALANCE), Verdict::Good);
        assert_eq!(judged(0.02, MASS_BALANCE), Verdict::Caution);
        assert_eq!(judged(0.2, MASS_BALANCE), Verdict::Bad);
        assert_eq!(judged(f64::NAN, MASS_BALANCE), Verdict::Unknown);
    }

    #[test]
    fn a_failed_point_is_bad_and_says_why() {
        let text = crate::template::text("smoke").unwrap();
        let case = crate::config::parse(text, "smoke.ron").unwrap();
        let outcome = PointOutcome::failed(100.0, "the step fell to nothing".into());
        let checks = checks(&case, &outcome);
        assert_eq!(checks.len(), NAMES.len());
        assert_eq!(verdict(&case, &outcome), Verdict::Bad);
        assert!(checks[0].meaning.contains("fell to nothing"));
        assert_eq!(checks[2].verdict, Verdict::Unknown);
    }

    #[test]
    fn books_with_a_gap_that_is_not_a_number_are_not_good() {
        use crate::monitor::MonitorRow;
        let of = |momentum_gap: f64, energy_gap: f64, ledger_residual: f64| {
            let monitors = vec![MonitorRow { momentum_gap, energy_gap, ..MonitorRow::default() }];
            let outcome = PointOutcome::failed(100.0, String::new());
            books(&PointOutcome { monitors, ledger_residual, ..outcome }).check.verdict
        };
        assert_eq!(of(1e-15, 2e-15, 3e-15), Verdict::Good);
        for (momentum, energy, all) in
            [(f64::NAN, 1e-15, 1e-15), (1e-15, f64::NAN, 1e-15), (1e-15, 1e-15, f64::NAN)]
        {
            assert_eq!(of(momentum, energy, all), Verdict::Unknown);
        }
    }
}
