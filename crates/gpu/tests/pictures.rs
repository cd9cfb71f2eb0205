//! Pictures of corpus models against those kept in `tests/pictures`: they may differ by a pixel's place and
//! by rounding.
//!
//! `CHORDAL_UPDATE_PICTURES=1` writes them anew; look at them before they are kept.

mod common;

use chordal_gpu::{
    Background, FaceRenderer, FaceScene, Picture, Projection, RenderOptions, Renderer, SectionPlane, Style,
    Trim, View, mesh_scenery, trimmed_model,
};
use chordal_nurbs::{DVec3, math};
use common::models::{Meshed, meshed};
use common::{gpu, no_gpu};
use std::path::Path;

/// Largest difference of a channel that is none, and the share of pixels that may differ by more.
const THRESHOLD: u8 = 24;
const SHARE: f64 = 0.004;

fn drawn(outcome: &Meshed, options: &RenderOptions) -> Picture {
    let (scenery, _) = mesh_scenery(&outcome.scene, &outcome.model, options.style);
    Renderer::new(gpu())
        .expect("shaders compile")
        .render(gpu(), &outcome.scene, &scenery, options)
        .expect("a picture")
}

fn on_device(outcome: &Meshed) -> FaceScene<'_> {
    let (scene, model) = (&outcome.scene, &outcome.model);
    FaceScene::new(gpu(), trimmed_model(scene, model), (scene, model), Style::Shaded).expect("it fits")
}

fn small() -> RenderOptions {
    RenderOptions::default().with_size(360, 270)
}

fn write(path: &Path, picture: &Picture) {
    std::fs::write(path, picture.to_png().expect("it has pixels")).expect("the folder is there");
}

fn hold_against(name: &str, picture: &Picture) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures").join(format!("{name}.png"));
    if std::env::var_os("CHORDAL_UPDATE_PICTURES").is_some() {
        write(&path, picture);
        return;
    }
    let kept = std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let share = Picture::from_png(&kept).expect("a picture is kept").difference(picture, THRESHOLD);
    if share > SHARE {
        let seen = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
        write(&seen, picture);
        panic!("{name}: {:.2} % of the pixels differ; see {}", 100.0 * share, seen.display());
    }
}

#[test]
fn corpus_models_look_as_they_did() {
    if no_gpu() {
        return;
    }
    let section = Some(SectionPlane { normal: DVec3::Y, offset: 0.0 });
    let cases = [
        ("bracket.step", 0.05, "bracket", small()),
        ("bracket.step", 0.05, "bracket_section", small().with_section(section)),
        (
            "bracket.step",
            0.05,
            "bracket_edges",
            small().with_style(Style::Edges).with_background(Background::DARK),
        ),
        (
            "gear.step",
            0.05,
            "gear_dark",
            small().with_background(Background::DARK).with_projection(Projection::Perspective),
        ),
        ("blade.step", 0.05, "blade_curvature", small().with_style(Style::Curvature)),
        ("assembly_200.step", 0.1, "assembly", small()),
        ("far_from_origin.step", 0.05, "far_from_origin", small()),
    ];
    for (model, percent, name, options) in cases {
        hold_against(name, &drawn(&meshed(model, percent), &options));
    }
}

