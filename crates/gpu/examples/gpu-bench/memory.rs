//! Grid points against the bandwidth that copies of buffers reach: the floor of an evaluation is what it
//! writes.

use crate::evaluation::{PAPER, rates, surface};
use crate::time::seconds;
use chordal_gpu::{Gpu, GpuError, Request, Samples, SurfaceSet, Task, Variant, Wanted};
use wgpu::BufferUsages;

/// Bytes of a point: three numbers in single precision.
const POINT: f64 = 12.0;

/// The largest buffer that is copied.
const LARGEST: u64 = 1 << 30;

/// Prints both and their ratio.
pub fn against_copies(gpu: &Gpu) -> Result<(), GpuError> {
    let bytes = (gpu.binding_limit().min(LARGEST) / 4) & !3;
    let buffer = |usage| {
        let descriptor =
            wgpu::BufferDescriptor { label: None, size: bytes, usage, mapped_at_creation: false };
        gpu.watched(Task::Allocating, || Ok(gpu.device.create_buffer(&descriptor)))
    };
    let (from, to) = (
        buffer(BufferUsages::COPY_SRC | BufferUsages::COPY_DST)?,
        buffer(BufferUsages::COPY_SRC | BufferUsages::COPY_DST)?,
    );
    let copies = 4;
    let time = seconds(|| {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for _ in 0..copies {
            encoder.copy_buffer_to_buffer(&from, 0, &to, 0, bytes);
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()
    })?;
    let written = (copies * bytes) as f64 / time;
    println!(
        "Copies of {} MiB: {:.2} GB/s written, {:.2} GB/s read and written together.\n",
        bytes >> 20,
        written * 1e-9,
        2.0 * written * 1e-9
    );
    println!(
        "| points of one dispatch | variant | Gpoints/s | GB/s at 12 B | of what copies write | of what \
         they read and write |"
    );
    println!("|---|---|---|---|---|---|");
    for (name, side, count, control) in [
        ("one grid of 1024²", 1024, 1, PAPER),
        ("one grid of 1024², one span", 1024, 1, 4),
        ("10,000 grids of 32²", 32, 10_000, 4),
    ] {
        let mut set = SurfaceSet::<f32>::with_bezier();
        for seed in 0..count {
            set.push_surface(&surface(seed, control));
        }
        let requests: Vec<_> = (0..count).map(|i| Request::even_grid(&set, i, side, side)).collect();
        let samples = Samples::new(&set, &requests)?;
        for variant in [Variant::Direct, Variant::Bernstein] {
            let [resident, _] = rates(gpu, variant, &set, &samples, Wanted::Points)?;
            let bandwidth = resident * 1e6 * POINT;
            println!(
                "| {name} | {} | {:.4} | {:.3} | {:.1} % | {:.1} % |",
                variant.name(),
                resident * 1e-3,
                bandwidth * 1e-9,
                100.0 * bandwidth / written,
                50.0 * bandwidth / written
            );
        }
    }
    println!();
    Ok(())
}
