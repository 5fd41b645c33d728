//! Rigid poses: a rotation and an origin.

use nalgebra::{Matrix3, Matrix4, Rotation3, Unit, Vector3};
use std::ops::Mul;

/// Pose of a frame `b` in a frame `a`, written `x_ab`: `p_a = R_ab p_b + r_ab`.
///
/// Poses compose so that neighbouring letters cancel: `x_ac = x_ab * x_bc`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Pose {
    /// Rotation `R_ab` (3 x 3, its columns are the axes of `b` in `a`) \[-\].
    pub rotation: Matrix3<f64>,
    /// Origin of `b` in axes of `a` \[m\].
    pub origin: Vector3<f64>,
}

impl Pose {
    /// The pose that changes nothing.
    pub fn identity() -> Self {
        Self {
            rotation: Matrix3::identity(),
            origin: Vector3::zeros(),
        }
    }

    /// Pure shift by `x`, `y`, `z` \[m\].
    pub fn translation(x: f64, y: f64, z: f64) -> Self {
        Self {
            rotation: Matrix3::identity(),
            origin: Vector3::new(x, y, z),
        }
    }

    /// Turn by `angle` \[rad\] about the unit vector `axis`.
    pub fn turn(axis: Unit<Vector3<f64>>, angle: f64) -> Self {
        Self {
            rotation: *Rotation3::from_axis_angle(&axis, angle).matrix(),
            origin: Vector3::zeros(),
        }
    }

    /// A rotation matrix given row by row, and an origin \[m\]. Nothing is checked: see [`Pose::defect`].
    pub fn from_rows(rows: [[f64; 3]; 3], origin: [f64; 3]) -> Self {
        Self {
            rotation: Matrix3::from_fn(|r, c| rows[r][c]),
            origin: Vector3::from(origin),
        }
    }

    /// The homogeneous transform `T_ab` (4 x 4).
    pub fn to_homogeneous(&self) -> Matrix4<f64> {
        let mut t = Matrix4::identity();
        t.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.rotation);
        t.fixed_view_mut::<3, 1>(0, 3).copy_from(&self.origin);
        t
    }

    /// The pose of a homogeneous transform; the last row is taken as (0, 0, 0, 1).
    pub fn from_homogeneous(t: &Matrix4<f64>) -> Self {
        Self {
            rotation: t.fixed_view::<3, 3>(0, 0).into_owned(),
            origin: t.fixed_view::<3, 1>(0, 3).into_owned(),
        }
    }

    /// `x_ba` of `x_ab`.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self {
            rotation,
            origin: -(rotation * self.origin),
        }
    }

    /// Coordinates in `a` of a point given in `b` \[m\].
    pub fn point(&self, p_b: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * p_b + self.origin
    }

    /// How far the rotation is from a proper one: the largest entry of `R^T R - 1`, or 2 when it mirrors;
    /// infinite when any number is not finite.
    pub fn defect(&self) -> f64 {
        let finite = self.rotation.iter().chain(self.origin.iter()).all(|x| x.is_finite());
        if !finite {
            return f64::INFINITY;
        }
        if self.rotation.determinant() < 0.0 {
            return 2.0;
        }
        (self.rotation.transpose() * self.rotation - Matrix3::identity()).amax()
    }
}

impl Mul for Pose {
    type Output = Pose;
    fn mul(self, x_bc: Pose) -> Pose {
        Pose {
            rotation: self.rotation * x_bc.rotation,
            origin: self.point(&x_bc.origin),
        }
    }
}
