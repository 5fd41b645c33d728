//! Tolerances and limits, and the check that they make sense.

/// One number for all components, or one for each.
#[derive(Debug, Clone, PartialEq)]
pub enum Tolerance {
    /// The same for all components.
    Scalar(f64),
    /// One for each component.
    Each(Vec<f64>),
}

impl From<f64> for Tolerance {
    fn from(value: f64) -> Self {
        Self::Scalar(value)
    }
}

impl From<Vec<f64>> for Tolerance {
    fn from(values: Vec<f64>) -> Self {
        Self::Each(values)
    }
}

impl From<&[f64]> for Tolerance {
    fn from(values: &[f64]) -> Self {
        Self::Each(values.to_vec())
    }
}

impl Tolerance {
    /// The tolerance of each of `dim` components, each passed by `check`.
    fn expand(&self, name: &'static str, dim: usize, valid: fn(f64) -> bool) -> Result<Vec<f64>, SettingsError> {
        let values = match self {
            Self::Scalar(value) => vec![*value; dim],
            Self::Each(values) => values.clone(),
        };
        if values.len() != dim {
            return Err(SettingsError::Length {
                name,
                expected: dim,
                found: values.len(),
            });
        }
        match values.iter().position(|&value| !valid(value)) {
            Some(component) => Err(SettingsError::Tolerance {
                name,
                component,
                value: values[component],
            }),
            None => Ok(values),
        }
    }
}

/// Tolerances and limits of an integration.
///
/// A step is accepted when the root mean square of errorᵢ / (absoluteᵢ + relativeᵢ max(|y₀ᵢ|, |y₁ᵢ|)) is at most 1
/// (Hairer, Nørsett, Wanner I, eq. II.4.10-11). Methods of fixed step need no tolerance and ignore it.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Relative tolerance, 0 ≤ value < 1. Below 10 ε (2.2e-15) it is taken as 10 ε, the best that double precision can do;
    /// so 0 means absolute control.
    pub relative: Tolerance,
    /// Absolute tolerance, > 0. Infinite: the component is not controlled (a quadrature, say).
    pub absolute: Tolerance,
    /// Length of the first step, > 0; chosen from the problem by default.
    pub first_step: Option<f64>,
    /// Longest step, > 0; infinite by default.
    pub max_step: f64,
    /// Most steps to attempt over the whole run, ≥ 1.
    pub max_steps: u64,
    /// Most events over the whole run.
    pub max_events: u64,
}

impl Default for Settings {
    /// Relative 1e-6, absolute 1e-9, no limit on the step, ten million steps, a million events.
    fn default() -> Self {
        Self::tolerances(1e-6, 1e-9)
    }
}

impl Settings {
    /// The default settings with these tolerances.
    pub fn tolerances(relative: impl Into<Tolerance>, absolute: impl Into<Tolerance>) -> Self {
        Self {
            relative: relative.into(),
            absolute: absolute.into(),
            first_step: None,
            max_step: f64::INFINITY,
            max_steps: 10_000_000,
            max_events: 1_000_000,
        }
    }

    /// Checks everything against a problem of `dim` components; returns relative and absolute tolerances of each.
    pub(crate) fn validate(&self, dim: usize) -> Result<(Vec<f64>, Vec<f64>), SettingsError> {
        let mut relative = self
            .relative
            .expand("relative", dim, |value| (0.0..1.0).contains(&value))?;
        let absolute = self.absolute.expand("absolute", dim, |value| value > 0.0)?;
        relative
            .iter_mut()
            .for_each(|value| *value = value.max(10.0 * f64::EPSILON));
        if let Some(step) = self.first_step {
            check_step("first_step", step)?;
            if !step.is_finite() {
                return Err(SettingsError::Step {
                    name: "first_step",
                    value: step,
                });
            }
        }
        check_step("max_step", self.max_step)?;
        if self.max_steps == 0 {
            return Err(SettingsError::NoSteps);
        }
        Ok((relative, absolute))
    }
}

/// A length of step must be a number above zero.
pub(crate) fn check_step(name: &'static str, value: f64) -> Result<(), SettingsError> {
    if value > 0.0 {
        Ok(())
    } else {
        Err(SettingsError::Step { name, value })
    }
}

/// A setting that makes no sense.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// A tolerance outside its range.
    #[error("{name} tolerance of component {component} is {value}; needed: 0 <= relative < 1, absolute > 0")]
    Tolerance {
        /// `relative` or `absolute`.
        name: &'static str,
        /// Index of the component.
        component: usize,
        /// The value found.
        value: f64,
    },
    /// A list whose length is not the dimension of the problem.
    #[error("{name} has {found} entries, the problem has {expected}")]
    Length {
        /// What the list is.
        name: &'static str,
        /// Dimension of the problem.
        expected: usize,
        /// Length found.
        found: usize,
    },
    /// A length of step that is not a positive number.
    #[error("{name} is {value}; needed: > 0")]
    Step {
        /// Name of the setting.
        name: &'static str,
        /// The value found.
        value: f64,
    },
    /// `max_steps` is zero.
    #[error("max_steps is 0; no step could be taken")]
    NoSteps,
    /// A time or a component of the start that is not finite.
    #[error("{name} is {value}; needed: a finite number")]
    NotFinite {
        /// What it is.
        name: &'static str,
        /// The value found.
        value: f64,
    },
    /// The method does not fit the problem, or its own parameters are out of range.
    #[error("method: {0}")]
    Method(&'static str),
}
