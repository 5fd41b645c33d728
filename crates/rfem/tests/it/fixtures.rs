//! Beams that several modules test.

use linkdyn_rfem::*;
use proptest::prelude::*;

pub const STEEL: Material = Material {
    density: 7850.0,
    youngs_modulus: 2.1e11,
    shear_modulus: 8.1e10,
    relaxation_time: 2e-5,
};

/// All numbers of it differ, so that none can stand for another.
pub const OWN: Section = Section {
    area: 3e-4,
    bending: [5e-9, 2e-8],
    torsion: 7e-9,
    shear_factors: [1.5, 2.5],
};

pub fn standard(length: f64, section: &Section, n: usize) -> Beam {
    divide(length, section, &STEEL, Division::Standard(n)).unwrap()
}

/// A round bar of 1 m so thin that the rotary inertia of its sections is below rounding.
pub fn slender() -> Section {
    Section::circle(1e-6).unwrap()
}

pub fn any_material() -> impl Strategy<Value = Material> {
    (1e2..2e4, 1e5..1e12, 1e5..1e12, prop_oneof![Just(0.0), 1e-7..1e-2]).prop_map(|(rho, e, g, tau)| Material {
        density: rho,
        youngs_modulus: e,
        shear_modulus: g,
        relaxation_time: tau,
    })
}

pub fn any_section() -> impl Strategy<Value = Section> {
    let size = || 1e-4..0.5;
    prop_oneof![
        size().prop_map(|d| Section::circle(d).unwrap()),
        (size(), 0.0..0.99).prop_map(|(d, m)| Section::tube(d, m * d).unwrap()),
        (size(), size()).prop_map(|(b, h)| Section::rectangle(b, h).unwrap()),
        (1e-6..1e-2, 1e-12..1e-5, 1e-12..1e-5, 1e-12..1e-5, 1.0..3.0, 1.0..3.0).prop_map(
            |(area, iy, iz, j, ky, kz)| {
                Section {
                    area,
                    bending: [iy, iz],
                    torsion: j,
                    shear_factors: [ky, kz],
                }
            }
        ),
    ]
}

pub fn any_division() -> impl Strategy<Value = Division> {
    prop_oneof![
        (1_usize..40).prop_map(Division::Standard),
        (2_usize..40).prop_map(Division::Equal)
    ]
}

#[track_caller]
pub fn near(found: f64, wanted: f64, relative: f64) {
    let error = found / wanted - 1.0;
    assert!(error.abs() <= relative, "{found} is {error:e} off {wanted}");
}
