//! The RSRRR scene against independent reference solutions, against itself by other routes, and under overload.

use linkdyn_dynamics::{DynamicsError, Formulation, ReactionSolver};
use linkdyn_integrators::{Adams, Auto, Corrector, Dop853, DormandPrince5, IntegrationError, Method, Newmark, Rk4};
use linkdyn_mechanisms::catalogue::{Rsrrr, rsrrr};
use linkdyn_mechanisms::{MotionError, Observation, RunError, Simulation};
use linkdyn_tests::reference::{self, Table};
use linkdyn_tests::scenes::{Finished, distance, prepare, ready_rsrrr, simulate, simulate_with};

/// Largest difference of the rows and a reference, by the head of the column's name.
fn differences(rows: &[Observation], simulation: &Simulation, table: &Table) -> Vec<(&'static str, f64)> {
    let columns = simulation.columns(true);
    let mut worst = ["q.", "v.", "a.", "lambda.", "reaction.", "friction.", "energy."].map(|head| (head, 0.0_f64));
    let mut numbers = Vec::new();
    assert_eq!(rows.len(), table.rows().len());
    for (row, expected) in rows.iter().zip(table.rows()) {
        assert!((row.t - expected[0]).abs() < 1e-12);
        row.write(true, &mut numbers);
        for (name, number) in columns.iter().zip(&numbers).skip(1) {
            if let Some(k) = table.columns().iter().position(|column| column == name) {
                let (_, most) = worst
                    .iter_mut()
                    .find(|(head, _)| name.starts_with(head))
                    .unwrap_or_else(|| panic!("{name}"));
                *most = most.max((number - expected[k]).abs());
            } else {
                assert!(
                    name == "t" || name == "energy.elastic" || name.starts_with("violation."),
                    "{name}"
                );
            }
        }
    }
    worst.into()
}

fn assert_within(found: &[(&str, f64)], limits: &[(&str, f64)]) {
    for (head, limit) in limits {
        let (_, difference) = found.iter().find(|(h, _)| h == head).expect("a known column");
        assert!(
            difference <= limit,
            "{head} differs by {difference:e}, allowed {limit:e}"
        );
    }
}

fn energy_error(rows: &[Observation]) -> f64 {
    rows.iter()
        .map(|o| (o.energy_balance() - rows[0].energy_balance()).abs())
        .fold(0.0, f64::max)
}

/// Largest difference of coordinates and speeds of two runs with the same rows.
fn motion_difference(a: &Finished, b: &Finished) -> f64 {
    let pairs = a.rows.iter().zip(&b.rows);
    pairs
        .map(|(a, b)| distance(&a.q, &b.q).max(distance(&a.v, &b.v)))
        .fold(0.0, f64::max)
}

// Limits for runs at 1e-12: what the scene is asked to show (1e-9 in coordinates and speeds), with the powers of the step and
// of the crank speed that derived quantities lose; the reference is far better than that.
#[test]
fn ideal_run_equals_the_independent_reference() {
    let run = simulate(&ready_rsrrr(false, 1.0), Dop853::default(), 1e-12, 5.0, 0.05);
    run.end.as_ref().expect("runs to the end");
    let limits = [
        ("q.", 1e-11),
        ("v.", 1e-9),
        ("a.", 1e-8),
        ("lambda.", 1e-8),
        ("reaction.", 1e-8),
        ("energy.", 1e-9),
    ];
    assert_within(
        &differences(&run.rows, &run.simulation, &reference::rsrrr_ideal()),
        &limits,
    );
}

#[test]
fn friction_run_equals_the_independent_reference() {
    let run = simulate(&ready_rsrrr(true, 1.0), Dop853::default(), 1e-12, 5.0, 0.05);
    run.end.as_ref().expect("runs to the end");
    let limits = [
        ("q.", 1e-9),
        ("v.", 1e-8),
        ("a.", 1e-6),
        ("lambda.", 1e-7),
        ("reaction.", 1e-7),
        ("friction.", 1e-8),
        ("energy.", 1e-8),
    ];
    assert_within(
        &differences(&run.rows, &run.simulation, &reference::rsrrr_friction()),
        &limits,
    );
}

#[test]
fn ideal_run_agrees_between_families_and_keeps_energy_and_loop() {
    let scene = ready_rsrrr(false, 1.0);
    let multistep = simulate(&scene, Adams::default(), 1e-12, 5.0, 0.01);
    let one_step = simulate(&scene, Dop853::default(), 1e-12, 5.0, 0.01);
    assert!(motion_difference(&multistep, &one_step) < 1e-9);
    for run in [&multistep, &one_step] {
        assert!(energy_error(&run.rows) < 1e-10, "{:e} J", energy_error(&run.rows));
        assert!(run.rows.iter().all(|o| o.violation.0 < 1e-12 && o.violation.1 < 1e-12));
        // Without friction nothing asks for reactions but the rows themselves.
        assert_eq!(run.simulation.counters().reaction_sweeps, run.rows.len() as u64);
        assert_eq!(run.simulation.counters().reaction_iterations, 0);
    }
}

