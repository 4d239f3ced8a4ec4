//! Weighted least squares, linear and not, with covariance.
//!
//! ```text
//! χ² = Σ_i ( (y_i - f(x_i; a))/σ_i )²,
//! C = (Jᵀ W J)⁻¹,      J_ik = ∂f(x_i)/∂a_k,      W = diag(σ_i⁻²)
//! ```
//!
//! Columns of J are scaled to equal length before the singular values are taken, so that parameters of different units
//! do not spoil the condition.
//!
//! Source: W. H. Press et al., *Numerical Recipes*, ch. 15.

use nalgebra::{DMatrix, DVector};

/// Ratio of singular values below which parameters cannot be told apart.
const SINGULAR: f64 = 1e-10;
/// Steps of a non-linear fit at most.
const MAX_STEPS: usize = 200;
/// Relative change of χ² at which a non-linear fit has converged.
const CONVERGED: f64 = 1e-12;

/// What a fit gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Parameters, in units that are the caller's.
    pub parameters: Vec<f64>,
    /// Their covariance, from the errors of the values as they were given.
    pub covariance: DMatrix<f64>,
    /// χ² at the parameters [-].
    pub chi_squared: f64,
}

/// Fits y = J a with standard deviations `sigma`; `None` where the values do not determine the parameters.
pub fn linear(design: &DMatrix<f64>, y: &[f64], sigma: &[f64]) -> Option<Solution> {
    let weighted = DMatrix::from_fn(design.nrows(), design.ncols(), |i, k| design[(i, k)] / sigma[i]);
    let values = DVector::from_iterator(y.len(), y.iter().zip(sigma).map(|(y, s)| y / s));
    let (inverse, covariance) = pseudo_inverse(&weighted)?;
    let parameters = inverse * &values;
    let chi_squared = (&weighted * &parameters - values).norm_squared();
    Some(Solution { parameters: parameters.iter().copied().collect(), covariance, chi_squared })
}

/// (A⁺, (AᵀA)⁻¹) of a matrix of full rank.
fn pseudo_inverse(matrix: &DMatrix<f64>) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
    let n = matrix.ncols();
    if matrix.nrows() < n || matrix.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let lengths: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
    if lengths.iter().any(|l| *l <= 0.0) {
        return None;
    }
    let scaled = DMatrix::from_fn(matrix.nrows(), n, |i, k| matrix[(i, k)] / lengths[k]);
    let svd = scaled.svd(true, true);
    let greatest = svd.singular_values.max();
    if svd.singular_values.min() < SINGULAR * greatest {
        return None;
    }
    let mut inverse = svd.pseudo_inverse(0.0).ok()?;
    for (k, length) in lengths.iter().enumerate() {
        inverse.row_mut(k).scale_mut(1.0 / length);
    }
    let covariance = &inverse * inverse.transpose();
    Some((inverse, covariance))
}

/// Fits a model with parameters `start` by damped Gauss-Newton steps (Levenberg-Marquardt), derivatives by differences.
///
/// `residuals` gives (f(xᵢ) - yᵢ)/σᵢ. `None` where the values do not determine the parameters.
pub fn nonlinear(start: &[f64], residuals: impl Fn(&[f64]) -> Vec<f64>) -> Option<Solution> {
    let mut parameters = start.to_vec();
    let mut here = DVector::from_vec(residuals(&parameters));
    let mut damping = 1e-3;
    for _ in 0..MAX_STEPS {
        let jacobian = jacobian(&parameters, &residuals);
        let Some((there, next)) = step(&parameters, &here, &jacobian, damping, &residuals) else {
            damping *= 10.0;
            if damping > 1e12 {
                break;
            }
            continue;
        };
        let gain = here.norm_squared() - next.norm_squared();
        let converged = gain <= CONVERGED * here.norm_squared();
        (parameters, here) = (there, next);
        damping = (damping * 0.1).max(1e-12);
        if converged {
            break;
        }
    }
    let (_, covariance) = pseudo_inverse(&jacobian(&parameters, &residuals))?;
    Some(Solution { parameters, covariance, chi_squared: here.norm_squared() })
}

