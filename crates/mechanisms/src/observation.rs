//! What can be observed at a state, and the columns in which result files list it.

use crate::clearance::ContactPoint;
use crate::error::MotionError;
use crate::mechanism::Mechanism;
use crate::simulation::Simulation;
use linkdyn_dynamics::{Energy, Instant, Reaction, Workspace};
use linkdyn_kinematics::Wrench;

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
    /// Multipliers of all loops, then of the prescribed motions.
    pub multipliers: Vec<f64>,
    /// Reactions on the successor of each joint at the joint's origin, in axes of the successor link. Contacts of a joint with
    /// clearance are loads: its reaction is what it holds besides.
    pub reactions: Vec<Reaction>,
    /// Friction torques or forces of the joints with friction, with the sign of the speed that they oppose.
    pub friction: Vec<f64>,
    /// Contact points of joints with limits or clearance.
    pub contacts: Vec<ContactPoint>,
    /// Energies.
    pub energy: Energy,
    /// Work done on the mechanism by drives, friction and damping since the start \[J\].
    pub work: f64,
    /// Integrals of loads since the start.
    pub integrals: Vec<f64>,
    /// Internal states of loads.
    pub states: Vec<f64>,
    /// What loads had kept since the last event.
    pub memory: Vec<f64>,
    /// Largest closure residual and rate.
    pub violation: (f64, f64),
}

impl Simulation {
    /// All that can be said of the mechanism at `t` and state vector `y`.
    ///
    /// # Errors
    /// [`MotionError`] where the accelerations do not exist.
    pub fn observe(&mut self, t: f64, y: &[f64], observation: &mut Observation) -> Result<(), MotionError> {
        let system = &self.mechanism.system;
        let at = self.layout.instant(t, y, self.memory.at(t));
        let o = observation;
        o.violation = system.violation(at.t, at.q, at.v, &mut self.work);
        let evaluated = system.evaluate_with(&at, &mut self.work);
        evaluated.map_err(|cause| self.mechanism.explain(cause))?;
        system.reactions(&mut self.work);
        o.t = t;
        replace(&mut o.q, at.q);
        replace(&mut o.v, at.v);
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
        o.energy = system.energy_with(&at);
        contact_points(&self.mechanism, &at, &mut self.work, &mut o.contacts);
        o.work = y[self.layout.work.clone()].first().copied().unwrap_or(0.0);
        replace(&mut o.integrals, &y[self.layout.integrals.clone()]);
        replace(&mut o.states, at.internal.states);
        replace(&mut o.memory, at.internal.memory);
        Ok(())
    }

    /// The state vector of an observation; the memory of loads becomes that of its time, so that a run may go on from there.
    ///
    /// # Panics
    /// If the observation is that of another mechanism.
    pub fn restore(&mut self, observation: &Observation) -> Vec<f64> {
        let (o, layout) = (observation, self.layout.clone());
        let mut y = vec![0.0; layout.len()];
        y[layout.coordinates.clone()].copy_from_slice(&o.q);
        y[layout.speeds.clone()].copy_from_slice(&o.v);
        if let Some(work) = y[layout.work.clone()].first_mut() {
            *work = o.work;
        }
        y[layout.states.clone()].copy_from_slice(&o.states);
        y[layout.integrals.clone()].copy_from_slice(&o.integrals);
        self.set_memory(&o.memory);
        y
    }

    /// Contact points of joints with limits or clearance at `t` and state vector `y`.
    pub fn contact_points(&mut self, t: f64, y: &[f64], points: &mut Vec<ContactPoint>) {
        let at = self.layout.instant(t, y, self.memory.at(t));
        contact_points(&self.mechanism, &at, &mut self.work, points);
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
        names.extend(mechanism.prescribed_names().map(|name| format!("lambda.{name}.drive")));
        if with_reactions {
            for joint in &mechanism.joints {
                names.extend(["fx", "fy", "fz", "nx", "ny", "nz"].map(|c| format!("reaction.{}.{c}", joint.name)));
            }
        }
        names.extend(mechanism.friction_names().map(|name| format!("friction.{name}")));
        for contact in &mechanism.contacts {
            for name in &contact.names {
                let columns = contact.load.columns().iter();
                names.extend(columns.map(|column| format!("contact.{name}.{column}")));
            }
        }
        names.extend(["kinetic", "potential", "elastic", "work"].map(|c| format!("energy.{c}")));
        if mechanism.system.equations() > 0 {
            names.extend(["position", "velocity"].map(|c| format!("violation.{c}")));
        }
        names
    }
}

/// Limits and clearances are the first of the loads with internals.
fn contact_points(mechanism: &Mechanism, at: &Instant<'_>, work: &mut Workspace, points: &mut Vec<ContactPoint>) {
    points.clear();
    if mechanism.contacts.is_empty() {
        return;
    }
    let mut contacts = mechanism.contacts.iter();
    mechanism.system.ask_loads(at, work, |_, motion, _| {
        if let Some(contact) = contacts.next() {
            points.extend((0..contact.load.points()).map(|point| contact.load.observe(motion, point)));
        }
    });
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
        for point in &self.contacts {
            point.write(row);
        }
        let energy = &self.energy;
        row.extend([energy.kinetic, energy.potential, energy.elastic, self.work]);
        if !self.multipliers.is_empty() {
            row.extend([self.violation.0, self.violation.1]);
        }
    }
}
