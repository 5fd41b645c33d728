//! Which methods are measured at which tolerances or steps, and in which order.

use linkdyn_mechanisms::Switching;

use crate::run::methods::{PUBLISHED_STEP, Plan, STEP};
use crate::scenes::Variant;

/// Sweeps of the friction loop in the paper on RSRRR.
const SWEEPS: usize = 3;

/// A row of the report before it is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Method with tolerance or step.
    pub plan: Plan,
    /// Whether the scene is also switched to the way of its paper.
    pub papers: bool,
}

impl Candidate {
    /// Share of what is left of the budget that the row may take, so that a method that does not get on leaves time for others.
    pub fn share(&self) -> f64 {
        if self.papers { 1.0 } else { 0.25 }
    }

    /// Tolerance or step \[s\].
    pub fn setting(&self) -> f64 {
        self.plan.rtol.or(self.plan.step).unwrap_or(0.0)
    }
}

/// The way of the paper that a scene comes from.
pub struct Papers {
    /// The scene switched to it.
    pub variant: Variant,
    /// Sweeps of the friction loop, where they take the place of solving it.
    pub sweeps: Option<usize>,
    /// Its method.
    pub candidate: Candidate,
}

/// The way of the paper: Newmark's method with three sweeps for RSRRR, at the program's usual step; RK4 with drift terms for RSUP.
pub fn papers_way(scene: &str, variant: &Variant) -> Papers {
    let rsrrr = scene == "rsrrr";
    let plan = Plan {
        switching: if rsrrr { Switching::Located } else { Switching::AtSteps },
        ..fixed(
            if rsrrr { "newmark" } else { "rk4" },
            if rsrrr { STEP } else { PUBLISHED_STEP },
        )
    };
    Papers {
        variant: Variant {
            as_published: !rsrrr,
            ..*variant
        },
        sweeps: (rsrrr && variant.friction == Some(true)).then_some(SWEEPS),
        candidate: Candidate { plan, papers: true },
    }
}

/// The two methods of the reference, by different families.
pub fn references(variant: &Variant) -> [Plan; 2] {
    if is_stiff(variant) {
        [adaptive("dop853", 1e-13), adaptive("radau5", 1e-12)]
    } else {
        [adaptive("dop853", 1e-13), adaptive("adams", 1e-13)]
    }
}

/// All rows but the paper's way, each method from its cheapest to its dearest. Penetrations are micrometres, so with clearance
/// loose tolerances say nothing; and elastic links and contacts need short steps of methods without error control.
pub fn candidates(variant: &Variant) -> Vec<Candidate> {
    let all = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
    let tolerances = match (variant.clearance, variant.flexible) {
        (Some(_), _) => &all[3..8],
        (None, Some(_)) => &all[..8],
        (None, None) => &all[..],
    };
    let steps: [f64; 3] = if is_stiff(variant) {
        [2e-5, 1e-5, 5e-6]
    } else {
        [1e-2, 1e-3, 1e-4]
    };
    let adaptive = ["adams", "dop853", "dopri5", "radau5"]
        .into_iter()
        .flat_map(|method| tolerances.iter().map(move |&tolerance| adaptive(method, tolerance)));
    let fixed = steps.into_iter().map(|step| fixed("rk4", step));
    let row = |plan| Candidate { plan, papers: false };
    adaptive.chain(fixed).map(row).collect()
}

/// Contacts and elastic links are stiff.
fn is_stiff(variant: &Variant) -> bool {
    variant.clearance.is_some() || variant.flexible.is_some()
}

fn adaptive(method: &str, tolerance: f64) -> Plan {
    Plan {
        method: method.to_owned(),
        rtol: Some(tolerance),
        atol: Some(tolerance),
        step: None,
        iterations: None,
        switching: Switching::Located,
    }
}

fn fixed(method: &str, step: f64) -> Plan {
    Plan {
        method: method.to_owned(),
        rtol: None,
        atol: None,
        step: Some(step),
        iterations: None,
        switching: Switching::Located,
    }
}

