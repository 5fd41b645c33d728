//! The formulas of each order, and the choice of order and step.

/// The errors of steps add up, mostly with one sign, and are counted as so many. Found by trial on the stiff problems of benchmark
/// 05-standard-odes: with 1 a digit is lost, and no work is saved for the same error.
pub(super) const COUNTED: f64 = 4.0;

/// Part of the tolerance that the next step aims at; found there too.
const AIM: f64 = 0.25;

/// Growth below this is not worth new factors and the rougher history.
const LEAST_GROWTH: f64 = 1.2;

/// Most growth after as many equal steps as the order needs; and from step to step at the start.
const MOST_GROWTH: f64 = 4.0;
const GROWTH_AT_START: f64 = 2.0;

/// Another order must promise a step longer by this factor.
const WORTH_ANOTHER_ORDER: f64 = 1.1;

/// The order is raised only where h^j times the j-th derivative falls to this part from j to j + 1, and lowered where it falls to
/// no less than the other one. For a vibration of frequency ω the part is h ω: where that is large, formulas of order 3 and above
/// may not be stable, and where the steps follow a vibration for accuracy it is small. Found by trial on stiff vibrations that are
/// hardly damped; on other problems nothing is lost.
const FALLING: f64 = 0.3;
const NOT_FALLING: f64 = 0.5;

/// γ of the formula of order k: h f = h times the slope of the prediction + γ times what the prediction misses.
pub(super) fn gamma(k: usize) -> f64 {
    (1..=k).map(|j| 1.0 / j as f64).sum()
}

/// Error that is counted for a step of order k after equal steps, where h^(k+1) times the derivative of that order is 1.
fn error_constant(k: usize) -> f64 {
    COUNTED / (k + 1) as f64
}

/// Largest error of the polynomial of order k within a step, likewise: max |s (s + 1) ... (s + k)| / (k + 1)!, −1 ≤ s ≤ 0.
pub(super) const BETWEEN: [f64; 6] = [1.0, 0.125, 0.06415, 0.04167, 0.03026, 0.02347];

/// The norm of h^(k+1) times the derivative of that order that decides on a step of order k, from its norm after the filter and before.
///
/// What the filter takes out is no error of the state reached, but one of interpolation, which does not add up over the steps.
pub(super) fn decisive(k: usize, filtered: f64, plain: f64) -> f64 {
    let between = BETWEEN[k.min(5)] / error_constant(k) * plain;
    // Unlike `f64::max` this keeps what is not a number.
    if between > filtered { between } else { filtered }
}

/// By what factor the next step may differ at order k, where h^(k+1) times the derivative of that order is known, in tolerances.
fn growth(k: usize, derivative: f64) -> f64 {
    (AIM / (error_constant(k) * derivative).max(1e-10)).powf(1.0 / (k + 1) as f64)
}

