//! Newton's method for the loop reaction - load - acceleration where all capacities are sums of lengths on supports.
//!
//! This is [`crate::reaction_loop`] once more, for up to `4 W` loads: fours all along, loops of constant length, and nothing that
//! leaves the registers without need. Loads that are missing have no gain; they stay zero.

use crate::lanes::{Four, Lanes};
use crate::lever::Felt;
use std::array::from_fn;

/// A number each load.
type PerLoad<const W: usize> = [Four; W];

/// What each load's supports feel.
type OnSupports<const W: usize> = [[Four; 5]; W];

/// Smallest pivot with which elimination goes on without exchanges. The matrices here are a unit matrix and a feedback; the
/// units of the unknowns do not change their pivots.
const DOUBTFUL: f64 = 1e-2;
/// Added to squares that divide: a length of zero has the direction zero.
const NO_SQUARE: f64 = 1e-300;

/// Where Newton's method came to an end.
pub(crate) struct End {
    /// Relative to the largest load; what is not a number stays so.
    pub residual: f64,
    pub measure: f64,
    pub iterations: u64,
}

/// Newton's method from vanishing loads to loads `found` for which the residual is within `tolerance`, in at `most` so many
/// steps; the last one is left where they are not enough. What the loads feel is told as by [`crate::influence::Influence::felt`].
/// `None` where there are too many loads for this way, or where a Jacobian asks for exchanges of rows.
#[inline]
pub(crate) fn newton(felt: &[Felt], gains: &[f64], found: &mut [f64], tolerance: f64, most: usize) -> Option<End> {
    match found.len().div_ceil(4) {
        1 => newton_sized::<1>(felt, gains, found, tolerance, most),
        2 => newton_sized::<2>(felt, gains, found, tolerance, most),
        3 => newton_sized::<3>(felt, gains, found, tolerance, most),
        _ => None,
    }
}

#[inline(always)]
fn newton_sized<const W: usize>(
    felt: &[Felt],
    gains: &[f64],
    found: &mut [f64],
    tolerance: f64,
    most: usize,
) -> Option<End> {
    let equations = Loop::<W> {
        felt: &felt[..W * (1 + 4 * W)],
        gains: from_fn(|w| Lanes(from_fn(|l| gains.get(4 * w + l).copied().unwrap_or(0.0)))),
    };
    let mut trial = [Four::ZERO; W];
    let mut end = End {
        residual: f64::INFINITY,
        measure: 1.0,
        iterations: 0,
    };
    while (end.iterations as usize) < most {
        let residual = equations.residual(&trial, &equations.felt_at(&trial));
        end.residual = residual.relative();
        if end.residual.is_nan() {
            break;
        }
        end.iterations += 1;
        let factors = Factors::new(equations.jacobian(&residual.directions))?;
        end.measure = factors.determinant;
        if end.residual <= tolerance {
            break;
        }
        let step = factors.solve(residual.value);
        for w in 0..W {
            trial[w] -= step[w];
        }
    }
    for (found, trial) in found.iter_mut().zip(trial.iter().flat_map(|four| four.0)) {
        *found = trial;
    }
    Some(end)
}

/// The loop: what is felt without loads and of each unit load, by each four of loads; gains.
struct Loop<'a, const W: usize> {
    felt: &'a [Felt],
    gains: PerLoad<W>,
}

/// Residual of the loop.
struct Residual<const W: usize> {
    value: PerLoad<W>,
    /// Directions of what is felt: the gradient of the capacity.
    directions: OnSupports<W>,
    worst: f64,
    largest: f64,
}

/// Factors of the Jacobian by Gauss and Jordan.
struct Factors<const W: usize> {
    /// What each step takes off the rows, in units of its pivot's row.
    shares: [[PerLoad<W>; 4]; W],
    inverse: PerLoad<W>,
    determinant: f64,
}

