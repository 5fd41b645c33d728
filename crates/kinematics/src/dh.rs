//! Denavit-Hartenberg transforms in the classical and in Craig's convention, with their derivatives.
//!
//! Both name the same four numbers: `theta` (turn about z), `d` (shift along z), `a` (shift along x), `alpha` (turn
//! about x). The classical one \[Denavit, Hartenberg 1955\] moves about the axis of the link before:
//! `T = Rz(theta) Tz(d) Tx(a) Rx(alpha)`. Craig's \[Craig 1986, eq. (3.6)\] first goes to the joint's own axis:
//! `T = Rx(alpha) Tx(a) Rz(theta) Tz(d)`; there the link frame sits on the axis of its own joint.

use crate::Pose;
use nalgebra::{Matrix3, Matrix4, Vector3};

/// The order in which the four elementary motions follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Convention {
    /// `T = Rz(theta) Tz(d) Tx(a) Rx(alpha)`.
    Classical,
    /// `T = Rx(alpha) Tx(a) Rz(theta) Tz(d)`.
    Craig,
}

/// One row of a Denavit-Hartenberg table.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Row {
    /// Turn about z \[rad\].
    pub theta: f64,
    /// Shift along z \[m\].
    pub d: f64,
    /// Shift along x \[m\].
    pub a: f64,
    /// Turn about x \[rad\].
    pub alpha: f64,
}

/// Which of the two numbers of a row the joint changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Variable {
    /// Revolute joint: `theta`.
    Theta,
    /// Prismatic joint: `d`.
    D,
}

impl Row {
    /// What comes before and after the joint's own motion, so that `T = before * Rz(theta) Tz(d) * after`.
    pub fn around(&self, convention: Convention) -> (Pose, Pose) {
        let (s, c) = self.alpha.sin_cos();
        let twist = Pose {
            rotation: Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c),
            origin: Vector3::new(self.a, 0.0, 0.0),
        };
        match convention {
            Convention::Classical => (Pose::identity(), twist),
            Convention::Craig => (twist, Pose::identity()),
        }
    }

    /// The joint's own motion `Rz(theta) Tz(d)`.
    pub fn motion(&self) -> Pose {
        let (s, c) = self.theta.sin_cos();
        Pose {
            rotation: Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0),
            origin: Vector3::new(0.0, 0.0, self.d),
        }
    }

    /// The link's pose in the frame of the link before.
    pub fn pose(&self, convention: Convention) -> Pose {
        let (before, after) = self.around(convention);
        before * self.motion() * after
    }

    /// `dT/dx` (4 x 4) for the joint variable `x` \[1/rad or 1/m\].
    pub fn first_derivative(&self, convention: Convention, variable: Variable) -> Matrix4<f64> {
        self.derivative(convention, variable, 1)
    }

    /// `d2T/dx2` (4 x 4) for the joint variable `x` \[1/rad^2 or 1/m^2\].
    pub fn second_derivative(&self, convention: Convention, variable: Variable) -> Matrix4<f64> {
        self.derivative(convention, variable, 2)
    }

    // Rz and Tz commute, so each derivative puts one more generator behind the motion.
    fn derivative(&self, convention: Convention, variable: Variable, order: u32) -> Matrix4<f64> {
        let mut generator = Matrix4::zeros();
        match variable {
            Variable::Theta => {
                generator[(0, 1)] = -1.0;
                generator[(1, 0)] = 1.0;
            }
            Variable::D => generator[(2, 3)] = 1.0,
        }
        let (before, after) = self.around(convention);
        let mut t = before.to_homogeneous() * self.motion().to_homogeneous();
        for _ in 0..order {
            t *= generator;
        }
        t * after.to_homogeneous()
    }
}
