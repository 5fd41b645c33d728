//! Andrews' squeezer (benchmark 01-andrews-squeezer): seven angles, six constraints, in every form by every method that takes it.

use linkdyn_integrators::{
    Adams, Constrained, Dop853, Equations, EvalError, Form, GeneralisedAlpha, Integration, Method, Progress, Radau5,
    Settings, Statistics, Terms,
};

use crate::problems::{boxed, distance};

const END: f64 = 0.03;
const MOMENT: f64 = 0.033;

// Points, lengths, centres, spring, and what the bodies weigh, in SI units, by the names of the test set for IVP solvers.
const A: [f64; 2] = [-0.06934, -0.00227];
const B: [f64; 2] = [-0.03635, 0.03273];
const C: [f64; 2] = [0.014, 0.072];
const C0: f64 = 4530.0;
const L0: f64 = 0.07785;
const D: f64 = 0.028;
const DA: f64 = 0.0115;
const E: f64 = 0.02;
const EA: f64 = 0.01421;
const RR: f64 = 0.007;
const RA: f64 = 0.00092;
const SS: f64 = 0.035;
const SA: f64 = 0.01874;
const SB: f64 = 0.01043;
const SC: f64 = 0.018;
const SD: f64 = 0.02;
const TA: f64 = 0.02308;
const TB: f64 = 0.00916;
const U: f64 = 0.04;
const UA: f64 = 0.01228;
const UB: f64 = 0.00449;
const ZF: f64 = 0.02;
const ZT: f64 = 0.04;
const FA: f64 = 0.01421;
const M: [f64; 7] = [0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498];
const I: [f64; 7] = [2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5];

struct Squeezer;

const START: [f64; 7] = [
    -0.06171389001427645,
    0.0,
    0.4552798191630704,
    0.2226683901658859,
    0.48736497954384255,
    -0.2226683901658859,
    1.2305474445498212,
];

impl Squeezer {
    /// End of the spring on the third part, C to there, and length.
    fn spring(gamma: f64) -> ([f64; 2], f64) {
        let (s, c) = gamma.sin_cos();
        let reach = [B[0] + SD * c + SC * s - C[0], B[1] + SD * s - SC * c - C[1]];
        (reach, reach[0].hypot(reach[1]))
    }

    /// Kinetic and spring energy.
    fn energy(q: &[f64], v: &[f64]) -> f64 {
        let mut terms = Terms::new(7, 6);
        Squeezer.evaluate(0.0, q, v, &mut terms).expect("no failure");
        let row = |i: usize| -> f64 { terms.matrix[7 * i..][..7].iter().zip(v).map(|(m, v)| m * v).sum() };
        let kinetic: f64 = (0..7).map(|i| 0.5 * v[i] * row(i)).sum();
        let (_, length) = Self::spring(q[2]);
        kinetic + 0.5 * C0 * (length - L0) * (length - L0)
    }
}

