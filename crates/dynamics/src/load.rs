//! Loads: whatever pushes links and joints apart from weight and the reactions of joints.

use linkdyn_kinematics::{LinkId, Positions, Velocities, Wrench};
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
}

/// Where loads put their forces. Loads add, they never assign.
#[derive(Debug)]
pub struct Loads<'a> {
    pub(crate) generalised: &'a mut [f64],
    /// Minus the outside wrenches, a node each, at the node's origin.
    pub(crate) counter: &'a mut [Wrench],
    /// Whether any wrench was added.
    pub(crate) on_links: bool,
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

    /// Power of all loads added so far \[W\].
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
        power
    }
}

/// A load that depends on time, position and velocity. It holds parameters only: all memory is in the state.
pub trait Load: Debug + Send + Sync {
    /// Adds the load's forces.
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>);

    /// Whether the load is the gradient of an energy. Its energy then counts as stored; the power of all other loads counts
    /// as work done on the system.
    fn is_conservative(&self) -> bool {
        false
    }

    /// Stored energy of a conservative load \[J\].
    fn potential_energy(&self, _motion: &Motion<'_>) -> f64 {
        0.0
    }

    /// Times at which the load, or a derivative of it, jumps: steps should end there \[s\].
    fn stop_times(&self) -> Vec<f64> {
        Vec::new()
    }
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

/// A load on one joint that depends on the reaction which it helps to cause, such as dry friction: the generalised force is
/// `-gain(speed) * capacity(reaction)`. These loads are found together with the accelerations, at every evaluation.
pub trait ReactionLoad: Debug + Send + Sync {
    /// Share of the capacity that acts at a joint speed \[rad/s or m/s\], with the sign of the speed.
    fn gain(&self, speed: f64) -> f64;

    /// Capacity for a reaction.
    fn capacity(&self, reaction: &Reaction) -> Capacity;
}
