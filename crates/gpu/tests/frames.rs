//! Frames after frames of one scene: what is evaluated again, what is rejected, what an edit uploads, and
//! what limits do.

mod common;

use chordal_gpu::{
    DeviceChoice, FaceRenderer, FaceScene, FrameCounts, Gpu, GpuError, Picture, Projection, RenderOptions,
    Renderer, SectionPlane, Style, Trim, View, scene_outline, trimmed_model,
};
use chordal_nurbs::{DVec3, NurbsSurface, math};
use common::models::{Meshed, meshed};
use common::{gpu, no_gpu};
use std::path::Path;

fn small() -> RenderOptions {
    RenderOptions::default().with_size(320, 240)
}

/// The pipelines and one model on a device.
struct Stage<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    faces: FaceRenderer,
    scene: FaceScene<'a>,
}

impl<'a> Stage<'a> {
    fn new(gpu: &'a Gpu, outcome: &'a Meshed) -> Self {
        let (scene, model) = (&outcome.scene, &outcome.model);
        Self {
            gpu,
            renderer: Renderer::new(gpu).expect("shaders compile"),
            faces: FaceRenderer::new(gpu).expect("shaders compile"),
            scene: FaceScene::new(gpu, trimmed_model(scene, model), (scene, model), Style::Shaded)
                .expect("it fits"),
        }
    }

    fn frame(&mut self, options: &RenderOptions) -> (Picture, FrameCounts) {
        self.renderer.render_faces(self.gpu, &self.faces, &mut self.scene, options).expect("a picture")
    }

    fn faces_of(&self, part: usize) -> usize {
        self.scene.exact().parts[part].faces.len()
    }
}

/// The same view again and a little nearer needs no new samples; nearer by a lot needs those of bent faces
/// alone.
#[test]
fn samples_are_used_again() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("iv/airplane_in_a_box.iv", 0.1);
    for trim in [Trim::Exact, Trim::Texture] {
        let mut stage = Stage::new(gpu(), &outcome);
        let options = small().with_trim(trim).with_reject(false);
        let (first, counts) = stage.frame(&options);
        assert_eq!(counts.evaluated, stage.faces_of(0));
        assert_eq!(counts.points, stage.scene.points());
        let (second, counts) = stage.frame(&options);
        assert_eq!((counts.evaluated, counts.points, counts.faces), (0, 0, stage.faces_of(0)));
        assert_eq!(first, second);
        let (_, counts) = stage.frame(&options.with_zoom(3.0));
        assert!(counts.evaluated > 0, "{counts:?}");
        if trim == Trim::Exact {
            // The walls without windows keep their samples.
            assert!(counts.evaluated < stage.faces_of(0), "{counts:?}");
        }
        // The reserve serves a little further.
        let (_, counts) = stage.frame(&options.with_zoom(3.3));
        assert_eq!(counts.evaluated, 0, "{counts:?}");
        // Back again: what is at most twice as fine stays.
        let (again, _) = stage.frame(&options);
        assert!(again.difference(&first, 24) < 0.002);
    }
}

/// A flight of a hundred frames towards a model: pictures are those of a scene made for each of them, and
/// little is on the device.
#[test]
fn a_flight_shows_what_single_pictures_show() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("blade.step", 0.1);
    let mut stage = Stage::new(gpu(), &outcome);
    let mut evaluated = 0;
    for step in 0..100 {
        let options = small().with_zoom(math::powi(1.04, step)).with_size(160, 120);
        let (picture, counts) = stage.frame(&options);
        evaluated += counts.evaluated;
        if step % 33 == 32 {
            let (alone, counts) = Stage::new(gpu(), &outcome).frame(&options);
            assert!(picture.difference(&alone, 24) < 0.003, "step {step}");
            // Samples twice as fine each way, and what is left over of faces beyond the picture.
            assert!(
                stage.scene.points() < 8 * counts.points + 100_000,
                "step {step}: {}",
                stage.scene.points()
            );
        }
    }
    assert!(evaluated < 30 * stage.faces_of(0), "{evaluated}");
}

