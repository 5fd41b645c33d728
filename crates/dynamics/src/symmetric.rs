//! Symmetric 3 x 3 matrices by their six numbers, and inertias made of them.

use crate::lanes::Vectors;
use nalgebra::{Matrix3, Vector3};

/// A symmetric 3 x 3 matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Symmetric {
    pub xx: f64,
    pub yy: f64,
    pub zz: f64,
    pub xy: f64,
    pub xz: f64,
    pub yz: f64,
}

impl Symmetric {
    pub const ZERO: Self = Self {
        xx: 0.0,
        yy: 0.0,
        zz: 0.0,
        xy: 0.0,
        xz: 0.0,
        yz: 0.0,
    };

    /// `c 1 + k u u^T`.
    #[inline]
    pub fn axial(c: f64, k: f64, u: &Vector3<f64>) -> Self {
        let ku = u * k;
        Self {
            xx: c + ku.x * u.x,
            yy: c + ku.y * u.y,
            zz: c + ku.z * u.z,
            xy: ku.x * u.y,
            xz: ku.x * u.z,
            yz: ku.y * u.z,
        }
    }

    /// The symmetric part of a full matrix, read from its upper triangle.
    #[inline]
    pub fn from_upper(m: &Matrix3<f64>) -> Self {
        Self {
            xx: m.m11,
            yy: m.m22,
            zz: m.m33,
            xy: m.m12,
            xz: m.m13,
            yz: m.m23,
        }
    }

    /// Sum of the diagonal.
    #[inline]
    pub fn trace(&self) -> f64 {
        self.xx + self.yy + self.zz
    }

    /// Product with a vector.
    #[inline]
    pub fn times(&self, v: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }

    /// Products with vectors in lanes.
    #[inline(always)]
    pub fn times_lanes<const N: usize>(&self, v: &Vectors<N>) -> Vectors<N> {
        [
            v[0] * self.xx + v[1] * self.xy + v[2] * self.xz,
            v[0] * self.xy + v[1] * self.yy + v[2] * self.yz,
            v[0] * self.xz + v[1] * self.yz + v[2] * self.zz,
        ]
    }

    /// `self -= k a a^T`.
    #[inline]
    pub fn subtract_square(&mut self, k: f64, a: &Vector3<f64>) {
        let ka = a * k;
        self.xx -= ka.x * a.x;
        self.yy -= ka.y * a.y;
        self.zz -= ka.z * a.z;
        self.xy -= ka.x * a.y;
        self.xz -= ka.x * a.z;
        self.yz -= ka.y * a.z;
    }

    #[inline]
    pub fn add(&mut self, other: &Self) {
        self.xx += other.xx;
        self.yy += other.yy;
        self.zz += other.zz;
        self.xy += other.xy;
        self.xz += other.xz;
        self.yz += other.yz;
    }
}

/// Inertia of a link or of a rigid group of links about a node's origin, in global axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpatialInertia {
    /// Mass \[kg\].
    pub mass: f64,
    /// First moment, mass times centre of mass from the origin \[kg m\].
    pub moment: Vector3<f64>,
    /// Second moment (inertia matrix) about the origin \[kg m^2\].
    pub second: Symmetric,
}

impl SpatialInertia {
    pub const ZERO: Self = Self {
        mass: 0.0,
        moment: Vector3::new(0.0, 0.0, 0.0),
        second: Symmetric::ZERO,
    };

    #[inline]
    pub fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        self.moment += other.moment;
        self.second.add(&other.second);
    }

    /// The same matter about a point that lies `arm` before the origin (Steiner).
    #[inline]
    pub fn shifted(&self, arm: &Vector3<f64>) -> Self {
        let md = arm * self.mass;
        let g = self.moment + md * 0.5;
        let (px, py, pz) = (2.0 * g.x * arm.x, 2.0 * g.y * arm.y, 2.0 * g.z * arm.z);
        Self {
            mass: self.mass,
            moment: self.moment + md,
            second: Symmetric {
                xx: self.second.xx + py + pz,
                yy: self.second.yy + px + pz,
                zz: self.second.zz + px + py,
                xy: self.second.xy - (g.x * arm.y + g.y * arm.x),
                xz: self.second.xz - (g.x * arm.z + g.z * arm.x),
                yz: self.second.yz - (g.y * arm.z + g.z * arm.y),
            },
        }
    }
}
