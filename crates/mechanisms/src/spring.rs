//! Springs and dampers on joint coordinates.

use linkdyn_dynamics::{Load, Loads, Motion};

/// A spring with a damper on one coordinate: `-stiffness (q - rest) - damping v`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Spring {
    /// Stiffness \[N m/rad, N/m\].
    pub stiffness: f64,
    /// Damping \[N m s/rad, N s/m\].
    pub damping: f64,
    /// Coordinate at which the spring is relaxed \[rad, m\]; zero unless given.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rest: f64,
}

impl Spring {
    /// First parameter that is out of range: its name, value and what would be right.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        if !self.rest.is_finite() {
            return Some(("rest", self.rest, "a finite number"));
        }
        let parameters = [("stiffness", self.stiffness), ("damping", self.damping)];
        let wrong = parameters
            .into_iter()
            .find(|(_, value)| !(value.is_finite() && *value >= 0.0));
        wrong.map(|(name, value)| (name, value, "a finite number that is not negative"))
    }
}

/// All springs of a linkage: one load, since flexible links bring many.
#[derive(Clone, Debug)]
pub(crate) struct JointSprings(pub Vec<Placed>);

/// A spring with the coordinate and the speed on which it acts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub coordinate: usize,
    pub speed: usize,
    pub spring: Spring,
}

impl Load for JointSprings {
    #[inline]
    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        let mut storing = 0.0;
        for placed in &self.0 {
            let (q, v) = (motion.q[placed.coordinate], motion.v[placed.speed]);
            let elastic = placed.spring.stiffness * (q - placed.spring.rest);
            loads.add(placed.speed, -elastic - placed.spring.damping * v);
            storing += elastic * v;
        }
        loads.stores(storing);
    }

    fn potential_energy(&self, motion: &Motion<'_>) -> f64 {
        let energy = |placed: &Placed| {
            let way = motion.q[placed.coordinate] - placed.spring.rest;
            0.5 * placed.spring.stiffness * way * way
        };
        self.0.iter().map(energy).sum()
    }
}