impl Constrained for Squeezer {
    fn positions(&self) -> usize {
        7
    }
    fn constraints(&self) -> usize {
        6
    }
    fn evaluate(&mut self, _t: f64, q: &[f64], v: &[f64], terms: &mut Terms) -> Result<(), EvalError> {
        let &[_, theta, gamma, phi, _, omega, _] = q else {
            return Err(EvalError::Abort("seven angles".into()));
        };
        let &[vb, vt, _, vp, vd, vo, ve] = v else {
            return Err(EvalError::Abort("seven rates".into()));
        };
        let ((st, ct), (sp, cp), (so, co)) = (theta.sin_cos(), phi.sin_cos(), omega.sin_cos());
        let (e, z) = (E - EA, ZF - FA);
        let mut put =
            |i: usize, j: usize, value: f64| (terms.matrix[7 * i + j], terms.matrix[7 * j + i]) = (value, value);
        put(
            0,
            0,
            M[0] * RA * RA + M[1] * (RR * RR - 2.0 * DA * RR * ct + DA * DA) + I[0] + I[1],
        );
        put(0, 1, M[1] * (DA * DA - DA * RR * ct) + I[1]);
        put(1, 1, M[1] * DA * DA + I[1]);
        put(2, 2, M[2] * (SA * SA + SB * SB) + I[2]);
        put(3, 3, M[3] * e * e + I[3]);
        put(3, 4, M[3] * (e * e + ZT * e * sp) + I[3]);
        put(
            4,
            4,
            M[3] * (ZT * ZT + 2.0 * ZT * e * sp + e * e) + M[4] * (TA * TA + TB * TB) + I[3] + I[4],
        );
        put(5, 5, M[5] * z * z + I[5]);
        put(5, 6, M[5] * (z * z - U * z * so) + I[5]);
        put(
            6,
            6,
            M[5] * (z * z - 2.0 * U * z * so + U * U) + M[6] * (UA * UA + UB * UB) + I[5] + I[6],
        );

        let (reach, length) = Self::spring(gamma);
        let pull = -C0 * (length - L0) / length;
        let (fx, fy) = (pull * reach[0], pull * reach[1]);
        let (sg, cg) = gamma.sin_cos();
        terms.force.copy_from_slice(&[
            MOMENT - M[1] * DA * RR * vt * (vt + 2.0 * vb) * st,
            M[1] * DA * RR * vb * vb * st,
            fx * (SC * cg - SD * sg) + fy * (SD * cg + SC * sg),
            M[3] * ZT * e * vd * vd * cp,
            -M[3] * ZT * e * vp * (vp + 2.0 * vd) * cp,
            -M[5] * U * z * ve * ve * co,
            M[5] * U * z * vo * (vo + 2.0 * ve) * co,
        ]);

        // Constraints are sums of arms: length, constant angle, the angles that turn it. Cosines in even rows, sines in odd ones.
        let quarter = 0.5 * std::f64::consts::PI;
        let arms: [&[(f64, f64, &[usize])]; 3] = [
            &[(RR, 0.0, &[0]), (-D, 0.0, &[0, 1]), (SS, quarter, &[2])],
            &[
                (RR, 0.0, &[0]),
                (-D, 0.0, &[0, 1]),
                (E, quarter, &[3, 4]),
                (-ZT, 0.0, &[4]),
            ],
            &[
                (RR, 0.0, &[0]),
                (-D, 0.0, &[0, 1]),
                (-ZF, 0.0, &[5, 6]),
                (U, quarter, &[6]),
            ],
        ];
        for (k, (arms, [x, y])) in arms.iter().zip([B, A, A]).enumerate() {
            (terms.constraint[2 * k], terms.constraint[2 * k + 1]) = (-x, -y);
            for &(length, constant, angles) in *arms {
                let (angle, rate): (f64, f64) = angles.iter().fold((constant, 0.0), |(a, r), &i| (a + q[i], r + v[i]));
                let (s, c) = (length * angle.sin(), length * angle.cos());
                terms.constraint[2 * k] += c;
                terms.constraint[2 * k + 1] += s;
                terms.bias[2 * k] -= c * rate * rate;
                terms.bias[2 * k + 1] -= s * rate * rate;
                for &i in angles {
                    terms.gradient[7 * 2 * k + i] -= s;
                    terms.gradient[7 * (2 * k + 1) + i] += c;
                }
            }
        }
        Ok(())
    }
}

/// Angles at the end, published, good for 9.5 digits; and multipliers, good for 6.
const ANGLES: [f64; 7] = [
    15.81077119629904,
    -15.75637105984298,
    0.04082224013073101,
    -0.5347301163226948,
    0.5244099658805303,
    0.5347301163226948,
    1.048080741042263,
];
const MULTIPLIERS: [f64; 6] = [
    199.175333373191,
    -29.75531228015052,
    23.06654119098399,
    31.45271365475927,
    22.64249232082739,
    11.61740700019673,
];

struct Outcome {
    /// Relative where they are larger than 1.
    angles: f64,
    multipliers: f64,
    /// Changes of E - moment (beta - beta0), and Phi + Omega.
    invariants: [f64; 2],
    statistics: Statistics,
}

fn run<M: Method<Equations<Squeezer>>>(form: Form, projected: bool, method: M, tolerance: f64) -> Outcome {
    let equations = Equations::new(Squeezer, form);
    let mut equations = if projected {
        equations.with_projection()
    } else {
        equations
    };
    let y = equations.start(0.0, &START, &[0.0; 7]).expect("consistent");
    // Rates are some thousand times the angles.
    let mut absolute = vec![tolerance; y.len()];
    absolute[7..].fill(1e3 * tolerance);
    let settings = Settings::tolerances(tolerance, absolute);
    let start = Squeezer::energy(&y[..7], &y[7..14]);
    let mut run = Integration::new(equations, boxed(method), 0.0, &y, settings).expect("it fits");
    while !matches!(run.advance(END).expect("it ends"), Progress::Done { .. }) {}
    let (statistics, y) = (run.statistics(), run.state().1.to_vec());
    let equations = run.problem_mut();
    let lambda = match form {
        Form::Explicit => equations.multipliers_at(END, &y).expect("an ordinary state").to_vec(),
        _ => equations.multipliers(&y).to_vec(),
    };
    let energy = Squeezer::energy(&y[..7], &y[7..14]) - start - MOMENT * (y[0] - START[0]);
    Outcome {
        angles: y
            .iter()
            .zip(&ANGLES)
            .map(|(a, b)| (a - b).abs() / b.abs().max(1.0))
            .fold(0.0, f64::max),
        multipliers: distance(&lambda, &MULTIPLIERS),
        invariants: [energy.abs(), (y[3] + y[5]).abs()],
        statistics,
    }
}

