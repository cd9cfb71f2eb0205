//! Wall time. The browser's bare WebAssembly target has no clock: every time is zero there.

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
use std::time::Instant;

/// Seconds since it was started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    started: Instant,
}

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
impl Clock {
    pub fn start() -> Self {
        Self { started: Instant::now() }
    }
    pub fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
impl Clock {
    pub fn start() -> Self {
        Self {}
    }
    pub fn seconds(&self) -> f64 {
        0.0
    }
}
