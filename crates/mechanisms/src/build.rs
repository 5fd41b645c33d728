//! From a description in any order to tree, closures and loads.

use crate::clearance::ClearanceJoint;
use crate::drive::CoordinateDrives;
use crate::error::BuildError;
use crate::limit::LimitStops;
use crate::linkage::{JointItem, LinkHandle, Linkage, Mount};
use crate::mechanism::{Contact, Mechanism, NamedJoint, NamedLink, NamedLoop};
use crate::spring::{self, JointSprings};
use crate::strut::PlacedStrut;
use linkdyn_dynamics::{Description, Guided, Load, ReactionLoad, RigidInertia, System, SystemError};
use linkdyn_kinematics::{Attachment, Closure, Joint, LinkId, Pose, Tree};
use nalgebra::Vector3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

impl Linkage {
    /// Checks everything and sets up the equations of motion.
    ///
    /// # Errors
    /// [`BuildError`] that names the item, its value and what would be right.
    pub fn build(&self) -> Result<Mechanism, BuildError> {
        self.check_names()?;
        self.check_items()?;
        match self.with_cuts_chosen() {
            Some(chosen) => chosen.build_tree(),
            None => self.build_tree(),
        }
    }

    /// Builds what is checked and a tree.
    fn build_tree(&self) -> Result<Mechanism, BuildError> {
        let placed = self.place()?;

        let (mut coordinates, mut speeds) = (Vec::new(), Vec::new());
        let (mut joints, mut loose) = (Vec::new(), Vec::new());
        let mut loads: Vec<Arc<dyn Load>> = Vec::new();
        let mut reaction_loads: Vec<(LinkId, Arc<dyn ReactionLoad>)> = Vec::new();
        let (mut springs, mut guided, mut contacts) = (Vec::new(), Vec::new(), Vec::new());
        for (&index, &node) in placed.order.iter().zip(&placed.nodes) {
            let item = &self.joints[index];
            let (q, v) = (placed.tree.coordinate_range(node), placed.tree.speed_range(node));
            // What clearance adds: slides before the joint's own freedoms, tilts behind the turn.
            loose.extend(v.start - item.slides().count()..v.start);
            if item.tilts() {
                loose.extend(v.start + 1..v.end);
            }
            if !item.drives.is_empty() {
                loads.push(Arc::new(CoordinateDrives {
                    coordinate: q.start,
                    speed: v.start,
                    drives: item.drives.clone(),
                }));
            }
            springs.extend(item.springs.iter().enumerate().map(|(k, &spring)| spring::Placed {
                coordinate: q.start + k,
                speed: v.start + k,
                spring,
            }));
            if let Some(motion) = &item.prescribed {
                guided.push(Guided {
                    coordinate: q.start,
                    speed: v.start,
                    speed_only: motion.speed_only(),
                    guide: Arc::new(motion.clone()),
                });
            }
            if let Some(limit) = &item.limit {
                let stops = Arc::new(LimitStops::new(&item.name, limit, q.start, v.start));
                contacts.push(Contact {
                    names: limit.point_names(&item.name).collect(),
                    load: stops.clone(),
                });
                loads.push(stops);
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
        if !springs.is_empty() {
            loads.push(Arc::new(JointSprings(springs)));
        }
        let (mut closures, mut centred) = (Vec::new(), Vec::new());
        for &index in &placed.order {
            let item = &self.joints[index];
            if let Some(clearance) = &item.clearance {
                let ends = [&item.predecessor, &item.successor].map(|mount| placed.attachment(mount));
                let joint = Arc::new(ClearanceJoint::new(&item.name, clearance, ends, axis_of(&item.joint)));
                contacts.push(Contact {
                    names: clearance.model.point_names(&item.name).collect(),
                    load: joint.clone(),
                });
                loads.push(joint);
            }
        }
        for cut in &self.cuts {
            let (one, two) = (placed.attachment(&cut.predecessor), placed.attachment(&cut.successor));
            let ideal = match &cut.rows {
                None => Closure::new(&placed.tree, one, two, &cut.joint),
                Some(rows) => Closure::with_rows(&placed.tree, one, two, rows.clone()),
            };
            match &cut.clearance {
                Some(clearance) => {
                    let axis = axis_of(&cut.joint);
                    let joint = Arc::new(ClearanceJoint::new(&cut.name, clearance, [one, two], axis));
                    closures.push(joint.closure(&placed.tree, &ideal));
                    contacts.push(Contact {
                        names: clearance.model.point_names(&cut.name).collect(),
                        load: joint.clone(),
                    });
                    loads.push(joint);
                }
                None => closures.push(ideal.clone()),
            }
            centred.push(ideal);
        }
        for (_, acts, load) in &self.point_loads {
            loads.push(Arc::new(load.placed(placed.attachment(&load.at), *acts)));
        }
        for (name, strut) in &self.struts {
            loads.push(Arc::new(PlacedStrut {
                name: name.clone(),
                ends: [&strut.from, &strut.to].map(|end| placed.attachment(end)),
                strut: *strut,
            }));
        }
        // After the contacts, so that these come first among the loads with internals.
        loads.extend(self.loads.iter().cloned());
        let loops = self.cuts.iter().zip(&closures).map(|(cut, closure)| NamedLoop {
            name: cut.name.clone(),
            components: closure.component_names(),
        });
        let loops = loops.collect();
        let inertias = placed.carriers.iter().map(|carrier| {
            let Some(item) = carrier.map(|index| &self.joints[index]) else {
                return RigidInertia::massless();
            };
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
            guided,
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
            centred,
            contacts,
            coordinates,
            speeds,
            loose,
        })
    }

    /// Hangs the links on the ground one by one, whatever the order in which they were described.
    fn place(&self) -> Result<Placed, BuildError> {
        let mut placed = Placed {
            tree: Tree::new(),
            order: Vec::new(),
            nodes: Vec::new(),
            carriers: Vec::new(),
            frames: vec![None; self.links.len()],
        };
        // By place: the ground, then the links.
        let place = |link: LinkHandle| link.0.map_or(0, |k| k + 1);
        let mut carriers: Vec<Option<&JointItem>> = vec![None; 1 + self.links.len()];
        let mut hanging = vec![Vec::new(); carriers.len()];
        for (k, joint) in self.joints.iter().enumerate() {
            if let Some(first) = carriers[place(joint.successor.link)].replace(joint) {
                return Err(BuildError::CarriedTwice {
                    link: self.link_name(joint.successor.link),
                    first: first.name.clone(),
                    second: joint.name.clone(),
                });
            }
            hanging[place(joint.predecessor.link)].push(Reverse(k));
        }
        // Joints on links that hang already: the first one described comes next.
        let mut reached = BinaryHeap::from(std::mem::take(&mut hanging[0]));
        while let Some(Reverse(k)) = reached.pop() {
            let item = &self.joints[k];
            let mut base = placed.attachment(&Mount {
                link: item.predecessor.link,
                pose: item.predecessor_frame(),
            });
            for joint in item.slides() {
                base = placed.attach(item, base, joint)?;
                placed.carriers.push(None);
            }
            let node = placed.attach(item, base, item.carrying())?.link;
            placed.carriers.push(Some(k));
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
            reached.append(&mut std::mem::take(&mut hanging[place(item.successor.link)]).into());
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

    fn name_link(&self, error: SystemError, placed: &Placed) -> BuildError {
        match error {
            SystemError::Inertia { link, source } => BuildError::Inertia {
                link: placed.carriers[link].map_or_else(String::new, |k| self.link_name(self.joints[k].successor.link)),
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
    /// For each link of the tree the joint that carries it; none for what stands between slides.
    carriers: Vec<Option<usize>>,
    /// Frames of the links on the tree's nodes.
    frames: Vec<Option<Attachment>>,
}

/// Axis of a joint with clearance in its frame; any one for a ball.
fn axis_of(joint: &Joint) -> Vector3<f64> {
    match joint {
        Joint::Revolute { axis } => **axis,
        _ => Vector3::z(),
    }
}

impl Placed {
    /// Hangs a link on `base`; its frame.
    fn attach(&mut self, item: &JointItem, base: Attachment, joint: Joint) -> Result<Attachment, BuildError> {
        let attached = self.tree.attach(base.link, base.pose, joint);
        let link = attached.map_err(|source| BuildError::Joint {
            joint: item.name.clone(),
            source,
        })?;
        let pose = Pose::identity();
        Ok(Attachment { link, pose })
    }

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
