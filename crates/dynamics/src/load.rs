//! Loads: whatever pushes links and joints apart from weight and the reactions of joints.

use linkdyn_kinematics::{Attachment, LinkId, Positions, Velocities, Wrench};
use nalgebra::Vector3;
use std::fmt::Debug;

/// What a load may look at.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Time \[s\].
    pub t: f64,
    /// Coordinates.
    pub q: &'a [f64],
    /// Speeds.
    pub v: &'a [f64],
    /// Positions of all links.
    pub positions: &'a Positions,
    /// Velocities of all links.
    pub velocities: &'a Velocities,
    /// Internal states and memory of the load that is asked; empty for those that have none.
    pub internal: InternalState<'a>,
}

impl Motion<'_> {
    /// How the origin of a frame on a link moves, in global axes.
    #[inline]
    pub fn origin(&self, frame: &Attachment) -> Moving {
        let node = &self.positions.nodes()[frame.link.node()];
        let twist = &self.velocities.nodes()[frame.link.node()];
        let arm = node.rotation * frame.pose.origin;
        Moving {
            arm,
            point: node.origin + arm,
            velocity: twist.linear + twist.angular.cross(&arm),
        }
    }
}

/// A point of a link in motion, global axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving {
    /// From the origin of the link \[m\]: the arm of forces that are [added](Loads::add_wrench) there.
    pub arm: Vector3<f64>,
    /// Where it is \[m\].
    pub point: Vector3<f64>,
    /// Its velocity \[m/s\].
    pub velocity: Vector3<f64>,
}

/// A state of a system at a time, with all that its loads keep.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a> {
    /// Time \[s\].
    pub t: f64,
    /// Coordinates.
    pub q: &'a [f64],
    /// Speeds.
    pub v: &'a [f64],
    /// Internal states and memory of all loads; where a slice is too short, zeros are taken for all of it.
    pub internal: InternalState<'a>,
}

impl<'a> Instant<'a> {
    /// A state in which loads have kept nothing yet.
    pub fn new(t: f64, q: &'a [f64], v: &'a [f64]) -> Self {
        let internal = InternalState::default();
        Self { t, q, v, internal }
    }
}

/// How many numbers a load keeps beside the motion; none by default. They belong to the state of whoever integrates, so that
/// steps can be tried and thrown away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Internals {
    /// States with rates of their own, such as the deflection of a bristle.
    pub states: usize,
    /// Integrals over time on which nothing depends, such as energy lost.
    pub integrals: usize,
    /// Numbers that change at events only, such as the speed at the beginning of a contact. All start from zero.
    pub memory: usize,
    /// Root functions: an event is where one of them, having been positive, becomes negative.
    pub roots: usize,
}

impl Internals {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Internal states and memory, of one load or of all of them one after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct InternalState<'a> {
    /// States with rates of their own.
    pub states: &'a [f64],
    /// Numbers that change at events only.
    pub memory: &'a [f64],
}

/// Where loads put their forces. Loads add, they never assign.
#[derive(Debug)]
pub struct Loads<'a> {
    pub(crate) generalised: &'a mut [f64],
    /// Minus the outside wrenches, a node each, at the node's origin.
    pub(crate) counter: &'a mut [Wrench],
    /// Whether any wrench was added.
    pub(crate) on_links: bool,
    /// Power that goes into energy stored by loads \[W\].
    pub(crate) storing: f64,
    /// Why a load has no meaning here.
    pub(crate) refused: Option<String>,
    /// Rates of the internal states of the load that is asked; zero before it is.
    pub state_rates: &'a mut [f64],
    /// Rates of its integrals; zero before it is asked.
    pub integral_rates: &'a mut [f64],
}

