//! Which parts of the mesher ran for a face, and how often.

/// Names of parts with the number of things that each made, in the order in which they first ran.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace(Vec<(&'static str, usize)>);

impl Trace {
    /// Adds `count` things made by `part`. A part that made nothing did not run.
    pub fn add(&mut self, part: &'static str, count: usize) {
        if count == 0 {
            return;
        }
        match self.0.iter_mut().find(|(name, _)| *name == part) {
            Some((_, sum)) => *sum += count,
            None => self.0.push((part, count)),
        }
    }

    /// Adds the counts of another trace.
    pub fn merge(&mut self, other: &Trace) {
        other.0.iter().for_each(|&(part, count)| self.add(part, count));
    }

    /// The parts that ran, with the number of things that each made.
    pub fn parts(&self) -> impl Iterator<Item = (&'static str, usize)> + '_ {
        self.0.iter().copied()
    }

    /// The number of things that `part` made.
    pub fn count(&self, part: &str) -> usize {
        self.0.iter().find(|(name, _)| *name == part).map_or(0, |(_, count)| *count)
    }
}
