//! The four structures of the second paper - open and closed, serial and tree - with several loops and redundant ones: energy is kept, and all formulations
//! say the same of accelerations, multipliers and reactions along the way.

use linkdyn_dynamics::Formulation;
use linkdyn_integrators::Dop853;
use linkdyn_mechanisms::analysis::mobility;
use linkdyn_mechanisms::{Observation, Simulation, State, file};
use linkdyn_tests::numbers::difference;
use linkdyn_tests::scenes::{prepare, simulate};

/// Runs a scene file and checks it all; `loops` are its cut joints, `redundant` their redundant equations.
fn check(name: &str, text: &str, serial: bool, loops: usize, redundant: usize) {
    let mut scene = file::scene(name, text).expect("sound");
    let outline = scene.linkage.outline();
    let ready = prepare(scene.clone());
    assert_eq!(ready.mechanism.loop_names().count(), loops, "{outline}");
    // In a serial linkage, open or closed, no link has more than two joints.
    let joints = scene.linkage.skeleton(&ready.mechanism, &ready.start.q).joints;
    let joints_of = |link: &Option<usize>| joints.iter().filter(|joint| joint.links.contains(link)).count();
    let most = joints.iter().flat_map(|joint| &joint.links).map(joints_of).max();
    assert_eq!(most <= Some(2), serial, "{outline}");
    let found = mobility(&ready.mechanism, &ready.start.q).expect("closed");
    assert_eq!(found.redundant.len(), redundant, "{name}: {:?}", found.redundant);

    let run = simulate(&ready, Dop853::default(), 1e-11, 0.3, 0.05);
    run.end.expect("runs to the end");
    let first = run.rows[0].energy_balance();
    let size = |o: &Observation| o.energy.kinetic.abs().max(1.0);
    for row in &run.rows {
        assert!(
            (row.energy_balance() - first).abs() < 1e-8 * size(row),
            "{name} at {}: energy",
            row.t
        );
    }
    let others = [
        Formulation::CompositeBody,
        Formulation::ArticulatedBody,
        Formulation::LocalLoops,
        Formulation::Lagrange,
    ];
    for formulation in others {
        scene.linkage.formulation = formulation;
        let mechanism = scene.linkage.build().expect("sound");
        let mut simulation = Simulation::new(&mechanism);
        let mut other = Observation::default();
        for row in &run.rows {
            let state = State {
                q: row.q.clone(),
                v: row.v.clone(),
            };
            let y = simulation.state_vector(&state);
            simulation.observe(row.t, &y, &mut other).expect("moves");
            let at = format!("{name}, {formulation:?}, t = {}", row.t);
            // Against gravity's acceleration, or a newton, where all is still.
            let gap = |one: &[f64], other: &[f64], unit: f64| {
                difference(&[one, &[unit]].concat(), &[other, &[unit]].concat())
            };
            let accelerations = gap(&row.a, &other.a, 10.0);
            assert!(accelerations < 1e-9, "{at}: accelerations {accelerations:e}");
            let multipliers = gap(&row.multipliers, &other.multipliers, 1.0);
            assert!(multipliers < 1e-8, "{at}: multipliers {multipliers:e}");
            let flat = |o: &Observation| -> Vec<f64> {
                let both = o
                    .reactions
                    .iter()
                    .flat_map(|one| one.force.iter().chain(&one.torque).copied());
                both.collect()
            };
            let reactions = gap(&flat(row), &flat(&other), 1.0);
            assert!(reactions < 1e-8, "{at}: reactions {reactions:e}");
        }
    }
}

const OPEN_SERIAL: &str = r#"
format = 1
[links]
one = { cylinder = { density = 7850, diameter = 0.02, along = [0.3, 0, 0] } }
two = { cylinder = { density = 7850, diameter = 0.02, along = [0.4, 0, 0] } }
three = { cylinder = { density = 7850, diameter = 0.02, along = [0.2, 0, 0] } }
[joints.A]
kind = "revolute"
axis = [0, 1, 0]
successor = { link = "one" }
drives = [{ harmonic = { amplitude = 1.0, frequency = 2.0 } }]
[joints.B]
kind = "universal"
predecessor = { link = "one", point = [0.3, 0, 0] }
successor = { link = "two" }
springs = [{ stiffness = 3.0, damping = 0.1 }, { stiffness = 2.0 }]
[joints.C]
kind = "spherical"
predecessor = { link = "two", point = [0.4, 0, 0] }
successor = { link = "three" }
[start]
positions = { A = 0.3 }
speeds = { A = 2.0, "B.theta" = 1.0 }
"#;

const OPEN_TREE: &str = r#"
format = 1
[links]
body = { box = { density = 1000, size = [0.3, 0.2, 0.1] } }
arm = { cylinder = { density = 7850, diameter = 0.02, along = [0.4, 0, 0] } }
leg = { cylinder = { density = 7850, diameter = 0.02, along = [0, 0, -0.3] } }
foot = { cylinder = { density = 7850, diameter = 0.02, along = [0.1, 0, 0] } }
nut = { cylinder = { density = 7850, diameter = 0.05, along = [0, 0, 0.02] } }
[joints.A]
kind = "planar"
successor = { link = "body" }
[joints.B]
kind = "revolute"
predecessor = { link = "body", point = [0.15, 0, 0] }
successor = { link = "arm" }
axis = [0, 1, 0]
[joints.C]
kind = "cylindrical"
predecessor = { link = "body", point = [-0.15, 0, 0] }
successor = { link = "leg" }
springs = [{ stiffness = 400.0, damping = 1.0 }, { stiffness = 2.0 }]
[joints.D]
kind = "prismatic"
predecessor = { link = "leg", point = [0, 0, -0.3] }
successor = { link = "foot" }
axis = [1, 0, 0]
springs = [{ stiffness = 300.0 }]
[joints.E]
kind = "screw"
lead = 0.05
predecessor = { link = "arm", point = [0.4, 0, 0] }
successor = { link = "nut" }
[start]
speeds = { "A.psi" = 3.0, B = 1.0, "A.x" = 0.5, E = 5.0 }
"#;

#[test]
fn an_open_serial_linkage() {
    check("open serial", OPEN_SERIAL, true, 0, 0);
}

#[test]
fn an_open_tree() {
    check("open tree", OPEN_TREE, false, 0, 0);
}

macro_rules! example {
    ($name:literal) => {
        include_str!(concat!("../../crates/mechanisms/scenes/", $name, ".toml"))
    };
}

#[test]
fn closed_serial_linkages_one_of_which_has_redundant_equations() {
    check("rsrrr", example!("rsrrr"), true, 1, 0);
    check("bennett", example!("bennett"), true, 1, 3);
    check("four-bar", example!("four_bar"), true, 1, 1);
}

#[test]
fn closed_trees_with_several_loops_and_with_redundant_ones() {
    check("squeezer", example!("andrews_squeezer"), false, 3, 3);
    check("governor", example!("flyball_governor"), false, 2, 2);
    check("platform", example!("stewart_platform"), false, 6, 0);
    check("four-bars in a row", example!("n_four_bar"), false, 2, 6);
}
