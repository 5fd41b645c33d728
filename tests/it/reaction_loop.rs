//! Loads that depend on the reactions which they help to cause.

use linkdyn_dynamics::{
    Description, DynamicsError, Formulation, ReactionLoad, ReactionSolver, RigidInertia, System, Workspace, lagrange,
};
use linkdyn_kinematics::{Joint, LinkId, Pose, Tree};
use linkdyn_tests::loads::{AlongSlide, Applied, Rough};
use linkdyn_tests::numbers::{condition, difference, largest};
use linkdyn_tests::{Blueprint, strategies};
use nalgebra::Vector3;
use proptest::prelude::*;
use std::sync::Arc;

/// A machine, and loads on some of its joints of one freedom.
#[derive(Clone, Debug)]
pub(crate) struct Rubbing<L> {
    pub blueprint: Blueprint,
    pub rough: Vec<(usize, L)>,
}

/// Closed machines that are well conditioned.
pub(crate) fn sound(blueprint: impl Strategy<Value = Blueprint>) -> impl Strategy<Value = Blueprint> {
    blueprint.prop_filter("well conditioned", |blueprint| {
        let machine = blueprint.machine(Formulation::Lagrange);
        let equations = lagrange::equations(&machine.system, &machine.q, &machine.v);
        condition(&equations).is_some_and(|c| c.product() < 1e4)
    })
}

fn rubbing(scale: f64) -> impl Strategy<Value = Rubbing<Rough>> {
    let rough = (0.2 * scale..scale, 0.1..1.0, 0.2..1.0).prop_map(|(scale, floor, arm)| Rough { scale, floor, arm });
    let blueprint = sound(strategies::closed(1..=6, 0..=1));
    (blueprint, prop::collection::vec(rough, 3)).prop_filter_map("a joint of one freedom", |(blueprint, rough)| {
        let rough: Vec<_> = single(&blueprint).into_iter().zip(rough).collect();
        (!rough.is_empty()).then_some(Rubbing { blueprint, rough })
    })
}

/// Parts on joints of one freedom.
pub(crate) fn single(blueprint: &Blueprint) -> Vec<usize> {
    let speeds = |k: &usize| blueprint.parts[*k].joint.speeds();
    (0..blueprint.parts.len()).filter(|k| speeds(k) == 1).collect()
}

impl<L: ReactionLoad + Copy + 'static> Rubbing<L> {
    pub fn description(&self) -> Description {
        let (mut description, links) = self.blueprint.description();
        for (part, rough) in &self.rough {
            let load = Arc::new(*rough) as Arc<dyn ReactionLoad>;
            description.reaction_loads.push((links[*part], load));
        }
        description
    }

    /// The system and its evaluation; `None` where loads and reactions have no equilibrium.
    pub fn evaluate(&self, description: Description) -> Option<(System, Workspace)> {
        let system = System::new(description).expect("valid");
        let mut work = Workspace::new(&system);
        match system.evaluate(0.0, &self.blueprint.coordinates(), &self.blueprint.speeds(), &mut work) {
            Ok(()) => Some((system, work)),
            Err(DynamicsError::Jammed { .. } | DynamicsError::NotUnique { .. }) => None,
            Err(other) => panic!("{other}"),
        }
    }

    /// The machine with the loads found put on as ordinary drives.
    pub fn driven(&self, forces: &[f64]) -> (System, Workspace) {
        let mut blueprint = self.blueprint.clone();
        for ((part, _), force) in self.rough.iter().zip(forces) {
            blueprint.parts[*part].drive[0] += force;
        }
        let machine = blueprint.machine(Formulation::Recursive);
        let mut work = machine.evaluate();
        machine.system.reactions(&mut work);
        (machine.system, work)
    }
}

/// Largest difference relative to the largest entry or 1.
pub(crate) fn gap(a: &[f64], b: &[f64]) -> f64 {
    difference(&[a, &[1.0]].concat(), &[b, &[1.0]].concat())
}

