//! One evaluation: from a state to accelerations and multipliers.

use crate::composite::along;
use crate::error::DynamicsError;
use crate::lagrange;
use crate::load::{Instant, InternalState, Loads, Motion};
use crate::local_loops::Column;
use crate::symmetric::SpatialInertia;
use crate::system::{Formulation, System};
use crate::workspace::{MassFactor, Workspace, moves};
use linkdyn_kinematics::{Twist, Wrench};
use std::ops::Range;

impl System {
    /// Accelerations and multipliers at time `t` \[s\], coordinates `q` and speeds `v`; they are found in `work`.
    ///
    /// `M v' = f + G^T lambda`, `G v' + gamma = 0`, with `f` all generalised forces less the bias forces.
    ///
    /// # Errors
    /// [`DynamicsError`] with time and place. `work` then holds no result.
    pub fn evaluate(&self, t: f64, q: &[f64], v: &[f64], work: &mut Workspace) -> Result<(), DynamicsError> {
        self.evaluate_with(&Instant::new(t, q, v), work)
    }

    /// As [`evaluate`](Self::evaluate), with internal states and memory of the loads; the rates of these states are found in
    /// `work` too.
    ///
    /// # Errors
    /// [`DynamicsError`] with time and place. `work` then holds no result.
    pub fn evaluate_with(&self, at: &Instant<'_>, work: &mut Workspace) -> Result<(), DynamicsError> {
        let Instant { t, v, .. } = *at;
        work.counters.evaluations += 1;
        self.set_up(at, work)?;
        self.solve(work);
        if !self.reaction_loads.is_empty() {
            self.solve_reaction_loads(t, v, work)?;
        }
        if !self.guided.is_empty() {
            work.power += self.guide_power(t, work);
        }
        if work.constraint.redundant() > 0 {
            work.counters.redundant += 1;
        }
        match work.rates.iter().position(|a| !a.is_finite()) {
            None => Ok(()),
            Some(speed) => Err(DynamicsError::NotFinite {
                time: t,
                speed,
                value: work.rates[speed],
            }),
        }
    }

    /// Motion, loads, factors of the mass matrix, and all right-hand sides taken inward.
    #[inline]
    fn set_up(&self, at: &Instant<'_>, work: &mut Workspace) -> Result<(), DynamicsError> {
        let Instant { t, q, v, .. } = *at;
        let base = -self.gravity;
        self.tree
            .sweep(q, v, &base, &mut work.positions, &mut work.velocities, &mut work.biases);
        self.apply_loads(at, work)?;
        work.columns.clear();
        for (speed, force) in work.generalised.iter().enumerate() {
            *work.columns.at_mut(speed, 0) = *force;
        }
        if self.formulation == Formulation::Lagrange {
            self.take_outside_wrenches(work);
        }
        self.own_wrenches(work);

        let factored = match &mut work.mass {
            MassFactor::Composite(mass) if self.formulation == Formulation::Lagrange => {
                let equations = lagrange::equations(self, q, v);
                equations.write(mass.matrix_mut(), &mut work.columns, &mut work.constraint.gamma);
                mass.factor()
            }
            MassFactor::LocalLoops(_) => {
                self.closure_columns(at, work);
                self.factor_mass(work)
            }
            _ => self.factor_mass(work),
        };
        factored.map_err(|(speed, pivot)| DynamicsError::SingularMass { time: t, speed, pivot })?;
        if let MassFactor::LocalLoops(_) = work.mass {
            return Ok(());
        }
        self.closure_columns(at, work);
        let units = self.unit_columns(work);
        match &mut work.mass {
            MassFactor::Composite(mass) => mass.inward(&mut work.columns),
            MassFactor::Articulated(mass) => {
                for column in (1..=self.equations).chain(units) {
                    let (nodes, positions) = (self.tree.nodes(), work.positions.nodes());
                    mass.inward(nodes, positions, &mut work.columns, column, &mut ());
                }
            }
            MassFactor::LocalLoops(_) => {}
        }
        Ok(())
    }

    /// Columns of the unit forces of reaction loads.
    #[inline]
    fn unit_columns(&self, work: &Workspace) -> Range<usize> {
        work.first_unit..work.first_unit + self.reaction_loads.len()
    }

