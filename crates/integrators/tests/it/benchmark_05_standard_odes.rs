//! Stiff problems of the test set for IVP solvers (benchmark 05-standard-odes): digits and work.

use linkdyn_integrators::{Bdf, Method, Radau5, Settings, Statistics};

use crate::problems::{Any, Function, solve};
use crate::standard_odes::{HIRES, ROBERTSON, Standard, VAN_DER_POL};

/// Digits of the worst component at the end, relative to its value.
pub fn digits(problem: &Standard, method: impl Method<Any<'static>> + 'static, relative: f64) -> (f64, Statistics) {
    let settings = Settings {
        first_step: Some(1e-6),
        ..Settings::tolerances(relative, problem.ratio * relative)
    };
    let (y, statistics) = solve(*problem, method, problem.start, problem.end, settings);
    (problem.digits(&y), statistics)
}

/// At each relative tolerance: at least so many digits, at most so many evaluations.
fn check(problem: &Standard, expected: [(f64, f64, u64); 4]) {
    for (relative, least, most) in expected {
        let (digits, statistics) = digits(problem, Radau5::default(), relative);
        assert!(digits >= least, "{}, {relative:e}: {digits} digits", problem.name);
        assert!(
            statistics.evaluations <= most,
            "{}, {relative:e}: {statistics:?}",
            problem.name
        );
    }
}

#[test]
fn hires() {
    check(
        &HIRES,
        [
            (1e-4, 2.0, 750),
            (1e-7, 7.2, 2600),
            (1e-10, 11.0, 12200),
            (1e-12, 12.0, 32000),
        ],
    );
}

#[test]
fn van_der_pol() {
    check(
        &VAN_DER_POL,
        [
            (1e-4, 3.0, 2300),
            (1e-7, 6.7, 8000),
            (1e-10, 10.2, 41500),
            (1e-11, 11.0, 70000),
        ],
    );
}

#[test]
fn robertson() {
    check(
        &ROBERTSON,
        [
            (1e-4, 3.7, 1500),
            (1e-7, 7.8, 6500),
            (1e-10, 11.3, 34000),
            (1e-11, 11.8, 56000),
        ],
    );
}

/// The steps of the original program, subroutine RADAU5 with the tolerance transformed as there, for van der Pol with ε = 1e-6:
/// 280 steps, 242 accepted, 668 iterations, 162 Jacobians, 253 pairs of factorisations.
#[test]
fn work_of_the_original() {
    let rhs = |_: f64, y: &[f64], dy: &mut [f64]| {
        (dy[0], dy[1]) = (y[1], ((1.0 - y[0] * y[0]) * y[1] - y[0]) / 1e-6);
        Ok(())
    };
    let tolerance = 0.1 * f64::powf(1e-4, 2.0 / 3.0);
    let settings = Settings {
        first_step: Some(1e-6),
        ..Settings::tolerances(tolerance, tolerance)
    };
    let (y, found) = solve(
        Function(2, rhs),
        Radau5::default().with_reuse(0.001),
        &[2.0, -0.66],
        2.0,
        settings,
    );
    // The result of the original differs from the exact one by 5e-6 and 2e-5.
    assert!(
        (y[0] - 1.706163).abs() < 2e-5 && (y[1] + 0.892797).abs() < 5e-5,
        "{y:?}"
    );
    let near = |found: u64, original: u64| (0.9..1.1).contains(&(found as f64 / original as f64));
    assert!(
        near(found.accepted + found.rejected, 280) && near(found.accepted, 242),
        "{found:?}"
    );
    assert!(near(found.iterations, 668), "{found:?}");
    // Steps that shrink a little keep their factors here.
    assert!(
        near(found.jacobians, 162) && found.factorisations < 2 * 253,
        "{found:?}"
    );
}

/// The same by backward differentiation: digits grow with each power of ten.
fn check_bdf(problem: &Standard, least: [f64; 7], most: [u64; 7]) {
    for (i, (least, most)) in least.into_iter().zip(most).enumerate() {
        let relative = f64::powi(10.0, -4 - i as i32);
        let (digits, statistics) = digits(problem, Bdf::default(), relative);
        assert!(digits >= least, "{}, {relative:e}: {digits} digits", problem.name);
        assert!(
            statistics.evaluations <= most,
            "{}, {relative:e}: {statistics:?}",
            problem.name
        );
    }
}

#[test]
fn hires_by_bdf() {
    let digits = [2.0, 2.9, 3.7, 4.9, 5.7, 6.6, 7.4];
    check_bdf(&HIRES, digits, [420, 520, 680, 860, 1140, 1590, 2270]);
}

#[test]
fn van_der_pol_by_bdf() {
    let digits = [2.6, 3.2, 4.1, 5.3, 6.1, 6.9, 7.7];
    check_bdf(&VAN_DER_POL, digits, [1010, 1340, 1720, 2300, 3320, 4810, 7030]);
}

#[test]
fn robertson_by_bdf() {
    let digits = [3.0, 3.7, 4.4, 5.1, 5.9, 6.7, 7.6];
    check_bdf(&ROBERTSON, digits, [790, 1060, 1410, 1920, 2720, 3910, 5690]);
}

/// What the work of these runs is made of, exactly: a change that costs or saves work shows.
#[test]
fn counters_of_bdf() {
    let counters = |problem: &Standard| {
        let s = digits(problem, Bdf::default(), 1e-6).1;
        let steps = [s.accepted, s.rejected, s.divergences];
        (steps, [s.evaluations, s.jacobians, s.factorisations, s.iterations])
    };
    let found = [counters(&HIRES), counters(&VAN_DER_POL), counters(&ROBERTSON)];
    let expected = [
        ([347, 0, 0], [635, 21, 106, 466]),
        ([1177, 4, 0], [1547, 71, 464, 1409]),
        ([959, 3, 0], [1286, 52, 273, 1129]),
    ];
    assert_eq!(found, expected);
}
