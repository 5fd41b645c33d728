//! The method of Adams with variable order and variable step.

mod coefficients;

use crate::lanes::{LANES, Lanes, blocks};
use crate::{Counted, EvalError, Method, Ode, SettingsError, Step, Weights};
use coefficients::{Coefficients, Past};

/// Highest order of the predictor.
const MOST: usize = 12;

/// Most differences that are kept.
const DEPTH: usize = MOST + 1;

/// Part of the tolerance that the next step aims at. Found by trial: ½, the value of STEP, throws more steps away than it saves.
const AIM: f64 = 0.25;

/// Growth of a step between these bounds is not worth the rougher history.
const LEAST_SHRINKING: f64 = 0.95;
const LEAST_GROWTH: f64 = 1.1;

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
    dim: usize,
    inverse_dim: f64,
    /// Errors are taken for so many times what they are.
    strictness: f64,
    /// Order k of the predictor in this attempt, and in the next.
    k: usize,
    next_k: usize,
    /// How many Φⱼ exist.
    depth: usize,
    /// Order and step still rise with every step.
    starting: bool,
    /// `depth`, `starting` and `past` as they were before the last step.
    before: (usize, bool, Past),
    /// Attempts refused since the last step.
    failures: u32,
    past: Past,
    coefficients: Coefficients,
    /// The differences at the newest point, and at the end of the attempt, block after block of components.
    blocks: Vec<Block>,
    blocks_new: Vec<Block>,
    /// Start and prediction of the attempt, f at the state reached and in the attempt: all filled up to full blocks.
    y: Vec<f64>,
    predicted: Vec<f64>,
    f: Vec<f64>,
    f_new: Vec<f64>,
    /// Squared norms (roots are costly) of the error had this step been made with order k, k − 1, k − 2.
    squares: [f64; 3],
    /// Squared norm of the error expected at `next_k` with an unchanged step.
    next_square: f64,
    /// By how much the polynomial of the last step misses its beginning, once it is asked for.
    defect: Vec<f64>,
    defect_ready: bool,
}

/// The differences of four components at one point: Φⱼ = `tails[j]` + `highest`.
///
/// With Φₖ₊₁ = f − Σ βᵢ Φᵢ at the point before, i ≤ k, the differences are Φⱼ = Φₖ₊₁ + Σ βᵢ Φᵢ, j ≤ i ≤ k. Only Φₖ₊₁ depends on f: the
/// sums are formed together with the prediction, and no further pass over the differences is needed when f is known.
#[derive(Debug, Clone, Default)]
struct Block {
    /// Σ βᵢ Φᵢ at the point before, j ≤ i ≤ k.
    tails: [Lanes; DEPTH + 1],
    /// Φₖ₊₁.
    highest: Lanes,
    /// 1 / tolerance.
    inverse_scale: Lanes,
}

impl Default for Adams {
    fn default() -> Self {
        Self {
            dim: 0,
            inverse_dim: 1.0,
            strictness: 1.0,
            k: 1,
            next_k: 1,
            depth: 1,
            starting: true,
            before: (1, true, Past::default()),
            failures: 0,
            past: Past::default(),
            coefficients: Coefficients::default(),
            blocks: Vec::new(),
            blocks_new: Vec::new(),
            y: Vec::new(),
            predicted: Vec::new(),
            f: Vec::new(),
            f_new: Vec::new(),
            squares: [0.0; 3],
            next_square: 1.0,
            defect: Vec::new(),
            defect_ready: false,
        }
    }
}

impl Adams {
    /// y + ∫ of the polynomial through the newest derivatives, from the newest point to a distance `s` from it.
    fn continue_by(&self, s: f64, y: &mut [f64]) {
        let count = self.depth.min(self.k + 1);
        let integrals = self.past.integrals(s, count);
        for (block, y) in self.blocks.iter().zip(y.chunks_mut(LANES)) {
            let mut change = Lanes::ZERO;
            for (&tail, &integral) in block.tails.iter().zip(&integrals[..count]) {
                change += integral * (tail + block.highest);
            }
            (Lanes::load(y) + change).store(y);
        }
    }

    /// Predicts y + h Σ gⱼ βⱼ Φⱼ(n), j < k.
    fn predict(&mut self, h: f64) {
        let k = self.k;
        let (beta, g) = (&self.coefficients.beta[..k], &self.coefficients.g[..k]);
        // Φₖ(n) exists only if so many points are known.
        let beta_k = if self.depth > k { self.coefficients.beta[k] } else { 0.0 };
        let states = self.y.as_chunks().0.iter().zip(self.predicted.as_chunks_mut().0);
        let blocks = self.blocks.iter().zip(&mut self.blocks_new);
        for ((block, new), (&y, predicted)) in blocks.zip(states) {
            let mut sum = beta_k * (block.tails[k] + block.highest);
            let mut integral = Lanes::ZERO;
            (new.tails[k], new.tails[k + 1]) = (sum, Lanes::ZERO);
            let tails = block.tails[..k].iter().zip(&mut new.tails[..k]);
            // Backward, so that small terms come first.
            for (((&tail, tail_new), &beta), &g) in tails.zip(beta).zip(g).rev() {
                let term = beta * (tail + block.highest);
                sum += term;
                integral += g * term;
                *tail_new = sum;
            }
            *predicted = (Lanes(y) + h * integral).0;
        }
    }

