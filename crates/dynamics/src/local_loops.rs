//! Elimination of loops on the way inward, at a cost linear in the number of links for loops of a bounded size
//! \[Anderson and Critchley 2003; Sathya and Carpentier 2026\].
//!
//! The unit multipliers of a closure act between its two ends and the node where the ways from there to the ground meet. From there on
//! the freedoms move the loop as a whole. What is articulated beyond answers at the meeting node, of acceleration `a`, with the wrench
//! `I a + p + W lambda`, and the closure demands `S lambda = W^T a - beta`: both by the inward walk of articulated bodies,
//! `W` from the closure's forces on the freedoms as `p` from other forces. So the loop adds `W S^-1 W^T` to the inertia and
//! `-W S^-1 beta` to the wrench, and is gone. Multipliers of loops that meet nearer to the ground and share freedoms with it
//! stay, with their part of `S`, `W` and `beta` reduced.
//!
//! `S` of a block is factored with pivots, so that redundant equations show: they demand nothing, and [`smallest`] shares out the
//! multipliers.

mod plan;
mod refine;
mod smallest;

use crate::articulated::{Articulated, ArticulatedInertia, Passengers, Pivot};
use crate::columns::Columns;
use crate::composite::{ROUNDING, along};
use crate::constraint::{NOTHING, REDUNDANT};
use crate::symmetric::SpatialInertia;
use linkdyn_kinematics::{Node, NodePosition, Tree, Twist, Wrench};
pub(crate) use plan::Plan;
pub(crate) use refine::Column;
use smallest::Smallest;

/// Articulated bodies with loops eliminated on the way.
#[derive(Clone, Debug)]
pub(crate) struct LocalLoops {
    articulated: Articulated,
    loops: Loops,
    smallest: Smallest,
    /// Scratch, an equation each.
    known: Vec<f64>,
    scratch: refine::Scratch,
}

/// All multipliers, block by block, slot by slot; see [`Plan`].
#[derive(Clone, Debug)]
struct Loops {
    plan: Plan,
    /// Slots: entry of the closure gradient, the same taken inward, wrench.
    gradient: Vec<f64>,
    forces: Vec<f64>,
    wrenches: Vec<Wrench>,
    /// Rows of `S` of all blocks: upper triangle of what is a block's own, and all of what it shares; then their factors.
    rows: Vec<f64>,
    /// Diagonal of `S` before any elimination, an equation each.
    diagonal: Vec<f64>,
    /// Error of that which inner loops have left of it, in units of rounding: small pivots of theirs magnify what they had of it.
    error: Vec<f64>,
    /// Sum of the inverse pivots of the freedoms that move a block.
    mobility: Vec<f64>,
    /// For each block, one after the other: its own equations' columns in the order of pivots, and the inverse pivots.
    order: Vec<usize>,
    inverse: Vec<f64>,
    rank: Vec<usize>,
    /// Largest ratio of a square, its error included, to the pivot that it became.
    doubt: f64,
    /// What is left of each equation of a column taken inward, and the multipliers.
    beta: Vec<f64>,
    lambda: Vec<f64>,
}

impl LocalLoops {
    pub fn new(tree: &Tree, plan: Plan) -> Self {
        let (slots, entries, blocks) = (plan.equations.len(), plan.entries, plan.blocks.len());
        let equations: usize = plan.blocks.iter().map(|block| block.own).sum();
        Self {
            articulated: Articulated::new(tree),
            smallest: Smallest::new(&plan),
            known: vec![0.0; equations],
            scratch: refine::Scratch::new(tree.speeds(), equations),
            loops: Loops {
                gradient: vec![0.0; slots],
                forces: vec![0.0; slots],
                wrenches: vec![Wrench::zero(); slots],
                rows: vec![0.0; entries],
                diagonal: vec![0.0; equations],
                error: vec![0.0; equations],
                mobility: vec![0.0; blocks],
                order: vec![0; equations],
                inverse: vec![0.0; equations],
                rank: vec![0; blocks],
                doubt: 0.0,
                beta: vec![0.0; equations],
                lambda: vec![0.0; equations],
                plan,
            },
        }
    }

    /// Sets an entry of the closure gradient.
    #[inline]
    pub fn put(&mut self, closure: usize, speed: usize, equation: usize, value: f64) {
        let speeds = &self.loops.plan.speeds[closure];
        if let Ok(place) = speeds.binary_search_by_key(&speed, |entry| entry.0) {
            self.loops.gradient[speeds[place].1 + equation] = value;
        }
    }

