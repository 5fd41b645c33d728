//! Order of each method, of its solution and of its interpolation.

use linkdyn_integrators::{
    Adams, Bdf, Corrector, Dop853, DormandPrince5, Method, Newmark, Progress, Radau5, Rk4, SecondOrder, Settings,
};

use crate::problems::{Any, Damped, Kink, Rational, begin, distance, solve};

/// Least-squares slope of log₂ error over halvings of the step.
fn slope(errors: &[f64]) -> f64 {
    let n = errors.len() as f64;
    let mean = (n - 1.0) / 2.0;
    let (mut above, mut below) = (0.0, 0.0);
    for (i, error) in errors.iter().enumerate() {
        above += (i as f64 - mean) * error.log2();
        below += (i as f64 - mean).powi(2);
    }
    -above / below
}

/// Errors at the end for `halvings` + 1 step sizes.
fn errors<P: SecondOrder + 'static, M: Method<Any<'static>> + 'static>(
    problem: impl Fn() -> P,
    method: impl Fn(f64) -> M,
    y0: &[f64],
    (end, exact): (f64, &[f64]),
    first: f64,
) -> Vec<f64> {
    (0..5)
        .map(|i| {
            let step = first / f64::from(1 << i);
            distance(&solve(problem(), method(step), y0, end, Settings::default()).0, exact)
        })
        .collect()
}

/// Orders on the three problems.
fn orders<M>(method: impl Fn(f64) -> M, first: [f64; 3]) -> [f64; 3]
where
    M: Method<Any<'static>> + 'static,
{
    [
        slope(&errors(
            || Damped,
            &method,
            &Damped::START,
            (4.0, &Damped::exact(4.0)),
            first[0],
        )),
        slope(&errors(
            || Kink,
            &method,
            &Kink::START,
            (1.5, &Kink::exact(1.5)),
            first[1],
        )),
        slope(&errors(
            || Rational,
            &method,
            &Rational::START,
            (2.0, &Rational::exact(2.0)),
            first[2],
        )),
    ]
}

fn assert_orders(found: [f64; 3], order: f64, margin: f64) {
    for (problem, found) in ["damped", "kink", "rational"].iter().zip(found) {
        assert!(
            (found - order).abs() < margin,
            "{problem}: order {found}, expected {order}"
        );
    }
}

#[test]
fn rk4() {
    assert_orders(orders(Rk4::new, [0.1, 0.05, 0.02]), 4.0, 0.05);
}

#[test]
fn dormand_prince_5() {
    assert_orders(orders(DormandPrince5::fixed, [0.1, 0.04, 0.03]), 5.0, 0.3);
}

#[test]
fn dop853() {
    assert_orders(orders(Dop853::fixed, [1.0, 0.5, 0.4]), 8.0, 0.3);
}

#[test]
fn radau_5() {
    assert_orders(orders(Radau5::fixed, [0.5, 0.2, 0.1]), 5.0, 0.15);
}

#[test]
fn newmark() {
    let settled = |step| {
        Newmark::new(
            step,
            Corrector::Until {
                change: 1e-14,
                at_most: 100,
            },
        )
    };
    assert_orders(orders(settled, [0.05, 0.05, 0.05]), 2.0, 0.02);
    assert_orders(
        orders(|step| Newmark::new(step, Corrector::Times(2)), [0.05, 0.05, 0.05]),
        2.0,
        0.02,
    );
}

#[test]
fn newmark_of_other_coefficients() {
    let damped = |step| Newmark::new(step, Corrector::Times(4)).with_coefficients(0.3025, 0.6);
    assert_orders(orders(damped, [0.01, 0.01, 0.01]), 1.0, 0.05);
}

/// Largest error of the interpolation at five places in each step of the run.
fn dense_error(
    problem: impl SecondOrder + 'static,
    method: impl Method<Any<'static>> + 'static,
    y0: &[f64],
    exact: impl Fn(f64) -> [f64; 3],
) -> f64 {
    let mut run = begin(problem, method, 0.0, y0, Settings::tolerances(1e-9, 1e-9)).expect("good settings");
    let (mut y, mut worst) = ([0.0; 3], 0.0_f64);
    loop {
        let progress = run.advance(1.5).expect("smooth");
        let (from, to) = run.last_step();
        for theta in [0.0, 0.13, 0.5, 0.71, 1.0] {
            let t = if theta == 1.0 { to } else { from + theta * (to - from) };
            run.interpolate(t, &mut y).expect("inside the step");
            worst = worst.max(distance(&y, &exact(t)));
        }
        if matches!(progress, Progress::Done { .. }) {
            return worst;
        }
    }
}

#[test]
fn interpolation() {
    let order = |errors: &dyn Fn(f64) -> f64, first: f64| {
        slope(&(0..4).map(|i| errors(first / f64::from(1 << i))).collect::<Vec<_>>())
    };
    let rk4 = order(&|h| dense_error(Kink, Rk4::new(h), &Kink::START, Kink::exact), 0.1);
    let dp5 = order(
        &|h| dense_error(Kink, DormandPrince5::fixed(h), &Kink::START, Kink::exact),
        0.1,
    );
    let dop = order(
        &|h| dense_error(Damped, Dop853::fixed(h), &Damped::START, Damped::exact),
        0.5,
    );
    let radau = order(&|h| dense_error(Kink, Radau5::fixed(h), &Kink::START, Kink::exact), 0.1);
    let corrector = Corrector::Until {
        change: 1e-14,
        at_most: 100,
    };
    let newmark = order(
        &|h| dense_error(Kink, Newmark::new(h, corrector), &Kink::START, Kink::exact),
        0.1,
    );
    for (found, expected, margin) in [
        (rk4, 4.0, 0.05),
        (dp5, 5.0, 0.3),
        (dop, 8.0, 0.4),
        (radau, 4.0, 0.1),
        (newmark, 2.0, 0.05),
    ] {
        assert!(
            (found - expected).abs() < margin,
            "local order {found}, expected {expected}"
        );
    }
    // Variable order: as good as the solution.
    let adams = dense_error(Kink, Adams::default(), &Kink::START, Kink::exact);
    assert!(adams < 1e-8, "{adams:e}");
    let bdf = dense_error(Kink, Bdf::default(), &Kink::START, Kink::exact);
    assert!(bdf < 2e-8, "{bdf:e}");
}
