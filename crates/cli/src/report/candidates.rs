//! Which methods are measured at which tolerances or steps, and in which order.

use linkdyn_mechanisms::Switching;

use crate::run::methods::{ADAPTIVE, PUBLISHED_STEP, Plan, STEP};
use crate::scenes::Variant;

/// Sweeps of the friction loop in the paper on RSRRR.
const SWEEPS: usize = 3;

/// In which way a row runs its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// As this program does.
    Own,
    /// Switched to the way of its paper, at another step.
    Papers,
    /// Switched to the way of its paper, at the paper's step.
    Published,
}

/// Every half decade.
const TOLERANCES: [f64; 17] = [
    1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9, 3e-10, 1e-10, 3e-11, 1e-11, 3e-12, 1e-12,
];

/// A row of the report before it is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Method with tolerance or step.
    pub plan: Plan,
    /// The way of the scene.
    pub way: Way,
}

impl Candidate {
    /// Share of what is left of the budget that the row may take, so that a method that does not get on leaves time for others.
    pub fn share(&self) -> f64 {
        if self.way == Way::Published { 1.0 } else { 0.25 }
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
    /// Its method, at the paper's step and then at others.
    pub candidates: Vec<Candidate>,
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
    let row = |step, way| Candidate {
        plan: Plan {
            step: Some(step),
            ..plan.clone()
        },
        way,
    };
    let published = row(if rsrrr { STEP } else { PUBLISHED_STEP }, Way::Published);
    let others: &[f64] = match (rsrrr, is_stiff(variant)) {
        // With longer ones the corrector does not settle at the start.
        (true, _) => &[3e-4, 3e-5],
        (false, true) => &[2e-5, 1e-5],
        (false, false) => &[1e-3, 3e-4, 1e-4, 3e-5, 1e-5],
    };
    let others = others.iter().map(|step| row(*step, Way::Papers));
    Papers {
        variant: Variant {
            as_published: !rsrrr,
            ..*variant
        },
        sweeps: (rsrrr && variant.friction == Some(true)).then_some(SWEEPS),
        candidates: std::iter::once(published).chain(others).collect(),
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
    let tolerances = match (variant.clearance, variant.flexible) {
        (Some(_), _) => &TOLERANCES[6..15],
        (None, Some(_)) => &TOLERANCES[..15],
        (None, None) => &TOLERANCES[..],
    };
    let steps: &[f64] = if is_stiff(variant) {
        &[2e-5, 1e-5, 5e-6]
    } else {
        &[1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5]
    };
    let adaptive = ADAPTIVE
        .into_iter()
        .flat_map(|method| tolerances.iter().map(move |&tolerance| adaptive(method, tolerance)));
    let fixed = steps.iter().map(|step| fixed("rk4", *step));
    let row = |plan| Candidate { plan, way: Way::Own };
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
    /// Adaptive runs so far, with their times \[s\].
    pub runs: Vec<(Candidate, f64)>,
}

/// Growth of the time of a run from one decade of tolerance to the next.
const GROWTH: f64 = 1.4;
/// Evaluations in a step of the methods of fixed step: four stages, or the usual sweeps of a corrector.
const STAGES: f64 = 4.0;

impl Experience {
    /// Time that a row is likely to take \[s\]; zero for the first row of an adaptive method.
    pub fn predict(&self, candidate: &Candidate) -> f64 {
        if let Some(step) = candidate.plan.step {
            return self.until / step * STAGES * self.evaluation;
        }
        let decades = |run: &Candidate| (run.setting() / candidate.setting()).log10();
        let same = self
            .runs
            .iter()
            .filter(|run| run.0.plan.method == candidate.plan.method);
        let nearest = same.min_by(|a, b| decades(&a.0).abs().total_cmp(&decades(&b.0).abs()));
        nearest.map_or(0.0, |(run, time)| time * GROWTH.powf(decades(run)))
    }

    /// Index of the row to measure next: the paper's way, to which others are compared, then whole decades from the cheapest on, then
    /// half decades; `None` if none waits.
    pub fn next(&self, waiting: &[Candidate]) -> Option<usize> {
        let key = |i: usize| {
            let row = &waiting[i];
            let half = row.setting().log10();
            let order = match row.way {
                Way::Published => 0,
                _ if (half - half.round()).abs() < 0.1 || is_coarse(row) => 1,
                _ => 2,
            };
            (order, self.predict(row))
        };
        (0..waiting.len()).min_by(|&a, &b| {
            let (a, b) = (key(a), key(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    }
}

/// Steps of stiff scenes are few, and none of them is between others.
fn is_coarse(row: &Candidate) -> bool {
    row.plan.step.is_some_and(|step| step < 2.5e-5)
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
        waiting.extend(papers_way("rsrrr", &variant).candidates);
        let mut experience = experience();
        let first = experience.next(&waiting).expect("some wait");
        assert_eq!(waiting.remove(first).way, Way::Published);
        waiting.retain(|row| row.way == Way::Own);
        // Each adaptive method is tried once, at its loosest tolerance, before fixed steps.
        for name in ADAPTIVE {
            let next = waiting.remove(experience.next(&waiting).expect("some wait"));
            assert_eq!((next.plan.method.as_str(), next.setting()), (name, 1e-4));
            experience.runs.push((next, if name == "radau5" { 1e-4 } else { 1e-2 }));
        }
        // 1.4e-4 s for radau5, 4e-4 s for a hundred steps of rk4.
        let next = waiting.remove(experience.next(&waiting).expect("some wait"));
        assert_eq!((next.plan.method.as_str(), next.setting()), ("radau5", 1e-5));
        experience.runs.push((next, 1.0));
        let next = waiting.remove(experience.next(&waiting).expect("some wait"));
        assert_eq!((next.plan.method.as_str(), next.setting()), ("rk4", 1e-2));
        // Half decades come last.
        waiting.retain(|row| row.plan.method == "adams");
        let last = std::iter::from_fn(|| Some(waiting.remove(experience.next(&waiting)?))).last();
        assert_eq!(last.map(|row| row.setting()), Some(3e-12));
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
            (rsrrr.candidates[0].plan.method.as_str(), rsrrr.sweeps),
            ("newmark", Some(3))
        );
        assert!(!rsrrr.variant.as_published);
        let rsup = papers_way("rsup", &Variant::default());
        assert_eq!(
            (rsup.candidates[0].plan.method.as_str(), rsup.candidates[0].setting()),
            ("rk4", 5e-6)
        );
        assert!(rsup.variant.as_published && rsup.sweeps.is_none());
    }
}
