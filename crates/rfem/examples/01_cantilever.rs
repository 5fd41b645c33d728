//! First frequencies and static tip of a steel cantilever, divided more and more finely, against Euler and Bernoulli.
//!
//! The chain is that of the modified form: rfe 0 is clamped, each further one hangs on the one before by the bending spring
//! between them. With the angles of the springs as coordinates the stiffness matrix is diagonal.

use linkdyn_rfem::modes::{Axis, Ends, bending_frequency};
use linkdyn_rfem::{Beam, Division, Material, Section, divide};
use nalgebra::DMatrix;

const LENGTH: f64 = 0.4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let steel = Material::isotropic(7850.0, 2.1e11, 0.3, 2e-5)?;
    let rod = Section::circle(0.010)?;
    let mut wanted = Vec::new();
    for mode in 1..=3 {
        wanted.push(bending_frequency(
            LENGTH,
            &rod,
            &steel,
            Axis::Z,
            Ends::ClampedFree,
            mode,
        )?);
    }
    println!("continuum: {:.2}, {:.2}, {:.2} rad/s", wanted[0], wanted[1], wanted[2]);
    println!("division               error of f1, f2, f3 [%]         tip [%]");
    let flexible = LENGTH.powi(3) / (3.0 * steel.youngs_modulus * rod.bending[1]);
    let standard = [1, 2, 4, 8, 16, 32].map(Division::Standard);
    for division in standard.into_iter().chain([Division::Equal(5)]) {
        let beam = divide(LENGTH, &rod, &steel, division)?;
        let mut line = format!("{:14}", format!("{division:?}"));
        for (found, wanted) in frequencies(&beam).iter().zip(&wanted) {
            line += &format!("{:+12.4}", 100.0 * (found / wanted - 1.0));
        }
        let tip = 100.0 * (tip_flexibility(&beam) / flexible - 1.0);
        println!("{line:50}{tip:+12.4}");
        if let Division::Standard(n) = division {
            assert!((tip + 25.0 / (n * n) as f64).abs() < 1e-10);
        }
    }
    Ok(())
}

/// Angular frequencies of the clamped chain, lowest first, for bending about z.
fn frequencies(beam: &Beam) -> Vec<f64> {
    let n = beam.springs.len();
    let mut inertia = DMatrix::<f64>::zeros(n, n);
    for (r, rfe) in beam.elements.iter().enumerate() {
        // The springs before this element move it: by their distance, and by one radian each.
        for (s, a) in beam.springs[..r].iter().enumerate() {
            for (t, b) in beam.springs[..r].iter().enumerate() {
                let arms = (rfe.centre() - a.position) * (rfe.centre() - b.position);
                inertia[(s, t)] +=
                    (rfe.mass * arms + rfe.inertia[2]) / (a.bend[1].stiffness * b.bend[1].stiffness).sqrt();
            }
        }
    }
    let mut squares: Vec<f64> = inertia
        .symmetric_eigenvalues()
        .iter()
        .map(|square| 1.0 / square)
        .collect();
    squares.sort_by(f64::total_cmp);
    squares.iter().map(|square| square.sqrt()).collect()
}

/// Deflection of the tip by one newton along y.
fn tip_flexibility(beam: &Beam) -> f64 {
    beam.springs
        .iter()
        .map(|sde| (LENGTH - sde.position).powi(2) / sde.bend[1].stiffness)
        .sum()
}
