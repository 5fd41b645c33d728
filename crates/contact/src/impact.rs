//! What a free impact does under F = K δⁿ (1 + χ δ'/v₀), exactly and for every n, K, mass and speed.
//!
//! A mass m meets the contact with the speed v₀ and no other force acts. With w = δ'/v₀ the motion obeys
//! `m v₀² w dw/(1 + χ w) = -K δⁿ dδ`. The left side integrates to φ(χ w) m v₀²/χ² with
//! φ(x) = x - ln(1 + x), the right side is the elastic energy, so that
//!
//! ```text
//! φ(χ) = φ(-χ e)                                  the restitution e, that is χ (1 + e) = ln((1 + χ)/(1 - χ e))
//! K δ_max^(n+1)/(n+1) = m v₀² φ(χ)/χ²             the greatest depth
//! ```
//!
//! Two masses count as their reduced mass m₁ m₂/(m₁ + m₂).

/// Restitution e \[-\] that a damping factor χ ≥ 0 \[-\] really delivers: one for χ = 0, towards 1/χ for large χ.
pub fn restitution(damping_factor: f64) -> f64 {
    let chi = damping_factor;
    if chi <= 0.0 {
        return 1.0;
    }
    if chi < 1e-8 {
        // The next term, of order χ², is lost in rounding, and the squares below may underflow.
        return 1.0 - 2.0 / 3.0 * chi;
    }
    // s = χ e = 1 - exp(-t) with φ(-s) = t - s = φ(χ). Convex in t, and the start lies to the right of the
    // root, so Newton's iterates come down on it.
    let target = excess(chi);
    let mut t = target + (2.0 * target).sqrt();
    for _ in 0..64 {
        let s = -(-t).exp_m1();
        let next = t - (if s < 0.1 { excess(-s) } else { t - s } - target) / s;
        if next < t {
            t = next;
        } else {
            break;
        }
    }
    -(-t).exp_m1() / chi
}

/// Damping factor χ \[-\] that delivers the restitution 0 < e ≤ 1 \[-\] exactly: zero for one, towards 1/e for small
/// ones; infinite for e ≤ 0.
pub fn damping_factor(restitution: f64) -> f64 {
    let e = restitution;
    if e >= 1.0 {
        return 0.0;
    }
    if e <= 0.0 {
        return f64::INFINITY;
    }
    // φ(χ)/χ² - φ(-χe)/χ² falls from (1 - e²)/2 at 0 to -∞ at 1/e.
    let (mut low, mut high) = (0.0, 1.0 / e);
    loop {
        let chi = 0.5 * low + 0.5 * high;
        if !(low < chi && chi < high) {
            return chi;
        }
        if depth_factor(chi) > e * e * depth_factor(-chi * e) {
            low = chi;
        } else {
            high = chi;
        }
    }
}

/// φ(χ)/χ² \[-\], the share of m v₀² that is stored at the greatest depth: 1/2 for χ = 0, falling with χ > -1.
pub fn depth_factor(damping_factor: f64) -> f64 {
    let x = damping_factor;
    if x.abs() < 0.1 {
        series(x)
    } else {
        (x - x.ln_1p()) / x / x
    }
}

/// φ(x) = x - ln(1 + x) without cancellation.
fn excess(x: f64) -> f64 {
    if x.abs() < 0.1 {
        series(x) * x * x
    } else {
        x - x.ln_1p()
    }
}

/// 1/2 - x/3 + x²/4 - ..., to rounding for |x| ≤ 0.1.
fn series(x: f64) -> f64 {
    (2..18).rev().fold(0.0, |sum, k| 1.0 / f64::from(k) - x * sum)
}