proptest! {
    #![proptest_config(strategies::cases(300))]

    #[test]
    fn loads_found_fulfil_the_loop_when_put_on_as_drives(case in rubbing(0.2)) {
        let found = case.evaluate(case.description());
        prop_assume!(found.is_some());
        let (_, work) = found.expect("checked");
        prop_assert!(work.reaction_residual() <= 1e-12 && work.reaction_measure() > 0.0);
        let (plain, driven) = case.driven(work.reaction_loads());
        // The loop is solved to 1e-12 of its loads, the rest is the condition.
        let gaps = (gap(work.rates(), driven.rates()), gap(work.multipliers(), driven.multipliers()));
        prop_assert!(gaps.0 < 1e-11 && gaps.1 < 1e-11, "{gaps:?}");
        let links: Vec<LinkId> = plain.tree().joints().iter().map(|(link, _)| *link).collect();
        for ((part, rough), force) in case.rough.iter().zip(work.reaction_loads()) {
            let capacity = rough.capacity(&plain.reaction(links[*part], &driven)).value;
            let asked = -rough.gain(case.blueprint.parts[*part].v[0]) * capacity;
            prop_assert!((asked - force).abs() < 1e-11 * largest(work.reaction_loads()).max(1.0), "{asked} {force}");
        }
        // Work of the loads counts.
        prop_assert!((work.power() - driven.power()).abs() < 1e-10 * (1.0 + work.power().abs()));
    }

    #[test]
    fn vanishing_gains_change_nothing(case in rubbing(1.0)) {
        let mut smooth = case.clone();
        smooth.rough.iter_mut().for_each(|(_, rough)| rough.scale = 0.0);
        let (_, work) = smooth.evaluate(smooth.description()).expect("no feedback");
        let (_, plain) = case.driven(&[0.0; 3]);
        prop_assert_eq!(work.rates(), plain.rates());
        prop_assert_eq!(work.multipliers(), plain.multipliers());
        prop_assert!(largest(work.reaction_loads()) == 0.0 && work.reaction_measure() == 1.0);
    }

    #[test]
    fn all_formulations_find_the_same_loads(case in rubbing(0.2)) {
        let with = |formulation| Description { formulation, ..case.description() };
        let first = case.evaluate(with(Formulation::Lagrange));
        prop_assume!(first.is_some());
        let (_, reference) = first.expect("checked");
        for formulation in [Formulation::CompositeBody, Formulation::ArticulatedBody] {
            let (_, work) = case.evaluate(with(formulation)).expect("the same equations");
            prop_assert!(gap(work.reaction_loads(), reference.reaction_loads()) < 1e-11);
            prop_assert!(gap(work.rates(), reference.rates()) < 1e-11);
        }
    }

    #[test]
    fn sweeps_go_to_the_solution_of_newton(case in rubbing(0.02)) {
        let with = |sweeps| Description {
            reaction_solver: ReactionSolver::Sweeps { sweeps },
            ..case.description()
        };
        let newton = case.evaluate(case.description());
        prop_assume!(newton.is_some());
        let (_, newton) = newton.expect("checked");
        let error = |sweeps| {
            let (_, work) = case.evaluate(with(sweeps)).expect("sweeps never fail");
            (gap(work.reaction_loads(), newton.reaction_loads()), work.reaction_residual())
        };
        // A sweep takes a share of the error away that is that of the feedback: 2 % of friction is far from jamming.
        let errors = [1, 2, 4, 40].map(error);
        prop_assume!(errors[1].0 < 0.2 * errors[0].0);
        prop_assert!(errors[2].0 <= errors[1].0.max(1e-15), "{errors:?}");
        prop_assert!(errors[3].0 < 1e-11 && errors[3].1 < 1e-11, "{errors:?}");
    }

    #[test]
    fn no_sweep_means_no_load(case in rubbing(0.5)) {
        let solver = ReactionSolver::Sweeps { sweeps: 0 };
        let (_, work) = case.evaluate(Description { reaction_solver: solver, ..case.description() }).expect("no loop");
        let (_, plain) = case.driven(&[0.0; 3]);
        prop_assert_eq!(work.rates(), plain.rates());
        // The residual is the whole load.
        let asks = case.rough.iter().any(|(part, rough)| rough.gain(case.blueprint.parts[*part].v[0]) != 0.0);
        prop_assert_eq!(work.reaction_residual(), f64::from(u8::from(asks)));
    }
}

