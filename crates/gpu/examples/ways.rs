//! Times the ways of drawing exact faces: trimmed by curves, by a texture, and lit by interpolated normals;
//! the first frame of a model, and frames of which nothing is evaluated.
//!
//!     cargo run --release -p chordal-gpu --example ways -- corpus/iv/duck.iv corpus/bracket.step

#[path = "../tests/common/models.rs"]
#[allow(dead_code)]
mod models;

use chordal_gpu::{
    DeviceChoice, FaceRenderer, FaceScene, Gpu, Normals, RenderOptions, Renderer, Style, Trim, trimmed_model,
};
use models::{Meshed, meshed_file};
use std::error::Error;
use std::time::{Duration, Instant};

/// Frames of which the fastest counts.
const FRAMES: usize = 12;

fn main() -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::open(DeviceChoice::Best)?;
    println!("{}, 1280 × 960, the fastest of {FRAMES} frames, ms: first / next\n", gpu.name());
    println!("| model | zoom | exact | trimmed by texture | interpolated normals |");
    println!("|---|---|---|---|---|");
    let renderers = (Renderer::new(&gpu)?, FaceRenderer::new(&gpu)?);
    for path in std::env::args().skip(1) {
        let outcome = meshed_file(path.as_ref(), 0.03);
        let name = std::path::Path::new(&path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for zoom in [1.0, 4.0] {
            let picture = RenderOptions::default().with_zoom(zoom).with_lines(false);
            let ways =
                [picture, picture.with_trim(Trim::Texture), picture.with_normals(Normals::Interpolated)];
            print!("| {name} | {zoom} |");
            for way in ways {
                let [first, next] = times(&gpu, &renderers, &outcome, &way)?;
                print!(" {:.1} / {:.1} |", 1e3 * first.as_secs_f64(), 1e3 * next.as_secs_f64());
            }
            println!();
        }
    }
    Ok(())
}

/// The fastest first frame and the fastest later one.
fn times(
    gpu: &Gpu,
    (renderer, faces): &(Renderer, FaceRenderer),
    outcome: &Meshed,
    picture: &RenderOptions,
) -> Result<[Duration; 2], Box<dyn Error>> {
    let (scene, model) = (&outcome.scene, &outcome.model);
    let (mut first, mut next) = (Duration::MAX, Duration::MAX);
    for _ in 0..3 {
        let mut on_device = FaceScene::new(gpu, trimmed_model(scene, model), (scene, model), Style::Shaded)?;
        let mut frame = || -> Result<Duration, Box<dyn Error>> {
            let started = Instant::now();
            renderer.draw_faces(gpu, faces, &mut on_device, picture)?;
            gpu.wait()?;
            Ok(started.elapsed())
        };
        first = first.min(frame()?);
        for _ in 0..FRAMES / 3 {
            next = next.min(frame()?);
        }
    }
    Ok([first, next])
}
