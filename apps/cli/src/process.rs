//! What the operating system gives the program: threads, memory.

/// Deep models recurse deeply, in readers above all.
const STACK: usize = 16 << 20;

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
