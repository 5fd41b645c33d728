//! Beams under a force along their axis: Euler's loads, and frequencies that rise and fall with the force.

use crate::fixtures::*;
use crate::planar::{about, frequencies, motion, shortening};
use linkdyn_rfem::modes::{Axis, Ends};
use std::f64::consts::PI;

/// The lowest force that buckles a chain of 1 m, over π² E I/L².
fn critical(axis: Axis, ends: Ends, n: usize) -> f64 {
    let forces = shortening(&standard(1.0, &OWN, n), axis, ends).symmetric_eigenvalues();
    1.0 / forces.max() / (PI * PI * STEEL.youngs_modulus * OWN.bending[about(axis)])
}

#[test]
fn buckling_of_benchmark_17_beam_modes() {
    for axis in [Axis::Y, Axis::Z] {
        for (ends, wanted) in [(Ends::PinnedPinned, 1.0), (Ends::ClampedFree, 0.25)] {
            let [coarse, fine] = [16, 32].map(|n| critical(axis, ends, n) / wanted - 1.0);
            assert!(fine.abs() < 1e-2, "{ends:?} {fine:e}");
            near(coarse / fine, 4.0, 0.01);
        }
    }
}

/// ω(P)² = ω² (1 + P L²/(k² π² E I)) for a pinned beam: from half the buckling load to as much tension.
#[test]
fn frequencies_under_load_of_benchmark_17_beam_modes() {
    let (section, axis, ends) = (slender(), Axis::Y, Ends::PinnedPinned);
    let beam = standard(1.0, &section, 64);
    let euler = PI * PI * STEEL.youngs_modulus * section.bending[0];
    let free = frequencies(&beam, axis, ends);
    let mut b = motion(&beam, axis, ends);
    for (row, mut values) in b.row_iter_mut().enumerate() {
        let rfe = &beam.elements[row / 2];
        values *= [rfe.mass, rfe.inertia[1]][row % 2].sqrt();
    }
    let mass = b.transpose() * b;
    let work = shortening(&beam, axis, ends);
    for tension in [-0.5, -0.1, 0.3, 0.5] {
        // (1 + P G) u = ω² M u: with the Cholesky factor of the left side the largest eigenvalue is the lowest frequency's.
        let stiffness = nalgebra::DMatrix::identity(64, 64) + &work * (tension * euler);
        let l = stiffness.cholesky().unwrap().l();
        let half = l.solve_lower_triangular(&mass).unwrap();
        let mut periods: Vec<f64> = l
            .solve_lower_triangular(&half.transpose())
            .unwrap()
            .symmetric_eigenvalues()
            .iter()
            .map(|square| square.sqrt())
            .collect();
        periods.sort_by(|a, b| b.total_cmp(a));
        for k in 1..=3 {
            let wanted = (1.0 + tension / (k * k) as f64).sqrt();
            near(1.0 / periods[k - 1] / free[k - 1], wanted, 2e-3);
            assert!((wanted - 1.0).abs() > 5e-3);
        }
    }
}
