//! One core of the host against what binds it.

use crate::evaluation::{PAPER, surface};
use crate::host_grid::HostSurface;
use crate::host_peaks::host_peaks;
use chordal_gpu::{GpuError, SurfaceSet};
use std::time::Instant;

/// Runs of which the best counts.
const RUNS: usize = 200;

/// One patch, and the paper's surface of 9 × 9 spans.
pub fn one_core() -> Result<(), GpuError> {
    println!(
        "One core, 1024² points of a rational bicubic surface, f64, rows that stay in the cache; 12 \
         multiply-adds and"
    );
    println!("one division a point:\n");
    for (name, side) in [("one span", 4), ("9 × 9 spans", PAPER)] {
        // Next to each other, so that both see the same clock.
        let peaks = host_peaks();
        let rate = rate(side, 1024, RUNS)? * 1e-9;
        let limits = [
            (peaks.multiply_adds / 12.0, "multiply-adds alone"),
            (peaks.divisions, "divisions alone"),
            (peaks.both, "both in this proportion"),
        ];
        println!("- {name}: **{rate:.3} Gpoints/s**");
        for (limit, what) in limits {
            let limit = limit * 1e-9;
            println!("  - {what} allow {limit:.3} Gpoints/s: {:.0} %", 100.0 * rate / limit);
        }
    }
    Ok(())
}

/// Points a second of a grid of `count`² on a surface of `side`² control points.
pub fn rate(side: usize, count: usize, runs: usize) -> Result<f64, GpuError> {
    let spread: Vec<f64> = (0..count).map(|k| k as f64 / (count - 1) as f64).collect();
    let mut set = SurfaceSet::<f64>::with_bezier();
    set.push_surface(&surface(1, side));
    let ready = HostSurface::new(&set, 0)?;
    let (mut best, mut sum) = (f64::INFINITY, 0.0);
    for _ in 0..runs {
        let started = Instant::now();
        ready.grid(&spread, &spread, |_, [x, y, z]| sum += x[0] + y[count / 2] + z[count - 1]);
        best = best.min(started.elapsed().as_secs_f64());
    }
    std::hint::black_box(sum);
    Ok((count * count) as f64 / best)
}
