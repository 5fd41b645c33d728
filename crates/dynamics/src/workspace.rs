//! Scratch and results of one evaluation.

use crate::articulated::Articulated;
use crate::columns::Columns;
use crate::composite::Composite;
use crate::constraint::Multipliers;
use crate::local_loops::{LocalLoops, Plan};
use crate::reaction_loop::ReactionLoop;
use crate::symmetric::SpatialInertia;
use crate::system::{Formulation, System};
use linkdyn_kinematics::{Accelerations, Freedom, Positions, Twist, Velocities, Wrench};

/// Exact counts of the work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Evaluations: state to accelerations and multipliers.
    pub evaluations: u64,
    /// Inward walks that found joint reactions.
    pub reaction_sweeps: u64,
    /// Iterations of the loop reaction - load - acceleration.
    pub reaction_iterations: u64,
    /// Times that this loop had to follow its solution from vanishing loads on.
    pub reaction_continuations: u64,
    /// Evaluations at which closure equations were redundant.
    pub redundant: u64,
    /// Steps of refinement, where loops are eliminated one by one and one of them is nearly singular.
    pub refinements: u64,
}

/// The mass matrix in a form that can be solved with.
#[derive(Clone, Debug)]
pub(crate) enum MassFactor {
    Composite(Composite),
    Articulated(Articulated),
    LocalLoops(Box<LocalLoops>),
}

impl MassFactor {
    /// Inverse pivots `D^-1`, one a speed.
    #[inline]
    pub fn inverse_diagonal(&self) -> &[f64] {
        match self {
            MassFactor::Composite(mass) => mass.inverse_diagonal(),
            MassFactor::Articulated(mass) => mass.inverse_diagonal(),
            MassFactor::LocalLoops(mass) => mass.inverse_diagonal(),
        }
    }
}

/// Scratch for [`System::evaluate`] and its results. One a thread; contents mean nothing to the next evaluation.
#[derive(Clone, Debug)]
pub struct Workspace {
    pub(crate) positions: Positions,
    pub(crate) velocities: Velocities,
    pub(crate) biases: Accelerations,
    /// Links' own inertias, later composite ones.
    pub(crate) inertias: Vec<SpatialInertia>,
    /// Links' own bias wrenches less outside wrenches.
    pub(crate) own: Vec<Wrench>,
    /// Accumulated wrenches.
    pub(crate) wrenches: Vec<Wrench>,
    pub(crate) mass: MassFactor,
    /// Right-hand sides, a row each speed: generalised forces, closure gradient `G^T`, unit forces of reaction loads.
    pub(crate) columns: Columns,
    /// The column of the first unit reaction load, behind those of generalised forces and closures: a multiple of four.
    pub(crate) first_unit: usize,
    /// Rates of the speeds for each right-hand side (those of the closure gradient mean nothing).
    pub(crate) solutions: Columns,
    /// Generalised forces of loads, kept for their power.
    pub(crate) generalised: Vec<f64>,
    /// Rates of the internal states and of the integrals of all loads.
    pub(crate) state_rates: Vec<f64>,
    pub(crate) integral_rates: Vec<f64>,
    pub(crate) constraint: Multipliers,
    pub(crate) reaction_loop: ReactionLoop,
    pub(crate) rates: Vec<f64>,
    pub(crate) reactions: Vec<Wrench>,
    pub(crate) twists: Vec<Twist>,
    pub(crate) power: f64,
    pub(crate) counters: Counters,
}

/// Branches up to this depth (freedoms on the way to the ground) are cheaper by composite bodies; measured with the bench
/// `evaluation` on chains of revolute joints.
const COMPOSITE_DEPTH: usize = 6;

/// Fewer closure equations are always solved for at once, without a look at the work it takes.
const FEWEST_EQUATIONS: usize = 12;
/// Multiplications and additions that a dense column takes a speed, nearly, beside those for `S`.
const DENSE_COLUMN: usize = 50;

