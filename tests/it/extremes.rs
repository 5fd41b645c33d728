//! Extreme cases, each with the outcome that `docs/extreme-cases.md` tells: cases run here, and tests elsewhere that it refers to.

use crate::linkage_refusals::{arm, rod};
use linkdyn_contact::{Fit, RestitutionLaw};
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::{Exponential, JournalBearing, Surface};
use linkdyn_integrators::{Dop853, Integration, Method, Radau5, Rk4};
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::catalogue::{Rsup, rsup};
use linkdyn_mechanisms::{Drive, Linkage, Mount, Observation, Scene, Simulation, Spring, Start, run};
use linkdyn_tests::linkages::FourBar;
use linkdyn_tests::scenes::ready_rsup;
use nalgebra::{Matrix3, Unit, Vector3};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// Most steps of a run: enough for all that come to an end.
const MOST_STEPS: u64 = 20_000;

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
        let (here, there) = (Mount::at_origin(arm.lower), Mount::at_origin(arm.upper));
        arm.linkage.joint("third", Joint::revolute_z(), here, there);
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

/// `done`, or `refused` with the reason.
fn told<T, E: Error>(result: Result<T, E>) -> String {
    result.map_or_else(|error| format!("refused: {error}"), |_| "done".to_owned())
}

/// Builds, closes and runs.
fn outcome(linkage: Linkage, start: &Start, method: impl Method<Simulation>, until: f64) -> String {
    rows(linkage, start, method, (until, 0.01))
}

fn rows(linkage: Linkage, start: &Start, method: impl Method<Simulation>, grid: (f64, f64)) -> String {
    watched(linkage, start, method, grid, |_| ())
}

/// The same, with a look at each row: `done`, `refused` before the first step, or `stops` after it.
fn watched(
    linkage: Linkage,
    start: &Start,
    method: impl Method<Simulation>,
    (until, every): (f64, f64),
    mut look: impl FnMut(&Observation),
) -> String {
    let mechanism = match linkage.build() {
        Ok(mechanism) => mechanism,
        Err(error) => return format!("refused: {error}"),
    };
    let state = match mechanism.assemble(start) {
        Ok((state, _)) => state,
        Err(error) => return format!("refused: {error}"),
    };
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&state);
    let mut settings = simulation.settings(1e-8, 1e-8);
    settings.max_steps = MOST_STEPS;
    let stops = mechanism.system().stop_times();
    let integration = Integration::new(simulation, method, 0.0, &y, settings);
    let mut integration = match integration.and_then(|integration| integration.with_stops(&stops)) {
        Ok(integration) => integration,
        Err(error) => return format!("refused: {error}"),
    };
    let mut seen = 0;
    let ended = run(&mut integration, until, every, |o| {
        assert!(
            o.q.iter().chain(&o.v).chain(&o.a).all(|x| x.is_finite()),
            "a row at {} s",
            o.t
        );
        seen += 1;
        look(o);
        ControlFlow::Continue(())
    });
    match ended {
        Ok(()) => "done".to_owned(),
        Err(error) if seen == 0 => format!("refused: {error}"),
        Err(error) => format!("stops: {error}"),
    }
}

fn scene_outcome(scene: Scene, until: f64) -> String {
    outcome(scene.linkage, &scene.start, Radau5::default(), until)
}

/// The arm with a third link on a hinge, its inertia changed.
fn end_of_the_arm(change: impl FnOnce(&mut RigidInertia)) -> String {
    let mut arm = arm();
    let mut inertia = rod();
    change(&mut inertia);
    let third = arm.linkage.link("third", inertia);
    let elbow = Mount::at(arm.lower, [0.5, 0.0, 0.0]);
    arm.linkage
        .joint("wrist", Joint::revolute_z(), elbow, Mount::at_origin(third));
    outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
}

fn massless_between() -> String {
    let mut arm = arm();
    let nothing = RigidInertia {
        mass: 0.0,
        com: Vector3::zeros(),
        about_com: Matrix3::zeros(),
    };
    let (middle, end) = (arm.linkage.link("middle", nothing), arm.linkage.link("end", rod()));
    let elbow = Mount::at(arm.lower, [0.5, 0.0, 0.0]);
    arm.linkage
        .joint("wrist", Joint::revolute_z(), elbow, Mount::at_origin(middle));
    arm.linkage
        .joint("bolt", Joint::Fixed, Mount::at_origin(middle), Mount::at_origin(end));
    outcome(arm.linkage, &Start::default(), Dop853::default(), 0.1)
}

/// A rod on a hinge; gives the hinge.
fn pendulum(linkage: &mut Linkage) -> linkdyn_mechanisms::JointHandle {
    let link = linkage.link("rod", rod());
    linkage.joint(
        "hinge",
        Joint::revolute_z(),
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link),
    )
}

fn stiff_spring(method: impl Method<Simulation>) -> String {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let hinge = pendulum(&mut linkage);
    if let Some(inertia) = linkage.inertia_mut("rod") {
        inertia.about_com *= 1e-6 / inertia.mass;
        inertia.mass = 1e-6;
    }
    linkage.springs(
        hinge,
        &[Spring {
            stiffness: 1e12,
            damping: 0.0,
        }],
    );
    outcome(linkage, &Start::default(), method, 0.01)
}

