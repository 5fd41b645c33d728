//! What the elimination of loops can know before the run: which multipliers pass which nodes, and where they are eliminated.

use crate::guide::Guided;
use crate::system::System;
use linkdyn_kinematics::{Closure, Tree};
use std::ops::Range;

/// A group of equations with multipliers of its own: a closure, or a coordinate with a prescribed motion.
#[derive(Clone, Debug)]
struct Group {
    /// Its equations among all.
    equations: Range<usize>,
    /// Nodes on exactly one of the ways from its two ends to the ground.
    path: Vec<usize>,
    /// The nearest node that lies on both ways: it moves the loop as a whole.
    meeting: usize,
}

/// Multipliers at a node. A **slot** is a place for one multiplier at one node.
#[derive(Clone, Debug)]
pub(crate) struct Front {
    /// Blocks that are eliminated at the node, before its freedom is.
    pub blocks: Range<usize>,
    /// Slots of the multipliers that the node's freedom works on, and that go on to the node before.
    pub passing: Range<usize>,
    /// Where products of those belong.
    pub pairs: Pairs,
}

/// Multipliers that are eliminated together.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Where it is eliminated.
    node: usize,
    /// Its own equations, then those of others that it is coupled with; by their numbers among all.
    pub equations: Vec<usize>,
    /// How many are its own.
    pub own: usize,
    /// Start of its rows, one an equation of its own with a column for each of `equations`, among those of all blocks.
    pub rows: usize,
    /// Place of its first own equation among those of all blocks.
    pub first: usize,
    /// Slot of its first own multiplier at the node; the others follow.
    pub slot: usize,
    /// Slots of the coupled multipliers at the node.
    pub others: Vec<usize>,
    /// Where products of those belong.
    pub pairs: Pairs,
}

/// Where the products of any two of a list of multipliers belong: each in the block that is eliminated first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs(Vec<Share>);

/// Neighbours in the list that belong to one block.
#[derive(Clone, Debug)]
struct Share {
    block: usize,
    rows: usize,
    width: usize,
    members: Range<usize>,
    /// Columns in the block of these and of all that follow in the list.
    columns: Vec<usize>,
}

/// The plan for a tree with closures.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// One a node.
    pub fronts: Vec<Front>,
    /// In the order of elimination.
    pub blocks: Vec<Block>,
    /// For each slot its equation.
    pub equations: Vec<usize>,
    /// For each slot that passes on, its slot at the node before.
    pub before: Vec<usize>,
    /// For each closure, then for each prescribed motion, the speeds that may move it, ascending, with the slot of its first equation there.
    pub speeds: Vec<Vec<(usize, usize)>>,
    /// Numbers in the rows of all blocks.
    pub entries: usize,
}

impl Pairs {
    /// Calls `add(place, k, l)` for all pairs `k <= l` of the list, with the place among the rows of all blocks.
    #[inline]
    pub fn each(&self, mut add: impl FnMut(usize, usize, usize)) {
        for share in &self.0 {
            let first = share.members.start;
            for (k, row) in share.members.clone().zip(&share.columns) {
                let row = share.rows + row * share.width;
                for (l, column) in share.columns.iter().enumerate().skip(k - first) {
                    add(row + column, k, first + l);
                }
            }
        }
    }

    /// The blocks that have part.
    #[inline]
    pub fn blocks(&self) -> impl Iterator<Item = usize> {
        self.0.iter().map(|share| share.block)
    }

    /// Number of pairs.
    fn count(&self) -> usize {
        let of = |share: &Share| share.members.len() * share.columns.len();
        self.0.iter().map(of).sum()
    }
}

impl Group {
    fn new(tree: &Tree, closure: &Closure, first: usize) -> Self {
        let up = |node: usize| std::iter::successors(Some(node), |&i| (i != 0).then(|| tree.nodes()[i].parent));
        let (mut one, mut two): (Vec<_>, Vec<_>) = (
            up(closure.predecessor().link.node()).collect(),
            up(closure.successor().link.node()).collect(),
        );
        let mut meeting = 0;
        while let (Some(&a), Some(&b)) = (one.last(), two.last())
            && a == b
        {
            meeting = a;
            one.pop();
            two.pop();
        }
        one.extend(two);
        Self {
            equations: first..first + closure.equations(),
            path: one,
            meeting,
        }
    }

