//! scratch
use linkdyn_mechanisms::catalogue::*;
use linkdyn_mechanisms::integrators::*;
use linkdyn_mechanisms::*;
fn go<M: Method<Simulation>>(name: &str, m: M, rel: f64, tol: f64, vf: f64, drift: f64) {
    let scene = rsrrr(&Rsrrr {
        friction: false,
        friction_scale: 1.0,
    });
    let mechanism = scene.linkage.build().unwrap();
    let (state, _) = mechanism.assemble(&scene.start).unwrap();
    let mut sim = Simulation::new(&mechanism);
    sim.set_drift_tolerance(drift);
    let y0 = sim.state_vector(&state);
    let s = Settings {
        absolute: Tolerance::from(vec![
            tol,
            tol,
            tol,
            tol,
            vf * tol,
            vf * tol,
            vf * tol,
            vf * tol,
            f64::INFINITY,
        ]),
        ..Settings::tolerances(rel, tol)
    };
    let mut integ = Integration::new(sim, m, 0.0, &y0, s)
        .unwrap()
        .with_stops(&mechanism.system().stop_times())
        .unwrap();
    let mut worst = (0.0f64, 0.0);
    let mut steps = vec![];
    loop {
        let p = integ.advance(5.0).unwrap();
        steps.push((integ.state().0, integ.state().1[0]));
        if let Progress::Done { .. } = p {
            break;
        }
    }
    let sim = Simulation::new(&mechanism);
    let s = sim.settings(0.0, 1e-14);
    let mut fine = Integration::new(sim, Dop853::default(), 0.0, &y0, s)
        .unwrap()
        .with_stops(&mechanism.system().stop_times())
        .unwrap();
    let mut y = y0.clone();
    let mut k = 0;
    while k < steps.len() {
        fine.advance(5.0).unwrap();
        while k < steps.len() && steps[k].0 <= fine.state().0 {
            fine.interpolate(steps[k].0, &mut y).unwrap();
            let e = (y[0] - steps[k].1).abs();
            if e > worst.0 {
                worst = (e, steps[k].0);
            }
            k += 1;
        }
    }
    let st = integ.statistics();
    println!(
        "{name} rel {rel:e} tol {tol:e} vf {vf} drift {drift:e}: evals {} acc {} rej {} err max {:.2e} at {:.2} end {:e}",
        st.evaluations - st.dense_evaluations,
        st.accepted,
        st.rejected,
        worst.0,
        worst.1,
        integ.state().1[0] - 36.994786126823954
    );
}
fn main() {
    for (rel, tol) in [
        (1e-8, 1e-8),
        (3e-9, 3e-9),
        (1e-9, 1e-9),
        (1e-8, 1e-10),
        (1e-8, 1e-11),
        (1e-9, 1e-11),
        (0.0, 1e-8),
        (0.0, 3e-9),
        (0.0, 1e-9),
        (0.0, 3e-10),
        (0.0, 1e-10),
    ] {
        for vf in [1.0, 10.0, 30.0] {
            go("dop853", Dop853::default(), rel, tol, vf, 0.0);
        }
        go("adams", Adams::default(), rel, tol, 10.0, 0.1 * tol);
    }
}
