//! A point on a rod in Cartesian coordinates (benchmark 04-pendulum-index3): every form by every method that takes it, against the
//! closed form; orders of positions, rates and multipliers apart.

use linkdyn_integrators::{
    Constrained, Dop853, Equations, EvalError, Form, GeneralisedAlpha, Integration, IntegrationError, Method, Progress,
    Radau5, Settings, SettingsError, Statistics, Terms,
};

use crate::problems::{Function, boxed, solve};

/// x² + y² = 1 under g = 9.81: M = 1, released at (−1, 0).
#[derive(Clone)]
pub struct Pendulum;

const GRAVITY: f64 = 9.81;

impl Constrained for Pendulum {
    fn positions(&self) -> usize {
        2
    }
    fn constraints(&self) -> usize {
        1
    }
    fn evaluate(&mut self, _t: f64, q: &[f64], v: &[f64], terms: &mut Terms) -> Result<(), EvalError> {
        (terms.matrix[0], terms.matrix[3]) = (1.0, 1.0);
        terms.force[1] = -GRAVITY;
        terms.constraint[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0);
        terms.gradient.copy_from_slice(q);
        terms.bias[0] = v[0] * v[0] + v[1] * v[1];
        Ok(())
    }
}

/// (x, y), their rates and λ at times of the published table and between, from the angle alone; checked against the table.
pub fn exact(t: f64) -> [f64; 5] {
    let angle = Function(2, |_: f64, y: &[f64], dy: &mut [f64]| {
        (dy[0], dy[1]) = (y[1], -GRAVITY * y[0].sin());
        Ok(())
    });
    let start = [0.5 * std::f64::consts::PI, 0.0];
    let (y, _) = solve(angle, Dop853::default(), &start, t, Settings::tolerances(1e-14, 1e-15));
    let ((s, c), w) = (y[0].sin_cos(), y[1]);
    [-s, -c, -c * w, s * w, w * w + GRAVITY * c]
}

#[test]
fn the_closed_form_is_that_of_the_table() {
    for (t, x, y) in [
        (0.5, -0.39104879155055, -0.92036994878519),
        (1.0, 0.98629175113188, -0.16501085312554),
        (2.0, -0.79356619534332, -0.60848393044379),
        (5.0, -0.94230543504376, -0.334754338414),
        (10.0, -0.27508746257612, -0.96141920509913),
    ] {
        let found = exact(t);
        assert!(
            (found[0] - x).abs() < 1e-12 && (found[1] - y).abs() < 1e-12,
            "{t}: {found:?}"
        );
        // Without loss of energy λ = 3 g cos θ.
        assert!((found[4] + 3.0 * GRAVITY * found[1]).abs() < 1e-11);
    }
}

const START: [[f64; 2]; 2] = [[-1.0, 0.0], [0.0, 0.0]];

/// Largest errors of positions, rates and multipliers at `end`; work; violations of g and g'.
type Outcome = ([f64; 3], Statistics, (f64, f64));

fn run<M: Method<Equations<Pendulum>>>(
    mut equations: Equations<Pendulum>,
    method: M,
    settings: Settings,
    end: f64,
) -> Result<Outcome, IntegrationError> {
    let y = equations.start(0.0, &START[0], &START[1]).expect("consistent");
    let mut run = Integration::new(equations, boxed(method), 0.0, &y, settings)?;
    while !matches!(run.advance(end)?, Progress::Done { .. }) {}
    let (statistics, y) = (run.statistics(), run.state().1.to_vec());
    let equations = run.problem_mut();
    let violation = equations.violation(end, &y).expect("an ordinary state");
    let lambda = match equations.form() {
        Form::Explicit => equations.multipliers_at(end, &y).expect("an ordinary state")[0],
        _ => equations.multipliers(&y)[0],
    };
    let exact = exact(end);
    let error = |i: usize, value: f64| (value - exact[i]).abs();
    let errors = [
        error(0, y[0]).max(error(1, y[1])),
        error(2, y[2]).max(error(3, y[3])),
        error(4, lambda),
    ];
    Ok((errors, statistics, violation))
}

const IMPLICIT: [Form; 4] = [Form::Index1, Form::Index2, Form::Stabilised, Form::Index3];

/// Measured orders between steps of these lengths.
fn orders(errors: impl Fn(f64) -> [f64; 3], [coarse, fine]: [f64; 2]) -> [f64; 3] {
    let (a, b) = (errors(coarse), errors(fine));
    std::array::from_fn(|i| (a[i] / b[i]).log2() / (coarse / fine).log2())
}

/// Radau IIA of three stages: 5 for what has index 1, 3 for algebraic components of index 2 and rates of index 3, 2 for multipliers of
/// index 3 (Hairer, Wanner II, VII.4).
#[test]
fn orders_of_radau() {
    for (form, expected) in [
        (Form::Index1, [5.0, 5.0, 5.0]),
        (Form::Index2, [5.0, 5.0, 3.0]),
        (Form::Stabilised, [5.0, 5.0, 3.0]),
        (Form::Index3, [5.0, 3.0, 2.0]),
    ] {
        let errors = |h: f64| {
            let equations = Equations::new(Pendulum, form);
            run(equations, Radau5::fixed(h), Settings::default(), 1.0)
                .expect("it ends")
                .0
        };
        let found = orders(errors, [0.01, 0.005]);
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 0.5,
                "{form:?}: {found} instead of {expected}"
            );
        }
    }
}

