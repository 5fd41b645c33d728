//! Where the joints of a linkage are at a position: what a drawing needs.

use crate::linkage::{LinkHandle, Linkage, Mount};
use crate::mechanism::Mechanism;
use crate::outline::{described, described_cut};
use linkdyn_kinematics::{Joint, Pose, Positions};
use nalgebra::Vector3;

/// A linkage at a position, in axes of the ground.
#[derive(Clone, Debug)]
pub struct Skeleton {
    /// The links.
    pub links: Vec<PlacedLink>,
    /// The joints, those of the tree first.
    pub joints: Vec<PlacedJoint>,
    /// Both ends of each strut: index of the link, `None` for the ground, and point \[m\].
    pub struts: Vec<[(Option<usize>, Vector3<f64>); 2]>,
}

/// A link at a position.
#[derive(Clone, Debug)]
pub struct PlacedLink {
    /// Its name.
    pub name: String,
    /// Its frame.
    pub frame: Pose,
    /// Its centre of mass \[m\]; none for links without mass.
    pub centre: Option<Vector3<f64>>,
}

/// A joint at a position.
#[derive(Clone, Debug)]
pub struct PlacedJoint {
    /// Its name.
    pub name: String,
    /// What it is; axes are those of its frames.
    pub joint: Joint,
    /// The same in words, with what is special about it.
    pub kind: String,
    /// Whether it has clearance.
    pub clearance: bool,
    /// Indices of predecessor and successor in [`Skeleton::links`]; `None` is the ground.
    pub links: [Option<usize>; 2],
    /// Its frame on either side.
    pub frames: [Pose; 2],
}

impl Linkage {
    /// Where everything is at the coordinates `q` of the mechanism that was built from this linkage.
    ///
    /// # Panics
    /// If `q` does not have as many numbers as the mechanism has coordinates.
    pub fn skeleton(&self, mechanism: &Mechanism, q: &[f64]) -> Skeleton {
        let tree = mechanism.system().tree();
        let mut positions = Positions::new(tree);
        tree.positions(q, &mut positions);
        let links: Vec<PlacedLink> = self
            .links
            .iter()
            .map(|(name, inertia)| {
                let at = mechanism.attachment(name);
                let frame = at.map_or_else(Pose::identity, |at| positions.pose(at.link) * at.pose);
                PlacedLink {
                    name: name.clone(),
                    frame,
                    centre: (inertia.mass > 0.0).then(|| frame.rotation * inertia.com + frame.origin),
                }
            })
            .collect();
        let frame = |link: LinkHandle| link.0.map_or_else(Pose::identity, |k| links[k].frame);
        let on = |mount: &Mount| frame(mount.link) * mount.pose;
        let place = |name: &str, joint, kind, clearance, mounts: [&Mount; 2]| PlacedJoint {
            name: name.to_owned(),
            joint,
            kind,
            clearance,
            links: mounts.map(|mount| mount.link.0),
            frames: mounts.map(on),
        };
        let carrying = self.joints.iter().map(|j| {
            let mounts = [&j.predecessor, &j.successor];
            place(&j.name, j.joint, described(j), j.clearance.is_some(), mounts)
        });
        let cut = self.cuts.iter().map(|c| {
            let mounts = [&c.predecessor, &c.successor];
            place(&c.name, c.joint, described_cut(c), c.clearance.is_some(), mounts)
        });
        let end = |mount: &Mount| (mount.link.0, on(mount).origin);
        let struts = self.struts.iter().map(|(_, strut)| [end(&strut.from), end(&strut.to)]);
        Skeleton {
            joints: carrying.chain(cut).collect(),
            struts: struts.collect(),
            links,
        }
    }

    /// Gravity \[m/s^2\] in axes of the ground.
    pub fn gravity(&self) -> [f64; 3] {
        self.gravity.into()
    }
}
