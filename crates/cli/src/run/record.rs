//! What of a run is kept in memory: the curves of the pictures and the figures of the summary.

use std::f64::consts::TAU;

use linkdyn_mechanisms::{Mechanism, Observation, Seen, Tally};

/// Curves over time, one point an output.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// Names of the coordinates.
    pub coordinates: Vec<String>,
    /// Output times \[s\].
    pub t: Vec<f64>,
    /// Coordinates, one curve each.
    pub q: Vec<Vec<f64>>,
    /// Speeds.
    pub v: Vec<Vec<f64>>,
    /// Accelerations at the ends of steps.
    pub accelerations: Vec<StepCurve>,
    /// Size of each joint's force \[N\].
    pub force: Vec<Vec<f64>>,
    /// Size of each joint's torque \[N m\].
    pub torque: Vec<Vec<f64>>,
    /// Largest force in each cut joint by its multipliers \[N\].
    pub loop_force: Vec<f64>,
    mechanism: Option<Mechanism>,
    /// Energy balance and potential energy at the start \[J\].
    start: Option<(f64, f64)>,
    /// Largest energy that was in motion: kinetic, stored, got from or given to weight, and work done \[J\].
    energy_moved: f64,
    /// Largest deviation of the energy balance from its start \[J\].
    pub energy_error: f64,
    /// Largest closure residual and rate at an output.
    pub violation: (f64, f64),
    /// Largest friction torque or force of each joint with friction.
    pub friction: Vec<f64>,
    /// Work done up to the last output \[J\].
    pub work: f64,
    /// Figures of contacts.
    pub tally: Tally,
    /// Contact points in time, one curve each.
    pub contacts: Vec<ContactCurve>,
    /// Integrals over time of the squares of all accelerations, by steps.
    squares: Vec<f64>,
    /// Accelerations and time at the end of the step before.
    before: (f64, Vec<f64>),
}

/// Share of the energy in motion that may be missing. RSRRR by Newmark's method with steps of 1e-2 s and the published runs of RSUP stay
/// below 1e-3; runs of `n_four_bar` that left their branch at a singular position lack 0.02 and more.
const MOST_ENERGY_LOST: f64 = 0.01;

/// A quantity in time, by steps; where steps are many only the largest value between two points is kept.
#[derive(Clone, Debug, Default)]
pub struct StepCurve {
    /// Times \[s\] and values.
    pub points: Vec<(f64, f64)>,
}

impl StepCurve {
    fn push(&mut self, t: f64, value: f64, spacing: f64) {
        let close = self.points.len() > 1 && t - self.points[self.points.len() - 2].0 < spacing;
        match self.points.last_mut() {
            Some(last) if close => {
                last.0 = t;
                if value.abs() > last.1.abs() {
                    last.1 = value;
                }
            }
            _ => self.points.push((t, value)),
        }
    }
}

/// A contact point in time.
#[derive(Clone, Debug, Default)]
pub struct ContactCurve {
    /// Normal force \[N\].
    pub normal: StepCurve,
    /// Centre of the journal in the bearing \[m\].
    pub journal: Vec<(f64, f64)>,
}

/// Most points of a curve by steps between two outputs.
const STEP_POINTS: f64 = 100.0;

impl Record {
    /// An empty record of runs of `mechanism`.
    #[must_use]
    pub fn new(mechanism: &Mechanism) -> Self {
        Self {
            coordinates: mechanism.coordinate_names().map(str::to_owned).collect(),
            mechanism: Some(mechanism.clone()),
            loop_force: vec![0.0; mechanism.loop_names().count()],
            ..Self::default()
        }
    }

