//! The planar joint: signs, rates, material velocities.

use crate::fixtures::*;
use linkdyn_contact::*;
use nalgebra::Vector3;
use proptest::prelude::*;

fn still(x: f64, y: f64) -> Centre {
    Centre {
        point: Vector3::new(x, y, 0.0),
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
        axis: Vector3::z(),
    }
}

#[test]
fn journal_pressed_in_x_is_pushed_back() {
    let touch = rsup_fit().planar(&still(0.0, 0.0), &still(1.01e-3, 0.0)).unwrap();
    assert!((touch.depth - 1e-5).abs() < 1e-16);
    assert_eq!(touch.normal, -Vector3::x());
    assert_eq!(touch.tangent, -Vector3::y());
    // The contact lies in +x of both centres.
    assert_eq!(touch.bearing_point, Vector3::new(0.005, 0.0, 0.0));
    assert!((touch.journal_point - Vector3::new(0.005_01, 0.0, 0.0)).norm() < 1e-17);
    let force = touch.force(10.0, [0.0, 0.0], ForcePoint::OwnSurface);
    assert_eq!(force.on_bearing, Vector3::new(10.0, 0.0, 0.0));
    assert_eq!(ForcePoint::default(), ForcePoint::Common);
}

#[test]
fn nothing_is_divided_by_zero_while_the_centres_coincide() {
    let fit = rsup_fit();
    let (bearing, mut journal) = (still(0.0, 0.0), still(0.0, 0.0));
    assert_eq!(fit.gap(&bearing, &journal), fit.clearance());
    assert_eq!(fit.gap_rate(&bearing, &journal), 0.0);
    assert_eq!(fit.planar(&bearing, &journal), None);
    journal.velocity = Vector3::new(3.0, 4.0, 7.0);
    assert_eq!(fit.gap_rate(&bearing, &journal), -5.0);
    assert_eq!(fit.planar(&bearing, &still(0.49e-3, 0.0)), None);
    let near = fit.planar(&bearing, &still(0.51e-3, 0.0)).unwrap();
    assert!(!near.is_contact() && near.depth < 0.0);
}

#[test]
fn slip_is_kept_when_only_the_journal_turns() {
    // Geometric contact points do not move here; material ones do.
    let mut journal = still(1.01e-3, 0.0);
    journal.spin = Vector3::new(0.0, 0.0, 10.0);
    let touch = rsup_fit().planar(&still(0.0, 0.0), &journal).unwrap();
    // Surface of the journal moves with +0.04 m/s along y, that is along -t.
    assert!((touch.slip - 0.04).abs() < 1e-15);
    assert_eq!(touch.rate, 0.0);
}

#[test]
fn equal_surfaces_roll_without_slip() {
    let (mut bearing, mut journal) = (still(0.0, 0.0), still(0.0, 1.01e-3));
    bearing.spin.z = 4.0;
    journal.spin.z = 5.0;
    let touch = rsup_fit().planar(&bearing, &journal).unwrap();
    assert!(touch.slip.abs() < 1e-16);
}

#[test]
fn friction_opposes_the_turning_journal() {
    let mut journal = still(1.01e-3, 0.0);
    journal.spin = Vector3::new(0.0, 0.0, 10.0);
    let touch = rsup_fit().planar(&still(0.0, 0.0), &journal).unwrap();
    let force = touch.force(100.0, [0.1 * touch.slip.signum() * 100.0, 0.0], ForcePoint::OwnSurface);
    assert!(force.torque_on_journal(&journal.point).z < 0.0);
    assert!((force.torque_on_journal(&journal.point).z + 0.004 * 10.0).abs() < 1e-15);
    // The bearing is dragged along.
    assert!((force.torque_on_bearing(&Vector3::zeros()).z - 0.005 * 10.0).abs() < 1e-15);
    assert!(force.power(&still(0.0, 0.0), &journal) < 0.0);
}

#[test]
fn sliding_along_the_axis_is_seen_apart() {
    let mut journal = still(1.01e-3, 0.0);
    journal.velocity.z = 0.3;
    let touch = rsup_fit().planar(&still(0.0, 0.0), &journal).unwrap();
    assert_eq!((touch.slip, touch.axial_slip, touch.rate), (0.0, -0.3, 0.0));
}

