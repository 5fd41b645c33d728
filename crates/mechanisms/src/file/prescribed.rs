//! Prescribed motions in a scene file: their format, and how they are read.

use super::fault::Faults;
use super::loads::key_of;
use super::quantity::Quantity;
use crate::prescribed::PrescribedMotion;
use crate::spline::Spline;
use schemars::JsonSchema;
use serde::Deserialize;

/// A prescribed motion.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum PrescribedItem {
    /// `c_0 + c_1 t + c_2 t^2 + ...`
    Polynomial {
        /// Coefficients, the constant first \[rad, m and per s to the power\].
        coefficients: Vec<f64>,
    },
    /// `mean + amplitude * sin(2 pi frequency t + phase)`.
    Harmonic {
        /// Middle position \[rad, m\]; zero unless given.
        #[serde(default)]
        mean: Quantity,
        /// Amplitude \[rad, m\].
        amplitude: Quantity,
        /// Frequency \[Hz\].
        frequency: f64,
        /// Phase at t = 0 \[rad\]; zero unless given.
        #[serde(default)]
        phase: Quantity,
    },
    /// A natural spline through positions over time, straight on before the first and behind the last.
    Table {
        /// Time \[s\] and position \[rad, m\] of each point, times rising.
        points: Vec<[f64; 2]>,
    },
    /// A natural spline through speeds over time, constant before the first and behind the last; from wherever the joint starts.
    Speeds {
        /// Time \[s\] and speed \[rad/s, m/s\] of each point, times rising.
        points: Vec<[f64; 2]>,
    },
}

/// The motion of the joint `name`; none where it cannot be.
pub(super) fn read(name: &str, item: &PrescribedItem, faults: &mut Faults<'_>) -> Option<PrescribedMotion> {
    let spline = |points: &[[f64; 2]]| Spline::natural(&points.iter().map(|&[t, x]| (t, x)).collect::<Vec<_>>());
    let (word, motion) = match item {
        PrescribedItem::Polynomial { coefficients } => {
            let coefficients = coefficients.clone();
            ("polynomial", PrescribedMotion::Polynomial { coefficients })
        }
        PrescribedItem::Harmonic {
            mean,
            amplitude,
            frequency,
            phase,
        } => {
            let motion = PrescribedMotion::Harmonic {
                mean: mean.0,
                amplitude: amplitude.0,
                frequency: *frequency,
                phase: phase.0,
            };
            ("harmonic", motion)
        }
        PrescribedItem::Table { points } => ("table", PrescribedMotion::Table { spline: spline(points) }),
        PrescribedItem::Speeds { points } => ("speeds", PrescribedMotion::Speeds { spline: spline(points) }),
    };
    if let Some((parameter, value, expected)) = motion.fault() {
        let message = format!("{parameter} = {value} must be {expected}");
        faults.add(&["joints", name, "prescribed", word, key_of(parameter)], message);
        return None;
    }
    Some(motion)
}
