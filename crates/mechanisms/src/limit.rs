//! Stops on a joint coordinate: what it may not pass pushes back by a contact law.

use crate::clearance::{ContactIntegrals, ContactPoint};
use crate::contact_load::{ContactLoad, kept};
use linkdyn_contact::{ContactLaw, NormalForce, NormalModel, ParameterError};
use linkdyn_dynamics::{Internals, Load, Loads, Motion};
use thiserror::Error;

/// Stops at one or both ends of a coordinate's way. Beyond a stop the contact law pushes back: depths are in rad or m, forces in
/// N m or N, and the law's units with them. Contacts are made and lost at located events; they are called `JOINT.lower` and
/// `JOINT.upper` in results.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Limit {
    /// Where the coordinate meets the lower stop \[rad, m\]; none if absent.
    pub lower: Option<f64>,
    /// Where it meets the upper stop \[rad, m\]; none if absent.
    pub upper: Option<f64>,
    /// Force over penetration and its rate.
    pub law: ContactLaw,
}

/// What is wrong with a limit.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LimitError {
    /// A parameter of the contact law.
    #[error("contact law: {0}")]
    Law(#[from] ParameterError),
    /// Neither stop is there.
    #[error("give a lower stop, an upper stop or both")]
    NoStop,
    /// The stops are not where they should be.
    #[error("the stops {lower} and {upper} must be finite, the lower below the upper")]
    Stops {
        /// Lower stop, minus infinity if absent.
        lower: f64,
        /// Upper stop, infinity if absent.
        upper: f64,
    },
}

/// Length by which hops are short or not \[rad, m\]: the usual size of a clearance. Hops shorter than a thousandth of it are too short
/// to matter for a machine.
const LENGTH: f64 = 1e-3;

impl Limit {
    pub(crate) fn validate(&self) -> Result<(), LimitError> {
        self.law.validate()?;
        if self.lower.is_none() && self.upper.is_none() {
            return Err(LimitError::NoStop);
        }
        let (lower, upper) = (
            self.lower.unwrap_or(-f64::INFINITY),
            self.upper.unwrap_or(f64::INFINITY),
        );
        let finite = self.lower.into_iter().chain(self.upper).all(f64::is_finite);
        if finite && lower < upper {
            Ok(())
        } else {
            Err(LimitError::Stops { lower, upper })
        }
    }

    /// Names of its contact points on joint `joint`.
    pub(crate) fn point_names(&self, joint: &str) -> impl Iterator<Item = String> + use<> {
        let joint = joint.to_owned();
        let sides = [(self.lower, "lower"), (self.upper, "upper")];
        let there = sides.into_iter().filter(|(stop, _)| stop.is_some());
        there.map(move |(_, side)| format!("{joint}.{side}"))
    }
}

/// The stops of one coordinate as a load.
#[derive(Clone, Debug)]
pub(crate) struct LimitStops {
    joint: String,
    coordinate: usize,
    speed: usize,
    /// Where each stop is, and the direction in which it pushes: 1 for a lower one, -1 for an upper one.
    stops: Vec<(f64, f64)>,
    law: ContactLaw,
    length: f64,
}

impl LimitStops {
    pub fn new(joint: &str, limit: &Limit, coordinate: usize, speed: usize) -> Self {
        let lower = limit.lower.map(|stop| (stop, 1.0));
        let upper = limit.upper.map(|stop| (stop, -1.0));
        let way = limit
            .lower
            .zip(limit.upper)
            .map_or(LENGTH, |(lower, upper)| upper - lower);
        Self {
            joint: joint.to_owned(),
            coordinate,
            speed,
            stops: lower.into_iter().chain(upper).collect(),
            law: limit.law.clone(),
            length: way.min(LENGTH),
        }
    }

    /// Depth and its rate at a stop.
    #[inline]
    fn depth(&self, motion: &Motion<'_>, point: usize) -> (f64, f64) {
        let (stop, side) = self.stops[point];
        let (q, v) = (motion.q[self.coordinate], motion.v[self.speed]);
        (side * (stop - q), -side * v)
    }

    /// Force at a stop that is in contact, with its depth's rate.
    #[inline]
    fn force(&self, motion: &Motion<'_>, point: usize) -> Option<(NormalForce, f64)> {
        let impact_speed = kept::impact_speed(motion.internal.memory, point);
        let (depth, rate) = self.depth(motion, point);
        (impact_speed > 0.0).then(|| (self.law.at(depth, rate, impact_speed), rate))
    }
}

impl ContactLoad for LimitStops {
    fn describe(&self) -> String {
        format!("joint `{}` has a limit", self.joint)
    }

    fn points(&self) -> usize {
        self.stops.len()
    }

    fn observe(&self, motion: &Motion<'_>, point: usize) -> ContactPoint {
        let (depth, rate) = self.depth(motion, point);
        ContactPoint {
            depth,
            rate,
            normal: self.force(motion, point).map_or(0.0, |(force, _)| force.value),
            impact_speed: kept::impact_speed(motion.internal.memory, point),
            ..ContactPoint::default()
        }
    }
}

impl Load for LimitStops {
    fn internals(&self) -> Internals {
        let points = self.points();
        Internals {
            states: 0,
            integrals: points * ContactIntegrals::COUNT,
            memory: points * kept::COUNT,
            roots: points,
        }
    }

    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        for (point, &(_, side)) in self.stops.iter().enumerate() {
            let Some((force, rate)) = self.force(motion, point) else {
                continue;
            };
            loads.add(self.speed, side * force.value);
            let storing = force.elastic * rate;
            loads.stores(storing);
            let integrals = ContactIntegrals {
                damping_loss: force.value * rate - storing,
                friction_loss: 0.0,
                impulse: force.value,
                square: force.value * force.value,
            };
            integrals.write(&mut loads.integral_rates[point * ContactIntegrals::COUNT..]);
        }
    }

    fn potential_energy(&self, motion: &Motion<'_>) -> f64 {
        let touching = (0..self.points()).filter(|&point| kept::impact_speed(motion.internal.memory, point) > 0.0);
        touching
            .map(|point| self.law.stored_energy(self.depth(motion, point).0))
            .sum()
    }

    fn roots(&self, motion: &Motion<'_>, roots: &mut [f64]) {
        for (point, root) in roots.iter_mut().enumerate() {
            *root = kept::root(motion.internal.memory, point, -self.depth(motion, point).0);
        }
    }

    fn at_event(&self, motion: &Motion<'_>, fired: &[bool], _states: &mut [f64], memory: &mut [f64]) {
        for point in (0..self.points()).filter(|&point| fired[point]) {
            let (_, rate) = self.depth(motion, point);
            kept::switch(memory, point, motion.t, rate, self.length);
        }
    }
}
