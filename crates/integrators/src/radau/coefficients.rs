//! The coefficients of the method, by formula.

use num_complex::Complex64;

type Matrix = [[f64; 3]; 3];

/// The three-stage Radau IIA formula and the transformation which splits its equations (Hairer, Wanner II, IV.5 and IV.8).
#[derive(Debug, Clone)]
pub(crate) struct Coefficients {
    /// Nodes cᵢ.
    pub c: [f64; 3],
    /// A; its last row holds the weights.
    pub a: Matrix,
    /// T and its inverse: T⁻¹ A⁻¹ T = [[γ, 0, 0], [0, α, −β], [0, β, α]].
    pub t: Matrix,
    /// T⁻¹.
    pub t_inverse: Matrix,
    /// γ, the real eigenvalue of A⁻¹.
    pub real: f64,
    /// α + i β, the eigenvalue above the real axis.
    pub complex: Complex64,
    /// Last row of A⁻¹: h times the derivative of the collocation polynomial at the end of the step is Σ rᵢ zᵢ.
    pub rate: [f64; 3],
    /// eᵢ: h f(t, y) + Σ eᵢ zᵢ is γ times the difference to a formula of order 3.
    pub e: [f64; 3],
}

impl Coefficients {
    pub(crate) fn new() -> Self {
        let root = 6.0_f64.sqrt();
        let c = [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0];
        let a = [
            [
                (88.0 - 7.0 * root) / 360.0,
                (296.0 - 169.0 * root) / 1800.0,
                (-2.0 + 3.0 * root) / 225.0,
            ],
            [
                (296.0 + 169.0 * root) / 1800.0,
                (88.0 + 7.0 * root) / 360.0,
                (-2.0 - 3.0 * root) / 225.0,
            ],
            [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
        ];
        // The zeros of z³ − 9 z² + 36 z − 60, the denominator of the stability function turned round.
        let (third, ninth) = (3.0_f64.cbrt(), 9.0_f64.cbrt());
        let real = 3.0 + ninth - third;
        let complex = Complex64::new(3.0 - 0.5 * (ninth - third), 0.5 * 3.0_f64.sqrt() * (ninth + third));
        // Columns of T: the real eigenvector of length 1, then real and negative imaginary part of the other one.
        let u = eigenvector(&a, real.into()).map(|x| x.re);
        let length = u.iter().map(|x| x * x).sum::<f64>().sqrt();
        let v = eigenvector(&a, complex);
        let t: Matrix = std::array::from_fn(|i| [u[i] / length, v[i].re, -v[i].im]);
        Self {
            c,
            a,
            t,
            t_inverse: inverse(&t),
            real,
            complex,
            rate: inverse(&a)[2],
            e: [(-13.0 - 7.0 * root) / 3.0, (-13.0 + 7.0 * root) / 3.0, -1.0 / 3.0],
        }
    }
}

/// The vector v with A⁻¹ v = λ v and v₃ = 1: perpendicular to the first two rows of A − 1/λ.
fn eigenvector(a: &Matrix, lambda: Complex64) -> [Complex64; 3] {
    let mut rows = a.map(|row| row.map(Complex64::from));
    (0..3).for_each(|i| rows[i][i] -= lambda.inv());
    let [x, y, _] = rows;
    let v = cross(&x, &y);
    [v[0] / v[2], v[1] / v[2], Complex64::new(1.0, 0.0)]
}

fn cross<T>(x: &[T; 3], y: &[T; 3]) -> [T; 3]
where
    T: Copy + std::ops::Mul<Output = T> + std::ops::Sub<Output = T>,
{
    [
        x[1] * y[2] - x[2] * y[1],
        x[2] * y[0] - x[0] * y[2],
        x[0] * y[1] - x[1] * y[0],
    ]
}

fn inverse(m: &Matrix) -> Matrix {
    // Columns of the inverse: cross products of rows over the determinant.
    let columns = [cross(&m[1], &m[2]), cross(&m[2], &m[0]), cross(&m[0], &m[1])];
    let determinant: f64 = (0..3).map(|k| m[0][k] * columns[0][k]).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i] / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, expected: f64) {
        assert!(
            (found - expected).abs() < 2e-15 * expected.abs().max(1.0),
            "{found} {expected}"
        );
    }

    fn power(x: f64, k: usize) -> f64 {
        x.powi(k as i32)
    }

    /// B(5), C(3), D(2): order 5 (Hairer, Wanner II, IV.5).
    #[test]
    fn simplifying_assumptions() {
        let Coefficients { a, c, .. } = Coefficients::new();
        let b = a[2];
        for k in 1..=5 {
            close((0..3).map(|i| b[i] * power(c[i], k - 1)).sum(), 1.0 / k as f64);
        }
        for (k, i) in (1..=3).flat_map(|k| (0..3).map(move |i| (k, i))) {
            close(
                (0..3).map(|j| a[i][j] * power(c[j], k - 1)).sum(),
                power(c[i], k) / k as f64,
            );
        }
        for (k, j) in (1..=2).flat_map(|k| (0..3).map(move |j| (k, j))) {
            let sum = (0..3).map(|i| b[i] * power(c[i], k - 1) * a[i][j]).sum();
            close(sum, b[j] * (1.0 - power(c[j], k)) / k as f64);
        }
        // Not of order 6.
        let sixth: f64 = (0..3).map(|i| b[i] * power(c[i], 5)).sum();
        assert!((sixth - 1.0 / 6.0).abs() > 1e-4);
    }

    /// A T Λ = T and T T⁻¹ = 1.
    #[test]
    fn transformation() {
        let Coefficients {
            a,
            t,
            t_inverse,
            real,
            complex,
            ..
        } = Coefficients::new();
        let lambda = [
            [real, 0.0, 0.0],
            [0.0, complex.re, -complex.im],
            [0.0, complex.im, complex.re],
        ];
        let times = |x: &Matrix, y: &Matrix| -> Matrix {
            std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| x[i][k] * y[k][j]).sum()))
        };
        let (back, one) = (times(&times(&a, &t), &lambda), times(&t, &t_inverse));
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            close(back[i][j], t[i][j]);
            close(one[i][j], f64::from(u8::from(i == j)));
        }
    }

    /// T as it stands in subroutine RADAU5.
    #[test]
    fn published_digits() {
        let published = [
            [0.09123239487089295, -0.1412552950209542, -0.030029194105147424],
            [0.241717932707107, 0.20412935229379994, 0.3829421127572619],
            [0.966048182615093, 1.0, 0.0],
        ];
        let t = Coefficients::new().t;
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            close(t[i][j], published[i][j]);
        }
    }

    /// The derivative at the end is right for degree 3.
    #[test]
    fn rate_at_the_end() {
        let Coefficients { c, rate, .. } = Coefficients::new();
        (1..=3).for_each(|k| {
            close(
                (0..3).map(|i| rate[i] * power(c[i], k)).sum::<f64>() / 10.0,
                k as f64 / 10.0,
            )
        });
    }

    /// The estimate vanishes for solutions of degree 3 and not of degree 4.
    #[test]
    fn estimate_of_order_3() {
        let Coefficients { c, e, .. } = Coefficients::new();
        let estimate = |k: usize| f64::from(u8::from(k == 1)) + (0..3).map(|i| e[i] * power(c[i], k)).sum::<f64>();
        (1..=3).for_each(|k| close(estimate(k), 0.0));
        assert!(estimate(4).abs() > 0.1);
    }
}
