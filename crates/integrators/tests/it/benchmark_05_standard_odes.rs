//! Stiff problems of the test set for IVP solvers (benchmark 05-standard-odes): digits and work.

use linkdyn_integrators::{Bdf, EvalError, Method, Radau5, Settings, Statistics};

use crate::problems::{Function, solve};

pub type Rhs = fn(f64, &[f64], &mut [f64]) -> Result<(), EvalError>;

pub struct Standard {
    rhs: Rhs,
    start: &'static [f64],
    end: f64,
    exact: &'static [f64],
}

/// Eight reactions with light.
pub const HIRES: Standard = Standard {
    rhs: |_, y, dy| {
        let reaction = 280.0 * y[5] * y[7];
        dy[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007;
        dy[1] = 1.71 * y[0] - 8.75 * y[1];
        dy[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
        dy[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
        dy[4] = -1.745 * y[4] + 0.43 * (y[5] + y[6]);
        dy[5] = -reaction + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
        dy[6] = reaction - 1.81 * y[6];
        dy[7] = -dy[6];
        Ok(())
    },
    start: &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057],
    end: 321.8122,
    exact: &[
        0.0007371312573325668,
        0.0001442485726316185,
        5.888729740967575e-05,
        0.001175651343283149,
        0.002386356198831331,
        0.006238968252742796,
        0.002849998395185769,
        0.002850001604814231,
    ],
};

pub const VAN_DER_POL: Standard = Standard {
    rhs: |_, y, dy| {
        (dy[0], dy[1]) = (y[1], 1000.0 * (1.0 - y[0] * y[0]) * y[1] - y[0]);
        Ok(())
    },
    start: &[2.0, 0.0],
    end: 2000.0,
    exact: &[1.706167732170469, -0.0008928097010248125],
};

pub const ROBERTSON: Standard = Standard {
    rhs: |_, y, dy| {
        (dy[0], dy[2]) = (-0.04 * y[0] + 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
        dy[1] = -dy[0] - dy[2];
        Ok(())
    },
    start: &[1.0, 0.0, 0.0],
    end: 1e11,
    exact: &[2.083340149701255e-08, 8.333360770334713e-14, 0.999999979166505],
};

/// Digits of the worst component at the end, relative to its value.
pub fn digits(
    problem: &Standard,
    method: impl Method<Function<Rhs>>,
    relative: f64,
    absolute: f64,
) -> (f64, Statistics) {
    let settings = Settings {
        first_step: Some(1e-6),
        ..Settings::tolerances(relative, absolute)
    };
    let &Standard { rhs, start, end, exact } = problem;
    let (y, statistics) = solve(Function(start.len(), rhs), method, start, end, settings);
    let digits = |(y, exact): (&f64, &f64)| -((y - exact) / exact).abs().log10();
    (
        y.iter().zip(exact).map(digits).fold(f64::INFINITY, f64::min),
        statistics,
    )
}

/// At each relative tolerance: at least so many digits, at most so many evaluations. Absolute tolerances are smaller by `ratio`.
fn check(problem: &Standard, ratio: f64, expected: [(f64, f64, u64); 4]) {
    for (relative, least, most) in expected {
        let (digits, statistics) = digits(problem, Radau5::default(), relative, ratio * relative);
        assert!(digits >= least, "{relative:e}: {digits} digits");
        assert!(statistics.evaluations <= most, "{relative:e}: {statistics:?}");
    }
}

#[test]
fn hires() {
    check(
        &HIRES,
        1e-2,
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
        1.0,
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
        1e-6,
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
    let rhs: Rhs = |_, y, dy| {
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
fn check_bdf(problem: &Standard, ratio: f64, least: [f64; 7], most: [u64; 7]) {
    for (i, (least, most)) in least.into_iter().zip(most).enumerate() {
        let relative = f64::powi(10.0, -4 - i as i32);
        let (digits, statistics) = digits(problem, Bdf::default(), relative, ratio * relative);
        assert!(digits >= least, "{relative:e}: {digits} digits");
        assert!(statistics.evaluations <= most, "{relative:e}: {statistics:?}");
    }
}

#[test]
fn hires_by_bdf() {
    let digits = [2.0, 2.9, 3.7, 4.9, 5.7, 6.6, 7.4];
    check_bdf(&HIRES, 1e-2, digits, [420, 520, 680, 860, 1140, 1590, 2270]);
}

#[test]
fn van_der_pol_by_bdf() {
    let digits = [2.6, 3.2, 4.1, 5.3, 6.1, 6.9, 7.7];
    check_bdf(&VAN_DER_POL, 1.0, digits, [1010, 1340, 1720, 2300, 3320, 4810, 7030]);
}

#[test]
fn robertson_by_bdf() {
    let digits = [3.0, 3.7, 4.4, 5.1, 5.9, 6.7, 7.6];
    check_bdf(&ROBERTSON, 1e-6, digits, [790, 1060, 1410, 1920, 2720, 3910, 5690]);
}

/// What the work of these runs is made of, exactly: a change that costs or saves work shows.
#[test]
fn counters_of_bdf() {
    let counters = |problem: &Standard, ratio: f64| {
        let s = digits(problem, Bdf::default(), 1e-6, ratio * 1e-6).1;
        let steps = [s.accepted, s.rejected, s.divergences];
        (steps, [s.evaluations, s.jacobians, s.factorisations, s.iterations])
    };
    let found = [
        counters(&HIRES, 1e-2),
        counters(&VAN_DER_POL, 1.0),
        counters(&ROBERTSON, 1e-6),
    ];
    let expected = [
        ([347, 0, 0], [635, 21, 106, 466]),
        ([1177, 4, 0], [1547, 71, 464, 1409]),
        ([959, 3, 0], [1286, 52, 273, 1129]),
    ];
    assert_eq!(found, expected);
}
