//! Eigenvalues of the linearised motion along a run.
//!
//! Differences are taken of f(P(y)), P putting a state back onto the loops: its derivative is df/dy on the states that the loops
//! allow, and zero across. Without P the directions across would come as double zeros, which differences tear apart.

use std::ops::ControlFlow;

use linkdyn_mechanisms::integrators::{Integration, Ode};
use linkdyn_mechanisms::{CONTACT_SPEED_SCALE, SPEED_SCALE, Seen, Simulation, run_watched};
use nalgebra::{Complex, DMatrix};

use crate::report::measure::Limit;
use crate::run::Prepared;

use super::bounds::Polynomial;
use super::plans::{plan, tolerance};

/// The method of the reference run: its steps are not limited by stability, so that they are those that accuracy allows.
pub const REFERENCE: &str = "radau5";
/// Parts of the run with at least one state each; with contacts also that of the largest force in each.
const PARTS: usize = 20;
/// Difference of a coordinate, in units of the scene's length: halfway between truncation and rounding.
const DIFFERENCE: f64 = 1e-6;

/// A state of the reference run.
#[derive(Clone, Debug)]
struct Sample {
    t: f64,
    y: Vec<f64>,
    memory: Vec<f64>,
    /// Length of the step that led to it \[s\].
    step: f64,
    /// Normal force of all contacts \[N\].
    normal: f64,
}

/// Eigenvalues at one time.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// Time \[s\].
    pub t: f64,
    /// Normal force of all contacts \[N\]; zero while apart.
    pub normal: f64,
    /// Step of the reference method there \[s\].
    pub step: f64,
    /// The eigenvalues \[1/s\].
    pub eigenvalues: Vec<Complex<f64>>,
}

impl Spectrum {
    /// Largest step with which an explicit method is stable there \[s\].
    pub fn largest_step(&self, polynomial: &Polynomial) -> f64 {
        let steps = self.eigenvalues.iter().map(|&lambda| polynomial.largest_step(lambda));
        steps.fold(f64::INFINITY, f64::min)
    }

    /// Largest modulus, most negative real part, largest imaginary part, largest positive real part \[1/s\].
    pub fn extremes(&self) -> [f64; 4] {
        self.eigenvalues.iter().fold([0.0; 4], |[size, fall, turn, rise], z| {
            [size.max(z.norm()), fall.min(z.re), turn.max(z.im), rise.max(z.re)]
        })
    }
}

/// Spectra along a run up to `until`, and why the run or one of them ended early, if so.
pub fn along(
    prepared: &Prepared,
    until: f64,
    limit: &Limit,
    seen: &mut dyn FnMut(),
) -> (Vec<Spectrum>, Option<String>) {
    let (samples, mut remark) = samples(prepared, until, limit, seen);
    let mut simulation = Simulation::new(&prepared.mechanism);
    let mut spectra = Vec::new();
    for sample in samples {
        match eigenvalues(&mut simulation, &sample) {
            Ok(eigenvalues) => spectra.push(Spectrum {
                t: sample.t,
                normal: sample.normal,
                step: sample.step,
                eigenvalues,
            }),
            Err(why) => remark = Some(format!("no eigenvalues at {} s: {why}", sample.t)),
        }
    }
    (spectra, remark)
}

