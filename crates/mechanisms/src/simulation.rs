//! A mechanism in motion: the initial value problem, and what can be observed at a state.

use crate::error::MotionError;
use crate::mechanism::{Mechanism, State};
use linkdyn_dynamics::{Counters, Drift, Energy, Reaction, Workspace};
use linkdyn_integrators::{EvalError, Ode, SecondOrder, Settings, Tolerance};
use linkdyn_kinematics::Wrench;
use thiserror::Error;

/// A mechanism with scratch of its own; clone it to send it to another thread.
///
/// The state is `y = (q, v, W)`: coordinates, speeds and, where a load is not conservative, the work \[J\] that loads have done
/// on the mechanism since the start. Closures are kept by projection after each step.
#[derive(Clone, Debug)]
pub struct Simulation {
    mechanism: Mechanism,
    work: Workspace,
    coordinates: usize,
    speeds: usize,
    has_work: bool,
    drift_tolerance: f64,
    worst: Worst,
}

/// Absolute tolerance of speeds in units of that of coordinates \[1/s\]: about the speed at which linkages turn. On RSRRR this
/// costs a quarter fewer evaluations for the same error of the crank angle than equal tolerances do.
pub const SPEED_SCALE: f64 = 10.0;

/// Closure residual beyond which a step has left the mechanism \[m, -\]: projection takes drift, which is far smaller.
pub(crate) const OFF_THE_LOOP: f64 = 1e-6;

/// A step so long that its end could not be put back onto the loops.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the step leaves the loops by {0:e}, too far to be put back; a shorter step may help")]
pub struct OffTheLoop(
    /// Largest closure residual that remained \[m, -\].
    pub f64,
);

/// Worst figures met so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// Largest closure residual found before a projection \[m, -\].
    pub position_drift: f64,
    /// Largest closure rate found before a projection \[m/s, 1/s\].
    pub velocity_drift: f64,
    /// Largest relative residual of the loop reaction - friction - acceleration over all evaluations.
    pub friction_residual: f64,
}

/// What a mechanism does at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observation {
    /// Time \[s\].
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Speeds.
    pub v: Vec<f64>,
    /// Rates of the speeds.
    pub a: Vec<f64>,
    /// Multipliers of all loops.
    pub multipliers: Vec<f64>,
    /// Reactions on the successor of each joint at the joint's origin, in axes of the successor link.
    pub reactions: Vec<Reaction>,
    /// Friction torques or forces of the joints with friction, with the sign of the speed that they oppose.
    pub friction: Vec<f64>,
    /// Energies.
    pub energy: Energy,
    /// Work done on the mechanism by drives, friction and damping since the start \[J\].
    pub work: f64,
    /// Largest closure residual and rate.
    pub violation: (f64, f64),
}

impl Simulation {
    /// A simulation of `mechanism`.
    pub fn new(mechanism: &Mechanism) -> Self {
        let system = mechanism.system();
        let conservative = system.loads().iter().all(|load| load.is_conservative());
        Self {
            work: Workspace::new(system),
            coordinates: system.tree().coordinates(),
            speeds: system.tree().speeds(),
            has_work: !conservative || mechanism.has_friction(),
            drift_tolerance: 0.0,
            worst: Worst::default(),
            mechanism: mechanism.clone(),
        }
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }

    /// The state vector of a start, with no work done yet.
    pub fn state_vector(&self, state: &State) -> Vec<f64> {
        let mut y = [state.q.as_slice(), state.v.as_slice()].concat();
        if self.has_work {
            y.push(0.0);
        }
        y
    }

    /// Number of coordinates at the head of the state vector.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Number of speeds that follow.
    pub fn speeds(&self) -> usize {
        self.speeds
    }

    /// Whether the work stands at the end of the state vector.
    pub fn has_work(&self) -> bool {
        self.has_work
    }

    /// Tolerances for an integration: `relative` for all of the state, `absolute` for coordinates \[rad, m\], [`SPEED_SCALE`] times
    /// that for speeds. The work at the end of the state follows the motion and is not controlled.
    pub fn settings(&self, relative: f64, absolute: f64) -> Settings {
        let mut components = vec![absolute; self.coordinates];
        components.resize(self.coordinates + self.speeds, SPEED_SCALE * absolute);
        components.extend(self.has_work.then_some(f64::INFINITY));
        Settings {
            absolute: Tolerance::from(components),
            ..Settings::tolerances(relative, absolute)
        }
    }

    /// Lets steps leave closure residuals and rates up to this size \[m, m/s, -\] instead of projecting every one; zero, the
    /// default, projects always. Observed states are put on the closures in any case.
    pub fn set_drift_tolerance(&mut self, tolerance: f64) {
        self.drift_tolerance = tolerance;
    }

    /// Work counters since the start, observations included.
    pub fn counters(&self) -> Counters {
        self.work.counters()
    }

    /// Worst figures since the start.
    pub fn worst(&self) -> Worst {
        self.worst
    }

    /// Accelerations at a state.
    ///
    /// # Errors
    /// [`MotionError`] where they do not exist.
    pub fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<&[f64], MotionError> {
        let evaluated = self.mechanism.system.evaluate(t, q, v, &mut self.work);
        evaluated.map_err(|cause| self.mechanism.explain(cause))?;
        Ok(self.work.rates())
    }

    /// Puts a state vector back onto the closures.
    pub fn put_on_closures(&mut self, y: &mut [f64]) -> Drift {
        self.project_beyond(0.0, y)
    }

