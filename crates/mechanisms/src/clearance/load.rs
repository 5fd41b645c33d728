//! The joint with clearance as a load with states of its own.

use super::{Clearance, ClearanceModel, ContactIntegrals, ContactPoint, Side};
use crate::contact_load::{ContactLoad, kept};
use linkdyn_contact::{Centre, NormalForce, NormalModel, Skewed, Touch};
use linkdyn_dynamics::{Internals, Load, Loads, Motion, Moving};
use linkdyn_friction::Bristle;
use linkdyn_kinematics::{Attachment, Closure, Positions, Row, Tree, Wrench};
use nalgebra::{Matrix3, Vector3};

/// A joint with clearance as a load.
#[derive(Debug)]
pub(crate) struct ClearanceJoint {
    /// Name of the joint.
    pub name: String,
    pub clearance: Clearance,
    /// Frame with the hole, and frame with the pin.
    bearing: Attachment,
    journal: Attachment,
    /// The joint's axis in both frames; any one for a ball.
    axis: Vector3<f64>,
    /// Two directions normal to it, in the frame with the hole: of its axes the first that is not close to the joint's, made
    /// normal to that, and the one that makes them right-handed; then the axis itself.
    seen_along: [Vector3<f64>; 3],
}

/// A journal in its bearing, in motion.
pub(super) struct Pair {
    pub bearing: Centre,
    pub journal: Centre,
}

impl ClearanceJoint {
    /// Between the frames of a joint on its predecessor and its successor, along `axis` of both.
    pub fn new(name: &str, clearance: &Clearance, [one, two]: [Attachment; 2], axis: Vector3<f64>) -> Self {
        let (bearing, journal) = match clearance.bearing {
            Side::Predecessor => (one, two),
            Side::Successor => (two, one),
        };
        let away = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let first = (away - axis * away.dot(&axis)).normalize();
        Self {
            name: name.to_owned(),
            clearance: clearance.clone(),
            bearing,
            journal,
            axis,
            seen_along: [first, axis.cross(&first), axis],
        }
    }

    /// The equations of a cut joint that clearance leaves.
    pub fn closure(&self, tree: &Tree, ideal: &Closure) -> Closure {
        let along = Row::Along { axis: self.axis };
        let rows = match self.clearance.model {
            ClearanceModel::Planar => {
                let angles = ideal.rows().iter().filter(|row| matches!(row, Row::Angle { .. }));
                std::iter::once(along).chain(angles.copied()).collect()
            }
            ClearanceModel::Spatial { .. } => vec![along],
            ClearanceModel::Spherical => Vec::new(),
        };
        Closure::with_rows(tree, *ideal.predecessor(), *ideal.successor(), rows)
    }

    /// Gap at each point: clearance less eccentricity \[m\]; not a number where the journal is too far inclined.
    fn gaps(&self, pair: &Pair) -> [f64; 2] {
        let (fit, Pair { bearing, journal }) = (&self.clearance.fit, pair);
        match self.clearance.model {
            ClearanceModel::Planar => [fit.gap(bearing, journal); 2],
            ClearanceModel::Spherical => [fit.ball_gap(bearing, journal); 2],
            ClearanceModel::Spatial { length } => fit.edge_gaps(length, bearing, journal).unwrap_or([f64::NAN; 2]),
        }
    }

    fn gap_rates(&self, pair: &Pair) -> [f64; 2] {
        let (fit, Pair { bearing, journal }) = (&self.clearance.fit, pair);
        match self.clearance.model {
            ClearanceModel::Planar => [fit.gap_rate(bearing, journal); 2],
            ClearanceModel::Spherical => [fit.ball_gap_rate(bearing, journal); 2],
            ClearanceModel::Spatial { length } => fit.edge_gap_rates(length, bearing, journal).unwrap_or([f64::NAN; 2]),
        }
    }

    fn touches(&self, pair: &Pair) -> Result<[Option<Touch>; 2], Skewed> {
        let (fit, Pair { bearing, journal }) = (&self.clearance.fit, pair);
        match self.clearance.model {
            ClearanceModel::Planar => Ok([fit.planar(bearing, journal), None]),
            ClearanceModel::Spherical => Ok([fit.ball(bearing, journal), None]),
            ClearanceModel::Spatial { length } => fit.edges(length, bearing, journal),
        }
    }

