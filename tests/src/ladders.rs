//! Machines of any size: a chain, and chains and crowds with a small loop at each link.

use crate::blueprint::{Blueprint, Part};
use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::{Joint, Pose, Wrench};
use nalgebra::Vector3;

/// What repeats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// One link: an open chain with twisted axes.
    Link,
    /// A four-bar whose coupler carries the next.
    Carrying,
    /// A link of the chain with a four-bar at its side.
    Sided,
    /// Three links of which the last is tied to that of the stage before: loops that share links, all in one plane.
    Crossed,
    /// A four-bar on the ground.
    Apart,
}

impl Stage {
    /// All.
    pub const ALL: [Self; 5] = [Stage::Link, Stage::Carrying, Stage::Sided, Stage::Crossed, Stage::Apart];

    /// So many stages. Cut joints are revolutes with five equations, of which two are independent. The speeds are any.
    pub fn times(self, count: usize) -> Blueprint {
        let mut b = Blueprint {
            parts: Vec::new(),
            cuts: Vec::new(),
            gravity: Vector3::new(1.0, -9.0, 3.0),
        };
        let (mut last, mut tied) = (None, None);
        for k in 0..count {
            let start = Pose::translation(if last.is_some() { 0.3 } else { 0.0 }, 0.0, 0.0);
            let twisted = start * Pose::turn(Vector3::x_axis(), 0.3 + 0.1 * k as f64);
            match self {
                Stage::Link => last = b.rod(last, twisted, 0.3),
                Stage::Carrying => last = b.four_bar(last, twisted),
                Stage::Sided => {
                    last = b.rod(last, twisted, 0.3);
                    b.four_bar(last, Pose::translation(0.1, 0.0, 0.0));
                }
                Stage::Crossed => {
                    last = b.rod(last, start, 0.3);
                    let arm = b.rod(last, Pose::translation(0.1, 0.0, 0.0), 0.2);
                    let end = b.rod(arm, Pose::translation(0.2, 0.0, 0.0), 0.25);
                    b.close(tied, Pose::translation(0.1, 0.0, 0.0), Joint::revolute_z(), &[0.4], end);
                    tied = end;
                }
                Stage::Apart => {
                    b.four_bar(None, Pose::translation(0.0, 0.0, k as f64) * twisted);
                }
            }
        }
        b
    }
}

/// A parallelogram, its links in line but for an angle \[rad\], hung on a link; its coupler is welded to the ground. The small loop is
/// nearly singular, which the large one does not let anything feel.
pub fn folded(angle: f64) -> Blueprint {
    let mut b = Blueprint {
        parts: Vec::new(),
        cuts: Vec::new(),
        gravity: Vector3::new(1.0, -9.0, 3.0),
    };
    let carrier = b.rod(None, Pose::identity(), 0.3);
    // Off the line of the carrier, so that the large loop is far from singular.
    let base = Pose::translation(0.3, 0.0, 0.0) * Pose::turn(Vector3::z_axis(), 1.0);
    let coupler = b.four_bar(carrier, base);
    for (part, q) in b.parts[1..].iter_mut().zip([angle, -angle, angle]) {
        part.q = vec![q];
    }
    b.cuts.clear();
    let end = Pose::translation(0.5, 0.0, 0.0);
    b.close(coupler, end, Joint::revolute_z(), &[0.4], Some(3));
    b.close(None, Pose::translation(0.2, 0.4, 0.0), Joint::Fixed, &[], coupler);
    b
}

impl Blueprint {
    /// Hangs a rod of steel along x on a revolute about z; angle and speed vary from one to the next.
    fn rod(&mut self, parent: Option<usize>, placement: Pose, length: f64) -> Option<usize> {
        let k = self.parts.len();
        self.parts.push(Part {
            parent,
            placement,
            joint: Joint::revolute_z(),
            inertia: RigidInertia::solid_cylinder(7850.0, 0.03, length, &Vector3::x()),
            q: vec![0.8 + 0.5 * (0.7 * k as f64).sin()],
            v: vec![(1.3 * k as f64).cos()],
            drive: vec![(0.9 * k as f64).sin()],
            wrench: Wrench::zero(),
        });
        Some(k)
    }

    /// A closed four-bar in the plane of `base`; its coupler.
    fn four_bar(&mut self, parent: Option<usize>, base: Pose) -> Option<usize> {
        let crank = self.rod(parent, base, 0.2);
        let coupler = self.rod(crank, Pose::translation(0.2, 0.0, 0.0), 0.5);
        let rocker = self.rod(parent, base * Pose::translation(0.5, 0.0, 0.0), 0.3);
        self.close(
            coupler,
            Pose::translation(0.5, 0.0, 0.0),
            Joint::revolute_z(),
            &[0.4],
            rocker,
        );
        coupler
    }
}
