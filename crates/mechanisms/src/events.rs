//! Contacts made and lost: what loads keep between events, and what happens at one.

use crate::contact_load::kept;
use crate::simulation::Simulation;
use linkdyn_dynamics::{Instant, InternalState};

/// When contacts are made and lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Switching {
    /// At the very time, which is located as the root of the gap.
    #[default]
    Located,
    /// At the end of the step in which it happens, the second paper's way: [`run`](crate::run()) asks after each step.
    AtSteps,
}

/// A contact made or lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvent {
    /// Contact point, in the order of [`Mechanism::contact_names`](crate::Mechanism::contact_names).
    pub point: usize,
    /// Whether it is made, else lost.
    pub made: bool,
    /// Speed of approach or of separation \[m/s\]; at the limit of a turn \[rad/s\].
    pub speed: f64,
    /// Whether a contact made is held: after many short hops in a row it counts as lost only when a larger gap opens.
    pub held: bool,
}

/// Numbers that loads keep between events, from the last event on and before it.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    pub now: Vec<f64>,
    pub before: Vec<f64>,
    /// Time of the last event \[s\].
    pub since: f64,
}

impl Memory {
    pub fn new(count: usize) -> Self {
        Self {
            now: vec![0.0; count],
            before: vec![0.0; count],
            since: f64::NEG_INFINITY,
        }
    }

    /// The memory at a time not before the last event but one, in a run forward in time.
    #[inline]
    pub fn at(&self, t: f64) -> &[f64] {
        if t < self.since { &self.before } else { &self.now }
    }
}

impl Simulation {
    /// Lets loads change their states and memory, and notes what happened.
    pub(crate) fn meet_event(&mut self, t: f64, y: &mut [f64], fired: &[bool]) {
        self.memory.before.copy_from_slice(&self.memory.now);
        self.memory.since = t;
        self.states_before.copy_from_slice(&y[self.layout.states.clone()]);
        let (motion, rest) = y.split_at_mut(self.layout.states.start);
        let before = Instant {
            t,
            q: &motion[self.layout.coordinates.clone()],
            v: &motion[self.layout.speeds.clone()],
            internal: InternalState {
                states: &self.states_before,
                memory: &self.memory.before,
            },
        };
        let states = &mut rest[..self.layout.states.len()];
        let system = &self.mechanism.system;
        system.at_event(&before, fired, (states, &mut self.memory.now), &mut self.work);
        self.happened.clear();
        let (mut contacts, mut first) = (self.mechanism.contacts.iter(), 0);
        system.ask_loads(&before, &mut self.work, |_, motion, place| {
            let Some(contact) = contacts.next() else { return };
            let points = place.roots.clone().zip(0..contact.load.points());
            for (_, point) in points.filter(|(root, _)| fired[*root]) {
                let seen = contact.load.observe(motion, point);
                let made = seen.impact_speed == 0.0;
                self.happened.push(ContactEvent {
                    point: first + point,
                    made,
                    speed: if made { seen.rate } else { -seen.rate },
                    held: kept::is_held(&self.memory.now[place.memory.clone()], point),
                });
            }
            first += contact.load.points();
        });
    }

    /// Makes the contacts that are there before anything has happened: where the journal of a start already lies in its bearing, or a coordinate at its limit.
    /// Root functions tell only of those that begin later. Tells whether there were any; [`run`](crate::run()) begins with this.
    pub fn begin(&mut self, t: f64, y: &mut [f64]) -> bool {
        self.happened.clear();
        let mut fired = std::mem::take(&mut self.fired);
        fired.clear();
        fired.resize(self.mechanism.system.internals().roots, false);
        let at = self.layout.instant(t, y, &self.memory.now);
        let mut contacts = self.mechanism.contacts.iter();
        self.mechanism
            .system
            .ask_loads(&at, &mut self.work, |_, motion, place| {
                let Some(contact) = contacts.next() else { return };
                for (point, root) in place.roots.clone().enumerate() {
                    fired[root] = contact.load.begins_in_contact(motion, point);
                }
            });
        let any = fired.contains(&true);
        if any {
            self.meet_event(t, y, &fired);
        }
        self.fired = fired;
        if self.switching == Switching::AtSteps {
            self.measure_roots(t, y);
            self.armed.clear();
            self.armed.extend(self.roots.iter().map(|&g| g > 0.0));
        }
        any
    }

    /// Makes and loses contacts at the end of a step where that is not left to the integration; tells whether there were any.
    pub(crate) fn switch_at_step(&mut self, t: f64, y: &mut [f64]) -> bool {
        if self.switching != Switching::AtSteps {
            return false;
        }
        self.measure_roots(t, y);
        let mut fired = std::mem::take(&mut self.fired);
        let pairs = || self.roots.iter().zip(&self.armed);
        fired.clear();
        fired.extend(pairs().map(|(&g, &armed)| armed && g < 0.0));
        let any = fired.contains(&true);
        if any {
            self.meet_event(t, y, &fired);
            self.measure_roots(t, y);
        }
        for ((armed, &g), &fired) in self.armed.iter_mut().zip(&self.roots).zip(&fired) {
            *armed = g > 0.0 || (*armed && !fired);
        }
        self.fired = fired;
        any
    }

    fn measure_roots(&mut self, t: f64, y: &[f64]) {
        self.roots.resize(self.mechanism.system.internals().roots, 0.0);
        let at = self.layout.instant(t, y, &self.memory.now);
        self.mechanism.system.roots(&at, &mut self.work, &mut self.roots);
    }
}
