//! Large static bending of a cantilever: the chain in one plane against the elastica.

use crate::fixtures::*;
use linkdyn_rfem::*;
use std::f64::consts::PI;

/// α = P L²/(E I); tip angle, x/L and deflection/L, by elliptic integrals.
const DEAD_TIP_LOAD: [(f64, [f64; 3]); 7] = [
    (0.1, [0.0499542557548, 0.999334600037, 0.0332953192682]),
    (0.5, [0.244533647133, 0.984081037529, 0.162143575658]),
    (1.0, [0.461351949712, 0.943566763717, 0.3017207738]),
    (2.0, [0.781749831557, 0.839358279175, 0.493457480397]),
    (3.0, [0.986016946711, 0.745579815436, 0.60325344113]),
    (5.0, [1.21536811761, 0.612371639276, 0.713791523612]),
    (10.0, [1.4302855388, 0.445004402246, 0.81060902488]),
];

/// Tip angle, x and deflection of a chain that is clamped at its start.
fn tip(beam: &Beam, angles: &[f64]) -> [f64; 3] {
    let mut at = [0.0, beam.elements[0].length, 0.0];
    for (rfe, angle) in beam.elements[1..].iter().zip(angles) {
        at = [
            *angle,
            at[1] + rfe.length * angle.cos(),
            at[2] + rfe.length * angle.sin(),
        ];
    }
    at
}

/// Directions of the elements behind the clamp under a dead force P across the beam at its tip.
///
/// The moments in sde r and r + 1 differ by P l_r cos θ_r: a tridiagonal system, solved by Newton's method from a straight beam
/// with the load put on in steps.
fn bent(beam: &Beam, load: f64) -> Vec<f64> {
    let n = beam.springs.len();
    let c: Vec<f64> = beam.springs.iter().map(|sde| sde.bend[1].stiffness).collect();
    let l: Vec<f64> = beam.elements[1..].iter().map(|rfe| rfe.length).collect();
    let mut theta = vec![0.0; n];
    for share in 1..=20 {
        let p = load * f64::from(share) / 20.0;
        let mut correction = f64::INFINITY;
        for _ in 0..30 {
            // c_r (θ_r - θ_{r-1}) - c_{r+1} (θ_{r+1} - θ_r) = P l_r cos θ_r, by Thomas' elimination from the clamp.
            let (mut pivots, mut right) = (vec![0.0; n], vec![0.0; n]);
            for r in 0..n {
                let before = if r == 0 { 0.0 } else { theta[r - 1] };
                let (next, moment) = if r + 1 < n {
                    (c[r + 1], c[r + 1] * (theta[r + 1] - theta[r]))
                } else {
                    (0.0, 0.0)
                };
                right[r] = p * l[r] * theta[r].cos() + moment - c[r] * (theta[r] - before);
                pivots[r] = c[r] + next + p * l[r] * theta[r].sin();
                if r > 0 {
                    right[r] += c[r] / pivots[r - 1] * right[r - 1];
                    pivots[r] -= c[r] * c[r] / pivots[r - 1];
                }
            }
            correction = 0.0;
            let mut step = 0.0;
            for r in (0..n).rev() {
                let coupling = if r + 1 < n { c[r + 1] } else { 0.0 };
                step = (right[r] + coupling * step) / pivots[r];
                theta[r] += step;
                correction = f64::max(correction, f64::abs(step));
            }
            if correction < 1e-15 {
                break;
            }
        }
        assert!(
            correction < 1e-12,
            "Newton's method ended with a step of {correction:e}"
        );
    }
    theta
}

fn bent_tip(alpha: f64, n: usize) -> [f64; 3] {
    let section = OWN;
    let beam = standard(1.0, &section, n);
    tip(&beam, &bent(&beam, alpha * STEEL.youngs_modulus * section.bending[1]))
}

#[test]
fn benchmark_18_elastica_second_order() {
    for (alpha, wanted) in DEAD_TIP_LOAD {
        let [coarse, fine] = [64, 128].map(|n| bent_tip(alpha, n));
        for k in 0..3 {
            let (coarse, fine) = (coarse[k] - wanted[k], fine[k] - wanted[k]);
            // 1 % of order, and the last digit of the reference.
            assert!(
                (coarse - 4.0 * fine).abs() < 0.01 * coarse.abs() + 4e-12,
                "{alpha} {k} {coarse:e} {fine:e}"
            );
            assert!(fine.abs() < 1e-4, "{alpha} {k} {fine:e}");
        }
    }
}

/// Errors are a series in 1/n², so that doublings extrapolate to the digits of the elliptic integrals.
#[test]
fn benchmark_18_elastica_extrapolated() {
    for (alpha, wanted) in DEAD_TIP_LOAD {
        let mut row: Vec<[f64; 3]> = [8, 16, 32, 64, 128].map(|n| bent_tip(alpha, n)).into();
        let mut power = 1.0;
        while row.len() > 1 {
            power *= 4.0;
            let better = |pair: &[[f64; 3]]| [0, 1, 2].map(|k| pair[1][k] + (pair[1][k] - pair[0][k]) / (power - 1.0));
            row = row.windows(2).map(better).collect();
        }
        for k in 0..3 {
            assert!(
                (row[0][k] - wanted[k]).abs() < 2e-11,
                "{alpha} {k} {:e}",
                row[0][k] - wanted[k]
            );
        }
    }
}

#[test]
fn benchmark_18_elastica_end_moment_closes_a_circle() {
    for n in [3, 4, 7, 50] {
        let beam = standard(1.0, &OWN, n);
        let moment = 2.0 * PI * STEEL.youngs_modulus * OWN.bending[1];
        let mut angle = 0.0;
        let turned = beam.springs.iter().map(|sde| {
            angle += moment / sde.bend[1].stiffness;
            angle
        });
        let [angle, x, y] = tip(&beam, &turned.collect::<Vec<_>>());
        assert!((angle - 2.0 * PI).abs() < 1e-13, "{n} {angle}");
        assert!(x.abs() < 1e-14 && y.abs() < 1e-14, "{n} {x:e} {y:e}");
    }
}

/// A quarter of the moment that closes the circle: an arc of radius E I/M, its chord met in second order.
#[test]
fn benchmark_18_elastica_end_moment_bends_an_arc() {
    let moment = 0.5 * PI * STEEL.youngs_modulus * OWN.bending[1];
    let radius = 2.0 / PI;
    let error = |n| {
        let beam = standard(1.0, &OWN, n);
        let angles: Vec<f64> = (1..=n)
            .map(|r| r as f64 * moment / beam.springs[0].bend[1].stiffness)
            .collect();
        let [angle, x, y] = tip(&beam, &angles);
        near(angle, 0.5 * PI, 1e-14);
        (x - radius).hypot(y - radius)
    };
    assert!(error(64) < 1e-4);
    near(error(32) / error(64), 4.0, 1e-2);
}
