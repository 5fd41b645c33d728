//! The papers' Lagrange equations \[Harlecki and Urbaś, eq. (2), with the mended h_k\]: traces of `T_i H T_j^T`.
//!
//! An independent route to everything that the recursions find, from 4 x 4 transforms and their derivatives alone. It
//! allocates and costs the fourth power of the depth.

use crate::columns::Columns;
use crate::system::System;
use linkdyn_kinematics::{Attachment, LinkId, Row, Transforms};
use nalgebra::{DMatrix, DVector, Matrix4, Vector3, Vector4};

/// `M v' + bias = f + G^T lambda`, `G v' + gamma = 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct LagrangeEquations {
    /// Mass matrix `A` (n x n).
    pub mass: DMatrix<f64>,
    /// Velocity and weight forces `h + g` (n).
    pub bias: DVector<f64>,
    /// Closure gradient `D^T` (m x n).
    pub gradient: DMatrix<f64>,
    /// Closure bias `-c` (m).
    pub gamma: DVector<f64>,
}

/// The equations of `system` at a state, without its loads and prescribed motions.
pub fn equations(system: &System, q: &[f64], v: &[f64]) -> LagrangeEquations {
    let tree = &system.tree;
    let n = tree.speeds();
    let transforms = tree.transforms(q);
    let mut mass = DMatrix::zeros(n, n);
    let mut bias = DVector::zeros(n);
    for ((link, _), inertia) in tree.joints().iter().zip(&system.inertias) {
        if inertia.mass == 0.0 {
            continue;
        }
        let h = inertia.pseudo_inertia();
        let speeds: Vec<usize> = tree.path(*link).map(|node| tree.nodes()[node].speed).collect();
        let first: Vec<Matrix4<f64>> = speeds.iter().map(|&i| transforms.first(*link, i)).collect();
        let second = second_rate(&transforms, *link, v);
        let com = inertia.com.push(1.0);
        let weight = (system.gravity * inertia.mass).push(0.0);
        for (t_k, &k) in first.iter().zip(&speeds) {
            let t_h = t_k * h;
            for (t_j, &j) in first.iter().zip(&speeds) {
                mass[(k, j)] += trace_of_product(&t_h, t_j);
            }
            bias[k] += trace_of_product(&t_h, &second) - weight.dot(&(t_k * com));
        }
    }
    let (gradient, gamma) = closures(system, &transforms, v);
    LagrangeEquations {
        mass,
        bias,
        gradient,
        gamma,
    }
}

impl LagrangeEquations {
    /// Accelerations and multipliers for generalised forces `f` (n) by Gauss elimination of the whole system; `None` when it
    /// is singular.
    pub fn solve(&self, f: &[f64]) -> Option<(DVector<f64>, DVector<f64>)> {
        let (n, m) = (self.mass.nrows(), self.gradient.nrows());
        let mut a = DMatrix::zeros(n + m, n + m);
        a.view_mut((0, 0), (n, n)).copy_from(&self.mass);
        a.view_mut((0, n), (n, m)).copy_from(&(-self.gradient.transpose()));
        a.view_mut((n, 0), (m, n)).copy_from(&self.gradient);
        let mut b = DVector::zeros(n + m);
        b.rows_mut(0, n)
            .copy_from(&(DVector::from_column_slice(f) - &self.bias));
        b.rows_mut(n, m).copy_from(&(-&self.gamma));
        let x = a.lu().solve(&b)?;
        Some((x.rows(0, n).into_owned(), x.rows(n, m).into_owned()))
    }

    /// Hands the equations to the solver of the recursive form.
    pub(crate) fn write(&self, matrix: &mut [f64], columns: &mut Columns, gamma: &mut [f64]) {
        let n = self.mass.nrows();
        for i in 0..n {
            for j in 0..=i {
                matrix[i * n + j] = self.mass[(i, j)];
            }
            *columns.at_mut(i, 0) -= self.bias[i];
            for k in 0..self.gradient.nrows() {
                *columns.at_mut(i, 1 + k) = self.gradient[(k, i)];
            }
        }
        gamma[..self.gamma.len()].copy_from_slice(self.gamma.as_slice());
    }
}

/// `sum_ij T_ij v_i v_j`: the second rate of a transform for vanishing rates of the speeds.
fn second_rate(transforms: &Transforms<'_>, link: LinkId, v: &[f64]) -> Matrix4<f64> {
    let speeds = transforms.speeds_of(link);
    let mut sum = Matrix4::zeros();
    for &i in &speeds {
        for &j in &speeds {
            sum += transforms.second(link, i, j) * (v[i] * v[j]);
        }
    }
    sum
}

/// tr(A B^T)
fn trace_of_product(a: &Matrix4<f64>, b: &Matrix4<f64>) -> f64 {
    a.component_mul(b).sum()
}

/// A homogeneous vector of a link with its first derivatives, rate and bias of the second rate, in global axes.
struct Moving {
    value: Vector3<f64>,
    first: Vec<Vector3<f64>>,
    rate: Vector3<f64>,
    second: Vector3<f64>,
}

