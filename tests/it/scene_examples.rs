//! Linkages that people know, from scene files, against closed forms.

use linkdyn_integrators::Adams;
use linkdyn_kinematics::assembly::AssemblyError;
use linkdyn_mechanisms::analysis::mobility;
use linkdyn_mechanisms::{StartError, file};
use linkdyn_tests::numbers::apart;
use linkdyn_tests::scenes::{Ready, index, prepare, simulate};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::f64::consts::PI;

const FOUR_BAR: &str = include_str!("../../crates/mechanisms/scenes/four_bar.toml");
const SLIDER_CRANK: &str = include_str!("../../crates/mechanisms/scenes/slider_crank.toml");
const RSSR: &str = include_str!("../../crates/mechanisms/scenes/rssr.toml");
const BENNETT: &str = include_str!("../../crates/mechanisms/scenes/bennett.toml");
const RSSP: &str = include_str!("../../crates/mechanisms/scenes/rssp.toml");
const STEWART: &str = include_str!("../../crates/mechanisms/scenes/stewart_platform.toml");
const GOVERNOR: &str = include_str!("../../crates/mechanisms/scenes/flyball_governor.toml");

fn ready(text: &str) -> Ready {
    prepare(file::scene("file", text).expect("a sound file"))
}

/// Freudenthal's equation of the bars' lengths, and its rate.
#[test]
fn four_bar_turns_fully_as_freudenthal_says() {
    let scene = ready(FOUR_BAR);
    let (crank, rocker) = (index(&scene, "A"), index(&scene, "D"));
    let run = simulate(&scene, Adams::default(), 1e-10, 1.5, 0.01);
    run.end.expect("runs to its end");
    let (a, b, c, d) = (0.1, 0.35, 0.25, 0.4_f64);
    let (r1, r2, r3) = (d / a, d / c, (a * a - b * b + c * c + d * d) / (2.0 * a * c));
    let mut turned = 0.0_f64;
    for row in run.rows {
        let (theta, phi) = (row.q[crank], row.q[rocker]);
        let residual = r1 * phi.cos() - r2 * theta.cos() + r3 - (theta - phi).cos();
        // On the loop to 1e-12 by projection, with factors up to 4.
        assert!(residual.abs() < 1e-11, "t = {}: {residual:e}", row.t);
        let ratio = (r2 * theta.sin() + (theta - phi).sin()) / (r1 * phi.sin() + (theta - phi).sin());
        assert!((row.v[rocker] - ratio * row.v[crank]).abs() < 1e-9, "t = {}", row.t);
        // Coupler and rocker are never in line: the rocker is on the side on which it started.
        assert!(phi.sin() > 0.0, "t = {}: {phi}", row.t);
        turned = theta;
    }
    // By Grashof the shortest bar turns all the way: 0.1 + 0.4 < 0.35 + 0.25.
    assert!(turned > 2.0 * PI, "{turned}");
}

#[test]
fn slider_crank_moves_as_the_closed_form_says() {
    let scene = ready(SLIDER_CRANK);
    let (crank, slide) = (index(&scene, "A"), index(&scene, "slide"));
    let run = simulate(&scene, Adams::default(), 1e-10, 1.0, 0.01);
    run.end.expect("runs to its end");
    for row in run.rows {
        let (sin, cos) = row.q[crank].sin_cos();
        let rod = (0.09 - 0.01 * sin * sin).sqrt();
        let place = 0.1 * cos + rod;
        let speed = -(0.1 * sin + 0.01 * sin * cos / rod) * row.v[crank];
        // On the loop to 1e-12 by projection.
        assert!((row.q[slide] - place).abs() < 1e-11, "t = {}", row.t);
        assert!((row.v[slide] - speed).abs() < 1e-10, "t = {}", row.t);
    }
}

/// The text with another start: crank angle \[deg\] and rocker angle \[rad\], the rod from pin to pin.
fn rssr_at(text: &str, base: [f64; 3], input: f64, output: f64) -> String {
    let (turn, given) = (
        input.to_radians(),
        "input = \"30 deg\", \"A.psi\" = \"24 deg\", \"A.theta\" = \"-37 deg\", output = \"16 deg\"",
    );
    let x = base[0] - 0.1 * turn.cos();
    let y = base[1] + 0.25 * output.cos() - 0.1 * turn.sin();
    let z = base[2] + 0.25 * output.sin();
    let (psi, theta) = (y.atan2(x) - turn, -z.atan2(x.hypot(y)));
    assert!(text.contains(given));
    // Rounded, so that there is something left to close.
    text.replace(
        given,
        &format!("input = \"{input} deg\", \"A.psi\" = {psi:.2}, \"A.theta\" = {theta:.2}, output = {output:.2}"),
    )
}

