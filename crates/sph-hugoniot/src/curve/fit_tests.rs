//! Fits of synthetic curves whose parameters and noise are known.

use super::*;
use rand::{RngExt, SeedableRng};

const PLACES: [f64; 10] = [50.0, 75.0, 100.0, 115.0, 130.0, 150.0, 175.0, 200.0, 250.0, 300.0];
const TRUE: [f64; 4] = [226.8, 1.886, 128.0, 3.5];

/// Normal noise of variance one: sum of twelve uniform numbers.
fn normal(random: &mut rand_pcg::Pcg64) -> f64 {
    (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0
}

/// The two-piece curve with noise of `sigma`, said to be `told`.
fn synthetic(seed: u64, sigma: f64, told: f64) -> Vec<FitPoint> {
    let mut random = rand_pcg::Pcg64::seed_from_u64(seed);
    let point = |&u: &f64| FitPoint {
        particle_velocity: u,
        shock_velocity: Form::TwoPiece.value(&TRUE, u) + sigma * normal(&mut random),
        standard_error: told,
    };
    PLACES.iter().map(point).collect()
}

fn variance(values: &[f64]) -> f64 {
    let mean = crate::statistics::mean(values);
    values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (values.len() - 1) as f64
}

#[test]
fn exact_points_give_their_parameters_back() {
    for (form, a) in [
        (Form::Linear, vec![200.0, 2.5]),
        (Form::Quadratic, vec![14.58, 3.573, -0.0003967]),
        (Form::TwoPiece, TRUE.to_vec()),
    ] {
        let at = |&u: &f64| FitPoint {
            particle_velocity: u,
            shock_velocity: form.value(&a, u),
            standard_error: 0.3,
        };
        let fit = Fit::new(form, &PLACES.iter().map(at).collect::<Vec<_>>()).unwrap();
        for (found, wanted) in fit.values.iter().zip(&a) {
            assert!((found / wanted - 1.0).abs() < 1e-6, "{form:?}: {:?}", fit.values);
        }
        assert!(fit.chi_squared < 1e-6 && fit.widened_by == 1.0 && fit.error_source == ErrorSource::Points);
    }
}

/// Over many draws the parameters scatter as the covariance says, χ² has its mean, and a bit over two of three
/// intervals of the break hold the true one.
#[test]
fn parameters_scatter_as_their_covariance_says() {
    let fits: Vec<Fit> =
        (0..400).map(|seed| Fit::new(Form::TwoPiece, &synthetic(seed, 1.5, 1.5)).unwrap()).collect();
    let exact = Fit::new(Form::TwoPiece, &synthetic(0, 0.0, 1.5)).unwrap();
    for k in 0..4 {
        let spread = variance(&fits.iter().map(|f| f.values[k]).collect::<Vec<_>>()).sqrt();
        assert!((spread / exact.errors[k] - 1.0).abs() < 0.12, "{k}: {spread} {}", exact.errors[k]);
    }
    let mean = |f: &dyn Fn(&Fit) -> f64| fits.iter().map(f).sum::<f64>() / fits.len() as f64;
    let reduced = mean(&|f| f.reduced_chi_squared.unwrap());
    assert!((reduced - 1.0).abs() < 0.08, "{reduced}");
    let inside = mean(&|f| {
        let (low, high) = f.break_interval.unwrap();
        f64::from(u8::from((low..=high).contains(&TRUE[2])))
    });
    assert!((0.64..0.80).contains(&inside), "{inside}");
    let probability = mean(&|f| f.probability.unwrap());
    assert!((probability - 0.5).abs() < 0.05, "{probability}");
}

/// Errors that are said to be five times too small are widened back by about five.
#[test]
fn underestimated_errors_are_widened_and_told() {
    let fits: Vec<Fit> =
        (0..200).map(|seed| Fit::new(Form::TwoPiece, &synthetic(seed, 1.5, 0.3)).unwrap()).collect();
    assert!(fits.iter().filter(|f| f.error_source == ErrorSource::Widened).count() > 195);
    let mean = |f: &dyn Fn(&Fit) -> f64| fits.iter().map(f).sum::<f64>() / fits.len() as f64;
    assert!((mean(&|f| f.widened_by.powi(2)) / 25.0 - 1.0).abs() < 0.1);
    let spread = variance(&fits.iter().map(|f| f.values[1]).collect::<Vec<_>>());
    assert!((mean(&|f| f.covariance[1][1]) / spread - 1.0).abs() < 0.2);
    let inside = mean(&|f| {
        let (low, high) = f.break_interval.unwrap();
        f64::from(u8::from((low..=high).contains(&TRUE[2])))
    });
    assert!((0.6..0.82).contains(&inside), "{inside}");
    assert!(fits[0].probability.unwrap() < 1e-6);
}

/// Too large errors are not made smaller.
#[test]
fn overestimated_errors_stay() {
    let fit = Fit::new(Form::Linear, &synthetic(1, 0.0, 500.0)).unwrap();
    assert!(fit.reduced_chi_squared.unwrap() < 1.0 && fit.widened_by == 1.0);
}

#[test]
fn points_without_errors_take_them_from_the_scatter() {
    let mut points = synthetic(3, 1.5, 1.5);
    points[4].standard_error = f64::NAN;
    let fit = Fit::new(Form::TwoPiece, &points).unwrap();
    assert_eq!((fit.error_source, fit.probability), (ErrorSource::Scatter, None));
    let told = Fit::new(Form::TwoPiece, &synthetic(3, 1.5, 1.5)).unwrap();
    assert!((0.3..3.0).contains(&(fit.errors[1] / told.errors[1])));
    // As many points as parameters: a curve, but no errors.
    let few = Fit::new(Form::Linear, &[points[4], points[5]]).unwrap();
    assert!(few.errors[0].is_nan() && few.error_source == ErrorSource::Unknown);
}

/// The 95 % band holds the true curve in 95 of 100 draws, at the ends, in the middle, and near the break.
#[test]
fn the_band_holds_the_true_curve() {
    let fits: Vec<Fit> =
        (0..300).map(|seed| Fit::new(Form::TwoPiece, &synthetic(seed, 1.5, 1.5)).unwrap()).collect();
    for u in [60.0, 140.0, 220.0, 300.0] {
        let is_inside = |f: &&Fit| (f.shock_velocity(u) - Form::TwoPiece.value(&TRUE, u)).abs() <= f.band(u);
        let part = fits.iter().filter(is_inside).count() as f64 / fits.len() as f64;
        assert!((0.91..0.99).contains(&part), "{u}: {part}");
    }
}

#[test]
fn too_few_points_give_no_fit() {
    let points = synthetic(1, 0.0, 1.0);
    assert_eq!(Fit::new(Form::Linear, &points[..1]), None);
    assert_eq!(Fit::new(Form::Quadratic, &points[..2]), None);
    assert_eq!(Fit::new(Form::TwoPiece, &points[..3]), None);
    assert_eq!(Fit::new(Form::Linear, &[]), None);
}
