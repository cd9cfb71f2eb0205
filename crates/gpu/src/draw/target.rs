//! The textures that a picture is drawn into, and its way to the host.

use super::options::Background;
use super::picture::Picture;
use super::pipelines::{COLOR, DEPTH, SAMPLES};
use super::srgb::{linear, srgb};
use crate::device::Gpu;
use crate::error::{GpuError, Task};
use crate::evaluate::read_back;
use wgpu::{BufferUsages, RenderPass};

/// The textures that a picture is drawn into.
#[derive(Debug)]
pub(crate) struct Target {
    pub size: [u32; 2],
    samples: wgpu::TextureView,
    depth: wgpu::TextureView,
    resolved: wgpu::Texture,
}

impl Target {
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if size.iter().any(|&s| s == 0 || s > limit) {
            let [width, height] = size;
            return Err(GpuError::PictureSize { width, height, limit, adapter: gpu.name().into() });
        }
        let texture = |format, sample_count, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("picture"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        gpu.watched(Task::Allocating, || {
            Ok(Self {
                size,
                samples: texture(COLOR, SAMPLES, attachment).create_view(&Default::default()),
                depth: texture(DEPTH, SAMPLES, attachment).create_view(&Default::default()),
                resolved: texture(COLOR, 1, attachment | wgpu::TextureUsages::COPY_SRC),
            })
        })
    }

    pub fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder, background: Background) -> RenderPass<'e> {
        let clear = match background {
            Background::Color([r, g, b]) => wgpu::Color { r, g, b, a: 1.0 },
            Background::Transparent => wgpu::Color::TRANSPARENT,
        };
        let resolved = self.resolved.create_view(&Default::default());
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.samples,
                depth_slice: None,
                resolve_target: Some(&resolved),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Discard },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// The picture on the host.
    pub fn read(&self, gpu: &Gpu, background: Background) -> Result<Picture, GpuError> {
        let [width, height] = self.size;
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(row) * u64::from(height);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pixels"),
            size: bytes,
            usage: BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            self.resolved.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            self.resolved.size(),
        );
        gpu.queue.submit([encoder.finish()]);
        let data = read_back(gpu, &buffer, bytes)?;
        let transparent = background == Background::Transparent;
        let pixels = data
            .chunks_exact(row as usize)
            .flat_map(|line| line[..4 * width as usize].chunks_exact(4))
            .map(|p| [p[0], p[1], p[2], p[3]])
            .map(|p| if transparent { unmultiplied(p) } else { p })
            .collect();
        Ok(Picture { width, height, pixels })
    }
}

/// Where samples of a pixel saw nothing, their black is taken out of its colour.
fn unmultiplied([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    if a == 0 || a == 255 {
        return [r, g, b, a];
    }
    let opacity = f64::from(a) / 255.0;
    let channel = |x: u8| (srgb((linear(f64::from(x) / 255.0) / opacity).min(1.0)) * 255.0).round() as u8;
    [channel(r), channel(g), channel(b), a]
}
