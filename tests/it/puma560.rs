//! The Puma 560 arm: published gravity torques and mass matrices [Corke, Armstrong-Helouvry 1994], classical
//! Denavit-Hartenberg frames.

use linkdyn_dynamics::lagrange;
use linkdyn_dynamics::{Description, Formulation, InertiaError, Load, RigidInertia, System, SystemError, Workspace};
use linkdyn_kinematics::dh::{Convention, Row};
use linkdyn_kinematics::{Joint, LinkId, Pose, Tree};
use linkdyn_tests::loads::Applied;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::Arc;

/// Length, mass and angle data as published: d, a, alpha.
const DH: [[f64; 3]; 6] = [
    [0.0, 0.0, FRAC_PI_2],
    [0.0, 0.4318, 0.0],
    [0.15005, 0.0203, -FRAC_PI_2],
    [0.4318, 0.0, FRAC_PI_2],
    [0.0, 0.0, -FRAC_PI_2],
    [0.0, 0.0, 0.0],
];
const MASS: [f64; 6] = [0.0, 17.4, 4.8, 0.82, 0.34, 0.09];
const COM: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [-0.3638, 0.006, 0.2275],
    [-0.0203, -0.0141, 0.070],
    [0.0, 0.019, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 0.032],
];
const INERTIA: [[f64; 3]; 6] = [
    [0.0, 0.35, 0.0],
    [0.13, 0.524, 0.539],
    [0.066, 0.086, 0.0125],
    [1.8e-3, 1.3e-3, 1.8e-3],
    [3e-4, 4e-4, 3e-4],
    [1.5e-4, 1.5e-4, 4e-5],
];
const MOTOR: [f64; 6] = [200e-6, 200e-6, 200e-6, 33e-6, 33e-6, 33e-6];
const GEAR: [f64; 6] = [-62.6111, 107.815, -53.7063, 76.0364, 71.923, 76.686];

const Q1: [f64; 6] = [0.0, FRAC_PI_4, -PI, 1.0, FRAC_PI_4, 0.0];
const Q2: [f64; 6] = [0.0, FRAC_PI_2, -PI, 1.0, FRAC_PI_2, 0.0];
const QN: [f64; 6] = [0.0, FRAC_PI_4, PI, 0.0, FRAC_PI_4, 0.0];
const QZ: [f64; 6] = [0.0; 6];

/// The published numbers have 10 digits after the point, some of them 7.
const DIGITS: f64 = 1e-9;

/// The arm. Joint k turns about z of frame k - 1, so that a tree's link sits in that frame, turned; what the classical
/// convention puts behind the turn belongs to the placement of the next joint, and of the inertia.
///
/// The published first link has an inertia without mass. About a joint on the base its own freedom alone matters, and a
/// wheel of the same moment about that axis has the same effect; its mass is carried by the base. Moments of links 1 and 3
/// break the triangle inequality.
fn description() -> Description {
    let mut tree = Tree::new();
    let mut inertias = Vec::new();
    let (mut parent, mut placement) = (LinkId::GROUND, Pose::identity());
    for k in 0..6 {
        let [d, a, alpha] = DH[k];
        let row = Row {
            theta: 0.0,
            d,
            a,
            alpha,
        };
        let (before, after) = row.around(Convention::Classical);
        parent = tree
            .attach(parent, placement * before, Joint::revolute_z())
            .expect("rigid placements");
        let frame = row.motion() * after;
        let published = RigidInertia {
            mass: if k == 0 { 1.0 } else { MASS[k] },
            com: Vector3::from(COM[k]),
            about_com: Matrix3::from_diagonal(&Vector3::from(INERTIA[k])),
        };
        inertias.push(published.moved(&frame));
        placement = frame;
    }
    Description {
        lenient: [0, 2].map(|k| tree.joints()[k].0).into(),
        ..Description::new(tree, inertias, Vector3::new(0.0, 0.0, -9.81))
    }
}

fn system() -> System {
    System::new(description()).expect("possible but for the triangle inequality")
}

fn assert_close(found: &[f64], published: &[f64], what: &str) {
    for (found, published) in found.iter().zip(published) {
        assert!(
            (found - published).abs() < DIGITS,
            "{what}: {found} instead of {published}"
        );
    }
}

/// Torques that hold the arm still, by Lagrange's equations.
fn gravity_torques(q: &[f64]) -> Vec<f64> {
    lagrange::equations(&system(), q, &[0.0; 6]).bias.as_slice().to_vec()
}

/// The mass matrix with motors, by Lagrange's equations.
fn mass_matrix(q: &[f64]) -> DMatrix<f64> {
    let mut mass = lagrange::equations(&system(), q, &[0.0; 6]).mass;
    for k in 0..6 {
        mass[(k, k)] += GEAR[k] * GEAR[k] * MOTOR[k];
    }
    mass
}

