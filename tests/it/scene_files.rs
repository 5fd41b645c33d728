//! Scene files against closed forms and against the same linkages in Rust.

use linkdyn_integrators::Auto;
use linkdyn_mechanisms::catalogue::{Rsrrr, rsrrr};
use linkdyn_mechanisms::{Edge, Observation, Role, Scene, file, spanning_tree};
use linkdyn_tests::scenes::{prepare, simulate};

const FOUR_BAR: &str = include_str!("../../crates/mechanisms/scenes/four_bar.toml");
const RSRRR: &str = include_str!("../../crates/mechanisms/scenes/rsrrr.toml");
const RSRRR_FRICTION: &str = include_str!("../../crates/mechanisms/scenes/rsrrr_friction.toml");
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

#[test]
fn joints_with_many_freedoms_are_cut_unless_told() {
    let edge = |predecessor, successor, freedoms, cut| Edge {
        predecessor,
        successor,
        freedoms,
        cut,
    };
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
