use crate::fixtures::*;
use linkdyn_contact::*;
use proptest::prelude::*;

/// With K = m = 1.
fn of_damping_ratio(zeta: f64) -> KelvinVoigt {
    KelvinVoigt {
        stiffness: 1.0,
        damping: 2.0 * zeta,
    }
}

#[test]
fn published_restitution() {
    let e = of_damping_ratio(0.3).delivered_restitution(1.0, 1.0);
    assert!((e - 0.451).abs() < 5e-4, "{e}");
}

#[test]
fn restitution_has_no_jump_at_critical_damping() {
    let e = of_damping_ratio(1.0).delivered_restitution(1.0, 1.0);
    assert!((e - (-2.0f64).exp()).abs() < 1e-15);
    for zeta in [1.0 - 1e-9, 1.0 + 1e-9] {
        assert!((of_damping_ratio(zeta).delivered_restitution(1.0, 1.0) - e).abs() < 1e-8);
    }
}

#[test]
fn strong_damping_leaves_nothing() {
    // (2ζ)⁻² for large ζ.
    let e = of_damping_ratio(1e4).delivered_restitution(1.0, 1.0);
    assert!(near(e, 0.25e-8, 1e-6));
    assert_eq!(of_damping_ratio(f64::MAX / 4.0).delivered_restitution(1.0, 1.0), 0.0);
    assert_eq!(of_damping_ratio(0.0).delivered_restitution(1.0, 1.0), 1.0);
}

#[test]
fn force_jumps_at_first_touch_and_never_pulls() {
    let law = KelvinVoigt {
        stiffness: 1e6,
        damping: 50.0,
    };
    assert_eq!(law.at(0.0, 2.0, 2.0).value, 0.0);
    assert!((law.at(1e-15, 2.0, 2.0).value - 100.0).abs() < 1e-8);
    assert!(law.at(1e-6, -1.0, 2.0).clamped);
    let f = law.at(1e-3, -1.0, 2.0);
    assert_eq!((f.value, f.elastic, f.d_depth, f.d_rate), (950.0, 1000.0, 1e6, 50.0));
    assert_eq!(law.stored_energy(1e-3), 0.5);
    assert_eq!(law.stored_energy(-1e-3), 0.0);
}

proptest! {
    #[test]
    fn restitution_depth_and_loss_of_real_impacts(k in 1e2..1e9f64, mass in 0.01..10.0f64, zeta in 0.0..3.0f64, speed in 0.01..5.0f64) {
        let law = KelvinVoigt { stiffness: k, damping: 2.0 * zeta * (k * mass).sqrt() };
        let seen = impact(&law, mass, speed, 1500);
        let e = law.delivered_restitution(mass, speed);
        // The end is found to a step, where the force is close to zero.
        prop_assert!((seen.restitution - e).abs() < 1e-5, "{seen:?} {e}");
        prop_assert!(near(seen.greatest_depth, law.greatest_depth(mass, speed), 1e-8), "{seen:?}");
        let energy = 0.5 * mass * speed * speed;
        prop_assert!((seen.lost - law.energy_loss(mass, speed)).abs() < 1e-4 * energy, "{seen:?}");
    }
}
