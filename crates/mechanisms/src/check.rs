//! What a description must not have: names used twice, frames that are no poses, parameters out of range.

use crate::clearance::Clearance;
use crate::drive::Drive;
use crate::error::BuildError;
use crate::linkage::{CutItem, JointItem, Linkage, Mount};
use crate::outline;
use crate::point_load::Acts;
use crate::prescribed::PrescribedMotion;
use crate::spring::Spring;
use linkdyn_friction::{BearingModel, Characteristic};
use linkdyn_kinematics::Joint;
use std::collections::HashSet;

impl Linkage {
    pub(crate) fn check_names(&self) -> Result<(), BuildError> {
        let mut seen = HashSet::new();
        let links = self.links.iter().map(|(name, _)| name);
        let joints = self.joints.iter().map(|joint| &joint.name);
        let cuts = self.cuts.iter().map(|cut| &cut.name);
        for group in [links.collect::<Vec<_>>(), joints.chain(cuts).collect()] {
            seen.clear();
            for name in group {
                if !seen.insert(name.clone()) {
                    return Err(BuildError::DuplicateName { name: name.clone() });
                }
            }
        }
        seen.clear();
        for joint in &self.joints {
            for coordinate in joint.coordinates() {
                if !seen.insert(coordinate.clone()) {
                    return Err(BuildError::DuplicateName { name: coordinate });
                }
            }
        }
        seen.clear();
        for (_, name) in self.contact_points() {
            if !seen.insert(name.clone()) {
                return Err(BuildError::DuplicateName { name });
            }
        }
        seen.clear();
        let loads = self.point_loads.iter().map(|(name, ..)| name);
        for name in loads.chain(self.struts.iter().map(|(name, _)| name)) {
            if !seen.insert(name.clone()) {
                return Err(BuildError::DuplicateName { name: name.clone() });
            }
        }
        Ok(())
    }

    /// Names of the contact points of limits and clearances, each behind its joint's.
    pub(crate) fn contact_points(&self) -> impl Iterator<Item = (&str, String)> {
        let joints = self.joints.iter().map(|joint| (joint.name.as_str(), &joint.clearance));
        let cuts = self.cuts.iter().map(|cut| (cut.name.as_str(), &cut.clearance));
        let with_clearance = joints
            .chain(cuts)
            .filter_map(|(name, clearance)| Some((name, clearance.as_ref()?)));
        let with_limit = self.joints.iter();
        let with_limit = with_limit.filter_map(|joint| Some((joint.name.as_str(), joint.limit.as_ref()?)));
        let in_limits = with_limit.flat_map(|(joint, limit)| limit.point_names(joint).map(move |name| (joint, name)));
        let in_clearances = with_clearance
            .flat_map(|(joint, clearance)| clearance.model.point_names(joint).map(move |name| (joint, name)));
        in_limits.chain(in_clearances)
    }

    pub(crate) fn check_items(&self) -> Result<(), BuildError> {
        if self.foreign {
            return Err(BuildError::Foreign {
                what: "the handle of a joint",
                name: "drive, springs, friction, limit, prescribe, coordinate_names or clearance".into(),
            });
        }
        for (name, inertia) in &self.links {
            let link = name.clone();
            inertia
                .validate()
                .map_err(|source| BuildError::Inertia { link, source })?;
        }
        let joints = self
            .joints
            .iter()
            .map(|j| (&j.name, &j.joint, &j.predecessor, &j.successor));
        let cuts = self
            .cuts
            .iter()
            .map(|c| (&c.name, &c.joint, &c.predecessor, &c.successor));
        for (name, joint, predecessor, successor) in joints.chain(cuts) {
            joint.validate().map_err(|source| BuildError::Joint {
                joint: name.clone(),
                source,
            })?;
            for (side, mount) in [("predecessor", predecessor), ("successor", successor)] {
                if mount.link.0.is_some_and(|k| k >= self.links.len()) {
                    let name = name.clone();
                    return Err(BuildError::Foreign { what: side, name });
                }
                let defect = mount.pose.defect();
                if defect.is_nan() || defect > 1e-9 {
                    let joint = name.clone();
                    return Err(BuildError::Mount { joint, side, defect });
                }
            }
            if predecessor.link == successor.link {
                return Err(BuildError::SelfJoint {
                    joint: name.clone(),
                    link: self.link_name(successor.link),
                });
            }
        }
        self.cuts.iter().try_for_each(CutItem::check)?;
        self.joints.iter().try_for_each(JointItem::check)?;
        self.check_loads()
    }

