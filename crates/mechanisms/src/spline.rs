//! Cubic splines through points: tables over time.

/// A cubic between each two neighbouring nodes, by values and slopes at both; constant before the first and behind the last.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Spline {
    /// Where the nodes are, rising.
    x: Vec<f64>,
    y: Vec<f64>,
    /// Slopes at the nodes.
    slopes: Vec<f64>,
}

impl Spline {
    /// Natural spline: two continuous derivatives between the ends, where the second vanishes. It may overshoot between nodes.
    /// Unsound nodes are told by whoever takes the spline; see [`crate::Linkage::build`].
    pub fn natural(nodes: &[(f64, f64)]) -> Self {
        let mut spline = Self::through(nodes);
        let (widths, secants) = spline.secants();
        let n = widths.len();
        if n == 0 {
            return spline;
        }
        // The second derivative is continuous at each inner node and zero at the ends: a tridiagonal system for the slopes,
        // by elimination downward (the factor kept in `upper`) and substitution upward.
        let slopes = &mut spline.slopes;
        let mut upper = vec![0.5; n + 1];
        slopes[0] = 1.5 * secants[0];
        for k in 1..n {
            let (a, b) = (1.0 / widths[k - 1], 1.0 / widths[k]);
            let pivot = 2.0 * (a + b) - a * upper[k - 1];
            upper[k] = b / pivot;
            slopes[k] = (3.0 * (a * secants[k - 1] + b * secants[k]) - a * slopes[k - 1]) / pivot;
        }
        slopes[n] = (3.0 * secants[n - 1] - slopes[n - 1]) / (2.0 - upper[n - 1]);
        for k in (0..n).rev() {
            slopes[k] -= upper[k] * slopes[k + 1];
        }
        spline
    }

    /// Monotone spline: between two nodes it stays between their values. One continuous derivative: the second jumps at the nodes.
    /// Slopes are weighted harmonic means of the neighbouring secants (Fritsch, Butland 1984), zero at turning points and ends.
    pub fn monotone(nodes: &[(f64, f64)]) -> Self {
        let mut spline = Self::through(nodes);
        let (h, d) = spline.secants();
        for k in 1..h.len() {
            if d[k - 1] * d[k] > 0.0 {
                let (one, two) = (h[k - 1] + 2.0 * h[k], 2.0 * h[k - 1] + h[k]);
                spline.slopes[k] = (one + two) / (one / d[k - 1] + two / d[k]);
            }
        }
        spline
    }

    fn through(nodes: &[(f64, f64)]) -> Self {
        Self {
            x: nodes.iter().map(|node| node.0).collect(),
            y: nodes.iter().map(|node| node.1).collect(),
            slopes: vec![0.0; nodes.len()],
        }
    }

    /// Distances of neighbouring nodes, and slopes of the straight lines between them.
    fn secants(&self) -> (Vec<f64>, Vec<f64>) {
        let widths: Vec<f64> = self.x.windows(2).map(|x| x[1] - x[0]).collect();
        let secants = self.y.windows(2).zip(&widths).map(|(y, h)| (y[1] - y[0]) / h);
        let secants = secants.collect();
        (widths, secants)
    }

    /// Value at `x`.
    pub fn value(&self, x: f64) -> f64 {
        self.with_derivatives(x)[0]
    }

    /// Value, first and second derivative at `x`.
    pub fn with_derivatives(&self, x: f64) -> [f64; 3] {
        let behind = self.x.partition_point(|node| *node <= x);
        if behind == 0 || behind == self.x.len() {
            let end = if behind == 0 { self.y.first() } else { self.y.last() };
            let value = if x.is_nan() {
                x
            } else {
                end.copied().unwrap_or(f64::NAN)
            };
            return [value, 0.0, 0.0];
        }
        let k = behind - 1;
        let h = self.x[behind] - self.x[k];
        let s = (x - self.x[k]) / h;
        let (m0, m1) = (h * self.slopes[k], h * self.slopes[behind]);
        let rise = self.y[behind] - self.y[k];
        let (second, third) = (3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise);
        [
            self.y[k] + s * (m0 + s * (second + s * third)),
            (m0 + s * (2.0 * second + s * 3.0 * third)) / h,
            (2.0 * second + s * 6.0 * third) / (h * h),
        ]
    }

    /// As [`Self::with_derivatives`], but a straight line before the first and behind the last node.
    pub fn straight_on(&self, x: f64) -> [f64; 3] {
        let ends = [0, self.x.len().saturating_sub(1)];
        match (self.x.first(), self.x.last()) {
            (Some(first), _) if x < *first => self.line(ends[0], x),
            (_, Some(last)) if x >= *last => self.line(ends[1], x),
            _ => self.with_derivatives(x),
        }
    }

    fn line(&self, node: usize, x: f64) -> [f64; 3] {
        let slope = self.slopes[node];
        [self.y[node] + slope * (x - self.x[node]), slope, 0.0]
    }

    /// Where steps have to end: at all nodes, for the third derivative of a natural spline jumps there too, and a step of high order
    /// across such a jump loses digits.
    pub fn kinks(&self) -> &[f64] {
        &self.x
    }

    /// First number that is out of place: its name, value and what would be right.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        if self.x.len() < 2 {
            return Some(("nodes", self.x.len() as f64, "at least two nodes"));
        }
        if let Some(x) = self.x.iter().find(|x| !x.is_finite()) {
            return Some(("node", *x, "a finite number"));
        }
        if let Some(pair) = self.x.windows(2).find(|x| x[1] <= x[0]) {
            return Some(("node", pair[1], "a node behind the one before"));
        }
        let numbers = self.y.iter().chain(&self.slopes);
        let bad = numbers.copied().find(|number| !number.is_finite());
        bad.map(|number| ("value", number, "a finite number, with finite slopes between nodes"))
    }
}
