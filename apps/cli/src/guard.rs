//! The last resort: a panic becomes one sentence and exit code 2, never a backtrace and 101.

use std::any::Any;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind};
use std::sync::Mutex;

/// Where problems are reported.
const ISSUES: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/issues");

/// Where the latest panic happened.
static PLACE: Mutex<Option<String>> = Mutex::new(None);

/// Runs `work`; a panic becomes an error with one sentence.
///
/// # Errors
/// Where `work` panicked.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let place = PLACE.lock().ok().and_then(|mut place| place.take());
        let place = place.map_or_else(String::new, |place| format!(" ({place})"));
        format!("internal error, please report it at {ISSUES}: {}{place}", text(&*panic))
    })
}

/// Replaces the message of the panic hook: whoever catches a panic reports it. The place is kept for that.
pub fn record_panics() {
    std::panic::set_hook(Box::new(|info: &PanicHookInfo<'_>| {
        if let (Ok(mut place), Some(at)) = (PLACE.lock(), info.location()) {
            *place = Some(format!("{}:{}", at.file(), at.line()));
        }
        chordal::tessellate::remember_panic(info);
    }));
}

fn text(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "a panic without a message".into()).replace('\n', " ")
}
