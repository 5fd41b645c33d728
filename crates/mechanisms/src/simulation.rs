//! A mechanism in motion: the initial value problem.

use crate::error::MotionError;
use crate::events::{ContactEvent, Memory, Switching};
use crate::mechanism::{Mechanism, State};
use linkdyn_dynamics::{Counters, Drift, Instant, InternalState, System, Workspace};
use linkdyn_integrators::{EvalError, Ode, SecondOrder, Settings, Tolerance};
use std::ops::Range;
use thiserror::Error;

/// A mechanism with scratch of its own; clone it to send it to another thread.
///
/// The state is `y = (q, v, s, W, e)`: coordinates, speeds, internal states of loads (bristles), where a load is not
/// conservative the work \[J\] that loads have done on the mechanism since the start, and integrals of loads (energies lost in
/// contacts). Closures are kept by projection after each step.
///
/// Numbers that change at events only, the memory of loads, stand beside it: they are constant in every step. The memory of the
/// time before the last event is kept too, so that states within the step that led to it can be observed (in runs forward in
/// time; a contact has no meaning in the other direction, where it would have to begin with the speed at which it ends).
#[derive(Clone, Debug)]
pub struct Simulation {
    pub(crate) mechanism: Mechanism,
    pub(crate) work: Workspace,
    pub(crate) layout: Layout,
    pub(crate) memory: Memory,
    /// Internal states as they were before an event.
    pub(crate) states_before: Vec<f64>,
    /// What the last event was.
    pub(crate) happened: Vec<ContactEvent>,
    pub(crate) switching: Switching,
    /// Scratch for root functions.
    pub(crate) roots: Vec<f64>,
    pub(crate) fired: Vec<bool>,
    /// Root functions that have been positive, where they are asked for after steps only.
    pub(crate) armed: Vec<bool>,
    drift_tolerance: f64,
    worst: Worst,
}

/// Where the parts of the state vector stand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Coordinates.
    pub coordinates: Range<usize>,
    /// Speeds.
    pub speeds: Range<usize>,
    /// Internal states of loads.
    pub states: Range<usize>,
    /// Work of loads that are not conservative: one number or none.
    pub work: Range<usize>,
    /// Integrals of loads.
    pub integrals: Range<usize>,
}

impl Layout {
    fn new(counts: [usize; 5]) -> Self {
        let mut end = 0;
        let [coordinates, speeds, states, work, integrals] = counts.map(|count| {
            end += count;
            end - count..end
        });
        Self {
            coordinates,
            speeds,
            states,
            work,
            integrals,
        }
    }

    /// Length of the state vector.
    pub fn len(&self) -> usize {
        self.integrals.end
    }

    /// Whether there is nothing; never for a simulation.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Absolute tolerance of speeds in units of that of coordinates \[1/s\]: about the speed at which linkages turn. On RSRRR this
/// costs a quarter fewer evaluations for the same error of the crank angle than equal tolerances do.
pub const SPEED_SCALE: f64 = 10.0;

/// As [`SPEED_SCALE`], with clearance or limits \[1/s\]. Contacts vibrate with 1e4 1/s and more; between 1e2 and 1e5 this value is about the best
/// for the error of the RSUP scene against its evaluations.
pub const CONTACT_SPEED_SCALE: f64 = 1e3;

/// Closure residual beyond which a step has left the mechanism \[m, -\]: projection takes drift, which is far smaller.
pub(crate) const OFF_THE_LOOP: f64 = 1e-6;

/// A step so long that its end could not be put back onto the loops.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the step leaves the loops by {0:e}, too far to be put back; a shorter step may help")]
pub struct OffTheLoop(
    /// Largest closure residual that remained \[m, -\].
    pub f64,
);

/// Worst figures met so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// Largest closure residual found before a projection \[m, -\].
    pub position_drift: f64,
    /// Largest closure rate found before a projection \[m/s, 1/s\].
    pub velocity_drift: f64,
    /// Largest relative residual of the loop reaction - friction - acceleration over all evaluations.
    pub friction_residual: f64,
}

