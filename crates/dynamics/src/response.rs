//! How the rates of the speeds respond to loads: `X tau`, with `X` of low rank.
//!
//! Column k of `X` holds the rates for a unit of load k. Its rank is that of the freedoms which the closures leave, or of the loads
//! if these are fewer. It is written as `Z Y^T`: each column of `Z` is a **motion**, its row in `Y` tells the shares of the loads in it.

/// Pivots below this share of what they are the rest of are rounding.
const ROUNDING: f64 = 1e-14;

/// `X = Z Y^T`.
#[derive(Clone, Debug)]
pub(crate) struct Response {
    loads: usize,
    speeds: usize,
    motions: usize,
    /// `Z`, one motion after the other.
    rates: Vec<f64>,
    /// `Y`, one motion after the other.
    shares: Vec<f64>,
}

impl Response {
    pub fn new(loads: usize, speeds: usize) -> Self {
        let most = loads.min(speeds);
        Self {
            loads,
            speeds,
            motions: 0,
            rates: vec![0.0; most * speeds],
            shares: vec![0.0; most * loads],
        }
    }

    /// Number of motions.
    #[inline]
    pub fn motions(&self) -> usize {
        self.motions
    }

    /// Shares of the loads in a motion.
    #[inline]
    pub fn shares(&self, motion: usize) -> &[f64] {
        &self.shares[motion * self.loads..][..self.loads]
    }

    /// Rate of a speed in a motion; zero where there are fewer motions.
    #[inline]
    pub fn rate(&self, motion: usize, speed: usize) -> f64 {
        if motion < self.motions {
            self.rates[motion * self.speeds + speed]
        } else {
            0.0
        }
    }

    /// Finds at `most` so many motions by Cholesky's method with pivots: `x(speed, k)` tells `X`, which is symmetric and positive
    /// in the rows of the loads' own speeds `own(k)`. `free` are responses of the speeds to their own force that tell the scale
    /// of rounding: where closures hold a joint fast, `X` is nothing else.
    #[inline]
    pub fn find(&mut self, most: usize, own: impl Fn(usize) -> usize, x: impl Fn(usize, usize) -> f64, free: &[f64]) {
        let (loads, speeds) = (self.loads, self.speeds);
        for r in 0..most {
            let (known_rates, rates) = self.rates.split_at_mut(r * speeds);
            let (known_shares, shares) = self.shares.split_at_mut(r * loads);
            let rest = |speed: usize, k: usize| {
                let known = |c: usize| known_rates[c * speeds + speed] * known_shares[c * loads + k];
                (0..r).fold(x(speed, k), |x, c| x - known(c))
            };
            // The largest in units of the free response, so that slides and turns compare.
            let (mut p, mut pivot, mut unit) = (0, 0.0, 1.0);
            for k in 0..loads {
                let speed = own(k);
                let (diagonal, scale) = (rest(speed, k), free[speed]);
                let is_rounding = diagonal <= ROUNDING * scale || (r > 0 && diagonal <= ROUNDING * x(speed, k));
                if !is_rounding && diagonal * unit > pivot * scale {
                    (p, pivot, unit) = (k, diagonal, scale);
                }
            }
            if pivot == 0.0 {
                self.motions = r;
                return;
            }
            let (inverse, speed) = (1.0 / pivot, own(p));
            for (i, rate) in rates[..speeds].iter_mut().enumerate() {
                *rate = rest(i, p);
            }
            for (k, share) in shares[..loads].iter_mut().enumerate() {
                *share = rest(speed, k) * inverse;
            }
        }
        self.motions = most;
    }

    /// Adds `X tau` to the rates.
    #[inline]
    pub fn add(&self, tau: &[f64], rates: &mut [f64]) {
        for motion in 0..self.motions {
            let share: f64 = tau
                .iter()
                .zip(self.shares(motion))
                .map(|(tau, share)| tau * share)
                .sum();
            for (rate, z) in rates.iter_mut().zip(&self.rates[motion * self.speeds..]) {
                *rate += z * share;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Units of a speed: every other one is told in others.
    fn units(i: usize, scale: f64) -> f64 {
        if i.is_multiple_of(2) { 1.0 } else { scale }
    }

    /// `Q D Q^T` with `rank` orthogonal columns of very different size, seen by loads on some speeds.
    fn response(own: &[usize], rank: usize, scale: f64) -> (Response, impl Fn(usize, usize) -> f64) {
        const N: usize = 6;
        let column = |c: usize, i: usize| ((2 * i + 1) as f64 * c as f64 * std::f64::consts::PI / (2 * N) as f64).cos();
        let units = move |i| units(i, scale);
        let full = move |i: usize, k: usize| -> f64 {
            let sum: f64 = (0..rank)
                .map(|c| column(c, i) * column(c, k) * 10.0_f64.powi(-(c as i32)))
                .sum();
            sum * units(i) * units(k)
        };
        let free: Vec<f64> = (0..N).map(|i| 2.0 * units(i) * units(i)).collect();
        let mut response = Response::new(own.len(), N);
        let speeds = own.to_vec();
        let x = move |speed: usize, k: usize| full(speed, speeds[k]);
        response.find(own.len().min(N), |k| own[k], &x, &free);
        (response, x)
    }

    #[test]
    fn motions_and_shares_give_the_response_in_any_units() {
        for scale in [1.0, 1e-6, 1e6] {
            for rank in 0..=6 {
                for own in [&[0, 1, 2, 3, 4, 5][..], &[4, 1], &[2, 5, 2], &[3]] {
                    let (response, x) = response(own, rank, scale);
                    let distinct = own.iter().collect::<std::collections::BTreeSet<_>>().len();
                    assert_eq!(response.motions(), rank.min(distinct), "rank {rank}, loads on {own:?}");
                    for k in 0..own.len() {
                        let mut rates = [0.0; 6];
                        let tau: Vec<f64> = (0..own.len()).map(|l| f64::from(u8::from(l == k))).collect();
                        response.add(&tau, &mut rates);
                        for (i, rate) in rates.iter().enumerate() {
                            let gap = (rate - x(i, k)) / (units(i, scale) * units(own[k], scale));
                            assert!(gap.abs() < 1e-14 * 50.0, "rank {rank}, loads on {own:?}: {gap:e}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_joint_that_is_held_fast_has_no_motion() {
        let mut response = Response::new(1, 2);
        response.find(1, |_| 0, |_, _| 3e-17, &[0.5, 0.5]);
        assert_eq!(response.motions(), 0);
        assert_eq!(response.rate(0, 1), 0.0);
    }

    #[test]
    fn what_is_not_a_number_has_no_motion() {
        let mut response = Response::new(1, 1);
        response.find(1, |_| 0, |_, _| f64::NAN, &[1.0]);
        assert_eq!(response.motions(), 0);
    }
}
