use super::planar::{PlanarBristlePoint, polar};
use super::{BristleModel, BristlePoint, LuGre};
use crate::{Expected, ParameterError};
use std::f64::consts::PI;

/// Elasto-plastic bristle: LuGre whose bristle is a plain spring up to a share κ of its steady load.
///
/// ```text
/// ż = v (1 - α σ₀ z sgn(v)/g(v))                   Dupont, Hayward, Armstrong, Altpeter 2002
/// α = 0 for |s| ≤ κ or v z ≤ 0, 1 for |s| ≥ 1, s = σ₀ z/g
/// α = 1/2 + 1/2 sin(π (|s| - (1 + κ)/2)/(1 - κ)) in between
/// ```
///
/// A load that stays below κ g leaves no drift behind, however often it swings. Passive at least
/// where its LuGre is, for α ≤ 1.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ElastoPlastic {
    /// The LuGre model that remains for α = 1.
    pub lugre: LuGre,
    /// Share 0 ≤ κ < 1 \[-\] of the steady load g up to which the bristle is a spring.
    pub elastic_share: f64,
}

impl ElastoPlastic {
    /// S = α s and dS/ds for a slip against which the bristle leans, v s > 0.
    #[inline]
    fn flow(&self, s: f64) -> (f64, f64) {
        let kappa = self.elastic_share;
        let x = s.abs();
        if x <= kappa {
            (0.0, 0.0)
        } else if x >= 1.0 {
            (s, 1.0)
        } else {
            let (sin, cos) = (PI * (x - 0.5 * (1.0 + kappa)) / (1.0 - kappa)).sin_cos();
            let alpha = 0.5 + 0.5 * sin;
            (alpha * s, alpha + 0.5 * PI * x * cos / (1.0 - kappa))
        }
    }
}

impl BristleModel for ElastoPlastic {
    #[inline]
    fn at(&self, slip: f64, bristle: f64) -> BristlePoint {
        self.lugre.evaluate(
            slip,
            bristle,
            |s| {
                if slip * s <= 0.0 { (0.0, 0.0) } else { self.flow(s) }
            },
        )
    }

    /// ż = v - α(|s|) max(0, v·s/|s|) s with s = σ₀ z/g(|v|): the bristle flows by the part of the slip along its
    /// deflection, so that ż stays continuous where the slip turns away from it. On a line the same as
    /// [`at`](Self::at); |z| ≤ µ_s/σ₀ is never left, and it is passive where its LuGre is.
    #[inline]
    fn at_planar(&self, slip: [f64; 2], bristle: [f64; 2]) -> PlanarBristlePoint {
        self.lugre.evaluate_planar(slip, bristle, |_, share| {
            let (x, lean) = polar(share);
            let along = slip[0] * lean[0] + slip[1] * lean[1];
            let (flowing, _) = self.flow(x);
            lean.map(|u| along.max(0.0) * (flowing * u))
        })
    }

    fn steady_bristle(&self, slip: f64) -> f64 {
        self.lugre.steady_bristle(slip)
    }

    fn bristle_limit(&self) -> f64 {
        self.lugre.bristle_limit()
    }

    /// The bound of its LuGre, sufficient here.
    fn is_passive_at(&self, slip: f64) -> bool {
        self.lugre.is_passive_at(slip)
    }

    fn steady_coefficient(&self, slip: f64) -> f64 {
        self.lugre.steady_coefficient(slip)
    }

    fn validate(&self) -> Result<(), ParameterError> {
        self.lugre.validate()?;
        Expected::ProperFraction.check("elastic_share", self.elastic_share)
    }
}
