//! From where a linkage is looked at.

use super::shape::points;
use linkdyn_mechanisms::Skeleton;
use linkdyn_mechanisms::kinematics::Joint;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Azimuth from which spatial linkages are looked at first \[rad\], about the vertical from its first horizontal axis.
const AZIMUTH: f64 = -1.0;
/// Azimuths that are tried in a full turn, and elevations \[rad\].
const TURNS: u32 = 24;
const ELEVATIONS: [f64; 2] = [0.35, 0.6];
/// Angles and distances below this, as a share of one and of the linkage's size, are zero.
const FLAT: f64 = 1e-6;

/// Directions to the right and upward on the page, in axes of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    right: Vector3<f64>,
    up: Vector3<f64>,
}

impl View {
    /// Onto x to the right and y upward.
    pub fn front() -> Self {
        Self {
            right: Vector3::x(),
            up: Vector3::y(),
        }
    }

    /// Along the axes of a planar linkage, gravity downward as far as it can; none for a spatial one.
    pub fn planar(skeleton: &Skeleton, gravity: Vector3<f64>) -> Option<Self> {
        let normal = normal(skeleton)?;
        let ups = [-gravity, Vector3::y(), Vector3::z()];
        let across = ups.map(|up| up - normal * up.dot(&normal));
        let up = across.into_iter().find(|up| up.norm() > FLAT);
        let up = up.map_or(Vector3::x(), |up| up.normalize());
        Some(Self {
            right: up.cross(&normal),
            up,
        })
    }

    /// From above and aside all the way round, gravity downward.
    pub fn around(gravity: Vector3<f64>) -> impl Iterator<Item = Self> {
        let up = (-gravity).try_normalize(FLAT).unwrap_or(Vector3::z());
        // The horizontal axis that follows the vertical one in cyclic order, made normal to it.
        let next = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| axis.dot(&up).abs());
        let first = if next[2] > 0.9 {
            Vector3::x()
        } else if next[1] > 0.9 {
            Vector3::z()
        } else {
            Vector3::y()
        };
        let first = (first - up * first.dot(&up)).normalize();
        let second = up.cross(&first);
        let eyes = ELEVATIONS
            .into_iter()
            .flat_map(|elevation| (0..TURNS).map(move |k| (k, elevation)));
        eyes.map(move |(k, elevation)| {
            let (sin_a, cos_a) = (AZIMUTH + f64::from(k) * TAU / f64::from(TURNS)).sin_cos();
            let (sin_e, cos_e) = elevation.sin_cos();
            Self {
                right: second * cos_a - first * sin_a,
                up: up * cos_e - (first * cos_a + second * sin_a) * sin_e,
            }
        })
    }

    /// A point or direction on the page, upward positive \[m\].
    pub fn see(&self, point: Vector3<f64>) -> [f64; 2] {
        [self.right.dot(&point), self.up.dot(&point)]
    }

    /// How far it is towards the eye \[m\].
    pub fn depth(&self, point: Vector3<f64>) -> f64 {
        self.right.cross(&self.up).dot(&point)
    }
}

/// The normal of the plane in which a linkage moves, towards the side of its first positive axis; none for a spatial one.
fn normal(skeleton: &Skeleton) -> Option<Vector3<f64>> {
    let axes = |wanted: fn(&Joint) -> Option<Vector3<f64>>| {
        let joints = skeleton.joints.iter();
        joints.filter_map(move |j| Some(j.frames[0].rotation * wanted(&j.joint)?))
    };
    let turning = |joint: &Joint| match joint {
        Joint::Revolute { axis } | Joint::Cylindrical { axis } => Some(**axis),
        Joint::Planar { normal, .. } => Some(**normal),
        _ => None,
    };
    let sliding = |joint: &Joint| match joint {
        Joint::Prismatic { axis } => Some(**axis),
        _ => None,
    };
    let free = |joint: &Joint| matches!(joint, Joint::Free | Joint::Universal { .. } | Joint::SphericalZyx);
    if skeleton.joints.iter().any(|j| free(&j.joint)) {
        return None;
    }
    let axis = axes(turning).next()?;
    // Of the two sides the one that most axes of the ground see as positive.
    let normal = if axis.sum() < 0.0 { -axis } else { axis };
    let flat = axes(turning).all(|other| other.cross(&normal).norm() < FLAT)
        && axes(sliding).all(|slide| slide.dot(&normal).abs() < FLAT);
    let points: Vec<Vector3<f64>> = points(skeleton).collect();
    let first = points.first()?;
    let size = points.iter().map(|p| (p - first).norm()).fold(0.0, f64::max);
    let in_plane = points.iter().all(|p| (p - first).dot(&normal).abs() <= FLAT * size);
    (flat && in_plane && size > 0.0).then_some(normal)
}
