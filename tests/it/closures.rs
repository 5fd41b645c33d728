//! A closure equation is one thing seen three ways: residual, gradient, wrench.

use linkdyn_kinematics::assembly::gradient;
use linkdyn_kinematics::{
    Accelerations, Attachment, Closure, Freedom, Joint, LinkId, Pose, Positions, Row, Tree, Twist, Velocities, Wrench,
};
use linkdyn_tests::numbers::{derivative, largest};
use linkdyn_tests::{Blueprint, strategies};
use nalgebra::{DVector, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;

/// One cut joint of any kind. Either it is closed, or one side is the ground and it is open by up to some metres: where both
/// sides hang on common freedoms, these carry an open gap about, which the gradient leaves out.
fn cut() -> impl Strategy<Value = Blueprint> {
    prop_oneof![1 => strategies::closed(2..=6, 1..=1), 2 => strategies::open()]
}

struct State {
    tree: Tree,
    closure: Closure,
    q: Vec<f64>,
    v: DVector<f64>,
}

impl State {
    fn new(blueprint: &Blueprint) -> Self {
        let (tree, links) = blueprint.tree();
        Self {
            closure: blueprint.closures(&tree, &links).remove(0),
            tree,
            q: blueprint.coordinates(),
            v: DVector::from_vec(blueprint.speeds()),
        }
    }

    fn positions(&self, step: &DVector<f64>) -> Positions {
        let mut q = self.q.clone();
        self.tree.displace(&mut q, step.as_slice());
        let mut positions = Positions::new(&self.tree);
        self.tree.positions(&q, &mut positions);
        positions
    }

    fn residual(&self, step: &DVector<f64>) -> DVector<f64> {
        let mut phi = DVector::zeros(self.closure.equations());
        self.closure.residual(&self.positions(step), phi.as_mut_slice());
        phi
    }

    /// Whether the residual of a screw is the same smooth function here and a little away: neither about to change to another turn, nor
    /// with axes nearly opposite.
    fn is_smooth(&self) -> bool {
        let phi = self.residual(&self.here());
        let positions = self.positions(&self.here());
        let axis = |a: &Attachment, axis: &Vector3<f64>| positions.pose(a.link).rotation * a.pose.rotation * axis;
        let smooth = |row: &Row, phi: f64| match row {
            Row::Screw { axis: u, pitch } => {
                let cosine = axis(self.closure.predecessor(), u).dot(&axis(self.closure.successor(), u));
                phi.abs() < 0.9 * PI * pitch.abs() && cosine > -0.5
            }
            _ => true,
        };
        let mut k = 0;
        self.closure.rows().iter().all(|row| {
            k += row.equations();
            smooth(row, phi[k - 1])
        })
    }

    fn rate(&self, step: &DVector<f64>) -> DVector<f64> {
        let positions = self.positions(step);
        let mut velocities = Velocities::new(&self.tree);
        self.tree.velocities(&positions, self.v.as_slice(), &mut velocities);
        let mut rate = DVector::zeros(self.closure.equations());
        self.closure.rate(&positions, &velocities, rate.as_mut_slice());
        rate
    }

    fn here(&self) -> DVector<f64> {
        DVector::zeros(self.tree.speeds())
    }
}

/// Motion of a node for unit speed `i`.
fn unit_twist(tree: &Tree, positions: &Positions, node: usize, i: usize) -> Twist {
    let mut velocities = Velocities::new(tree);
    let v: Vec<f64> = (0..tree.speeds()).map(|k| f64::from(u8::from(k == i))).collect();
    tree.velocities(positions, &v, &mut velocities);
    velocities.nodes()[node]
}

proptest! {
    #![proptest_config(strategies::cases(1000))]

    #[test]
    fn gradient_is_that_of_the_residual(blueprint in cut()) {
        let state = State::new(&blueprint);
        prop_assume!(state.is_smooth());
        let here = state.here();
        let g = gradient(&state.tree, std::slice::from_ref(&state.closure), &state.positions(&here));
        for i in 0..state.tree.speeds() {
            let mut unit = here.clone();
            unit[i] = 1.0;
            let gap = derivative(|h| state.residual(&(&unit * h))) - g.column(i);
            // Truncation h^4/30 phi''''' < 1e-10 for levers of some metres.
            prop_assert!(largest(&gap) < 1e-9, "speed {i}: {gap}");
        }
    }

    #[test]
    fn rate_is_gradient_times_speeds(blueprint in cut()) {
        let state = State::new(&blueprint);
        let here = state.here();
        let g = gradient(&state.tree, std::slice::from_ref(&state.closure), &state.positions(&here));
        let gap = g * &state.v - state.rate(&here);
        // The same sums in another order.
        prop_assert!(largest(&gap) < 1e-13 * (1.0 + largest(&state.v)) * 10.0, "{gap}");
    }

    #[test]
    fn bias_is_the_second_rate_at_constant_speeds(blueprint in cut()) {
        let state = State::new(&blueprint);
        prop_assume!(state.is_smooth());
        let (mut positions, mut velocities) = (Positions::new(&state.tree), Velocities::new(&state.tree));
        let mut biases = Accelerations::new(&state.tree);
        // A common base acceleration must drop out.
        let base = Vector3::new(3.0, -4.0, 5.0);
        state.tree.sweep(&state.q, state.v.as_slice(), &base, &mut positions, &mut velocities, &mut biases);
        let mut gamma = DVector::zeros(state.closure.equations());
        state.closure.bias(&positions, &velocities, &biases, gamma.as_mut_slice());
        let gap = derivative(|h| state.rate(&(&state.v * h))) - &gamma;
        // Speeds up to 1.5 rad/s in a row of up to 18: angular velocities of some rad/s, so that the sixth derivative of the
        // residual may reach 1e6 and the truncation h^4/30 of that.
        prop_assert!(largest(&gap) < 1e-7, "{gap}");
    }

    #[test]
    fn wrenches_of_unit_multipliers_are_columns_of_the_transposed_gradient(blueprint in cut()) {
        let state = State::new(&blueprint);
        let positions = state.positions(&state.here());
        let g = gradient(&state.tree, std::slice::from_ref(&state.closure), &positions);
        let (one, two) = (state.closure.predecessor().link.node(), state.closure.successor().link.node());
        for row in 0..state.closure.equations() {
            let mut multipliers = vec![0.0; state.closure.equations()];
            multipliers[row] = 1.0;
            let (on_one, on_two) = state.closure.wrenches(&positions, &multipliers);
            for i in 0..state.tree.speeds() {
                let work = |node, wrench: &Wrench| wrench.power(&unit_twist(&state.tree, &positions, node, i));
                let gap = work(one, &on_one) + work(two, &on_two) - g[(row, i)];
                // The same products in another order, levers of some metres.
                prop_assert!(gap.abs() < 1e-13, "row {row}, speed {i}: {gap:e}");
            }
        }
    }

    #[test]
    fn a_freedom_is_on_the_side_whose_frame_it_moves_alone(blueprint in cut()) {
        let state = State::new(&blueprint);
        let positions = state.positions(&state.here());
        let (one, two) = (state.closure.predecessor().link.node(), state.closure.successor().link.node());
        let path: Vec<usize> = state.closure.path().collect();
        for (i, node) in state.tree.nodes().iter().enumerate() {
            if node.freedom == Freedom::None {
                prop_assert!(state.closure.side(i) == 0.0 && !path.contains(&i));
                continue;
            }
            let moves = |end| unit_twist(&state.tree, &positions, end, node.speed) != Twist::zero();
            let side = f64::from(u8::from(moves(one))) - f64::from(u8::from(moves(two)));
            prop_assert_eq!(state.closure.side(i), side);
            prop_assert_eq!(path.contains(&i), side != 0.0);
        }
    }

    #[test]
    fn ends_are_the_frames_of_the_attachments(blueprint in cut()) {
        let state = State::new(&blueprint);
        let positions = state.positions(&state.here());
        let place = |attachment: &Attachment| {
            let node = &positions.nodes()[attachment.link.node()];
            node.origin + node.rotation * attachment.pose.origin
        };
        let ends = state.closure.ends(&positions);
        prop_assert!((ends.one() - place(state.closure.predecessor())).amax() < 1e-14);
        prop_assert!((ends.two() - place(state.closure.successor())).amax() < 1e-14);
        let phi = state.residual(&state.here());
        if let Some(Row::Coincident) = state.closure.rows().first() {
            prop_assert_eq!(ends.one() - ends.two(), phi.fixed_rows::<3>(0).into_owned());
        }
    }

    #[test]
    fn wrenches_on_both_sides_balance(blueprint in cut()) {
        let state = State::new(&blueprint);
        let positions = state.positions(&state.here());
        let multipliers: Vec<f64> = (0..state.closure.equations()).map(|k| 1.0 + k as f64).collect();
        let (one, two) = (state.closure.predecessor().link.node(), state.closure.successor().link.node());
        let (mut on_one, on_two) = state.closure.wrenches(&positions, &multipliers);
        let arm = positions.nodes()[two].origin - positions.nodes()[one].origin;
        on_one = on_one.shifted(&-arm);
        // Equal and opposite forces; an open gap of coinciding points leaves the couple gap x force, which is no error.
        prop_assert!((on_one.force + on_two.force).amax() < 1e-13);
        let phi = state.residual(&state.here());
        if let Some(Row::Coincident) = state.closure.rows().first() {
            let couple = phi.fixed_rows::<3>(0).cross(&Vector3::new(1.0, 2.0, 3.0));
            prop_assert!((on_one.torque + on_two.torque - couple).amax() < 1e-12);
        } else {
            prop_assert!((on_one.torque + on_two.torque).amax() < 1e-12);
        }
    }

    #[test]
    fn a_joint_closed_on_itself_stays_closed_along_its_own_motion(
        joint in strategies::joint(),
        (start, end) in (strategies::raw(), strategies::raw()),
        base in strategies::pose(1.0),
    ) {
        // Tree and cut form of one joint between the same frames: whatever the tree's joint does, the cut allows.
        let mut tree = Tree::new();
        let link = tree.attach(LinkId::GROUND, base, joint).expect("valid");
        let at = |pose, link| Attachment { link, pose };
        let pre = at(base, LinkId::GROUND);
        let suc = at(Pose::identity(), link);
        let closure = Closure::new(&tree, pre, suc, &joint);
        prop_assert_eq!(closure.equations() + joint.speeds(), 6);
        prop_assert_eq!(closure.component_names().len(), closure.equations());
        let mut positions = Positions::new(&tree);
        for raw in [start, end] {
            tree.positions(&strategies::coordinates(&joint, &raw), &mut positions);
            let mut phi = vec![0.0; closure.equations()];
            closure.residual(&positions, &mut phi);
            prop_assert!(largest(&phi) < 4e-15, "{joint:?}: {phi:?}");
            let g = gradient(&tree, std::slice::from_ref(&closure), &positions);
            prop_assert!(largest(g.as_slice()) < 4e-15, "{joint:?}: {g}");
        }
    }
}

#[test]
fn fixed_and_slides_forbid_all_turns() {
    // The three angle equations of a joint that does not turn are independent at the closed position.
    for joint in [Joint::Fixed, Joint::prismatic_z()] {
        let mut tree = Tree::new();
        let ground = LinkId::GROUND;
        let identity = Pose::identity();
        let link = tree.attach(ground, identity, Joint::Spherical).expect("valid");
        let at = |link| Attachment { link, pose: identity };
        let closure = Closure::new(&tree, at(ground), at(link), &joint);
        let mut positions = Positions::new(&tree);
        tree.positions(&tree.neutral(), &mut positions);
        let g = gradient(&tree, &[closure], &positions);
        let turns = g.rows(g.nrows() - 3, 3).into_owned();
        assert!((turns.determinant().abs() - 1.0).abs() < 1e-15, "{joint:?}: {turns}");
    }
}
