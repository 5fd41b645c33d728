//! What a run has cost.

/// Counters of a run. Attempted steps = `accepted` + `rejected`.
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
    /// Calls of [`Ode::project`](crate::Ode::project).
    pub projections: u64,
    /// Answers [`EvalError::Retry`](crate::EvalError::Retry), each of which threw a step away.
    pub retries: u64,
    /// Corrector iterations of implicit formulas.
    pub iterations: u64,
    /// Jacobian matrices formed.
    pub jacobians: u64,
    /// Matrices factorised.
    pub factorisations: u64,
    /// Events located.
    pub events: u64,
}
