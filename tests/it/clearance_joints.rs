//! Motion of joints with clearance in the tree and of the same joints cut, planar, spatial and of a ball: one motion, a closed balance,
//! and the ideal joint in the limit.

use crate::clearance::Run;
use crate::hung_rod::{CLEARANCE, Hung, apart, clearance, contacts_apart, dead, kinds, lugre};
use linkdyn_contact::ForcePoint;
use linkdyn_friction::{BristleStart, ElastoPlastic};
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::{Clearance, ClearanceModel, Observation, Side};
use nalgebra::{Unit, Vector3};

#[test]
fn a_joint_of_the_tree_and_the_same_joint_cut_move_alike() {
    for (joint, model, speeds) in kinds() {
        for bearing in [Side::Predecessor, Side::Successor] {
            let clearance = Clearance {
                bearing,
                ..clearance(model, CLEARANCE)
            };
            let hung = Hung::new(joint, Some(clearance), speeds);
            let (tree, cut) = (hung.run(0.06), hung.run_cut(0.06));
            let (made, touching) = (tree.1.contacts.len(), |row: &&Observation| {
                row.contacts.iter().any(|point| point.tangent != [0.0; 3])
            });
            assert!(made > 2, "{joint:?}: {made}");
            assert!(tree.1.rows.iter().filter(touching).count() > 2, "{joint:?}");
            let told = |run: &Run| -> Vec<(usize, bool)> {
                run.contacts
                    .iter()
                    .map(|(_, event)| (event.point, event.made))
                    .collect()
            };
            assert_eq!(told(&tree.1), told(&cut.1), "{joint:?}");
            let (rods, points) = (apart(&tree, &cut), contacts_apart(&tree.1, &cut.1));
            assert!(
                rods < 1e-9 && points < 1e-9,
                "{joint:?}, {model:?}, {bearing:?}: {rods:e} {points:e}"
            );
        }
    }
}

#[test]
fn energy_is_stored_or_lost_in_the_contact() {
    for (joint, model, speeds) in kinds() {
        for force_point in [ForcePoint::Common, ForcePoint::OwnSurface] {
            let clearance = Clearance {
                force_point,
                ..clearance(model, CLEARANCE)
            };
            let (_, run) = Hung::new(joint, Some(clearance), speeds).run(0.06);
            let (first, last) = (&run.rows[0], run.rows.last().expect("rows"));
            let lost: f64 = last.integrals.chunks(4).map(|one| one[0] + one[1]).sum();
            assert!(lost > 1e-4 && last.integrals[1] > 1e-6, "{joint:?}: {lost}");
            assert!((last.work + lost).abs() < 1e-9, "{joint:?}: {} {lost}", last.work);
            for row in &run.rows {
                let change = row.energy_balance() - first.energy_balance();
                assert!(change.abs() < 1e-8, "{joint:?}, {model:?} at {}: {change:e}", row.t);
            }
        }
    }
}

#[test]
fn the_bristle_of_a_ball_lies_in_the_plane_of_contact_and_keeps_its_limit() {
    let (joint, model, speeds) = kinds()[2];
    let elasto_plastic = ElastoPlastic {
        lugre: lugre(),
        elastic_share: 0.5,
    };
    // Bristle damping comes on top of an elastic bristle, up to the same again.
    for (friction, bristle_start, limit) in [
        (lugre().into(), BristleStart::Relaxed, 0.2),
        (elasto_plastic.into(), BristleStart::Steady, 0.4),
    ] {
        let clearance = Clearance {
            friction: Some(friction),
            bristle_start,
            ..dead(clearance(model, CLEARANCE), 1e9)
        };
        let (_, run) = Hung::new(joint, Some(clearance), speeds).run(0.2);
        // How long the last contact has lasted, and where it began.
        let (mut since, mut first, mut turned) = (0.0, Vector3::zeros(), 0.0_f64);
        for row in run.rows.iter().filter(|row| row.contacts[0].impact_speed > 0.0) {
            let point = &row.contacts[0];
            let [e, z, force, slip] = [point.journal, point.bristle, point.tangent, point.slip].map(Vector3::from);
            assert!((e.norm() - CLEARANCE - point.depth).abs() < 1e-15);
            assert!(
                e.dot(&z).abs() < 1e-9 * CLEARANCE && z.norm() <= 0.2 / 600.0 * (1.0 + 1e-9),
                "{e} {z}"
            );
            assert!(e.dot(&force).abs() < 1e-12 * point.normal.max(1.0) && e.dot(&slip).abs() < 1e-15);
            assert!(force.norm() <= (limit + 0.01 * slip.norm()) * point.normal * (1.0 + 1e-9));
            let made = run
                .contacts
                .iter()
                .rev()
                .find(|(t, event)| event.made && *t <= row.t)
                .expect("made")
                .0;
            if made > since {
                (since, first) = (made, e);
            }
            turned = turned.max(e.angle(&first));
        }
        // The plane of contact does turn while the contact lasts.
        assert!(turned > 0.3, "{turned}");
    }
}

