//! The loop reaction - load - acceleration.
//!
//! A load that depends on a joint's reaction changes the accelerations, and these change the reactions. For given position
//! and velocity all of that but the load itself is linear: with the generalised forces `tau` of these loads the reactions are
//! `r_j = base_j + sum_k K_jk tau_k`. What remains is the small system
//!
//! `tau_j + gain_j * capacity_j(r_j(tau)) = 0`
//!
//! on the loads alone, solved by Newton's method. Its Jacobian `J = 1 + d(gain capacity)/d tau` starts at the unit matrix for
//! vanishing gains; where its determinant, the **measure**, falls to zero on the way to full gains, loads and reactions have
//! no common equilibrium any more: the mechanism jams.

use crate::error::DynamicsError;
use crate::influence::Influence;
use crate::linear::Lu;
use crate::load::Reaction;
use crate::supports;
use crate::system::{OnNode, ReactionSolver, System};
use crate::workspace::Workspace;
use nalgebra::Vector3;
use std::array::from_fn;

/// Newton steps before the solution is followed from vanishing loads on.
const DIRECT_ITERATIONS: usize = 10;
/// Newton steps at each stage of following; the tangent leads near enough for a few.
const STAGE_ITERATIONS: usize = 6;
/// Smallest advance in the share of the loads that is still tried: the fold is then located to this share.
const SMALLEST_STAGE: f64 = 1e-9;
/// A measure below this where following ends is that of a fold: it falls like the root of the distance, to about 3e-5.
const AT_THE_FOLD: f64 = 1e-3;

/// Scratch and results of the loop.
#[derive(Clone, Debug)]
pub(crate) struct ReactionLoop {
    loads: usize,
    pub influence: Influence,
    /// Generalised forces found.
    forces: Vec<f64>,
    trial: Vec<f64>,
    /// Solution and its tangent at the share of the loads followed to.
    known: Vec<f64>,
    tangent: Vec<f64>,
    gains: Vec<f64>,
    jacobian: Lu,
    step: Vec<f64>,
    residual: f64,
    measure: f64,
}

/// How an attempt to solve the loop ended.
enum Outcome {
    Solved,
    /// Residual too large, with the relative size reached.
    Open(f64),
}

impl ReactionLoop {
    pub fn new(system: &System) -> Self {
        let loads = system.reaction_loads.len();
        Self {
            loads,
            influence: Influence::new(system),
            forces: vec![0.0; loads],
            trial: vec![0.0; loads],
            known: vec![0.0; loads],
            tangent: vec![0.0; loads],
            gains: vec![0.0; loads],
            jacobian: Lu::new(loads),
            step: vec![0.0; loads],
            residual: 0.0,
            measure: 1.0,
        }
    }

    pub fn forces(&self) -> &[f64] {
        &self.forces
    }

    pub fn residual(&self) -> f64 {
        self.residual
    }

    pub fn measure(&self) -> f64 {
        self.measure
    }

    /// Residual of the loop at `trial` for a share of the gains, in `step`; fills the Jacobian. Returns the residual relative
    /// to the largest load.
    fn linearise(&mut self, system: &System, share: f64) -> f64 {
        let n = self.loads;
        let mut worst: f64 = 0.0;
        let mut largest: f64 = 0.0;
        for (j, on) in system.reaction_loads.iter().enumerate() {
            let mut felt = self.influence.felt_by(j, 0);
            for (k, force) in self.trial.iter().enumerate() {
                let unit = self.influence.felt_by(j, 1 + k);
                felt = from_fn(|i| felt[i] + unit[i] * force);
            }
            let (capacity, gradient) = if self.influence.has_supports() {
                capacity_of_supports(felt)
            } else {
                capacity_of_load(on, felt)
            };
            let gain = share * self.gains[j];
            let residual = self.trial[j] + gain * capacity;
            self.step[j] = -residual;
            worst = worst.max(residual.abs());
            largest = largest.max(self.trial[j].abs()).max((gain * capacity).abs());
            for k in 0..n {
                let slope: f64 = gradient
                    .iter()
                    .zip(self.influence.felt_by(j, 1 + k))
                    .map(|(g, x)| g * x)
                    .sum();
                self.jacobian.matrix[j * n + k] = gain * slope + f64::from(u8::from(j == k));
            }
            if residual.is_nan() {
                return f64::NAN;
            }
        }
        if largest == 0.0 { 0.0 } else { worst / largest }
    }

