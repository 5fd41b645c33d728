//! Scene files against closed forms and against the same linkages in Rust.

use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::{
    Bearing, Cubic, Exponential, Friction, HyperbolicTangent, JournalBearing, PadGuide, PiecewiseLinear, Stribeck, Sum,
    Surface, Viscous,
};
use linkdyn_integrators::{Auto, Dop853};
use linkdyn_kinematics::{Joint, Positions};
use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsrrr, Rsup, rsrrr, rsup};
use linkdyn_mechanisms::{Edge, Linkage, Mount, Observation, Role, Scene, file, spanning_tree};
use linkdyn_tests::scenes::{Ready, prepare, simulate};

const FOUR_BAR: &str = include_str!("../../crates/mechanisms/scenes/four_bar.toml");
const RSRRR: &str = include_str!("../../crates/mechanisms/scenes/rsrrr.toml");
const RSRRR_FRICTION: &str = include_str!("../../crates/mechanisms/scenes/rsrrr_friction.toml");
const RSUP: &str = include_str!("../../crates/mechanisms/scenes/rsup.toml");
const RSUP_CLEARANCE: &str = include_str!("../../crates/mechanisms/scenes/rsup_clearance.toml");
const RSUP_FLEXIBLE: &str = include_str!("../../crates/mechanisms/scenes/rsup_flexible.toml");
const SLIDER_CRANK: &str = include_str!("../../crates/mechanisms/scenes/slider_crank.toml");
const RSSR: &str = include_str!("../../crates/mechanisms/scenes/rssr.toml");

fn read(text: &str) -> Scene {
    file::scene("file", text).expect("a sound file")
}

#[test]
fn four_bar_closes_as_the_closed_form_says() {
    let scene = read(FOUR_BAR);
    let mechanism = scene.linkage.build().expect("a linkage");
    let (state, _) = mechanism.assemble(&scene.start).expect("closes");
    // Circles about the crank's pin and the rocker's base: the law of cosines on the branch with the coupler above.
    let (a, b, c, d) = (0.1, 0.35, 0.25, 0.4_f64);
    let (x, y) = (a * f64::cos(1.0) - d, a * f64::sin(1.0));
    let diagonal = x.hypot(y);
    let opening = ((diagonal * diagonal + c * c - b * b) / (2.0 * diagonal * c)).acos();
    let rocker = y.atan2(x) - opening;
    let names: Vec<_> = mechanism.coordinate_names().collect();
    assert_eq!(names, ["A", "B", "D"]);
    // Closed to 1e-14, angles to that times the condition, some 10.
    assert!(
        (state.q[2] - rocker).abs() < 1e-12,
        "{} instead of {rocker}",
        state.q[2]
    );
}

/// Motions that keep their energy balance.
#[test]
fn files_run() {
    for text in [FOUR_BAR, SLIDER_CRANK, RSSR] {
        let scene = read(text);
        let ready = prepare(scene);
        let run = simulate(&ready, Auto::default(), 1e-10, 0.5, 0.05);
        run.end.expect("runs");
        let energy = |o: &Observation| o.energy.kinetic + o.energy.potential - o.work;
        let (first, last) = (energy(&run.rows[0]), energy(run.rows.last().expect("rows")));
        assert!((last - first).abs() < 1e-8, "{first} {last}");
    }
}

/// A description without the signs of its zeros, which a file does not write.
fn plain(linkage: &Linkage) -> String {
    format!("{linkage:?}").replace("-0.0,", "0.0,").replace("-0.0]", "0.0]")
}

#[test]
fn rsup_as_a_file_is_the_same_linkage_to_the_bit() {
    let (clearance, flexible) = (Some(ClearanceKind::Planar), Some(2));
    for (clearance, flexible, text) in [
        (None, None, RSUP),
        (clearance, None, RSUP_CLEARANCE),
        (None, flexible, RSUP_FLEXIBLE),
    ] {
        let variant = Rsup {
            clearance,
            flexible,
            ..Rsup::default()
        };
        let (rust, file) = (rsup(&variant).expect("a scene"), read(text));
        assert_eq!(plain(&rust.linkage), plain(&file.linkage));
        assert_eq!(rust.start, file.start);
        assert_eq!((rust.until, rust.reactions), (file.until, file.reactions));
        assert_eq!((rust.crank, rust.output), (file.crank, file.output));
    }
}

