use super::{BearingModel, Capacity, Supports, supports};
use crate::{Expected, ParameterError};

/// Guide of a prismatic joint: two pads A and B on the slide, and a key against turning.
///
/// ```text
/// f_f = µ_A N_A + µ_B N_B + µ_K N_K
/// N_A = |(f_x/2 - n_y/a, f_y/2 + n_x/a)|
/// N_B = |(f_x/2 + n_y/a, f_y/2 - n_x/a)|
/// N_K = |n_z|/b
/// ```
///
/// The counterpart of [`JournalBearing`](crate::JournalBearing) for sliding along z: pad A lies at
/// z = -a/2, pad B at z = +a/2, the joint origin midway; the force along the slide, f_z, loads no
/// surface. The key touches at two places, each b away from the slide axis, with |n_z|/(2b) each.
///
/// Limits: the pads do not move against the joint origin, so a slide that runs out of a short guide
/// (overhang) is not described; each pad bears with the resultant of its force, as on a round bar,
/// whereas a box way has |N_x| + |N_y|, up to √2 times as much; transverse load and torsion add up,
/// though one face may carry both.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PadGuide {
    /// Distance a > 0 \[m\] between the middles of the pads.
    pub spacing: f64,
    /// Distance b > 0 \[m\] of the key's contacts from the slide axis.
    pub arm: f64,
    /// Coefficient of friction µ_A ≥ 0 \[-\] of pad A for χ = 1.
    pub pad_a: f64,
    /// Coefficient of friction µ_B ≥ 0 \[-\] of pad B for χ = 1.
    pub pad_b: f64,
    /// Coefficient of friction µ_K ≥ 0 \[-\] of the key for χ = 1; zero without a key.
    pub key: f64,
}

impl PadGuide {
    /// The same guide with all coefficients of friction multiplied by a factor ≥ 0 \[-\].
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            pad_a: factor * self.pad_a,
            pad_b: factor * self.pad_b,
            key: factor * self.key,
            ..self
        }
    }

    /// Normal forces \[N\] on pad A, on pad B, and on the two contacts of the key together.
    pub fn loads(&self, force: [f64; 3], torque: [f64; 3]) -> [f64; 3] {
        let (a, b) = supports::forces(self.spacing, force, torque);
        let key = torque[2].abs() / self.arm;
        [supports::polar(a).0, supports::polar(b).0, key]
    }
}

impl BearingModel for PadGuide {
    /// Capacity \[N\].
    #[inline]
    fn capacity(&self, force: [f64; 3], torque: [f64; 3]) -> Capacity {
        let w_k = self.key / self.arm;
        let (n_k, sign) = supports::magnitude(torque[2]);
        let mut capacity = supports::capacity(self.spacing, [self.pad_a, self.pad_b], force, torque);
        capacity.value += w_k * n_k;
        capacity.d_torque[2] = w_k * sign;
        capacity
    }

    fn supports(&self) -> Option<Supports> {
        let (w_a, w_b) = (self.pad_a, self.pad_b);
        Some(Supports {
            across: [[0.5 * w_a, w_a / self.spacing], [0.5 * w_b, -w_b / self.spacing]],
            along: [0.0, self.key / self.arm],
        })
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::Positive.check("spacing", self.spacing)?;
        Expected::Positive.check("arm", self.arm)?;
        Expected::NotNegative.check("pad_a", self.pad_a)?;
        Expected::NotNegative.check("pad_b", self.pad_b)?;
        Expected::NotNegative.check("key", self.key)
    }
}