/// The factor if it is worth a change.
fn worth(factor: f64) -> f64 {
    match factor {
        factor if factor >= LEAST_GROWTH => factor.min(MOST_GROWTH),
        factor if factor < 1.0 => factor.clamp(0.5, 0.9),
        _ => 1.0,
    }
}

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
    /// At a start, with orders up to `most`.
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

    /// The factor of the next step after an accepted one.
    pub(super) fn factor(&self) -> f64 {
        self.factor
    }

    /// Decides after a step of length `h` that was accepted.
    pub(super) fn after_accepted(&mut self, h: f64, derivatives: &Derivatives) {
        // Lengths differ by rounding of t + h.
        let same = (h - self.last_h).abs() <= 1e-6 * h.abs();
        self.steady = if same { self.steady + 1 } else { 1 };
        (self.last_h, self.failures) = (h, 0);
        (self.next, self.factor) = self.choose(derivatives);
        if self.next != self.k {
            self.steady = 0;
        }
    }

    fn choose(&mut self, derivatives: &Derivatives) -> (usize, f64) {
        let k = self.k;
        let &Derivatives {
            own,
            lower,
            lowest,
            higher,
        } = derivatives;
        let falling = k == 1 || own < FALLING * lower;
        let same = growth(k, own);
        if self.starting && falling {
            if k < self.most {
                return (k + 1, GROWTH_AT_START);
            }
            if same >= GROWTH_AT_START {
                return (k, GROWTH_AT_START);
            }
        }
        self.starting = false;
        // Derivatives that do not fall with their order: what is seen is not smooth, or the formula is not stable here (Skelboe 1977).
        if (k > 2 && own >= NOT_FALLING * lower.max(lowest)) || (k == 2 && NOT_FALLING * own >= lower) {
            return (k - 1, worth(growth(k - 1, lower).min(1.0)));
        }
        if self.steady <= k {
            return (k, worth(same.min(1.0)));
        }
        let mut best = (k, same);
        if k > 1 {
            let factor = growth(k - 1, lower);
            if factor > WORTH_ANOTHER_ORDER * best.1 {
                best = (k - 1, factor);
            }
        }
        if k < self.most && falling && higher < FALLING * own {
            let factor = growth(k + 1, higher);
            if factor > WORTH_ANOTHER_ORDER * best.1 {
                best = (k + 1, factor);
            }
        }
        (best.0, worth(best.1))
    }

    /// Decides after an attempt whose error was above 1; returns the factor of its length.
    pub(super) fn after_refused(&mut self, derivatives: &Derivatives) -> f64 {
        (self.starting, self.steady) = (false, 0);
        self.failures += 1;
        let k = self.k;
        if self.failures > 3 {
            // The history misleads.
            self.next = 1;
            return 0.25;
        }
        let mut factor = growth(k, derivatives.own);
        if k > 1 {
            let lower = growth(k - 1, derivatives.lower);
            if lower > factor {
                (self.next, factor) = (k - 1, lower);
            }
        }
        // What has failed twice is not as smooth as it seems.
        (0.9 * factor).clamp(0.25, if self.failures == 1 { 0.9 } else { 0.5 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// h^j times the j-th derivative falls by `ratio` from j to j + 1.
    fn falling(own: f64, ratio: f64) -> Derivatives {
        Derivatives {
            own,
            lower: own / ratio,
            lowest: own / (ratio * ratio),
            higher: own * ratio,
        }
    }

    fn after(steps: usize, k: usize, derivatives: &Derivatives) -> (usize, f64) {
        let mut orders = Orders {
            k,
            next: k,
            starting: false,
            ..Orders::new(5)
        };
        for _ in 0..steps {
            orders.after_accepted(0.1, derivatives);
        }
        (orders.next, orders.factor())
    }

    #[test]
    fn a_start_raises_the_order_with_every_step() {
        let mut orders = Orders::new(4);
        for k in [2, 3, 4, 4] {
            orders.after_accepted(0.1, &falling(1e-8, 0.1));
            assert_eq!((orders.next, orders.factor()), (k, GROWTH_AT_START));
            orders.k = orders.next;
        }
        orders.after_refused(&falling(10.0, 0.1));
        orders.after_accepted(0.1, &falling(1e-8, 0.1));
        assert_eq!((orders.next, orders.factor()), (4, 1.0));
    }

    #[test]
    fn equal_steps_come_before_a_change() {
        let smooth = falling(1e-3, 0.1);
        assert_eq!(after(3, 3, &smooth), (3, 1.0));
        let (k, factor) = after(4, 3, &smooth);
        assert!(k == 4 && factor > 2.0, "{k} {factor}");
        // A step that is too long is shortened at once.
        let (k, factor) = after(1, 3, &falling(0.9, 0.1));
        assert!(k == 3 && (0.5..1.0).contains(&factor), "{k} {factor}");
    }

    /// The stability rule: derivatives of a vibration fall by h ω.
    #[test]
    fn vibrations_lower_the_order() {
        for (ratio, expected) in [(2.0, 2), (0.8, 2), (0.4, 3), (0.25, 4)] {
            assert_eq!(after(4, 3, &falling(0.1, ratio)).0, expected, "{ratio}");
        }
        assert_eq!(after(1, 2, &falling(1e-3, 3.0)).0, 1);
    }

    #[test]
    fn refused_steps_shrink_and_end_at_order_1() {
        let mut orders = Orders {
            k: 5,
            next: 5,
            ..Orders::new(5)
        };
        for expected in [5, 5, 5, 1] {
            let factor = orders.after_refused(&falling(3.0, 0.1));
            assert!((0.25..0.9).contains(&factor));
            assert_eq!(orders.next, expected);
        }
        // The order falls where that promises more.
        let mut orders = Orders {
            k: 5,
            next: 5,
            ..Orders::new(5)
        };
        orders.after_refused(&falling(3.0, 10.0));
        assert_eq!(orders.next, 4);
    }
}
