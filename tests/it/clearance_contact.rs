//! Contact of the RSUP linkage with planar clearance, recomputed from the states of an independent solution
//! (`reference/README.md`): laws and geometry of the clearance, signs and points of application.

use linkdyn_contact::*;
use linkdyn_friction::{BristleModel, Guard, LuGre};
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::collections::HashMap;

type Row = HashMap<String, f64>;

fn rows(file: &str) -> Vec<Row> {
    let path = format!("{}/reference/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let numbers = |line: &str| -> Row {
        let values = line.split(',').map(|x| x.parse().unwrap());
        names.iter().map(|name| name.to_string()).zip(values).collect()
    };
    lines.map(numbers).collect()
}

fn turn(axis: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    *Rotation3::new(axis * angle).matrix()
}

/// Bearing (coupler end E) and journal (yoke), from the transforms of the scene written out by hand.
fn joint(row: &Row) -> (Centre, Centre) {
    let (q, v) = (
        |name: &str| row[&format!("q.{name}")],
        |name: &str| row[&format!("v.{name}")],
    );
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());

    let base = Matrix3::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0);
    let crank = base * turn(z, q("psi11"));
    let spin_crank = base * z * v("psi11");
    let s = crank * y * 0.2;
    let yawed = crank * turn(z, q("psi12"));
    let pitched = yawed * turn(y, q("theta12"));
    let coupler = pitched * turn(x, q("phi12"));
    let spin = spin_crank + crank * z * v("psi12") + yawed * y * v("theta12") + pitched * x * v("phi12");
    let arm = coupler * y * -0.4;
    let bearing = Centre {
        point: s + arm,
        velocity: spin_crank.cross(&s) + spin.cross(&arm),
        spin,
        axis: coupler * x,
    };

    let base = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
    let journal = Centre {
        point: base * z * q("z21") - y * 0.1,
        velocity: base * z * v("z21"),
        spin: base * z * v("psi22"),
        axis: base * turn(z, q("psi22")) * x,
    };
    (bearing, journal)
}

fn fit() -> Fit {
    Fit::new(0.005, 0.004).unwrap()
}

fn law() -> NormalLaw {
    let steel = Material {
        youngs_modulus: 2.1e11,
        poisson_ratio: 0.3,
    };
    let stiffness = ball_in_socket(0.005, 0.004, 2.0 * steel.compliance().unwrap()).unwrap();
    NormalLaw::new(stiffness, 1.5, RestitutionLaw::LankaraniNikravesh.with(0.9)).unwrap()
}

fn bristle() -> LuGre {
    LuGre {
        static_coefficient: 0.2,
        kinetic_coefficient: 0.1,
        stribeck_speed: 0.0175,
        bristle_stiffness: 600.0,
        bristle_damping: 600f64.sqrt(),
        viscous_coefficient: 0.0,
        guard: Guard::None,
    }
}

/// Force and torque about E that the yoke exerts on the coupler.
fn reaction(row: &Row) -> (Vector3<f64>, Vector3<f64>) {
    let vector = |a, b, c| Vector3::new(row[a], row[b], row[c]);
    (vector("R.fx", "R.fy", "R.fz"), vector("R.nx", "R.ny", "R.nz"))
}

