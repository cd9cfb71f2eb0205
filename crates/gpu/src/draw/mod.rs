//! Drawing: scenes of meshes or of exact surfaces, without a window, into a picture.
//!
//! Files `mesh_*` draw meshes, files `face_*` draw exact faces; `renderer.rs` has what both share.

mod blocks;
mod camera;
mod choice;
mod device_store;
mod face_batch;
#[cfg(test)]
mod face_normal;
mod face_renderer;
mod face_scene;
mod false_color;
mod frame_counts;
mod mesh_groups;
mod mesh_shapes;
mod options;
mod picture;
mod pipelines;
mod renderer;
mod shapes;
mod srgb;
mod still_frame;
mod target;
mod trim_texture;
mod view_data;
mod view_lines;
mod visible;

pub use camera::{Camera, Projection, View};
pub use choice::PIXEL_ERROR;
pub use face_renderer::FaceRenderer;
pub use face_scene::FaceScene;
pub use frame_counts::FrameCounts;
pub use mesh_shapes::{Legend, mesh_scenery, scene_outline};
pub use options::{Background, Normals, RenderOptions, SectionPlane, Style, Trim};
pub use picture::Picture;
pub use renderer::Renderer;
pub use shapes::{Placed, Scenery, Shape, Vertex};