    /// Sets the closure gradient of a closure as `gradient` tells it.
    #[inline(never)]
    pub fn put_closure(&mut self, closure: usize, gradient: impl FnOnce(&mut dyn FnMut(usize, usize, f64))) {
        gradient(&mut |speed, equation, value| self.put(closure, speed, equation, value));
    }

    pub fn inverse_diagonal(&self) -> &[f64] {
        self.articulated.inverse_diagonal()
    }

    /// See [`Plan::cost`].
    pub fn work(&self) -> usize {
        self.loops.plan.cost()
    }

    /// Number of independent equations.
    pub fn rank(&self) -> usize {
        self.loops.rank.iter().sum()
    }

    /// As [`Articulated::factor`], with the loops by the gradient put; the closure bias `gamma` goes with the first column.
    pub fn factor(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        bodies: &[SpatialInertia],
        wrenches: &[Wrench],
        columns: &mut Columns,
        gamma: &[f64],
    ) -> Result<(), (usize, f64)> {
        let loops = &mut self.loops;
        loops.wrenches.fill(Wrench::zero());
        loops.rows.fill(0.0);
        loops.diagonal.fill(0.0);
        loops.error.fill(0.0);
        loops.mobility.fill(0.0);
        loops.doubt = 0.0;
        loops.beta.copy_from_slice(gamma);
        self.articulated
            .factor(nodes, positions, bodies, wrenches, columns, loops)?;
        let mut ground = ArticulatedInertia::rigid(&SpatialInertia::ZERO);
        loops.gathered(0, &mut ground, &mut Wrench::zero());
        if self.is_redundant() {
            self.smallest.factor(&self.loops);
            self.make_consistent(nodes, positions, columns, gamma);
        }
        Ok(())
    }

    fn is_redundant(&self) -> bool {
        self.rank() < self.known.len()
    }

    /// Takes off the first column, factored with it, that part of the closure bias which no motion answers, so that it does not
    /// matter which of the redundant equations are kept. Needs a column behind the first as scratch.
    fn make_consistent(&mut self, nodes: &[Node], positions: &[NodePosition], columns: &mut Columns, gamma: &[f64]) {
        const SCRATCH: usize = 1;
        let loops = &mut self.loops;
        self.known.copy_from_slice(&loops.beta);
        let idle = self.smallest.idle(loops, gamma);
        loops.beta.iter_mut().zip(idle).for_each(|(x, idle)| *x = -idle);
        let speeds = self.articulated.inverse_diagonal().len();
        (0..speeds).for_each(|speed| *columns.at_mut(speed, SCRATCH) = 0.0);
        self.articulated.inward(nodes, positions, columns, SCRATCH, loops);
        loops.gathered_column(0, &mut Wrench::zero());
        loops
            .beta
            .iter_mut()
            .zip(&self.known)
            .for_each(|(x, known)| *x += known);
        (0..speeds).for_each(|speed| *columns.at_mut(speed, 0) += columns.at(speed, SCRATCH));
    }

    /// Takes another column inward; `gamma` is the bias that goes with it, none if empty.
    pub fn inward(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        columns: &mut Columns,
        column: usize,
        gamma: &[f64],
    ) {
        self.loops.beta.fill(0.0);
        self.loops.beta[..gamma.len()].copy_from_slice(gamma);
        if self.is_redundant() && !gamma.is_empty() {
            let idle = self.smallest.idle(&self.loops, gamma);
            self.loops.beta.iter_mut().zip(idle).for_each(|(x, idle)| *x -= idle);
        }
        self.articulated
            .inward(nodes, positions, columns, column, &mut self.loops);
        self.loops.gathered_column(0, &mut Wrench::zero());
    }

    /// Rates of the speeds, into a column of `solutions`, and [`multipliers`](Self::multipliers) for the column that was last taken
    /// inward.
    pub fn outward(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        inward: &Columns,
        solutions: &mut Columns,
        column: usize,
    ) {
        for (speed, inverse) in self.articulated.inverse_diagonal().iter().enumerate() {
            *solutions.at_mut(speed, column) = inward.at(speed, column) * inverse;
        }
        self.loops.arrived(0, &Twist::zero());
        self.articulated
            .outward(nodes, positions, solutions, column, &mut self.loops);
        self.drop_idle();
    }

