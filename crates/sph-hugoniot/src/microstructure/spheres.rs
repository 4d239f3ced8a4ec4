//! Spherical pores in space: periodic samples on cubic lattices or at random, for windows in three dimensions.
//!
//! A box L × H × W holds N points of a cubic lattice of spacing D, each of the volume D³. As in the plane N (1 - 1/m) of them
//! are removed, those nearest to the pores, so that all surfaces move alike and the porosity m = ρ0/ρ00 is met to a
//! particle at every D. Random pores are placed one after another, the largest first, where they keep their gap from all that
//! stand and from their periodic images (random sequential addition), with the generator of [`super::placement`]: a seed gives
//! the same pores on every machine.
//!
//! Case files know the plane only; `cargo run --release -p sph-hugoniot --example spheres` shows the use from Rust.

use std::path::Path;

use glam::DVec3;
use sph_core::{Dim3, Domain, Particle, Particles};
use sph_io::IoError;
use sph_io::field_image::{Field, FieldImage};
use sph_io::snapshot::Snapshot;
use sph_window::{FeedSample, WindowError};

use super::cut;
use super::placement::{Amount, ROUNDS, Random, Refusal, Round, Sizes, TRIES, radii};

/// Largest porosity.
const LIMIT: f64 = 20.0;
/// Most particles of a cell.
const MAX_PARTICLES: f64 = 5e6;
/// Slices of a picture.
const SLICES: usize = 4;
/// Microns in a meter.
const MICRO: f64 = 1e6;

/// Why there is no sample.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SphereError {
    /// A number is out of its bounds.
    #[error("{field} = {value} {unit}: {reason}")]
    Setting {
        /// Which.
        field: &'static str,
        /// Its value, in `unit`.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// What it must be.
        reason: &'static str,
    },
    /// Spheres on a lattice touch or overlap.
    #[error(
        "spheres of radius {radius} m overlap: at most {most} m, half their distance; hint: a lower porosity"
    )]
    Overlap {
        /// Radius that the porosity asks for [m].
        radius: f64,
        /// Largest that fits [m].
        most: f64,
    },
    /// Random spheres found no place.
    #[error("spheres at random: {0}")]
    Placement(#[from] Refusal),
}

/// A spherical pore.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Center [m].
    pub center: DVec3,
    /// Radius [m].
    pub radius: f64,
}

/// Spheres at random.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomSpheres {
    /// How sizes are spread.
    pub sizes: Sizes,
    /// Least width of the gaps [m].
    pub gap: f64,
    /// Seed of the generator.
    pub seed: u64,
}

/// Where the spheres are.
#[derive(Clone, Debug, PartialEq)]
pub enum Arrangement {
    /// One in the middle of each cube.
    SimpleCubic,
    /// Two a cube: one more in the middle of eight.
    BodyCentered,
    /// At random, as many as the porosity takes; all are scaled alike to meet it.
    Random(RandomSpheres),
}

/// A solid with spherical pores.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereMedium {
    /// Periodic cell: length L along x, the way of the wave, height and width [m].
    pub cell: DVec3,
    /// Where the spheres are.
    pub arrangement: Arrangement,
    /// Porosity m = ρ0/ρ00 to reach [-].
    pub porosity: f64,
    /// Particle size D [m]; must divide the edges.
    pub particle_size: f64,
}

impl SphereMedium {
    /// The spheres of one cell: on lattices of the radius that the porosity asks for.
    ///
    /// # Errors
    /// [`SphereError`] for a number out of its bounds, spheres that overlap, or find no place.
    pub fn spheres(&self) -> Result<Vec<Sphere>, SphereError> {
        self.validate()?;
        let share = 1.0 - 1.0 / self.porosity;
        match &self.arrangement {
            Arrangement::SimpleCubic => self.on_lattice(&[0.5], share),
            Arrangement::BodyCentered => self.on_lattice(&[0.25, 0.75], share),
            Arrangement::Random(random) => Ok(place(random, share, self.cell)?),
        }
    }

