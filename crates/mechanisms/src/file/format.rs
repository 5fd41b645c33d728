//! The format of scene files. These structs are the one source of what is read, of the JSON Schema and of its descriptions.

use super::beam::BeamItem;
use super::clearance::ClearanceItem;
use super::friction::FrictionItem;
use super::points::{LimitItem, PointLoadItem, StrutItem};
use super::prescribed::PrescribedItem;
use super::quantity::Quantity;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::Deserialize;

/// A linkage with its start and its run. Units are SI: m, kg, s, rad.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Version of the format: 1.
    pub format: i64,
    /// One line for listings; empty unless given.
    #[serde(default)]
    pub summary: String,
    /// Gravity \[m/s^2\] in axes of the ground; along -z unless given.
    #[serde(default = "earth")]
    pub gravity: [f64; 3],
    /// The links by name; `ground` is there already.
    pub links: IndexMap<String, LinkItem>,
    /// The joints by name.
    pub joints: IndexMap<String, JointItem>,
    /// Forces on points of links by name; none unless given. Forces, moments and struts need names of their own.
    #[serde(default)]
    pub forces: IndexMap<String, PointLoadItem>,
    /// Moments on links by name; none unless given.
    #[serde(default)]
    pub moments: IndexMap<String, PointLoadItem>,
    /// Springs with dampers between two points by name; none unless given.
    #[serde(default)]
    pub struts: IndexMap<String, StrutItem>,
    /// Where the linkage starts; all coordinates and speeds zero unless given.
    #[serde(default)]
    pub start: StartItem,
    /// How it is run; for a second unless given.
    #[serde(default)]
    pub run: RunItem,
}

fn earth() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

/// A link: `cylinder`, `box`, or `mass` with `centre` and `inertia`; or flexible as a `beam`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkItem {
    /// Mass \[kg\], with `centre` and `inertia`, where no shape is given; 0 for a link that only carries others.
    pub mass: Option<f64>,
    /// Centre of mass in the link's frame \[m\]; its origin unless given.
    pub centre: Option<[f64; 3]>,
    /// Inertia matrix about the centre of mass, row by row \[kg m^2\]; zero unless given.
    pub inertia: Option<[[f64; 3]; 3]>,
    /// A solid cylinder from the origin of the link's frame, in place of mass, centre and inertia.
    pub cylinder: Option<CylinderItem>,
    /// A solid box with edges along the axes of the link's frame, in place of mass, centre and inertia.
    #[serde(rename = "box")]
    pub cuboid: Option<CuboidItem>,
    /// A flexible beam from the origin of the link's frame, in place of all others.
    pub beam: Option<BeamItem>,
}

/// A solid cylinder.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderItem {
    /// Density \[kg/m^3\].
    pub density: f64,
    /// Diameter \[m\].
    pub diameter: f64,
    /// From its beginning, the origin of the link's frame, to its end \[m\].
    pub along: [f64; 3],
}

/// A solid box.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CuboidItem {
    /// Density \[kg/m^3\].
    pub density: f64,
    /// Its edges along x, y and z \[m\].
    pub size: [f64; 3],
    /// Its middle in the link's frame \[m\]; the origin unless given.
    #[serde(default)]
    pub centre: [f64; 3],
}

