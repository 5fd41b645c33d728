//! What of a run is kept in memory: the curves of the pictures and the figures of the summary.

use std::f64::consts::TAU;

use linkdyn_mechanisms::Observation;

/// Curves over time, one point an output.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// Output times \[s\].
    pub t: Vec<f64>,
    /// Coordinates, one curve each.
    pub q: Vec<Vec<f64>>,
    /// Speeds.
    pub v: Vec<Vec<f64>>,
    /// Size of each joint's force \[N\].
    pub force: Vec<Vec<f64>>,
    /// Size of each joint's torque \[N m\].
    pub torque: Vec<Vec<f64>>,
    /// Largest force of a loop's multipliers (norm) \[N\].
    pub multipliers: f64,
    /// Energy balance at the start \[J\].
    balance: Option<f64>,
    /// Largest deviation of the energy balance from its start \[J\].
    pub energy_error: f64,
    /// Largest closure residual and rate at an output.
    pub violation: (f64, f64),
    /// Largest friction torque or force of each joint with friction.
    pub friction: Vec<f64>,
    /// Work done up to the last output \[J\].
    pub work: f64,
}

impl Record {
    /// Adds an output.
    pub fn push(&mut self, o: &Observation) {
        self.t.push(o.t);
        append(&mut self.q, o.q.iter().copied());
        append(&mut self.v, o.v.iter().copied());
        append(&mut self.force, o.reactions.iter().map(|r| r.force.norm()));
        append(&mut self.torque, o.reactions.iter().map(|r| r.torque.norm()));
        let norm = o.multipliers.iter().map(|x| x * x).sum::<f64>().sqrt();
        self.multipliers = self.multipliers.max(norm);
        let start = *self.balance.get_or_insert(o.energy_balance());
        self.energy_error = self.energy_error.max((o.energy_balance() - start).abs());
        self.violation.0 = self.violation.0.max(o.violation.0);
        self.violation.1 = self.violation.1.max(o.violation.1);
        self.friction.resize(o.friction.len(), 0.0);
        for (most, friction) in self.friction.iter_mut().zip(&o.friction) {
            *most = most.max(friction.abs());
        }
        self.work = o.work;
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
