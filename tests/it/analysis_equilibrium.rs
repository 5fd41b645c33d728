//! Static equilibria against closed forms, minima of potential energy, and beam theory.

use linkdyn_integrators::Radau5;
use linkdyn_kinematics::{Joint, Pose, Positions};
use linkdyn_mechanisms::analysis::equilibrium::{Seek, Settings, Stability, settled};
use linkdyn_mechanisms::analysis::positions::Sweep;
use linkdyn_mechanisms::analysis::{AnalysisError, equilibrium, positions};
use linkdyn_mechanisms::catalogue::{Rsup, rsup};
use linkdyn_mechanisms::{Drive, Linkage, Mechanism, Mount, PrescribedMotion, Spring, Start, State};
use linkdyn_tests::linkages::{Cantilever, FourBar, bricard, cantilever, hanging};
use linkdyn_tests::scenes::{Ready, simulate};
use std::f64::consts::PI;

const NEAREST: Settings = Settings {
    seek: Seek::Nearest,
    time: 0.0,
    held: Vec::new(),
    iterations: 100,
};

#[test]
fn a_pendulum_hangs_or_stands() {
    let (length, mass) = (0.7, 2.0);
    let mechanism = hanging(&[(length, mass)]).build().expect("valid");
    let square = 9.81 / length;
    for start in [-3.0, -0.1, 0.0, 1.0, 2.0, 3.1] {
        let found = equilibrium(&mechanism, &[start], &Settings::default()).expect("hangs");
        assert!(found.q[0].abs() < 1e-11, "{start}: {found:?}");
        assert!(found.stability == Stability::Stable && (found.lowest / square - 1.0).abs() < 1e-9);
        assert!((found.stiffness[(0, 0)] - mass * 9.81 * length).abs() < 1e-8);
    }
    let found = equilibrium(&mechanism, &[2.9], &NEAREST).expect("stands");
    assert!((found.q[0] - PI).abs() < 1e-11 && found.stability == Stability::Unstable);
    assert!((found.lowest / square + 1.0).abs() < 1e-9);
    // Put upright exactly, it falls if a stable position is wanted.
    let found = equilibrium(&mechanism, &[PI], &Settings::default()).expect("falls");
    assert!(
        found.q[0]
            .rem_euclid(2.0 * PI)
            .min(2.0 * PI - found.q[0].rem_euclid(2.0 * PI))
            < 1e-11
    );
}

#[test]
fn a_torque_holds_a_pendulum_aside_until_it_is_too_large() {
    let holding = |torque: f64| {
        let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
        let inertia = linkdyn_dynamics::RigidInertia::solid_cylinder(7850.0, 0.02, 1.0, &-nalgebra::Vector3::y());
        let link = linkage.link("bar", inertia);
        let joint = linkage.joint(
            "a",
            Joint::revolute_z(),
            Mount::at_origin(Linkage::GROUND),
            Mount::at_origin(link),
        );
        linkage.drive(
            joint,
            Drive::Ramp {
                torque: inertia.mass * 9.81 * 0.5 * torque,
                rise_time: 2.0,
            },
        );
        linkage.build().expect("valid")
    };
    let at = |torque: f64, time: f64| {
        equilibrium(
            &holding(torque),
            &[0.0],
            &Settings {
                time,
                ..Settings::default()
            },
        )
    };
    assert!((at(0.5, 2.0).expect("held").q[0] - PI / 6.0).abs() < 1e-11);
    // Half of the torque at half of its rise.
    assert!((at(0.5, 1.0).expect("held").q[0] - 0.25_f64.asin()).abs() < 1e-11);
    match at(1.1, 2.0) {
        Err(AnalysisError::NoEquilibrium { coordinate, force, .. }) => assert!(coordinate == "a" && force > 0.0),
        other => panic!("{other:?}"),
    }
}

/// Potential energies on a way round, with the value of the driven coordinate.
fn round(mechanism: &Mechanism, q: &[f64], name: &str, to: f64, parts: usize) -> Vec<(f64, f64)> {
    let path = positions(mechanism, q, &Sweep::new(name, to, parts)).expect("moves");
    let still = vec![0.0; mechanism.system().tree().speeds()];
    let at = mechanism
        .coordinate_names()
        .position(|known| known == name)
        .expect("a coordinate");
    let energy = |q: &[f64]| mechanism.system().energy(0.0, q, &still).total();
    path.rows.iter().map(|row| (row.q[at], energy(&row.q))).collect()
}

