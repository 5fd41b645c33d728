//! The cubic Hermite polynomial of a step.

/// Writes y(t + θh) from the states and derivatives at both ends (Hairer, Nørsett, Wanner I, eq. II.6.7): local error O(h⁴).
pub(crate) fn interpolate(theta: f64, h: f64, [y0, f0]: [&[f64]; 2], [y1, f1]: [&[f64]; 2], y: &mut [f64]) {
    let eta = 1.0 - theta;
    for (i, y) in y.iter_mut().enumerate() {
        let chord = y1[i] - y0[i];
        let bend = eta * (h * f0[i] - chord) + theta * (chord - h * f1[i]);
        *y = y0[i] + theta * (chord + eta * bend);
    }
}
