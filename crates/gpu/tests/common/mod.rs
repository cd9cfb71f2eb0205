//! The device of the tests, surfaces to evaluate, and meshed models.
#![allow(dead_code, reason = "every test file uses its own part")]

pub mod models;

use chordal_gpu::{DeviceChoice, Gpu, GpuError};
use chordal_nurbs::{DVec3, NurbsSurface, math};
use std::io::Write;
use std::sync::OnceLock;

/// The device that tests run on. A test calls [`no_gpu`] first.
pub fn gpu() -> &'static Gpu {
    opened().expect("the test has asked no_gpu")
}

/// True without a device: the test is skipped then, and a line on standard error says so.
///
/// `CHORDAL_REQUIRE_GPU=1` makes such a test fail instead; CI sets it where it has installed a device.
pub fn no_gpu() -> bool {
    let skipped = opened().is_none();
    if skipped {
        let thread = std::thread::current();
        let name = thread.name().unwrap_or("a test");
        // Not by a macro: the test harness hides what a passing test prints by macros.
        let _ = writeln!(std::io::stderr(), "{name}: skipped: no {} device", chordal_gpu::BACKENDS);
    }
    skipped
}

fn opened() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    let open = || match Gpu::open(DeviceChoice::Best) {
        Ok(gpu) => {
            eprintln!("adapter: {}", gpu.name());
            Some(gpu)
        }
        Err(error @ (GpuError::NoDevice { .. } | GpuError::Lacks { .. })) => {
            let required = std::env::var_os("CHORDAL_REQUIRE_GPU").is_some_and(|v| v != "0");
            assert!(!required, "CHORDAL_REQUIRE_GPU is set, but {error}");
            None
        }
        Err(error) => panic!("{error}"),
    };
    GPU.get_or_init(open).as_ref()
}

/// A small generator: the same numbers everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }
}

/// Knots with `spans` spans of lengths from 1e-3 to 1 about `at`, some knots repeated; clamped or not.
pub fn knots(random: &mut Random, degree: usize, spans: usize, at: f64) -> Vec<f64> {
    let mut inner = Vec::new();
    let mut t = at;
    for _ in 1..spans {
        t += math::pow(10.0, -3.0 * random.next());
        let times = 1 + if random.below(4) == 0 { random.below(degree.min(3)) } else { 0 };
        inner.extend(std::iter::repeat_n(t, times));
    }
    t += math::pow(10.0, -3.0 * random.next());
    let clamped = random.below(3) > 0;
    let step = |k: usize| if clamped { 0.0 } else { 0.1 * k as f64 };
    let before = (0..=degree).rev().map(|k| at - step(k));
    let after = (0..=degree).map(|k| t + step(k));
    before.chain(inner.iter().copied()).chain(after).collect()
}

/// A bumpy sheet anywhere in space, rational or not, with weights up to 1:20.
pub fn surface(random: &mut Random, degree: [usize; 2], spans: [usize; 2]) -> NurbsSurface {
    let at = (random.next() - 0.5) * math::powi(10.0, random.below(4) as i32);
    let knots = [knots(random, degree[0], spans[0], at), knots(random, degree[1], spans[1], -at)];
    let counts = [knots[0].len() - degree[0] - 1, knots[1].len() - degree[1] - 1];
    let size = math::pow(10.0, 4.0 * random.next() - 2.0);
    let place = DVec3::new(random.next(), random.next(), random.next()) * size * 1e3;
    let mut points = Vec::new();
    for i in 0..counts[0] {
        for j in 0..counts[1] {
            let p = DVec3::new(i as f64, j as f64, 3.0 * random.next());
            points.push(place + p * size);
        }
    }
    let rational = random.below(2) == 0;
    let weights = rational.then(|| points.iter().map(|_| math::pow(20.0, random.next())).collect());
    let [u, v] = knots;
    NurbsSurface::new(degree, u, v, points, weights).expect("knots and net fit")
}

/// Surfaces of every degree from 1 to 100 along u, of others along v.
pub fn zoo(random: &mut Random) -> Vec<NurbsSurface> {
    let mut found = Vec::new();
    for p in 1..=100 {
        let q = if p <= 12 { 1 + random.below(12) } else { [1, 2, 3, p][random.below(4)] };
        let spans =
            if p <= 12 { [1 + random.below(6), 1 + random.below(6)] } else { [1 + random.below(2), 1] };
        let degree = if random.below(2) == 0 { [p, q] } else { [q, p] };
        found.push(surface(random, degree, spans));
    }
    found
}
