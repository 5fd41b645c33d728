//! Laws with the data of the benchmarks, and generators.

use linkdyn_friction::*;
use proptest::prelude::*;

/// The default, with room for `prop_assume` at any number of cases.
pub fn config() -> ProptestConfig {
    let default = ProptestConfig::default();
    ProptestConfig {
        max_global_rejects: 100 * default.cases,
        ..default
    }
}

pub const EXPONENTIAL: Exponential = Exponential {
    reference_speed: 0.01,
    steepness: 3.0,
};

pub const STRIBECK: Stribeck = Stribeck {
    static_ratio: 1.5,
    stribeck_speed: 0.1,
    exponent: 2.0,
    reference_speed: 0.01,
};

/// Joint (1,1) of the RSRRR linkage with a loaded thrust face.
pub const JOURNAL: JournalBearing = JournalBearing {
    spacing: 0.03,
    surface_a: Surface {
        diameter: 0.01,
        coefficient: 0.2,
    },
    surface_b: Surface {
        diameter: 0.01,
        coefficient: 0.2,
    },
    face: Surface {
        diameter: 0.015,
        coefficient: 0.2,
    },
};

pub const GUIDE: PadGuide = PadGuide {
    spacing: 0.1,
    arm: 0.02,
    pad_a: 0.1,
    pad_b: 0.15,
    key: 0.2,
};

/// The bristle of the RSUP linkage.
pub const LUGRE: LuGre = LuGre {
    static_coefficient: 0.2,
    kinetic_coefficient: 0.1,
    stribeck_speed: 0.0175,
    bristle_stiffness: 600.0,
    bristle_damping: 24.49489742783178,
    viscous_coefficient: 0.0,
    guard: Guard::None,
};

/// The block of Canudas de Wit et al. 1995, in force form: the normal force is one.
pub const BLOCK: LuGre = LuGre {
    static_coefficient: 1.5,
    kinetic_coefficient: 1.0,
    stribeck_speed: 0.001,
    bristle_stiffness: 1e5,
    bristle_damping: 316.22776601683796,
    viscous_coefficient: 0.4,
    guard: Guard::None,
};

/// Every characteristic that stays within ±bound, with that bound, for any valid parameters.
pub fn bounded() -> impl Strategy<Value = (Friction, f64)> {
    let speed = 1e-3..10.0f64;
    prop_oneof![
        (speed.clone(), 0.5..5.0f64).prop_map(|(v, k)| (
            Exponential {
                reference_speed: v,
                steepness: k
            }
            .into(),
            1.0
        )),
        speed
            .clone()
            .prop_map(|v| (PiecewiseLinear { reference_speed: v }.into(), 1.0)),
        speed
            .clone()
            .prop_map(|v| (HyperbolicTangent { reference_speed: v }.into(), 1.0)),
        speed.clone().prop_map(|v| (Cubic { reference_speed: v }.into(), 1.0)),
        (1.0..3.0f64, speed.clone(), prop_oneof![Just(2.0), 0.4..3.0f64], speed).prop_map(
            |(static_ratio, stribeck_speed, exponent, reference_speed)| {
                let law = Stribeck {
                    static_ratio,
                    stribeck_speed,
                    exponent,
                    reference_speed,
                };
                (law.into(), static_ratio)
            }
        ),
    ]
}

pub fn guard() -> impl Strategy<Value = Guard> {
    prop_oneof![
        Just(Guard::None),
        Just(Guard::Cap),
        (1e-3..1.0f64).prop_map(|speed| Guard::Decay { speed }),
    ]
}

pub fn lugre() -> impl Strategy<Value = LuGre> {
    let coefficients = (0.01..1.0f64, 1.0..3.0f64);
    (
        coefficients,
        1e-3..0.1f64,
        10.0..1e5f64,
        0.0..100.0f64,
        0.0..1.0f64,
        guard(),
    )
        .prop_map(|((mu_k, ratio), stribeck_speed, sigma0, sigma1, sigma2, guard)| LuGre {
            static_coefficient: ratio * mu_k,
            kinetic_coefficient: mu_k,
            stribeck_speed,
            bristle_stiffness: sigma0,
            bristle_damping: sigma1,
            viscous_coefficient: sigma2,
            guard,
        })
}

pub fn journal() -> impl Strategy<Value = JournalBearing> {
    let d = 0.001..0.1f64;
    let mu = 0.0..2.0f64;
    (
        0.001..0.5f64,
        (d.clone(), mu.clone()),
        (d, mu.clone()),
        (1.0..3.0f64, mu),
    )
        .prop_map(|(spacing, (d_a, mu_a), (d_b, mu_b), (ratio, mu_c))| JournalBearing {
            spacing,
            surface_a: Surface {
                diameter: d_a,
                coefficient: mu_a,
            },
            surface_b: Surface {
                diameter: d_b,
                coefficient: mu_b,
            },
            face: Surface {
                diameter: ratio * d_a,
                coefficient: mu_c,
            },
        })
}

pub fn guide() -> impl Strategy<Value = PadGuide> {
    let mu = 0.0..2.0f64;
    (0.001..0.5f64, 0.001..0.5f64, mu.clone(), mu.clone(), mu).prop_map(|(spacing, arm, pad_a, pad_b, key)| PadGuide {
        spacing,
        arm,
        pad_a,
        pad_b,
        key,
    })
}

pub fn bearing() -> impl Strategy<Value = Bearing> {
    prop_oneof![journal().prop_map(Bearing::from), guide().prop_map(Bearing::from)]
}

/// Force \[N\] and torque \[N m\].
pub fn load() -> impl Strategy<Value = ([f64; 3], [f64; 3])> {
    (
        prop::array::uniform3(-100.0..100.0f64),
        prop::array::uniform3(-10.0..10.0f64),
    )
}

/// Central difference with a step that suits the scale of x.
pub fn difference(f: impl Fn(f64) -> f64, x: f64, scale: f64) -> f64 {
    let h = 1e-6 * scale;
    (f(x + h) - f(x - h)) / (2.0 * h)
}

pub fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * (1.0 + a.abs().max(b.abs()))
}