    /// One period of the medium, of a solid of a density [kg/m³].
    ///
    /// # Errors
    /// As [`SphereMedium::spheres`].
    pub fn build(&self, density: f64) -> Result<SphereSample, SphereError> {
        let spheres = self.spheres()?;
        let points = self.lattice();
        let to_spheres =
            |p: &DVec3| spheres.iter().map(|s| s.distance(*p, self.cell)).fold(f64::INFINITY, f64::min);
        let distance: Vec<f64> = points.iter().map(to_spheres).collect();
        let wanted = points.len() as f64 * (1.0 - 1.0 / self.porosity);
        let removed = cut::voids(&distance, wanted, self.particle_size);
        let volume = self.particle_size.powi(3);
        let mut solid: Vec<DVec3> =
            points.iter().zip(&removed).filter(|(_, gone)| !**gone).map(|(p, _)| *p).collect();
        solid.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
        let particle = |(id, p): (usize, &DVec3)| {
            Particle::at_rest(id as u64, *p, density * volume, self.particle_size, density)
        };
        Ok(SphereSample {
            cell: self.cell,
            density,
            porosity: points.len() as f64 / solid.len() as f64,
            particles: solid.iter().enumerate().map(particle).collect(),
            spheres,
        })
    }

    fn validate(&self) -> Result<(), SphereError> {
        let setting = |field, value, unit, reason| Err(SphereError::Setting { field, value, unit, reason });
        if !(self.porosity > 1.0 && self.porosity <= LIMIT) {
            return setting("porosity", self.porosity, "", "must lie above 1 and not above 20");
        }
        if !(self.particle_size > 0.0 && self.particle_size.is_finite()) {
            return setting("particle_size", self.particle_size, "m", "must be positive");
        }
        let counts = self.cell / self.particle_size;
        for (field, n) in [("cell.x", counts.x), ("cell.y", counts.y), ("cell.z", counts.z)] {
            // Not a number is refused too.
            if !((n - n.round()).abs() <= 1e-6 * n && n >= 3.5) {
                let reason = "must hold a whole number of particles, four or more";
                return setting(field, n * self.particle_size, "m", reason);
            }
        }
        if counts.element_product() > MAX_PARTICLES {
            let reason = "must leave no more than 5e6 particles a cell";
            return setting("particle_size", self.particle_size, "m", reason);
        }
        match &self.arrangement {
            Arrangement::Random(random) if random.gap < self.particle_size || random.gap.is_nan() => {
                setting("gap", random.gap, "m", "must be no narrower than a particle")
            }
            _ => Ok(()),
        }
    }

    /// Spheres at these parts of the cell's diagonal.
    fn on_lattice(&self, places: &[f64], share: f64) -> Result<Vec<Sphere>, SphereError> {
        let one = share * self.cell.element_product() / places.len() as f64;
        let radius = libm::cbrt(one / Round::Ball.measure(1.0));
        let between = if places.len() == 2 { 0.5 * self.cell.length() } else { f64::INFINITY };
        let most = 0.5 * between.min(self.cell.min_element());
        if radius >= most {
            return Err(SphereError::Overlap { radius, most });
        }
        Ok(places.iter().map(|f| Sphere { center: *f * self.cell, radius }).collect())
    }

    /// Points of the full cell, half a spacing off its sides.
    fn lattice(&self) -> Vec<DVec3> {
        let counts = (self.cell / self.particle_size).round();
        let spacing = self.cell / counts;
        let mut points = Vec::with_capacity(counts.element_product() as usize);
        for layer in 0..counts.z as usize {
            for row in 0..counts.y as usize {
                for k in 0..counts.x as usize {
                    points.push((DVec3::new(k as f64, row as f64, layer as f64) + 0.5) * spacing);
                }
            }
        }
        points
    }
}

impl Sphere {
    /// Distance of a point to the surface of the sphere or of its nearest image [m]; negative inside.
    pub fn distance(&self, point: DVec3, cell: DVec3) -> f64 {
        let offset = point - self.center;
        let nearest = offset - cell * (offset / cell).round();
        nearest.length() - self.radius
    }

    /// Width of the gap to another sphere and its images [m]; negative where they overlap.
    pub fn gap(&self, other: &Self, cell: DVec3) -> f64 {
        other.distance(self.center, cell) - self.radius
    }
}

/// Random sequential addition, the largest first.
fn place(random: &RandomSpheres, share: f64, cell: DVec3) -> Result<Vec<Sphere>, Refusal> {
    let mut numbers = Random::new(random.seed);
    let volume = cell.element_product();
    let mut radii = radii(&random.sizes, Amount::Share(share), Round::Ball, volume, &mut numbers)?;
    radii.sort_by(|a, b| b.total_cmp(a));
    let longest = radii.first().map_or(0.0, |r| 2.0 * r + random.gap);
    if longest > cell.min_element() {
        return Err(Refusal::TooLong(longest));
    }
    let mut best: Vec<Sphere> = Vec::new();
    for _ in 0..ROUNDS {
        let placed = place_all(&radii, random.gap, cell, &mut numbers);
        if placed.len() == radii.len() {
            return Ok(placed);
        }
        if placed.len() > best.len() {
            best = placed;
        }
    }
    let share = best.iter().map(|s| Round::Ball.measure(s.radius)).sum::<f64>() / volume;
    Err(Refusal::Full { placed: best.len(), wanted: radii.len(), share })
}

