//! What must be refused, by its own name and with its numbers: trees, inertias, systems, singular masses.

use linkdyn_dynamics::{
    Baumgarte, Description, DynamicsError, Formulation, InertiaError, RigidInertia, System, SystemError, Workspace,
};
use linkdyn_kinematics::{Joint, LinkId, Pose, Tree, TreeError};
use linkdyn_tests::loads::{Applied, Rough};
use linkdyn_tests::strategies;
use nalgebra::{Matrix3, Unit, Vector3};
use proptest::prelude::*;
use std::sync::Arc;

fn rod() -> RigidInertia {
    RigidInertia::solid_cylinder(7850.0, 0.05, 0.5, &Vector3::x())
}

fn attach(placement: Pose, joint: Joint) -> Result<LinkId, TreeError> {
    Tree::new().attach(LinkId::GROUND, placement, joint)
}

fn pendulum() -> Description {
    let mut tree = Tree::new();
    tree.attach(LinkId::GROUND, Pose::identity(), Joint::revolute_z())
        .expect("valid");
    Description::new(tree, vec![rod()], Vector3::new(0.0, -9.81, 0.0))
}

fn refusal(change: impl FnOnce(&mut Description)) -> SystemError {
    let mut description = pendulum();
    change(&mut description);
    System::new(description).expect_err("must be refused")
}

#[test]
fn a_parent_of_another_tree_is_refused() {
    let mut large = Tree::new();
    let mut last = LinkId::GROUND;
    for _ in 0..3 {
        last = large
            .attach(last, Pose::identity(), Joint::revolute_z())
            .expect("valid");
    }
    let found = Tree::new().attach(last, Pose::identity(), Joint::revolute_z());
    assert_eq!(found, Err(TreeError::UnknownParent { parent: 3, last: 0 }));
}

#[test]
fn placements_that_are_not_rigid_are_refused() {
    let stretched = Pose::from_rows([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.001]], [0.0; 3]);
    let mirrored = Pose::from_rows([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]], [0.0; 3]);
    let defect = |pose| match attach(pose, Joint::revolute_z()) {
        Err(TreeError::NotRigid { defect }) => defect,
        other => panic!("{other:?}"),
    };
    assert!((defect(stretched) - 0.002001).abs() < 1e-12);
    assert_eq!(defect(mirrored), 2.0);
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(defect(Pose::translation(0.0, bad, 0.0)), f64::INFINITY);
        assert_eq!(
            defect(Pose::from_rows(
                [[bad, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                [0.0; 3]
            )),
            f64::INFINITY
        );
    }
}

#[test]
fn axes_that_are_no_unit_vectors_are_refused_for_every_joint() {
    let unit = |x, y, z| Unit::new_unchecked(Vector3::new(x, y, z));
    for axis in [
        unit(0.0, 0.0, 0.0),
        unit(0.0, 0.0, 2.0),
        unit(f64::NAN, 0.0, 0.0),
        unit(f64::INFINITY, 0.0, 0.0),
    ] {
        let second = Vector3::x_axis();
        for joint in [
            Joint::Revolute { axis },
            Joint::Prismatic { axis },
            Joint::Cylindrical { axis },
            Joint::Universal { first: axis, second },
            Joint::Universal {
                first: second,
                second: axis,
            },
        ] {
            assert!(
                matches!(attach(Pose::identity(), joint), Err(TreeError::BadAxis { .. })),
                "{joint:?}"
            );
        }
    }
    let parallel = Joint::Universal {
        first: Vector3::x_axis(),
        second: -Vector3::x_axis(),
    };
    assert_eq!(
        attach(Pose::identity(), parallel),
        Err(TreeError::BadAxis { joint: parallel })
    );
}

