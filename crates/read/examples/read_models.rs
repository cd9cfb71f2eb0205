//! Reads files and prints what they hold: `cargo run --release --example read_models -- FILE…`; the time is
//! the best of `REPEATS` (1 unless set).

use chordal_brep::FaceGeometry;
use std::time::Instant;

fn main() {
    let repeats: u32 = std::env::var("REPEATS").ok().and_then(|n| n.parse().ok()).unwrap_or(1);
    for path in std::env::args().skip(1) {
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                eprintln!("{path}: {error}");
                continue;
            }
        };
        let mut seconds = f64::INFINITY;
        let mut read = || {
            let start = Instant::now();
            let model = chordal_read::read_bytes(
                &bytes,
                None,
                &chordal_read::ReadOptions::default().with_name(&*path),
            );
            seconds = seconds.min(start.elapsed().as_secs_f64());
            model
        };
        let peak = peak_megabytes();
        for _ in 1..repeats {
            let _ = read();
        }
        let model = match read() {
            Ok(model) => model,
            Err(error) => {
                println!("{path}: {error}");
                continue;
            }
        };
        let failed: Vec<_> = model
            .parts
            .iter()
            .flat_map(|part| &part.faces)
            .filter_map(|face| match &face.geometry {
                FaceGeometry::Failed(reason) => Some(reason),
                FaceGeometry::Surface(_) => None,
            })
            .collect();
        println!(
            "{path}: {} | {} | parts {} nodes {} roots {} | placed faces {} failed {} | warnings {} | {:.1} \
             ms, {:.0} MB/s | peak {} MB ({} before)",
            model.schema,
            model.unit,
            model.parts.len(),
            model.nodes.len(),
            model.roots.len(),
            model.placed_faces(),
            failed.len(),
            model.issues.len(),
            seconds * 1e3,
            bytes.len() as f64 / 1e6 / seconds,
            peak_megabytes(),
            peak,
        );
        for reason in failed.iter().take(5) {
            println!("    failed: {reason}");
        }
        for warning in model.issues.iter().take(8) {
            println!("    {warning}");
        }
    }
}

/// The largest memory that the process ever held, from the system's accounts where they exist.
fn peak_megabytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok()).map_or(0, |kb| kb / 1024)
}
