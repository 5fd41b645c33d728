//! Extreme cases, each with the outcome that `docs/extreme-cases.md` tells: cases run here, and tests elsewhere that it refers to.

use crate::extreme_runs::{
    change_point, end_of_the_arm, friction, many_steps, massless_between, no_number, outcome, parallelogram, pendulum,
    rows, scene_outcome, spinning, stiff_spring, told, tree, upside_down,
};
use crate::linkage_refusals::{arm, rod};
use linkdyn_contact::{Fit, RestitutionLaw};
use linkdyn_integrators::{Dop853, Radau5};
use linkdyn_kinematics::Joint;
use linkdyn_mechanisms::catalogue::{Rsup, rsup};
use linkdyn_mechanisms::{Drive, Linkage, Mount, Simulation, Start};
use linkdyn_tests::scenes::ready_rsup;
use nalgebra::{Matrix3, Unit, Vector3};
use std::path::PathBuf;

/// A case as the table names it, and what brings its outcome.
type Case = (&'static str, fn() -> String);

const CASES: &[Case] = &[
    ("link of mass zero at the end of a chain", || {
        end_of_the_arm(|inertia| (inertia.mass, inertia.about_com) = (0.0, Matrix3::zeros()))
    }),
    ("link of mass zero fixed between two others", massless_between),
    ("mass of -1 kg", || end_of_the_arm(|inertia| inertia.mass = -1.0)),
    ("mass that is not a number", || {
        end_of_the_arm(|inertia| inertia.mass = f64::NAN)
    }),
    ("moments of inertia 1, 1, 3", || {
        end_of_the_arm(|inertia| inertia.about_com = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 3.0)))
    }),
    ("products of inertia too large", || {
        end_of_the_arm(|inertia| (inertia.about_com[(0, 1)], inertia.about_com[(1, 0)]) = (1.0, 1.0))
    }),
    ("inertia that is not symmetric", || {
        end_of_the_arm(|inertia| inertia.about_com[(0, 1)] = 1.0)
    }),
    ("mass of 1e-300 kg beside 1 kg", || {
        end_of_the_arm(|inertia| {
            inertia.about_com *= 1e-300 / inertia.mass;
            inertia.mass = 1e-300;
        })
    }),
    ("gravity of 1e308 m/s^2", || {
        let mut linkage = Linkage::new([0.0, -1e308, 0.0]);
        pendulum(&mut linkage);
        outcome(linkage, &Start::default(), Dop853::default(), 0.1)
    }),
    ("spring of 1e12 N m/rad on 1e-6 kg, implicit", || {
        stiff_spring(Radau5::default())
    }),
    ("spring of 1e12 N m/rad on 1e-6 kg, explicit", || {
        stiff_spring(Dop853::default())
    }),
    ("coefficient of friction of -0.1", || friction(-0.1, 0.01)),
    ("coefficient of friction of 0", || friction(0.0, 0.01)),
    ("coefficient of friction of 10", || friction(10.0, 0.01)),
    ("reference speed of friction of 0", || friction(0.1, 0.0)),
    ("clearance of 0", || told(Fit::new(0.004, 0.004))),
    ("pin larger than its hole", || told(Fit::new(0.003, 0.004))),
    ("restitution of 1.5", || {
        told(RestitutionLaw::LankaraniNikravesh.damping_factor(1.5))
    }),
    ("restitution of 0, law by Lankarani and Nikravesh", || {
        told(RestitutionLaw::LankaraniNikravesh.damping_factor(0.0))
    }),
    ("restitution of 0, law by Flores", || {
        told(RestitutionLaw::Flores.damping_factor(0.0))
    }),
    ("restitution of 1 in every law", || {
        let lossless = |law: &RestitutionLaw| law.damping_factor(1.0).is_ok_and(|factor| factor.abs() < 1e-12);
        assert!(RestitutionLaw::ALL.iter().all(lossless));
        "done".to_owned()
    }),
    ("body on a ball, 1e4 rad/s", spinning),
    ("flat parallelogram through its change point", change_point),
    ("rod too short to close the loop", || {
        let mut bars = parallelogram();
        bars.lengths[1] = 10.0;
        outcome(bars.linkage(), &Start::default(), Dop853::default(), 0.1)
    }),
    ("run that ends at its start", || {
        outcome(arm().linkage, &Start::default(), Dop853::default(), 0.0)
    }),
    ("run that ends before its start", || {
        outcome(arm().linkage, &Start::default(), Dop853::default(), -1.0)
    }),
    ("output at 1e8 times", || {
        rows(arm().linkage, &Start::default(), Dop853::default(), (1.0, 1e-8))
    }),
    ("no link", || {
        outcome(Linkage::new([0.0; 3]), &Start::default(), Dop853::default(), 0.1)
    }),
    ("chain of 1000 links", || tree(1000, |i| i)),
    ("star of 500 links", || tree(500, |_| 0)),
    ("joints that go round without a cut", || {
        let mut arm = arm();
        let (here, there) = (Mount::at_origin(arm.lower), Mount::at(arm.upper, [0.5, 0.0, 0.0]));
        arm.linkage.joint("third", Joint::revolute_z(), here, there);
        outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
    }),
    ("joints that go round, each with a drive", || {
        let mut arm = arm();
        let (here, there) = (Mount::at_origin(arm.lower), Mount::at(arm.upper, [0.5, 0.0, 0.0]));
        let third = arm.linkage.joint("third", Joint::revolute_z(), here, there);
        for joint in [arm.shoulder, arm.elbow, third] {
            arm.linkage.drive(joint, Drive::Constant { torque: 1.0 });
        }
        outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
    }),
    ("link without a joint", || {
        let mut arm = arm();
        arm.linkage.link("lost", rod());
        outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
    }),
    ("link jointed to itself", || {
        let mut arm = arm();
        let lost = arm.linkage.link("lost", rod());
        arm.linkage.joint(
            "third",
            Joint::revolute_z(),
            Mount::at_origin(lost),
            Mount::at_origin(lost),
        );
        outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
    }),
    ("name used twice", || {
        let mut arm = arm();
        arm.linkage.link("upper", rod());
        outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
    }),
    ("axis of length zero", || {
        let mut arm = arm();
        let lost = arm.linkage.link("lost", rod());
        let axis = Unit::new_unchecked(Vector3::zeros());
        arm.linkage.joint(
            "third",
            Joint::Revolute { axis },
            Mount::at_origin(arm.lower),
            Mount::at_origin(lost),
        );
        outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
    }),
    ("coupler of 0 elements", || {
        told(rsup(&Rsup {
            flexible: Some(0),
            ..Rsup::default()
        }))
    }),
    ("coupler of 1 element", || {
        scene_outcome(
            rsup(&Rsup {
                flexible: Some(1),
                ..Rsup::default()
            })
            .expect("there is one"),
            0.02,
        )
    }),
    ("coupler of 100 elements, one evaluation", || {
        let ready = ready_rsup(&Rsup {
            flexible: Some(100),
            ..Rsup::default()
        });
        let mut simulation = Simulation::new(&ready.mechanism);
        told(
            simulation
                .accelerations(0.0, &ready.start.q, &ready.start.v)
                .map(|_| ()),
        )
    }),
    ("damping of springs 1e6 times as large", || {
        let mut scene = rsup(&Rsup {
            flexible: Some(2),
            ..Rsup::default()
        })
        .expect("there is one");
        scene.linkage.springs_mut().for_each(|spring| spring.damping *= 1e6);
        scene_outcome(scene, 0.02)
    }),
    ("pendulum at rest upside down", upside_down),
    ("drive that is no number after 0.1 s", no_number),
    ("20 000 steps without losses", many_steps),
];