#[test]
fn spatial_clearance_as_a_file_runs_to_the_same_rows() {
    let text = RSUP_CLEARANCE.replace("force_point", "length = 0.02\nforce_point");
    let variant = Rsup {
        clearance: Some(ClearanceKind::Spatial),
        ..Rsup::default()
    };
    let [rust, file] = [rsup(&variant).expect("a scene"), read(&text)].map(|scene| {
        let run = simulate(&prepare(scene), Dop853::default(), 1e-10, 0.1, 0.01);
        run.end.expect("runs");
        run.rows
    });
    assert_eq!(rust, file);
}

#[test]
fn rsrrr_as_a_file_is_the_same_linkage_to_the_bit() {
    for (friction, text) in [(false, RSRRR), (true, RSRRR_FRICTION)] {
        let variant = Rsrrr {
            friction,
            ..Rsrrr::default()
        };
        let (rust, file) = (rsrrr(&variant), read(text));
        assert_eq!(format!("{:?}", rust.linkage), format!("{:?}", file.linkage));
        assert_eq!(rust.start, file.start);
        assert_eq!(
            (rust.until, rust.reactions, rust.crank),
            (file.until, file.reactions, file.crank)
        );
    }
}

fn edge(predecessor: Option<usize>, successor: Option<usize>, freedoms: usize, cut: Option<bool>) -> Edge {
    Edge {
        predecessor,
        successor,
        freedoms,
        cut,
        backwards: freedoms < 3,
    }
}

#[test]
fn joints_with_many_freedoms_are_cut_unless_told() {
    let loop_of = |cut| {
        [
            edge(None, Some(0), 1, None),
            edge(Some(0), Some(1), 3, cut),
            edge(Some(1), None, 1, None),
        ]
    };
    let roles = spanning_tree(2, &loop_of(None));
    assert_eq!(roles, [Role::Carries, Role::Cut, Role::CarriesBackwards]);
    let roles = spanning_tree(2, &loop_of(Some(false)));
    assert_eq!(roles, [Role::Carries, Role::Carries, Role::Cut]);
}

#[test]
fn joints_that_cannot_carry_backwards_do_so_only_where_there_is_no_other_way() {
    // Link 1 hangs between two balls, both of which have it for their predecessor: neither can carry it.
    let open = [edge(None, Some(0), 1, None), edge(Some(1), Some(0), 3, None)];
    assert_eq!(spanning_tree(2, &open), [Role::Carries, Role::CarriesBackwards]);
    // Another joint can, though it has more freedoms.
    let closed = [open[0], open[1], edge(None, Some(1), 6, None)];
    assert_eq!(spanning_tree(2, &closed), [Role::Carries, Role::Cut, Role::Carries]);
    // A ball that shall carry link 0 is waited for.
    let told = [
        open[0],
        edge(Some(1), Some(0), 3, Some(false)),
        edge(None, Some(1), 2, None),
    ];
    assert_eq!(spanning_tree(2, &told), [Role::Cut, Role::Carries, Role::Carries]);
}

#[test]
fn a_universal_joint_carries_its_predecessor_by_the_same_coordinates() {
    let text = |sides: &str| {
        format!(
            "format = 1\nlinks.rod = {{ cylinder = {{ density = 7850, diameter = 0.02, along = [0.3, 0.1, 0] }} }}\n\
             [joints.U]\nkind = \"universal\"\naxis = [1, 0, 2]\nsecond_axis = [0, 1, 0.5]\n{sides}\n\
             springs = [{{ stiffness = 3, damping = 0.1 }}, {{ stiffness = 8 }}]\n\
             [start]\npositions = {{ \"U.psi\" = 0.7, \"U.theta\" = -0.4 }}\nspeeds = {{ \"U.psi\" = -2, \"U.theta\" = 1 }}"
        )
    };
    let (forwards, backwards) = (
        text("predecessor.point = [0.1, 0, 0]\nsuccessor = { link = \"rod\", point = [0, 0.2, 0] }"),
        text("successor.point = [0.1, 0, 0]\npredecessor = { link = \"rod\", point = [0, 0.2, 0] }"),
    );
    // Seen from the other side the turns are the opposite ones in the opposite order, and the axes' names exchanged.
    let ready = |text: &str, turned: bool| {
        let ready = prepare(read(text));
        let names: Vec<_> = ready.mechanism.coordinate_names().map(str::to_owned).collect();
        assert_eq!(
            names,
            if turned {
                ["U.theta", "U.psi"]
            } else {
                ["U.psi", "U.theta"]
            }
        );
        ready
    };
    let (one, two) = (ready(&forwards, false), ready(&backwards, true));
    assert_eq!((one.start.q[0], one.start.q[1]), (two.start.q[1], two.start.q[0]));
    // R(psi, theta) of the file's axes turns the successor against the predecessor in both.
    let rotation = |ready: &Ready| {
        let tree = ready.mechanism.system().tree();
        let mut positions = Positions::new(tree);
        tree.positions(&ready.start.q, &mut positions);
        let frame = ready.mechanism.attachment("rod").expect("the rod");
        (positions.pose(frame.link) * frame.pose).rotation
    };
    let (r1, r2) = (rotation(&one), rotation(&two));
    assert!((r1.transpose() - r2).amax() < 1e-15, "{r1} {r2}");
}

