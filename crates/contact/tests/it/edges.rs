//! The spatial joint: two edges.

use crate::fixtures::*;
use linkdyn_contact::*;
use nalgebra::Vector3;
use proptest::prelude::*;

const LENGTH: f64 = 0.02;

fn bearing() -> Centre {
    Centre {
        point: Vector3::zeros(),
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
        axis: Vector3::z(),
    }
}

/// A journal through (x, y) of the two edge planes, given by a point somewhere on its axis.
fn through(lower: [f64; 2], upper: [f64; 2]) -> Centre {
    let p = Vector3::new(lower[0], lower[1], -0.5 * LENGTH);
    let q = Vector3::new(upper[0], upper[1], 0.5 * LENGTH);
    Centre {
        point: p + (q - p) * 0.3,
        axis: (q - p).normalize(),
        ..bearing()
    }
}

#[test]
fn four_cases() {
    let fit = rsup_fit();
    let pattern = |lower, upper| Pattern::of(&fit.edges(LENGTH, &bearing(), &through(lower, upper)).unwrap());
    assert_eq!(pattern([0.0, 0.0], [0.0, 0.0]), Pattern::Free);
    assert_eq!(pattern([9e-4, 0.0], [-9e-4, 0.0]), Pattern::Free);
    assert_eq!(pattern([1.1e-3, 0.0], [2e-4, 0.0]), Pattern::Point);
    assert_eq!(pattern([1.1e-3, 0.0], [-9e-4, 0.0]), Pattern::Point);
    assert_eq!(pattern([0.0, 1.1e-3], [0.0, 1.1e-3]), Pattern::Line);
    assert_eq!(pattern([1.1e-3, 0.0], [0.8e-3, 0.8e-3]), Pattern::Line);
    assert_eq!(pattern([1.1e-3, 0.0], [-1.2e-3, 0.0]), Pattern::Opposite);
}

#[test]
fn journals_pressed_at_one_edge_are_pushed_back_there() {
    let touches = rsup_fit()
        .edges(LENGTH, &bearing(), &through([0.0, 0.0], [1.01e-3, 0.0]))
        .unwrap();
    assert_eq!(touches[1], None);
    let upper = touches[0].unwrap();
    assert!((upper.depth - 1e-5).abs() < 1e-15);
    assert!((upper.bearing_point - Vector3::new(0.005, 0.0, 0.01)).norm() < 1e-15);
    assert!((upper.journal_point - Vector3::new(0.005_01, 0.0, 0.01)).norm() < 1e-15);
    assert!(upper.force(1.0, [0.0; 2], ForcePoint::Common).on_bearing.x > 0.99);
    let gaps = rsup_fit()
        .edge_gaps(LENGTH, &bearing(), &through([0.0, 0.0], [1.01e-3, 0.0]))
        .unwrap();
    assert!((gaps[1] - 1e-3).abs() < 1e-15 && (gaps[0] + 1e-5).abs() < 1e-15);
}

