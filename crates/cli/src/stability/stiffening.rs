//! Numbers of a scene that make it stiff when they grow.

use linkdyn_mechanisms::Linkage;
use linkdyn_mechanisms::contact::{ContactLaw, ParameterError};
use linkdyn_mechanisms::friction::{Bristle, Friction};

use crate::errors::CliError;
use crate::run::{Prepared, ready};
use crate::scenes::{self, Variant};

/// The link that becomes light, the first of these that there is: one that a loop carries between heavier ones.
const LIGHT: [&str; 2] = ["1,2", "2,2"];
/// Numbers of spring-damping elements, in place of factors.
const ELEMENTS: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// Factors on all others.
const FACTORS: [f64; 7] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6];

/// What is made larger, or smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Stiffness of contacts, times the factor.
    ContactStiffness,
    /// Young's modulus of flexible links, times the factor; the relaxation time stays.
    Modulus,
    /// The number of spring-damping elements of a flexible link.
    Elements,
    /// Slope of joint friction at zero speed: reference speeds over the factor.
    FrictionSlope,
    /// Stiffness σ₀ of bristles, times the factor.
    BristleStiffness,
    /// Mass of a link against the others: its mass and inertia over the factor.
    MassRatio,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::ContactStiffness,
        Self::Modulus,
        Self::Elements,
        Self::FrictionSlope,
        Self::BristleStiffness,
        Self::MassRatio,
    ];

    /// Those whose presence makes a scene stiff at its own numbers.
    pub const STIFF: [Self; 2] = [Self::ContactStiffness, Self::Modulus];

    /// The name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::ContactStiffness => "contact stiffness",
            Self::Modulus => "elastic modulus",
            Self::Elements => "elements",
            Self::FrictionSlope => "friction slope",
            Self::BristleStiffness => "bristle stiffness",
            Self::MassRatio => "mass ratio",
        }
    }

    /// Values to go through, from the scene's own on.
    pub fn factors(self) -> &'static [f64] {
        match self {
            Self::Elements => &ELEMENTS,
            _ => &FACTORS,
        }
    }

    /// Whether the scene has it.
    pub fn is_in(self, variant: &Variant, linkage: &Linkage) -> bool {
        match self {
            Self::Elements => variant.flexible.is_some(),
            _ => self.apply(1.0, &mut linkage.clone()).unwrap_or(0) > 0,
        }
    }

    /// The scene with this number changed, ready to run.
    ///
    /// # Errors
    /// Those of a scene that cannot be built or cannot start.
    pub fn prepare(self, scene: &str, variant: &Variant, factor: f64) -> Result<Prepared, CliError> {
        let entry = scenes::find(scene)?;
        if self == Self::Elements {
            let flexible = Some(factor as u16);
            return ready(entry.scene(&Variant { flexible, ..*variant })?);
        }
        let mut changed = entry.scene(variant)?;
        self.apply(factor, &mut changed.linkage)
            .map_err(|error| CliError::usage("there is no such scene").with_source(error))?;
        ready(changed)
    }

    /// Changes a linkage; tells the number of places where.
    fn apply(self, factor: f64, linkage: &mut Linkage) -> Result<usize, ParameterError> {
        let mut count = 0;
        match self {
            Self::ContactStiffness => {
                for clearance in linkage.clearances_mut() {
                    count += usize::from(stiffen(factor, &mut clearance.law)?);
                }
            }
            Self::Modulus => {
                for spring in linkage.springs_mut() {
                    spring.stiffness *= factor;
                    spring.damping *= factor;
                    count += 1;
                }
            }
            Self::Elements => {}
            Self::FrictionSlope => {
                for characteristic in linkage.characteristics_mut() {
                    count += usize::from(steepen(factor, characteristic));
                }
            }
            Self::BristleStiffness => {
                let bristles = linkage.clearances_mut().filter_map(|c| c.friction.as_mut());
                for bristle in bristles {
                    let lugre = match bristle {
                        Bristle::LuGre(lugre) => lugre,
                        Bristle::ElastoPlastic(law) => &mut law.lugre,
                        _ => continue,
                    };
                    lugre.bristle_stiffness *= factor;
                    count += 1;
                }
            }
            Self::MassRatio => {
                let light = LIGHT.into_iter().find(|name| linkage.inertia_mut(name).is_some());
                if let Some(inertia) = light.and_then(|name| linkage.inertia_mut(name)) {
                    inertia.mass /= factor;
                    inertia.about_com /= factor;
                    count += 1;
                }
            }
        }
        Ok(count)
    }
}

