use super::planar::{PlanarBristlePoint, polar};
use super::{BristleModel, BristlePoint, Partials};
use crate::{Expected, ParameterError};

/// LuGre bristle model, normalised by the normal force.
///
/// ```text
/// µ = σ₀ z + σ₁ ż + σ₂ v                           Canudas de Wit, Olsson, Åström, Lischinsky 1995,
/// ż = v - σ₀ |v| z/g(v)                            divided by the normal force
/// g(v) = µ_k + (µ_s - µ_k) exp(-(v/v_s)²)
/// ```
///
/// Facts, each with a test: |z| ≤ µ_s/σ₀ is never left; a lasting slip ends in
/// µ = g(v) sgn(v) + σ₂ v; the model is passive at v, whatever the deflection, if (for
/// σ₂ = 0 only if) σ₁ |v| ≤ 4 g(v). With a
/// constant σ₁ a bristle at rest meets a slip v with µ = σ₁ v, which may lie far above µ_s: see
/// [`Guard`]. The bristle of a sticking contact creeps under an oscillating load: see
/// [`ElastoPlastic`](crate::ElastoPlastic).
///
/// The force form is this form for a unit normal force: coefficients in N, σ₀ in N/m, σ₁ and σ₂ in
/// N s/m.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LuGre {
    /// Static coefficient µ_s ≥ µ_k \[-\].
    pub static_coefficient: f64,
    /// Kinetic coefficient µ_k ≥ 0 \[-\].
    pub kinetic_coefficient: f64,
    /// Stribeck speed v_s > 0 \[m/s\].
    pub stribeck_speed: f64,
    /// Bristle stiffness σ₀ ≥ 0 \[1/m\].
    pub bristle_stiffness: f64,
    /// Bristle damping σ₁ ≥ 0 \[s/m\].
    pub bristle_damping: f64,
    /// Viscous coefficient σ₂ ≥ 0 \[s/m\].
    pub viscous_coefficient: f64,
    /// What becomes of σ₁ at higher speeds; nothing by default.
    #[cfg_attr(feature = "serde", serde(default))]
    pub guard: Guard,
}

/// What becomes of the bristle damping σ₁ at higher slip speeds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Guard {
    /// σ₁ stays constant, as in the original model.
    #[default]
    None,
    /// σ₁(v) = min(σ₁, g(v)/|v|): then |µ - σ₂ v| ≤ µ_s and the model is passive at every speed.
    /// Above |v| = g/σ₁ friction is the steady curve itself.
    Cap,
    /// σ₁(v) = σ₁ exp(-(v/v_d)²), after Olsson 1996. Passive where σ₁(v) |v| ≤ 4 g(v).
    Decay {
        /// Decay speed v_d > 0 \[m/s\].
        speed: f64,
    },
}

impl LuGre {
    /// Dahl's model: ż = v - σ₀ |v| z/µ_k, µ = σ₀ z. A bristle without damping and static peak.
    pub const fn dahl(coefficient: f64, bristle_stiffness: f64) -> Self {
        Self {
            static_coefficient: coefficient,
            kinetic_coefficient: coefficient,
            stribeck_speed: 1.0,
            bristle_stiffness,
            bristle_damping: 0.0,
            viscous_coefficient: 0.0,
            guard: Guard::None,
        }
    }

    /// Steady curve g(v) \[-\] and its slope \[s/m\]: the coefficient without sign and viscous share.
    #[inline]
    pub fn steady_curve(&self, slip: f64) -> (f64, f64) {
        let (e, de) = gauss(slip, self.stribeck_speed);
        let peak = self.static_coefficient - self.kinetic_coefficient;
        (self.kinetic_coefficient + peak * e, peak * de)
    }

    /// Bristle damping σ₁(v) \[s/m\] under the guard, and its slope \[s²/m²\].
    #[inline]
    pub fn damping(&self, slip: f64) -> (f64, f64) {
        self.guarded_damping(slip, self.steady_curve(slip))
    }

