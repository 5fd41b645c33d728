//! Joint reactions by the recursive Newton-Euler algorithm \[Craig 1986, ch. 6.5\], closures included.

use crate::evaluate::inertial_wrench;
use crate::load::{Reaction, ReactionLoad};
use crate::system::System;
use crate::workspace::Workspace;
use linkdyn_kinematics::{LinkId, Node, NodePosition, Twist, Wrench};

/// Increments of acceleration for rates of the speeds alone, outward.
#[inline]
fn acceleration_step(node: &Node, here: &NodePosition, before: &Twist, rate: impl FnOnce(usize) -> f64) -> Twist {
    let mut twist = Twist {
        angular: before.angular,
        linear: before.linear + before.angular.cross(&here.arm),
    };
    node.advance(&here.axis, rate, &mut twist);
    twist
}

impl System {
    /// Reactions of all joints for the last evaluation in `work`; read them with [`System::reaction`].
    pub fn reactions(&self, work: &mut Workspace) {
        work.counters.reaction_sweeps += 1;
        let nodes = self.tree.nodes();
        let positions = work.positions.nodes();
        for (i, node) in nodes.iter().enumerate().skip(1) {
            let twist = acceleration_step(node, &positions[i], &work.twists[node.parent], |speed| {
                work.rates[speed]
            });
            work.twists[i] = twist;
            let mut total = work.own[i];
            total += inertial_wrench(&work.inertias[i], &twist);
            work.reactions[i] = total;
        }
        let mut first = 0;
        for closure in &self.closures {
            let lambda = &work.constraint.multipliers()[first..first + closure.equations()];
            let (on_predecessor, on_successor) = closure.wrenches(&work.positions, lambda);
            work.reactions[closure.predecessor().link.node()] -= on_predecessor;
            work.reactions[closure.successor().link.node()] -= on_successor;
            first += closure.equations();
        }
        for (i, node) in nodes.iter().enumerate().skip(1).rev() {
            if node.parent != 0 {
                let total = work.reactions[i].shifted(&positions[i].arm);
                work.reactions[node.parent] += total;
            }
        }
    }

    /// As [`System::reactions`], for rates of the speeds and multipliers of one's own, at the state of the last
    /// [`System::write_terms`] with `work`.
    ///
    /// # Panics
    /// If `rates` has not one number a speed, or `multipliers` not one an equation.
    pub fn reactions_for(&self, rates: &[f64], multipliers: &[f64], work: &mut Workspace) {
        work.rates.copy_from_slice(rates);
        work.constraint.lambda.copy_from_slice(multipliers);
        self.reactions(work);
    }

    /// The loads that depend on reactions, each with its speed and the reaction that it sees; of the last [`System::reactions`].
    pub fn reaction_loads_with<'a>(
        &'a self,
        work: &'a Workspace,
    ) -> impl Iterator<Item = (usize, &'a dyn ReactionLoad, Reaction)> {
        let seen = |node: usize| in_axes_of(&work.positions.nodes()[node], &work.reactions[node]);
        let loads = self.reaction_loads.iter();
        loads.map(move |on| (on.speed, on.load.as_ref(), seen(on.node)))
    }

    /// Force and torque exerted on `link` by its predecessor at the joint's origin, in axes of `link`; of the last
    /// [`System::reactions`]. For a joint of several steps this is what its last step passes on.
    pub fn reaction(&self, link: LinkId, work: &Workspace) -> Reaction {
        let i = link.node();
        in_axes_of(&work.positions.nodes()[i], &work.reactions[i])
    }
}

/// A wrench in global axes, turned to the axes of a node.
#[inline]
fn in_axes_of(node: &NodePosition, wrench: &Wrench) -> Wrench {
    Wrench {
        torque: node.rotation.tr_mul(&wrench.torque),
        force: node.rotation.tr_mul(&wrench.force),
    }
}
