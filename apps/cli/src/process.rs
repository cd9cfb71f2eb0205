//! Resources of the operating system: threads, memory.

/// The stack of every thread, in bytes. Readers follow nested entities by recursion, to depths that they
/// limit. The main thread of Windows has 1 MiB, which is too small for these limits.
const STACK: usize = 16 << 20;

/// Runs `work` in a thread with a stack that is deep enough for every reader.
///
/// # Errors
/// One sentence if the system refuses the thread.
pub fn with_deep_stack<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let failed = |e: std::io::Error| format!("cannot start a thread: {e}");
    std::thread::scope(|scope| {
        let thread =
            std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work).map_err(failed)?;
        thread.join().map_err(|_| "internal error: the main thread stopped".into())
    })
}

/// A pool of `threads` threads, or of one per core.
///
/// # Errors
/// One sentence where the system refuses the threads.
pub fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool, String> {
    let number = threads.map_or_else(|| "the".to_owned(), |n| n.to_string());
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .stack_size(STACK)
        .build()
        .map_err(|e| format!("cannot start {number} worker threads: {e}"))
}

/// The largest resident memory so far, in bytes, if the system provides it.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}
