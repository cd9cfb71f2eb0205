//! Time, where the platform has a clock: stopwatches of CPU time, and deadlines.
//!
//! On `wasm32-unknown-unknown` there is no clock and reading one panics. There every stopwatch shows zero and
//! no deadline passes.

use std::time::Duration;

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
fn now() -> Option<std::time::Instant> {
    Some(std::time::Instant::now())
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
fn now() -> Option<std::time::Instant> {
    None
}

/// Which time a stopwatch counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Thread,
    Process,
    Wall,
}

/// Seconds since it was made.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    kind: Kind,
    cpu: Option<f64>,
    wall: Option<std::time::Instant>,
}

impl Stopwatch {
    /// CPU time of this thread; it must be read by the same one. On a machine with other work, wall time
    /// would show how busy the machine is.
    pub fn of_thread() -> Self {
        Self::new(Kind::Thread)
    }

    /// CPU time of the process, all threads.
    pub fn of_process() -> Self {
        Self::new(Kind::Process)
    }

    /// Wall time.
    pub fn of_wall() -> Self {
        Self::new(Kind::Wall)
    }

    fn new(kind: Kind) -> Self {
        Self { kind, cpu: cpu_seconds(kind), wall: now() }
    }

    /// Seconds since it was made; wall time if the system provides no CPU time, zero where it has no
    /// clock.
    pub fn seconds(&self) -> f64 {
        let cpu = cpu_seconds(self.kind).zip(self.cpu).map(|(now, then)| now - then);
        cpu.unwrap_or_else(|| self.wall.map_or(0.0, |wall| wall.elapsed().as_secs_f64()))
    }
}

#[cfg(unix)]
fn cpu_seconds(kind: Kind) -> Option<f64> {
    let id = match kind {
        Kind::Thread => rustix::time::ClockId::ThreadCPUTime,
        Kind::Process => rustix::time::ClockId::ProcessCPUTime,
        Kind::Wall => return None,
    };
    let time = rustix::time::clock_gettime(id);
    Some(time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9)
}

#[cfg(not(unix))]
fn cpu_seconds(_: Kind) -> Option<f64> {
    None
}

/// When work is given up: after so much CPU time of the thread that made the deadline. Other work on the
/// machine does not count, so that it does not decide which faces are given up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    watch: Stopwatch,
    seconds: f64,
}

impl Deadline {
    /// This much of the thread's time from now; none where the platform has no clock.
    pub fn after(time: Duration) -> Option<Self> {
        now().map(|_| Self { watch: Stopwatch::of_thread(), seconds: time.as_secs_f64() })
    }

    /// True from that moment on; for the thread that made it.
    pub fn is_over(self) -> bool {
        self.watch.seconds() > self.seconds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;

    #[test]
    #[cfg(unix)]
    fn sleeping_costs_nothing_and_work_does() {
        let watch = Stopwatch::of_thread();
        let wall = Stopwatch::of_wall();
        std::thread::sleep(Duration::from_millis(50));
        let asleep = watch.seconds();
        assert!(asleep < 0.04, "{asleep}");
        assert!(wall.seconds() >= 0.05);
        let mut x = 0.5f64;
        while watch.seconds() < asleep + 0.01 {
            x = std::hint::black_box(math::sin(x));
        }
        assert!(Stopwatch::of_process().seconds() >= 0.0);
    }

    #[test]
    fn a_deadline_passes() {
        let deadline = Deadline::after(Duration::from_millis(5)).expect("this platform has a clock");
        assert!(!deadline.is_over());
        let watch = Stopwatch::of_thread();
        while watch.seconds() < 0.01 {
            std::hint::black_box(watch);
        }
        assert!(deadline.is_over());
        let later = Deadline::after(Duration::from_secs(1000)).expect("this platform has a clock");
        assert!(!later.is_over());
    }
}
