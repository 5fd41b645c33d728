//! Two supports that share the force and torque across the joint axis.

use super::Capacity;

/// Plane forces on the supports A at z = -a/2 and B at z = +a/2 \[N\]:
///
/// ```text
/// A = (f_x/2 - n_y/a, f_y/2 + n_x/a)        Harlecki and Urbaś, eq. (6.1)
/// B = (f_x/2 + n_y/a, f_y/2 - n_x/a)        eq. (6.2)
/// ```
#[inline]
pub(super) fn forces(spacing: f64, f: [f64; 3], n: [f64; 3]) -> ([f64; 2], [f64; 2]) {
    let (f_x, f_y) = (0.5 * f[0], 0.5 * f[1]);
    let (n_x, n_y) = (n[0] / spacing, n[1] / spacing);
    ([f_x - n_y, f_y + n_x], [f_x + n_y, f_y - n_x])
}

/// w_A |A| + w_B |B| with its gradient.
#[inline]
pub(super) fn capacity(spacing: f64, [w_a, w_b]: [f64; 2], force: [f64; 3], torque: [f64; 3]) -> Capacity {
    let (a, b) = forces(spacing, force, torque);
    let (f_a, [a_x, a_y]) = polar(a);
    let (f_b, [b_x, b_y]) = polar(b);
    let (a_x, a_y, b_x, b_y) = (w_a * a_x, w_a * a_y, w_b * b_x, w_b * b_y);
    Capacity {
        value: w_a * f_a + w_b * f_b,
        d_force: [0.5 * (a_x + b_x), 0.5 * (a_y + b_y), 0.0],
        d_torque: [(a_y - b_y) / spacing, (b_x - a_x) / spacing, 0.0],
    }
}

/// Length and direction of a plane vector. Zero has the direction zero, which is the shortest of all
/// its subgradients.
#[inline]
pub(super) fn polar([x, y]: [f64; 2]) -> (f64, [f64; 2]) {
    let square = x * x + y * y;
    // Squares in this range have neither overflowed nor lost digits.
    if (1e-280..1e300).contains(&square) {
        let r = square.sqrt();
        (r, [x / r, y / r])
    } else {
        polar_rescaled([x, y])
    }
}

#[cold]
fn polar_rescaled([x, y]: [f64; 2]) -> (f64, [f64; 2]) {
    let m = x.abs().max(y.abs());
    if m == 0.0 {
        return (0.0, [0.0, 0.0]);
    }
    let (x, y) = (x / m, y / m);
    let r = (x * x + y * y).sqrt();
    (m * r, [x / r, y / r])
}

/// |x| and its derivative, with zero for the latter at zero.
#[inline]
pub(super) fn magnitude(x: f64) -> (f64, f64) {
    (x.abs(), if x == 0.0 { 0.0 } else { x.signum() })
}