impl Workspace {
    /// Scratch for `system`.
    pub fn new(system: &System) -> Self {
        let tree = &system.tree;
        let nodes = tree.nodes().len();
        let depth = tree.joints().iter().map(|(link, _)| tree.path(*link).count()).max();
        let composite = match system.formulation {
            Formulation::Recursive => depth.unwrap_or(0) <= COMPOSITE_DEPTH,
            Formulation::ArticulatedBody | Formulation::LocalLoops => false,
            Formulation::CompositeBody | Formulation::Lagrange => true,
        };
        let mass = if let Some(plan) = plan_of_loops(system) {
            MassFactor::LocalLoops(Box::new(LocalLoops::new(tree, plan)))
        } else if composite {
            MassFactor::Composite(Composite::new(tree))
        } else {
            MassFactor::Articulated(Articulated::new(tree))
        };
        let is_dense = !matches!(mass, MassFactor::LocalLoops(_));
        let first_unit = if is_dense { 1 + system.equations } else { 1 }.next_multiple_of(4);
        let columns = first_unit + system.reaction_loads.len();
        let constraint = if is_dense {
            Multipliers::new(system.equations, columns)
        } else {
            Multipliers::found_elsewhere(system.equations, columns)
        };
        Self {
            positions: Positions::new(tree),
            velocities: Velocities::new(tree),
            biases: Accelerations::new(tree),
            inertias: vec![SpatialInertia::ZERO; nodes],
            own: vec![Wrench::zero(); nodes],
            wrenches: vec![Wrench::zero(); nodes],
            mass,
            columns: Columns::new(tree.speeds(), columns),
            solutions: Columns::new(tree.speeds(), columns),
            generalised: vec![0.0; tree.speeds()],
            state_rates: vec![0.0; system.internals.states],
            integral_rates: vec![0.0; system.internals.integrals],
            constraint,
            first_unit,
            reaction_loop: ReactionLoop::new(system),
            rates: vec![0.0; tree.speeds()],
            reactions: vec![Wrench::zero(); nodes],
            twists: vec![Twist::zero(); nodes],
            power: 0.0,
            counters: Counters::default(),
        }
    }

    /// Rates of the speeds: the accelerations of the joints \[rad/s^2, m/s^2\].
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Rates of the internal states of all loads, in the order of [`System::internals`].
    pub fn state_rates(&self) -> &[f64] {
        &self.state_rates
    }

    /// Rates of the integrals of all loads.
    pub fn integral_rates(&self) -> &[f64] {
        &self.integral_rates
    }

    /// Multipliers of all closures, one after the other; see [`linkdyn_kinematics::Row`] for their meaning.
    pub fn multipliers(&self) -> &[f64] {
        self.constraint.multipliers()
    }

    /// Generalised forces of the reaction-dependent loads, in their order, with the sign in which they act.
    pub fn reaction_loads(&self) -> &[f64] {
        self.reaction_loop.forces()
    }

    /// Relative residual of the loop reaction - load - acceleration at this evaluation.
    pub fn reaction_residual(&self) -> f64 {
        self.reaction_loop.residual()
    }

    /// Measure `det(1 - d load/d load)` of that loop: 1 without feedback, 0 where the mechanism jams.
    pub fn reaction_measure(&self) -> f64 {
        self.reaction_loop.measure()
    }

    /// Power of all loads that is not stored, reaction-dependent loads included \[W\].
    pub fn power(&self) -> f64 {
        self.power
    }

    /// Number of closure equations that were redundant at this evaluation.
    pub fn redundant(&self) -> usize {
        self.constraint.redundant()
    }

    /// Multiplications and additions, nearly, that an evaluation takes for loops eliminated one by one; `None` where all of them are
    /// solved for at once.
    pub fn loop_work(&self) -> Option<usize> {
        match &self.mass {
            MassFactor::LocalLoops(mass) => Some(mass.work()),
            MassFactor::Composite(_) | MassFactor::Articulated(_) => None,
        }
    }

    /// Positions of this evaluation.
    pub fn positions(&self) -> &Positions {
        &self.positions
    }

    /// Velocities of this evaluation.
    pub fn velocities(&self) -> &Velocities {
        &self.velocities
    }

    /// Work done so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }
}

/// The plan by which loops are eliminated, where that is wanted or takes less work.
fn plan_of_loops(system: &System) -> Option<Plan> {
    let (n, m) = (system.tree.speeds(), system.equations);
    match system.formulation {
        Formulation::LocalLoops => Some(Plan::new(system)),
        Formulation::Recursive if m >= FEWEST_EQUATIONS => {
            let plan = Plan::new(system);
            (plan.cost() < m * (m + DENSE_COLUMN) * n).then_some(plan)
        }
        _ => None,
    }
}

/// Whether a node moves at all.
pub(crate) fn moves(freedom: Freedom) -> bool {
    freedom != Freedom::None
}