    #[inline]
    fn guarded_damping(&self, v: f64, (g, dg): (f64, f64)) -> (f64, f64) {
        let sigma1 = self.bristle_damping;
        match self.guard {
            Guard::None => (sigma1, 0.0),
            Guard::Cap if sigma1 * v.abs() > g => (g / v.abs(), (dg - g / v).copysign(-v) / v.abs()),
            Guard::Cap => (sigma1, 0.0),
            Guard::Decay { speed } => {
                let (e, de) = gauss(v, speed);
                (sigma1 * e, sigma1 * de)
            }
        }
    }

    /// Deflection \[m\] after a duration \[s\] at constant slip \[m/s\], exactly:
    ///
    /// ```text
    /// z + (z_ss - z)(1 - exp(-σ₀ |v| h/g)),  z_ss = g sgn(v)/σ₀
    /// ```
    ///
    /// Never leaves the interval between z and z_ss, whatever the duration.
    pub fn step(&self, slip: f64, bristle: f64, duration: f64) -> f64 {
        let (v, z, h) = (slip, bristle, duration);
        let sigma0 = self.bristle_stiffness;
        if v * h == 0.0 || sigma0 == 0.0 {
            return z + v * h;
        }
        let (g, _) = self.steady_curve(v);
        let x = sigma0 * (v * h).abs() / g;
        z + ((g / sigma0).copysign(v) - z) * -(-x).exp_m1()
    }

    /// [`step`](Self::step) in the plane of contact: the deflection runs straight to the steady one.
    pub fn step_planar(&self, slip: [f64; 2], bristle: [f64; 2], duration: f64) -> [f64; 2] {
        let (v, z, h) = (slip, bristle, duration);
        let (speed, direction) = polar(v);
        let sigma0 = self.bristle_stiffness;
        if speed * h == 0.0 || sigma0 == 0.0 {
            return [0, 1].map(|i| z[i] + v[i] * h);
        }
        let (g, _) = self.steady_curve(speed);
        let settled = -(-sigma0 * (speed * h).abs() / g).exp_m1();
        [0, 1].map(|i| z[i] + (g / sigma0 * direction[i] - z[i]) * settled)
    }

    /// Coefficient and rate for ż = v - flow, where `flow` is a function of the speed and of the vector s = σ₀ z/g.
    /// LuGre has |v| s.
    #[inline]
    pub(super) fn evaluate_planar(
        &self,
        v: [f64; 2],
        z: [f64; 2],
        flow: impl Fn(f64, [f64; 2]) -> [f64; 2],
    ) -> PlanarBristlePoint {
        let sigma0 = self.bristle_stiffness;
        let (speed, direction) = polar(v);
        let curve = self.steady_curve(speed);
        // Without friction a bristle carries nothing and flows at once.
        let share = if curve.0 > 0.0 {
            z.map(|z| sigma0 * z / curve.0)
        } else {
            direction
        };
        let flow = flow(speed, share);
        let (sigma1, _) = self.guarded_damping(speed, curve);
        let rate = [v[0] - flow[0], v[1] - flow[1]];
        PlanarBristlePoint {
            coefficient: [0, 1].map(|i| sigma0 * z[i] + sigma1 * rate[i] + self.viscous_coefficient * v[i]),
            rate,
        }
    }

