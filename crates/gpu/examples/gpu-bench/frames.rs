//! Frames a second of exact surfaces.

use crate::scene::Scenario;
use crate::time::{grouped, seconds};
use chordal_gpu::{
    Background, FaceRenderer, FaceScene, Gpu, GpuError, PIXEL_ERROR, RenderOptions, Renderer, Style, View,
    trimmed_model,
};
use chordal_nurbs::{DVec3, NurbsSurface, math};
use std::time::Instant;

/// After a frame of so many seconds the larger scenes are left out.
const LONGEST: f64 = 10.0;

const NUMBERS: [usize; 6] = [3, 30, 300, 3_000, 30_000, 300_000];

fn options(size: [u32; 2]) -> RenderOptions {
    let view = View::From { direction: DVec3::Z, up: DVec3::Y };
    RenderOptions::default().with_size(size[0], size[1]).with_view(view).with_lines(false)
}

/// Frames a second against the number of surfaces, at the size of a screen; smaller on a program.
pub fn by_surfaces(gpu: &Gpu) -> Result<(), GpuError> {
    let size = if gpu.is_software() { [640, 480] } else { [1920, 1080] };
    println!(
        "Frames of {} × {} pixels, four samples each, {PIXEL_ERROR} pixel of error, every third surface \
         trimmed, all in view,",
        size[0], size[1]
    );
    println!("from above; waited for, not read back. Moving: 2 % nearer from frame to frame.\n");
    println!(
        "| surfaces | points | first frame, s | frames/s, still | frames/s, moving | evaluated anew a frame |"
    );
    println!("|---|---|---|---|---|---|");
    let (renderer, exact) = (Renderer::new(gpu)?, FaceRenderer::new(gpu)?);
    for count in NUMBERS {
        let (model, scene) = Scenario::new(count).model();
        let mut shown = FaceScene::new(gpu, trimmed_model(&scene, &model), (&scene, &model), Style::Shaded)?;
        let options = options(size);
        let started = Instant::now();
        let first = renderer.draw_faces(gpu, &exact, &mut shown, &options)?;
        gpu.wait()?;
        let slowest = started.elapsed().as_secs_f64();
        let still = seconds(|| {
            renderer.draw_faces(gpu, &exact, &mut shown, &options)?;
            gpu.wait()
        })?;
        // The mean, not the best: frames that evaluate much are among them.
        let (mut frame, mut evaluated, began) = (0, 0, Instant::now());
        while frame < 20 && (frame == 0 || began.elapsed().as_secs_f64() < 1.0) {
            frame += 1;
            let nearer = options.with_zoom(math::powi(1.02, frame));
            evaluated += renderer.draw_faces(gpu, &exact, &mut shown, &nearer)?.evaluated;
            gpu.wait()?;
        }
        let moving = began.elapsed().as_secs_f64() / f64::from(frame);
        println!(
            "| {} | {} | {slowest:.2} | {:.2} | {:.2} | {:.1} |",
            grouped(count),
            grouped(first.points),
            1.0 / still,
            1.0 / moving,
            evaluated as f64 / f64::from(frame)
        );
        if slowest.max(still).max(moving) > LONGEST && count < NUMBERS[NUMBERS.len() - 1] {
            println!("\nA frame took more than {LONGEST} s: larger scenes are left out.");
            break;
        }
    }
    println!();
    Ok(())
}

