//! Machines as data: every theorem that compares two machines edits a blueprint and builds it twice.

use crate::loads::Applied;
use linkdyn_dynamics::{Description, Formulation, RigidInertia, System, Workspace};
use linkdyn_kinematics::assembly::consistent_velocities;
use linkdyn_kinematics::{Attachment, Closure, Joint, LinkId, Pose, Positions, Tree, Wrench};
use linkdyn_mechanisms::{LinkHandle, Linkage, Mount};
use nalgebra::Vector3;
use std::sync::Arc;

/// One link with the joint that carries it, its state and its loads.
#[derive(Clone, Debug)]
pub struct Part {
    /// Index of an earlier part, or the ground.
    pub parent: Option<usize>,
    /// Frame of the joint on the parent.
    pub placement: Pose,
    /// The joint.
    pub joint: Joint,
    /// Inertia of the link.
    pub inertia: RigidInertia,
    /// Coordinates of the joint.
    pub q: Vec<f64>,
    /// Speeds of the joint.
    pub v: Vec<f64>,
    /// Torques or forces applied on the joint's freedoms.
    pub drive: Vec<f64>,
    /// Wrench applied on the link at its origin, global axes.
    pub wrench: Wrench,
}

/// A cut joint between frames on two parts (or the ground).
#[derive(Clone, Debug)]
pub struct Cut {
    /// Predecessor and the frame on it.
    pub predecessor: (Option<usize>, Pose),
    /// Successor and the frame on it.
    pub successor: (Option<usize>, Pose),
    /// The joint.
    pub joint: Joint,
}

/// A machine in a state, under loads, as plain data.
#[derive(Clone, Debug)]
pub struct Blueprint {
    /// Links, parents first.
    pub parts: Vec<Part>,
    /// Cut joints.
    pub cuts: Vec<Cut>,
    /// Gravity \[m/s^2\].
    pub gravity: Vector3<f64>,
}

/// A blueprint once built.
#[derive(Clone, Debug)]
pub struct Machine {
    /// The equations of motion.
    pub system: System,
    /// Links of the parts.
    pub links: Vec<LinkId>,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Speeds.
    pub v: Vec<f64>,
}

/// The pose that a joint gives its successor at coordinates `q`.
pub fn joint_pose(joint: &Joint, q: &[f64]) -> Pose {
    let mut tree = Tree::new();
    let link = tree
        .attach(LinkId::GROUND, Pose::identity(), *joint)
        .expect("a valid joint");
    let mut positions = Positions::new(&tree);
    tree.positions(q, &mut positions);
    positions.pose(link)
}

impl Blueprint {
    /// The tree, and the links of the parts.
    pub fn tree(&self) -> (Tree, Vec<LinkId>) {
        let mut tree = Tree::new();
        let mut links = Vec::new();
        for part in &self.parts {
            let parent = link_of(&links, part.parent);
            links.push(tree.attach(parent, part.placement, part.joint).expect("a valid part"));
        }
        (tree, links)
    }

    /// Coordinates of all parts.
    pub fn coordinates(&self) -> Vec<f64> {
        self.parts.iter().flat_map(|part| part.q.clone()).collect()
    }

    /// Speeds of all parts.
    pub fn speeds(&self) -> Vec<f64> {
        self.parts.iter().flat_map(|part| part.v.clone()).collect()
    }

    /// Poses of all parts.
    pub fn poses(&self) -> Vec<Pose> {
        let (tree, links) = self.tree();
        let mut positions = Positions::new(&tree);
        tree.positions(&self.coordinates(), &mut positions);
        links.iter().map(|&link| positions.pose(link)).collect()
    }

    /// The closures of the cuts.
    pub fn closures(&self, tree: &Tree, links: &[LinkId]) -> Vec<Closure> {
        let attachment = |(part, pose): &(Option<usize>, Pose)| Attachment {
            link: link_of(links, *part),
            pose: *pose,
        };
        let closure = |cut: &Cut| {
            Closure::new(
                tree,
                attachment(&cut.predecessor),
                attachment(&cut.successor),
                &cut.joint,
            )
        };
        self.cuts.iter().map(closure).collect()
    }

