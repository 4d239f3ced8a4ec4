//! Momentum and total energy of closed systems are conserved to round-off by every scheme, in both dimensions.

mod common;

use common::{advance, simulation};
use sph_core::{Dim2, Dim3, Vector};
use sph_riemann::{FaceClosure, Scheme, Settings, SolidDimension, SurfaceTreatment};

fn closed_block_keeps_momentum_and_energy<D: SolidDimension>(cells: usize, steps: usize, settings: Settings) {
    let mut simulation = simulation::<D>(cells, 0.1, settings);
    let before = simulation.totals();
    advance(&mut simulation, steps);
    let after = simulation.totals();
    let name = format!("{:?} {:?} in {} dimensions", settings.scheme, settings.surface, D::COUNT);
    assert_eq!(before.mass, after.mass, "{name}");
    let momentum = (after.momentum - before.momentum).length() / before.momentum.length();
    assert!(momentum < 1e-13, "{name}: momentum moved by {momentum:e}");
    let energy = |t: sph_riemann::Totals<D>| t.kinetic_energy + t.internal_energy;
    let change = (energy(after) - energy(before)).abs() / energy(before);
    assert!(change < 1e-13, "{name}: energy moved by {change:e}");
    // It is not conserved because nothing happens.
    let exchanged = (after.kinetic_energy - before.kinetic_energy).abs() / before.kinetic_energy;
    assert!(exchanged > 0.01, "{name}: only {exchanged:e} of the kinetic energy was exchanged");
}

#[test]
fn every_scheme_conserves_momentum_and_energy() {
    for scheme in Scheme::ALL {
        closed_block_keeps_momentum_and_energy::<Dim2>(30, 150, Settings::for_scheme(scheme));
        closed_block_keeps_momentum_and_energy::<Dim3>(12, 60, Settings::for_scheme(scheme));
    }
}

#[test]
fn every_surface_treatment_conserves_momentum_and_energy() {
    for surface in [
        SurfaceTreatment::None,
        SurfaceTreatment::Printed { determinant_floor: 0.05 },
        SurfaceTreatment::Intended { determinant_floor: 0.05 },
        SurfaceTreatment::SpectralCap { cap: 1.5 },
    ] {
        let settings = Settings { surface, courant: 0.1, ..Settings::default() };
        closed_block_keeps_momentum_and_energy::<Dim2>(30, 150, settings);
    }
}

#[test]
fn closed_faces_conserve_momentum_and_energy() {
    let settings = Settings { face_closure: Some(FaceClosure::default()), ..Settings::default() };
    closed_block_keeps_momentum_and_energy::<Dim2>(30, 150, settings);
    closed_block_keeps_momentum_and_energy::<Dim3>(12, 60, settings);
}
