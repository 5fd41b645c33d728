//! Bricard's mechanism from its scene file (benchmark 08-bricard): the curve and the energy in closed form, and every joint as the cut.

use linkdyn_integrators::Adams;
use linkdyn_mechanisms::analysis::mobility;
use linkdyn_mechanisms::{Observation, file};
use linkdyn_tests::scenes::{Ready, index, prepare, simulate};
use nalgebra::{Rotation3, Unit, Vector3};
use std::f64::consts::PI;

const BRICARD: &str = include_str!("../../crates/mechanisms/scenes/bricard.toml");
const JOINTS: [&str; 6] = ["a1", "b1", "a2", "b2", "a3", "b3"];

/// The linkage with the joint of this name cut.
fn cut_at(name: &str) -> Ready {
    let head = format!("[joints.{name}]\n");
    assert!(BRICARD.contains(&head));
    let text = BRICARD.replace(&head, &format!("{head}cut = true\n"));
    prepare(file::scene("file", &text).expect("a sound file"))
}

/// Kinetic and potential energy \[J\] of the five rods at the angle `a` and its rate, by rotations about the published axes one after the
/// other.
fn energies(a: f64, rate: f64) -> [f64; 2] {
    let sin_b = -a.sin() / (1.0 + a.sin());
    let b = sin_b.asin();
    let rate_b = -a.cos() * rate / ((1.0 + a.sin()).powi(2) * b.cos());
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let (mut turn, mut spin) = (Rotation3::identity(), Vector3::zeros());
    let (mut point, mut speed) = (Vector3::zeros(), Vector3::zeros());
    let (mut kinetic, mut potential) = (0.0, 0.0);
    // Moments of a box of 1 kg and 1 x 0.1 x 0.1 m, across and along.
    let (across, along) = (1.01 / 12.0, 0.02 / 12.0);
    for (k, (axis, rod)) in [(y, x), (z, -y), (x, z), (y, -x), (z, y)].into_iter().enumerate() {
        let (angle, rate) = if k % 2 == 0 { (a, rate) } else { (b, rate_b) };
        spin += turn * axis * rate;
        turn *= Rotation3::from_axis_angle(&Unit::new_unchecked(axis), angle);
        let rod = turn * rod;
        let (own, middle) = (spin.dot(&rod), speed + 0.5 * spin.cross(&rod));
        kinetic += 0.5 * (middle.norm_squared() + across * (spin.norm_squared() - own * own) + along * own * own);
        potential += 9.81 * (point.y + 0.5 * rod.y);
        point += rod;
        speed += spin.cross(&rod);
    }
    [kinetic, potential]
}

fn run(scene: &Ready, until: f64) -> Vec<Observation> {
    let run = simulate(scene, Adams::default(), 1e-12, until, 0.05);
    run.end.expect("runs to its end");
    run.rows
}

#[test]
fn benchmark_08_bricard_swings_on_its_curve_and_keeps_its_energy() {
    let scene = cut_at("b3");
    let angles: Vec<usize> = JOINTS[..5].iter().map(|name| index(&scene, name)).collect();
    let rows = run(&scene, 10.0);
    let [_, start] = energies(0.0, 0.0);
    let (mut furthest, mut largest) = (0.0_f64, 0.0_f64);
    for row in &rows {
        let [a, b, a2, b2, a3] = [0, 1, 2, 3, 4].map(|k| row.q[angles[k]]);
        let curve = a.sin() + b.sin() + a.sin() * b.sin();
        assert!(curve.abs() < 1e-11, "t = {}: {a} {b}", row.t);
        for apart in [a - a2, a - a3, b - b2] {
            assert!(apart.abs() < 1e-11, "t = {}: {:?}", row.t, row.q);
        }
        assert!(a > -1e-9 && a < PI + 1e-9, "t = {}: {a}", row.t);
        let [kinetic, potential] = energies(a, row.v[angles[0]]);
        // 4.6 J go to and fro: the limit is 1e-8 of that.
        assert!(
            (kinetic + potential - start).abs() < 4.5e-8,
            "t = {}: {kinetic} {potential}",
            row.t
        );
        assert!(
            (row.energy.total() - rows[0].energy.total()).abs() < 4.5e-8,
            "t = {}",
            row.t
        );
        assert!((row.energy.kinetic - kinetic).abs() < 1e-9, "t = {}", row.t);
        furthest = furthest.max(a);
        largest = largest.max(kinetic);
    }
    assert!(furthest > 0.99 * PI && largest > 4.5, "{furthest} {largest}");
}

#[test]
fn one_equation_is_redundant_all_along_the_curve() {
    let scene = cut_at("b3");
    let [a, b] = ["a1", "b1"].map(|name| index(&scene, name));
    let mut q = scene.start.q.clone();
    for k in -2..=20 {
        // From just above -30 to just below 210 degrees, where the sine of b is 1.
        let angle = f64::from(k) * PI / 18.0;
        let other = (-angle.sin() / (1.0 + angle.sin())).asin();
        for (k, q) in q.iter_mut().enumerate() {
            *q = if k % 2 == a % 2 { angle } else { other };
        }
        assert_eq!((q[a], q[b]), (angle, other));
        let mobility = mobility(&scene.mechanism, &q).expect("a closed position");
        let found = (mobility.freedoms, mobility.counted, mobility.redundant.len());
        assert_eq!(found, (1, 0, 1), "{angle}");
    }
}

#[test]
fn the_motion_is_the_same_wherever_the_loop_is_cut() {
    let frames = |name: &str| -> Vec<_> {
        let scene = cut_at(name);
        let rows = run(&scene, 5.0);
        let place = |row: &Observation| scene.scene.linkage.skeleton(&scene.mechanism, &row.q);
        rows.iter().map(place).collect()
    };
    let first = frames("b3");
    for name in &JOINTS[..5] {
        for (one, two) in first.iter().zip(frames(name)) {
            for (one, two) in one.links.iter().zip(two.links) {
                let apart = (one.frame.origin - two.frame.origin).amax();
                assert!(apart < 1e-8, "cut at {name}: {apart:e}");
                assert!((one.frame.rotation - two.frame.rotation).amax() < 1e-8, "cut at {name}");
            }
        }
    }
}
