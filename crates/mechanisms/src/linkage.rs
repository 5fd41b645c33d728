//! The builder: links, joints, cut joints, drives and friction by name, in any order.

use crate::drive::{CoordinateDrives, Drive};
use crate::error::BuildError;
use crate::joint_friction::JointFriction;
use crate::mechanism::{Mechanism, NamedJoint, NamedLink, NamedLoop};
use linkdyn_dynamics::{
    Baumgarte, Description, Formulation, Load, ReactionLoad, ReactionSolver, RigidInertia, System, SystemError,
};
use linkdyn_friction::{Bearing, BearingModel, Characteristic, Friction};
use linkdyn_kinematics::{Attachment, Closure, Joint, LinkId, Pose, Tree};
use nalgebra::{Rotation3, Unit, Vector3};
use std::collections::HashSet;
use std::sync::Arc;

/// Handle of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LinkHandle(Option<usize>);

/// Handle of a joint of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct JointHandle(usize);

/// A frame on a link, where a joint sits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Mount {
    /// The link.
    pub link: LinkHandle,
    /// The joint's frame in the link's frame.
    pub pose: Pose,
}

impl Mount {
    /// The joint's frame is the link's frame.
    pub fn at_origin(link: LinkHandle) -> Self {
        Self {
            link,
            pose: Pose::identity(),
        }
    }

    /// The joint's frame lies at `point` \[m\] of the link, with the link's axes.
    pub fn at(link: LinkHandle, point: [f64; 3]) -> Self {
        Self {
            link,
            pose: Pose::translation(point[0], point[1], point[2]),
        }
    }

    /// Any frame of the link.
    pub fn with_pose(link: LinkHandle, pose: Pose) -> Self {
        Self { link, pose }
    }
}

/// Description of a linkage. Nothing is checked before [`Linkage::build`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Linkage {
    gravity: Vector3<f64>,
    links: Vec<(String, RigidInertia)>,
    joints: Vec<JointItem>,
    cuts: Vec<CutItem>,
    #[cfg_attr(feature = "serde", serde(skip))]
    loads: Vec<Arc<dyn Load>>,
    /// Whether a joint was named by a handle of another linkage.
    #[cfg_attr(feature = "serde", serde(skip))]
    foreign: bool,
    /// Drift terms, if any.
    pub baumgarte: Option<Baumgarte>,
    /// Formulation of the equations of motion.
    pub formulation: Formulation,
    /// Solver of the loop reaction - friction - acceleration.
    pub reaction_solver: ReactionSolver,
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
struct JointItem {
    name: String,
    joint: Joint,
    predecessor: Mount,
    successor: Mount,
    coordinate_names: Option<Vec<String>>,
    drives: Vec<Drive>,
    friction: Option<JointFriction>,
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
struct CutItem {
    name: String,
    joint: Joint,
    predecessor: Mount,
    successor: Mount,
}

impl Linkage {
    /// The ground.
    pub const GROUND: LinkHandle = LinkHandle(None);

    /// An empty linkage under gravity \[m/s^2\].
    pub fn new(gravity: [f64; 3]) -> Self {
        Self {
            gravity: Vector3::from(gravity),
            links: Vec::new(),
            joints: Vec::new(),
            cuts: Vec::new(),
            loads: Vec::new(),
            foreign: false,
            baumgarte: None,
            formulation: Formulation::default(),
            reaction_solver: ReactionSolver::default(),
        }
    }

    /// Adds a link with its inertia in the link's frame.
    pub fn link(&mut self, name: &str, inertia: RigidInertia) -> LinkHandle {
        self.links.push((name.to_owned(), inertia));
        LinkHandle(Some(self.links.len() - 1))
    }

    /// Adds a joint of the tree: `predecessor` lies on the side of the ground, `successor` is carried by the joint.
    pub fn joint(&mut self, name: &str, joint: Joint, predecessor: Mount, successor: Mount) -> JointHandle {
        self.joints.push(JointItem {
            name: name.to_owned(),
            joint,
            predecessor,
            successor,
            coordinate_names: None,
            drives: Vec::new(),
            friction: None,
        });
        JointHandle(self.joints.len() - 1)
    }

    /// Adds a cut joint: it closes a loop by equations, its multipliers act with + on the predecessor.
    pub fn cut(&mut self, name: &str, joint: Joint, predecessor: Mount, successor: Mount) {
        self.cuts.push(CutItem {
            name: name.to_owned(),
            joint,
            predecessor,
            successor,
        });
    }

    /// Names the coordinates of a joint. Without this a single coordinate has the joint's name, several are called
    /// `JOINT.psi` and so on, see [`Joint::coordinate_names`].
    pub fn coordinate_names(&mut self, joint: JointHandle, names: &[&str]) -> &mut Self {
        let names = names.iter().map(|&name| name.to_owned()).collect();
        self.on(joint, |item| item.coordinate_names = Some(names));
        self
    }

    /// Adds a drive or resistance to a joint with one coordinate; several add up.
    pub fn drive(&mut self, joint: JointHandle, drive: Drive) -> &mut Self {
        self.on(joint, |item| item.drives.push(drive));
        self
    }

