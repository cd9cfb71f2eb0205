//! How much work a thread has done, as a count that does not depend on the speed of the machine.
//!
//! Limits of time that count seconds make results depend on the machine and on what else it does. Evaluations
//! and bounds count themselves here instead; loops beside them count their steps with [`count`]. A unit
//! takes one to four nanoseconds on a core of 2022; [`UNITS_PER_SECOND`] converts one into the other.
//!
//! [`limited`] sets a limit for a piece of work. Loops that may take long look at [`is_over`] and end early
//! with an incomplete result. Whoever set the limit calls [`is_over`] at the end and discards the result if
//! true.
//!
//! Count and limit belong to the thread. They are meant for work that stays on one thread from beginning to
//! end.

use std::cell::Cell;

/// The units of a second on an ordinary core: a nominal speed, by which limits in seconds become limits of
/// work.
pub const UNITS_PER_SECOND: f64 = 4e8;

thread_local! {
    static DONE: Cell<u64> = const { Cell::new(0) };
    /// The count at which the work on this thread is to end.
    static END: Cell<u64> = const { Cell::new(u64::MAX) };
}

/// Adds to the work of this thread.
#[inline]
pub fn count(units: u64) {
    DONE.set(DONE.get().wrapping_add(units));
}

/// The units of this many products in a row: the processor takes several at once, and half of a square of
/// basis functions is zero. Measured on faces of degree 100.
#[inline]
pub(crate) const fn products(number: usize) -> u64 {
    (number as u64 * 2).div_ceil(5)
}

/// What this thread has done so far. The difference of two calls is the work between them.
#[inline]
pub fn done() -> u64 {
    DONE.get()
}

/// Runs something within this many units, and within the remainder of an enclosing limit. What it
/// returns means nothing where [`is_over`] is true at its end.
pub fn limited<T>(units: u64, work_on: impl FnOnce() -> T) -> T {
    struct Restore(u64);
    impl Drop for Restore {
        fn drop(&mut self) {
            END.set(self.0);
        }
    }
    let _outer = Restore(END.get());
    END.set(END.get().min(done().saturating_add(units)));
    work_on()
}

/// True where the work on this thread has reached its limit.
#[inline]
pub fn is_over() -> bool {
    DONE.get() >= END.get()
}

/// Lets the innermost limit of this thread be reached now.
pub fn give_up() {
    END.set(0);
}

/// Does something that counts as no work: something found once and kept, which threads share. Whichever needs
/// it first would pay for it.
pub fn uncounted<T>(find: impl FnOnce() -> T) -> T {
    let before = DONE.get();
    let found = find();
    DONE.set(before);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures;
    use glam::DVec2;

    #[test]
    fn the_same_evaluations_count_the_same_on_every_thread() {
        let surface = crate::Surface::Nurbs(fixtures::nurbs_surface());
        let work = || {
            let before = done();
            for i in 0..100 {
                std::hint::black_box(surface.point(DVec2::splat(f64::from(i) / 100.0)));
            }
            done() - before
        };
        let here = work();
        assert!(here > 100 && here == work());
        assert_eq!(std::thread::scope(|s| s.spawn(work).join().expect("the thread ends")), here);
        let before = done();
        uncounted(work);
        assert_eq!(done(), before);
    }

    #[test]
    fn limits_nest_and_end() {
        let steps = || (0..1000).take_while(|_| !is_over()).inspect(|_| count(10)).count();
        assert_eq!(limited(100, steps), 10);
        assert_eq!(limited(100, || [limited(50, steps), limited(1000, steps)]), [5, 5]);
        assert_eq!(steps(), 1000);
        limited(100, || {
            give_up();
            assert!(is_over());
        });
        assert!(!is_over());
    }
}
