//! The last resort: a panic becomes one sentence and exit code 2, never a backtrace and 101.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `work`; a panic becomes an error with one sentence.
///
/// # Errors
/// Where `work` panicked.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work))
        .map_err(|panic| format!("internal error, please report it: {}", text(&*panic)))
}

/// Silences the panic hook: what a panic has to say is said by whoever catches it.
pub fn silence() {
    std::panic::set_hook(Box::new(|_| ()));
}

fn text(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "a panic without a message".into()).replace('\n', " ")
}
