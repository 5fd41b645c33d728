//! The numbers of the method.

use crate::SettingsError;

/// Coefficients of the generalised-α method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coefficients {
    pub alpha_m: f64,
    pub alpha_f: f64,
    pub beta: f64,
    pub gamma: f64,
}

impl Coefficients {
    /// Order 2 for any α_m and α_f, β for largest damping of what is fastest (Chung and Hulbert 1993).
    fn new(alpha_m: f64, alpha_f: f64) -> Self {
        let gamma = 0.5 + alpha_f - alpha_m;
        Self {
            alpha_m,
            alpha_f,
            beta: 0.25 * (gamma + 0.5) * (gamma + 0.5),
            gamma,
        }
    }

    /// With this spectral radius for infinite frequency (Chung and Hulbert 1993).
    pub(crate) fn of_radius(rho: f64) -> Self {
        Self::new((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
    }

    /// The method of Hilber, Hughes and Taylor.
    pub(crate) fn hht(alpha: f64) -> Self {
        Self::new(0.0, alpha)
    }

    /// Whether the numbers make sense; not so for a radius or an α out of range.
    pub(crate) fn check(&self) -> Result<(), SettingsError> {
        // Unconditional stability (Chung and Hulbert 1993): α_m <= α_f <= 1/2.
        if self.alpha_m >= -1.0 && self.alpha_m <= self.alpha_f && self.alpha_f <= 0.5 {
            Ok(())
        } else {
            Err(SettingsError::Method(
                "needed: 0 <= spectral radius <= 1, 0 <= alpha of Hilber, Hughes and Taylor <= 1/2",
            ))
        }
    }

    /// aₙ belongs to the time tₙ + this part of the step (Arnold and Brüls 2007).
    pub(crate) fn offset(&self) -> f64 {
        self.alpha_m - self.alpha_f
    }

    /// Local errors of positions and rates, in units of h³ q''' and h³ v'''.
    pub(crate) fn local_errors(&self) -> (f64, f64) {
        let (d, gamma) = (self.offset(), self.gamma);
        let rates = 1.0 / 6.0 - 0.5 * ((1.0 - gamma) * d * d + gamma * (1.0 + d) * (1.0 + d));
        (1.0 / 6.0 - 0.5 * d - self.beta, rates)
    }

    /// The part of aₙ₊₁ in v'ₙ₊₁.
    pub(crate) fn share(&self) -> f64 {
        (1.0 - self.alpha_m) / (1.0 - self.alpha_f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn special_cases() {
        let trapezoidal = Coefficients::hht(0.0);
        assert_eq!((trapezoidal.beta, trapezoidal.gamma), (0.25, 0.5));
        let (q, v) = trapezoidal.local_errors();
        assert!((q + 1.0 / 12.0).abs() < 1e-15 && (v + 1.0 / 12.0).abs() < 1e-15);
        for bad in [
            Coefficients::of_radius(-0.1),
            Coefficients::of_radius(1.1),
            Coefficients::of_radius(f64::NAN),
        ] {
            assert!(bad.check().is_err(), "{bad:?}");
        }
        for bad in [
            Coefficients::hht(-0.1),
            Coefficients::hht(0.6),
            Coefficients::hht(f64::NAN),
        ] {
            assert!(bad.check().is_err(), "{bad:?}");
        }
        for radius in [0.0, 0.5, 0.8, 1.0] {
            assert!(Coefficients::of_radius(radius).check().is_ok());
        }
    }
}
