//! Flexible links against beam theory: a cantilever along each axis of its frame, its frequencies, its tip, its damping.

use linkdyn_integrators::{Integration, Radau5};
use linkdyn_kinematics::{Joint, Positions, Wrench};
use linkdyn_mechanisms::rfem::modes::{Axis, BarEnds, Ends, bending_frequency, torsion_frequency};
use linkdyn_mechanisms::rfem::{Beam, Division, Material, Section, divide};
use linkdyn_mechanisms::{Along, Linkage, Mechanism, Mount, Observation, Simulation, State, run};
use linkdyn_tests::loads::Applied;
use nalgebra::{DMatrix, DVector, Vector3};
use std::f64::consts::PI;
use std::ops::ControlFlow;

const ALL: [Along; 6] = [
    Along::X,
    Along::Y,
    Along::Z,
    Along::MinusX,
    Along::MinusY,
    Along::MinusZ,
];
const LENGTH: f64 = 1.0;

/// The beam's axis and the section's first and second one, as indices of the frame's axes x, y, z.
fn axes(along: Along) -> [usize; 3] {
    match along {
        Along::X | Along::MinusX => [0, 1, 2],
        Along::Y | Along::MinusY => [1, 2, 0],
        Along::Z | Along::MinusZ => [2, 0, 1],
    }
}

fn steel(relaxation_time: f64) -> Material {
    Material::isotropic(7850.0, 2.1e11, 0.3, relaxation_time).expect("a material")
}

/// Half a millimetre along the section's first axis, one along the second: so slender that rotary inertia shows in the sixth digit only.
fn blade() -> Section {
    Section::rectangle(5e-4, 1e-3).expect("a section")
}

fn cut(section: &Section, relaxation_time: f64, n: usize) -> Beam {
    divide(LENGTH, section, &steel(relaxation_time), Division::Standard(n)).expect("a beam")
}

/// The beam `b`, clamped to the ground at its beginning; nothing weighs.
fn cantilever(beam: &Beam, along: Along) -> Linkage {
    let mut linkage = Linkage::new([0.0; 3]);
    let link = linkage.flexible_link("b", beam, along);
    linkage.joint(
        "clamp",
        Joint::Fixed,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link.elements[0]),
    );
    linkage
}

/// Minus the derivative of the accelerations by the coordinates, about the straight beam.
fn stiffness_over_mass(mechanism: &Mechanism) -> DMatrix<f64> {
    let mut simulation = Simulation::new(mechanism);
    let n = simulation.layout().speeds.len();
    let step = 1e-5;
    let mut at = |k: usize, by: f64| {
        let mut q = vec![0.0; n];
        q[k] = by;
        let a = simulation.accelerations(0.0, &q, &vec![0.0; n]).expect("regular");
        DVector::from_column_slice(a)
    };
    let columns: Vec<_> = (0..n).map(|k| (at(k, -step) - at(k, step)) / (2.0 * step)).collect();
    DMatrix::from_columns(&columns)
}

/// Indices of the coordinates that turn about an axis of the frame: psi is about z, theta about y, phi about x.
fn turns_about(axis: usize, count: usize) -> Vec<usize> {
    (0..count / 3).map(|r| 3 * r + 2 - axis).collect()
}

/// Angular frequencies of the motions in the coordinates about one axis of the frame, lowest first. That the others do not join in
/// is checked.
fn frequencies(mechanism: &Mechanism, axis: usize) -> Vec<f64> {
    let all = stiffness_over_mass(mechanism);
    let own = turns_about(axis, all.nrows());
    for &column in &own {
        for row in (0..all.nrows()).filter(|row| !own.contains(row)) {
            assert!(
                all[(row, column)].abs() < 1e-9 * all[(column, column)].abs(),
                "{row} {column}"
            );
        }
    }
    let block = all.select_rows(&own).select_columns(&own);
    let mut found: Vec<f64> = block
        .complex_eigenvalues()
        .iter()
        .map(|value| {
            assert!(value.im.abs() < 1e-6 * value.re, "{value}");
            value.re.sqrt()
        })
        .collect();
    found.sort_by(f64::total_cmp);
    found
}

fn built(section: &Section, n: usize, along: Along) -> Mechanism {
    cantilever(&cut(section, 0.0, n), along).build().expect("valid")
}

