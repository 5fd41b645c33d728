//! Linear systems λ − h J of implicit methods, without the positions of second-order pairs and without quadratures.

use std::ops::{AddAssign, Mul, Neg};

use crate::linear::{Field, Singular, factorise, solve};
use crate::{Ode, SettingsError};

/// How many components of what kind a state has; in this order.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Layout {
    /// All components.
    pub dim: usize,
    /// Positions; as many rates come next.
    pub pairs: usize,
    /// All but the quadratures at the end.
    pub active: usize,
    /// Those at the end of the active ones whose equation is 0 = fᵢ.
    pub algebraic: usize,
}

impl Layout {
    /// What the problem tells of itself.
    pub(crate) fn of<P: Ode + ?Sized>(problem: &P) -> Result<Self, SettingsError> {
        let (dim, pairs, quadratures) = (problem.dim(), problem.second_order_pairs(), problem.quadratures());
        let algebraic = problem.algebraic();
        let left = dim
            .checked_sub(quadratures)
            .and_then(|left| left.checked_sub(algebraic));
        if pairs > dim || left.is_none_or(|left| 2 * pairs > left) {
            return Err(SettingsError::Method(
                "more pairs of positions and rates, algebraic components and quadratures than components",
            ));
        }
        Ok(Self {
            dim,
            pairs,
            active: dim - quadratures,
            algebraic,
        })
    }

    /// The number of components with which y begins that are neither algebraic nor quadratures.
    pub(crate) fn differential(&self) -> usize {
        self.active - self.algebraic
    }
}

/// The factors of λ − h J without its positions: J begins with rows (0, 1, 0), so the system
///
/// λ x_q − h x_v = r_q, λ x − h J x = r in the other rows
///
/// is solved by x_q = (r_q + h x_v) / λ and (λ − h J' − h² A / λ) x = r + h A r_q / λ, where A is what J has in the columns of the
/// positions (added to those of their rates) and J' the rest of it. In algebraic rows λ x is missing.
#[derive(Debug, Clone)]
pub(crate) struct Reduced<T> {
    lambda: T,
    inverse_lambda: T,
    factors: Vec<T>,
    pivots: Vec<usize>,
    x: Vec<T>,
}

impl<T> Reduced<T>
where
    T: Field + From<f64> + AddAssign + Neg<Output = T> + Mul<f64, Output = T>,
{
    pub(crate) fn new(lambda: T, size: usize) -> Self {
        Self {
            lambda,
            inverse_lambda: lambda.inverse(),
            factors: vec![T::from(0.0); size * size],
            pivots: vec![0; size],
            x: vec![T::from(0.0); size],
        }
    }

    pub(crate) fn factorise(&mut self, layout: Layout, jacobian: &[f64], h: f64) -> Result<(), Singular> {
        let Layout { dim, pairs, active, .. } = layout;
        let (size, differential) = (active - pairs, layout.differential() - pairs);
        let positions = self.inverse_lambda * (h * h);
        let rows = jacobian[pairs * dim..].chunks_exact(dim.max(1));
        for (i, (row, target)) in rows.zip(self.factors.chunks_exact_mut(size.max(1))).enumerate() {
            for (target, &entry) in target.iter_mut().zip(&row[pairs..active]) {
                *target = T::from(-h * entry);
            }
            for (target, &entry) in target.iter_mut().zip(&row[..pairs]) {
                *target += -(positions * entry);
            }
            if i < differential {
                target[i] += self.lambda;
            }
        }
        factorise(&mut self.factors, &mut self.pivots)
    }

    /// Solves in place; `get` and `set` reach the components of the right-hand side.
    pub(crate) fn solve<R: ?Sized>(
        &mut self,
        Layout { dim, pairs, active, .. }: Layout,
        (jacobian, h): (&[f64], f64),
        r: &mut R,
        get: impl Fn(&R, usize) -> T,
        set: impl Fn(&mut R, usize, T),
    ) {
        for (i, x) in self.x.iter_mut().enumerate() {
            let mut positions = T::from(0.0);
            for (j, &entry) in jacobian[(pairs + i) * dim..][..pairs].iter().enumerate() {
                positions += get(r, j) * entry;
            }
            *x = get(r, pairs + i);
            *x += self.inverse_lambda * positions * h;
        }
        solve(&self.factors, &self.pivots, &mut self.x);
        for j in 0..pairs {
            let mut sum = get(r, j);
            sum += self.x[j] * h;
            set(r, j, self.inverse_lambda * sum);
        }
        (pairs..active).for_each(|i| set(r, i, self.x[i - pairs]));
    }
}