/// Derivatives of the potential energy by a driven coordinate at a position: first and second.
fn slopes(mechanism: &Mechanism, q: &[f64], name: &str) -> (f64, f64) {
    let h = 1e-2;
    let at = mechanism
        .coordinate_names()
        .position(|known| known == name)
        .expect("a coordinate");
    let value = |k: f64| round(mechanism, q, name, q[at] + k * h, 1)[1].1;
    let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| {
        if k == 0.0 {
            round(mechanism, q, name, q[at] + h, 1)[0].1
        } else {
            value(k)
        }
    });
    (
        (8.0 * (d - b) - (e - a)) / (12.0 * h),
        (16.0 * (b + d) - 30.0 * c - (a + e)) / (12.0 * h * h),
    )
}

#[test]
fn a_hanging_four_bar_lies_where_its_potential_energy_is_least() {
    for closing in [Joint::revolute_z(), Joint::Spherical] {
        let plane = Pose::turn(nalgebra::Vector3::y_axis(), 0.4);
        let four_bar = FourBar {
            lengths: [0.3, 1.0, 0.9, 1.1],
            plane,
            closing,
        };
        let mechanism = four_bar.linkage().build().expect("valid");
        let start = Start {
            positions: vec![("crank".into(), 0.2), ("coupler".into(), 0.7), ("rocker".into(), 1.6)],
            held: vec!["crank".into()],
            speeds: Vec::new(),
        };
        let q = mechanism.assemble(&start).expect("closes").0.q;
        let way = round(&mechanism, &q, "crank", 0.2 + 2.0 * PI, 720);
        let lowest = way.iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("rows");
        let found = equilibrium(&mechanism, &q, &Settings::default()).expect("hangs");
        let crank = (found.q[0] - lowest.0).rem_euclid(2.0 * PI);
        assert!(
            crank.min(2.0 * PI - crank) < 2.0 * PI / 720.0,
            "{} {}",
            found.q[0],
            lowest.0
        );
        assert_eq!(found.stability, Stability::Stable);
        let (first, second) = slopes(&mechanism, &found.q, "crank");
        assert!(first.abs() < 1e-6 * second, "{first} {second}");
        // The stiffness belongs to the independent coordinate; squares of the ratio of both lead to the crank.
        if found.independent == ["crank"] {
            assert!((found.stiffness[(0, 0)] / second - 1.0).abs() < 1e-6);
        }
        let residual = mechanism
            .system()
            .violation(
                0.0,
                &found.q,
                &[0.0; 3],
                &mut linkdyn_dynamics::Workspace::new(mechanism.system()),
            )
            .0;
        assert!(residual < 1e-13);
    }
}

#[test]
fn bricards_loop_sinks_to_the_least_of_its_energy_in_spite_of_its_redundant_row() {
    let mechanism = bricard();
    let found = equilibrium(&mechanism, &[0.0; 5], &Settings::default()).expect("hangs");
    assert_eq!((found.stability, found.independent.len()), (Stability::Stable, 1));
    let name = &found.independent[0];
    let (first, second) = slopes(&mechanism, &found.q, name);
    assert!(first.abs() < 1e-6 * second, "{first} {second}");
    assert!(
        (found.stiffness[(0, 0)] / second - 1.0).abs() < 1e-6,
        "{} {second}",
        found.stiffness
    );
}

/// The sag of the end of a clamped bar.
fn sag(n: usize, gravity: f64) -> f64 {
    let Cantilever { mechanism, link, .. } = cantilever(n, gravity, 0.0);
    let q = vec![0.0; mechanism.system().tree().coordinates()];
    let found = equilibrium(&mechanism, &q, &Settings::default()).expect("sags");
    let nearest = equilibrium(&mechanism, &q, &NEAREST).expect("sags");
    let apart = found
        .q
        .iter()
        .zip(&nearest.q)
        .fold(0.0, |s, (a, b)| f64::max(s, (a - b).abs()));
    assert!(apart < 1e-11 && found.stability == Stability::Stable, "{apart:e}");
    let mut places = Positions::new(mechanism.system().tree());
    mechanism.system().tree().positions(&found.q, &mut places);
    let last = mechanism.attachment(&format!("b,{n}")).expect("the last element");
    let pose = places.pose(last.link) * last.pose;
    -pose.point(&link.end.pose.origin).z
}

#[test]
fn a_cantilever_sags_as_beam_theory_says() {
    // w L^4/(8 E I); the arc shortens the lever by the square of the slope, 5e-5 at most with a tenth of gravity.
    let theory = 7850.0 * 1e-4 * 0.981 / (8.0 * 2.1e11 * 1e-8 / 12.0);
    let errors: Vec<f64> = [4, 8, 16].map(|n| sag(n, 0.981) / theory - 1.0).into();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.9..2.1).contains(&order), "{errors:?}");
    }
    assert!(errors[2].abs() < 1e-2, "{errors:?}");
    // A hundredfold load bends it far; it sags less than in proportion, and never by more than its length.
    let far = sag(8, 981.0);
    assert!(far < 0.99 && far > 0.3, "{far}");
}

