//! Linkages that people know, from scene files, against closed forms.

use linkdyn_integrators::Adams;
use linkdyn_kinematics::assembly::AssemblyError;
use linkdyn_mechanisms::analysis::mobility;
use linkdyn_mechanisms::{StartError, file};
use linkdyn_tests::numbers::apart;
use linkdyn_tests::scenes::{Ready, prepare, simulate};
use std::f64::consts::PI;

const SLIDER_CRANK: &str = include_str!("../../crates/mechanisms/scenes/slider_crank.toml");
const RSSR: &str = include_str!("../../crates/mechanisms/scenes/rssr.toml");
const BENNETT: &str = include_str!("../../crates/mechanisms/scenes/bennett.toml");
const BRICARD: &str = include_str!("../../crates/mechanisms/scenes/bricard.toml");

fn ready(text: &str) -> Ready {
    prepare(file::scene("file", text).expect("a sound file"))
}

/// Place of a coordinate.
fn index(ready: &Ready, name: &str) -> usize {
    let at = ready.mechanism.coordinate_names().position(|there| there == name);
    at.expect("there is such a coordinate")
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
        &format!("input = \"{input} deg\", \"A.psi\" = {psi:.1}, \"A.theta\" = {theta:.1}, output = {output:.1}"),
    )
}

#[test]
fn rssr_closes_at_the_published_angles() {
    let published = [
        (0, 0.0),
        (30, 0.283_361_851_723_81),
        (60, 0.314_674_583_540_30),
        (90, 0.100_167_421_161_56),
        (120, -0.295_152_274_334_36),
        (270, -0.999_154_295_869_88),
        (330, -0.384_937_478_566_85),
    ];
    for (input, output) in published {
        let scene = ready(&rssr_at(RSSR, [0.3, 0.1, 0.2], f64::from(input), output));
        let found = scene.start.q[index(&scene, "output")];
        // Fourteen digits are given; closed to 1e-14 times the condition, some 10.
        assert!(apart(found, output) < 1e-12, "{input} deg: {found} instead of {output}");
        // The crank, and the rod about itself.
        let mobility = mobility(&scene.mechanism, &scene.start.q).expect("a closed position");
        assert_eq!(mobility.freedoms, 2);
    }
}

#[test]
fn rssr_that_cannot_reach_is_refused_with_its_gap() {
    // A rod of 0.5 m on a base at 0.4 m: nothing closes between 171.7 and 185.6 degrees of the crank.
    let longer = RSSR
        .replace("[0.45, 0, 0]", "[0.5, 0, 0]")
        .replace("[0.3, 0.1, 0.2]", "[0.4, 0.1, 0.2]");
    let base = [0.4, 0.1, 0.2];
    let start = |input| {
        // The rocker where it turns back: furthest towards the crank's pin.
        let text = rssr_at(&longer, base, input, f64::atan2(-base[2], -base[1]));
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
fn bricard_swings_on_its_curve_and_keeps_its_energy() {
    let scene = ready(BRICARD);
    let mobility = mobility(&scene.mechanism, &scene.start.q).expect("a closed position");
    assert_eq!(
        (mobility.freedoms, mobility.counted, mobility.redundant.len()),
        (1, 0, 1)
    );
    // Two of the cut joint's neighbours are carried from its other side, so names and not places count.
    let (a1, b1) = (index(&scene, "a1"), index(&scene, "b1"));
    let run = simulate(&scene, Adams::default(), 1e-10, 10.0, 0.05);
    run.end.expect("runs to its end");
    let first = run.rows[0].energy.total();
    let mut furthest = 0.0_f64;
    for row in &run.rows {
        let (a, b) = (row.q[a1].sin(), row.q[b1].sin());
        assert!((a + b + a * b).abs() < 1e-10, "t = {}: {a} {b}", row.t);
        assert!(
            (row.q[a1]) > -1e-9 && row.q[a1] < PI + 1e-9,
            "t = {}: {}",
            row.t,
            row.q[a1]
        );
        // Joules, of some 10 that go to and fro.
        assert!((row.energy.total() - first).abs() < 1e-7, "t = {}", row.t);
        furthest = furthest.max(row.q[a1]);
    }
    assert!(furthest > 0.99 * PI, "{furthest}");
}