    /// The touches where there is nobody to tell of a journal too far inclined: evaluations refuse such a state.
    fn touches_or_none(&self, pair: &Pair) -> [Option<Touch>; 2] {
        self.touches(pair).unwrap_or_default()
    }

    fn pair(&self, motion: &Motion<'_>) -> Pair {
        let centre = |at: &Attachment| centre(at, &self.axis, motion);
        Pair {
            bearing: centre(&self.bearing),
            journal: centre(&self.journal),
        }
    }

    /// Normal force at a touch: the law's, or half of it at each edge.
    fn normal(&self, touch: &Touch, impact_speed: f64) -> NormalForce {
        let force = self.clearance.law.at(touch.depth, touch.rate, impact_speed);
        match self.clearance.model {
            ClearanceModel::Planar | ClearanceModel::Spherical => force,
            ClearanceModel::Spatial { .. } => force.scaled(0.5),
        }
    }

    /// Axes of the bearing's frame.
    fn axes(&self, positions: &Positions) -> Matrix3<f64> {
        positions.nodes()[self.bearing.link.node()].rotation * self.bearing.pose.rotation
    }

    /// Bristles and impact speed of a point.
    fn kept<'a>(&self, motion: &Motion<'a>, point: usize) -> (&'a [f64], f64) {
        let bristles = self.clearance.directions();
        let states = &motion.internal.states[point * bristles..(point + 1) * bristles];
        (states, kept::impact_speed(motion.internal.memory, point))
    }
}

/// A frame's origin and axis in motion.
fn centre(at: &Attachment, axis: &Vector3<f64>, motion: &Motion<'_>) -> Centre {
    let Moving { point, velocity, .. } = motion.origin(at);
    Centre {
        point,
        velocity,
        spin: motion.velocities.nodes()[at.link.node()].angular,
        axis: motion.positions.nodes()[at.link.node()].rotation * (at.pose.rotation * axis),
    }
}

impl ContactLoad for ClearanceJoint {
    fn describe(&self) -> String {
        format!("joint `{}` has clearance", self.name)
    }

    fn points(&self) -> usize {
        self.clearance.model.points()
    }

    fn observe(&self, motion: &Motion<'_>, point: usize) -> ContactPoint {
        let (pair, axes) = (self.pair(motion), self.axes(motion.positions));
        let (bristles, impact_speed) = self.kept(motion, point);
        let eccentricity = axes.tr_mul(&(pair.journal.point - pair.bearing.point));
        let mut seen = ContactPoint {
            depth: -self.gaps(&pair)[point],
            rate: -self.gap_rates(&pair)[point],
            impact_speed,
            journal: self.seen_along.map(|direction| direction.dot(&eccentricity)),
            directions: self.clearance.directions(),
            ..ContactPoint::default()
        };
        seen.bristle[..bristles.len()].copy_from_slice(bristles);
        if impact_speed > 0.0
            && let Some(touch) = self.touches_or_none(&pair)[point]
        {
            let rubbing = self.clearance.rubbing(&touch, &pair, || axes, bristles);
            seen.normal = self.normal(&touch, impact_speed).value;
            let directions = |parts| self.clearance.in_directions(&touch, &axes, parts);
            seen.tangent = directions(rubbing.coefficients.map(|mu| mu * seen.normal));
            seen.slip = directions([touch.slip, touch.axial_slip]);
        }
        seen
    }

    fn columns(&self) -> &'static [&'static str] {
        ContactPoint::columns(self.clearance.directions())
    }

    fn bristle(&self) -> Option<&Bristle> {
        self.clearance.friction.as_ref()
    }

    fn clearance(&self) -> Option<f64> {
        Some(self.clearance.fit.clearance())
    }
}

impl Load for ClearanceJoint {
    fn internals(&self) -> Internals {
        let points = self.points();
        Internals {
            states: points * self.clearance.directions(),
            integrals: points * ContactIntegrals::COUNT,
            memory: points * kept::COUNT,
            roots: points,
        }
    }

