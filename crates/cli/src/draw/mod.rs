//! `linkdyn draw`: a linkage at its start as a line drawing. Links are bars or plates between their joints, a joint has the symbol of its
//! kind, the ground is hatched; spatial linkages are looked at from where least is hidden.

mod labels;
mod page;
mod shape;
mod symbols;
mod view;

use std::fs;

use linkdyn_mechanisms::{PlacedJoint, Skeleton};
use nalgebra::Vector3;
use svg::Document;
use svg::node::element::{Group, Rectangle, Title};

use crate::args::DrawArgs;
use crate::errors::CliError;
use crate::figure::{FONT, clean, svg_to_png};
use crate::output;
use crate::run::{Prepared, ready};
use crate::scenes::{self, Variant};
use labels::Taken;
use page::{Page, SIZE, Spot, crossing, length};
use shape::{corners, heavy_end, is_drawn, place, slides};
use symbols::{INK, RADIUS};

/// Pixels of a PNG for one of the picture.
const PNG_SCALE: f64 = 2.0;
/// Colours of the links one after the other; told apart by colour-blind readers.
const COLOURS: [&str; 6] = ["#1b5ea8", "#d1451b", "#1d845b", "#7d3c98", "#b07d00", "#4a4a4a"];
/// Half the width and height of the axes in the corner, with the letters and the arrow of gravity.
const AXES: [f64; 2] = [40.0, 28.0];

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
    let variant = Variant::new(&args.variant, false);
    let prepared = ready(scenes::find(&args.scene)?.scene(&variant)?)?;
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

/// What is drawn, and where.
struct Sketch<'a> {
    skeleton: &'a Skeleton,
    page: Page,
    /// What names must not cover.
    taken: Taken,
}

fn colour(link: usize) -> &'static str {
    COLOURS[link % COLOURS.len()]
}

fn title(text: &str) -> Title {
    Title::new(clean(text))
}

impl<'a> Sketch<'a> {
    fn joints(&self) -> impl Iterator<Item = &'a PlacedJoint> + use<'a> {
        self.skeleton.joints.iter().filter(|j| is_drawn(j))
    }

    fn at(&self, joint: &PlacedJoint) -> [f64; 2] {
        self.page.place(place(self.skeleton, joint))
    }

    /// Brackets and beds, and in space the lines between them.
    fn ground(&mut self, is_planar: bool) -> Group {
        let mut symbols = Group::new();
        let mut feet: Vec<Spot> = Vec::new();
        let held = self.joints().filter(|joint| joint.links.contains(&None));
        let ends = self.skeleton.struts.iter().flatten().filter(|(link, _)| link.is_none());
        let joints = held.map(|joint| (place(self.skeleton, joint), Some(joint)));
        for (point, joint) in joints.chain(ends.map(|(_, end)| (*end, None))) {
            let foot = self.page.spot(point);
            let at = [foot[0], foot[1]];
            if feet.iter().any(|other| length(at, [other[0], other[1]]) < 1.0) {
                continue;
            }
            feet.push(foot);
            let slide = joint.and_then(|joint| Some(joint.frames[0].rotation * shape::axis(&joint.joint)?));
            match slide.and_then(|axis| symbols::bed(at, self.page.direction(axis))) {
                Some((bed, edge)) => {
                    symbols = symbols.add(bed);
                    self.taken.lines.push(edge);
                }
                None => {
                    symbols = symbols.add(symbols::ground(at));
                    self.taken.discs.push(([at[0], at[1] + 14.0], 13.0));
                }
            }
        }
        if is_planar || feet.len() < 2 {
            return symbols;
        }
        let (base, edges) = symbols::base(&feet);
        self.taken.lines.extend(edges);
        Group::new().add(base).add(symbols)
    }

    /// Bars and plates; where one crosses another the nearer one is whole. Their edges become obstacles.
    fn links(&mut self) -> Group {
        let mut group = Group::new();
        let mut edges: Vec<(usize, [Spot; 2])> = Vec::new();
        for (k, link) in self.skeleton.links.iter().enumerate() {
            let seen: Vec<Spot> = corners(self.skeleton, k)
                .into_iter()
                .map(|p| self.page.spot(p))
                .collect();
            let (shape, own) = symbols::link(&seen, colour(k));
            group = group.add(shape.add(title(&link.name)));
            edges.extend(own.into_iter().map(|edge| (k, edge)));
        }
        for (k, (one, first)) in edges.iter().enumerate() {
            for (two, second) in &edges[..k] {
                if let (true, Some((at, first_is_nearer))) = (one != two, crossing(*first, *second)) {
                    let (link, edge) = if first_is_nearer {
                        (*one, *first)
                    } else {
                        (*two, *second)
                    };
                    group = group.add(symbols::bridge(at, edge, colour(link)));
                }
            }
        }
        for k in 0..self.skeleton.links.len() {
            if let Some(centre) = heavy_end(self.skeleton, k) {
                let at = self.page.place(centre);
                group = group.add(symbols::mass(at, colour(k)));
                self.taken.discs.push((at, symbols::MASS));
            }
        }
        self.taken.lines.extend(edges.into_iter().map(|(_, edge)| edge));
        group
    }