    /// Makes the multipliers the smallest ones that do the same.
    fn drop_idle(&mut self) {
        if self.is_redundant() {
            let idle = self.smallest.idle(&self.loops, &self.loops.lambda);
            self.loops.lambda.iter_mut().zip(idle).for_each(|(x, idle)| *x -= idle);
        }
    }
}

impl Passengers for Loops {
    fn gathered(&mut self, node: usize, inertia: &mut ArticulatedInertia, wrench: &mut Wrench) {
        for b in self.plan.fronts[node].blocks.clone() {
            self.factor_block(b);
            self.reduce_others(b, inertia);
            self.reduce_column(b, wrench);
        }
    }

    fn released(&mut self, index: usize, node: &Node, here: &NodePosition, pivot: &Pivot, share: f64) {
        let front = &self.plan.fronts[index];
        let moves = pivot.inverse != 0.0;
        for slot in front.passing.clone() {
            let mut wrench = self.wrenches[slot];
            if moves {
                let force = self.gradient[slot] - along(node, here, &wrench);
                let equation = self.plan.equations[slot];
                let answer = force * pivot.inverse;
                self.forces[slot] = force;
                self.diagonal[equation] += force * answer;
                self.beta[equation] += force * share;
                wrench.torque += pivot.u.torque * answer;
                wrench.force += pivot.u.force * answer;
            }
            if node.parent != 0 {
                self.wrenches[self.plan.before[slot]] += wrench.shifted(&here.arm);
            }
        }
        if moves {
            let (forces, rows) = (&self.forces[front.passing.clone()], &mut self.rows);
            front
                .pairs
                .each(|place, k, l| rows[place] += forces[k] * forces[l] * pivot.inverse);
            front.pairs.blocks().for_each(|b| self.mobility[b] += pivot.inverse);
        }
    }

    fn gathered_column(&mut self, node: usize, wrench: &mut Wrench) {
        for b in self.plan.fronts[node].blocks.clone() {
            self.reduce_column(b, wrench);
        }
    }

    fn released_column(&mut self, node: usize, share: f64) {
        for slot in self.plan.fronts[node].passing.clone() {
            self.beta[self.plan.equations[slot]] += self.forces[slot] * share;
        }
    }

    fn add_to_rate(&self, node: usize, inverse: f64, rate: &mut f64) {
        let slots = self.plan.fronts[node].passing.clone();
        let forces = &self.forces[slots.clone()];
        let equations = &self.plan.equations[slots];
        let force: f64 = forces
            .iter()
            .zip(equations)
            .map(|(force, &k)| force * self.lambda[k])
            .sum();
        *rate += force * inverse;
    }

    /// Multipliers of the blocks at a node; those that stand for redundant equations are zero.
    fn arrived(&mut self, node: usize, acceleration: &Twist) {
        for b in self.plan.fronts[node].blocks.clone().rev() {
            let block = &self.plan.blocks[b];
            let (own, width) = (block.own, block.equations.len());
            let order = &self.order[block.first..block.first + own];
            let equation = |column: usize| block.equations[if column < own { order[column] } else { column }];
            for i in (0..own).rev() {
                let k = equation(i);
                self.lambda[k] = 0.0;
                if i < self.rank[b] {
                    let row = &self.rows[block.rows + i * width..][..width];
                    let known = (i + 1..width).map(|l| row[l] * self.lambda[equation(l)]).sum::<f64>();
                    let moved = self.wrenches[block.slot + i].power(acceleration);
                    self.lambda[k] = (moved - self.beta[k] - known) * self.inverse[block.first + i];
                }
            }
        }
    }
}

