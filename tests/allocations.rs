//! One evaluation and one accepted step allocate nothing after the first, and no event after the first. (A target of its own: it
//! replaces the global allocator.)

use linkdyn_integrators::{Adams, Dop853, Integration, Method, Radau5, Settings};
use linkdyn_mechanisms::Simulation;
use linkdyn_mechanisms::catalogue::{ClearanceKind, Rsup};
use linkdyn_tests::scenes::{Ready, ready_rsrrr, ready_rsup};

type Run<M> = Integration<Simulation, M>;

fn begin<M: Method<Simulation>>(ready: &Ready, method: M, settings: impl Fn(&Simulation) -> Settings) -> Run<M> {
    let simulation = Simulation::new(&ready.mechanism);
    let y = simulation.state_vector(&ready.start);
    let settings = settings(&simulation);
    Integration::new(simulation, method, 0.0, &y, settings).expect("valid")
}

/// Allocations of `steps` further steps or events.
fn allocations<M: Method<Simulation>>(run: &mut Run<M>, steps: usize) -> u64 {
    let counted = allocation_counter::measure(|| {
        for _ in 0..steps {
            run.advance(5.0).expect("regular");
        }
    });
    counted.count_total
}

fn allocations_of_rsrrr<M: Method<Simulation>>(friction: bool, method: M) -> u64 {
    let mut run = begin(&ready_rsrrr(friction, 1.0), method, |_| {
        Settings::tolerances(1e-8, 1e-8)
    });
    allocations(&mut run, 20);
    allocations(&mut run, 100)
}

#[test]
fn steps_of_rsrrr_allocate_nothing() {
    for friction in [false, true] {
        assert_eq!(allocations_of_rsrrr(friction, Dop853::default()), 0);
        assert_eq!(allocations_of_rsrrr(friction, Adams::default()), 0);
    }
}

/// Allocations in five events and the steps between them, after the first contact was made and lost. A state that is refused, as in
/// a first step that leads too deep into a contact, comes with its cause in a box and a name; these two are not counted.
fn allocations_of_contacts<M: Method<Simulation>>(variant: &Rsup, method: M) -> u64 {
    let mut run = begin(&ready_rsup(variant), method, |simulation| {
        simulation.settings(1e-7, 1e-7)
    });
    let mut until_event = |count: u64| {
        let mut allocated = 0;
        let goal = run.statistics().events + count;
        while run.statistics().events < goal {
            let retries = run.statistics().retries;
            let step = allocations(&mut run, 1);
            allocated += step.saturating_sub(2 * (run.statistics().retries - retries));
            assert!(
                run.state().0 < 1.0,
                "contacts are made and lost within the first second"
            );
        }
        allocated
    };
    until_event(2);
    until_event(5)
}

#[test]
fn contacts_made_and_lost_allocate_nothing() {
    for kind in [ClearanceKind::Planar, ClearanceKind::Spatial] {
        let variant = Rsup {
            clearance: Some(kind),
            ..Rsup::default()
        };
        assert_eq!(allocations_of_contacts(&variant, Dop853::default()), 0, "{kind:?}");
        assert_eq!(allocations_of_contacts(&variant, Radau5::default()), 0, "{kind:?}");
    }
}

#[test]
fn steps_with_elastic_links_allocate_nothing() {
    let ready = ready_rsup(&Rsup {
        flexible: Some(4),
        ..Rsup::default()
    });
    let settings = |simulation: &Simulation| simulation.settings(1e-7, 1e-7);
    let mut explicit = begin(&ready, Dop853::default(), settings);
    let mut implicit = begin(&ready, Radau5::default(), settings);
    allocations(&mut explicit, 20);
    allocations(&mut implicit, 20);
    assert_eq!(allocations(&mut explicit, 100), 0);
    assert_eq!(allocations(&mut implicit, 100), 0);
    let both = Rsup {
        flexible: Some(2),
        clearance: Some(ClearanceKind::Planar),
        ..Rsup::default()
    };
    assert_eq!(allocations_of_contacts(&both, Radau5::default()), 0);
}
