//! `chordal bench`: CPU seconds of reading and meshing in process, for comparison with other kernels.

use crate::args::BenchArgs;
use crate::exit::{Exit, print, say};
use crate::messages::error_sentence;
use crate::process::thread_pool;
use chordal::{Cancel, Error, InputFormat, MeshOptions, Model, ReadOptions, stages};
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

/// One file.
#[derive(Debug, Serialize)]
struct Timing {
    input: String,
    bytes: u64,
    faces: usize,
    triangles: usize,
    /// In millimetres.
    tolerance: f64,
    /// One per repetition, in seconds: CPU time of all threads if the system provides it, else wall time.
    read: Vec<f64>,
    mesh: Vec<f64>,
    clock: &'static str,
}

pub fn run(args: &BenchArgs) -> Exit {
    let checked = args.accuracy.check_without_audit("chordal bench").and_then(|()| args.accuracy.check());
    if let Err(sentence) = checked {
        say(&sentence);
        return Exit::Nothing;
    }
    // One thread unless `--jobs` is given: the comparison is of work, not of cores.
    let options = args.accuracy.options();
    let pool = match thread_pool(Some(args.accuracy.jobs.unwrap_or(1))) {
        Ok(pool) => pool,
        Err(error) => {
            say(&error.to_string());
            return Exit::Nothing;
        }
    };
    if args.papers {
        return pool.install(|| papers(args, &options));
    }
    let mut timings = Vec::new();
    for input in &args.inputs {
        let read = args.accuracy.read_options();
        match pool
            .install(|| time(input, args.accuracy.input_format, &read, &options, args.warm, args.repeat))
        {
            Ok(timing) => timings.push(timing),
            Err(error) => say(&error_sentence(&input.display().to_string(), &error)),
        }
    }
    print(&(serde_json::to_string_pretty(&timings).expect("timings have string keys only") + "\n"));
    if timings.len() == args.inputs.len() { Exit::Clean } else { Exit::Nothing }
}

/// The tables of the paper, one object per model.
fn papers(args: &BenchArgs, options: &MeshOptions) -> Exit {
    let cancel = Cancel::default();
    let mut tables = Vec::new();
    for input in &args.inputs {
        match chordal::papers::paper_tables(input, options, &cancel) {
            Ok(found) => tables.push(found),
            Err(error) => say(&error.to_string()),
        }
    }
    print(&(serde_json::to_string_pretty(&tables).expect("tables have string keys only") + "\n"));
    if tables.len() == args.inputs.len() { Exit::Clean } else { Exit::Nothing }
}

fn time(
    input: &Path,
    format: Option<InputFormat>,
    read: &ReadOptions,
    options: &MeshOptions,
    warm: usize,
    repeat: usize,
) -> Result<Timing, Error> {
    let cancel = Cancel::default();
    let mut timing = Timing {
        input: input.display().to_string(),
        bytes: std::fs::metadata(input).map_or(0, |m| m.len()),
        faces: 0,
        triangles: 0,
        tolerance: 0.0,
        read: Vec::new(),
        mesh: Vec::new(),
        clock: if cpu_seconds().is_some() { "cpu" } else { "wall" },
    };
    let origin = Instant::now();
    let now = || cpu_seconds().unwrap_or_else(|| origin.elapsed().as_secs_f64());
    for round in 0..warm + repeat.max(1) {
        let started = now();
        let model = Model::open_with(input, format, read)?;
        let was_read = now();
        let resolved = stages::resolve(&model, options, &cancel)?;
        let parts = stages::mesh_parts(&model, &resolved, &cancel);
        let meshed = now();
        if round >= warm {
            timing.read.push(was_read - started);
            timing.mesh.push(meshed - was_read);
        }
        timing.tolerance = resolved.tolerance;
        timing.faces = model.face_count();
        timing.triangles =
            parts.iter().zip(&resolved.uses).map(|(p, u)| p.mesh.triangle_count() * u.instances).sum();
    }
    Ok(timing)
}

/// CPU time of this process, all threads, in seconds.
#[cfg(unix)]
fn cpu_seconds() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9)
}

#[cfg(not(unix))]
fn cpu_seconds() -> Option<f64> {
    None
}
