//! Random sizes and places of circles or ellipses that do not overlap.
//!
//! Sizes are drawn first, from their distribution; then each is placed, the largest first, at a place and angle drawn
//! uniformly, again and again until it keeps its gap from all that stand (random sequential addition). When one does not
//! fit after `TRIES` places, all are taken up and placed anew, `ROUNDS` times.
//!
//! The generator is PCG (M. O'Neill, 2014), logarithms and sines are of `libm`: a seed gives the same pores on every
//! machine.

use glam::DVec2;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use serde::Serialize;

use super::shape::Shape;

/// Places that are tried for one shape.
pub(super) const TRIES: usize = 3000;
/// Times that all are placed anew.
pub(super) const ROUNDS: usize = 12;
/// Most shapes that are placed.
pub const MOST: usize = 5000;

/// How sizes are spread: radii, or for ellipses the radii of circles of the same area [m].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Sizes {
    /// All alike.
    Constant(f64),
    /// Normal, cut off three deviations from the mean and below a tenth of it.
    Normal {
        /// Mean [m].
        mean: f64,
        /// Standard deviation [m].
        deviation: f64,
    },
    /// Log-normal, cut off three deviations from the median.
    LogNormal {
        /// Median [m].
        median: f64,
        /// Standard deviation of the logarithm [-].
        deviation: f64,
    },
    /// These.
    Listed(Vec<f64>),
}

/// How many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// This number.
    Count(usize),
    /// As many as fill this part of the cell; all are then scaled alike, so that it is met exactly.
    Share(f64),
}

/// What is to be placed.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// How sizes are spread.
    pub sizes: Sizes,
    /// How many.
    pub amount: Amount,
    /// Ratio of the short to the long axis [-]; 1 for circles.
    pub aspect: f64,
    /// Angle of the long axis against x [rad]; `None`: any.
    pub angle: Option<f64>,
    /// Least width of the gaps [m].
    pub gap: f64,
    /// Seed of the generator.
    pub seed: u64,
}

/// Why shapes could not be placed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// More than [`MOST`] would be needed.
    #[error("{0} shapes would be needed; hint: at most {MOST}")]
    TooMany(f64),
    /// The part of the cell cannot be met: one shape alone takes this part [-].
    #[error(
        "one shape takes {0} of the cell, so that no whole number of them meets the share; hint: smaller ones, or a count"
    )]
    TooLarge(f64),
    /// A shape with its gap is longer than the cell: its length [m].
    #[error("the largest is {0} m long with its gap; hint: smaller ones, or a larger cell")]
    TooLong(f64),
    /// They do not fit.
    #[error(
        "only {placed} of {wanted} found a place, the cell is full at a share of {share}; hint: a narrower gap, a lower porosity"
    )]
    Full {
        /// Most that were placed.
        placed: usize,
        /// That were wanted.
        wanted: usize,
        /// Part of the cell that the placed ones take [-].
        share: f64,
    },
}

/// Places shapes in a cell [m], clear of what is there.
///
/// # Errors
/// [`Refusal`].
pub fn place(request: &Request, cell: DVec2, standing: &[Shape]) -> Result<Vec<Shape>, Refusal> {
    let mut random = Random::new(request.seed);
    let mut radii = radii(&request.sizes, request.amount, Round::Disc, cell.x * cell.y, &mut random)?;
    radii.sort_by(|a, b| b.total_cmp(a));
    let axes: Vec<DVec2> = radii.iter().map(|r| semi_axes(*r, request.aspect)).collect();
    let longest = axes.first().map_or(0.0, |a| 2.0 * a.x + request.gap);
    if longest > cell.min_element() {
        return Err(Refusal::TooLong(longest));
    }
    let mut best: Vec<Shape> = Vec::new();
    for _ in 0..ROUNDS {
        let placed = place_all(&axes, request, cell, standing, &mut random);
        if placed.len() == axes.len() {
            return Ok(placed);
        }
        if placed.len() > best.len() {
            best = placed;
        }
    }
    let share = best.iter().map(|s| s.area(cell.y)).sum::<f64>() / (cell.x * cell.y);
    Err(Refusal::Full { placed: best.len(), wanted: axes.len(), share })
}

/// Half axes of an ellipse with the area of a circle.
fn semi_axes(radius: f64, aspect: f64) -> DVec2 {
    DVec2::new(radius / aspect.sqrt(), radius * aspect.sqrt())
}

