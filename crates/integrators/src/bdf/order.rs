//! The formulas of each order, and the choice of order and step.

use super::history::MOST;

/// What tells one order from another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Formula {
    /// γ: the formula is h f = h times the slope of the prediction + γ times what the prediction misses.
    pub gamma: f64,
    /// Part of h^(k+1) times the derivative of that order which a step with equal steps before it counts as its error.
    pub error: f64,
}

/// κ of the numerical differentiation formulas: a smaller error at the orders where stability is untouched or nearly so (Shampine and
/// Reichelt 1997, table 1).
const KAPPA: [f64; MOST + 1] = [0.0, -0.1850, -1.0 / 9.0, -0.0823, -0.0415, 0.0];

impl Formula {
    /// Of order k, 1 ≤ k ≤ 5.
    pub(super) fn of(k: usize) -> Self {
        let sum: f64 = (1..=k).map(|j| 1.0 / j as f64).sum();
        Self {
            gamma: (1.0 - KAPPA[k]) * sum,
            error: KAPPA[k] * sum + 1.0 / (k + 1) as f64,
        }
    }
}

/// Part of the tolerance that the next step aims at.
const AIM: f64 = 0.5;

/// Growth below this is not worth the rougher history.
const LEAST_GROWTH: f64 = 1.2;

/// Most growth after as many equal steps as the order needs; and from step to step at the start.
const MOST_GROWTH: f64 = 4.0;
const GROWTH_AT_START: f64 = 2.0;

/// Another order must promise a step longer by this factor.
const WORTH_ANOTHER_ORDER: f64 = 1.1;

/// Norms, in tolerances, of h^j times the j-th derivative for j = k + 1, k, k − 1, k + 2 as a step of order k has them.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Derivatives {
    pub own: f64,
    pub lower: f64,
    pub lowest: f64,
    pub higher: f64,
}

/// Order and step from accepted and refused attempts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Orders {
    /// Of this attempt, and of the next.
    pub k: usize,
    pub next: usize,
    most: usize,
    /// Steps of this order and length so far.
    steady: usize,
    last_h: f64,
    /// Order and step still rise with every step.
    starting: bool,
    /// Attempts of this step refused because of their error.
    failures: u32,
    /// By what factor the next step is to be longer.
    factor: f64,
}

impl Orders {
    pub(super) fn new(most: usize) -> Self {
        Self {
            k: 1,
            next: 1,
            most,
            steady: 0,
            last_h: 0.0,
            starting: true,
            failures: 0,
            factor: 1.0,
        }
    }

    /// Decides after a step of length `h` that was accepted.
    pub(super) fn after_accepted(&mut self, h: f64, derivatives: &Derivatives) {
        // Lengths differ by rounding of t + h.
        let same = self.next == self.k && (h - self.last_h).abs() <= 1e-6 * h.abs();
        self.steady = if same { self.steady + 1 } else { 1 };
        (self.last_h, self.failures) = (h, 0);
        (self.next, self.factor) = self.choose(derivatives);
        if self.next != self.k {
            self.steady = 0;
        }
    }

    fn choose(&mut self, &Derivatives { own, lower, lowest, higher }: &Derivatives) -> (usize, f64) {
        let k = self.k;
        let factor = |k: usize, derivative: f64| growth(Formula::of(k).error * derivative, k);
        if self.starting && k < self.most && (k == 1 || lower > own) {
            return (k + 1, GROWTH_AT_START);
        }
        if self.starting && k == self.most && factor(k, own) >= GROWTH_AT_START && lower > own {
            return (k, GROWTH_AT_START);
        }
        self.starting = false;
        // Derivatives that rise with their order: what is seen is not smooth, or the formula is not stable here (Skelboe 1977).
        if (k > 2 && lower.max(lowest) <= own) || (k == 2 && lower <= 0.5 * own) {
            return (k - 1, worth(factor(k - 1, lower).min(1.0)));
        }
        let same = factor(k, own);
        if self.steady <= k {
            return (k, worth(same.min(1.0)));
        }
        let mut best = (k, same);
        if k > 1 {
            let factor = factor(k - 1, lower);
            if factor > WORTH_ANOTHER_ORDER * best.1 {
                best = (k - 1, factor);
            }
        }
        if k < self.most && higher < own {
            let factor = factor(k + 1, higher);
            if factor > WORTH_ANOTHER_ORDER * best.1.max(same) {
                best = (k + 1, factor);
            }
        }
        (best.0, worth(best.1))
    }

    /// Decides after an attempt whose error is above 1; returns the factor of its length.
    pub(super) fn after_refused(&mut self, error: f64, derivatives: &Derivatives) -> f64 {
        self.starting = false;
        self.failures += 1;
        let k = self.k;
        self.steady = 0;
        match self.failures {
            1 => {
                let own = growth(error, k);
                let lower = growth(Formula::of(k.max(2) - 1).error * derivatives.lower, k.max(2) - 1);
                if k > 1 && lower > own {
                    self.next = k - 1;
                }
                (0.9 * own.max(if k > 1 { lower } else { 0.0 })).clamp(0.25, 0.9)
            }
            2 => 0.25,
            _ => {
                // The history misleads.
                self.next = 1;
                0.25
            }
        }
    }

    /// The factor of the next step after an accepted one.
    pub(super) fn factor(&self) -> f64 {
        self.factor
    }
}

/// By what factor a step of order `k` with this error may be longer.
fn growth(error: f64, k: usize) -> f64 {
    (AIM / error.max(1e-10)).powf(1.0 / (k + 1) as f64)
}

/// The factor if it is worth a change.
fn worth(factor: f64) -> f64 {
    match factor {
        factor if factor >= LEAST_GROWTH => factor.min(MOST_GROWTH),
        factor if factor < 1.0 => factor.clamp(0.5, 0.9),
        _ => 1.0,
    }
}
