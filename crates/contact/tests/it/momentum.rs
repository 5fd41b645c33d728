//! Action, reaction, power.

use crate::fixtures::*;
use linkdyn_contact::*;
use proptest::prelude::*;

proptest! {
    #[test]
    fn common_point_keeps_angular_momentum((bearing, journal) in pair(rsup_fit(), 0.05), f in 0.0..1e3f64, friction in prop::array::uniform2(-1e3..1e3f64), about in vector(1.0)) {
        let (b, j) = (bearing.at(0.0), journal.at(0.0));
        let touch = rsup_fit().planar(&b, &j).unwrap();
        let force = touch.force(f, friction, ForcePoint::Common);
        // Forces are opposite by construction; torques about any point too.
        let sum = force.torque_on_bearing(&about) + force.torque_on_journal(&about);
        prop_assert!(sum.norm() < 1e-12 * (1.0 + force.on_bearing.norm()), "{sum}");
        let middle = 0.5 * (touch.bearing_point + touch.journal_point);
        prop_assert_eq!(force.bearing_point, middle);
    }

    #[test]
    fn own_surfaces_leave_the_couple_of_depth_and_friction((bearing, journal) in pair(rsup_fit(), 1e-9), f in 0.0..1e3f64, f_t in -1e3..1e3f64, about in vector(1.0)) {
        let (b, mut j) = (bearing.at(0.0), journal.at(0.0));
        j.axis = b.axis;
        j.point -= b.axis * b.axis.dot(&(j.point - b.point));
        let touch = rsup_fit().planar(&b, &j).unwrap();
        let force = touch.force(f, [f_t, 0.0], ForcePoint::OwnSurface);
        let sum = force.torque_on_bearing(&about) + force.torque_on_journal(&about);
        // (C_b - C_j) × F = δ n × (-f_t t) = -δ f_t axis.
        let couple = -touch.axis * (touch.depth * f_t);
        prop_assert!((sum - couple).norm() < 1e-12 * (1.0 + force.on_bearing.norm()), "{sum} {couple}");
    }

    #[test]
    fn power_is_that_of_rate_and_slip((bearing, journal) in pair(rsup_fit(), 1e-9), f in 0.0..1e3f64, friction in prop::array::uniform2(-1e3..1e3f64)) {
        let (b, mut j) = (bearing.at(0.0), journal.at(0.0));
        j.axis = b.axis;
        j.point -= b.axis * b.axis.dot(&(j.point - b.point));
        let touch = rsup_fit().planar(&b, &j).unwrap();
        let power = |at| touch.force(f, friction, at).power(&b, &j);
        let own = -f * touch.rate - friction[0] * touch.slip - friction[1] * touch.axial_slip;
        prop_assert!(close(power(ForcePoint::OwnSurface), own, 1e-11));
        // The points half-way slip differently by the spins times half the depth.
        let turned = 0.5 * touch.depth * (b.spin + j.spin).dot(&touch.axis);
        let tilting = 0.5 * touch.depth * (b.spin + j.spin).dot(&touch.tangent);
        let common = own + friction[0] * turned - friction[1] * tilting;
        prop_assert!(close(power(ForcePoint::Common), common, 1e-11), "{} {common}", power(ForcePoint::Common));
    }
}
