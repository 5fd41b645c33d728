//! The collocation polynomial of a step: interpolation, and prediction of the next one.

/// The polynomial of degree 3 through the start and the stages of a step (Hairer, Wanner II, IV.8), in Newton's form.
#[derive(Debug, Clone, Default)]
pub(crate) struct Polynomial {
    /// Signed length of the step; none before the first.
    h: Option<f64>,
    nodes: [f64; 3],
    /// Divided differences of orders 1 to 3 over (1, c₂), (1, c₂, c₁), (1, c₂, c₁, 0), one vector after the other.
    differences: [Vec<f64>; 3],
}

impl Polynomial {
    pub(crate) fn new(nodes: [f64; 3], dim: usize) -> Self {
        Self {
            h: None,
            nodes,
            differences: std::array::from_fn(|_| vec![0.0; dim]),
        }
    }

    /// Forgets the step.
    pub(crate) fn clear(&mut self) {
        self.h = None;
    }

    /// Takes over the changes `z` from the start of the step to its stages.
    pub(crate) fn set(&mut self, h: f64, z: &[Vec<f64>; 3]) {
        let [c1, c2, _] = self.nodes;
        self.h = Some(h);
        let [first, second, third] = &mut self.differences;
        for i in 0..first.len() {
            let (z1, z2, z3) = (z[0][i], z[1][i], z[2][i]);
            let (late, middle, early) = ((z2 - z3) / (c2 - 1.0), (z1 - z2) / (c1 - c2), z1 / c1);
            let (bend, bend_before) = ((middle - late) / (c1 - 1.0), (early - middle) / -c2);
            (first[i], second[i], third[i]) = (late, bend, bend - bend_before);
        }
    }

    /// The step whose polynomial this is.
    pub(crate) fn step(&self) -> Option<f64> {
        self.h
    }

    /// Adds to `y` the change between two places.
    pub(crate) fn add_change_between(&self, from: f64, to: f64, y: &mut [f64]) {
        if from != 1.0 {
            y.iter_mut().for_each(|y| *y = -*y);
            self.add_change(from, y);
            y.iter_mut().for_each(|y| *y = -*y);
        }
        self.add_change(to, y);
    }

    /// Adds to `y` the change from the end of the step to `theta`; 1 is the end, more lies beyond.
    pub(crate) fn add_change(&self, theta: f64, y: &mut [f64]) {
        let [c1, c2, _] = self.nodes;
        let (s, s1, s2) = (theta - 1.0, theta - c1, theta - c2);
        let [first, second, third] = &self.differences;
        for (i, y) in y.iter_mut().enumerate() {
            *y += s * (first[i] + s2 * (second[i] + s1 * third[i]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_3_are_met() {
        let nodes = [0.2, 0.6, 1.0];
        let cubic = |x: f64| [x * (2.0 - x + 3.0 * x * x), x, 0.0, -x * x];
        let mut polynomial = Polynomial::new(nodes, 4);
        assert_eq!(polynomial.step(), None);
        polynomial.set(0.5, &nodes.map(|c| cubic(c).to_vec()));
        assert_eq!(polynomial.step(), Some(0.5));
        for theta in [-0.7, 0.0, 0.2, 0.4, 0.6, 1.0, 1.3, 4.0] {
            let mut y = cubic(1.0);
            polynomial.add_change(theta, &mut y);
            for (y, expected) in y.iter().zip(cubic(theta)) {
                assert!(
                    (y - expected).abs() < 1e-13 * (1.0 + expected.abs()),
                    "{theta}: {y} {expected}"
                );
            }
            polynomial.add_change_between(theta, 0.2, &mut y);
            for (y, expected) in y.iter().zip(cubic(0.2)) {
                assert!((y - expected).abs() < 1e-12 * (1.0 + cubic(theta)[0].abs()));
            }
        }
        polynomial.clear();
        assert_eq!(polynomial.step(), None);
    }
}
