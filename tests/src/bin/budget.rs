//! Counts instructions and allocations of one evaluation and one step of each built-in scene, and compares them with
//! `tools/budget.csv` (`--check`) or writes that file (`--update`). Instructions need valgrind, under which the program calls itself
//! with `--under-valgrind`. Started by `tools/instructions`.

use linkdyn_integrators::{Adams, Integration, Method, Ode, Radau5};
use linkdyn_mechanisms::Simulation;
use linkdyn_tests::budget::{Budget, Row};
use linkdyn_tests::scenes::{Ready, builtin};
use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::{env, fs, io};

/// Evaluations and steps in one count.
const REPEATS: u64 = 100;
/// Steps before the count, so that all scratch has its size and the order of Adams' method has settled.
const WARM_UP: u64 = 60;
/// Contacts made and lost before the count, at least.
const EVENTS: u64 = 3;

/// Everything that is counted goes through here: callgrind begins and ends at this name.
#[inline(never)]
fn budget_counted(work: &mut dyn FnMut()) {
    work();
    // Something to do after the call, so that it is one and not a jump.
    black_box(());
}

struct Case {
    /// The scene as `linkdyn run` is told it.
    name: &'static str,
    ready: Ready,
    /// Method on which such a run settles, and its tolerance.
    method: &'static str,
    tolerance: f64,
}

fn cases() -> Vec<Case> {
    let case = |(name, ready): (&'static str, Ready)| {
        let stiff = name.contains("clearance") || name.contains("flexible");
        let (method, tolerance) = if stiff { ("radau5", 1e-9) } else { ("adams", 1e-12) };
        Case {
            name,
            ready,
            method,
            tolerance,
        }
    };
    builtin().into_iter().map(case).collect()
}

impl Case {
    /// Calls `count` with the work of [`REPEATS`] evaluations, then with that of as many steps.
    fn count(&self, count: &mut dyn FnMut(String, &mut dyn FnMut())) -> Result<(), Box<dyn Error>> {
        let mut simulation = Simulation::new(&self.ready.mechanism);
        simulation.set_drift_tolerance(0.1 * self.tolerance);
        let y = simulation.state_vector(&self.ready.start);
        let settings = simulation.settings(self.tolerance, self.tolerance);
        let method: Box<dyn Method<Simulation>> = match self.method {
            "adams" => Box::new(Adams::default()),
            _ => Box::new(Radau5::default()),
        };
        let until = self.ready.scene.until;
        let run = Integration::new(simulation, method, 0.0, &y, settings)?;
        let mut run = run.with_stops(&self.ready.mechanism.system().stop_times())?;
        for _ in 0..WARM_UP {
            run.advance(until)?;
        }
        if run.problem().roots() > 0 {
            // One step into a contact.
            while run.statistics().events < EVENTS || !run.problem().happened().iter().any(|event| event.made) {
                run.advance(until)?;
            }
            run.advance(until)?;
        }

        let (t, y) = (run.state().0, run.state().1.to_vec());
        let mut problem = run.problem().clone();
        let mut dy = vec![0.0; y.len()];
        let mut outcome = Ok(());
        count("evaluation".into(), &mut || {
            outcome = (0..REPEATS).try_for_each(|_| problem.rhs(black_box(t), black_box(&y), &mut dy));
        });
        outcome.map_err(|error| error.to_string())?;
        let mut outcome = Ok(());
        count(format!("step of {}", self.method), &mut || {
            outcome = (0..REPEATS).try_for_each(|_| run.advance(until).map(|_| ()));
        });
        Ok(outcome?)
    }
}

/// All figures without instructions.
fn allocations() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = Vec::new();
    for case in cases() {
        case.count(&mut |what, work| {
            let counted = allocation_counter::measure(|| budget_counted(work));
            rows.push(Row {
                scene: case.name.to_owned(),
                what,
                instructions: None,
                allocations: counted.count_total,
            });
        })?;
    }
    Ok(rows)
}

