//! A run that is stopped and goes on gives the bits of one that is not, wherever it is stopped.

mod common;

use common::{advance, bits, simulation};
use sph_core::{Dim2, Dim3};
use sph_riemann::{Settings, Simulation, SolidDimension};

fn saved_and_restored<D: SolidDimension>(run: &Simulation<D>) -> Simulation<D> {
    Simulation::restore(
        *run.domain(),
        run.materials().to_vec(),
        run.particles().clone(),
        *run.settings(),
        run.clock(),
        run.list_positions(),
    )
    .expect("what was saved is sound")
}

fn stopping_does_not_show<D: SolidDimension>(cells: usize, stops: &[usize], total: usize) {
    let mut straight = simulation::<D>(cells, 0.1, Settings::default());
    advance(&mut straight, total);
    assert!(straight.stage_times().rebuilds > 2, "lists are rebuilt on the way");
    for &stop in stops {
        let mut run = simulation::<D>(cells, 0.1, Settings::default());
        advance(&mut run, stop);
        let mut resumed = saved_and_restored(&run);
        advance(&mut resumed, total - stop);
        assert_eq!(resumed.clock(), straight.clock(), "stopped after {stop} steps");
        assert!(bits(resumed.particles()) == bits(straight.particles()), "stopped after {stop} steps");
    }
}

#[test]
fn a_restart_gives_the_same_bits_at_any_step() {
    let stops: Vec<usize> = (0..30).step_by(3).collect();
    stopping_does_not_show::<Dim2>(30, &stops, 40);
    stopping_does_not_show::<Dim3>(10, &[0, 1, 7, 12], 25);
}
