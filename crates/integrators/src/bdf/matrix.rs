//! df/dy and the factors of the iteration's matrix: how long they serve.

use crate::jacobian::differences;
use crate::linear::Singular;
use crate::newton::Convergence;
use crate::reduced::{Layout, Reduced};
use crate::{Counted, EvalError, Ode, Weights};

/// Factors serve for values of c = h/γ that differ from theirs by this part.
const SAME_MATRIX: f64 = 0.05;

/// Where changes shrink to this part or less, df/dy is as good as a new one.
const FAST: f64 = 0.02;

/// Where they shrink more slowly than this, divergence is near.
const SLOW: f64 = 0.3;

/// df/dy serves for so many steps at most, or for twice as many as it has cost evaluations. An iteration that still converges may
/// follow a matrix that has lost its meaning: without this bound van der Pol's equation misses its jumps.
const MOST_STEPS: usize = 20;

/// Iterations that a step with a new df/dy is taken to need at first.
const USUAL: u32 = 2;

/// The matrix 1 − c J of Newton's iteration.
#[derive(Debug, Clone)]
pub(super) struct Matrix {
    pub layout: Layout,
    jacobian: Vec<f64>,
    system: Reduced<f64>,
    /// The c for which factors exist.
    c: Option<f64>,
    /// J serves.
    pub usable: bool,
    /// Evaluations that J has cost, steps that it has served, iterations of the step it was found for, and the iterations above these of all steps since.
    evaluations: usize,
    steps: usize,
    usual: u32,
    excess: u32,
}

impl Matrix {
    pub(super) fn new(layout: Layout) -> Self {
        Self {
            layout,
            jacobian: vec![0.0; layout.dim * layout.dim],
            system: Reduced::new(1.0, layout.active - layout.pairs),
            c: None,
            usable: false,
            evaluations: 0,
            steps: 0,
            usual: USUAL,
            excess: 0,
        }
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        (self.c, self.usable) = (None, false);
        (self.usual, self.excess) = (USUAL, 0);
    }

    /// Finds df/dy at (t, y), where f is `f`, for a step of length `h`; see [`differences`].
    pub(super) fn find<P: Ode + ?Sized>(
        &mut self,
        problem: &mut Counted<'_, P>,
        (t, h): (f64, f64),
        (y, f): (&[f64], &[f64]),
        weights: &Weights,
        scratch: [&mut [f64]; 2],
    ) -> Result<(), EvalError> {
        (self.c, self.usable, self.evaluations) = (None, false, 0);
        if !problem.jacobian(t, y, &mut self.jacobian)? {
            let active = self.layout.active;
            self.evaluations = active;
            differences(problem, (t, h), (y, f), weights, active, scratch, &mut self.jacobian)?;
        }
        self.usable = true;
        Ok(())
    }

    /// Makes factors for this `c` unless those at hand will do.
    pub(super) fn prepare<P: Ode + ?Sized>(&mut self, problem: &mut Counted<'_, P>, c: f64) -> Result<(), Singular> {
        if self.c.is_some_and(|own| (c - own).abs() <= SAME_MATRIX * own.abs()) {
            return Ok(());
        }
        problem.count_factorisations(1);
        self.c = None;
        self.system.factorise(self.layout, &self.jacobian, c)?;
        self.c = Some(c);
        Ok(())
    }

    /// Solves (1 − c J) x = r in place, with the factors at hand; where they belong to another c the result is scaled so that it is
    /// right in the middle between soft and stiff components (Brown, Byrne, Hindmarsh 1989).
    pub(super) fn solve(&mut self, c: f64, r: &mut [f64]) {
        let own = self.c.unwrap_or(c);
        let (get, set) = (|r: &[f64], i: usize| r[i], |r: &mut [f64], i: usize, x: f64| r[i] = x);
        self.system.solve(self.layout, (&self.jacobian, own), r, get, set);
        if own != c {
            let scale = 2.0 / (1.0 + c / own);
            r[..self.layout.active].iter_mut().for_each(|x| *x *= scale);
        }
    }

    /// Multiplies by (1 − c J)⁻¹ with the c of the factors, quadratures included.
    pub(super) fn filter(&mut self, r: &mut [f64]) {
        let own = self.c.unwrap_or(0.0);
        self.solve(own, r);
        let (controlled, quadratures) = r.split_at_mut(self.layout.active);
        for (i, x) in quadratures.iter_mut().enumerate() {
            *x += own * self.row_times(self.layout.active + i, controlled);
        }
    }

    /// Row `i` of df/dy times a change of all that f depends on.
    pub(super) fn row_times(&self, i: usize, x: &[f64]) -> f64 {
        let row = &self.jacobian[i * self.layout.dim..][..self.layout.active];
        row.iter().zip(x).map(|(j, x)| j * x).sum()
    }

    /// Whether J has served long enough, after the iteration of a step; `new` if it was found in that step.
    pub(super) fn is_outdated(&mut self, convergence: &Convergence, new: bool) -> bool {
        let iterations = convergence.iterations();
        self.steps = if new { 0 } else { self.steps + 1 };
        self.usual = iterations.min(self.usual + u32::from(new));
        self.excess = if new {
            0
        } else {
            self.excess + (iterations - self.usual)
        };
        let paid = self.excess as usize > self.evaluations;
        self.steps >= MOST_STEPS.max(2 * self.evaluations) || convergence.contraction() > if paid { FAST } else { SLOW }
    }
}
