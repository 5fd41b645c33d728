//! What a step of Adams' method needs of the times of the last points.

use super::DEPTH;
use crate::lanes::Lanes;

/// Nodes below ½ and weights of Gauss' quadrature on [0, 1], of degree 15: exact for all the integrals here. The other nodes lie
/// symmetrically.
const NODES: Lanes = Lanes([
    0.4082826787521751,
    0.2372337950418355,
    0.10166676129318663,
    0.019855071751231884,
]);
const GAUSS: Lanes = Lanes([
    0.181341891689181,
    0.15685332293894364,
    0.11119051722668724,
    0.05061426814518813,
]);

/// Times of the last points, relative to the newest.
#[derive(Debug, Clone, Default)]
pub(super) struct Past {
    /// tₙ − tₙ₋ⱼ.
    back: [f64; DEPTH],
    /// 1 / (tₙ − tₙ₋ⱼ), j > 0.
    inverse: [f64; DEPTH + 1],
    /// The last step, and how many before it were exactly as long.
    last: f64,
    repeats: usize,
}

/// βⱼ, gⱼ and 1 / (tₙ₊₁ − tₙ₊₁₋ⱼ) for a step from tₙ to tₙ₊₁ = tₙ + h.
#[derive(Debug, Clone, Default)]
pub(super) struct Coefficients {
    pub(super) beta: [f64; DEPTH + 1],
    pub(super) g: [f64; DEPTH + 1],
    inverse: [f64; DEPTH + 1],
    /// Values at the nodes of the polynomials of which gⱼ is the integral, times the weights.
    newton: [[Lanes; 2]; DEPTH + 1],
    /// The step for which this holds, and the highest j for which βⱼ and gⱼ are known.
    h: f64,
    known: usize,
}

impl Coefficients {
    /// gⱼ for j ≤ `count` and βⱼ for j < `count` (Hairer, Nørsett, Wanner I, eq. III.5.9 and III.5.11), where `count` is at most the
    /// number of points that are known.
    ///
    /// gⱼ is the integral over the step of Π (t − tₙ₋ᵢ) / (tₙ₊₁ − tₙ₋ᵢ), i < j, in units of h. By quadrature this is O(k) instead of
    /// the O(k²) of the usual recursion, and free of cancellation.
    pub(super) fn find(&mut self, past: &Past, h: f64, count: usize) {
        // What depends on equal steps only has not changed.
        let kept = if h == self.h {
            self.known.min(past.repeats).min(count)
        } else {
            0
        };
        if kept == 0 {
            (self.beta[0], self.g[0], self.newton[0]) = (1.0, 1.0, [GAUSS; 2]);
        }
        // The divisions first, so that they are made in pairs.
        let new = kept + 1..count + 1;
        for (inverse, back) in self.inverse[new.clone()].iter_mut().zip(&past.back[kept..count]) {
            *inverse = 1.0 / (h + back);
        }
        let (mut newton, mut beta) = (self.newton[kept], self.beta[kept]);
        let from = self.inverse[new.clone()]
            .iter()
            .zip(&past.inverse[new.clone()])
            .zip(&past.back[kept..count]);
        let to = self.newton[new.clone()]
            .iter_mut()
            .zip(&mut self.beta[new.clone()])
            .zip(&mut self.g[new]);
        for (((&inverse, past_inverse), &back), ((newton_j, beta_j), g_j)) in from.zip(to) {
            beta *= (h + back) * past_inverse;
            newton = next_newton(newton, h, back, inverse);
            (*newton_j, *beta_j, *g_j) = (newton, beta, (newton[0] + newton[1]).sum());
        }
        // Of the last j only gⱼ is good: the point before the first does not exist.
        (self.h, self.known) = (h, count - 1);
    }
}

/// From the polynomial of j − 1 factors to that of j factors, at the nodes of the interval [tₙ, tₙ + s].
#[inline(always)]
fn next_newton(newton: [Lanes; 2], s: f64, back: f64, inverse: f64) -> [Lanes; 2] {
    let (start, end) = (back * inverse, (s + back) * inverse);
    let rise = (s * inverse) * NODES;
    [
        newton[0] * rise.map(|rise| start + rise),
        newton[1] * rise.map(|rise| end - rise),
    ]
}

impl Past {
    /// Forgets everything.
    pub(super) fn clear(&mut self, coefficients: &mut Coefficients) {
        (self.last, self.repeats) = (0.0, 0);
        (coefficients.h, coefficients.known) = (0.0, 0);
    }