/// The models by which trimmed drawing is shown, by curves and by textures; close up a texture keeps to its
/// own resolution.
#[test]
fn trimmed_surfaces_look_as_they_did() {
    if no_gpu() {
        return;
    }
    let star = View::At { eye: DVec3::new(6e4, -5e4, 4e4), target: DVec3::new(5e3, 1e3, 0.0) };
    let cases = [
        ("iv/duck.iv", Trim::Exact, "duck", small()),
        ("iv/duck.iv", Trim::Texture, "duck_neck_texture", small().with_zoom(6.0)),
        (
            "iv/airplane_in_a_box.iv",
            Trim::Exact,
            "airplane_in_a_box",
            small().with_projection(Projection::Perspective),
        ),
        ("iv/airplane_in_a_box.iv", Trim::Texture, "airplane_in_a_box_texture", small()),
        ("iv/concave_trim.iv", Trim::Exact, "concave_trim", small()),
        (
            "iv/concave_trim.iv",
            Trim::Texture,
            "concave_trim_star_texture",
            small().with_view(star).with_zoom(12.0),
        ),
        ("nested_loops.step", Trim::Texture, "nested_loops_texture", small()),
        ("fillet_torus.step", Trim::Exact, "neighbours_close", small().with_zoom(5.0).with_lines(false)),
    ];
    let (faces, renderer) = (FaceRenderer::new(gpu()).unwrap(), Renderer::new(gpu()).unwrap());
    for (model, trim, name, options) in cases {
        let outcome = meshed(model, 0.05);
        let options = options.with_trim(trim);
        let (picture, _) = renderer.render_faces(gpu(), &faces, &mut on_device(&outcome), &options).unwrap();
        hold_against(name, &picture);
    }
}

/// Styles that show the mesh: more lines than the model's own edges, and no distance above the proven error.
#[test]
fn styles_of_the_mesh_show_it() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("bracket.step", 0.3);
    let dark = |p: &Picture| p.pixels.iter().filter(|p| p[1] < 90).count();
    let shaded = drawn(&outcome, &small());
    assert!(dark(&drawn(&outcome, &small().with_style(Style::Wireframe))) > dark(&shaded));
    let (_, legend) = mesh_scenery(&outcome.scene, &outcome.model, Style::Error);
    let (high, proven) = (legend.unwrap().high, outcome.proven_error);
    assert!(high > 0.1 * proven && high <= proven, "{high} {proven}");
    assert!(drawn(&outcome, &small().with_style(Style::Error)).difference(&shaded, THRESHOLD) > 0.1);
}

/// The model far from the origin is drawn as sharply as the same one near it would be: single precision holds
/// offsets only.
#[test]
fn a_close_look_far_from_the_origin_keeps_its_pixels() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("far_from_origin.step", 0.05);
    let near = drawn(&outcome, &small());
    let mut moved = outcome;
    for &root in &moved.scene.roots.clone() {
        moved.scene.nodes[root].transform.translation += DVec3::new(4e7, -3e7, 2e7);
    }
    assert!(near.difference(&drawn(&moved, &small()), 8) < 0.002);
}

/// A mirrored placement is lit like the thing itself seen in a mirror.
#[test]
fn mirrored_placements_are_lit_from_the_same_side() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("gear.step", 0.1);
    let top = small().with_view("top".parse::<View>().unwrap());
    let plain = drawn(&outcome, &top);
    let mut mirrored = outcome;
    for &root in &mirrored.scene.roots.clone() {
        let transform = &mut mirrored.scene.nodes[root].transform;
        *transform = chordal_nurbs::DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0)) * *transform;
    }
    // A flat gear mirrored in its own plane shows the same face upwards.
    assert!(plain.difference(&drawn(&mirrored, &top), 8) < 0.01);
}

/// A transparent background leaves the borders' colours free of it.
#[test]
fn transparent_pictures_have_no_dark_borders() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("bracket.step", 0.1);
    let clear = drawn(&outcome, &small().with_background(Background::Transparent));
    let light = drawn(&outcome, &small());
    assert!(clear.pixels.iter().any(|p| p[3] == 0) && clear.pixels.iter().any(|p| p[3] == 255));
    for (a, b) in clear.pixels.iter().zip(&light.pixels).filter(|(a, _)| a[3] == 255) {
        assert!(a.iter().zip(b).all(|(x, y)| x.abs_diff(*y) <= 2));
    }
}

