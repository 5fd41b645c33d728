#![doc = include_str!("notation.md")]
