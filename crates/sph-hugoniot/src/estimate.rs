//! What a run will need: particles, memory, time. Rough, and said to be so.
//!
//! The front's speed is guessed as the larger of two lines: shut pores follow the snow-plow slope a = m/(m - 1),
//! u_s = a u_p; pores that stay open follow sqrt(Y/ρ00) + a u_p/2. The second is empirical: it is the published fit of
//! porous copper within 3 %. A solid without pores is taken at its elastic wave. Enough for an estimate.

use serde::Serialize;
use sph_materials::Strength;
use sph_window::Search;

use crate::config::Case;
use crate::microstructure::Sample;
use crate::series;

/// Memory of a particle with its neighbor lists [bytes]: the design bound of the solver.
const BYTES_PER_PARTICLE: f64 = 800.0;
/// Files of a run with no points: report, sample, curve [bytes]. These four are meant as upper bounds; the shipped cases
/// came to between 0.48 and 0.86 of what is foreseen once they had ended.
const DISK_OF_RUN: f64 = 1.3e6;
/// Files of a point whatever its size: plots and tables [bytes].
const DISK_OF_POINT: f64 = 0.8e6;
/// Files of a point that grow with its particles: pictures, outcome [bytes a particle].
const DISK_OF_PARTICLE: f64 = 320.0;
/// The last two states of a point under way [bytes a particle].
const DISK_OF_STATES: f64 = 260.0;
/// Particle-steps per second of one core [1/s]: measured with the default scheme, rounded down.
const PARTICLE_STEPS_PER_SECOND: f64 = 2.0e6;

/// What one point will need.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct PointEstimate {
    /// Particle velocity u_p [m/s].
    pub particle_velocity: f64,
    /// Guess of the shock velocity u_s [m/s].
    pub shock_velocity: f64,
    /// Window [cells].
    pub window_cells: usize,
    /// Particles in the window.
    pub particles: usize,
    /// Fewest cells fed.
    pub fed_cells: usize,
    /// Steps to feed them [-].
    pub steps: f64,
    /// Time on one core [s].
    pub seconds: f64,
    /// Memory [bytes].
    pub bytes: f64,
    /// Moments for ParaView on disk [bytes]; zero where none are asked for.
    pub snapshot_bytes: f64,
}

/// Guess of the shock velocity [m/s] of the medium at u_p [m/s].
pub fn shock_velocity(case: &Case, porosity: f64, particle_velocity: f64) -> f64 {
    let material = &case.material;
    let solid = material.longitudinal_sound_speed(material.reference_density, 0.0);
    if porosity <= 1.0 + 1e-9 {
        return solid;
    }
    let slope = porosity / (porosity - 1.0);
    let yield_strength = match material.strength {
        Strength::PerfectPlastic { yield_strength, .. } => yield_strength,
        Strength::Fluid | Strength::Elastic { .. } => 0.0,
    };
    let open =
        (yield_strength * porosity / material.reference_density).sqrt() + 0.5 * slope * particle_velocity;
    open.max(slope * particle_velocity).min(solid + 1.5 * particle_velocity)
}

/// What one point will need.
pub(crate) fn point(case: &Case, sample: &Sample, particle_velocity: f64) -> PointEstimate {
    let u_s = shock_velocity(case, sample.porosity, particle_velocity);
    let window_cells = case.window.cells_at(particle_velocity);
    // Behind the front the particles stand closer, by up to m; half of the window on average.
    let packed = 0.5 * (1.0 + sample.porosity);
    let particles = (window_cells as f64 * sample.particles.len() as f64 * packed).round();
    let speeds = case.materials().into_iter().map(|m| m.longitudinal_sound_speed(m.reference_density, 0.0));
    let sound_speed = speeds.fold(0.0, f64::max);
    let step = case.scheme.courant * case.medium.particle_size / (sound_speed + particle_velocity);
    let (seconds, fed) = times(case, window_cells, u_s, particle_velocity);
    let (in_trials, fed_between) = search(case, window_cells, u_s);
    let (seconds, fed) = (seconds + in_trials, fed + fed_between);
    let steps = (seconds / step).ceil();
    PointEstimate {
        particle_velocity,
        shock_velocity: u_s,
        window_cells,
        particles: particles as usize,
        fed_cells: fed.ceil() as usize,
        steps,
        seconds: particles * steps / PARTICLE_STEPS_PER_SECOND,
        bytes: particles * BYTES_PER_PARTICLE,
        snapshot_bytes: snapshot_bytes(case, particles, window_cells),
    }
}

/// Bytes of the moments for ParaView: over the cells that the front sweeps at the most, within the limit.
fn snapshot_bytes(case: &Case, particles: f64, window_cells: usize) -> f64 {
    let Some(snapshots) = &case.output.snapshots else { return 0.0 };
    let swept = case.stop.max_fed_cells as f64 + case.window.front_place * window_cells as f64;
    (swept / snapshots.every_cells * particles * series::BYTES_PER_PARTICLE).min(snapshots.limit_bytes)
}

