//! The family of laws at one depth and rate.

use crate::fixtures::*;
use linkdyn_contact::*;
use proptest::prelude::*;
use std::sync::Arc;

#[test]
fn force_of_lankarani_and_nikravesh_by_hand() {
    let law = rsup();
    let (depth, rate, v0): (f64, f64, f64) = (4e-6, 0.05, 0.1);
    let elastic = 2.176e10 * 8e-9;
    let f = law.at(depth, rate, v0);
    assert!(near(f.elastic, elastic, 1e-14));
    assert!(near(f.value, elastic * (1.0 + 0.75 * 0.19 * 0.5), 1e-14));
    assert_eq!(law.damping_factor(v0), 0.75 * (1.0 - 0.9) * (1.0 + 0.9));
    assert!(!f.clamped);
}

#[test]
fn no_force_without_depth() {
    for depth in [0.0, -0.0, -1e-9, f64::NEG_INFINITY] {
        assert_eq!(rsup().at(depth, 1e3, 0.1), NormalForce::default());
        assert_eq!(rsup().stored_energy(depth), 0.0);
    }
}

#[test]
fn force_never_pulls() {
    // L-N with e = 0.9: at 7.02 times the impact speed apart.
    let law = rsup();
    let turn = 0.1 / law.damping_factor(0.1);
    assert!((turn / 0.1 - 7.0).abs() < 0.02);
    assert!(law.at(1e-6, -0.999 * turn, 0.1).value > 0.0);
    let clamped = law.at(1e-6, -1.001 * turn, 0.1);
    assert!(clamped.clamped);
    assert_eq!((clamped.value, clamped.d_depth, clamped.d_rate), (0.0, 0.0, 0.0));
    assert!(clamped.elastic > 0.0);
}

#[test]
fn impact_speed_has_a_floor() {
    let law = rsup();
    assert_eq!(law.least_impact_speed(), 1e-6);
    for speed in [0.0, -0.0, -3.0, 1e-300, 1e-6] {
        assert_eq!(law.at(1e-6, 1e-7, speed), law.at(1e-6, 1e-7, 1e-6));
    }
    let higher = law.with_least_impact_speed(0.01).unwrap();
    assert_eq!(higher.at(1e-6, 0.1, 0.0), law.at(1e-6, 0.1, 0.01));
    assert_eq!(higher.at(1e-6, 0.1, 0.2), law.at(1e-6, 0.1, 0.2));
}

#[test]
fn material_damping_forgets_the_impact_speed() {
    let law = NormalLaw::new(1e9, 1.5, Damping::Material { constant: 0.4 }).unwrap();
    let f = law.at(1e-6, 0.5, 0.1);
    assert!(near(f.value, f.elastic * (1.0 + 1.5 * 0.4 * 0.5), 1e-15));
    assert_eq!(f, law.at(1e-6, 0.5, 0.0));
}

#[test]
fn hertz_ignores_the_rate() {
    let law = NormalLaw::new(1e9, 1.5, Damping::Hertz).unwrap();
    let f = law.at(1e-4, -1e9, 0.0);
    assert!(near(f.value, 1e3, 1e-14));
    assert_eq!(f.d_rate, 0.0);
}

#[test]
fn half_the_stiffness_is_half_of_everything() {
    let f = rsup().at(3e-6, 0.02, 0.1);
    let half = NormalLaw::new(1.088e10, 1.5, rsup().damping())
        .unwrap()
        .at(3e-6, 0.02, 0.1);
    let scaled = f.scaled(0.5);
    assert!(near(scaled.value, half.value, 1e-14) && near(scaled.elastic, half.elastic, 1e-14));
    assert!(near(scaled.d_depth, half.d_depth, 1e-14) && near(scaled.d_rate, half.d_rate, 1e-14));
}

