//! Times both ways of trimming: the first frame of a model, and frames of which nothing is evaluated.
//!
//!     cargo run --release -p chordal-gpu --example trims -- corpus/iv/duck.iv corpus/bracket.step

use chordal::gpu::{
    DeviceChoice, ExactRenderer, ExactScene, Gpu, RenderOptions, Renderer, Style, Trim, exact_model,
};
use chordal::{Job, JobOptions, Tolerance};
use std::error::Error;
use std::time::{Duration, Instant};

/// Frames of which the fastest counts.
const FRAMES: usize = 12;

fn main() -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::open(DeviceChoice::Best)?;
    println!("{}, 1280 × 960, the fastest of {FRAMES} frames, ms\n", gpu.name());
    println!("| model | zoom | first, exact | first, texture | next, exact | next, texture |");
    println!("|---|---|---|---|---|---|");
    let (renderer, faces) = (Renderer::new(&gpu)?, ExactRenderer::new(&gpu)?);
    for path in std::env::args().skip(1) {
        let options = JobOptions::default().with_tolerance(Tolerance::Percent(0.03));
        let outcome = chordal::run(&Job::new(&path).with_options(options))?;
        let (scene, model) = (&outcome.scene, &outcome.model);
        let name = std::path::Path::new(&path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for zoom in [1.0, 4.0] {
            let mut times = Vec::new();
            for trim in [Trim::Exact, Trim::Texture] {
                let picture = RenderOptions::default().with_zoom(zoom).with_lines(false).with_trim(trim);
                let (mut first, mut next) = (Duration::MAX, Duration::MAX);
                for _ in 0..3 {
                    let mut on_device =
                        ExactScene::new(&gpu, exact_model(scene, model), (scene, model), Style::Shaded)?;
                    let mut frame = || -> Result<Duration, Box<dyn Error>> {
                        let started = Instant::now();
                        renderer.draw_exact(&gpu, &faces, &mut on_device, &picture)?;
                        gpu.wait()?;
                        Ok(started.elapsed())
                    };
                    first = first.min(frame()?);
                    for _ in 0..FRAMES / 3 {
                        next = next.min(frame()?);
                    }
                }
                times.push([first, next].map(|t| 1e3 * t.as_secs_f64()));
            }
            let [exact, texture] = [times[0], times[1]];
            println!(
                "| {name} | {zoom} | {:.1} | {:.1} | {:.1} | {:.1} |",
                exact[0], texture[0], exact[1], texture[1]
            );
        }
    }
    Ok(())
}
