//! The pair loops in lanes against plain formulas for one particle at a time, in both dimensions.

mod common;

use common::simulation;
use sph_core::correction::{Neighbor, gradient_matrix, spectral_cap};
use sph_core::gradient::{rotation_exact, vector_sum};
use sph_core::lanes::{InstructionSet, LANES, Line};
use sph_core::matrix::SquareMatrix;
use sph_core::neighbors::TILE;
use sph_core::{Components, Dim2, Dim3, Vector};
use sph_riemann::contact::acoustic::{Side, solve};
use sph_riemann::dimension::symmetric;
use sph_riemann::matter::Matter;
use sph_riemann::pass::{Pass, Sizes, Smoothing, TilePairs, collect};
use sph_riemann::prepare::prepare;
use sph_riemann::record::{Prepared, Row, Sides, State, Sums};
use sph_riemann::{Limiter, Settings, Simulation, SolidDimension, SurfaceTreatment};

/// Low, so that it acts on many particles.
const CAP: f64 = 1.5;

/// Records and rows after both passes over a jittered block with a pore, and what is needed to do it again.
struct Passes<D: SolidDimension> {
    simulation: Simulation<D>,
    state: Vec<Line>,
    sides: Vec<Line>,
    rows: Vec<Line>,
    sums: Vec<Line>,
    size: Vec<f64>,
}

impl<D: SolidDimension> Passes<D> {
    fn run(cells: usize, surface: SurfaceTreatment) -> Self {
        let settings = Settings { surface, smoothing: 0.6, ..Settings::default() };
        let mut simulation = simulation::<D>(cells, 0.3, settings);
        // Two steps give stresses; the lists of the second still hold.
        simulation.step().expect("a sound step");
        simulation.step().expect("a sound step");
        let lists = simulation.lists();
        let (records, padded) = (lists.n_records(), lists.n_padded());
        let mut state = vec![Line::default(); records * D::STATE_LINES];
        let mut sides = vec![Line::default(); records * D::SIDES_LINES];
        let mut rows = vec![Line::default(); padded / LANES * Row::count::<D>()];
        let size = vec![common::SIZE; records];
        let matter = Matter::new(simulation.materials().to_vec());
        let instructions = InstructionSet::detect();
        let mut least = vec![(0.0, 0); lists.tiles().len()];
        let prepared = Prepared::State;
        prepare(simulation.particles(), &matter, instructions, prepared, &mut state, &mut rows, &mut least);
        lists.halo().refresh(&mut state, D::STATE_LINES, padded);
        let smoothing = Smoothing::new(settings.kernel, settings.smoothing, D::COUNT, Sizes::Each(&size));
        let pass = Pass { lists, smoothing, surface, records: &state, half_step: 0.0, instructions };
        pass.gradients(None, &mut sides, &mut rows);
        lists.halo().refresh(&mut sides, D::SIDES_LINES, padded);
        let mut sums = vec![Line::default(); padded * D::SUM_LINES];
        let mut pairs = vec![TilePairs::default(); lists.tiles().len()];
        let pass = Pass { records: &sides, ..pass };
        pass.contacts(Some(Limiter::VanLeer), &mut sums, &mut pairs);
        let tiles = sums.chunks_mut(TILE * D::SUM_LINES).enumerate();
        tiles.for_each(|(t, own)| collect(lists, &pairs, instructions, t, own));
        Self { simulation, state, sides, rows, sums, size }
    }

    fn number(lines: &[Line], stride: usize, record: usize, k: usize) -> f64 {
        lines[record * stride + k / LANES].0[k % LANES]
    }

    fn state(&self, record: usize, k: usize) -> f64 {
        Self::number(&self.state, D::STATE_LINES, record, k)
    }

    fn side(&self, record: usize, k: usize) -> f64 {
        Self::number(&self.sides, D::SIDES_LINES, record, k)
    }

    fn row(&self, i: usize, r: usize) -> f64 {
        self.rows[i / LANES * Row::count::<D>() + r].0[i % LANES]
    }

