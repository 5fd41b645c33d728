//! Joints, and the elementary steps they are made of.
//!
//! A joint lets its successor move in a linear subspace of twists. Here each joint is a short chain of **steps** with one
//! freedom each (a turn about an axis, a slide along one); between the steps of one joint there is nothing. The
//! recursions then know two kinds of freedom and no kinds of joints, and a new joint is a new list of steps.

use crate::{Pose, TreeError};
use nalgebra::{Matrix3, Unit, Vector3};

/// A joint between two links. Axes are unit vectors in the joint's frame on the predecessor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub enum Joint {
    /// No freedom.
    Fixed,
    /// One turn \[rad\].
    Revolute {
        /// Axis of the turn.
        axis: Unit<Vector3<f64>>,
    },
    /// One slide \[m\].
    Prismatic {
        /// Direction of the slide.
        axis: Unit<Vector3<f64>>,
    },
    /// One turn \[rad\] about an axis with a slide along it in proportion.
    Screw {
        /// Axis of turn and slide.
        axis: Unit<Vector3<f64>>,
        /// Slide for a turn by one radian \[m/rad\]: the lead over 2 pi, negative for a left-hand thread.
        pitch: f64,
    },
    /// Slide \[m\] along and turn \[rad\] about the same axis, in this order.
    Cylindrical {
        /// The common axis.
        axis: Unit<Vector3<f64>>,
    },
    /// Turn about `first` (fixed in the predecessor), then about `second` (fixed in the successor) \[rad\].
    Universal {
        /// Axis on the predecessor.
        first: Unit<Vector3<f64>>,
        /// Axis on the successor, given at zero angles.
        second: Unit<Vector3<f64>>,
    },
    /// Three turns `Rz(psi) Ry(theta) Rx(phi)` \[rad\], the papers' form; singular at `theta = ±pi/2`.
    SphericalZyx,
    /// Ball joint without singularity: a quaternion (w, x, y, z) as coordinates and the angular velocity relative to the
    /// predecessor, in axes of the successor, as speeds \[rad/s\].
    Spherical,
    /// Motion in a plane: slides \[m\] along `along` and `normal x along`, then a turn \[rad\] about `normal`.
    Planar {
        /// Direction of the first slide, at right angles to the normal.
        along: Unit<Vector3<f64>>,
        /// Axis of the turn.
        normal: Unit<Vector3<f64>>,
    },
    /// Nothing is held: slides \[m\] along x, y and z of the predecessor, then a turn as of [`Joint::Spherical`]. As a cut it
    /// has no equations.
    Free,
}

impl Joint {
    /// Revolute joint about z of its frame.
    pub fn revolute_z() -> Self {
        Joint::Revolute {
            axis: Vector3::z_axis(),
        }
    }

    /// Prismatic joint along z of its frame.
    pub fn prismatic_z() -> Self {
        Joint::Prismatic {
            axis: Vector3::z_axis(),
        }
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        match self {
            Joint::Spherical => 4,
            Joint::Free => 7,
            other => other.speeds(),
        }
    }

    /// Number of speeds, which is the number of freedoms.
    pub fn speeds(&self) -> usize {
        self.steps().count()
    }

    /// Names of the coordinates, as results use them: the papers' psi, theta, phi for turns, z for a slide.
    pub fn coordinate_names(&self) -> &'static [&'static str] {
        match self {
            Joint::Fixed => &[],
            Joint::Revolute { .. } | Joint::Screw { .. } => &["psi"],
            Joint::Prismatic { .. } => &["z"],
            Joint::Cylindrical { .. } => &["z", "psi"],
            Joint::Universal { .. } => &["psi", "theta"],
            Joint::SphericalZyx => &["psi", "theta", "phi"],
            Joint::Spherical => &["w", "x", "y", "z"],
            Joint::Planar { .. } => &["x", "y", "psi"],
            Joint::Free => &["x", "y", "z", "qw", "qx", "qy", "qz"],
        }
    }

    /// Names of the speeds; equal to those of the coordinates except where there is a quaternion.
    pub fn speed_names(&self) -> &'static [&'static str] {
        match self {
            Joint::Spherical => &["wx", "wy", "wz"],
            Joint::Free => &["vx", "vy", "vz", "wx", "wy", "wz"],
            other => other.coordinate_names(),
        }
    }

    /// The joint as a chain of steps. This is the only place that knows what kinds of joints there are.
    pub(crate) fn steps(&self) -> impl Iterator<Item = Step> + use<> {
        let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
        let (turn, slide, ball) = (
            |axis| Some(Step::Turn(axis)),
            |axis| Some(Step::Slide(axis)),
            |k| Some(Step::Ball(k)),
        );
        let none = None;
        let list = match *self {
            Joint::Fixed => [none; 6],
            Joint::Revolute { axis } => [turn(axis), none, none, none, none, none],
            Joint::Prismatic { axis } => [slide(axis), none, none, none, none, none],
            Joint::Screw { axis, pitch } => [Some(Step::Screw(axis, pitch)), none, none, none, none, none],
            Joint::Cylindrical { axis } => [slide(axis), turn(axis), none, none, none, none],
            Joint::Universal { first, second } => [turn(first), turn(second), none, none, none, none],
            Joint::SphericalZyx => [turn(z), turn(y), turn(x), none, none, none],
            Joint::Spherical => [ball(0), ball(1), ball(2), none, none, none],
            Joint::Planar { along, normal } => {
                let across = Unit::new_unchecked(normal.cross(&along));
                [slide(along), slide(across), turn(normal), none, none, none]
            }
            Joint::Free => [slide(x), slide(y), slide(z), ball(0), ball(1), ball(2)],
        };
        list.into_iter().flatten()
    }

    /// Checks that every axis of the joint is a finite unit vector and a pitch finite, that those of a universal joint are not
    /// parallel, and that those of a planar joint are at right angles.
    ///
    /// # Errors
    /// [`TreeError::BadAxis`]. [`crate::Tree::attach`] checks by itself, [`crate::Closure::new`] trusts its caller.
    pub fn validate(&self) -> Result<(), TreeError> {
        let unit = |a: &Unit<Vector3<f64>>| (a.norm() - 1.0).abs() < 1e-9;
        let sound = match self {
            Joint::Revolute { axis } | Joint::Prismatic { axis } | Joint::Cylindrical { axis } => unit(axis),
            Joint::Screw { axis, pitch } => unit(axis) && pitch.is_finite(),
            Joint::Universal { first, second } => unit(first) && unit(second) && first.cross(second).norm() > 1e-6,
            Joint::Planar { along, normal } => unit(along) && unit(normal) && along.dot(normal).abs() < 1e-9,
            Joint::Fixed | Joint::SphericalZyx | Joint::Spherical | Joint::Free => true,
        };
        if sound {
            Ok(())
        } else {
            Err(TreeError::BadAxis { joint: *self })
        }
    }
}

