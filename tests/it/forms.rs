//! Mechanisms with multipliers as unknowns: the same motion and the same multipliers as where they are eliminated.

use linkdyn_integrators::{Dop853, Equations, Form, GeneralisedAlpha, Integration, Method, Progress, Radau5, Settings};
use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsup};
use linkdyn_mechanisms::{ConstrainedMechanism, FormError, Observation};
use linkdyn_tests::scenes::{Ready, distance, ready_rsrrr, ready_rsup, simulate};

const END: f64 = 0.5;

/// Coordinates, speeds and multipliers at the end.
fn solve<M: Method<Equations<ConstrainedMechanism>>>(
    ready: &Ready,
    (form, projected): (Form, bool),
    method: M,
    tolerance: f64,
) -> [Vec<f64>; 3] {
    let motion = ConstrainedMechanism::new(&ready.mechanism).expect("no friction, no contact");
    let equations = Equations::new(motion, form);
    let mut equations = if projected {
        equations.with_projection()
    } else {
        equations
    };
    let (start, n) = (&ready.start, ready.start.q.len());
    let y = equations.start(0.0, &start.q, &start.v).expect("closed");
    let settings = Settings::tolerances(tolerance, tolerance);
    let run = Integration::new(equations, method, 0.0, &y, settings).expect("it fits");
    let mut run = run.with_stops(&ready.mechanism.system().stop_times()).expect("finite");
    while !matches!(run.advance(END).expect("it ends"), Progress::Done { .. }) {}
    let y = run.state().1.to_vec();
    let multipliers = match form {
        Form::Explicit => run.problem_mut().multipliers_at(END, &y).expect("regular").to_vec(),
        _ => run.problem().multipliers(&y).to_vec(),
    };
    [y[..n].to_vec(), y[n..2 * n].to_vec(), multipliers]
}

fn reference(ready: &Ready) -> Observation {
    let finished = simulate(ready, Dop853::default(), 1e-11, END, END);
    finished.end.expect("the run ends");
    finished.rows.last().expect("rows").clone()
}

/// Largest differences against the projected form, those of multipliers relative to the largest.
fn differences(exact: &Observation, [q, v, multipliers]: &[Vec<f64>; 3]) -> [f64; 3] {
    let size = exact
        .multipliers
        .iter()
        .fold(1.0, |size: f64, lambda| size.max(lambda.abs()));
    [
        distance(q, &exact.q),
        distance(v, &exact.v),
        distance(multipliers, &exact.multipliers) / size,
    ]
}

#[test]
fn rsrrr_in_every_form() {
    let ready = ready_rsrrr(false, 1.0);
    let exact = reference(&ready);
    for (form, projected, most) in [
        (Form::Explicit, true, [1e-7, 1e-6, 1e-6]),
        (Form::Index1, false, [1e-7, 1e-6, 1e-6]),
        (Form::Index1, true, [1e-7, 1e-6, 1e-6]),
        (Form::Index2, false, [1e-7, 1e-6, 1e-4]),
        (Form::Stabilised, false, [1e-7, 1e-6, 1e-4]),
        (Form::Index3, false, [1e-6, 1e-5, 1e-2]),
        (Form::Index3, true, [1e-6, 1e-5, 1e-5]),
    ] {
        let found = solve(&ready, (form, projected), Radau5::default(), 1e-8);
        let found = differences(&exact, &found);
        for (found, most) in found.iter().zip(most) {
            assert!(*found < most, "{form:?} {projected}: {found:e}");
        }
    }
}

#[test]
fn rsrrr_by_generalised_alpha() {
    let ready = ready_rsrrr(false, 1.0);
    let exact = reference(&ready);
    for projected in [false, true] {
        let [rough, fine] = [2e-3, 1e-3].map(|h| {
            let found = solve(&ready, (Form::Index3, projected), GeneralisedAlpha::fixed(h), 1e-8);
            differences(&exact, &found)
        });
        for (rough, fine) in rough.iter().zip(fine) {
            assert!(
                fine < 1e-2 && (3.0..5.5).contains(&(rough / fine)),
                "order 2: {rough:e} {fine:e}"
            );
        }
    }
}

#[test]
fn what_has_no_such_form_is_refused_by_name() {
    let friction = ConstrainedMechanism::new(&ready_rsrrr(true, 1.0).mechanism);
    assert!(matches!(friction, Err(FormError::Friction { joint }) if !joint.is_empty()));
    let variant = Rsup {
        clearance: Some(ClearanceKind::Planar),
        ..Rsup::default()
    };
    let clearance = ConstrainedMechanism::new(&ready_rsup(&variant).mechanism);
    assert!(matches!(clearance, Err(FormError::Internals { what }) if what.contains("clearance")));
}