    /// A sum of particle `i` per volume.
    fn sum(&self, i: usize, k: usize) -> f64 {
        Self::number(&self.sums, D::SUM_LINES, i, k) / self.side(i, Sides::volume::<D>())
    }

    fn offset(&self, i: usize, j: usize) -> D::Vector {
        D::vector(|a| self.state(j, a) - self.state(i, a))
    }

    fn smoothing_length(&self, i: usize, j: usize) -> f64 {
        self.simulation.settings().smoothing * (self.size[i] + self.size[j])
    }

    fn neighbors(&self, i: usize) -> Vec<(usize, Neighbor<D>)> {
        let of = |j: u32| {
            let j = j as usize;
            let volume = self.state(j, State::volume::<D>());
            let kernel = self.simulation.settings().kernel;
            (j, Neighbor::new(kernel, self.offset(i, j), self.smoothing_length(i, j), volume))
        };
        self.simulation.lists().neighbors(i).map(of).collect()
    }

    fn symmetric_matrix(&self, component: impl Fn(usize) -> f64) -> SquareMatrix<D> {
        SquareMatrix::from_fn(|a, b| component(symmetric(D::COUNT, a, b)))
    }

    fn velocity(&self, record: usize) -> D::Vector {
        D::vector(|a| self.state(record, State::fields::<D>() + a))
    }
}

fn close(a: f64, b: f64, scale: f64, what: &str) {
    assert!((a - b).abs() <= 1e-11 * scale, "{what}: {a:e} in lanes, {b:e} in plain code, scale {scale:e}");
}

fn gradients_agree<D: SolidDimension>(cells: usize) {
    let passes = Passes::<D>::run(cells, SurfaceTreatment::SpectralCap { cap: CAP });
    let mut capped = 0;
    for i in 0..passes.simulation.particles().len() {
        let neighbors = passes.neighbors(i);
        let l = gradient_matrix(neighbors.iter().map(|(_, n)| *n));
        let k = spectral_cap(l, CAP);
        let lanes_l = passes.symmetric_matrix(|c| passes.row(i, Row::gradient_matrix::<D>() + c));
        let lanes_k = passes.symmetric_matrix(|c| passes.side(i, Sides::correction::<D>() + c));
        close((lanes_l - l).largest(), 0.0, 1.0, "L");
        close((lanes_k - k).largest(), 0.0, 10.0, "K");
        let difference = |j: usize| passes.velocity(j) - passes.velocity(i);
        let raw = vector_sum(neighbors.iter().map(|(j, n)| (*n, difference(*j))));
        let gradient = rotation_exact(raw, l, k);
        let slope = |a: usize, b: usize| passes.side(i, Sides::slopes::<D>() + b * D::COUNT + a);
        for (a, b) in (0..D::COUNT).flat_map(|a| (0..D::COUNT).map(move |b| (a, b))) {
            close(slope(a, b), gradient[(a, b)], 1e9, "velocity gradient [1/s]");
        }
        capped += ((k * l - SquareMatrix::identity()).largest() > 1e-6) as usize;
    }
    assert!(capped > 5, "only {capped} particles at the pore's surface are capped");
}

#[test]
fn gradients_are_those_of_the_plain_formulas() {
    gradients_agree::<Dim2>(24);
    gradients_agree::<Dim3>(10);
}

/// Two unit vectors across `e`, one in the plane.
fn across<D: SolidDimension>(e: D::Vector) -> Vec<D::Vector> {
    if D::COUNT == 2 {
        return vec![D::vector(|a| if a == 0 { -e[1] } else { e[0] })];
    }
    let least = (0..3).min_by(|&a, &b| e[a].abs().total_cmp(&e[b].abs())).unwrap_or(0);
    let s = D::vector(|a| if a == least { 1.0 } else { 0.0 });
    let s = s - e * s.dot(e);
    let s = s * (1.0 / s.length());
    let t = D::vector(|a| e[(a + 1) % 3] * s[(a + 2) % 3] - e[(a + 2) % 3] * s[(a + 1) % 3]);
    vec![s, t]
}

