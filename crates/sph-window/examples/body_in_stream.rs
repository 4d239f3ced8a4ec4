//! A body in a stream, in the fixed window: copper runs at 8 km/s, twice its speed of sound, onto a plate.
//!
//! A bow shock stands ahead of the plate. In a steady stream the total enthalpy e + P/ρ + u²/2 is the same along a stream
//! line, through the shock too (Bernoulli): on the axis it is U²/2, since the medium that comes in has neither energy nor
//! stress. On the axis the shock is a normal one that stands still, so that its speed relative to the medium is that of the
//! stream, and u_s = c_a + s_a u_p gives the pressure behind it: 194 GPa. The strength of copper, 0.35 GPa, does not matter.
//!
//! When it is looked at the shock still moves against the stream, with some v = 480 m/s. Then the enthalpy behind it is
//! U²/2 + v (U - u): 1.04 of U²/2 with u = 5287 m/s, and 1.06 is found. The rest is within what the place of the shock is
//! known to, a particle, and what acoustic contacts, made for waves weak against 138 GPa, miss.
//!
//! `cargo run --release -p sph-window --example body_in_stream`

use sph_core::{Components, Dim2, Domain, Particle, Particles, dimension::Dimension};
use sph_riemann::{Scheme, Settings};
use sph_window::{FeedSample, Search, Window, WindowError, WindowSettings};

/// Particle size [m].
const SIZE: f64 = 1e-6;
/// Velocity of the stream [m/s].
const STREAM: f64 = 8000.0;
/// Half the height of the plate, and half the period across [D].
const HALF: (f64, f64) = (4.0, 64.0);
/// Where the plate begins and ends along x [D].
const PLATE: (f64, f64) = (24.0, 28.0);

fn sample(density: f64) -> Result<FeedSample<Dim2>, WindowError> {
    let (columns, rows) = (10, (2.0 * HALF.1) as usize);
    let mut particles = Particles::default();
    for index in 0..columns * rows {
        let place = [(index % columns) as f64 + 0.5, (index / columns) as f64 + 0.5];
        let position = Dim2::vector(|axis| SIZE * place[axis]);
        particles.push(Particle::at_rest(index as u64, position, density * SIZE * SIZE, SIZE, density));
    }
    let upper = Dim2::vector(|axis| SIZE * [columns, rows][axis] as f64);
    FeedSample::new(particles, Domain::new(Dim2::vector(|_| 0.0), upper, Components::from_fn(|_| true)))
}

/// What the particles on the axis hold between the plate, whose face is at a place [m], and a distance from it.
#[derive(Default)]
struct Axis {
    count: f64,
    enthalpy: f64,
    velocity: f64,
    pressure: f64,
}

impl Axis {
    fn add(&mut self, window: &Window<Dim2>, face: f64, distance: (f64, f64)) {
        let particles = window.simulation().particles();
        for i in 0..particles.len() {
            let (dx, dy) = (particles.position[0][i] - face, particles.position[1][i] - HALF.1 * SIZE);
            if (distance.0 * SIZE..distance.1 * SIZE).contains(&dx) && dy.abs() < 1.5 * SIZE {
                let (pressure, u) = (window.simulation().pressure(i), particles.velocity_of(i));
                let energy = particles.specific_internal_energy[i] + 0.5 * u.dot(u);
                self.count += 1.0;
                self.enthalpy += energy + pressure / particles.density[i];
                self.velocity += u.x;
                self.pressure += pressure;
            }
        }
    }

    fn mean(&self, sum: f64) -> f64 {
        sum / self.count
    }
}

/// Where the shock stands on the axis: the first matter that is slower than the mean of both sides [m].
fn shock(window: &Window<Dim2>) -> f64 {
    let particles = window.simulation().particles();
    let is_behind = |&i: &usize| {
        let dy = particles.position[1][i] - HALF.1 * SIZE;
        dy.abs() < 1.5 * SIZE && particles.velocity[0][i] > -0.5 * (STREAM + 5287.0)
    };
    (0..particles.len()).filter(is_behind).map(|i| particles.position[0][i]).fold(0.0, f64::max)
}

/// Runs the stream until it is steady and prints the pressure at the nose.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let copper = sph_materials::library::material("porous-copper")?;
    let settings = WindowSettings {
        inlet_velocity: Some(STREAM),
        search: Search::FixedFrame,
        // The outlet takes the matter away with the velocity of the stream, as good as.
        ..WindowSettings::new(70.0 * SIZE, 1.0)
    };
    let sample = sample(copper.reference_density)?;
    let mut window = Window::new(sample, vec![copper], Settings::for_scheme(Scheme::TkcHancock), settings)?;
    let (x, y) = ((PLATE.0 * SIZE, PLATE.1 * SIZE), ((HALF.1 - HALF.0) * SIZE, (HALF.1 + HALF.0) * SIZE));
    window.hold(|place| (x.0..x.1).contains(&place.x) && (y.0..y.1).contains(&place.y))?;

    // Places of the shock, one each nanosecond.
    let mut places: Vec<(f64, f64)> = Vec::new();
    // The layer behind the shock, and all of the stretch between plate and shock.
    let (mut layer, mut stretch) = (Axis::default(), Axis::default());
    while window.time() < 16e-9 {
        window.step()?;
        if window.time() > 10e-9 {
            layer.add(&window, x.1, (10.0, 14.0));
            stretch.add(&window, x.1, (2.0, 14.0));
            if places.last().is_none_or(|last| window.time() - last.0 >= 1e-9) {
                places.push((window.time(), shock(&window)));
            }
        }
    }
    let total = stretch.mean(stretch.enthalpy) / (0.5 * STREAM * STREAM);
    println!("a stream of {STREAM} m/s onto a plate, {} steps", window.steps());
    println!("e + P/ρ + u²/2 ahead of the plate: {total:.3} of U²/2, 1 behind a shock that stands");
    for (time, place) in &places {
        println!("{:.1} ns: the shock on the axis at {:.1} µm", 1e9 * time, 1e6 * place);
    }
    let (first, last) = (places[0], places[places.len() - 1]);
    let drift = (last.1 - first.1) / (last.0 - first.0);
    let moving = 1.0 + 2.0 * drift * (STREAM - 5287.0) / (STREAM * STREAM);
    println!("the shock moves with {drift:.0} m/s, for which {moving:.3} is expected");
    let (u, pressure) = (layer.mean(layer.velocity), layer.mean(layer.pressure));
    println!(
        "behind the bow shock: {u:.0} m/s, {:.0} GPa; at the shock itself -5287 m/s, 194 GPa",
        pressure / 1e9
    );
    println!("the ledger closes to {:.1e}", window.ledger_residual());
    if (total - moving).abs() > 0.03 {
        return Err("the total enthalpy is not that behind a shock that moves so".into());
    }
    Ok(())
}
