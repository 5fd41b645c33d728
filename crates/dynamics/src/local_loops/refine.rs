//! Refinement of a solution \[Higham 2002, ch. 12\], where the order of elimination has cost digits.
//!
//! Loops are eliminated in the order in which they close, whatever their pivots. One that is nearly singular by itself, while another
//! loop holds the same motion firmly, has a small pivot that the equations as a whole do not have, and magnifies rounding. What is
//! left of the equations themselves, solved for by the same factors, takes that away again.

use super::{LocalLoops, Loops};
use crate::columns::Columns;
use crate::composite::ROUNDING;
use crate::symmetric::SpatialInertia;
use linkdyn_kinematics::{Freedom, Node, NodePosition, Wrench};

/// Error of factors, relative, that is left alone: multipliers magnify it by some tens.
const GOOD: f64 = 1e-12;
/// Steps at most. Factors of the worst pivots that count are good to 1e-3.
const STEPS: u64 = 4;

/// What a column was before it was taken inward.
pub(crate) struct Column<'a, F> {
    /// Generalised force on a speed.
    pub force: F,
    /// Wrenches that the links take, none if empty.
    pub wrenches: &'a [Wrench],
    /// Closure bias, none if empty.
    pub gamma: &'a [f64],
}

/// Scratch.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// Solution so far.
    rates: Vec<f64>,
    lambda: Vec<f64>,
    /// What is left of the closures, and the part of it that no motion answers.
    gap: Vec<f64>,
    idle: Vec<f64>,
}

impl Scratch {
    pub fn new(speeds: usize, equations: usize) -> Self {
        Self {
            rates: vec![0.0; speeds],
            lambda: vec![0.0; equations],
            gap: vec![0.0; equations],
            idle: vec![0.0; equations],
        }
    }
}

impl LocalLoops {
    /// Steps of refinement that solutions need: each takes away as many digits of the error as the factors have.
    pub fn refinements(&self) -> u64 {
        let error = ROUNDING * self.loops.doubt;
        let errors = std::iter::successors(Some(error), |left| Some(left * error));
        errors.zip(0..STEPS).take_while(|(left, _)| *left > GOOD).count() as u64
    }

    /// Multipliers found last.
    pub fn multipliers(&self) -> &[f64] {
        &self.loops.lambda
    }

    /// Refines the solution that the last walk outward has left in a column of `solutions`, and its multipliers; `known` is what it
    /// solves. The same column of `columns` is scratch.
    pub fn refine(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        bodies: &[SpatialInertia],
        known: &Column<'_, impl Fn(usize) -> f64>,
        (columns, solutions): (&mut Columns, &mut Columns),
        column: usize,
    ) {
        let mut scratch = std::mem::take(&mut self.scratch);
        for _ in 0..self.refinements() {
            let Scratch {
                rates,
                lambda,
                gap,
                idle,
            } = &mut scratch;
            lambda.copy_from_slice(&self.loops.lambda);
            for (speed, rate) in rates.iter_mut().enumerate() {
                *rate = solutions.at(speed, column);
            }
            gap.fill(0.0);
            gap[..known.gamma.len()].copy_from_slice(known.gamma);
            self.loops
                .each_entry(nodes, |speed, equation, value| gap[equation] += value * rates[speed]);
            if self.is_redundant() {
                self.drop_contradiction(nodes, positions, (columns, solutions), column, (gap, idle));
            }
            for speed in 0..rates.len() {
                *columns.at_mut(speed, column) = (known.force)(speed);
            }
            let links = (bodies, known.wrenches);
            self.articulated
                .subtract_inertial(nodes, positions, links, rates, columns, column);
            self.loops.each_entry(nodes, |speed, equation, value| {
                *columns.at_mut(speed, column) += value * lambda[equation];
            });
            self.inward(nodes, positions, columns, column, gap);
            self.outward(nodes, positions, columns, solutions, column);
            for (speed, rate) in rates.iter().enumerate() {
                *solutions.at_mut(speed, column) += rate;
            }
            let found = self.loops.lambda.iter_mut().zip(lambda);
            found.for_each(|(x, known)| *x += *known);
            self.drop_idle();
        }
        self.scratch = scratch;
    }

    /// Takes off a closure bias what no motion answers. The factors know that only as well as all else; but as multipliers it should
    /// exert no force, and those that hold the force that it does exert mend it.
    fn drop_contradiction(
        &mut self,
        nodes: &[Node],
        positions: &[NodePosition],
        (columns, solutions): (&mut Columns, &mut Columns),
        column: usize,
        (gap, idle): (&mut [f64], &mut [f64]),
    ) {
        idle.copy_from_slice(self.smallest.idle(&self.loops, gap));
        let speeds = self.articulated.inverse_diagonal().len();
        (0..speeds).for_each(|speed| *columns.at_mut(speed, column) = 0.0);
        self.loops.each_entry(nodes, |speed, equation, value| {
            *columns.at_mut(speed, column) += value * idle[equation];
        });
        self.inward(nodes, positions, columns, column, &[]);
        self.outward(nodes, positions, columns, solutions, column);
        for (gap, (idle, mended)) in gap.iter_mut().zip(idle.iter().zip(&self.loops.lambda)) {
            *gap -= idle + mended;
        }
    }
}

impl Loops {
    /// Calls `f(speed, equation, value)` for all entries of the closure gradient.
    fn each_entry(&self, nodes: &[Node], mut f: impl FnMut(usize, usize, f64)) {
        for (front, node) in self.plan.fronts.iter().zip(nodes) {
            if node.freedom != Freedom::None {
                for slot in front.passing.clone() {
                    f(node.speed, self.plan.equations[slot], self.gradient[slot]);
                }
            }
        }
    }
}