/// Parameters and residuals after a damped step; `None` if it does not lower χ².
fn step(
    parameters: &[f64],
    here: &DVector<f64>,
    jacobian: &DMatrix<f64>,
    damping: f64,
    residuals: impl Fn(&[f64]) -> Vec<f64>,
) -> Option<(Vec<f64>, DVector<f64>)> {
    let mut normal = jacobian.transpose() * jacobian;
    for k in 0..normal.ncols() {
        normal[(k, k)] *= 1.0 + damping;
    }
    let way = normal.lu().solve(&(jacobian.transpose() * here))?;
    let there: Vec<f64> = parameters.iter().zip(way.iter()).map(|(p, w)| p - w).collect();
    let next = DVector::from_vec(residuals(&there));
    (next.iter().all(|r| r.is_finite()) && next.norm_squared() <= here.norm_squared())
        .then_some((there, next))
}

/// Derivatives of the residuals by central differences.
fn jacobian(parameters: &[f64], residuals: &impl Fn(&[f64]) -> Vec<f64>) -> DMatrix<f64> {
    let columns: Vec<DVector<f64>> = (0..parameters.len())
        .map(|k| {
            let width = 1e-6 * parameters[k].abs().max(1e-6);
            let at = |shift: f64| {
                let mut moved = parameters.to_vec();
                moved[k] += shift;
                DVector::from_vec(residuals(&moved))
            };
            (at(width) - at(-width)) / (2.0 * width)
        })
        .collect();
    DMatrix::from_columns(&columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight line has its parameters and covariance in closed form.
    #[test]
    fn a_straight_line_has_its_textbook_covariance() {
        let x = [50.0_f64, 100.0, 150.0, 250.0, 300.0];
        let sigma = [0.5, 0.2, 0.4, 1.0, 0.3];
        let y = [321.0, 415.5, 510.2, 699.0, 792.8];
        let design = DMatrix::from_fn(5, 2, |i, k| x[i].powi(k as i32));
        let solution = linear(&design, &y, &sigma).unwrap();
        let sum = |f: &dyn Fn(usize) -> f64| (0..5).map(|i| f(i) / (sigma[i] * sigma[i])).sum::<f64>();
        let (s, sx, sy) = (sum(&|_| 1.0), sum(&|i| x[i]), sum(&|i| y[i]));
        let (sxx, sxy) = (sum(&|i| x[i] * x[i]), sum(&|i| x[i] * y[i]));
        let determinant = s * sxx - sx * sx;
        let expected = [
            ((sxx * sy - sx * sxy) / determinant, solution.parameters[0]),
            ((s * sxy - sx * sy) / determinant, solution.parameters[1]),
            (sxx / determinant, solution.covariance[(0, 0)]),
            (s / determinant, solution.covariance[(1, 1)]),
            (-sx / determinant, solution.covariance[(0, 1)]),
        ];
        for (wanted, found) in expected {
            assert!((found / wanted - 1.0).abs() < 1e-10, "{found} {wanted}");
        }
    }

    #[test]
    fn parameters_that_the_values_leave_open_are_refused() {
        let one_place = DMatrix::from_fn(3, 2, |_, k| 100f64.powi(k as i32));
        assert_eq!(linear(&one_place, &[1.0, 2.0, 3.0], &[1.0; 3]), None);
        let too_few = DMatrix::from_fn(1, 2, |_, k| 100f64.powi(k as i32));
        assert_eq!(linear(&too_few, &[1.0], &[1.0]), None);
    }

    #[test]
    fn a_nonlinear_fit_finds_an_exponential_and_agrees_with_the_linear_covariance() {
        let x: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
        let exact = |a: &[f64], x: f64| a[0] * (-a[1] * x).exp();
        let y: Vec<f64> = x.iter().map(|&x| exact(&[3.0, 0.7], x)).collect();
        let residuals =
            |a: &[f64]| x.iter().zip(&y).map(|(&x, y)| (exact(a, x) - y) / 0.01).collect::<Vec<_>>();
        let solution = nonlinear(&[1.0, 1.0], residuals).unwrap();
        assert!((solution.parameters[0] - 3.0).abs() < 1e-8 && (solution.parameters[1] - 0.7).abs() < 1e-8);
        let design = DMatrix::from_fn(20, 2, |i, k| match k {
            0 => (-0.7 * x[i]).exp(),
            _ => -3.0 * x[i] * (-0.7 * x[i]).exp(),
        });
        let reference = linear(&design, &[0.0; 20], &[0.01; 20]).unwrap();
        for (found, wanted) in solution.covariance.iter().zip(reference.covariance.iter()) {
            assert!((found / wanted - 1.0).abs() < 1e-5, "{found} {wanted}");
        }
    }
}