/// Force per volume and power per volume of particle `i`: the contact solved along R, S, T one after the other.
fn contact_sums<D: SolidDimension>(passes: &Passes<D>, i: usize) -> (D::Vector, f64) {
    let (mut force, mut power) = (D::Vector::default(), 0.0);
    for (j, neighbor) in passes.neighbors(i) {
        let dx = neighbor.offset;
        let e = dx * (1.0 / dx.length());
        let field = |record: usize, f: usize| passes.side(record, Sides::fields::<D>() + f);
        let along = |record: usize, f: usize| {
            (0..D::COUNT)
                .map(|a| passes.side(record, Sides::slopes::<D>() + f * D::COUNT + a) * dx[a])
                .sum::<f64>()
        };
        let jump = |f: usize| field(j, f) - field(i, f);
        let phi_l = |f: usize| field(i, f) + Limiter::VanLeer.half(jump(f), along(i, f));
        let phi_r = |f: usize| field(j, f) - Limiter::VanLeer.half(jump(f), along(j, f));
        let k_of = |r: usize| passes.symmetric_matrix(|c| passes.side(r, Sides::correction::<D>() + c));
        let mean_e = (k_of(i).apply(e) + k_of(j).apply(e)) * 0.5;
        let traction =
            |phi: &dyn Fn(usize) -> f64| passes.symmetric_matrix(|c| phi(D::COUNT + c)).apply(mean_e);
        let (t_l, t_r) = (traction(&phi_l), traction(&phi_r));
        let u_l = D::vector(&phi_l);
        let u_r = D::vector(&phi_r);
        let (mut t_star, mut u_star) = (D::Vector::default(), D::Vector::default());
        let directions = std::iter::once((e, Sides::longitudinal::<D>()))
            .chain(across::<D>(e).into_iter().map(|s| (s, Sides::transverse::<D>())));
        for (n, impedance) in directions {
            let side = |r: usize, u: D::Vector, t: D::Vector| Side {
                impedance: passes.side(r, impedance),
                velocity: u.dot(n),
                traction: t.dot(n),
            };
            let star = solve(side(i, u_l, t_l), side(j, u_r, t_r));
            t_star += n * star.traction;
            u_star += n * star.velocity;
        }
        let weight = 2.0 * neighbor.volume * neighbor.kernel_gradient.length();
        force += t_star * weight;
        power += weight * t_star.dot(u_star);
    }
    (force, power)
}

fn contacts_agree<D: SolidDimension>(cells: usize) {
    let passes = Passes::<D>::run(cells, SurfaceTreatment::None);
    let (mut largest_force, mut largest_power) = (0.0_f64, 0.0_f64);
    let n = passes.simulation.particles().len();
    let sums: Vec<(D::Vector, f64)> = (0..n).map(|i| contact_sums(&passes, i)).collect();
    for (force, power) in &sums {
        largest_force = largest_force.max(force.length());
        largest_power = largest_power.max(power.abs());
    }
    assert!(largest_force > 1e14, "the block is under load");
    for (i, (force, power)) in sums.iter().enumerate() {
        let lanes: D::Vector = D::vector(|a| passes.sum(i, Sums::FORCE + a));
        close((lanes - *force).length(), 0.0, largest_force, "force per volume [N/m3]");
        close(passes.sum(i, Sums::power::<D>()), *power, largest_power, "power per volume [W/m3]");
    }
}

#[test]
fn contacts_are_those_of_the_plain_formulas() {
    contacts_agree::<Dim2>(24);
    contacts_agree::<Dim3>(10);
}

#[test]
fn components_have_the_counts_of_their_dimensions() {
    assert_eq!(<[f64; 24] as Components<f64>>::COUNT, Sides::slopes::<Dim2>() + 5 * 2);
    assert!(Sides::slopes::<Dim3>() + 9 * 3 <= <[f64; 56] as Components<f64>>::COUNT);
}
