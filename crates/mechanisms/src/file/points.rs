//! What acts between or on points in a scene file: forces, moments, struts; and the stops of joints: their format, and how they are read.

use super::contact::ContactItem;
use super::fault::Faults;
use super::format::{DriveItem, MountItem, SceneFile};
use super::joints::mount;
use super::links::Links;
use super::loads;
use super::quantity::Quantity;
use crate::limit::Limit;
use crate::linkage::Linkage;
use crate::point_load::{Axes, PointLoad};
use crate::strut::Strut;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::HashSet;

/// Stops at one or both ends of a coordinate's way, with contact beyond them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimitItem {
    /// Where the coordinate meets the lower stop \[rad, m\], angles also as texts like `"30 deg"`; none unless given.
    pub lower: Option<Quantity>,
    /// Where it meets the upper stop \[rad, m\]; none unless given.
    pub upper: Option<Quantity>,
    /// Force over penetration.
    pub contact: ContactItem,
}

/// A force on a point of a link, or a moment on a link.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointLoadItem {
    /// The link, and its point.
    pub at: MountItem,
    /// Direction, of any length but zero.
    pub direction: [f64; 3],
    /// In whose axes the direction stays fixed; the ground's unless given.
    #[serde(default)]
    pub axes: AxesItem,
    /// Size along the direction; drives add up. Resistances see the point's speed along it, for a moment the angular velocity about it.
    pub drives: Vec<DriveItem>,
}

/// What a direction is fixed in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AxesItem {
    /// The ground.
    #[default]
    Ground,
    /// The frame `at` on the link, with which the direction turns.
    Link,
}

/// A spring with a damper between two points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrutItem {
    /// One end; the ground's origin unless given.
    #[serde(default)]
    pub from: MountItem,
    /// The other end; the ground's origin unless given.
    #[serde(default)]
    pub to: MountItem,
    /// Distance of the ends at which it is relaxed \[m\]; zero unless given.
    #[serde(default)]
    pub free_length: f64,
    /// Stiffness \[N/m\]; zero unless given.
    #[serde(default)]
    pub stiffness: f64,
    /// Damping \[N s/m\]; zero unless given.
    #[serde(default)]
    pub damping: f64,
}
/// Adds all forces, moments and struts, in the order of the file.
pub(super) fn add(file: &SceneFile, links: &Links, linkage: &mut Linkage, faults: &mut Faults<'_>) {
    let mut names = HashSet::new();
    let forces = file.forces.keys().map(|name| ("forces", name));
    let moments = file.moments.keys().map(|name| ("moments", name));
    let struts = file.struts.keys().map(|name| ("struts", name));
    for (section, name) in forces.chain(moments).chain(struts) {
        if !names.insert(name) {
            faults.add(&[section, name], format!("the name `{name}` is used twice"));
        }
    }
    for (name, item) in &file.forces {
        if let Some(force) = point_load(links, &["forces", name], item, faults) {
            linkage.force(name, force);
        }
    }
    for (name, item) in &file.moments {
        if let Some(moment) = point_load(links, &["moments", name], item, faults) {
            linkage.moment(name, moment);
        }
    }
    for (name, item) in &file.struts {
        if let Some(strut) = strut(links, name, item, faults) {
            linkage.strut(name, strut);
        }
    }
}

fn point_load(links: &Links, keys: &[&str], item: &PointLoadItem, faults: &mut Faults<'_>) -> Option<PointLoad> {
    let below = |key| [keys, &[key]].concat();
    let at = mount(links, &below("at"), &item.at, faults);
    let drives = loads::drives(&below("drives"), &item.drives, faults);
    if at.is_some_and(|at| at.link == Linkage::GROUND) {
        faults.add(&below("at"), "is on the ground, where it does nothing; give a `link`");
    }
    let length = Vector3::from(item.direction).norm();
    if !(length.is_finite() && length > 0.0) {
        let message = format!("its length {length} must be a finite positive number");
        faults.add(&below("direction"), message);
    }
    Some(PointLoad {
        at: at?,
        direction: item.direction,
        axes: match item.axes {
            AxesItem::Ground => Axes::Ground,
            AxesItem::Link => Axes::Mount,
        },
        drives,
    })
}

fn strut(links: &Links, name: &str, item: &StrutItem, faults: &mut Faults<'_>) -> Option<Strut> {
    let from = mount(links, &["struts", name, "from"], &item.from, faults);
    let to = mount(links, &["struts", name, "to"], &item.to, faults);
    let strut = Strut {
        from: from?,
        to: to?,
        free_length: item.free_length,
        stiffness: item.stiffness,
        damping: item.damping,
    };
    if strut.from.link == strut.to.link {
        faults.add(
            &["struts", name, "to"],
            "is on the same link as `from`; a strut connects two",
        );
    }
    if let Some((parameter, value, expected)) = strut.fault() {
        faults.add(
            &["struts", name, parameter],
            format!("{parameter} = {value} must be {expected}"),
        );
    }
    Some(strut)
}

/// The stops to which `keys` lead.
pub(super) fn limit(keys: &[&str], item: &LimitItem, faults: &mut Faults<'_>) -> Option<Limit> {
    let law = match item.contact.law(None) {
        Ok(law) => law,
        Err(message) => {
            faults.add(&[keys, &["contact"]].concat(), message);
            return None;
        }
    };
    let limit = Limit {
        lower: item.lower.map(|stop| stop.0),
        upper: item.upper.map(|stop| stop.0),
        law,
    };
    if let Err(error) = limit.validate() {
        faults.add(keys, error.to_string());
    }
    Some(limit)
}
