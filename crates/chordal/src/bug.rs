//! Panics of the stages: a bug in Chordal, given to the caller as an error.
//!
//! The mesher itself turns the panic of a face into that face's failure; this catches what happens between
//! the faces. On platforms that abort at a panic nothing is caught.

use crate::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `work`, whose values are dropped when it panics.
///
/// # Errors
/// Those of `work`, and [`Error::Bug`] where it panics.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        let message = text.unwrap_or_else(|| "a panic without a message".into()).replace('\n', " ");
        Err(Error::Bug { message })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_a_bug_and_an_error_stays_an_error() {
        let bug = guarded::<()>(|| panic!("index {} of {}", 3, 2)).expect_err("a panic");
        assert!(matches!(&bug, Error::Bug { message } if message == "index 3 of 2"), "{bug}");
        assert!(bug.to_string().contains("please report"));
        assert!(matches!(guarded::<()>(|| Err(Error::Cancelled)), Err(Error::Cancelled)));
    }
}
