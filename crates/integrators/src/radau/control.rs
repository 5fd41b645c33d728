//! How long the next step is (Hairer, Wanner II, IV.8).

/// Safety factor of the step control.
const SAFETY: f64 = 0.9;

/// A step shrinks to no less than a fifth and grows to no more than eightfold.
const LEAST: f64 = 0.2;
const MOST: f64 = 8.0;

/// Steps that would grow by no more than this, or shrink within the safety factor, are left as they are if the matrix J is, too:
/// the factors then serve again. (Subroutine RADAU5: growth only. This saves up to four fifths of the factors, and no step is lost.)
const NOT_WORTH_NEW_FACTORS: std::ops::RangeInclusive<f64> = 0.93..=1.2;

/// The step control: from the error of a step, and by Gustafsson's prediction from that of the one before.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Prediction {
    /// Length and error of the last accepted step.
    before: Option<(f64, f64)>,
}

impl Prediction {
    /// The step after one of length `h` > 0 that was rejected with this error.
    pub(crate) fn after_rejected(&self, h: f64, error: f64, effort: f64) -> f64 {
        match self.before {
            // Nothing is known yet of the right size.
            None => 0.1 * h,
            Some(_) => h * (SAFETY * effort * error.powf(-0.25)).clamp(LEAST, MOST),
        }
    }

    /// The step after one of length `h` > 0 that was accepted with this error. `keep` tells that its factors can serve again.
    pub(crate) fn after_accepted(&mut self, h: f64, error: f64, effort: f64, keep: bool) -> f64 {
        let mut factor = (SAFETY * effort * error.powf(-0.25)).min(MOST);
        if let Some((h_before, error_before)) = self.before {
            let predicted = SAFETY * (h / h_before) * (error_before / (error * error)).powf(0.25);
            factor = factor.min(predicted);
        }
        let factor = factor.clamp(LEAST, MOST);
        self.before = Some((h, error.max(0.01)));
        if keep && NOT_WORTH_NEW_FACTORS.contains(&factor) {
            h
        } else {
            h * factor
        }
    }
}

/// Steps that needed many of the `most` iterations are to grow less: part of the growth that is left to them.
pub(crate) fn effort(iterations: u32, most: u32) -> f64 {
    let most = f64::from(2 * most);
    ((1.0 + most) / (f64::from(iterations) + most)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_follow_the_error() {
        let mut prediction = Prediction::default();
        assert_eq!(prediction.after_rejected(1.0, 2.0, 1.0), 0.1);
        assert_eq!(prediction.after_accepted(1.0, 0.0, 1.0, true), 8.0);
        assert!((prediction.after_rejected(1.0, 16.0, 1.0) - 0.45).abs() < 1e-15);
        assert_eq!(prediction.after_rejected(1.0, 1e9, 1.0), 0.2);
        // The error has risen from 0.01 to 0.5 in a step of the same length: the next one would miss.
        let next = prediction.after_accepted(1.0, 0.5, 1.0, true);
        assert!((next - 0.9 * f64::powf(0.01 / 0.25, 0.25)).abs() < 1e-15, "{next}");
        // A little growth is not taken if the factors can serve again.
        let growth = |keep| Prediction::default().after_accepted(1.0, 0.5, 1.0, keep);
        assert_eq!(growth(true), 1.0);
        assert!((1.0..1.2).contains(&growth(false)) && growth(false) > 1.0);
        assert_eq!(effort(1, 7), 1.0);
        assert!(effort(7, 7) < 0.75);
    }
}