/// Of a box that is seen through, front and back cover what the opacity of both says, whatever the order of
/// drawing.
#[test]
fn what_is_not_opaque_is_seen_through() {
    if no_gpu() {
        return;
    }
    let (faces, renderer) = (FaceRenderer::new(gpu()).unwrap(), Renderer::new(gpu()).unwrap());
    let options = small().with_lines(false).with_background(Background::Transparent);
    for opacity in [0.25, 0.5, 0.7] {
        let mut outcome = meshed("styles.step", 0.1);
        for part in &mut outcome.scene.parts {
            part.face_colors.fill(Some([0.8, 0.2, 0.1, opacity]));
        }
        let (exact, _) = renderer.render_faces(gpu(), &faces, &mut on_device(&outcome), &options).unwrap();
        let texture = options.with_trim(Trim::Texture);
        let (textured, _) = renderer.render_faces(gpu(), &faces, &mut on_device(&outcome), &texture).unwrap();
        for picture in [exact, textured, drawn(&outcome, &options)] {
            // Well within the picture of the box, 8 × 8 of the patterns.
            let (w, h) = (picture.width as usize, picture.height as usize);
            let middle = (0..32 * 32).map(|k| (h / 2 + k / 32) * w + w / 2 + k % 32);
            let mean = middle.map(|at| f64::from(picture.pixels[at][3])).sum::<f64>() / 1024.0 / 255.0;
            let wanted = 1.0 - math::square(1.0 - f64::from(opacity));
            assert!((mean - wanted).abs() < 0.03, "{mean} of {wanted}");
        }
    }
}

/// Exact surfaces look like their mesh at a tolerance that no pixel shows, near and far, the trims close up
/// too.
#[test]
fn exact_surfaces_look_like_a_fine_mesh() {
    if no_gpu() {
        return;
    }
    let models = ["bracket.step", "elliptic.step", "cone_apex.step", "sphere_holes.step", "torus_hole.step"];
    let faces = FaceRenderer::new(gpu()).unwrap();
    let renderer = Renderer::new(gpu()).unwrap();
    for model in models {
        let outcome = meshed(model, 0.01);
        let mut exact = on_device(&outcome);
        for zoom in [1.0, 5.0] {
            let options = small().with_zoom(zoom);
            let (picture, counts) = renderer.render_faces(gpu(), &faces, &mut exact, &options).unwrap();
            assert!(counts.faces > 0);
            let share = picture.difference(&drawn(&outcome, &options), THRESHOLD);
            assert!(share < 0.003, "{model} at zoom {zoom}: {:.2} % of the pixels differ", 100.0 * share);
        }
    }
}

/// With a mesh that departs by a hundred-thousandth of the model at most, the silhouettes of both modes are
/// within a pixel of each other, without exception: every pixel that one shows is next to one that the other
/// shows.
#[test]
fn silhouettes_are_those_of_a_mesh_at_1e_5() {
    if no_gpu() {
        return;
    }
    let models = [
        "bracket.step",
        "elliptic.step",
        "cone_apex.step",
        "sphere_holes.step",
        "torus_hole.step",
        "gear.step",
        "pipe_elbow.step",
        "far_from_origin.step",
        "iv/duck.iv",
        "iv/concave_trim.iv",
    ];
    let (faces, renderer) = (FaceRenderer::new(gpu()).unwrap(), Renderer::new(gpu()).unwrap());
    for model in models {
        let outcome = meshed(model, 0.001);
        let mut exact = on_device(&outcome);
        for (view, zoom) in [("iso", 1.0), ("front", 3.0)] {
            let options = small()
                .with_view(view.parse().unwrap())
                .with_zoom(zoom)
                .with_lines(false)
                .with_background(Background::Transparent);
            let (nurbs, _) = renderer.render_faces(gpu(), &faces, &mut exact, &options).unwrap();
            let mesh = drawn(&outcome, &options);
            for (name, a, b) in [("nurbs", &nurbs, &mesh), ("mesh", &mesh, &nurbs)] {
                let alone = beyond_a_pixel(a, b);
                // Needles thinner than a pixel end in a strip that is not.
                let allowed = if model == "iv/concave_trim.iv" { 2 } else { 0 };
                assert!(alone <= allowed, "{model} from {view}: {alone} pixels that {name} mode shows alone");
            }
        }
    }
}

