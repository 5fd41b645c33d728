//! `linkdyn analyse`: what can move, where it goes, what drives it, where it rests, how it vibrates.

mod motion;
mod rest;

use linkdyn_mechanisms::analysis::mobility::Redundant;
use linkdyn_mechanisms::analysis::{AnalysisError, mobility};

use crate::args::{AnalyseArgs, AnalysisArg, FormulationArg};
use crate::errors::CliError;
use crate::output;
use crate::run::{Prepared, prepare};
use crate::scenes::Variant;
use crate::summary::{Cell, Table};

/// `linkdyn analyse`.
///
/// # Errors
/// Wrong usage, a scene that cannot start, an analysis without an answer.
pub fn analyse(args: &AnalyseArgs) -> Result<(), CliError> {
    let variant = Variant::new(&args.variant, false);
    let prepared = prepare(&args.scene, &variant, None, FormulationArg::Recursive)?;
    let tables = match args.what {
        AnalysisArg::Mobility => mobility_tables(&prepared),
        AnalysisArg::Branches => motion::branch_tables(&prepared, args),
        AnalysisArg::Positions => motion::position_tables(&prepared, args),
        AnalysisArg::Drives => motion::drive_tables(&prepared, args),
        AnalysisArg::Equilibrium => rest::rest_tables(&prepared, args),
        AnalysisArg::Modes => rest::mode_tables(&prepared, args),
    };
    let tables = tables.map_err(|error| {
        CliError::failed(format!("scene `{}` could not be analysed", args.scene)).with_source(error)
    })?;
    if args.json {
        let all: Vec<_> = tables.iter().map(Table::to_json).collect();
        return output::print(&format!("{:#}\n", serde_json::Value::from(all)));
    }
    let all: Vec<String> = tables.iter().map(Table::to_text).collect();
    output::print(&all.join("\n"))
}

/// What can move, and the redundant equations by name.
pub(crate) fn mobility_tables(prepared: &Prepared) -> Result<Vec<Table>, AnalysisError> {
    let found = mobility(&prepared.mechanism, &prepared.start.q)?;
    let mut counts = Table::list("mobility");
    let counted = i64::try_from(found.counted).unwrap_or(i64::MAX);
    counts.entry("speeds of the tree", Cell::count(found.speeds as u64), "");
    counts.entry("equations of the loops", Cell::count(found.equations as u64), "");
    counts.entry("independent equations here", Cell::count(found.rank as u64), "");
    counts.entry("speeds less equations", Cell::text(counted.to_string()), "");
    counts.entry("freedoms here", Cell::count(found.freedoms as u64), "");
    counts.entry("freedoms that last", Cell::count(found.finite as u64), "");
    counts.entry("freedoms for any dimensions", Cell::count(found.general as u64), "");
    if found.prescribed > 0 {
        counts.entry("prescribed motions", Cell::count(found.prescribed as u64), "");
        counts.entry("freedoms left to forces", Cell::count(found.left as u64), "");
    }
    counts.entry("independent coordinates", Cell::text(shortened(&found.independent)), "");
    counts.entry("smallest pivot over the first", Cell::number(found.weakest), "");
    counts.entry("largest pivot that counts as zero", Cell::number(found.rest), "");
    let mut rows = Table::new("redundant", &[("redundant equation", ""), ("follows from", "")]);
    for redundant in &found.redundant {
        rows.row([
            Cell::text(redundant.row.to_string()),
            Cell::text(combination(redundant)),
        ]);
    }
    Ok(match found.redundant.is_empty() {
        true => vec![counts],
        false => vec![counts, rows],
    })
}

/// Names in one line; of many the first ones.
fn shortened(names: &[String]) -> String {
    const MOST: usize = 12;
    match names.len().checked_sub(MOST) {
        None | Some(0) => names.join(", "),
        Some(more) => format!("{} and {more} more", names[..MOST].join(", ")),
    }
}

fn combination(redundant: &Redundant) -> String {
    if redundant.combination.is_empty() {
        return "nothing moves it".into();
    }
    let terms = redundant.combination.iter();
    terms
        .map(|(row, factor)| format!("{factor:+.4} {row}"))
        .collect::<Vec<_>>()
        .join(" ")
}
