//! When a simplified Newton iteration stops (Hairer, Wanner II, IV.8).

/// Changes below this part of the tolerance that do not shrink any more are taken for rounding: if they were not, the error
/// would be a hundred times larger and still no matter.
const ROUNDING: f64 = 1e-4;

/// A ratio of the first two changes is taken for no more than this where there is patience.
const LARGEST_FIRST: f64 = 0.9;

/// What one more iteration has shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Verdict {
    /// More iterations are needed.
    GoOn,
    /// The error of the iteration is a small part of the tolerance.
    Converged,
    /// It does not converge, or not soon enough; a step shorter by this factor is likely to.
    Failed { factor: f64 },
}

/// The convergence of one Newton iteration, measured by its changes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Convergence {
    /// Most iterations.
    most: u32,
    /// Norm of the error at which to stop, in tolerances.
    goal: f64,
    /// Whether to give up as soon as the goal is out of reach within `most` iterations.
    foresight: bool,
    /// Whether a second change may be as large as the first.
    patience: bool,
    iterations: u32,
    change: f64,
    ratio: f64,
    contraction: f64,
    /// Error left per size of the last change, as in the step before until it is known.
    left: f64,
}

impl Convergence {
    /// `left` is that of the step before.
    pub(crate) fn new(most: u32, goal: f64, foresight: bool, left: f64) -> Self {
        Self {
            most,
            goal,
            foresight,
            patience: false,
            iterations: 0,
            change: 0.0,
            ratio: 0.0,
            contraction: 0.0,
            left: left.max(f64::EPSILON).powf(0.8),
        }
    }

    /// Does not take the second change for a sign of divergence. In problems of higher index an iteration reduces the error of some
    /// components only, and that of the others in the next: two together tell how it converges.
    pub(crate) fn with_patience(mut self) -> Self {
        self.patience = true;
        self
    }

    /// Judges after an iteration which changed the stages by the norm `change`.
    pub(crate) fn judge(&mut self, change: f64) -> Verdict {
        self.iterations += 1;
        let n = self.iterations;
        if !change.is_finite() {
            return Verdict::Failed { factor: 0.5 };
        }
        if n > 1 {
            let (ratio, before) = (change / self.change.max(f64::EPSILON), self.ratio);
            self.contraction = if n == 2 { ratio } else { (ratio * before).sqrt() };
            self.ratio = ratio;
            if self.patience && n == 2 {
                self.contraction = self.contraction.min(LARGEST_FIRST);
            }
            if self.contraction >= 0.99 {
                return if n > 2 && change < ROUNDING {
                    Verdict::Converged
                } else {
                    Verdict::Failed { factor: 0.5 }
                };
            }
            self.left = self.contraction / (1.0 - self.contraction);
        }
        self.change = change;
        let error = self.left * change;
        if error <= self.goal {
            return Verdict::Converged;
        }
        if n == self.most {
            return Verdict::Failed { factor: 0.5 };
        }
        let rest = self.most - 1 - n.min(self.most - 1);
        let expected = error * self.contraction.powi(rest as i32) / self.goal;
        if self.foresight && n > 1 + u32::from(self.patience) && expected >= 1.0 {
            let exponent = -1.0 / f64::from(4 + rest);
            return Verdict::Failed {
                factor: 0.8 * expected.clamp(1e-4, 20.0).powf(exponent),
            };
        }
        Verdict::GoOn
    }

    /// Iterations made.
    pub(crate) fn iterations(&self) -> u32 {
        self.iterations
    }

    /// The last change.
    pub(crate) fn change(&self) -> f64 {
        self.change
    }

    /// By what part the changes shrink from one iteration to the next; 0 if there was only one.
    pub(crate) fn contraction(&self) -> f64 {
        self.contraction
    }

    /// Error left per size of the last change.
    pub(crate) fn left(&self) -> f64 {
        self.left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judge(changes: &[f64], most: u32, goal: f64, foresight: bool) -> (Verdict, Convergence) {
        let mut convergence = Convergence::new(most, goal, foresight, 1.0);
        let mut verdict = Verdict::GoOn;
        for &change in changes {
            assert_eq!(verdict, Verdict::GoOn);
            verdict = convergence.judge(change);
        }
        (verdict, convergence)
    }

    #[test]
    fn fast_convergence_ends_early() {
        let (verdict, convergence) = judge(&[1.0, 0.01], 7, 1e-3, true);
        assert_eq!(verdict, Verdict::Converged);
        assert_eq!((convergence.iterations(), convergence.contraction()), (2, 0.01));
        // In the step after it one iteration is enough for a small change.
        let mut next = Convergence::new(7, 1e-3, true, convergence.left());
        assert_eq!(next.judge(0.03), Verdict::Converged);
        assert_eq!(next.contraction(), 0.0);
    }

    #[test]
    fn no_change_is_convergence() {
        assert_eq!(judge(&[0.0], 7, 1e-3, true).0, Verdict::Converged);
        assert_eq!(judge(&[1.0, 0.0], 7, 1e-3, true).0, Verdict::Converged);
    }

    #[test]
    fn slow_convergence_is_foreseen() {
        let Verdict::Failed { factor } = judge(&[1.0, 0.7], 7, 1e-3, true).0 else {
            panic!("0.7^5 is more than 1e-3")
        };
        assert!((0.3..0.8).contains(&factor), "{factor}");
        assert_eq!(judge(&[1.0, 0.7], 7, 1e-3, false).0, Verdict::GoOn);
        assert_eq!(
            judge(&[1.0, 0.7, 0.49], 3, 1e-3, false).0,
            Verdict::Failed { factor: 0.5 }
        );
    }

    #[test]
    fn growth_fails_unless_it_is_rounding() {
        assert_eq!(judge(&[1.0, 2.0], 7, 1e-3, true).0, Verdict::Failed { factor: 0.5 });
        assert_eq!(judge(&[f64::NAN], 7, 1e-3, true).0, Verdict::Failed { factor: 0.5 });
        assert_eq!(
            judge(&[1.0, f64::INFINITY], 7, 1e-3, true).0,
            Verdict::Failed { factor: 0.5 }
        );
        assert_eq!(judge(&[1.0, 1e-5, 1e-6, 8e-6], 20, 1e-11, false).0, Verdict::GoOn);
        assert_eq!(
            judge(&[1.0, 1e-5, 9e-6, 1.5e-5], 20, 1e-11, false).0,
            Verdict::Converged
        );
    }
}
