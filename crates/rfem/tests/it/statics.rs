//! Small static deflections under loads at the tip of a cantilever, which beam theory gives in closed form.

use crate::fixtures::*;
use linkdyn_rfem::*;
use nalgebra::{DMatrix, Matrix2};
use proptest::prelude::*;

/// Deflection and rotation of the tip by a unit force and by a unit moment there: solved as a system in displacement and
/// rotation of every element, rfe 0 clamped. Deflection along y (0) with bending about z, or along z (1) with bending about y;
/// without shear the elements are only hinged.
fn tip_flexibility(beam: &Beam, along: usize, with_shear: bool) -> Matrix2<f64> {
    let n = beam.springs.len();
    let mut k = DMatrix::<f64>::zeros(2 * n, 2 * n);
    for (s, sde) in beam.springs.iter().enumerate() {
        let bend = sde.bend[1 - along].stiffness;
        // A hinge is a shear spring so stiff that nothing but rounding is left of it.
        let shear = if with_shear {
            sde.shear[along].stiffness
        } else {
            1e6 * bend / beam.elements[1].length.powi(2)
        };
        let mut offset = DMatrix::<f64>::zeros(1, 2 * n);
        let mut turn = DMatrix::<f64>::zeros(1, 2 * n);
        for (r, sign) in [(s, -1.0), (s + 1, 1.0)].into_iter().filter(|(r, _)| *r > 0) {
            offset[2 * (r - 1)] = sign;
            offset[2 * (r - 1) + 1] = sign * (sde.position - beam.elements[r].centre());
            turn[2 * (r - 1) + 1] = sign;
        }
        k += offset.transpose() * offset * shear + turn.transpose() * turn * bend;
    }
    let half = beam.elements[n].length / 2.0;
    let mut loads = DMatrix::<f64>::zeros(2 * n, 2);
    loads[(2 * n - 2, 0)] = 1.0;
    loads[(2 * n - 1, 0)] = half;
    loads[(2 * n - 1, 1)] = 1.0;
    let moved = k.lu().solve(&loads).unwrap();
    Matrix2::from_fn(|row, load| {
        let (y, theta) = (moved[(2 * n - 2, load)], moved[(2 * n - 1, load)]);
        if row == 0 { y + half * theta } else { theta }
    })
}

#[track_caller]
fn near_matrix(found: Matrix2<f64>, wanted: Matrix2<f64>, relative: f64) {
    for (found, wanted) in found.iter().zip(wanted.iter()) {
        near(*found, *wanted, relative);
    }
}

/// Sums over the hinges: no system to solve, so exact to rounding.
fn hinged(beam: &Beam, about: usize) -> Matrix2<f64> {
    let last = beam.elements.last().unwrap();
    let tip = last.start + last.length;
    beam.springs
        .iter()
        .map(|sde| {
            let arm = tip - sde.position;
            Matrix2::new(arm * arm, arm, arm, 1.0) / sde.bend[about].stiffness
        })
        .sum()
}

#[test]
fn tip_deflects_less_by_exactly_a_quarter_of_n_squared() {
    let l = 0.7;
    for n in [1, 2, 3, 4, 5, 10, 100] {
        let beam = standard(l, &OWN, n);
        for about in [0, 1] {
            let ei = STEEL.youngs_modulus * OWN.bending[about];
            let short = 1.0 - 0.25 / (n * n) as f64;
            let wanted = Matrix2::new(short * l * l * l / 3.0, l * l / 2.0, l * l / 2.0, l) / ei;
            near_matrix(hinged(&beam, about), wanted, 1e-14);
        }
    }
}

#[test]
fn equal_division_loses_the_outer_halves() {
    let (l, n) = (0.7, 5.0);
    let beam = divide(l, &OWN, &STEEL, Division::Equal(5)).unwrap();
    let found = hinged(&beam, 0) * (STEEL.youngs_modulus * OWN.bending[0]);
    near(found[(0, 0)], 0.72 * l * l * l / 3.0, 1e-14);
    near(found[(1, 1)], (1.0 - 1.0 / n) * l, 1e-14);
}

