//! A straight uniform beam cut into rigid finite elements (rfe) with spring-damping elements (sde) between them.

use crate::{BeamError, Expected, Material, Section};

/// Largest number of elements in a [`Division`].
pub const MAX_COUNT: usize = 10_000;

/// Where a beam of length L is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Division {
    /// The standard division, right for any ends, with this number n of sdes (1 to [`MAX_COUNT`]): n segments of length
    /// Δ = L/n, each with its sde in the middle; what lies between two sdes is an rfe, so that there are n + 1, the two at the
    /// ends of length Δ/2 \[Wittbrodt, Adamiec-Wójcik, Wojciech 2006\].
    Standard(usize),
    /// This number N of equal rfes (2 to [`MAX_COUNT`]) of length Δ = L/N with N - 1 sdes between them. Too stiff, except where
    /// the bending moment vanishes at both ends: the two outer half elements bend nowhere. A cantilever of 5 elements bends
    /// 28 % too little.
    Equal(usize),
}

/// How the shear coefficients of the sdes are found. They count only in the classical form of the method, in which the elements
/// have six coordinates each; with springs for torsion and bending alone the choice changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Shear {
    /// The shear of the segment: 1/c = κ Δ/(G A).
    #[default]
    Classical,
    /// The shear of the segment, and the part of its deflection that a hinge in its middle leaves out:
    /// 1/c = κ Δ/(G A) + Δ³/(12 E I). In the standard division deflection and rotation under any load at the ends
    /// are then exact for any number of elements.
    Improved,
}

/// A beam as a chain: sde `s` connects rfe `s` with rfe `s + 1`, whose `start` is the position of the sde.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Beam {
    /// Rigid finite elements from start to end of the beam, one more than `springs`.
    pub elements: Vec<Rfe>,
    /// Spring-damping elements from start to end of the beam.
    pub springs: Vec<Sde>,
}

/// Rigid finite element: a prism along x, the axis of the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Rfe {
    /// Where it begins, from the start of the beam \[m\].
    pub start: f64,
    /// Length l \[m\]. The centre of mass lies in the middle.
    pub length: f64,
    /// Mass m = ρ A l \[kg\].
    pub mass: f64,
    /// Moments of inertia about its own centre of mass and the axes x, y, z \[kg m^2\]: ρ (I_y + I_z) l,
    /// m l²/12 + ρ I_y l, m l²/12 + ρ I_z l. They are principal.
    pub inertia: [f64; 3],
}

impl Rfe {
    /// Centre of mass, from the start of the beam \[m\].
    pub fn centre(&self) -> f64 {
        self.start + self.length / 2.0
    }
}

/// Spring-damping element: what the segment around it does under load, put into a point. Axes as those of the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Sde {
    /// Where it sits, from the start of the beam \[m\].
    pub position: f64,
    /// Along x: E A/Δ \[N/m\], \[N s/m\].
    pub stretch: Coefficient,
    /// Along y and z, by [`Shear`] \[N/m\], \[N s/m\]. A force along y goes with I_z, a force along z with I_y.
    pub shear: [Coefficient; 2],
    /// About x: G J/Δ \[N m\], \[N m s\].
    pub twist: Coefficient,
    /// About y and z: E I_y/Δ, E I_z/Δ \[N m\], \[N m s\].
    pub bend: [Coefficient; 2],
}

/// A linear spring c with a damper d = τ c beside it: force = c deflection + d rate, energy = c deflection²/2, power lost = d rate².
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Coefficient {
    /// Stiffness c \[N/m\] or \[N m\] per radian.
    pub stiffness: f64,
    /// Damping d \[N s/m\] or \[N m s\] per radian.
    pub damping: f64,
}

/// Cuts a beam of a length \[m\] with the [classical](Shear::Classical) shear coefficients.
///
/// # Errors
/// See [`divide_with`].
pub fn divide(length: f64, section: &Section, material: &Material, division: Division) -> Result<Beam, BeamError> {
    divide_with(length, section, material, division, Shear::Classical)
}

