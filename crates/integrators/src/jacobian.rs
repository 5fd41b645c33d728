//! The matrix df/dy by differences of f.

use crate::{Counted, EvalError, Ode, Weights};

/// Part of a component by which it is varied: the square root of ε, which balances rounding and curvature.
const PART: f64 = 1.4901161193847656e-8;

/// A change of f is to stand out from its rounding by so many units where the component itself gives no size.
const ABOVE_ROUNDING: f64 = 1e5;

/// A difference quotient is not a number.
#[derive(Debug, thiserror::Error)]
#[error("a difference quotient of f is not finite")]
pub(crate) struct NotFinite;

/// Writes the first `columns` columns of df/dy at (t, y) by forward differences; the others are left as they are.
///
/// `f` is f(t, y), `h` the signed length of the step that is planned. A component is varied in the direction in which it moves
/// and, if f is not defined there, in the other one. The first entries of `scratch` are overwritten. Costs one evaluation for
/// each column, two where the first failed.
///
/// # Errors
/// Those of the problem; [`EvalError::Retry`] if a quotient is not finite.
pub(crate) fn differences<P: Ode + ?Sized>(
    problem: &mut Counted<'_, P>,
    (t, h): (f64, f64),
    (y, f): (&[f64], &[f64]),
    weights: &Weights,
    columns: usize,
    [y_varied, f_varied]: [&mut [f64]; 2],
    matrix: &mut [f64],
) -> Result<(), EvalError> {
    let n = y.len();
    y_varied.copy_from_slice(y);
    let structure = problem.structure();
    let end = n - structure.quadratures().min(n);
    let algebraic = end - structure.algebraic().min(end)..end;
    let motion = h.abs() * weights.norm(y, y, f);
    for column in 0..columns {
        let toward = if h * f[column] < 0.0 { -1.0 } else { 1.0 };
        let weight = weights.of(column, y[column]);
        let mut increment = toward * increment(y[column], h * f[column], weight, motion);
        if algebraic.contains(&column) {
            let excess = problem.structure().index(column).saturating_sub(1);
            increment = toward * increment.abs().max(least(weight / h.abs().powi(excess as i32)));
        }
        y_varied[column] = y[column] + increment;
        let mut varied = problem.rhs_for_jacobian(t, y_varied, f_varied);
        if let Err(EvalError::Retry(_)) = varied {
            y_varied[column] = y[column] - increment;
            varied = problem.rhs_for_jacobian(t, y_varied, f_varied);
        }
        varied?;
        let inverse = 1.0 / (y_varied[column] - y[column]);
        y_varied[column] = y[column];
        let mut check = 0.0;
        for (row, (f_varied, f)) in f_varied.iter().zip(f).enumerate() {
            let quotient = (f_varied - f) * inverse;
            matrix[row * n + column] = quotient;
            check += 0.0 * quotient;
        }
        if check != 0.0 {
            return Err(EvalError::Retry(Box::new(NotFinite)));
        }
    }
    Ok(())
}

/// The least by which to vary an algebraic component of this tolerance: it may be far smaller than its effects are large, so the
/// geometric mean of the tolerance and of rounding of 1 (subroutine RADAU5 takes 1e-5 for any tolerance).
fn least(weight: f64) -> f64 {
    if weight.is_finite() {
        (f64::EPSILON * weight).sqrt()
    } else {
        0.0
    }
}

