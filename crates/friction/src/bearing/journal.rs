use super::{BearingModel, Capacity, Supports, supports};
use crate::{Expected, ParameterError};

/// A surface on which a bearing slides.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Surface {
    /// Diameter d > 0 \[m\].
    pub diameter: f64,
    /// Coefficient of friction µ₀ ≥ 0 \[-\] for χ = 1.
    pub coefficient: f64,
}

/// Bearing of a revolute joint: two journals A and B, and a thrust face C.
///
/// ```text
/// t_f = µ_A d_A f_A/2 + µ_B d_B f_B/2
///     + µ_C |f_z| (d_C² + d_C d_A + d_A²)/(3 (d_C + d_A))        Harlecki and Urbaś, eqs. (4) to (5.3)
/// f_A = |(f_x/2 - n_y/a, f_y/2 + n_x/a)|                         eq. (6.1)
/// f_B = |(f_x/2 + n_y/a, f_y/2 - n_x/a)|                         eq. (6.2)
/// ```
///
/// Surface A lies at z = -a/2, B at z = +a/2, the joint origin midway. The face is a ring from d_A
/// to d_C under even pressure; the printed quotient of eq. (5.3) is 0/0 for d_C = d_A, the one
/// above is the same with the common factor taken out. The torque about the axis, n_z, loads no
/// surface. Where a surface carries nothing, its part of the gradient is zero; the capacity has a
/// cone's tip there and no derivative.
///
/// In the paper χ is taken at the joint speed in rad/s, one for all three surfaces;
/// [`sliding_speeds`](Self::sliding_speeds) gives the speeds in m/s instead.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct JournalBearing {
    /// Distance a > 0 \[m\] between the middles of the journals A and B.
    pub spacing: f64,
    /// Journal A, at z = -a/2.
    pub surface_a: Surface,
    /// Journal B, at z = +a/2.
    pub surface_b: Surface,
    /// Thrust face C: outer diameter d_C ≥ d_A, the inner one is d_A. Without a thrust face give the
    /// coefficient zero.
    pub face: Surface,
}

impl JournalBearing {
    /// The same bearing with all coefficients of friction multiplied by a factor ≥ 0 \[-\].
    pub fn scaled(self, factor: f64) -> Self {
        let scaled = |surface: Surface| Surface {
            coefficient: factor * surface.coefficient,
            ..surface
        };
        Self {
            spacing: self.spacing,
            surface_a: scaled(self.surface_a),
            surface_b: scaled(self.surface_b),
            face: scaled(self.face),
        }
    }

    /// Normal forces \[N\] on A, B and C: f_A, f_B and |f_z|.
    pub fn loads(&self, force: [f64; 3], torque: [f64; 3]) -> [f64; 3] {
        let (a, b) = supports::forces(self.spacing, force, torque);
        [supports::polar(a).0, supports::polar(b).0, force[2].abs()]
    }

    /// Levers \[m\] of the friction on A, B and C: the radii of the journals, and of the face the
    /// radius at which its friction may be thought to act.
    pub fn levers(&self) -> [f64; 3] {
        let (d_a, d_b, d_c) = (self.surface_a.diameter, self.surface_b.diameter, self.face.diameter);
        [
            0.5 * d_a,
            0.5 * d_b,
            (d_c * d_c + d_c * d_a + d_a * d_a) / (3.0 * (d_c + d_a)),
        ]
    }

    /// Sliding speeds \[m/s\] on A, B and C for a joint speed \[rad/s\]: the speed times the levers.
    pub fn sliding_speeds(&self, joint_speed: f64) -> [f64; 3] {
        self.levers().map(|lever| lever * joint_speed)
    }
}

impl BearingModel for JournalBearing {
    /// Capacity \[N m\].
    #[inline]
    fn capacity(&self, force: [f64; 3], torque: [f64; 3]) -> Capacity {
        let [r_a, r_b, r_c] = self.levers();
        let w_a = self.surface_a.coefficient * r_a;
        let w_b = self.surface_b.coefficient * r_b;
        let w_c = self.face.coefficient * r_c;
        let (f_c, sign) = supports::magnitude(force[2]);
        let mut capacity = supports::capacity(self.spacing, [w_a, w_b], force, torque);
        capacity.value += w_c * f_c;
        capacity.d_force[2] = w_c * sign;
        capacity
    }

    fn supports(&self) -> Option<Supports> {
        let [r_a, r_b, r_c] = self.levers();
        let w_a = self.surface_a.coefficient * r_a;
        let w_b = self.surface_b.coefficient * r_b;
        Some(Supports {
            across: [[0.5 * w_a, w_a / self.spacing], [0.5 * w_b, -w_b / self.spacing]],
            along: [self.face.coefficient * r_c, 0.0],
        })
    }

    fn validate(&self) -> Result<(), ParameterError> {
        Expected::Positive.check("spacing", self.spacing)?;
        Expected::Positive.check("surface_a.diameter", self.surface_a.diameter)?;
        Expected::NotNegative.check("surface_a.coefficient", self.surface_a.coefficient)?;
        Expected::Positive.check("surface_b.diameter", self.surface_b.diameter)?;
        Expected::NotNegative.check("surface_b.coefficient", self.surface_b.coefficient)?;
        let inner = Expected::AtLeast {
            bound: self.surface_a.diameter,
            of: "surface_a.diameter, the inner edge of the face",
        };
        inner.check("face.diameter", self.face.diameter)?;
        Expected::NotNegative.check("face.coefficient", self.face.coefficient)
    }
}
