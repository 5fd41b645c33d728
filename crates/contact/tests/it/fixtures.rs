//! Data of the benchmarks, random motions, an integrator.

use linkdyn_contact::*;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

/// The contact of the RSUP linkage.
pub fn rsup() -> NormalLaw {
    NormalLaw::new(2.176e10, 1.5, RestitutionLaw::LankaraniNikravesh.with(0.9)).unwrap()
}

pub fn rsup_fit() -> Fit {
    Fit::new(0.005, 0.004).unwrap()
}

pub fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}

pub fn direction() -> impl Strategy<Value = Vector3<f64>> {
    vector(1.0)
        .prop_filter("too short for a direction", |v| v.norm() > 0.1)
        .prop_map(|v| v.normalize())
}

/// Any damping that has a meaning for all restitutions of the crate's laws, and n.
pub fn law() -> impl Strategy<Value = NormalLaw> {
    let restitution = (0..10usize, 0.05..=1.0f64).prop_map(|(i, e)| RestitutionLaw::ALL[i].with(e));
    let damping = prop_oneof![
        1 => Just(Damping::Hertz),
        8 => restitution,
        1 => (0.0..2.0f64).prop_map(|constant| Damping::Material { constant }),
    ];
    let exponent = prop_oneof![Just(1.5), Just(1.0), 1.0..3.0f64];
    (1e3..1e11f64, exponent, damping).prop_map(|(k, n, damping)| NormalLaw::new(k, n, damping).unwrap())
}

/// What came out of an impact.
#[derive(Debug)]
pub struct Impact {
    pub restitution: f64,
    pub greatest_depth: f64,
    /// Integral of F dδ.
    pub lost: f64,
    pub clamped: bool,
}

/// Integrates m δ'' = -F from the first touch with RK4 until the bodies separate: at depth zero, or where the force is
/// clamped. States are depth, speed and loss.
pub fn impact(law: &dyn NormalModel, mass: f64, speed: f64, steps: usize) -> Impact {
    let rate = |y: [f64; 3]| {
        let f = law.at(y[0], y[1], speed);
        [y[1], -f.value / mass, f.value * y[1]]
    };
    let add = |y: [f64; 3], k: [f64; 3], h: f64| [y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2]];
    let step = |y: [f64; 3], h: f64| {
        let k1 = rate(y);
        let k2 = rate(add(y, k1, 0.5 * h));
        let k3 = rate(add(y, k2, 0.5 * h));
        let k4 = rate(add(y, k3, h));
        let k = [0, 1, 2].map(|i| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0);
        add(y, k, h)
    };
    let h = law.greatest_depth(mass, speed) / speed / steps as f64;
    // Off the line of depth zero, where laws with a jump say nothing yet.
    let mut y = [1e-9 * speed * h, speed, 0.0];
    let (mut greatest, mut clamped) = (0.0, false);
    for _ in 0..1000 * steps {
        let mut next = step(y, h);
        if y[1] > 0.0 && next[1] <= 0.0 {
            // The summit: Newton's method on the speed.
            let mut top = y;
            for _ in 0..6 {
                top = step(top, top[1] * mass / law.at(top[0], top[1], speed).value);
            }
            greatest = top[0];
        }
        let separated = law.at(next[0], next[1], speed).clamped;
        clamped |= separated;
        if next[0] <= 0.0 || separated {
            if next[0] <= 0.0 {
                for _ in 0..6 {
                    next = step(next, -next[0] / next[1]);
                }
            }
            return Impact {
                restitution: -next[1] / speed,
                greatest_depth: greatest,
                lost: next[2],
                clamped,
            };
        }
        y = next;
    }
    panic!("the impact does not end: {law:?} {mass} {speed} {y:?}");
}

/// A body that moves with constant velocity and constant spin.
#[derive(Debug, Clone, Copy)]
pub struct Mover {
    pub at_zero: Centre,
}

impl Mover {
    pub fn at(&self, t: f64) -> Centre {
        let c = self.at_zero;
        Centre {
            point: c.point + c.velocity * t,
            axis: Rotation3::new(c.spin * t) * c.axis,
            ..c
        }
    }

    /// Place of a material point of the body at time t, given where it is at time zero.
    pub fn material(&self, point: Vector3<f64>, t: f64) -> Vector3<f64> {
        let c = self.at_zero;
        c.point + c.velocity * t + Rotation3::new(c.spin * t) * (point - c.point)
    }
}

/// A bearing and a journal tilted by up to some angle, with their centres up to some clearances apart.
pub fn pair(fit: Fit, tilt: f64) -> impl Strategy<Value = (Mover, Mover)> {
    let state = (vector(0.5), vector(0.5), vector(20.0));
    let other = (
        vector(0.5),
        vector(20.0),
        0.6..3.0f64,
        -0.02..0.02f64,
        direction(),
        0.0..tilt,
    );
    (state, direction(), other, vector(1.0)).prop_map(
        move |((r, v, w), axis, (v2, w2, share, along, side, tilt), around)| {
            let bearing = Centre {
                point: r,
                velocity: v,
                spin: w,
                axis,
            };
            let across = side.cross(&axis);
            let across = if across.norm() > 0.1 {
                across.normalize()
            } else {
                axis.cross(&(side + around + Vector3::x() * 3.0)).normalize()
            };
            let journal = Centre {
                point: r + axis * along + across * (share * fit.clearance()),
                velocity: v2,
                spin: w2,
                axis: Rotation3::new(across * tilt) * axis,
            };
            (Mover { at_zero: bearing }, Mover { at_zero: journal })
        },
    )
}

/// Central difference of fourth order.
pub fn difference(f: impl Fn(f64) -> f64, h: f64) -> f64 {
    (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)
}

pub fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * (1.0 + a.abs().max(b.abs()))
}

/// Relative.
pub fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * a.abs().max(b.abs())
}
