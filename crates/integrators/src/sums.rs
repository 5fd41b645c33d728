//! Linear combinations of stages, the only loops that every step runs through.

/// out = y + h Σ aⱼ kⱼ, where the stages k lie one after the other in `stages`.
#[inline]
pub(crate) fn combine(out: &mut [f64], y: &[f64], h: f64, row: &[(usize, f64)], stages: &[f64]) {
    out.copy_from_slice(y);
    add(out, h, row, stages);
}

/// out += h Σ aⱼ kⱼ, the whole sum being formed before it is added.
#[inline]
pub(crate) fn add(out: &mut [f64], h: f64, row: &[(usize, f64)], stages: &[f64]) {
    match row.len() {
        1 => add_terms::<1>(out, h, row, stages),
        2 => add_terms::<2>(out, h, row, stages),
        3 => add_terms::<3>(out, h, row, stages),
        4 => add_terms::<4>(out, h, row, stages),
        5 => add_terms::<5>(out, h, row, stages),
        6 => add_terms::<6>(out, h, row, stages),
        7 => add_terms::<7>(out, h, row, stages),
        8 => add_terms::<8>(out, h, row, stages),
        _ => {
            let (head, tail) = row.split_at(8);
            add_terms::<8>(out, h, head, stages);
            add(out, h, tail, stages);
        }
    }
}

/// `add` with a number of terms known to the compiler, so that it unrolls the inner loop and vectorises the outer one.
fn add_terms<const K: usize>(out: &mut [f64], h: f64, row: &[(usize, f64)], stages: &[f64]) {
    let n = out.len();
    let a: [f64; K] = std::array::from_fn(|j| row[j].1);
    let k: [&[f64]; K] = std::array::from_fn(|j| &stages[row[j].0 * n..][..n]);
    for (i, out) in out.iter_mut().enumerate() {
        let mut sum = 0.0;
        for j in 0..K {
            sum += a[j] * k[j][i];
        }
        *out += h * sum;
    }
}
