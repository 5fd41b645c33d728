//! Four components at a time: loops over such blocks have no tail and no checks of bounds, and the compiler makes vector
//! instructions of them.

use std::ops::{Add, AddAssign, Mul, Sub};

/// Components in a block.
pub(crate) const LANES: usize = 4;

/// Four components of a vector; lanes beyond its end hold zero.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(align(32))]
pub(crate) struct Lanes(pub(crate) [f64; LANES]);

/// Number of blocks of a vector of `n` components.
pub(crate) fn blocks(n: usize) -> usize {
    n.div_ceil(LANES)
}

impl Lanes {
    pub(crate) const ZERO: Self = Self([0.0; LANES]);

    /// A block of a vector, as `chunks(LANES)` gives it; `rest` where the vector has ended.
    #[inline(always)]
    pub(crate) fn load_or(chunk: &[f64], rest: f64) -> Self {
        Self(match *chunk {
            [a, b, c, d] => [a, b, c, d],
            [a, b, c] => [a, b, c, rest],
            [a, b] => [a, b, rest, rest],
            [a] => [a, rest, rest, rest],
            _ => [rest; LANES],
        })
    }

    #[inline(always)]
    pub(crate) fn load(chunk: &[f64]) -> Self {
        Self::load_or(chunk, 0.0)
    }

    /// Writes to a block of a vector, as `chunks_mut(LANES)` gives it.
    #[inline(always)]
    pub(crate) fn store(self, chunk: &mut [f64]) {
        // Case by case: a loop over the rest would become a call of memcpy.
        match (chunk, self.0) {
            ([to_a, to_b, to_c, to_d], [a, b, c, d]) => (*to_a, *to_b, *to_c, *to_d) = (a, b, c, d),
            ([to_a, to_b, to_c], [a, b, c, _]) => (*to_a, *to_b, *to_c) = (a, b, c),
            ([to_a, to_b], [a, b, ..]) => (*to_a, *to_b) = (a, b),
            ([to_a], [a, ..]) => *to_a = a,
            _ => {}
        }
    }

    #[inline(always)]
    pub(crate) fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    pub(crate) fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    pub(crate) fn squared(self) -> Self {
        self * self
    }

    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        let [a, b, c, d] = self.0;
        (a + c) + (b + d)
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Mul<Lanes> for f64 {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, lanes: Lanes) -> Lanes {
        lanes.map(|lane| self * lane)
    }
}
