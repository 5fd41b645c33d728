use crate::fixtures::*;
use linkdyn_friction::*;
use proptest::prelude::*;

const GUARDS: [Guard; 3] = [Guard::None, Guard::Cap, Guard::Decay { speed: 0.1 }];

#[test]
fn steady_state_of_the_published_block() {
    let published = [
        (1e-4, 1.495064916874584),
        (5e-4, 1.3896003915357025),
        (1e-3, 1.1843397205857211),
        (2e-3, 1.009957819444367),
        (5e-3, 1.002000000006944),
    ];
    for (v, force) in published {
        assert!((BLOCK.steady_coefficient(v) - force).abs() < 1e-14);
        assert!((BLOCK.steady_coefficient(-v) + force).abs() < 1e-14);
        let settled = BLOCK.at(v, BLOCK.steady_bristle(v));
        assert!((settled.coefficient.value - force).abs() < 1e-12);
        assert!(settled.rate.value.abs() < 1e-15);
    }
}

#[test]
fn presliding_bristle_is_a_spring() {
    let at = BLOCK.at(0.0, 1e-6);
    assert!((at.coefficient.value - 0.1).abs() < 1e-15);
    assert_eq!(at.coefficient.d_bristle, 1e5);
    assert_eq!(at.rate.value, 0.0);
}

#[test]
fn passivity_bound_of_the_rsup_linkage() {
    assert!(LUGRE.is_passive_at(0.0204));
    assert!(LUGRE.is_passive_at(-0.0204));
    assert!(!LUGRE.is_passive_at(0.0206));
    assert!(!LUGRE.is_passive_at(-0.0206));
    assert!(LUGRE.is_passive_at(0.0));
}

#[test]
fn first_touch_overshoots_with_constant_damping() {
    // sqrt(600) s/m · 0.1 m/s, twelve times µ_s.
    let mu = LUGRE.at(0.1, 0.0).coefficient.value;
    assert!((mu - 2.449489742783178).abs() < 1e-14);
    let capped = LuGre {
        guard: Guard::Cap,
        ..LUGRE
    };
    assert!((capped.at(0.1, 0.0).coefficient.value - 0.1).abs() < 1e-12);
}

#[test]
fn capped_model_above_its_corner_is_the_steady_curve() {
    let capped = LuGre {
        guard: Guard::Cap,
        ..LUGRE
    };
    for z in [-1e-4, 0.0, 3e-4] {
        let at = capped.at(-0.5, z).coefficient;
        assert!((at.value + 0.1).abs() < 1e-14);
        assert!(at.d_bristle.abs() < 1e-12);
    }
}

#[test]
fn decaying_damping_is_a_gauss_curve() {
    let decaying = LuGre {
        guard: Guard::Decay { speed: 0.05 },
        ..LUGRE
    };
    let expected = LUGRE.bristle_damping * (-4.0f64).exp();
    assert!((decaying.damping(0.1).0 - expected).abs() < 1e-14);
    assert_eq!(decaying.damping(0.0).0, LUGRE.bristle_damping);
}

#[test]
fn dahl_has_neither_damping_nor_peak() {
    let dahl = LuGre::dahl(0.3, 1000.0);
    let at = dahl.at(0.2, 1e-4);
    assert!((at.coefficient.value - 0.1).abs() < 1e-15);
    // ż = v (1 - σ₀ z sgn(v)/µ)
    assert!((at.rate.value - 0.2 * (1.0 - 0.1 / 0.3)).abs() < 1e-15);
    assert_eq!(dahl.steady_coefficient(5.0), 0.3);
    assert!(dahl.is_passive_at(1e6));
}

#[test]
fn rate_has_no_jump_where_the_slip_changes_sign() {
    for guard in GUARDS {
        let model = LuGre { guard, ..LUGRE };
        let (before, after) = (model.at(-1e-12, 2e-4), model.at(1e-12, 2e-4));
        assert!((before.rate.value - after.rate.value).abs() < 1e-11);
        assert!((before.coefficient.value - after.coefficient.value).abs() < 1e-9);
    }
}

#[test]
fn without_coefficients_it_is_frictionless_and_not_nan() {
    let none = LuGre {
        static_coefficient: 0.0,
        kinetic_coefficient: 0.0,
        ..LUGRE
    };
    none.validate().unwrap();
    for v in [-1.0, -0.0, 0.0, 0.3] {
        let at = none.at(v, 0.0);
        assert_eq!(at.coefficient.value, 0.0);
        assert_eq!(at.rate.value, 0.0);
        assert_eq!(none.step(v, 0.0, 1e-3), 0.0);
    }
}