    /// Coefficient and rate for ż = v - |v| S(s), where s = σ₀ z/g is the load on the bristle as a
    /// share of the steady one, and `flow` gives S and dS/ds. LuGre has S = s.
    #[inline]
    pub(super) fn evaluate(&self, v: f64, z: f64, flow: impl Fn(f64) -> (f64, f64)) -> BristlePoint {
        let sigma0 = self.bristle_stiffness;
        let (g, dg) = self.steady_curve(v);
        let sign = sign(v);
        // Without friction a bristle carries nothing and flows at once.
        let (share, share_z, share_v) = if g > 0.0 {
            let s = sigma0 * z / g;
            (s, sigma0 / g, -s * dg / g)
        } else {
            (sign, 0.0, 0.0)
        };
        let (flowing, slope) = flow(share);
        let rate = Partials {
            value: v - v.abs() * flowing,
            d_slip: 1.0 - sign * flowing - v.abs() * slope * share_v,
            d_bristle: -v.abs() * slope * share_z,
        };
        let (sigma1, dsigma1) = self.guarded_damping(v, (g, dg));
        let sigma2 = self.viscous_coefficient;
        let coefficient = Partials {
            value: sigma0 * z + sigma1 * rate.value + sigma2 * v,
            d_slip: sigma1 * rate.d_slip + dsigma1 * rate.value + sigma2,
            d_bristle: sigma0 + sigma1 * rate.d_bristle,
        };
        BristlePoint { coefficient, rate }
    }
}

impl BristleModel for LuGre {
    #[inline]
    fn at(&self, slip: f64, bristle: f64) -> BristlePoint {
        self.evaluate(slip, bristle, |s| (s, 1.0))
    }

    /// ż = v - σ₀ |v| z/g(|v|) by components, µ = σ₀ z + σ₁ ż + σ₂ v. |z| ≤ µ_s/σ₀ is never left, and the model is
    /// passive where the one-dimensional one is.
    #[inline]
    fn at_planar(&self, slip: [f64; 2], bristle: [f64; 2]) -> PlanarBristlePoint {
        self.evaluate_planar(slip, bristle, |speed, share| share.map(|s| speed * s))
    }

    /// z_ss = g(v) sgn(v)/σ₀; infinite for σ₀ = 0, where the bristle never settles.
    fn steady_bristle(&self, slip: f64) -> f64 {
        if slip == 0.0 {
            return 0.0;
        }
        self.steady_curve(slip).0.copysign(slip) / self.bristle_stiffness
    }

    /// µ_s/σ₀.
    fn bristle_limit(&self) -> f64 {
        self.static_coefficient / self.bristle_stiffness
    }

    /// σ₁(v) |v| ≤ 4 g(v): with s = σ₀ z sgn(v)/g and a = σ₁ |v|/g the power beyond that stored is
    /// g |v| (s² - a s + a) + σ₂ v², for σ₂ = 0 not negative at every s if and only if a ≤ 4. The
    /// worst s, a/2 > 2, may lie beyond the limit µ_s/g of a bristle that started within it; for
    /// such bristles the bound is sufficient, and necessary only where µ_s/g reaches that far.
    fn is_passive_at(&self, slip: f64) -> bool {
        self.damping(slip).0 * slip.abs() <= 4.0 * self.steady_curve(slip).0
    }

    /// g(v) sgn(v) + σ₂ v.
    fn steady_coefficient(&self, slip: f64) -> f64 {
        sign(slip) * self.steady_curve(slip).0 + self.viscous_coefficient * slip
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::NotNegative.check("kinetic_coefficient", self.kinetic_coefficient)?;
        let kinetic = Expected::AtLeast {
            bound: self.kinetic_coefficient,
            of: "kinetic_coefficient",
        };
        kinetic.check("static_coefficient", self.static_coefficient)?;
        Expected::Positive.check("stribeck_speed", self.stribeck_speed)?;
        Expected::NotNegative.check("bristle_stiffness", self.bristle_stiffness)?;
        Expected::NotNegative.check("bristle_damping", self.bristle_damping)?;
        Expected::NotNegative.check("viscous_coefficient", self.viscous_coefficient)?;
        match self.guard {
            Guard::None | Guard::Cap => Ok(()),
            Guard::Decay { speed } => Expected::Positive.check("guard.decay.speed", speed),
        }
    }
}

/// exp(-(v/w)²) and its derivative by v.
#[inline]
fn gauss(v: f64, w: f64) -> (f64, f64) {
    let u = v / w;
    let e = (-u * u).exp();
    (e, if e == 0.0 { 0.0 } else { -2.0 * u / w * e })
}

/// Sign of v, zero at zero, NaN for NaN.
#[inline]
fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}
