//! The past of a run: modified divided differences on the steps as they were, and the polynomials through it.

/// Highest order that is stable for stiff decay at small steps.
pub(super) const MOST: usize = 5;

/// Differences that are kept: of orders 0 to k + 1.
const DIFFERENCES: usize = MOST + 2;

/// What a step of length h makes of the past (Brenan, Campbell, Petzold 1996, 5.2.1, counted from 0).
///
/// Distances back from the new point are dᵢ, from the newest one before it d̄ᵢ.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Coefficients {
    /// βᵢ = Π dⱼ / d̄ⱼ, 1 ≤ j ≤ i: takes φᵢ along to the new point.
    beta: [f64; DIFFERENCES],
    /// Σ h / dⱼ, 1 ≤ j ≤ i: h times the slope of the i-th polynomial of Newton at the new point.
    pub slope: [f64; DIFFERENCES + 1],
    /// i! Π h / dⱼ, 1 ≤ j ≤ i: makes h^i times the i-th derivative of φᵢ; 1 for equal steps.
    pub scale: [f64; DIFFERENCES + 1],
}

/// The differences φᵢ at the newest point, and those at the point before it or after it.
#[derive(Debug, Clone, Default)]
pub(super) struct History {
    phi: [Vec<f64>; DIFFERENCES],
    other: [Vec<f64>; DIFFERENCES],
    /// Distances d̄ᵢ from the newest point back to the one i steps before, signed like the step; those of the other point.
    distances: [f64; DIFFERENCES + 1],
    other_distances: [f64; DIFFERENCES + 1],
    /// How many of them are known; what lies further back is a guess that nothing depends on.
    pub known: usize,
    pub coefficients: Coefficients,
}

impl History {
    /// For states of `dim` components.
    pub(super) fn new(dim: usize) -> Self {
        Self {
            phi: std::array::from_fn(|_| vec![0.0; dim]),
            other: std::array::from_fn(|_| vec![0.0; dim]),
            ..Self::default()
        }
    }

    /// Forgets all but one state.
    pub(super) fn start(&mut self, y: &[f64]) {
        self.phi[0].copy_from_slice(y);
        self.known = 0;
    }

    /// Prepares a step of length `h`. Before the first one the past is the tangent of slope `f`.
    pub(super) fn prepare(&mut self, h: f64, f: &[f64]) {
        if self.known == 0 {
            self.phi[1].iter_mut().zip(f).for_each(|(phi, f)| *phi = h * f);
            self.phi[2..].iter_mut().for_each(|phi| phi.fill(0.0));
            self.distances = std::array::from_fn(|i| i as f64 * h);
        }
        let Coefficients { beta, slope, scale } = &mut self.coefficients;
        (beta[0], slope[0], scale[0]) = (1.0, 0.0, 1.0);
        for i in 1..=DIFFERENCES {
            let distance = h + self.distances[i - 1];
            if let Some(beta_before) = beta.get(i - 1).copied()
                && i < DIFFERENCES
            {
                beta[i] = beta_before * distance / self.distances[i];
            }
            slope[i] = slope[i - 1] + h / distance;
            scale[i] = scale[i - 1] * i as f64 * h / distance;
        }
    }

    /// Writes the polynomial of order `k` at the new point, and h times its slope there.
    pub(super) fn predict(&self, k: usize, y: &mut [f64], rate: &mut [f64]) {
        y.fill(0.0);
        rate.fill(0.0);
        let Coefficients { beta, slope, .. } = &self.coefficients;
        // Backward, so that small terms come first.
        for i in (1..=k).rev() {
            for ((y, rate), phi) in y.iter_mut().zip(&mut *rate).zip(&self.phi[i]) {
                let term = beta[i] * phi;
                *y += term;
                *rate += slope[i] * term;
            }
        }
        y.iter_mut().zip(&self.phi[0]).for_each(|(y, start)| *y += start);
    }

    /// Writes the differences of orders k, k − 1 and k + 2 at the new point, where that of order k + 1 is `miss`.
    ///
    /// That of order k + 2 needs two steps of order k, that of order k − 1 k ≥ 2; they are of no use otherwise.
    pub(super) fn differences(&self, k: usize, miss: &[f64], [lower, lowest, higher]: [&mut [f64]; 3]) {
        let (below, beta) = (k.saturating_sub(1), &self.coefficients.beta);
        for (i, &miss) in miss.iter().enumerate() {
            lower[i] = miss + beta[k] * self.phi[k][i];
            lowest[i] = lower[i] + beta[below] * self.phi[below][i];
            higher[i] = miss - beta[k + 1] * self.phi[k + 1][i];
        }
    }

    /// Makes the new point the newest: `y` there, and by how much the prediction of order `k` missed it.
    pub(super) fn step(&mut self, h: f64, k: usize, y: &[f64], miss: &[f64]) {
        self.other[k + 1].copy_from_slice(miss);
        for i in (1..=k).rev() {
            let (new, above) = self.other.split_at_mut(i + 1);
            for ((new, above), phi) in new[i].iter_mut().zip(&above[0]).zip(&self.phi[i]) {
                *new = above + self.coefficients.beta[i] * phi;
            }
        }
        self.other[0].copy_from_slice(y);
        self.other[k + 2..].iter_mut().for_each(|phi| phi.fill(0.0));
        self.other_distances = std::array::from_fn(|i| if i == 0 { 0.0 } else { h + self.distances[i - 1] });
        self.swap();
        self.known += 1;
    }

