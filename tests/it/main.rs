//! All integration tests, one module a subject.

mod recursion_and_lagrange;
