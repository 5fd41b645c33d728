//! The speed up to which a bristle is passive, and the deflection it starts with.

use crate::fixtures::*;
use linkdyn_friction::*;
use proptest::prelude::*;

#[test]
fn bound_of_the_rsup_linkage() {
    let v = LUGRE.largest_passive_slip();
    assert!((v - 0.0205).abs() < 5e-5, "{v}");
    // σ₁ v = 4 g(v).
    assert!((LUGRE.bristle_damping * v - 4.0 * LUGRE.steady_curve(v).0).abs() < 1e-14);
    let behind = Bristle::from(LUGRE);
    assert_eq!(behind.largest_passive_slip(), v);
}

#[test]
fn capped_and_undamped_bristles_are_passive_at_any_speed() {
    let capped = LuGre {
        guard: Guard::Cap,
        ..LUGRE
    };
    assert_eq!(capped.largest_passive_slip(), f64::INFINITY);
    assert_eq!(LuGre::dahl(0.3, 1e3).largest_passive_slip(), f64::INFINITY);
    let elasto_plastic = ElastoPlastic {
        lugre: LUGRE,
        elastic_share: 0.5,
    };
    assert_eq!(elasto_plastic.largest_passive_slip(), LUGRE.largest_passive_slip());
}

#[test]
fn bristles_without_friction_are_never_passive_when_damped() {
    let none = LuGre {
        static_coefficient: 0.0,
        kinetic_coefficient: 0.0,
        ..LUGRE
    };
    assert_eq!(none.largest_passive_slip(), 0.0);
}

#[test]
fn steady_start_begins_on_the_steady_curve() {
    for slip in [0.3, -0.02, 0.0] {
        let z = BristleStart::Steady.deflection(&LUGRE, slip);
        let at = LUGRE.at(slip, z);
        assert!((at.coefficient.value - LUGRE.steady_coefficient(slip)).abs() < 1e-14);
        assert!(at.rate.value.abs() < 1e-16);
        assert_eq!(BristleStart::Relaxed.deflection(&LUGRE, slip), 0.0);
    }
    assert_eq!(BristleStart::default(), BristleStart::Relaxed);
    // Without stiffness nothing settles.
    let slack = LuGre {
        bristle_stiffness: 0.0,
        ..LUGRE
    };
    assert_eq!(BristleStart::Steady.planar_deflection(&slack, [0.3, 0.0]), [0.0, 0.0]);
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn passive_up_to_the_bound_and_not_beyond(model in lugre(), share in 0.0..1.0f64) {
        let v = model.largest_passive_slip();
        if v.is_finite() {
            prop_assert!(model.is_passive_at(share * v) && model.is_passive_at(v));
            prop_assert!(!model.is_passive_at(v * (1.0 + 1e-12)));
        } else {
            prop_assert!(model.is_passive_at(10.0 * share));
        }
    }
}
