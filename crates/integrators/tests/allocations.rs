//! After the first step nothing is allocated. (A target of its own: it replaces the global allocator.)

use linkdyn_integrators::{
    Constrained, Corrector, Dop853, Equations, EvalError, Form, GeneralisedAlpha, Integration, Method, Newmark, Ode,
    Radau5, Rk4, SecondOrder, Settings, Terms,
};

#[path = "it/methods.rs"]
mod methods;

use methods::{adaptive, nth};

struct Pendulum;

impl Ode for Pendulum {
    fn dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        (dy[0], dy[1]) = (y[1], -y[0].sin());
        Ok(())
    }
    fn project(&mut self, _t: f64, _y: &mut [f64]) -> Result<bool, EvalError> {
        Ok(true)
    }
}

/// The pendulum in Cartesian coordinates.
struct OnACircle;

impl Constrained for OnACircle {
    fn positions(&self) -> usize {
        2
    }
    fn constraints(&self) -> usize {
        1
    }
    fn evaluate(&mut self, _t: f64, q: &[f64], v: &[f64], terms: &mut Terms) -> Result<(), EvalError> {
        (terms.matrix[0], terms.matrix[3], terms.force[1]) = (1.0, 1.0, -1.0);
        terms.constraint[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0);
        terms.gradient.copy_from_slice(q);
        terms.bias[0] = v[0] * v[0] + v[1] * v[1];
        Ok(())
    }
}

/// The pendulum, with events wherever it is lowest.
struct Struck;

impl Ode for Struck {
    fn dim(&self) -> usize {
        Pendulum.dim()
    }
    fn rhs(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        Pendulum.rhs(t, y, dy)
    }
    fn roots(&self) -> usize {
        2
    }
    fn root(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        (g[0], g[1]) = (y[0], -y[0]);
        Ok(())
    }
    fn at_event(&mut self, _t: f64, y: &mut [f64], _fired: &[bool]) -> Result<(), EvalError> {
        y[1] *= 1.01;
        Ok(())
    }
}

impl SecondOrder for Struck {
    fn pairs(&self) -> usize {
        1
    }
}

impl SecondOrder for Pendulum {
    fn pairs(&self) -> usize {
        1
    }
}

fn allocations<P: Ode, M: Method<P>>(problem: P, method: M) -> u64 {
    allocations_from(problem, method, &[1.0, 0.0])
}

fn allocations_with_constraints<M: Method<Equations<OnACircle>>>(form: Form, method: M) -> u64 {
    let mut equations = Equations::new(OnACircle, form).with_projection();
    let y = equations.start(0.0, &[1.0, 0.0], &[0.0, 0.0]).expect("consistent");
    allocations_from(equations, method, &y)
}

fn allocations_from<P: Ode, M: Method<P>>(problem: P, method: M, y: &[f64]) -> u64 {
    let run = Integration::new(problem, method, 0.0, y, Settings::default()).expect("good settings");
    let mut run = run.with_stops(&[3.0]).expect("finite");
    run.advance(100.0).expect("smooth");
    let mut y = y.to_vec();
    let info = allocation_counter::measure(|| {
        for _ in 0..200 {
            run.advance(100.0).expect("smooth");
            let (from, to) = run.last_step();
            run.interpolate(0.5 * (from + to), &mut y).expect("inside");
        }
    });
    info.count_total
}

#[test]
fn no_step_allocates() {
    assert!(
        allocation_counter::measure(|| drop(std::hint::black_box(vec![0_u8; 10]))).count_total > 0,
        "the counter counts"
    );
    assert_eq!(allocations(Pendulum, Rk4::new(0.01)), 0);
    assert_eq!(allocations(Pendulum, Newmark::new(0.01, Corrector::Times(2))), 0);
    for (k, (name, _)) in adaptive::<Pendulum>().into_iter().enumerate() {
        assert_eq!(allocations(Pendulum, nth(k)), 0, "{name}");
    }
    assert_eq!(allocations(Pendulum, Radau5::fixed(0.01)), 0);
}

/// Nor do those of constrained problems.
#[test]
fn no_constrained_step_allocates() {
    for form in [
        Form::Explicit,
        Form::Index1,
        Form::Index2,
        Form::Stabilised,
        Form::Index3,
    ] {
        assert_eq!(allocations_with_constraints(form, Radau5::default()), 0, "{form:?}");
    }
    assert_eq!(allocations_with_constraints(Form::Explicit, Dop853::default()), 0);
    assert_eq!(
        allocations_with_constraints(Form::Index3, GeneralisedAlpha::default()),
        0
    );
    assert_eq!(
        allocations_with_constraints(Form::Index3, GeneralisedAlpha::fixed(0.01)),
        0
    );
}

/// Nor do events.
#[test]
fn no_event_allocates() {
    assert_eq!(allocations(Struck, Rk4::new(0.01)), 0);
    assert_eq!(allocations(Struck, Newmark::new(0.01, Corrector::Times(2))), 0);
    for (k, (name, _)) in adaptive::<Struck>().into_iter().enumerate() {
        assert_eq!(allocations(Struck, nth(k)), 0, "{name}");
    }
    assert_eq!(allocations(Struck, Radau5::fixed(0.01)), 0);
}
