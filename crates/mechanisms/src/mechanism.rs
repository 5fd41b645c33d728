//! A built linkage: the equations of motion with names.

use crate::contact_load::ContactLoad;
use crate::error::{MotionError, StartError};
use linkdyn_dynamics::{DynamicsError, System};
use linkdyn_friction::Bristle;
use linkdyn_kinematics::assembly::{self, Assembly, Settings};
use linkdyn_kinematics::{Attachment, Closure, LinkId, Pose, Positions};
use std::ops::Range;
use std::sync::Arc;

/// An immutable mechanism; cheap to clone and to share between threads.
#[derive(Clone, Debug)]
pub struct Mechanism {
    pub(crate) system: Arc<System>,
    pub(crate) links: Vec<NamedLink>,
    pub(crate) joints: Vec<NamedJoint>,
    pub(crate) loops: Vec<NamedLoop>,
    /// All cut joints without their clearance; those of the tree are without where the speeds of `loose` are held.
    pub(crate) centred: Vec<Closure>,
    /// Joints with limits, then with clearance, those of the tree before cut ones; they are the first of the loads with internals.
    pub(crate) contacts: Vec<Contact>,
    pub(crate) coordinates: Vec<String>,
    pub(crate) speeds: Vec<String>,
    /// Speeds that clearance adds to joints of the tree: zero in the ideal joint.
    pub(crate) loose: Vec<usize>,
}

/// A link by name.
#[derive(Clone, Debug)]
pub(crate) struct NamedLink {
    pub name: String,
    pub frame: Option<Attachment>,
}

/// A joint of the tree by name.
#[derive(Clone, Debug)]
pub(crate) struct NamedJoint {
    pub name: String,
    pub link: LinkId,
    /// Pose of the link's frame in the joint's frame on the successor.
    pub to_link: Pose,
    pub speed: usize,
    pub has_friction: bool,
}

/// A cut joint by name.
#[derive(Clone, Debug)]
pub(crate) struct NamedLoop {
    pub name: String,
    pub components: Vec<String>,
}

/// A joint with limits or clearance.
#[derive(Clone, Debug)]
pub(crate) struct Contact {
    /// Names of its contact points.
    pub names: Vec<String>,
    pub load: Arc<dyn ContactLoad>,
}

/// Coordinates and speeds to start from.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Coordinates.
    pub q: Vec<f64>,
    /// Speeds.
    pub v: Vec<f64>,
}

/// How a start is given: a guess by names, and which coordinates are held while the loops are closed.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Start {
    /// Guessed coordinates; those not named start from zero (quaternions from no turn).
    pub positions: Vec<(String, f64)>,
    /// Coordinates that keep their guessed value and speed.
    pub held: Vec<String>,
    /// Speeds of coordinates; the others follow from the loops.
    pub speeds: Vec<(String, f64)>,
}

impl Mechanism {
    /// The equations of motion.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Names of the coordinates in the order of `q`.
    pub fn coordinate_names(&self) -> impl Iterator<Item = &str> {
        self.coordinates.iter().map(String::as_str)
    }

    /// Names of the speeds in the order of `v`; those of the coordinates wherever they are their rates.
    pub fn speed_names(&self) -> impl Iterator<Item = &str> {
        self.speeds.iter().map(String::as_str)
    }

