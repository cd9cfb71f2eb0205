//! Points a second of every kernel.

use crate::host;
use crate::time::seconds;
use chordal_gpu::{
    Gpu, GpuError, KernelRunner, OnDevice, Request, Samples, Search, SurfaceSet, Variant, Wanted,
    sorted_by_span,
};
use chordal_nurbs::{DVec2, DVec3, NurbsCurve3, NurbsSurface};
use std::time::Instant;

/// Control points along each side of the paper's surface.
pub const PAPER: usize = 12;

/// A rational bicubic surface of n × n control points.
pub fn surface(seed: usize, n: usize) -> NurbsSurface {
    let mut knots = vec![0.0; 4];
    knots.extend((1..n - 3).map(|k| k as f64 / (n - 3) as f64));
    knots.extend([1.0; 4]);
    let wave = |k: usize| ((k * 7919 + seed * 104_729) % 1000) as f64 / 1000.0;
    let points = (0..n * n).map(|k| DVec3::new((k / n) as f64, (k % n) as f64, wave(k))).collect();
    let weights = (0..n * n).map(|k| 0.5 + wave(k + 31)).collect();
    NurbsSurface::new([3, 3], knots.clone(), knots, points, Some(weights)).expect("knots and net fit")
}

/// Points a second in millions: with all data on the device, and with everything uploaded each time.
pub fn rates(
    gpu: &Gpu,
    variant: Variant,
    set: &SurfaceSet<f32>,
    samples: &Samples<f32>,
    wanted: Wanted,
) -> Result<[f64; 2], GpuError> {
    let evaluator = KernelRunner::new(gpu, variant, Search::Host)?;
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

/// Prints a line a case and returns the best resident and uploaded rates of each, in points a second.
fn table(
    gpu: &Gpu,
    title: &str,
    cases: &[(String, SurfaceSet<f32>, Samples<f32>)],
    wanted: Wanted,
) -> Result<Vec<[f64; 2]>, GpuError> {
    println!("{title}, million points a second (resident / uploaded):\n");
    println!("| | {} |", Variant::ALL.map(Variant::name).join(" | "));
    println!("|---|{}", "---|".repeat(Variant::ALL.len()));
    let mut best = vec![[0.0_f64; 2]; cases.len()];
    for ((name, set, samples), best) in cases.iter().zip(&mut best) {
        let mut line = format!("| {name} |");
        for variant in Variant::ALL {
            line += &match rates(gpu, variant, set, samples, wanted) {
                Ok(rates) => {
                    *best = [0, 1].map(|k| best[k].max(rates[k] * 1e6));
                    format!(" {:.2} / {:.2} |", rates[0], rates[1])
                }
                Err(GpuError::TooLarge { .. }) => " beyond a binding |".into(),
                Err(error) => return Err(error),
            };
        }
        println!("{line}");
    }
    println!();
    Ok(best)
}

/// One surface of growing grids, and where the device begins to gain on one core of the host.
pub fn single(gpu: &Gpu) -> Result<(), GpuError> {
    const SIDES: [usize; 8] = [8, 16, 32, 64, 128, 256, 512, 1024];
    for (title, wanted) in [
        ("One surface of 12 × 12 control points, points", Wanted::Points),
        ("One surface, points and normals, as drawing asks", Wanted::Normals),
        ("One surface, points, first derivatives, normals", Wanted::First),
    ] {
        let mut cases = Vec::new();
        for side in SIDES {
            let mut set = SurfaceSet::with_bezier();
            set.push_surface(&surface(1, PAPER));
            let samples = Samples::new(&set, &[Request::even_grid(&set, 0, side, side)])?;
            cases.push((format!("{side}²"), set, samples));
        }
        let best = table(gpu, title, &cases, wanted)?;
        if wanted == Wanted::Points {
            against_host(&SIDES, &best)?;
        }
    }
    Ok(())
}

fn against_host(sides: &[usize], best: &[[f64; 2]]) -> Result<(), GpuError> {
    println!(
        "The best of these against one core of the host in double precision, million points a second:\n"
    );
    println!("| | host | resident / host | uploaded / host |");
    println!("|---|---|---|---|");
    for (&side, [resident, uploaded]) in sides.iter().zip(best) {
        let host = host::rate(PAPER, side, 100)?;
        println!("| {side}² | {:.0} | {:.3} | {:.3} |", host * 1e-6, resident / host, uploaded / host);
    }
    println!();
    Ok(())
}

/// Many small surfaces at once.
pub fn batched(gpu: &Gpu) -> Result<(), GpuError> {
    let mut set = SurfaceSet::with_bezier();
    for seed in 0..10_000 {
        set.push_surface(&surface(seed, 4));
    }
    let mut cases = Vec::new();
    for side in [8, 16, 32] {
        let requests: Vec<_> = (0..set.len()).map(|i| Request::even_grid(&set, i, side, side)).collect();
        cases.push((format!("{side}² each"), set.clone(), Samples::new(&set, &requests)?));
    }
    table(gpu, "10,000 patches of 4 × 4 control points in one dispatch, points", &cases, Wanted::Points)?;
    Ok(())
}

/// Lists of points.
pub fn scattered(gpu: &Gpu) -> Result<(), GpuError> {
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
    table(gpu, "Scattered (u, v)", &cases, Wanted::Points)?;
    Ok(())
}

/// One curve.
pub fn curves(gpu: &Gpu) -> Result<(), GpuError> {
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
    table(gpu, "One cubic curve", &cases, Wanted::Points)?;
    Ok(())
}

/// What `chordal mesh --device gpu` asks for: points, first and second derivatives in double precision, there
/// and back, against the host's own evaluator, point by point.
pub fn mesher(gpu: &Gpu) -> Result<(), GpuError> {
    if !gpu.has_f64() {
        println!("No double precision in shaders here: `chordal mesh` evaluates on the CPU.\n");
        return Ok(());
    }
    let surface = surface(1, PAPER);
    let evaluator = KernelRunner::<f64>::new(gpu, Variant::Bernstein, Search::Host)?;
    println!(
        "Point, first and second derivatives in f64 at scattered places of one surface, uploaded and read \
         back,"
    );
    println!("million a second:\n");
    println!("| points | device | one core |\n|---|---|---|");
    for count in [64, 1024, 4096, 16_384, 65_536, 262_144] {
        let uvs: Vec<DVec2> =
            (1..=count).map(|k| (DVec2::new(0.754_877, 0.569_84) * f64::from(k)).fract()).collect();
        let device = seconds(|| {
            let mut set = SurfaceSet::<f64>::with_bezier();
            set.push_surface(&surface);
            let samples = Samples::new(&set, &[Request::Points { surface: 0, uvs: uvs.clone() }])?;
            std::hint::black_box(evaluator.evaluate(gpu, &set, &samples, Wanted::Second)?);
            Ok(())
        })?;
        let started = Instant::now();
        for &uv in &uvs {
            std::hint::black_box(surface.jet(uv));
        }
        let host = started.elapsed().as_secs_f64();
        let rate = |seconds: f64| f64::from(count) / seconds * 1e-6;
        println!("| {count} | {:.3} | {:.3} |", rate(device), rate(host));
    }
    println!();
    Ok(())
}
