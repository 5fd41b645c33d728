//! What driver and method add to the evaluations: a right-hand side of 9 components that costs next to nothing, so that the time
//! per element is the overhead per evaluation.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use linkdyn_integrators::{
    Adams, Dop853, DormandPrince5, EvalError, Integration, Method, Ode, Progress, Rk4, Settings,
};

struct Rotation;

impl Ode for Rotation {
    fn dim(&self) -> usize {
        9
    }
    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), EvalError> {
        for i in 0..4 {
            (dy[i], dy[4 + i]) = (y[4 + i], -y[i]);
        }
        dy[8] = y[0];
        Ok(())
    }
}

fn run<M: Method<Rotation>>(method: M) -> u64 {
    let y0 = [1.0, 0.5, 0.2, 0.1, 0.0, 0.3, 0.7, 0.9, 0.0];
    let settings = Settings::tolerances(1e-8, 1e-8);
    let mut run = Integration::new(Rotation, method, 0.0, &y0, settings).expect("good settings");
    while !matches!(run.advance(200.0).expect("smooth problem"), Progress::Done { .. }) {}
    black_box(run.state().1[8]);
    run.statistics().evaluations
}

fn overhead(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("overhead per evaluation");
    group
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    group.throughput(Throughput::Elements(run(Rk4::new(0.01))));
    group.bench_function("Rk4", |bencher| bencher.iter(|| run(Rk4::new(0.01))));
    group.throughput(Throughput::Elements(run(DormandPrince5::default())));
    group.bench_function("DormandPrince5", |bencher| {
        bencher.iter(|| run(DormandPrince5::default()))
    });
    group.throughput(Throughput::Elements(run(Dop853::default())));
    group.bench_function("Dop853", |bencher| bencher.iter(|| run(Dop853::default())));
    group.throughput(Throughput::Elements(run(Adams::default())));
    group.bench_function("Adams", |bencher| bencher.iter(|| run(Adams::default())));
    let (mut y, mut dy) = ([0.5; 9], [0.0; 9]);
    group.throughput(Throughput::Elements(1));
    group.bench_function("right-hand side alone", |bencher| {
        bencher.iter(|| {
            Rotation
                .rhs(0.0, black_box(&y), black_box(&mut dy))
                .expect("never fails");
            y[0] = dy[1];
        });
    });
    group.finish();
}

criterion_group!(benches, overhead);
criterion_main!(benches);