impl Loads<'_> {
    /// Adds a generalised force on a speed \[N m or N\].
    #[inline]
    pub fn add(&mut self, speed: usize, force: f64) {
        self.generalised[speed] += force;
    }

    /// Adds a wrench on a link, at the link's origin, in global axes.
    #[inline]
    pub fn add_wrench(&mut self, link: LinkId, at_origin: Wrench) {
        self.counter[link.node()] -= at_origin;
        self.on_links = true;
    }

    /// Tells that power \[W\] goes into the load's [stored energy](Load::potential_energy) and thus is no work done on the system.
    /// Conservative loads need not say so.
    #[inline]
    pub fn stores(&mut self, power: f64) {
        self.storing += power;
    }

    /// Refuses this state: the load has no meaning here. The evaluation then fails with the first such reason.
    #[cold]
    pub fn refuse(&mut self, reason: impl Into<String>) {
        self.refused.get_or_insert_with(|| reason.into());
    }

    /// Power of all loads added so far that is not stored \[W\].
    #[inline]
    pub(crate) fn power(&self, motion: &Motion<'_>) -> f64 {
        let mut power: f64 = self.generalised.iter().zip(motion.v).map(|(f, v)| f * v).sum();
        if self.on_links {
            let twists = motion.velocities.nodes();
            power -= self
                .counter
                .iter()
                .zip(twists)
                .map(|(wrench, twist)| wrench.power(twist))
                .sum::<f64>();
        }
        power + self.storing
    }
}

/// A load that depends on time, position and velocity. It holds parameters only: all memory is in the state.
pub trait Load: Debug + Send + Sync {
    /// Adds the load's forces.
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>);

    /// Whether the load is the gradient of its [stored energy](Load::potential_energy). The power of all other loads counts as
    /// work done on the system, less what they [store](Loads::stores).
    fn is_conservative(&self) -> bool {
        false
    }

    /// Energy that the load stores \[J\]. A load that is not conservative must tell its rate by [`Loads::stores`], or the energy
    /// balance does not close.
    fn potential_energy(&self, _motion: &Motion<'_>) -> f64 {
        0.0
    }

    /// Times at which the load, or a derivative of it, jumps: steps should end there \[s\].
    fn stop_times(&self) -> Vec<f64> {
        Vec::new()
    }

    /// How many numbers the load keeps beside the motion.
    fn internals(&self) -> Internals {
        Internals::default()
    }

    /// Writes the load's root functions.
    fn roots(&self, _motion: &Motion<'_>, _roots: &mut [f64]) {}

    /// Changes the load's internal states and memory at an event: `fired` tells which of its root functions met zero, `motion`
    /// holds states and memory as they were before.
    fn at_event(&self, _motion: &Motion<'_>, _fired: &[bool], _states: &mut [f64], _memory: &mut [f64]) {}
}

/// The force and torque that a reaction-dependent load sees: those on the joint's successor by its predecessor, at the
/// joint's origin, in the successor's axes (the papers' f and n).
pub type Reaction = Wrench;

/// Size of a load for unit gain, and its gradient with respect to the reaction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capacity {
    /// Size \[N m or N\].
    pub value: f64,
    /// Its gradient; `force` holds d value/d force, `torque` d value/d torque.
    pub gradient: Wrench,
}

/// What carries a reaction where all parts are round about the z axis: two supports across it and one along it. The capacity
/// is a sum of lengths, with `z` the unit vector of the axis:
///
/// `sum over i of |a_i f + b_i z x n|, parts across z, + |c f_z + d n_z|`, `across[i] = [a_i, b_i]`, `along = [c, d]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Supports {
    /// Weights of force and torque on the two supports across the axis \[m and -, or - and 1/m\].
    pub across: [[f64; 2]; 2],
    /// Weights of force and torque on the one along it \[m and -, or - and 1/m\].
    pub along: [f64; 2],
}

impl Supports {
    /// All weights, those along the axis last.
    pub(crate) fn weights(&self) -> [f64; 6] {
        let [[a1, b1], [a2, b2]] = self.across;
        let [c, d] = self.along;
        [a1, b1, a2, b2, c, d]
    }
}

/// A load on one joint that depends on the reaction which it helps to cause, such as dry friction: the generalised force is
/// `-gain(speed) * capacity(reaction)`. These loads are found together with the accelerations, at every evaluation.
pub trait ReactionLoad: Debug + Send + Sync {
    /// Share of the capacity that acts at a joint speed \[rad/s or m/s\], with the sign of the speed.
    fn gain(&self, speed: f64) -> f64;

    /// Capacity for a reaction.
    fn capacity(&self, reaction: &Reaction) -> Capacity;

    /// The supports whose sum [`ReactionLoad::capacity`] is, if it is one. Where all loads of a system tell them, they are
    /// found several times as fast. Asked for once, when a workspace is made.
    fn supports(&self) -> Option<Supports> {
        None
    }
}