#[test]
fn planar_contact_follows_from_the_states_of_an_independent_solution() {
    let (fit, law, bristle) = (fit(), law(), bristle());
    let mut touching = 0;
    for row in rows("rsup_planar.csv") {
        let t = row["t"];
        let of = |name: &str| row[&format!("contact.R.{name}")];
        let (bearing, journal) = joint(&row);
        assert!((fit.gap(&bearing, &journal) + of("depth")).abs() < 2e-15, "{t}");
        if of("normal") == 0.0 {
            assert!(of("depth") < 0.0);
            continue;
        }
        touching += 1;
        let touch = fit.planar(&bearing, &journal).unwrap();
        assert!(
            (touch.rate - of("rate")).abs() < 1e-12,
            "{t} {} {}",
            touch.rate,
            of("rate")
        );
        // The depth of the file: the one from the coordinates has lost six digits in the difference.
        let normal = law.at(of("depth"), touch.rate, of("impact_speed")).value;
        assert!(
            (normal - of("normal")).abs() < 1e-8 * (1.0 + of("normal")),
            "{t} {normal} {}",
            of("normal")
        );
        let friction = bristle.at(touch.slip, of("bristle")).coefficient.value * normal;
        assert!(
            (friction - of("tangent")).abs() < 1e-7,
            "{t} {friction} {}",
            of("tangent")
        );

        // All that the yoke exerts on the coupler, less the contact, is what the kept equations can exert: a force
        // along the axis and a torque across it.
        let contact = touch.force(of("normal"), [of("tangent"), 0.0], ForcePoint::OwnSurface);
        let (force, torque) = reaction(&row);
        let force = force - contact.on_bearing;
        let torque = torque - contact.torque_on_bearing(&bearing.point);
        assert!(force.cross(&journal.axis).norm() < 1e-8, "{t} {force}");
        assert!(torque.dot(&journal.axis).abs() < 1e-10, "{t} {torque}");
        assert!(contact.on_bearing.norm() > 1e-3 && force.norm() > 1e-3);
    }
    assert!(touching > 15, "{touching}");
}

/// Direction of the one kept equation and the point of its line, from bearing and journal.
type Kept = fn(&Centre, &Centre) -> (Vector3<f64>, Vector3<f64>);

fn check_edges(file: &str, kept: Kept) {
    let (fit, law, bristle) = (fit(), law(), bristle());
    let mut touching = [0, 0];
    for row in rows(file) {
        let t = row["t"];
        let (bearing, journal) = joint(&row);
        let gaps = fit.edge_gaps(0.02, &bearing, &journal).unwrap();
        let touches = fit.edges(0.02, &bearing, &journal).unwrap();
        let (mut force, mut torque) = reaction(&row);
        for k in 0..2 {
            let of = |name: &str| row[&format!("contact.R{}.{name}", k + 1)];
            assert!((gaps[k] + of("depth")).abs() < 2e-15, "{t} {k}");
            if of("normal") == 0.0 {
                continue;
            }
            touching[k] += 1;
            let touch = touches[k].unwrap();
            assert!(
                (touch.rate - of("rate")).abs() < 1e-12,
                "{t} {} {}",
                touch.rate,
                of("rate")
            );
            let normal = law.at(of("depth"), touch.rate, of("impact_speed")).scaled(0.5).value;
            assert!(
                (normal - of("normal")).abs() < 1e-8 * (1.0 + of("normal")),
                "{t} {normal} {}",
                of("normal")
            );
            let slip = [touch.slip, touch.axial_slip];
            let mu = bristle
                .at_planar(slip, [of("bristle"), of("bristle_axial")])
                .coefficient;
            let friction = [of("tangent"), of("tangent_axial")];
            assert!(
                (0..2).all(|i| (mu[i] * normal - friction[i]).abs() < 1e-7),
                "{t} {mu:?} {friction:?}"
            );
            let contact = touch.force(of("normal"), friction, ForcePoint::OwnSurface);
            force -= contact.on_bearing;
            torque -= contact.torque_on_bearing(&bearing.point);
        }
        let (direction, point) = kept(&bearing, &journal);
        assert!(force.cross(&direction).norm() < 1e-8, "{t} {force}");
        assert!(
            (torque - (point - bearing.point).cross(&force)).norm() < 1e-10,
            "{t} {torque}"
        );
    }
    assert!(touching.iter().all(|&rows| rows > 8), "{touching:?}");
}

#[test]
fn contact_at_the_edges_follows_from_the_states_of_an_independent_solution() {
    check_edges("rsup_spatial.csv", |bearing, journal| (bearing.axis, journal.point));
    check_edges("rsup_spatial_x22.csv", |bearing, journal| (journal.axis, bearing.point));
}