impl Simulation {
    /// A simulation of `mechanism`.
    pub fn new(mechanism: &Mechanism) -> Self {
        let system = mechanism.system();
        let conservative = system.loads().iter().all(|load| load.is_conservative());
        let has_work = !conservative || mechanism.has_friction() || !system.guided().is_empty();
        let (tree, internals) = (system.tree(), system.internals());
        let layout = Layout::new([
            tree.coordinates(),
            tree.speeds(),
            internals.states,
            usize::from(has_work),
            internals.integrals,
        ]);
        Self {
            work: Workspace::new(system),
            layout,
            memory: Memory::new(internals.memory),
            states_before: vec![0.0; internals.states],
            happened: Vec::with_capacity(internals.roots),
            switching: Switching::default(),
            roots: Vec::new(),
            fired: Vec::new(),
            armed: Vec::new(),
            drift_tolerance: 0.0,
            worst: Worst::default(),
            mechanism: mechanism.clone(),
        }
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }

    /// The state vector of a start, with no work done yet and all bristles at rest.
    pub fn state_vector(&self, state: &State) -> Vec<f64> {
        let mut y = [state.q.as_slice(), state.v.as_slice()].concat();
        y.resize(self.layout.len(), 0.0);
        y
    }

    /// Where the parts of the state vector stand.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Tolerances for an integration: `relative` for all of the state, `absolute` for coordinates \[rad, m\] and bristles \[m\],
    /// [`SPEED_SCALE`] times that for speeds. Work and integrals follow the motion and are not controlled.
    ///
    /// With clearance or limits a crank that has turned many times must be known as well as one that has not, since penetrations are
    /// micrometres: then `absolute` alone counts, and [`CONTACT_SPEED_SCALE`] times that for speeds.
    pub fn settings(&self, relative: f64, absolute: f64) -> Settings {
        let contacts = !self.mechanism.contacts.is_empty();
        let (relative, scale) = if contacts {
            (0.0, CONTACT_SPEED_SCALE)
        } else {
            (relative, SPEED_SCALE)
        };
        let mut components = vec![absolute; self.layout.len()];
        components[self.layout.speeds.clone()].fill(scale * absolute);
        components[self.layout.work.start..].fill(f64::INFINITY);
        Settings {
            absolute: Tolerance::from(components),
            ..Settings::tolerances(relative, absolute)
        }
    }

    /// Lets steps leave closure residuals and rates up to this size \[m, m/s, -\] instead of projecting every one; zero, the
    /// default, projects always. Observed states are put on the closures in any case.
    pub fn set_drift_tolerance(&mut self, tolerance: f64) {
        self.drift_tolerance = tolerance;
    }

    /// Work counters since the start, observations included.
    pub fn counters(&self) -> Counters {
        self.work.counters()
    }

    /// Worst figures since the start.
    pub fn worst(&self) -> Worst {
        self.worst
    }

    /// What loads have kept since the last event, such as impact speeds; with the state vector it is all that a run needs to go on.
    pub fn memory(&self) -> &[f64] {
        &self.memory.now
    }

    /// Sets the memory of loads, to go on from a saved state.
    ///
    /// # Panics
    /// If its length is not that of [`memory`](Self::memory).
    pub fn set_memory(&mut self, memory: &[f64]) {
        self.memory.now.copy_from_slice(memory);
        self.memory.since = f64::NEG_INFINITY;
    }

    /// Chooses when contacts are made and lost; before an integration begins.
    pub fn set_switching(&mut self, switching: Switching) {
        self.switching = switching;
    }

    /// When contacts are made and lost.
    pub fn switching(&self) -> Switching {
        self.switching
    }

    /// Contacts made and lost at the last event.
    pub fn happened(&self) -> &[ContactEvent] {
        &self.happened
    }

