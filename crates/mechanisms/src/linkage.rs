//! The builder: links, joints, cut joints and the loads on them by name, in any order.

use crate::clearance::{Clearance, carried};
use crate::drive::Drive;
use crate::joint_friction::JointFriction;
use crate::limit::Limit;
use crate::point_load::{Acts, PointLoad};
use crate::prescribed::PrescribedMotion;
use crate::spring::Spring;
use crate::strut::Strut;
use linkdyn_dynamics::{Baumgarte, Formulation, Load, ReactionSolver, RigidInertia};
use linkdyn_friction::{Bearing, Friction};
use linkdyn_kinematics::{Joint, Pose, Row};
use nalgebra::{Rotation3, Unit, Vector3};
use std::sync::Arc;

/// Handle of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LinkHandle(pub(crate) Option<usize>);

/// Handle of a joint of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct JointHandle(pub(crate) usize);

/// Handle of a cut joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CutHandle(pub(crate) usize);

/// A joint of either kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnyJoint {
    /// One of the tree.
    Carrying(JointHandle),
    /// One that is cut.
    Cut(CutHandle),
}

impl From<JointHandle> for AnyJoint {
    fn from(joint: JointHandle) -> Self {
        Self::Carrying(joint)
    }
}

impl From<CutHandle> for AnyJoint {
    fn from(cut: CutHandle) -> Self {
        Self::Cut(cut)
    }
}

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
    pub(crate) gravity: Vector3<f64>,
    pub(crate) links: Vec<(String, RigidInertia)>,
    pub(crate) joints: Vec<JointItem>,
    pub(crate) cuts: Vec<CutItem>,
    pub(crate) point_loads: Vec<(String, Acts, PointLoad)>,
    pub(crate) struts: Vec<(String, Strut)>,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) loads: Vec<Arc<dyn Load>>,
    /// Whether a joint was named by a handle of another linkage.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) foreign: bool,
    /// Flexible links: the name of each and its elements.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) beams: Vec<(String, Vec<LinkHandle>)>,
    /// Drift terms, if any.
    pub baumgarte: Option<Baumgarte>,
    /// Formulation of the equations of motion.
    pub formulation: Formulation,
    /// Solver of the loop reaction - friction - acceleration.
    pub reaction_solver: ReactionSolver,
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub(crate) struct JointItem {
    pub(crate) name: String,
    pub(crate) joint: Joint,
    pub(crate) predecessor: Mount,
    pub(crate) successor: Mount,
    pub(crate) coordinate_names: Option<Vec<String>>,
    pub(crate) drives: Vec<Drive>,
    pub(crate) springs: Vec<Spring>,
    pub(crate) friction: Option<JointFriction>,
    pub(crate) prescribed: Option<PrescribedMotion>,
    pub(crate) limit: Option<Limit>,
    pub(crate) clearance: Option<Clearance>,
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub(crate) struct CutItem {
    pub(crate) name: String,
    pub(crate) joint: Joint,
    pub(crate) predecessor: Mount,
    pub(crate) successor: Mount,
    pub(crate) clearance: Option<Clearance>,
    /// Equations of one's own, in place of the joint's.
    pub(crate) rows: Option<Vec<Row>>,
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
            point_loads: Vec::new(),
            struts: Vec::new(),
            loads: Vec::new(),
            foreign: false,
            beams: Vec::new(),
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
    ///
    /// Where the joints added so make no tree, [`Linkage::build`] chooses which of them are cut, as [`spanning_tree`](crate::spanning_tree)
    /// says: those with many freedoms, never one with a drive, springs, friction, a limit, prescribed motion, clearance or names of its
    /// coordinates. A joint may then carry its predecessor from the successor's side; its coordinates mean the same all the same, its
    /// reaction is that on the link it carries. [`Linkage::cut`] says it for a joint oneself. A cut joint has no coordinates: which names
    /// there are tells [`Mechanism::coordinate_names`](crate::Mechanism::coordinate_names), the tree [`Linkage::outline`].
    pub fn joint(&mut self, name: &str, joint: Joint, predecessor: Mount, successor: Mount) -> JointHandle {
        self.joints.push(JointItem {
            name: name.to_owned(),
            joint,
            predecessor,
            successor,
            coordinate_names: None,
            drives: Vec::new(),
            springs: Vec::new(),
            friction: None,
            prescribed: None,
            limit: None,
            clearance: None,
        });
        JointHandle(self.joints.len() - 1)
    }

    /// Adds a joint of one's own: joints one after the other, all at the same place, with links without mass between them. They are named
    /// `NAME.1` and so on, and each takes drives, springs, friction and the like as any other. Without joints the successor is not carried.
    pub fn chain(&mut self, name: &str, joints: &[Joint], predecessor: Mount, successor: Mount) -> Vec<JointHandle> {
        let mut before = predecessor;
        let last = joints.len().saturating_sub(1);
        let hang = |(k, joint): (usize, &Joint)| {
            let name = format!("{name}.{}", k + 1);
            let behind = if k == last {
                successor
            } else {
                Mount::at_origin(self.link(&name, RigidInertia::massless()))
            };
            self.joint(&name, *joint, std::mem::replace(&mut before, behind), behind)
        };
        joints.iter().enumerate().map(hang).collect()
    }

    /// Adds a cut joint of one's own by the equations that it keeps.
    pub fn cut_rows(&mut self, name: &str, rows: &[Row], predecessor: Mount, successor: Mount) -> CutHandle {
        let handle = self.cut(name, Joint::Free, predecessor, successor);
        self.cuts[handle.0].rows = Some(rows.to_vec());
        handle
    }

    /// Adds a joint that is cut: it closes a loop by equations, its multipliers act with + on the predecessor.
    pub fn cut(&mut self, name: &str, joint: Joint, predecessor: Mount, successor: Mount) -> CutHandle {
        self.cuts.push(CutItem {
            name: name.to_owned(),
            joint,
            predecessor,
            successor,
            clearance: None,
            rows: None,
        });
        CutHandle(self.cuts.len() - 1)
    }

    /// Gives a revolute or spherical joint clearance, and a contact. A cut joint loses equations. A joint of the tree gets coordinates
    /// before its own: `JOINT.x` and `JOINT.y`, for a ball `JOINT.z` too, the place of the successor's frame in that of the
    /// predecessor \[m\] (turned so that z is the axis of a revolute joint). Its own are called as ever, but:
    ///
    /// * with spatial clearance the tilts `JOINT.theta` and `JOINT.phi` stand behind the turn, which is one about the predecessor's
    ///   axis (turns about z, y, x; drives and springs act on the first);
    /// * of a ball joint with a quaternion they are `JOINT.qw`, `JOINT.qx`, `JOINT.qy`, `JOINT.qz`, unless named.
    ///
    /// A start is assembled with the journal in the middle of its bearing; coordinates that clearance adds to the tree may be given
    /// other values there, and are held.
    pub fn clearance(&mut self, joint: impl Into<AnyJoint>, clearance: Clearance) -> &mut Self {
        let place = match joint.into() {
            AnyJoint::Carrying(joint) => self.joints.get_mut(joint.0).map(|item| &mut item.clearance),
            AnyJoint::Cut(cut) => self.cuts.get_mut(cut.0).map(|item| &mut item.clearance),
        };
        match place {
            Some(place) => *place = Some(clearance),
            None => self.foreign = true,
        }
        self
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

    /// Makes a joint with one coordinate follow a motion, whatever force or torque that takes; see
    /// [`Mechanism::prescribed_names`](crate::Mechanism::prescribed_names).
    pub fn prescribe(&mut self, joint: JointHandle, motion: PrescribedMotion) -> &mut Self {
        self.on(joint, |item| item.prescribed = Some(motion));
        self
    }

    /// Puts springs with dampers into a joint, one for each coordinate in their order. The coordinates must have speeds that are
    /// their rates (all joints but the ball joint with a quaternion).
    pub fn springs(&mut self, joint: JointHandle, springs: &[Spring]) -> &mut Self {
        self.on(joint, |item| item.springs = springs.to_vec());
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

    /// Puts stops at the ends of a joint's way; the joint must have one coordinate.
    pub fn limit(&mut self, joint: JointHandle, limit: Limit) -> &mut Self {
        self.on(joint, |item| item.limit = Some(limit));
        self
    }

    /// Adds a force on a point of a link.
    pub fn force(&mut self, name: &str, force: PointLoad) -> &mut Self {
        self.point_loads.push((name.to_owned(), Acts::Force, force));
        self
    }

    /// Adds a moment on a link.
    pub fn moment(&mut self, name: &str, moment: PointLoad) -> &mut Self {
        self.point_loads.push((name.to_owned(), Acts::Moment, moment));
        self
    }

    /// Adds a spring with a damper between two points of two links or the ground.
    pub fn strut(&mut self, name: &str, strut: Strut) -> &mut Self {
        self.struts.push((name.to_owned(), strut));
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

    /// Whether a link is flexible, which makes the equations of motion stiff.
    pub fn is_flexible(&self) -> bool {
        !self.beams.is_empty()
    }

    /// Name of a link, for messages.
    pub(crate) fn link_name(&self, link: LinkHandle) -> String {
        link.0.map_or_else(|| "ground".to_owned(), |k| self.links[k].0.clone())
    }
}

/// Names of a joint's coordinates or speeds: its own for a single one.
pub(crate) fn qualified(joint: &str, local: &[&str]) -> Vec<String> {
    match local {
        [_] => vec![joint.to_owned()],
        _ => local.iter().map(|name| format!("{joint}.{name}")).collect(),
    }
}

impl JointItem {
    /// Names of its coordinates, those that clearance adds included.
    pub(crate) fn coordinates(&self) -> Vec<String> {
        carried::names(&self.name, &self.joint, self.model(), self.coordinate_names.as_deref())
    }

    /// Speeds have the names of their coordinates wherever they are their rates.
    pub(crate) fn speeds(&self) -> Vec<String> {
        if self.joint.coordinates() == self.joint.speeds() {
            self.coordinates()
        } else {
            let own = qualified(&self.name, self.joint.speed_names());
            carried::names(&self.name, &self.joint, self.model(), Some(&own))
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

    /// The joint as it stands in the tree.
    pub(crate) fn carrying(&self) -> Joint {
        let z: Unit<Vector3<f64>> = Vector3::z_axis();
        match self.joint {
            Joint::Revolute { .. } if self.tilts() => Joint::SphericalZyx,
            Joint::Revolute { .. } => Joint::Revolute { axis: z },
            Joint::Prismatic { .. } => Joint::Prismatic { axis: z },
            other => other,
        }
    }

    pub(crate) fn predecessor_frame(&self) -> Pose {
        self.predecessor.pose * self.alignment()
    }

    pub(crate) fn successor_frame(&self) -> Pose {
        self.successor.pose * self.alignment()
    }
}
