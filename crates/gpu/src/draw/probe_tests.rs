//! The normals that fragments are lit by, read back as numbers, against double precision.

use super::*;
use crate::draw::face_normal::face_normal;
use crate::draw::pipelines::{DEPTH, pipeline_into};
use crate::error::Resource;
use crate::evaluate::read_back;
use crate::faces::TrimmedFace;
use crate::test_support::models::{Meshed, meshed};
use crate::test_support::{gpu, no_gpu};
use crate::{Camera, Normals, Real, SurfaceSet, shaders, trimmed_model};
use chordal_nurbs::{DVec2, Surface, math};
use glam::DMat3;
use wgpu::{RenderPipeline, TextureFormat, TextureUsages};

const FORMATS: [TextureFormat; 2] = [TextureFormat::Rgba32Float; 2];
const SIZE: [u32; 2] = [160, 120];

/// What one pixel shows of one face.
struct Seen {
    pixel: [u32; 2],
    part: usize,
    face: usize,
    /// Of the face's square by NURBS parameters.
    spot: DVec2,
    /// In view space.
    normal: DVec3,
    /// What the twin says, in the part's axes.
    twin: DVec3,
}

/// The pixels of all exact faces, batch by batch; hidden ones of other batches too.
fn probe(gpu: &Gpu, outcome: &Meshed, options: &RenderOptions) -> (TrimmedModel, Camera, Vec<Seen>) {
    let (renderer, exact) = (Renderer::new(gpu).unwrap(), FaceRenderer::new(gpu).unwrap());
    let model = trimmed_model(&outcome.scene, &outcome.model);
    let mut scene =
        FaceScene::new(gpu, model.clone(), (&outcome.scene, &outcome.model), Style::Shaded).unwrap();
    scene.draw(gpu, (&renderer, &exact), options).unwrap();
    let pipeline = pipeline_into(gpu, shaders::FACE, ["vertex", "fragment_probe"], &[], (&FORMATS, 1));
    let mut found = Vec::new();
    for (id, list) in &scene.lists {
        let places: BTreeMap<usize, (usize, usize)> = scene
            .sampled
            .iter()
            .flat_map(|((part, _), faces)| faces.iter().enumerate().map(move |(face, s)| (*part, face, s)))
            .filter_map(|(part, face, s)| Some((s.filter(|s| s.batch == *id)?.index, (part, face))))
            .collect();
        let [spots, normals] = frame(gpu, &pipeline, (&exact, &scene), (&scene.batches[id], list));
        let batch = &scene.batches[id];
        let (data, places_of) = batch.known(gpu).unwrap();
        let net = &scene.stores[batch.store].set.bezier;
        for (k, (spot, normal)) in spots.iter().zip(&normals).enumerate() {
            if spot[3] == 0.0 {
                continue;
            }
            let (part, face) = places[&(spot[2] as usize)];
            found.push(Seen {
                pixel: [k as u32 % SIZE[0], k as u32 / SIZE[0]],
                part,
                face,
                spot: DVec2::new(spot[0].into(), spot[1].into()),
                normal: DVec3::from([0, 1, 2].map(|c| f64::from(normal[c]))),
                twin: face_normal(&data[spot[2] as usize], &places_of, net, [spot[0], spot[1]]).as_dvec3(),
            });
        }
    }
    (model, options.camera(&scene.outline), found)
}