#[test]
fn a_ball_in_a_plane_is_a_pin() {
    let pin = Hung::flat(Joint::revolute_z(), ClearanceModel::Planar, "J").run(0.2);
    assert!(pin.1.contacts.len() > 2, "{}", pin.1.contacts.len());
    for (joint, turn) in [(Joint::Spherical, "J.qz"), (Joint::SphericalZyx, "J.psi")] {
        let ball = Hung::flat(joint, ClearanceModel::Spherical, turn).run(0.2);
        let rods = apart(&pin, &ball);
        assert!(rods < 1e-9, "{joint:?}: {rods:e}");
        for (a, b) in pin.1.rows.iter().zip(&ball.1.rows) {
            let (a, b) = (&a.contacts[0], &b.contacts[0]);
            assert!(
                (a.depth - b.depth).abs() < 1e-10 && (a.normal - b.normal).abs() < 1e-3,
                "{a:?} {b:?}"
            );
            assert!(
                (a.bristle[0].abs() - Vector3::from(b.bristle).norm()).abs() < 1e-9,
                "{a:?} {b:?}"
            );
            assert!(
                (a.tangent[0].abs() - Vector3::from(b.tangent).norm()).abs() < 1e-3,
                "{a:?} {b:?}"
            );
            assert!(b.bristle[2].abs() < 1e-15 && b.journal[2].abs() < 1e-15);
        }
    }
}

#[test]
fn nothing_changes_where_everything_is_turned_and_moved() {
    let place = Pose {
        origin: Vector3::new(0.3, -0.7, 0.2),
        ..Pose::turn(Unit::new_normalize(Vector3::new(-0.4, 0.9, 0.6)), 2.1)
    };
    for (joint, model, speeds) in kinds() {
        let here = Hung::new(joint, Some(clearance(model, CLEARANCE)), speeds);
        let there = Hung { place, ..here.clone() };
        let ((_, one), (_, two)) = (here.run(0.06), there.run(0.06));
        let coordinates = one.rows.iter().zip(&two.rows).flat_map(|(a, b)| a.q.iter().zip(&b.q));
        let worst = coordinates.fold(contacts_apart(&one, &two), |worst, (a, b)| worst.max((a - b).abs()));
        assert!(worst < 1e-9, "{joint:?}, {model:?}: {worst:e}");
    }
}

#[test]
fn small_clearance_is_the_ideal_joint() {
    for (joint, model, speeds) in kinds() {
        let ideal = match joint {
            Joint::Spherical => vec![("J.x", 2.0), ("J.z", -3.0)],
            _ => speeds.to_vec(),
        };
        let ideal = Hung::new(joint, None, &ideal).run(0.05);
        let error = |size: f64| {
            // A bearing as long as the rod, that tilts shall count no more than the rest.
            let model = match model {
                ClearanceModel::Spatial { .. } => ClearanceModel::Spatial { length: 0.3 },
                other => other,
            };
            // So stiff that it is the clearance that counts.
            let mut clearance = dead(clearance(model, size), 1e11);
            clearance.friction = None;
            let run = Hung::new(joint, Some(clearance), speeds).run(0.05);
            apart(&run, &ideal)
        };
        for size in [1e-3, 1e-4, 1e-5] {
            let share = error(size) / size;
            assert!((0.3..20.0).contains(&share), "{joint:?}, {model:?}, {size:e}: {share}");
        }
    }
}
