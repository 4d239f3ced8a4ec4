//! How a run ends that was interrupted early, late, or when all was done.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use super::{Earlier, Next, RunEnd, RunOptions, WayOut, end_of, next_round, run};
use crate::config::case::Refinement;
use crate::outcome::{PointOutcome, Status};
use crate::{config, template};

fn settled(u_p: f64, u_s: f64) -> PointOutcome {
    PointOutcome {
        shock_velocity: u_s,
        standard_error: 0.1,
        status: Status::Settled,
        ..PointOutcome::failed(u_p, String::new())
    }
}

#[test]
fn an_interrupt_cuts_short_only_where_a_point_is_missing() {
    let done = [settled(100.0, 425.0), settled(200.0, 757.0)];
    assert_eq!(next_round(&done, 2, None, true), Next::End(WayOut::Whole));
    assert_eq!(next_round(&done, 3, None, true), Next::End(WayOut::CutShort), "one was not begun");
    let stopped = [done[0].clone(), PointOutcome { status: Status::Interrupted, ..done[1].clone() }];
    assert_eq!(next_round(&stopped, 2, None, true), Next::End(WayOut::CutShort));
    let failed = [done[0].clone(), PointOutcome::failed(200.0, "broken".into())];
    assert_eq!(next_round(&failed, 2, None, true), Next::End(WayOut::Whole));
    let all: Vec<&PointOutcome> = failed.iter().collect();
    assert_eq!(end_of(&all, WayOut::Whole), RunEnd::SomeFailed, "not hidden by the interrupt");
}

#[test]
fn an_interrupt_cuts_an_adaptive_sweep_short_only_where_it_wants_more_points() {
    let bent = [50.0, 100.0, 200.0, 300.0].map(|u_p| settled(u_p, 0.02 * u_p * u_p + 100.0));
    let refinement = Refinement { tolerance: 0.003, max_points: 24 };
    let more = next_round(&bent, 4, Some(&refinement), false);
    assert!(matches!(&more, Next::Points(points) if !points.is_empty()), "{more:?}");
    assert_eq!(next_round(&bent, 4, Some(&refinement), true), Next::End(WayOut::CutShort));
    let enough = Refinement { max_points: 4, ..refinement };
    assert_eq!(next_round(&bent, 4, Some(&enough), true), Next::End(WayOut::Whole));
}

/// Ctrl-C while the pages are written.
#[test]
fn a_run_that_is_interrupted_after_its_last_point_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let text = template::text("smoke").unwrap();
    let quick = text.replace("max_fed_cells: 12", "max_fed_cells: 6").replace("Cells(4)", "Cells(2)");
    let mut case = config::parse(&quick, "smoke.ron").unwrap();
    case.points = vec![300.0];
    let options = RunOptions {
        folder: folder.path().join("out"),
        threads: 1,
        quiet: true,
        json: false,
        earlier: Earlier::Refuse,
        keep_every: Duration::from_secs(1_000_000),
        go_on: String::new(),
    };
    let (interrupt, ended) = (AtomicBool::new(false), AtomicBool::new(false));
    // The table is written when the point is at its end.
    let table = options.folder.join("hugoniot.csv");
    let end = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !table.exists() && !ended.load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(1));
            }
            interrupt.store(true, Ordering::Relaxed);
        });
        let end = run(&case, &quick, &options, &interrupt);
        ended.store(true, Ordering::Relaxed);
        end.unwrap()
    });
    assert!(table.exists() && interrupt.load(Ordering::Relaxed));
    assert_eq!(end, RunEnd::Done);
}
