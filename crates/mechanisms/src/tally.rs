//! Figures of contacts over a run.

use crate::clearance::{ContactIntegrals, ContactPoint};
use crate::run::Seen;

/// Figures of all contact points over a run, from what [`run_watched`](crate::run_watched) shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// One for each contact point, in the order of [`Mechanism::contact_names`](crate::Mechanism::contact_names).
    pub points: Vec<PointTally>,
    /// Beginning and end of what was seen \[s\].
    pub span: (f64, f64),
    scratch: Vec<ContactPoint>,
}

/// Figures of one contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointTally {
    /// Contacts made.
    pub impacts: u64,
    /// Those among them that were held, see [`ContactEvent::held`](crate::ContactEvent::held).
    pub held: u64,
    /// Time in contact \[s\], up to the last contact lost.
    closed: f64,
    /// Beginning of the contact that lasts, and its speed of approach.
    open: Option<(f64, f64)>,
    /// Greatest normal force at the ends of steps \[N\].
    pub peak_force: f64,
    /// Greatest penetration at the ends of steps \[m\].
    pub greatest_depth: f64,
    /// Greatest speed of approach \[m/s\].
    pub fastest: f64,
    /// Sum of the ratios of the speeds of separation and approach, and their number.
    ratios: (f64, u64),
    /// Integrals over time.
    pub integrals: ContactIntegrals,
}

impl PointTally {
    /// Time in contact until `end` \[s\].
    pub fn contact_time(&self, end: f64) -> f64 {
        self.closed + self.open.map_or(0.0, |(since, _)| end - since)
    }

    /// Mean ratio of the speeds of separation and approach \[-\]; none before the first contact is lost.
    pub fn restitution(&self) -> Option<f64> {
        let (sum, count) = self.ratios;
        (count > 0).then(|| sum / count as f64)
    }

    /// Mean normal force while in contact \[N\].
    pub fn mean_force(&self, end: f64) -> f64 {
        over(self.integrals.impulse, self.contact_time(end))
    }

    /// Root of the mean square of the normal force while in contact \[N\].
    pub fn rms_force(&self, end: f64) -> f64 {
        over(self.integrals.square, self.contact_time(end)).max(0.0).sqrt()
    }
}

fn over(integral: f64, time: f64) -> f64 {
    if time > 0.0 { integral / time } else { 0.0 }
}

impl Tally {
    /// Takes in what a run shows.
    pub fn see(&mut self, seen: &mut Seen<'_>) {
        match seen {
            Seen::Row(observation) if self.points.is_empty() => {
                self.points.resize(observation.contacts.len(), PointTally::default());
                self.span = (observation.t, observation.t);
            }
            Seen::Row(_) => {}
            Seen::Contact { t, event } => {
                let Some(point) = self.points.get_mut(event.point) else {
                    return;
                };
                if event.made {
                    point.impacts += 1;
                    point.held += u64::from(event.held);
                    point.open = Some((*t, event.speed));
                    point.fastest = point.fastest.max(event.speed);
                } else if let Some((since, approach)) = point.open.take() {
                    point.closed += *t - since;
                    if approach > 0.0 {
                        point.ratios = (point.ratios.0 + event.speed / approach, point.ratios.1 + 1);
                    }
                }
            }
            Seen::Step { t, y, simulation, .. } => {
                self.span.1 = *t;
                if self.points.is_empty() {
                    return;
                }
                simulation.contact_points(*t, y, &mut self.scratch);
                let integrals = &y[simulation.layout().integrals.clone()];
                let integrals = integrals.chunks(ContactIntegrals::COUNT);
                for ((point, seen), integrals) in self.points.iter_mut().zip(&self.scratch).zip(integrals) {
                    point.peak_force = point.peak_force.max(seen.normal);
                    point.greatest_depth = point.greatest_depth.max(seen.depth);
                    point.integrals = ContactIntegrals::read(integrals);
                }
            }
        }
    }

    /// The contact points as they were at the end of the last step.
    pub fn last(&self) -> &[ContactPoint] {
        &self.scratch
    }
}
