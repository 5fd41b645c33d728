//! The summary of a run and its manifest `run.json`.

use std::time::Duration;

use linkdyn_mechanisms::dynamics::Counters;
use linkdyn_mechanisms::integrators::Statistics;
use linkdyn_mechanisms::{Mechanism, Scene, Tally, Worst};
use serde_json::{Value, json};

use crate::machine::{Machine, Program};
use crate::summary::{Cell, Table};

use super::methods::Plan;
use super::record::{Record, peak};

/// Share of the run, from its end, that counts as its steady part.
const STEADY: f64 = 0.4;

/// How a run ended and what it cost.
pub struct Outcome {
    /// Costs of the integration.
    pub statistics: Statistics,
    /// Costs of the equations of motion, observations included.
    pub counters: Counters,
    /// Worst figures between the outputs.
    pub worst: Worst,
    /// Time on the clock.
    pub wall: Duration,
    /// Number of rows written.
    pub rows: u64,
    /// Why the run ended early, if it did.
    pub failure: Option<String>,
    /// Why a run that reached its end means nothing, if so.
    pub lost: Option<String>,
}

/// What happened, in figures.
#[must_use]
pub fn summary(scene: &Scene, mechanism: &Mechanism, record: &Record, outcome: &Outcome) -> Table {
    let mut table = Table::list("summary");
    let end = record.t.last().copied().unwrap_or(0.0);
    table.entry("simulated until", Cell::number(end), "s");
    let crank = mechanism.coordinate_names().position(|name| name == scene.crank);
    if let Some((speed, from)) = crank.and_then(|k| record.mean_speed(k, STEADY)) {
        let label = format!("mean speed of {}, whole turns from {from:.3} s", scene.crank);
        table.entry(&label, Cell::number(speed), "rad/s");
    }
    for (name, force) in mechanism.joint_names().zip(&record.force) {
        table.entry(&format!("peak force in {name}"), Cell::number(peak(force)), "N");
    }
    for (name, force) in mechanism.loop_names().zip(&record.loop_force) {
        table.entry(&format!("peak force in {name}"), Cell::number(*force), "N");
    }
    for (name, friction) in mechanism.friction_names().zip(&record.friction) {
        table.entry(&format!("peak friction on {name}"), Cell::number(*friction), "N m");
    }
    if let Some(name) = &scene.output
        && let Some(rms) = mechanism
            .coordinate_names()
            .position(|known| known == name)
            .and_then(|k| record.acceleration_rms(k))
    {
        table.entry(&format!("acceleration of {name}, rms"), Cell::number(rms), "m/s^2");
    }
    contacts(&mut table, mechanism, &record.tally);
    table.entry("work of all loads", Cell::number(record.work), "J");
    table.entry("energy error, largest", Cell::number(record.energy_error), "J");
    table.entry(
        "loop residual at outputs, largest",
        Cell::number(record.violation.0),
        "m",
    );
    table.entry(
        "loop drift before projection, largest",
        Cell::number(outcome.worst.position_drift),
        "m",
    );
    if mechanism.has_friction() {
        table.entry(
            "friction loop residual, largest",
            Cell::number(outcome.worst.friction_residual),
            "",
        );
        table.entry(
            "friction iterations",
            Cell::count(outcome.counters.reaction_iterations),
            "",
        );
    }
    let s = &outcome.statistics;
    table.entry("steps accepted", Cell::count(s.accepted), "");
    table.entry("steps rejected", Cell::count(s.rejected), "");
    table.entry("evaluations", Cell::count(s.evaluations), "");
    table.entry("rows", Cell::count(outcome.rows), "");
    table.entry("wall time", Cell::number(outcome.wall.as_secs_f64()), "s");
    table
}

/// What happened in the joints with clearance.
fn contacts(table: &mut Table, mechanism: &Mechanism, tally: &Tally) {
    let (begin, end) = tally.span;
    for (name, point) in mechanism.contact_names().zip(&tally.points) {
        let mut entry = |what: &str, value: f64, unit: &str| {
            table.entry(&format!("{what} in {name}"), Cell::number(value), unit);
        };
        if end > begin {
            entry("time share in contact", point.contact_time(end) / (end - begin), "");
        }
        entry("mean normal force while in contact", point.mean_force(end), "N");
        entry("rms normal force while in contact", point.rms_force(end), "N");
        entry("peak normal force", point.peak_force, "N");
        entry("greatest penetration", point.greatest_depth, "m");
        entry("fastest impact", point.fastest, "m/s");
        entry("energy lost in the normal direction", point.integrals.damping_loss, "J");
        entry("energy lost in friction", point.integrals.friction_loss, "J");
        if let Some(restitution) = point.restitution() {
            entry("separation over approach, mean", restitution, "");
        }
        table.entry(&format!("impacts in {name}"), Cell::count(point.impacts), "");
        if point.held > 0 {
            table.entry(&format!("contacts held in {name}"), Cell::count(point.held), "");
        }
    }
}

/// The manifest: the scene as it was run, method, counters, worst figures, program, machine.
#[must_use]
pub fn manifest(
    scene: &Scene,
    plan: &Plan,
    grid: (f64, f64),
    columns: &[String],
    table: &Table,
    outcome: &Outcome,
) -> Value {
    let s = &outcome.statistics;
    let c = &outcome.counters;
    json!({
        "status": if outcome.failure.is_some() { "partial" } else { "complete" },
        "failure": outcome.failure.as_ref().or(outcome.lost.as_ref()),
        "scene": scene,
        "until": grid.0,
        "every": grid.1,
        "integration": plan,
        "columns": columns,
        "counters": {
            "steps_accepted": s.accepted,
            "steps_rejected": s.rejected,
            "evaluations": s.evaluations,
            "evaluations_for_interpolation": s.dense_evaluations,
            "evaluations_with_observations": c.evaluations,
            "projections": s.projections,
            "retries": s.retries,
            "corrector_iterations": s.iterations,
            "jacobians": s.jacobians,
            "factorisations": s.factorisations,
            "events": s.events,
            "root_evaluations": s.root_evaluations,
            "steps_made_again_at_events": s.relocations,
            "reaction_sweeps": c.reaction_sweeps,
            "friction_iterations": c.reaction_iterations,
            "friction_continuations": c.reaction_continuations,
            "evaluations_with_redundant_closures": c.redundant,
            "refinements": c.refinements,
        },
        "worst": {
            "position_drift": outcome.worst.position_drift,
            "velocity_drift": outcome.worst.velocity_drift,
            "friction_residual": outcome.worst.friction_residual,
        },
        "summary": table.to_json(),
        "wall_time_s": outcome.wall.as_secs_f64(),
        "machine": Machine::this(),
        "program": Program::this(),
    })
}
