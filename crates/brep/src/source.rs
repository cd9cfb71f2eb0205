//! Where in the file something came from.

use serde::Serialize;
use std::fmt;

/// An entity of the input file: its number (`#id`; 0 where the format has none) and its line (from 1; 0
/// unknown).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct Source {
    /// The number of the entity; 0 where the format has none.
    pub entity: u64,
    /// The line, from 1; 0 where it is not known.
    pub line: u32,
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.entity, self.line) {
            (0, 0) => write!(f, "the file"),
            (0, line) => write!(f, "line {line}"),
            (entity, 0) => write!(f, "#{entity}"),
            (entity, line) => write!(f, "#{entity} (line {line})"),
        }
    }
}
