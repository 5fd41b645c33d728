//! Random machines. Everything is of the order of 1 (metres, kilograms, seconds), so that tolerances can be stated plainly.

use crate::blueprint::{Blueprint, Cut, Part};
use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::{Joint, Pose, Wrench};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::RngSeed;
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// `cases` cases, the same in every run. With the environment variable `PROPTEST_CASES` as many as it says, new ones each time.
pub fn cases(cases: u32) -> ProptestConfig {
    let wanted: Option<u32> = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok());
    let cases = wanted.unwrap_or(cases);
    ProptestConfig {
        cases,
        failure_persistence: None,
        max_global_rejects: 20 * cases,
        rng_seed: wanted.map_or(RngSeed::Fixed(1), |_| RngSeed::Random),
        ..ProptestConfig::default()
    }
}

/// A number between `-size` and `size`.
pub fn number(size: f64) -> impl Strategy<Value = f64> {
    -size..size
}

/// A vector with entries up to `size`.
pub fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(number(size)).prop_map(Vector3::from)
}

/// Any direction.
pub fn direction() -> impl Strategy<Value = Unit<Vector3<f64>>> {
    (number(1.0), number(PI)).prop_map(|(z, turn)| {
        let r = (1.0 - z * z).sqrt();
        Unit::new_normalize(Vector3::new(r * turn.cos(), r * turn.sin(), z))
    })
}

/// Any orientation at a point with coordinates up to `size` \[m\].
pub fn pose(size: f64) -> impl Strategy<Value = Pose> {
    (direction(), number(PI), vector(size)).prop_map(|(axis, angle, origin)| Pose {
        origin,
        ..Pose::turn(axis, angle)
    })
}

/// Any joint with at least one freedom.
pub fn moving_joint() -> impl Strategy<Value = Joint> {
    prop_oneof![
        3 => direction().prop_map(|axis| Joint::Revolute { axis }),
        2 => direction().prop_map(|axis| Joint::Prismatic { axis }),
        1 => direction().prop_map(|axis| Joint::Cylindrical { axis }),
        1 => universal(),
        1 => screw(),
        1 => Just(Joint::SphericalZyx),
        1 => Just(Joint::Spherical),
        1 => planar(),
        1 => Just(Joint::Free),
    ]
}

/// Any joint.
pub fn joint() -> impl Strategy<Value = Joint> {
    prop_oneof![1 => Just(Joint::Fixed), 9 => moving_joint()]
}

/// A screw with a lead of at least 0.3 m either way, so that coordinates within one turn tell a lead apart from the next.
fn screw() -> impl Strategy<Value = Joint> {
    (direction(), 0.05..0.3, any::<bool>()).prop_map(|(axis, pitch, right)| Joint::Screw {
        axis,
        pitch: if right { pitch } else { -pitch },
    })
}

/// A universal joint with axes at least 0.5 rad apart.
fn universal() -> impl Strategy<Value = Joint> {
    (direction(), number(PI), 0.5..(PI - 0.5)).prop_map(|(first, turn, apart)| {
        let across = Pose::turn(first, turn).rotation * first.cross(&off(&first)).normalize();
        let second = Pose::turn(Unit::new_normalize(across), apart).rotation * *first;
        Joint::Universal {
            first,
            second: Unit::new_normalize(second),
        }
    })
}

/// A planar joint.
fn planar() -> impl Strategy<Value = Joint> {
    (direction(), number(PI)).prop_map(|(normal, turn)| Joint::Planar {
        along: Unit::new_normalize(Pose::turn(normal, turn).rotation * normal.cross(&off(&normal))),
        normal,
    })
}

/// A direction that is not that of `axis`.
fn off(axis: &Vector3<f64>) -> Vector3<f64> {
    if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() }
}

/// Seven numbers between -1 and 1 that become the coordinates of any joint.
pub type Raw = [f64; 7];

/// Numbers for [`coordinates`].
pub fn raw() -> impl Strategy<Value = Raw> {
    prop::array::uniform7(number(1.0))
}

