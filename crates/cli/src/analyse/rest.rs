//! Where a mechanism rests, and how it vibrates there.

use linkdyn_mechanisms::analysis::equilibrium::{Equilibrium, Settings, Stability};
use linkdyn_mechanisms::analysis::{AnalysisError, Mode, equilibrium, linearise};
use linkdyn_mechanisms::{Mechanism, State};

use crate::args::AnalyseArgs;
use crate::run::Prepared;
use crate::summary::{Cell, Table};

/// Parts of shapes below this are none, the largest being 1.
const NO_PART: f64 = 1e-9;

fn rest(prepared: &Prepared, args: &AnalyseArgs) -> Result<Equilibrium, AnalysisError> {
    let settings = Settings {
        time: args.time,
        held: args.hold.clone(),
        ..Settings::default()
    };
    equilibrium(&prepared.mechanism, &prepared.start.q, &settings)
}

/// Where it rests.
pub(super) fn rest_tables(prepared: &Prepared, args: &AnalyseArgs) -> Result<Vec<Table>, AnalysisError> {
    let found = rest(prepared, args)?;
    Ok(vec![rest_table(&prepared.mechanism, &found)])
}

fn rest_table(mechanism: &Mechanism, found: &Equilibrium) -> Table {
    let mut table = Table::list("equilibrium");
    for (name, value) in mechanism.coordinate_names().zip(&found.q) {
        table.entry(name, Cell::number(*value), "");
    }
    let kept = match found.stability {
        Stability::Stable => "stable",
        Stability::Unstable => "unstable",
        Stability::Indifferent => "indifferent",
    };
    table.entry("equilibrium", Cell::text(kept), "");
    table.entry("least stiffness over mass", Cell::number(found.lowest), "1/s^2");
    table.entry("largest force left", Cell::number(found.force), "N, N m");
    table
}

/// Frequencies, damping, shapes.
pub(super) fn mode_tables(prepared: &Prepared, args: &AnalyseArgs) -> Result<Vec<Table>, AnalysisError> {
    let mechanism = &prepared.mechanism;
    let found = rest(prepared, args)?;
    let state = State {
        q: found.q.clone(),
        v: vec![0.0; prepared.start.v.len()],
    };
    let modes = linearise::holding(mechanism, args.time, &state, &args.hold)?.modes()?;
    let columns = [
        ("mode", ""),
        ("frequency", "Hz"),
        ("damping ratio", ""),
        ("real part", "1/s"),
        ("moves most", ""),
    ];
    let mut table = Table::new("modes", &columns);
    let names: Vec<&str> = mechanism.speed_names().collect();
    for (k, mode) in modes.iter().enumerate() {
        let sizes = mode.shape.iter().map(|x| x.norm()).enumerate();
        let most = sizes.max_by(|a, b| a.1.total_cmp(&b.1)).map_or("", |(k, _)| names[k]);
        table.row([
            Cell::count(k as u64 + 1),
            Cell::number(mode.frequency()),
            mode.damping_ratio().map_or(Cell::Empty, Cell::number),
            Cell::number(mode.eigenvalue.re),
            Cell::text(most),
        ]);
    }
    Ok(vec![rest_table(mechanism, &found), table, shapes(&names, &modes)])
}

/// The shapes, one a row; where joints do not move in step with the one that moves most, a second row tells what they are a quarter of a
/// period later.
fn shapes(names: &[&str], modes: &[Mode]) -> Table {
    let mut columns = vec![("mode", ""), ("part", "")];
    columns.extend(names.iter().map(|name| (*name, "")));
    let mut table = Table::new("shapes", &columns);
    let real = |x: f64| Cell::number(if x.abs() < NO_PART { 0.0 } else { x });
    for (k, mode) in modes.iter().enumerate() {
        let mut row = |part: &str, values: Vec<f64>| {
            let begin = [Cell::count(k as u64 + 1), Cell::text(part)];
            table.row(begin.into_iter().chain(values.into_iter().map(real)));
        };
        row("real", mode.shape.iter().map(|x| x.re).collect());
        if mode.shape.iter().any(|x| x.im.abs() >= NO_PART) {
            row("imaginary", mode.shape.iter().map(|x| x.im).collect());
        }
    }
    table
}