/// One freedom of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// Turn about an axis.
    Turn(Unit<Vector3<f64>>),
    /// Slide along an axis.
    Slide(Unit<Vector3<f64>>),
    /// Turn about an axis with a slide along it of so many metres a radian.
    Screw(Unit<Vector3<f64>>, f64),
    /// The k-th of the three body-fixed angular velocities of a ball joint; the first one carries the rotation.
    Ball(usize),
}

/// Rotation matrix of a quaternion (w, x, y, z) of any length but zero.
#[inline]
pub(crate) fn quaternion_rotation(q: &[f64]) -> Matrix3<f64> {
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    let s = 2.0 / (w * w + x * x + y * y + z * z);
    Matrix3::new(
        1.0 - s * (y * y + z * z),
        s * (x * y - w * z),
        s * (x * z + w * y),
        s * (x * y + w * z),
        1.0 - s * (x * x + z * z),
        s * (y * z - w * x),
        s * (x * z - w * y),
        s * (y * z + w * x),
        1.0 - s * (x * x + y * y),
    )
}

/// `q * (0, w)/2`: the rate of a quaternion for the angular velocity `w` in the turned axes.
#[inline]
pub(crate) fn quaternion_rate(q: &[f64], w: &[f64], rate: &mut [f64]) {
    rate[0] = 0.5 * (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]);
    rate[1] = 0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]);
    rate[2] = 0.5 * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]);
    rate[3] = 0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]);
}

/// `q * exp((0, w)/2)`, of unit length.
pub(crate) fn quaternion_turn(q: &[f64], w: &[f64], turned: &mut [f64]) {
    let angle = (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt();
    let (s, c) = (0.5 * angle).sin_cos();
    let k = if angle > 0.0 { s / angle } else { 0.5 };
    let (x, y, z) = (k * w[0], k * w[1], k * w[2]);
    let product = [
        q[0] * c - q[1] * x - q[2] * y - q[3] * z,
        q[0] * x + q[1] * c + q[2] * z - q[3] * y,
        q[0] * y + q[2] * c + q[3] * x - q[1] * z,
        q[0] * z + q[3] * c + q[1] * y - q[2] * x,
    ];
    let length = product.iter().map(|p| p * p).sum::<f64>().sqrt();
    for (turned, p) in turned.iter_mut().zip(product) {
        *turned = p / length;
    }
}

/// How one step places its node on the node before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Motion {
    /// `R = A0 + A1 sin q + A2 cos q` (Rodrigues' formula behind the constant offset), origin fixed.
    Turn(Turn),
    /// Constant rotation, origin `r + u q`.
    Slide(Slide),
    /// A turn, with the origin at `r + u pitch q`.
    Screw(Turn, f64),
    /// Quaternion behind a constant offset: the first freedom of a ball joint.
    Ball(Pose),
    /// The second (1) or third (2) freedom of a ball joint: the pose is that of the node before.
    BallNext(usize),
    /// Constant pose, no freedom.
    Still(Pose),
}

/// Constants of a turn; see [`Motion::Turn`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn {
    pub constant: Matrix3<f64>,
    pub sine: Matrix3<f64>,
    pub cosine: Matrix3<f64>,
    /// Axis in the frame before.
    pub axis: Vector3<f64>,
    /// Origin in the frame before \[m\].
    pub origin: Vector3<f64>,
}

impl Turn {
    pub fn new(offset: &Pose, axis: &Vector3<f64>) -> Self {
        let k = axis.cross_matrix();
        let kk = k * k;
        let clean = |m: Matrix3<f64>| m.map(|x| x + 0.0);
        Self {
            constant: clean(offset.rotation + offset.rotation * kk),
            sine: clean(offset.rotation * k),
            cosine: clean(-(offset.rotation * kk)),
            axis: offset.rotation * axis,
            origin: offset.origin,
        }
    }

    #[inline]
    pub fn rotation(&self, q: f64) -> Matrix3<f64> {
        let (s, c) = q.sin_cos();
        self.constant + self.sine * s + self.cosine * c
    }
}

/// Constants of a slide; see [`Motion::Slide`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slide {
    pub rotation: Matrix3<f64>,
    /// Direction in the frame before.
    pub axis: Vector3<f64>,
    /// Origin at zero in the frame before \[m\].
    pub origin: Vector3<f64>,
}