#[test]
fn the_start_is_the_published_one() {
    let mut equations = Equations::new(Squeezer, Form::Index3);
    let y = equations.start(0.0, &START, &[0.0; 7]).expect("consistent");
    assert!(distance(&y[..7], &START) < 1e-15);
    let lambda = [98.56687039624109, -6.122688344255662, 0.0, 0.0, 0.0, 0.0];
    assert!(distance(equations.multipliers(&y), &lambda) < 1e-10, "{y:?}");
    let energy = Squeezer::energy(&y[..7], &y[7..14]) - MOMENT * y[0];
    assert!((energy - 1.43783295753).abs() < 1e-10, "{energy}");
}

/// Largest errors of angles and multipliers, of the invariants, and most evaluations.
fn check(name: &str, outcome: &Outcome, most: [f64; 4], evaluations: u64) {
    let found = [
        outcome.angles,
        outcome.multipliers,
        outcome.invariants[0],
        outcome.invariants[1],
    ];
    for (found, most) in found.iter().zip(most) {
        assert!(*found < most, "{name}: {found:e}, expected below {most:e}");
    }
    assert!(
        outcome.statistics.evaluations < evaluations,
        "{name}: {:?}",
        outcome.statistics
    );
}

/// The published angles are good for 1e-9, multipliers for 1e-6 of their size.
#[test]
fn explicit_methods() {
    for projected in [false, true] {
        let invariants = if projected { [1e-10, 1e-12] } else { [1e-9, 1e-10] };
        let most = [1e-9, 1e-4, invariants[0], invariants[1]];
        let outcome = run(Form::Explicit, projected, Dop853::default(), 1e-11);
        check("Dop853", &outcome, most, 2_000);
        let outcome = run(Form::Explicit, projected, Adams::default(), 1e-12);
        check("Adams", &outcome, [1e-9, 1e-4, 1e-9, 1e-10], 2_000);
    }
}

#[test]
fn radau_in_every_form() {
    for (form, projected, tolerance, most) in [
        (Form::Explicit, true, 1e-9, [1e-9, 1e-4, 1e-9, 1e-11]),
        (Form::Index1, true, 1e-9, [1e-9, 1e-4, 1e-9, 1e-11]),
        (Form::Index2, false, 1e-9, [1e-9, 1e-4, 1e-9, 1e-11]),
        (Form::Stabilised, false, 1e-9, [1e-9, 1e-4, 1e-9, 1e-13]),
        // Multipliers of index 3 are of order 2 only.
        (Form::Index3, false, 1e-9, [1e-7, 0.1, 1e-8, 1e-13]),
        (Form::Index3, true, 1e-11, [1e-9, 1e-4, 1e-9, 1e-13]),
    ] {
        let outcome = run(form, projected, Radau5::default(), tolerance);
        check(&format!("{form:?} {projected}"), &outcome, most, 200_000);
    }
}

#[test]
fn generalised_alpha() {
    for projected in [false, true] {
        let outcomes = [2e-5, 1e-5].map(|h| run(Form::Index3, projected, GeneralisedAlpha::fixed(h), 1e-6));
        let [rough, fine] = &outcomes;
        check("alpha", fine, [1e-5, 0.05, 1e-4, 1e-13], 20_000);
        for (rough, fine) in [(rough.angles, fine.angles), (rough.multipliers, fine.multipliers)] {
            assert!((3.0..5.0).contains(&(rough / fine)), "order 2: {rough:e} {fine:e}");
        }
        // By tolerance: multipliers feel every change of the step unless rates are projected.
        let multipliers = if projected { 0.3 } else { 100.0 };
        let outcome = run(Form::Index3, projected, GeneralisedAlpha::default(), 1e-7);
        check("alpha", &outcome, [1e-3, multipliers, 1e-3, 1e-10], 20_000);
    }
}
