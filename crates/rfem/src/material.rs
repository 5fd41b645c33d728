use crate::{BeamError, Expected};

/// A linear elastic material with damping in proportion to stiffness (Kelvin and Voigt).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Material {
    /// Density ρ > 0 \[kg/m^3\].
    pub density: f64,
    /// Young's modulus E > 0 \[Pa\].
    pub youngs_modulus: f64,
    /// Shear modulus G > 0 \[Pa\].
    pub shear_modulus: f64,
    /// Relaxation time τ ≥ 0 \[s\], η/E = η_G/G: every damping coefficient is τ times its stiffness, and a mode of angular
    /// frequency ω has the damping ratio τ ω/2.
    pub relaxation_time: f64,
}

impl Material {
    /// Isotropic material: G = E/(2 (1 + ν)). Density \[kg/m^3\], Young's modulus \[Pa\], Poisson's ratio \[-\], relaxation
    /// time \[s\].
    ///
    /// # Errors
    /// The first argument outside its range; Poisson's ratio must lie above -1 and not above 0.5.
    pub fn isotropic(
        density: f64,
        youngs_modulus: f64,
        poissons_ratio: f64,
        relaxation_time: f64,
    ) -> Result<Self, BeamError> {
        Expected::PoissonRatio.check("poissons_ratio", poissons_ratio)?;
        let material = Self {
            density,
            youngs_modulus,
            shear_modulus: youngs_modulus / (2.0 * (1.0 + poissons_ratio)),
            relaxation_time,
        };
        material.validate()?;
        Ok(material)
    }

    /// Checks the ranges that the fields state.
    ///
    /// # Errors
    /// The first field outside its range.
    pub fn validate(&self) -> Result<(), BeamError> {
        Expected::Positive.check("material.density", self.density)?;
        Expected::Positive.check("material.youngs_modulus", self.youngs_modulus)?;
        Expected::Positive.check("material.shear_modulus", self.shear_modulus)?;
        Expected::NotNegative.check("material.relaxation_time", self.relaxation_time)?;
        Ok(())
    }
}