/// One round; ends with the first shape that does not fit.
fn place_all(
    axes: &[DVec2],
    request: &Request,
    cell: DVec2,
    standing: &[Shape],
    random: &mut Random,
) -> Vec<Shape> {
    let mut placed: Vec<Shape> = Vec::with_capacity(axes.len());
    for axes in axes {
        let fitting = (0..TRIES).find_map(|_| {
            let center = DVec2::new(random.uniform(), random.uniform()) * cell;
            let angle = request.angle.unwrap_or_else(|| std::f64::consts::PI * random.uniform());
            let shape = Shape::ellipse(center, *axes, angle);
            let clear = |other: &Shape| is_clear(&shape, other, request.gap, cell);
            (placed.iter().all(clear) && standing.iter().all(clear)).then_some(shape)
        });
        match fitting {
            Some(shape) => placed.push(shape),
            None => break,
        }
    }
    placed
}

/// True if two shapes keep their gap. Far ones are told by the circles around them, ellipses that overlap by the circles
/// within them.
fn is_clear(a: &Shape, b: &Shape, gap: f64, cell: DVec2) -> bool {
    if let Shape::Circle { .. } | Shape::Ellipse { .. } = b {
        let ((p, half_a), (q, half_b)) = (a.bounds(), b.bounds());
        let (outer_a, outer_b) = (half_a.length(), half_b.length());
        let offset = p - q;
        let nearest = offset - cell * (offset / cell).round();
        if nearest.length() > outer_a + outer_b + gap {
            return true;
        }
        let ellipses = matches!((a, b), (Shape::Ellipse { .. }, Shape::Ellipse { .. }));
        if ellipses && nearest.length() < 0.5 * (a.width() + b.width()) + gap {
            return false;
        }
    }
    a.keeps_gap(b, gap, cell)
}

/// How large something round is, in the plane or in space.
#[derive(Clone, Copy, Debug)]
pub(super) enum Round {
    /// A disc: area [m²].
    Disc,
    /// A ball: volume [m³].
    Ball,
}

impl Round {
    /// Area [m²] or volume [m³] with a radius [m].
    pub(super) fn measure(self, radius: f64) -> f64 {
        match self {
            Self::Disc => std::f64::consts::PI * radius * radius,
            Self::Ball => 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius,
        }
    }

    /// What lengths are to be multiplied by for a measure that is multiplied by `ratio`.
    fn scale(self, ratio: f64) -> f64 {
        match self {
            Self::Disc => ratio.sqrt(),
            Self::Ball => libm::cbrt(ratio),
        }
    }
}

/// Radii [m], in the order in which they are drawn, for a cell of an area [m²] or volume [m³].
pub(super) fn radii(
    sizes: &Sizes,
    amount: Amount,
    round: Round,
    cell: f64,
    random: &mut Random,
) -> Result<Vec<f64>, Refusal> {
    if let Sizes::Listed(radii) = sizes {
        return Ok(radii.clone());
    }
    let share = match amount {
        Amount::Count(count) => return Ok((0..count).map(|_| random.radius(sizes)).collect()),
        Amount::Share(share) => share,
    };
    let wanted = share * cell;
    let middle = round.measure(sizes.middle());
    if wanted / middle > MOST as f64 {
        return Err(Refusal::TooMany((wanted / middle).ceil()));
    }
    let (mut radii, mut sum) = (Vec::new(), 0.0);
    while radii.len() < 2 * MOST {
        let next = random.radius(sizes);
        // The one that comes nearest: with or without the last.
        if sum + round.measure(next) - wanted > wanted - sum {
            break;
        }
        radii.push(next);
        sum += round.measure(next);
    }
    let scale = round.scale(wanted / sum);
    if radii.is_empty() || !(0.8..=1.25).contains(&scale) {
        return Err(Refusal::TooLarge(middle / cell));
    }
    Ok(radii.iter().map(|r| r * scale).collect())
}

impl Sizes {
    /// The middle of the distribution [m].
    pub fn middle(&self) -> f64 {
        match self {
            Self::Constant(radius) => *radius,
            Self::Normal { mean, .. } => *mean,
            Self::LogNormal { median, .. } => *median,
            Self::Listed(radii) => radii.iter().sum::<f64>() / radii.len().max(1) as f64,
        }
    }
}

