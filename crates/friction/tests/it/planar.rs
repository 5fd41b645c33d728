//! Bristles in the plane of contact.

use crate::fixtures::*;
use linkdyn_friction::*;
use proptest::prelude::*;

/// A model of the caller's that knows one direction only.
#[derive(Debug)]
struct Plain(LuGre);

impl BristleModel for Plain {
    fn at(&self, slip: f64, bristle: f64) -> BristlePoint {
        self.0.at(slip, bristle)
    }
    fn steady_bristle(&self, slip: f64) -> f64 {
        self.0.steady_bristle(slip)
    }
    fn bristle_limit(&self) -> f64 {
        self.0.bristle_limit()
    }
    fn is_passive_at(&self, slip: f64) -> bool {
        self.0.is_passive_at(slip)
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn turned(v: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]]
}

fn at_angle(length: f64, angle: f64) -> [f64; 2] {
    turned([length, 0.0], angle)
}

/// LuGre and elasto-plastic.
fn models(lugre: LuGre, elastic_share: f64) -> [Bristle; 2] {
    [lugre.into(), ElastoPlastic { lugre, elastic_share }.into()]
}

#[test]
fn slip_across_the_deflection_turns_the_bristle() {
    let z = [1e-4, 0.0];
    let at = LUGRE.at_planar([0.0, 0.1], z);
    // Across, the bristle starts with the slip; along the old direction it relaxes.
    assert!((at.rate[1] - 0.1).abs() < 1e-16);
    assert!((at.rate[0] + 600.0 * 0.1 * 1e-4 / 0.1).abs() < 1e-12);
}

#[test]
fn bristle_at_rest_is_a_spring_in_any_direction() {
    for model in models(LUGRE, 0.5) {
        let at = model.at_planar([0.0, -0.0], [1e-4, -2e-4]);
        assert_eq!(at.rate, [0.0, 0.0]);
        assert!((at.coefficient[0] - 0.06).abs() < 1e-16 && (at.coefficient[1] + 0.12).abs() < 1e-16);
    }
}

#[test]
fn without_coefficients_it_is_frictionless_and_not_nan() {
    let none = LuGre {
        static_coefficient: 0.0,
        kinetic_coefficient: 0.0,
        ..LUGRE
    };
    for model in models(none, 0.5) {
        for slip in [[0.0, 0.0], [0.3, 0.0], [0.0, -0.3]] {
            let at = model.at_planar(slip, [0.0, 0.0]);
            assert_eq!((at.coefficient, at.rate), ([0.0; 2], [0.0; 2]));
        }
    }
}

#[test]
fn planar_bristles_do_not_hide_a_nan() {
    for model in models(LUGRE, 0.5) {
        assert!(model.at_planar([f64::NAN, 0.1], [0.0; 2]).coefficient[0].is_nan());
        assert!(model.at_planar([0.1, 0.0], [f64::NAN, 0.0]).coefficient[0].is_nan());
    }
}

