//! Laws of contact in a scene file: their format, and how they are read.

use linkdyn_contact::{
    ContactLaw, Damping, Fit, KelvinVoigt, Material, NormalLaw, NormalModel, ParameterError, ball_in_socket,
};
use schemars::JsonSchema;
use serde::Deserialize;

/// A law of contact.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum ContactItem {
    /// A power of the penetration with the damping of Hunt and Crossley: `K depth^n (1 + factor rate/impact speed)`.
    Power {
        /// Stiffness K \[N/m^n, N m/rad^n\].
        stiffness: f64,
        /// Exponent n, at least 1 \[-\]; 1.5 unless given.
        #[serde(default = "hertz")]
        exponent: f64,
        /// How energy is lost; not at all unless given.
        #[serde(default = "elastic")]
        damping: Damping,
        /// Floor of the impact speed \[m/s, rad/s\]; 1e-6 unless given.
        #[serde(default = "least_impact_speed")]
        least_impact_speed: f64,
    },
    /// The same with exponent 1.5 and Hertz's stiffness of a ball in a socket with the radii of pin and hole.
    Hertz {
        /// Material of both parts.
        material: Material,
        /// How energy is lost; not at all unless given.
        #[serde(default = "elastic")]
        damping: Damping,
        /// Floor of the impact speed \[m/s\]; 1e-6 unless given.
        #[serde(default = "least_impact_speed")]
        least_impact_speed: f64,
    },
    /// A linear spring and damper.
    KelvinVoigt(KelvinVoigt),
}

fn hertz() -> f64 {
    1.5
}

fn elastic() -> Damping {
    Damping::Hertz
}

fn least_impact_speed() -> f64 {
    NormalLaw::LEAST_IMPACT_SPEED
}

impl ContactItem {
    /// The law between parts that meet in a fit, or what is wrong with it.
    pub(super) fn law(&self, fit: Option<Fit>) -> Result<ContactLaw, String> {
        let fault = |error: ParameterError| error.to_string();
        let power = |stiffness: f64, exponent: f64, damping: Damping, least: f64| {
            let law = NormalLaw::new(stiffness, exponent, damping).and_then(|law| law.with_least_impact_speed(least));
            law.map(ContactLaw::from).map_err(fault)
        };
        match *self {
            Self::Power {
                stiffness,
                exponent,
                damping,
                least_impact_speed,
            } => power(stiffness, exponent, damping, least_impact_speed),
            Self::Hertz {
                material,
                damping,
                least_impact_speed,
            } => {
                let Some(fit) = fit else {
                    return Err("`hertz` needs the radii of a pin and its hole; give `power` or `kelvin_voigt`".into());
                };
                let compliance = 2.0 * material.compliance().map_err(fault)?;
                let stiffness = ball_in_socket(fit.bearing_radius(), fit.journal_radius(), compliance);
                power(stiffness.map_err(fault)?, hertz(), damping, least_impact_speed)
            }
            Self::KelvinVoigt(law) => {
                law.validate().map_err(fault)?;
                Ok(law.into())
            }
        }
    }
}