/// What placements cost: one part of three surfaces, one of them trimmed, placed over and over.
pub fn by_placements(gpu: &Gpu) -> Result<(), GpuError> {
    println!(
        "One part of three surfaces placed many times, 640 × 480 pixels. Milliseconds until the frame is \
         submitted, and until it is"
    );
    println!(
        "done: of a frame like the last, and of one whose placements are composed with the camera again.\n"
    );
    println!("| placements | like the last: submitted | done | composed again: submitted | done |");
    println!("|---|---|---|---|---|");
    let (renderer, exact) = (Renderer::new(gpu)?, FaceRenderer::new(gpu)?);
    for count in [100, 1_000, 10_000, 100_000] {
        let (model, scene) = Scenario::new(3).placed(count);
        let mut shown = FaceScene::new(gpu, trimmed_model(&scene, &model), (&scene, &model), Style::Shaded)?;
        let mut best = [[f64::INFINITY; 2]; 2];
        let began = Instant::now();
        for frame in 0..8 {
            // Another background composes the placements again, and evaluates nothing.
            let background = [Background::LIGHT, Background::DARK][frame % 2];
            for kind in best.iter_mut().rev() {
                let options = options([640, 480]).with_background(background);
                let started = Instant::now();
                renderer.draw_faces(gpu, &exact, &mut shown, &options)?;
                let submitted = started.elapsed().as_secs_f64();
                gpu.wait()?;
                *kind = [kind[0].min(submitted), kind[1].min(started.elapsed().as_secs_f64())];
            }
            if began.elapsed().as_secs_f64() > 2.0 * LONGEST {
                break;
            }
        }
        let [[last, last_done], [anew, anew_done]] = best.map(|kind| kind.map(|s| 1e3 * s));
        println!("| {} | {last:.2} | {last_done:.1} | {anew:.2} | {anew_done:.1} |", grouped(count));
    }
    println!();
    Ok(())
}

/// Frames a second of thirty surfaces against the size of their grids, which follows the size of the picture.
pub fn by_grids(gpu: &Gpu) -> Result<(), GpuError> {
    let largest = if gpu.is_software() { 1280 } else { 7680 };
    let largest = largest.min(gpu.device.limits().max_texture_dimension_2d);
    println!(
        "Thirty surfaces, ten of them trimmed, in pictures of growing size; animated: control points of all \
         of them change"
    );
    println!("from frame to frame.\n");
    println!("| picture | points a surface | frames/s, still | frames/s, animated |");
    println!("|---|---|---|---|");
    let (renderer, exact) = (Renderer::new(gpu)?, FaceRenderer::new(gpu)?);
    let scenario = Scenario::new(30);
    let (model, scene) = scenario.model();
    let sizes = [160, 320, 640, 1280, 1920, 3840, 7680];
    for width in sizes.into_iter().filter(|w| *w <= largest) {
        let mut shown = FaceScene::new(gpu, trimmed_model(&scene, &model), (&scene, &model), Style::Shaded)?;
        let options = options([width, width * 3 / 4]);
        let points = renderer.draw_faces(gpu, &exact, &mut shown, &options)?.points;
        let still = seconds(|| {
            renderer.draw_faces(gpu, &exact, &mut shown, &options)?;
            gpu.wait()
        })?;
        let mut frame = 0;
        let animated = seconds(|| {
            frame += 1;
            for (k, sheet) in scenario.surfaces.iter().enumerate() {
                shown.set_surface(gpu, 0, k, &swaying(sheet, frame))?;
            }
            renderer.draw_faces(gpu, &exact, &mut shown, &options)?;
            gpu.wait()
        })?;
        println!(
            "| {width} × {} | {} | {:.1} | {:.1} |",
            width * 3 / 4,
            grouped(points / 30),
            1.0 / still,
            1.0 / animated
        );
    }
    println!();
    Ok(())
}

/// The surface a little higher and lower.
fn swaying(sheet: &NurbsSurface, frame: u32) -> NurbsSurface {
    let height = 1.0 + 0.05 * math::sin(0.3 * f64::from(frame));
    let points = sheet.points().iter().map(|p| DVec3::new(p.x, p.y, p.z * height)).collect();
    let weights = sheet.weights().map(<[f64]>::to_vec);
    let knots = (sheet.knots_u().to_vec(), sheet.knots_v().to_vec());
    NurbsSurface::new(sheet.degree(), knots.0, knots.1, points, weights).expect("moved, nothing else")
}