    /// Factors of the mass matrix from the links' own inertias, their own wrenches taken inward; else speed and pivot that are singular.
    #[inline]
    pub(crate) fn factor_mass(&self, work: &mut Workspace) -> Result<(), (usize, f64)> {
        let (nodes, positions) = (self.tree.nodes(), work.positions.nodes());
        match &mut work.mass {
            MassFactor::Composite(mass) => {
                work.wrenches.copy_from_slice(&work.own);
                mass.assemble(nodes, positions, &work.inertias, &mut work.wrenches, &mut work.columns);
                mass.factor()
            }
            MassFactor::Articulated(mass) => {
                mass.factor(nodes, positions, &work.inertias, &work.own, &mut work.columns, &mut ())
            }
            MassFactor::LocalLoops(mass) => {
                let (columns, gamma) = (&mut work.columns, &work.constraint.gamma);
                mass.factor(nodes, positions, &work.inertias, &work.own, columns, gamma)
            }
        }
    }

    /// Generalised forces and outside wrenches of all loads, and the power of those that are not conservative.
    #[inline]
    pub(crate) fn apply_loads(&self, at: &Instant<'_>, work: &mut Workspace) -> Result<(), DynamicsError> {
        work.generalised.fill(0.0);
        work.own.fill(Wrench::zero());
        work.power = 0.0;
        if self.loads.is_empty() {
            return Ok(());
        }
        let Instant { t, q, v, internal } = *at;
        let motion = Motion {
            t,
            q,
            v,
            positions: &work.positions,
            velocities: &work.velocities,
            internal: InternalState::default(),
        };
        let mut loads = Loads {
            generalised: &mut work.generalised,
            counter: &mut work.own,
            on_links: false,
            storing: 0.0,
            refused: None,
            state_rates: &mut [],
            integral_rates: &mut [],
        };
        let (plain, others) = self.loads.split_at(self.plain_loads);
        let (with_internals, conservative) = others.split_at(self.places.len());
        plain.iter().for_each(|load| load.apply(&motion, &mut loads));
        let (mut states, mut integrals) = (&mut work.state_rates[..], &mut work.integral_rates[..]);
        states.fill(0.0);
        integrals.fill(0.0);
        for (k, (load, place)) in with_internals.iter().zip(&self.places).enumerate() {
            if k == self.working {
                work.power = loads.power(&motion);
            }
            (loads.state_rates, states) = states.split_at_mut(place.states.len());
            (loads.integral_rates, integrals) = integrals.split_at_mut(place.integrals.len());
            load.apply(&self.seen_by(place, &motion, internal), &mut loads);
        }
        if self.working == with_internals.len() {
            work.power = loads.power(&motion);
        }
        (loads.state_rates, loads.integral_rates) = (&mut [], &mut []);
        conservative.iter().for_each(|load| load.apply(&motion, &mut loads));
        match loads.refused {
            None => Ok(()),
            Some(reason) => Err(DynamicsError::Refused { time: t, reason }),
        }
    }

    /// Adds the links' inertial wrenches for vanishing rates to the outside ones.
    #[inline]
    pub(crate) fn own_wrenches(&self, work: &mut Workspace) {
        for (i, body) in self.bodies.iter().enumerate().skip(1) {
            let inertia = body.turned(&work.positions.nodes()[i].rotation);
            let w = &work.velocities.nodes()[i].angular;
            let bias = &work.biases.nodes()[i];
            let h = &inertia.moment;
            let mut own = inertial_wrench(&inertia, bias);
            own.force += w.cross(&w.cross(h));
            own.torque += w.cross(&inertia.second.times(w));
            work.own[i] += own;
            work.inertias[i] = inertia;
        }
    }

    /// The Lagrange form knows no wrenches: takes the outside ones inward to generalised forces.
    fn take_outside_wrenches(&self, work: &mut Workspace) {
        work.wrenches.copy_from_slice(&work.own);
        for (i, node) in self.tree.nodes().iter().enumerate().skip(1).rev() {
            let here = &work.positions.nodes()[i];
            let wrench = work.wrenches[i];
            if moves(node.freedom) {
                *work.columns.at_mut(node.speed, 0) -= along(node, here, &wrench);
            }
            work.wrenches[node.parent] += wrench.shifted(&here.arm);
        }
    }