    /// Forces, moments and struts.
    fn check_loads(&self) -> Result<(), BuildError> {
        let refuse = |what, name: &str, (parameter, value, expected)| {
            let name = name.to_owned();
            Err(BuildError::Load {
                what,
                name,
                parameter,
                value,
                expected,
            })
        };
        let place = |what, name: &str, at: &Mount| {
            if at.link.0.is_some_and(|k| k >= self.links.len()) {
                let name = name.to_owned();
                return Err(BuildError::Foreign { what: "a link", name });
            }
            let defect = at.pose.defect();
            if defect.is_nan() || defect > 1e-9 {
                return refuse(what, name, ("error of its frame", defect, "zero, that of a rigid pose"));
            }
            Ok(())
        };
        for (name, acts, load) in &self.point_loads {
            let what = match acts {
                Acts::Force => "force",
                Acts::Moment => "moment",
            };
            place(what, name, &load.at)?;
            if let Some(fault) = load.fault() {
                return refuse(what, name, fault);
            }
        }
        for (name, strut) in &self.struts {
            place("strut", name, &strut.from)?;
            place("strut", name, &strut.to)?;
            if strut.from.link == strut.to.link {
                return Err(BuildError::SelfStrut {
                    strut: name.clone(),
                    link: self.link_name(strut.from.link),
                });
            }
            if let Some(fault) = strut.fault() {
                return refuse("strut", name, fault);
            }
        }
        Ok(())
    }
}

impl CutItem {
    fn check(&self) -> Result<(), BuildError> {
        if let Some(row) = self.rows.iter().flatten().position(|row| !row.is_sound()) {
            let joint = self.name.clone();
            return Err(BuildError::Row { joint, row });
        }
        check_clearance(&self.name, &self.joint, self.clearance.as_ref())
    }
}

fn check_clearance(name: &str, joint: &Joint, clearance: Option<&Clearance>) -> Result<(), BuildError> {
    let Some(clearance) = clearance else {
        return Ok(());
    };
    if !clearance.model.fits(joint) {
        return Err(BuildError::ClearanceKind {
            joint: name.to_owned(),
            kind: outline::kind(joint),
            model: clearance.model.name(),
        });
    }
    clearance.validate().map_err(|source| BuildError::Clearance {
        joint: name.to_owned(),
        source,
    })
}

impl JointItem {
    fn check(&self) -> Result<(), BuildError> {
        let joint = || self.name.clone();
        let coordinates = self.joint.coordinates();
        if let Some(names) = &self.coordinate_names
            && names.len() != coordinates
        {
            return Err(BuildError::CoordinateNames {
                joint: joint(),
                expected: coordinates,
                found: names.len(),
            });
        }
        let needs_one = [
            (!self.drives.is_empty(), "a drive"),
            (self.friction.is_some(), "friction"),
            (self.prescribed.is_some(), "a prescribed motion"),
            (self.limit.is_some(), "a limit"),
        ];
        if let Some((_, what)) = needs_one.into_iter().find(|(there, _)| *there && coordinates != 1) {
            return Err(BuildError::NotOneCoordinate {
                what,
                joint: joint(),
                coordinates,
            });
        }
        if !self.springs.is_empty() && (self.springs.len() != coordinates || self.joint.speeds() != coordinates) {
            return Err(BuildError::Springs {
                joint: joint(),
                coordinates,
                speeds: self.joint.speeds(),
                found: self.springs.len(),
            });
        }
        let faults = self.drives.iter().filter_map(Drive::fault);
        let faults = faults.chain(self.springs.iter().filter_map(Spring::fault));
        let mut faults = faults.chain(self.prescribed.iter().filter_map(PrescribedMotion::fault));
        if let Some((parameter, value, expected)) = faults.next() {
            return Err(BuildError::Parameter {
                joint: joint(),
                parameter,
                value,
                expected,
            });
        }
        if let Some(limit) = &self.limit {
            let checked = limit.validate();
            checked.map_err(|source| BuildError::Limit { joint: joint(), source })?;
        }
        check_clearance(&self.name, &self.joint, self.clearance.as_ref())?;
        if let Some(friction) = &self.friction {
            if self.clearance.is_some() {
                return Err(BuildError::FrictionWithClearance { joint: joint() });
            }
            let checked = friction
                .characteristic
                .validate()
                .and_then(|()| friction.bearing.validate());
            checked.map_err(|source| BuildError::Friction { joint: joint(), source })?;
        }
        Ok(())
    }
}