#[test]
fn rssr_closes_on_both_published_branches() {
    let published = [
        (0, 0.0, 2.214_297_435_588_18),
        (30, 0.283_361_851_723_81, 2.368_273_475_612_25),
        (60, 0.314_674_583_540_30, 2.693_143_330_669_62),
        (90, 0.100_167_421_161_56, 3.041_425_232_428_23),
        (120, -0.295_152_274_334_36, -2.980_215_118_635_30),
        (180, -1.140_187_826_695_20, -2.928_700_044_896_21),
        (270, -0.999_154_295_869_88, 2.569_950_622_664_78),
        (330, -0.384_937_478_566_85, 2.239_527_914_570_07),
    ];
    for (input, plus, minus) in published {
        for output in [plus, minus] {
            let scene = ready(&rssr_at(RSSR, [0.3, 0.1, 0.2], f64::from(input), output));
            let found = scene.start.q[index(&scene, "output")];
            // Fourteen digits are given; closed to 1e-14 times the condition, some 10.
            assert!(apart(found, output) < 1e-12, "{input} deg: {found} instead of {output}");
            // The crank, and the rod about itself.
            let mobility = mobility(&scene.mechanism, &scene.start.q).expect("a closed position");
            assert_eq!(mobility.freedoms, 2);
        }
    }
}

/// The base at 0.4 m and a rod of 0.5 m: nothing closes between 171.7 and 185.6 degrees of the crank.
const LOCKING_BASE: [f64; 3] = [0.4, 0.1, 0.2];

fn locking() -> String {
    RSSR.replace("[0.45, 0, 0]", "[0.5, 0, 0]")
        .replace("[0.3, 0.1, 0.2]", "[0.4, 0.1, 0.2]")
}

#[test]
fn rssr_that_cannot_reach_is_refused_with_its_gap() {
    let start = |input| {
        // The rocker where it turns back: furthest towards the crank's pin.
        let output = f64::atan2(-LOCKING_BASE[2], -LOCKING_BASE[1]);
        let text = rssr_at(&locking(), LOCKING_BASE, input, output);
        let scene = file::scene("file", &text).expect("a sound file");
        scene.linkage.build().expect("a linkage").assemble(&scene.start)
    };
    assert!(start(171.0).is_ok());
    let refused = start(178.0);
    assert!(
        matches!(&refused, Err(StartError::Assembly(AssemblyError::NotClosed { residual, .. })) if *residual > 1e-6),
        "{refused:?}"
    );
}

#[test]
fn rssr_turns_back_at_its_locking_angle() {
    // Started towards it, and pushed on by the drive.
    let text =
        rssr_at(&locking(), LOCKING_BASE, 120.0, -2.0).replace("[\"input\"]", "[\"input\"]\nspeeds = { input = 4 }");
    let scene = ready(&text);
    let (input, output) = (index(&scene, "input"), index(&scene, "output"));
    let run = simulate(&scene, Adams::default(), 1e-10, 1.0, 0.001);
    run.end.expect("runs to its end");
    // Published.
    let end = 171.663_033_639_726_4_f64.to_radians();
    let first = run.rows[0].energy_balance();
    let (mut furthest, mut back) = (0.0_f64, false);
    for row in &run.rows {
        assert!(row.q[input] < end + 1e-9, "t = {}: {}", row.t, row.q[input]);
        assert!((row.energy_balance() - first).abs() < 1e-8, "t = {}", row.t);
        furthest = furthest.max(row.q[input]);
        back |= furthest > end - 1e-3 && row.q[input] < end - 0.1;
    }
    assert!(back, "{furthest} of {end}");
    // Through its locking position the rocker went on to the other branch.
    let moved = run.rows.last().expect("rows").q[output] - run.rows[0].q[output];
    assert!(moved.abs() > 0.5, "{moved}");
}

#[test]
fn bennett_closes_with_three_redundant_equations() {
    for (theta1, theta2) in [
        (30.0_f64, 171.872_156_54_f64),
        (80.0, 154.913_008_83),
        (140.0, 107.852_824_3),
        (200.0, -67.247_535_2),
    ] {
        let guess = format!(
            "theta1 = \"{theta1} deg\", theta2 = \"{theta2:.0} deg\", theta3 = \"{} deg\"",
            -theta1
        );
        let given = "theta1 = \"80 deg\", theta2 = \"155 deg\", theta3 = \"-80 deg\"";
        let scene = ready(&BENNETT.replace(given, &guess));
        let q = |name| scene.start.q[index(&scene, name)];
        // Ten digits are given.
        assert!(
            apart(q("theta2"), theta2.to_radians()) < 1e-9,
            "{theta1}: {}",
            q("theta2")
        );
        // The law of the twists, and opposite angles alike. Directions enter the residual by their sines, closed to 1e-14.
        let product = (0.5 * q("theta1")).tan() * (0.5 * q("theta2")).tan();
        assert!((product - 3.771_382_631_945_855).abs() < 1e-10, "{theta1}: {product}");
        assert!(apart(q("theta3"), -q("theta1")) < 1e-11);
        let mobility = mobility(&scene.mechanism, &scene.start.q).expect("a closed position");
        assert_eq!(
            (mobility.freedoms, mobility.counted, mobility.redundant.len()),
            (1, -2, 3)
        );
    }
}

