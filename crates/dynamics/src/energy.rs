//! Energies.

use crate::load::{Instant, InternalState, Motion};
use crate::system::System;
use linkdyn_kinematics::{Positions, Velocities};

/// Energies of a system \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Potential energy of weight, zero for centres of mass at the global origin.
    pub potential: f64,
    /// Energy stored by loads (springs, contacts).
    pub elastic: f64,
}

impl Energy {
    /// Sum of all.
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential + self.elastic
    }
}

impl System {
    /// Energies at a state; loads with internals are taken as at their beginning.
    pub fn energy(&self, t: f64, q: &[f64], v: &[f64]) -> Energy {
        self.energy_with(&Instant::new(t, q, v))
    }

    /// Energies at a state with the internal states and the memory of all loads.
    pub fn energy_with(&self, at: &Instant<'_>) -> Energy {
        let Instant { t, q, v, internal } = *at;
        let mut positions = Positions::new(&self.tree);
        let mut velocities = Velocities::new(&self.tree);
        self.tree.positions(q, &mut positions);
        self.tree.velocities(&positions, v, &mut velocities);
        let mut energy = Energy::default();
        for ((link, _), inertia) in self.tree.joints().iter().zip(&self.inertias) {
            let (pose, twist) = (positions.pose(*link), velocities.nodes()[link.node()]);
            let arm = pose.rotation * inertia.com;
            let speed = twist.linear + twist.angular.cross(&arm);
            let w = pose.rotation.tr_mul(&twist.angular);
            energy.kinetic += 0.5 * (inertia.mass * speed.norm_squared() + w.dot(&(inertia.about_com * w)));
            energy.potential -= inertia.mass * self.gravity.dot(&(pose.origin + arm));
        }
        let motion = Motion {
            t,
            q,
            v,
            positions: &positions,
            velocities: &velocities,
            internal: InternalState::default(),
        };
        for (k, load) in self.loads.iter().enumerate() {
            let place = k.checked_sub(self.plain_loads).and_then(|k| self.places.get(k));
            energy.elastic += match place {
                Some(place) => load.potential_energy(&self.seen_by(place, &motion, internal)),
                None => load.potential_energy(&motion),
            };
        }
        energy
    }
}
