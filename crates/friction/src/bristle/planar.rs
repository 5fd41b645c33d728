//! Bristles that lean in a plane: both slip and deflection have two components.

use super::BristleModel;

/// A bristle model at one slip and deflection in the plane of contact, by components.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlanarBristlePoint {
    /// Coefficient of friction µ \[-\]; friction is µ times the normal force, against the slip.
    pub coefficient: [f64; 2],
    /// Rate of the bristle ż \[m/s\].
    pub rate: [f64; 2],
}

/// Deflection \[m\] that a bristle gets where a contact is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum BristleStart {
    /// None. With constant bristle damping the coefficient then begins at σ₁ v.
    #[default]
    Relaxed,
    /// The one that a lasting slip ends in, so that the coefficient begins on the steady curve.
    Steady,
}

impl BristleStart {
    /// Deflection \[m\] at the first slip \[m/s\]; zero also for a bristle that never settles.
    pub fn deflection(self, model: &dyn BristleModel, slip: f64) -> f64 {
        match self {
            Self::Relaxed => 0.0,
            Self::Steady => Some(model.steady_bristle(slip))
                .filter(|z| !z.is_infinite())
                .unwrap_or(0.0),
        }
    }

    /// The same in a plane.
    pub fn planar_deflection(self, model: &dyn BristleModel, slip: [f64; 2]) -> [f64; 2] {
        let (speed, direction) = polar(slip);
        direction.map(|d| d * self.deflection(model, speed))
    }
}

/// Length and direction; zero has no direction and gets (0, 0).
#[inline]
pub(super) fn polar(v: [f64; 2]) -> (f64, [f64; 2]) {
    let length = v[0].hypot(v[1]);
    let direction = if length == 0.0 { [0.0; 2] } else { v.map(|x| x / length) };
    (length, direction)
}

/// A model for one direction, used for two: at the slip's speed, with the bristle's part along the slip and the one
/// across it by themselves.
pub(super) fn superposed<M: BristleModel + ?Sized>(model: &M, slip: [f64; 2], bristle: [f64; 2]) -> PlanarBristlePoint {
    let (speed, along) = polar(slip);
    // At rest every direction is as good.
    let along = if speed == 0.0 { [1.0, 0.0] } else { along };
    let across = [-along[1], along[0]];
    let part = |u: [f64; 2]| u[0] * bristle[0] + u[1] * bristle[1];
    let (a, b, slipping) = (
        model.at(speed, part(along)),
        model.at(speed, part(across)),
        model.at(speed, 0.0),
    );
    let join = |a: f64, b: f64| [0, 1].map(|i| a * along[i] + b * across[i]);
    PlanarBristlePoint {
        coefficient: join(a.coefficient.value, b.coefficient.value - slipping.coefficient.value),
        rate: join(a.rate.value, b.rate.value - slipping.rate.value),
    }
}
