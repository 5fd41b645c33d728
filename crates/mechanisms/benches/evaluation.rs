//! Time of one evaluation, state to accelerations and multipliers, beside the unit LU7.

#![allow(missing_docs)]

mod cases;

use cases::{chain_case, lu7, rsrrr_case};
use criterion::{Criterion, criterion_group, criterion_main};

fn evaluation(c: &mut Criterion) {
    let mut unit = lu7();
    c.bench_function("lu7", |b| b.iter(&mut unit));
    for friction in [false, true] {
        let mut case = rsrrr_case(friction);
        let name = if friction { "rsrrr friction" } else { "rsrrr" };
        c.bench_function(name, |b| b.iter(|| case.evaluate()));
    }
    for n in [4, 8, 16, 32, 64] {
        let mut case = chain_case(n);
        c.bench_function(&format!("chain {n}"), |b| b.iter(|| case.evaluate()));
    }
    let mut unit = lu7();
    c.bench_function("lu7 again", |b| b.iter(&mut unit));
}

criterion_group!(benches, evaluation);
criterion_main!(benches);