    /// Puts friction into a revolute or prismatic joint: a characteristic over the joint's speed, and the bearing that
    /// turns the joint's reaction into friction. The bearing's z axis is the joint's axis.
    pub fn friction(
        &mut self,
        joint: JointHandle,
        characteristic: impl Into<Friction>,
        bearing: impl Into<Bearing>,
    ) -> &mut Self {
        let friction = JointFriction {
            characteristic: characteristic.into(),
            bearing: bearing.into(),
        };
        self.on(joint, |item| item.friction = Some(friction));
        self
    }

    /// Changes a joint; a handle that this linkage did not give out is remembered for [`Linkage::build`] to refuse.
    fn on(&mut self, joint: JointHandle, change: impl FnOnce(&mut JointItem)) {
        match self.joints.get_mut(joint.0) {
            Some(item) => change(item),
            None => self.foreign = true,
        }
    }

    /// Adds any other load.
    pub fn load(&mut self, load: impl Load + 'static) -> &mut Self {
        self.loads.push(Arc::new(load));
        self
    }

    /// Checks everything and sets up the equations of motion.
    ///
    /// # Errors
    /// [`BuildError`] that names the item, its value and what would be right.
    pub fn build(&self) -> Result<Mechanism, BuildError> {
        self.check_names()?;
        self.check_items()?;
        let placed = self.place()?;

        let (mut coordinates, mut speeds) = (Vec::new(), Vec::new());
        let mut joints = Vec::new();
        let mut loads: Vec<Arc<dyn Load>> = Vec::new();
        let mut reaction_loads: Vec<(LinkId, Arc<dyn ReactionLoad>)> = Vec::new();
        for (&index, &node) in placed.order.iter().zip(&placed.nodes) {
            let item = &self.joints[index];
            let (q, v) = (placed.tree.coordinate_range(node), placed.tree.speed_range(node));
            if !item.drives.is_empty() {
                loads.push(Arc::new(CoordinateDrives {
                    coordinate: q.start,
                    speed: v.start,
                    drives: item.drives.clone(),
                }));
            }
            if let Some(friction) = &item.friction {
                reaction_loads.push((node, Arc::new(friction.clone())));
            }
            coordinates.extend(item.coordinates());
            speeds.extend(item.speeds());
            joints.push(NamedJoint {
                name: item.name.clone(),
                link: node,
                to_link: item.successor_frame().inverse(),
                speed: v.start,
                has_friction: item.friction.is_some(),
            });
        }
        loads.extend(self.loads.iter().cloned());

        let attach = |mount: &Mount| placed.attachment(mount);
        let closures = self.cuts.iter().map(|cut| {
            Closure::new(
                &placed.tree,
                attach(&cut.predecessor),
                attach(&cut.successor),
                &cut.joint,
            )
        });
        let closures: Vec<Closure> = closures.collect();
        let loops = self.cuts.iter().zip(&closures).map(|(cut, closure)| NamedLoop {
            name: cut.name.clone(),
            components: closure.component_names(),
        });
        let loops = loops.collect();
        let inertias = placed.order.iter().map(|&index| {
            let item = &self.joints[index];
            let (_, inertia) = &self.links[item.successor.link.0.unwrap_or_default()];
            inertia.moved(&item.successor_frame().inverse())
        });
        let links = self.links.iter().enumerate().map(|(k, (name, _))| NamedLink {
            name: name.clone(),
            frame: placed.frames[k],
        });
        let description = Description {
            inertias: inertias.collect(),
            closures,
            loads,
            reaction_loads,
            baumgarte: self.baumgarte,
            formulation: self.formulation,
            reaction_solver: self.reaction_solver,
            ..Description::new(placed.tree.clone(), Vec::new(), self.gravity)
        };
        let system = System::new(description).map_err(|error| self.name_link(error, &placed))?;
        Ok(Mechanism {
            system: Arc::new(system),
            links: links.collect(),
            joints,
            loops,
            coordinates,
            speeds,
        })
    }

    fn check_names(&self) -> Result<(), BuildError> {
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
        Ok(())
    }

