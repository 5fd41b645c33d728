use crate::{BeamError, Expected};
use std::f64::consts::PI;

/// Cross section in its principal axes y and z; x is the axis of the beam, through the centroid and the shear centre.
///
/// Fill the fields for a section of your own, or take a constructor. Sections whose shear centre is not their centroid
/// (channels, angles) couple bending with torsion and are outside of what these numbers can say.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Section {
    /// Area A > 0 \[m^2\].
    pub area: f64,
    /// Second moments of area > 0 \[m^4\] for bending **about** y and z: I_y = ∫z² dA, I_z = ∫y² dA.
    pub bending: [f64; 2],
    /// Torsion constant J > 0 \[m^4\] of Saint-Venant: twist per length = torque/(G J). Only for round sections is it
    /// I_y + I_z, for all others it is less.
    pub torsion: f64,
    /// Shear factors κ ≥ 0 \[-\] for forces **along** y and z: shear angle = κ force/(G A). Zero is a beam rigid in shear, which
    /// only [`Shear::Improved`](crate::Shear::Improved) can take.
    pub shear_factors: [f64; 2],
}

impl Section {
    /// Full circle of a diameter \[m\]: I = π d⁴/64, J = π d⁴/32, κ = 10/9.
    ///
    /// The factor is that of shear stresses even over each chord, as texts on the method use it; the elastic solution for
    /// Poisson's ratio 0 gives 7/6 \[Cowper 1966\].
    ///
    /// # Errors
    /// A diameter that is not positive, or with a section beyond the range of `f64`.
    pub fn circle(diameter: f64) -> Result<Self, BeamError> {
        Expected::Positive.check("diameter", diameter)?;
        Self::tube(diameter, 0.0)
    }

    /// Circular tube of an outer and an inner diameter \[m\]: I = π (D⁴ - d⁴)/64, J = π (D⁴ - d⁴)/32.
    ///
    /// The shear factor runs from 10/9 of the full circle to 2 of the thin tube, in between with the term m²/(1 + m²)²,
    /// m = d/D, of the elastic solution \[Cowper 1966\]: κ = 10/9 + (32/9) m²/(1 + m²)².
    ///
    /// # Errors
    /// Outer diameter not positive; inner diameter negative or not below the outer one; a section beyond the range of `f64`.
    pub fn tube(outer_diameter: f64, inner_diameter: f64) -> Result<Self, BeamError> {
        Expected::Positive.check("outer_diameter", outer_diameter)?;
        let below = Expected::Below {
            bound: outer_diameter,
            of: "outer_diameter",
        };
        below.check("inner_diameter", inner_diameter)?;
        let m = inner_diameter / outer_diameter;
        // Differences of powers as products: thin walls keep their digits.
        let area = PI / 4.0 * (outer_diameter - inner_diameter) * (outer_diameter + inner_diameter);
        let second = area * outer_diameter * outer_diameter * (1.0 + m * m) / 16.0;
        let shear = 10.0 / 9.0 + 32.0 / 9.0 * (m / (1.0 + m * m)).powi(2);
        Self::of(area, [second, second], 2.0 * second, shear)
    }

    /// Rectangle of a width along y and a height along z \[m\]: I_y = b h³/12, I_z = h b³/12, κ = 6/5.
    ///
    /// Torsion constant with a ≥ c of the sides, by the series of the membrane \[Timoshenko and Goodier 1970\]:
    /// J = a c³ (1/3 - (64/π⁵) (c/a) Σ tanh(k π a/(2c))/k⁵), k = 1, 3, 5, ...
    ///
    /// # Errors
    /// Sides that are not positive, or with a section beyond the range of `f64`.
    pub fn rectangle(width: f64, height: f64) -> Result<Self, BeamError> {
        Expected::Positive.check("width", width)?;
        Expected::Positive.check("height", height)?;
        let bending = [width * height * height * height, height * width * width * width].map(|product| product / 12.0);
        Self::of(width * height, bending, torsion_of_rectangle(width, height), 1.2)
    }

    /// I_y + I_z \[m^4\], which times density and length is the moment of inertia about the axis of the beam.
    pub fn polar(&self) -> f64 {
        self.bending[0] + self.bending[1]
    }

    /// Checks the ranges that the fields state.
    ///
    /// # Errors
    /// The first field outside its range.
    pub fn validate(&self) -> Result<(), BeamError> {
        Expected::Positive.check("section.area", self.area)?;
        Expected::Positive.check("section.bending[0]", self.bending[0])?;
        Expected::Positive.check("section.bending[1]", self.bending[1])?;
        Expected::Positive.check("section.torsion", self.torsion)?;
        Expected::NotNegative.check("section.shear_factors[0]", self.shear_factors[0])?;
        Expected::NotNegative.check("section.shear_factors[1]", self.shear_factors[1])?;
        Ok(())
    }

    fn of(area: f64, bending: [f64; 2], torsion: f64, shear: f64) -> Result<Self, BeamError> {
        let section = Self {
            area,
            bending,
            torsion,
            shear_factors: [shear, shear],
        };
        section.validate()?;
        Ok(section)
    }
}

/// The series of [`Section::rectangle`] with tanh u = 1 - 2/(exp(2u) + 1): the ones sum to a constant, the rest falls by
/// exp(-2π) or more from term to term.
fn torsion_of_rectangle(width: f64, height: f64) -> f64 {
    /// Sum of 1/k⁵ over odd k, (31/32) ζ(5).
    const ODD_FIFTH_POWERS: f64 = 1.004_523_762_795_139_6;
    let (a, c) = (width.max(height), width.min(height));
    let ratio = c / a;
    let rest: f64 = (0..6)
        .map(|i| f64::from(2 * i + 1))
        .map(|k| 2.0 / ((k * PI / ratio).exp() + 1.0) / k.powi(5))
        .sum();
    a * c * c * c * (1.0 / 3.0 - 64.0 / PI.powi(5) * ratio * (ODD_FIFTH_POWERS - rest))
}
