use crate::fixtures::*;
use linkdyn_friction::*;
use proptest::prelude::*;

proptest! {
    #![proptest_config(config())]

    #[test]
    fn odd_with_even_slope((law, _) in bounded(), v in -30.0..30.0f64) {
        let (plus, minus) = (law.at(v), law.at(-v));
        prop_assert_eq!(plus.value, -minus.value);
        prop_assert_eq!(plus.slope, minus.slope);
    }

    #[test]
    fn friction_never_helps_the_slip((law, _) in bounded(), v in -30.0..30.0f64) {
        prop_assert!(law.at(v).value * v >= 0.0);
    }

    #[test]
    fn stays_within_its_bound((law, bound) in bounded(), v in -1e6..1e6f64) {
        prop_assert!(law.at(v).value.abs() <= bound * (1.0 + 1e-15));
    }

    #[test]
    fn tends_to_one((law, _) in bounded()) {
        prop_assert!((law.at(1e30).value - 1.0).abs() < 1e-15);
        prop_assert_eq!(law.at(1e30).slope, 0.0);
    }

    #[test]
    fn without_static_peak_it_never_falls((law, bound) in bounded(), v in 0.0..30.0f64, more in 0.0..1.0f64) {
        prop_assume!(bound == 1.0);
        prop_assert!(law.at(v + more).value >= law.at(v).value);
        prop_assert!(law.at(v).slope >= 0.0);
    }

    #[test]
    fn value_is_the_integral_of_the_slope((law, _) in bounded(), v in -5.0..5.0f64) {
        // The jump in the slope of the piecewise linear law and the curvature at zero of a
        // fractional exponent are left out.
        if let Friction::PiecewiseLinear(l) = &law {
            prop_assume!((v.abs() - l.reference_speed).abs() > 1e-4);
        }
        prop_assume!(v.abs() > 1e-3);
        let numeric = difference(|v| law.at(v).value, v, 1e-2);
        prop_assert!(close(law.at(v).slope, numeric, 1e-5), "{} {numeric}", law.at(v).slope);
    }

    #[test]
    fn value_is_continuous((law, _) in bounded(), v in -20.0..20.0f64) {
        let step = 1e-9;
        prop_assert!((law.at(v + step).value - law.at(v).value).abs() < 1e-4);
    }

    #[test]
    fn slope_is_continuous_except_for_the_piecewise_linear((law, _) in bounded(), v in -20.0..20.0f64) {
        prop_assume!(!matches!(law, Friction::PiecewiseLinear(_)));
        if let Friction::Stribeck(l) = &law {
            prop_assume!(l.exponent >= 1.0);
        }
        let step = 1e-9;
        let slope = law.at(0.0).slope;
        prop_assert!((law.at(v + step).slope - law.at(v).slope).abs() < 1e-4 * (1.0 + slope));
    }

    #[test]
    fn sum_adds_value_and_slope((law, _) in bounded(), c in 0.0..10.0f64, v in -5.0..5.0f64) {
        let sum = Sum { first: law.clone(), second: Viscous { per_speed: c } };
        prop_assert_eq!(sum.at(v).value, law.at(v).value + c * v);
        prop_assert_eq!(sum.at(v).slope, law.at(v).slope + c);
    }
}

#[test]
fn zero_slip_gives_zero_and_the_stated_slope() {
    let reference_speed = 0.02;
    let laws: [(Friction, f64); 6] = [
        (
            Exponential {
                reference_speed,
                steepness: 3.0,
            }
            .into(),
            150.0,
        ),
        (PiecewiseLinear { reference_speed }.into(), 50.0),
        (HyperbolicTangent { reference_speed }.into(), 50.0),
        (Cubic { reference_speed }.into(), 75.0),
        (
            Stribeck {
                reference_speed,
                ..STRIBECK
            }
            .into(),
            75.0,
        ),
        (Viscous { per_speed: 4.0 }.into(), 4.0),
    ];
    for (law, slope) in laws {
        for zero in [0.0, -0.0] {
            let at = law.at(zero);
            assert_eq!(at.value, 0.0, "{law:?}");
            assert!((at.slope - slope).abs() < 1e-12 * slope, "{law:?} {at:?}");
        }
    }
}

