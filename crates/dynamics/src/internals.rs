//! Loads with states of their own: what they see, their root functions, their events.

use crate::load::{Instant, InternalState, Load, Motion};
use crate::system::{Place, System};
use crate::workspace::Workspace;
use std::ops::Range;
use std::sync::Arc;

impl System {
    /// The loads with internals, each with its place among the internals of all.
    fn with_internals(&self) -> impl Iterator<Item = (&Arc<dyn Load>, &Place)> {
        self.loads[self.plain_loads..].iter().zip(&self.places)
    }

    /// The motion with the internals of one load; zeros where `internal` has not got them all.
    #[inline]
    pub(crate) fn seen_by<'a>(&'a self, place: &Place, motion: &Motion<'a>, internal: InternalState<'a>) -> Motion<'a> {
        let cut = |all: &'a [f64], range: &Range<usize>| all.get(range.clone()).unwrap_or(&self.zeros[..range.len()]);
        Motion {
            internal: InternalState {
                states: cut(internal.states, &place.states),
                memory: cut(internal.memory, &place.memory),
            },
            ..*motion
        }
    }

    /// Calls `ask` for each load with internals, with the motion as that load sees it. Positions and velocities in `work` become
    /// those of this state.
    pub fn ask_loads(
        &self,
        at: &Instant<'_>,
        work: &mut Workspace,
        mut ask: impl FnMut(&dyn Load, &Motion<'_>, &Place),
    ) {
        let Instant { t, q, v, internal } = *at;
        self.tree.positions(q, &mut work.positions);
        self.tree.velocities(&work.positions, v, &mut work.velocities);
        let motion = Motion {
            t,
            q,
            v,
            positions: &work.positions,
            velocities: &work.velocities,
            internal: InternalState::default(),
        };
        for (load, place) in self.with_internals() {
            ask(load.as_ref(), &self.seen_by(place, &motion, internal), place);
        }
    }

    /// Writes the root functions of all loads, one load after the other.
    pub fn roots(&self, at: &Instant<'_>, work: &mut Workspace, roots: &mut [f64]) {
        self.ask_loads(at, work, |load, motion, place| {
            load.roots(motion, &mut roots[place.roots.clone()]);
        });
    }

    /// Lets all loads with a root function that has `fired` change their states and memory; `before` holds these as they were.
    pub fn at_event(
        &self,
        before: &Instant<'_>,
        fired: &[bool],
        (states, memory): (&mut [f64], &mut [f64]),
        work: &mut Workspace,
    ) {
        self.ask_loads(before, work, |load, motion, place| {
            let fired = &fired[place.roots.clone()];
            if fired.contains(&true) {
                let (states, memory) = (&mut states[place.states.clone()], &mut memory[place.memory.clone()]);
                load.at_event(motion, fired, states, memory);
            }
        });
    }
}
