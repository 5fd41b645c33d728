//! The terms of the equations of motion one by one, for whoever solves for multipliers himself.

use crate::composite::Composite;
use crate::error::DynamicsError;
use crate::load::Instant;
use crate::system::System;
use crate::workspace::Workspace;

/// `M v' = f + G^T lambda`, `G v' + gamma = 0`, `phi = 0` at one state, with n speeds and m closure equations.
#[derive(Clone, Debug)]
pub struct MotionTerms {
    composite: Composite,
    /// Mass matrix M (n x n).
    pub mass: Vec<f64>,
    /// Generalised forces less the bias forces (n).
    pub force: Vec<f64>,
    /// Closure residual (m).
    pub residual: Vec<f64>,
    /// Closure gradient G (m x n), row after row.
    pub gradient: Vec<f64>,
    /// Closure bias (m).
    pub gamma: Vec<f64>,
}

impl MotionTerms {
    /// Room for those of `system`.
    pub fn new(system: &System) -> Self {
        let (n, m) = (system.tree.speeds(), system.closure_equations);
        Self {
            composite: Composite::new(&system.tree),
            mass: vec![0.0; n * n],
            force: vec![0.0; n],
            residual: vec![0.0; m],
            gradient: vec![0.0; m * n],
            gamma: vec![0.0; m],
        }
    }
}

impl System {
    /// Writes the terms at a state. Loads that depend on reactions and prescribed motions are left out, and so are Baumgarte's terms.
    ///
    /// # Errors
    /// [`DynamicsError::Refused`] where a load has no meaning.
    pub fn write_terms(
        &self,
        at: &Instant<'_>,
        work: &mut Workspace,
        terms: &mut MotionTerms,
    ) -> Result<(), DynamicsError> {
        work.counters.evaluations += 1;
        let (n, base) = (self.tree.speeds(), -self.gravity);
        self.tree.sweep(
            at.q,
            at.v,
            &base,
            &mut work.positions,
            &mut work.velocities,
            &mut work.biases,
        );
        self.apply_loads(at, work)?;
        work.columns.clear();
        for (speed, force) in work.generalised.iter().enumerate() {
            *work.columns.at_mut(speed, 0) = *force;
        }
        self.own_wrenches(work);
        work.wrenches.copy_from_slice(&work.own);
        let positions = work.positions.nodes();
        terms.composite.assemble(
            self.tree.nodes(),
            positions,
            &work.inertias,
            &mut work.wrenches,
            &mut work.columns,
        );
        let lower = terms.composite.matrix_mut();
        for i in 0..n {
            terms.force[i] = work.columns.at(i, 0);
            for j in 0..=i {
                let entry = lower[i * n + j];
                (terms.mass[i * n + j], terms.mass[j * n + i]) = (entry, entry);
            }
        }
        terms.gradient.fill(0.0);
        let mut first = 0;
        for closure in &self.closures {
            let range = first..first + closure.equations();
            let gradient = &mut terms.gradient;
            closure.gradient_and_bias(
                &work.positions,
                &work.velocities,
                &work.biases,
                |speed, equation, value| gradient[(first + equation) * n + speed] = value,
                &mut terms.gamma[range.clone()],
            );
            closure.residual(&work.positions, &mut terms.residual[range]);
            first += closure.equations();
        }
        Ok(())
    }
}
