//! `gpu-bench`: points a second of every kernel on the adapter that is there, and of one core of the host.
//!
//! Prints tables in Markdown; docs/gpu.md says how to run it and keeps what it printed.

use chordal_gpu::{
    DeviceChoice, Evaluator, Gpu, GpuError, HostSurface, OnDevice, Request, Samples, Search, SurfaceSet,
    Variant, Wanted, host_peaks, sorted_by_span,
};
use chordal_nurbs::{DVec2, DVec3, NurbsCurve3, NurbsSurface};
use std::time::{Duration, Instant};

/// Control points along each side of the paper's surface.
const PAPER: usize = 12;
/// No measurement goes on for longer.
const PATIENCE: Duration = Duration::from_millis(1500);

fn main() -> std::process::ExitCode {
    match run() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("gpu-bench: {error}");
            std::process::ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), GpuError> {
    host()?;
    if std::env::args().any(|a| a == "host") {
        return Ok(());
    }
    let gpu = Gpu::open(DeviceChoice::Best)?;
    let kind = if gpu.is_software() { ", a program on the CPU: no figure of a GPU" } else { "" };
    println!("\nAdapter: {}{kind}\n", gpu.name());
    single(&gpu)?;
    batched(&gpu)?;
    scattered(&gpu)?;
    curves(&gpu)
}

/// A rational bicubic surface of n × n control points.
fn surface(seed: usize, n: usize) -> NurbsSurface {
    let mut knots = vec![0.0; 4];
    knots.extend((1..n - 3).map(|k| k as f64 / (n - 3) as f64));
    knots.extend([1.0; 4]);
    let wave = |k: usize| ((k * 7919 + seed * 104_729) % 1000) as f64 / 1000.0;
    let points = (0..n * n).map(|k| DVec3::new((k / n) as f64, (k % n) as f64, wave(k))).collect();
    let weights = (0..n * n).map(|k| 0.5 + wave(k + 31)).collect();
    NurbsSurface::new([3, 3], knots.clone(), knots, points, Some(weights)).expect("knots and net fit")
}