/// A joint between two links.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointItem {
    /// What it lets its links do.
    pub kind: Kind,
    /// Axis in the joint's frame, of any length but zero; z unless given. The first axis of a universal joint, the normal of a planar one.
    pub axis: Option<[f64; 3]>,
    /// Second axis of a universal joint, y unless given; first slide of a planar one, x unless given.
    pub second_axis: Option<[f64; 3]>,
    /// Lead of a screw, where it must be given: slide of its successor for a whole turn \[m\], negative for a left-hand thread.
    pub lead: Option<f64>,
    /// One side, the ground unless given; coordinates say how the successor moves against it.
    #[serde(default)]
    pub predecessor: MountItem,
    /// The other side, the ground unless given.
    #[serde(default)]
    pub successor: MountItem,
    /// Whether the joint closes a loop by equations; chosen unless given: joints with few freedoms carry links.
    pub cut: Option<bool>,
    /// Names of its coordinates; unless given a single one has the joint's name, several are `JOINT.psi` and so on.
    pub coordinates: Option<Vec<String>>,
    /// Drives and resistances on its one coordinate, which add up; none unless given.
    #[serde(default)]
    pub drives: Vec<DriveItem>,
    /// Springs with dampers, one for each coordinate; none unless given.
    #[serde(default)]
    pub springs: Vec<SpringItem>,
    /// Friction of a revolute or prismatic joint that carries a link; none unless given.
    pub friction: Option<FrictionItem>,
    /// Motion that its one coordinate is made to follow, which takes a freedom away; none unless given.
    pub prescribed: Option<PrescribedItem>,
    /// Clearance of a revolute or ball joint; none unless given. The joint is cut then, unless it has `cut = false` or something on its coordinates: in the
    /// tree it gets coordinates `JOINT.x`, `JOINT.y` and for a ball `JOINT.z`, with `length` also `JOINT.theta` and `JOINT.phi`.
    pub clearance: Option<ClearanceItem>,
    /// Stops at the ends of the way of its one coordinate; none unless given.
    pub limit: Option<LimitItem>,
}

/// Kinds of joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// No freedom.
    Fixed,
    /// One turn about `axis`.
    Revolute,
    /// One slide along `axis`.
    Prismatic,
    /// Turn about `axis` with a slide along it by `lead` for a whole turn.
    Screw,
    /// Slide along and turn about `axis`.
    Cylindrical,
    /// Turn about `axis`, then about `second_axis`.
    Universal,
    /// Ball joint with a quaternion.
    Spherical,
    /// Ball joint as three turns about z, y and x.
    SphericalZyx,
    /// Slides along `second_axis` and across it, then a turn about `axis`.
    Planar,
    /// Nothing is held: three slides, then a ball joint with a quaternion.
    Free,
}

/// A frame on a link, where a joint sits.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MountItem {
    /// Name of the link; `ground` unless given.
    pub link: Option<String>,
    /// Whether the joint sits at the end of a beam, in a frame with the beam's axes and its origin there; at its beginning unless given.
    #[serde(default)]
    pub end: bool,
    /// Origin of the joint's frame in the link's frame \[m\]; zero unless given.
    #[serde(default)]
    pub point: [f64; 3],
    /// Rotation matrix of the joint's frame, row by row: its columns are the joint's axes in axes of the link. None unless given.
    pub rotation: Option<[[f64; 3]; 3]>,
    /// A turn of the joint's frame against the link's, in place of `rotation`.
    pub turn: Option<TurnItem>,
}

/// A turn about an axis.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TurnItem {
    /// Axis, of any length but zero.
    pub axis: [f64; 3],
    /// Angle \[rad\], or a text like `"30 deg"`.
    pub angle: Quantity,
}

/// A drive or resistance.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum DriveItem {
    /// Rises linearly from zero at t = 0 and stays.
    Ramp {
        /// Final torque or force \[N m, N\].
        torque: f64,
        /// Time of the rise \[s\].
        rise_time: f64,
    },
    /// Constant.
    Constant {
        /// Torque or force \[N m, N\].
        torque: f64,
    },
    /// `amplitude * sin(2 pi frequency t + phase)`.
    Harmonic {
        /// Largest torque or force \[N m, N\].
        amplitude: f64,
        /// Frequency \[Hz\].
        frequency: f64,
        /// Phase at t = 0 \[rad\], or a text like `"30 deg"`; zero unless given.
        #[serde(default)]
        phase: Quantity,
    },
    /// A spline through points over time.
    Table {
        /// Time \[s\] and torque or force \[N m, N\] of each point, times rising; constant before the first and behind the last.
        points: Vec<[f64; 2]>,
        /// Whether values between two points stay between theirs, with one continuous derivative. Unless given there are two, and the
        /// spline may overshoot.
        #[serde(default)]
        monotone: bool,
    },
    /// Opposes the speed by its square.
    QuadraticResistance {
        /// Torque or force at the reference speed \[N m, N\].
        torque: f64,
        /// Reference speed \[rad/s, m/s\].
        reference_speed: f64,
    },
    /// Opposes the speed, in proportion to it.
    Resistance {
        /// Torque or force at the reference speed \[N m, N\].
        torque: f64,
        /// Reference speed \[rad/s, m/s\].
        reference_speed: f64,
    },
}