/// Draws the faces of one batch into two targets of numbers.
fn frame(
    gpu: &Gpu,
    pipeline: &RenderPipeline,
    (exact, scene): (&FaceRenderer, &FaceScene),
    (batch, list): (&FaceBatch, &List),
) -> [Vec<[f32; 4]>; 2] {
    let texture = |format, usage| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage | TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    };
    let targets = FORMATS.map(|format| texture(format, TextureUsages::COPY_SRC));
    let views = [0, 1].map(|k| targets[k].create_view(&Default::default()));
    let depth = texture(DEPTH, TextureUsages::empty()).create_view(&Default::default());
    let attachment = |k: usize| {
        let ops = wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            store: wgpu::StoreOp::Store,
        };
        Some(wgpu::RenderPassColorAttachment {
            view: &views[k],
            depth_slice: None,
            resolve_target: None,
            ops,
        })
    };
    let blocks = Blocks::new(gpu, [pipeline, &exact.borders], batch.cells(), &list.drawn).unwrap();
    let store = &scene.stores[batch.store];
    let group = batch.probe_group(gpu, pipeline, store, scene.stage.buffers());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[attachment(0), attachment(1)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        blocks.draw_faces(&mut pass, &exact.indices);
    }
    let row = (16 * SIZE[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let bytes = u64::from(row * SIZE[1]);
    let buffers = targets.each_ref().map(|target| {
        let buffer =
            crate::evaluate::empty_storage(gpu, Resource::Points, bytes, wgpu::BufferUsages::empty())
                .unwrap();
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(target.as_image_copy(), to, target.size());
        buffer
    });
    gpu.queue.submit([encoder.finish()]);
    buffers.map(|buffer| {
        let data = read_back(gpu, &buffer, bytes).unwrap();
        let lines = data.chunks_exact(row as usize);
        lines
            .flat_map(|line| bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&line[..16 * SIZE[0] as usize]))
            .collect()
    })
}

/// Part to view for normals, of a part that is placed once.
fn turn(outcome: &Meshed, camera: &Camera, part: usize) -> DMat3 {
    let placements = outcome.scene.placements();
    let world = placements.iter().find(|p| p.part == part).expect("it is seen").world;
    let view = camera.view.matrix3 * world.matrix3;
    view.inverse().transpose() * view.determinant().signum()
}

/// The exact unit normal of a face at a place of its square, and how far that of a pixel may be from it,
/// radians: rounding of the tangents, by the parameters of their span, and of the place.
///
/// Each homogeneous derivative is a sum of differences that carry 12 n + 4 roundings of control points up to
/// √3 from the middle (as in `SurfaceEntry::point_bound`), times the degree; the quotient has as many again
/// of the point, and the weights may be ρ times smaller than the largest: √3 ρ p (36 n + 24) units. The place
/// is rounded to 8 units of the face's square.
fn normal_in_double(face: &TrimmedFace, entry: &crate::SurfaceEntry, spot: DVec2) -> Option<(DVec3, f64)> {
    let low = face.parameters.nurbs_from_native(face.uv.min);
    let over = face.parameters.nurbs_from_native(face.uv.max) - low;
    let uv = low + spot * over;
    let jet = face.surface.jet(uv);
    let span = DVec2::from_array([0, 1].map(|axis| {
        let direction = &entry.directions[axis];
        let cell = (direction.locate(uv[axis]).0 - direction.span) as usize;
        direction.breaks[cell + 1] - direction.breaks[cell]
    }));
    let (du, dv) = (jet.du * span.x, jet.dv * span.y);
    let n = du.cross(dv);
    let degrees = entry.degree.map(|p| p as f64);
    let units = 3.0_f64.sqrt() * entry.weight_ratio * (36.0 * (degrees[0] + degrees[1]) + 24.0);
    let rounding = degrees.map(|p| units * p * entry.frame.size * f32::UNIT);
    let moved = 8.0 * f32::UNIT * (over.abs() + span);
    let shift = [
        (jet.duu.length() * moved.x + jet.duv.length() * moved.y) * span.x,
        (jet.duv.length() * moved.x + jet.dvv.length() * moved.y) * span.y,
    ];
    let wrong = (rounding[0] + shift[0]) * dv.length() + (rounding[1] + shift[1]) * du.length();
    let bound = wrong / n.length() + 16.0 * f32::UNIT;
    let outside = if face.reversed { -1.0 } else { 1.0 };
    (bound < 0.1).then(|| (n.normalize() * outside, bound))
}