/// What is known of the times that runs take.
#[derive(Clone, Debug)]
pub struct Experience {
    /// End of the runs \[s\].
    pub until: f64,
    /// Time of one evaluation \[s\].
    pub evaluation: f64,
    /// Methods and the times of their runs so far \[s\].
    pub runs: Vec<(String, f64)>,
}

/// Growth of the time of a run from one tolerance to the next.
const GROWTH: f64 = 1.4;
/// Evaluations in a step of the methods of fixed step: four stages, or the usual sweeps of a corrector.
const STAGES: f64 = 4.0;

impl Experience {
    /// Time that a row is likely to take \[s\]; zero for the first row of an adaptive method.
    pub fn predict(&self, candidate: &Candidate) -> f64 {
        match candidate.plan.step {
            Some(step) => self.until / step * STAGES * self.evaluation,
            None => {
                let mut same = self.runs.iter().rev().filter(|run| run.0 == candidate.plan.method);
                same.next().map_or(0.0, |run| GROWTH * run.1)
            }
        }
    }

    /// Index of the row to measure next: the paper's way, to which others are compared, then the cheapest; `None` if none waits.
    pub fn next(&self, waiting: &[Candidate]) -> Option<usize> {
        let key = |i: &usize| match waiting[*i].papers {
            true => -1.0,
            false => self.predict(&waiting[*i]),
        };
        (0..waiting.len()).min_by(|a, b| key(a).total_cmp(&key(b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::ClearanceArg;

    fn experience() -> Experience {
        Experience {
            until: 1.0,
            evaluation: 1e-6,
            runs: Vec::new(),
        }
    }

    #[test]
    fn the_papers_way_comes_first_and_then_what_is_cheapest() {
        let variant = Variant::default();
        let mut waiting = candidates(&variant);
        waiting.push(papers_way("rsrrr", &variant).candidate);
        let mut experience = experience();
        let first = experience.next(&waiting).expect("some wait");
        assert!(waiting.remove(first).papers);
        // Each adaptive method is tried once, at its loosest tolerance, before fixed steps.
        for name in ["adams", "dop853", "dopri5", "radau5"] {
            let next = waiting.remove(experience.next(&waiting).expect("some wait"));
            assert_eq!((next.plan.method.as_str(), next.setting()), (name, 1e-4));
            experience
                .runs
                .push((name.to_owned(), if name == "radau5" { 1e-4 } else { 1e-2 }));
        }
        // 1.4e-4 s for radau5, 4e-4 s for a hundred steps of rk4.
        let next = waiting.remove(experience.next(&waiting).expect("some wait"));
        assert_eq!((next.plan.method.as_str(), next.setting()), ("radau5", 1e-5));
        experience.runs.push(("radau5".to_owned(), 1.0));
        let next = waiting.remove(experience.next(&waiting).expect("some wait"));
        assert_eq!((next.plan.method.as_str(), next.setting()), ("rk4", 1e-2));
        assert_eq!(experience.next(&[]), None);
    }

    #[test]
    fn references_are_of_different_methods_and_tighter_than_any_row() {
        let clearance = Some(ClearanceArg::Planar);
        let ideal = Variant::default();
        for variant in [ideal, Variant { clearance, ..ideal }] {
            let [a, b] = references(&variant);
            assert_ne!(a.method, b.method);
            for row in candidates(&variant) {
                let same = [&a, &b].into_iter().find(|plan| plan.method == row.plan.method);
                assert!(row.plan.step.is_some() || same.is_none_or(|plan| plan.rtol < row.plan.rtol));
            }
        }
    }

    #[test]
    fn the_papers_ways_are_those_of_the_two_papers() {
        let friction = Variant {
            friction: Some(true),
            ..Variant::default()
        };
        let rsrrr = papers_way("rsrrr", &friction);
        assert_eq!(
            (rsrrr.candidate.plan.method.as_str(), rsrrr.sweeps),
            ("newmark", Some(3))
        );
        assert!(!rsrrr.variant.as_published);
        let rsup = papers_way("rsup", &Variant::default());
        assert_eq!(
            (rsup.candidate.plan.method.as_str(), rsup.candidate.setting()),
            ("rk4", 5e-6)
        );
        assert!(rsup.variant.as_published && rsup.sweeps.is_none());
    }
}
