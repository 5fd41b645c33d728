//! Finite answers for every finite speed, and NaN for NaN.

use crate::fixtures::*;
use linkdyn_friction::*;
use proptest::prelude::*;

const SPEEDS: [f64; 12] = [
    0.0,
    -0.0,
    5e-324,
    -5e-324,
    1e-310,
    f64::MIN_POSITIVE,
    1e-160,
    -1e160,
    1e300,
    1e308,
    -f64::MAX,
    f64::MAX,
];

fn laws() -> Vec<Friction> {
    let reference_speed = 0.01;
    let mut laws: Vec<Friction> = vec![
        EXPONENTIAL.into(),
        PiecewiseLinear { reference_speed }.into(),
        HyperbolicTangent { reference_speed }.into(),
        Cubic { reference_speed }.into(),
        Viscous { per_speed: 0.5 }.into(),
    ];
    laws.extend([0.3, 1.0, 2.0, 7.0].map(|exponent| Stribeck { exponent, ..STRIBECK }.into()));
    laws
}

#[test]
fn characteristics_are_finite_at_every_speed() {
    for law in laws() {
        for v in SPEEDS {
            let at = law.at(v);
            assert!(at.value.is_finite() && at.slope.is_finite(), "{law:?} {v:e} {at:?}");
            assert!(at.value * v.signum() >= 0.0, "{law:?} {v:e} {at:?}");
        }
    }
}

#[test]
fn characteristics_do_not_hide_a_nan() {
    for law in laws() {
        assert!(law.at(f64::NAN).value.is_nan(), "{law:?}");
    }
}

#[test]
fn bristles_are_finite_at_every_speed() {
    for guard in [Guard::None, Guard::Cap, Guard::Decay { speed: 0.1 }] {
        for mu in [0.0, 0.1] {
            let lugre = LuGre {
                guard,
                kinetic_coefficient: mu,
                ..LUGRE
            };
            let models: [Bristle; 2] = [
                lugre.into(),
                ElastoPlastic {
                    lugre,
                    elastic_share: 0.5,
                }
                .into(),
            ];
            for model in models {
                for v in SPEEDS.map(|v| v.clamp(-1e300, 1e300)) {
                    for z in [0.0, -0.0, 5e-324, 1e-4] {
                        let at = model.at(v, z);
                        for part in [at.coefficient, at.rate] {
                            assert!(part.value.is_finite(), "{model:?} {v:e} {z:e} {at:?}");
                            assert!(mu == 0.0 || part.d_slip.is_finite(), "{model:?} {v:e} {z:e} {at:?}");
                            assert!(mu == 0.0 || part.d_bristle.is_finite(), "{model:?} {v:e} {z:e} {at:?}");
                        }
                    }
                    let _ = model.is_passive_at(v);
                    assert!(model.steady_coefficient(v).is_finite());
                }
            }
            for v in SPEEDS {
                for h in [0.0, 5e-324, 1.0, 1e308] {
                    if v * h != f64::INFINITY.copysign(v) || v != 0.0 {
                        assert!(lugre.step(v, 1e-4, h).is_finite(), "{v:e} {h:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn bristles_do_not_hide_a_nan() {
    for (v, z) in [(f64::NAN, 0.0), (0.1, f64::NAN)] {
        assert!(LUGRE.at(v, z).coefficient.value.is_nan());
        assert!(LUGRE.at(v, z).rate.value.is_nan());
        assert!(LUGRE.step(v, z, 1e-3).is_nan());
        assert!(
            ElastoPlastic {
                lugre: LUGRE,
                elastic_share: 0.5
            }
            .at(v, z)
            .coefficient
            .value
            .is_nan()
        );
    }
    assert!(!LUGRE.is_passive_at(f64::NAN));
}

#[test]
fn bearings_neither_overflow_nor_lose_tiny_loads() {
    for size in [5e-324, 1e-310, 1e-200, 1e-160, 1.0, 1e160, 1e300] {
        let c = JOURNAL.capacity([3.0 * size, -4.0 * size, 0.0], [0.0; 3]);
        let expected = 0.001 * 5.0 * size;
        assert!(
            (c.value - expected).abs() <= 1e-14 * expected + 1e-323,
            "{size:e} {c:?}"
        );
        if size > 1e-300 {
            assert!(
                (c.d_force[0] - 0.6e-3).abs() < 1e-15 && (c.d_force[1] + 0.8e-3).abs() < 1e-15,
                "{size:e} {c:?}"
            );
        }
    }
}

#[test]
fn bearings_do_not_hide_a_nan() {
    for i in 0..3 {
        let mut f = [1.0; 3];
        f[i] = f64::NAN;
        assert!(JOURNAL.capacity(f, [1.0; 3]).value.is_nan());
        assert!(GUIDE.capacity([1.0; 3], f).value.is_nan());
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn characteristics_are_finite_for_any_bits(bits in any::<u64>()) {
        let v = f64::from_bits(bits);
        prop_assume!(v.is_finite());
        for law in laws() {
            let at = law.at(v);
            prop_assert!(at.value.is_finite() && at.slope.is_finite(), "{law:?} {v:e} {at:?}");
        }
    }

    #[test]
    fn gradient_is_bounded_for_any_bits(bits in prop::array::uniform4(any::<u64>())) {
        let [a, b, c, d] = bits.map(f64::from_bits);
        prop_assume!([a, b, c, d].iter().all(|x| x.abs() < 1e290));
        let at = JOURNAL.capacity([a, b, 0.0], [c, d, 0.0]);
        prop_assert!(at.value.is_finite());
        prop_assert!(at.d_force[0].abs() <= 1.0001e-3 && at.d_force[1].abs() <= 1.0001e-3);
    }
}