/// Simulated time [s] and cells fed until a point can settle.
///
/// The front runs to its place while the outlet rests and the medium enters with u_p; then the medium enters with u_s,
/// first until the start-up material has left with u_s - u_p, then for the blocks that must agree.
fn times(case: &Case, window_cells: usize, shock_velocity: f64, particle_velocity: f64) -> (f64, f64) {
    let (cell, stop) = (case.medium.cell, &case.stop);
    let place = case.window.front_place * window_cells as f64 * cell;
    let approach = place / (shock_velocity - particle_velocity).max(0.1 * shock_velocity);
    let fed_on_the_way = approach * particle_velocity / cell;
    let wanted =
        stop.startup_cells.map(|cells| (cells as f64 - fed_on_the_way).max(0.0) * cell / shock_velocity);
    let steady = wanted.unwrap_or(approach) + (stop.blocks * stop.block_cells) as f64 * cell / shock_velocity;
    (approach + steady, fed_on_the_way + steady * shock_velocity / cell)
}

/// Simulated time that the trials of a bisection and the way between its rounds take [s], and cells fed on that way; what
/// trials feed is taken back.
fn search(case: &Case, window_cells: usize, shock_velocity: f64) -> (f64, f64) {
    let Search::Bisection(bisection) = case.search else { return (0.0, 0.0) };
    let width =
        bisection.bracket.map_or(2.0 * bisection.half_width * shock_velocity, |(low, high)| high - low);
    let trials = (width / bisection.tolerance).log2().ceil().max(1.0);
    let rounds = f64::from(bisection.rounds);
    let between = (rounds - 1.0) * bisection.settle * window_cells as f64;
    let cells = rounds * trials * bisection.samples + between;
    (cells * case.medium.cell / shock_velocity, between)
}

/// What all points need on `threads` cores: (time [s], memory [bytes]).
pub(crate) fn total(points: &[PointEstimate], threads: usize) -> (f64, f64) {
    let work: f64 = points.iter().map(|p| p.seconds).sum();
    let longest = points.iter().map(|p| p.seconds).fold(0.0, f64::max);
    let mut bytes: Vec<f64> = points.iter().map(|p| p.bytes).collect();
    bytes.sort_by(|a, b| b.total_cmp(a));
    let side_by_side = threads.min(points.len());
    (
        (work / threads as f64).max(longest / (threads as f64 / side_by_side as f64)),
        bytes.iter().take(side_by_side).sum(),
    )
}

/// What all points will have on disk while `threads` cores run them [bytes].
pub(crate) fn disk(points: &[PointEstimate], threads: usize) -> f64 {
    let kept = |p: &PointEstimate| DISK_OF_POINT + DISK_OF_PARTICLE * p.particles as f64 + p.snapshot_bytes;
    let states = total(points, threads).1 / BYTES_PER_PARTICLE * DISK_OF_STATES;
    DISK_OF_RUN + points.iter().map(kept).sum::<f64>() + states
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config;

    fn case() -> Case {
        config::parse(include_str!("../templates/porous-copper.ron"), "porous-copper.ron").unwrap()
    }

    #[test]
    fn the_guess_is_within_a_tenth_of_what_was_published() {
        for (u_p, published) in [(50.0, 321.1), (100.0, 415.4), (150.0, 541.6), (250.0, 883.0)] {
            let guess = shock_velocity(&case(), 1.35, u_p);
            assert!((guess / published - 1.0).abs() < 0.1, "u_p = {u_p}: {guess} against {published}");
        }
        assert!(shock_velocity(&case(), 1.0, 100.0) > 4000.0);
    }

    #[test]
    fn a_bisection_feeds_its_trials_beside() {
        let tracked = case();
        let sample = crate::microstructure::sample(&tracked);
        let text =
            include_str!("../templates/porous-copper.ron").replace("search: Tracking", "search: Bisection()");
        let searched = config::parse(&text, "porous-copper.ron").unwrap();
        let [without, with] = [&tracked, &searched].map(|case| point(case, &sample, 250.0));
        // 2 · 0.2 · 963 m/s are halved nine times to 1 m/s, in two rounds, over three cells each; half a window between.
        let cells = 54.0 + 0.5 * without.window_cells as f64;
        let step = tracked.scheme.courant * 1e-6 / (4659.0 + 250.0);
        let more = (with.steps - without.steps) * step * without.shock_velocity / 20e-6;
        assert!((more / cells - 1.0).abs() < 0.02, "{more} {cells}");
        assert_eq!(with.fed_cells, without.fed_cells + without.window_cells / 2);
    }

    #[test]
    fn more_cores_never_take_longer() {
        let case = case();
        let sample = crate::microstructure::sample(&case);
        let points: Vec<_> = case.points.iter().map(|&u| point(&case, &sample, u)).collect();
        let times: Vec<f64> = [1, 2, 4, 8, 16].iter().map(|&n| total(&points, n).0).collect();
        assert!(times.is_sorted_by(|a, b| a >= b), "{times:?}");
    }
}