    /// Names of the joints of the tree, in the order of attachment.
    pub fn joint_names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(|joint| joint.name.as_str())
    }

    /// Names of the cut joints.
    pub fn loop_names(&self) -> impl Iterator<Item = &str> {
        self.loops.iter().map(|cut| cut.name.as_str())
    }

    /// Names of the coordinates with prescribed motion, in the order of their multipliers, which stand behind those of the loops and are
    /// the forces \[N\] or torques \[N m\] that the motions take.
    pub fn prescribed_names(&self) -> impl Iterator<Item = &str> {
        let guided = self.system.guided().iter();
        guided.map(|guided| self.coordinates[guided.coordinate].as_str())
    }

    /// Size of the force \[N\] in each cut joint by the multipliers of all loops; torques are left out.
    pub fn loop_forces(&self, multipliers: &[f64]) -> impl Iterator<Item = f64> {
        let mut rest = multipliers;
        self.loops.iter().map(move |cut| {
            let (own, others) = rest.split_at_checked(cut.components.len()).unwrap_or_default();
            rest = others;
            let forces = own.iter().zip(&cut.components).filter(|(_, c)| c.starts_with('f'));
            forces.map(|(force, _)| force * force).sum::<f64>().sqrt()
        })
    }

    /// Names of the speeds on which joint friction acts, in the order of [`crate::Observation::friction`].
    pub fn friction_names(&self) -> impl Iterator<Item = &str> {
        let rubbing = self.joints.iter().filter(|joint| joint.has_friction);
        rubbing.map(|joint| self.speeds[joint.speed].as_str())
    }

    /// Names of the contact points of joints with limits, then of those with clearance, those of the tree first, in the order of
    /// [`crate::Observation::contacts`].
    pub fn contact_names(&self) -> impl Iterator<Item = String> {
        self.contacts.iter().flat_map(|contact| contact.names.iter().cloned())
    }

    /// Friction at each contact point.
    pub(crate) fn bristles(&self) -> impl Iterator<Item = Option<&Bristle>> {
        let contacts = self.contacts.iter();
        contacts.flat_map(|contact| std::iter::repeat_n(contact.load.bristle(), contact.load.points()))
    }

    /// Radial clearance at each contact point \[m\]; none at limits.
    pub fn clearances(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        let contacts = self.contacts.iter();
        contacts.flat_map(|contact| std::iter::repeat_n(contact.load.clearance(), contact.load.points()))
    }

    /// Whether a joint of the mechanism has friction.
    pub fn has_friction(&self) -> bool {
        self.joints.iter().any(|joint| joint.has_friction)
    }

    /// Which load has states, integrals or events of its own, or which coordinate a prescribed motion, if one has.
    pub(crate) fn stateful(&self) -> Option<String> {
        let guided = self.prescribed_names().next();
        let guided = guided.map(|name| format!("coordinate `{name}` has a prescribed motion"));
        guided.or_else(|| self.keeping())
    }

    /// Which load has states, integrals or events of its own, if one has.
    pub(crate) fn keeping(&self) -> Option<String> {
        if self.system.internals().is_empty() {
            return None;
        }
        Some(match self.contacts.first() {
            Some(contact) => contact.load.describe(),
            None => "a load has states, integrals or events of its own".into(),
        })
    }

    /// An error of the equations of motion in terms of this mechanism's names.
    #[cold]
    pub fn explain(&self, cause: DynamicsError) -> MotionError {
        let coordinate = cause.speed().and_then(|speed| self.speeds.get(speed).cloned());
        MotionError { coordinate, cause }
    }

    /// Where a link's frame sits on the tree; `None` for unknown names.
    pub fn attachment(&self, link: &str) -> Option<Attachment> {
        self.links.iter().find(|l| l.name == link).and_then(|l| l.frame)
    }

    /// Closes the loops from a guess, joints with clearance centred and prescribed coordinates where they are at t = 0; see
    /// [`assembly::assemble`]. Coordinates that clearance adds to joints of the tree, see
    /// [`Linkage::clearance`](crate::Linkage::clearance), are held at the guess, which is zero unless named.
    ///
    /// # Errors
    /// [`StartError`] for unknown names and where the loops cannot be closed with what is held.
    pub fn assemble(&self, start: &Start) -> Result<(State, Assembly), StartError> {
        let tree = self.system.tree();
        let mut q = tree.neutral();
        for (name, value) in &start.positions {
            q[self.index(name)?] = *value;
        }
        let mut held = self.held(&start.held)?;
        self.follow_prescribed(0.0, &mut q, &mut held);
        let mut v = vec![0.0; tree.speeds()];
        let mut given = held.clone();
        for (name, value) in &start.speeds {
            let speed = self.speed(name)?;
            (v[speed], given[speed]) = (*value, true);
        }
        for guided in self.system.guided() {
            (v[guided.speed], given[guided.speed]) = (guided.guide.at(0.0)[1], true);
        }
        self.check_prescribed(start, &q, &v)?;
        let closed = assembly::assemble(tree, &self.centred, &q, &held, &Settings::default())?;
        self.check_upright(&closed.q)?;
        let v = assembly::consistent_velocities(tree, &self.centred, &closed.q, &v, &given)?;
        let state = State { q: closed.q.clone(), v };
        Ok((state, closed))
    }

    /// Cut joints must be put together the right way round.
    fn check_upright(&self, q: &[f64]) -> Result<(), StartError> {
        let tree = self.system.tree();
        let mut places = Positions::new(tree);
        tree.positions(q, &mut places);
        let mut pairs = self.loops.iter().zip(&self.centred);
        match pairs.find(|(_, cut)| !cut.is_upright(&places)) {
            Some((cut, _)) => Err(StartError::Reversed {
                joint: cut.name.clone(),
            }),
            None => Ok(()),
        }
    }

    /// Puts coordinates with prescribed positions where they are at time `t` \[s\], and flags their speeds as held.
    pub(crate) fn follow_prescribed(&self, t: f64, q: &mut [f64], held: &mut [bool]) {
        for guided in self.system.guided().iter().filter(|guided| !guided.speed_only) {
            (q[guided.coordinate], held[guided.speed]) = (guided.guide.at(t)[0], true);
        }
    }

    /// A start must not say of a prescribed coordinate what its motion does not.
    fn check_prescribed(&self, start: &Start, q: &[f64], v: &[f64]) -> Result<(), StartError> {
        for guided in self.system.guided() {
            let name = &self.coordinates[guided.coordinate];
            let told = |list: &[(String, f64)]| list.iter().find(|(told, _)| told == name).map(|(_, value)| *value);
            let position = told(&start.positions).filter(|_| !guided.speed_only);
            let pairs = [
                ("position", position, q[guided.coordinate]),
                ("speed", told(&start.speeds), v[guided.speed]),
            ];
            for (what, given, prescribed) in pairs {
                // Numbers that a person has rounded to nine digits are the same.
                let differs = |given: &f64| (given - prescribed).abs() > 1e-9 * prescribed.abs().max(1.0);
                if let Some(given) = given.filter(differs) {
                    return Err(StartError::Prescribed {
                        coordinate: name.clone(),
                        what,
                        given,
                        prescribed,
                    });
                }
            }
        }
        Ok(())
    }

    /// A flag a speed: those of the coordinates named, and those that clearance adds.
    pub(crate) fn held(&self, names: &[String]) -> Result<Vec<bool>, StartError> {
        let mut held = vec![false; self.system.tree().speeds()];
        for name in names {
            held[self.speed(name)?] = true;
        }
        for &speed in &self.loose {
            held[speed] = true;
        }
        Ok(held)
    }

    pub(crate) fn index(&self, name: &str) -> Result<usize, StartError> {
        self.coordinate_names()
            .position(|known| known == name)
            .ok_or_else(|| StartError::UnknownCoordinate {
                name: name.to_owned(),
                known: self.coordinate_names().collect::<Vec<_>>().join(", "),
            })
    }

    /// The speed that belongs to a coordinate (for the quaternion of a ball joint: w, x, y, z to its three speeds).
    pub(crate) fn speed(&self, name: &str) -> Result<usize, StartError> {
        let index = self.index(name)?;
        let found = self.ranges().find(|(q, _)| q.contains(&index));
        Ok(found.map_or(index, |(q, v)| {
            let local = index - q.start;
            let turned = before_quaternion(q.len(), v.len()).map_or(local, |slides| match local.checked_sub(slides) {
                None => local,
                Some(part) => slides + part.saturating_sub(1),
            });
            v.start + turned
        }))
    }

    /// Coordinates and speeds of the joints of the tree, one joint after the other.
    fn ranges(&self) -> impl Iterator<Item = (Range<usize>, Range<usize>)> {
        let joints = self.system.tree().joints().iter();
        joints.scan((0, 0), |(q, v), (_, joint)| {
            let first = (*q, *v);
            (*q, *v) = (*q + joint.coordinates(), *v + joint.speeds());
            Some((first.0..*q, first.1..*v))
        })
    }

    /// The coordinate whose rate a speed is; of a ball joint with a quaternion the part about the speed's axis.
    pub(crate) fn value_of_speed(&self, speed: usize, q: &[f64]) -> f64 {
        self.coordinate_of_speed(speed).map_or(f64::NAN, |index| q[index])
    }

    /// Index of that coordinate.
    pub(crate) fn coordinate_of_speed(&self, speed: usize) -> Option<usize> {
        self.ranges().find_map(|(q, v)| {
            let local = speed.checked_sub(v.start).filter(|local| *local < v.len())?;
            let behind = before_quaternion(q.len(), v.len()).is_some_and(|slides| local >= slides);
            Some(q.start + local + usize::from(behind))
        })
    }
}

/// How many coordinates of a joint come before its quaternion, if it has one: the slides of a free joint.
fn before_quaternion(coordinates: usize, speeds: usize) -> Option<usize> {
    (coordinates > speeds).then(|| speeds.saturating_sub(3))
}
