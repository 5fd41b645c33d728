//! Prescribed motion of single coordinates: equations that depend on time, behind those of the closures.

use crate::system::System;
use crate::workspace::{MassFactor, Workspace};
use std::fmt::Debug;
use std::sync::Arc;

/// Motion of a coordinate as a function of time.
pub trait Guide: Debug + Send + Sync {
    /// Position \[rad, m\], speed \[rad/s, m/s\] and acceleration \[rad/s^2, m/s^2\] at time `t` \[s\].
    fn at(&self, t: f64) -> [f64; 3];

    /// Times at which the motion or a derivative of it jumps: steps should end there \[s\].
    fn stop_times(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// A coordinate that follows a [`Guide`]: `q - f(t) = 0`, or `v - f'(t) = 0` alone. Its multiplier is the force or torque on the
/// coordinate that this takes \[N, N m\]; the power of it counts as work done on the system.
#[derive(Clone, Debug)]
pub struct Guided {
    /// Index of the coordinate.
    pub coordinate: usize,
    /// Index of the speed that is its rate.
    pub speed: usize,
    /// Whether its speed alone is prescribed, from wherever it starts.
    pub speed_only: bool,
    /// The motion.
    pub guide: Arc<dyn Guide>,
}

impl Guided {
    /// Residual `phi`, its rate, and the bias of its second rate.
    #[inline]
    fn residuals(&self, t: f64, q: f64, v: f64) -> [f64; 3] {
        let [position, speed, acceleration] = self.guide.at(t);
        let residual = if self.speed_only { 0.0 } else { q - position };
        [residual, v - speed, -acceleration]
    }
}

impl System {
    /// Coordinates that follow a prescribed motion.
    pub fn guided(&self) -> &[Guided] {
        &self.guided
    }

    /// Residuals into `lambda`, behind those of the closures.
    #[inline]
    pub(crate) fn guide_residuals(&self, t: f64, q: &[f64], work: &mut Workspace) {
        let rows = &mut work.constraint.lambda[self.closure_equations..];
        for (row, guided) in rows.iter_mut().zip(&self.guided) {
            [*row, ..] = guided.residuals(t, q[guided.coordinate], 0.0);
        }
    }

    /// Rates into `lambda`, behind those of the closures.
    #[inline]
    pub(crate) fn guide_rates(&self, t: f64, v: &[f64], work: &mut Workspace) {
        let rows = &mut work.constraint.lambda[self.closure_equations..];
        for (row, guided) in rows.iter_mut().zip(&self.guided) {
            [_, *row, _] = guided.residuals(t, 0.0, v[guided.speed]);
        }
    }

    /// Puts the gradient where it is taken inward.
    #[inline]
    pub(crate) fn put_guides(&self, work: &mut Workspace) {
        let (closures, first) = (self.closures.len(), 1 + self.closure_equations);
        for (k, guided) in self.guided.iter().enumerate() {
            match &mut work.mass {
                MassFactor::LocalLoops(mass) => mass.put(closures + k, guided.speed, 0, 1.0),
                _ => *work.columns.at_mut(guided.speed, first + k) = 1.0,
            }
        }
    }

    /// Biases, drift terms included.
    #[inline]
    pub(crate) fn guide_biases(&self, t: f64, q: &[f64], v: &[f64], work: &mut Workspace) {
        let gamma = &mut work.constraint.gamma[self.closure_equations..];
        for (gamma, guided) in gamma.iter_mut().zip(&self.guided) {
            let [residual, rate, bias] = guided.residuals(t, q[guided.coordinate], v[guided.speed]);
            let drift = self
                .baumgarte
                .map_or(0.0, |b| 2.0 * b.alpha * rate + b.beta * b.beta * residual);
            *gamma = bias + drift;
        }
    }

    /// Power that the prescribed motions put in \[W\], by the multipliers in `work`.
    #[inline]
    pub(crate) fn guide_power(&self, t: f64, work: &Workspace) -> f64 {
        let multipliers = &work.constraint.multipliers()[self.closure_equations..];
        let power = |(guided, multiplier): (&Guided, &f64)| multiplier * guided.guide.at(t)[1];
        self.guided.iter().zip(multipliers).map(power).sum()
    }
}
