//! A step between two rebuilds of the neighbor lists allocates nothing.

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{advance, simulation};
use sph_core::{Dim2, Dim3};
use sph_riemann::{Scheme, Settings, SolidDimension};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: passes every call on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations_of_quiet_steps<D: SolidDimension>(cells: usize, scheme: Scheme) -> usize {
    let mut simulation = simulation::<D>(cells, 0.0, Settings::for_scheme(scheme));
    advance(&mut simulation, 30); // Scratch has grown to what it needs.
    let mut least = usize::MAX;
    let mut quiet = 0;
    for _ in 0..40 {
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        let report = simulation.step().expect("a sound step");
        if !report.rebuilt {
            quiet += 1;
            least = least.min(ALLOCATIONS.load(Ordering::Relaxed) - before);
        }
    }
    assert!(quiet > 10, "{quiet} steps without a rebuild");
    least
}

#[test]
fn a_step_allocates_nothing() {
    // One thread: rayon's queues between threads allocate for themselves.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("threads");
    pool.install(|| {
        for scheme in [Scheme::Csph, Scheme::TkcHancock] {
            assert_eq!(allocations_of_quiet_steps::<Dim2>(30, scheme), 0, "{scheme:?}, plane");
            assert_eq!(allocations_of_quiet_steps::<Dim3>(10, scheme), 0, "{scheme:?}, space");
        }
    });
}