    /// Corrects the prediction with f there, and estimates the errors at the orders k, k − 1 and k − 2.
    fn correct(&mut self, h: f64, weights: &Weights, y_new: &mut [f64], error: &mut [f64]) {
        let (k, g) = (self.k, &self.coefficients.g);
        // With k = 1 the lower orders do not exist; what is computed for them is not used.
        let (below, lowest) = (k - 1, k.saturating_sub(2));
        let (integral, miss) = (h * g[k], h * (g[k] - g[k - 1]));
        let mut sums = [Lanes::ZERO; 3];
        let blocks = self.blocks_new.iter_mut().zip(weights.scales());
        let states = self.y.as_chunks().0.iter().zip(self.predicted.as_chunks().0);
        let results = y_new.chunks_mut(LANES).zip(error.chunks_mut(LANES));
        let all = blocks.zip(states).zip(self.f_new.as_chunks().0).zip(results);
        for ((((block, scale), (&y, &predicted)), &f), (y_new, error)) in all {
            // The differences had the step been closed with this f.
            let highest = Lanes(f) - block.tails[0];
            let phi_k = block.tails[k] + highest;
            let corrected = Lanes(predicted) + integral * phi_k;
            corrected.store(y_new);
            (miss * phi_k).store(error);
            let inverse_scale = scale.inverse(Lanes(y), corrected);
            block.inverse_scale = inverse_scale;
            sums[0] += (inverse_scale * phi_k).squared();
            sums[1] += (inverse_scale * (block.tails[below] + highest)).squared();
            sums[2] += (inverse_scale * (block.tails[lowest] + highest)).squared();
        }
        self.squares = std::array::from_fn(|m| {
            if m < k {
                self.squared_error(h, k - m, weights.mean(sums[m]))
            } else {
                0.0
            }
        });
    }

    /// Makes the end of the attempt the newest point; returns the mean square of its Φₖ₊₁.
    fn update(&mut self) -> f64 {
        std::mem::swap(&mut self.f, &mut self.f_new);
        std::mem::swap(&mut self.blocks, &mut self.blocks_new);
        let mut square = Lanes::ZERO;
        for (block, &f) in self.blocks.iter_mut().zip(self.f.as_chunks().0) {
            block.highest = Lanes(f) - block.tails[0];
            square += (block.inverse_scale * block.highest).squared();
        }
        square.sum() * self.inverse_dim
    }

    /// Squared error of a step of order k, from the mean square of its Φₖ: h (gₖ − gₖ₋₁) Φₖ.
    fn squared_error(&self, h: f64, k: usize, mean_square: f64) -> f64 {
        let miss = self.strictness * h * (self.coefficients.g[k] - self.coefficients.g[k - 1]);
        miss * miss * mean_square
    }

    /// Order of the next step after an accepted one, and the squared error to expect of it (Shampine and Gordon, chapter 7).
    ///
    /// `mean_square` is that of the highest difference.
    fn choose_order(&mut self, h: f64, mean_square: f64) -> (usize, f64) {
        let (k, [own, lower, lowest]) = (self.k, self.squares);
        if self.starting && k < MOST && (k == 1 || lower > own) {
            return (k + 1, own);
        }
        self.starting = false;
        // Order 1 and 2 are exchanged only if this halves the error.
        let half = 0.25 * own;
        if (k > 2 && lower.max(lowest) <= own) || (k == 2 && lower <= half) {
            return (k - 1, lower);
        }
        if k == MOST || self.depth < k + 2 {
            return (k, own);
        }
        // The highest difference is Φₖ₊₁.
        let higher = self.squared_error(h, k + 1, mean_square);
        match k {
            1 if higher < half => (2, higher),
            2.. if lower <= own.min(higher) => (k - 1, lower),
            2.. if higher < own => (k + 1, higher),
            _ => (k, own),
        }
    }

    /// Makes steps for tolerances smaller by this factor than those that are given.
    pub(crate) fn set_strictness(&mut self, factor: f64) {
        self.strictness = factor;
    }

    /// f at the end of the attempt: at the prediction before it is closed, at the state reached afterwards.
    pub(crate) fn rate_at_end(&self) -> &[f64] {
        &self.f_new[..self.dim]
    }