    /// What belongs to a coordinate of this name.
    pub fn of<'a, T>(&self, coordinate: &str, curves: &'a [T]) -> Option<&'a T> {
        let k = self.coordinates.iter().position(|name| name == coordinate)?;
        curves.get(k)
    }

    /// Takes in what a run shows; `every` is the time between outputs \[s\].
    pub fn see(&mut self, seen: &mut Seen<'_>, every: f64) {
        self.tally.see(seen);
        match seen {
            Seen::Row(observation) => self.push(observation),
            Seen::Step {
                t, rates, simulation, ..
            } => {
                let layout = simulation.layout();
                let rates = &rates[layout.speeds.clone()];
                let (before, old) = (self.before.0, &mut self.before.1);
                if !old.is_empty() {
                    self.squares.resize(rates.len(), 0.0);
                    for ((sum, a), b) in self.squares.iter_mut().zip(&*old).zip(rates) {
                        // Exact for an acceleration that is straight over the step.
                        *sum += (*t - before) * (a * a + a * b + b * b) / 3.0;
                    }
                }
                old.clear();
                old.extend_from_slice(rates);
                self.before.0 = *t;
                let spacing = every / STEP_POINTS;
                self.accelerations.resize_with(rates.len(), StepCurve::default);
                for (curve, &a) in self.accelerations.iter_mut().zip(rates) {
                    curve.push(*t, a, spacing);
                }
                self.follow_contacts(*t, spacing);
            }
            Seen::Contact { .. } => {}
        }
    }

    fn follow_contacts(&mut self, t: f64, spacing: f64) {
        self.contacts
            .resize_with(self.tally.last().len(), ContactCurve::default);
        for (curve, point) in self.contacts.iter_mut().zip(self.tally.last()) {
            let count = curve.normal.points.len();
            curve.normal.push(t, point.normal, spacing);
            if curve.normal.points.len() == count {
                curve.journal.pop();
            }
            curve.journal.push((point.journal[0], point.journal[1]));
        }
    }

    /// Root of the mean square of acceleration `k` over the steps.
    #[must_use]
    pub fn acceleration_rms(&self, k: usize) -> Option<f64> {
        let span = self.tally.span.1 - self.tally.span.0;
        let square = self.squares.get(k)?;
        (span > 0.0).then(|| (square / span).sqrt())
    }

    /// Adds an output.
    fn push(&mut self, o: &Observation) {
        self.t.push(o.t);
        append(&mut self.q, o.q.iter().copied());
        append(&mut self.v, o.v.iter().copied());
        append(&mut self.force, o.reactions.iter().map(|r| r.force.norm()));
        append(&mut self.torque, o.reactions.iter().map(|r| r.torque.norm()));
        if let Some(mechanism) = &self.mechanism {
            for (most, force) in self.loop_force.iter_mut().zip(mechanism.loop_forces(&o.multipliers)) {
                *most = most.max(force);
            }
        }
        let (balance, potential) = *self.start.get_or_insert((o.energy_balance(), o.energy.potential));
        self.energy_error = self.energy_error.max((o.energy_balance() - balance).abs());
        let fallen = (o.energy.potential - potential).abs();
        let moved = o.energy.kinetic + o.energy.elastic.abs() + fallen + o.work.abs();
        // Below a millionth of what weight holds at the start all may be rounding.
        self.energy_moved = self.energy_moved.max(moved).max(1e-6 * potential.abs());
        self.violation.0 = self.violation.0.max(o.violation.0);
        self.violation.1 = self.violation.1.max(o.violation.1);
        self.friction.resize(o.friction.len(), 0.0);
        for (most, friction) in self.friction.iter_mut().zip(&o.friction) {
            *most = most.max(friction.abs());
        }
        self.work = o.work;
    }

    /// What to say where so much energy is missing that the run means nothing.
    #[must_use]
    pub fn energy_lost(&self) -> Option<String> {
        let share = self.energy_error / self.energy_moved;
        (share > MOST_ENERGY_LOST).then(|| {
            format!(
                "the run reached its end, but its energy balance is off by {:.3e} J, {:.0} % of all that was in motion; the rows are \
                 written and mean nothing",
                self.energy_error,
                100.0 * share
            )
        })
    }

    /// Mean speed of coordinate `k` over its last whole turns, as many as fit into the last `share` of the run, and where
    /// they begin \[s\]; `None` where it makes no whole turn.
    #[must_use]
    pub fn mean_speed(&self, k: usize, share: f64) -> Option<(f64, f64)> {
        let (first, last) = (*self.t.first()?, *self.t.last()?);
        let from = self.t.iter().position(|&t| t >= last - share * (last - first))?;
        let q = self.q.get(k)?;
        let turned = q.last()? - q[from];
        let whole = (turned / TAU).trunc() * TAU;
        let begin = q.last()? - whole;
        // Between two rows the angle is as good as straight.
        let after = (from + 1..q.len()).find(|&i| (q[i] - begin) * whole >= 0.0)?;
        let part = (begin - q[after - 1]) / (q[after] - q[after - 1]);
        let t = self.t[after - 1] + part * (self.t[after] - self.t[after - 1]);
        (whole != 0.0 && t < last).then(|| (whole / (last - t), t))
    }
}

fn append(curves: &mut Vec<Vec<f64>>, values: impl Iterator<Item = f64>) {
    for (k, value) in values.enumerate() {
        if curves.len() == k {
            curves.push(Vec::new());
        }
        curves[k].push(value);
    }
}

/// Largest value of a curve; zero for an empty one.
#[must_use]
pub fn peak(curve: &[f64]) -> f64 {
    curve.iter().copied().fold(0.0, f64::max)
}