impl<const W: usize> Loop<'_, W> {
    /// What is felt by four loads without loads (`k = 0`), or of unit load `k - 1`.
    #[inline(always)]
    fn felt(&self, w: usize, k: usize) -> &Felt {
        &self.felt[w * (1 + 4 * W) + k]
    }

    #[inline(always)]
    fn felt_at(&self, trial: &PerLoad<W>) -> OnSupports<W> {
        from_fn(|w| {
            from_fn(|i| {
                let mut sum = self.felt(w, 0)[i];
                for (v, four) in trial.iter().enumerate() {
                    let unit = |l: usize| self.felt(w, 1 + 4 * v + l)[i] * four.0[l];
                    sum += (unit(0) + unit(1)) + (unit(2) + unit(3));
                }
                sum
            })
        })
    }

    #[inline(always)]
    fn residual(&self, trial: &PerLoad<W>, felt: &OnSupports<W>) -> Residual<W> {
        let mut directions = [[Four::ZERO; 5]; W];
        let mut value = [Four::ZERO; W];
        let (mut worst, mut largest, mut sum) = (Four::ZERO, Four::ZERO, Four::ZERO);
        for w in 0..W {
            let [ax, ay, bx, by, z] = felt[w];
            let (aa, bb, zz) = (ax * ax + ay * ay, bx * bx + by * by, z * z);
            let (a, b, along) = (aa.sqrt(), bb.sqrt(), z.abs());
            // One over the square goes beside the root: there is less to wait for than with one over the length.
            let per = |square: Four, length: Four| square.map(|x| 1.0 / (x + NO_SQUARE)) * length;
            let (per_a, per_b, per_z) = (per(aa, a), per(bb, b), per(zz, along));
            directions[w] = [ax * per_a, ay * per_a, bx * per_b, by * per_b, z * per_z];
            let load = self.gains[w] * (a + b + along);
            value[w] = trial[w] + load;
            sum += value[w];
            worst = worst.larger(value[w].abs());
            largest = largest.larger(trial[w].abs()).larger(load.abs());
        }
        Residual {
            value,
            directions,
            // What is not a number hides from comparisons, but not in a sum.
            worst: if sum.sum().is_nan() { f64::NAN } else { worst.largest() },
            largest: largest.largest(),
        }
    }

    /// Columns of the Jacobian.
    #[inline(always)]
    fn jacobian(&self, directions: &OnSupports<W>) -> [[PerLoad<W>; 4]; W] {
        let unit = |on: bool, l: usize| Lanes(from_fn(|row| f64::from(u8::from(on && row == l))));
        from_fn(|v| {
            from_fn(|l| {
                from_fn(|w| {
                    let felt = self.felt(w, 1 + 4 * v + l);
                    let along = |i: usize| directions[w][i] * felt[i];
                    let slope = (along(0) + along(1)) + (along(2) + along(3)) + along(4);
                    slope * self.gains[w] + unit(v == w, l)
                })
            })
        })
    }
}

impl<const W: usize> Residual<W> {
    /// Relative to the largest load.
    #[inline(always)]
    fn relative(&self) -> f64 {
        if self.worst == 0.0 {
            0.0
        } else {
            self.worst / self.largest
        }
    }
}

impl<const W: usize> Factors<W> {
    /// Without exchanges; `None` where a pivot is too small for that.
    #[inline(always)]
    fn new(mut columns: [[PerLoad<W>; 4]; W]) -> Option<Self> {
        let mut shares = [[[Four::ZERO; W]; 4]; W];
        let mut inverse = [Four::ZERO; W];
        let mut determinant = 1.0;
        for v in 0..W {
            let mut inverses = [0.0; 4];
            for l in 0..4 {
                let pivot = columns[v][l][v].0[l];
                if pivot.is_nan() || pivot.abs() < DOUBTFUL {
                    return None;
                }
                determinant *= pivot;
                inverses[l] = 1.0 / pivot;
                // The pivot's own row stays.
                let share: PerLoad<W> = from_fn(|w| {
                    let column = columns[v][l][w] * inverses[l];
                    Lanes(from_fn(|row| if v == w && row == l { 0.0 } else { column.0[row] }))
                });
                for (u, k) in (0..4 * W).map(|column| (column / 4, column % 4)) {
                    if 4 * u + k > 4 * v + l {
                        let factor = columns[u][k][v].0[l];
                        for w in 0..W {
                            columns[u][k][w] -= share[w] * factor;
                        }
                    }
                }
                shares[v][l] = share;
            }
            inverse[v] = Lanes(inverses);
        }
        Some(Self {
            shares,
            inverse,
            determinant,
        })
    }

    #[inline(always)]
    fn solve(&self, mut b: PerLoad<W>) -> PerLoad<W> {
        for v in 0..W {
            for l in 0..4 {
                let factor = b[v].0[l];
                for w in 0..W {
                    b[w] -= self.shares[v][l][w] * factor;
                }
            }
        }
        from_fn(|w| b[w] * self.inverse[w])
    }
}
