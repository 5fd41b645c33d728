//! The method of Adams with variable order and variable step.

use crate::sums::add;
use crate::{Counted, EvalError, Method, Ode, SettingsError, Step, Weights};

/// Highest order of the predictor.
const MOST: usize = 12;

/// Part of the tolerance that the next step aims at. Found by trial: ½, the value of STEP, throws more steps away than it saves.
const AIM: f64 = 0.25;

/// Adams' method in the form of Shampine and Gordon: order 2 to 13, 2 evaluations per step (predict, evaluate, correct, evaluate).
///
/// On smooth problems and tolerances from 1e-6 downward it needs about half the evaluations of [`Dop853`](crate::Dop853);
/// its own work per evaluation is larger. Interpolation needs no evaluation and has the order of the step. It starts with order
/// 1, so at each [stop](crate::Integration::with_stops) some 25 evaluations are spent on gathering a new history.
///
/// Shampine, Gordon, Computer Solution of Ordinary Differential Equations, 1975, chapters 5, 7, 10 (STEP); notation of
/// Hairer, Nørsett, Wanner I, III.5: Φⱼ are the modified divided differences, βⱼ takes them along to the next point, gⱼ are the
/// integrals of the Newton polynomials.
#[derive(Debug, Clone)]
pub struct Adams {
    /// Order k of the predictor in this attempt, and in the next.
    k: usize,
    next_k: usize,
    /// How many Φⱼ exist.
    depth: usize,
    /// Order and step still rise with every step.
    starting: bool,
    /// Attempts refused since the last step.
    failures: u32,
    /// tₙ − tₙ₋ⱼ, and 1 / (tₙ − tₙ₋ⱼ) here and after the attempt, j > 0.
    back: [f64; MOST + 2],
    inverse: [f64; MOST + 2],
    inverse_new: [f64; MOST + 2],
    /// Φⱼ(n), one vector after the other.
    differences: Vec<f64>,
    beta: [f64; MOST + 2],
    g: [f64; MOST + 2],
    /// Φₖ(n + 1) of the predicted state, then scratch.
    top: Vec<f64>,
    f_new: Vec<f64>,
    /// Φₖ₋₁(n + 1) and Φₖ₋₂(n + 1) of the predicted state.
    lower: [Vec<f64>; 2],
    /// Norms of the error had this step been made with order k, k − 1, k − 2.
    errors: [f64; 3],
    /// Norm of the error expected at `next_k` with an unchanged step.
    next_error: f64,
    /// By how much the polynomial of the last step misses its beginning, once it is asked for.
    defect: Vec<f64>,
    defect_ready: bool,
}

impl Default for Adams {
    fn default() -> Self {
        Self {
            k: 1,
            next_k: 1,
            depth: 1,
            starting: true,
            failures: 0,
            back: [0.0; MOST + 2],
            inverse: [0.0; MOST + 2],
            inverse_new: [0.0; MOST + 2],
            differences: Vec::new(),
            beta: [0.0; MOST + 2],
            g: [0.0; MOST + 2],
            top: Vec::new(),
            f_new: Vec::new(),
            lower: [Vec::new(), Vec::new()],
            errors: [0.0; 3],
            next_error: 1.0,
            defect: Vec::new(),
            defect_ready: false,
        }
    }
}

impl Adams {
    /// βⱼ and gⱼ for a step h with order k (Hairer, Nørsett, Wanner I, eq. III.5.9 and III.5.11-13).
    fn find_coefficients(&mut self, h: f64) {
        let count = self.depth.min(self.k + 1);
        for j in 1..=count {
            self.inverse_new[j] = 1.0 / (h + self.back[j - 1]);
        }
        self.beta[0] = 1.0;
        for j in 1..self.depth.min(self.k + 1) {
            self.beta[j] = self.beta[j - 1] * (h + self.back[j - 1]) * self.inverse[j];
        }
        // c[q] is c_{j, q + 1}, of which q <= count - j is needed; a loop of constant length is faster than one of the right length.
        let mut c: [f64; MOST + 3] = std::array::from_fn(|q| 1.0 / (q + 1) as f64);
        self.g[0] = c[0];
        for j in 1..=count {
            let ratio = h * self.inverse_new[j];
            for q in 0..MOST + 2 {
                c[q] -= ratio * c[q + 1];
            }
            self.g[j] = c[0];
        }
    }

