//! The integration methods by name, and the tolerances or steps that go with them.

use linkdyn_mechanisms::integrators::{
    Adams, Auto, Bdf, Corrector, Dop853, DormandPrince5, Method, Newmark, Radau5, Rk4, Rodas, Settings,
};
use linkdyn_mechanisms::{RunSettings, Simulation, Switching};
use serde::Serialize;

use crate::args::RunArgs;
use crate::errors::CliError;
use crate::run::Prepared;

/// A method with all its settings, defaults filled in.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Name of the method.
    pub method: String,
    /// Relative tolerance of adaptive methods.
    pub rtol: Option<f64>,
    /// Absolute tolerance of adaptive methods, for coordinates.
    pub atol: Option<f64>,
    /// Step of fixed-step methods \[s\].
    pub step: Option<f64>,
    /// Corrector iterations a step, where they are fixed.
    pub iterations: Option<u32>,
    /// When contacts are made and lost.
    pub switching: Switching,
}

/// Methods with error control.
pub(crate) const ADAPTIVE: [&str; 7] = ["auto", "adams", "dop853", "dopri5", "radau5", "bdf", "rodas"];
/// Methods of fixed step.
pub(crate) const FIXED: [&str; 2] = ["rk4", "newmark"];

/// Default tolerance, relative and absolute \[rad, m, rad/s, m/s\].
const TOLERANCE: f64 = 1e-12;
/// Default tolerance of methods for stiff scenes, whose steps are of low order: 1e-12 would take them millions.
const STIFF_TOLERANCE: f64 = 1e-9;
/// Default and loosest tolerance with clearance, in clearances: penetrations are a thousandth of one to a hundredth.
const CONTACT_TOLERANCE: f64 = 1e-6;
const CONTACT_LOOSEST: f64 = 1e-4;
/// Radial clearance where none is given \[m\]: that of the scene.
const CLEARANCE: f64 = 1e-3;
/// Loosest tolerance taken without a word: the start of RSRRR is an unstable equilibrium, and a loose run may fall to the
/// wrong side.
const LOOSEST: f64 = 1e-4;
/// Most drift that a step may leave, whatever the tolerance: far less than what counts as having left the loops.
const MOST_DRIFT: f64 = 1e-7;
/// Default fixed step \[s\].
pub(crate) const STEP: f64 = 1e-4;
/// Fixed step of the paper on clearance \[s\].
pub(crate) const PUBLISHED_STEP: f64 = 5e-6;

/// The command line filled up with what the scene says. A method on the command line comes with its own tolerances and steps.
fn with_settings(args: &RunArgs, settings: &RunSettings) -> RunArgs {
    let mut args = args.clone();
    if args.method.is_none() && !args.as_published {
        args.method.clone_from(&settings.method);
        args.rtol = args.rtol.or(settings.rtol);
        args.atol = args.atol.or(settings.atol);
        args.step = args.step.or(settings.step);
    }
    args
}

