//! Motion and forces in independent speeds: the way from `(q, z', z'')` to the forces that this motion needs.
//!
//! With the independent speeds `z'` the loops give `v = T z'` and `v' = T z'' + ...`. The forces `u` on the independent speeds that
//! make `M v' = f + F tau + E u + G^T lambda` true are `u = T^T (M v' - f - F tau)`, `tau` being friction, which depends on reactions.
//! Their derivatives are mass, damping and stiffness of the mechanism: since `T` changes with the position, the derivative of `T^T`
//! times a force is what multipliers times second derivatives of the loops would give.

use super::elimination::Elimination;
use super::error::AnalysisError;
use crate::mechanism::Mechanism;
use crate::simulation::OFF_THE_LOOP;
use linkdyn_dynamics::{Instant, MotionTerms, Reaction, Workspace};
use linkdyn_kinematics::assembly::{self, SingularValues};
use linkdyn_kinematics::{Positions, Velocities};
use nalgebra::{DMatrix, DVector};

/// Newton's iterations of friction and reactions.
const FRICTION_ITERATIONS: usize = 100;
/// Residual of friction over the largest friction that counts as solved: that of [`linkdyn_dynamics::ReactionSolver`].
const FRICTION_TOLERANCE: f64 = 1e-12;
/// Half-width of the four-point differences [`Balance::slopes`] \[rad, m, 1/s\]: their error is of the order of its fourth power, rounding
/// that of the forces over it.
const DIFFERENCE: f64 = 1e-3;

/// A mechanism with scratch and a choice of independent speeds.
#[derive(Clone, Debug)]
pub(super) struct Balance<'a> {
    pub mechanism: &'a Mechanism,
    pub work: Workspace,
    terms: MotionTerms,
    positions: Positions,
    /// Speeds that are kept at zero, each by an equation behind those of the loops.
    held: Vec<usize>,
    /// Equations from which the dependent speeds follow.
    rows: Vec<usize>,
    dependent: Vec<usize>,
    /// The independent speeds.
    pub independent: Vec<usize>,
}

/// By what forces are differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    /// The independent positions: gives the stiffness.
    Position,
    /// The independent speeds: gives the damping, gyroscopic terms included.
    Speed,
}

/// Speeds and their rates that keep the loops closed.
#[derive(Clone, Debug)]
pub(super) struct Moving {
    /// `T` (speeds x independent speeds).
    pub tangent: DMatrix<f64>,
    pub v: DVector<f64>,
    pub a: DVector<f64>,
}

/// Forces that a motion needs.
#[derive(Clone, Debug)]
pub(super) struct Needed {
    /// On the independent speeds \[N m, N\].
    pub forces: DVector<f64>,
    /// Of the loops, then of the prescribed motions.
    pub multipliers: DVector<f64>,
    /// Generalised forces of friction, with the sign in which they act.
    pub friction: Vec<f64>,
}

impl<'a> Balance<'a> {
    /// Scratch for `mechanism`, whose loads must have no states of their own. Prescribed motions are left out.
    pub fn new(mechanism: &'a Mechanism) -> Result<Self, AnalysisError> {
        match mechanism.keeping() {
            Some(what) => Err(AnalysisError::Internals { what }),
            None => Ok(Self::kinematic(mechanism)),
        }
    }

    /// The same with speeds that are kept at zero, whatever force that takes: those of prescribed motions, then those of the coordinates
    /// `named`.
    pub fn holding(mechanism: &'a Mechanism, named: &[String]) -> Result<Self, AnalysisError> {
        let mut held: Vec<usize> = mechanism.system().guided().iter().map(|guided| guided.speed).collect();
        for name in named {
            let (_, speed) = driven(mechanism, name)?;
            if !held.contains(&speed) {
                held.push(speed);
            }
        }
        Ok(Self {
            held,
            ..Self::new(mechanism)?
        })
    }

