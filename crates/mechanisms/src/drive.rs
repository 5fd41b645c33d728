//! Drives and resistances: torques or forces on one coordinate as functions of time, coordinate and speed.

use crate::Spline;
use linkdyn_dynamics::{Load, Loads, Motion};
use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

/// Torque \[N m\] or force \[N\] as a function of time \[s\], coordinate \[rad, m\] and speed \[rad/s, m/s\].
pub type DriveFunction = Arc<dyn Fn(f64, f64, f64) -> f64 + Send + Sync>;

/// A torque or force on a joint with one coordinate, positive along its speed.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Drive {
    /// Rises linearly from zero at t = 0 to `torque` at `rise_time` and stays there.
    Ramp {
        /// Final torque or force \[N m, N\].
        torque: f64,
        /// Time of the rise \[s\].
        rise_time: f64,
    },
    /// Constant.
    Constant {
        /// Torque or force \[N m, N\].
        torque: f64,
    },
    /// Opposes the speed: `-torque * speed/reference_speed`.
    Resistance {
        /// Torque or force at the reference speed \[N m, N\].
        torque: f64,
        /// Reference speed \[rad/s, m/s\].
        reference_speed: f64,
    },
    /// Opposes the speed by its square: `-torque * (speed/reference_speed) |speed/reference_speed|`, as air does.
    QuadraticResistance {
        /// Torque or force at the reference speed \[N m, N\].
        torque: f64,
        /// Reference speed \[rad/s, m/s\].
        reference_speed: f64,
    },
    /// `amplitude * sin(2 pi frequency t + phase)`.
    Harmonic {
        /// Largest torque or force \[N m, N\].
        amplitude: f64,
        /// Frequency \[Hz\].
        frequency: f64,
        /// Phase at t = 0 \[rad\].
        phase: f64,
    },
    /// A table over time \[s\] of torques \[N m\] or forces \[N\].
    Table {
        /// The table, constant before its first and behind its last node.
        spline: Spline,
    },
    /// Any function, with the times at which it or a derivative of it jumps \[s\].
    Custom {
        /// The function.
        #[cfg_attr(feature = "serde", serde(skip))]
        function: DriveFunction,
        /// Its kinks.
        stop_times: Vec<f64>,
    },
}

impl fmt::Debug for Drive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Drive::Ramp { torque, rise_time } => write!(f, "Ramp {{ torque: {torque}, rise_time: {rise_time} }}"),
            Drive::Constant { torque } => write!(f, "Constant {{ torque: {torque} }}"),
            Drive::Resistance {
                torque,
                reference_speed,
            } => write!(
                f,
                "Resistance {{ torque: {torque}, reference_speed: {reference_speed} }}"
            ),
            Drive::QuadraticResistance {
                torque,
                reference_speed,
            } => write!(
                f,
                "QuadraticResistance {{ torque: {torque}, reference_speed: {reference_speed} }}"
            ),
            Drive::Harmonic {
                amplitude,
                frequency,
                phase,
            } => write!(
                f,
                "Harmonic {{ amplitude: {amplitude}, frequency: {frequency}, phase: {phase} }}"
            ),
            Drive::Table { spline } => write!(f, "Table {{ spline: {spline:?} }}"),
            Drive::Custom { stop_times, .. } => write!(f, "Custom {{ stop_times: {stop_times:?} }}"),
        }
    }
}

impl Drive {
    /// Torque or force at time `t`, coordinate `q` and speed `v`.
    #[inline]
    pub fn torque(&self, t: f64, q: f64, v: f64) -> f64 {
        match self {
            Drive::Ramp { torque, rise_time } => torque * (t / rise_time).clamp(0.0, 1.0),
            Drive::Constant { torque } => *torque,
            Drive::Resistance {
                torque,
                reference_speed,
            } => -torque * v / reference_speed,
            Drive::QuadraticResistance {
                torque,
                reference_speed,
            } => {
                let share = v / reference_speed;
                -torque * share * share.abs()
            }
            Drive::Harmonic {
                amplitude,
                frequency,
                phase,
            } => amplitude * (TAU * frequency * t + phase).sin(),
            Drive::Table { spline } => spline.value(t),
            Drive::Custom { function, .. } => function(t, q, v),
        }
    }

    /// First parameter that is out of range: its name, value and what would be right.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        match *self {
            Drive::Ramp { torque, .. }
            | Drive::Constant { torque }
            | Drive::Resistance { torque, .. }
            | Drive::QuadraticResistance { torque, .. }
                if !torque.is_finite() =>
            {
                Some(("torque", torque, "a finite number"))
            }
            Drive::Ramp { rise_time, .. } if !(rise_time.is_finite() && rise_time > 0.0) => {
                Some(("rise_time", rise_time, "a finite positive number"))
            }
            Drive::Resistance { reference_speed, .. } | Drive::QuadraticResistance { reference_speed, .. }
                if !(reference_speed.is_finite() && reference_speed > 0.0) =>
            {
                Some(("reference_speed", reference_speed, "a finite positive number"))
            }
            Drive::Harmonic { amplitude, .. } if !amplitude.is_finite() => {
                Some(("amplitude", amplitude, "a finite number"))
            }
            Drive::Harmonic { frequency, .. } if !(frequency.is_finite() && frequency >= 0.0) => {
                Some(("frequency", frequency, "a finite number, not negative"))
            }
            Drive::Harmonic { phase, .. } if !phase.is_finite() => Some(("phase", phase, "a finite number")),
            Drive::Table { ref spline } => spline.fault(),
            _ => None,
        }
    }

    pub(crate) fn stop_times(&self) -> Vec<f64> {
        match self {
            Drive::Ramp { rise_time, .. } => vec![0.0, *rise_time],
            Drive::Custom { stop_times, .. } => stop_times.clone(),
            Drive::Table { spline } => spline.kinks().to_vec(),
            Drive::Constant { .. }
            | Drive::Resistance { .. }
            | Drive::QuadraticResistance { .. }
            | Drive::Harmonic { .. } => Vec::new(),
        }
    }
}

/// The drives of one coordinate.
#[derive(Clone, Debug)]
pub(crate) struct CoordinateDrives {
    pub coordinate: usize,
    pub speed: usize,
    pub drives: Vec<Drive>,
}

impl Load for CoordinateDrives {
    #[inline]
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        let (q, v) = (motion.q[self.coordinate], motion.v[self.speed]);
        for drive in &self.drives {
            loads.add(self.speed, drive.torque(motion.t, q, v));
        }
    }

    fn stop_times(&self) -> Vec<f64> {
        self.drives.iter().flat_map(Drive::stop_times).collect()
    }
}
