//! `linkdyn draw`: a linkage at its start as a line drawing. Links are lines or plates between their joints, a joint has the symbol of
//! its kind, the ground is hatched.

mod symbols;
mod view;

use std::fs;

use linkdyn_mechanisms::kinematics::Joint;
use linkdyn_mechanisms::{PlacedJoint, Skeleton};
use nalgebra::Vector3;
use svg::Document;
use svg::node::element::{Group, Rectangle, Title};

use crate::args::DrawArgs;
use crate::errors::CliError;
use crate::figure::svg_to_png;
use crate::output;
use crate::run::{Prepared, ready};
use crate::scenes::{self, Variant};
use view::View;

/// Width and height of a picture, and the margin in it that symbols need.
const SIZE: [f64; 2] = [420.0, 300.0];
const MARGIN: f64 = 34.0;
/// Pixels of a PNG for one of the picture.
const PNG_SCALE: f64 = 2.0;
/// Colours of the links one after the other; told apart by colour-blind readers.
const COLOURS: [&str; 6] = ["#1b5ea8", "#d1451b", "#1d845b", "#7d3c98", "#b07d00", "#4a4a4a"];

/// `linkdyn draw`.
///
/// # Errors
/// A scene that cannot start, a picture whose name does not end in .svg or .png or that cannot be written.
pub fn draw(args: &DrawArgs) -> Result<(), CliError> {
    let kind = args.out.extension().and_then(|kind| kind.to_str()).unwrap_or_default();
    if !["svg", "png"].contains(&kind) {
        let message = format!("`{}` is no picture that can be drawn", args.out.display());
        return Err(CliError::usage(message).with_hint("give a name that ends in .svg or .png"));
    }
    let prepared = ready(scenes::find(&args.scene)?.scene(&Variant::default())?)?;
    let picture = picture(&prepared);
    let bytes = match kind {
        "png" => svg_to_png(&picture, PNG_SCALE)?,
        _ => picture.into_bytes(),
    };
    let path = args.out.display();
    fs::write(&args.out, bytes).map_err(|error| {
        CliError::usage(format!("cannot write `{path}`"))
            .with_source(error)
            .with_hint("give the name of a file in a folder that is there")
    })?;
    output::print(&format!("wrote {path}\n"))
}

/// The points that must fit into the picture: joints on both sides, ends of struts, and the centres of links with a single joint.
fn points(skeleton: &Skeleton) -> impl Iterator<Item = Vector3<f64>> {
    let drawn = skeleton.joints.iter().filter(|j| is_drawn(j));
    let joints = drawn.flat_map(|j| j.frames.iter().map(|frame| frame.origin));
    let struts = skeleton.struts.iter().flatten().map(|(_, point)| *point);
    let links = (0..skeleton.links.len()).flat_map(|link| corners(skeleton, link));
    joints.chain(struts).chain(links)
}

/// A free joint is no part of a machine.
fn is_drawn(joint: &PlacedJoint) -> bool {
    !matches!(joint.joint, Joint::Free)
}

fn slides(joint: &Joint) -> bool {
    matches!(
        joint,
        Joint::Prismatic { .. } | Joint::Screw { .. } | Joint::Cylindrical { .. } | Joint::Planar { .. }
    )
}

/// Corners of a link: its joints and ends of struts, and its centre where these are one point only.
fn corners(skeleton: &Skeleton, link: usize) -> Vec<Vector3<f64>> {
    let mut corners: Vec<Vector3<f64>> = Vec::new();
    for joint in skeleton.joints.iter().filter(|j| is_drawn(j)) {
        let sides = joint.links.iter().zip(&joint.frames);
        corners.extend(
            sides
                .filter(|(side, _)| **side == Some(link))
                .map(|(_, frame)| frame.origin),
        );
    }
    let ends = skeleton.struts.iter().flatten();
    corners.extend(ends.filter(|(side, _)| *side == Some(link)).map(|(_, point)| *point));
    let first = corners.first().copied();
    let one_point = first.is_some_and(|first| corners.iter().all(|p| (p - first).norm() < 1e-9));
    if one_point {
        corners.extend(skeleton.links[link].centre);
    }
    corners
}

