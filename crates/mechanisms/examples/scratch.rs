//! scratch
use linkdyn_mechanisms::catalogue::*;
use linkdyn_mechanisms::integrators::*;
use linkdyn_mechanisms::*;
use std::ops::ControlFlow;
use std::time::Instant;
fn main() {
    for friction in [false, true] {
        let scene = rsrrr(&Rsrrr {
            friction,
            friction_scale: 1.0,
        });
        let mechanism = scene.linkage.build().unwrap();
        let (state, assembly) = mechanism.assemble(&scene.start).unwrap();
        println!("{assembly:?} {state:?}");
        for tol in [1e-8, 1e-10, 1e-12] {
            let sim = Simulation::new(&mechanism);
            let y0 = sim.state_vector(&state);
            let mut integ = Integration::new(sim, Dop853::default(), 0.0, &y0, Settings::tolerances(tol, tol))
                .unwrap()
                .with_stops(&mechanism.system().stop_times())
                .unwrap();
            let t0 = Instant::now();
            let mut n = 0;
            let mut worst = 0.0f64;
            let mut b0 = None;
            let mut viol = 0.0f64;
            let mut fs = 0.0f64;
            run(&mut integ, 5.0, 0.01, |o| {
                n += 1;
                let b = o.energy_balance();
                b0.get_or_insert(b);
                worst = worst.max((b - b0.unwrap()).abs());
                viol = viol.max(o.violation.0);
                fs = fs.max(o.multipliers.iter().map(|x| x * x).sum::<f64>().sqrt());
                ControlFlow::Continue(())
            })
            .unwrap();
            let el = t0.elapsed();
            println!(
                "tol {tol:e} {:?} psi {:?} rows {n} energy {worst:e} viol {viol:e} fS {fs} drift {:?} {:?} time {el:?}",
                integ.statistics(),
                integ.state().1,
                integ.problem().worst(),
                integ.problem().counters()
            );
        }
        // ns per evaluation
        let mut sim = Simulation::new(&mechanism);
        let mut y = sim.state_vector(&state);
        for (k, v) in y[4..8].iter_mut().enumerate() {
            *v = 1.0 + k as f64;
        }
        let mut dy = y.clone();
        let q = [1.2, 3.0, -1.2, 0.6];
        y[..4].copy_from_slice(&q);
        for _ in 0..3 {
            let t0 = Instant::now();
            let n = 1_000_000;
            for _ in 0..n {
                sim.rhs(1.0, std::hint::black_box(&y), &mut dy).unwrap();
                std::hint::black_box(&dy);
            }
            println!(
                "ns/eval {:?}  {:?}",
                t0.elapsed().as_nanos() as f64 / n as f64,
                sim.counters()
            );
        }
        let a = nalgebra::SMatrix::<f64, 7, 7>::from_fn(|i, j| {
            if i == j {
                10.0
            } else {
                1.0 / (1.0 + i as f64 + 2.0 * j as f64)
            }
        });
        let b = nalgebra::SVector::<f64, 7>::from_fn(|i, _| i as f64);
        let t0 = Instant::now();
        for _ in 0..1_000_000 {
            std::hint::black_box(std::hint::black_box(a).lu().solve(std::hint::black_box(&b)));
        }
        println!("LU7 {} ns", t0.elapsed().as_nanos() as f64 / 1e6);
    }
}
