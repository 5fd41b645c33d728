//! Instructions of driver and method, to be counted by `valgrind --tool=callgrind`: the arguments name the case and say how often
//! it runs, printed are the evaluations of one run. The difference of two counts over the difference of the evaluations is free
//! of everything else; instructions of `rhs` proper are not part of the overhead, callgrind lists them apart.

use linkdyn_integrators::{Adams, Dop853, DormandPrince5, Ode, Radau5, Rk4};

mod cases;

use cases::{Duffing, Rotation, run};

fn work<P: Ode>(problem: P, method: &str) -> u64 {
    match method {
        "rk4" => run(problem, Rk4::new(0.01)),
        "dp5" => run(problem, DormandPrince5::default()),
        "dop853" => run(problem, Dop853::default()),
        "adams" => run(problem, Adams::default()),
        "radau" => run(problem, Radau5::default()),
        other => panic!("no method {other}"),
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let [problem, method, repeats] = &arguments[..] else {
        return;
    };
    let repeats: u32 = repeats.parse().expect("the third argument is a number");
    for i in 0..repeats {
        let evaluations = match problem.as_str() {
            "rotation" => work(Rotation, method),
            "duffing" => work(Duffing, method),
            other => panic!("no problem {other}"),
        };
        if i == 0 {
            println!("{evaluations}");
        }
    }
}