/// A slide under a drive, with a load that follows the force along it: `x = |constant + slope x - slope drive|` for `x = -load`.
fn slide(load: AlongSlide, drive: f64) -> Result<(f64, Workspace), DynamicsError> {
    let mut tree = Tree::new();
    let link = tree
        .attach(LinkId::GROUND, Pose::identity(), Joint::prismatic_z())
        .expect("valid");
    let inertia = RigidInertia::solid_cylinder(7850.0, 0.1, 0.3, &Vector3::z());
    let mass = inertia.mass;
    let system = System::new(Description {
        loads: vec![Arc::new(Applied {
            drives: vec![drive],
            wrenches: Vec::new(),
        })],
        reaction_loads: vec![(link, Arc::new(load))],
        ..Description::new(tree, vec![inertia], Vector3::zeros())
    })
    .expect("valid");
    let mut work = Workspace::new(&system);
    system.evaluate(2.0, &[0.0], &[0.5], &mut work)?;
    Ok((mass, work))
}

/// Load and loop measure in closed form, or the share of the load at which the slide jams.
fn closed_form(slope: f64, drive: f64) -> Result<(f64, f64), f64> {
    let base = 4.0 - slope * drive;
    let towards = if base > 0.0 { slope } else { -slope };
    // On the way from zero load, x = share (|base| + towards x).
    if towards < 1.0 {
        Ok((base.abs() / (1.0 - towards), 1.0 - towards))
    } else {
        Err(1.0 / towards)
    }
}

#[test]
fn the_load_on_a_slide_or_its_jam_is_that_in_closed_form() {
    let (mut found, mut jams) = (0, 0);
    for slope in [-3.0, -0.5, 0.0, 0.5, 0.9, 0.999, 1.25, 2.0, 10.0] {
        for drive in [-2.0, 0.0, 1.0] {
            let load = AlongSlide {
                constant: 4.0,
                slope,
                folded: true,
            };
            match (slide(load, drive), closed_form(slope, drive)) {
                (Ok((mass, work)), Ok((x, measure))) => {
                    let load = -work.reaction_loads()[0];
                    // The measure divides the residual of 1e-12.
                    assert!(
                        (load - x).abs() < 1e-11 * x / measure.min(1.0),
                        "{slope} {drive}: {load} instead of {x}"
                    );
                    assert!((work.rates()[0] - (drive - load) / mass).abs() < 1e-12 * x);
                    assert!((work.reaction_measure() - measure).abs() < 1e-12);
                    found += 1;
                }
                (
                    Err(DynamicsError::Jammed {
                        time,
                        speed,
                        share,
                        measure,
                    }),
                    Err(fold),
                ) => {
                    assert_eq!((time, speed), (2.0, 0));
                    // The measure 1 - share/fold passes zero; the fold is located to 1e-10, and rounding of the load of
                    // 1e10 N beside it is let go at 1e-12 of that.
                    assert!((share - fold).abs() < 1e-8, "{share} instead of {fold}");
                    assert!(measure > 0.0 && measure < 1e-3);
                    jams += 1;
                }
                (other, expected) => {
                    panic!(
                        "{slope} {drive}: {:?} instead of {expected:?}",
                        other.map(|(_, work)| work.reaction_loads()[0])
                    );
                }
            }
        }
    }
    assert!(found > 10 && jams > 5, "{found} {jams}");
}

#[test]
fn a_solution_behind_the_fold_is_not_unique() {
    // Without the absolute value the line has one solution of a sign that no continuous growth reaches.
    match slide(
        AlongSlide {
            constant: 4.0,
            slope: 2.0,
            folded: false,
        },
        0.0,
    ) {
        Err(DynamicsError::NotUnique { time, speed, measure }) => {
            assert_eq!((time, speed), (2.0, 0));
            assert!((measure + 1.0).abs() < 1e-12, "{measure}");
        }
        other => panic!("{:?}", other.map(|(_, work)| work.reaction_loads().to_vec())),
    }
}

#[test]
fn capacities_that_are_no_numbers_are_told() {
    match slide(
        AlongSlide {
            constant: f64::NAN,
            slope: 0.5,
            folded: false,
        },
        0.0,
    ) {
        Err(DynamicsError::NotSettled { time, residual, .. }) => assert!(time == 2.0 && residual.is_nan()),
        other => panic!("{:?}", other.map(|(_, work)| work.reaction_loads().to_vec())),
    }
}
