//! A mechanism with the multipliers of its loops as unknowns: the forms of index 1, 2 and 3.

use crate::mechanism::Mechanism;
use linkdyn_dynamics::{Instant, MotionTerms, Workspace};
use linkdyn_integrators::{Constrained, EvalError, Terms};
use thiserror::Error;

/// The equations of motion of a mechanism as a [constrained problem](Constrained), for
/// [`Equations`](linkdyn_integrators::Equations): positions are its coordinates, rates its speeds, constraints its closure equations;
/// the multipliers are those of [`Observation::multipliers`](crate::Observation::multipliers). Energies and reactions are
/// [observed](crate::Simulation::observe) at positions and rates as for any state.
#[derive(Clone, Debug)]
pub struct ConstrainedMechanism {
    mechanism: Mechanism,
    work: Workspace,
    terms: MotionTerms,
}

/// Why a mechanism has no such form.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FormError {
    /// Friction depends on reactions, so that the force is no function of positions and rates.
    #[error(
        "joint `{joint}` has friction, which depends on reactions; forms with multipliers need joints without friction"
    )]
    Friction {
        /// The joint.
        joint: String,
    },
    /// A load has states, integrals or events of its own.
    #[error("{what}; forms with multipliers need loads that depend on time, position and velocity alone")]
    Internals {
        /// Which load, as far as it has a name.
        what: String,
    },
    /// The speeds are not the rates of the coordinates.
    #[error(
        "there are {coordinates} coordinates and {speeds} speeds (ball joints with quaternions); forms with multipliers need as many"
    )]
    Quaternions {
        /// Coordinates.
        coordinates: usize,
        /// Speeds.
        speeds: usize,
    },
}

impl ConstrainedMechanism {
    /// The form of `mechanism`.
    ///
    /// # Errors
    /// [`FormError`] that names what does not fit.
    pub fn new(mechanism: &Mechanism) -> Result<Self, FormError> {
        let system = mechanism.system();
        if let Some(joint) = mechanism.joints.iter().find(|joint| joint.has_friction) {
            let joint = joint.name.clone();
            return Err(FormError::Friction { joint });
        }
        if let Some(what) = mechanism.stateful() {
            return Err(FormError::Internals { what });
        }
        let (coordinates, speeds) = (system.tree().coordinates(), system.tree().speeds());
        if coordinates != speeds {
            return Err(FormError::Quaternions { coordinates, speeds });
        }
        Ok(Self {
            work: Workspace::new(system),
            terms: MotionTerms::new(system),
            mechanism: mechanism.clone(),
        })
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }
}

impl Constrained for ConstrainedMechanism {
    fn positions(&self) -> usize {
        self.mechanism.system.tree().speeds()
    }

    fn constraints(&self) -> usize {
        self.mechanism.system.equations()
    }

    fn evaluate(&mut self, t: f64, q: &[f64], v: &[f64], terms: &mut Terms) -> Result<(), EvalError> {
        let system = &self.mechanism.system;
        let written = system.write_terms(&Instant::new(t, q, v), &mut self.work, &mut self.terms);
        written.map_err(|cause| EvalError::Retry(Box::new(self.mechanism.explain(cause))))?;
        let own = &self.terms;
        terms.matrix.copy_from_slice(&own.mass);
        terms.force.copy_from_slice(&own.force);
        // Multipliers of mechanisms act with the sign of the gradient: the constraints are minus the closure residuals.
        let negative = |target: &mut [f64], source: &[f64]| target.iter_mut().zip(source).for_each(|(t, s)| *t = -s);
        negative(&mut terms.constraint, &own.residual);
        negative(&mut terms.gradient, &own.gradient);
        negative(&mut terms.bias, &own.gamma);
        Ok(())
    }
}
