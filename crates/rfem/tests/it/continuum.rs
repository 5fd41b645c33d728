//! Frequencies of the continuum against published roots and against their equations.

use crate::fixtures::*;
use linkdyn_rfem::modes::*;
use linkdyn_rfem::*;
use std::f64::consts::PI;

#[test]
fn roots_of_benchmark_17_beam_modes() {
    let clamped_free = [
        1.875104068711961,
        4.694091132974175,
        7.854757438237613,
        10.99554073487547,
        14.13716839104647,
    ];
    let both = [
        4.730040744862704,
        7.853204624095838,
        10.99560783800167,
        14.13716549125746,
    ];
    let propped = [
        3.926602312047919,
        7.068582745628732,
        10.21017612281303,
        13.35176877775409,
    ];
    let cases: [(Ends, &[f64]); 4] = [
        (Ends::ClampedFree, &clamped_free),
        (Ends::ClampedClamped, &both),
        (Ends::FreeFree, &both),
        (Ends::ClampedPinned, &propped),
    ];
    for (ends, roots) in cases {
        for (mode, wanted) in (1..).zip(roots) {
            near(bending_root(ends, mode).unwrap(), *wanted, 1e-15);
        }
    }
    assert_eq!(bending_root(Ends::PinnedPinned, 3).unwrap(), 3.0 * PI);
}

/// Where cosh overflows the roots are those of the cosine.
#[test]
fn roots_of_high_modes() {
    for (ends, shift) in [
        (Ends::ClampedFree, -0.5),
        (Ends::FreeFree, 0.5),
        (Ends::ClampedPinned, 0.25),
    ] {
        for mode in [100, 1000, u32::MAX] {
            near(bending_root(ends, mode).unwrap(), (f64::from(mode) + shift) * PI, 1e-15);
        }
    }
}

#[test]
fn bar_of_benchmark_17_beam_modes() {
    let bar = Section::rectangle(0.01, 0.01).unwrap();
    let hertz = |ends, mode| bending_frequency(1.0, &bar, &STEEL, Axis::Z, ends, mode).unwrap() / (2.0 * PI);
    let cantilever = [
        8.35516594444,
        52.3609311864,
        146.612123489,
        287.301247144,
        474.929547282,
    ];
    let pinned = [23.4533061662, 93.8132246647, 211.079755496, 375.252898659];
    for (mode, wanted) in (1..).zip(cantilever) {
        near(hertz(Ends::ClampedFree, mode), wanted, 1e-11);
    }
    for (mode, wanted) in (1..).zip(pinned) {
        near(hertz(Ends::PinnedPinned, mode), wanted, 1e-11);
    }
}

#[test]
fn bars_that_twist_and_stretch() {
    let round = Section::circle(0.01).unwrap();
    let sound = (STEEL.youngs_modulus / STEEL.density).sqrt();
    let slower = (STEEL.shear_modulus / STEEL.density).sqrt();
    for mode in 1..5 {
        let quarter = f64::from(2 * mode - 1) * PI / 2.0 / 0.7;
        let half = f64::from(mode) * PI / 0.7;
        near(
            stretch_frequency(0.7, &STEEL, BarEnds::FixedFree, mode).unwrap(),
            quarter * sound,
            1e-14,
        );
        for ends in [BarEnds::FixedFixed, BarEnds::FreeFree] {
            near(stretch_frequency(0.7, &STEEL, ends, mode).unwrap(), half * sound, 1e-14);
            near(
                torsion_frequency(0.7, &round, &STEEL, ends, mode).unwrap(),
                half * slower,
                1e-14,
            );
        }
    }
}

#[test]
fn mode_zero_is_refused() {
    let text = "mode is 0, but must be from 1 to 4294967295";
    assert_eq!(bending_root(Ends::FreeFree, 0).unwrap_err().to_string(), text);
    let refused = bending_frequency(1.0, &OWN, &STEEL, Axis::Y, Ends::FreeFree, 0).unwrap_err();
    assert_eq!(refused.item, "mode");
    assert_eq!(
        torsion_frequency(1.0, &OWN, &STEEL, BarEnds::FreeFree, 0)
            .unwrap_err()
            .item,
        "mode"
    );
    assert_eq!(
        stretch_frequency(1.0, &STEEL, BarEnds::FreeFree, 0).unwrap_err().item,
        "mode"
    );
}

#[test]
fn bad_beams_are_refused() {
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let errors = [
            bending_frequency(length, &OWN, &STEEL, Axis::Y, Ends::FreeFree, 1),
            torsion_frequency(length, &OWN, &STEEL, BarEnds::FreeFree, 1),
            stretch_frequency(length, &STEEL, BarEnds::FreeFree, 1),
        ];
        for error in errors {
            assert_eq!(error.unwrap_err().item, "length");
        }
    }
    let dust = Material { density: -1.0, ..STEEL };
    assert_eq!(
        stretch_frequency(1.0, &dust, BarEnds::FreeFree, 1).unwrap_err().item,
        "material.density"
    );
    let error = bending_frequency(1e-200, &OWN, &STEEL, Axis::Y, Ends::FreeFree, 1).unwrap_err();
    assert_eq!(error.item, "bending frequency");
}
