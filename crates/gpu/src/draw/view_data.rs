//! The view and the placements as the shaders read them.

use super::{Background, Camera, RenderOptions, Style};
use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DMat4, DVec3, Mat4};

/// As `View` in `view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct ViewData {
    projection: [[f32; 4]; 4],
    viewport: [f32; 2],
    line_width: f32,
    eye: f32,
    line_color: [f32; 4],
    fill: [f32; 4],
    depth: [f32; 4],
    section: [f32; 4],
}

/// As `Placement` in `view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct PlacementData {
    view: [[f32; 4]; 4],
    normal: [[f32; 4]; 3],
    color: [f32; 4],
}

/// The view as the shaders read it.
pub(crate) fn view_data(camera: &Camera, options: &RenderOptions) -> ViewData {
    let [width, height] = options.size.map(|s| s as f32);
    let dark = options.background.is_dark();
    let background = match options.background {
        Background::Color(c) => c.map(|x| x as f32),
        Background::Transparent => [1.0; 3],
    };
    let line = if dark && options.style == Style::Edges { 0.80 } else { 0.012 };
    let fill = if options.style == Style::Edges { 1.0 } else { 0.0 };
    // Lines keep their share of larger pictures.
    let width_of_lines =
        (height / 800.0).max(1.0) * if options.style == Style::Wireframe { 0.8 } else { 1.4 };
    let section = options.section.map_or([0.0; 4], |s| {
        let normal = camera.view.matrix3 * s.normal;
        let offset = s.offset + normal.dot(camera.view.translation);
        normal.extend(offset).as_vec4().to_array()
    });
    ViewData {
        projection: camera.projection.as_mat4().to_cols_array_2d(),
        viewport: [width, height],
        line_width: width_of_lines,
        eye: camera.distance.unwrap_or(0.0) as f32,
        line_color: [line, line, line * 1.15, 1.0],
        fill: [background[0], background[1], background[2], fill],
        depth: [camera.pixel as f32, 0.0, 0.0, 0.0],
        section,
    }
}

/// One placement as the shaders read it; composed in double precision, so that places far from the origin keep their digits.
pub(crate) fn placement(camera: &Camera, world: &DAffine3, color: Option<[f32; 4]>) -> PlacementData {
    let view = camera.view * *world;
    // Normals turn with the inverse transpose; a mirror turns their sense too.
    let mirrored = view.matrix3.determinant().signum();
    let normal = view.matrix3.inverse().transpose() * mirrored;
    let column = |v: DVec3| v.normalize_or_zero().extend(0.0).as_vec4().to_array();
    let scale = normal.col(0).length().max(normal.col(1).length()).max(normal.col(2).length());
    let scaled = |v: DVec3| (v / scale).extend(0.0).as_vec4().to_array();
    let columns = [normal.col(0), normal.col(1), normal.col(2)];
    let finite = columns.iter().all(|c| c.is_finite()) && scale > 0.0;
    PlacementData {
        view: Mat4::to_cols_array_2d(&DMat4::from(view).as_mat4()),
        normal: if finite {
            columns.map(scaled)
        } else {
            [view.matrix3.x_axis, view.matrix3.y_axis, view.matrix3.z_axis].map(column)
        },
        color: color.map_or([0.0; 4], |c| [c[0], c[1], c[2], 1.0]),
    }
}
