//! Cost against size: time of one evaluation of chains, ladders and crowds of loops, and of one projection, as a table; then what it
//! takes to build such a linkage and to assemble a start.
//! `cargo run --release -p linkdyn-tests --example size`, with `dense` behind `--` to have the loops solved for all at once.

use linkdyn_dynamics::{Formulation, System, Workspace};
use linkdyn_integrators::Ode;
use linkdyn_mechanisms::{Simulation, Start};
use linkdyn_tests::ladders::Stage;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Shortest time of one call \[s\], out of batches that take some time.
fn time(mut f: impl FnMut()) -> f64 {
    let mut calls = 1;
    let mut least = f64::INFINITY;
    let begin = Instant::now();
    while begin.elapsed() < Duration::from_millis(600) {
        let start = Instant::now();
        (0..calls).for_each(|_| f());
        let batch = start.elapsed();
        least = least.min(batch.as_secs_f64() / f64::from(calls));
        if batch < Duration::from_millis(10) {
            calls *= 2;
        }
    }
    least
}

/// One row: all, and what is not there without the loops.
fn measure(stage: Stage, count: usize, formulation: Formulation) {
    let blueprint = stage.times(count);
    let (mut description, _) = blueprint.description();
    description.formulation = formulation;
    let (q, v) = (blueprint.coordinates(), blueprint.speeds());
    let system = System::new(description.clone()).expect("valid");
    let evaluation = |system: &System| {
        let mut work = Workspace::new(system);
        time(|| {
            let state = black_box((&q[..], &v[..]));
            system.evaluate(0.0, state.0, state.1, &mut work).expect("regular");
            black_box(work.rates());
        })
    };
    let whole = evaluation(&system);
    description.closures.clear();
    let tree = evaluation(&System::new(description).expect("valid"));
    let mut work = Workspace::new(&system);
    let projection = time(|| {
        let (mut q, mut v) = (q.clone(), v.clone());
        q[0] += 1e-9;
        black_box(system.project_beyond(0.0, 1e-12, &mut q, &mut v, &mut work));
    });
    let (speeds, equations) = (system.tree().speeds(), system.equations());
    let micro = |seconds: f64| 1e6 * seconds;
    println!(
        "{:9} {count:7} {speeds:7} {equations:9} {:12.2} {:12.2} {:10.3} {:12.2}",
        format!("{stage:?}"),
        micro(whole),
        micro(whole - tree),
        micro(whole) / speeds as f64,
        micro(projection),
    );
}

/// One row of what comes before the first step: times of building and assembly from a guess 1e-3 off, and of one right-hand side.
fn prepare(stage: Stage, count: usize) {
    let blueprint = stage.times(count);
    let (linkage, coordinates) = blueprint.linkage();
    let off = |(k, (name, q)): (usize, (String, f64))| (name, q + 1e-3 * (k as f64).sin());
    let start = Start {
        positions: coordinates.into_iter().enumerate().map(off).collect(),
        ..Start::default()
    };
    let begin = Instant::now();
    let mechanism = linkage.build().expect("valid");
    let built = begin.elapsed();
    let begin = Instant::now();
    let (state, assembly) = mechanism.assemble(&start).expect("closes");
    let assembled = begin.elapsed();
    let mut simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&state);
    let mut dy = vec![0.0; y.len()];
    let evaluated = time(|| simulation.rhs(0.0, black_box(&y), &mut dy).expect("regular"));
    let milli = |seconds: f64| 1e3 * seconds;
    println!(
        "{:9} {count:7} {:12.2} {:12.2} {:12} {:12.3}",
        format!("{stage:?}"),
        milli(built.as_secs_f64()),
        milli(assembled.as_secs_f64()),
        assembly.iterations,
        milli(evaluated),
    );
}

fn main() {
    let dense = std::env::args().any(|a| a == "dense");
    let formulation = if dense {
        Formulation::ArticulatedBody
    } else {
        Formulation::Recursive
    };
    println!("stage       count  speeds equations  evaluation   [loops us]   us/speed   projection");
    for stage in Stage::ALL {
        let sizes: &[usize] = if stage == Stage::Link {
            &[10, 30, 100, 300, 1000]
        } else {
            &[3, 10, 30, 100, 300]
        };
        for &count in sizes
            .iter()
            .filter(|&&count| !dense || count <= 100 || stage == Stage::Link)
        {
            measure(stage, count, formulation);
        }
    }
    if dense {
        return;
    }
    println!("\nstage       count     build ms  assembly ms        steps   right-hand side ms");
    for stage in Stage::ALL {
        let sizes: &[usize] = match stage {
            Stage::Link => &[10, 100, 1000],
            // Loops that share links are closed all at once, by singular values.
            Stage::Crossed => &[3, 10, 30],
            Stage::Carrying | Stage::Sided | Stage::Apart => &[10, 100, 300],
        };
        sizes.iter().for_each(|&count| prepare(stage, count));
    }
}