    /// How much f has changed from the prediction, where it was this, to `y_new`, by how much the state has: both in tolerances.
    pub(crate) fn sensitivity(&self, at_prediction: &[f64], y_new: &[f64]) -> f64 {
        let scales = self.blocks_new.iter().map(|block| block.inverse_scale);
        let states = y_new.chunks(LANES).zip(self.predicted.chunks(LANES));
        let rates = self.f_new.chunks(LANES).zip(at_prediction.chunks(LANES));
        let (mut change, mut cause) = (Lanes::ZERO, Lanes::ZERO);
        for ((scale, (y, predicted)), (f, before)) in scales.zip(states).zip(rates) {
            change += (scale * (Lanes::load(f) - Lanes::load(before))).squared();
            cause += (scale * (Lanes::load(y) - Lanes::load(predicted))).squared();
        }
        let (change, cause) = (change.sum(), cause.sum());
        if cause > 0.0 { (change / cause).sqrt() } else { 0.0 }
    }

    /// Forgets all but the newest point.
    fn forget(&mut self) {
        (self.next_k, self.depth) = (1, 1);
        self.past.clear(&mut self.coefficients);
    }
}

/// (x²)^(1/2n), but 1 without much work where it lies between `LEAST_SHRINKING` and `LEAST_GROWTH`.
fn factor(x_squared: f64, n: usize) -> f64 {
    const fn squared_powers(x: f64) -> [f64; MOST + 2] {
        let mut powers = [1.0; MOST + 2];
        let mut n = 1;
        while n < powers.len() {
            powers[n] = x * x * powers[n - 1];
            n += 1;
        }
        powers
    }
    const SHRINKING: [f64; MOST + 2] = squared_powers(LEAST_SHRINKING);
    const GROWTH: [f64; MOST + 2] = squared_powers(LEAST_GROWTH);
    if (SHRINKING[n]..GROWTH[n]).contains(&x_squared) {
        1.0
    } else {
        x_squared.powf(0.5 / n as f64)
    }
}

impl<P: Ode + ?Sized> Method<P> for Adams {
    fn order(&self) -> u32 {
        self.k as u32
    }

    fn prepare(&mut self, problem: &P) -> Result<(), SettingsError> {
        let n = problem.dim();
        let blocks = blocks(n);
        (self.dim, self.inverse_dim) = (n, 1.0 / n.max(1) as f64);
        self.blocks = vec![Block::default(); blocks];
        self.blocks_new = self.blocks.clone();
        for vector in [&mut self.y, &mut self.predicted, &mut self.f, &mut self.f_new] {
            *vector = vec![0.0; LANES * blocks];
        }
        self.defect = vec![0.0; n];
        Ok(())
    }

    fn restart(&mut self, problem: &mut Counted<'_, P>, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.forget();
        (self.k, self.starting, self.failures) = (1, true, 0);
        problem.rhs(t, y, &mut self.f[..self.dim])?;
        for (block, &f) in self.blocks.iter_mut().zip(self.f.as_chunks().0) {
            (block.tails[0], block.highest) = (Lanes::ZERO, Lanes(f));
        }
        Ok(())
    }

    fn attempt(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        weights: &Weights,
        y_new: &mut [f64],
        error: &mut [f64],
    ) -> Result<f64, EvalError> {
        let n = self.dim;
        self.k = self.next_k;
        self.coefficients.find(&self.past, step.h, self.depth.min(self.k + 1));
        self.y[..n].copy_from_slice(step.y);
        self.predict(step.h);
        problem.rhs(step.t + step.h, &self.predicted[..n], &mut self.f_new[..n])?;
        self.correct(step.h, weights, y_new, error);
        Ok(self.squares[0].sqrt())
    }

    fn close(
        &mut self,
        problem: &mut Counted<'_, P>,
        step: Step<'_>,
        y_new: &[f64],
        _projected: bool,
    ) -> Result<&[f64], EvalError> {
        let f_new = &mut self.f_new[..self.dim];
        problem.rhs(step.t + step.h, y_new, f_new)?;
        Ok(f_new)
    }

    fn accept(&mut self, h: f64) {
        self.before = (self.depth, self.starting, self.past.clone());
        self.depth = (self.depth + 1).min(self.k + 2).min(DEPTH);
        let mean_square = self.update();
        self.past.step(h, &self.coefficients, self.depth);
        self.failures = 0;
        self.defect_ready = false;
        (self.next_k, self.next_square) = self.choose_order(h, mean_square);
    }

    fn retreat(&mut self) {
        (self.depth, self.starting, self.past) = self.before.clone();
        self.next_k = self.k;
        std::mem::swap(&mut self.f, &mut self.f_new);
        std::mem::swap(&mut self.blocks, &mut self.blocks_new);
    }

