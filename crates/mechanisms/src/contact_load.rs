//! What loads with contacts have in common: what is asked of them, and what a contact point keeps between events.

use crate::clearance::ContactPoint;
use linkdyn_dynamics::{Load, Motion};
use linkdyn_friction::Bristle;

/// A load with contact points. Its memory begins with [`kept::COUNT`] numbers a point, its integrals are
/// [`ContactIntegrals`](crate::ContactIntegrals) a point, and each point has one root function.
pub(crate) trait ContactLoad: Load {
    /// What the load is, for messages.
    fn describe(&self) -> String;

    /// Number of contact points.
    fn points(&self) -> usize;

    /// What can be seen of contact point `point`.
    fn observe(&self, motion: &Motion<'_>, point: usize) -> ContactPoint;

    /// Columns of a contact point in result files, as [`ContactPoint`] writes them.
    fn columns(&self) -> &'static [&'static str] {
        ContactPoint::columns(0)
    }

    /// Friction at its points, if there is any.
    fn bristle(&self) -> Option<&Bristle> {
        None
    }

    /// Radial clearance, if it is one \[m\].
    fn clearance(&self) -> Option<f64> {
        None
    }

    /// Whether a point to which nothing has happened yet is in contact.
    fn begins_in_contact(&self, motion: &Motion<'_>, point: usize) -> bool {
        if kept::is_used(motion.internal.memory, point) {
            return false;
        }
        let seen = self.observe(motion, point);
        seen.depth > 0.0 || (seen.depth == 0.0 && seen.rate > 0.0)
    }
}

/// What contact points keep between events, in the memory of their load.
pub(crate) mod kept {
    /// Speed of penetration at the beginning of the contact; zero while apart.
    const IMPACT_SPEED: usize = 0;
    /// Time at which the last contact was lost.
    const LOST: usize = 1;
    /// Number of hops in a row that were too short to matter.
    const HOPS: usize = 2;
    /// Gap that must open before the contact counts as lost.
    const HOLD: usize = 3;
    /// How many numbers a point keeps.
    pub const COUNT: usize = 4;

    /// A hop is short if impact speed times duration, about four times the greatest gap, is below this share of the contact's length.
    const SHORT_HOP: f64 = 1e-3;
    /// After so many short hops in a row the contact is held: it counts as lost only when a gap of [`HELD_GAP`] opens, and until then
    /// the force law, which is continuous and zero across a gap, goes on without events.
    const MOST_HOPS: f64 = 32.0;
    /// Gap that ends a held contact, as a share of the contact's length.
    const HELD_GAP: f64 = 1e-2;

    /// Speed of penetration at the beginning of the contact; zero while apart.
    #[inline]
    pub fn impact_speed(memory: &[f64], point: usize) -> f64 {
        memory[point * COUNT + IMPACT_SPEED]
    }

    /// Whether the contact is held.
    pub fn is_held(memory: &[f64], point: usize) -> bool {
        memory[point * COUNT + HOLD] > 0.0
    }

    /// Whether anything has happened to the point.
    pub fn is_used(memory: &[f64], point: usize) -> bool {
        memory[point * COUNT..(point + 1) * COUNT].iter().any(|&x| x != 0.0)
    }

    /// The point's root function, positive while the contact stays what it is: the gap while apart, the depth while in contact.
    #[inline]
    pub fn root(memory: &[f64], point: usize, gap: f64) -> f64 {
        let kept = &memory[point * COUNT..];
        if kept[IMPACT_SPEED] > 0.0 {
            kept[HOLD] - gap
        } else {
            gap
        }
    }

    /// Makes or loses the contact at `t`, approached at `rate`, and tells whether it is made. By `length`, the clearance or what stands
    /// for it, hops are short or not.
    pub fn switch(memory: &mut [f64], point: usize, t: f64, rate: f64, length: f64) -> bool {
        let kept = &mut memory[point * COUNT..(point + 1) * COUNT];
        if kept[IMPACT_SPEED] > 0.0 {
            kept[IMPACT_SPEED] = 0.0;
            kept[HOLD] = 0.0;
            kept[LOST] = t;
            return false;
        }
        // What only grazes still makes contact; the law has a floor for its speed.
        let speed = rate.max(f64::MIN_POSITIVE);
        kept[IMPACT_SPEED] = speed;
        let short = speed * (t - kept[LOST]) < SHORT_HOP * length;
        kept[HOPS] = if short { kept[HOPS] + 1.0 } else { 0.0 };
        if kept[HOPS] >= MOST_HOPS {
            kept[HOLD] = HELD_GAP * length;
        }
        true
    }
}
