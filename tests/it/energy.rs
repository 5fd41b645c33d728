//! Energies, and the power that changes them.

use linkdyn_dynamics::lagrange;
use linkdyn_dynamics::{Description, Formulation, Load, System, Workspace};
use linkdyn_kinematics::Freedom;
use linkdyn_tests::loads::Spring;
use linkdyn_tests::numbers::{derivative, largest};
use linkdyn_tests::{Blueprint, strategies};
use nalgebra::DVector;
use proptest::prelude::*;
use std::sync::Arc;

/// The blueprint with a spring on every single freedom.
fn with_springs(blueprint: &Blueprint) -> System {
    let (mut description, links): (Description, _) = blueprint.description();
    for (part, link) in blueprint.parts.iter().zip(links) {
        let tree = &description.tree;
        if part.q.len() == 1 {
            let spring = Spring {
                coordinate: tree.coordinate_range(link).start,
                speed: tree.speed_range(link).start,
                stiffness: 7.0,
            };
            description.loads.push(Arc::new(spring) as Arc<dyn Load>);
        }
    }
    System::new(description).expect("a valid blueprint")
}

proptest! {
    #![proptest_config(strategies::cases(300))]

    #[test]
    fn kinetic_energy_is_half_the_mass_matrix_between_speeds(blueprint in strategies::tree(1..=12)) {
        let machine = blueprint.machine(Formulation::Lagrange);
        let v = DVector::from_column_slice(&machine.v);
        let mass = lagrange::equations(&machine.system, &machine.q, &machine.v).mass;
        let kinetic = machine.system.energy(0.0, &machine.q, &machine.v).kinetic;
        let gap = 0.5 * v.dot(&(&mass * &v)) - kinetic;
        // Signed sums of traces against a sum of squares: rounding of the largest entries between the speeds.
        prop_assert!(gap.abs() < 1e-13 * (1.0 + v.abs().dot(&(mass.abs() * v.abs()))), "{gap:e} of {kinetic}");
    }

    #[test]
    fn weight_forces_are_the_gradient_of_potential_energy(blueprint in strategies::tree(1..=6)) {
        let machine = blueprint.machine(Formulation::Lagrange);
        let (tree, rest) = (machine.tree(), vec![0.0; machine.tree().speeds()]);
        let bias = lagrange::equations(&machine.system, &machine.q, &rest).bias;
        for i in 0..tree.speeds() {
            let potential = |h: f64| {
                let (mut q, mut step) = (machine.q.clone(), rest.clone());
                step[i] = h;
                tree.displace(&mut q, &step);
                DVector::from_element(1, machine.system.energy(0.0, &q, &rest).potential)
            };
            let gap = derivative(potential)[0] - bias[i];
            // Potential energies of some hundred joules, five points 1e-3 apart: 1e-10 of truncation and of rounding.
            prop_assert!(gap.abs() < 1e-8, "speed {i}: {gap:e}");
        }
    }

    #[test]
    fn power_of_all_loads_is_the_rate_of_energy(blueprint in strategies::closed(1..=6, 0..=1)) {
        let system = with_springs(&blueprint);
        let (q, v) = (blueprint.coordinates(), blueprint.speeds());
        let mut work = Workspace::new(&system);
        system.evaluate(0.0, &q, &v, &mut work).expect("a regular mass matrix");
        let rates = work.rates().to_vec();
        // A motion that starts with these speeds and accelerations.
        let energy = |h: f64| {
            let step: Vec<f64> = v.iter().zip(&rates).map(|(v, a)| h * v + 0.5 * h * h * a).collect();
            let speeds: Vec<f64> = v.iter().zip(&rates).map(|(v, a)| v + h * a).collect();
            let mut moved = q.clone();
            system.tree().displace(&mut moved, &step);
            DVector::from_element(1, system.energy(0.0, &moved, &speeds).total())
        };
        prop_assume!(largest(&rates) < 300.0);
        // By steps of a quarter, with which the truncation is 1/256: near the singularity of three turns accelerations are large.
        let gap = 4.0 * derivative(|h| energy(0.25 * h))[0] - work.power();
        // Accelerations up to 300: within the five points speeds change by 1, energies by some hundred joules; the
        // truncation h^4/30 E''''' holds fifth powers of speeds and squares of accelerations.
        let scale = 1.0 + energy(0.0).amax() + largest(&rates).powi(2) * 0.1;
        prop_assert!(gap.abs() < 1e-7 * scale, "{gap:e} of {}, scale {scale:e}", work.power());
    }

    #[test]
    fn power_is_the_sum_over_drives_and_wrenches(blueprint in strategies::tree(1..=8)) {
        let machine = blueprint.machine(Formulation::Recursive);
        let work = machine.evaluate();
        let drives: f64 = blueprint.parts.iter().flat_map(|p| p.drive.iter().zip(&p.v)).map(|(f, v)| f * v).sum();
        let links = blueprint.parts.iter().zip(&machine.links);
        let wrenches: f64 = links.map(|(p, link)| p.wrench.power(&work.velocities().nodes()[link.node()])).sum();
        let scale = 1.0 + drives.abs() + wrenches.abs();
        prop_assert!((drives + wrenches - work.power()).abs() < 1e-12 * scale);
        prop_assert!(machine.tree().nodes().iter().filter(|n| n.freedom != Freedom::None).count() == machine.v.len());
    }
}
