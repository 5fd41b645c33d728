//! The ball in its socket: gap, rates, power, and that neither frame nor choice of tangents matters.

use crate::fixtures::*;
use linkdyn_contact::*;
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

/// A socket and a ball in motion, their centres up to three clearances apart in any direction.
fn pair() -> impl Strategy<Value = (Mover, Mover)> {
    let motions = (vector(0.5), vector(20.0), vector(0.5), vector(20.0));
    (vector(0.5), motions, direction(), 0.6..3.0f64).prop_map(|(r, (v, w, v2, w2), towards, share)| {
        let at = |point, velocity, spin| Mover {
            at_zero: Centre {
                point,
                velocity,
                spin,
                axis: Vector3::z(),
            },
        };
        let place = r + towards * (share * rsup_fit().clearance());
        (at(r, v, w), at(place, v2, w2))
    })
}

fn slip(touch: &Touch) -> Vector3<f64> {
    touch.tangent * touch.slip + touch.axis * touch.axial_slip
}

#[test]
fn nothing_is_divided_by_zero_while_the_centres_coincide() {
    let fit = rsup_fit();
    let still = |x: f64| Centre {
        point: Vector3::new(0.0, x, 0.0),
        velocity: Vector3::zeros(),
        spin: Vector3::new(1.0, 2.0, 3.0),
        axis: Vector3::z(),
    };
    let (socket, mut ball) = (still(0.0), still(0.0));
    assert_eq!(fit.ball_gap(&socket, &ball), fit.clearance());
    assert_eq!(fit.ball_gap_rate(&socket, &ball), 0.0);
    assert_eq!(fit.ball(&socket, &ball), None);
    ball.velocity = Vector3::new(2.0, 3.0, 6.0);
    assert_eq!(fit.ball_gap_rate(&socket, &ball), -7.0);
    assert_eq!(fit.ball(&socket, &still(0.49e-3)), None);
    let near = fit
        .ball(&socket, &still(0.51e-3))
        .expect("close enough for a direction");
    assert!(!near.is_contact() && near.depth < 0.0 && near.normal == -Vector3::y());
}

#[test]
fn a_ball_that_turns_about_the_normal_does_not_slide() {
    let centre = |y: f64, spin| Centre {
        point: Vector3::new(0.0, y, 0.0),
        velocity: Vector3::zeros(),
        spin,
        axis: Vector3::z(),
    };
    let socket = centre(0.0, Vector3::zeros());
    let about_n = rsup_fit()
        .ball(&socket, &centre(1.01e-3, Vector3::y() * 7.0))
        .expect("contact");
    assert!(slip(&about_n).norm() < 1e-16);
    // About x its surface at +y moves along z, by the ball's radius.
    let across = rsup_fit()
        .ball(&socket, &centre(1.01e-3, Vector3::x() * 7.0))
        .expect("contact");
    assert!((slip(&across) + Vector3::z() * 0.028).norm() < 1e-15);
}