    /// After a step of length `h` with these coefficients: tₙ₊₁ is the newest of `depth` points.
    pub(super) fn step(&mut self, h: f64, coefficients: &Coefficients, depth: usize) {
        for j in (1..depth).rev() {
            self.back[j] = self.back[j - 1] + h;
        }
        self.inverse = coefficients.inverse;
        self.repeats = if h == self.last { self.repeats + 1 } else { 0 };
        self.last = h;
    }

    /// Factors of Φⱼ, j < `count`, in the integral from tₙ to tₙ + s of the polynomial through the newest derivatives.
    pub(super) fn integrals(&self, s: f64, count: usize) -> [f64; DEPTH] {
        let mut newton = [GAUSS; 2];
        let mut integrals = [s; DEPTH];
        for (j, integral) in integrals.iter_mut().enumerate().take(count).skip(1) {
            newton = next_newton(newton, s, self.back[j - 1], self.inverse[j]);
            *integral = s * (newton[0] + newton[1]).sum();
        }
        integrals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// gⱼ by the recursion of Hairer, Nørsett, Wanner I, eq. III.5.11-13.
    fn recursion(h: f64, back: &[f64], count: usize) -> Vec<f64> {
        let mut c: Vec<f64> = (0..=count).map(|q| 1.0 / (q + 1) as f64).collect();
        let mut g = vec![c[0]];
        for j in 1..=count {
            for q in 0..=count - j {
                c[q] -= h / (h + back[j - 1]) * c[q + 1];
            }
            g.push(c[0]);
        }
        g
    }

    /// The coefficients of Adams and Bashforth: equal steps (Hairer, Nørsett, Wanner I, table III.1.1).
    #[test]
    fn equal_steps() {
        let (mut past, mut coefficients) = (Past::default(), Coefficients::default());
        for depth in 1..=9 {
            coefficients.find(&past, 0.5, depth);
            past.step(0.5, &coefficients, depth + 1);
        }
        let (beta, g) = (&coefficients.beta, &coefficients.g);
        let table = [
            1.0,
            1.0 / 2.0,
            5.0 / 12.0,
            3.0 / 8.0,
            251.0 / 720.0,
            95.0 / 288.0,
            19087.0 / 60480.0,
            5257.0 / 17280.0,
            1070017.0 / 3628800.0,
        ];
        for (j, expected) in table.into_iter().enumerate() {
            assert!((g[j] - expected).abs() < 4.0 * f64::EPSILON, "{j}: {}", g[j]);
            assert!((beta[j] - 1.0).abs() < 20.0 * f64::EPSILON, "{j}: {}", beta[j]);
        }
    }

    /// Steps of many lengths, with repetitions: as the recursion, and as if found anew.
    #[test]
    fn coefficients() {
        let (mut past, mut running) = (Past::default(), Coefficients::default());
        let (mut depth, mut h) = (1, 0.1);
        let mut times = vec![0.0];
        for step in 0..400_usize {
            match step % 37 {
                3 | 20 => h *= 1.7,
                12 => h *= 0.5,
                25 => h *= 0.9,
                30 if step % 2 == 0 => h *= -1.0,
                _ => {}
            }
            if step % 111 == 110 || h * past.last < 0.0 {
                past.clear(&mut running);
                (depth, times) = (1, vec![0.0]);
            }
            let count = depth.min(1 + step % 23).max(1);
            running.find(&past, h, count);
            let mut fresh = Coefficients::default();
            fresh.find(&past, h, count);
            let back: Vec<f64> = times.iter().rev().map(|t| times[times.len() - 1] - t).collect();
            let expected = recursion(h, &back, count);
            let mut beta = 1.0;
            for j in 0..=count {
                assert_eq!(running.g[j], fresh.g[j]);
                assert!((running.g[j] - expected[j]).abs() < 1e-14);
                if j < count {
                    assert_eq!(running.beta[j], fresh.beta[j]);
                    assert!(
                        (running.beta[j] - beta).abs() < 1e-11 * beta,
                        "{} {beta}",
                        running.beta[j]
                    );
                    beta *= (h + back[j]) / back.get(j + 1).unwrap_or(&f64::NAN);
                }
            }
            depth = (depth + 1).min(count + 1).min(DEPTH);
            past.step(h, &running, depth);
            times.push(times[times.len() - 1] + h);
        }
    }
}
