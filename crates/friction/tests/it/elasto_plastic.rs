use crate::fixtures::*;
use linkdyn_friction::*;
use proptest::prelude::*;

const MODEL: ElastoPlastic = ElastoPlastic {
    lugre: LUGRE,
    elastic_share: 0.7,
};

/// Mean deflection of the contact after swinging a small load many times about a bias.
fn drift(model: &dyn BristleModel) -> f64 {
    let (amplitude, omega, h) = (5e-5, 100.0, 1e-5);
    // The contact creeps where, at the same deflection of the bristle, its place has moved on. Place
    // and bristle start together and part by what has flowed.
    let (mut z, mut x) = (1e-4, 1e-4);
    for i in 0..100_000 {
        let v = amplitude * omega * (omega * i as f64 * h).cos();
        let rate = model.at(v, z).rate.value;
        x += v * h;
        z += rate * h;
    }
    x - z
}

#[test]
fn small_swinging_loads_leave_no_drift_as_lugre_does() {
    assert_eq!((drift(&MODEL) * 1e12).round(), 0.0);
    assert!(drift(&LUGRE) > 1e-5);
}

#[test]
fn elastic_bristle_follows_the_slip_exactly() {
    let z = 0.69 * MODEL.steady_bristle(0.01);
    assert_eq!(MODEL.at(0.01, z).rate.value, 0.01);
    assert_eq!(MODEL.at(-0.01, MODEL.steady_bristle(0.01)).rate.value, -0.01);
}

#[test]
fn saturated_bristle_flows_as_lugre() {
    let z = LUGRE.bristle_limit();
    assert_eq!(MODEL.at(0.1, z), LUGRE.at(0.1, z));
    assert_eq!(MODEL.steady_coefficient(0.1), LUGRE.steady_coefficient(0.1));
    assert_eq!(MODEL.steady_bristle(0.1), LUGRE.steady_bristle(0.1));
    assert_eq!(MODEL.bristle_limit(), LUGRE.bristle_limit());
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn rate_lies_between_spring_and_lugre(lugre in lugre(), kappa in 0.0..0.99f64, v in -1.0..1.0f64, share in -1.0..1.0f64) {
        let z = share * lugre.bristle_limit();
        let rate = ElastoPlastic { lugre, elastic_share: kappa }.at(v, z).rate.value;
        let other = lugre.at(v, z).rate.value;
        prop_assert!(rate >= v.min(other) - 1e-14 && rate <= v.max(other) + 1e-14);
    }

    #[test]
    fn partials_are_those_of_the_values(lugre in lugre(), kappa in 0.0..0.9f64, v in -0.3..0.3f64, share in -1.0..1.0f64) {
        let model = ElastoPlastic { lugre: LuGre { guard: Guard::None, ..lugre }, elastic_share: kappa };
        let z = share * lugre.bristle_limit();
        prop_assume!(v.abs() > 1e-4);
        // Kinks where the flow begins and where it is complete.
        let s = (z / lugre.steady_bristle(v)).abs();
        prop_assume!((s - kappa).abs() > 1e-3 && (s - 1.0).abs() > 1e-3);
        let at = model.at(v, z);
        let (v_scale, z_scale) = (lugre.stribeck_speed, lugre.bristle_limit());
        let by_slip = difference(|v| model.at(v, z).rate.value, v, v_scale);
        let by_bristle = difference(|z| model.at(v, z).rate.value, z, z_scale);
        prop_assert!(close(at.rate.d_slip * v_scale, by_slip * v_scale, 1e-6));
        prop_assert!(close(at.rate.d_bristle * z_scale, by_bristle * z_scale, 1e-6));
    }

    #[test]
    fn passive_where_lugre_is(lugre in lugre(), kappa in 0.0..0.99f64, v in -0.5..0.5f64, share in -1.0..1.0f64) {
        let model = ElastoPlastic { lugre, elastic_share: kappa };
        prop_assume!(model.is_passive_at(v));
        let z = share * lugre.bristle_limit();
        let at = model.at(v, z);
        let stored = lugre.bristle_stiffness * z * at.rate.value;
        prop_assert!(at.coefficient.value * v - stored >= -1e-12);
    }
}
