//! The chain that twists.

use crate::fixtures::*;
use linkdyn_rfem::modes::{BarEnds, torsion_frequency};
use linkdyn_rfem::*;
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// Angular frequencies, lowest first, of a chain free at both ends; the turn of the whole is left out.
fn free(beam: &Beam) -> Vec<f64> {
    let n = beam.elements.len();
    let root = |r: usize| beam.elements[r].inertia[0].sqrt();
    let mut k = DMatrix::<f64>::zeros(n, n);
    for (s, sde) in beam.springs.iter().enumerate() {
        let c = sde.twist.stiffness;
        k[(s, s)] += c / (root(s) * root(s));
        k[(s + 1, s + 1)] += c / (root(s + 1) * root(s + 1));
        k[(s, s + 1)] -= c / (root(s) * root(s + 1));
        k[(s + 1, s)] -= c / (root(s) * root(s + 1));
    }
    let mut squares: Vec<f64> = k.symmetric_eigenvalues().iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    squares[1..].iter().map(|square| square.sqrt()).collect()
}

/// Halves at the ends make the chain the lumped one of textbooks: ω_k = (2 n/L) √(G J/(ρ I_p)) sin(k π/(2n)).
#[test]
fn frequencies_of_the_chain_in_closed_form() {
    let l = 0.4;
    let sections = [
        OWN,
        Section::circle(0.01).unwrap(),
        Section::rectangle(0.02, 0.004).unwrap(),
    ];
    for section in sections {
        let speed = (STEEL.shear_modulus * section.torsion / (STEEL.density * section.polar())).sqrt();
        for n in [1, 4, 9] {
            let found = free(&standard(l, &section, n));
            assert_eq!(found.len(), n);
            for (k, found) in found.iter().enumerate() {
                let wanted = 2.0 * n as f64 / l * speed * ((k + 1) as f64 * PI / (2 * n) as f64).sin();
                near(*found, wanted, 1e-12);
            }
        }
    }
}

#[test]
fn frequencies_tend_to_those_of_the_bar_in_second_order() {
    let section = Section::rectangle(0.02, 0.004).unwrap();
    let error = |n, k: u32| {
        let wanted = torsion_frequency(0.4, &section, &STEEL, BarEnds::FreeFree, k).unwrap();
        free(&standard(0.4, &section, n))[k as usize - 1] / wanted - 1.0
    };
    for k in 1..=3 {
        assert!(error(64, k).abs() < 1e-3);
        near(error(32, k) / error(64, k), 4.0, 0.01);
    }
}

/// The published coupler, four sdes: its fastest motion, to which explicit steps have to keep.
#[test]
fn coupler_of_the_paper() {
    let steel = Material::isotropic(7850.0, 2.1e11, 0.3, 2e-5).unwrap();
    let section = Section::circle(0.01).unwrap();
    let found = free(&divide(0.4, &section, &steel, Division::Standard(4)).unwrap());
    assert!(
        (found[0] - 24.55e3).abs() < 10.0 && (found[3] - 64.15e3).abs() < 10.0,
        "{found:?}"
    );
}

/// Static twist under a torque at the end: exact for the standard division; equal elements lose the two outer halves.
#[test]
fn static_twist() {
    let flexibility = |division| {
        let beam = divide(0.4, &OWN, &STEEL, division).unwrap();
        beam.springs.iter().map(|sde| 1.0 / sde.twist.stiffness).sum::<f64>()
    };
    let exact = 0.4 / (STEEL.shear_modulus * OWN.torsion);
    for n in [1, 2, 5, 31] {
        near(flexibility(Division::Standard(n)), exact, 1e-14);
        near(
            flexibility(Division::Equal(n + 1)),
            exact * n as f64 / (n + 1) as f64,
            1e-14,
        );
    }
}

/// Twist takes neither moment of bending, bending not the torsion constant, stretch the area alone.
#[test]
fn each_stiffness_has_its_own_constant() {
    let sde = standard(2.0, &OWN, 4).springs[0];
    let (e, g) = (STEEL.youngs_modulus, STEEL.shear_modulus);
    near(sde.twist.stiffness, g * 7e-9 / 0.5, 1e-15);
    near(sde.bend[0].stiffness, e * 5e-9 / 0.5, 1e-15);
    near(sde.bend[1].stiffness, e * 2e-8 / 0.5, 1e-15);
    near(sde.stretch.stiffness, e * 3e-4 / 0.5, 1e-15);
    near(sde.shear[0].stiffness, g * 3e-4 / (1.5 * 0.5), 1e-15);
    near(sde.shear[1].stiffness, g * 3e-4 / (2.5 * 0.5), 1e-15);
}
