//! What driver and method add to each evaluation: the time per element.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use linkdyn_integrators::{Adams, Dop853, DormandPrince5, Method, Ode, Radau5, Rk4};

mod cases;

use cases::{Duffing, Rotation, run};

fn overhead(criterion: &mut Criterion) {
    case(criterion, "rotation", || Rotation);
    case(criterion, "duffing", || Duffing);
}

fn case<P: Ode>(criterion: &mut Criterion, name: &str, problem: fn() -> P) {
    let mut group = criterion.benchmark_group(format!("overhead per evaluation, {name}"));
    group
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    let mut bench = |name, work: &dyn Fn() -> u64| {
        group.throughput(Throughput::Elements(work()));
        group.bench_function(name, |bencher| bencher.iter(work));
    };
    bench("Rk4", &|| run(problem(), Rk4::new(0.01)));
    bench("DormandPrince5", &|| run(problem(), DormandPrince5::default()));
    bench("Dop853", &|| run(problem(), Dop853::default()));
    bench("Adams", &|| run(problem(), Adams::default()));
    bench("Radau5", &|| run(problem(), Radau5::default()));
    // As the driver sees it: a method behind a pointer.
    bench("Adams, boxed", &|| {
        let method: Box<dyn Method<P>> = Box::new(Adams::default());
        run(problem(), method)
    });
    let (mut y, mut dy) = ([0.5; 9], [0.0; 9]);
    group.throughput(Throughput::Elements(1));
    group.bench_function("right-hand side alone", |bencher| {
        bencher.iter(|| {
            problem()
                .rhs(0.0, black_box(&y), black_box(&mut dy))
                .expect("never fails");
            y[0] = dy[1];
        });
    });
    group.finish();
}

criterion_group!(benches, overhead);
criterion_main!(benches);
