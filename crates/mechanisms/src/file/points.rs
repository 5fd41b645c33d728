//! What acts between or on points in a scene file: forces, moments, struts; and the stops of joints.

use super::fault::Faults;
use super::format::{AxesItem, ContactItem, LimitItem, PointLoadItem, SceneFile, StrutItem};
use super::joints::mount;
use super::loads::drive;
use crate::limit::Limit;
use crate::linkage::Linkage;
use crate::point_load::{Axes, PointLoad};
use crate::strut::Strut;
use linkdyn_contact::{ContactLaw, Damping, KelvinVoigt, NormalLaw, ParameterError, RestitutionLaw};
use std::collections::HashSet;

/// Adds all forces, moments and struts, in the order of the file.
pub(super) fn add(file: &SceneFile, linkage: &mut Linkage, faults: &mut Faults<'_>) {
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
        if let Some(force) = point_load(file, &["forces", name], item, faults) {
            linkage.force(name, force);
        }
    }
    for (name, item) in &file.moments {
        if let Some(moment) = point_load(file, &["moments", name], item, faults) {
            linkage.moment(name, moment);
        }
    }
    for (name, item) in &file.struts {
        if let Some(strut) = strut(file, name, item, faults) {
            linkage.strut(name, strut);
        }
    }
}

fn point_load(file: &SceneFile, keys: &[&str], item: &PointLoadItem, faults: &mut Faults<'_>) -> Option<PointLoad> {
    let at = mount(file, &[keys, &["at"]].concat(), &item.at, faults);
    let load = PointLoad {
        at: at?,
        direction: item.direction,
        axes: match item.axes {
            AxesItem::Ground => Axes::Ground,
            AxesItem::Link => Axes::Mount,
        },
        drives: item.drives.iter().map(drive).collect(),
    };
    if let Some((parameter, value, expected)) = load.fault() {
        faults.add(keys, format!("{parameter} = {value} must be {expected}"));
    }
    Some(load)
}

fn strut(file: &SceneFile, name: &str, item: &StrutItem, faults: &mut Faults<'_>) -> Option<Strut> {
    let from = mount(file, &["struts", name, "from"], &item.from, faults);
    let to = mount(file, &["struts", name, "to"], &item.to, faults);
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
    let law = match law(&item.contact) {
        Ok(law) => law,
        Err(error) => {
            faults.add(&[keys, &["contact"]].concat(), error.to_string());
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

fn law(item: &ContactItem) -> Result<ContactLaw, ParameterError> {
    Ok(match *item {
        ContactItem::Power {
            stiffness,
            exponent,
            restitution,
        } => {
            let damping = Damping::Restitution {
                law: RestitutionLaw::Exact,
                restitution,
            };
            NormalLaw::new(stiffness, exponent, damping)?.into()
        }
        ContactItem::KelvinVoigt { stiffness, damping } => KelvinVoigt { stiffness, damping }.into(),
    })
}