#[test]
fn exponential_reaches_95_percent_at_the_reference_speed_for_k_3() {
    let chi = EXPONENTIAL.at(0.01).value;
    assert!((chi - 0.950212931632136).abs() < 1e-15);
}

#[test]
fn exponential_does_not_grow_for_negative_speed_as_printed() {
    assert_eq!(EXPONENTIAL.at(-0.01).value, -EXPONENTIAL.at(0.01).value);
    assert_eq!(EXPONENTIAL.at(-9.0).value, -1.0);
}

#[test]
fn exponential_keeps_digits_of_a_creeping_joint() {
    // 1 - exp(-x) written out loses all of them here.
    let at = EXPONENTIAL.at(1e-18);
    assert!((at.value / 3e-16 - 1.0).abs() < 1e-14);
}

#[test]
fn exponential_slope_at_zero_is_that_of_the_linkage() {
    // µ₀ k/v_k = 60 s/rad with µ₀ = 0.2.
    assert!((0.2 * EXPONENTIAL.at(0.0).slope - 60.0).abs() < 1e-12);
}

#[test]
fn piecewise_linear_jumps_in_slope_at_the_reference_speed() {
    let law = PiecewiseLinear { reference_speed: 0.5 };
    assert_eq!(law.at(0.25), Value { value: 0.5, slope: 2.0 });
    assert_eq!(law.at(0.5), Value { value: 1.0, slope: 0.0 });
    assert_eq!(
        law.at(-0.6),
        Value {
            value: -1.0,
            slope: 0.0
        }
    );
}

#[test]
fn cubic_is_the_cubic_step_between_both_branches() {
    let law = Cubic { reference_speed: 2.0 };
    for v in [-1.9f64, -1.0, -0.3, 0.0, 0.7, 1.5] {
        let t = (v + 2.0) / 4.0;
        let step = -1.0 + 2.0 * t * t * (3.0 - 2.0 * t);
        assert!((law.at(v).value - step).abs() < 1e-15);
    }
}

#[test]
fn tanh_creep_speed_under_a_sticking_load() {
    // Benchmark: v = v_r artanh(T/(µ N)).
    let law = HyperbolicTangent { reference_speed: 1e-3 };
    let v = 1e-3 * 0.7f64.atanh();
    assert!((law.at(v).value - 0.7).abs() < 1e-15);
}

#[test]
fn stribeck_falls_from_the_static_to_the_kinetic_level() {
    let law = Stribeck {
        reference_speed: 1e-6,
        ..STRIBECK
    };
    assert!((law.at(1e-4).value - 1.5).abs() < 1e-5);
    assert!((law.at(0.1).value - (1.0 + 0.5 * (-1.0f64).exp())).abs() < 1e-12);
    assert!((law.at(1.0).value - 1.0).abs() < 1e-12);
    assert!(law.at(0.05).slope < 0.0);
}

#[test]
fn stribeck_peak_is_where_the_documentation_puts_it() {
    let peak = (0..10_000)
        .map(|i| STRIBECK.at(i as f64 * 1e-5).value)
        .fold(0.0, f64::max);
    assert!(((peak - 1.0) / 0.5 - 0.9).abs() < 0.005, "{peak}");
}

#[test]
fn stribeck_with_ratio_one_is_the_hyperbolic_tangent() {
    let stribeck = Stribeck {
        static_ratio: 1.0,
        ..STRIBECK
    };
    let tanh = HyperbolicTangent { reference_speed: 0.01 };
    for v in [-1.0, -0.01, 0.0, 0.003, 0.5] {
        assert_eq!(stribeck.at(v), tanh.at(v));
    }
}

#[test]
fn stribeck_exponent_two_equals_the_general_power() {
    let near = Stribeck {
        exponent: 2.0 + 1e-13,
        ..STRIBECK
    };
    for v in [-0.2, 0.01, 0.1, 0.3] {
        assert!((near.at(v).value - STRIBECK.at(v).value).abs() < 1e-12);
    }
}

#[test]
fn stribeck_slope_stays_finite_for_exponents_below_one() {
    let law = Stribeck {
        exponent: 0.5,
        ..STRIBECK
    };
    for v in [0.0, 5e-324, 1e-300, 1e-12] {
        assert!((law.at(v).slope - 150.0).abs() < 1e-2, "{v:e} {:?}", law.at(v));
    }
}
