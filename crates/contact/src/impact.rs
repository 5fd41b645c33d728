//! What a free impact does under F = K δⁿ (1 + ξ δ'/v₀), exactly and for every n, K, mass and speed.
//!
//! A mass m meets the contact with the speed v₀ and no other force acts. With w = δ'/v₀ the motion obeys
//! `m v₀² w dw/(1 + ξ w) = -K δⁿ dδ`. The left side integrates to L(ξ w) m v₀²/ξ² with
//! L(x) = x - ln(1 + x), the right side is the elastic energy, so that
//!
//! ```text
//! L(ξ) = L(-ξ ε)                                  the restitution ε, that is ξ (1 + ε) = ln((1 + ξ)/(1 - ξ ε))
//! K δ_max^(n+1)/(n+1) = m v₀² L(ξ)/ξ²             the greatest depth
//! ```
//!
//! Two masses count as their reduced mass m₁ m₂/(m₁ + m₂).

/// Restitution ε \[-\] that a damping factor ξ ≥ 0 \[-\] really delivers: one for ξ = 0, towards 1/ξ for large ξ.
pub fn restitution(damping_factor: f64) -> f64 {
    let xi = damping_factor;
    if xi <= 0.0 {
        return 1.0;
    }
    if xi < 1e-8 {
        // The next term, of order ξ², is lost in rounding, and the squares below may underflow.
        return 1.0 - 2.0 / 3.0 * xi;
    }
    // s = ξ ε = 1 - exp(-t) with L(-s) = t - s = L(ξ). Convex in t, and the start lies to the right of the
    // root, so Newton's iterates come down on it.
    let target = excess(xi);
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
    -(-t).exp_m1() / xi
}

/// Damping factor ξ \[-\] that delivers the restitution 0 < ε ≤ 1 \[-\] exactly: zero for one, towards 1/ε for small
/// ones; infinite for ε ≤ 0.
pub fn damping_factor(restitution: f64) -> f64 {
    let eps = restitution;
    if eps >= 1.0 {
        return 0.0;
    }
    if eps <= 0.0 {
        return f64::INFINITY;
    }
    // L(ξ)/ξ² - L(-ξε)/ξ² falls from (1 - ε²)/2 at 0 to -∞ at 1/ε.
    let (mut low, mut high) = (0.0, 1.0 / eps);
    loop {
        let xi = 0.5 * low + 0.5 * high;
        if !(low < xi && xi < high) {
            return xi;
        }
        if depth_factor(xi) > eps * eps * depth_factor(-xi * eps) {
            low = xi;
        } else {
            high = xi;
        }
    }
}

/// L(ξ)/ξ² \[-\], the share of m v₀² that is stored at the greatest depth: 1/2 for ξ = 0, falling with ξ > -1.
pub fn depth_factor(damping_factor: f64) -> f64 {
    let x = damping_factor;
    if x.abs() < 0.1 {
        series(x)
    } else {
        (x - x.ln_1p()) / x / x
    }
}

/// L(x) = x - ln(1 + x) without cancellation.
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
