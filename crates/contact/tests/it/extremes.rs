//! Finite answers for every finite argument, and NaN for NaN.

use crate::fixtures::*;
use linkdyn_contact::*;
use nalgebra::Vector3;
use proptest::prelude::*;

fn laws() -> Vec<ContactLaw> {
    let mut laws = vec![
        ContactLaw::from(KelvinVoigt {
            stiffness: 1e9,
            damping: 1e3,
        }),
        NormalLaw::new(1e300, 30.0, Damping::Material { constant: 1e308 })
            .unwrap()
            .into(),
        NormalLaw::new(1e-300, 1.5, RestitutionLaw::Flores.with(1e-300))
            .unwrap()
            .into(),
    ];
    for n in [1.0, 1.5, 2.2] {
        for law in RestitutionLaw::ALL {
            laws.push(NormalLaw::new(1e10, n, law.with(0.1)).unwrap().into());
        }
        laws.push(NormalLaw::new(1e10, n, Damping::Hertz).unwrap().into());
    }
    laws
}

fn parts(f: NormalForce) -> [f64; 4] {
    [f.value, f.elastic, f.d_depth, f.d_rate]
}

proptest! {
    #[test]
    fn forces_are_finite_for_any_bits(bits in prop::array::uniform3(any::<u64>())) {
        let [depth, rate, speed] = bits.map(f64::from_bits);
        prop_assume!(depth.is_finite() && rate.is_finite() && speed.is_finite());
        for law in laws() {
            let f = law.at(depth, rate, speed);
            prop_assert!(parts(f).iter().all(|x| x.is_finite()), "{law:?} {f:?}");
            prop_assert!(f.value >= 0.0);
            prop_assert!(law.stored_energy(depth).is_finite());
        }
    }
}

#[test]
fn forces_are_finite_at_the_ends_of_the_numbers() {
    let numbers = [
        0.0,
        -0.0,
        5e-324,
        -5e-324,
        1e-310,
        1e-160,
        1e160,
        1e308,
        f64::MAX,
        f64::MIN,
    ];
    for law in laws() {
        for depth in numbers {
            for rate in numbers {
                for speed in numbers {
                    let f = law.at(depth, rate, speed);
                    assert!(
                        parts(f).iter().all(|x| x.is_finite()),
                        "{law:?} {depth:e} {rate:e} {speed:e} {f:?}"
                    );
                    assert!(f.value >= 0.0);
                }
            }
        }
    }
}

#[test]
fn forces_do_not_hide_a_nan() {
    for law in [ContactLaw::from(rsup()), laws()[0].clone()] {
        assert!(law.at(f64::NAN, 0.1, 0.1).value.is_nan());
        assert!(law.at(1e-6, f64::NAN, 0.1).value.is_nan());
    }
    assert!(rsup().at(1e-6, 0.1, f64::NAN).value.is_nan());
}

#[test]
fn geometry_does_not_hide_a_nan() {
    let centre = Centre {
        point: Vector3::new(f64::NAN, 0.0, 0.0),
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
        axis: Vector3::z(),
    };
    let other = Centre {
        point: Vector3::zeros(),
        ..centre
    };
    assert!(rsup_fit().gap(&centre, &other).is_nan());
    assert!(rsup_fit().planar(&centre, &other).unwrap().depth.is_nan());
}

#[test]
fn tiny_clearances_work() {
    let fit = Fit::new(0.005, 0.005 - 1e-9).unwrap();
    let bearing = Centre {
        point: Vector3::zeros(),
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
        axis: Vector3::z(),
    };
    let journal = Centre {
        point: Vector3::new(0.0, 2e-9, 0.0),
        velocity: Vector3::new(0.0, 1.0, 0.0),
        ..bearing
    };
    let touch = fit.planar(&bearing, &journal).unwrap();
    assert!((touch.depth - 1e-9).abs() < 1e-17);
    assert_eq!(touch.rate, 1.0);
}