/// Coordinates of a joint: any angles (but `theta` of three turns stays 0.3 rad off its singularity), slides up to half a
/// metre, unit quaternions.
pub fn coordinates(joint: &Joint, raw: &Raw) -> Vec<f64> {
    let [a, b, c, d, ..] = *raw;
    match joint {
        Joint::Fixed => vec![],
        Joint::Revolute { .. } | Joint::Screw { .. } => vec![PI * a],
        Joint::Prismatic { .. } => vec![0.5 * a],
        Joint::Cylindrical { .. } => vec![0.5 * a, PI * b],
        Joint::Universal { .. } => vec![PI * a, PI * b],
        Joint::SphericalZyx => vec![PI * a, (PI / 2.0 - 0.3) * b, PI * c],
        Joint::Spherical => quaternion([a, b, c, d]),
        Joint::Planar { .. } => vec![0.5 * a, 0.5 * b, PI * c],
        Joint::Free => {
            let mut q = vec![0.5 * a, 0.5 * b, 0.5 * c];
            q.extend(quaternion([d, raw[4], raw[5], raw[6]]));
            q
        }
    }
}

/// A unit quaternion.
fn quaternion([a, b, c, d]: [f64; 4]) -> Vec<f64> {
    // The shift of w keeps the length away from zero, at the price of turns that are not uniform.
    let w = if a < 0.0 { a - 0.1 } else { a + 0.1 };
    let length = (w * w + b * b + c * c + d * d).sqrt();
    vec![w / length, b / length, c / length, d / length]
}

/// A possible inertia: a rod or a wheel (bodies of revolution about their origins' axis), an irregular body, or one that looks
/// like a body of revolution about z by its inertia about the origin, but has its centre of mass off that axis.
pub fn inertia() -> impl Strategy<Value = RigidInertia> {
    let rod = (0.02..0.1, 0.2..1.0, direction())
        .prop_map(|(diameter, length, u)| RigidInertia::solid_cylinder(7850.0, diameter, length, &u));
    let wheel = (1.0..5.0, 0.1..0.4, 0.01..0.1, direction()).prop_map(|(mass, axial, more, u)| RigidInertia {
        mass,
        com: Vector3::zeros(),
        about_com: Matrix3::identity() * (axial / 2.0 + more) + *u * u.transpose() * (axial / 2.0 - more),
    });
    let deceptive = RigidInertia {
        mass: 2.0,
        com: Vector3::new(0.5, 0.0, 0.0),
        about_com: Matrix3::from_diagonal(&Vector3::new(1.0, 0.5, 1.0)),
    };
    prop_oneof![4 => rod, 2 => wheel, 4 => irregular(), 1 => Just(deceptive)]
}

/// An irregular body: three positive second moments `a`, `b`, `c` about turned axes make a possible inertia.
pub fn irregular() -> impl Strategy<Value = RigidInertia> {
    let moments = prop::array::uniform3(0.01..0.3);
    (0.5..5.0, vector(0.4), moments, direction(), number(PI)).prop_map(|(mass, com, [a, b, c], axis, angle)| {
        let r = *Rotation3::from_axis_angle(&axis, angle).matrix();
        let about_com = r * Matrix3::from_diagonal(&Vector3::new(b + c, c + a, a + b)) * r.transpose();
        RigidInertia {
            mass,
            com,
            about_com: (about_com + about_com.transpose()) * 0.5,
        }
    })
}

/// A force and torque with components up to `size`.
pub fn wrench(size: f64) -> impl Strategy<Value = Wrench> {
    (vector(size), vector(size)).prop_map(|(torque, force)| Wrench { torque, force })
}

/// Where a link hangs: twice as often on the last one as on any earlier one.
fn place() -> impl Strategy<Value = Option<Index>> {
    prop_oneof![2 => Just(None), 1 => any::<Index>().prop_map(Some)]
}