    /// The equation of a prescribed motion holds one freedom, between a node and that before it.
    fn of_guide(tree: &Tree, guided: &Guided, equation: usize) -> Self {
        let nodes = tree.nodes().iter().enumerate();
        let held = nodes.filter(|(_, node)| node.speed == guided.speed);
        let (path, before): (Vec<usize>, Vec<usize>) = held.map(|(i, node)| (i, node.parent)).unzip();
        Self {
            equations: equation..equation + 1,
            path,
            meeting: before.first().copied().unwrap_or(0),
        }
    }
}

impl Plan {
    pub fn new(system: &System) -> Self {
        let tree = &system.tree;
        let mut first = 0;
        let group = |closure: &Closure| {
            let group = Group::new(tree, closure, first);
            first = group.equations.end;
            group
        };
        let mut groups: Vec<Group> = system.closures.iter().map(group).collect();
        let guided = (system.closure_equations..).zip(&system.guided);
        groups.extend(guided.map(|(equation, guided)| Group::of_guide(tree, guided, equation)));
        let nodes = tree.nodes().len();
        let mut active = vec![Vec::new(); nodes];
        for (g, group) in groups.iter().enumerate() {
            group.path.iter().for_each(|&node| active[node].push(g));
        }

        // Groups that meet at a node make one block if they come through the same branch, or are joined by others that do.
        let mut component: Vec<usize> = (0..groups.len()).collect();
        for (i, node) in tree.nodes().iter().enumerate().skip(1) {
            let mut together = active[i].iter().filter(|&&g| groups[g].meeting == node.parent);
            if let Some(&one) = together.next() {
                for &other in together {
                    let (from, to) = (component[other], component[one]);
                    component.iter_mut().filter(|c| **c == from).for_each(|c| *c = to);
                }
            }
        }
        let mut order: Vec<usize> = (0..groups.len()).filter(|&g| !groups[g].equations.is_empty()).collect();
        order.sort_by_key(|&g| (usize::MAX - groups[g].meeting, component[g], g));
        let mut place = vec![usize::MAX; groups.len()];
        order.iter().enumerate().for_each(|(k, &g)| place[g] = k);
        for list in &mut active {
            list.retain(|&g| place[g] != usize::MAX);
            list.sort_by_key(|&g| place[g]);
        }

        let mut plan = Self {
            fronts: Vec::new(),
            blocks: Vec::new(),
            equations: Vec::new(),
            before: Vec::new(),
            speeds: vec![Vec::new(); groups.len()],
            entries: 0,
        };
        plan.make_blocks(tree, &groups, &order, &component, &active);
        plan.make_fronts(tree, &groups, &active);
        plan
    }

    /// Blocks without their slots.
    fn make_blocks(
        &mut self,
        tree: &Tree,
        groups: &[Group],
        order: &[usize],
        component: &[usize],
        active: &[Vec<usize>],
    ) {
        let mut children = vec![Vec::new(); active.len()];
        for (i, node) in tree.nodes().iter().enumerate().skip(1) {
            children[node.parent].push(i);
        }
        let mut first = 0;
        for own in order.chunk_by(|&a, &b| component[a] == component[b]) {
            let node = groups[own[0]].meeting;
            let shared = children[node]
                .iter()
                .filter(|&&child| active[child].iter().any(|g| own.contains(g)));
            let shared: Vec<usize> = shared.flat_map(|&child| &active[child]).copied().collect();
            let others = active[node].iter().filter(|g| shared.contains(g));
            let equations_of =
                |list: &[usize]| -> Vec<usize> { list.iter().flat_map(|&g| groups[g].equations.clone()).collect() };
            let mut equations = equations_of(own);
            let count = equations.len();
            equations.extend(equations_of(&others.copied().collect::<Vec<_>>()));
            let entries = count * equations.len();
            self.blocks.push(Block {
                node,
                equations,
                own: count,
                rows: self.entries,
                first,
                slot: 0,
                others: Vec::new(),
                pairs: Pairs::default(),
            });
            self.entries += entries;
            first += count;
        }
    }