/// A spring with a damper.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringItem {
    /// Stiffness \[N m/rad, N/m\]; zero unless given.
    #[serde(default)]
    pub stiffness: f64,
    /// Damping \[N m s/rad, N s/m\]; zero unless given.
    #[serde(default)]
    pub damping: f64,
    /// Coordinate at which it is relaxed \[rad, m\]; zero unless given.
    #[serde(default)]
    pub rest: Quantity,
}

/// A guess of the coordinates, from which the loops are closed.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartItem {
    /// Guessed coordinates \[rad, m\], angles also as texts like `"30 deg"`; zero unless given.
    #[serde(default)]
    pub positions: IndexMap<String, Quantity>,
    /// Coordinates that keep their guessed value and speed while the loops are closed; none unless given.
    #[serde(default)]
    pub held: Vec<String>,
    /// Speeds \[rad/s, m/s\]; unless given they follow from the loops, as small as can be.
    #[serde(default)]
    pub speeds: IndexMap<String, f64>,
}

/// How the scene is run unless the command line says otherwise.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RunItem {
    /// End of the run \[s\]; it begins at 0. 1 s unless given.
    pub until: f64,
    /// Whether results list joint reactions; no unless given.
    pub reactions: bool,
    /// Coordinate whose speed stands for the run; that of the first joint that has one unless given.
    pub crank: Option<String>,
    /// Coordinate whose motion is the result; none unless given.
    pub output: Option<String>,
    /// Time between two rows of the results \[s\]; 1/500 of the run unless given.
    pub every: Option<f64>,
    /// Integration method; `auto` unless given.
    pub method: Option<MethodItem>,
    /// Relative tolerance of methods with error control \[-\]. Unless given 1e-12, with beams and methods for stiff scenes
    /// 1e-9, with clearance a millionth of it; there the absolute one alone counts.
    pub rtol: Option<f64>,
    /// Absolute tolerance of methods with error control \[SI units of each coordinate and speed\]; that of `rtol` unless given.
    pub atol: Option<f64>,
    /// Fixed step of `rk4` and `newmark` \[s\]; 1e-4 unless given.
    pub step: Option<f64>,
}

/// Integration methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MethodItem {
    /// Adams or Radau5, as the run finds them cheaper.
    Auto,
    /// Adams' method of variable order and step.
    Adams,
    /// Explicit Runge-Kutta method of order 8.
    Dop853,
    /// Explicit Runge-Kutta method of order 5.
    Dopri5,
    /// Implicit Runge-Kutta method of order 5, for stiff scenes.
    Radau5,
    /// Backward differentiation, for stiff scenes.
    Bdf,
    /// Rosenbrock method of order 5, for stiff scenes.
    Rodas,
    /// The classical Runge-Kutta method with fixed step.
    Rk4,
    /// Newmark's method with fixed step.
    Newmark,
}

impl Default for RunItem {
    fn default() -> Self {
        Self {
            until: 1.0,
            reactions: false,
            crank: None,
            output: None,
            every: None,
            method: None,
            rtol: None,
            atol: None,
            step: None,
        }
    }
}