impl Plan {
    /// What the command line asks for, and where it says nothing the scene.
    ///
    /// # Errors
    /// Unknown methods, and options that do not go with the method.
    pub(crate) fn new(args: &RunArgs, prepared: &Prepared) -> Result<Self, CliError> {
        let args = &with_settings(args, &prepared.scene.settings);
        let method = match (&args.method, args.as_published) {
            (None, true) => "rk4",
            (None, false) => "auto",
            (Some(name), false) => name,
            (Some(_), true) => {
                let message = "`--method` does not go with `--as-published`, which is rk4";
                return Err(CliError::usage(message).with_hint("leave one of them out"));
            }
        };
        let fixed = FIXED.contains(&method);
        if !fixed && !ADAPTIVE.contains(&method) {
            return Err(CliError::unknown("method", method, ADAPTIVE.into_iter().chain(FIXED)));
        }
        let misplaced = |option: &str, hint: String| {
            Err(CliError::usage(format!("`{option}` does not go with method `{method}`")).with_hint(hint))
        };
        if fixed && (args.rtol.is_some() || args.atol.is_some()) {
            return misplaced(
                "--rtol/--atol",
                format!("give its `--step`, or take an adaptive method: {}", ADAPTIVE.join(", ")),
            );
        }
        if !fixed && args.step.is_some() {
            return misplaced(
                "--step",
                format!(
                    "give `--rtol` and `--atol`, or take a method of fixed step: {}",
                    FIXED.join(", ")
                ),
            );
        }
        if method != "newmark" && args.iterations.is_some() {
            return misplaced("--iterations", "only newmark has a corrector to iterate".to_owned());
        }
        let clearance = args
            .variant
            .clearance
            .map(|_| args.variant.clearance_size.unwrap_or(CLEARANCE))
            .or_else(|| prepared.mechanism.clearances().flatten().reduce(f64::min));
        let (usual, loosest) = match clearance {
            Some(size) => (CONTACT_TOLERANCE * size, CONTACT_LOOSEST * size),
            // Elastic links are stiff.
            None if ["radau5", "bdf", "rodas"].contains(&method)
                || (method == "auto" && prepared.scene.linkage.is_flexible()) =>
            {
                (STIFF_TOLERANCE, LOOSEST)
            }
            None => (TOLERANCE, LOOSEST),
        };
        let rtol = args.rtol.unwrap_or(usual);
        for (name, tolerance) in [("rtol", rtol), ("atol", args.atol.unwrap_or(rtol))] {
            if tolerance > loosest {
                let message = format!("{name} = {tolerance} is too loose: the result would mean nothing");
                return Err(CliError::usage(message).with_hint(format!("give at most {loosest:e}")));
            }
        }
        Ok(Self {
            method: method.to_owned(),
            rtol: (!fixed).then_some(rtol),
            atol: (!fixed).then(|| args.atol.unwrap_or(rtol)),
            step: fixed.then(|| {
                args.step
                    .unwrap_or(if args.as_published { PUBLISHED_STEP } else { STEP })
            }),
            switching: if args.as_published {
                Switching::AtSteps
            } else {
                Switching::Located
            },
            iterations: args.iterations,
        })
    }

    /// The method.
    #[must_use]
    pub fn method(&self) -> Box<dyn Method<Simulation>> {
        let step = self.step.unwrap_or(STEP);
        match self.method.as_str() {
            "auto" => Box::new(Auto::default()),
            "dop853" => Box::new(Dop853::default()),
            "dopri5" => Box::new(DormandPrince5::default()),
            "radau5" => Box::new(Radau5::default()),
            "bdf" => Box::new(Bdf::default()),
            "rodas" => Box::new(Rodas::default()),
            "rk4" => Box::new(Rk4::new(step)),
            "newmark" => Box::new(Newmark::new(step, self.corrector())),
            _ => Box::new(Adams::default()),
        }
    }

    fn corrector(&self) -> Corrector {
        match self.iterations {
            Some(iterations) => Corrector::Times(iterations),
            None => Corrector::Until {
                change: 1e-13,
                at_most: 100,
            },
        }
    }

    /// Makes a simulation keep its loops and switch its contacts as planned. Drift that a step may leave is a tenth of the
    /// tolerance, so that it never shows beside the error; with drift terms nothing is projected.
    pub fn set_up(&self, simulation: &mut Simulation) {
        simulation.set_switching(self.switching);
        simulation.set_drift_tolerance(match self.switching {
            Switching::Located => (0.1 * self.atol.unwrap_or(0.0)).min(MOST_DRIFT),
            Switching::AtSteps => f64::INFINITY,
        });
    }

    /// Tolerances for a simulation.
    #[must_use]
    pub fn settings(&self, simulation: &Simulation) -> Settings {
        simulation.settings(self.rtol.unwrap_or(TOLERANCE), self.atol.unwrap_or(TOLERANCE))
    }
}