    fn check_items(&self) -> Result<(), BuildError> {
        if self.foreign {
            return Err(BuildError::Foreign {
                what: "the handle of a joint",
                name: "drive, friction or coordinate_names".into(),
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
        self.joints.iter().try_for_each(JointItem::check)
    }

    /// Hangs the links on the ground one by one, whatever the order in which they were described.
    fn place(&self) -> Result<Placed, BuildError> {
        let mut placed = Placed {
            tree: Tree::new(),
            order: Vec::new(),
            nodes: Vec::new(),
            frames: vec![None; self.links.len()],
        };
        for (k, joint) in self.joints.iter().enumerate() {
            let carried = |other: &&JointItem| other.successor.link == joint.successor.link;
            if let Some(first) = self.joints[..k].iter().find(carried) {
                return Err(BuildError::CarriedTwice {
                    link: self.link_name(joint.successor.link),
                    first: first.name.clone(),
                    second: joint.name.clone(),
                });
            }
        }
        loop {
            let next = self.joints.iter().enumerate().find(|(k, joint)| {
                let reached = match joint.predecessor.link.0 {
                    None => true,
                    Some(link) => placed.frames[link].is_some(),
                };
                reached && !placed.order.contains(k)
            });
            let Some((k, item)) = next else { break };
            let base = placed.attachment(&Mount {
                link: item.predecessor.link,
                pose: item.predecessor_frame(),
            });
            let joint = item.aligned();
            let node = placed
                .tree
                .attach(base.link, base.pose, joint)
                .map_err(|source| BuildError::Joint {
                    joint: item.name.clone(),
                    source,
                })?;
            let frame = Attachment {
                link: node,
                pose: item.successor_frame().inverse(),
            };
            match item.successor.link.0 {
                Some(link) => placed.frames[link] = Some(frame),
                None => {
                    return Err(BuildError::CarriedTwice {
                        link: "ground".into(),
                        first: "the ground itself".into(),
                        second: item.name.clone(),
                    });
                }
            }
            placed.order.push(k);
            placed.nodes.push(node);
        }
        match placed.frames.iter().position(Option::is_none) {
            Some(link) => Err(BuildError::Disconnected {
                link: self.links[link].0.clone(),
            }),
            None => Ok(placed),
        }
    }

    fn link_name(&self, link: LinkHandle) -> String {
        link.0.map_or_else(|| "ground".to_owned(), |k| self.links[k].0.clone())
    }

    fn name_link(&self, error: SystemError, placed: &Placed) -> BuildError {
        match error {
            SystemError::Inertia { link, source } => BuildError::Inertia {
                link: self.link_name(self.joints[placed.order[link]].successor.link),
                source,
            },
            other => BuildError::System(other),
        }
    }
}

/// The tree as far as it has grown.
struct Placed {
    tree: Tree,
    /// Joints in the order in which they were attached.
    order: Vec<usize>,
    /// Their nodes.
    nodes: Vec<LinkId>,
    /// Frames of the links on the tree's nodes.
    frames: Vec<Option<Attachment>>,
}

impl Placed {
    fn attachment(&self, mount: &Mount) -> Attachment {
        let ground = Attachment {
            link: LinkId::GROUND,
            pose: Pose::identity(),
        };
        let frame = mount.link.0.and_then(|k| self.frames[k]).unwrap_or(ground);
        Attachment {
            link: frame.link,
            pose: frame.pose * mount.pose,
        }
    }
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
        ];
        if let Some((_, what)) = needs_one.into_iter().find(|(there, _)| *there && coordinates != 1) {
            return Err(BuildError::NotOneCoordinate {
                what,
                joint: joint(),
                coordinates,
            });
        }
        if let Some((parameter, value, expected)) = self.drives.iter().find_map(Drive::fault) {
            return Err(BuildError::Parameter {
                joint: joint(),
                parameter,
                value,
                expected,
            });
        }
        if let Some(friction) = &self.friction {
            let checked = friction
                .characteristic
                .validate()
                .and_then(|()| friction.bearing.validate());
            checked.map_err(|source| BuildError::Friction { joint: joint(), source })?;
        }
        Ok(())
    }

    fn coordinates(&self) -> Vec<String> {
        self.coordinate_names
            .clone()
            .unwrap_or_else(|| self.qualified(self.joint.coordinate_names()))
    }

    /// Speeds have the names of their coordinates wherever they are their rates.
    fn speeds(&self) -> Vec<String> {
        if self.joint.coordinates() == self.joint.speeds() {
            self.coordinates()
        } else {
            self.qualified(self.joint.speed_names())
        }
    }

    fn qualified(&self, local: &[&str]) -> Vec<String> {
        match local {
            [_] => vec![self.name.clone()],
            _ => local.iter().map(|name| format!("{}.{name}", self.name)).collect(),
        }
    }

    /// The turn that takes z to the joint's axis. Joints with one axis are built along z of their frames, so that the axes
    /// of a bearing are those of the node.
    fn alignment(&self) -> Pose {
        let (Joint::Revolute { axis } | Joint::Prismatic { axis }) = &self.joint else {
            return Pose::identity();
        };
        let about_x = || Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
        let turn = Rotation3::rotation_between(&Vector3::z(), axis).unwrap_or_else(about_x);
        Pose {
            rotation: *turn.matrix(),
            origin: Vector3::zeros(),
        }
    }

    fn aligned(&self) -> Joint {
        let z: Unit<Vector3<f64>> = Vector3::z_axis();
        match self.joint {
            Joint::Revolute { .. } => Joint::Revolute { axis: z },
            Joint::Prismatic { .. } => Joint::Prismatic { axis: z },
            other => other,
        }
    }

    fn predecessor_frame(&self) -> Pose {
        self.predecessor.pose * self.alignment()
    }

    fn successor_frame(&self) -> Pose {
        self.successor.pose * self.alignment()
    }
}