impl Loops {
    /// Factors a block's rows with pivots, up to the rank; the wrenches of its own multipliers go along.
    fn factor_block(&mut self, b: usize) {
        let block = &self.plan.blocks[b];
        let (own, width) = (block.own, block.equations.len());
        let rows = &mut self.rows[block.rows..block.rows + own * width];
        let order = &mut self.order[block.first..block.first + own];
        let inverse = &mut self.inverse[block.first..block.first + own];
        let wrenches = &mut self.wrenches[block.slot..block.slot + own];
        order.iter_mut().enumerate().for_each(|(k, o)| *o = k);
        // Squares without what inner loops have taken: rounding is a share of these.
        let squares = block.equations[..own].iter().map(|&k| self.diagonal[k]);
        let floor = (REDUNDANT * squares.fold(0.0, f64::max)).max(NOTHING * self.mobility[b]);
        self.rank[b] = own;
        for i in 0..own {
            let sure = |p: usize| rows[p * width + p] - ROUNDING * self.error[block.equations[order[p]]];
            let p = (i + 1..own).fold(i, |p, q| if sure(q) <= sure(p) { p } else { q });
            if sure(p) <= floor {
                self.rank[b] = i;
                return;
            }
            let pivot = rows[p * width + p];
            if p != i {
                exchange(rows, own, width, i, p);
                order.swap(i, p);
                wrenches.swap(i, p);
            }
            inverse[i] = 1.0 / pivot;
            let equation = block.equations[order[i]];
            self.doubt = self.doubt.max((self.diagonal[equation] + self.error[equation]) / pivot);
            let (done, rest) = rows.split_at_mut((i + 1) * width);
            let row = &done[i * width..];
            for (k, target) in (i + 1..own).zip(rest.chunks_exact_mut(width)) {
                let factor = row[k] * inverse[i];
                magnify(&mut self.error, equation, block.equations[order[k]], factor);
                for (x, y) in target[k..].iter_mut().zip(&row[k..]) {
                    *x -= factor * y;
                }
                let wrench = wrenches[i];
                wrenches[k].torque -= wrench.torque * factor;
                wrenches[k].force -= wrench.force * factor;
            }
        }
    }

    /// Takes a factored block out of what is coupled with it, and adds what it holds to the inertia.
    fn reduce_others(&mut self, b: usize, inertia: &mut ArticulatedInertia) {
        let block = &self.plan.blocks[b];
        let (own, width) = (block.own, block.equations.len());
        for i in 0..self.rank[b] {
            let inverse = self.inverse[block.first + i];
            let start = block.rows + i * width + own;
            let wrench = self.wrenches[block.slot + i];
            inertia.hold(&wrench, inverse);
            let k = block.equations[self.order[block.first + i]];
            for (place, &slot) in (start..).zip(&block.others) {
                let factor = self.rows[place] * inverse;
                let other = self.plan.equations[slot];
                magnify(&mut self.error, k, other, factor);
                self.error[other] += factor * factor * self.diagonal[k];
                self.wrenches[slot].torque -= wrench.torque * factor;
                self.wrenches[slot].force -= wrench.force * factor;
            }
            let rows = &mut self.rows;
            block
                .pairs
                .each(|place, k, l| rows[place] -= rows[start + k] * rows[start + l] * inverse);
        }
    }

    /// Takes a factored block out of a column: out of what is coupled with it, and out of the wrench.
    fn reduce_column(&mut self, b: usize, wrench: &mut Wrench) {
        let block = &self.plan.blocks[b];
        let (own, width) = (block.own, block.equations.len());
        let order = &self.order[block.first..block.first + own];
        for i in 0..self.rank[b] {
            let share = self.beta[block.equations[order[i]]] * self.inverse[block.first + i];
            let row = &self.rows[block.rows + i * width..][..width];
            for k in i + 1..own {
                self.beta[block.equations[order[k]]] -= row[k] * share;
            }
            for (k, x) in block.equations[own..].iter().zip(&row[own..]) {
                self.beta[*k] -= x * share;
            }
            let held = &self.wrenches[block.slot + i];
            wrench.torque -= held.torque * share;
            wrench.force -= held.force * share;
        }
    }
}

/// Error of an equation's square after `factor` times another's row has been taken off: errors of inner loops may all have one sign.
#[inline]
fn magnify(error: &mut [f64], from: usize, to: usize, factor: f64) {
    error[to] = (error[to].sqrt() + factor.abs() * error[from].sqrt()).powi(2);
}

/// Exchanges places `i < p` of a symmetric matrix kept by its upper triangle, with more columns behind.
fn exchange(rows: &mut [f64], own: usize, width: usize, i: usize, p: usize) {
    (0..i).for_each(|k| rows.swap(k * width + i, k * width + p));
    rows.swap(i * width + i, p * width + p);
    (i + 1..p).for_each(|k| rows.swap(i * width + k, k * width + p));
    (p + 1..width).for_each(|k| rows.swap(i * width + k, p * width + k));
    debug_assert!(p < own);
}
