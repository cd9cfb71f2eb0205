//! The time of the stages.

use crate::clock::Clock;
use crate::report::{Report, Seconds};

/// The clock of a run.
#[derive(Debug)]
pub(crate) struct Ledger {
    started: Clock,
    seconds: Seconds,
}

impl Ledger {
    pub fn start() -> Self {
        Self { started: Clock::start(), seconds: Seconds::default() }
    }

    /// Runs one stage and adds its wall time.
    pub fn time<T>(&mut self, stage: impl Fn(&mut Seconds) -> &mut f64, work: impl FnOnce() -> T) -> T {
        let clock = Clock::start();
        let result = work();
        *stage(&mut self.seconds) += clock.seconds();
        result
    }

    /// Writes the times into the report.
    pub fn close(self, report: &mut Report) {
        let (times, own) = (&mut report.seconds, self.seconds);
        (times.read, times.sew, times.resolve) = (own.read, own.sew, own.resolve);
        (times.audit, times.write) = (own.audit, own.write);
        times.total = self.started.seconds();
    }
}