    /// Closure gradient and biases, drift terms, and unit forces of the reaction loads.
    #[inline]
    fn closure_columns(&self, at: &Instant<'_>, work: &mut Workspace) {
        let (positions, velocities) = (&work.positions, &work.velocities);
        let lagrange = self.formulation == Formulation::Lagrange;
        let mut first = 0;
        for (number, closure) in self.closures.iter().enumerate() {
            let range = first..first + closure.equations();
            if !lagrange {
                let (columns, biases) = (&mut work.columns, &work.biases);
                let gamma = &mut work.constraint.gamma[range.clone()];
                if let MassFactor::LocalLoops(mass) = &mut work.mass {
                    mass.put_closure(number, |put| closure.gradient(positions, put));
                    closure.bias(positions, velocities, biases, gamma);
                } else {
                    let put = |speed, equation, value| *columns.at_mut(speed, 1 + first + equation) = value;
                    closure.gradient_and_bias(positions, velocities, biases, put, gamma);
                }
            }
            if let Some(drift) = self.baumgarte {
                let gamma = &mut work.constraint.gamma[range.clone()];
                let lambda = &mut work.constraint.lambda[range];
                closure.rate(positions, velocities, lambda);
                gamma
                    .iter_mut()
                    .zip(&*lambda)
                    .for_each(|(g, rate)| *g += 2.0 * drift.alpha * rate);
                closure.residual(positions, lambda);
                gamma
                    .iter_mut()
                    .zip(&*lambda)
                    .for_each(|(g, phi)| *g += drift.beta * drift.beta * phi);
            }
            first += closure.equations();
        }
        if !self.guided.is_empty() {
            self.put_guides(work);
            self.guide_biases(at.t, at.q, at.v, work);
        }
        for (k, load) in self.reaction_loads.iter().enumerate() {
            *work.columns.at_mut(load.speed, work.first_unit + k) = 1.0;
        }
    }

    /// Multipliers and rates for all right-hand sides; those for the generalised forces become the result.
    #[inline]
    fn solve(&self, work: &mut Workspace) {
        if let MassFactor::LocalLoops(_) = work.mass {
            self.solve_local_loops(work);
        } else {
            let inverse = work.mass.inverse_diagonal();
            if self.equations > 0 {
                work.constraint.factor(&work.columns, inverse);
            }
            work.constraint.solve_all(&work.columns, inverse, &mut work.solutions);
            self.outward(work);
        }
        for (speed, rate) in work.rates.iter_mut().enumerate() {
            *rate = work.solutions.at(speed, 0);
        }
    }

    /// The same with loops that have been eliminated one by one, one column after the other.
    fn solve_local_loops(&self, work: &mut Workspace) {
        let units = self.unit_columns(work);
        let (nodes, positions) = (self.tree.nodes(), work.positions.nodes());
        if let MassFactor::LocalLoops(mass) = &mut work.mass {
            for column in (0..1).chain(units) {
                if column > 0 {
                    mass.inward(nodes, positions, &mut work.columns, column, &[]);
                }
                mass.outward(nodes, positions, &work.columns, &mut work.solutions, column);
                if mass.refinements() > 0 {
                    work.counters.refinements += mass.refinements();
                    let unit = column
                        .checked_sub(work.first_unit)
                        .map(|k| self.reaction_loads[k].speed);
                    let known = Column {
                        force: |speed| unit.map_or(work.generalised[speed], |unit| f64::from(u8::from(speed == unit))),
                        wrenches: if unit.is_none() { &work.own } else { &[] },
                        gamma: if unit.is_none() { &work.constraint.gamma } else { &[] },
                    };
                    let arrays = (&mut work.columns, &mut work.solutions);
                    mass.refine(nodes, positions, &work.inertias, &known, arrays, column);
                }
                work.constraint.take(mass.multipliers(), column, mass.rank());
            }
        }
    }

    /// Takes the solutions, divided by the pivots, outward.
    #[inline]
    pub(crate) fn outward(&self, work: &mut Workspace) {
        let units = self.unit_columns(work);
        match &mut work.mass {
            MassFactor::Composite(mass) => mass.outward(&mut work.solutions),
            MassFactor::Articulated(mass) => {
                for column in (0..1).chain(units) {
                    let (nodes, positions) = (self.tree.nodes(), work.positions.nodes());
                    mass.outward(nodes, positions, &mut work.solutions, column, &mut ());
                }
            }
            MassFactor::LocalLoops(_) => {}
        }
    }
}

/// `I a` of a link: force and torque about its origin for an acceleration.
#[inline]
pub(crate) fn inertial_wrench(inertia: &SpatialInertia, a: &Twist) -> Wrench {
    Wrench {
        torque: inertia.second.times(&a.angular) + inertia.moment.cross(&a.linear),
        force: a.linear * inertia.mass + a.angular.cross(&inertia.moment),
    }
}