    fn project_beyond(&mut self, tolerance: f64, y: &mut [f64]) -> Drift {
        let (q, rest) = y.split_at_mut(self.coordinates);
        let (system, v) = (&self.mechanism.system, &mut rest[..self.speeds]);
        let drift = system.project_beyond(tolerance, q, v, &mut self.work);
        self.worst.position_drift = self.worst.position_drift.max(drift.position);
        self.worst.velocity_drift = self.worst.velocity_drift.max(drift.velocity);
        drift
    }

    /// All that can be said of the mechanism at `t` and state vector `y`.
    ///
    /// # Errors
    /// [`MotionError`] where the accelerations do not exist.
    pub fn observe(&mut self, t: f64, y: &[f64], observation: &mut Observation) -> Result<(), MotionError> {
        let system = &self.mechanism.system;
        let (q, rest) = y.split_at(self.coordinates);
        let (v, work) = rest.split_at(self.speeds);
        let o = observation;
        o.violation = system.violation(q, v, &mut self.work);
        let evaluated = system.evaluate(t, q, v, &mut self.work);
        evaluated.map_err(|cause| self.mechanism.explain(cause))?;
        system.reactions(&mut self.work);
        o.t = t;
        replace(&mut o.q, q);
        replace(&mut o.v, v);
        replace(&mut o.a, self.work.rates());
        replace(&mut o.multipliers, self.work.multipliers());
        o.reactions.clear();
        for joint in &self.mechanism.joints {
            let reaction = system.reaction(joint.link, &self.work);
            let to_link = joint.to_link.rotation;
            o.reactions.push(Wrench {
                torque: to_link.tr_mul(&reaction.torque),
                force: to_link.tr_mul(&reaction.force),
            });
        }
        o.friction.clear();
        // Results show friction with the sign of the speed; the generalised force opposes it.
        o.friction.extend(self.work.reaction_loads().iter().map(|force| -force));
        o.energy = system.energy(t, q, v);
        o.work = work.first().copied().unwrap_or(0.0);
        Ok(())
    }

    /// Names of the numbers of an [`Observation`] in the order of [`Observation::write`], as result files have them.
    /// Reactions are listed only `with_reactions`.
    pub fn columns(&self, with_reactions: bool) -> Vec<String> {
        let mechanism = &self.mechanism;
        let mut names = vec!["t".to_owned()];
        let speeds = || mechanism.speeds.iter();
        names.extend(mechanism.coordinate_names().map(|name| format!("q.{name}")));
        names.extend(speeds().map(|name| format!("v.{name}")));
        names.extend(speeds().map(|name| format!("a.{name}")));
        for cut in &mechanism.loops {
            names.extend(cut.components.iter().map(|c| format!("lambda.{}.{c}", cut.name)));
        }
        if with_reactions {
            for joint in &mechanism.joints {
                names.extend(["fx", "fy", "fz", "nx", "ny", "nz"].map(|c| format!("reaction.{}.{c}", joint.name)));
            }
        }
        names.extend(mechanism.friction_names().map(|name| format!("friction.{name}")));
        names.extend(["kinetic", "potential", "elastic", "work"].map(|c| format!("energy.{c}")));
        if !mechanism.loops.is_empty() {
            names.extend(["position", "velocity"].map(|c| format!("violation.{c}")));
        }
        names
    }
}

fn replace(target: &mut Vec<f64>, source: &[f64]) {
    target.clear();
    target.extend_from_slice(source);
}

impl Observation {
    /// Kinetic, potential and stored energy less the work done: constant for every mechanism \[J\].
    pub fn energy_balance(&self) -> f64 {
        self.energy.total() - self.work
    }

    /// Writes all numbers in the order of [`Simulation::columns`].
    pub fn write(&self, with_reactions: bool, row: &mut Vec<f64>) {
        row.clear();
        row.push(self.t);
        row.extend(self.q.iter().chain(&self.v).chain(&self.a).chain(&self.multipliers));
        if with_reactions {
            for reaction in &self.reactions {
                row.extend(reaction.force.iter().chain(reaction.torque.iter()));
            }
        }
        row.extend(&self.friction);
        let energy = &self.energy;
        row.extend([energy.kinetic, energy.potential, energy.elastic, self.work]);
        if !self.multipliers.is_empty() {
            row.extend([self.violation.0, self.violation.1]);
        }
    }
}

impl Ode for Simulation {
    fn dim(&self) -> usize {
        self.coordinates + self.speeds + usize::from(self.has_work)
    }

    #[inline]
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        let system = &self.mechanism.system;
        let (q, rest) = y.split_at(self.coordinates);
        let v = &rest[..self.speeds];
        // A trial state may lie where the mechanism jams or stretches; a shorter step may not.
        let evaluated = system.evaluate(t, q, v, &mut self.work);
        evaluated.map_err(|cause| EvalError::Retry(Box::new(self.mechanism.explain(cause))))?;
        let (q_rate, rest) = dy.split_at_mut(self.coordinates);
        let (v_rate, work_rate) = rest.split_at_mut(self.speeds);
        system.tree().coordinate_rates(q, v, q_rate);
        v_rate.copy_from_slice(self.work.rates());
        if let Some(rate) = work_rate.first_mut() {
            *rate = self.work.power();
        }
        self.worst.friction_residual = self.worst.friction_residual.max(self.work.reaction_residual());
        Ok(())
    }

    fn project(&mut self, _t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        let drift = self.project_beyond(self.drift_tolerance, y);
        if drift.remaining > OFF_THE_LOOP {
            return Err(EvalError::Retry(Box::new(OffTheLoop(drift.remaining))));
        }
        Ok(drift.changed)
    }
}

impl SecondOrder for Simulation {
    /// All coordinates, or none where the speeds are not their rates (ball joints with quaternions).
    fn pairs(&self) -> usize {
        if self.coordinates == self.speeds {
            self.speeds
        } else {
            0
        }
    }
}