    fn make_fronts(&mut self, tree: &Tree, groups: &[Group], active: &[Vec<usize>]) {
        let equations = groups.iter().map(|group| group.equations.end).max().unwrap_or(0);
        // Block and column of each equation in its own block.
        let mut home = vec![(0, 0); equations];
        for (b, block) in self.blocks.iter().enumerate() {
            for (column, &equation) in block.equations[..block.own].iter().enumerate() {
                home[equation] = (b, column);
            }
        }
        let mut slots_of = vec![0..0; active.len()];
        let mut next_block = self.blocks.len();
        let mut blocks_at = vec![0..0; active.len()];
        for (i, range) in blocks_at.iter_mut().enumerate() {
            let end = next_block;
            while next_block > 0 && self.blocks[next_block - 1].node == i {
                next_block -= 1;
            }
            *range = next_block..end;
        }
        for (i, node) in tree.nodes().iter().enumerate() {
            let start = self.equations.len();
            for block in &mut self.blocks[blocks_at[i].clone()] {
                block.slot = self.equations.len();
                self.equations.extend(&block.equations[..block.own]);
            }
            let passing = self.equations.len();
            for &g in &active[i] {
                if node.speed != usize::MAX {
                    self.speeds[g].push((node.speed, self.equations.len()));
                }
                self.equations.extend(groups[g].equations.clone());
            }
            slots_of[i] = start..self.equations.len();
            let list = self.equations[passing..].to_vec();
            let pairs = self.pairs(&list, &home);
            self.fronts.push(Front {
                blocks: blocks_at[i].clone(),
                passing: passing..self.equations.len(),
                pairs,
            });
        }
        self.speeds.iter_mut().for_each(|list| list.sort_unstable());
        let slot_at = |i: usize, equation: usize, all: &[usize]| {
            let range: Range<usize> = slots_of[i].clone();
            range.start + all[range].iter().position(|&e| e == equation).unwrap_or(0)
        };
        self.before = vec![0; self.equations.len()];
        for (i, node) in tree.nodes().iter().enumerate().skip(1) {
            for slot in self.fronts[i].passing.clone() {
                self.before[slot] = slot_at(node.parent, self.equations[slot], &self.equations);
            }
        }
        for (i, blocks) in blocks_at.iter().enumerate() {
            for b in blocks.clone() {
                let others = self.blocks[b].equations[self.blocks[b].own..].to_vec();
                let slots = others.iter().map(|&equation| slot_at(i, equation, &self.equations));
                self.blocks[b].others = slots.collect();
                self.blocks[b].pairs = self.pairs(&others, &home);
            }
        }
    }

    /// Pairs of a list of equations in the order of elimination.
    fn pairs(&self, list: &[usize], home: &[(usize, usize)]) -> Pairs {
        let mut first = 0;
        let shares = list.chunk_by(|&a, &b| home[a].0 == home[b].0).map(|members| {
            let b = home[members[0]].0;
            let block = &self.blocks[b];
            // Both lists are in the order of elimination, so that one walk finds all.
            let mut columns = Vec::with_capacity(list.len() - first);
            let mut column = 0;
            for equation in &list[first..] {
                while column < block.equations.len() && block.equations[column] != *equation {
                    column += 1;
                }
                columns.push(column);
            }
            let start = first;
            first += members.len();
            Share {
                block: b,
                rows: block.rows,
                width: block.equations.len(),
                members: start..first,
                columns,
            }
        });
        Pairs(shares.collect())
    }

    /// Multiplications and additions that the elimination takes, nearly, the walks of the tree itself apart.
    pub fn cost(&self) -> usize {
        let front = |front: &Front| PER_SLOT * front.passing.len() + 2 * front.pairs.count();
        let block = |block: &Block| {
            let (own, all) = (block.own, block.equations.len());
            own * (own * (own + 21) / 2 + (all - own) * (all + 14))
        };
        self.fronts.iter().map(front).sum::<usize>() + self.blocks.iter().map(block).sum::<usize>()
    }
}

/// Multiplications and additions for a multiplier at a node: its force, share, shift, and the place of its wrench.
const PER_SLOT: usize = 60;