    fn apply(&self, motion: &Motion<'_>, loads: &mut Loads<'_>) {
        let points = self.points();
        let free = (0..points).all(|point| self.kept(motion, point).1 == 0.0);
        // A journal across its bearing is refused even while it touches nothing.
        let may_tilt = matches!(self.clearance.model, ClearanceModel::Spatial { .. });
        if free && !may_tilt {
            return;
        }
        let pair = self.pair(motion);
        let touches = match self.touches(&pair) {
            Ok(touches) => touches,
            Err(skewed) => return loads.refuse(format!("clearance of joint `{}`: {skewed}", self.name)),
        };
        if free {
            return;
        }
        let bristles = self.clearance.directions();
        for (point, touch) in touches.iter().enumerate().take(points) {
            let (z, impact_speed) = self.kept(motion, point);
            let (Some(touch), true) = (touch, impact_speed > 0.0) else {
                continue;
            };
            let normal = self.normal(touch, impact_speed);
            let rubbing = self.clearance.rubbing(touch, &pair, || self.axes(motion.positions), z);
            loads.state_rates[point * bristles..(point + 1) * bristles].copy_from_slice(&rubbing.rates[..bristles]);
            if normal.value == 0.0 && normal.elastic == 0.0 {
                continue;
            }
            let friction = rubbing.coefficients.map(|mu| mu * normal.value);
            let force = touch.force(normal.value, friction, self.clearance.force_point);
            let origin = |at: &Attachment| motion.positions.nodes()[at.link.node()].origin;
            let on_bearing = Wrench {
                torque: force.torque_on_bearing(&origin(&self.bearing)),
                force: force.on_bearing,
            };
            let on_journal = Wrench {
                torque: force.torque_on_journal(&origin(&self.journal)),
                force: -force.on_bearing,
            };
            loads.add_wrench(self.bearing.link, on_bearing);
            loads.add_wrench(self.journal.link, on_journal);
            let storing = normal.elastic * touch.rate;
            loads.stores(storing);
            let power = force.power(&pair.bearing, &pair.journal);
            let damping_loss = normal.value * touch.rate - storing;
            let integrals = ContactIntegrals {
                damping_loss,
                friction_loss: -power - normal.value * touch.rate,
                impulse: normal.value,
                square: normal.value * normal.value,
            };
            integrals.write(&mut loads.integral_rates[point * ContactIntegrals::COUNT..]);
        }
    }

    fn potential_energy(&self, motion: &Motion<'_>) -> f64 {
        let pair = self.pair(motion);
        let share = 1.0 / self.points() as f64;
        let stored = |(point, touch): (usize, &Option<Touch>)| match touch {
            Some(touch) if self.kept(motion, point).1 > 0.0 => share * self.clearance.law.stored_energy(touch.depth),
            _ => 0.0,
        };
        self.touches_or_none(&pair)
            .iter()
            .enumerate()
            .take(self.points())
            .map(stored)
            .sum()
    }

    fn roots(&self, motion: &Motion<'_>, roots: &mut [f64]) {
        let gaps = self.gaps(&self.pair(motion));
        for (point, (root, gap)) in roots.iter_mut().zip(gaps).enumerate() {
            *root = kept::root(motion.internal.memory, point, gap);
        }
    }

    fn at_event(&self, motion: &Motion<'_>, fired: &[bool], states: &mut [f64], memory: &mut [f64]) {
        let pair = self.pair(motion);
        let rates = self.gap_rates(&pair);
        let (touches, bristles) = (self.touches_or_none(&pair), self.clearance.directions());
        let axes = self.axes(motion.positions);
        for point in (0..self.points()).filter(|&point| fired[point]) {
            let z = &mut states[point * bristles..(point + 1) * bristles];
            z.fill(0.0);
            let made = kept::switch(memory, point, motion.t, -rates[point], self.clearance.fit.clearance());
            if !made {
                continue;
            }
            if let (Some(model), Some(touch)) = (&self.clearance.friction, touches[point]) {
                self.clearance.begin_rubbing(model, &touch, &axes, z);
            }
        }
    }
}