/// Cuts a beam of a length \[m\]. Mass, centre of mass and moments of inertia of the whole are those of the uncut beam.
///
/// # Errors
/// The first argument outside its range, or the first result that such arguments drive beyond the range of `f64`.
pub fn divide_with(
    length: f64,
    section: &Section,
    material: &Material,
    division: Division,
    shear: Shear,
) -> Result<Beam, BeamError> {
    Expected::Positive.check("length", length)?;
    section.validate()?;
    material.validate()?;
    let (cuts, segment) = match division {
        Division::Standard(n) => {
            let n = count("division.standard", n, 1)?;
            let middles: Vec<_> = (0..n).map(|s| length * ((2 * s + 1) as f64 / (2 * n) as f64)).collect();
            (middles, length / n as f64)
        }
        Division::Equal(n) => {
            let n = count("division.equal", n, 2)?;
            let borders = (1..n).map(|s| length * (s as f64 / n as f64)).collect();
            (borders, length / n as f64)
        }
    };
    let spring = spring(segment, section, material, shear)?;
    let inner = prism(segment, section, material)?;
    let outer = match division {
        Division::Standard(_) => prism(segment / 2.0, section, material)?,
        Division::Equal(_) => inner,
    };
    let starts = std::iter::once(0.0).chain(cuts.iter().copied());
    let of = |r| if r == 0 || r == cuts.len() { outer } else { inner };
    Ok(Beam {
        elements: starts.enumerate().map(|(r, start)| Rfe { start, ..of(r) }).collect(),
        springs: cuts.iter().map(|&position| Sde { position, ..spring }).collect(),
    })
}

fn count(item: &'static str, n: usize, from: usize) -> Result<usize, BeamError> {
    Expected::Count { from, to: MAX_COUNT }.check(item, n as f64)?;
    Ok(n)
}

/// The element of a length, as if it began at the start of the beam.
fn prism(l: f64, section: &Section, material: &Material) -> Result<Rfe, BeamError> {
    let rho = material.density;
    let m = Expected::Positive.check("mass of an element", rho * section.area * l)?;
    let [about_y, about_z] = section.bending.map(|i| m * l * l / 12.0 + rho * i * l);
    let inertia = [rho * section.polar() * l, about_y, about_z];
    for moment in inertia {
        Expected::Positive.check("moment of inertia of an element", moment)?;
    }
    Ok(Rfe {
        start: 0.0,
        length: l,
        mass: m,
        inertia,
    })
}

/// The sde of a segment, as if it sat at the start of the beam.
fn spring(segment: f64, section: &Section, material: &Material, shear: Shear) -> Result<Sde, BeamError> {
    let (e, g) = (material.youngs_modulus, material.shear_modulus);
    let [ei_y, ei_z] = section.bending.map(|i| e * i);
    let ga = g * section.area;
    let kappa = section.shear_factors;
    let along = |kappa: f64, ei: f64| match shear {
        Shear::Classical => ga / (kappa * segment),
        Shear::Improved => 1.0 / (kappa * segment / ga + segment * segment / ei * (segment / 12.0)),
    };
    if shear == Shear::Classical {
        Expected::Positive.check("section.shear_factors[0]", kappa[0])?;
        Expected::Positive.check("section.shear_factors[1]", kappa[1])?;
    }
    let coefficient = |item, stiffness: f64| {
        Expected::Positive.check(item, stiffness)?;
        let damping = material.relaxation_time * stiffness;
        Expected::NotNegative.check("damping of an sde", damping)?;
        Ok::<_, BeamError>(Coefficient { stiffness, damping })
    };
    Ok(Sde {
        position: 0.0,
        stretch: coefficient("longitudinal stiffness of an sde", e * section.area / segment)?,
        shear: [
            coefficient("shear stiffness of an sde along y", along(kappa[0], ei_z))?,
            coefficient("shear stiffness of an sde along z", along(kappa[1], ei_y))?,
        ],
        twist: coefficient("torsional stiffness of an sde", g * section.torsion / segment)?,
        bend: [
            coefficient("bending stiffness of an sde about y", ei_y / segment)?,
            coefficient("bending stiffness of an sde about z", ei_z / segment)?,
        ],
    })
}