/// States of the reference run, in the order of time.
fn samples(prepared: &Prepared, until: f64, limit: &Limit, heard: &mut dyn FnMut()) -> (Vec<Sample>, Option<String>) {
    let plan = plan(REFERENCE, tolerance(prepared));
    let mut simulation = Simulation::new(&prepared.mechanism);
    plan.set_up(&mut simulation);
    let y = simulation.state_vector(&prepared.start);
    let settings = plan.settings(&simulation);
    let stops = prepared.mechanism.system().stop_times();
    let integration = Integration::new(simulation, plan.method(), 0.0, &y, settings);
    let mut integration = match integration.and_then(|integration| integration.with_stops(&stops)) {
        Ok(integration) => integration,
        Err(error) => return (Vec::new(), Some(error.to_string())),
    };
    // For each part of the run the first state, and the one pressed most.
    let mut found: Vec<[Option<Sample>; 2]> = vec![[None, None]; PARTS];
    let (mut before, mut points) = (0.0, Vec::new());
    let ended = run_watched(&mut integration, until, until, |what| {
        if let Seen::Step { t, y, simulation, .. } = what {
            heard();
            simulation.contact_points(t, y, &mut points);
            let normal: f64 = points.iter().map(|point| point.normal).sum();
            let part = ((t / until * PARTS as f64) as usize).min(PARTS - 1);
            let [first, pressed] = &mut found[part];
            let sample = || {
                Some(Sample {
                    t,
                    y: y.to_vec(),
                    memory: simulation.memory().to_vec(),
                    step: t - before,
                    normal,
                })
            };
            if first.is_none() {
                *first = sample();
            } else if normal > pressed.as_ref().map_or(0.0, |sample| sample.normal) {
                *pressed = sample();
            }
            before = t;
        }
        match limit.left() > 0.0 {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    });
    let mut samples: Vec<Sample> = found.into_iter().flatten().flatten().collect();
    samples.sort_by(|a, b| a.t.total_cmp(&b.t));
    (samples, ended.err().map(|error| error.to_string()))
}

/// Eigenvalues of df/dy at a state, quadratures left out.
fn eigenvalues(simulation: &mut Simulation, sample: &Sample) -> Result<Vec<Complex<f64>>, String> {
    let layout = simulation.layout().clone();
    let (dim, count) = (layout.len(), layout.work.start);
    let (scale, speeds) = match simulation.mechanism().clearances().flatten().reduce(f64::min) {
        Some(size) => (size, CONTACT_SPEED_SCALE),
        None => (1.0, SPEED_SCALE),
    };
    simulation.set_memory(&sample.memory);
    let mut matrix = DMatrix::zeros(count, count);
    let mut rates = [vec![0.0; dim], vec![0.0; dim]];
    for j in 0..count {
        let delta = DIFFERENCE * scale * if layout.speeds.contains(&j) { speeds } else { 1.0 };
        for (rates, delta) in rates.iter_mut().zip([delta, -delta]) {
            let mut y = sample.y.clone();
            y[j] += delta;
            simulation.put_on_closures(sample.t, &mut y);
            simulation.rhs(sample.t, &y, rates).map_err(|error| error.to_string())?;
        }
        for i in 0..count {
            matrix[(i, j)] = (rates[0][i] - rates[1][i]) / (2.0 * delta);
        }
    }
    linkdyn_mechanisms::analysis::eigenvalues(matrix).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::FormulationArg;
    use crate::interrupt::Interrupt;
    use crate::run::prepare;
    use crate::scenes::Variant;

    #[test]
    fn loops_leave_a_pair_for_each_freedom_and_zeros() {
        // RSRRR has four speeds and one freedom: of eight eigenvalues six are zero, whatever the loops do.
        let prepared = prepare("rsrrr", &Variant::default(), None, FormulationArg::Recursive).expect("a scene");
        let limit = Limit::new(60.0, Interrupt::new());
        let (spectra, remark) = along(&prepared, 0.1, &limit, &mut || ());
        assert!(remark.is_none() && spectra.len() > 10, "{remark:?} {}", spectra.len());
        for spectrum in spectra {
            let mut sizes: Vec<f64> = spectrum.eigenvalues.iter().map(|z| z.norm()).collect();
            sizes.sort_by(f64::total_cmp);
            assert!(
                sizes.len() == 8 && sizes[5] < 1e-4 && sizes[6] > 1e-2,
                "{} s: {sizes:?}",
                spectrum.t
            );
        }
    }
}
