//! The same bits for any number of threads, any set of instructions, and (nearly) in any frame.

mod common;

use common::{advance, bits, simulation, with_every_set};
use sph_core::{Dim2, Dim3, Vector};
use sph_riemann::{FaceClosure, Scheme, Settings, SolidDimension};

fn bits_after<D: SolidDimension>(cells: usize, threads: usize, settings: Settings) -> Vec<(u64, Vec<u64>)> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut simulation = simulation::<D>(cells, 0.1, settings);
        advance(&mut simulation, 40);
        bits(simulation.particles())
    })
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let closed = Settings { face_closure: Some(FaceClosure::default()), ..Settings::default() };
    for settings in [Settings::default(), closed] {
        let plane = bits_after::<Dim2>(60, 1, settings);
        let space = bits_after::<Dim3>(14, 1, settings);
        for threads in [2, 5] {
            assert!(plane == bits_after::<Dim2>(60, threads, settings), "{threads} threads, plane");
            assert!(space == bits_after::<Dim3>(14, threads, settings), "{threads} threads, space");
        }
    }
}

fn sets_agree<D: SolidDimension>(cells: usize) {
    let closed = Settings { face_closure: Some(FaceClosure::default()), ..Settings::default() };
    for settings in Scheme::ALL.map(Settings::for_scheme).into_iter().chain([closed]) {
        let scheme = settings.scheme;
        let mut runs = with_every_set(|| simulation::<D>(cells, 0.1, settings));
        runs.iter_mut().for_each(|run| advance(run, 12));
        let reference = bits(runs[0].particles());
        for run in &runs[1..] {
            assert!(bits(run.particles()) == reference, "{scheme:?} in {} dimensions", D::COUNT);
        }
    }
}

#[test]
fn every_set_of_instructions_gives_the_same_bits() {
    sets_agree::<Dim2>(20);
    sets_agree::<Dim3>(8);
}

fn frame_does_not_matter<D: SolidDimension>(cells: usize, steps: usize) {
    // Volume sums are taken when lists are rebuilt, and when that is depends on which particles share a tile: without them.
    let settings = Settings { volume_consistency: None, ..Settings::default() };
    let boost = D::vector(|a| 700.0 - 300.0 * a as f64);
    let mut rest = simulation::<D>(cells, 0.1, settings);
    let mut moving = simulation::<D>(cells, 0.1, settings);
    moving.boost(boost);
    advance(&mut rest, steps);
    advance(&mut moving, steps);
    let (a, b) = (rest.particles(), moving.particles());
    let mut by_id: Vec<usize> = (0..b.len()).collect();
    by_id.sort_by_key(|&i| b.id[i]);
    let mut order: Vec<usize> = (0..a.len()).collect();
    order.sort_by_key(|&i| a.id[i]);
    for (&i, &j) in order.iter().zip(&by_id) {
        let difference = (b.velocity_of(j) - boost - a.velocity_of(i)).length();
        assert!(difference < 1e-6, "velocity of particle {} differs by {difference:e} m/s", a.id[i]);
        let energy = a.specific_internal_energy[i] - b.specific_internal_energy[j];
        assert!(energy.abs() < 1e-3, "energy of particle {} differs by {energy:e} J/kg", a.id[i]);
        assert!((a.density[i] / b.density[j] - 1.0).abs() < 1e-9);
    }
}

#[test]
fn the_frame_does_not_matter() {
    frame_does_not_matter::<Dim2>(30, 40);
    frame_does_not_matter::<Dim3>(10, 20);
}
