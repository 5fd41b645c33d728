//! Known linkages.