    /// Name of the first speed that is held.
    pub fn first_held(&self) -> Option<&'a str> {
        self.held.first().map(|&speed| self.mechanism.speeds[speed].as_str())
    }

    /// A flag a speed: those that are held.
    pub fn held_flags(&self) -> Vec<bool> {
        let speeds = self.mechanism.system().tree().speeds();
        (0..speeds).map(|speed| self.held.contains(&speed)).collect()
    }

    /// Scratch for motion without forces: loads and prescribed motions do not count.
    pub fn kinematic(mechanism: &'a Mechanism) -> Self {
        let system = mechanism.system();
        Self {
            work: Workspace::new(system),
            terms: MotionTerms::new(system),
            positions: Positions::new(system.tree()),
            held: Vec::new(),
            rows: Vec::new(),
            dependent: Vec::new(),
            independent: Vec::new(),
            mechanism,
        }
    }

    /// Gradient of the loops, with a row for each speed that is held.
    fn gradient(&mut self, q: &[f64]) -> DMatrix<f64> {
        let system = self.mechanism.system();
        system.tree().positions(q, &mut self.positions);
        let loops = assembly::gradient(system.tree(), system.closures(), &self.positions);
        let first = loops.nrows();
        let mut all = loops.resize_vertically(first + self.held.len(), 0.0);
        for (k, &speed) in self.held.iter().enumerate() {
            all[(first + k, speed)] = 1.0;
        }
        all
    }

    /// Chooses independent speeds at `q`: those `driven`, or by elimination where none is.
    pub fn choose(&mut self, q: &[f64], driven: &[usize]) -> Result<(), AnalysisError> {
        let n = self.mechanism.system().tree().speeds();
        let gradient = self.gradient(q);
        let chosen = Elimination::new(gradient.clone(), |_, speed| !driven.contains(&speed));
        let free = chosen.free(n);
        if free.is_empty() {
            return Err(AnalysisError::NoFreedom);
        }
        if !driven.is_empty() {
            let rank = Elimination::new(gradient, |_, _| true).rank();
            if rank > chosen.rank() {
                let (driven, freedoms) = (self.names(driven), n - rank);
                return Err(AnalysisError::Overdetermined { driven, freedoms });
            }
            let others: Vec<usize> = free.iter().copied().filter(|speed| !driven.contains(speed)).collect();
            if !others.is_empty() {
                let (driven, free) = (self.names(driven), self.names(&others));
                return Err(AnalysisError::Undetermined { driven, free });
            }
        }
        (self.rows, self.dependent) = chosen.pivots.into_iter().unzip();
        self.independent = if driven.is_empty() { free } else { driven.to_vec() };
        Ok(())
    }

    fn names(&self, speeds: &[usize]) -> String {
        let names = speeds
            .iter()
            .map(|&speed| format!("`{}`", self.mechanism.speeds[speed]));
        names.collect::<Vec<_>>().join(", ")
    }

    fn no_motion(&self) -> AnalysisError {
        AnalysisError::Overdetermined {
            driven: self.names(&self.independent),
            freedoms: self.independent.len(),
        }
    }

    /// The motion at `q` for independent speeds `rates` and their rates `second`; the terms of the equations are then those of it.
    pub fn moving(&mut self, t: f64, q: &[f64], rates: &[f64], second: &[f64]) -> Result<Moving, AnalysisError> {
        let n = self.mechanism.system().tree().speeds();
        let gradient = self.gradient(q).select_rows(&self.rows);
        let of_independent = gradient.select_columns(&self.independent);
        let factors = gradient.select_columns(&self.dependent).lu();
        // Nothing to solve for where nothing depends: nalgebra 0.35 overflows on an empty matrix.
        let solve = |rhs: DMatrix<f64>| match rhs.is_empty() {
            true => Some(rhs),
            false => factors.solve(&rhs),
        };
        let shares = solve(of_independent.clone()).ok_or_else(|| self.no_motion())?;
        let mut tangent = DMatrix::zeros(n, self.independent.len());
        for (k, &speed) in self.independent.iter().enumerate() {
            tangent[(speed, k)] = 1.0;
            for (i, &follower) in self.dependent.iter().enumerate() {
                tangent[(follower, k)] = -shares[(i, k)];
            }
        }
        let v = &tangent * DVector::from_column_slice(rates);
        let mut a = DVector::zeros(n);
        let second = DMatrix::from_column_slice(second.len(), 1, second);
        let system = self.mechanism.system();
        let written = system.write_terms(&Instant::new(t, q, v.as_slice()), &mut self.work, &mut self.terms);
        written.map_err(|cause| self.mechanism.explain(cause))?;
        // What is held has none.
        let gamma = |row: usize| self.terms.gamma.get(row).copied().unwrap_or(0.0);
        let gamma = DMatrix::from_fn(self.rows.len(), 1, |i, _| gamma(self.rows[i]));
        let followers = solve(gamma + of_independent * &second).ok_or_else(|| self.no_motion())?;
        for (k, &speed) in self.independent.iter().enumerate() {
            a[speed] = second[k];
        }
        for (i, &speed) in self.dependent.iter().enumerate() {
            a[speed] = -followers[i];
        }
        Ok(Moving { tangent, v, a })
    }

    /// Force that the tree needs besides its loads: `M v' - f`, of the last [`Balance::moving`].
    fn lacking(&self, a: &DVector<f64>) -> DVector<f64> {
        let n = a.len();
        DMatrix::from_row_slice(n, n, &self.terms.mass) * a - DVector::from_column_slice(&self.terms.force)
    }

    /// Forces on the independent speeds, for the last [`Balance::moving`].
    pub fn forces(&mut self, moving: &Moving) -> Result<DVector<f64>, AnalysisError> {
        if self.mechanism.has_friction() {
            return Ok(self.needed(moving)?.forces);
        }
        Ok(moving.tangent.tr_mul(&self.lacking(&moving.a)))
    }

    /// All forces, for the last [`Balance::moving`].
    pub fn needed(&mut self, moving: &Moving) -> Result<Needed, AnalysisError> {
        let system = self.mechanism.system();
        let (n, m) = (system.tree().speeds(), self.terms.gamma.len());
        // What is left for the loops of a force on the speeds, once the independent ones are held.
        let split = |force: &DVector<f64>| {
            let share = moving.tangent.tr_mul(force);
            let mut rest = force.clone();
            for (k, &speed) in self.independent.iter().enumerate() {
                rest[speed] -= share[k];
            }
            (share, rest)
        };
        let mut transposed = DMatrix::zeros(n, m + self.held.len());
        transposed.columns_mut(0, m).copy_from_slice(&self.terms.gradient);
        for (k, &speed) in self.held.iter().enumerate() {
            transposed[(speed, m + k)] = 1.0;
        }
        let loops = SingularValues::new(&transposed);
        // Prescribed motions that are left out take no force; that of what else is held is not among the multipliers.
        let shortest = |rest: &DVector<f64>| match transposed.ncols() {
            0 => DVector::zeros(system.equations()),
            _ => loops.solve(rest).resize_vertically(system.equations(), 0.0),
        };
        let (mut forces, rest) = split(&self.lacking(&moving.a));
        let mut multipliers = shortest(&rest);
        let speeds: Vec<usize> = system.reaction_load_speeds().collect();
        if speeds.is_empty() {
            let friction = Vec::new();
            return Ok(Needed {
                forces,
                multipliers,
                friction,
            });
        }
        let units: Vec<_> = speeds
            .iter()
            .map(|&speed| {
                let (share, rest) = split(&DVector::from_fn(n, |i, _| if i == speed { -1.0 } else { 0.0 }));
                (share, shortest(&rest))
            })
            .collect();
        let friction = self.friction(moving, &multipliers, &units)?;
        for ((share, own), tau) in units.iter().zip(&friction) {
            forces.axpy(*tau, share, 1.0);
            multipliers.axpy(*tau, own, 1.0);
        }
        Ok(Needed {
            forces,
            multipliers,
            friction,
        })
    }

    /// Reactions seen by the loads that depend on them.
    fn seen(&mut self, a: &DVector<f64>, multipliers: &DVector<f64>) -> Vec<Reaction> {
        let system = self.mechanism.system();
        system.reactions_for(a.as_slice(), multipliers.as_slice(), &mut self.work);
        system
            .reaction_loads_with(&self.work)
            .map(|(_, _, seen)| seen)
            .collect()
    }

    /// Friction by Newton's method: for given accelerations reactions are affine functions of it, through the multipliers.
    fn friction(
        &mut self,
        moving: &Moving,
        multipliers: &DVector<f64>,
        units: &[(DVector<f64>, DVector<f64>)],
    ) -> Result<Vec<f64>, AnalysisError> {
        let (count, system) = (units.len(), self.mechanism.system());
        let base = self.seen(&moving.a, multipliers);
        let mut response = Vec::new();
        for (_, own) in units {
            let mut change = self.seen(&moving.a, &(multipliers + own));
            change.iter_mut().zip(&base).for_each(|(change, base)| *change -= *base);
            response.push(change);
        }
        let mut tau = DVector::<f64>::zeros(count);
        let mut residual = f64::INFINITY;
        for _ in 0..FRICTION_ITERATIONS {
            let mut open = DVector::zeros(count);
            let mut jacobian = DMatrix::<f64>::identity(count, count);
            let mut largest = 0.0_f64;
            for (j, (speed, load, _)) in system.reaction_loads_with(&self.work).enumerate() {
                let mut seen = base[j];
                for (change, tau) in response.iter().zip(tau.iter()) {
                    seen.force += change[j].force * *tau;
                    seen.torque += change[j].torque * *tau;
                }
                let (gain, capacity) = (load.gain(moving.v[speed]), load.capacity(&seen));
                open[j] = tau[j] + gain * capacity.value;
                largest = largest.max((gain * capacity.value).abs());
                for (k, change) in response.iter().enumerate() {
                    let slope =
                        capacity.gradient.force.dot(&change[j].force) + capacity.gradient.torque.dot(&change[j].torque);
                    jacobian[(j, k)] += gain * slope;
                }
            }
            residual = if open.amax() == 0.0 { 0.0 } else { open.amax() / largest };
            if residual <= FRICTION_TOLERANCE {
                return Ok(tau.as_slice().to_vec());
            }
            match jacobian.lu().solve(&open) {
                Some(step) => tau -= step,
                None => break,
            }
        }
        Err(AnalysisError::FrictionNotSettled {
            residual,
            iterations: FRICTION_ITERATIONS,
        })
    }

    /// Derivative by four-point differences of the forces at independent speeds and rates `(z', z'')` displaced along column `k`.
    fn slope(
        &mut self,
        by: By,
        (t, q): (f64, &[f64]),
        (rates, second): (&[f64], &[f64]),
        tangent: &DMatrix<f64>,
        k: usize,
    ) -> Result<DVector<f64>, AnalysisError> {
        let mut slope = DVector::zeros(rates.len());
        for (places, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let (mut at, mut speeds) = (q.to_vec(), rates.to_vec());
            match by {
                By::Position => {
                    // The straight way leaves the loops by the square of the step only, which is none in the derivative.
                    let step = tangent.column(k) * (places * DIFFERENCE);
                    self.mechanism.system().tree().displace(&mut at, step.as_slice());
                }
                By::Speed => speeds[k] += places * DIFFERENCE,
            }
            let moving = self.moving(t, &at, &speeds, second)?;
            slope += self.forces(&moving)? * (weight / (12.0 * DIFFERENCE));
        }
        Ok(slope)
    }

    /// `d u/d z` or `d u/d z'` (independent x independent) at `(t, q)` and `(z', z'')`.
    pub fn slopes(
        &mut self,
        by: By,
        at: (f64, &[f64]),
        motion: (&[f64], &[f64]),
        tangent: &DMatrix<f64>,
    ) -> Result<DMatrix<f64>, AnalysisError> {
        let columns: Result<Vec<_>, _> = (0..motion.0.len())
            .map(|k| self.slope(by, at, motion, tangent, k))
            .collect();
        Ok(DMatrix::from_columns(&columns?))
    }

    /// `d u/d z''`: the mass. The forces are linear in `z''`, but for friction.
    pub fn mass(
        &mut self,
        (t, q): (f64, &[f64]),
        (rates, second): (&[f64], &[f64]),
    ) -> Result<DMatrix<f64>, AnalysisError> {
        let mut columns = Vec::new();
        for k in 0..rates.len() {
            let mut sides = Vec::new();
            for by in [0.5, -0.5] {
                let mut second = second.to_vec();
                second[k] += by;
                let moving = self.moving(t, q, rates, &second)?;
                sides.push(self.forces(&moving)?);
            }
            columns.push(&sides[0] - &sides[1]);
        }
        Ok(DMatrix::from_columns(&columns))
    }

    /// Rates of all speeds when the mechanism is let go at `(t, q)` from rest, where friction is none.
    pub fn let_go(&mut self, (t, q): (f64, &[f64])) -> Result<Vec<f64>, AnalysisError> {
        let still = vec![0.0; self.independent.len()];
        let mass = self.mass((t, q), (&still, &still))?;
        let moving = self.moving(t, q, &still, &still)?;
        let pushed = mass.lu().solve(&-self.forces(&moving)?);
        let second = pushed.ok_or(AnalysisError::Eigenvalues("a freedom moves no mass"))?;
        Ok(self.moving(t, q, &still, second.as_slice())?.a.as_slice().to_vec())
    }

    /// Names of the independent speeds.
    pub fn independent_names(&self) -> Vec<String> {
        let speeds = self.independent.iter();
        speeds.map(|&speed| self.mechanism.speeds[speed].clone()).collect()
    }
}

