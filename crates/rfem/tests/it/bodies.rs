//! Rigid elements: where they lie, and what they weigh together.

use crate::fixtures::*;
use linkdyn_rfem::*;
use proptest::prelude::*;

#[test]
fn standard_division_of_four() {
    let beam = standard(0.8, &OWN, 4);
    let starts: Vec<f64> = beam.elements.iter().map(|rfe| rfe.start).collect();
    let lengths: Vec<f64> = beam.elements.iter().map(|rfe| rfe.length).collect();
    let sdes: Vec<f64> = beam.springs.iter().map(|sde| sde.position).collect();
    let same = |found: &[f64], wanted: &[f64]| {
        assert_eq!(found.len(), wanted.len());
        assert!(
            found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-15),
            "{found:?}"
        );
    };
    same(&starts, &[0.0, 0.1, 0.3, 0.5, 0.7]);
    same(&lengths, &[0.1, 0.2, 0.2, 0.2, 0.1]);
    same(&sdes, &[0.1, 0.3, 0.5, 0.7]);
}

#[test]
fn equal_division_of_four() {
    let beam = divide(0.8, &OWN, &STEEL, Division::Equal(4)).unwrap();
    for (r, rfe) in beam.elements.iter().enumerate() {
        assert!((rfe.start - 0.2 * r as f64).abs() < 1e-15);
        assert_eq!((rfe.length, rfe.mass), (0.2, beam.elements[0].mass));
    }
    assert_eq!((beam.elements.len(), beam.springs.len()), (4, 3));
}

/// m d²/8 and m (3 d² + 4 l²)/48 of the published cylinder.
#[test]
fn elements_of_a_round_bar_are_cylinders() {
    let d: f64 = 0.028;
    let beam = standard(0.2, &Section::circle(d).unwrap(), 3);
    for rfe in &beam.elements {
        let (m, l) = (rfe.mass, rfe.length);
        near(m, 7850.0 * std::f64::consts::PI * d * d / 4.0 * l, 1e-14);
        near(rfe.inertia[0], m * d * d / 8.0, 1e-14);
        near(rfe.inertia[1], m * (3.0 * d * d + 4.0 * l * l) / 48.0, 1e-14);
        assert_eq!(rfe.inertia[1], rfe.inertia[2]);
    }
}

/// m (a² + b²)/12 about each axis, a and b the sides across it.
#[test]
fn elements_of_a_rectangular_bar_are_boxes() {
    let (b, h) = (0.05, 0.01);
    for rfe in &standard(0.3, &Section::rectangle(b, h).unwrap(), 2).elements {
        let (m, l) = (rfe.mass, rfe.length);
        near(rfe.inertia[0], m * (b * b + h * h) / 12.0, 1e-14);
        near(rfe.inertia[1], m * (l * l + h * h) / 12.0, 1e-14);
        near(rfe.inertia[2], m * (l * l + b * b) / 12.0, 1e-14);
    }
}

#[test]
fn largest_number_is_accepted() {
    let beam = standard(1.0, &OWN, MAX_COUNT);
    assert_eq!(beam.elements.len(), MAX_COUNT + 1);
}

proptest! {
    #[test]
    fn nothing_is_lost_by_cutting(
        l in 1e-3..50.0, section in any_section(), material in any_material(), division in any_division(),
    ) {
        let beam = divide(l, &section, &material, division).unwrap();
        let rfes = &beam.elements;
        let mass: f64 = rfes.iter().map(|rfe| rfe.mass).sum();
        let whole = material.density * section.area * l;
        near(mass, whole, 1e-13);
        let centre = rfes.iter().map(|rfe| rfe.mass * rfe.centre()).sum::<f64>() / mass;
        near(centre, l / 2.0, 1e-13);
        let axial: f64 = rfes.iter().map(|rfe| rfe.inertia[0]).sum();
        near(axial, material.density * section.polar() * l, 1e-13);
        for about in [0, 1] {
            let steiner = |rfe: &Rfe| rfe.inertia[1 + about] + rfe.mass * (rfe.centre() - l / 2.0).powi(2);
            let found: f64 = rfes.iter().map(steiner).sum();
            near(found, whole * l * l / 12.0 + material.density * section.bending[about] * l, 1e-12);
        }
    }

    /// Elements follow each other without gaps, and a spring sits exactly where the next element begins.
    #[test]
    fn elements_and_springs_alternate(l in 1e-3..50.0, division in any_division()) {
        let beam = divide(l, &OWN, &STEEL, division).unwrap();
        prop_assert_eq!(beam.elements.len(), beam.springs.len() + 1);
        prop_assert_eq!(beam.elements[0].start, 0.0);
        for (sde, pair) in beam.springs.iter().zip(beam.elements.windows(2)) {
            prop_assert_eq!(sde.position, pair[1].start);
            prop_assert!((pair[0].start + pair[0].length - sde.position).abs() < 1e-14 * l);
        }
        let last = beam.elements.last().unwrap();
        near(last.start + last.length, l, 1e-14);
    }

    /// No body has one moment of inertia above the sum of the two others.
    #[test]
    fn inertia_is_that_of_a_body(l in 1e-3..50.0, section in any_section(), division in any_division()) {
        for rfe in &divide(l, &section, &STEEL, division).unwrap().elements {
            let sum: f64 = rfe.inertia.iter().sum();
            for moment in rfe.inertia {
                prop_assert!(moment <= (sum - moment) * (1.0 + 1e-14));
            }
        }
    }
}