    fn derivative(&self) -> &[f64] {
        &self.f[..self.dim]
    }

    fn next_step(&mut self, h: f64, error: f64) -> f64 {
        let best = |square: f64, k: usize| factor(AIM * AIM / square.max(1e-28), k + 1);
        if error > 1.0 {
            self.starting = false;
            self.failures += 1;
            if self.failures > 2 {
                // The history misleads.
                self.forget();
            } else if self.k > 1 && self.squares[1] <= error * error {
                self.next_k = self.k - 1;
            }
            return h * best(error * error, self.k).clamp(0.25, 0.9);
        }
        if self.starting {
            return 2.0 * h;
        }
        h * best(self.next_square, self.next_k).clamp(0.5, 2.0)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Integration, Progress, Settings};

    /// Five components, so that one block is full and one is not; it stops being smooth now and then, so that steps are refused.
    struct Swing;

    impl Ode for Swing {
        fn dim(&self) -> usize {
            5
        }
        fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
            let kick = if (t / 3.0).fract() < 0.5 { 1.0 } else { 1.1 };
            dy.copy_from_slice(&[y[1], -kick * y[0].sin(), y[3], -4.0 * y[2], t.sin()]);
            Ok(())
        }
    }

    /// Φⱼ(n) = f[tₙ, …, tₙ₋ⱼ] (tₙ − tₙ₋₁) … (tₙ − tₙ₋ⱼ), j < `count`, from divided differences (Hairer, Nørsett, Wanner I, eq. III.5.6);
    /// and the same with all signs alike, of which rounding is a small part.
    fn differences(points: &[(f64, f64)], count: usize) -> Vec<(f64, f64)> {
        let newest = points.len() - 1;
        let back = |j: usize| points[newest].0 - points[newest - j].0;
        let latest = points.iter().rev().take(count);
        let mut divided: Vec<(f64, f64)> = latest.map(|&(_, f)| (f, f.abs())).collect();
        let (mut phi, mut product) = (vec![divided[0]], 1.0);
        for j in 1..count {
            for i in 0..count - j {
                let (gap, (next, next_size)) = (back(i + j) - back(i), divided[i + 1]);
                divided[i] = ((divided[i].0 - next) / gap, (divided[i].1 + next_size) / gap);
            }
            product *= back(j);
            phi.push((divided[0].0 * product, divided[0].1 * product));
        }
        phi
    }

    #[test]
    fn tails_are_differences() {
        let y0 = [1.0, 0.5, 0.0, 2.0, 0.0];
        let settings = Settings::tolerances(1e-8, 1e-8);
        let mut run = Integration::new(Swing, Adams::default(), 0.0, &y0, settings).expect("good settings");
        let (mut points, mut y, mut highest_order) = (Vec::new(), [0.0; 5], 0);
        loop {
            let progress = run.advance(30.0).expect("no singularity");
            let (from, to) = run.last_step();
            let method = run.method();
            if points.is_empty() {
                let mut start = [0.0; 5];
                Swing.rhs(from, &y0, &mut start).expect("never fails");
                points.push((from, start.to_vec()));
            }
            points.push((to, method.f[..5].to_vec()));
            highest_order = highest_order.max(method.k);
            for i in 0..5 {
                let component: Vec<_> = points.iter().map(|(t, f)| (*t, f[i])).collect();
                let block = &method.blocks[i / LANES];
                for (j, (expected, size)) in differences(&component, method.depth).into_iter().enumerate() {
                    let found = (block.tails[j] + block.highest).0[i % LANES];
                    let rounding = 100.0 * f64::EPSILON * size.max(1.0);
                    assert!(
                        (found - expected).abs() < rounding,
                        "{j} at {to}: {found:e}, {expected:e} ± {rounding:e}"
                    );
                }
            }
            // The polynomial begins where the step began, but for the defect of the size of the error.
            run.interpolate(from + 1e-9 * (to - from), &mut y).expect("inside");
            assert!(run.method().defect.iter().all(|defect| defect.abs() < 1e-6));
            if matches!(progress, Progress::Done { .. }) {
                break;
            }
        }
        assert!(highest_order > 8 && run.statistics().rejected > 10);
    }

    #[test]
    fn factors() {
        for n in 2..=MOST + 1 {
            for x in [1e-10, 0.3, 0.9, 1.0, 1.5, 2.0, 7.0, 1e4] {
                let exact = f64::powf(x, 1.0 / n as f64);
                let expected = if (LEAST_SHRINKING..LEAST_GROWTH).contains(&exact) {
                    1.0
                } else {
                    exact
                };
                assert!((factor(x * x, n) - expected).abs() < 1e-13 * expected);
            }
        }
    }
}
