//! The threads that read, mesh and write.
//!
//! A process that was forked has none of its parent's threads, so a pool belongs to the process that made it.

use pyo3::PyResult;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::ptr;
use std::sync::Arc;
use std::sync::atomic::{AtomicPtr, Ordering};

/// Deep models recurse deeply, in readers above all.
const STACK: usize = 16 << 20;

/// The pool of a process. It lives as long as the process: a pool of the parent cannot be ended by the child.
struct Owned {
    process: u32,
    pool: Arc<ThreadPool>,
}

static SHARED: AtomicPtr<Owned> = AtomicPtr::new(ptr::null_mut());

/// The pool of this process, or one of `threads` threads for one job.
///
/// # Errors
/// Where the number is out of range, or the system refuses the threads.
pub fn pool(threads: Option<usize>) -> PyResult<Arc<ThreadPool>> {
    match threads {
        None => shared(),
        Some(threads @ 1..=1024) => started(threads),
        Some(_) => Err(crate::errors::request("threads: the number of threads must be from 1 to 1024")),
    }
}

fn started(threads: usize) -> PyResult<Arc<ThreadPool>> {
    let builder = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK);
    let pool = builder.thread_name(|i| format!("chordal-{i}")).build();
    pool.map(Arc::new).map_err(|e| crate::errors::internal(&format!("cannot start worker threads: {e}")))
}

/// No lock: a fork in another thread could leave it locked for ever in the child.
#[allow(unsafe_code, reason = "one pointer that is shared without a lock")]
fn shared() -> PyResult<Arc<ThreadPool>> {
    let process = std::process::id();
    let before = SHARED.load(Ordering::Acquire);
    // SAFETY: the pointer is null, or comes from `Box::leak` below and is never freed.
    if let Some(owned) = unsafe { before.as_ref() }
        && owned.process == process
    {
        return Ok(owned.pool.clone());
    }
    let made = Box::into_raw(Box::new(Owned { process, pool: started(0)? }));
    match SHARED.compare_exchange(before, made, Ordering::AcqRel, Ordering::Acquire) {
        // SAFETY: `made` is never freed once it is shared.
        Ok(_) => Ok(unsafe { &*made }.pool.clone()),
        Err(_) => {
            // SAFETY: nobody else has seen `made`.
            drop(unsafe { Box::from_raw(made) });
            shared()
        }
    }
}