/// One round; ends with the first sphere that does not fit.
fn place_all(radii: &[f64], gap: f64, cell: DVec3, numbers: &mut Random) -> Vec<Sphere> {
    let mut placed: Vec<Sphere> = Vec::with_capacity(radii.len());
    for &radius in radii {
        let fitting = (0..TRIES).find_map(|_| {
            let center = DVec3::new(numbers.uniform(), numbers.uniform(), numbers.uniform()) * cell;
            let sphere = Sphere { center, radius };
            placed.iter().all(|other| sphere.gap(other, cell) >= gap).then_some(sphere)
        });
        match fitting {
            Some(sphere) => placed.push(sphere),
            None => break,
        }
    }
    placed
}

/// One period of a solid with spherical pores.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereSample {
    /// Particles sorted by x, then y, then z; at rest, unstressed.
    pub particles: Vec<Particle<Dim3>>,
    /// Periodic cell [m].
    pub cell: DVec3,
    /// Density ρ0 of the solid [kg/m³].
    pub density: f64,
    /// Porosity that whole particles reach, m = ρ0/ρ00 [-].
    pub porosity: f64,
    /// The pores.
    pub spheres: Vec<Sphere>,
}

impl SphereSample {
    /// Density ρ00 of the medium [kg/m³].
    pub fn bulk_density(&self) -> f64 {
        self.density / self.porosity
    }

    /// Narrowest gap between two pores, or between a pore and its own image [m].
    pub fn smallest_gap(&self) -> f64 {
        let own = self.spheres.iter().map(|s| self.cell.min_element() - 2.0 * s.radius);
        let pairs = self
            .spheres
            .iter()
            .enumerate()
            .flat_map(|(k, a)| self.spheres[..k].iter().map(move |b| a.gap(b, self.cell)));
        own.chain(pairs).fold(f64::INFINITY, f64::min)
    }

    /// The sample as a window repeats it.
    ///
    /// # Errors
    /// [`WindowError::Sample`] if the sample is empty.
    pub fn feed(&self) -> Result<FeedSample<Dim3>, WindowError> {
        let mut particles = Particles::default();
        self.particles.iter().for_each(|&p| particles.push(p));
        FeedSample::new(particles, Domain::new(DVec3::ZERO, self.cell, [true; 3]))
    }

    /// Writes the particles of one cell for ParaView, as `.vtp`.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_vtp(&self, path: &Path) -> Result<(), IoError> {
        let points: Vec<[f64; 3]> = self.particles.iter().map(|p| p.position.to_array()).collect();
        let number = |value: fn(&Particle<Dim3>) -> f64| self.particles.iter().map(value).collect::<Vec<_>>();
        let (size, density) = (number(|p| p.size), number(|p| p.density));
        Snapshot::new(0.0, &points)
            .with_scalar("size [m]", &size)
            .with_scalar("density [kg/m3]", &density)
            .write_vtp(path)
    }

    /// Draws layers of particles at four depths z, side by side, into a PNG file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_slices(&self, title: &str, path: &Path) -> Result<(), IoError> {
        let size = self.particles.first().map_or(1.0, |p| p.size);
        let layers = (self.cell.z / size).round();
        let (mut x, mut y, mut edge, mut depth) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let step = self.cell.x + 2.0 * size;
        for slice in 0..SLICES {
            let layer = (layers * slice as f64 / SLICES as f64).floor();
            for p in self.particles.iter().filter(|p| (p.position.z / size).floor() == layer) {
                x.push((p.position.x + slice as f64 * step) * MICRO);
                y.push(p.position.y * MICRO);
                edge.push(size * MICRO);
                depth.push(slice as f64);
            }
        }
        let at = |slice: usize| {
            let layer = (layers * slice as f64 / SLICES as f64).floor() + 0.5;
            format!("z = {:.1} µm", layer * size * MICRO)
        };
        let label = format!("layers of one cell, m = {:.4}, {} pores", self.porosity, self.spheres.len());
        let length = (SLICES as f64 * step - 2.0 * size) * MICRO;
        let field = Field::categories(label, depth, (0..SLICES).map(at).collect());
        FieldImage::new(title, (0.0, length), (0.0, self.cell.y * MICRO))
            .with_particles(x, y, edge)
            .with_field(field)
            .write_png(path)
    }
}
