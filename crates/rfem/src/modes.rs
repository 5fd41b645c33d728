//! Natural frequencies of uniform beams as continua, to compare divided ones with.
//!
//! Bending after Euler and Bernoulli: neither shear nor the rotary inertia of the sections. Torsion and stretch as waves
//! in a bar. All without damping.

use crate::{BeamError, Expected, Material, Section};
use std::f64::consts::PI;

/// What holds the two ends of a bending beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Ends {
    /// Cantilever.
    ClampedFree,
    /// Both ends held in place, free to turn.
    PinnedPinned,
    /// Both ends held in place and direction.
    ClampedClamped,
    /// Nothing held. The two motions as a rigid body are not counted as modes.
    FreeFree,
    /// One end held in place and direction, the other in place.
    ClampedPinned,
}

/// What holds the two ends of a bar that twists or stretches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum BarEnds {
    /// One end held.
    FixedFree,
    /// Both ends held.
    FixedFixed,
    /// Nothing held. The motion as a rigid body is not counted as a mode.
    FreeFree,
}

/// The transverse axis that a beam bends about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Axis {
    /// About y, with I_y; points move along z.
    Y,
    /// About z, with I_z; points move along y.
    Z,
}

/// Root βL \[-\] of the frequency equation for a mode, counted from 1:
/// cos x cosh x = -1 (clamped - free), sin x = 0 (pinned), cos x cosh x = 1 (clamped or free at both ends),
/// tan x = tanh x (clamped - pinned).
///
/// # Errors
/// Mode 0.
pub fn bending_root(ends: Ends, mode: u32) -> Result<f64, BeamError> {
    let k = counted(mode)?;
    // Divided by cosh x, so that nothing overflows; the starts are the roots for cosh x infinite.
    let sech = |x: f64| 1.0 / x.cosh();
    Ok(match ends {
        Ends::PinnedPinned => k * PI,
        Ends::ClampedFree => newton((k - 0.5) * PI, |x| (x.cos() + sech(x), -x.sin() - sech(x) * x.tanh())),
        Ends::ClampedClamped | Ends::FreeFree => {
            newton((k + 0.5) * PI, |x| (x.cos() - sech(x), -x.sin() + sech(x) * x.tanh()))
        }
        Ends::ClampedPinned => newton((k + 0.25) * PI, |x| {
            let (s, c, t) = (x.sin(), x.cos(), x.tanh());
            (s - c * t, c + s * t - c * sech(x) * sech(x))
        }),
    })
}

/// Angular frequency \[rad/s\] of bending: (βL/L)² √(E I/(ρ A)). Length \[m\]; mode counted from 1.
///
/// # Errors
/// The first argument outside its range, or a frequency beyond the range of `f64`.
pub fn bending_frequency(
    length: f64,
    section: &Section,
    material: &Material,
    axis: Axis,
    ends: Ends,
    mode: u32,
) -> Result<f64, BeamError> {
    checked(length, section, material)?;
    let second = match axis {
        Axis::Y => section.bending[0],
        Axis::Z => section.bending[1],
    };
    let radius = (second / section.area).sqrt();
    let beta = bending_root(ends, mode)? / length;
    let speed = (material.youngs_modulus / material.density).sqrt();
    Expected::Positive.check("bending frequency", beta * radius * (beta * speed))
}

/// Angular frequency \[rad/s\] of torsion, warping left out: (βL/L) √(G J/(ρ (I_y + I_z))) with βL = k π, for one free end
/// (k - 1/2) π. Length \[m\]; mode k counted from 1.
///
/// # Errors
/// The first argument outside its range, or a frequency beyond the range of `f64`.
pub fn torsion_frequency(
    length: f64,
    section: &Section,
    material: &Material,
    ends: BarEnds,
    mode: u32,
) -> Result<f64, BeamError> {
    checked(length, section, material)?;
    let speed = (material.shear_modulus / material.density * (section.torsion / section.polar())).sqrt();
    Expected::Positive.check("torsion frequency", bar_root(ends, mode)? / length * speed)
}

/// Angular frequency \[rad/s\] of stretching: (βL/L) √(E/ρ) with βL as for torsion. Length \[m\]; mode counted from 1.
///
/// # Errors
/// The first argument outside its range, or a frequency beyond the range of `f64`.
pub fn stretch_frequency(length: f64, material: &Material, ends: BarEnds, mode: u32) -> Result<f64, BeamError> {
    Expected::Positive.check("length", length)?;
    material.validate()?;
    let speed = (material.youngs_modulus / material.density).sqrt();
    Expected::Positive.check("stretch frequency", bar_root(ends, mode)? / length * speed)
}

fn bar_root(ends: BarEnds, mode: u32) -> Result<f64, BeamError> {
    let k = counted(mode)?;
    Ok(match ends {
        BarEnds::FixedFree => (k - 0.5) * PI,
        BarEnds::FixedFixed | BarEnds::FreeFree => k * PI,
    })
}

fn counted(mode: u32) -> Result<f64, BeamError> {
    let to = u32::MAX as usize;
    Expected::Count { from: 1, to }.check("mode", f64::from(mode))
}

fn checked(length: f64, section: &Section, material: &Material) -> Result<(), BeamError> {
    Expected::Positive.check("length", length)?;
    section.validate()?;
    material.validate()
}

/// Newton's method from a start so near that the sixth step is below rounding.
fn newton(start: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    (0..6).fold(start, |x, _| {
        let (value, slope) = f(x);
        x - value / slope
    })
}