/// A contact law of this many times the stiffness, at the same restitution; `false` for laws of the caller's own.
fn stiffen(factor: f64, law: &mut ContactLaw) -> Result<bool, ParameterError> {
    match law {
        ContactLaw::Family(family) => {
            let floor = family.least_impact_speed();
            let stiffer = linkdyn_mechanisms::contact::NormalLaw::new(
                factor * family.stiffness(),
                family.exponent(),
                family.damping(),
            )?;
            *family = stiffer.with_least_impact_speed(floor)?;
        }
        ContactLaw::KelvinVoigt(linear) => linear.stiffness *= factor,
        _ => return Ok(false),
    }
    Ok(true)
}

/// A characteristic of this many times the slope at zero; `false` for those without a reference speed.
fn steepen(factor: f64, characteristic: &mut Friction) -> bool {
    match characteristic {
        Friction::Exponential(law) => law.reference_speed /= factor,
        Friction::PiecewiseLinear(law) => law.reference_speed /= factor,
        Friction::HyperbolicTangent(law) => law.reference_speed /= factor,
        Friction::Cubic(law) => law.reference_speed /= factor,
        Friction::Stribeck(law) => law.reference_speed /= factor,
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::ClearanceArg;

    fn found(scene: &str, variant: &Variant) -> Vec<&'static str> {
        let linkage = scenes::find(scene)
            .and_then(|entry| entry.scene(variant))
            .expect("a scene")
            .linkage;
        let quantities = Quantity::ALL.into_iter();
        quantities
            .filter(|q| q.is_in(variant, &linkage))
            .map(Quantity::name)
            .collect()
    }

    #[test]
    fn each_scene_has_its_quantities() {
        let ideal = Variant::default();
        let friction = Variant {
            friction: Some(true),
            ..ideal
        };
        assert_eq!(found("rsrrr", &ideal), ["mass ratio"]);
        assert_eq!(found("rsrrr", &friction), ["friction slope", "mass ratio"]);
        let planar = Variant {
            clearance: Some(ClearanceArg::Planar),
            ..ideal
        };
        assert_eq!(
            found("rsup", &planar),
            ["contact stiffness", "bristle stiffness", "mass ratio"]
        );
        let flexible = Variant {
            flexible: Some(2),
            ..ideal
        };
        assert_eq!(found("rsup", &flexible), ["elastic modulus", "elements", "mass ratio"]);
    }

    #[test]
    fn a_factor_reaches_every_number_it_is_for() {
        let variant = Variant {
            flexible: Some(2),
            ..Variant::default()
        };
        let plain = Quantity::Modulus
            .prepare("rsup", &variant, 1.0)
            .expect("builds")
            .scene
            .linkage;
        let mut stiff = Quantity::Modulus
            .prepare("rsup", &variant, 100.0)
            .expect("builds")
            .scene
            .linkage;
        let mut plain = plain;
        let pairs: Vec<_> = plain.springs_mut().zip(stiff.springs_mut()).collect();
        assert_eq!(pairs.len(), 6);
        assert!(
            pairs
                .iter()
                .all(|(a, b)| b.stiffness == 100.0 * a.stiffness && a.stiffness > 0.0)
        );
        let four = Quantity::Elements.prepare("rsup", &variant, 4.0).expect("builds");
        assert_eq!(four.scene.linkage.clone().springs_mut().count(), 12);
        let light = Quantity::MassRatio.prepare("rsup", &variant, 1e6).expect("builds");
        let mass = light
            .scene
            .linkage
            .clone()
            .inertia_mut("2,2")
            .map(|inertia| inertia.mass);
        assert!(mass.is_some_and(|mass| (mass - 1e-7).abs() < 1e-15), "{mass:?}");
    }
}
