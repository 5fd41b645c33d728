//! Flexible links by the modified rigid finite element method: a chain of rigid elements on turns with springs.

use crate::linkage::{JointHandle, LinkHandle, Linkage, Mount};
use crate::spring::Spring;
use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::Joint;
use linkdyn_rfem::{Beam, Rfe, Sde};
use nalgebra::{Matrix3, Vector3};

/// Along which axis of its frame a beam runs from its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "file", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Along {
    /// Along +x.
    X,
    /// Along +y.
    Y,
    /// Along +z.
    Z,
    /// Along -x.
    MinusX,
    /// Along -y.
    MinusY,
    /// Along -z.
    MinusZ,
}

impl Along {
    /// The beam's axis and the section's first and second axis, as indices of the frame's axes; in cyclic order.
    fn axes(self) -> [usize; 3] {
        match self {
            Along::X | Along::MinusX => [0, 1, 2],
            Along::Y | Along::MinusY => [1, 2, 0],
            Along::Z | Along::MinusZ => [2, 0, 1],
        }
    }

    /// The direction as a unit vector.
    pub fn direction(self) -> Vector3<f64> {
        let sign = match self {
            Along::X | Along::Y | Along::Z => 1.0,
            Along::MinusX | Along::MinusY | Along::MinusZ => -1.0,
        };
        let mut direction = Vector3::zeros();
        direction[self.axes()[0]] = sign;
        direction
    }

    /// Numbers given for the beam's axis and the section's two, in the order x, y, z of the frame.
    fn in_frame<T: Copy>(self, [beam, first, second]: [T; 3]) -> [T; 3] {
        let mut sorted = [beam; 3];
        for (axis, value) in self.axes().into_iter().zip([beam, first, second]) {
            sorted[axis] = value;
        }
        sorted
    }
}

/// A flexible link on its linkage.
#[derive(Clone, Debug)]
pub struct FlexibleLink {
    /// The rigid elements, from the beginning of the beam to its end.
    pub elements: Vec<LinkHandle>,
    /// The joints between them, which hold springs and dampers.
    pub joints: Vec<JointHandle>,
    /// The end of the beam, on the last element, with the axes of the beam's frame.
    pub end: Mount,
}

impl Linkage {
    /// Adds a flexible straight link: the rigid finite elements `NAME,0`, `NAME,1`, ... on ZYX turns `NAME.1`, `NAME.2`, ... with the
    /// springs and dampers of the spring-damping elements \[Wittbrodt, Adamiec-Wójcik, Wojciech 2006\]. It bends and twists; the
    /// modified method neither stretches nor shears. ZYX turns are singular where theta is a right angle in one of them, far beyond
    /// what their springs are meant for.
    ///
    /// The beam begins at the origin of the link's frame, which is that of element 0. Element r has its origin at
    /// spring-damping element r and, while nothing is bent, the axes of that frame. Twist belongs to the turn about the axis `along`
    /// which the beam runs, bending to the two others: the section's first and second axis are the next two in cyclic order.
    pub fn flexible_link(&mut self, name: &str, beam: &Beam, along: Along) -> FlexibleLink {
        let direction = along.direction();
        let mut elements: Vec<LinkHandle> = Vec::new();
        let mut joints = Vec::new();
        let mut origin = 0.0;
        let mut before = 0.0;
        for (r, element) in beam.elements.iter().enumerate() {
            let sde = r.checked_sub(1).and_then(|s| beam.springs.get(s));
            if let Some(sde) = sde {
                (before, origin) = (origin, sde.position);
            }
            let link = self.link(&format!("{name},{r}"), rigid(element, origin, along));
            if let (Some(sde), Some(&last)) = (sde, elements.last()) {
                let place = direction * (origin - before);
                let joint = self.joint(
                    &format!("{name}.{r}"),
                    Joint::SphericalZyx,
                    Mount::at(last, place.into()),
                    Mount::at_origin(link),
                );
                self.springs(joint, &springs(sde, along));
                joints.push(joint);
            }
            elements.push(link);
        }
        let length = beam.elements.last().map_or(0.0, |last| last.start + last.length);
        let last = elements.last().copied().unwrap_or(Linkage::GROUND);
        self.beams.push((name.to_owned(), elements.clone()));
        FlexibleLink {
            end: Mount::at(last, (direction * (length - origin)).into()),
            elements,
            joints,
        }
    }
}

/// Inertia of an element in its own frame, whose origin lies at `origin` along the beam.
fn rigid(element: &Rfe, origin: f64, along: Along) -> RigidInertia {
    RigidInertia {
        mass: element.mass,
        com: along.direction() * (element.start + 0.5 * element.length - origin),
        about_com: Matrix3::from_diagonal(&Vector3::from(along.in_frame(element.inertia))),
    }
}

/// Springs of the turns psi (about z), theta (about y) and phi (about x).
fn springs(sde: &Sde, along: Along) -> [Spring; 3] {
    let [first, second] = sde.bend;
    let [x, y, z] = along.in_frame([sde.twist, first, second]);
    [z, y, x].map(|c| Spring {
        stiffness: c.stiffness,
        damping: c.damping,
        rest: 0.0,
    })
}
