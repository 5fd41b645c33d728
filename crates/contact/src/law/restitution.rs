//! Damping factors from a wanted restitution.

use super::Damping;
use crate::{Expected, ParameterError, impact};
use std::ops::RangeInclusive;

/// A published formula ξ(ε) for the damping factor of F = K δⁿ (1 + ξ δ'/v₀) by the restitution ε.
///
/// All but `Exact` are approximations: what [`impact::restitution`] makes of their ξ is not the ε that was asked
/// for. [`valid_range`](Self::valid_range) tells where it comes near.
///
/// | law | ξ(ε) | source |
/// |---|---|---|
/// | `HuntCrossley` | 3(1 - ε)/2 | Hunt and Crossley 1975 |
/// | `HerbertMcWhannell` | 6(1 - ε)/((2ε - 1)² + 3) | Herbert and McWhannell 1977 |
/// | `LeeWang` | 3(1 - ε)/4 | Lee and Wang 1983 |
/// | `LankaraniNikravesh` | 3(1 - ε²)/4 | Lankarani and Nikravesh 1990 |
/// | `Gonthier` | (1 - ε²)/ε | Gonthier, McPhee, Lange, Piedbœuf 2004, approximate form |
/// | `ZhiyingQishao` | 3(1 - ε²) exp(2(1 - ε))/4 | Zhiying and Qishao 2006 |
/// | `Flores` | 8(1 - ε)/(5ε) | Flores, Machado, Silva, Martins 2011 |
/// | `HuGuo` | 3(1 - ε)/(2ε) | Hu and Guo 2015 |
/// | `CarvalhoMartins` | 3(1 - ε)(11 - ε)/(2(1 + 9ε)) | Carvalho and Martins 2019 |
/// | `Exact` | root of ξ (1 + ε) = ln((1 + ξ)/(1 - ξ ε)) | [`impact`] |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum RestitutionLaw {
    /// Made for ε near one; valid from 0.748.
    HuntCrossley,
    /// Made for ε near one; valid from 0.604.
    HerbertMcWhannell,
    /// Valid from 0.905; to first order in 1 - ε it loses half of what it should.
    LeeWang,
    /// Made for ε near one; valid from 0.794. Never delivers less than 0.648.
    LankaraniNikravesh,
    /// Valid for all ε > 0.
    Gonthier,
    /// Valid from 0.238.
    ZhiyingQishao,
    /// Valid for all ε > 0.
    Flores,
    /// Valid for all ε > 0, best above one half.
    HuGuo,
    /// Valid from 0.029, right to three digits above one half.
    CarvalhoMartins,
    /// Delivers what is asked for.
    Exact,
}

impl RestitutionLaw {
    /// All of them, in order of publication.
    pub const ALL: [Self; 10] = [
        Self::HuntCrossley,
        Self::HerbertMcWhannell,
        Self::LeeWang,
        Self::LankaraniNikravesh,
        Self::Gonthier,
        Self::ZhiyingQishao,
        Self::Flores,
        Self::HuGuo,
        Self::CarvalhoMartins,
        Self::Exact,
    ];

    /// Largest difference \[-\] of delivered and nominal restitution within [`valid_range`](Self::valid_range).
    pub const TOLERANCE: f64 = 0.05;

    /// This law with a restitution, for [`NormalLaw::new`](crate::NormalLaw::new).
    pub const fn with(self, restitution: f64) -> Damping {
        Damping::Restitution { law: self, restitution }
    }

    /// ξ(ε) \[-\], zero for ε = 1.
    ///
    /// # Errors
    /// A restitution outside 0 ≤ ε ≤ 1, or zero where ξ(0) would be infinite (`Gonthier`, `Flores`, `HuGuo`,
    /// `Exact`).
    pub fn damping_factor(self, restitution: f64) -> Result<f64, ParameterError> {
        self.accepted().check("restitution", restitution)?;
        let eps = restitution;
        Ok(match self {
            Self::HuntCrossley => 1.5 * (1.0 - eps),
            Self::HerbertMcWhannell => 6.0 * (1.0 - eps) / ((2.0 * eps - 1.0).powi(2) + 3.0),
            Self::LeeWang => 0.75 * (1.0 - eps),
            Self::LankaraniNikravesh => 0.75 * (1.0 - eps) * (1.0 + eps),
            Self::Gonthier => (1.0 - eps) * (1.0 + eps) / eps,
            Self::ZhiyingQishao => 0.75 * (1.0 - eps) * (1.0 + eps) * (2.0 * (1.0 - eps)).exp(),
            Self::Flores => 1.6 * (1.0 - eps) / eps,
            Self::HuGuo => 1.5 * (1.0 - eps) / eps,
            Self::CarvalhoMartins => 1.5 * (1.0 - eps) * (11.0 - eps) / (1.0 + 9.0 * eps),
            Self::Exact => impact::damping_factor(eps),
        })
    }

    fn accepted(self) -> Expected {
        match self {
            Self::Gonthier | Self::Flores | Self::HuGuo | Self::Exact => Expected::PositiveFraction,
            _ => Expected::Fraction,
        }
    }

    /// The nominal restitutions from which on, up to one, the delivered one differs by at most
    /// [`TOLERANCE`](Self::TOLERANCE), to three digits. It starts at 0.001 for laws that are good for every ε they
    /// accept but do not accept zero. Found by trying all thousandths; not for inner loops.
    pub fn valid_range(self) -> RangeInclusive<f64> {
        let good = |thousandths: &u32| {
            let eps = f64::from(*thousandths) / 1000.0;
            self.damping_factor(eps)
                .is_ok_and(|xi| (impact::restitution(xi) - eps).abs() <= Self::TOLERANCE)
        };
        let lowest = (0..=1000).rev().take_while(good).last().unwrap_or(1000);
        f64::from(lowest) / 1000.0..=1.0
    }
}
