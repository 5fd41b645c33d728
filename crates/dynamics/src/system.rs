//! A mechanical system: links with inertia on a tree, closures, loads. Immutable once built, so that threads may share it.

use crate::error::SystemError;
use crate::guide::Guided;
use crate::inertia::{Body, RigidInertia};
use crate::load::{Internals, Load, ReactionLoad};
use linkdyn_kinematics::{Closure, LinkId, Tree, assembly};
use nalgebra::Vector3;
use std::ops::Range;
use std::sync::Arc;

/// Terms that pull the closure back when it has drifted: `phi'' + 2 alpha phi' + beta^2 phi = 0` \[Baumgarte 1972\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Baumgarte {
    /// Velocity coefficient \[1/s\].
    pub alpha: f64,
    /// Position coefficient \[1/s\].
    pub beta: f64,
}

/// How mass matrix and bias forces come about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Formulation {
    /// Recursive; composite bodies where branches are short, articulated bodies where they are long, and many loops eliminated one by
    /// one where that takes less work.
    #[default]
    Recursive,
    /// Recursive with composite bodies, whatever the size.
    CompositeBody,
    /// Recursive with articulated bodies, whatever the size.
    ArticulatedBody,
    /// Recursive with articulated bodies and loops eliminated where they close, whatever the size.
    LocalLoops,
    /// The papers' Lagrange equations with traces of `T_i H T_j^T`. Slow and allocating: for comparison.
    Lagrange,
}

/// How the loads that depend on reactions are found at each evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ReactionSolver {
    /// Newton's method to a relative residual; tells jamming and non-uniqueness apart from failure.
    Newton {
        /// Largest residual relative to the largest load.
        tolerance: f64,
    },
    /// A fixed number of sweeps reactions - loads - accelerations from loads zero: the first paper's way. No residual is
    /// asked for, the one reached is reported.
    Sweeps {
        /// Number of sweeps.
        sweeps: usize,
    },
}

impl Default for ReactionSolver {
    fn default() -> Self {
        ReactionSolver::Newton { tolerance: 1e-12 }
    }
}

/// All that makes a [`System`].
#[derive(Clone, Debug)]
pub struct Description {
    /// Links and joints.
    pub tree: Tree,
    /// One inertia a link of the tree, in the order of attachment, in the link's frame.
    pub inertias: Vec<RigidInertia>,
    /// Gravity in global axes \[m/s^2\].
    pub gravity: Vector3<f64>,
    /// Cut joints.
    pub closures: Vec<Closure>,
    /// Coordinates that follow a prescribed motion.
    pub guided: Vec<Guided>,
    /// Loads that depend on time, position and velocity.
    pub loads: Vec<Arc<dyn Load>>,
    /// Loads that depend on the reaction in the one-freedom joint that carries the link.
    pub reaction_loads: Vec<(LinkId, Arc<dyn ReactionLoad>)>,
    /// Drift terms, if any.
    pub baumgarte: Option<Baumgarte>,
    /// Formulation of the equations of motion.
    pub formulation: Formulation,
    /// Solver of the loop reaction - load - acceleration.
    pub reaction_solver: ReactionSolver,
    /// Links whose inertia may break the triangle inequality (published data sometimes do).
    pub lenient: Vec<LinkId>,
}

impl Description {
    /// A tree with inertias under gravity `g` \[m/s^2\], all else absent or default.
    pub fn new(tree: Tree, inertias: Vec<RigidInertia>, gravity: Vector3<f64>) -> Self {
        Self {
            tree,
            inertias,
            gravity,
            closures: Vec::new(),
            guided: Vec::new(),
            loads: Vec::new(),
            reaction_loads: Vec::new(),
            baumgarte: None,
            formulation: Formulation::default(),
            reaction_solver: ReactionSolver::default(),
            lenient: Vec::new(),
        }
    }
}

/// A checked, immutable system.
#[derive(Clone, Debug)]
pub struct System {
    pub(crate) tree: Tree,
    /// One a node.
    pub(crate) bodies: Vec<Body>,
    pub(crate) inertias: Vec<RigidInertia>,
    pub(crate) gravity: Vector3<f64>,
    pub(crate) closures: Vec<Closure>,
    pub(crate) guided: Vec<Guided>,
    /// Those of the closures; behind them stand those of the guided coordinates.
    pub(crate) closure_equations: usize,
    pub(crate) equations: usize,
    /// First those without internals that are not conservative, then those with internals (the conservative ones last), then
    /// conservative ones without.
    pub(crate) loads: Vec<Arc<dyn Load>>,
    /// End of the first group.
    pub(crate) plain_loads: usize,
    /// How many of the second group are not conservative.
    pub(crate) working: usize,
    /// The second group's places in the internal states.
    pub(crate) places: Vec<Place>,
    /// Sums over all loads.
    pub(crate) internals: Internals,
    /// Internals of a load before anything has happened to it.
    pub(crate) zeros: Vec<f64>,
    pub(crate) reaction_loads: Vec<OnNode>,
    pub(crate) baumgarte: Option<Baumgarte>,
    pub(crate) formulation: Formulation,
    pub(crate) reaction_solver: ReactionSolver,
}

/// Where the internals of a load stand among those of all loads.
#[derive(Clone, Debug)]
pub struct Place {
    /// Of its states.
    pub states: Range<usize>,
    /// Of its integrals.
    pub integrals: Range<usize>,
    /// Of its memory.
    pub memory: Range<usize>,
    /// Of its root functions.
    pub roots: Range<usize>,
}

