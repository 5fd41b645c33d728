//! Projection of a state onto its closures, on position and velocity level.

use crate::system::System;
use crate::workspace::{MassFactor, Workspace};
use linkdyn_kinematics::Wrench;
use linkdyn_kinematics::assembly::{largest, rates, residuals};

/// Residuals below this share of the largest distance from the origin (or of 1 m) are rounding and are left alone.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Newton steps on position level; drift of an accepted step needs one.
const ITERATIONS: usize = 6;

/// Drift found by [`System::project`] before it was taken away.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drift {
    /// Largest closure residual \[m, -\].
    pub position: f64,
    /// Largest closure rate \[m/s, 1/s\].
    pub velocity: f64,
    /// Whether coordinates or speeds were changed.
    pub changed: bool,
    /// Largest closure residual left \[m, -\]: far above rounding where the state was too far away to be put back.
    pub remaining: f64,
}

impl System {
    /// Moves `q` and `v` back onto the closures and prescribed motions at time `t` \[s\] along the shortest way in the metric of the mass
    /// matrix there. What `work` has been used for before does not matter.
    ///
    /// This is meant for drift: from far away use [`linkdyn_kinematics::assembly`].
    pub fn project(&self, t: f64, q: &mut [f64], v: &mut [f64], work: &mut Workspace) -> Drift {
        let has_metric = self.set_metric(q, v, work);
        self.project_by_metric(t, 0.0, (q, v), work, has_metric)
    }

    /// As [`System::project`], but residuals up to `tolerance` \[m, -\] and rates up to it \[m/s, 1/s\] stay as they are, and the
    /// metric is that of the last evaluation in `work`: any mass matrix near the state serves as well, and costs nothing.
    pub fn project_beyond(&self, t: f64, tolerance: f64, q: &mut [f64], v: &mut [f64], work: &mut Workspace) -> Drift {
        let has_metric = work.counters.evaluations > 0 || self.set_metric(q, v, work);
        self.project_by_metric(t, tolerance, (q, v), work, has_metric)
    }

    /// Factors the mass matrix; false if it is singular.
    fn set_metric(&self, q: &[f64], v: &[f64], work: &mut Workspace) -> bool {
        if self.equations == 0 {
            return true;
        }
        let base = -self.gravity;
        self.tree
            .sweep(q, v, &base, &mut work.positions, &mut work.velocities, &mut work.biases);
        work.own.fill(Wrench::zero());
        self.own_wrenches(work);
        work.columns.clear();
        if let MassFactor::LocalLoops(_) = work.mass {
            self.put_gradient(work);
        }
        self.factor_mass(work).is_ok()
    }

    fn project_by_metric(
        &self,
        t: f64,
        tolerance: f64,
        (q, v): (&mut [f64], &mut [f64]),
        work: &mut Workspace,
        has_metric: bool,
    ) -> Drift {
        let mut drift = Drift::default();
        if self.tree.normalise(q) > ROUNDING {
            drift.changed = true;
        }
        if self.equations == 0 {
            return drift;
        }
        if !has_metric {
            return Drift {
                remaining: f64::INFINITY,
                ..drift
            };
        }
        self.tree.positions(q, &mut work.positions);
        let size = work
            .positions
            .nodes()
            .iter()
            .fold(1.0_f64, |s, node| s.max(node.origin.amax()));
        let guided = |s: f64, on: &crate::Guided| s.max(q[on.coordinate].abs());
        let size = self.guided.iter().fold(size, guided);
        let mut factored = false;
        for iteration in 0..ITERATIONS {
            let residual = self.residual(t, q, work);
            drift.remaining = residual;
            if iteration == 0 {
                drift.position = residual;
            }
            if residual.is_nan() || residual <= tolerance.max(ROUNDING * size) {
                break;
            }
            if !self.factor_closures(work, &mut factored) {
                break;
            }
            self.closure_step(work);
            self.tree.displace(q, &work.rates);
            self.tree.positions(q, &mut work.positions);
            drift.changed = true;
        }
        self.tree.velocities(&work.positions, v, &mut work.velocities);
        let fastest = v.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
        drift.velocity = self.rate(t, v, work);
        if drift.velocity > tolerance.max(ROUNDING * size * fastest) && self.factor_closures(work, &mut factored) {
            self.closure_step(work);
            v.iter_mut().zip(&work.rates).for_each(|(v, step)| *v += step);
            drift.changed = true;
        }
        drift
    }

