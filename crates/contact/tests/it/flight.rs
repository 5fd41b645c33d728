//! Flights of a journal inside its bearing (benchmark 11-contact-restitution, last line).

use crate::fixtures::*;
use linkdyn_contact::*;
use nalgebra::Vector3;
use proptest::prelude::*;

fn at(point: Vector3<f64>, velocity: Vector3<f64>) -> Centre {
    Centre {
        point,
        velocity,
        spin: Vector3::zeros(),
        axis: Vector3::z(),
    }
}

proptest! {
    #[test]
    fn journal_crosses_the_clearance_in_chord_over_speed(angle in 0.0..6.0f64, aside in -1.3..1.3f64, speed in 0.01..3.0f64) {
        let (fit, bearing) = (rsup_fit(), at(Vector3::zeros(), Vector3::zeros()));
        let c = fit.clearance();
        // From the circle at `angle`, inwards, `aside` from the normal: the chord is 2 c cos(aside).
        let start = c * Vector3::new(angle.cos(), angle.sin(), 0.0);
        let v = -speed * Vector3::new((angle + aside).cos(), (angle + aside).sin(), 0.0);
        let expected = 2.0 * c * aside.cos() / speed;
        let gap = |t: f64| fit.gap(&bearing, &at(start + v * t, v));
        let (mut free, mut touching) = (0.5 * expected, 2.0 * expected);
        prop_assert!(gap(free) > 0.0 && gap(touching) < 0.0);
        for _ in 0..200 {
            let t = 0.5 * (free + touching);
            if gap(t) > 0.0 { free = t } else { touching = t }
        }
        prop_assert!(near(touching, expected, 1e-12), "{touching} {expected}");
        // It arrives under the angle under which it left, and leaves under it again without friction.
        let touch = fit.planar(&bearing, &at(start + v * touching, v)).unwrap();
        prop_assert!((touch.rate - speed * aside.cos()).abs() < 1e-10 * speed);
        prop_assert!((touch.slip.abs() - speed * aside.sin().abs()).abs() < 1e-10 * speed);
        prop_assert!(touch.depth.abs() < 1e-15);
    }
}

#[test]
fn frictionless_bounces_keep_the_tangential_speed_and_the_angular_momentum() {
    let (fit, bearing) = (rsup_fit(), at(Vector3::zeros(), Vector3::zeros()));
    let (law, mass) = (
        NormalLaw::new(2.176e10, 1.5, RestitutionLaw::Exact.with(0.8)).unwrap(),
        0.1,
    );
    let (mut r, mut v) = (Vector3::new(0.3e-3, 0.0, 0.0), Vector3::new(0.05, 0.2, 0.0));
    let momentum = r.cross(&v).z;
    let (h, mut v0, mut bounces) = (1e-7, 0.0, 0);
    let mut arrival = 0.0;
    // Velocity Verlet; the rate is one step old, so h is small.
    for _ in 0..400_000 {
        let journal = at(r, v);
        let touch = fit.planar(&bearing, &journal).filter(Touch::is_contact);
        let force = match &touch {
            Some(touch) => {
                if v0 == 0.0 {
                    (v0, arrival) = (touch.rate, touch.rate);
                }
                -touch
                    .force(law.at(touch.depth, touch.rate, v0).value, [0.0; 2], ForcePoint::Common)
                    .on_bearing
            }
            None => {
                if v0 > 0.0 {
                    let leaving = fit.gap_rate(&bearing, &journal);
                    assert!((leaving / arrival - 0.8).abs() < 5e-3, "{leaving} {arrival}");
                    bounces += 1;
                }
                v0 = 0.0;
                Vector3::zeros()
            }
        };
        v += force * (h / mass);
        r += v * h;
    }
    assert!(bounces >= 3, "{bounces}");
    assert!((r.cross(&v).z / momentum - 1.0).abs() < 1e-9);
}