/// From points of the ground's axes to the page.
struct Page {
    view: View,
    scale: f64,
    shift: [f64; 2],
}

impl Page {
    fn new(view: View, skeleton: &Skeleton) -> Self {
        let seen: Vec<[f64; 2]> = points(skeleton).map(|p| view.see(p)).collect();
        let range = |k: usize| {
            let range = seen.iter().map(|p| p[k]);
            range.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            })
        };
        let (x, y) = (range(0), range(1));
        let fit = |(low, high): (f64, f64), size: f64| (size - 2.0 * MARGIN) / (high - low);
        let scale = fit(x, SIZE[0]).min(fit(y, SIZE[1]));
        // One point, or none.
        let scale = if scale.is_finite() { scale } else { 1.0 };
        let middle = |(low, high): (f64, f64)| if low <= high { 0.5 * (low + high) } else { 0.0 };
        Self {
            view,
            scale,
            shift: [0.5 * SIZE[0] - scale * middle(x), 0.5 * SIZE[1] + scale * middle(y)],
        }
    }

    fn place(&self, point: Vector3<f64>) -> [f64; 2] {
        let [x, y] = self.view.see(point);
        [self.shift[0] + self.scale * x, self.shift[1] - self.scale * y]
    }

    /// A direction, shorter than one where it points to the eye or away.
    fn direction(&self, direction: Vector3<f64>) -> [f64; 2] {
        let [x, y] = self.view.see(direction);
        [x, -y]
    }
}

/// The picture as SVG.
fn picture(prepared: &Prepared) -> String {
    let linkage = &prepared.scene.linkage;
    let skeleton = linkage.skeleton(&prepared.mechanism, &prepared.start.q);
    let page = Page::new(View::of(&skeleton, Vector3::from(linkage.gravity())), &skeleton);
    let mut ground = Group::new();
    for joint in skeleton.joints.iter().filter(|j| is_drawn(j)) {
        let [one, two] = joint.frames.map(|frame| page.place(frame.origin));
        match joint.links {
            // What slides on the ground stands on it wherever it is.
            [None, _] if slides(&joint.joint) => ground = ground.add(symbols::ground(two)),
            [None, _] => ground = ground.add(symbols::ground(one)),
            [_, None] => ground = ground.add(symbols::ground(two)),
            _ => {}
        }
    }
    for (_, end) in skeleton.struts.iter().flatten().filter(|(link, _)| link.is_none()) {
        ground = ground.add(symbols::ground(page.place(*end)));
    }
    let mut links = Group::new();
    for (k, link) in skeleton.links.iter().enumerate() {
        let seen: Vec<[f64; 2]> = corners(&skeleton, k).into_iter().map(|p| page.place(p)).collect();
        let colour = COLOURS[k % COLOURS.len()];
        links = links.add(symbols::link(&seen, colour).add(Title::new(link.name.as_str())));
        let joints = skeleton
            .joints
            .iter()
            .filter(|j| is_drawn(j) && j.links.contains(&Some(k)));
        if let (1, Some(centre)) = (joints.count(), link.centre) {
            links = links.add(symbols::mass(page.place(centre), colour));
        }
    }
    let mut struts = Group::new();
    for ends in &skeleton.struts {
        struts = struts.add(symbols::spring(ends.map(|(_, end)| page.place(end))));
    }
    let mut joints = Group::new();
    for joint in skeleton.joints.iter().filter(|j| is_drawn(j)) {
        let [one, two] = joint.frames.map(|frame| page.place(frame.origin));
        let places = [if joint.links[0].is_none() { two } else { one }, two];
        let along = |axis: Vector3<f64>| page.direction(joint.frames[0].rotation * axis);
        joints = joints.add(symbols::joint(&joint.joint, places, along).add(Title::new(joint.name.as_str())));
    }
    let white = Rectangle::new()
        .set("width", SIZE[0])
        .set("height", SIZE[1])
        .set("fill", "#ffffff");
    let document = Document::new()
        .set("width", SIZE[0])
        .set("height", SIZE[1])
        .set("viewBox", (0, 0, SIZE[0], SIZE[1]))
        .set("role", "img")
        .add(Title::new(prepared.scene.name.as_str()))
        .add(white);
    document.add(ground).add(links).add(struts).add(joints).to_string()
}