#[test]
fn without_stiffness_the_bristle_follows_the_slip() {
    let slack = LuGre {
        bristle_stiffness: 0.0,
        ..LUGRE
    };
    slack.validate().unwrap();
    assert_eq!(slack.at(0.3, 7.0).rate.value, 0.3);
    assert_eq!(slack.step(0.3, 7.0, 2.0), 7.6);
}

#[test]
fn exact_step_starts_like_the_slip_and_ends_at_the_steady_bristle() {
    assert!((LUGRE.step(1e-9, 0.0, 1e-6) / 1e-15 - 1.0).abs() < 1e-9);
    assert_eq!(LUGRE.step(0.1, -3e-4, 1e9), LUGRE.steady_bristle(0.1));
    assert_eq!(LUGRE.step(0.0, 1e-4, 1e9), 1e-4);
}

#[test]
fn stuck_bristle_overcomes_more_than_the_kinetic_coefficient() {
    // Slow slip from rest: the peak comes near µ_s before it falls.
    let (mut z, h, mut peak) = (0.0, 1e-5, 0.0f64);
    for i in 0..200_000 {
        let v = 0.05 * i as f64 * h;
        z = LUGRE.step(v, z, h);
        peak = peak.max(LUGRE.bristle_stiffness * z);
    }
    assert!(peak > 0.15 && peak <= 0.2, "{peak}");
    assert!((LUGRE.bristle_stiffness * z - 0.1).abs() < 1e-3);
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn exact_step_agrees_with_fine_integration(model in lugre(), v in -0.2..0.2f64, share in -1.0..1.0f64) {
        let z0 = share * model.bristle_limit();
        let g = model.steady_curve(v).0;
        let duration = 2.0 * g / (model.bristle_stiffness * v.abs()).max(1e-3 * model.bristle_stiffness);
        let n = 400;
        let h = duration / n as f64;
        let rate = |z: f64| model.at(v, z).rate.value;
        let mut z = z0;
        for _ in 0..n {
            let k1 = rate(z);
            let k2 = rate(z + 0.5 * h * k1);
            let k3 = rate(z + 0.5 * h * k2);
            let k4 = rate(z + h * k3);
            z += h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
        }
        prop_assert!((model.step(v, z0, duration) - z).abs() < 1e-10 * model.bristle_limit());
    }

    #[test]
    fn exact_step_halves_into_two(model in lugre(), v in -1.0..1.0f64, share in -1.0..1.0f64, h in 0.0..1.0f64) {
        let z = share * model.bristle_limit();
        let twice = model.step(v, model.step(v, z, 0.5 * h), 0.5 * h);
        prop_assert!((model.step(v, z, h) - twice).abs() <= 1e-14 * model.bristle_limit());
    }

    #[test]
    fn bristle_never_leaves_its_limit(model in lugre(), slips in prop::collection::vec((-2.0..2.0f64, 0.0..0.1f64), 1..40)) {
        let limit = model.bristle_limit();
        let mut z = 0.0;
        for (v, h) in slips {
            z = model.step(v, z, h);
            prop_assert!(z.abs() <= limit * (1.0 + 1e-14));
        }
    }

    #[test]
    fn rate_at_the_limit_points_inwards(model in lugre(), v in -2.0..2.0f64) {
        let limit = model.bristle_limit();
        prop_assert!(model.at(v, limit).rate.value <= 1e-14);
        prop_assert!(model.at(v, -limit).rate.value >= -1e-14);
    }

    #[test]
    fn odd_in_slip_and_bristle_together(model in lugre(), v in -2.0..2.0f64, share in -1.0..1.0f64) {
        let z = share * model.bristle_limit();
        let (plus, minus) = (model.at(v, z), model.at(-v, -z));
        prop_assert_eq!(plus.coefficient.value, -minus.coefficient.value);
        prop_assert_eq!(plus.rate.value, -minus.rate.value);
    }

    #[test]
    fn partials_are_those_of_the_values(model in lugre(), v in -0.3..0.3f64, share in -1.0..1.0f64) {
        let z = share * model.bristle_limit();
        prop_assume!(v.abs() > 1e-5);
        if model.guard == Guard::Cap {
            // The corner of the cap.
            let corner = model.bristle_damping * v.abs() / model.steady_curve(v).0;
            prop_assume!((corner - 1.0).abs() > 1e-2);
        }
        let at = model.at(v, z);
        let (v_scale, z_scale) = (model.stribeck_speed, model.bristle_limit());
        for (part, partials) in [(0, at.rate), (1, at.coefficient)] {
            let value = |v: f64, z: f64| {
                let at = model.at(v, z);
                [at.rate.value, at.coefficient.value][part]
            };
            let by_slip = difference(|v| value(v, z), v, v_scale);
            let by_bristle = difference(|z| value(v, z), z, z_scale);
            prop_assert!(close(partials.d_slip * v_scale, by_slip * v_scale, 1e-7), "{partials:?} {by_slip}");
            prop_assert!(close(partials.d_bristle * z_scale, by_bristle * z_scale, 1e-7), "{partials:?} {by_bristle}");
        }
    }

    #[test]
    fn passive_speeds_never_give_power_beyond_the_store(model in lugre(), v in -0.5..0.5f64, share in -1.0..1.0f64) {
        prop_assume!(model.is_passive_at(v));
        let z = 5.0 * share * model.bristle_limit();
        let at = model.at(v, z);
        let stored = model.bristle_stiffness * z * at.rate.value;
        prop_assert!(at.coefficient.value * v - stored >= -1e-12);
    }

    #[test]
    fn beyond_the_passivity_bound_some_bristle_drives_the_slip(model in lugre(), v in 0.001..2.0f64) {
        let (sigma1, g) = (model.damping(v).0, model.steady_curve(v).0);
        prop_assume!(sigma1 * v > 4.2 * g);
        // The worst deflection, which may lie beyond the limit.
        let s = 0.5 * sigma1 * v / g;
        let z = s * g / model.bristle_stiffness;
        let at = LuGre { viscous_coefficient: 0.0, ..model }.at(v, z);
        let stored = model.bristle_stiffness * z * at.rate.value;
        prop_assert!(at.coefficient.value * v - stored < 0.0);
        prop_assert!(!model.is_passive_at(v));
    }

    #[test]
    fn bristle_power_has_the_documented_form(model in lugre(), v in -1.0..1.0f64, share in -2.0..2.0f64) {
        let z = share * model.bristle_limit();
        let at = model.at(v, z);
        let g = model.steady_curve(v).0;
        let (s, a) = (model.bristle_stiffness * z * v.signum() / g, model.damping(v).0 * v.abs() / g);
        let power = g * v.abs() * (s * s - a * s + a) + model.viscous_coefficient * v * v;
        let given = at.coefficient.value * v - model.bristle_stiffness * z * at.rate.value;
        prop_assert!(close(power, given, 1e-10));
    }

    #[test]
    fn bristle_within_its_limit_is_passive_without_a_static_peak(model in lugre(), v in -2.0..2.0f64, share in -1.0..1.0f64) {
        let model = LuGre { static_coefficient: model.kinetic_coefficient, ..model };
        let z = share * model.bristle_limit();
        let at = model.at(v, z);
        let given = at.coefficient.value * v - model.bristle_stiffness * z * at.rate.value;
        prop_assert!(given >= -1e-12);
    }

    #[test]
    fn cap_keeps_the_coefficient_below_the_static_one(model in lugre(), v in -5.0..5.0f64, share in -1.0..1.0f64) {
        let model = LuGre { guard: Guard::Cap, viscous_coefficient: 0.0, ..model };
        let mu = model.at(v, share * model.bristle_limit()).coefficient.value;
        prop_assert!(mu.abs() <= model.static_coefficient * (1.0 + 1e-12));
        prop_assert!(model.is_passive_at(v));
    }

    #[test]
    fn steady_bristle_stays_where_it_is(model in lugre(), v in -2.0..2.0f64, h in 0.0..10.0f64) {
        let z = model.steady_bristle(v);
        prop_assert!((model.step(v, z, h) - z).abs() <= 1e-15 * model.bristle_limit());
        prop_assert!(model.at(v, z).rate.value.abs() <= 1e-14);
    }

    #[test]
    fn coefficient_scales_with_the_normal_force_in_force_form(model in lugre(), load in 0.1..100.0f64, v in -1.0..1.0f64, share in -1.0..1.0f64) {
        let z = share * model.bristle_limit();
        let force_form = LuGre {
            static_coefficient: load * model.static_coefficient,
            kinetic_coefficient: load * model.kinetic_coefficient,
            bristle_stiffness: load * model.bristle_stiffness,
            bristle_damping: load * model.bristle_damping,
            viscous_coefficient: load * model.viscous_coefficient,
            ..model
        };
        let (a, b) = (model.at(v, z), force_form.at(v, z));
        prop_assert!(close(load * a.coefficient.value, b.coefficient.value, 1e-12));
        prop_assert!(close(a.rate.value, b.rate.value, 1e-12));
    }
}
