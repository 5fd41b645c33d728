//! The exact relations of a free impact (benchmark 11-contact-restitution), against real impacts integrated here.

use crate::fixtures::*;
use linkdyn_contact::*;
use proptest::prelude::*;

#[test]
fn ball_of_benchmark_11_contact_restitution() {
    let law = NormalLaw::new(1.4e8, 1.5, RestitutionLaw::LankaraniNikravesh.with(0.5)).unwrap();
    let (m, v) = (1.0, 4.429446918);
    assert!((law.delivered_restitution(v) - 0.725_241_114_0).abs() < 1e-10);
    assert!((law.greatest_depth(m, v) - 1.753_105_695_04e-3).abs() < 1e-14);
    let seen = impact(&law, m, v, 4000);
    assert!((seen.restitution - 0.725_241_114_0).abs() < 1e-8, "{seen:?}");
    assert!((seen.greatest_depth - 1.753_105_695_04e-3).abs() < 1e-11, "{seen:?}");
}

#[test]
fn undamped_impact_gives_all_back() {
    let law = NormalLaw::new(1e8, 1.5, Damping::Hertz).unwrap();
    assert_eq!(law.delivered_restitution(3.0), 1.0);
    assert_eq!(law.energy_loss(2.0, 3.0), 0.0);
    // All energy is in the contact at the greatest depth: ((n + 1) m v²/(2K))^(1/(n+1)).
    let depth = law.greatest_depth(2.0, 3.0);
    assert!(near(depth, (2.5f64 * 2.0 * 9.0 / 2e8).powf(0.4), 1e-14));
    assert!(near(law.stored_energy(depth), 9.0, 1e-14));
}

#[test]
fn every_law_bounces_a_ball_to_its_own_heights() {
    // Benchmark 11: apex n lies at e'^(2n) of the first, if gravity is negligible during contact.
    let (m, g, k) = (0.7, 9.81, 1e9);
    for family in RestitutionLaw::ALL {
        let law = NormalLaw::new(k, 1.5, family.with(0.6)).unwrap();
        let mut height = 0.8;
        for bounce in 1..4 {
            let v = f64::sqrt(2.0 * g * height);
            height = (impact(&law, m, v, 1000).restitution * v).powi(2) / (2.0 * g);
            let expected = 0.8 * law.delivered_restitution(v).powi(2 * bounce);
            assert!(near(height, expected, 1e-6), "{family:?} {bounce} {height} {expected}");
        }
    }
}

#[test]
fn slow_impacts_below_the_floor_follow_the_same_relations() {
    let law = rsup().with_least_impact_speed(0.1).unwrap();
    assert_eq!(law.damping_factor(0.2), rsup().damping_factor(0.2));
    assert!(near(
        law.damping_factor(0.025),
        0.25 * rsup().damping_factor(1.0),
        1e-15
    ));
    let seen = impact(&law, 0.3, 0.025, 2000);
    assert!((seen.restitution - law.delivered_restitution(0.025)).abs() < 1e-7);
    assert!(law.delivered_restitution(1e-9) > 0.999_999);
}

#[test]
fn material_damping_loses_more_at_higher_speed() {
    let alpha = 0.3;
    let law = NormalLaw::new(1e9, 1.5, Damping::Material { constant: alpha }).unwrap();
    // e = 1 - α v for low speeds.
    assert!((law.delivered_restitution(1e-4) - (1.0 - alpha * 1e-4)).abs() < 1e-9);
    assert!(law.delivered_restitution(2.0) < law.delivered_restitution(1.0));
    let seen = impact(&law, 0.3, 1.5, 2000);
    assert!((seen.restitution - law.delivered_restitution(1.5)).abs() < 1e-7);
}

proptest! {
    #[test]
    fn restitution_depth_and_loss_of_real_impacts(law in law(), mass in 0.01..10.0f64, speed in 0.01..5.0f64) {
        let seen = impact(&law, mass, speed, 1500);
        let xi = law.damping_factor(speed);
        let e = law.delivered_restitution(speed);
        prop_assert!((seen.restitution - e).abs() < 2e-7, "{seen:?} {e}");
        // The relation itself, with the restitution seen, as 1 - ξe = (1 + ξ) exp(-ξ(1 + e)): its logarithm has no digits where ξe is near 1.
        let (left, right) = (1.0 - xi * seen.restitution, (1.0 + xi) * (-xi * (1.0 + seen.restitution)).exp());
        prop_assert!((left - right).abs() < 4e-7 * xi + 1e-12, "{xi} {left} {right}");
        prop_assert!(near(seen.greatest_depth, law.greatest_depth(mass, speed), 1e-6), "{seen:?}");
        let energy = 0.5 * mass * speed * speed;
        prop_assert!((seen.lost - law.energy_loss(mass, speed)).abs() < 1e-6 * energy, "{seen:?}");
        prop_assert!(!seen.clamped);
    }

    #[test]
    fn restitution_and_damping_factor_are_inverse(e in 1e-3..0.9999f64) {
        let xi = impact::damping_factor(e);
        prop_assert!((impact::restitution(xi) - e).abs() < 1e-14);
        prop_assert!(xi > 0.0 && xi < 1.0 / e + 1e-9);
    }

    #[test]
    fn relation_holds_to_rounding(xi in 1e-6..20.0f64) {
        let e = impact::restitution(xi);
        prop_assert!(e > 0.0 && e < 1.0);
        // Where 1 - ξ e still has digits.
        if xi < 8.0 {
            let right = xi.ln_1p() - (-xi * e).ln_1p();
            prop_assert!((xi * (1.0 + e) - right).abs() < 1e-15 / (1.0 - xi * e) + 1e-14, "{xi} {e}");
        }
    }

    #[test]
    fn small_damping_loses_two_thirds_of_it(xi in 1e-12..1e-5f64) {
        // ξ (1 + e) = ln((1 + ξ)/(1 - ξ e)) to second order: 1 - e = 2ξ/3.
        prop_assert!(((1.0 - impact::restitution(xi)) / xi - 2.0 / 3.0).abs() < 1e-15 / xi + xi);
    }
}

#[test]
fn limits_of_the_relations() {
    assert_eq!(impact::restitution(0.0), 1.0);
    assert_eq!(impact::restitution(-1.0), 1.0);
    assert_eq!(impact::restitution(1e-300), 1.0);
    assert!((impact::restitution(1e-8) - impact::restitution(1e-8 - 1e-20)).abs() < 1e-15);
    assert!(near(impact::restitution(1e6), 1e-6, 1e-12));
    assert!(impact::restitution(f64::MAX) > 0.0);
    assert!(impact::restitution(f64::NAN).is_nan());
    assert_eq!(impact::damping_factor(1.0), 0.0);
    assert_eq!(impact::damping_factor(0.0), f64::INFINITY);
    assert!(near(impact::damping_factor(1e-3), 1e3, 1e-12));
    assert_eq!(impact::depth_factor(0.0), 0.5);
    // Both branches of the series meet.
    assert!(near(
        impact::depth_factor(0.1),
        impact::depth_factor(0.1 - 1e-15),
        1e-13
    ));
    assert!(near(
        impact::depth_factor(-0.1),
        impact::depth_factor(-0.1 + 1e-15),
        1e-13
    ));
}