#[test]
fn impossible_inertias_are_refused_each_for_its_reason() {
    let with = |change: &dyn Fn(&mut RigidInertia)| {
        let mut inertia = rod();
        change(&mut inertia);
        inertia.validate().expect_err("must be refused")
    };
    let diagonal = |x, y, z| Matrix3::from_diagonal(&Vector3::new(x, y, z));
    assert_eq!(with(&|i| i.mass = -1.0), InertiaError::Mass(-1.0));
    assert!(matches!(with(&|i| i.mass = f64::NAN), InertiaError::Mass(m) if m.is_nan()));
    assert_eq!(with(&|i| i.mass = f64::INFINITY), InertiaError::Mass(f64::INFINITY));
    assert!(matches!(with(&|i| i.com.y = f64::NAN), InertiaError::Com([_, y, _]) if y.is_nan()));
    assert_eq!(with(&|i| i.about_com[(1, 2)] = f64::NAN), InertiaError::NotFinite);
    assert_eq!(with(&|i| i.about_com[(1, 2)] = f64::INFINITY), InertiaError::NotFinite);
    assert_eq!(
        with(&|i| (i.about_com = diagonal(1.0, 1.0, 1.0), i.about_com[(0, 1)] = 1e-3).1),
        InertiaError::NotSymmetric(1e-3)
    );
    assert_eq!(
        with(&|i| (i.mass = 0.0, i.about_com = diagonal(0.1, 0.2, 0.2)).1),
        InertiaError::InertiaWithoutMass(0.2)
    );
    assert_eq!(
        with(&|i| i.about_com = diagonal(2.0, 1.0, -0.5)),
        InertiaError::NotPositive([-0.5, 1.0, 2.0])
    );
    assert_eq!(
        with(&|i| i.about_com = diagonal(1.0, 4.0, 2.0)),
        InertiaError::Triangle([1.0, 2.0, 4.0])
    );
    // The same off the principal axes: off-diagonal entries as large as the diagonal are not positive definite.
    let flat = Matrix3::from_fn(|r, c| if r == c { 1.0 } else { -0.9 });
    assert!(matches!(with(&|i| i.about_com = flat), InertiaError::NotPositive(_)));
    // A plate is the limit, and allowed; so is a point, and no mass at all.
    for (mass, moments) in [(1.0, [1.0, 2.0, 3.0]), (1.0, [0.0; 3]), (0.0, [0.0; 3])] {
        let about_com = Matrix3::from_diagonal(&Vector3::from(moments));
        let inertia = RigidInertia {
            mass,
            about_com,
            ..RigidInertia::massless()
        };
        assert_eq!(inertia.validate(), Ok(()));
    }
}

#[test]
fn impossible_systems_are_refused_each_for_its_reason() {
    assert_eq!(
        refusal(|d| d.inertias.clear()),
        SystemError::Inertias { found: 0, expected: 1 }
    );
    assert_eq!(
        refusal(|d| d.inertias.push(rod())),
        SystemError::Inertias { found: 2, expected: 1 }
    );
    assert_eq!(refusal(|d| d.tree = Tree::new()), SystemError::NoFreedom);
    let fixed = refusal(|d| {
        d.tree = Tree::new();
        d.tree
            .attach(LinkId::GROUND, Pose::identity(), Joint::Fixed)
            .expect("valid");
    });
    assert_eq!(fixed, SystemError::NoFreedom);
    let inertia = refusal(|d| d.inertias[0].mass = -2.0);
    assert_eq!(
        inertia,
        SystemError::Inertia {
            link: 0,
            source: InertiaError::Mass(-2.0)
        }
    );
    assert!(matches!(refusal(|d| d.gravity.z = f64::NAN), SystemError::Gravity([_, _, z]) if z.is_nan()));
    for (alpha, beta) in [(-1.0, 1.0), (1.0, -1.0), (f64::INFINITY, 0.0)] {
        let found = refusal(|d| d.baumgarte = Some(Baumgarte { alpha, beta }));
        assert_eq!(found, SystemError::Baumgarte { alpha, beta });
    }
    for joint in [Joint::Fixed, Joint::Spherical, Joint::SphericalZyx] {
        let rough = Rough {
            scale: 0.1,
            floor: 1.0,
            arm: 1.0,
        };
        let found = refusal(|d| {
            let first = d.tree.joints()[0].0;
            let link = d.tree.attach(first, Pose::identity(), joint).expect("valid");
            d.inertias.push(rod());
            d.reaction_loads.push((link, Arc::new(rough)));
        });
        assert_eq!(
            found,
            SystemError::ReactionLoad {
                link: 1,
                freedoms: joint.speeds()
            }
        );
    }
}

#[test]
fn leniency_forgives_the_triangle_inequality_alone() {
    let lenient = |change: &dyn Fn(&mut RigidInertia)| {
        let mut description = pendulum();
        description.lenient = description.tree.joints().iter().map(|(link, _)| *link).collect();
        change(&mut description.inertias[0]);
        System::new(description).map(|_| ())
    };
    assert_eq!(
        lenient(&|i| i.about_com = Matrix3::from_diagonal(&Vector3::new(1.0, 4.0, 2.0))),
        Ok(())
    );
    let source = InertiaError::Mass(-1.0);
    assert_eq!(
        lenient(&|i| i.mass = -1.0),
        Err(SystemError::Inertia { link: 0, source })
    );
}