#[test]
fn crossed_axes_are_refused_with_their_angle() {
    let mut journal = bearing();
    journal.axis = Vector3::x();
    let error = rsup_fit().edges(LENGTH, &bearing(), &journal).unwrap_err();
    assert!((error.angle - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!(error.to_string().contains("1.57"), "{error}");
    assert!(rsup_fit().edge_gaps(LENGTH, &bearing(), &journal).is_err());
    journal.axis.x = f64::NAN;
    assert!(rsup_fit().edge_gap_rates(LENGTH, &bearing(), &journal).is_err());
}

#[test]
fn sense_of_the_journals_axis_does_not_matter() {
    let fit = rsup_fit();
    let mut journal = through([1.1e-3, 2e-4], [-1.0e-3, 4e-4]);
    journal.spin = Vector3::new(1.0, 2.0, 3.0);
    let there = fit.edges(LENGTH, &bearing(), &journal).unwrap();
    journal.axis = -journal.axis;
    assert_eq!(fit.edges(LENGTH, &bearing(), &journal).unwrap(), there);
}

#[test]
fn centred_edges_have_a_rate() {
    let journal = Centre {
        spin: Vector3::new(0.0, 2.0, 0.0),
        ..bearing()
    };
    let rates = rsup_fit().edge_gap_rates(LENGTH, &bearing(), &journal).unwrap();
    assert_eq!(rates, [-0.02, -0.02]);
}

proptest! {
    #[test]
    fn rates_are_those_of_depths_and_gaps((bearing, journal) in pair(rsup_fit(), 0.3)) {
        let fit = rsup_fit();
        let (b, j) = (bearing.at(0.0), journal.at(0.0));
        let gap = |k: usize, t: f64| fit.edge_gaps(LENGTH, &bearing.at(t), &journal.at(t)).unwrap()[k];
        let rates = fit.edge_gap_rates(LENGTH, &b, &j).unwrap();
        for (k, touch) in fit.edges(LENGTH, &b, &j).unwrap().into_iter().enumerate() {
            // Away from the ridge.
            prop_assume!(fit.clearance() - gap(k, 0.0) > 1e-4);
            let seen = difference(|t| gap(k, t), 1e-7);
            prop_assert!(close(rates[k], seen, 1e-6), "{rates:?} {seen}");
            if let Some(touch) = touch {
                prop_assert!(close(touch.rate, -seen, 1e-6));
                prop_assert!((touch.depth + gap(k, 0.0)).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn power_of_the_normal_force_misses_the_rate_by_tilt_times_axial_speed((bearing, journal) in pair(rsup_fit(), 0.05)) {
        let (b, j) = (bearing.at(0.0), journal.at(0.0));
        for touch in rsup_fit().edges(LENGTH, &b, &j).unwrap().into_iter().flatten() {
            let power = touch.force(1.0, [0.0; 2], ForcePoint::OwnSurface).power(&b, &j);
            // The speed of the journal's axis through the edge plane, and how far its axis leans towards the normal.
            let lean = j.axis.dot(&touch.normal) / j.axis.dot(&touch.axis);
            let centre = touch.journal_point + touch.normal * rsup_fit().journal_radius();
            let edge = touch.bearing_point + touch.normal * rsup_fit().bearing_radius();
            let through = (b.velocity_at(&edge) - j.velocity_at(&centre)).dot(&touch.axis)
                + b.spin.cross(&touch.axis).dot(&(edge - centre));
            prop_assert!(close(power, -touch.rate - lean * through, 1e-10), "{power} {}", touch.rate);
        }
    }

    #[test]
    fn slips_are_those_of_material_points((bearing, journal) in pair(rsup_fit(), 0.3)) {
        let touches = rsup_fit().edges(LENGTH, &bearing.at(0.0), &journal.at(0.0)).unwrap();
        for touch in touches.into_iter().flatten() {
            let apart = |t: f64| bearing.material(touch.bearing_point, t) - journal.material(touch.journal_point, t);
            let along = |u: Vector3<f64>| difference(|t| apart(t).dot(&u), 1e-5);
            prop_assert!(close(touch.slip, along(touch.tangent), 1e-9));
            prop_assert!(close(touch.axial_slip, along(touch.axis), 1e-9));
            prop_assert!((touch.tangent.norm() - 1.0).abs() < 1e-12);
            prop_assert!(touch.tangent.dot(&touch.normal).abs() < 1e-9);
        }
    }

    #[test]
    fn parallel_axes_give_the_planar_joint_twice((bearing, journal) in pair(rsup_fit(), 1e-9)) {
        let (b, mut j) = (bearing.at(0.0), journal.at(0.0));
        j.axis = b.axis;
        j.spin = b.spin + b.axis * 3.0; // remain parallel
        let planar = rsup_fit().planar(&b, &j).unwrap();
        for touch in rsup_fit().edges(LENGTH, &b, &j).unwrap() {
            let touch = touch.unwrap();
            prop_assert!((touch.depth - planar.depth).abs() < 1e-14);
            prop_assert!((touch.rate - planar.rate).abs() < 1e-10, "{} {}", touch.rate, planar.rate);
            prop_assert!((touch.normal - planar.normal).norm() < 1e-10);
        }
        prop_assert_eq!(Pattern::of(&rsup_fit().edges(LENGTH, &b, &j).unwrap()), if planar.is_contact() { Pattern::Line } else { Pattern::Free });
    }

    #[test]
    fn point_on_the_journals_axis_may_be_any((bearing, journal) in pair(rsup_fit(), 0.3), along in -0.05..0.05f64) {
        let (b, j) = (bearing.at(0.0), journal.at(0.0));
        let shifted = j.axis * along;
        let other = Centre { point: j.point + shifted, velocity: j.velocity + j.spin.cross(&shifted), ..j };
        let (here, there) = (rsup_fit().edges(LENGTH, &b, &j).unwrap(), rsup_fit().edges(LENGTH, &b, &other).unwrap());
        for (here, there) in here.into_iter().zip(there) {
            let (Some(here), Some(there)) = (here, there) else { continue };
            prop_assert!((here.depth - there.depth).abs() < 1e-14);
            prop_assert!((here.rate - there.rate).abs() < 1e-9 && (here.slip - there.slip).abs() < 1e-9);
        }
    }
}
