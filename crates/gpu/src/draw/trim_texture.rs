//! The trim texture of Krishnamurthy, Khardekar and McMains 2009, section 7: loops as fans of triangles from
//! one point, drawn so that each turns what it covers, several faces to a texture through its colour
//! channels.
//!
//! 1. Each face gets a rectangle of texels; rectangles are packed onto planes, four planes (the channels)
//!    a layer.
//! 2. Each piece of its loops is cut into chords that keep within an eighth of a texel.
//! 3. One pass a layer draws all fans, four samples a texel. Triangles turn 0 into 1 and 1 into 0 at every
//!    sample; the texture keeps the share of the samples that are inside.
//! 4. Drawing a face samples its channel between the texels and discards what has less than a half.
//!
//! Unlike the exact test it has the resolution that it was made for: closer up, curves show the texels.

use super::pipelines::{bind_group, module};
use crate::device::Gpu;
use crate::error::{GpuError, Resource};
use crate::evaluate::storage;
use crate::faces::Cubic;
use crate::shaders;
use bytemuck::{Pod, Zeroable};
use wgpu::{Buffer, RenderPipeline, TextureFormat, TextureUsages, TextureView};

const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
const SAMPLES: u32 = 4;
/// Texels along a side of a layer, at most.
const PAGE: u32 = 2048;
/// Layers of one texture at most, beyond which resolution is halved.
const LAYERS: u32 = 32;

/// The rectangle of a face's trim: layer, channel, place and size in texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Slot {
    pub layer: u32,
    pub channel: u32,
    pub at: [u32; 2],
    pub size: [u32; 2],
}

impl Slot {
    /// Texture coordinates of its corner, and its size in them.
    pub fn rectangle(&self, page: u32) -> [f32; 4] {
        [self.at[0], self.at[1], self.size[0], self.size[1]].map(|x| x as f32 / page as f32)
    }
}

/// As `Fan` in `trim_texture.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Fan {
    piece: u32,
    slot: u32,
    step: u32,
    steps: u32,
}

/// As `Slot` there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct SlotData {
    corner: [f32; 2],
    size: [f32; 2],
    color: [f32; 4],
}

/// The pipeline that draws trim textures.
#[derive(Debug)]
pub(crate) struct TrimTextures {
    fans: RenderPipeline,
    pub sampler: wgpu::Sampler,
}

/// The trims of some faces.
#[derive(Debug)]
pub(crate) struct TrimTexture {
    pub view: TextureView,
    pub page: u32,
    pub slots: Vec<Slot>,
    #[cfg(test)]
    texture: wgpu::Texture,
}

/// One face to be drawn: the texels that it needs, its loops, and the number of their first piece in the
/// buffer.
pub(crate) struct Trimmed<'a> {
    pub texels: [f64; 2],
    pub loops: &'a [Cubic],
    pub first: u32,
}

impl TrimTextures {
    pub fn new(gpu: &Gpu) -> Self {
        // Where the fragment is 1, 1 - dst replaces dst; where it is 0, dst stays.
        let turn = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::OneMinusDst,
            dst_factor: wgpu::BlendFactor::OneMinusSrc,
            operation: wgpu::BlendOperation::Add,
        };
        let module = module(gpu, shaders::TRIM_TEXTURE);
        let target = wgpu::ColorTargetState {
            format: FORMAT,
            blend: Some(wgpu::BlendState { color: turn, alpha: turn }),
            write_mask: wgpu::ColorWrites::ALL,
        };
        let fans = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("trim texture"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("fan_vertex"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState { count: SAMPLES, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fan_fragment"),
                compilation_options: Default::default(),
                targets: &[Some(target)],
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("trim texture"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { fans, sampler }
    }

    /// Draws the trims of some faces, whose pieces are in `cubics`.
    pub fn draw(&self, gpu: &Gpu, faces: &[Trimmed], cubics: &Buffer) -> Result<TrimTexture, GpuError> {
        let limits = gpu.device.limits();
        let page_limit = PAGE.min(limits.max_texture_dimension_2d);
        let layer_limit = LAYERS.min(limits.max_texture_array_layers);
        let rectangles: Vec<_> = faces.iter().map(|f| f.texels).collect();
        let (page, layers, slots) = pack_within(&rectangles, page_limit, layer_limit);
        let texture = |layers: u32, samples: u32, usage: TextureUsages| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("trim texture"),
                size: wgpu::Extent3d { width: page, height: page, depth_or_array_layers: layers },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage,
                view_formats: &[],
            })
        };
        let attachment = TextureUsages::RENDER_ATTACHMENT;
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
        let kept = texture(layers, 1, usage);
        // Not resolved into its layer at once: Mesa 22's lavapipe resolves into the first layer whichever is
        // given.
        let resolved = texture(1, 1, attachment | TextureUsages::COPY_SRC);
        let resolved_view = resolved.create_view(&Default::default());
        let samples = texture(1, SAMPLES, attachment).create_view(&Default::default());
        let data: Vec<_> = slots.iter().map(|slot| slot_data(slot, page)).collect();
        let slot_buffer = storage(gpu, Resource::TrimRectangles, &data)?;
        let most = (gpu.binding_limit() as usize / size_of::<Fan>()).max(1);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for layer in 0..layers {
            let fans = fans_of(faces, &slots, layer);
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("trim texture"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &samples,
                    depth_slice: None,
                    resolve_target: Some(&resolved_view),
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Discard,
                    },
                })],
                ..Default::default()
            });
            pass.set_pipeline(&self.fans);
            for some in fans.chunks(most) {
                let buffer = storage(gpu, Resource::TrimFans, some)?;
                let bound = [(0, cubics), (1, &buffer), (2, &slot_buffer)];
                pass.set_bind_group(0, &bind_group(gpu, &self.fans, &bound), &[]);
                pass.draw(0..3 * some.len() as u32, 0..1);
            }
            drop(pass);
            let to = wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
                ..kept.as_image_copy()
            };
            encoder.copy_texture_to_texture(resolved.as_image_copy(), to, resolved.size());
        }
        gpu.queue.submit([encoder.finish()]);
        let view = kept.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(TrimTexture {
            view,
            page,
            slots,
            #[cfg(test)]
            texture: kept,
        })
    }
}