    fn struts(&mut self) -> Group {
        let mut group = Group::new();
        for ends in &self.skeleton.struts {
            let ends = ends.map(|(_, end)| self.page.spot(end));
            group = group.add(symbols::spring(ends.map(|end| [end[0], end[1]])));
            // As wide as the teeth are.
            let way = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
            let size = f64::hypot(way[0], way[1]).max(1.0);
            for side in [-8.0, 0.0, 8.0] {
                let aside = [-side * way[1] / size, side * way[0] / size, 0.0];
                self.taken
                    .lines
                    .push(ends.map(|end| [0, 1, 2].map(|k| end[k] + aside[k])));
            }
        }
        group
    }

    fn joint_symbols(&mut self) -> Group {
        let mut group = Group::new();
        // Blocks below what sits on them.
        let (blocks, others): (Vec<_>, Vec<_>) = self.joints().partition(|joint| slides(&joint.joint));
        for joint in blocks.into_iter().chain(others) {
            let at = self.at(joint);
            let along = |axis: Vector3<f64>| self.page.direction(joint.frames[0].rotation * axis);
            let successor = joint.links[1].or(joint.links[0]).map_or(INK, colour);
            let mut symbol = symbols::joint(&joint.joint, at, along, successor);
            if joint.clearance {
                symbol = symbol.add(symbols::gap(at));
            }
            group = group.add(symbol.add(title(&format!("{} ({})", joint.name, joint.kind))));
            self.taken.discs.push((at, RADIUS + 3.0));
        }
        group
    }

    /// Which axes are seen, and where gravity points.
    fn axes(&mut self, gravity: Vector3<f64>) -> Group {
        let middle = self.taken.corner(AXES);
        let mut group = Group::new();
        let seen = [(Vector3::x(), "x"), (Vector3::y(), "y"), (Vector3::z(), "z")];
        let seen = seen.map(|(axis, name)| (self.page.direction(axis), name));
        let seen: Vec<_> = seen.iter().filter(|([x, y, _], _)| f64::hypot(*x, *y) > 0.1).collect();
        // Letters stand beyond the tips; all of it is put in the middle of the left part.
        let letter = |[x, y, _]: &Spot, k: usize| [x, y][k] * (20.0 + 8.0 / f64::hypot(*x, *y));
        let from = [0, 1].map(|k| {
            let places = seen.iter().map(|(axis, _)| letter(axis, k));
            let (low, high) = places.fold((0.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
            middle[k] - 0.5 * (low + high) - if k == 0 { 9.0 } else { 0.0 }
        });
        for (axis, name) in seen {
            let at = [0, 1].map(|k| from[k] + letter(axis, k));
            let arrow = symbols::arrow(from, [20.0 * axis[0], 20.0 * axis[1]]);
            group = group.add(arrow).add(labels::letters(name, at, INK));
        }
        if let Some(down) = gravity.try_normalize(1e-9) {
            let [x, y, _] = self.page.direction(down);
            let from = [middle[0] + AXES[0] - 5.0, middle[1] - 10.0 * y];
            group = group
                .add(symbols::arrow(from, [20.0 * x, 20.0 * y]))
                .add(labels::letters("g", [from[0] - 8.0, from[1] + 8.0 * y], INK));
        }
        group
    }

    /// Names of joints in ink and of links in their colours, those of joints in one place together.
    fn names(&mut self) -> Group {
        let mut group = Group::new();
        let mut there: Vec<([f64; 2], String)> = Vec::new();
        for joint in self.joints() {
            let at = self.at(joint);
            let clearance = if joint.clearance { " (clearance)" } else { "" };
            let name = format!("{}{clearance}", joint.name);
            match there.iter_mut().find(|(other, _)| length(*other, at) < 1.0) {
                Some((_, names)) => *names = format!("{names}, {name}"),
                None => there.push((at, name)),
            }
        }
        for (at, names) in there {
            if let Some(text) = self.taken.around(&names, at, RADIUS + 2.0, INK) {
                group = group.add(text);
            }
        }
        for (k, link) in self.skeleton.links.iter().enumerate() {
            let seen: Vec<Spot> = corners(self.skeleton, k)
                .into_iter()
                .map(|p| self.page.spot(p))
                .collect();
            let (_, edges) = symbols::link(&seen, colour(k));
            let placed = edges
                .into_iter()
                .find_map(|edge| self.taken.along(&link.name, edge, colour(k)));
            if let Some(text) = placed {
                group = group.add(text);
            }
        }
        group
    }
}

/// The picture as SVG.
fn picture(prepared: &Prepared) -> String {
    let linkage = &prepared.scene.linkage;
    let skeleton = linkage.skeleton(&prepared.mechanism, &prepared.start.q);
    let gravity = Vector3::from(linkage.gravity());
    let mut sketch = Sketch {
        page: Page::best(&skeleton, gravity),
        skeleton: &skeleton,
        taken: Taken::default(),
    };
    let is_planar = view::View::planar(&skeleton, gravity).is_some();
    let layers = [
        sketch.ground(is_planar),
        sketch.links(),
        sketch.struts(),
        sketch.joint_symbols(),
        sketch.axes(gravity),
        sketch.names(),
    ];
    let white = Rectangle::new()
        .set("width", SIZE[0])
        .set("height", SIZE[1])
        .set("fill", "#ffffff");
    let document = Document::new()
        .set("width", SIZE[0])
        .set("height", SIZE[1])
        .set("viewBox", (0, 0, SIZE[0], SIZE[1]))
        .set("role", "img")
        .set("font-family", format!("{FONT}, Verdana, Helvetica, sans-serif"))
        .add(title(&prepared.scene.name))
        .add(white);
    let document = layers.into_iter().fold(document, |document, layer| document.add(layer));
    document.to_string()
}