    /// y + ∫ of the polynomial through the newest derivatives, from the newest point to a distance `s` from it.
    fn continue_by(&self, s: f64, y: &mut [f64]) {
        let count = self.depth.min(self.k + 1);
        // i[q] is β_j c_{j, q + 1} of the step s; formed without the quotients that vanish at the points themselves.
        let mut i: [f64; MOST + 3] = std::array::from_fn(|q| 1.0 / (q + 1) as f64);
        let mut terms = [(0, 0.0); MOST + 1];
        terms[0] = (0, i[0]);
        for (j, term) in terms.iter_mut().enumerate().take(count).skip(1) {
            for q in 0..count - j {
                i[q] = ((s + self.back[j - 1]) * i[q] - s * i[q + 1]) * self.inverse[j];
            }
            *term = (j, i[0]);
        }
        add(y, s, &terms[..count], &self.differences);
    }

    /// Error of a step of order k, from the mean square of its Φₖ: h (gₖ − gₖ₋₁) Φₖ.
    fn error_norm(&self, h: f64, k: usize, mean_square: f64) -> f64 {
        (h * (self.g[k] - self.g[k - 1])).abs() * mean_square.sqrt()
    }

    /// Order of the next step after an accepted one, and the error to expect of it (Shampine and Gordon, chapter 7).
    fn choose_order(&mut self, step: Step<'_>, weights: &Weights, y_new: &[f64]) -> (usize, f64) {
        let (k, [error, lower, lowest]) = (self.k, self.errors);
        if self.starting && k < MOST && (k == 1 || lower > error) {
            return (k + 1, error);
        }
        self.starting = false;
        if (k > 2 && lower.max(lowest) <= error) || (k == 2 && lower <= 0.5 * error) {
            return (k - 1, lower);
        }
        if k == MOST || self.depth < k + 2 {
            return (k, error);
        }
        let n = self.f_new.len();
        let [square] = weights.mean_squares(step.y, y_new, [&self.differences[(k + 1) * n..(k + 2) * n]]);
        let higher = self.error_norm(step.h, k + 1, square);
        match k {
            1 if higher < 0.5 * error => (2, higher),
            2.. if lower <= error.min(higher) => (k - 1, lower),
            2.. if higher < error => (k + 1, higher),
            _ => (k, error),
        }
    }
}

impl<P: Ode + ?Sized> Method<P> for Adams {
    fn order(&self) -> u32 {
        self.k as u32
    }

    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        let n = problem.dim();
        self.differences = vec![0.0; n * (MOST + 1)];
        let [lower, lowest] = &mut self.lower;
        for vector in [&mut self.top, &mut self.f_new, &mut self.defect, lower, lowest] {
            *vector = vec![0.0; n];
        }
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        (self.k, self.next_k, self.depth, self.starting, self.failures) = (1, 1, 1, true, 0);
        problem.rhs(t, y, &mut self.differences[..y.len()])
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        let Step { t, h, y } = step;
        self.k = self.next_k;
        let k = self.k;
        self.find_coefficients(h);
        let (beta, g) = (&self.beta, &self.g);

        // Predict: p = yₙ + h Σ gⱼ βⱼ Φⱼ(n); evaluate.
        let terms: [(usize, f64); MOST] = std::array::from_fn(|j| (j, g[j] * beta[j]));
        y_new.copy_from_slice(y);
        add(y_new, h, &terms[..k], &self.differences);
        problem.rhs(t + h, y_new, &mut self.f_new)?;

        // Φₖ(n + 1) = f(p) − Σ βⱼ Φⱼ(n); correct.
        let terms: [(usize, f64); MOST] = std::array::from_fn(|j| (j, beta[j]));
        self.top.copy_from_slice(&self.f_new);
        add(&mut self.top, -1.0, &terms[..k], &self.differences);
        add(y_new, h, &[(0, g[k])], &self.top);
        error.fill(0.0);
        add(error, h, &[(0, g[k] - g[k - 1])], &self.top);

