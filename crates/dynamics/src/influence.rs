//! How reactions depend on the loads that depend on them.
//!
//! For given position and velocity the reactions are affine in the generalised forces `tau` of these loads. A load acts through
//! two things only: the multipliers of the closures, `Lambda tau`, and the rates of the speeds, `X tau`.
//!
//! * A multiplier acts on the reactions between its frames and the ground, and nothing but levers is needed to say how.
//! * Each of the few motions of which `X` is made (see [`crate::response`]) takes one walk of inertial wrenches through the tree.
//!
//! Loads are kept by fours, so that one operation serves four of them.

use crate::inertial_walk::{Spatial, inertial_walk};
use crate::lanes::{Four, Lanes};
use crate::lever::{Felt, FourLoads, Places, Sides};
use crate::response::Response;
use crate::system::System;
use crate::workspace::Workspace;
use std::array::from_fn;

/// What loads feel of their reactions, as affine functions of all loads.
#[derive(Clone, Debug)]
pub(crate) struct Influence {
    loads: usize,
    /// Four loads each.
    fours: Vec<FourLoads>,
    has_supports: bool,
    /// Which side of which closure four loads are on, one closure after the other.
    sides: Vec<Sides>,
    response: Response,
    /// Scratch of the walks, two at once, and the wrenches of all.
    walk_rates: Vec<Lanes<2>>,
    accelerations: Vec<Spatial<2>>,
    wrenches: Vec<Spatial<2>>,
    /// What is felt in each walk, and of each unit multiplier; of the four loads last asked.
    walked: Vec<Felt>,
    units: Vec<Felt>,
    /// What is felt without loads and of each unit load: by the first four loads, by the next, ... Unit loads are filled up to
    /// fours with zeros.
    felt: Vec<Felt>,
}

impl Influence {
    pub fn new(system: &System) -> Self {
        let (loads, speeds) = (system.reaction_loads.len(), system.tree.speeds());
        let (width, motions, nodes) = (loads.div_ceil(4), loads.min(speeds), system.tree.nodes().len());
        let fours = system.reaction_loads.chunks(4);
        let sides = |closure| fours.clone().map(move |loads| Sides::new(loads, closure));
        Self {
            loads,
            fours: fours.clone().map(FourLoads::new).collect(),
            has_supports: system.reaction_loads.iter().all(|on| on.load.supports().is_some()),
            sides: system.closures.iter().flat_map(sides).collect(),
            response: Response::new(loads, speeds),
            walk_rates: vec![Lanes::ZERO; speeds],
            accelerations: vec![Spatial::ZERO; nodes],
            wrenches: vec![Spatial::ZERO; (motions / 2 + 1) * nodes],
            walked: vec![[Four::ZERO; 6]; 1 + motions],
            units: vec![[Four::ZERO; 6]; system.equations],
            felt: vec![[Four::ZERO; 6]; (1 + 4 * width) * width],
        }
    }

    /// Whether all loads are sums of lengths on supports.
    #[inline]
    pub fn has_supports(&self) -> bool {
        self.has_supports
    }

    /// What is felt without loads and of each unit load, by all fours of loads one after the other.
    #[inline]
    pub fn felt(&self) -> &[Felt] {
        &self.felt
    }

    /// What load `j` feels without loads (`k = 0`), or of unit load `k - 1`.
    pub fn felt_by(&self, j: usize, k: usize) -> [f64; 6] {
        self.felt[j / 4 * (1 + 4 * self.fours.len()) + k].map(|component| component.0[j % 4])
    }

    /// Adds to the rates of the speeds what the loads do to them.
    #[inline]
    pub fn add_rates(&self, tau: &[f64], rates: &mut [f64]) {
        self.response.add(tau, rates);
    }
}

impl System {
    /// Finds what loads feel of their reactions, from the last solution in `work`.
    #[inline]
    pub(crate) fn find_influence(&self, work: &mut Workspace) {
        let rank = self.equations - work.constraint.redundant();
        let freedoms = self.tree.speeds().saturating_sub(rank);
        let (own, first_unit) = (&self.reaction_loads, work.first_unit);
        let influence = &mut work.reaction_loop.influence;
        influence.response.find(
            influence.loads.min(freedoms),
            |k| own[k].speed,
            |speed, k| work.solutions.at(speed, first_unit + k),
            work.mass.inverse_diagonal(),
        );
        work.counters.reaction_sweeps += 1 + influence.response.motions() as u64;
        self.walk_motions(work);
        for w in 0..work.reaction_loop.influence.fours.len() {
            if work.reaction_loop.influence.has_supports {
                self.feel::<5>(w, work);
            } else {
                self.feel::<6>(w, work);
            }
        }
    }

    /// Walks without loads (the first) and in each motion, by pairs.
    #[inline]
    fn walk_motions(&self, work: &mut Workspace) {
        let influence = &mut work.reaction_loop.influence;
        let nodes = self.tree.nodes();
        for pair in 0..influence.response.motions() / 2 + 1 {
            for (speed, rate) in work.rates.iter().enumerate() {
                let left = if pair == 0 {
                    *rate
                } else {
                    influence.response.rate(2 * pair - 1, speed)
                };
                influence.walk_rates[speed] = Lanes([left, influence.response.rate(2 * pair, speed)]);
            }
            inertial_walk(
                nodes,
                work.positions.nodes(),
                &work.inertias,
                &influence.walk_rates,
                (pair == 0).then_some(work.own.as_slice()),
                &mut influence.accelerations,
                &mut influence.wrenches[pair * nodes.len()..],
            );
        }
    }

    /// What four loads feel, of which the first `N` components are not zero.
    #[inline]
    fn feel<const N: usize>(&self, w: usize, work: &mut Workspace) {
        let influence = &mut work.reaction_loop.influence;
        let (nodes, loads) = (self.tree.nodes().len(), influence.loads);
        let width = influence.fours.len();
        let places = Places::new(&influence.fours[w], work.positions.nodes(), influence.has_supports);
        let on_nodes = influence.fours[w].nodes;

        let walked = &mut influence.walked[..1 + influence.response.motions()];
        for (k, walked) in walked.iter_mut().enumerate() {
            let through = on_nodes.map(|node| &influence.wrenches[k / 2 * nodes + node]);
            let force = from_fn(|i| Lanes(from_fn(|l| through[l].linear[i].0[k % 2])));
            let torque = from_fn(|i| Lanes(from_fn(|l| through[l].angular[i].0[k % 2])));
            *walked = places.feel(places.local(&force), places.local(&torque));
        }

        let mut first = 0;
        for (closure, sides) in self.closures.iter().zip(influence.sides.iter().skip(w).step_by(width)) {
            places.feel_multipliers(closure, sides, &work.positions, &mut influence.units[first..]);
            first += closure.equations();
        }

        let multipliers = work.constraint.all();
        let felt = &mut influence.felt[w * (1 + 4 * width)..][..1 + loads];
        for (k, felt) in felt.iter_mut().enumerate() {
            let column = if k == 0 { 0 } else { work.first_unit + k - 1 };
            let mut sum = [Four::ZERO; N];
            let mut add = |felt: &Felt, factor: f64| sum = from_fn(|i| sum[i] + felt[i] * factor);
            for (unit, multiplier) in influence.units.iter().zip(multipliers.column(column)) {
                add(unit, multiplier);
            }
            if k == 0 {
                add(&walked[0], 1.0);
            } else {
                for (r, walked) in walked[1..].iter().enumerate() {
                    add(walked, influence.response.shares(r)[k - 1]);
                }
            }
            felt[..N].copy_from_slice(&sum);
        }
    }
}