#[test]
fn a_loop_with_a_flexible_coupler_rests() {
    let scene = rsup(&Rsup {
        flexible: Some(3),
        ..Rsup::default()
    })
    .expect("a variant");
    let mechanism = scene.linkage.build().expect("valid");
    let (state, _) = mechanism.assemble(&scene.start).expect("closes");
    let found = equilibrium(&mechanism, &state.q, &Settings::default()).expect("rests");
    let still = vec![0.0; state.v.len()];
    let energy = |q: &[f64]| mechanism.system().energy(0.0, q, &still).total();
    assert!(energy(&found.q) < energy(&state.q));
    // Nothing accelerates from there.
    let mut work = linkdyn_dynamics::Workspace::new(mechanism.system());
    mechanism
        .system()
        .evaluate(0.0, &found.q, &still, &mut work)
        .expect("regular");
    assert!(work.rates().iter().all(|a| a.abs() < 1e-4), "{:?}", work.rates());
    assert!(found.multipliers.iter().any(|l| l.abs() > 0.1));
    assert!(
        found
            .multipliers
            .iter()
            .zip(work.multipliers())
            .all(|(a, b)| (a - b).abs() < 1e-6)
    );
}

/// What rests stays: a run from there with the crank held.
#[test]
fn a_run_that_begins_sagged_stays_where_it_is() {
    let scene = rsup(&Rsup {
        flexible: Some(2),
        ..Rsup::default()
    });
    let mut scene = scene.expect("a variant");
    scene.start.speeds.clear();
    let mechanism = scene.linkage.build().expect("sound");
    let settings = Settings {
        held: vec![scene.crank.clone()],
        ..Settings::default()
    };
    let settled = settled(&mechanism, &scene.start, &settings).expect("there is one");
    let (begin, _) = mechanism.assemble(&scene.start).expect("closes");
    let crank = mechanism
        .coordinate_names()
        .position(|name| name == scene.crank)
        .expect("it is there");
    assert!(settled.q[crank] == begin.q[crank] && settled.v.iter().all(|v| *v == 0.0));
    let gap = settled
        .q
        .iter()
        .zip(&begin.q)
        .fold(0.0, |s, (a, b)| f64::max(s, (a - b).abs()));
    assert!(gap > 1e-7, "{gap:e}");
    let joint = scene.linkage.joint_named("J11").expect("that of the crank");
    let motion = PrescribedMotion::Polynomial {
        coefficients: vec![settled.q[crank]],
    };
    scene.linkage.prescribe(joint, motion);
    let mechanism = scene.linkage.build().expect("sound");
    let (sagged, straight) = (settled.clone(), begin);
    let moved = |start: State| {
        let (scene, mechanism) = (scene.clone(), mechanism.clone());
        let run = simulate(
            &Ready {
                scene,
                mechanism,
                start: start.clone(),
            },
            Radau5::default(),
            1e-8,
            0.02,
            0.005,
        );
        run.end.expect("runs to the end");
        let gaps = run.rows.iter().flat_map(|row| {
            row.q
                .iter()
                .zip(&start.q)
                .map(|(a, b)| (a - b).abs())
                .collect::<Vec<_>>()
        });
        gaps.fold(0.0, f64::max)
    };
    let (rest, swing) = (moved(sagged), moved(straight));
    assert!(rest < 1e-4 * swing && swing > 1e-7, "{rest:e} {swing:e}");
}

#[test]
fn what_nothing_pushes_is_indifferent_and_what_cannot_move_is_refused() {
    let mut linkage = Linkage::new([0.0; 3]);
    let rod = linkdyn_dynamics::RigidInertia::solid_cylinder(7850.0, 0.02, 1.0, &nalgebra::Vector3::x());
    let link = linkage.link("free", rod);
    let joint = linkage.joint(
        "a",
        Joint::revolute_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link),
    );
    let free = equilibrium(&linkage.build().expect("valid"), &[0.3], &Settings::default()).expect("rests anywhere");
    assert!(free.q == [0.3] && free.stability == Stability::Indifferent && free.iterations == 0);
    linkage.springs(
        joint,
        &[Spring {
            stiffness: 3.0,
            damping: 0.1,
            ..Spring::default()
        }],
    );
    let sprung = equilibrium(&linkage.build().expect("valid"), &[0.3], &Settings::default()).expect("rests");
    assert!(sprung.q[0].abs() < 1e-12 && (sprung.stiffness[(0, 0)] - 3.0).abs() < 1e-10);
    linkage.cut(
        "lock",
        Joint::Fixed,
        Mount::at_origin(link),
        Mount::at_origin(Linkage::GROUND),
    );
    let locked = equilibrium(&linkage.build().expect("valid"), &[0.0], &Settings::default());
    assert!(matches!(locked, Err(AnalysisError::NoFreedom)), "{locked:?}");
}