/// Checks lengths, numbers and loops of a state; speeds only where they are given.
pub(super) fn check(mechanism: &Mechanism, q: &[f64], v: Option<&[f64]>) -> Result<(), AnalysisError> {
    let system = mechanism.system();
    let tree = system.tree();
    let parts = [("q", q, tree.coordinates()), ("v", v.unwrap_or(&[]), tree.speeds())];
    for (what, values, expected) in &parts[..1 + usize::from(v.is_some())] {
        if values.len() != *expected {
            return Err(AnalysisError::Length {
                what,
                found: values.len(),
                expected: *expected,
            });
        }
        if let Some(index) = values.iter().position(|x| !x.is_finite()) {
            return Err(number(format!("{what}[{index}]"), values[index], "a finite number"));
        }
    }
    // Loops alone: what is asked may be of another time than the one at which prescribed motions are there.
    let (residual, rate) = violation(mechanism, q, v);
    let fastest = v.unwrap_or(&[]).iter().fold(1.0, |s, x| f64::max(s, x.abs()));
    // At rest loops stay closed, but prescribed motions may have to go on.
    let worst = v.map_or(residual, |_| residual.max(rate / fastest));
    if worst.is_nan() || worst > OFF_THE_LOOP {
        return Err(AnalysisError::Open {
            residual: worst,
            allowed: OFF_THE_LOOP,
        });
    }
    Ok(())
}