/// Leaving out what the picture cannot show leaves the picture as it is: closed and open bodies, near and
/// far, cut and whole.
#[test]
fn rejection_is_not_seen() {
    if no_gpu() {
        return;
    }
    let mut rejected = [0, 0];
    let models = [
        "bracket.step",
        "gear.step",
        "open_shell.step",
        "void.step",
        "iv/airplane_in_a_box.iv",
        "assembly_200.step",
    ];
    for model in models {
        let outcome = meshed(model, 0.3);
        let mut stage = Stage::new(gpu(), &outcome);
        let section = Some(SectionPlane { normal: DVec3::Y, offset: 0.5 });
        for projection in [Projection::Orthographic, Projection::Perspective] {
            for (view, zoom, section) in [("iso", 1.0, None), ("bottom", 6.0, None), ("left", 1.0, section)] {
                let options = small()
                    .with_projection(projection)
                    .with_view(view.parse().unwrap())
                    .with_zoom(zoom)
                    .with_section(section)
                    .with_lines(false);
                let (with, counts) = stage.frame(&options);
                let (without, all) = stage.frame(&options.with_reject(false));
                // Strips along the borders of backs are seen by parts of a pixel at silhouettes.
                let share = with.difference(&without, 40);
                if share > 1e-3 {
                    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
                    std::fs::write(folder.join("rejected.png"), with.to_png().unwrap()).unwrap();
                    std::fs::write(folder.join("whole.png"), without.to_png().unwrap()).unwrap();
                }
                assert!(share <= 1e-3, "{model} from {view} at {zoom}, {projection:?}: {share}");
                assert_eq!((all.outside, all.backs, all.placements_outside), (0, 0, 0));
                assert!(section.is_none() || counts.backs == 0);
                assert!(model != "open_shell.step" || counts.backs == 0);
                rejected[0] += counts.outside + counts.placements_outside;
                rejected[1] += counts.backs;
            }
        }
    }
    assert!(rejected[0] > 50 && rejected[1] > 30, "{rejected:?}");
}

/// The surface with its control points moved in a wave.
fn moved(surface: &NurbsSurface, phase: f64) -> NurbsSurface {
    let size = surface.points().iter().map(|p| p.length()).fold(0.0, f64::max);
    let points = surface
        .points()
        .iter()
        .map(|p| *p + DVec3::Z * (0.1 * size * math::sin(4.0 * p.x / size + phase)))
        .collect();
    let weights = surface.weights().map(<[f64]>::to_vec);
    NurbsSurface::new(
        surface.degree(),
        surface.knots_u().to_vec(),
        surface.knots_v().to_vec(),
        points,
        weights,
    )
    .expect("the same counts")
}

/// Control points that change from frame to frame: only they are sent, only their face is evaluated, in place
/// from the second frame on, and the pictures are those of a scene that had them from the start.
#[test]
fn moving_surfaces_send_and_evaluate_themselves_alone() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("iv/duck.iv", 0.1);
    let options = small().with_lines(false);
    for trim in [Trim::Exact, Trim::Texture] {
        let options = options.with_trim(trim);
        let mut stage = Stage::new(gpu(), &outcome);
        let body = stage.scene.exact().parts[0].faces[0].surface.clone();
        let (still, counts) = stage.frame(&options);
        let whole = counts.points;
        for step in 1..=6 {
            let surface = moved(&body, 0.4 * f64::from(step));
            let sent = stage.scene.set_surface(gpu(), 0, 0, &surface).unwrap();
            let nets = 16 * (surface.points().len() + 16 * 4 * surface.points().len());
            assert!(sent > 0 && sent < nets as u64, "{sent}");
            let (picture, counts) = stage.frame(&options);
            assert_eq!(counts.evaluated, 1);
            assert!(counts.points < whole);
            assert!(picture.difference(&still, 24) > 0.02, "it moves");
            let mut fresh = Stage::new(gpu(), &outcome);
            fresh.scene.set_surface(gpu(), 0, 0, &surface).unwrap();
            assert!(picture.difference(&fresh.frame(&options).0, 24) < 0.003, "step {step}");
        }
        let (_, counts) = stage.frame(&options);
        assert_eq!(counts.evaluated, 0);
        let refused = stage.scene.set_surface(gpu(), 0, 1, &body);
        assert!(matches!(refused, Err(GpuError::OtherShape { .. })), "{refused:?}");
        assert!(stage.scene.set_surface(gpu(), 0, 99, &body).is_err());
    }
}

/// Knots that move move the samples with them: the picture is that of a scene that had them from the start.
#[test]
fn moved_knots_move_the_samples() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("iv/duck.iv", 0.1);
    let options = small().with_lines(false);
    let mut stage = Stage::new(gpu(), &outcome);
    let (still, _) = stage.frame(&options);
    let face = |f: &chordal_gpu::TrimmedFace| f.surface.breaks_u().len() > 2;
    let index = stage.scene.exact().parts[0].faces.iter().position(face).expect("inner knots");
    let s = stage.scene.exact().parts[0].faces[index].surface.clone();
    let domain = s.domain();
    let bent = |t: &f64| {
        let x = (t - domain.min.x) / domain.size().x;
        domain.min.x + domain.size().x * (x + 0.25 * math::sin(x * std::f64::consts::PI))
    };
    let knots = s.knots_u().iter().map(bent).collect();
    let weights = s.weights().map(<[f64]>::to_vec);
    let surface =
        NurbsSurface::new(s.degree(), knots, s.knots_v().to_vec(), s.points().to_vec(), weights).unwrap();
    stage.scene.set_surface(gpu(), 0, index, &surface).unwrap();
    let (moved, _) = stage.frame(&options);
    assert!(moved.difference(&still, 8) > 0.005, "{}", moved.difference(&still, 8));
    let mut fresh = Stage::new(gpu(), &outcome);
    fresh.scene.set_surface(gpu(), 0, index, &surface).unwrap();
    assert!(moved.difference(&fresh.frame(&options).0, 8) < 0.0005);
}

