//! Multipliers of smallest norm where equations are redundant.
//!
//! The elimination leaves the multipliers of redundant equations at zero. Any others `z` for them do as well, if those before them in
//! their block, and those of inner loops, answer: `mu = T [z; mu_others]`. The smallest `|lambda - mu|^2` is found by eliminating
//! one block after the other from this sum of squares, as the closures were from the equations of motion.

use super::{Loops, Plan};

/// Factors of the sum of squares, and scratch.
#[derive(Clone, Debug)]
pub(super) struct Smallest {
    /// Second derivatives of the sum of squares: kept as the rows of `S` are.
    squares: Vec<f64>,
    /// `T`: a row each own multiplier in the order of pivots, a column each redundant one and each of others.
    answers: Vec<f64>,
    /// Eliminated rows for the redundant multipliers, with inverse pivots.
    factors: Vec<f64>,
    inverse: Vec<f64>,
    /// Scratch, as large as the largest block.
    image: Vec<f64>,
    square: Vec<f64>,
    /// First derivatives, an equation each; then the answers `mu`.
    slope: Vec<f64>,
    /// Eliminated slopes of redundant multipliers, by place.
    known: Vec<f64>,
}

impl Smallest {
    pub fn new(plan: &Plan) -> Self {
        let equations: usize = plan.blocks.iter().map(|block| block.own).sum();
        let largest = plan.blocks.iter().map(|block| block.equations.len()).max().unwrap_or(0);
        let most = plan.blocks.iter().map(|block| block.own * block.equations.len());
        Self {
            squares: vec![0.0; plan.entries],
            answers: vec![0.0; plan.entries],
            factors: vec![0.0; plan.entries],
            inverse: vec![0.0; equations],
            image: vec![0.0; most.max().unwrap_or(0)],
            square: vec![0.0; largest * largest],
            slope: vec![0.0; equations],
            known: vec![0.0; equations],
        }
    }

    /// Finds answers and factors for factored loops.
    pub fn factor(&mut self, loops: &Loops) {
        self.squares.fill(0.0);
        for block in &loops.plan.blocks {
            let width = block.equations.len();
            (0..block.own).for_each(|k| self.squares[block.rows + k * width + k] = 1.0);
        }
        for b in 0..loops.plan.blocks.len() {
            self.find_answers(loops, b);
            self.eliminate(loops, b);
        }
    }

    /// `T` of a block by back substitution.
    fn find_answers(&mut self, loops: &Loops, b: usize) {
        let block = &loops.plan.blocks[b];
        let (own, width, rank) = (block.own, block.equations.len(), loops.rank[b]);
        let (free, count) = (own - rank, width - rank);
        let rows = &loops.rows[block.rows..];
        let answers = &mut self.answers[block.rows..block.rows + own * width];
        for i in (0..own).rev() {
            for c in 0..count {
                answers[i * width + c] = if i >= rank {
                    f64::from(u8::from(c == i - rank))
                } else {
                    let direct = if c < free { 0.0 } else { rows[i * width + rank + c] };
                    let sum = (i + 1..own).fold(direct, |sum, k| sum + rows[i * width + k] * answers[k * width + c]);
                    -sum * loops.inverse[block.first + i]
                };
            }
        }
    }

    /// Takes a block out of the sum of squares.
    fn eliminate(&mut self, loops: &Loops, b: usize) {
        let block = &loops.plan.blocks[b];
        let (own, width, rank) = (block.own, block.equations.len(), loops.rank[b]);
        let (free, count) = (own - rank, width - rank);
        if count == 0 {
            return;
        }
        let order = &loops.order[block.first..block.first + own];
        let answers = &self.answers[block.rows..block.rows + own * width];
        let squares = &self.squares[block.rows..block.rows + own * width];
        let (image, square) = (&mut self.image, &mut self.square);
        let mixed = |i: usize, c: usize| {
            if c < free {
                0.0
            } else {
                squares[order[i] * width + rank + c]
            }
        };
        for i in 0..own {
            for c in 0..count {
                let sum = (0..own).map(|k| {
                    let (low, high) = (order[i].min(order[k]), order[i].max(order[k]));
                    squares[low * width + high] * answers[k * width + c]
                });
                image[i * width + c] = sum.sum::<f64>() + mixed(i, c);
            }
        }
        for c in 0..count {
            for d in c..count {
                let term =
                    |i: usize| answers[i * width + c] * image[i * width + d] + mixed(i, c) * answers[i * width + d];
                square[c * width + d] = (0..own).map(term).sum();
            }
        }
        // The free ones first: their pivots are at least 1.
        for i in 0..free {
            let inverse = 1.0 / square[i * width + i];
            self.inverse[block.first + i] = inverse;
            for k in i + 1..count {
                let factor = square[i * width + k] * inverse;
                (k..count).for_each(|l| square[k * width + l] -= factor * square[i * width + l]);
            }
            self.factors[block.rows + i * width..][..count].copy_from_slice(&square[i * width..][..count]);
        }
        let squares = &mut self.squares;
        let others = |k: usize| free + k;
        block
            .pairs
            .each(|place, k, l| squares[place] += square[others(k) * width + others(l)]);
    }

    /// The part of multipliers that exerts no force on any freedom, which is the part of a closure bias that no motion answers:
    /// without it they are the shortest that do the same.
    pub fn idle(&mut self, loops: &Loops, values: &[f64]) -> &[f64] {
        self.slope.copy_from_slice(values);
        for (b, block) in loops.plan.blocks.iter().enumerate() {
            let (own, width, rank) = (block.own, block.equations.len(), loops.rank[b]);
            let (free, count) = (own - rank, width - rank);
            let order = &loops.order[block.first..block.first + own];
            let answers = &self.answers[block.rows..];
            // What the free ones and the others get to feel of the block's own slopes.
            let square = &mut self.square[..count];
            for (c, sum) in square.iter_mut().enumerate() {
                let term = |i: usize| answers[i * width + c] * self.slope[block.equations[order[i]]];
                *sum = (0..own).map(term).sum();
            }
            for i in 0..free {
                let share = square[i] * self.inverse[block.first + i];
                self.known[block.first + i] = share;
                let factors = &self.factors[block.rows + i * width..];
                (i + 1..count).for_each(|k| square[k] -= factors[k] * share);
            }
            for (k, sum) in block.equations[own..].iter().zip(&square[free..]) {
                self.slope[*k] += sum;
            }
        }
        // Slopes become answers, outward.
        for (b, block) in loops.plan.blocks.iter().enumerate().rev() {
            let (own, width, rank) = (block.own, block.equations.len(), loops.rank[b]);
            let (free, count) = (own - rank, width - rank);
            let order = &loops.order[block.first..block.first + own];
            let square = &mut self.square[..count];
            for (x, k) in square[free..].iter_mut().zip(&block.equations[own..]) {
                *x = self.slope[*k];
            }
            for i in (0..free).rev() {
                let factors = &self.factors[block.rows + i * width..];
                let sum: f64 = (i + 1..count).map(|k| factors[k] * square[k]).sum();
                square[i] = self.known[block.first + i] - sum * self.inverse[block.first + i];
            }
            for i in 0..own {
                let row = &self.answers[block.rows + i * width..][..count];
                let k = block.equations[order[i]];
                self.slope[k] = row.iter().zip(&*square).map(|(t, x)| t * x).sum();
            }
        }
        &self.slope
    }
}