#[test]
fn friction_run_agrees_between_families_and_solves_its_loop_at_every_evaluation() {
    let scene = ready_rsrrr(true, 1.0);
    let multistep = simulate(&scene, Adams::default(), 1e-12, 5.0, 0.01);
    let one_step = simulate(&scene, DormandPrince5::default(), 1e-12, 5.0, 0.01);
    assert!(motion_difference(&multistep, &one_step) < 1e-7);
    for run in [&multistep, &one_step] {
        assert!(run.simulation.worst().friction_residual < 1e-12);
        assert!(energy_error(&run.rows) < 1e-9);
        assert!(run.rows.iter().all(|o| o.violation.0 < 1e-12));
    }
}

#[test]
fn rows_can_be_recomputed_from_their_own_state() {
    let scene = ready_rsrrr(true, 1.0);
    let run = simulate(&scene, Adams::default(), 1e-10, 5.0, 0.05);
    for row in &run.rows {
        // A fresh simulation knows nothing of the run.
        let mut simulation = Simulation::new(&scene.mechanism);
        let state = [row.q.as_slice(), row.v.as_slice(), &[row.work]].concat();
        let mut again = Observation::default();
        simulation.observe(row.t, &state, &mut again).expect("a regular state");
        assert_eq!(&again, row, "t = {}", row.t);
    }
}

#[test]
fn crank_error_is_1e_9_with_at_most_3000_evaluations() {
    let scene = ready_rsrrr(false, 1.0);
    let table = reference::rsrrr_ideal();
    let psi11 = table.column("q.psi11");
    let error = |o: &Observation, row: &Vec<f64>| (o.q[0] - row[psi11]).abs();

    // One-step method: at the end of the run. Between its long steps interpolation loses half a digit.
    let one_step = simulate_with(&scene, Dop853::default(), (0.0, 3e-9), 5.0, 5.0);
    let last = (one_step.rows.last().expect("rows"), table.rows().last().expect("rows"));
    let (error_at_end, evaluations) = (error(last.0, last.1), one_step.statistics.evaluations);
    assert!(
        error_at_end < 1e-9 && evaluations <= 3000,
        "{error_at_end:e} with {evaluations}"
    );

    // Multistep method: in all rows, where interpolation costs nothing.
    let multistep = simulate_with(&scene, Adams::default(), (0.0, 3e-11), 5.0, 0.05);
    let largest = multistep
        .rows
        .iter()
        .zip(table.rows())
        .map(|(o, row)| error(o, row))
        .fold(0.0, f64::max);
    assert!(
        largest < 1e-9 && multistep.statistics.evaluations <= 2000,
        "{largest:e}, {:?}",
        multistep.statistics
    );
}

#[test]
fn tolerance_a_hundredth_cuts_the_error_at_least_tenfold() {
    let scene = ready_rsrrr(false, 1.0);
    let table = reference::rsrrr_ideal();
    let last = table.rows().last().expect("rows");
    let error = |run: &Finished| distance(&run.rows.last().expect("rows").q, &last[1..5]);
    let errors = |tolerance| {
        [
            error(&simulate(&scene, Adams::default(), tolerance, 5.0, 5.0)),
            error(&simulate(&scene, Dop853::default(), tolerance, 5.0, 5.0)),
            error(&simulate(&scene, DormandPrince5::default(), tolerance, 5.0, 5.0)),
        ]
    };
    let (loose, tight) = (errors(1e-7), errors(1e-9));
    for (loose, tight) in loose.iter().zip(tight) {
        assert!(tight < 0.1 * loose, "{loose:e} to {tight:e}");
    }
}

#[test]
fn simulations_on_two_threads_repeat_each_other_bit_for_bit() {
    let scene = ready_rsrrr(true, 1.0);
    let alone = simulate(&scene, Dop853::default(), 1e-8, 1.0, 0.1).rows;
    let threads: Vec<_> = std::thread::scope(|scope| {
        let work = || simulate(&scene, Dop853::default(), 1e-8, 1.0, 0.1).rows;
        let handles = [scope.spawn(work), scope.spawn(work)];
        handles
            .into_iter()
            .map(|handle| handle.join().expect("no panic"))
            .collect()
    });
    assert!(threads.iter().all(|rows| *rows == alone));
}

#[test]
fn lagrange_form_gives_the_same_motion() {
    let lagrange = |friction| {
        let mut scene = rsrrr(&Rsrrr {
            friction,
            friction_scale: 1.0,
        });
        scene.linkage.formulation = Formulation::Lagrange;
        prepare(scene)
    };
    let recursive = simulate(&ready_rsrrr(false, 1.0), Dop853::default(), 1e-10, 1.0, 0.1);
    let same = simulate(&lagrange(false), Dop853::default(), 1e-10, 1.0, 0.1);
    // The steps are the same, so that rounding alone differs.
    let difference = motion_difference(&recursive, &same);
    assert!(difference < 1e-12, "{difference:e}");

    // With friction a kink can make two runs step differently; the equations are compared state by state.
    let recursive = simulate(&ready_rsrrr(true, 1.0), Dop853::default(), 1e-8, 5.0, 0.1);
    let lagrange = lagrange(true);
    let mut simulation = Simulation::new(&lagrange.mechanism);
    for row in &recursive.rows {
        let rates = simulation
            .accelerations(row.t, &row.q, &row.v)
            .expect("a regular state");
        // Accelerations are of size 100 rad/s^2, and both friction loops are solved to 1e-12.
        assert!(distance(rates, &row.a) < 1e-9);
    }
}

