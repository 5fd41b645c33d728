//! What the RSUP scene with planar clearance costs: error against work, for the paper's way and for located contacts. The error is
//! the largest difference of slider and journal from a reference over all rows, in clearances.
//!
//! The first argument may give the end of the run \[s\]: 5 takes a minute, the default 0.3 a few seconds. A second argument `without`
//! leaves friction out: then the motion is chaotic, and the table says up to which time 1e-6 and 1e-3 clearances are kept.

use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsup, rsup};
use linkdyn_mechanisms::dynamics::Baumgarte;
use linkdyn_mechanisms::integrators::{Auto, Dop853, Integration, Method, Radau5, Rk4};
use linkdyn_mechanisms::{Mechanism, Seen, Simulation, State, Switching, Tally, run_watched};
use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

const CLEARANCE: f64 = 1e-3;

/// A finished run: slider and journal at each row, and what it took.
struct Run {
    rows: Vec<[f64; 4]>,
    evaluations: u64,
    seconds: f64,
    tally: Tally,
    energy_error: f64,
}

struct Case {
    mechanism: Mechanism,
    start: State,
    until: f64,
}

impl Case {
    fn new(friction: bool, published: bool, until: f64) -> Result<Self, Box<dyn Error>> {
        let mut variant = Rsup {
            clearance: Some(ClearanceKind::Planar),
            clearance_size: CLEARANCE,
            ..Rsup::default()
        };
        if !friction {
            variant.friction = None;
        }
        let mut scene = rsup(&variant)?;
        if published {
            let (alpha, beta) = (100.0, 50.0);
            scene.linkage.baumgarte = Some(Baumgarte { alpha, beta });
        }
        let mechanism = scene.linkage.build()?;
        let (start, _) = mechanism.assemble(&scene.start)?;
        Ok(Self {
            mechanism,
            start,
            until,
        })
    }

    fn run(
        &self,
        method: impl Method<Simulation>,
        tolerance: f64,
        switching: Switching,
    ) -> Result<Run, Box<dyn Error>> {
        let mut simulation = Simulation::new(&self.mechanism);
        simulation.set_switching(switching);
        if switching == Switching::AtSteps {
            simulation.set_drift_tolerance(f64::INFINITY);
        }
        let y = simulation.state_vector(&self.start);
        let settings = simulation.settings(tolerance, tolerance);
        let integration = Integration::new(simulation, method, 0.0, &y, settings)?;
        let mut integration = integration.with_stops(&self.mechanism.system().stop_times())?;
        let (mut rows, mut tally) = (Vec::new(), Tally::default());
        let mut balance = Vec::new();
        let begun = Instant::now();
        run_watched(&mut integration, self.until, 0.01, |mut seen| {
            tally.see(&mut seen);
            if let Seen::Row(o) = seen {
                let [y, z, _] = o.contacts[0].journal;
                rows.push([o.t, o.q[4], y, z]);
                balance.push((o.energy_balance(), o.energy.total()));
            }
            ControlFlow::Continue(())
        })?;
        let seconds = begun.elapsed().as_secs_f64();
        let scale = balance.iter().map(|(_, energy)| energy.abs()).fold(0.0, f64::max);
        let drift = balance
            .iter()
            .map(|(b, _)| (b - balance[0].0).abs())
            .fold(0.0, f64::max);
        Ok(Run {
            rows,
            evaluations: integration.statistics().evaluations,
            seconds,
            tally,
            energy_error: drift / scale,
        })
    }
}

impl Run {
    /// Largest error in clearances, and the times until which it stays below 1e-6 and 1e-3.
    fn error(&self, reference: &Self) -> (f64, [f64; 2]) {
        let mut worst = 0.0_f64;
        let mut kept = [f64::INFINITY; 2];
        for (row, exact) in self.rows.iter().zip(&reference.rows) {
            for k in 1..4 {
                worst = worst.max((row[k] - exact[k]).abs() / CLEARANCE);
            }
            for (kept, limit) in kept.iter_mut().zip([1e-6, 1e-3]) {
                if worst > limit {
                    *kept = kept.min(row[0]);
                }
            }
        }
        (worst, kept)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let until: f64 = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 0.3,
    };
    let friction = std::env::args().nth(2).as_deref() != Some("without");
    let case = Case::new(friction, false, until)?;
    let reference = case.run(Dop853::default(), 1e-13, Switching::Located)?;
    println!("reference: dop853 at 1e-13, {} evaluations", reference.evaluations);
    println!(
        "{:>9} {:>8} {:>10} {:>12} {:>9} {:>8} {:>8} {:>9} {:>10} {:>10} {:>9}",
        "method",
        "at",
        "error/c",
        "evaluations",
        "seconds",
        "to 1e-6",
        "to 1e-3",
        "impacts",
        "mean (N)",
        "loss (J)",
        "energy"
    );
    let show = |name: &str, at: f64, run: &Run| {
        let (error, [micro, milli]) = run.error(&reference);
        let point = &run.tally.points[0];
        println!(
            "{name:>9} {at:>8.0e} {error:>10.1e} {:>12} {:>9.3} {micro:>8.2} {milli:>8.2} {:>9} {:>10.4} {:>10.6} {:>9.1e}",
            run.evaluations,
            run.seconds,
            point.impacts,
            point.mean_force(until),
            point.integrals.damping_loss + point.integrals.friction_loss,
            run.energy_error,
        );
    };
    for tolerance in [1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        let method = Auto::default();
        show("auto", tolerance, &case.run(method, tolerance, Switching::Located)?);
    }
    for tolerance in [1e-8, 3e-9, 1e-9, 1e-10, 1e-11, 1e-12] {
        let method = Radau5::default();
        show("radau5", tolerance, &case.run(method, tolerance, Switching::Located)?);
    }
    for tolerance in [1e-9, 1e-10, 1e-11, 1e-12] {
        show(
            "dop853",
            tolerance,
            &case.run(Dop853::default(), tolerance, Switching::Located)?,
        );
    }
    let published = Case::new(friction, true, until)?;
    let step = 5e-6;
    show(
        "as paper",
        step,
        &published.run(Rk4::new(step), 1.0, Switching::AtSteps)?,
    );
    Ok(())
}
