//! Stiffness of Hertz's point contacts from radii and materials, for exponent 3/2.
//!
//! ```text
//! F = K δ^(3/2),  K = 4/(3 (s_i + s_j)) √R,  s = (1 - ν²)/E
//! ```
//!
//! with R the reduced radius of the pairing. A journal in a bearing touches along a line; in the literature on
//! clearance it is customary to use the ball in a socket for it all the same.

use crate::{Expected, ParameterError};

/// A linear elastic, isotropic material.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Material {
    /// Young's modulus E > 0 \[Pa\].
    pub youngs_modulus: f64,
    /// Poisson's ratio -1 < ν ≤ 1/2 \[-\].
    pub poisson_ratio: f64,
}

impl Material {
    /// Compliance s = (1 - ν²)/E \[1/Pa\] of one of the two bodies; a contact has the sum of both.
    ///
    /// # Errors
    /// A modulus that is not positive, a ratio out of its range.
    pub fn compliance(&self) -> Result<f64, ParameterError> {
        Expected::Positive.check("youngs_modulus", self.youngs_modulus)?;
        Expected::PoissonRatio.check("poisson_ratio", self.poisson_ratio)?;
        Ok((1.0 - self.poisson_ratio) * (1.0 + self.poisson_ratio) / self.youngs_modulus)
    }
}

/// K \[N/m^1.5\] of a ball inside a hollow sphere (radii \[m\]) for the sum of the compliances \[1/Pa\]; the reduced
/// radius is R_i R_j/(R_i - R_j).
///
/// # Errors
/// A radius or compliance that is not positive, a ball that is not smaller than its socket, a stiffness beyond all
/// numbers.
pub fn ball_in_socket(socket_radius: f64, ball_radius: f64, compliance: f64) -> Result<f64, ParameterError> {
    Expected::Positive.check("socket_radius", socket_radius)?;
    Expected::Below {
        bound: socket_radius,
        of: "socket_radius",
    }
    .check("ball_radius", ball_radius)?;
    hertz(
        ball_radius * (socket_radius / (socket_radius - ball_radius)),
        compliance,
    )
}

/// K \[N/m^1.5\] of two balls (radii \[m\]) that touch from outside, for the sum of the compliances \[1/Pa\]; the
/// reduced radius is R_i R_j/(R_i + R_j).
///
/// # Errors
/// A radius or compliance that is not positive, a stiffness beyond all numbers.
pub fn balls(radius_i: f64, radius_j: f64, compliance: f64) -> Result<f64, ParameterError> {
    Expected::Positive.check("radius_i", radius_i)?;
    Expected::Positive.check("radius_j", radius_j)?;
    hertz(1.0 / (1.0 / radius_i + 1.0 / radius_j), compliance)
}

/// K \[N/m^1.5\] of a ball (radius \[m\]) on a half space, for the sum of the compliances \[1/Pa\].
///
/// # Errors
/// A radius or compliance that is not positive, a stiffness beyond all numbers.
pub fn ball_on_plane(radius: f64, compliance: f64) -> Result<f64, ParameterError> {
    Expected::Positive.check("radius", radius)?;
    hertz(radius, compliance)
}

fn hertz(reduced_radius: f64, compliance: f64) -> Result<f64, ParameterError> {
    Expected::Positive.check("compliance", compliance)?;
    let k = 4.0 / 3.0 / compliance * reduced_radius.sqrt();
    Expected::Positive.check("stiffness", k)?;
    Ok(k)
}