#[test]
fn orders_of_generalised_alpha() {
    type Fixed = fn(f64) -> GeneralisedAlpha;
    let variants: [(&str, Fixed, bool); 5] = [
        ("radius 0.8", GeneralisedAlpha::fixed, false),
        ("radius 0.8, projected", GeneralisedAlpha::fixed, true),
        ("radius 0", |h| GeneralisedAlpha::fixed(h).with_radius(0.0), false),
        ("hht", |h| GeneralisedAlpha::fixed(h).with_hht(0.2), false),
        (
            "trapezoidal, projected",
            |h| GeneralisedAlpha::fixed(h).with_trapezoidal(),
            true,
        ),
    ];
    for (name, method, projected) in variants {
        let errors = |h: f64| {
            let equations = Equations::new(Pendulum, Form::Index3);
            let equations = if projected {
                equations.with_projection()
            } else {
                equations
            };
            run(equations, method(h), Settings::default(), 1.0).expect("it ends").0
        };
        let found = orders(errors, [0.002, 0.001]);
        for found in found {
            assert!((found - 2.0).abs() < 0.3, "{name}: {found}");
        }
    }
}

/// Largest error after 10 s in tolerances, evaluations.
#[test]
fn radau_by_tolerance() {
    let tolerance = 1e-7;
    for (form, projected, [most_q, most_v, most_lambda], most) in [
        (Form::Index1, false, [1e2, 1e3, 1e4], 20_000),
        (Form::Index1, true, [1e2, 1e3, 1e3], 20_000),
        (Form::Index2, false, [1e2, 1e3, 1e4], 20_000),
        (Form::Stabilised, false, [1e2, 1e3, 1e4], 20_000),
        (Form::Index3, false, [1e2, 1e3, 1e6], 20_000),
        (Form::Index3, true, [1e2, 1e3, 1e3], 20_000),
    ] {
        let equations = Equations::new(Pendulum, form);
        let equations = if projected {
            equations.with_projection()
        } else {
            equations
        };
        let settings = Settings::tolerances(tolerance, tolerance);
        let (errors, statistics, violation) = run(equations, Radau5::default(), settings, 10.0).expect("it ends");
        for (error, most) in errors.iter().zip([most_q, most_v, most_lambda]) {
            assert!(*error < most * tolerance, "{form:?} {projected}: {errors:?}");
        }
        assert!(statistics.evaluations < most, "{form:?} {projected}: {statistics:?}");
        // g = 0 is solved to rounding where it is among the equations, and g' = 0.
        if matches!(form, Form::Stabilised | Form::Index3) || projected {
            assert!(violation.0 < 1e-3 * tolerance, "{form:?}: {violation:?}");
        }
        if form != Form::Index3 || projected {
            assert!(violation.1 < 10.0 * tolerance, "{form:?}: {violation:?}");
        }
    }
}

#[test]
fn generalised_alpha_by_tolerance() {
    for projected in [false, true] {
        let solve = |tolerance: f64| {
            let equations = Equations::new(Pendulum, Form::Index3);
            let equations = if projected {
                equations.with_projection()
            } else {
                equations
            };
            let settings = Settings::tolerances(tolerance, tolerance);
            run(equations, GeneralisedAlpha::default(), settings, 2.0).expect("it ends")
        };
        let ((rough, _, _), (fine, statistics, violation)) = (solve(1e-5), solve(1e-8));
        // Local errors of order 3, global ones of order 2: a thousandth of the tolerance is a hundredth of the error. Multipliers feel
        // every change of the step unless rates are projected.
        let known = if projected { 3 } else { 2 };
        for (rough, fine) in rough.iter().zip(fine).take(known) {
            assert!(fine < 0.03 * rough && fine < 1e-3, "{projected}: {rough} {fine}");
        }
        assert!(statistics.rejected < statistics.accepted / 10, "{statistics:?}");
        assert!(
            violation.0 < 1e-9 && (!projected || violation.1 < 1e-12),
            "{violation:?}"
        );
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let refused = |outcome: Result<Outcome, IntegrationError>| {
        matches!(outcome, Err(IntegrationError::Settings(SettingsError::Method(_))))
    };
    let equations = |form| Equations::new(Pendulum, form);
    for form in IMPLICIT {
        assert!(
            refused(run(equations(form), Dop853::default(), Settings::default(), 1.0)),
            "{form:?}"
        );
    }
    for form in [Form::Explicit, Form::Index1, Form::Index2, Form::Stabilised] {
        assert!(refused(run(
            equations(form),
            GeneralisedAlpha::default(),
            Settings::default(),
            1.0
        )));
    }
    for method in [
        GeneralisedAlpha::default().with_radius(1.1),
        GeneralisedAlpha::default().with_radius(f64::NAN),
        GeneralisedAlpha::default().with_hht(-0.1),
    ] {
        assert!(refused(run(equations(Form::Index3), method, Settings::default(), 1.0)));
    }
}
