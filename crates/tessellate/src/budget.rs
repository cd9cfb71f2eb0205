//! How long a face or an edge may be worked at: a limit of work, which is the same on every machine, and a
//! limit of time as the last guard.
//!
//! A timeout of one second allows the work of one second on an ordinary core
//! ([`work::UNITS_PER_SECOND`]). What is given up for that reason is given up everywhere. Only work that
//! takes longer than [`SLOWER`] times its nominal time is given up by the clock: on a machine that is much
//! slower, or in a step that counts too little.
//!
//! A [`FileBudget`] is the work that all faces and edges of a file may take together. Threads draw from it in
//! any order, so where it is spent, the results of single faces mean nothing: the caller meshes everything
//! anew with less for each.

use crate::clock::{Deadline, Stopwatch};
use chordal_nurbs::work;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// The clock ends work that takes this many times its nominal time.
const SLOWER: f64 = 1.5;

/// The clock is looked at once in this much work: twenty microseconds cost nothing beside a tenth of one.
const WORK_PER_LOOK: u64 = 20_000;

/// Looks at the budget count as this much work, so that loops that count nothing come to look at the clock.
const LOOK: u64 = 1_000;

/// The units of work of a time at the nominal speed.
fn units(time: Duration) -> u64 {
    (time.as_secs_f64() * work::UNITS_PER_SECOND) as u64
}

/// What all faces and edges of a file may take together; clones draw from the same.
#[derive(Clone, Debug)]
pub struct FileBudget {
    most_units: u64,
    most_triangles: u64,
    taken: Arc<Taken>,
}

#[derive(Debug, Default)]
struct Taken {
    units: AtomicU64,
    triangles: AtomicU64,
}

impl FileBudget {
    /// The work of this time at the nominal speed (`None`: unlimited), and this many triangles and chords.
    pub fn new(time: Option<Duration>, triangles: usize) -> Self {
        let most_units = time.map_or(u64::MAX, units);
        Self { most_units, most_triangles: triangles as u64, taken: Arc::default() }
    }

    /// True where faces and edges took all of it: some may have been given up only for that reason.
    pub fn is_spent(&self) -> bool {
        self.units_left() == 0 || self.taken.triangles.load(Ordering::Relaxed) >= self.most_triangles
    }

    /// The work that was taken, as seconds at the nominal speed.
    pub fn seconds_taken(&self) -> f64 {
        self.taken.units.load(Ordering::Relaxed) as f64 / work::UNITS_PER_SECOND
    }

    /// None where nothing more is worth doing.
    fn units_left(&self) -> u64 {
        self.most_units.saturating_sub(self.taken.units.load(Ordering::Relaxed))
    }

    fn take_units(&self, units: u64) {
        self.taken.units.fetch_add(units, Ordering::Relaxed);
    }

    fn take_triangles(&self, triangles: u64) {
        self.taken.triangles.fetch_add(triangles, Ordering::Relaxed);
    }
}

/// What one face or edge took so far, in all attempts and rounds.
#[derive(Debug, Default)]
pub(crate) struct Spent {
    units: AtomicU64,
    nanoseconds: AtomicU64,
    /// The most triangles or chords that it had so far.
    triangles: AtomicU64,
}

impl Spent {
    /// Runs one piece of the work within the remaining budget. The budget belongs to the thread that calls
    /// this.
    pub fn within<T>(
        &self,
        timeout: Option<Duration>,
        file: Option<&FileBudget>,
        work_on: impl FnOnce(Budget) -> T,
    ) -> T {
        let (watch, before) = (Stopwatch::of_thread(), work::done());
        let result = work::limited(self.units_left(timeout, file), || {
            let budget = Budget { clock: self.time_left(timeout).and_then(Deadline::after) };
            work_on(budget)
        });
        let done = work::done() - before;
        self.units.fetch_add(done, Ordering::Relaxed);
        self.nanoseconds.fetch_add((1e9 * watch.seconds()) as u64, Ordering::Relaxed);
        if let Some(file) = file {
            file.take_units(done);
        }
        result
    }

    /// Notes how many triangles or chords the last piece of the work made.
    pub fn made(&self, triangles: usize, file: Option<&FileBudget>) {
        // The largest number counts: sums do not depend on the order of threads then.
        let before = self.triangles.fetch_max(triangles as u64, Ordering::Relaxed);
        if let Some(file) = file {
            file.take_triangles((triangles as u64).saturating_sub(before));
        }
    }

    fn units_left(&self, timeout: Option<Duration>, file: Option<&FileBudget>) -> u64 {
        let own = timeout.map(|t| units(t).saturating_sub(self.units.load(Ordering::Relaxed)));
        let of_file = file.map(|file| if file.is_spent() { 0 } else { file.units_left() });
        [own, of_file].into_iter().flatten().min().unwrap_or(u64::MAX)
    }

    fn time_left(&self, timeout: Option<Duration>) -> Option<Duration> {
        let taken = Duration::from_nanos(self.nanoseconds.load(Ordering::Relaxed));
        timeout.map(|t| t.mul_f64(SLOWER).saturating_sub(taken))
    }
}

/// When work on one thread is given up: where it reaches the limit of [`work`], or its time is over.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Budget {
    clock: Option<Deadline>,
}

impl Budget {
    /// True from the moment on at which the work is to be given up; for the thread that began it. Cheap
    /// enough for every step of a loop.
    pub fn is_over(self) -> bool {
        let before = work::done();
        work::count(LOOK);
        let is_time_to_look = before / WORK_PER_LOOK != (before + LOOK) / WORK_PER_LOOK;
        if is_time_to_look && self.clock.is_some_and(Deadline::is_over) {
            work::give_up();
        }
        work::is_over()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_ends_a_budget_and_adds_up() {
        let time = |units: f64| Duration::from_secs_f64(units / work::UNITS_PER_SECOND);
        let (spent, file) = (Spent::default(), FileBudget::new(Some(time(3e6)), 100));
        let most = time(2e6);
        let steps = |budget: Budget| {
            (0..).take_while(|_| !budget.is_over()).inspect(|_| work::count(100_000)).count()
        };
        let first = spent.within(Some(most), Some(&file), |budget| {
            work::count(1_000_000);
            budget.is_over()
        });
        assert!(!first && !file.is_spent());
        assert_eq!(spent.within(Some(most), Some(&file), steps), 10);
        assert_eq!(spent.within(Some(most), Some(&file), steps), 0);
        assert_eq!(Spent::default().within(Some(most), Some(&file), steps), 10);
        assert!(file.is_spent());
        let file = FileBudget::new(None, 100);
        spent.made(99, Some(&file));
        spent.made(60, Some(&file));
        assert!(!file.is_spent());
        Spent::default().made(1, Some(&file));
        assert!(file.is_spent());
        assert!(!Budget::default().is_over());
    }

    #[test]
    fn the_clock_ends_what_counts_no_work() {
        let steps = Spent::default().within(Some(Duration::from_millis(20)), None, |budget| {
            (0..).take_while(|_| !budget.is_over()).inspect(|_| spin(Duration::from_micros(500))).count()
        });
        assert!((10..=110).contains(&steps), "{steps}");
    }

    fn spin(time: Duration) {
        let watch = Stopwatch::of_thread();
        while watch.seconds() < time.as_secs_f64() {
            std::hint::black_box(watch);
        }
    }
}