#[test]
fn friction_takes_all_laws_and_both_bearings() {
    let text = |kind: &str, laws: &str, bearing: &str| {
        format!(
            "format = 1\nlinks.bob = {{ mass = 2, centre = [0.1, 0, 0] }}\n[joints.A]\nkind = \"{kind}\"\naxis = [0, 1, 0]\n\
             successor.link = \"bob\"\n[joints.A.friction]\n{laws}\n{bearing}\n"
        )
    };
    let surface = |diameter: f64| Surface {
        diameter,
        coefficient: 0.2,
    };
    let journal = JournalBearing {
        spacing: 0.03,
        surface_a: surface(0.01),
        surface_b: surface(0.01),
        face: surface(0.015),
    };
    let pads = PadGuide {
        spacing: 0.1,
        arm: 0.02,
        pad_a: 0.2,
        pad_b: 0.2,
        key: 0.1,
    };
    let written = "{ diameter = 0.01, coefficient = 0.2 }";
    let journal_text = format!(
        "journal = {{ spacing = 0.03, surface_a = {written}, surface_b = {written}, face = {{ diameter = 0.015, coefficient = 0.2 }} }}"
    );
    let pads_text = "pad_guide = { spacing = 0.1, arm = 0.02, pad_a = 0.2, pad_b = 0.2, key = 0.1 }";
    let (reference_speed, steepness) = (0.01, 3.0);
    let (exponential, viscous) = (
        Exponential {
            reference_speed,
            steepness,
        },
        Viscous { per_speed: 0.5 },
    );
    let stribeck = Stribeck {
        static_ratio: 1.5,
        stribeck_speed: 0.02,
        exponent: 2.0,
        reference_speed,
    };
    let laws: [(&str, Friction); 7] = [
        (
            "exponential = { reference_speed = 0.01, steepness = 3 }",
            exponential.into(),
        ),
        (
            "piecewise_linear = { reference_speed = 0.01 }",
            PiecewiseLinear { reference_speed }.into(),
        ),
        (
            "hyperbolic_tangent = { reference_speed = 0.01 }",
            HyperbolicTangent { reference_speed }.into(),
        ),
        ("cubic = { reference_speed = 0.01 }", Cubic { reference_speed }.into()),
        (
            "stribeck = { static_ratio = 1.5, stribeck_speed = 0.02, exponent = 2, reference_speed = 0.01 }",
            stribeck.into(),
        ),
        ("viscous = { per_speed = 0.5 }", viscous.into()),
        (
            "viscous = { per_speed = 0.5 }\nexponential = { reference_speed = 0.01, steepness = 3 }",
            Sum {
                first: exponential,
                second: viscous,
            }
            .into(),
        ),
    ];
    let axis = nalgebra::Vector3::y_axis();
    let bearings: [(&str, Joint, Bearing, &str); 2] = [
        ("revolute", Joint::Revolute { axis }, journal.into(), &journal_text),
        ("prismatic", Joint::Prismatic { axis }, pads.into(), pads_text),
    ];
    for (kind, joint, bearing, bearing_text) in bearings {
        for (law_text, law) in &laws {
            let mut rust = Linkage::new([0.0, 0.0, -9.81]);
            let bob = RigidInertia {
                mass: 2.0,
                com: nalgebra::Vector3::new(0.1, 0.0, 0.0),
                about_com: nalgebra::Matrix3::zeros(),
            };
            let bob = rust.link("bob", bob);
            let a = rust.joint("A", joint, Mount::at_origin(Linkage::GROUND), Mount::at_origin(bob));
            rust.friction(a, law.clone(), bearing.clone());
            let file = read(&text(kind, law_text, bearing_text));
            assert_eq!(format!("{rust:?}"), format!("{:?}", file.linkage));
        }
    }
}