    /// Adds a cut joint that is closed in this state: the frame on the successor is put where the joint, at coordinates `q`
    /// of its own, would have it.
    pub fn close(
        &mut self,
        predecessor: Option<usize>,
        frame: Pose,
        joint: Joint,
        q: &[f64],
        successor: Option<usize>,
    ) {
        let poses = self.poses();
        let pose = |part: Option<usize>| part.map_or_else(Pose::identity, |k| poses[k]);
        let target = pose(predecessor) * frame * joint_pose(&joint, q);
        self.cuts.push(Cut {
            predecessor: (predecessor, frame),
            successor: (successor, pose(successor).inverse() * target),
            joint,
        });
    }

    /// Replaces the speeds by the nearest ones that keep the cuts closed.
    pub fn make_speeds_consistent(&mut self) {
        let (tree, links) = self.tree();
        let closures = self.closures(&tree, &links);
        let held = vec![false; tree.speeds()];
        let v = consistent_velocities(&tree, &closures, &self.coordinates(), &self.speeds(), &held)
            .expect("nothing is held, so there is always a solution");
        self.set_speeds(&v);
    }

    /// Hands speeds to the parts.
    pub fn set_speeds(&mut self, mut v: &[f64]) {
        for part in &mut self.parts {
            let (own, rest) = v.split_at(part.v.len());
            part.v.copy_from_slice(own);
            v = rest;
        }
    }

    /// What a system is made of, loads included.
    pub fn description(&self) -> (Description, Vec<LinkId>) {
        let (tree, links) = self.tree();
        let loads = Applied {
            drives: self.parts.iter().flat_map(|part| part.drive.clone()).collect(),
            wrenches: links
                .iter()
                .zip(&self.parts)
                .map(|(&link, part)| (link, part.wrench))
                .collect(),
        };
        let description = Description {
            closures: self.closures(&tree, &links),
            loads: vec![Arc::new(loads)],
            ..Description::new(tree, self.parts.iter().map(|part| part.inertia).collect(), self.gravity)
        };
        (description, links)
    }

    /// The same as a linkage, without loads: links `l0`, `l1`, ... on joints `j0`, `j1`, ..., cut joints `c0`, `c1`, ... And its
    /// coordinates by name.
    pub fn linkage(&self) -> (Linkage, Vec<(String, f64)>) {
        let mut linkage = Linkage::new(self.gravity.into());
        let named = |(k, part): (usize, &Part)| linkage.link(&format!("l{k}"), part.inertia);
        let links: Vec<LinkHandle> = self.parts.iter().enumerate().map(named).collect();
        let link = |part: Option<usize>| part.map_or(Linkage::GROUND, |k| links[k]);
        let mut coordinates = Vec::new();
        for (k, part) in self.parts.iter().enumerate() {
            let name = format!("j{k}");
            let base = Mount::with_pose(link(part.parent), part.placement);
            linkage.joint(&name, part.joint, base, Mount::at_origin(links[k]));
            let local = part.joint.coordinate_names();
            coordinates.extend(local.iter().zip(&part.q).map(|(local, value)| match part.q.len() {
                1 => (name.clone(), *value),
                _ => (format!("{name}.{local}"), *value),
            }));
        }
        for (k, cut) in self.cuts.iter().enumerate() {
            let mount = |(part, pose): (Option<usize>, Pose)| Mount::with_pose(link(part), pose);
            linkage.cut(
                &format!("c{k}"),
                cut.joint,
                mount(cut.predecessor),
                mount(cut.successor),
            );
        }
        (linkage, coordinates)
    }

    /// The machine, with the given formulation of its equations.
    pub fn machine(&self, formulation: Formulation) -> Machine {
        let (mut description, links) = self.description();
        description.formulation = formulation;
        Machine {
            system: System::new(description).expect("a valid blueprint"),
            links,
            q: self.coordinates(),
            v: self.speeds(),
        }
    }
}

impl Machine {
    /// The evaluation at the machine's own state.
    pub fn evaluate(&self) -> Workspace {
        self.evaluate_at(&self.q, &self.v)
    }

    /// The evaluation at any state, at t = 0.
    pub fn evaluate_at(&self, q: &[f64], v: &[f64]) -> Workspace {
        let mut work = Workspace::new(&self.system);
        self.system
            .evaluate(0.0, q, v, &mut work)
            .expect("a regular mass matrix");
        work
    }

    /// The tree.
    pub fn tree(&self) -> &Tree {
        self.system.tree()
    }
}

fn link_of(links: &[LinkId], part: Option<usize>) -> LinkId {
    part.map_or(LinkId::GROUND, |k| links[k])
}
