//! CPU time, where the system tells: on a machine with other work to do, wall time says how busy that is.

use std::time::Instant;

/// Whose time counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Whose {
    Thread,
    Process,
}

/// Seconds since it was made.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    whose: Whose,
    cpu: Option<f64>,
    wall: Instant,
}

impl Stopwatch {
    /// CPU time of this thread; it must be read by the same one.
    pub fn of_thread() -> Self {
        Self::new(Whose::Thread)
    }

    /// CPU time of the process, all threads.
    pub fn of_process() -> Self {
        Self::new(Whose::Process)
    }

    fn new(whose: Whose) -> Self {
        Self { whose, cpu: cpu_seconds(whose), wall: Instant::now() }
    }

    /// Seconds of CPU time since it was made, wall time where the system does not tell.
    pub fn seconds(&self) -> f64 {
        let cpu = cpu_seconds(self.whose).zip(self.cpu).map(|(now, then)| now - then);
        cpu.unwrap_or_else(|| self.wall.elapsed().as_secs_f64())
    }
}

#[cfg(unix)]
fn cpu_seconds(whose: Whose) -> Option<f64> {
    let id = match whose {
        Whose::Thread => rustix::time::ClockId::ThreadCPUTime,
        Whose::Process => rustix::time::ClockId::ProcessCPUTime,
    };
    let time = rustix::time::clock_gettime(id);
    Some(time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9)
}

#[cfg(not(unix))]
fn cpu_seconds(_: Whose) -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn sleeping_costs_nothing_and_work_does() {
        let watch = Stopwatch::of_thread();
        std::thread::sleep(std::time::Duration::from_millis(50));
        let asleep = watch.seconds();
        assert!(asleep < 0.04, "{asleep}");
        let mut x = 0.5f64;
        while watch.seconds() < asleep + 0.01 {
            x = std::hint::black_box(x.sin());
        }
        assert!(Stopwatch::of_process().seconds() >= 0.0);
    }
}
