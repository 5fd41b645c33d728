//! Numbers side by side, on which one operation is one or two wide instructions.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// `N` numbers; all operations work on each by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(16))]
pub(crate) struct Lanes<const N: usize>(pub [f64; N]);

/// Four numbers.
pub(crate) type Four = Lanes<4>;

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

impl<const N: usize> Mul<f64> for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self.map(|x| x * factor)
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