/// Largest residual of the loops, and largest rate of one.
fn violation(mechanism: &Mechanism, q: &[f64], v: Option<&[f64]>) -> (f64, f64) {
    let system = mechanism.system();
    let tree = system.tree();
    let (mut positions, mut velocities) = (Positions::new(tree), Velocities::new(tree));
    tree.positions(q, &mut positions);
    let mut rows = vec![0.0; assembly::equations(system.closures())];
    assembly::residuals(system.closures(), &positions, &mut rows);
    let residual = assembly::largest(&rows);
    let rate = v.map_or(0.0, |v| {
        tree.velocities(&positions, v, &mut velocities);
        assembly::rates(system.closures(), &positions, &velocities, &mut rows);
        assembly::largest(&rows)
    });
    (residual, rate)
}

/// A number out of range.
pub(super) fn number(what: impl Into<String>, value: f64, expected: &'static str) -> AnalysisError {
    AnalysisError::Number {
        what: what.into(),
        value,
        expected,
    }
}

/// Coordinate and speed of a driven coordinate by name, which must not be part of a quaternion.
pub(super) fn driven(mechanism: &Mechanism, name: &str) -> Result<(usize, usize), AnalysisError> {
    let (coordinate, speed) = (mechanism.index(name)?, mechanism.speed(name)?);
    let tree = mechanism.system().tree();
    let quaternion = tree.joints().iter().any(|(link, _)| {
        let (q, v) = (tree.coordinate_range(*link), tree.speed_range(*link));
        q.contains(&coordinate) && q.len() != v.len()
    });
    if quaternion {
        return Err(AnalysisError::Quaternion {
            coordinate: name.to_owned(),
        });
    }
    Ok((coordinate, speed))
}
