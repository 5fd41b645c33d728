//! Prescribed motion against closed forms, against inverse dynamics and against itself as a drive.

use linkdyn_integrators::{Auto, Dop853, Radau5};
use linkdyn_mechanisms::analysis::inverse_dynamics::{Prescribed, inverse_dynamics};
use linkdyn_mechanisms::{Observation, PrescribedMotion, Scene, Spline, file};
use linkdyn_tests::scenes::{Finished, prepare, simulate};

const FOUR_BAR: &str = include_str!("../../crates/mechanisms/scenes/four_bar.toml");

fn slider(motion: &str) -> Scene {
    let text = format!(
        r#"
        format = 1
        gravity = [-2.0, 0, -9.81]
        [links.block]
        mass = 3.0
        [joints.way]
        kind = "prismatic"
        axis = [1, 0, 0]
        successor = {{ link = "block" }}
        prescribed = {motion}
        "#
    );
    file::scene("slider", &text).expect("sound")
}

fn run(scene: Scene) -> Finished {
    let run = simulate(&prepare(scene), Dop853::default(), 1e-11, 2.0, 0.1);
    assert!(run.end.is_ok());
    run
}

#[test]
fn force_of_a_guided_slider_is_mass_times_acceleration_and_weight() {
    let w = std::f64::consts::TAU * 1.5;
    let harmonic = "{ harmonic = { mean = 0.2, amplitude = 0.1, frequency = 1.5 } }";
    for row in &run(slider(harmonic)).rows {
        let (s, c) = (w * row.t).sin_cos();
        assert!((row.q[0] - 0.2 - 0.1 * s).abs() < 1e-14);
        assert!((row.v[0] - 0.1 * w * c).abs() < 1e-13);
        assert!((row.multipliers[0] - 3.0 * (2.0 - 0.1 * w * w * s)).abs() < 1e-11);
        // Kinetic energy and that of the weight come out of the drive.
        let energy = |o: &Observation| o.energy.kinetic + o.energy.potential - o.work;
        let first = 1.5 * (0.1 * w) * (0.1 * w) + 6.0 * 0.2;
        // The motion is prescribed, so that nothing but the steps of an undisturbed oscillation controls the sum of its work.
        assert!((energy(row) - first).abs() < 1e-8, "{}", energy(row) - first);
        assert!(row.violation.0 < 1e-14 && row.violation.1 < 1e-13);
    }
    for row in &run(slider("{ polynomial = { coefficients = [0.1, 0.2, 0.3] } }")).rows {
        assert!((row.q[0] - 0.1 - row.t * (0.2 + row.t * 0.3)).abs() < 1e-14);
        assert!((row.multipliers[0] - 3.0 * 2.6).abs() < 1e-11);
    }
}

#[test]
fn a_table_of_speeds_starts_from_where_the_joint_is() {
    let points = [(0.0, 0.0), (0.5, 1.0), (1.0, 0.5), (1.5, 0.0)];
    let list: Vec<String> = points.iter().map(|(t, v)| format!("[{t:?}, {v:?}]")).collect();
    let motion = format!("{{ speeds = {{ points = [{}] }} }}", list.join(", "));
    let mut scene = slider(&motion);
    scene.start.positions.push(("way".into(), 0.7));
    let rows = run(scene).rows;
    let spline = Spline::natural(&points);
    for row in &rows {
        assert!((row.v[0] - spline.value(row.t)).abs() < 1e-14);
    }
    // The spline's integral by Simpson's rule, exact for cubics between nodes.
    let part = |a: f64, b: f64| {
        let middle = spline.value(0.5 * (a + b));
        (b - a) / 6.0 * (spline.value(a) + 4.0 * middle + spline.value(b))
    };
    let way: f64 = points.windows(2).map(|pair| part(pair[0].0, pair[1].0)).sum();
    let last = rows.last().expect("rows");
    assert!((last.q[0] - 0.7 - way).abs() < 1e-10, "{} {way}", last.q[0]);
}

#[test]
fn torque_of_a_guided_crank_is_that_of_inverse_dynamics() {
    let mut scene = file::scene("four-bar", FOUR_BAR).expect("sound");
    scene.start.positions.retain(|(name, _)| name != "A");
    scene.start.speeds.clear();
    let free = {
        let mut free = scene.clone();
        free.start.positions.push(("A".into(), 1.0));
        prepare(free)
    };
    let handle = scene.linkage.joint_named("A").expect("the crank");
    let coefficients = vec![1.0, 6.0, 0.5];
    scene
        .linkage
        .prescribe(handle, PrescribedMotion::Polynomial { coefficients });
    let ready = prepare(scene);
    assert_eq!(ready.mechanism.prescribed_names().collect::<Vec<_>>(), ["A"]);
    let runs = [
        simulate(&ready, Dop853::default(), 1e-11, 1.0, 0.05),
        simulate(&ready, Radau5::default(), 1e-11, 1.0, 0.05),
        simulate(&ready, Auto::default(), 1e-11, 1.0, 0.05),
    ];
    for run in runs {
        assert!(run.end.is_ok());
        assert_eq!(run.rows.len(), 21);
        for row in &run.rows {
            let (angle, speed, acceleration) = (1.0 + row.t * (6.0 + 0.5 * row.t), 6.0 + row.t, 1.0);
            assert!((row.q[0] - angle).abs() < 1e-13 && (row.v[0] - speed).abs() < 1e-12);
            let motion = Prescribed {
                coordinate: "A".into(),
                speed,
                acceleration,
            };
            let needs = inverse_dynamics(&free.mechanism, row.t, &row.q, &[motion]).expect("a motion");
            let (torque, needed) = (*row.multipliers.last().expect("the drive"), needs.drives[0]);
            assert!(
                (torque - needed).abs() < 1e-9 * needed.abs().max(1.0),
                "{torque} {needed}"
            );
            let energy = |o: &Observation| o.energy.kinetic + o.energy.potential - o.work;
            assert!((energy(row) - energy(&run.rows[0])).abs() < 1e-7);
        }
    }
}

#[test]
fn starts_and_motions_that_contradict_are_refused() {
    let mut scene = slider("{ polynomial = { coefficients = [0.1, 0.2] } }");
    scene.start.positions.push(("way".into(), 0.3));
    let mechanism = scene.linkage.build().expect("sound");
    let error = mechanism
        .assemble(&scene.start)
        .expect_err("another position")
        .to_string();
    assert!(
        error.contains("`way`") && error.contains("0.3") && error.contains("0.1"),
        "{error}"
    );

    let mut scene = file::scene("four-bar", FOUR_BAR).expect("sound");
    scene.start.positions.clear();
    scene.start.speeds.clear();
    for (name, angle) in [("A", 1.0), ("D", 0.3)] {
        let coefficients = vec![angle];
        let joint = scene.linkage.joint_named(name).expect("a joint of the file");
        scene
            .linkage
            .prescribe(joint, PrescribedMotion::Polynomial { coefficients });
    }
    let mechanism = scene.linkage.build().expect("no fault of a single item");
    assert!(mechanism.assemble(&scene.start).is_err());

    let mut scene = slider("{ polynomial = { coefficients = [0.1] } }");
    let joint = scene.linkage.joint_named("way").expect("a joint of the file");
    let coefficients = vec![0.1, f64::NAN];
    scene
        .linkage
        .prescribe(joint, PrescribedMotion::Polynomial { coefficients });
    let error = scene.linkage.build().expect_err("no number").to_string();
    assert!(error.contains("`way`") && error.contains("coefficient"), "{error}");
}
