//! Bearings: how much friction a joint can develop under its force and torque.

mod journal;
mod pad_guide;
mod supports;

pub use journal::{JournalBearing, Surface};
pub use pad_guide::PadGuide;

use crate::ParameterError;
use std::fmt::Debug;
use std::sync::Arc;

/// Friction of a joint for χ = 1, and how it changes with the joint load.
///
/// The friction itself is -χ(v) times `value`, along or about the joint axis. Its unit is that of
/// the joint's own load: N m for a bearing that turns, N for a guide that slides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Capacity {
    /// Capacity \[N m or N\], not negative.
    pub value: f64,
    /// Its gradient with respect to the joint force \[m or -\].
    pub d_force: [f64; 3],
    /// Its gradient with respect to the joint torque \[- or 1/m\].
    pub d_torque: [f64; 3],
}

/// Weights of a capacity that is a sum of three lengths: two supports across the axis z and one along it, all round about it.
///
/// ```text
/// t_f = Σ_i |a_i (f_x, f_y) + b_i (-n_y, n_x)| + |c f_z + d n_z|     across[i] = [a_i, b_i], along = [c, d]
/// ```
///
/// Solvers that look for friction and reactions together are faster where they know them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Supports {
    /// a_i \[m or -\] and b_i \[- or 1/m\] of the supports across the axis.
    pub across: [[f64; 2]; 2],
    /// c \[m or -\] and d \[- or 1/m\] of the support along it.
    pub along: [f64; 2],
}

/// A bearing whose friction depends on the force and torque it transmits.
///
/// Force \[N\] and torque \[N m\] are those exerted on the successor at the joint origin, in the
/// joint frame, whose z axis is the joint axis. Every capacity is positively homogeneous of degree
/// one: a load c times as large, c > 0, gives c times the value and the same gradient, and
/// `value` = `d_force` · force + `d_torque` · torque.
pub trait BearingModel: Debug + Send + Sync {
    /// Capacity and gradient under a joint force and torque.
    fn capacity(&self, force: [f64; 3], torque: [f64; 3]) -> Capacity;

    /// The same capacity as weights of three lengths; `None` where it is not of that kind.
    fn supports(&self) -> Option<Supports> {
        None
    }

    /// Refuses parameters for which [`capacity`](Self::capacity) has no meaning.
    fn validate(&self) -> Result<(), ParameterError> {
        Ok(())
    }
}

/// Any bearing, for choices made at run time.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Bearing {
    /// Two journals and a thrust face.
    Journal(JournalBearing),
    /// Two pads on a slide.
    PadGuide(PadGuide),
    /// The caller's own. It has no serialised form.
    #[cfg_attr(feature = "serde", serde(skip))]
    Custom(Arc<dyn BearingModel>),
}

impl Bearing {
    /// The bearing behind the choice.
    #[inline]
    pub fn model(&self) -> &dyn BearingModel {
        match self {
            Self::Journal(bearing) => bearing,
            Self::PadGuide(bearing) => bearing,
            Self::Custom(bearing) => bearing.as_ref(),
        }
    }
}

impl BearingModel for Bearing {
    #[inline]
    fn capacity(&self, force: [f64; 3], torque: [f64; 3]) -> Capacity {
        self.model().capacity(force, torque)
    }

    fn supports(&self) -> Option<Supports> {
        self.model().supports()
    }

    fn validate(&self) -> Result<(), ParameterError> {
        self.model().validate()
    }
}

impl From<JournalBearing> for Bearing {
    fn from(bearing: JournalBearing) -> Self {
        Self::Journal(bearing)
    }
}

impl From<PadGuide> for Bearing {
    fn from(bearing: PadGuide) -> Self {
        Self::PadGuide(bearing)
    }
}

impl From<Arc<dyn BearingModel>> for Bearing {
    fn from(bearing: Arc<dyn BearingModel>) -> Self {
        Self::Custom(bearing)
    }
}