    /// Newton's method at full gains from vanishing loads, on the short way where there is one.
    #[inline]
    fn newton_direct(&mut self, system: &System, tolerance: f64, iterations: &mut u64) -> Outcome {
        if self.influence.has_supports()
            && let Some(end) = supports::newton(
                self.influence.felt(),
                &self.gains,
                &mut self.trial,
                tolerance,
                DIRECT_ITERATIONS,
            )
        {
            *iterations += end.iterations;
            (self.measure, self.residual) = (end.measure, end.residual);
            return if end.residual <= tolerance {
                Outcome::Solved
            } else {
                Outcome::Open(end.residual)
            };
        }
        self.trial.fill(0.0);
        self.newton(system, 1.0, tolerance, DIRECT_ITERATIONS, iterations)
    }

    /// Newton's method from `trial`; `measure` is that of the last Jacobian.
    fn newton(&mut self, system: &System, share: f64, tolerance: f64, most: usize, iterations: &mut u64) -> Outcome {
        let mut residual = f64::INFINITY;
        for _ in 0..most {
            residual = self.linearise(system, share);
            if residual.is_nan() {
                return Outcome::Open(residual);
            }
            *iterations += 1;
            self.measure = self.jacobian.factor();
            if residual <= tolerance {
                self.residual = residual;
                return Outcome::Solved;
            }
            if self.measure == 0.0 || self.measure.is_nan() {
                return Outcome::Open(residual);
            }
            self.jacobian.solve(&mut self.step);
            self.trial.iter_mut().zip(&self.step).for_each(|(x, dx)| *x += dx);
        }
        Outcome::Open(residual)
    }

    /// Follows the solution from vanishing loads to the full ones, along its tangent: with `tau = -share gain capacity` the
    /// solution moves by `J^-1 tau/share` with the share, and by minus the full load where it begins.
    #[cold]
    fn follow(
        &mut self,
        system: &System,
        time: f64,
        tolerance: f64,
        iterations: &mut u64,
    ) -> Result<(), DynamicsError> {
        let (mut share, mut stage): (f64, f64) = (0.0, 0.125);
        let (mut measure, mut last_residual) = (1.0, f64::INFINITY);
        self.trial.fill(0.0);
        self.linearise(system, 1.0);
        self.known.fill(0.0);
        self.tangent.copy_from_slice(&self.step);
        while share < 1.0 {
            let next = (share + stage).min(1.0);
            for ((trial, known), tangent) in self.trial.iter_mut().zip(&self.known).zip(&self.tangent) {
                *trial = known + (next - share) * tangent;
            }
            let solved = match self.newton(system, next, tolerance, STAGE_ITERATIONS, iterations) {
                // A jump past the fold lands where the measure has changed sign.
                Outcome::Solved => self.measure > 0.0,
                Outcome::Open(residual) => {
                    last_residual = residual;
                    false
                }
            };
            if solved {
                self.known.copy_from_slice(&self.trial);
                for (tangent, known) in self.tangent.iter_mut().zip(&self.known) {
                    *tangent = known / next;
                }
                // The last Jacobian is that of the solution.
                self.jacobian.solve(&mut self.tangent);
                (share, measure, stage) = (next, self.measure, 2.0 * stage);
            } else {
                stage *= 0.5;
                if stage < SMALLEST_STAGE {
                    self.trial.copy_from_slice(&self.known);
                    let speed = self.weakest(system, share);
                    return Err(if measure < AT_THE_FOLD {
                        DynamicsError::Jammed {
                            time,
                            speed,
                            share,
                            measure,
                        }
                    } else {
                        DynamicsError::NotSettled {
                            time,
                            speed,
                            residual: last_residual,
                            iterations: *iterations as usize,
                        }
                    });
                }
            }
        }
        Ok(())
    }

