//! The time of the stages.

use crate::report::{Report, Seconds};
use chordal_tessellate::Stopwatch;

/// The clock of a run.
#[derive(Debug)]
pub(crate) struct Ledger {
    started: Stopwatch,
    seconds: Seconds,
}

impl Ledger {
    pub fn start() -> Self {
        Self { started: Stopwatch::of_wall(), seconds: Seconds::default() }
    }

    /// Runs one stage and adds its wall time.
    pub fn time<T>(&mut self, stage: impl Fn(&mut Seconds) -> &mut f64, work: impl FnOnce() -> T) -> T {
        let clock = Stopwatch::of_wall();
        let result = work();
        *stage(&mut self.seconds) += clock.seconds();
        result
    }

    /// Writes the times into the report. `read`: how long reading took, which was before.
    pub fn close(self, report: &mut Report, read: f64) {
        let (times, own) = (&mut report.seconds, self.seconds);
        (times.read, times.sew, times.resolve, times.audit) = (read, own.sew, own.resolve, own.audit);
        times.total = read + self.started.seconds();
    }
}
