//! Changes to a linkage that is already described: the same machine with other numbers. Nothing is checked before
//! [`Linkage::build`].

use crate::clearance::Clearance;
use crate::linkage::{JointHandle, LinkHandle, Linkage};
use crate::spring::Spring;
use linkdyn_dynamics::RigidInertia;
use linkdyn_friction::Friction;

impl Linkage {
    /// Inertia of a link in the link's frame; `None` for unknown names.
    pub fn inertia_mut(&mut self, link: &str) -> Option<&mut RigidInertia> {
        let found = self.links.iter_mut().find(|(name, _)| name == link);
        found.map(|(_, inertia)| inertia)
    }

    /// Handle of a link by its name; `None` for unknown names.
    pub fn link_named(&self, link: &str) -> Option<LinkHandle> {
        let found = self.links.iter().position(|(name, _)| name == link);
        found.map(|index| LinkHandle(Some(index)))
    }

    /// Handle of a joint of the tree by its name; `None` for unknown names.
    pub fn joint_named(&self, joint: &str) -> Option<JointHandle> {
        let found = self.joints.iter().position(|item| item.name == joint);
        found.map(JointHandle)
    }

    /// All springs with dampers, those of flexible links included.
    pub fn springs_mut(&mut self) -> impl Iterator<Item = &mut Spring> {
        self.joints.iter_mut().flat_map(|item| &mut item.springs)
    }

    /// Characteristics of all joint friction.
    pub fn characteristics_mut(&mut self) -> impl Iterator<Item = &mut Friction> {
        let rubbing = self.joints.iter_mut().filter_map(|item| item.friction.as_mut());
        rubbing.map(|friction| &mut friction.characteristic)
    }

    /// Clearances of all joints that have one.
    pub fn clearances_mut(&mut self) -> impl Iterator<Item = &mut Clearance> {
        let joints = self.joints.iter_mut().map(|item| &mut item.clearance);
        let cuts = self.cuts.iter_mut().map(|item| &mut item.clearance);
        joints.chain(cuts).filter_map(Option::as_mut)
    }

    /// Takes all drives and resistances away, those on points and links too.
    pub fn clear_drives(&mut self) -> &mut Self {
        for item in &mut self.joints {
            item.drives.clear();
        }
        self.point_loads.clear();
        self
    }
}