    /// Undoes the last [`step`](History::step).
    pub(super) fn back(&mut self) {
        self.swap();
        self.known -= 1;
    }

    fn swap(&mut self) {
        std::mem::swap(&mut self.phi, &mut self.other);
        std::mem::swap(&mut self.distances, &mut self.other_distances);
    }

    /// Writes the polynomial of order `k` through the newest states at the distance `s` from the newest one, which is `newest`.
    pub(super) fn interpolate(&self, k: usize, s: f64, newest: &[f64], y: &mut [f64]) {
        y.copy_from_slice(newest);
        let mut factor = 1.0;
        for i in 1..=k {
            factor *= (s + self.distances[i - 1]) / self.distances[i];
            y.iter_mut().zip(&self.phi[i]).for_each(|(y, phi)| *y += factor * phi);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polynomial of degree 5, its slope and its derivatives up to the seventh.
    fn quintic(t: f64) -> (f64, f64) {
        let c = [0.3, -1.2, 0.7, 0.4, -0.25, 0.11];
        let value = c.iter().rev().fold(0.0, |sum, c| sum * t + c);
        let slope = (1..6).rev().fold(0.0, |sum, i| sum * t + i as f64 * c[i]);
        (value, slope)
    }

    /// History of exact states at these times, each step of the order that the number of states allows.
    fn exact(times: &[f64]) -> History {
        let mut history = History::new(1);
        let (y, f) = quintic(times[0]);
        history.start(&[y]);
        let (mut predicted, mut rate) = ([0.0], [0.0]);
        for (n, pair) in times.windows(2).enumerate() {
            let (h, k) = (pair[1] - pair[0], (n + 1).min(MOST));
            history.prepare(h, &[f]);
            history.predict(k, &mut predicted, &mut rate);
            let y = quintic(pair[1]).0;
            history.step(h, k, &[y], &[y - predicted[0]]);
        }
        history
    }

    const TIMES: [f64; 9] = [0.0, 0.1, 0.25, 0.3, 0.5, 0.52, 0.8, 1.0, 1.3];

    #[test]
    fn polynomials_of_degree_5_are_met_on_any_steps() {
        for mirror in [1.0, -1.0] {
            let mut history = exact(&TIMES.map(|t| mirror * t));
            let (mut y, mut rate) = ([0.0], [0.0]);
            for h in [0.3, 0.01, 1.0].map(|h| mirror * h) {
                history.prepare(h, &[f64::NAN]);
                history.predict(5, &mut y, &mut rate);
                let (value, slope) = quintic(mirror * 1.3 + h);
                assert!((y[0] - value).abs() < 1e-11, "{h}: {} {value}", y[0]);
                assert!((rate[0] - h * slope).abs() < 1e-11, "{h}: {} {slope}", rate[0] / h);
                // The fifth derivative is 5! · 0.11, in whatever way it is scaled; there is no sixth one.
                let mut found = [[0.0], [0.0], [0.0]];
                let [lower, lowest, higher] = &mut found;
                history.differences(5, &[0.0], [lower, lowest, higher]);
                let scaled = history.coefficients.scale[5] * lower[0];
                assert!(
                    (scaled / h.powi(5) - 13.2).abs() < 1e-6 / h.abs().powi(5).min(1.0),
                    "{scaled}"
                );
                // Rounding of the past grows by β₆, more than a hundred for the longest step.
                assert!(higher[0].abs() < 1e-10, "{h}: {}", higher[0]);
            }
            for s in [0.0, -0.1, -0.3, -0.5].map(|s| mirror * s) {
                history.interpolate(5, s, &[quintic(mirror * 1.3).0], &mut y);
                assert!((y[0] - quintic(mirror * 1.3 + s).0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_step_can_be_undone() {
        let (mut history, mut y, mut rate) = (exact(&TIMES), [0.0], [0.0]);
        let mut values = || {
            history.prepare(0.2, &[0.0]);
            history.predict(5, &mut y, &mut rate);
            history.step(0.2, 5, &[7.0], &[7.0 - y[0]]);
            history.back();
            [y[0].to_bits(), rate[0].to_bits(), history.known as u64]
        };
        assert_eq!(values(), values());
    }

    /// Equal steps: the coefficients of the book.
    #[test]
    fn equal_steps() {
        let mut history = exact(&std::array::from_fn::<f64, 8, _>(|i| i as f64));
        history.prepare(1.0, &[0.0]);
        let Coefficients { beta, slope, scale } = history.coefficients;
        let mut sum = 0.0;
        for i in 1..DIFFERENCES {
            sum += 1.0 / i as f64;
            assert!((beta[i] - 1.0).abs() < 1e-14 && (scale[i] - 1.0).abs() < 1e-14 && (slope[i] - sum).abs() < 1e-14);
        }
    }
}