/// Two routes to the modified form: hinges summed up, and the system of all displacements with shear nearly rigid.
#[test]
fn sums_and_systems_agree() {
    let beam = standard(0.7, &OWN, 4);
    for along in [0, 1] {
        near_matrix(tip_flexibility(&beam, along, false), hinged(&beam, 1 - along), 1e-5);
    }
}

/// Deflection by bending and shear (Timoshenko's beam) under force and moment at the tip.
fn exact(l: f64, section: &Section, along: usize) -> Matrix2<f64> {
    let ei = STEEL.youngs_modulus * section.bending[1 - along];
    let shear = section.shear_factors[along] * l / (STEEL.shear_modulus * section.area);
    Matrix2::new(
        l * l * l / (3.0 * ei) + shear,
        l * l / (2.0 * ei),
        l * l / (2.0 * ei),
        l / ei,
    )
}

#[test]
fn improved_shear_is_exact_for_any_number() {
    // Short beam: shear takes a good part of the deflection, about different amounts along y and z.
    for (l, section) in [(0.03, OWN), (1.0, OWN), (0.2, Section::rectangle(0.02, 0.05).unwrap())] {
        for n in [1, 2, 4, 9] {
            let beam = divide_with(l, &section, &STEEL, Division::Standard(n), Shear::Improved).unwrap();
            for along in [0, 1] {
                near_matrix(tip_flexibility(&beam, along, true), exact(l, &section, along), 1e-10);
            }
        }
    }
}

#[test]
fn improved_shear_takes_a_beam_rigid_in_shear() {
    let rigid = Section {
        shear_factors: [0.0, 0.0],
        ..OWN
    };
    for n in [1, 2, 4] {
        let beam = divide_with(0.5, &rigid, &STEEL, Division::Standard(n), Shear::Improved).unwrap();
        for along in [0, 1] {
            near_matrix(tip_flexibility(&beam, along, true), exact(0.5, &rigid, along), 1e-10);
        }
    }
}

#[test]
fn classical_shear_leaves_the_quarter_of_n_squared() {
    let l = 0.05;
    for n in [1_usize, 2, 4] {
        let beam = standard(l, &OWN, n);
        for along in [0, 1] {
            let ei = STEEL.youngs_modulus * OWN.bending[1 - along];
            let mut wanted = exact(l, &OWN, along);
            wanted[(0, 0)] -= l * l * l / (3.0 * ei) * 0.25 / (n * n) as f64;
            near_matrix(tip_flexibility(&beam, along, true), wanted, 1e-10);
        }
    }
}

proptest! {
    /// Springs in a row: stretch, shear, twist and the turn under an end moment are those of the uncut beam.
    #[test]
    fn flexibilities_add_up(
        l in 0.01..10.0, section in any_section(), material in any_material(), n in 1_usize..60,
    ) {
        let beam = divide(l, &section, &material, Division::Standard(n)).unwrap();
        let sum = |of: fn(&Sde) -> Coefficient| beam.springs.iter().map(|sde| 1.0 / of(sde).stiffness).sum::<f64>();
        let (e, ga) = (material.youngs_modulus, material.shear_modulus * section.area);
        near(sum(|s| s.stretch), l / (e * section.area), 1e-13);
        near(sum(|s| s.shear[0]), section.shear_factors[0] * l / ga, 1e-13);
        near(sum(|s| s.shear[1]), section.shear_factors[1] * l / ga, 1e-13);
        near(sum(|s| s.twist), l / (material.shear_modulus * section.torsion), 1e-13);
        near(sum(|s| s.bend[0]), l / (e * section.bending[0]), 1e-13);
        near(sum(|s| s.bend[1]), l / (e * section.bending[1]), 1e-13);
    }

    /// One relaxation time for all, whatever the division: a mode keeps its damping when n changes.
    #[test]
    fn damping_is_stiffness_times_relaxation_time(
        l in 0.01..10.0, section in any_section(), material in any_material(), division in any_division(),
        improved in any::<bool>(),
    ) {
        let shear = if improved { Shear::Improved } else { Shear::Classical };
        let beam = divide_with(l, &section, &material, division, shear).unwrap();
        for sde in &beam.springs {
            for c in [sde.stretch, sde.shear[0], sde.shear[1], sde.twist, sde.bend[0], sde.bend[1]] {
                prop_assert_eq!(c.damping, material.relaxation_time * c.stiffness);
            }
        }
    }
}
