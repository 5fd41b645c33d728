//! Many right-hand sides at once: rows of columns, padded to a multiple of four so that one row operation is a few wide
//! instructions.

const LANES: usize = 4;

/// A row-major array with one row a speed and any number of columns.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    stride: usize,
    data: Vec<f64>,
}

impl Columns {
    pub fn new(rows: usize, columns: usize) -> Self {
        let stride = columns.next_multiple_of(LANES);
        Self {
            stride,
            data: vec![0.0; rows * stride],
        }
    }

    #[inline]
    pub fn clear(&mut self) {
        self.data.fill(0.0);
    }

    /// Distance of two rows in [`Columns::flat_mut`].
    #[inline]
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// All numbers, row by row.
    #[inline]
    pub fn flat_mut(&mut self) -> &mut [f64] {
        &mut self.data
    }

    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.data.chunks_exact(self.stride)
    }

    #[inline]
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.data[row * self.stride + column]
    }

    #[inline]
    pub fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.data[row * self.stride + column]
    }

    /// `row(target) -= factor * row(source)`.
    #[inline]
    pub fn subtract(&mut self, target: usize, factor: f64, source: usize) {
        match self.stride {
            LANES => self.subtract_sized(LANES, target, factor, source),
            stride => self.subtract_sized(stride, target, factor, source),
        }
    }

    #[inline(always)]
    fn subtract_sized(&mut self, stride: usize, target: usize, factor: f64, source: usize) {
        let (head, tail) = self.data.split_at_mut(target.max(source) * stride);
        let (low, high) = (&mut head[target.min(source) * stride..][..stride], &mut tail[..stride]);
        let (target, source) = if target < source { (low, high) } else { (high, low) };
        for (x, y) in target.iter_mut().zip(source) {
            *x -= factor * *y;
        }
    }
}
