//! Derivatives of positions: `T_i`, `T_ij`, Jacobians and rates are those of what they are derived from.

use linkdyn_kinematics::{Accelerations, LinkId, Positions, Tree, Velocities};
use linkdyn_tests::numbers::{derivative, largest};
use linkdyn_tests::{Blueprint, strategies};
use nalgebra::{DVector, Matrix4, Vector3};
use proptest::prelude::*;

/// Differences against derivatives of products of sines, lengths up to some metres: truncation of the five-point formula is
/// below 1e-10, its rounding about 1e-12.
const TOLERANCE: f64 = 1e-9;

fn displaced(tree: &Tree, q: &[f64], step: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut q = q.to_vec();
    let step: Vec<f64> = (0..tree.speeds()).map(step).collect();
    tree.displace(&mut q, &step);
    q
}

fn flat(t: &Matrix4<f64>) -> DVector<f64> {
    DVector::from_column_slice(t.as_slice())
}

fn along(i: usize, h: f64) -> impl Fn(usize) -> f64 {
    move |k| if k == i { h } else { 0.0 }
}

struct Moving {
    tree: Tree,
    links: Vec<LinkId>,
    q: Vec<f64>,
    v: Vec<f64>,
}

impl Moving {
    fn new(blueprint: &Blueprint) -> Self {
        let (tree, links) = blueprint.tree();
        Self {
            tree,
            links,
            q: blueprint.coordinates(),
            v: blueprint.speeds(),
        }
    }

    fn positions(&self, q: &[f64]) -> Positions {
        let mut positions = Positions::new(&self.tree);
        self.tree.positions(q, &mut positions);
        positions
    }

    fn velocities(&self, positions: &Positions) -> Velocities {
        let mut velocities = Velocities::new(&self.tree);
        self.tree.velocities(positions, &self.v, &mut velocities);
        velocities
    }
}

proptest! {
    #![proptest_config(strategies::cases(150))]

    #[test]
    fn transforms_are_the_poses(blueprint in strategies::tree(1..=20)) {
        let m = Moving::new(&blueprint);
        let (positions, transforms) = (m.positions(&m.q), m.tree.transforms(&m.q));
        for &link in &m.links {
            let gap = positions.pose(link).to_homogeneous() - transforms.transform(link);
            // Two orders of the same products: one rounding a link and metre.
            prop_assert!(gap.amax() < 1e-13, "{gap}");
        }
    }

    #[test]
    fn first_derivatives_are_those_of_the_transforms(blueprint in strategies::tree(1..=6)) {
        let m = Moving::new(&blueprint);
        let transforms = m.tree.transforms(&m.q);
        for &link in &m.links {
            for i in 0..m.tree.speeds() {
                let of = |h| flat(&m.tree.transforms(&displaced(&m.tree, &m.q, along(i, h))).transform(link));
                let gap = derivative(of) - flat(&transforms.first(link, i));
                prop_assert!(largest(&gap) < TOLERANCE, "T_{i}: {gap}");
            }
        }
    }

    #[test]
    fn second_derivatives_are_those_of_the_first(blueprint in strategies::tree(1..=4)) {
        let m = Moving::new(&blueprint);
        let transforms = m.tree.transforms(&m.q);
        for &link in &m.links {
            for i in 0..m.tree.speeds() {
                for j in 0..m.tree.speeds() {
                    let of = |h| flat(&m.tree.transforms(&displaced(&m.tree, &m.q, along(j, h))).first(link, i));
                    let gap = derivative(of) - flat(&transforms.second(link, i, j));
                    prop_assert!(largest(&gap) < TOLERANCE, "T_{i}{j}: {gap}");
                }
            }
        }
    }

    #[test]
    fn jacobians_are_derivatives_of_points_and_give_velocities(
        blueprint in strategies::tree(1..=6),
        point in strategies::vector(1.0),
    ) {
        let m = Moving::new(&blueprint);
        let positions = m.positions(&m.q);
        let velocities = m.velocities(&positions);
        for &link in &m.links {
            let frame = m.tree.frame_jacobian(&positions, link, &point);
            prop_assert_eq!(&m.tree.point_jacobian(&positions, link, &point), &frame.rows(3, 3).into_owned());
            for i in 0..m.tree.speeds() {
                let of = |h| {
                    let pose = m.positions(&displaced(&m.tree, &m.q, along(i, h))).pose(link);
                    DVector::from_column_slice(pose.point(&point).as_slice())
                };
                let gap = derivative(of) - frame.column(i).rows(3, 3);
                prop_assert!(largest(&gap) < TOLERANCE, "speed {i}: {gap}");
            }
            let twist = velocities.nodes()[link.node()];
            let arm = positions.pose(link).rotation * point;
            let rate = &frame * DVector::from_column_slice(&m.v);
            let expected = [twist.angular, twist.linear + twist.angular.cross(&arm)];
            let gap = rate - DVector::from_iterator(6, expected.iter().flat_map(|e| e.iter().copied()));
            // The same sums in another order.
            prop_assert!(largest(&gap) < 1e-12, "{gap}");
        }
    }

    #[test]
    fn velocities_and_accelerations_are_rates_of_positions(
        blueprint in strategies::tree(1..=5),
        rates in prop::collection::vec(strategies::number(3.0), 30),
        base in strategies::vector(10.0),
    ) {
        let m = Moving::new(&blueprint);
        let positions = m.positions(&m.q);
        let velocities = m.velocities(&positions);
        let rates = &rates[..m.tree.speeds()];
        let mut accelerations = Accelerations::new(&m.tree);
        m.tree.accelerations(&positions, &velocities, &m.v, rates, &base, &mut accelerations);
        for &link in &m.links {
            // Constant speeds move along `displace`; the rates of the speeds add T_i v'_i to T_ij v_i v_j.
            let pose = |h: f64| m.positions(&displaced(&m.tree, &m.q, |k| h * m.v[k])).pose(link);
            let origin = derivative(|h| DVector::from_column_slice(pose(h).origin.as_slice()));
            let twist = velocities.nodes()[link.node()];
            prop_assert!(largest((origin - twist.linear).as_slice()) < 1e-7, "linear velocity");

            let transforms = m.tree.transforms(&m.q);
            let mut second = Matrix4::zeros();
            for i in 0..m.tree.speeds() {
                second += transforms.first(link, i) * rates[i];
                for j in 0..m.tree.speeds() {
                    second += transforms.second(link, i, j) * (m.v[i] * m.v[j]);
                }
            }
            let r = positions.pose(link).rotation;
            let a = accelerations.nodes()[link.node()];
            let w = twist.angular.cross_matrix();
            let spin = (a.angular.cross_matrix() + w * w) * r;
            let linear: Vector3<f64> = second.fixed_view::<3, 1>(0, 3) + base;
            // Sums of some hundred products of the order of 1 to 10.
            prop_assert!((spin - second.fixed_view::<3, 3>(0, 0)).amax() < 1e-11, "angular acceleration");
            prop_assert!((linear - a.linear).amax() < 1e-11, "linear acceleration");
        }
    }

    #[test]
    fn coordinate_rates_are_those_of_displacements(blueprint in strategies::tree(1..=6)) {
        let m = Moving::new(&blueprint);
        let mut rates = vec![0.0; m.tree.coordinates()];
        m.tree.coordinate_rates(&m.q, &m.v, &mut rates);
        let moved = derivative(|h| DVector::from_vec(displaced(&m.tree, &m.q, |k| h * m.v[k])));
        prop_assert!(largest(&(moved - DVector::from_vec(rates))) < TOLERANCE);
    }
}