/// Relative errors of the first frequencies of bending about the section's first (`Axis::Y`) or second axis.
fn bending_errors(n: usize, along: Along, axis: Axis) -> Vec<f64> {
    let section = blade();
    let place = match axis {
        Axis::Y => axes(along)[1],
        Axis::Z => axes(along)[2],
    };
    let found = frequencies(&built(&section, n, along), place);
    let modes = (1..=3).zip(found);
    let error = |(mode, omega): (u32, f64)| {
        let exact = bending_frequency(LENGTH, &section, &steel(0.0), axis, Ends::ClampedFree, mode);
        omega / exact.expect("there is one") - 1.0
    };
    modes.map(error).collect()
}

#[test]
fn four_elements_have_the_known_errors_of_bending_along_every_axis_and_in_both_planes() {
    for along in ALL {
        for axis in [Axis::Y, Axis::Z] {
            let errors = bending_errors(4, along, axis);
            for (error, known) in errors.iter().zip([0.0145269, 0.0520979, 0.0748591]) {
                assert!((error - known).abs() < 1e-5, "{along:?} {axis:?}: {errors:?}");
            }
        }
    }
}

#[test]
fn bending_converges_with_the_second_order() {
    let errors: Vec<f64> = [2, 4, 8, 16].map(|n| bending_errors(n, Along::Y, Axis::Z)[0]).into();
    for (error, known) in errors.iter().zip([0.0608372, 0.0145269, 0.00359604, 0.000896868]) {
        assert!((error - known).abs() < 2e-6, "{errors:?}");
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.9..2.1).contains(&order), "{order}");
    }
}

#[test]
fn torsion_is_that_of_a_bar_in_equal_parts() {
    let section = blade();
    for along in ALL {
        let n = 4;
        let found = frequencies(&built(&section, n, along), axes(along)[0]);
        assert_eq!(found.len(), n);
        for (mode, omega) in (1..).zip(found) {
            let exact =
                torsion_frequency(LENGTH, &section, &steel(0.0), BarEnds::FixedFree, mode).expect("there is one");
            // Eigenvalues of the second difference with one fixed and one free end.
            let half = (2.0 * f64::from(mode) - 1.0) * PI / (4 * n) as f64;
            assert!((omega / exact - half.sin() / half).abs() < 1e-8, "{along:?} {mode}");
        }
    }
}

#[test]
fn the_same_link_along_any_axis_is_the_same_link() {
    let of = |along: Along| axes(along).map(|axis| frequencies(&built(&blade(), 3, along), axis));
    let first = of(Along::X);
    for along in ALL {
        for (a, b) in first.iter().flatten().zip(of(along).iter().flatten()) {
            assert!((a / b - 1.0).abs() < 1e-8, "{along:?} {a} {b}");
        }
    }
    // No two of the three kinds of motion are alike, so that none can stand for another.
    for k in 0..3 {
        let other = first[(k + 1) % 3][0];
        assert!((first[k][0] / other - 1.0).abs() > 0.3, "{first:?}");
    }
}

/// Position and turn of the last element's frame, and from it the tip.
fn tip(mechanism: &Mechanism, q: &[f64], n: usize, along: Along) -> Vector3<f64> {
    let mut positions = Positions::new(mechanism.system().tree());
    mechanism.system().tree().positions(q, &mut positions);
    let last = mechanism.attachment(&format!("b,{n}")).expect("the last element");
    let from_sde = LENGTH / (2 * n) as f64;
    (positions.pose(last.link) * last.pose).point(&(along.direction() * from_sde))
}

#[test]
fn a_force_at_the_tip_deflects_it_by_the_known_amount_in_its_own_direction() {
    let section = blade();
    let modulus = steel(0.0).youngs_modulus;
    for along in ALL {
        for n in [1, 2, 4] {
            let [_, first, second] = axes(along);
            // A force along the second axis bends about the first, and the other way round.
            for (direction, moment) in [(second, section.bending[0]), (first, section.bending[1])] {
                let beam = cut(&section, 0.0, n);
                let free = cantilever(&beam, along).build().expect("valid");
                let last = free.attachment(&format!("b,{n}")).expect("the last element");
                let mut force = Vector3::zeros();
                // So small that the tip moves by a millionth of the length.
                force[direction] = 3.0 * modulus * moment * 1e-6;
                let frame = last.pose.origin + along.direction() * (LENGTH / (2 * n) as f64);
                let wrench = Wrench {
                    torque: frame.cross(&force),
                    force,
                };
                let mut loaded = cantilever(&beam, along);
                loaded.load(Applied {
                    drives: Vec::new(),
                    wrenches: vec![(last.link, wrench)],
                });
                let loaded = loaded.build().expect("valid");
                let count = 3 * n;
                let rest = vec![0.0; count];
                let pushed = Simulation::new(&loaded)
                    .accelerations(0.0, &rest, &rest)
                    .expect("regular")
                    .to_vec();
                let q = stiffness_over_mass(&free)
                    .lu()
                    .solve(&DVector::from_vec(pushed))
                    .expect("springs everywhere");
                let moved = tip(&free, q.as_slice(), n, along) - tip(&free, &rest, n, along);
                let expected = 1e-6 * LENGTH * (1.0 - 0.25 / (n * n) as f64);
                assert!(
                    (moved[direction] / expected - 1.0).abs() < 1e-6,
                    "{along:?} {n}: {} {expected}",
                    moved[direction]
                );
                // Across, it stays where it is; along the beam it shortens by the square.
                moved
                    .iter()
                    .enumerate()
                    .filter(|(k, _)| *k != direction)
                    .for_each(|(_, x)| assert!(x.abs() < 1e-11));
            }
        }
    }
}

