//! Inverse dynamics gives back what forward dynamics was driven with: torque, reactions, multipliers, friction.

use linkdyn_dynamics::{Instant, MotionTerms, RigidInertia, Workspace};
use linkdyn_friction::{Exponential, JournalBearing, Surface};
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::analysis::inverse_dynamics::Prescribed;
use linkdyn_mechanisms::analysis::positions::{Driven, Sweep};
use linkdyn_mechanisms::analysis::{AnalysisError, inverse_dynamics, mobility, positions};
use linkdyn_mechanisms::catalogue::{Rsrrr, Rsup, rsrrr, rsup};
use linkdyn_mechanisms::{Linkage, Mount, Observation, Simulation, Start, State};
use linkdyn_tests::linkages::{FourBar, hanging};
use linkdyn_tests::loads::Applied;
use linkdyn_tests::numbers::difference;
use linkdyn_tests::strategies;
use nalgebra::{DMatrix, Vector3};
use proptest::prelude::*;

fn prescribed(names: &[String], v: &[f64], a: &[f64]) -> Vec<Prescribed> {
    let motion = names.iter().zip(v.iter().zip(a));
    motion
        .map(|(name, (speed, acceleration))| Prescribed {
            coordinate: name.clone(),
            speed: *speed,
            acceleration: *acceleration,
        })
        .collect()
}

/// What is observed at a state.
fn observe(linkage: &Linkage, t: f64, state: &State) -> Option<Observation> {
    let mut simulation = Simulation::new(&linkage.build().expect("valid"));
    let mut seen = Observation::default();
    let y = simulation.state_vector(state);
    simulation.observe(t, &y, &mut seen).ok()?;
    Some(seen)
}

proptest! {
    #![proptest_config(strategies::cases(150))]

    #[test]
    fn drives_of_random_mechanisms_come_back(
        blueprint in prop_oneof![strategies::tree(1..=5), strategies::closed(3..=6, 1..=1), strategies::closed(4..=8, 2..=2)],
        forces in prop::collection::vec(strategies::number(5.0), 40),
        speeds in prop::collection::vec(strategies::number(2.0), 40),
    ) {
        let (linkage, coordinates) = blueprint.linkage();
        let Ok(mechanism) = linkage.build() else { return Err(TestCaseError::reject("a joint without freedom only")) };
        let place = |name: &str| mechanism.coordinate_names().position(|known| known == name).expect("its own");
        let mut q = vec![0.0; coordinates.len()];
        coordinates.iter().for_each(|(name, value)| q[place(name)] = *value);
        let found = mobility(&mechanism, &q).expect("closed as drawn");
        prop_assume!(found.weakest > 1e-3 && found.rest < 1e-12 && found.freedoms > 0);
        // Speeds of ball joints with quaternions are no coordinates.
        prop_assume!(found.independent.iter().all(|name| mechanism.coordinate_names().any(|known| known == name)));
        let index: Vec<usize> = found.independent.iter().map(|name| place(name)).collect();
        prop_assume!(mechanism.system().tree().coordinates() == mechanism.system().tree().speeds());
        let rest = prescribed(&found.independent, &speeds, &vec![0.0; found.freedoms]);
        let v = inverse_dynamics(&mechanism, 0.0, &q, &rest).expect("determined").v;
        prop_assume!(v.iter().all(|v| v.abs() < 100.0));

        let n = v.len();
        let (mut work, mut terms) = (Workspace::new(mechanism.system()), MotionTerms::new(mechanism.system()));
        mechanism.system().write_terms(&Instant::new(0.0, &q, &v), &mut work, &mut terms).expect("no loads");
        let masses = DMatrix::from_row_slice(n, n, &terms.mass).symmetric_eigenvalues();
        // Rounding of forward dynamics grows by the condition of the mass matrix, and by the square of that of the loops.
        prop_assume!(masses.min() > 0.0 && masses.max() / masses.min() / found.weakest.powi(2) < 1e5);

        let mut drives = vec![0.0; n];
        index.iter().zip(&forces).for_each(|(k, force)| drives[*k] = *force);
        let mut driven = linkage.clone();
        driven.load(Applied { drives, wrenches: Vec::new() });
        let Some(forward) = observe(&driven, 0.0, &State { q: q.clone(), v }) else {
            return Err(TestCaseError::reject("a freedom without mass"))
        };
        let a: Vec<f64> = index.iter().map(|k| forward.a[*k]).collect();
        prop_assume!(forward.a.iter().all(|a| a.abs() < 1e4));
        let back = inverse_dynamics(&mechanism, 0.0, &q, &prescribed(&found.independent, &speeds, &a)).expect("determined");
        let size = 1.0 + forward.a.iter().fold(0.0, |s, a| f64::max(s, a.abs()));
        for (drive, force) in back.drives.iter().zip(&forces) {
            prop_assert!((drive - force).abs() < 1e-10 * size, "{drive} instead of {force}, accelerations {size}");
        }
        prop_assert!(difference(&back.v, &forward.v) < 1e-10);
        let gap = back.a.iter().zip(&forward.a).fold(0.0, |s, (a, b)| f64::max(s, (a - b).abs()));
        prop_assert!(gap < 1e-10 * size);
        let gap = back.multipliers.iter().zip(&forward.multipliers).fold(0.0, |s, (a, b)| f64::max(s, (a - b).abs()));
        prop_assert!(gap < 1e-8 * size, "{gap:e}");
        for (one, other) in back.reactions.iter().zip(&forward.reactions) {
            let gap = (one.force - other.force).amax().max((one.torque - other.torque).amax());
            prop_assert!(gap < 1e-8 * size, "{gap:e}");
        }
    }
}