        // Φₖ₋₁(n + 1) = Φₖ(n + 1) + βₖ₋₁ Φₖ₋₁(n) and so on.
        let [lower, lowest] = &mut self.lower;
        lower.copy_from_slice(&self.top);
        if k > 1 {
            add(lower, 1.0, &[(k - 1, beta[k - 1])], &self.differences);
        }
        lowest.copy_from_slice(lower);
        if k > 2 {
            add(lowest, 1.0, &[(k - 2, beta[k - 2])], &self.differences);
        }
        let squares = weights.mean_squares(y, y_new, [&self.top, lower, lowest]);
        self.errors = std::array::from_fn(|m| {
            if m < k {
                self.error_norm(h, k - m, squares[m])
            } else {
                0.0
            }
        });
        Ok(self.errors[0])
    }

    fn close(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        _projected: bool,
    ) -> Result<&[f64], EvalError> {
        problem.rhs(step.t + step.h, y_new, &mut self.f_new)?;
        Ok(&self.f_new)
    }

    fn accept(&mut self, step: Step<'_>, weights: &Weights, y_new: &[f64]) {
        // Φ₀(n + 1) = f, Φⱼ₊₁(n + 1) = Φⱼ(n + 1) − βⱼ Φⱼ(n).
        let n = y_new.len();
        self.depth = (self.depth + 1).min(self.k + 2).min(MOST + 1);
        self.top.copy_from_slice(&self.f_new);
        for (phi, beta) in self
            .differences
            .chunks_exact_mut(n.max(1))
            .zip(self.beta)
            .take(self.depth)
        {
            for (old, new) in phi.iter_mut().zip(&mut self.top) {
                (*old, *new) = (*new, *new - beta * *old);
            }
        }
        for j in (1..self.depth).rev() {
            self.back[j] = self.back[j - 1] + step.h;
        }
        self.inverse = self.inverse_new;
        self.failures = 0;
        self.defect_ready = false;
        (self.next_k, self.next_error) = self.choose_order(step, weights, y_new);
    }

    fn derivative(&self) -> &[f64] {
        &self.differences[..self.f_new.len()]
    }

    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        let best = |error: f64, k: usize| (AIM / error.max(1e-14)).powf(1.0 / (k + 1) as f64);
        if error > 1.0 {
            self.starting = false;
            self.failures += 1;
            if self.failures > 2 {
                // The history misleads.
                (self.next_k, self.depth) = (1, 1);
            } else if self.k > 1 && self.errors[1] <= error {
                self.next_k = self.k - 1;
            }
            return h * best(error, self.k).clamp(0.25, 0.9);
        }
        match best(self.next_error, self.next_k) {
            _ if self.starting => 2.0 * h,
            // Small changes are not worth the rougher history.
            factor if (0.95..1.1).contains(&factor) => h,
            factor => h * factor.clamp(0.5, 2.0),
        }
    }

    fn interpolate(
        &mut self,
        _problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        theta: f64,
        y: &mut [f64],
    ) -> Result<(), EvalError> {
        if !self.defect_ready {
            let mut start = std::mem::take(&mut self.defect);
            start.copy_from_slice(y_new);
            self.continue_by(-step.h, &mut start);
            start.iter_mut().zip(step.y).for_each(|(start, y)| *start = y - *start);
            self.defect = start;
            self.defect_ready = true;
        }
        y.copy_from_slice(y_new);
        self.continue_by((theta - 1.0) * step.h, y);
        // The defect, of the size of the error, is faded out toward the end: y is continuous, its derivative too.
        let fade = (1.0 - theta) * (1.0 - theta) * (1.0 + 2.0 * theta);
        y.iter_mut()
            .zip(&self.defect)
            .for_each(|(y, defect)| *y += fade * defect);
        Ok(())
    }

    fn is_multistep(&self) -> bool {
        true
    }
}