#[test]
fn an_own_law_can_be_chosen() {
    #[derive(Debug)]
    struct Wall(f64);
    impl NormalModel for Wall {
        fn at(&self, depth: f64, _: f64, _: f64) -> NormalForce {
            let value = if depth > 0.0 { self.0 } else { 0.0 };
            NormalForce {
                value,
                elastic: value,
                ..NormalForce::default()
            }
        }
        fn stored_energy(&self, depth: f64) -> f64 {
            self.0 * depth.max(0.0)
        }
        fn delivered_restitution(&self, _: f64, _: f64) -> f64 {
            1.0
        }
        fn greatest_depth(&self, mass: f64, speed: f64) -> f64 {
            0.5 * mass * speed * speed / self.0
        }
    }
    let own: Arc<dyn NormalModel> = Arc::new(Wall(7.0));
    let law = ContactLaw::from(own);
    law.validate().unwrap();
    assert_eq!(law.at(1.0, 0.0, 0.0).value, 7.0);
    assert_eq!(law.energy_loss(1.0, 2.0), 0.0);
    assert!((impact(&law, 2.0, 3.0, 500).greatest_depth - 9.0 / 7.0).abs() < 1e-9);
}

#[test]
fn choice_answers_as_the_law_behind_it() {
    let (family, linear) = (
        rsup(),
        KelvinVoigt {
            stiffness: 1e6,
            damping: 20.0,
        },
    );
    for (choice, law) in [
        (ContactLaw::from(family), &family as &dyn NormalModel),
        (ContactLaw::from(linear), &linear),
    ] {
        assert_eq!(choice.at(1e-6, 0.1, 0.2), law.at(1e-6, 0.1, 0.2));
        assert_eq!(choice.stored_energy(1e-6), law.stored_energy(1e-6));
        assert_eq!(
            choice.delivered_restitution(0.1, 0.2),
            law.delivered_restitution(0.1, 0.2)
        );
        assert_eq!(choice.greatest_depth(0.1, 0.2), law.greatest_depth(0.1, 0.2));
        assert_eq!(choice.energy_loss(0.1, 0.2), law.energy_loss(0.1, 0.2));
        choice.validate().unwrap();
    }
}

proptest! {
    #[test]
    fn derivatives_are_those_of_the_force(law in law(), depth in 1e-6..1e-3f64, share in -3.0..3.0f64, speed in 0.01..3.0f64) {
        let rate = share * speed;
        let f = law.at(depth, rate, speed);
        let kink = 1.0 + law.damping_factor(speed) * share;
        prop_assume!(kink.abs() > 1e-3);
        let by_depth = difference(|h| law.at(depth + h, rate, speed).value, 1e-3 * depth);
        let by_rate = difference(|h| law.at(depth, rate + h, speed).value, 1e-5 * speed);
        prop_assert!(near(f.d_depth, by_depth, 1e-8), "{f:?} {by_depth}");
        prop_assert!((f.d_rate - by_rate).abs() <= 1e-8 * (f.d_rate.abs() + f.elastic / speed), "{f:?} {by_rate}");
        prop_assert_eq!(f.clamped, kink < 0.0);
    }

    #[test]
    fn stored_energy_is_the_work_of_the_elastic_force(law in law(), depth in 1e-6..1e-3f64) {
        let force = difference(|h| law.stored_energy(depth + h), 1e-3 * depth);
        prop_assert!(near(force, law.at(depth, 0.0, 1.0).elastic, 1e-9));
        prop_assert_eq!(law.at(depth, 0.0, 1.0).elastic, law.at(depth, 0.0, 1.0).value);
    }

    #[test]
    fn damping_takes_power_in_both_directions(law in law(), depth in 1e-6..1e-3f64, rate in -5.0..5.0f64, speed in 0.0..3.0f64) {
        let f = law.at(depth, rate, speed);
        prop_assert!((f.value - f.elastic) * rate >= 0.0, "{f:?}");
    }

    #[test]
    fn force_is_continuous_where_the_contact_begins(law in law(), rate in -1.0..1.0f64) {
        let force = law.at(1e-12, rate, 1.0).value;
        prop_assert!(force <= law.stiffness() * 1e-12 * (1.0 + law.damping_factor(1.0)), "{force}");
    }
}
