//! The view and the placements as the shaders read them.

use super::camera::Camera;
use super::mesh_shapes::opacity;
use super::options::{Background, Normals, RenderOptions, Style};
use super::shapes::{Placed, Scenery};
use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DMat3, DMat4, Mat4};

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
        depth: [camera.pixel as f32, f32::from(u8::from(options.normals == Normals::Exact)), 0.0, 0.0],
        section,
    }
}

/// What of a placement does not change with the view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Standing {
    /// From about the middle of the shape to the world.
    world: DAffine3,
    /// Turns normals, at its longest by 1.
    normal: DMat3,
    color: [f32; 4],
}

impl Standing {
    fn new(world: DAffine3, color: Option<[f32; 4]>) -> Self {
        // Normals turn with the inverse transpose; a mirror turns their sense too.
        let m = world.matrix3;
        let turned = m.inverse().transpose() * m.determinant().signum();
        let scale = turned.x_axis.length().max(turned.y_axis.length()).max(turned.z_axis.length());
        let finite = turned.is_finite() && scale > 0.0;
        let flat = || {
            DMat3::from_cols(
                m.x_axis.normalize_or_zero(),
                m.y_axis.normalize_or_zero(),
                m.z_axis.normalize_or_zero(),
            )
        };
        Self {
            world,
            normal: if finite { turned * scale.recip() } else { flat() },
            color: color.map_or([0.0; 4], |c| [c[0], c[1], c[2], opacity(c)]),
        }
    }

    /// As the shaders read it; composed in double precision, so that places far from the origin keep their
    /// digits. The axes of a view are at right angles and of length 1: they turn normals as they turn points.
    pub fn in_view(&self, camera: &Camera) -> PlacementData {
        let normal = camera.view.matrix3 * self.normal;
        PlacementData {
            view: Mat4::to_cols_array_2d(&DMat4::from(camera.view * self.world).as_mat4()),
            normal: [normal.x_axis, normal.y_axis, normal.z_axis].map(|c| c.extend(0.0).as_vec4().to_array()),
            color: self.color,
        }
    }
}

/// Of all placements of a scenery.
pub(crate) fn standing(scenery: &Scenery) -> Vec<Standing> {
    let of = |p: &Placed| {
        let about = DAffine3::from_translation(scenery.shapes[p.shape].middle);
        Standing::new(p.world * about, p.color)
    };
    scenery.placed.iter().map(of).collect()
}
