//! `linkdyn analyse`: what can move, where it goes, where it rests, how it vibrates.

use linkdyn_mechanisms::analysis::equilibrium::{Equilibrium, Settings, Stability};
use linkdyn_mechanisms::analysis::mobility::Redundant;
use linkdyn_mechanisms::analysis::positions::Sweep;
use linkdyn_mechanisms::analysis::{AnalysisError, equilibrium, linearise, mobility, positions};
use linkdyn_mechanisms::{Mechanism, State};

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
        AnalysisArg::Positions => position_tables(&prepared, args),
        AnalysisArg::Equilibrium => rest(&prepared, args).map(|found| vec![rest_table(&prepared.mechanism, &found)]),
        AnalysisArg::Modes => mode_tables(&prepared, args),
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

fn position_tables(prepared: &Prepared, args: &AnalyseArgs) -> Result<Vec<Table>, AnalysisError> {
    let mechanism = &prepared.mechanism;
    let name = args.drive.clone().unwrap_or_else(|| prepared.scene.crank.clone());
    let from = mechanism.coordinate_names().position(|known| known == name);
    let from = from.map_or(0.0, |index| prepared.start.q[index]);
    let to = args.to.unwrap_or(from + 2.0 * std::f64::consts::PI);
    let path = positions(
        mechanism,
        &prepared.start.q,
        &Sweep::new(&name, to, usize::from(args.parts)),
    )?;
    let coordinates: Vec<String> = mechanism.coordinate_names().map(|name| format!("q.{name}")).collect();
    let names = mechanism
        .speed_names()
        .map(|name| [format!("v.{name}"), format!("a.{name}")]);
    let (speeds, rates): (Vec<String>, Vec<String>) = names.map(|[v, a]| (v, a)).unzip();
    let columns: Vec<(&str, &str)> = coordinates
        .iter()
        .chain(&speeds)
        .chain(&rates)
        .map(|name| (name.as_str(), ""))
        .collect();
    let mut rows = Table::new("positions", &columns);
    for row in &path.rows {
        rows.row(row.q.iter().chain(&row.v).chain(&row.a).map(|x| Cell::number(*x)));
    }
    let mut tables = vec![rows];
    if let Some(limit) = path.limit {
        let mut end = Table::list("limit");
        end.entry(
            &format!("{name} goes no further than"),
            Cell::number(limit.driven[0]),
            "",
        );
        end.entry("moves most there", Cell::text(limit.coordinate), "");
        end.entry("its value", Cell::number(limit.value), "");
        end.entry("smallest over largest singular value", Cell::number(limit.measure), "");
        tables.push(end);
    }
    Ok(tables)
}

fn rest(prepared: &Prepared, args: &AnalyseArgs) -> Result<Equilibrium, AnalysisError> {
    let settings = Settings {
        time: args.time,
        ..Settings::default()
    };
    equilibrium(&prepared.mechanism, &prepared.start.q, &settings)
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

fn mode_tables(prepared: &Prepared, args: &AnalyseArgs) -> Result<Vec<Table>, AnalysisError> {
    let found = rest(prepared, args)?;
    let state = State {
        q: found.q.clone(),
        v: vec![0.0; prepared.start.v.len()],
    };
    let modes = linearise(&prepared.mechanism, args.time, &state)?.modes()?;
    let columns = [
        ("frequency", "Hz"),
        ("damping ratio", ""),
        ("real part", "1/s"),
        ("moves most", ""),
    ];
    let mut table = Table::new("modes", &columns);
    let names: Vec<&str> = prepared.mechanism.speed_names().collect();
    for mode in &modes {
        let sizes = mode.shape.iter().map(|x| x.norm()).enumerate();
        let most = sizes.max_by(|a, b| a.1.total_cmp(&b.1)).map_or("", |(k, _)| names[k]);
        table.row([
            Cell::number(mode.frequency()),
            mode.damping_ratio().map_or(Cell::Empty, Cell::number),
            Cell::number(mode.eigenvalue.re),
            Cell::text(most),
        ]);
    }
    Ok(vec![rest_table(&prepared.mechanism, &found), table])
}
