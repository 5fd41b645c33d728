//! Joints of one's own: a list of elementary steps, and the equations that say the same.

use crate::closure::Row;
use crate::joint::Step;
use nalgebra::{Unit, Vector3};

/// One freedom of a joint of one's own; the axis is a unit vector of the joint's frame, carried along by the freedoms before.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub enum JointStep {
    /// Turn \[rad\] about an axis.
    Turn {
        /// The axis.
        axis: Unit<Vector3<f64>>,
    },
    /// Slide \[m\] along an axis.
    Slide {
        /// The axis.
        axis: Unit<Vector3<f64>>,
    },
    /// Turn \[rad\] about an axis with a slide along it in proportion.
    Screw {
        /// The axis.
        axis: Unit<Vector3<f64>>,
        /// Slide for a turn by one radian \[m/rad\].
        pitch: f64,
    },
}

impl JointStep {
    pub(crate) fn axis(&self) -> &Unit<Vector3<f64>> {
        match self {
            JointStep::Turn { axis } | JointStep::Slide { axis } | JointStep::Screw { axis, .. } => axis,
        }
    }

    fn step(self) -> Step {
        match self {
            JointStep::Turn { axis } => Step::Turn(axis),
            JointStep::Slide { axis } => Step::Slide(axis),
            JointStep::Screw { axis, pitch } => Step::Screw(axis, pitch),
        }
    }
}

/// A joint of one's own, for [`crate::Joint::Custom`]: its freedoms one after the other, all through the same point, and the
/// equations that keep everything else from happening when it is cut. Lists longer than six are cut off at seven, which
/// [`crate::Joint::validate`] refuses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Custom {
    freedoms: [Option<JointStep>; 7],
    rows: [Option<Row>; 7],
}

impl Custom {
    /// From freedoms, and equations (none: the joint cannot be cut).
    pub fn new(freedoms: &[JointStep], rows: &[Row]) -> Self {
        Self {
            freedoms: std::array::from_fn(|k| freedoms.get(k).copied()),
            rows: std::array::from_fn(|k| rows.get(k).copied()),
        }
    }

    /// Its freedoms, one after the other.
    pub fn steps(&self) -> impl Iterator<Item = JointStep> + use<> {
        self.freedoms.into_iter().flatten()
    }

    /// Its equations.
    pub fn rows(&self) -> impl Iterator<Item = Row> + use<> {
        self.rows.into_iter().flatten()
    }

    /// Whether freedoms and equations make six, so that the joint may be cut.
    pub fn can_be_cut(&self) -> bool {
        self.steps().count() + self.rows().map(|row| row.equations()).sum::<usize>() == 6
    }

    pub(crate) fn chain(&self) -> [Option<Step>; 6] {
        std::array::from_fn(|k| self.freedoms[k].map(JointStep::step))
    }

    pub(crate) fn is_sound(&self, unit: impl Fn(&Unit<Vector3<f64>>) -> bool) -> bool {
        let pitches = |freedom: JointStep| !matches!(freedom, JointStep::Screw { pitch, .. } if !pitch.is_finite());
        let count = self.steps().count();
        let no_gap = self.freedoms[..count.min(6)].iter().all(Option::is_some);
        let lengths = (1..=6).contains(&count) && (self.rows().next().is_none() || self.can_be_cut());
        lengths && no_gap && self.steps().all(|freedom| unit(freedom.axis()) && pitches(freedom))
    }
}
