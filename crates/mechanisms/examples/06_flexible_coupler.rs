//! The RSUP scene with a flexible coupler of n = 1, 2, 4, ... spring-damping elements: how far the slider is from where a rigid
//! coupler would put it, the energy that is elastic, and what each run takes.
//!
//! Arguments: end of the run \[s\] (default 0.02) and largest n (default 4); `5 16` takes minutes.

use linkdyn_mechanisms::catalogue::{Rsup, rsup};
use linkdyn_mechanisms::integrators::{Adams, Integration, Method, Radau5};
use linkdyn_mechanisms::{Seen, Simulation, run_watched};
use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

struct Run {
    slider: Vec<f64>,
    elastic: f64,
    energy_error: f64,
    evaluations: u64,
    seconds: f64,
}

fn run(
    flexible: Option<usize>,
    method: impl Method<Simulation>,
    tolerance: f64,
    until: f64,
) -> Result<Run, Box<dyn Error>> {
    let scene = rsup(&Rsup {
        flexible,
        ..Rsup::default()
    })?;
    let mechanism = scene.linkage.build()?;
    let (start, _) = mechanism.assemble(&scene.start)?;
    let simulation = Simulation::new(&mechanism);
    let y = simulation.state_vector(&start);
    let settings = simulation.settings(tolerance, tolerance);
    let integration = Integration::new(simulation, method, 0.0, &y, settings)?;
    let mut integration = integration.with_stops(&mechanism.system().stop_times())?;
    let slide = mechanism.coordinate_names().position(|name| name == "z21").unwrap_or(0);
    let (mut slider, mut elastic, mut balance) = (Vec::new(), 0.0_f64, Vec::new());
    let begun = Instant::now();
    run_watched(&mut integration, until, until / 200.0, |seen| {
        if let Seen::Row(o) = seen {
            slider.push(o.q[slide]);
            elastic = elastic.max(o.energy.elastic);
            balance.push(o.energy_balance());
        }
        ControlFlow::Continue(())
    })?;
    Ok(Run {
        slider,
        elastic,
        energy_error: balance.iter().map(|b| (b - balance[0]).abs()).fold(0.0, f64::max),
        evaluations: integration.statistics().evaluations,
        seconds: begun.elapsed().as_secs_f64(),
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let until: f64 = arguments.next().map_or(Ok(0.02), |text| text.parse())?;
    let most: usize = arguments.next().map_or(Ok(4), |text| text.parse())?;
    let rigid = run(None, Adams::default(), 1e-12, until)?;
    println!(
        "{:>3} {:>16} {:>14} {:>12} {:>12} {:>9}",
        "n", "slider off (m)", "elastic (J)", "energy (J)", "evaluations", "seconds"
    );
    let mut n = 1;
    while n <= most {
        let flexible = run(Some(n), Radau5::default(), 1e-8, until)?;
        let pairs = flexible.slider.iter().zip(&rigid.slider);
        let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!(
            "{n:>3} {off:>16.3e} {:>14.3e} {:>12.1e} {:>12} {:>9.2}",
            flexible.elastic, flexible.energy_error, flexible.evaluations, flexible.seconds
        );
        n *= 2;
    }
    Ok(())
}
