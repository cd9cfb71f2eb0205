//! Takes pictures of meshes and of exact surfaces, with four samples a pixel.

use super::mesh_groups::{Lines, Triangles};
use super::mesh_shapes::scene_outline;
use super::options::{Background, RenderOptions};
use super::picture::Picture;
use super::pipelines::{bind_group, pipeline};
use super::shapes::Scenery;
use super::target::Target;
use super::view_data::{PlacementData, ViewData, standing, view_data};
use crate::device::Gpu;
use crate::error::{GpuError, Resource, Task};
use crate::evaluate::empty_storage;
use crate::shaders;
use chordal_mesh::Scene;
use std::ops::Range;
use wgpu::{Buffer, BufferUsages, RenderPass, RenderPipeline};

/// The pipelines of mesh pictures.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) faces: RenderPipeline,
    pub(crate) lines: RenderPipeline,
}

impl Renderer {
    /// Compiles the shaders.
    ///
    /// # Errors
    /// What [`Gpu::watched`] gives.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Unorm8x4, 3 => Uint32];
        let corners = wgpu::VertexBufferLayout {
            array_stride: size_of::<super::Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let entries = ["vertex", "fragment"];
        gpu.watched(Task::CompilingShaders, || {
            Ok(Self {
                faces: pipeline(gpu, shaders::MESH, entries, &[Some(corners)]),
                lines: pipeline(gpu, shaders::LINES, entries, &[]),
            })
        })
    }

    /// Takes a picture of meshes.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] for pictures or parts beyond the device, and what [`Gpu::watched`] gives.
    pub fn render(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        scenery: &Scenery,
        options: &RenderOptions,
    ) -> Result<Picture, GpuError> {
        let camera = options.camera(&scene_outline(scene));
        let target = Target::new(gpu, options.size)?;
        gpu.watched(Task::Drawing, || {
            let stage = Stage::new(gpu, scenery.placed.len())?;
            let mut placed = vec![0..0; scenery.shapes.len()];
            let mut first = 0;
            for of_shape in scenery.placed.chunk_by(|a, b| a.shape == b.shape) {
                placed[of_shape[0].shape] = first..first + of_shape.len() as u32;
                first += of_shape.len() as u32;
            }
            let data: Vec<_> = standing(scenery).iter().map(|s| s.in_view(&camera)).collect();
            stage.set(gpu, &view_data(&camera, options), &data);
            let triangles = Triangles::upload(gpu, &scenery.shapes)?;
            let lines = Lines::upload(gpu, &self.lines, &scenery.shapes, stage.buffers())?;
            draw(gpu, &target, options.background, |pass| {
                self.draw_triangles(gpu, pass, &stage, &triangles, &placed);
                if options.lines {
                    self.draw_lines(pass, &lines, &placed);
                }
            });
            Ok(())
        })?;
        target.read(gpu, options.background)
    }

    pub(crate) fn draw_triangles(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass,
        stage: &Stage,
        triangles: &[Triangles],
        placed: &[Range<u32>],
    ) {
        let [view, placements] = stage.buffers();
        pass.set_pipeline(&self.faces);
        pass.set_bind_group(0, &bind_group(gpu, &self.faces, &[(0, view), (1, placements)]), &[]);
        triangles.iter().for_each(|group| group.draw(pass, placed));
    }

    pub(crate) fn draw_lines(&self, pass: &mut RenderPass, lines: &[Lines], placed: &[Range<u32>]) {
        pass.set_pipeline(&self.lines);
        lines.iter().for_each(|group| group.draw(pass, placed));
    }
}

/// Records one pass over a target and submits it.
pub(crate) fn draw(gpu: &Gpu, target: &Target, background: Background, record: impl FnOnce(&mut RenderPass)) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record(&mut target.begin(&mut encoder, background));
    gpu.queue.submit([encoder.finish()]);
}

/// The buffers of what changes with the view: the view itself and where parts stand in it.
#[derive(Debug)]
pub(crate) struct Stage {
    view: Buffer,
    placements: Buffer,
}

impl Stage {
    /// Makes room for a number of placements.
    pub fn new(gpu: &Gpu, placements: usize) -> Result<Self, GpuError> {
        let view = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: size_of::<ViewData>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bytes = (placements.max(1) * size_of::<PlacementData>()) as u64;
        let placements = empty_storage(gpu, Resource::Placements, bytes, BufferUsages::empty())?;
        Ok(Self { view, placements })
    }

    pub fn set(&self, gpu: &Gpu, view: &ViewData, placements: &[PlacementData]) {
        gpu.queue.write_buffer(&self.view, 0, bytemuck::bytes_of(view));
        if !placements.is_empty() {
            gpu.queue.write_buffer(&self.placements, 0, bytemuck::cast_slice(placements));
        }
    }

    pub fn buffers(&self) -> [&Buffer; 2] {
        [&self.view, &self.placements]
    }
}
