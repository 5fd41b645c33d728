//! What a run has cost.

/// Counters of a run. Attempted steps = `accepted` + `rejected` + `relocations`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Statistics {
    /// Steps taken.
    pub accepted: u64,
    /// Steps tried and thrown away: error too large, state not finite, or [`EvalError::Retry`](crate::EvalError::Retry).
    pub rejected: u64,
    /// All calls of [`Ode::rhs`](crate::Ode::rhs), failed ones included.
    pub evaluations: u64,
    /// Those of the evaluations that only interpolation asked for.
    pub dense_evaluations: u64,
    /// Those of the evaluations that only differences for Jacobian matrices asked for.
    pub jacobian_evaluations: u64,
    /// Calls of [`Ode::project`](crate::Ode::project).
    pub projections: u64,
    /// Answers [`EvalError::Retry`](crate::EvalError::Retry), each of which threw a step away.
    pub retries: u64,
    /// Corrector iterations of implicit formulas.
    pub iterations: u64,
    /// Attempts given up because the corrector of an implicit formula did not converge; part of those rejected.
    pub divergences: u64,
    /// Jacobian matrices formed, by the problem or by differences.
    pub jacobians: u64,
    /// Matrices factorised; [`Radau5`](crate::Radau5) factorises two at a time, a real and a complex one.
    pub factorisations: u64,
    /// Events located.
    pub events: u64,
    /// Calls of [`Ode::root`](crate::Ode::root).
    pub root_evaluations: u64,
    /// Steps tried, found to hold an event and thrown away, to be made again with the length that leads to it.
    pub relocations: u64,
}
