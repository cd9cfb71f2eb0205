//! How long work takes.

use chordal_gpu::GpuError;
use std::time::{Duration, Instant};

/// No measurement goes on for longer, unless one run does.
const PATIENCE: Duration = Duration::from_millis(600);
/// A first run above this does not include the compilation of a kernel.
const WARMING: Duration = Duration::from_secs(5);

/// The shortest of several runs of `work`, which waits for the device; the first one warms up.
pub fn seconds(mut work: impl FnMut() -> Result<(), GpuError>) -> Result<f64, GpuError> {
    let began = Instant::now();
    work()?;
    let mut best = began.elapsed().as_secs_f64();
    // Work that takes longer than a measurement may is repeated once at most.
    for k in 0..20 {
        if began.elapsed() > if k == 0 { WARMING } else { PATIENCE } {
            break;
        }
        let started = Instant::now();
        work()?;
        best = best.min(started.elapsed().as_secs_f64());
    }
    Ok(best)
}

/// 1234567 as 1,234,567.
pub fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