    /// Accelerations at a state in which loads have kept nothing.
    ///
    /// # Errors
    /// [`MotionError`] where they do not exist.
    pub fn accelerations(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<&[f64], MotionError> {
        let evaluated = self.mechanism.system.evaluate(t, q, v, &mut self.work);
        evaluated.map_err(|cause| self.mechanism.explain(cause))?;
        Ok(self.work.rates())
    }

    /// Puts a state vector back onto closures and prescribed motions at time `t` \[s\].
    pub fn put_on_closures(&mut self, t: f64, y: &mut [f64]) -> Drift {
        self.project_by(|system, q, v, work| system.project(t, q, v, work), y)
    }

    fn project_by(
        &mut self,
        project: impl FnOnce(&System, &mut [f64], &mut [f64], &mut Workspace) -> Drift,
        y: &mut [f64],
    ) -> Drift {
        let (q, rest) = y.split_at_mut(self.layout.speeds.start);
        let (system, v) = (&self.mechanism.system, &mut rest[..self.layout.speeds.len()]);
        let drift = project(system, q, v, &mut self.work);
        self.worst.position_drift = self.worst.position_drift.max(drift.position);
        self.worst.velocity_drift = self.worst.velocity_drift.max(drift.velocity);
        drift
    }
}

impl Layout {
    /// A state vector with the memory of loads, as mechanics see it.
    #[inline]
    pub(crate) fn instant<'a>(&self, t: f64, y: &'a [f64], memory: &'a [f64]) -> Instant<'a> {
        Instant {
            t,
            q: &y[self.coordinates.clone()],
            v: &y[self.speeds.clone()],
            internal: InternalState {
                states: &y[self.states.clone()],
                memory,
            },
        }
    }
}

impl Ode for Simulation {
    fn dim(&self) -> usize {
        self.layout.len()
    }

    #[inline]
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        let system = &self.mechanism.system;
        let at = self.layout.instant(t, y, &self.memory.now);
        // A trial state may lie where the mechanism jams or stretches; a shorter step may not.
        let evaluated = system.evaluate_with(&at, &mut self.work);
        evaluated.map_err(|cause| EvalError::Retry(Box::new(self.mechanism.explain(cause))))?;
        let (q_rate, rest) = dy.split_at_mut(self.layout.coordinates.end);
        let (v_rate, rest) = rest.split_at_mut(self.layout.speeds.len());
        let (state_rates, rest) = rest.split_at_mut(self.layout.states.len());
        let (work_rate, integral_rates) = rest.split_at_mut(self.layout.work.len());
        system.tree().coordinate_rates(at.q, at.v, q_rate);
        v_rate.copy_from_slice(self.work.rates());
        state_rates.copy_from_slice(self.work.state_rates());
        if let Some(rate) = work_rate.first_mut() {
            *rate = self.work.power();
        }
        integral_rates.copy_from_slice(self.work.integral_rates());
        self.worst.friction_residual = self.worst.friction_residual.max(self.work.reaction_residual());
        Ok(())
    }

    fn quadratures(&self) -> usize {
        self.layout.len() - self.layout.work.start
    }

    fn second_order_pairs(&self) -> usize {
        self.pairs()
    }

    fn roots(&self) -> usize {
        match self.switching {
            Switching::Located => self.mechanism.system.internals().roots,
            Switching::AtSteps => 0,
        }
    }

    fn root(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        let at = self.layout.instant(t, y, &self.memory.now);
        self.mechanism.system.roots(&at, &mut self.work, g);
        Ok(())
    }

    fn at_event(&mut self, t: f64, y: &mut [f64], fired: &[bool]) -> Result<(), EvalError> {
        self.meet_event(t, y, fired);
        Ok(())
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        let tolerance = self.drift_tolerance;
        let drift = self.project_by(|system, q, v, work| system.project_beyond(t, tolerance, q, v, work), y);
        if drift.remaining > OFF_THE_LOOP {
            return Err(EvalError::Retry(Box::new(OffTheLoop(drift.remaining))));
        }
        Ok(drift.changed)
    }
}

impl SecondOrder for Simulation {
    /// All coordinates, or none where the speeds are not their rates (ball joints with quaternions).
    fn pairs(&self) -> usize {
        if self.layout.coordinates.len() == self.layout.speeds.len() {
            self.layout.speeds.len()
        } else {
            0
        }
    }
}
