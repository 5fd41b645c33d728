//! Inertia of rigid links.

use crate::symmetric::{SpatialInertia, Symmetric};
use linkdyn_kinematics::Pose;
use nalgebra::{Matrix3, Matrix4, Vector3};
use thiserror::Error;

/// Mass, centre of mass and inertia matrix of a rigid link, in a frame of the link.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RigidInertia {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: Vector3<f64>,
    /// Inertia matrix about the centre of mass \[kg m^2\].
    pub about_com: Matrix3<f64>,
}

/// What is wrong with an inertia.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum InertiaError {
    /// Mass is negative or not finite.
    #[error("mass {0} kg must be finite and not negative")]
    Mass(f64),
    /// The link has no mass but an inertia or the other way about.
    #[error("a link without mass must have no inertia either, found {0:e} kg m^2")]
    InertiaWithoutMass(f64),
    /// Centre of mass is not finite.
    #[error("centre of mass {0:?} m must be finite")]
    Com([f64; 3]),
    /// An entry of the inertia matrix is not finite.
    #[error("inertia matrix must be finite")]
    NotFinite,
    /// The inertia matrix is not symmetric.
    #[error("inertia matrix must be symmetric, entries differ by {0:e} kg m^2")]
    NotSymmetric(f64),
    /// A principal moment is negative.
    #[error("principal moments of inertia {0:?} kg m^2 must not be negative")]
    NotPositive([f64; 3]),
    /// No distribution of mass has these principal moments: one exceeds the sum of the two others.
    #[error(
        "principal moments of inertia {0:?} kg m^2 violate the triangle inequality: the largest exceeds the sum of the two others"
    )]
    Triangle([f64; 3]),
}

impl RigidInertia {
    /// No mass at all: a link that only carries others.
    pub fn massless() -> Self {
        Self {
            mass: 0.0,
            com: Vector3::zeros(),
            about_com: Matrix3::zeros(),
        }
    }

    /// A solid cylinder that begins at the origin and runs along `direction` (any length but zero): mass `rho pi d^2 l/4`,
    /// axial moment `m d^2/8`, transverse `m (l^2/12 + d^2/16)`. Density \[kg/m^3\], diameter and length \[m\].
    pub fn solid_cylinder(density: f64, diameter: f64, length: f64, direction: &Vector3<f64>) -> Self {
        let u = direction.normalize();
        let mass = density * std::f64::consts::PI * diameter * diameter * length / 4.0;
        let axial = mass * diameter * diameter / 8.0;
        let transverse = mass * (length * length / 12.0 + diameter * diameter / 16.0);
        Self {
            mass,
            com: u * (length / 2.0),
            about_com: Matrix3::identity() * transverse + u * u.transpose() * (axial - transverse),
        }
    }

    /// The same link described in another frame; `pose` is that of the old frame in the new one.
    pub fn moved(&self, pose: &Pose) -> Self {
        Self {
            mass: self.mass,
            com: pose.point(&self.com),
            about_com: pose.rotation * self.about_com * pose.rotation.transpose(),
        }
    }