impl Moving {
    /// `local` ends in 1 for points and in 0 for directions.
    fn new(transforms: &Transforms<'_>, attachment: &Attachment, local: Vector4<f64>, v: &[f64]) -> Self {
        let link = attachment.link;
        let local = attachment.pose.to_homogeneous() * local;
        let first: Vec<_> = (0..v.len())
            .map(|i| (transforms.first(link, i) * local).xyz())
            .collect();
        Self {
            value: (transforms.transform(link) * local).xyz(),
            rate: first.iter().zip(v).map(|(f, v)| f * *v).sum(),
            second: (second_rate(transforms, link, v) * local).xyz(),
            first,
        }
    }

    fn minus(mut self, other: Self) -> Self {
        self.value -= other.value;
        self.rate -= other.rate;
        self.second -= other.second;
        self.first.iter_mut().zip(other.first).for_each(|(a, b)| *a -= b);
        self
    }

    fn dot(&self, other: &Self) -> Scalar {
        let first = self.first.iter().zip(&other.first);
        Scalar {
            value: self.value.dot(&other.value),
            first: first.map(|(a, b)| a.dot(&other.value) + self.value.dot(b)).collect(),
            rate: self.rate.dot(&other.value) + self.value.dot(&other.rate),
            second: self.second.dot(&other.value) + 2.0 * self.rate.dot(&other.rate) + self.value.dot(&other.second),
        }
    }
}

fn closures(system: &System, transforms: &Transforms<'_>, v: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    let (n, m) = (system.tree.speeds(), system.closure_equations);
    let mut gradient = DMatrix::zeros(m, n);
    let mut gamma = DVector::zeros(m);
    let mut k = 0;
    for closure in &system.closures {
        let (p, s) = (closure.predecessor(), closure.successor());
        let origin = Vector4::new(0.0, 0.0, 0.0, 1.0);
        let gap = Moving::new(transforms, p, origin, v).minus(Moving::new(transforms, s, origin, v));
        for row in closure.rows() {
            match row {
                Row::Coincident => {
                    for (i, first) in gap.first.iter().enumerate() {
                        gradient.fixed_view_mut::<3, 1>(k, i).copy_from(first);
                    }
                    gamma.fixed_rows_mut::<3>(k).copy_from(&gap.second);
                    k += 3;
                }
                Row::Along { axis } => {
                    let along = Moving::new(transforms, p, axis.push(0.0), v).dot(&gap);
                    along.write(&mut gradient, &mut gamma, k);
                    k += 1;
                }
                Row::Angle {
                    on_predecessor,
                    on_successor,
                    ..
                } => {
                    let a = Moving::new(transforms, p, on_predecessor.push(0.0), v);
                    let b = Moving::new(transforms, s, on_successor.push(0.0), v);
                    a.dot(&b).write(&mut gradient, &mut gamma, k);
                    k += 1;
                }
                Row::Screw { axis, pitch } => {
                    let along = Moving::new(transforms, p, axis.push(0.0), v).dot(&gap);
                    let e1 = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
                    let e2 = axis.cross(&e1);
                    let [a1, a2] = [e1, e2].map(|e| Moving::new(transforms, p, e.push(0.0), v));
                    let [b1, b2] = [e1, e2].map(|e| Moving::new(transforms, s, e.push(0.0), v));
                    let sine = a2.dot(&b1).plus(-1.0, &a1.dot(&b2));
                    let cosine = a1.dot(&b1).plus(1.0, &a2.dot(&b2));
                    along
                        .plus(*pitch, &sine.angle(&cosine))
                        .write(&mut gradient, &mut gamma, k);
                    k += 1;
                }
            }
        }
    }
    (gradient, gamma)
}

/// A function of the coordinates with its first derivatives, rate and bias of the second rate.
struct Scalar {
    value: f64,
    first: Vec<f64>,
    rate: f64,
    second: f64,
}

impl Scalar {
    /// `self + factor other`
    fn plus(mut self, factor: f64, other: &Self) -> Self {
        self.value += factor * other.value;
        self.rate += factor * other.rate;
        self.second += factor * other.second;
        self.first
            .iter_mut()
            .zip(&other.first)
            .for_each(|(a, b)| *a += factor * b);
        self
    }

    /// The angle with this sine and that cosine, both with the same factor.
    fn angle(&self, cosine: &Self) -> Self {
        let (s, c) = (self.value, cosine.value);
        let square = s * s + c * c;
        let rate = (c * self.rate - s * cosine.rate) / square;
        let first = self.first.iter().zip(&cosine.first);
        Self {
            value: s.atan2(c),
            first: first.map(|(ds, dc)| (c * ds - s * dc) / square).collect(),
            rate,
            second: (c * self.second - s * cosine.second - 2.0 * rate * (c * cosine.rate + s * self.rate)) / square,
        }
    }

    fn write(&self, gradient: &mut DMatrix<f64>, gamma: &mut DVector<f64>, k: usize) {
        for (i, first) in self.first.iter().enumerate() {
            gradient[(k, i)] = *first;
        }
        gamma[k] = self.second;
    }
}
