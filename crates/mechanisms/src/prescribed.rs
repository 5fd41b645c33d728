//! Prescribed motion of a joint: position or speed as a function of time.

use crate::Spline;
use linkdyn_dynamics::Guide;
use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

/// Position, speed and acceleration as a function of time \[s\].
pub type MotionFunction = Arc<dyn Fn(f64) -> [f64; 3] + Send + Sync>;

/// What a joint with one coordinate is made to do, whatever force or torque that takes. The coordinate gets an equation with a multiplier,
/// which is that force; its power counts as work done on the mechanism.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum PrescribedMotion {
    /// `c_0 + c_1 t + c_2 t^2 + ...`: at rest, at constant speed, at constant acceleration.
    Polynomial {
        /// Coefficients, the constant first \[rad, m and per s to the power\].
        coefficients: Vec<f64>,
    },
    /// `mean + amplitude * sin(2 pi frequency t + phase)`.
    Harmonic {
        /// Middle position \[rad, m\].
        mean: f64,
        /// Amplitude \[rad, m\].
        amplitude: f64,
        /// Frequency \[Hz\].
        frequency: f64,
        /// Phase at t = 0 \[rad\].
        phase: f64,
    },
    /// A table of positions over time, through which a spline goes; straight on before its first and behind its last node.
    Table {
        /// The positions; a natural spline, so that accelerations are continuous.
        spline: Spline,
    },
    /// A table of speeds over time, from wherever the joint starts; constant before its first and behind its last node.
    Speeds {
        /// The speeds.
        spline: Spline,
    },
    /// Any function, with the times at which it or a derivative of it jumps \[s\].
    Custom {
        /// The function.
        #[cfg_attr(feature = "serde", serde(skip))]
        function: MotionFunction,
        /// Its kinks.
        stop_times: Vec<f64>,
    },
}

impl fmt::Debug for PrescribedMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PrescribedMotion::Polynomial { coefficients } => {
                write!(f, "Polynomial {{ coefficients: {coefficients:?} }}")
            }
            PrescribedMotion::Harmonic {
                mean,
                amplitude,
                frequency,
                phase,
            } => write!(
                f,
                "Harmonic {{ mean: {mean}, amplitude: {amplitude}, frequency: {frequency}, phase: {phase} }}"
            ),
            PrescribedMotion::Table { spline } => write!(f, "Table {{ spline: {spline:?} }}"),
            PrescribedMotion::Speeds { spline } => write!(f, "Speeds {{ spline: {spline:?} }}"),
            PrescribedMotion::Custom { stop_times, .. } => write!(f, "Custom {{ stop_times: {stop_times:?} }}"),
        }
    }
}

impl PrescribedMotion {
    /// Whether the speed alone is prescribed.
    pub fn speed_only(&self) -> bool {
        matches!(self, PrescribedMotion::Speeds { .. })
    }

    /// First parameter that is out of range: its name, value and what would be right.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        let finite = |numbers: &[(&'static str, f64)]| {
            let wrong = numbers.iter().find(|(_, value)| !value.is_finite());
            wrong.map(|(name, value)| (*name, *value, "a finite number"))
        };
        match self {
            PrescribedMotion::Polynomial { coefficients } if coefficients.is_empty() => {
                Some(("coefficients", 0.0, "at least one coefficient"))
            }
            PrescribedMotion::Polynomial { coefficients } => {
                coefficients.iter().find_map(|c| finite(&[("coefficient", *c)]))
            }
            PrescribedMotion::Harmonic {
                mean,
                amplitude,
                frequency,
                phase,
            } => finite(&[
                ("mean", *mean),
                ("amplitude", *amplitude),
                ("frequency", *frequency),
                ("phase", *phase),
            ]),
            PrescribedMotion::Table { spline } | PrescribedMotion::Speeds { spline } => spline.fault(),
            PrescribedMotion::Custom { stop_times, .. } => stop_times.iter().find_map(|t| finite(&[("stop time", *t)])),
        }
    }
}

impl Guide for PrescribedMotion {
    fn at(&self, t: f64) -> [f64; 3] {
        match self {
            // Horner's rule for the value and both derivatives.
            PrescribedMotion::Polynomial { coefficients } => coefficients
                .iter()
                .rev()
                .fold([0.0; 3], |[f, d, s], c| [f * t + c, d * t + f, s * t + 2.0 * d]),
            PrescribedMotion::Harmonic {
                mean,
                amplitude,
                frequency,
                phase,
            } => {
                let w = TAU * frequency;
                let (s, c) = (w * t + phase).sin_cos();
                [mean + amplitude * s, amplitude * w * c, -amplitude * w * w * s]
            }
            PrescribedMotion::Table { spline } => spline.straight_on(t),
            PrescribedMotion::Speeds { spline } => {
                let [speed, acceleration, _] = spline.with_derivatives(t);
                [0.0, speed, acceleration]
            }
            PrescribedMotion::Custom { function, .. } => function(t),
        }
    }

    fn stop_times(&self) -> Vec<f64> {
        match self {
            PrescribedMotion::Polynomial { .. } | PrescribedMotion::Harmonic { .. } => Vec::new(),
            PrescribedMotion::Table { spline } | PrescribedMotion::Speeds { spline } => spline.kinks().to_vec(),
            PrescribedMotion::Custom { stop_times, .. } => stop_times.clone(),
        }
    }
}
