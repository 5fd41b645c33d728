//! `linkdyn stability`: where methods stop being stable on a scene, what limits them, how they drift, whether they repeat.

mod bounds;
mod long_run;
mod pictures;
mod plans;
mod repeat;
mod spectrum;
mod stiffening;
mod sweep;
mod tables;

use crate::args::{FormulationArg, StabilityArgs};
use crate::errors::CliError;
use crate::interrupt::Interrupt;
use crate::output;
use crate::progress::Progress;
use crate::report::measure::Limit;
use crate::results::RunFolder;
use crate::run::{default_folder, prepare, shown};
use crate::scenes::{self, Variant};

/// Shares of the time that is left for eigenvalues, repeats, and sweeps, one after the other; long runs get what remains.
const SHARES: [f64; 3] = [0.1, 0.2, 0.6];
/// Long runs go on to this many times `--until`, or to their last time.
const LONG: f64 = 5000.0;

/// All that is found about a scene.
struct Study {
    /// Name of the scene.
    scene: String,
    /// What the variant is called.
    label: String,
    /// End of the runs other than long ones \[s\].
    until: f64,
    /// Time on the clock that was allowed \[s\].
    budget: f64,
    sweeps: Vec<sweep::Row>,
    spectra: Vec<spectrum::Spectrum>,
    /// Why eigenvalues are missing, if some are.
    remark: Option<String>,
    long_run: Vec<long_run::Row>,
    repeat: Vec<repeat::Row>,
}

/// `linkdyn stability`.
///
/// # Errors
/// Wrong usage, a scene that cannot start, a folder that cannot be written.
pub fn stability(args: &StabilityArgs) -> Result<(), CliError> {
    let variant = Variant::new(&args.variant, false);
    let prepared = prepare(&args.scene, &variant, None, FormulationArg::Recursive)?;
    let conservative = long_run::conservative(&args.scene)?;
    let target = args.out.clone().unwrap_or_else(|| {
        let folder = default_folder(&args.scene, &variant);
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        folder.with_file_name(format!("stability-{name}"))
    });
    let folder = RunFolder::create(&target)?;
    let limit = Limit::new(args.budget, Interrupt::install()?);
    let (until, budget) = (args.until, args.budget);
    let mut progress = Progress::new("stability", 0.0, budget, args.quiet || args.json);
    let mut heard = || progress.set(budget - limit.left());

    let [spectra, repeats, sweeps] = SHARES;
    let (spectra, remark) = spectrum::along(&prepared, until, &limit.part(spectra), &mut heard);
    let repeat = repeat::rows(&prepared, until, &limit.part(repeats), &mut heard);
    let sweeps = sweep::sweeps(
        (&args.scene, &variant, &prepared),
        until,
        &limit.part(sweeps),
        &mut heard,
    );
    let long_run = long_run::rows(&conservative, LONG * until, &limit, &mut heard);
    drop(progress);
    let study = Study {
        scene: args.scene.clone(),
        label: scenes::find(&args.scene)?.label(&variant),
        until,
        budget,
        sweeps,
        spectra,
        remark,
        long_run,
        repeat,
    };
    write(&study, folder, args.json)?;
    match limit.interrupted() {
        true => Err(CliError::interrupted("stopped; what was found up to then is written")),
        false => Ok(()),
    }
}

/// Writes tables and pictures, puts the folder in place and prints.
fn write(study: &Study, mut folder: RunFolder, json: bool) -> Result<(), CliError> {
    let whole = tables::json(study);
    folder.write("stability.json", format!("{whole:#}\n"))?;
    for (name, table) in tables::all(study) {
        folder.write(&format!("{name}.csv"), table.to_csv())?;
    }
    pictures::draw(study, &mut folder)?;
    let manifest = serde_json::json!({ "kind": "stability", "scene": study.scene, "variant": study.label });
    let placed = folder.commit(&manifest)?;
    match json {
        true => output::print(&format!("{whole:#}\n")),
        false => output::print(&format!("{}\nstability in {}\n", tables::text(study), shown(&placed))),
    }
}
