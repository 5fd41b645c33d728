//! Drives against closed forms, and tables against what their splines promise.

use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::dynamics::RigidInertia;
use linkdyn_mechanisms::integrators::{Dop853, Integration, Settings};
use linkdyn_mechanisms::{BuildError, Drive, Linkage, Mechanism, Mount, Simulation, Spline, Start, run};
use nalgebra::{Matrix3, Vector3};
use std::ops::ControlFlow;

const MASS: f64 = 2.0;

/// A mass on a rail, pushed.
fn slider(drive: Drive) -> Result<Mechanism, BuildError> {
    let mut m = Linkage::new([0.0; 3]);
    let mass = m.link(
        "mass",
        RigidInertia {
            mass: MASS,
            com: Vector3::zeros(),
            about_com: Matrix3::identity(),
        },
    );
    let rail = m.joint(
        "rail",
        Joint::prismatic_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(mass),
    );
    m.drive(rail, drive);
    m.build()
}

/// Way and speed after `until` seconds.
fn after(drive: Drive, speed: f64, until: f64) -> (f64, f64) {
    let mechanism = slider(drive).expect("sound");
    let (mut state, _) = mechanism.assemble(&Start::default()).expect("nothing to close");
    state.v[0] = speed;
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&state);
    let settings = Settings::tolerances(1e-12, 1e-12);
    let steps = Integration::new(simulation, Dop853::default(), 0.0, &y, settings);
    let stops = mechanism.system().stop_times();
    let mut steps = steps
        .and_then(|steps| steps.with_stops(&stops))
        .expect("a sound problem");
    let mut end = (f64::NAN, f64::NAN);
    run(&mut steps, until, until, |now| {
        end = (now.q[0], now.v[0]);
        ControlFlow::Continue(())
    })
    .expect("runs to the end");
    end
}

fn near(found: f64, right: f64) {
    assert!(
        (found - right).abs() < 1e-10 * right.abs().max(1.0),
        "{found} for {right}"
    );
}

#[test]
fn harmonic_force_moves_a_mass_by_its_integrals() {
    let (amplitude, frequency, phase, t) = (3.0, 0.7, 0.4, 1.3);
    let (x, v) = after(
        Drive::Harmonic {
            amplitude,
            frequency,
            phase,
        },
        0.0,
        t,
    );
    let w = std::f64::consts::TAU * frequency;
    near(v, amplitude / (MASS * w) * (phase.cos() - (w * t + phase).cos()));
    let way = phase.cos() * t - ((w * t + phase).sin() - phase.sin()) / w;
    near(x, amplitude / (MASS * w) * way);
}

#[test]
fn quadratic_resistance_slows_by_the_closed_form_in_both_directions() {
    let (torque, reference_speed, t) = (5.0, 2.0, 0.8);
    for start in [3.0, -3.0_f64] {
        let (x, v) = after(
            Drive::QuadraticResistance {
                torque,
                reference_speed,
            },
            start,
            t,
        );
        let c = torque / (MASS * reference_speed * reference_speed);
        let k = 1.0 + c * start.abs() * t;
        near(v, start / k);
        near(x, start.signum() * k.ln() / c);
    }
}

#[test]
fn a_table_pushes_by_the_integral_of_its_spline() {
    // Three nodes of a triangle: the natural spline is 1 - 1.5 s^2 + 0.5 s^3 to either side of the tip.
    let spline = Spline::natural(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)]);
    let (_, v) = after(Drive::Table { spline }, 0.0, 3.0);
    near(v, 2.0 * (1.0 - 0.5 + 0.125) / MASS);
}

#[test]
fn natural_splines_have_two_derivatives_and_monotone_ones_no_new_extrema() {
    let nodes = [(0.0, 1.0), (0.4, 1.2), (1.0, 3.0), (1.1, 3.1), (2.0, 0.5), (3.0, 0.5)];
    let (natural, monotone) = (Spline::natural(&nodes), Spline::monotone(&nodes));
    for spline in [&natural, &monotone] {
        for (x, y) in nodes {
            assert!((spline.value(x) - y).abs() < 1e-14);
        }
        assert_eq!((spline.value(-1.0), spline.value(9.0)), (1.0, 0.5));
        assert!(spline.value(f64::NAN).is_nan());
    }
    // Cubics are told exactly by differences to one side: the second derivative at a node, from the left and from the right.
    let second = |x: f64, h: f64| {
        let f = |k: f64| natural.value(x + k * h);
        (2.0 * f(0.0) - 5.0 * f(1.0) + 4.0 * f(2.0) - f(3.0)) / (h * h)
    };
    let h = 0.01;
    for (x, _) in &nodes[1..5] {
        assert!((second(*x, h) - second(*x, -h)).abs() < 1e-9);
    }
    assert!(second(0.0, h).abs() < 1e-9 && second(3.0, -h).abs() < 1e-9);
    for pair in nodes.windows(2) {
        let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
        for k in 0..=50 {
            let y = monotone.value(pair[0].0 + (pair[1].0 - pair[0].0) * f64::from(k) / 50.0);
            assert!(y >= low - 1e-14 && y <= high + 1e-14, "{y} not in {low} to {high}");
        }
    }
    assert_eq!(natural.kinks(), nodes.map(|node| node.0));
}

#[test]
fn parameters_out_of_range_are_told_by_name() {
    let harmonic = |amplitude, frequency, phase| Drive::Harmonic {
        amplitude,
        frequency,
        phase,
    };
    let table = |nodes: &[(f64, f64)]| Drive::Table {
        spline: Spline::natural(nodes),
    };
    let cases = [
        (harmonic(f64::NAN, 1.0, 0.0), "amplitude"),
        (harmonic(1.0, -1.0, 0.0), "frequency"),
        (harmonic(1.0, 1.0, f64::INFINITY), "phase"),
        (
            Drive::QuadraticResistance {
                torque: f64::NAN,
                reference_speed: 1.0,
            },
            "torque",
        ),
        (
            Drive::QuadraticResistance {
                torque: 1.0,
                reference_speed: 0.0,
            },
            "reference_speed",
        ),
        (table(&[(0.0, 1.0)]), "nodes"),
        (table(&[]), "nodes"),
        (table(&[(0.0, 1.0), (0.0, 2.0)]), "node"),
        (table(&[(0.0, 1.0), (f64::NAN, 2.0)]), "node"),
        (table(&[(0.0, 1.0), (1.0, f64::INFINITY)]), "value"),
    ];
    for (drive, name) in cases {
        let told = format!("{drive:?}");
        match slider(drive) {
            Err(BuildError::Parameter { parameter, .. }) => assert_eq!(parameter, name, "{told}"),
            other => panic!("{told}: {other:?}"),
        }
    }
}