#[test]
fn work_of_one_run_is_what_it_was() {
    let run = simulate(&ready_rsrrr(true, 1.0), Dop853::default(), 1e-8, 5.0, 5.0);
    let s = run.statistics;
    // One row each at the beginning and the end is observed on top of the evaluations.
    assert_eq!(run.simulation.counters().evaluations, s.evaluations + 2);
    assert_eq!(s.dense_evaluations, 0);
    // Trigonometric functions of other systems may move a step; a tenth more work is a defect.
    assert!(s.evaluations < 9_600, "{s:?}");
    assert!(run.simulation.counters().reaction_iterations < 6 * s.evaluations);
}

/// The way of the paper: Newmark's method, friction by k sweeps from zero at each evaluation.
fn papers_way(sweeps: usize, step: f64) -> f64 {
    let mut scene = rsrrr(&Rsrrr {
        friction: true,
        friction_scale: 1.0,
    });
    scene.linkage.reaction_solver = ReactionSolver::Sweeps { sweeps };
    let corrector = Corrector::Until {
        change: 1e-12,
        at_most: 200,
    };
    let run = simulate(&prepare(scene), Newmark::new(step, corrector), 1e-9, 5.0, 5.0);
    run.end.expect("runs to the end");
    let table = reference::rsrrr_friction();
    let last = table.rows().last().expect("rows");
    run.rows.last().expect("rows").q[0] - last[table.column("q.psi11")]
}

#[test]
fn three_sweeps_of_the_friction_loop_miss_the_crank_angle_by_a_hundredth() {
    // Errata: 2e-2 rad after 5 s, whatever the step.
    let error = papers_way(3, 1e-3).abs();
    assert!((1e-2..4e-2).contains(&error), "{error}");
}

#[test]
fn rk4_converges_to_the_reference_with_order_four() {
    let table = reference::rsrrr_ideal();
    let last = table.rows().last().expect("rows");
    let error = |step| {
        let run = simulate(&ready_rsrrr(false, 1.0), Rk4::new(step), 1e-9, 5.0, 5.0);
        (run.rows.last().expect("rows").q[0] - last[1]).abs()
    };
    let order = (error(4e-3) / error(2e-3)).log2();
    assert!((3.7..4.4).contains(&order), "{order}");
}

/// The diagnosis a run ended with.
fn diagnosis(end: RunError) -> DynamicsError {
    let source = match end {
        RunError::Motion(error) => return error.cause,
        RunError::Integration(IntegrationError::StepTooSmall {
            source: Some(source), ..
        }) => source,
        other => panic!("{other}"),
    };
    source.downcast::<MotionError>().expect("a diagnosis").cause
}

#[test]
fn friction_below_the_fold_runs() {
    for scale in [1.5, 1.85] {
        let run = simulate(&ready_rsrrr(true, scale), Dop853::default(), 1e-8, 5.0, 0.5);
        run.end.unwrap_or_else(|error| panic!("{scale}: {error}"));
        assert!(run.rows.last().expect("rows").q[0] > 30.0);
    }
}

/// Times of `tests/reference/rsrrr_jamming.csv`. Before it jams the mechanism creeps near the fold, the longer the more friction there is: explicit methods then
/// take minutes, and times depend on the tolerance more than motions do.
#[test]
fn friction_beyond_the_fold_jams_at_the_time_of_the_independent_reference() {
    let jam = |scale, method: Box<dyn Method<Simulation>>, tolerance| {
        let end = simulate(&ready_rsrrr(true, scale), method, tolerance, 5.0, 0.5).end;
        match diagnosis(end.expect_err("jams")) {
            DynamicsError::Jammed { time, speed, .. } => {
                assert_eq!(speed, 1, "the wide bearing of J21 jams");
                time
            }
            other => panic!("{scale}: {other}"),
        }
    };
    for (scale, expected, method, tolerance) in [
        (
            1.9,
            0.573_435_890,
            Box::new(Dop853::default()) as Box<dyn Method<Simulation>>,
            1e-9,
        ),
        (1.9, 0.573_435_890, Box::new(Adams::default()), 1e-10),
        (2.0, 0.529_625_119, Box::new(Dop853::default()), 1e-9),
        (2.0, 0.529_625_119, Box::new(Adams::default()), 1e-10),
        (3.0, 0.319_444_879, Box::new(Auto::default()), 1e-9),
    ] {
        let found = jam(scale, method, tolerance);
        assert!(
            (found - expected).abs() < 5e-6,
            "{scale}: {found} instead of {expected}"
        );
    }
}
