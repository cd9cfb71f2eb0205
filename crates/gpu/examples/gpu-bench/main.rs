//! `gpu-bench`: what the adapter that is there can do, and one core of the host.
//!
//! Prints tables in Markdown; docs/gpu.md says how to run it, docs/results/gpu_*.md keep what it printed.

mod evaluation;
mod frames;
mod host;
mod host_grid;
mod host_peaks;
mod memory;
mod scene;
mod time;

use chordal_gpu::{DeviceChoice, Gpu, GpuError};
use std::path::PathBuf;

/// One part of what can be measured.
struct Section {
    name: &'static str,
    summary: &'static str,
    run: fn(&Gpu) -> Result<(), GpuError>,
}

const SECTIONS: &[Section] = &[
    Section { name: "single", summary: "one surface, grids 8² to 1024²", run: evaluation::single },
    Section { name: "batched", summary: "10,000 surfaces in one dispatch", run: evaluation::batched },
    Section { name: "scattered", summary: "lists of (u, v), sorted and not", run: evaluation::scattered },
    Section { name: "curves", summary: "one curve", run: evaluation::curves },
    Section { name: "memory", summary: "grid points against copies", run: memory::against_copies },
    Section {
        name: "mesher",
        summary: "jets in double precision, as `chordal mesh` asks",
        run: evaluation::mesher,
    },
    Section { name: "surfaces", summary: "frames against the number of surfaces", run: frames::by_surfaces },
    Section {
        name: "placements",
        summary: "frames against the number of placements of one part",
        run: frames::by_placements,
    },
    Section { name: "grids", summary: "frames against the size of grids", run: frames::by_grids },
];

const USAGE: &str = "usage: gpu-bench [SECTION…]            all sections, or these
       gpu-bench --scene N FILE      writes the scene of N surfaces as text, for tools/glu_bench.c
sections:
  host        one core of the host (needs no device)";

fn main() -> std::process::ExitCode {
    match run() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(sentence) => {
            eprintln!("gpu-bench: {sentence}");
            std::process::ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, count, path] = &arguments[..]
        && flag == "--scene"
    {
        let count = count.parse().map_err(|_| format!("{count} is no number of surfaces"))?;
        let text = scene::Scenario::new(count).to_text();
        return std::fs::write(PathBuf::from(path), text).map_err(|e| format!("{path}: {e}"));
    }
    let known = |name: &String| name == "host" || SECTIONS.iter().any(|s| s.name == name);
    if !arguments.iter().all(known) {
        let lines = SECTIONS.iter().map(|s| format!("\n  {:<12}{}", s.name, s.summary));
        return Err(format!("{USAGE}{}", lines.collect::<String>()));
    }
    let wanted = |name: &str| arguments.is_empty() || arguments.iter().any(|a| a == name);
    let sentence = |error: GpuError| error.to_string();
    if wanted("host") {
        host::one_core().map_err(sentence)?;
    }
    if arguments.iter().all(|a| a == "host") && !arguments.is_empty() {
        return Ok(());
    }
    let gpu = Gpu::open(DeviceChoice::Best).map_err(sentence)?;
    let kind = if gpu.is_software() { ", a program on the CPU: **no figure of a GPU**" } else { "" };
    println!("\nAdapter: {}{kind}\n", gpu.name());
    SECTIONS.iter().filter(|s| wanted(s.name)).try_for_each(|s| (s.run)(&gpu)).map_err(sentence)
}