#[test]
fn rssp_moves_its_slider_as_the_closed_form_says() {
    let scene = ready(RSSP);
    let (crank, slide) = (index(&scene, "crank"), index(&scene, "slide"));
    let run = simulate(&scene, Adams::default(), 1e-10, 1.0, 0.01);
    run.end.expect("runs to its end");
    let along = Vector3::new(0.8, 0.0, 0.6);
    let mut turned = 0.0_f64;
    for row in run.rows {
        let (sin, cos) = row.q[crank].sin_cos();
        // From the slide's origin to the crank's pin: the rod ends where its length is 0.4.
        let w = Vector3::new(0.1 * cos, 0.1 * sin - 0.05, 0.0);
        let rate = Vector3::new(-0.1 * sin, 0.1 * cos, 0.0) * row.v[crank];
        let root = (w.dot(&along).powi(2) - w.norm_squared() + 0.16).sqrt();
        let place = w.dot(&along) + root;
        let speed = rate.dot(&along) + (w.dot(&along) * rate.dot(&along) - w.dot(&rate)) / root;
        assert!((row.q[slide] - place).abs() < 1e-11, "t = {}: {}", row.t, row.q[slide]);
        assert!((row.v[slide] - speed).abs() < 1e-10, "t = {}: {}", row.t, row.v[slide]);
        turned = row.q[crank];
    }
    assert!(turned > 2.0 * PI, "{turned}");
}

#[test]
fn stewart_platform_has_legs_as_long_as_its_pose_says() {
    let scene = ready(STEWART);
    let mobility = mobility(&scene.mechanism, &scene.start.q).expect("a closed position");
    assert_eq!((mobility.freedoms, mobility.redundant.len()), (6, 0));
    let run = simulate(&scene, Adams::default(), 1e-10, 1.0, 0.02);
    run.end.expect("runs to its end");
    let pose = index(&scene, "pose.x");
    let circle = |radius: f64, degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Vector3::new(radius * cos, radius * sin, 0.0)
    };
    let legs = [
        (10.0, 50.0),
        (110.0, 70.0),
        (130.0, 170.0),
        (230.0, 190.0),
        (250.0, 290.0),
        (350.0, 310.0),
    ];
    let first = run.rows[0].energy_balance();
    let mut swing = 0.0_f64;
    for row in &run.rows {
        let q = &row.q[pose..pose + 7];
        let origin = Vector3::new(q[0], q[1], q[2]);
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[3], q[4], q[5], q[6]));
        for (k, (base, ball)) in legs.into_iter().enumerate() {
            let length = (origin + turn * circle(0.3, ball) - circle(0.5, base)).norm();
            let found = row.q[index(&scene, &format!("leg{}", k + 1))];
            // Points are written to six digits.
            assert!((found - length).abs() < 1e-6, "t = {}: {found} for {length}", row.t);
        }
        assert!((row.energy_balance() - first).abs() < 1e-7, "t = {}", row.t);
        swing = swing.max((q[2] - run.rows[0].q[pose + 2]).abs());
    }
    assert!(swing > 0.01, "{swing}");
}

#[test]
fn flyball_governor_stays_at_the_angle_of_its_speed() {
    let (m, sleeve, l, k, free) = (0.5, 1.0, 0.2, 100.0, 0.35);
    let (angle, speed) = ("arm1 = 0.6510630589835664", "spindle = 15 ");
    assert!(GOVERNOR.contains(angle) && GOVERNOR.contains(speed));
    for omega in [12.0, 15.0, 20.0_f64] {
        // Balance of ball and sleeve, the spring of length 2 l cos phi between pivot and sleeve.
        let cosine = ((m + sleeve) * 9.81 + k * free) / (l * (m * omega * omega + 2.0 * k));
        let phi = cosine.acos();
        let text = GOVERNOR.replace(angle, &format!("arm1 = {phi}"));
        let scene = ready(&text.replace(speed, &format!("spindle = {omega} ")));
        let run = simulate(&scene, Adams::default(), 1e-11, 1.0, 0.02);
        run.end.expect("runs to its end");
        for row in &run.rows {
            let q = |name| row.q[index(&scene, name)];
            assert!(
                (q("arm1") - phi).abs() < 1e-8 && (q("arm2") - phi).abs() < 1e-8,
                "{omega}: {}",
                q("arm1")
            );
            assert!((q("sleeve") + 2.0 * l * cosine).abs() < 1e-8);
            assert!((q("spindle") - omega * row.t).abs() < 1e-8);
        }
    }
}