fn page() -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../docs/extreme-cases.md");
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Rows of the tables: case, outcome, where it is run.
fn table(page: &str) -> Vec<[String; 3]> {
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|')
            .split(" | ")
            .map(|cell| cell.trim().replace('\\', ""))
            .collect()
    };
    let lines = page
        .lines()
        .filter(|line| line.starts_with("| ") && !line.starts_with("| case"));
    lines
        .map(|line| cells(line).try_into().unwrap_or_else(|cells| panic!("{cells:?}")))
        .collect()
}

/// Whether a text has these pieces, divided by `...`, from its beginning to its end.
fn reads(pattern: &str, text: &str) -> bool {
    let pieces: Vec<&str> = pattern.split("...").collect();
    let mut rest = text;
    for (i, piece) in pieces.iter().enumerate() {
        let Some(at) = rest.find(piece) else { return false };
        if i == 0 && at > 0 {
            return false;
        }
        rest = &rest[at + piece.len()..];
    }
    rest.is_empty() || pieces.last().is_some_and(|piece| piece.is_empty())
}

#[test]
fn outcomes_are_those_of_the_page() {
    let page = page();
    let rows = table(&page);
    let here: Vec<&[String; 3]> = rows.iter().filter(|row| row[2] == "`extremes`").collect();
    let mut wrong = String::new();
    for (name, case) in CASES {
        let found = case();
        match here.iter().find(|row| row[0] == *name) {
            Some(row) if reads(&row[1], &found) => {}
            Some(row) => wrong += &format!("{name}: the page says\n  {}\nfound is\n  {found}\n", row[1]),
            None => wrong += &format!("not on the page:\n| {name} | {found} | `extremes` |\n"),
        }
    }
    for row in here {
        if !CASES.iter().any(|(name, _)| row[0] == *name) {
            wrong += &format!("on the page, and no case: {}\n", row[0]);
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn tests_that_the_page_names_exist() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let mut named = 0;
    for [case, outcome, place] in table(&page()) {
        if place == "`extremes`" {
            continue;
        }
        let path = place.trim_matches('`');
        let (module, test) = path
            .rsplit_once("::")
            .unwrap_or_else(|| panic!("{case}: `{path}` is no test"));
        let file = root.join(format!("it/{module}.rs"));
        let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(text.contains(&format!("fn {test}(")), "{case}: no {path}");
        assert!(!outcome.is_empty(), "{case}");
        named += 1;
    }
    assert!(named > 10, "{named}");
}

#[test]
fn patterns_leave_out_what_dots_stand_for_and_nothing_else() {
    assert!(reads("done", "done") && reads("a ... c", "a b c") && reads("a ...", "a b c"));
    assert!(!reads("done", "done twice") && !reads("b ... c", "a b c") && !reads("a ... d", "a b c"));
}