/// In every pixel of pictures that are sampled coarsely the normal is that of the surface, within the bound
/// of single precision: spheres, tori, a rational duck, splines up to degree 100. Interpolated ones are far
/// from it.
#[test]
fn normals_of_pixels_are_those_of_the_surface() {
    if no_gpu() {
        return;
    }
    let gpu = gpu();
    let options = RenderOptions::default().with_size(SIZE[0], SIZE[1]).with_lines(false);
    let models = [
        "sphere_holes.step",
        "torus_hole.step",
        "elliptic.step",
        "blade.step",
        "spline_ball.step",
        "degree_mixed.step",
        "degree_100.step",
        "far_from_origin.step",
        "iv/duck.iv",
    ];
    for name in models {
        let outcome = meshed(name, 0.5);
        let mut worst = [0.0_f64; 2];
        for (k, normals) in [Normals::Exact, Normals::Interpolated].into_iter().enumerate() {
            let (model, camera, seen) = probe(gpu, &outcome, &options.with_normals(normals));
            let mut left_out = 0;
            for pixel in &seen {
                let face = &model.parts[pixel.part].faces[pixel.face];
                let mut set = SurfaceSet::<f32>::new();
                set.push_surface(&face.surface);
                let Some((n, bound)) = normal_in_double(face, &set.entries()[0], pixel.spot) else {
                    left_out += 1;
                    continue;
                };
                let wanted = (turn(&outcome, &camera, pixel.part) * n).normalize();
                let angle = math::angle_between(wanted, pixel.normal);
                let at = (pixel.face, pixel.spot);
                assert!(k == 1 || angle <= bound, "{name}: {angle} of {bound} at {at:?}");
                let of_twin = math::angle_between(n, pixel.twin);
                assert!(of_twin <= bound, "{name}, twin: {of_twin} of {bound} at {at:?}");
                worst[k] = worst[k].max(angle);
            }
            assert!(seen.len() > 1000 && 50 * left_out < seen.len(), "{name}: {left_out} of {}", seen.len());
        }
        println!("{name}: {:.1e} radians, interpolated {:.1e}", worst[0], worst[1]);
        assert!(worst[0] < 0.1 * worst[1], "{name}: {worst:?}");
    }
}

/// The place itself is where the pixel looks: on a sphere the normals are those of the points that a pixel's
/// ray meets, within the error of half a pixel and the half that is allowed to the picture.
#[test]
fn normals_of_a_sphere_are_those_that_its_pixels_look_at() {
    if no_gpu() {
        return;
    }
    let gpu = gpu();
    let options = RenderOptions::default().with_size(SIZE[0], SIZE[1]).with_lines(false);
    let outcome = meshed("sphere_full.step", 0.5);
    let (_, camera, seen) = probe(gpu, &outcome, &options);
    let chordal_brep::FaceGeometry::Surface(surface) = &outcome.model.parts[0].faces[0].geometry else {
        panic!("a sphere is a surface")
    };
    let Surface::Sphere { frame, radius } = surface.as_ref() else { panic!("a sphere is a sphere") };
    let world = outcome.scene.placements()[0].world;
    let to_view = camera.view * world;
    let middle = to_view.transform_point3(frame.origin);
    let radius = radius * to_view.matrix3.x_axis.length();
    let half = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1])) * 0.5;
    let mut compared = 0;
    for pixel in &seen {
        let at = DVec2::new(f64::from(pixel.pixel[0]) + 0.5, f64::from(pixel.pixel[1]) + 0.5);
        let off = ((at - half) * DVec2::new(1.0, -1.0) * camera.pixel - middle.truncate()) / radius;
        let depth = 1.0 - off.length_squared();
        if depth < 0.1 {
            continue;
        }
        let wanted = off.extend(depth.sqrt());
        let normal = pixel.normal * pixel.normal.z.signum();
        let angle = math::angle_between(wanted, normal);
        assert!(angle <= camera.pixel / radius / depth.sqrt(), "{angle} at {:?}", pixel.pixel);
        compared += 1;
    }
    assert!(compared > 2000, "{compared}");
}