/// Instructions of all figures, one after the other, or `None` without valgrind.
fn instructions(figures: usize) -> io::Result<Option<Vec<u64>>> {
    let folder = env::temp_dir().join(format!("linkdyn-budget-{}", std::process::id()));
    fs::create_dir(&folder)?;
    let counted = count_in(&folder, figures);
    fs::remove_dir_all(&folder)?;
    counted
}

fn count_in(folder: &Path, figures: usize) -> io::Result<Option<Vec<u64>>> {
    let file = folder.join("count");
    let output = Command::new("valgrind")
        .args([
            "--tool=callgrind",
            "--zero-before=*budget_counted",
            "--dump-after=*budget_counted",
        ])
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(env::current_exe()?)
        .arg("--under-valgrind")
        .output();
    let output = match output {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        other => other?,
    };
    if !output.status.success() {
        return Err(io::Error::other(String::from_utf8_lossy(&output.stderr).into_owned()));
    }
    // One file for each time that the function was left.
    let part = |i| {
        let text = fs::read_to_string(folder.join(format!("count.{i}")))?;
        let total = text.lines().find_map(|line| line.strip_prefix("totals: "));
        let total: Option<u64> = total.and_then(|total| total.trim().parse().ok());
        total
            .map(|total| total / REPEATS)
            .ok_or(io::Error::other("callgrind told no total"))
    };
    (1..=figures).map(part).collect::<io::Result<_>>().map(Some)
}

fn compiler() -> io::Result<String> {
    let rustc = env::var_os("RUSTC").unwrap_or("rustc".into());
    let output = Command::new(rustc).arg("-V").output()?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The C library chooses the code of sines and exponentials by these.
fn processor() -> String {
    #[cfg(target_arch = "x86_64")]
    let features = [
        (std::arch::is_x86_feature_detected!("avx2"), " avx2"),
        (std::arch::is_x86_feature_detected!("fma"), " fma"),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let features: [(bool, &str); 0] = [];
    let present = features.iter().filter_map(|&(is, name)| is.then_some(name));
    env::consts::ARCH.to_owned() + &present.collect::<String>()
}

fn counted() -> Result<Budget, Box<dyn Error>> {
    let mut rows = allocations()?;
    if let Some(counts) = instructions(rows.len())? {
        for (row, count) in rows.iter_mut().zip(counts) {
            row.instructions = Some(count);
        }
    }
    Ok(Budget {
        compiler: compiler()?,
        processor: processor(),
        rows,
    })
}

fn print(budget: &Budget) {
    println!(
        "{:<38} {:<16} {:>12} {:>11}",
        "scene", "what", "instructions", "allocations"
    );
    for row in &budget.rows {
        let instructions = row.instructions.map_or("-".to_owned(), |count| count.to_string());
        println!(
            "{:<38} {:<16} {instructions:>12} {:>11}",
            row.scene, row.what, row.allocations
        );
    }
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tools/budget.csv");
    match env::args().nth(1).as_deref() {
        Some("--under-valgrind") => {
            for case in cases() {
                case.count(&mut |_, work| budget_counted(work))?;
            }
        }
        Some("--update") => {
            let counted = counted()?;
            if counted.rows.iter().any(|row| row.instructions.is_none()) {
                return Err("the budget is written with instructions, and these need valgrind".into());
            }
            print(&counted);
            fs::write(file, counted.to_string())?;
        }
        Some("--check") => {
            let budget = Budget::parse(&fs::read_to_string(file)?)?;
            let counted = counted()?;
            print(&counted);
            let found = budget.compare(&counted);
            found.notes.iter().for_each(|note| println!("{note}"));
            if !found.failures.is_empty() {
                found
                    .failures
                    .iter()
                    .for_each(|failure| eprintln!("over budget: {failure}"));
                return Ok(ExitCode::FAILURE);
            }
            println!("within the budget");
        }
        _ => return Err("give --check or --update".into()),
    }
    Ok(ExitCode::SUCCESS)
}