/// One core of the host against what binds it: one patch, and the paper's surface of 9 × 9 spans.
fn host() -> Result<(), GpuError> {
    let spread: Vec<f64> = (0..1024).map(|k| f64::from(k) / 1023.0).collect();
    println!("One core, 1024² points of a rational bicubic surface, f64, rows that stay in the cache:\n");
    for (name, side) in [("one span", 4), ("9 × 9 spans", PAPER)] {
        let mut set = SurfaceSet::<f64>::with_bezier();
        set.push_surface(&surface(1, side));
        let ready = HostSurface::new(&set, 0)?;
        let peaks = host_peaks();
        let (mut best, mut sum) = (f64::INFINITY, 0.0);
        for _ in 0..200 {
            let started = Instant::now();
            ready.grid(&spread, &spread, |_, [x, _, z]| sum += x[7] + z[1000]);
            best = best.min(started.elapsed().as_secs_f64());
        }
        std::hint::black_box(sum);
        let rate = f64::from(1024 * 1024) / best * 1e-9;
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

/// The shortest of several runs of `work`, which waits for the device; the first one warms up.
fn seconds(mut work: impl FnMut() -> Result<(), GpuError>) -> Result<f64, GpuError> {
    work()?;
    let (began, mut best) = (Instant::now(), f64::INFINITY);
    for _ in 0..20 {
        let started = Instant::now();
        work()?;
        best = best.min(started.elapsed().as_secs_f64());
        if began.elapsed() > PATIENCE {
            break;
        }
    }
    Ok(best)
}

/// Points a second in millions: with all data on the device, and with everything uploaded each time.
fn rates(
    gpu: &Gpu,
    variant: Variant,
    set: &SurfaceSet<f32>,
    samples: &Samples<f32>,
    wanted: Wanted,
) -> Result<[f64; 2], GpuError> {
    let evaluator = Evaluator::new(gpu, variant, Search::Host)?;
    let on_device = OnDevice::upload(gpu, set)?;
    let evaluation = evaluator.prepare(gpu, &on_device, set, samples, wanted)?;
    let resident = seconds(|| {
        evaluator.run(gpu, &evaluation)?;
        gpu.wait()
    })?;
    let uploaded = seconds(|| {
        let on_device = OnDevice::upload(gpu, set)?;
        let evaluation = evaluator.prepare(gpu, &on_device, set, samples, wanted)?;
        evaluator.run(gpu, &evaluation)?;
        gpu.wait()
    })?;
    Ok([resident, uploaded].map(|s| samples.len() as f64 / s * 1e-6))
}

fn table(
    gpu: &Gpu,
    title: &str,
    cases: &[(String, SurfaceSet<f32>, Samples<f32>)],
    wanted: Wanted,
) -> Result<(), GpuError> {
    println!("{title}, million points a second (resident / uploaded):\n");
    println!("| | {} |", Variant::ALL.map(Variant::name).join(" | "));
    println!("|---|{}", "---|".repeat(Variant::ALL.len()));
    for (name, set, samples) in cases {
        let mut line = format!("| {name} |");
        for variant in Variant::ALL {
            line += &match rates(gpu, variant, set, samples, wanted) {
                Ok([resident, uploaded]) => format!(" {resident:.2} / {uploaded:.2} |"),
                Err(GpuError::TooLarge { .. }) => " beyond a binding |".into(),
                Err(error) => return Err(error),
            };
        }
        println!("{line}");
    }
    println!();
    Ok(())
}

fn single(gpu: &Gpu) -> Result<(), GpuError> {
    for (title, wanted) in [
        ("One surface, points", Wanted::Points),
        ("One surface, points, first derivatives, normals", Wanted::First),
    ] {
        let mut cases = Vec::new();
        for side in [8, 16, 32, 64, 128, 256, 512, 1024] {
            let mut set = SurfaceSet::with_bezier();
            set.push_surface(&surface(1, PAPER));
            let samples = Samples::new(&set, &[Request::even_grid(&set, 0, side, side)])?;
            cases.push((format!("{side}²"), set, samples));
        }
        table(gpu, title, &cases, wanted)?;
    }
    Ok(())
}

fn batched(gpu: &Gpu) -> Result<(), GpuError> {
    let mut set = SurfaceSet::with_bezier();
    for seed in 0..10_000 {
        set.push_surface(&surface(seed, 4));
    }
    let mut cases = Vec::new();
    for side in [8, 16, 32] {
        let requests: Vec<_> = (0..set.len()).map(|i| Request::even_grid(&set, i, side, side)).collect();
        cases.push((format!("{side}² each"), set.clone(), Samples::new(&set, &requests)?));
    }
    table(gpu, "10,000 patches of 4 × 4 control points in one dispatch, points", &cases, Wanted::Points)
}

fn scattered(gpu: &Gpu) -> Result<(), GpuError> {
    let mut set = SurfaceSet::with_bezier();
    set.push_surface(&surface(1, PAPER));
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let uvs: Vec<DVec2> = (0..1 << 18).map(|_| DVec2::new(random(), random())).collect();
    let sorted = sorted_by_span(&set, 0, &uvs).0;
    let mut cases = Vec::new();
    for (name, uvs) in [("262,144, any order", uvs), ("262,144, sorted by span", sorted)] {
        let samples = Samples::new(&set, &[Request::Points { surface: 0, uvs }])?;
        cases.push((name.into(), set.clone(), samples));
    }
    table(gpu, "Scattered (u, v)", &cases, Wanted::Points)
}

fn curves(gpu: &Gpu) -> Result<(), GpuError> {
    // The knots of the paper's example.
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.1, 0.1, 0.5, 1.0, 1.0, 1.0, 1.0];
    let points = (0..7).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 5), 1.0)).collect();
    let curve = NurbsCurve3::new(3, knots, points, None).expect("knots and points fit");
    let mut cases = Vec::new();
    for count in [100, 10_000, 1_000_000] {
        let mut set = SurfaceSet::with_bezier();
        set.push_curve(&curve);
        let ts = (0..count).map(|k| f64::from(k) / f64::from(count - 1)).collect();
        let samples = Samples::new(&set, &[Request::curve(0, ts)])?;
        cases.push((format!("{count}"), set, samples));
    }
    table(gpu, "One cubic curve", &cases, Wanted::Points)
}
