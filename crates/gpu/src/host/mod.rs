//! Evaluation on one core of the host, and what binds it.

mod grid;
mod peaks;

pub use grid::{HIGHEST_DEGREE, HostSurface};
pub use peaks::{HostPeaks, host_peaks};