/// Clip coordinates of a slot; its rows run downwards, as texture coordinates do.
fn slot_data(slot: &Slot, page: u32) -> SlotData {
    let [x, y, w, h] = slot.rectangle(page);
    let mut color = [0.0; 4];
    color[slot.channel as usize] = 1.0;
    SlotData { corner: [2.0 * x - 1.0, 1.0 - 2.0 * y], size: [2.0 * w, -2.0 * h], color }
}

/// The triangles of all pieces of the faces on a layer.
fn fans_of(faces: &[Trimmed], slots: &[Slot], layer: u32) -> Vec<Fan> {
    let mut fans = Vec::new();
    for (index, (face, slot)) in faces.iter().zip(slots).enumerate().filter(|(_, (_, s))| s.layer == layer) {
        for (k, piece) in face.loops.iter().enumerate() {
            let bend = piece.second() * glam::DVec2::from(slot.size.map(f64::from));
            // A chord of 1/n departs from the curve by bend / (8 n²) at most.
            let steps = bend.max_element().sqrt().ceil().clamp(1.0, 256.0) as u32;
            let piece = face.first + k as u32;
            fans.extend((0..steps).map(|step| Fan { piece, slot: index as u32, step, steps }));
        }
    }
    fans
}

/// Packs rectangles; halves them until they fit into the layers that there are. Returns the side of a layer,
/// the number of layers and the slots.
fn pack_within(rectangles: &[[f64; 2]], page_limit: u32, layer_limit: u32) -> (u32, u32, Vec<Slot>) {
    let mut scale = 1.0;
    loop {
        let sizes: Vec<_> = rectangles
            .iter()
            .map(|rectangle| rectangle.map(|x| ((x * scale).ceil() as u32).clamp(1, page_limit)))
            .collect();
        let largest = sizes.iter().flatten().copied().max().unwrap_or(1);
        let area: f64 = sizes.iter().map(|s| f64::from(s[0]) * f64::from(s[1])).sum();
        // About as large as all rectangles need in four channels, with a fifth for gaps.
        let side = (1.2 * area / 4.0).sqrt().ceil() as u32;
        let page = side.max(largest).clamp(1, page_limit);
        let (planes, slots) = pack(&sizes, page);
        let layers = planes.div_ceil(4).max(1);
        if layers <= layer_limit || scale < 1e-3 {
            return (page, layers, slots);
        }
        scale *= 0.5;
    }
}

/// Puts rectangles on shelves of planes of `page` × `page`, the tallest first; the number of planes, and a
/// slot for each.
fn pack(sizes: &[[u32; 2]], page: u32) -> (u32, Vec<Slot>) {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&k| std::cmp::Reverse(sizes[k][1]));
    let mut slots = vec![Slot::default(); sizes.len()];
    let (mut plane, mut x, mut y, mut shelf) = (0, 0, 0, 0);
    for k in order {
        let [width, height] = sizes[k];
        if x + width > page {
            (x, y, shelf) = (0, y + shelf, 0);
        }
        if y + height > page {
            (plane, x, y, shelf) = (plane + 1, 0, 0, 0);
        }
        slots[k] = Slot { layer: plane / 4, channel: plane % 4, at: [x, y], size: [width, height] };
        x += width;
        shelf = shelf.max(height);
    }
    (if sizes.is_empty() { 0 } else { plane + 1 }, slots)
}

#[cfg(test)]
#[path = "trim_texture_tests.rs"]
mod tests;