#[test]
fn rsrrr_with_friction_gives_back_its_drive() {
    for (scale, speed) in [(1.0, 4.0), (1.0, -3.0), (0.5, 0.01), (0.0, 2.0)] {
        let scene = rsrrr(&Rsrrr {
            friction: true,
            friction_scale: scale,
        });
        let mechanism = scene.linkage.build().expect("valid");
        let mut start = scene.start.clone();
        // Off the start, where two joints stand still.
        start.positions[0].1 += 0.3;
        start.speeds = vec![("psi11".into(), speed)];
        let (state, _) = mechanism.assemble(&start).expect("closes");
        for torque in [0.0, 7.5, -20.0] {
            let mut driven = scene.linkage.clone();
            driven.load(Applied {
                drives: vec![torque, 0.0, 0.0, 0.0],
                wrenches: Vec::new(),
            });
            let forward = observe(&driven, 1.0, &state).expect("moves");
            let names = ["psi11".to_owned()];
            let back =
                inverse_dynamics(&mechanism, 1.0, &state.q, &prescribed(&names, &[speed], &forward.a)).expect("moves");
            assert!(
                (back.drives[0] - torque).abs() < 1e-10 * 20.0,
                "{} instead of {torque}",
                back.drives[0]
            );
            assert!((back.power - back.drives[0] * speed).abs() < 1e-12 * (1.0 + back.power.abs()));
            assert!(difference(&back.friction, &forward.friction) < 1e-9 || scale == 0.0);
            assert!(
                scale == 0.0 || forward.friction.iter().all(|f| f.abs() > 1e-6),
                "{:?}",
                forward.friction
            );
            assert!(difference(&back.multipliers, &forward.multipliers) < 1e-10);
            for (one, other) in back.reactions.iter().zip(&forward.reactions) {
                assert!((one.force - other.force).amax() < 1e-9 && (one.torque - other.torque).amax() < 1e-9);
            }
        }
    }
}

#[test]
fn friction_in_a_loop_with_redundant_rows_comes_back_too() {
    let surface = |diameter| Surface {
        diameter,
        coefficient: 0.2,
    };
    let bearing = JournalBearing {
        spacing: 0.05,
        surface_a: surface(0.02),
        surface_b: surface(0.02),
        face: surface(0.03),
    };
    let law = Exponential {
        reference_speed: 0.01,
        steepness: 3.0,
    };
    let rod = |length| RigidInertia::solid_cylinder(7850.0, 0.02, length, &Vector3::x());
    let mut linkage = Linkage::new([3.0, -7.0, 5.0]);
    let [crank, coupler, rocker] =
        [("crank", 0.3), ("coupler", 1.0), ("rocker", 0.9)].map(|(name, length)| linkage.link(name, rod(length)));
    let z = Joint::revolute_z();
    let bases = [
        Mount::at_origin(Linkage::GROUND),
        Mount::at(crank, [0.3, 0.0, 0.0]),
        Mount::at(Linkage::GROUND, [1.1, 0.0, 0.0]),
    ];
    for ((name, base), link) in ["crank", "coupler", "rocker"]
        .into_iter()
        .zip(bases)
        .zip([crank, coupler, rocker])
    {
        let joint = linkage.joint(name, z, base, Mount::at_origin(link));
        linkage.friction(joint, law, bearing);
    }
    let (one, other) = (Mount::at(coupler, [1.0, 0.0, 0.0]), Mount::at(rocker, [0.9, 0.0, 0.0]));
    linkage.cut("pin", z, one, other);
    let mechanism = linkage.build().expect("valid");
    for (angle, speed, torque) in [(0.2, 3.0, 5.0), (2.0, -4.0, 1.0), (4.5, 1.0, -8.0)] {
        let start = Start {
            positions: vec![
                ("crank".into(), angle),
                ("coupler".into(), 0.9 - angle),
                ("rocker".into(), 1.6),
            ],
            held: vec!["crank".into()],
            speeds: vec![("crank".into(), speed)],
        };
        let (state, _) = mechanism.assemble(&start).expect("closes");
        let mut driven = linkage.clone();
        driven.load(Applied {
            drives: vec![torque, 0.0, 0.0],
            wrenches: Vec::new(),
        });
        let forward = observe(&driven, 0.0, &state).expect("moves");
        assert!(
            forward.friction.iter().all(|f| f.abs() > 1e-3),
            "{:?}",
            forward.friction
        );
        let names = ["crank".to_owned()];
        let motion = prescribed(&names, &[speed], &forward.a);
        let back = inverse_dynamics(&mechanism, 0.0, &state.q, &motion).expect("moves");
        assert!(
            (back.drives[0] - torque).abs() < 1e-10 * 10.0,
            "{} instead of {torque}",
            back.drives[0]
        );
        assert!(difference(&back.friction, &forward.friction) < 1e-10);
        assert!(difference(&back.multipliers, &forward.multipliers) < 1e-10);
    }
}

