//! Convergence of the mesh solution, and its agreement with the exact one.

use super::*;
use crate::reference::riemann;

const COPPER_DENSITY: f64 = 8960.0;
const COPPER_SHEAR: f64 = 59.1159e9;

fn copper_pressure(density: f64, _: f64) -> f64 {
    4148.0f64.powi(2) * (density - COPPER_DENSITY)
}

fn sound_wave(zones: usize) -> Mesh<'static> {
    let solid = Solid {
        pressure: &copper_pressure,
        shear_modulus: COPPER_SHEAR,
        yield_strength: f64::INFINITY,
        sound_speed: 5105.0,
    };
    let scheme = Scheme {
        symmetry: Symmetry::Planar,
        ends: Ends::Periodic,
        cfl: 0.9,
        viscosity: Viscosity::default(),
    };
    let rest = Zone { density: COPPER_DENSITY, energy: 0.0, deviator: [0.0; 3] };
    let pulse = |x: f64| 5.0 * (-2.0 * (1e3 * x).powi(2)).exp();
    let mut mesh = Mesh::new(solid, scheme, [-5e-3, 5e-3], zones, |_| rest, pulse);
    mesh.run_until(3e-3 / 5099.30);
    mesh
}

fn difference(a: &Mesh<'_>, b: &Mesh<'_>) -> f64 {
    let places = (0..2000).map(|k| -5e-3 + 1e-2 * (f64::from(k) + 0.5) / 2000.0);
    places.map(|x| (a.velocity_at(x) - b.velocity_at(x)).abs()).sum::<f64>() / 2000.0
}

#[test]
fn sound_wave_converges_with_second_order() {
    let meshes = [400, 800, 1600, 6400].map(sound_wave);
    let errors: Vec<f64> = meshes[..3].iter().map(|mesh| difference(mesh, &meshes[3])).collect();
    println!("sound wave, L1 of u against 6400 zones [m/s]: {errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 1.8, "order {order} from {errors:?}");
    }
    assert!(errors[2] < 2e-5, "{errors:?}");
}

#[test]
fn linear_solution_is_close_but_not_the_reference() {
    let mesh = sound_wave(3200);
    let pulse = |x: f64| 2.5 * (-2.0 * (1e3 * x).powi(2)).exp();
    let train = |x: f64| pulse(x - 1e-2) + pulse(x) + pulse(x + 1e-2);
    let places = (0..2000).map(|k| -5e-3 + 1e-2 * (f64::from(k) + 0.5) / 2000.0);
    let error =
        places.map(|x| (mesh.velocity_at(x) - train(x - 3e-3) - train(x + 3e-3)).abs()).sum::<f64>() / 2000.0;
    println!("d'Alembert differs by {error:.3e} m/s");
    assert!((2e-4..2e-3).contains(&error), "{error}");
}

fn shell_pressure(density: f64, energy: f64) -> f64 {
    5328.0f64.powi(2) * (density - 2785.0) + density * energy
}

/// Inner radius at its least, time of it [s], and the inner radius by r² at the least of the mean square radius.
fn shell(zones: usize) -> [f64; 3] {
    let solid = Solid {
        pressure: &shell_pressure,
        shear_modulus: 27.6e9,
        yield_strength: 0.3e9,
        sound_speed: 6600.0,
    };
    let scheme = Scheme {
        symmetry: Symmetry::Cylindrical,
        ends: Ends::Free,
        cfl: 0.7,
        viscosity: Viscosity::default(),
    };
    let rest = Zone { density: 2785.0, energy: 0.0, deviator: [0.0; 3] };
    let mut mesh = Mesh::new(solid, scheme, [0.08, 0.1], zones, |_| rest, |r| -208.55 * 0.08 / r);
    let start = mesh.energy();
    let (mut inner, mut time, mut square) = (f64::INFINITY, 0.0, f64::INFINITY);
    while mesh.time() < 140e-6 {
        mesh.step(mesh.time_step());
        if mesh.radius()[0] < inner {
            (inner, time) = (mesh.radius()[0], mesh.time());
        }
        square = square.min(mesh.mean_square_radius());
    }
    let drift = mesh.energy() / start - 1.0;
    assert!(drift.abs() < 1e-4, "energy of {zones} zones drifts by {drift:e}");
    [inner, time, (square - 0.5 * (0.1f64.powi(2) - 0.08f64.powi(2))).sqrt()]
}

#[test]
fn shell_converges_to_the_known_stop() {
    let runs = [50, 100, 200, 400].map(shell);
    println!("shell: inner stop [m], time [s], by r² [m]: {runs:?}");
    let [inner, time, square] = runs[3];
    assert!((inner - 0.066536).abs() < 1.5e-6, "inner radius {inner}");
    assert!((time - 124.2e-6).abs() < 0.3e-6, "time {time}");
    assert!((square - 0.066514).abs() < 1.5e-6, "by mean square {square}");
    let change = |a: usize, b: usize| (runs[a][2] - runs[b][2]).abs();
    assert!(change(2, 3) < change(1, 2) && change(1, 2) < change(0, 1), "{runs:?}");
}

#[test]
fn mesh_reproduces_the_exact_riemann_solution() {
    let exact_solid =
        riemann::Solid { density: 2688.9, bulk_modulus: 73e9, shear_modulus: 23e9, yield_strength: 0.3e9 };
    let left = exact_solid.at_compressive_yield(-4e9);
    let right = exact_solid.at_rest();
    let exact = riemann::solve(exact_solid, left, right, riemann::Release::Fan).expect("the paper's problem");
    let pressure = |density: f64, _: f64| 73e9 * (density / 2688.9).ln();
    let solid =
        Solid { pressure: &pressure, shear_modulus: 23e9, yield_strength: 0.3e9, sound_speed: 6400.0 };
    let scheme = Scheme {
        symmetry: Symmetry::Planar,
        ends: Ends::Fixed,
        cfl: 0.5,
        viscosity: Viscosity { quadratic: 2.0, linear: 0.2 },
    };
    let state = |x: f64| {
        let (density, s) = if x < 0.0 { (left.density, left.deviator) } else { (right.density, 0.0) };
        Zone { density, energy: 0.0, deviator: [s, -0.5 * s, -0.5 * s] }
    };
    let errors = [400, 800, 1600].map(|zones| {
        let mut mesh = Mesh::new(solid, scheme, [-0.025, 0.025], zones, state, |_| 0.0);
        mesh.run_until(2e-6);
        let error = |k: usize| (mesh.radial_stress(k) - exact.sample(mesh.middle(k) / 2e-6).stress).abs();
        (0..zones).map(error).sum::<f64>() / zones as f64 / 1e9
    });
    println!("Riemann problem, L1 of stress [GPa]: {errors:?}");
    // Weak waves smear with the square root of the width, as under any linear viscosity.
    assert!(errors[0] < 0.03 && errors[1] < 0.75 * errors[0] && errors[2] < 0.7 * errors[1], "{errors:?}");
}