impl Place {
    /// The place of the `next` load behind those summed in `sum`, to which it is added.
    fn after(sum: &mut Internals, next: Internals) -> Self {
        let take = |sum: &mut usize, count: usize| {
            *sum += count;
            *sum - count..*sum
        };
        Self {
            states: take(&mut sum.states, next.states),
            integrals: take(&mut sum.integrals, next.integrals),
            memory: take(&mut sum.memory, next.memory),
            roots: take(&mut sum.roots, next.roots),
        }
    }
}

/// A reaction load with its place.
#[derive(Clone, Debug)]
pub(crate) struct OnNode {
    pub node: usize,
    pub speed: usize,
    pub load: Arc<dyn ReactionLoad>,
}

impl System {
    /// Checks a description.
    ///
    /// # Errors
    /// [`SystemError`] that names the first impossible item.
    pub fn new(description: Description) -> Result<Self, SystemError> {
        let d = description;
        if d.tree.speeds() == 0 {
            return Err(SystemError::NoFreedom);
        }
        let links = d.tree.joints();
        if d.inertias.len() != links.len() {
            return Err(SystemError::Inertias {
                found: d.inertias.len(),
                expected: links.len(),
            });
        }
        for (link, inertia) in d.inertias.iter().enumerate() {
            let lenient = d.lenient.contains(&links[link].0);
            let checked = if lenient {
                inertia.validate_positive()
            } else {
                inertia.validate()
            };
            checked.map_err(|source| SystemError::Inertia { link, source })?;
        }
        if !d.gravity.iter().all(|g| g.is_finite()) {
            return Err(SystemError::Gravity(d.gravity.into()));
        }
        if let Some(Baumgarte { alpha, beta }) = d.baumgarte
            && !(alpha.is_finite() && beta.is_finite() && alpha >= 0.0 && beta >= 0.0)
        {
            return Err(SystemError::Baumgarte { alpha, beta });
        }
        let mut bodies = vec![Body::Massless; d.tree.nodes().len()];
        for ((link, _), inertia) in links.iter().zip(&d.inertias) {
            bodies[link.node()] = Body::new(inertia);
        }
        let mut reaction_loads = Vec::new();
        for (link, load) in d.reaction_loads {
            let speeds = d.tree.speed_range(link);
            if speeds.len() != 1 {
                let position = links.iter().position(|(l, _)| *l == link);
                return Err(SystemError::ReactionLoad {
                    link: position.unwrap_or(usize::MAX),
                    freedoms: speeds.len(),
                });
            }
            reaction_loads.push(OnNode {
                node: link.node(),
                speed: speeds.start,
                load,
            });
        }
        let (mut with_internals, plain): (Vec<_>, Vec<_>) =
            d.loads.into_iter().partition(|load| !load.internals().is_empty());
        let (mut loads, conservative): (Vec<_>, Vec<_>) = plain.into_iter().partition(|load| !load.is_conservative());
        let plain_loads = loads.len();
        with_internals.sort_by_key(|load| load.is_conservative());
        let working = with_internals.partition_point(|load| !load.is_conservative());
        let mut internals = Internals::default();
        let places = with_internals
            .iter()
            .map(|load| Place::after(&mut internals, load.internals()));
        let places = places.collect();
        loads.extend(with_internals);
        loads.extend(conservative);
        for guided in &d.guided {
            let (coordinates, speeds) = (d.tree.coordinates(), d.tree.speeds());
            if guided.coordinate >= coordinates || guided.speed >= speeds {
                return Err(SystemError::Guided {
                    coordinate: guided.coordinate,
                    speed: guided.speed,
                    coordinates,
                    speeds,
                });
            }
        }
        let closure_equations = assembly::equations(&d.closures);
        Ok(Self {
            equations: closure_equations + d.guided.len(),
            closure_equations,
            guided: d.guided,
            tree: d.tree,
            bodies,
            inertias: d.inertias,
            gravity: d.gravity,
            closures: d.closures,
            loads,
            plain_loads,
            working,
            places,
            zeros: vec![0.0; internals.states.max(internals.memory)],
            internals,
            reaction_loads,
            baumgarte: d.baumgarte,
            formulation: d.formulation,
            reaction_solver: d.reaction_solver,
        })
    }

    /// Links and joints.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Cut joints.
    pub fn closures(&self) -> &[Closure] {
        &self.closures
    }

    /// Number of equations of closures and prescribed motions, which is the number of multipliers.
    pub fn equations(&self) -> usize {
        self.equations
    }

    /// Inertias, one a link in the order of attachment.
    pub fn inertias(&self) -> &[RigidInertia] {
        &self.inertias
    }

    /// Gravity \[m/s^2\].
    pub fn gravity(&self) -> Vector3<f64> {
        self.gravity
    }

    /// Loads that depend on time, position and velocity.
    pub fn loads(&self) -> &[Arc<dyn Load>] {
        &self.loads
    }

    /// How many internal states, integrals, numbers of memory and root functions the loads have in all. They stand one load
    /// after the other, in the order of [`loads`](Self::loads).
    pub fn internals(&self) -> Internals {
        self.internals
    }

    /// Places of the loads with internals, in the order of [`loads`](Self::loads).
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// Speeds on which the reaction-dependent loads act, in their order.
    pub fn reaction_load_speeds(&self) -> impl Iterator<Item = usize> + '_ {
        self.reaction_loads.iter().map(|load| load.speed)
    }

    /// Times at which a load or a prescribed motion jumps \[s\], ascending.
    pub fn stop_times(&self) -> Vec<f64> {
        let loads = self.loads.iter().flat_map(|load| load.stop_times());
        let guides = self.guided.iter().flat_map(|guided| guided.guide.stop_times());
        let mut times: Vec<f64> = loads.chain(guides).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}