/// By how much to vary a component `y` of tolerance `weight` that changes by `change` in the step; `motion` is the norm of all
/// changes, in tolerances.
fn increment(y: f64, change: f64, weight: f64, motion: f64) -> f64 {
    let known = PART * y.abs();
    let (above_rounding, rest) = if weight.is_finite() {
        (ABOVE_ROUNDING * f64::EPSILON * motion * weight, 0.01 * weight)
    } else {
        (PART * change.abs(), PART)
    };
    let increment = known.max(if above_rounding.is_finite() {
        above_rounding
    } else {
        0.0
    });
    // Below this the reciprocal may overflow.
    if increment > 1e-290 {
        increment
    } else {
        rest.max(1e-290)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Source, Statistics};

    struct Problem<F>(usize, F);

    impl<F: Fn(&[f64], &mut [f64]) -> Result<(), EvalError>> Ode for Problem<F> {
        fn dim(&self) -> usize {
            self.0
        }
        fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
            (self.1)(y, dy)
        }
    }

    fn matrix(
        f: impl Fn(&[f64], &mut [f64]) -> Result<(), EvalError>,
        h: f64,
        y: &[f64],
        absolute: &[f64],
        columns: usize,
    ) -> Result<(Vec<f64>, Statistics), EvalError> {
        let n = y.len();
        let (mut problem, mut statistics) = (Problem(n, f), Statistics::default());
        let weights = Weights::new(&vec![1e-8; n], absolute);
        let (mut dy, mut scratch, mut matrix) = (vec![0.0; n], [vec![0.0; n], vec![0.0; n]], vec![7.0; n * n]);
        problem.rhs(0.0, y, &mut dy)?;
        let mut counted = Counted::new(&mut problem, &mut statistics);
        let [a, b] = &mut scratch;
        differences(&mut counted, (0.0, h), (y, &dy), &weights, columns, [a, b], &mut matrix)?;
        Ok((matrix, statistics))
    }

    /// A vibration with a force that is far larger than the state, a decay, and components at zero or below all scales.
    #[test]
    fn entries_are_accurate_whatever_the_scales() {
        let rates = |y: &[f64], dy: &mut [f64]| {
            dy.copy_from_slice(&[y[1], -1e9 * y[0] + 9.81 - 1e3 * y[1], -1e-3 * y[2] + y[0], y[3] * y[0]]);
            Ok(())
        };
        for y in [
            [1e-6, 0.1, 1e6, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [1e-310, -5e-324, 0.3, 1e-300],
            [1e-30, 1.0, -1.0, 1.0],
        ] {
            for (h, absolute) in [(1e-5, 1e-10), (-1e-5, 1e-12), (1e-3, 1e-6)] {
                let (found, statistics) = matrix(rates, h, &y, &[absolute; 4], 4).unwrap();
                let rows = [
                    [0.0, 1.0, 0.0, 0.0],
                    [-1e9, -1e3, 0.0, 0.0],
                    [1.0, 0.0, -1e-3, 0.0],
                    [y[3], 0.0, 0.0, y[0]],
                ];
                for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
                    let (found, exact) = (found[4 * i + j], rows[i][j]);
                    // What matters is h J.
                    let bound = 1e-6 * exact.abs() + 1e-3 / h.abs();
                    assert!((found - exact).abs() < bound, "{i} {j} at {y:?}, {h}: {found} {exact}");
                }
                assert_eq!((statistics.evaluations, statistics.jacobian_evaluations), (4, 4));
            }
        }
    }

    #[test]
    fn later_columns_are_left_alone() {
        let (found, statistics) = matrix(
            |y, dy| {
                dy.copy_from_slice(&[2.0 * y[0], y[0]]);
                Ok(())
            },
            0.1,
            &[1.0, 0.0],
            &[1e-8, f64::INFINITY],
            1,
        )
        .unwrap();
        assert!((found[0] - 2.0).abs() < 1e-7 && (found[2] - 1.0).abs() < 1e-7);
        assert_eq!((found[1], found[3], statistics.evaluations), (7.0, 7.0, 1));
    }

    /// Without a tolerance the component itself gives the size, or its change.
    #[test]
    fn components_without_tolerance() {
        let square = |y: &[f64], dy: &mut [f64]| {
            dy[0] = y[0] * y[0] + 1.0;
            Ok(())
        };
        for y in [0.0, 1.0, -1e3, 1e-200] {
            let (found, _) = matrix(square, 1e-3, &[y], &[f64::INFINITY], 1).unwrap();
            assert!((found[0] - 2.0 * y).abs() < 1e-6 * (1.0 + y.abs()), "{found:?} at {y}");
        }
    }

    #[test]
    fn failures() {
        let refuse = |y: &[f64], dy: &mut [f64]| {
            dy[0] = -1.0;
            if y[0] == 1.0 {
                Ok(())
            } else {
                Err(EvalError::Retry(Source::from("outside")))
            }
        };
        assert!(matches!(
            matrix(refuse, 0.1, &[1.0], &[1e-8], 1),
            Err(EvalError::Retry(_))
        ));
        let abort = |y: &[f64], _: &mut [f64]| {
            if y[0] == 1.0 {
                Ok(())
            } else {
                Err(EvalError::Abort(Source::from("no use")))
            }
        };
        assert!(matches!(
            matrix(abort, 0.1, &[1.0], &[1e-8], 1),
            Err(EvalError::Abort(_))
        ));
        let jump = |y: &[f64], dy: &mut [f64]| {
            dy[0] = if y[0] == 1.0 { 1.0 } else { f64::INFINITY };
            Ok(())
        };
        let error = matrix(jump, 0.1, &[1.0], &[1e-8], 1).unwrap_err();
        assert!(
            error.to_string().contains("a difference quotient of f is not finite"),
            "{error}"
        );
    }
}
