//! What of a linkage is drawn where.

use linkdyn_mechanisms::kinematics::Joint;
use linkdyn_mechanisms::{PlacedJoint, Skeleton};
use nalgebra::Vector3;

/// Points closer than this are one \[m\].
const SAME: f64 = 1e-9;

/// A free joint is no part of a machine.
pub(super) fn is_drawn(joint: &PlacedJoint) -> bool {
    !matches!(joint.joint, Joint::Free)
}

pub(super) fn slides(joint: &Joint) -> bool {
    matches!(
        joint,
        Joint::Prismatic { .. } | Joint::Screw { .. } | Joint::Cylindrical { .. } | Joint::Planar { .. }
    )
}

/// The direction of a slide in its frames; none for those in a plane.
pub(super) fn axis(joint: &Joint) -> Option<Vector3<f64>> {
    match joint {
        Joint::Prismatic { axis } | Joint::Screw { axis, .. } | Joint::Cylindrical { axis } => Some(**axis),
        _ => None,
    }
}

/// The points that must fit into the picture.
pub(super) fn points(skeleton: &Skeleton) -> impl Iterator<Item = Vector3<f64>> {
    let drawn = skeleton.joints.iter().filter(|j| is_drawn(j));
    let joints = drawn.map(|j| place(skeleton, j));
    let struts = skeleton.struts.iter().flatten().map(|(_, point)| *point);
    let links = (0..skeleton.links.len()).flat_map(|link| corners(skeleton, link));
    joints.chain(struts).chain(links)
}

/// Where the symbol of a joint is. A slide is where its successor is, and halfway between two rods of which one slides in the other.
pub(super) fn place(skeleton: &Skeleton, joint: &PlacedJoint) -> Vector3<f64> {
    let [one, two] = [0, 1].map(|side| joint.frames[side].origin);
    let telescope = |[predecessor, successor]: [usize; 2]| {
        let long = |link: usize, end: Vector3<f64>| ends(skeleton, link).any(|point| (point - end).norm() > SAME);
        slides(&joint.joint) && long(predecessor, one) && long(successor, two)
    };
    match joint.links {
        [Some(predecessor), Some(successor)] if telescope([predecessor, successor]) => 0.5 * (one + two),
        [_, None] => one,
        _ => two,
    }
}

/// Where joints and struts hold a link, and where its mass is.
fn ends(skeleton: &Skeleton, link: usize) -> impl Iterator<Item = Vector3<f64>> {
    let joints = skeleton.joints.iter().filter(|j| is_drawn(j));
    let sides = joints.flat_map(|j| j.links.into_iter().zip(j.frames.iter().map(|frame| frame.origin)));
    let struts = skeleton.struts.iter().flatten().copied();
    let there = sides.chain(struts).filter(move |(side, _)| *side == Some(link));
    there.map(|(_, point)| point).chain(skeleton.links[link].centre)
}

/// Corners of a link: its joints and ends of struts, and its centre of mass where these are one point only.
pub(super) fn corners(skeleton: &Skeleton, link: usize) -> Vec<Vector3<f64>> {
    let joints = skeleton.joints.iter().filter(|j| is_drawn(j));
    let sides = joints.flat_map(|j| {
        // A link in which another one slides reaches as far as the slide.
        let at = place(skeleton, j);
        let on = |side: usize| if slides(&j.joint) { at } else { j.frames[side].origin };
        [
            (j.links[0], j.frames[0].origin),
            (j.links[0], on(0)),
            (j.links[1], on(1)),
        ]
    });
    let struts = skeleton.struts.iter().flatten().copied();
    let there = sides.chain(struts).filter(|(side, _)| *side == Some(link));
    let mut corners: Vec<Vector3<f64>> = Vec::new();
    for (_, point) in there {
        if corners.iter().all(|corner| (corner - point).norm() > SAME) {
            corners.push(point);
        }
    }
    if corners.len() < 2 {
        corners.extend(skeleton.links[link].centre);
    }
    corners
}

/// The mass of a link, where it sits at one of its ends.
pub(super) fn heavy_end(skeleton: &Skeleton, link: usize) -> Option<Vector3<f64>> {
    let corners = corners(skeleton, link);
    let size = corners.iter().map(|p| (p - corners[0]).norm()).fold(0.0, f64::max);
    let centre = skeleton.links[link].centre?;
    let at_an_end = corners.iter().any(|corner| (corner - centre).norm() <= SAME);
    (size > SAME && at_an_end).then_some(centre)
}