fn part() -> impl Strategy<Value = (Part, Option<Index>, bool)> {
    let body = (inertia(), prop::bool::weighted(0.15));
    let load = (prop::array::uniform6(number(5.0)), wrench(5.0));
    let state = (raw(), prop::array::uniform6(number(2.0)));
    (joint(), pose(0.5), place(), body, state, load).prop_map(
        |(joint, placement, place, (inertia, empty), (raw, v), (drive, wrench))| {
            let part = Part {
                parent: None,
                placement,
                joint,
                inertia,
                q: coordinates(&joint, &raw),
                v: v[..joint.speeds()].to_vec(),
                drive: drive[..joint.speeds()].to_vec(),
                wrench,
            };
            (part, place, empty)
        },
    )
}

/// A tree of so many links, in any state under any loads.
pub fn tree(links: RangeInclusive<usize>) -> impl Strategy<Value = Blueprint> {
    let parts = prop::collection::vec(part(), links);
    let moves = |b: &Blueprint| b.parts.iter().any(|part| part.joint.speeds() > 0);
    (parts, vector(10.0))
        .prop_map(|(drawn, gravity)| grow(drawn, gravity))
        .prop_filter("must move", moves)
}

fn grow(drawn: Vec<(Part, Option<Index>, bool)>, gravity: Vector3<f64>) -> Blueprint {
    let mut empty = Vec::new();
    let mut parts: Vec<Part> = Vec::new();
    for (k, (mut part, place, without_mass)) in drawn.into_iter().enumerate() {
        let choice = place.map_or(k, |index| index.index(k + 1));
        part.parent = choice.checked_sub(1);
        empty.push(without_mass);
        parts.push(part);
    }
    // An inner link may be without mass where two single freedoms in a row move one massive link.
    for k in 0..parts.len() {
        let carries = |other: &Part| other.parent == Some(k) && other.inertia.mass > 0.0 && other.joint.speeds() <= 1;
        let carried = parts.iter().enumerate().any(|(j, other)| !empty[j] && carries(other));
        if empty[k] && carried && parts[k].joint.speeds() <= 1 {
            parts[k].inertia = RigidInertia::massless();
        } else {
            empty[k] = false;
        }
    }
    Blueprint {
        parts,
        cuts: Vec::new(),
        gravity,
    }
}

/// A tree with so many cut joints that are closed in its state, and speeds that keep them closed.
pub fn closed(links: RangeInclusive<usize>, cuts: RangeInclusive<usize>) -> impl Strategy<Value = Blueprint> {
    closed_with(links, cuts, joint())
}

/// As [`closed`], with cut joints of one's own choice.
pub fn closed_with(
    links: RangeInclusive<usize>,
    cuts: RangeInclusive<usize>,
    joint: impl Strategy<Value = Joint>,
) -> impl Strategy<Value = Blueprint> {
    let cut = (any::<Index>(), any::<Index>(), pose(0.5), joint, raw());
    (tree(links), prop::collection::vec(cut, cuts)).prop_map(|(mut blueprint, cuts)| {
        for (one, other, frame, joint, raw) in cuts {
            // Two different ones out of the ground and all parts.
            let places = blueprint.parts.len() + 1;
            let one = one.index(places);
            let other = (one + 1 + other.index(places - 1)) % places;
            blueprint.close(
                one.checked_sub(1),
                frame,
                joint,
                &coordinates(&joint, &raw),
                other.checked_sub(1),
            );
        }
        blueprint.make_speeds_consistent();
        blueprint
    })
}

/// A tree tied to the ground by one cut joint that is open by anything up to some metres.
pub fn open() -> impl Strategy<Value = Blueprint> {
    let frames = (pose(0.5), pose(0.5), any::<bool>());
    (tree(1..=6), joint(), frames, any::<Index>()).prop_map(|(mut blueprint, joint, (one, other, turned), place)| {
        let link = Some(place.index(blueprint.parts.len()));
        let (predecessor, successor) = if turned { (link, None) } else { (None, link) };
        blueprint.cuts.push(Cut {
            predecessor: (predecessor, one),
            successor: (successor, other),
            joint,
        });
        blueprint
    })
}