    /// Largest closure residual and rate at a state \[m, -\], \[m/s, 1/s\].
    pub fn violation(&self, t: f64, q: &[f64], v: &[f64], work: &mut Workspace) -> (f64, f64) {
        if self.equations == 0 {
            return (0.0, 0.0);
        }
        self.tree.positions(q, &mut work.positions);
        self.tree.velocities(&work.positions, v, &mut work.velocities);
        (self.residual(t, q, work), self.rate(t, v, work))
    }

    /// Residuals into `lambda`; returns the largest.
    fn residual(&self, t: f64, q: &[f64], work: &mut Workspace) -> f64 {
        residuals(&self.closures, &work.positions, &mut work.constraint.lambda);
        self.guide_residuals(t, q, work);
        largest(&work.constraint.lambda)
    }

    /// Rates into `lambda`; returns the largest.
    fn rate(&self, t: f64, v: &[f64], work: &mut Workspace) -> f64 {
        let (positions, velocities) = (&work.positions, &work.velocities);
        rates(&self.closures, positions, velocities, &mut work.constraint.lambda);
        self.guide_rates(t, v, work);
        largest(&work.constraint.lambda)
    }

    /// Closure gradient at the present positions, taken inward and factored; once is enough for a small drift. False where that fails,
    /// which it can only if the mass matrix has to be factored with it.
    fn factor_closures(&self, work: &mut Workspace, factored: &mut bool) -> bool {
        if std::mem::replace(factored, true) {
            return true;
        }
        work.columns.clear();
        self.put_gradient(work);
        match &mut work.mass {
            MassFactor::Composite(mass) => mass.inward(&mut work.columns),
            MassFactor::Articulated(mass) => {
                for column in 1..=self.equations {
                    let (nodes, positions) = (self.tree.nodes(), work.positions.nodes());
                    mass.inward(nodes, positions, &mut work.columns, column, &mut ());
                }
            }
            MassFactor::LocalLoops(_) => return self.factor_mass(work).is_ok(),
        }
        work.constraint.factor(&work.columns, work.mass.inverse_diagonal());
        true
    }

    /// Puts the closure gradient where it is taken inward.
    fn put_gradient(&self, work: &mut Workspace) {
        let mut first = 0;
        for (number, closure) in self.closures.iter().enumerate() {
            let (mass, columns) = (&mut work.mass, &mut work.columns);
            closure.gradient(&work.positions, |speed, equation, value| match mass {
                MassFactor::LocalLoops(mass) => mass.put(number, speed, equation, value),
                _ => *columns.at_mut(speed, 1 + first + equation) = value,
            });
            first += closure.equations();
        }
        self.put_guides(work);
    }

    /// The step `-M^-1 G^T S^-1 r` for the residual or rate `r` in `lambda`, left in `rates`.
    fn closure_step(&self, work: &mut Workspace) {
        let m = self.equations;
        if let MassFactor::LocalLoops(mass) = &mut work.mass {
            // The step is the acceleration of a system without forces, with the residual as bias.
            let (nodes, positions) = (self.tree.nodes(), work.positions.nodes());
            work.columns.clear();
            mass.inward(nodes, positions, &mut work.columns, 0, &work.constraint.lambda);
            mass.outward(nodes, positions, &work.columns, &mut work.solutions, 0);
        } else {
            work.constraint.solve();
            work.solutions.clear();
            let inverse = work.mass.inverse_diagonal();
            for (i, inverse) in inverse.iter().enumerate() {
                let lambda = work.constraint.lambda[..m].iter().enumerate();
                let sum: f64 = lambda.map(|(k, l)| work.columns.at(i, 1 + k) * l).sum();
                *work.solutions.at_mut(i, 0) = -sum * inverse;
            }
            self.outward(work);
        }
        for (i, rate) in work.rates.iter_mut().enumerate() {
            *rate = work.solutions.at(i, 0);
        }
    }
}