const FORMULATIONS: [Formulation; 3] = [
    Formulation::CompositeBody,
    Formulation::ArticulatedBody,
    Formulation::Lagrange,
];

/// The Lagrange form knows the size of its rounding too badly to tell masses that turn about themselves.
const RECURSIONS: [Formulation; 2] = [Formulation::CompositeBody, Formulation::ArticulatedBody];

fn evaluate(description: Description, q: &[f64], v: &[f64]) -> Result<Vec<f64>, DynamicsError> {
    let system = System::new(description).expect("valid");
    let mut work = Workspace::new(&system);
    system.evaluate(7.0, q, v, &mut work).map(|()| work.rates().to_vec())
}

#[test]
fn a_freedom_that_moves_no_mass_is_told_with_its_speed() {
    for formulation in FORMULATIONS {
        let mut description = Description {
            formulation,
            ..pendulum()
        };
        let first = description.tree.joints()[0].0;
        description
            .tree
            .attach(first, Pose::translation(0.5, 0.0, 0.0), Joint::revolute_z())
            .expect("valid");
        description.inertias.push(RigidInertia::massless());
        match evaluate(description, &[0.1; 2], &[0.2; 2]) {
            Err(DynamicsError::SingularMass {
                time: 7.0,
                speed: 1,
                pivot: 0.0,
            }) => {}
            other => panic!("{formulation:?}: {other:?}"),
        }
    }
}

#[test]
fn states_and_loads_that_are_no_numbers_are_told() {
    for formulation in FORMULATIONS {
        let description = Description {
            formulation,
            ..pendulum()
        };
        for (q, v) in [
            (f64::NAN, 0.0),
            (0.0, f64::NAN),
            (f64::INFINITY, 0.0),
            (0.0, f64::INFINITY),
        ] {
            let found = evaluate(description.clone(), &[q], &[v]);
            let told = matches!(
                found,
                Err(DynamicsError::NotFinite {
                    time: 7.0,
                    speed: 0,
                    ..
                } | DynamicsError::SingularMass {
                    time: 7.0,
                    speed: 0,
                    ..
                })
            );
            // A single turn needs no angular velocity: an infinite one may cancel out of its equation, but not in space.
            assert!(
                told || (q == 0.0 && found.as_ref().is_ok_and(|a| a[0].is_finite())),
                "{formulation:?}: {found:?}"
            );
        }
        let drives = vec![f64::NAN];
        let loads = Applied {
            drives,
            wrenches: Vec::new(),
        };
        let driven = Description {
            loads: vec![Arc::new(loads)],
            ..description
        };
        let found = evaluate(driven, &[0.0], &[0.0]);
        assert!(
            matches!(found, Err(DynamicsError::NotFinite { speed: 0, .. })),
            "{formulation:?}: {found:?}"
        );
    }
}

proptest! {
    #![proptest_config(strategies::cases(200))]

    #[test]
    fn a_point_mass_that_turns_about_itself_is_told(
        placement in strategies::pose(1.0),
        axis in strategies::direction(),
        (angle, mass, along) in (strategies::number(3.0), 0.1..10.0, strategies::number(1.0)),
    ) {
        // The freedom moves nothing, but for rounding: on the axis of a revolute joint, or on the end of a string. Close to a
        // plane of the link's axes two of the string's three pivots share the loss of digits, and the last is no longer rounding.
        prop_assume!(axis.iter().all(|x| x.abs() > 0.4) && along.abs() > 1e-3);
        let on_axis = (Joint::Revolute { axis }, vec![angle], 1);
        let string = (Joint::Spherical, strategies::coordinates(&Joint::Spherical, &[angle / 3.0, along, 0.3, -0.2, 0.0, 0.0, 0.0]), 3);
        for formulation in RECURSIONS {
            for (joint, q, speeds) in [on_axis.clone(), string.clone()] {
                let mut tree = Tree::new();
                tree.attach(LinkId::GROUND, placement, joint).expect("valid");
                let point = RigidInertia { mass, com: *axis * along, ..RigidInertia::massless() };
                let description = Description::new(tree, vec![point], Vector3::new(1.0, 2.0, 3.0));
                let found = evaluate(Description { formulation, ..description }, &q, &vec![0.5; speeds]);
                let told = matches!(found, Err(DynamicsError::SingularMass { .. }));
                prop_assert!(told, "{formulation:?}, {joint:?}: {found:?}");
            }
        }
    }
}