#[test]
fn gravity_torques_are_those_published() {
    let cases = [
        (Q1, [0.0, 31.6333865049, 6.0286441495, -0.0118869557, 0.0217589265, 0.0]),
        (QN, [0.0, 31.6398803784, 6.035138023, 0.0, 0.0282528, 0.0]),
        (QZ, [0.0, 37.48366665, 0.24892875, 0.0, 0.0, 0.0]),
    ];
    for (q, published) in cases {
        // The fifth torque at qn is given to 7 digits.
        let found = gravity_torques(&q);
        assert_close(&found[..4], &published[..4], "gravity");
        assert!((found[4] - published[4]).abs() < 1e-8);
    }
    let found = gravity_torques(&Q2);
    for (found, published) in found.iter().zip([0.0, 7.7197833, 8.7439473, -0.0237739114, 0.0, 0.0]) {
        assert!((found - published).abs() < 5e-8, "{found} instead of {published}");
    }
}

#[test]
fn mass_matrices_are_those_published() {
    let m1 = mass_matrix(&Q1);
    let row = [
        3.6591249322,
        -0.404241821,
        0.1012562927,
        -0.0021076827,
        -0.0015032613,
        -0.000009194,
    ];
    assert_close(m1.row(0).transpose().as_slice(), &row, "M(q1)");
    let diagonal = [
        3.6591249322,
        4.412829095,
        0.9377372039,
        0.1925317061,
        0.1713484517,
        0.1941045057,
    ];
    assert_close(m1.diagonal().as_slice(), &diagonal, "diagonal of M(q1)");
    let product = [
        1.676259633,
        2.1799141069,
        0.6946775448,
        0.0944011532,
        0.0861430018,
        0.0970855984,
    ];
    assert_close((&m1 * DVector::from_element(6, 0.5)).as_slice(), &product, "M(q1) 0.5");
    let row = [
        2.6621121225,
        -0.6879519339,
        0.0034858495,
        -0.0006719113,
        -0.000972503,
        0.0000216121,
    ];
    assert_close(mass_matrix(&Q2).row(0).transpose().as_slice(), &row, "M(q2)");
}

#[test]
fn recursions_give_back_the_accelerations_that_the_published_numbers_ask_for() {
    let wanted = [0.3, -0.2, 0.5, -1.0, 2.0, -3.0];
    for q in [Q1, Q2] {
        let equations = lagrange::equations(&system(), &q, &[0.0; 6]);
        let torques = &equations.mass * DVector::from_column_slice(&wanted) + &equations.bias;
        for formulation in [Formulation::CompositeBody, Formulation::ArticulatedBody] {
            let applied = Applied {
                drives: torques.as_slice().to_vec(),
                wrenches: Vec::new(),
            };
            let system = System::new(Description {
                loads: vec![Arc::new(applied) as Arc<dyn Load>],
                formulation,
                ..description()
            })
            .expect("possible but for the triangle inequality");
            let mut work = Workspace::new(&system);
            system.evaluate(0.0, &q, &[0.0; 6], &mut work).expect("regular");
            for (found, wanted) in work.rates().iter().zip(wanted) {
                // The wrist weighs 1e-5 of the arm: 1e-16 of the torques on a moment of 4e-5 kg m^2.
                assert!(
                    (found - wanted).abs() < 1e-9,
                    "{formulation:?}: {found} instead of {wanted}"
                );
            }
        }
    }
}

#[test]
fn the_published_inertias_are_refused_without_leniency() {
    let refused = |lenient: Vec<LinkId>| match System::new(Description {
        lenient,
        ..description()
    }) {
        Err(SystemError::Inertia { link, source }) => (link, source),
        other => panic!("{other:?}"),
    };
    let close = |found: [f64; 3], wanted: [f64; 3]| found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-15);
    match refused(Vec::new()) {
        (0, InertiaError::Triangle(moments)) => assert!(close(moments, [0.0, 0.0, 0.35])),
        other => panic!("{other:?}"),
    }
    match refused(vec![description().tree.joints()[0].0]) {
        (2, InertiaError::Triangle(moments)) => assert!(close(moments, [0.0125, 0.066, 0.086])),
        other => panic!("{other:?}"),
    }
    let published = RigidInertia {
        mass: 0.0,
        com: Vector3::zeros(),
        about_com: Matrix3::from_diagonal(&Vector3::from(INERTIA[0])),
    };
    assert_eq!(
        published.validate_positive(),
        Err(InertiaError::InertiaWithoutMass(0.35))
    );
}
