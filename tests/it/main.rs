//! All integration tests, one module a subject.

mod architecture;
mod assembly;
mod baumgarte;
mod clearance_contact;
mod clearance_refusals;
mod closed_form_loops;
mod closures;
mod cut_or_carried;
mod denavit_hartenberg;
mod derivatives;
mod energy;
mod flexible_link;
mod implicit;
mod invariances;
mod linkage_refusals;
mod newton_euler;
mod projection;
mod puma560;
mod reaction_loop;
mod reaction_supports;
mod recursion_and_lagrange;
mod redundant_closures;
mod refusals;
mod rsrrr;
mod rsup;
