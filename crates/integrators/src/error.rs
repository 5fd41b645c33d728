//! How an integration can fail.

use crate::{SettingsError, Source};

/// Why an integration stopped. The state of the last accepted step is kept.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IntegrationError {
    /// Refused before the first step.
    #[error("settings: {0}")]
    Settings(#[from] SettingsError),
    /// The step would have to be shorter than the spacing of numbers near t allows: a singularity, a jump, or a stiff problem.
    #[error("at t = {time} the step {step:e} is too small{}; a singularity, a jump or stiffness?", of_component(*.component))]
    StepTooSmall {
        /// Time reached.
        time: f64,
        /// The step that was refused.
        step: f64,
        /// The component with the largest error in the last attempt, if it got so far.
        component: Option<usize>,
        /// The last [`EvalError::Retry`](crate::EvalError::Retry), if that is what refused the step.
        source: Option<Source>,
    },
    /// The state or its derivative is not finite, however short the step.
    #[error("at t = {time}, step {step:e}: component {component} is not finite")]
    NonFinite {
        /// Time reached.
        time: f64,
        /// The step that was refused; zero if the derivative at `time` itself is not finite.
        step: f64,
        /// The first component that is not finite.
        component: usize,
    },
    /// `max_steps` attempts are used up.
    #[error("at t = {time}: {steps} steps attempted, no more allowed")]
    TooManySteps {
        /// Time reached.
        time: f64,
        /// Attempts made.
        steps: u64,
    },
    /// A root function is not finite, however short the step.
    #[error("at t = {time}: root function {function} is not finite")]
    NonFiniteRoot {
        /// Time reached.
        time: f64,
        /// Index of the function.
        function: usize,
    },
    /// `max_events` are used up.
    #[error("at t = {time}: {events} events met, no more allowed")]
    TooManyEvents {
        /// Time reached, that of the next event.
        time: f64,
        /// Events met.
        events: u64,
    },
    /// So many events lie so close together that time does not go on: they accumulate, as those of a ball that bounces ever lower.
    #[error(
        "at t = {time}: {events} events at one time, root function {function} among the last; do they accumulate here?"
    )]
    EventsAccumulate {
        /// Time reached.
        time: f64,
        /// Events closer together than the spacing of numbers near t allows to tell.
        events: u64,
        /// Index of a function that met zero last.
        function: usize,
    },
    /// The problem gave up, or a method of fixed step met a state that it cannot evaluate.
    #[error("at t = {time}: {source}")]
    Problem {
        /// Time reached.
        time: f64,
        /// The error of the problem.
        source: Source,
    },
    /// A time to interpolate at lies outside the last step.
    #[error("t = {time} is outside the last step, {from} to {to}")]
    OutsideStep {
        /// The time asked for.
        time: f64,
        /// Where the last step began.
        from: f64,
        /// Where it ended.
        to: f64,
    },
}

fn of_component(component: Option<usize>) -> String {
    component
        .map(|index| format!(" (largest error in component {index})"))
        .unwrap_or_default()
}