/// Rows of a run from rest.
fn rows(mechanism: &Mechanism, q: Vec<f64>, tolerance: f64, until: f64, every: f64) -> Vec<Observation> {
    let simulation = Simulation::new(mechanism);
    let v = vec![0.0; simulation.layout().speeds.len()];
    let y = simulation.state_vector(&State { q, v });
    let settings = simulation.settings(tolerance, tolerance);
    let mut integration = Integration::new(simulation, Radau5::default(), 0.0, &y, settings).expect("valid");
    let mut rows = Vec::new();
    run(&mut integration, until, every, |o| {
        rows.push(o.clone());
        ControlFlow::Continue(())
    })
    .expect("runs to the end");
    rows
}

#[test]
fn damping_takes_energy_and_is_the_only_one_to_do_so() {
    let section = blade();
    let bent: Vec<f64> = (0..9).map(|k| 0.05 * (1.0 + f64::from(k)).sin()).collect();
    for (relaxation_time, tolerance) in [(0.0, 1e-8), (1e-3, 1e-9)] {
        let mechanism = cantilever(&cut(&section, relaxation_time, 3), Along::MinusZ)
            .build()
            .expect("valid");
        let rows = rows(&mechanism, bent.clone(), tolerance, 0.05, 0.0005);
        let size = rows[0].energy.elastic;
        assert!(size > 0.0 && rows[0].energy.kinetic == 0.0);
        for pair in rows.windows(2) {
            let (before, after) = (pair[0].energy.total(), pair[1].energy.total());
            let balance = pair[1].energy_balance() - rows[0].energy_balance();
            assert!(balance.abs() < 1e-5 * size, "{balance:e} J of {size:e} J");
            if relaxation_time > 0.0 {
                assert!(after < before, "{after} {before} at {}", pair[1].t);
            }
        }
        let end = rows[rows.len() - 1].energy.total();
        if relaxation_time > 0.0 {
            assert!(end < 0.9 * size, "{end} {size}");
        } else {
            assert!((end / size - 1.0).abs() < 1e-5, "{end} {size}");
        }
    }
}

#[test]
fn a_mode_decays_by_half_relaxation_time_times_frequency() {
    let (section, relaxation_time, n) = (Section::rectangle(0.01, 0.02).expect("a section"), 1e-3, 3);
    let undamped = built(&section, n, Along::Y);
    let all = stiffness_over_mass(&undamped);
    let mechanism = cantilever(&cut(&section, relaxation_time, n), Along::Y)
        .build()
        .expect("valid");
    // Bending about the first axis, z, and about the second one, x.
    for axis in [2, 0] {
        let own = turns_about(axis, 3 * n);
        let omega = frequencies(&undamped, axis)[0];
        // The first mode by inverse iteration.
        let block = all.select_rows(&own).select_columns(&own).lu();
        let mut mode = DVector::from_element(n, 1.0);
        for _ in 0..30 {
            mode = block.solve(&mode).expect("springs everywhere").normalize();
        }
        let size = 1e-5;
        let mut q = vec![0.0; 3 * n];
        own.iter().zip(mode.iter()).for_each(|(&k, x)| q[k] = size * x);
        let zeta = 0.5 * relaxation_time * omega;
        let period = 2.0 * PI / (omega * (1.0 - zeta * zeta).sqrt());
        let rows = rows(&mechanism, q.clone(), 1e-11, 2.0 * period, period);
        for (turns, row) in (0..).zip(&rows) {
            let expected = (-zeta * omega * f64::from(turns) * period).exp();
            for &k in &own {
                assert!(
                    (row.q[k] / q[k] - expected).abs() < 1e-4,
                    "{axis} {turns} {} {expected}",
                    row.q[k] / q[k]
                );
            }
        }
        assert!(zeta > 0.02 && rows.len() == 3);
    }
}