    /// Speed of the load that grows fastest at `trial`: the largest entry of the Jacobian's weakest direction.
    fn weakest(&mut self, system: &System, share: f64) -> usize {
        self.linearise(system, share);
        self.jacobian.factor();
        let mut x = vec![1.0; self.loads];
        for _ in 0..3 {
            self.jacobian.solve(&mut x);
            let size = x.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
            x.iter_mut().for_each(|x| *x /= size);
        }
        let (place, _) = x
            .iter()
            .enumerate()
            .fold((0, 0.0), |a, (i, x)| if x.abs() > a.1 { (i, x.abs()) } else { a });
        system.reaction_loads[place].speed
    }
}

impl System {
    /// Finds the reaction-dependent loads and adds what they do to rates and multipliers.
    pub(crate) fn solve_reaction_loads(&self, time: f64, v: &[f64], work: &mut Workspace) -> Result<(), DynamicsError> {
        let state = &mut work.reaction_loop;
        for (gain, load) in state.gains.iter_mut().zip(&self.reaction_loads) {
            *gain = load.load.gain(v[load.speed]);
        }
        state.forces.fill(0.0);
        state.trial.fill(0.0);
        (state.residual, state.measure) = (0.0, 1.0);
        if state.gains.iter().all(|&gain| gain == 0.0) {
            return Ok(());
        }
        self.find_influence(work);

        let mut iterations = 0;
        let state = &mut work.reaction_loop;
        let result = match self.reaction_solver {
            ReactionSolver::Newton { tolerance } => match state.newton_direct(self, tolerance, &mut iterations) {
                Outcome::Solved if state.measure > 0.0 => Ok(()),
                outcome => {
                    work.counters.reaction_continuations += 1;
                    let other = matches!(outcome, Outcome::Solved).then_some(state.measure);
                    match (state.follow(self, time, tolerance, &mut iterations), other) {
                        (Err(DynamicsError::Jammed { speed, .. }), Some(measure)) => {
                            Err(DynamicsError::NotUnique { time, speed, measure })
                        }
                        (result, _) => result,
                    }
                }
            },
            ReactionSolver::Sweeps { sweeps } => {
                for _ in 0..sweeps {
                    state.linearise(self, 1.0);
                    iterations += 1;
                    // A sweep takes the loads that the last reactions ask for.
                    state.trial.iter_mut().zip(&state.step).for_each(|(x, dx)| *x += dx);
                }
                state.residual = state.linearise(self, 1.0);
                Ok(())
            }
        };
        work.counters.reaction_iterations += iterations;
        result?;
        self.add_reaction_loads(v, work);
        Ok(())
    }

    /// Adds what the loads found do to rates, multipliers and power.
    #[inline]
    fn add_reaction_loads(&self, v: &[f64], work: &mut Workspace) {
        let state = &mut work.reaction_loop;
        state.forces.copy_from_slice(&state.trial);
        state.influence.add_rates(&state.forces, &mut work.rates);
        work.constraint.add_loads(work.first_unit, &state.forces);
        for (force, on) in state.forces.iter().zip(&self.reaction_loads) {
            work.power += force * v[on.speed];
        }
    }
}

/// Capacity of supports, the sum of the lengths felt, and its gradient. A length of zero has the gradient zero.
fn capacity_of_supports([ax, ay, bx, by, z, _]: [f64; 6]) -> (f64, [f64; 6]) {
    let (a, b, along) = (ax.hypot(ay), bx.hypot(by), z.abs());
    let per = |x: f64, length: f64| if length == 0.0 { 0.0 } else { x / length };
    let gradient = [per(ax, a), per(ay, a), per(bx, b), per(by, b), per(z, along), 0.0];
    (a + b + along, gradient)
}

/// Capacity of any load, and its gradient.
fn capacity_of_load(on: &OnNode, [fx, fy, fz, nx, ny, nz]: [f64; 6]) -> (f64, [f64; 6]) {
    let capacity = on.load.capacity(&Reaction {
        torque: Vector3::new(nx, ny, nz),
        force: Vector3::new(fx, fy, fz),
    });
    let (f, n) = (capacity.gradient.force, capacity.gradient.torque);
    (capacity.value, [f.x, f.y, f.z, n.x, n.y, n.z])
}
