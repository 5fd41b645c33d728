//! Time of whole runs of RSRRR, 0 to 5 s without output, and how much of it is not evaluations.
//!
//! Prints the evaluations of each run: its time less evaluations x time of one evaluation is what driver, method and projection
//! add. `tools/instructions` counts the same exactly.

#![allow(missing_docs)]

mod cases;

use cases::{WholeRun, rsrrr_case};
use criterion::{Criterion, criterion_group, criterion_main};

fn runs(c: &mut Criterion) {
    for friction in [false, true] {
        let name = if friction { "rsrrr friction" } else { "rsrrr" };
        let mut case = rsrrr_case(friction);
        c.bench_function(&format!("{name}: one evaluation"), |b| b.iter(|| case.evaluate()));
        let run = WholeRun::rsrrr(friction);
        println!("{name}: Adams (crank angle, evaluations) = {:?}", run.by_adams());
        c.bench_function(&format!("{name}: run by Adams"), |b| b.iter(|| run.by_adams()));
        println!("{name}: Dop853 (crank angle, evaluations) = {:?}", run.by_dop853());
        c.bench_function(&format!("{name}: run by Dop853"), |b| b.iter(|| run.by_dop853()));
    }
}

criterion_group!(benches, runs);
criterion_main!(benches);
