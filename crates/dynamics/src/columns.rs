//! Many right-hand sides at once: rows of columns in fours.

use crate::lanes::{Four, at, at_mut};

/// Calls `$f(n)` with `n` a constant where it is small: the compiler then unrolls what is one plain text.
macro_rules! sized {
    ($n:expr, [$($small:literal),*], $f:expr) => {
        match $n {
            $($small => $f($small),)*
            n => $f(n),
        }
    };
}
pub(crate) use sized;

/// A row-major array with one row a speed (or an equation) and any number of columns.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    /// Fours in a row.
    width: usize,
    fours: Vec<Four>,
}

impl Columns {
    pub fn new(rows: usize, columns: usize) -> Self {
        let width = columns.div_ceil(4);
        Self {
            width,
            fours: vec![Four::ZERO; rows * width],
        }
    }

    #[inline]
    pub fn clear(&mut self) {
        self.fours.fill(Four::ZERO);
    }

    /// Fours in a row.
    #[inline]
    pub fn width(&self) -> usize {
        self.width
    }

    /// All numbers, row by row.
    #[inline]
    pub fn fours(&self) -> &[Four] {
        &self.fours
    }

    #[inline]
    pub fn fours_mut(&mut self) -> &mut [Four] {
        &mut self.fours
    }

    /// All numbers of a column.
    #[inline]
    pub fn column(&self, column: usize) -> impl Iterator<Item = f64> {
        let rows = self.fours.chunks_exact(self.width);
        rows.map(move |row| row[column / 4].0[column % 4])
    }

    #[inline]
    pub fn at(&self, row: usize, column: usize) -> f64 {
        at(&self.fours, 4 * row * self.width + column)
    }

    #[inline]
    pub fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        at_mut(&mut self.fours, 4 * row * self.width + column)
    }
}

/// `row(target) -= factor * row(source)` in an array with `width` fours a row.
#[inline(always)]
pub(crate) fn subtract(fours: &mut [Four], width: usize, target: usize, factor: f64, source: usize) {
    for c in 0..width {
        let share = fours[source * width + c] * factor;
        fours[target * width + c] -= share;
    }
}
