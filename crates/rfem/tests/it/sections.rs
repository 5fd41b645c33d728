//! Numbers of cross sections against closed forms, tables, and a second route.

use crate::fixtures::*;
use linkdyn_rfem::*;
use proptest::prelude::*;
use std::f64::consts::PI;

#[test]
fn circle() {
    let circle = Section::circle(0.02).unwrap();
    near(circle.area, PI * 1e-4, 1e-15);
    near(circle.bending[0], PI * 1e-8 / 4.0, 1e-15);
    assert_eq!(circle.bending[0], circle.bending[1]);
    near(circle.torsion, PI * 1e-8 / 2.0, 1e-15);
    assert_eq!(circle.torsion, circle.polar());
    near(circle.shear_factors[0], 10.0 / 9.0, 1e-15);
}

#[test]
fn tube_is_a_circle_less_a_circle() {
    let (outer, inner) = (Section::circle(0.03).unwrap(), Section::circle(0.02).unwrap());
    let tube = Section::tube(0.03, 0.02).unwrap();
    near(tube.area, outer.area - inner.area, 1e-14);
    near(tube.bending[1], outer.bending[1] - inner.bending[1], 1e-14);
    near(tube.torsion, outer.torsion - inner.torsion, 1e-14);
}

/// Thin walls keep their digits: π r t³-free formulas of the thin ring, to the first order in t/r.
#[test]
fn thin_tube() {
    let (d, t) = (0.1, 1e-9);
    let tube = Section::tube(d, d - 2.0 * t).unwrap();
    near(tube.area, PI * d * t, 1e-6);
    near(tube.bending[0], PI * d.powi(3) * t / 8.0, 1e-6);
    near(tube.shear_factors[0], 2.0, 1e-8);
}

/// Cowper's solution for tubes: 1/κ = 6 (1 + ν) (1 + m²)²/((7 + 6ν) (1 + m²)² + (20 + 12ν) m²). The factor used here is
/// free of ν and stays within 6.2 % of it from ν = 0 to 0.3.
#[test]
fn shear_factor_of_tubes_is_near_the_elastic_one() {
    for i in 0..100 {
        let m = f64::from(i) / 100.0;
        let found = Section::tube(1.0, m).unwrap().shear_factors[0];
        let s = (1.0 + m * m).powi(2);
        for nu in [0.0, 0.3] {
            let cowper = ((7.0 + 6.0 * nu) * s + (20.0 + 12.0 * nu) * m * m) / (6.0 * (1.0 + nu) * s);
            near(found, cowper, 0.062);
        }
    }
}

#[test]
fn rectangle_bends_about_the_axes_it_names() {
    let flat = Section::rectangle(0.04, 0.01).unwrap(); // wide along y
    near(flat.area, 4e-4, 1e-15);
    near(flat.bending[0], 0.04 * 1e-6 / 12.0, 1e-14);
    near(flat.bending[1], 0.01 * 6.4e-5 / 12.0, 1e-14);
    assert_eq!(flat.shear_factors, [1.2, 1.2]);
}

/// J/(a c³) as tabulated for bars of sides a ≥ c.
#[test]
fn torsion_constant_of_rectangles_as_tabulated() {
    let table = [
        (1.0, 0.1406),
        (1.5, 0.1958),
        (2.0, 0.2287),
        (3.0, 0.2633),
        (5.0, 0.2913),
        (10.0, 0.3123),
    ];
    for (a, wanted) in table {
        assert!(
            (Section::rectangle(a, 1.0).unwrap().torsion / a - wanted).abs() < 5.1e-5,
            "{a}"
        );
    }
    near(
        Section::rectangle(1.0, 1.0).unwrap().torsion,
        0.140_577_014_955_1,
        1e-11,
    );
    near(Section::rectangle(1e5, 1.0).unwrap().torsion, 1e5 / 3.0, 1e-5);
}

/// The series holds for either order of the sides; with the short side first it is another, slower sum for the same number.
fn slow_series(a: f64, c: f64) -> f64 {
    let sum: f64 = (0..4000)
        .rev()
        .map(|i| f64::from(2 * i + 1))
        .map(|k| (k * PI * a / (2.0 * c)).tanh() / k.powi(5))
        .sum();
    a * c * c * c * (1.0 / 3.0 - 64.0 / PI.powi(5) * c / a * sum)
}

proptest! {
    #[test]
    fn torsion_constant_of_rectangles_by_two_series(a in 0.1..10.0, ratio in 0.1..1.0) {
        let (a, c) = (a, a * ratio);
        let found = Section::rectangle(a, c).unwrap().torsion;
        prop_assert_eq!(found, Section::rectangle(c, a).unwrap().torsion);
        near(found, slow_series(a, c), 1e-13);
        near(found, slow_series(c, a), 1e-9); // cancels by the fourth power of the ratio
    }

    /// No section resists torsion better than by its polar moment, none of those here worse than a circle of its least width.
    #[test]
    fn torsion_constants_are_bounded(b in 1e-3..1.0, h in 1e-3..1.0) {
        let section = Section::rectangle(b, h).unwrap();
        prop_assert!(section.torsion < section.polar());
        prop_assert!(section.torsion > Section::circle(b.min(h)).unwrap().torsion);
    }

    #[test]
    fn tubes_scale(d in 1e-3..1.0, m in 0.0..0.999) {
        let (unit, tube) = (Section::tube(1.0, m).unwrap(), Section::tube(d, m * d).unwrap());
        near(tube.area, unit.area * d * d, 1e-11);
        near(tube.torsion, unit.torsion * d.powi(4), 1e-11);
    }
}