/// Random numbers that are the same everywhere.
pub(super) struct Random(Pcg64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// In [0, 1).
    pub(super) fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Normal with mean 0 and deviation 1, cut off at three (Box and Muller).
    fn normal(&mut self) -> f64 {
        loop {
            let (u, v) = (1.0 - self.uniform(), self.uniform());
            let x = (-2.0 * libm::log(u)).sqrt() * libm::cos(std::f64::consts::TAU * v);
            if x.abs() <= 3.0 {
                return x;
            }
        }
    }

    fn radius(&mut self, sizes: &Sizes) -> f64 {
        match sizes {
            Sizes::Constant(radius) => *radius,
            Sizes::Normal { mean, deviation } => loop {
                let radius = mean + deviation * self.normal();
                if radius >= 0.1 * mean {
                    break radius;
                }
            },
            Sizes::LogNormal { median, deviation } => median * libm::exp(deviation * self.normal()),
            Sizes::Listed(radii) => radii[(self.uniform() * radii.len() as f64) as usize],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: DVec2 = DVec2::new(60.0, 40.0);

    fn request(sizes: Sizes, amount: Amount) -> Request {
        Request { sizes, amount, aspect: 1.0, angle: None, gap: 1.0, seed: 7 }
    }

    fn share(shapes: &[Shape]) -> f64 {
        shapes.iter().map(|s| s.area(CELL.y)).sum::<f64>() / (CELL.x * CELL.y)
    }

    #[test]
    fn the_part_of_the_cell_is_met_exactly_and_gaps_are_kept() {
        for (sizes, aspect) in [
            (Sizes::Constant(2.0), 1.0),
            (Sizes::Normal { mean: 2.0, deviation: 0.5 }, 1.0),
            (Sizes::LogNormal { median: 1.5, deviation: 0.3 }, 0.5),
        ] {
            let request = Request { aspect, ..request(sizes, Amount::Share(0.26)) };
            let shapes = place(&request, CELL, &[]).unwrap();
            assert!((share(&shapes) - 0.26).abs() < 1e-12);
            for (k, a) in shapes.iter().enumerate() {
                assert!(shapes[..k].iter().all(|b| a.gap(b, CELL) >= 1.0));
            }
            assert_eq!(place(&request, CELL, &[]).unwrap(), shapes, "the same seed, the same pores");
            assert_ne!(place(&Request { seed: 8, ..request }, CELL, &[]).unwrap(), shapes);
        }
    }

    #[test]
    fn sizes_follow_their_distribution() {
        let mut random = Random::new(1);
        let mut draw = |sizes: &Sizes| (0..20_000).map(|_| random.radius(sizes)).collect::<Vec<_>>();
        let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
        let deviation =
            |x: &[f64]| (mean(&x.iter().map(|v| v * v).collect::<Vec<_>>()) - mean(x).powi(2)).sqrt();
        let normal = draw(&Sizes::Normal { mean: 2.0, deviation: 0.4 });
        // A normal distribution that is cut off at three deviations has 0.9866 of its deviation.
        assert!((mean(&normal) - 2.0).abs() < 0.01 && (deviation(&normal) / 0.4 - 0.9866).abs() < 0.015);
        let logs: Vec<f64> =
            draw(&Sizes::LogNormal { median: 2.0, deviation: 0.3 }).iter().map(|r| r.ln()).collect();
        assert!((mean(&logs) - 2f64.ln()).abs() < 0.01 && (deviation(&logs) / 0.3 - 0.9866).abs() < 0.015);
    }

    #[test]
    fn a_seed_gives_these_numbers_on_every_machine() {
        let mut random = Random::new(42);
        let bits = [random.uniform(), random.normal(), random.uniform()].map(f64::to_bits);
        assert_eq!(bits, SEED_42);
    }

    const SEED_42: [u64; 3] =
        [4_597_328_993_821_229_068, 4_587_407_251_491_852_037, 4_602_929_576_513_655_500];

    #[test]
    fn what_does_not_fit_is_told() {
        let refusal = |r: &Request| place(r, CELL, &[]).unwrap_err();
        let full = refusal(&request(Sizes::Constant(2.0), Amount::Share(0.6)));
        let Refusal::Full { placed, wanted, share } = full else { panic!("{full:?}") };
        assert!(placed < wanted && (0.2..0.6).contains(&share), "{placed} of {wanted}, {share}");
        assert!(
            matches!(refusal(&request(Sizes::Constant(0.01), Amount::Share(0.5))), Refusal::TooMany(n) if n > 1e6)
        );
        assert!(matches!(refusal(&request(Sizes::Constant(8.0), Amount::Share(0.02))), Refusal::TooLarge(_)));
        assert!(
            matches!(refusal(&request(Sizes::Constant(21.0), Amount::Count(1))), Refusal::TooLong(l) if l > 42.0)
        );
    }

    #[test]
    fn what_stands_is_kept_clear() {
        let standing = [Shape::Layer { from: 20.0, to: 40.0 }];
        let shapes = place(&request(Sizes::Constant(2.0), Amount::Count(10)), CELL, &standing).unwrap();
        assert!(shapes.iter().all(|s| s.gap(&standing[0], CELL) >= 1.0));
        let listed = request(Sizes::Listed(vec![1.0, 3.0]), Amount::Count(2));
        let radii: Vec<f64> = place(&listed, CELL, &[]).unwrap().iter().map(Shape::width).collect();
        assert_eq!(radii, [6.0, 2.0]);
    }
}