proptest! {
    #[test]
    fn rates_are_those_of_depth_gap_and_normal((socket, ball) in pair()) {
        let fit = rsup_fit();
        let touch = fit.ball(&socket.at(0.0), &ball.at(0.0)).expect("a direction");
        let gap = |t: f64| fit.ball_gap(&socket.at(t), &ball.at(t));
        let seen = difference(gap, 1e-7);
        prop_assert!(close(touch.rate, -seen, 1e-7), "{} {seen}", touch.rate);
        prop_assert!(close(fit.ball_gap_rate(&socket.at(0.0), &ball.at(0.0)), seen, 1e-7));
        prop_assert!((touch.depth + gap(0.0)).abs() < 1e-15);
        // The normal in axes that turn with the socket.
        let normal = |t: f64, u: &Vector3<f64>| {
            let n = fit.ball(&socket.at(t), &ball.at(t)).expect("a direction").normal;
            (Rotation3::new(socket.at_zero.spin * -t) * n).dot(u)
        };
        let rate = touch.normal_rate(&socket.at(0.0), &ball.at(0.0));
        for u in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let seen = difference(|t| normal(t, &u), 1e-7);
            prop_assert!((rate.dot(&u) - seen).abs() < 1e-5 * (1.0 + rate.norm()), "{rate} {seen}");
        }
    }

    #[test]
    fn slip_is_that_of_material_points_and_at_right_angles_to_the_normal((socket, ball) in pair()) {
        let touch = rsup_fit().ball(&socket.at(0.0), &ball.at(0.0)).expect("a direction");
        let apart = |t: f64| socket.material(touch.bearing_point, t) - ball.material(touch.journal_point, t);
        for u in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let whole = difference(|t| apart(t).dot(&u), 1e-5);
            prop_assert!(close((slip(&touch) + touch.normal * touch.rate).dot(&u), whole, 1e-9));
        }
        prop_assert!(slip(&touch).dot(&touch.normal).abs() < 1e-14);
        let handed = touch.normal.cross(&touch.tangent).dot(&touch.axis);
        prop_assert!((handed - 1.0).abs() < 1e-14);
    }

    #[test]
    fn power_is_that_of_rate_and_slip((socket, ball) in pair(), f in 0.0..1e3f64, friction in prop::array::uniform2(-1e3..1e3f64)) {
        let (b, j) = (socket.at(0.0), ball.at(0.0));
        let touch = rsup_fit().ball(&b, &j).expect("a direction");
        let power = |friction, at| touch.force(f, friction, at).power(&b, &j);
        let own = -f * touch.rate - friction[0] * touch.slip - friction[1] * touch.axial_slip;
        prop_assert!(close(power(friction, ForcePoint::OwnSurface), own, 1e-11));
        // Half-way between the surfaces only friction finds another speed.
        prop_assert!(close(power([0.0; 2], ForcePoint::Common), -f * touch.rate, 1e-11));
        let common = touch.force(f, friction, ForcePoint::Common);
        let sum = common.torque_on_bearing(&b.point) + common.torque_on_journal(&b.point);
        prop_assert!(sum.norm() < 1e-12 * (1.0 + common.on_bearing.norm()));
    }

    #[test]
    fn neither_frame_nor_choice_of_tangents_matters((socket, ball) in pair(), turn in vector(3.0), shift in vector(1.0)) {
        let rotation = Rotation3::new(turn);
        let moved = |c: Centre| Centre {
            point: rotation * c.point + shift,
            velocity: rotation * c.velocity,
            spin: rotation * c.spin,
            // Even this one may be turned by itself.
            axis: Rotation3::new(shift) * c.axis,
        };
        let (b, j) = (socket.at(0.0), ball.at(0.0));
        let (m, k) = (moved(b), moved(j));
        let (here, there) = (rsup_fit().ball(&b, &j).expect("some"), rsup_fit().ball(&m, &k).expect("some"));
        prop_assert!((here.depth - there.depth).abs() < 1e-14 && (here.rate - there.rate).abs() < 1e-10);
        prop_assert!((rotation * here.normal - there.normal).norm() < 1e-11);
        prop_assert!((rotation * slip(&here) - slip(&there)).norm() < 1e-10);
        let rates = (here.normal_rate(&b, &j), there.normal_rate(&m, &k));
        prop_assert!((rotation * rates.0 - rates.1).norm() < 1e-8 * (1.0 + rates.0.norm()));
    }

    #[test]
    fn in_a_plane_it_is_the_planar_joint((socket, ball) in pair(), axis in direction()) {
        let flat = |v: Vector3<f64>| v - axis * v.dot(&axis);
        let (b, mut j) = (socket.at(0.0), ball.at(0.0));
        let b = Centre { velocity: flat(b.velocity), spin: axis * b.spin.norm(), axis, ..b };
        j = Centre {
            point: b.point + flat(j.point - b.point) * 3.0,
            velocity: flat(j.velocity),
            spin: axis * -j.spin.norm(),
            axis,
        };
        let planar = rsup_fit().planar(&b, &j);
        let ball = rsup_fit().ball(&b, &j);
        prop_assert_eq!(planar.is_some(), ball.is_some());
        if let (Some(planar), Some(ball)) = (planar, ball) {
            prop_assert!((planar.depth - ball.depth).abs() < 1e-15 && (planar.rate - ball.rate).abs() < 1e-12);
            prop_assert!((slip(&planar) - slip(&ball)).norm() < 1e-12);
            prop_assert!((planar.bearing_point - ball.bearing_point).norm() < 1e-14);
        }
    }
}
