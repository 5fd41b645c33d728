//! Where a mechanism goes: all its closed positions, a range of one coordinate, and what drives it through.

use linkdyn_mechanisms::analysis::branches::Search;
use linkdyn_mechanisms::analysis::inverse_dynamics::Prescribed;
use linkdyn_mechanisms::analysis::positions::{Driven, Path, Sweep};
use linkdyn_mechanisms::analysis::{AnalysisError, branches, inverse_dynamics, positions};
use linkdyn_mechanisms::{Simulation, Start};

use crate::args::AnalyseArgs;
use crate::run::Prepared;
use crate::summary::{Cell, Table};

/// All closed positions.
pub(super) fn branch_tables(prepared: &Prepared, args: &AnalyseArgs) -> Result<Vec<Table>, AnalysisError> {
    let mechanism = &prepared.mechanism;
    let scene = &prepared.scene;
    let held = match (args.hold.is_empty(), scene.start.held.is_empty()) {
        (false, _) => args.hold.clone(),
        (true, false) => scene.start.held.clone(),
        (true, true) => vec![scene.crank.clone()],
    };
    let names: Vec<String> = mechanism.coordinate_names().map(str::to_owned).collect();
    let positions = names.iter().cloned().zip(prepared.start.q.iter().copied()).collect();
    let start = Start {
        positions,
        held,
        speeds: Vec::new(),
    };
    let search = Search {
        guesses: usize::from(args.guesses),
        ..Search::default()
    };
    let found = branches(mechanism, &start, &search)?;
    let mut columns = vec![("branch", "")];
    columns.extend(names.iter().map(|name| (name.as_str(), "")));
    columns.extend([("residual", ""), ("guesses", "")]);
    let mut rows = Table::new("branches", &columns);
    for (k, closed) in found.positions.iter().enumerate() {
        let number = Cell::count(k as u64 + 1);
        let values = closed.q.iter().map(|x| Cell::number(*x));
        let figures = [Cell::number(closed.residual), Cell::count(closed.hits as u64)];
        rows.row(std::iter::once(number).chain(values).chain(figures));
    }
    let mut counts = Table::list("search");
    counts.entry("held", Cell::text(start.held.join(", ")), "");
    counts.entry("guesses", Cell::count(args.guesses.into()), "");
    counts.entry("guesses that led nowhere", Cell::count(found.lost as u64), "");
    counts.entry(
        "guesses that led to cuts closed backwards",
        Cell::count(found.reversed as u64),
        "",
    );
    counts.entry("positions found only once", Cell::count(found.singles as u64), "");
    Ok(vec![rows, counts])
}

/// The driven coordinate, and the way that it goes.
fn sweep(prepared: &Prepared, args: &AnalyseArgs) -> Result<(Driven, Path), AnalysisError> {
    let mechanism = &prepared.mechanism;
    let name = args.drive.clone().unwrap_or_else(|| prepared.scene.crank.clone());
    let from = mechanism.coordinate_names().position(|known| known == name);
    let from = from.map_or(0.0, |index| prepared.start.q[index]);
    let driven = Driven {
        to: args.to.unwrap_or(from + 2.0 * std::f64::consts::PI),
        coordinate: name,
        speed: args.speed,
        acceleration: args.acceleration,
    };
    let mut sweep = Sweep::new(&driven.coordinate, driven.to, usize::from(args.parts));
    sweep.driven = vec![driven.clone()];
    Ok((driven, positions(mechanism, &prepared.start.q, &sweep)?))
}

/// Positions, speeds and accelerations over a range.
pub(super) fn position_tables(prepared: &Prepared, args: &AnalyseArgs) -> Result<Vec<Table>, AnalysisError> {
    let (driven, path) = sweep(prepared, args)?;
    let mechanism = &prepared.mechanism;
    let coordinates = mechanism.coordinate_names().map(|name| format!("q.{name}"));
    let speeds = mechanism.speed_names().map(|name| format!("v.{name}"));
    let rates = mechanism.speed_names().map(|name| format!("a.{name}"));
    let mut rows = numbers("positions", coordinates.chain(speeds).chain(rates));
    for row in &path.rows {
        rows.row(row.q.iter().chain(&row.v).chain(&row.a).map(|x| Cell::number(*x)));
    }
    Ok(with_end(rows, &driven, path))
}

/// What drives the mechanism through a range.
pub(super) fn drive_tables(prepared: &Prepared, args: &AnalyseArgs) -> Result<Vec<Table>, AnalysisError> {
    let (driven, path) = sweep(prepared, args)?;
    let mechanism = &prepared.mechanism;
    // The columns of result files.
    let columns = Simulation::new(mechanism).columns(true);
    let of = |begins: &'static str| columns.iter().filter(move |name| name.starts_with(begins)).cloned();
    let first = [format!("q.{}", driven.coordinate), "drive".into(), "power".into()];
    let rest = of("lambda.").chain(of("reaction.")).chain(of("friction."));
    let mut rows = numbers("drives", first.into_iter().chain(rest));
    let motion = [Prescribed {
        coordinate: driven.coordinate.clone(),
        speed: driven.speed,
        acceleration: driven.acceleration,
    }];
    let index = mechanism.coordinate_names().position(|name| name == driven.coordinate);
    for row in &path.rows {
        let needs = inverse_dynamics(mechanism, args.time, &row.q, &motion)?;
        let mut values = vec![index.map_or(f64::NAN, |index| row.q[index])];
        values.extend(&needs.drives);
        values.push(needs.power);
        values.extend(&needs.multipliers);
        for reaction in &needs.reactions {
            values.extend(reaction.force.iter().chain(&reaction.torque));
        }
        values.extend(&needs.friction);
        rows.row(values.into_iter().map(Cell::number));
    }
    Ok(with_end(rows, &driven, path))
}

fn numbers(name: &str, columns: impl Iterator<Item = String>) -> Table {
    let columns: Vec<String> = columns.collect();
    let columns: Vec<(&str, &str)> = columns.iter().map(|name| (name.as_str(), "")).collect();
    Table::new(name, &columns)
}

/// The rows, and where they ended, if that was early.
fn with_end(rows: Table, driven: &Driven, path: Path) -> Vec<Table> {
    let mut tables = vec![rows];
    if let Some(limit) = path.limit {
        let mut end = Table::list("limit");
        end.entry(
            &format!("{} goes no further than", driven.coordinate),
            Cell::number(limit.driven[0]),
            "",
        );
        end.entry("moves most there", Cell::text(limit.coordinate), "");
        end.entry("its value", Cell::number(limit.value), "");
        end.entry("smallest over largest singular value", Cell::number(limit.measure), "");
        tables.push(end);
    }
    tables
}
