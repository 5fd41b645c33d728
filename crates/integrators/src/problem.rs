//! What a user states: the right-hand side of y' = f(t, y), and how an evaluation may fail.

use std::error::Error;

/// Any error of the caller, passed through unchanged.
pub type Source = Box<dyn Error + Send + Sync>;

/// Why a right-hand side could not be evaluated.
#[derive(Debug, thiserror::Error)]
pub enum EvalError {
    /// A smaller step may succeed: the trial state lies outside the domain of the problem.
    #[error("evaluation failed for this trial state: {0}")]
    Retry(#[source] Source),
    /// No step will succeed; the integration stops.
    #[error("evaluation failed: {0}")]
    Abort(#[source] Source),
}

/// An initial value problem y' = f(t, y).
///
/// `&mut self` lets a problem own its scratch memory. A method tries steps and throws some of them away, so nothing that
/// `rhs` stores may influence a later evaluation.
pub trait Ode {
    /// The number of components of y.
    fn dim(&self) -> usize;

    /// Writes f(t, y) into all of `dy`.
    ///
    /// # Errors
    /// [`EvalError::Retry`] where f is not defined at this (t, y), [`EvalError::Abort`] where going on is pointless.
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError>;

    /// Puts `y` back on the invariants of the problem and returns whether it was changed.
    ///
    /// Called on each accepted step, and by whoever wants an interpolated state on the invariants. By default there are none.
    ///
    /// # Errors
    /// As for [`rhs`](Ode::rhs); a `Retry` rejects the step.
    fn project(&mut self, _t: f64, _y: &mut [f64]) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// Writes df/dy at (t, y) into `matrix`, row after row (`matrix[i * dim + j]` is dfᵢ/dyⱼ), which holds zeros before; returns false
    /// if it is to be found by differences of f. By default it is.
    ///
    /// Implicit methods only. Their steps get shorter or need more evaluations where it is wrong, the result does not change.
    ///
    /// # Errors
    /// As for [`rhs`](Ode::rhs).
    fn jacobian(&mut self, _t: f64, _y: &[f64], _matrix: &mut [f64]) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// The number of components at the end of y on which f does not depend (quadratures). By default there are none.
    fn quadratures(&self) -> usize {
        0
    }

    /// The number of components, at the end of y but before the quadratures, whose equation is 0 = fᵢ(t, y) instead of yᵢ' = fᵢ(t, y).
    /// By default there are none. Methods that cannot solve such equations refuse the problem.
    ///
    /// What holds for f then holds for the equation. A start must fulfil the equations, those that follow from them by
    /// differentiation included; the algebraic components themselves need be near their values only.
    fn algebraic(&self) -> usize {
        0
    }

    /// The index of a component of a differential-algebraic problem (Hairer, Wanner II, VII.1): 1, the default, for
    /// components which the equations determine as they stand, 2 or 3 where they must be differentiated once or twice before.
    ///
    /// Errors of components of index k are measured after multiplication by the (k - 1)-th power of the step.
    fn index(&self, _component: usize) -> u32 {
        1
    }

    /// The number of positions with which y begins if as many rates follow: `y[i]' = y[pairs + i]`, as for [`SecondOrder`]. By
    /// default 0, which is never wrong; more saves implicit methods most of their linear algebra.
    fn second_order_pairs(&self) -> usize {
        0
    }

    /// The number of root functions; it must not change during a run. By default there are none.
    fn roots(&self) -> usize {
        0
    }

    /// Writes the root functions at (t, y) into all of `g`: an [event](Ode::at_event) is where one of them, having been positive,
    /// becomes zero or negative in the direction of the integration.
    ///
    /// They should be as smooth as f within a step, and cheap: two calls in every step, some twenty at an event. After a start,
    /// a stop or an event they are asked for up to 1e-4 of a step ahead.
    ///
    /// # Errors
    /// As for [`rhs`](Ode::rhs).
    fn root(&mut self, _t: f64, _y: &[f64], _g: &mut [f64]) -> Result<(), EvalError> {
        Ok(())
    }

    /// Changes the state at an event: `fired` tells which root functions met zero. `y` is on the invariants of the problem and
    /// must be left there.
    ///
    /// The problem may change itself too: f and the root functions may be others afterwards. (Numbers that events alone change
    /// are well kept as components of y whose derivatives are zero: states interpolated before the event then hold what was
    /// true there.)
    ///
    /// A function that fired may fire again once it has been positive; so it may after an event at which it turned round, from
    /// falling to rising or to rest. A function that is negative after the event without having been so before fires at once:
    /// there is then another event at the same time.
    ///
    /// # Errors
    /// Any error ends the integration.
    fn at_event(&mut self, _t: f64, _y: &mut [f64], _fired: &[bool]) -> Result<(), EvalError> {
        Ok(())
    }
}

/// A problem whose state begins with positions and their rates.
///
/// The first `pairs` entries of y are positions, the next `pairs` are their rates (`y[i]' = y[pairs + i]`); what follows is of
/// first order.
pub trait SecondOrder: Ode {
    /// The number of positions.
    fn pairs(&self) -> usize;
}

impl<P: Ode + ?Sized> Ode for &mut P {
    fn dim(&self) -> usize {
        (**self).dim()
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        (**self).rhs(t, y, dy)
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        (**self).project(t, y)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], matrix: &mut [f64]) -> Result<bool, EvalError> {
        (**self).jacobian(t, y, matrix)
    }
    fn quadratures(&self) -> usize {
        (**self).quadratures()
    }
    fn algebraic(&self) -> usize {
        (**self).algebraic()
    }
    fn index(&self, component: usize) -> u32 {
        (**self).index(component)
    }
    fn second_order_pairs(&self) -> usize {
        (**self).second_order_pairs()
    }
    fn roots(&self) -> usize {
        (**self).roots()
    }
    fn root(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        (**self).root(t, y, g)
    }
    fn at_event(&mut self, t: f64, y: &mut [f64], fired: &[bool]) -> Result<(), EvalError> {
        (**self).at_event(t, y, fired)
    }
}

impl<P: SecondOrder + ?Sized> SecondOrder for &mut P {
    fn pairs(&self) -> usize {
        (**self).pairs()
    }
}

impl<P: Ode + ?Sized> Ode for Box<P> {
    fn dim(&self) -> usize {
        (**self).dim()
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        (**self).rhs(t, y, dy)
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, EvalError> {
        (**self).project(t, y)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], matrix: &mut [f64]) -> Result<bool, EvalError> {
        (**self).jacobian(t, y, matrix)
    }
    fn quadratures(&self) -> usize {
        (**self).quadratures()
    }
    fn algebraic(&self) -> usize {
        (**self).algebraic()
    }
    fn index(&self, component: usize) -> u32 {
        (**self).index(component)
    }
    fn second_order_pairs(&self) -> usize {
        (**self).second_order_pairs()
    }
    fn roots(&self) -> usize {
        (**self).roots()
    }
    fn root(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        (**self).root(t, y, g)
    }
    fn at_event(&mut self, t: f64, y: &mut [f64], fired: &[bool]) -> Result<(), EvalError> {
        (**self).at_event(t, y, fired)
    }
}

impl<P: SecondOrder + ?Sized> SecondOrder for Box<P> {
    fn pairs(&self) -> usize {
        (**self).pairs()
    }
}