/// Pixels that `a` covers by more than a half and of whose neighbours in `b` none is touched.
fn beyond_a_pixel(a: &Picture, b: &Picture) -> usize {
    let (w, h) = (a.width as i64, a.height as i64);
    let opacity =
        |p: &Picture, x: i64, y: i64| p.pixels[(y.clamp(0, h - 1) * w + x.clamp(0, w - 1)) as usize][3];
    let alone = |x: i64, y: i64| {
        opacity(a, x, y) > 127 && (-1..=1).all(|dy| (-1..=1).all(|dx| opacity(b, x + dx, y + dy) == 0))
    };
    (0..h).map(|y| (0..w).filter(|&x| alone(x, y)).count()).sum()
}

/// Both ways of trimming look alike where texels are finer than pixels, and like a fine mesh: deep notches,
/// holes with islands, windows.
#[test]
fn both_trims_look_alike() {
    if no_gpu() {
        return;
    }
    let (faces, renderer) = (FaceRenderer::new(gpu()).unwrap(), Renderer::new(gpu()).unwrap());
    for model in [
        "iv/duck.iv",
        "iv/concave_trim.iv",
        "iv/airplane_in_a_box.iv",
        "nested_loops.step",
        "sphere_holes.step",
    ] {
        let outcome = meshed(model, 0.01);
        let mut exact = on_device(&outcome);
        for zoom in [1.0, 4.0] {
            let options = small().with_zoom(zoom);
            let mut of =
                |trim| renderer.render_faces(gpu(), &faces, &mut exact, &options.with_trim(trim)).unwrap().0;
            let (curves, texture) = (of(Trim::Exact), of(Trim::Texture));
            let share = curves.difference(&texture, THRESHOLD);
            assert!(share < 0.001, "{model} at zoom {zoom}: {:.2} % of the pixels differ", 100.0 * share);
            let share = texture.difference(&drawn(&outcome, &options), THRESHOLD);
            assert!(share < 0.003, "{model} at zoom {zoom}: {:.2} % differ from the mesh", 100.0 * share);
        }
    }
}

/// Seen through no crack: inside the silhouette of a solid no sample shows the background, at any zoom,
/// however coarse the mesh that the loops were taken from.
#[test]
fn neighbours_show_no_crack() {
    if no_gpu() {
        return;
    }
    let faces = FaceRenderer::new(gpu()).unwrap();
    let renderer = Renderer::new(gpu()).unwrap();
    let magenta = "#ff00ff".parse().unwrap();
    for model in ["bracket.step", "fillets.step", "blade.step", "fillet_torus.step"] {
        let outcome = meshed(model, 0.2);
        let mut exact = on_device(&outcome);
        for zoom in [1.0, 3.3, 11.0] {
            let options = small().with_zoom(zoom).with_lines(false).with_background(magenta);
            let (picture, _) = renderer.render_faces(gpu(), &faces, &mut exact, &options).unwrap();
            let solid = drawn(&meshed(model, 0.005), &options);
            let (w, h) = (i64::from(picture.width), i64::from(picture.height));
            let is_background = |p: [u8; 4]| p[0] > p[1].saturating_add(60);
            let deep = |x: i64, y: i64| {
                (-2..=2).all(|dy| {
                    (-2..=2).all(|dx| {
                        let (x, y) = ((x + dx).clamp(0, w - 1), (y + dy).clamp(0, h - 1));
                        !is_background(solid.pixels[(y * w + x) as usize])
                    })
                })
            };
            let cracks = (0..w * h)
                .filter(|i| is_background(picture.pixels[*i as usize]) && deep(i % w, i / w))
                .count();
            assert_eq!(cracks, 0, "{model} at zoom {zoom}");
        }
    }
}

#[test]
fn a_picture_beyond_the_device_is_refused() {
    if no_gpu() {
        return;
    }
    let outcome = meshed("gear.step", 0.5);
    let (scenery, _) = mesh_scenery(&outcome.scene, &outcome.model, Style::Shaded);
    let renderer = Renderer::new(gpu()).unwrap();
    for (width, height) in [(0, 10), (100_000, 10)] {
        let refused = renderer.render(gpu(), &outcome.scene, &scenery, &small().with_size(width, height));
        assert!(refused.is_err_and(|e| e.to_string().contains("pixels")));
    }
}