#[test]
fn bristle_follows_a_circling_slip() {
    // The direction of the slip turns slowly; friction stays opposed to it and as large as on a line.
    let (v, omega, h) = (0.3, 2.0, 1e-4);
    let mut z = [0.0; 2];
    for i in 0..20_000 {
        z = LUGRE.step_planar(at_angle(v, omega * i as f64 * h), z, h);
    }
    let slip = at_angle(v, omega * 2.0);
    let along = dot(z, slip) / v * LUGRE.bristle_stiffness;
    assert!((along - 0.1).abs() < 1e-5, "{along}");
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn on_a_line_it_is_the_model_of_one_direction(lugre in lugre(), kappa in 0.0..0.99f64, v in -1.0..1.0f64, share in -1.2..1.2f64, h in 0.0..0.1f64) {
        let z = share * lugre.bristle_limit();
        for model in models(lugre, kappa) {
            let (line, first, second) = (model.at(v, z), model.at_planar([v, 0.0], [z, 0.0]), model.at_planar([0.0, v], [0.0, z]));
            prop_assert_eq!(first.coefficient, [line.coefficient.value, 0.0]);
            prop_assert_eq!(first.rate, [line.rate.value, 0.0]);
            prop_assert_eq!(second.coefficient, [0.0, line.coefficient.value]);
            prop_assert_eq!(second.rate, [0.0, line.rate.value]);
        }
        prop_assert_eq!(lugre.step_planar([v, 0.0], [z, 0.0], h), [lugre.step(v, z, h), 0.0]);
    }

    #[test]
    fn no_direction_is_better_than_another(lugre in lugre(), kappa in 0.0..0.99f64, v in 0.0..1.0f64, share in 0.0..1.2f64, lean in -3.0..3.0f64, angle in -3.0..3.0f64) {
        let (slip, z) = ([v, 0.0], at_angle(share * lugre.bristle_limit(), lean));
        for model in models(lugre, kappa) {
            let here = model.at_planar(slip, z);
            let there = model.at_planar(turned(slip, angle), turned(z, angle));
            for (a, b) in [(here.rate, there.rate), (here.coefficient, there.coefficient)] {
                let a = turned(a, angle);
                prop_assert!(close(a[0], b[0], 1e-11) && close(a[1], b[1], 1e-11), "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn rate_at_the_limit_points_inwards(lugre in lugre(), kappa in 0.0..0.99f64, v in 0.0..2.0f64, lean in -3.0..3.0f64) {
        let z = at_angle(lugre.bristle_limit(), lean);
        for model in models(lugre, kappa) {
            let rate = model.at_planar([v, 0.0], z).rate;
            prop_assert!(dot(rate, z) <= 1e-14 * lugre.bristle_limit(), "{rate:?}");
        }
    }

    #[test]
    fn passive_speeds_never_give_power_beyond_the_store(lugre in lugre(), kappa in 0.0..0.99f64, v in 0.0..0.5f64, share in 0.0..5.0f64, lean in -3.2..3.2f64) {
        prop_assume!(lugre.is_passive_at(v));
        let (slip, z) = ([v, 0.0], at_angle(share * lugre.bristle_limit(), lean));
        for model in models(lugre, kappa) {
            let at = model.at_planar(slip, z);
            let stored = lugre.bristle_stiffness * dot(z, at.rate);
            prop_assert!(dot(at.coefficient, slip) - stored >= -1e-12, "{at:?}");
        }
    }

    #[test]
    fn cap_keeps_the_coefficient_below_the_static_one(lugre in lugre(), v in 0.0..5.0f64, share in 0.0..1.0f64, lean in -3.2..3.2f64) {
        let lugre = LuGre { guard: Guard::Cap, viscous_coefficient: 0.0, ..lugre };
        let mu = lugre.at_planar([v, 0.0], at_angle(share * lugre.bristle_limit(), lean)).coefficient;
        prop_assert!(mu[0].hypot(mu[1]) <= lugre.static_coefficient * (1.0 + 1e-12), "{mu:?}");
    }

    #[test]
    fn exact_step_agrees_with_its_rate(lugre in lugre(), v in prop::array::uniform2(-0.2..0.2f64), share in 0.0..1.0f64, lean in -3.2..3.2f64) {
        let z = at_angle(share * lugre.bristle_limit(), lean);
        let speed = v[0].hypot(v[1]);
        let h = 1e-6 * lugre.steady_curve(speed).0 / (lugre.bristle_stiffness * speed.max(1e-6));
        let rate = lugre.at_planar(v, z).rate;
        let ends = [lugre.step_planar(v, z, h), lugre.step_planar(v, z, 2.0 * h)];
        for i in 0..2 {
            let seen = (4.0 * (ends[0][i] - z[i]) - (ends[1][i] - z[i])) / (2.0 * h);
            prop_assert!((rate[i] - seen).abs() <= 1e-8 * (speed + 1e-6), "{rate:?} {seen}");
        }
        let steady = BristleStart::Steady.planar_deflection(&lugre, v);
        let last = lugre.step_planar(v, z, 1e9);
        prop_assert!((0..2).all(|i| (last[i] - steady[i]).abs() <= 1e-14 * lugre.bristle_limit()));
        prop_assert_eq!(BristleStart::Relaxed.planar_deflection(&lugre, v), [0.0, 0.0]);
    }

    #[test]
    fn own_models_of_one_direction_are_superposed(lugre in lugre(), v in prop::array::uniform2(-0.5..0.5f64), share in 0.0..1.0f64, lean in -3.2..3.2f64) {
        let z = at_angle(share * lugre.bristle_limit(), lean);
        let (own, exact) = (Plain(lugre).at_planar(v, z), lugre.at_planar(v, z));
        for (a, b) in [(own.rate, exact.rate), (own.coefficient, exact.coefficient)] {
            prop_assert!(close(a[0], b[0], 1e-11) && close(a[1], b[1], 1e-11), "{a:?} {b:?}");
        }
        let still = Plain(lugre).at_planar([0.0; 2], z);
        prop_assert_eq!(still.rate, [0.0; 2]);
    }
}
