//! Numbers side by side, on which one operation is one or two wide instructions.

use nalgebra::Vector3;
use std::array::from_fn;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// `N` numbers; all operations work on each by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(16))]
pub(crate) struct Lanes<const N: usize>(pub [f64; N]);

/// Four numbers.
pub(crate) type Four = Lanes<4>;

/// A vector for each lane.
pub(crate) type Vectors<const N: usize> = [Lanes<N>; 3];

impl<const N: usize> Lanes<N> {
    pub const ZERO: Self = Self([0.0; N]);

    #[inline(always)]
    pub fn map(self, f: impl FnMut(f64) -> f64) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(from_fn(|l| f(self.0[l], other.0[l])))
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        self.map(f64::abs)
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    /// The larger numbers; those of `other` where one is not a number.
    #[inline(always)]
    pub fn larger(self, other: Self) -> Self {
        self.zip(other, larger)
    }
}

impl Four {
    /// The largest of the four; meaningless where one is not a number.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        let [a, b, c, d] = self.0;
        larger(larger(a, c), larger(b, d))
    }

    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d] = self.0;
        (a + c) + (b + d)
    }
}

/// The larger of two numbers, `b` where one is not a number.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Number `i` of a list held by fours.
#[inline(always)]
pub(crate) fn at(fours: &[Four], i: usize) -> f64 {
    fours[i / 4].0[i % 4]
}

/// Number `i` of a list held by fours.
#[inline(always)]
pub(crate) fn at_mut(fours: &mut [Four], i: usize) -> &mut f64 {
    &mut fours[i / 4].0[i % 4]
}

impl<const N: usize> Add for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<const N: usize> Mul for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl<const N: usize> Mul<f64> for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.map(|x| x * factor)
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<const N: usize> AddAssign for Lanes<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Lanes<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// The same vector in each lane.
#[inline(always)]
pub(crate) fn splat<const N: usize>(v: &Vector3<f64>) -> Vectors<N> {
    from_fn(|i| Lanes([v[i]; N]))
}

/// `a + b`.
#[inline(always)]
pub(crate) fn plus<const N: usize>(a: &Vectors<N>, b: &Vectors<N>) -> Vectors<N> {
    from_fn(|i| a[i] + b[i])
}

/// `a factor`.
#[inline(always)]
pub(crate) fn times<const N: usize>(a: &Vectors<N>, factor: Lanes<N>) -> Vectors<N> {
    from_fn(|i| a[i] * factor)
}

/// `a . b`.
#[inline(always)]
pub(crate) fn dot<const N: usize>(a: &Vectors<N>, b: &Vectors<N>) -> Lanes<N> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a x b`.
#[inline(always)]
pub(crate) fn cross<const N: usize>(a: &Vectors<N>, b: &Vectors<N>) -> Vectors<N> {
    from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}