fn friction(coefficient: f64, reference_speed: f64) -> String {
    let mut arm = arm();
    let surface = |diameter: f64| Surface { diameter, coefficient };
    let bearing = JournalBearing {
        spacing: 0.03,
        surface_a: surface(0.01),
        surface_b: surface(0.01),
        face: surface(0.015),
    };
    arm.linkage.friction(
        arm.elbow,
        Exponential {
            reference_speed,
            steepness: 3.0,
        },
        bearing,
    );
    outcome(arm.linkage, &Start::default(), Radau5::default(), 0.1)
}

fn no_number() -> String {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let joint = pendulum(&mut linkage);
    let function = Arc::new(|t: f64, _: f64, _: f64| if t < 0.1 { 1.0 } else { f64::NAN });
    let stop_times = Vec::new();
    linkage.drive(joint, Drive::Custom { function, stop_times });
    outcome(linkage, &Start::default(), Dop853::default(), 1.0)
}

fn spinning() -> String {
    let mut linkage = Linkage::new([0.0; 3]);
    let about_com = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5));
    let body = linkage.link(
        "body",
        RigidInertia {
            mass: 1.0,
            com: Vector3::zeros(),
            about_com,
        },
    );
    linkage.joint(
        "ball",
        Joint::Spherical,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(body),
    );
    let mechanism = linkage.build().expect("valid");
    let names: Vec<String> = mechanism.coordinate_names().map(str::to_owned).collect();
    let start = Start {
        speeds: vec![(names[1].clone(), 1e4), (names[2].clone(), 1.0)],
        ..Start::default()
    };
    let (mut length, mut first, mut energy) = (0.0_f64, None, 0.0_f64);
    let outcome = watched(linkage, &start, Dop853::default(), (0.01, 1e-4), |o| {
        length = length.max((o.q.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0).abs());
        let now = o.energy.total();
        energy = energy.max((now / *first.get_or_insert(now) - 1.0).abs());
    });
    assert!(
        length < 1e-12 && energy < 1e-6,
        "quaternion {length:e}, energy {energy:e}"
    );
    outcome
}

fn parallelogram() -> FourBar {
    FourBar {
        lengths: [0.1, 0.3, 0.1, 0.3],
        plane: Pose::identity(),
        closing: Joint::Spherical,
    }
}

/// Passes the flat position twice, and stays a parallelogram: of the two branches there the smooth one.
fn change_point() -> String {
    let turned = 0.5;
    let start = Start {
        positions: [("crank", turned), ("coupler", -turned), ("rocker", turned)]
            .map(|(n, x)| (n.to_owned(), x))
            .into(),
        held: vec!["crank".to_owned()],
        speeds: vec![("crank".to_owned(), -20.0)],
    };
    let mut apart = 0.0_f64;
    let mut turns = 0.0_f64;
    let outcome = watched(
        parallelogram().linkage(),
        &start,
        Dop853::default(),
        (0.6, 0.003),
        |o| {
            apart = apart.max((o.q[0] - o.q[2]).abs());
            turns = turns.max((o.q[0] - turned).abs());
        },
    );
    if outcome == "done" {
        assert!(
            apart < 1e-6 && turns > 6.5,
            "crank and rocker {apart:e} apart after {turns} rad"
        );
    }
    outcome
}

/// `count` links on hinges; link i hangs on link `parent(i)`, counted from 1, or on the ground.
fn tree(count: usize, parent: fn(usize) -> usize) -> String {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let mut links = Vec::new();
    for i in 0..count {
        let link = linkage.link(&format!("link {i}"), rod());
        links.push(link);
        let predecessor = match parent(i) {
            0 => Mount::at_origin(Linkage::GROUND),
            k => Mount::at(links[k - 1], [0.5, 0.0, 0.0]),
        };
        linkage.joint(
            &format!("joint {i}"),
            Joint::revolute_z(),
            predecessor,
            Mount::at_origin(link),
        );
    }
    rows(linkage, &Start::default(), Rk4::new(1e-3), (1e-3, 1e-3))
}

/// Upright the weight has no lever; half a turn has the rounding of π, which grows by e each 0.18 s.
fn upside_down() -> String {
    let mut linkage = Linkage::new([-9.81, 0.0, 0.0]);
    pendulum(&mut linkage);
    let start = Start::default();
    let start = Start {
        positions: vec![("hinge".to_owned(), std::f64::consts::PI)],
        held: vec!["hinge".to_owned()],
        ..start
    };
    let mut tilt = 0.0_f64;
    let outcome = watched(linkage, &start, Dop853::default(), (2.0, 0.1), |o| {
        tilt = tilt.max((o.q[0] - std::f64::consts::PI).abs());
    });
    assert!(tilt < 1e-9, "it has fallen by {tilt:e} rad");
    outcome
}

/// Drift of energy at most in proportion to time, over two decades.
fn many_steps() -> String {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    pendulum(&mut linkage);
    let (mut first, mut drift) = (None, [0.0_f64; 2]);
    let outcome = watched(linkage, &Start::default(), Rk4::new(1e-3), (19.9, 0.1), |o| {
        let off = (o.energy.total() - *first.get_or_insert(o.energy.total())).abs();
        drift[1] = drift[1].max(off);
        if o.t < 2.0 {
            drift[0] = drift[0].max(off);
        }
    });
    assert!(drift[0] > 0.0 && drift[1] < 15.0 * drift[0], "{drift:?} J");
    outcome
}

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