proptest! {
    #[test]
    fn rates_are_those_of_depth_and_gap((bearing, journal) in pair(rsup_fit(), 0.3)) {
        let fit = rsup_fit();
        let touch = fit.planar(&bearing.at(0.0), &journal.at(0.0)).unwrap();
        let gap = |t: f64| fit.gap(&bearing.at(t), &journal.at(t));
        let seen = difference(gap, 1e-7);
        prop_assert!(close(touch.rate, -seen, 1e-7), "{} {seen}", touch.rate);
        prop_assert!(close(fit.gap_rate(&bearing.at(0.0), &journal.at(0.0)), seen, 1e-7));
        prop_assert!((touch.depth + gap(0.0)).abs() < 1e-15);
    }

    #[test]
    fn slip_is_that_of_material_points((bearing, journal) in pair(rsup_fit(), 0.3)) {
        let touch = rsup_fit().planar(&bearing.at(0.0), &journal.at(0.0)).unwrap();
        // The two points are followed separately through time.
        let apart = |t: f64| bearing.material(touch.bearing_point, t) - journal.material(touch.journal_point, t);
        let along = |u: Vector3<f64>| difference(|t| apart(t).dot(&u), 1e-5);
        prop_assert!(close(touch.slip, along(touch.tangent), 1e-9));
        prop_assert!(close(touch.axial_slip, along(touch.axis), 1e-9));
    }

    #[test]
    fn conventions_of_the_rsup_scene((bearing, journal) in pair(rsup_fit(), 1e-9), along in -0.5..0.5f64) {
        // Parallel axes, no axial offset; spins may be any.
        let (b, mut j) = (bearing.at(0.0), journal.at(0.0));
        let x = b.axis;
        j.axis = x;
        j.point -= x * x.dot(&(j.point - b.point));
        let touch = rsup_fit().planar(&b, &j).unwrap();
        let e = b.point - j.point;
        let n = e / e.norm();
        let t = x.cross(&n);
        let edot = b.velocity - j.velocity;
        prop_assert!((touch.normal - n).norm() < 1e-12 && (touch.tangent - t).norm() < 1e-12);
        prop_assert!((touch.depth - (e.norm() - 0.001)).abs() < 1e-15);
        prop_assert!((touch.rate - edot.dot(&n)).abs() < 1e-11);
        let v_t = edot.dot(&t) - 0.005 * b.spin.dot(&x) + 0.004 * j.spin.dot(&x);
        prop_assert!((touch.slip - v_t).abs() < 1e-11);
        prop_assert!((touch.bearing_point - (b.point - n * 0.005)).norm() < 1e-14);
        prop_assert!((touch.journal_point - (j.point - n * 0.004)).norm() < 1e-14);
        let force = touch.force(3.0, [along, 0.0], ForcePoint::OwnSurface).on_bearing;
        prop_assert!((force - (-3.0 * n - along * t)).norm() < 1e-12);
    }

    #[test]
    fn frame_does_not_matter((bearing, journal) in pair(rsup_fit(), 0.3), turn in vector(3.0), shift in vector(1.0)) {
        let rotation = nalgebra::Rotation3::new(turn);
        let moved = |c: Centre| Centre {
            point: rotation * c.point + shift,
            velocity: rotation * c.velocity,
            spin: rotation * c.spin,
            axis: rotation * c.axis,
        };
        let (b, j) = (bearing.at(0.0), journal.at(0.0));
        let (here, there) = (rsup_fit().planar(&b, &j).unwrap(), rsup_fit().planar(&moved(b), &moved(j)).unwrap());
        prop_assert!((here.depth - there.depth).abs() < 1e-14);
        prop_assert!((here.rate - there.rate).abs() < 1e-10 && (here.slip - there.slip).abs() < 1e-10);
        prop_assert!((rotation * here.normal - there.normal).norm() < 1e-11);
        prop_assert!((rotation * here.bearing_point + shift - there.bearing_point).norm() < 1e-13);
    }
}