/// Far copies of a part are sampled by themselves, more coarsely.
#[test]
fn far_copies_take_fewer_points() {
    if no_gpu() {
        return;
    }
    let mut outcome = meshed("iv/duck.iv", 0.3);
    let outline = scene_outline(&outcome.scene);
    let (low, high) = outline.iter().fold((outline[0], outline[0]), |(l, h), p| (l.min(*p), h.max(*p)));
    let (target, reach) = (0.5 * (low + high), low.distance(high));
    let view = View::At { eye: target - DVec3::Y * (2.5 * reach), target };
    let options = small()
        .with_size(1200, 900)
        .with_view(view)
        .with_projection(Projection::Perspective)
        .with_lines(false);
    let (whole, counts) = Stage::new(gpu(), &outcome).frame(&options);
    assert!(whole.pixels.iter().any(|p| p[..3] != whole.pixels[0][..3]));
    // One copy of everything, sixty times as far away, adds few points.
    let roots = outcome.scene.roots.clone();
    for root in roots {
        let mut copy = outcome.scene.nodes[root].clone();
        copy.transform.translation += DVec3::Y * (60.0 * reach);
        outcome.scene.nodes.push(copy);
        outcome.scene.roots.push(outcome.scene.nodes.len() - 1);
    }
    let (_, both) = Stage::new(gpu(), &outcome).frame(&options);
    assert!(both.faces > counts.faces, "{both:?}");
    assert!(both.points < counts.points * 6 / 5, "{} of {}", both.points, counts.points);
}

/// A device that binds little gets the model in several pieces and shows the same picture; where one face
/// does not fit it says so.
#[test]
fn small_bindings_split_the_scene() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("blade.step", 0.1);
    let options = small();
    let (whole, _) = Stage::new(gpu(), &outcome).frame(&options);
    let limited = Gpu::open_within(DeviceChoice::Best, 128 << 10).expect("a device");
    for trim in [Trim::Exact, Trim::Texture] {
        let (picture, _) = Stage::new(&limited, &outcome).frame(&options.with_trim(trim));
        assert!(picture.difference(&whole, 24) < 0.004, "{trim:?}");
    }
    let tiny = Gpu::open_within(DeviceChoice::Best, 512).expect("a device");
    let (scene, model) = (&outcome.scene, &outcome.model);
    let refused = FaceScene::new(&tiny, trimmed_model(scene, model), (scene, model), Style::Shaded).and_then(
        |mut s| {
            Renderer::new(&tiny)?
                .render_faces(&tiny, &FaceRenderer::new(&tiny)?, &mut s, &options)
                .map(|_| ())
        },
    );
    assert!(matches!(refused, Err(GpuError::TooLarge { .. })), "{refused:?}");
}

/// Without its device no frame, no edit and no new scene: an error that says so.
#[test]
fn a_lost_device_is_said() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("iv/duck.iv", 0.5);
    let doomed = Gpu::open(DeviceChoice::Best).expect("a device");
    let mut stage = Stage::new(&doomed, &outcome);
    stage.frame(&small());
    doomed.device.destroy();
    let lost = |what: &str, error: Option<GpuError>| {
        assert!(matches!(error, Some(GpuError::Lost(_))), "{what}: {error:?}");
    };
    let surface = stage.scene.exact().parts[0].faces[0].surface.clone();
    let Stage { renderer, faces, scene, .. } = &mut stage;
    lost("drawing", renderer.render_faces(&doomed, faces, scene, &small()).err());
    lost("another size", renderer.render_faces(&doomed, faces, scene, &small().with_size(64, 64)).err());
    lost("an edit", scene.set_surface(&doomed, 0, 0, &surface).err());
    let parts = (&outcome.scene, &outcome.model);
    lost("a scene", FaceScene::new(&doomed, trimmed_model(parts.0, parts.1), parts, Style::Shaded).err());
    lost("shaders", Renderer::new(&doomed).err());
    lost("kernels", FaceRenderer::new(&doomed).err());
}