#[test]
fn power_of_the_drive_is_the_rate_of_energy() {
    let plane = Pose::turn(nalgebra::Vector3::x_axis(), 0.7);
    let four_bar = FourBar {
        lengths: [0.3, 1.0, 0.9, 1.1],
        plane,
        closing: Joint::revolute_z(),
    };
    let mechanism = four_bar.linkage().build().expect("valid");
    let start = Start {
        positions: vec![("crank".into(), 0.2), ("coupler".into(), 0.7), ("rocker".into(), 1.6)],
        held: vec!["crank".into()],
        speeds: Vec::new(),
    };
    let (state, _) = mechanism.assemble(&start).expect("closes");
    let (speed, parts) = (3.0, 600);
    let to = 0.2 + 2.0 * std::f64::consts::PI;
    let driven = vec![Driven {
        coordinate: "crank".into(),
        to,
        speed,
        acceleration: 0.0,
    }];
    let path = positions(
        &mechanism,
        &state.q,
        &Sweep {
            driven,
            parts,
            largest_step: 0.1,
        },
    )
    .expect("turns fully");
    let energy = |k: usize| mechanism.system().energy(0.0, &path.rows[k].q, &path.rows[k].v).total();
    let time = (to - 0.2) / speed / parts as f64;
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    for k in 2..parts - 1 {
        let rate = (8.0 * (energy(k + 1) - energy(k - 1)) - (energy(k + 2) - energy(k - 2))) / (12.0 * time);
        let names = ["crank".to_owned()];
        let needs =
            inverse_dynamics(&mechanism, 0.0, &path.rows[k].q, &prescribed(&names, &[speed], &[0.0])).expect("moves");
        worst = worst.max((needs.power - rate).abs());
        most = most.max(rate.abs());
    }
    // Fourth order in steps of 0.01 rad.
    assert!(worst < 1e-6 * most, "{worst:e} of {most:e}");
}

#[test]
fn a_pendulum_needs_its_weight_and_its_inertia() {
    let mechanism = hanging(&[(0.7, 2.0)]).build().expect("valid");
    let names = ["a0".to_owned()];
    let needs = inverse_dynamics(&mechanism, 0.0, &[0.4], &prescribed(&names, &[1.5], &[3.0])).expect("moves");
    let torque = 2.0 * 0.7 * 0.7 * 3.0 + 2.0 * 9.81 * 0.7 * 0.4_f64.sin();
    assert!((needs.drives[0] - torque).abs() < 1e-13);
    // The bar is pulled by weight and centrifugal force.
    let along = 2.0 * (9.81 * 0.4_f64.cos() + 0.7 * 1.5 * 1.5);
    assert!(
        (needs.reactions[0].force.y - along).abs() < 1e-13,
        "{:?}",
        needs.reactions
    );
}

#[test]
fn motions_that_are_not_determined_are_refused() {
    let mechanism = hanging(&[(1.0, 1.0), (1.0, 1.0)]).build().expect("valid");
    let one = |name: &str, speed: f64| prescribed(&[name.to_owned()], &[speed], &[0.0]);
    let ask = |prescribed: &[Prescribed]| inverse_dynamics(&mechanism, 0.0, &[0.0, 0.0], prescribed);
    assert!(matches!(ask(&one("a0", 1.0)), Err(AnalysisError::Undetermined { .. })));
    assert!(matches!(ask(&one("a7", 1.0)), Err(AnalysisError::Start(_))));
    assert!(matches!(
        ask(&one("a0", f64::INFINITY)),
        Err(AnalysisError::Number { .. })
    ));
    assert!(matches!(ask(&[]), Err(AnalysisError::Number { .. })));
    let scene = rsup(&Rsup {
        clearance: Some(linkdyn_mechanisms::catalogue::ClearanceKind::Planar),
        ..Rsup::default()
    });
    let scene = scene.expect("a variant");
    let loose = scene.linkage.build().expect("valid");
    let (state, _) = loose.assemble(&scene.start).expect("closes");
    match inverse_dynamics(&loose, 0.0, &state.q, &one("psi11", 1.0)) {
        Err(AnalysisError::Internals { what }) => assert_eq!(what, "joint `R` has clearance"),
        other => panic!("{other:?}"),
    }
}
