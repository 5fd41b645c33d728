//! Denavit-Hartenberg transforms against products of elementary ones, and their derivatives against differences.

use linkdyn_kinematics::Pose;
use linkdyn_kinematics::dh::{Convention, Row, Variable};
use linkdyn_tests::numbers::{derivative, largest};
use linkdyn_tests::strategies::{self, number};
use nalgebra::{DVector, Matrix4, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;

fn row() -> impl Strategy<Value = Row> {
    (number(PI), number(1.0), number(1.0), number(PI)).prop_map(|(theta, d, a, alpha)| Row { theta, d, a, alpha })
}

fn flat(t: &Matrix4<f64>) -> DVector<f64> {
    DVector::from_column_slice(t.as_slice())
}

proptest! {
    #![proptest_config(strategies::cases(1000))]

    #[test]
    fn both_conventions_are_products_of_two_turns_and_two_shifts(row in row()) {
        let z = Pose::turn(Vector3::z_axis(), row.theta) * Pose::translation(0.0, 0.0, row.d);
        let x = Pose::translation(row.a, 0.0, 0.0) * Pose::turn(Vector3::x_axis(), row.alpha);
        let pairs = [(Convention::Classical, z * x), (Convention::Craig, x * z)];
        for (convention, expected) in pairs {
            let gap = row.pose(convention).to_homogeneous() - expected.to_homogeneous();
            // A handful of products of numbers up to 1.
            prop_assert!(gap.amax() < 1e-15, "{convention:?}: {gap}");
            let (before, after) = row.around(convention);
            let joined = before * row.motion() * after;
            prop_assert!((joined.to_homogeneous() - expected.to_homogeneous()).amax() < 1e-15);
        }
    }

    #[test]
    fn derivatives_are_limits_of_differences(row in row()) {
        for convention in [Convention::Classical, Convention::Craig] {
            for variable in [Variable::Theta, Variable::D] {
                let moved = |h: f64| match variable {
                    Variable::Theta => Row { theta: row.theta + h, ..row },
                    Variable::D => Row { d: row.d + h, ..row },
                };
                let first = derivative(|h| flat(&moved(h).pose(convention).to_homogeneous()));
                let second = derivative(|h| flat(&moved(h).first_derivative(convention, variable)));
                // Five points 1e-3 apart on sines: truncation 3e-14, rounding 1e-12.
                let gap = largest(&(first - flat(&row.first_derivative(convention, variable))));
                prop_assert!(gap < 1e-11, "first {gap:e}");
                let gap = largest(&(second - flat(&row.second_derivative(convention, variable))));
                prop_assert!(gap < 1e-11, "second {gap:e}");
            }
        }
    }
}
