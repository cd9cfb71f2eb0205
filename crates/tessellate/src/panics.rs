//! Panics become issues: a fault of this program costs one face or edge, not the job, and the message
//! requests a bug report.

use chordal_brep::MeshIssue;
use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind};

thread_local! {
    /// Where this thread last panicked.
    static LOCATION: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Remembers where a panic happened, so that the [`MeshIssue::InternalError`] that comes of it can say so.
/// The panic hook of a program may call this; the library sets no hook itself, since that would change the
/// whole process.
pub fn remember_panic(info: &PanicHookInfo<'_>) {
    let location = info.location().map(|place| format!("{}:{}", place.file(), place.line()));
    LOCATION.with_borrow_mut(|last| *last = location);
}

/// Does the work; this is the one place where a panic is caught.
///
/// # Errors
/// Where the work panicked.
pub(crate) fn caught<T>(work: impl FnOnce() -> T) -> Result<T, MeshIssue> {
    LOCATION.with_borrow_mut(|last| *last = None);
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| MeshIssue::InternalError {
        message: text(&*payload),
        location: LOCATION.with_borrow_mut(Option::take),
    })
}

/// The text of a panic, where it has one.
fn text(payload: &(dyn Any + Send)) -> String {
    let owned = payload.downcast_ref::<String>().cloned();
    let text = owned.or_else(|| payload.downcast_ref::<&str>().map(|&text| text.to_owned()));
    text.unwrap_or_else(|| "a panic without a text".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn issue_of(work: impl FnOnce()) -> MeshIssue {
        caught(work).expect_err("the work panics")
    }

    #[test]
    fn a_panic_keeps_its_text() {
        let message = |issue: MeshIssue| match issue {
            MeshIssue::InternalError { message, .. } => message,
            other => panic!("{other}"),
        };
        assert_eq!(message(issue_of(|| panic!("plain"))), "plain");
        assert_eq!(message(issue_of(|| panic!("with {}", 1))), "with 1");
        assert_eq!(message(issue_of(|| std::panic::panic_any(7))), "a panic without a text");
        let empty: Vec<u32> = Vec::new();
        let sentence = issue_of(|| assert_eq!(std::hint::black_box(&empty)[3], 0)).to_string();
        assert!(sentence.contains("index out of bounds") && sentence.contains("report it"), "{sentence}");
        assert_eq!(caught(|| 5), Ok(5));
    }
}
