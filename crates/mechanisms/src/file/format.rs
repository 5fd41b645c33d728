//! The format of scene files. These structs are the one source of what is read, of the JSON Schema and of its descriptions.

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
    /// One line for listings.
    #[serde(default)]
    pub summary: String,
    /// Gravity \[m/s^2\] in axes of the ground; along -z unless given.
    #[serde(default = "earth")]
    pub gravity: [f64; 3],
    /// The links by name; `ground` is there already.
    pub links: IndexMap<String, LinkItem>,
    /// The joints by name.
    pub joints: IndexMap<String, JointItem>,
    /// Forces on points of links by name.
    #[serde(default)]
    pub forces: IndexMap<String, PointLoadItem>,
    /// Moments on links by name.
    #[serde(default)]
    pub moments: IndexMap<String, PointLoadItem>,
    /// Springs with dampers between two points by name.
    #[serde(default)]
    pub struts: IndexMap<String, StrutItem>,
    /// Where the linkage starts.
    #[serde(default)]
    pub start: StartItem,
    /// How it is run.
    #[serde(default)]
    pub run: RunItem,
}

fn earth() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

/// A rigid link: `cylinder`, `box`, or `mass` with `centre` and `inertia`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkItem {
    /// Mass \[kg\]; 0 for a link that only carries others.
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
    /// One side; coordinates say how the successor moves against it.
    #[serde(default)]
    pub predecessor: MountItem,
    /// The other side.
    #[serde(default)]
    pub successor: MountItem,
    /// Whether the joint closes a loop by equations; chosen unless given: joints with few freedoms carry links.
    pub cut: Option<bool>,
    /// Names of its coordinates; the joint's own name for a single one.
    pub coordinates: Option<Vec<String>>,
    /// Drives and resistances on its one coordinate; they add up.
    #[serde(default)]
    pub drives: Vec<DriveItem>,
    /// Springs with dampers, one for each coordinate.
    #[serde(default)]
    pub springs: Vec<SpringItem>,
    /// Friction in a revolute joint.
    pub friction: Option<FrictionItem>,
    /// Stops at the ends of the way of its one coordinate.
    pub limit: Option<LimitItem>,
}

/// Stops at one or both ends of a coordinate's way, with contact beyond them.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimitItem {
    /// Where the coordinate meets the lower stop \[rad, m\], angles also as texts like `"30 deg"`; none unless given.
    pub lower: Option<Quantity>,
    /// Where it meets the upper stop; none unless given.
    pub upper: Option<Quantity>,
    /// Force over penetration.
    pub contact: ContactItem,
}

/// Force of a contact over penetration and its rate.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum ContactItem {
    /// A power of the penetration, with as much loss as a free impact of a restitution needs.
    Power {
        /// Force at a penetration of one \[N/m^exponent, N m/rad^exponent\].
        stiffness: f64,
        /// Exponent \[-\], 1 or more; 1.5 unless given.
        #[serde(default = "hertz")]
        exponent: f64,
        /// Speed after an impact as a share of that before it, from more than 0 to 1 \[-\]; 1 unless given.
        #[serde(default = "no_loss")]
        restitution: f64,
    },
    /// A linear spring and damper.
    KelvinVoigt {
        /// Stiffness \[N/m, N m/rad\].
        stiffness: f64,
        /// Damping \[N s/m, N m s/rad\].
        damping: f64,
    },
}

fn hertz() -> f64 {
    1.5
}

fn no_loss() -> f64 {
    1.0
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
    /// One end.
    #[serde(default)]
    pub from: MountItem,
    /// The other end.
    #[serde(default)]
    pub to: MountItem,
    /// Distance of the ends at which it is relaxed \[m\]; zero unless given.
    #[serde(default)]
    pub free_length: f64,
    /// Stiffness \[N/m\].
    #[serde(default)]
    pub stiffness: f64,
    /// Damping \[N s/m\].
    #[serde(default)]
    pub damping: f64,
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
        /// Phase at t = 0 \[rad\]; zero unless given.
        #[serde(default)]
        phase: f64,
    },
    /// A spline through points over time.
    Table {
        /// Time \[s\] and torque or force \[N m, N\] of each point, times rising; constant before the first and behind the last.
        points: Vec<[f64; 2]>,
        /// Whether values between two points stay between theirs, with one continuous derivative; else two, and it may overshoot.
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
    /// Stiffness \[N m/rad, N/m\].
    #[serde(default)]
    pub stiffness: f64,
    /// Damping \[N m s/rad, N s/m\].
    #[serde(default)]
    pub damping: f64,
    /// Coordinate at which it is relaxed \[rad, m\]; zero unless given.
    #[serde(default)]
    pub rest: Quantity,
}

/// Friction of a joint.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionItem {
    /// Coefficient against speed, as a share of the full coefficient: the smooth exponential law.
    pub exponential: ExponentialItem,
    /// The journal bearing that turns the joint's reaction into friction.
    pub journal: JournalItem,
}

/// The exponential characteristic `1 - exp(-steepness |v|/reference_speed)`.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExponentialItem {
    /// Reference speed \[rad/s\].
    pub reference_speed: f64,
    /// Steepness \[-\].
    pub steepness: f64,
}

/// A journal bearing: two journals and a face.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JournalItem {
    /// Distance of the two journals \[m\].
    pub spacing: f64,
    /// One journal.
    pub surface_a: SurfaceItem,
    /// The other journal.
    pub surface_b: SurfaceItem,
    /// The face that takes the axial force.
    pub face: SurfaceItem,
}

/// A surface of a bearing.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceItem {
    /// Diameter \[m\].
    pub diameter: f64,
    /// Coefficient of friction \[-\].
    pub coefficient: f64,
}

/// A guess of the coordinates, from which the loops are closed.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartItem {
    /// Guessed coordinates \[rad, m\], angles also as texts like `"30 deg"`; zero unless given.
    #[serde(default)]
    pub positions: IndexMap<String, Quantity>,
    /// Coordinates that keep their guessed value and speed while the loops are closed.
    #[serde(default)]
    pub held: Vec<String>,
    /// Speeds \[rad/s, m/s\]; the others follow from the loops.
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
    /// Coordinate whose speed stands for the run; the first one unless given.
    pub crank: Option<String>,
    /// Coordinate whose motion is the result, if one is.
    pub output: Option<String>,
}

impl Default for RunItem {
    fn default() -> Self {
        Self {
            until: 1.0,
            reactions: false,
            crank: None,
            output: None,
        }
    }
}