    /// Inertia matrix about the frame's origin \[kg m^2\].
    pub fn about_origin(&self) -> Matrix3<f64> {
        let c = &self.com;
        self.about_com + (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * self.mass
    }

    /// Pseudo-inertia matrix `H` (4 x 4) of the papers: the integral of `r r^T dm` over homogeneous points `r = (x, y, z, 1)`.
    pub fn pseudo_inertia(&self) -> Matrix4<f64> {
        let i = self.about_origin();
        let second = Matrix3::identity() * (i.trace() / 2.0) - i;
        let mut h = Matrix4::zeros();
        h.fixed_view_mut::<3, 3>(0, 0).copy_from(&second);
        let first = self.com * self.mass;
        h.fixed_view_mut::<3, 1>(0, 3).copy_from(&first);
        h.fixed_view_mut::<1, 3>(3, 0).copy_from(&first.transpose());
        h[(3, 3)] = self.mass;
        h
    }

    /// Checks that some distribution of mass has this inertia (rounding of 1e-9 of the largest moment is forgiven).
    ///
    /// # Errors
    /// [`InertiaError`] with the numbers.
    pub fn validate(&self) -> Result<(), InertiaError> {
        let moments = self.principal_moments()?;
        let slack = 1e-9 * moments[2].abs();
        if moments[2] > moments[0] + moments[1] + slack {
            return Err(InertiaError::Triangle(moments));
        }
        Ok(())
    }

    /// Checks all that [`RigidInertia::validate`] checks but the triangle inequality: for published data that break it.
    ///
    /// # Errors
    /// [`InertiaError`] with the numbers.
    pub fn validate_positive(&self) -> Result<(), InertiaError> {
        self.principal_moments().map(|_| ())
    }

    fn principal_moments(&self) -> Result<[f64; 3], InertiaError> {
        if !(self.mass.is_finite() && self.mass >= 0.0) {
            return Err(InertiaError::Mass(self.mass));
        }
        if !self.com.iter().all(|x| x.is_finite()) {
            return Err(InertiaError::Com(self.com.into()));
        }
        if !self.about_com.iter().all(|x| x.is_finite()) {
            return Err(InertiaError::NotFinite);
        }
        let size = self.about_com.amax();
        let asymmetry = (self.about_com - self.about_com.transpose()).amax();
        if asymmetry > 1e-9 * size {
            return Err(InertiaError::NotSymmetric(asymmetry));
        }
        if self.mass == 0.0 && size > 0.0 {
            return Err(InertiaError::InertiaWithoutMass(size));
        }
        let mut moments: [f64; 3] = self.about_com.symmetric_eigenvalues().into();
        moments.sort_by(f64::total_cmp);
        if moments[0] < -1e-9 * size {
            return Err(InertiaError::NotPositive(moments));
        }
        Ok(moments)
    }
}

/// A link's inertia as the recursions want it: what can be known before the run is found once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Body {
    /// No mass.
    Massless,
    /// A body of revolution with its origin on its axis `u`: `I = c 1 + k u u^T`, first moment `s u`.
    Axial {
        mass: f64,
        axis: Vector3<f64>,
        c: f64,
        k: f64,
        s: f64,
    },
    /// Any other.
    General {
        mass: f64,
        moment: Vector3<f64>,
        about_origin: Matrix3<f64>,
    },
}

impl Body {
    pub fn new(inertia: &RigidInertia) -> Self {
        if inertia.mass == 0.0 {
            return Body::Massless;
        }
        Self::axial(inertia).unwrap_or(Body::General {
            mass: inertia.mass,
            moment: inertia.com * inertia.mass,
            about_origin: inertia.about_origin(),
        })
    }

    /// Bodies of revolution are found by trial: the axis is that of the centre of mass, or of the odd principal moment.
    fn axial(inertia: &RigidInertia) -> Option<Self> {
        let origin = inertia.about_origin();
        let trace = origin.trace();
        let mut candidates = vec![inertia.com];
        let principal = origin.symmetric_eigen().eigenvectors;
        candidates.extend((0..3).map(|k| principal.column(k).into_owned()));
        for candidate in candidates {
            let Some(u) = candidate.try_normalize(0.0) else {
                continue;
            };
            let along = u.dot(&(origin * u));
            let c = (trace - along) / 2.0;
            let k = along - c;
            let rest = origin - Matrix3::identity() * c - u * u.transpose() * k;
            let s = inertia.mass * inertia.com.dot(&u);
            let off = (inertia.com * inertia.mass - u * s).amax();
            if rest.amax() <= 4.0 * f64::EPSILON * origin.amax() && off <= 4.0 * f64::EPSILON * s.abs() {
                return Some(Body::Axial {
                    mass: inertia.mass,
                    axis: u,
                    c,
                    k,
                    s,
                });
            }
        }
        None
    }

    /// Inertia about the node's origin in global axes, for the node's `rotation`.
    #[inline]
    pub fn turned(&self, rotation: &Matrix3<f64>) -> SpatialInertia {
        match self {
            Body::Massless => SpatialInertia::ZERO,
            Body::Axial { mass, axis, c, k, s } => {
                let u = rotation * axis;
                SpatialInertia {
                    mass: *mass,
                    moment: u * *s,
                    second: Symmetric::axial(*c, *k, &u),
                }
            }
            Body::General {
                mass,
                moment,
                about_origin,
            } => SpatialInertia {
                mass: *mass,
                moment: rotation * moment,
                second: Symmetric::from_upper(&(rotation * about_origin * rotation.transpose())),
            },
        }
    }
}
