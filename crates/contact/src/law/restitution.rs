//! Damping factors from a wanted restitution.

use super::Damping;
use crate::{Expected, ParameterError, impact};
use std::ops::RangeInclusive;

/// A published formula χ(e) for the damping factor of F = K δⁿ (1 + χ δ'/v₀) by the restitution e.
///
/// All but `Exact` are approximations: what [`impact::restitution`] makes of their χ is not the e that was asked
/// for. [`valid_range`](Self::valid_range) tells where it comes near.
///
/// | law | χ(e) | source |
/// |---|---|---|
/// | `HuntCrossley` | 3(1 - e)/2 | Hunt and Crossley 1975 |
/// | `HerbertMcWhannell` | 6(1 - e)/((2e - 1)² + 3) | Herbert and McWhannell 1977 |
/// | `LeeWang` | 3(1 - e)/4 | Lee and Wang 1983 |
/// | `LankaraniNikravesh` | 3(1 - e²)/4 | Lankarani and Nikravesh 1990 |
/// | `Gonthier` | (1 - e²)/e | Gonthier, McPhee, Lange, Piedbœuf 2004, approximate form |
/// | `ZhiyingQishao` | 3(1 - e²) exp(2(1 - e))/4 | Zhiying and Qishao 2006 |
/// | `Flores` | 8(1 - e)/(5e) | Flores, Machado, Silva, Martins 2011 |
/// | `HuGuo` | 3(1 - e)/(2e) | Hu and Guo 2015 |
/// | `CarvalhoMartins` | 3(1 - e)(11 - e)/(2(1 + 9e)) | Carvalho and Martins 2019 |
/// | `Exact` | root of χ (1 + e) = ln((1 + χ)/(1 - χ e)) | [`impact`] |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum RestitutionLaw {
    /// Made for e near one; valid from 0.748.
    HuntCrossley,
    /// Made for e near one; valid from 0.604.
    HerbertMcWhannell,
    /// Valid from 0.905; to first order in 1 - e it loses half of what it should.
    LeeWang,
    /// Made for e near one; valid from 0.794. Never delivers less than 0.648.
    LankaraniNikravesh,
    /// Valid for all e > 0.
    Gonthier,
    /// Valid from 0.238.
    ZhiyingQishao,
    /// Valid for all e > 0.
    Flores,
    /// Valid for all e > 0, best above one half.
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

    /// χ(e) \[-\], zero for e = 1.
    ///
    /// # Errors
    /// A restitution outside 0 ≤ e ≤ 1, or zero where χ(0) would be infinite (`Gonthier`, `Flores`, `HuGuo`,
    /// `Exact`).
    pub fn damping_factor(self, restitution: f64) -> Result<f64, ParameterError> {
        self.accepted().check("restitution", restitution)?;
        let e = restitution;
        Ok(match self {
            Self::HuntCrossley => 1.5 * (1.0 - e),
            Self::HerbertMcWhannell => 6.0 * (1.0 - e) / ((2.0 * e - 1.0).powi(2) + 3.0),
            Self::LeeWang => 0.75 * (1.0 - e),
            Self::LankaraniNikravesh => 0.75 * (1.0 - e) * (1.0 + e),
            Self::Gonthier => (1.0 - e) * (1.0 + e) / e,
            Self::ZhiyingQishao => 0.75 * (1.0 - e) * (1.0 + e) * (2.0 * (1.0 - e)).exp(),
            Self::Flores => 1.6 * (1.0 - e) / e,
            Self::HuGuo => 1.5 * (1.0 - e) / e,
            Self::CarvalhoMartins => 1.5 * (1.0 - e) * (11.0 - e) / (1.0 + 9.0 * e),
            Self::Exact => impact::damping_factor(e),
        })
    }

    fn accepted(self) -> Expected {
        match self {
            Self::Gonthier | Self::Flores | Self::HuGuo | Self::Exact => Expected::PositiveFraction,
            _ => Expected::Fraction,
        }
    }

    /// The nominal restitutions from which on, up to one, the delivered one differs by at most
    /// [`TOLERANCE`](Self::TOLERANCE), to three digits. It starts at 0.001 for laws that are good for every e they
    /// accept but do not accept zero. Found by trying all thousandths; not for inner loops.
    pub fn valid_range(self) -> RangeInclusive<f64> {
        let good = |thousandths: &u32| {
            let e = f64::from(*thousandths) / 1000.0;
            self.damping_factor(e)
                .is_ok_and(|chi| (impact::restitution(chi) - e).abs() <= Self::TOLERANCE)
        };
        let lowest = (0..=1000).rev().take_while(good).last().unwrap_or(1000);
        f64::from(lowest) / 1000.0..=1.0
    }
}
