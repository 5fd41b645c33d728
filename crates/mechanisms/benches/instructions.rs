//! Instructions of one evaluation. Run under `valgrind --tool=callgrind` by `tools/instructions`: the first argument names
//! the case, the second says how often it is evaluated; the difference of two counts is free of everything else.

#![allow(missing_docs)]

mod cases;

use cases::{WholeRun, chain_case, lu7, rsrrr_case};

fn main() {
    let mut arguments = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let (Some(name), Some(repeats)) = (arguments.next(), arguments.next()) else {
        return;
    };
    let repeats: usize = repeats.parse().expect("the second argument is a number");
    if name == "lu7" {
        let mut unit = lu7();
        (0..repeats).for_each(|_| unit());
        return;
    }
    if let Some(method) = name.strip_prefix("run-") {
        let run = WholeRun::rsrrr(false);
        let once = || match method {
            "dop853" => run.by_dop853(),
            _ => run.by_adams(),
        };
        let evaluations = (0..repeats).fold(0, |_, _| once().1);
        println!("evaluations {evaluations}");
        return;
    }
    let mut case = match name.as_str() {
        "rsrrr" => rsrrr_case(false),
        "rsrrr-friction" => rsrrr_case(true),
        other => chain_case(other.trim_start_matches("chain-").parse().expect("chain-N")),
    };
    (0..repeats).for_each(|_| case.evaluate());
}
