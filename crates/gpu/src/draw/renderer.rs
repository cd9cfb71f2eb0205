//! Draws a scenery into a picture, with four samples a pixel.

use super::exact::refine_lines;
use super::mesh_shapes::{scene_outline, scenery_of};
use super::{
    Background, Camera, ExactRenderer, Picture, Placed, RenderOptions, Scenery, Style, linear, srgb,
};
use crate::evaluate::{read_back, storage};
use crate::{ExactModel, Gpu, GpuError, Shader, shaders};
use bytemuck::{Pod, Zeroable};
use chordal_brep::Model;
use chordal_mesh::Scene;
use glam::{DAffine3, DMat4, DVec3, Mat4};
use std::ops::Range;
use wgpu::{BindGroup, Buffer, BufferUsages, RenderPass, RenderPipeline, TextureFormat};

const COLOR: TextureFormat = TextureFormat::Rgba8UnormSrgb;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;
const SAMPLES: u32 = 4;

/// As `View` in `view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
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
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct PlacementData {
    view: [[f32; 4]; 4],
    normal: [[f32; 4]; 3],
    color: [f32; 4],
}

/// The pipelines of mesh pictures.
#[derive(Debug)]
pub struct Renderer {
    faces: RenderPipeline,
    lines: RenderPipeline,
}

/// The buffers of some shapes, none of which is cut.
struct Group {
    vertices: Buffer,
    indices: Buffer,
    lines: BindGroup,
    draws: Vec<Draw>,
}

struct Draw {
    indices: Range<u32>,
    base_vertex: i32,
    line_vertices: Range<u32>,
    placed: Range<u32>,
}

impl Group {
    fn draw_faces(&self, pass: &mut RenderPass) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for draw in self.draws.iter().filter(|d| !d.indices.is_empty()) {
            pass.draw_indexed(draw.indices.clone(), draw.base_vertex, draw.placed.clone());
        }
    }

    fn draw_lines(&self, pass: &mut RenderPass) {
        pass.set_bind_group(0, &self.lines, &[]);
        for draw in self.draws.iter().filter(|d| !d.line_vertices.is_empty()) {
            pass.draw(draw.line_vertices.clone(), draw.placed.clone());
        }
    }
}

impl Renderer {
    /// Compiles the shaders.
    ///
    /// # Errors
    /// What [`Gpu::watched`] gives.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Unorm8x4];
        let corners = wgpu::VertexBufferLayout {
            array_stride: size_of::<super::Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let entries = ["vertex", "fragment"];
        gpu.watched("compiling shaders", || {
            Ok(Self {
                faces: pipeline(gpu, shaders::FACES, entries, &[Some(corners)]),
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
        Ok(self.picture(gpu, scenery, &camera, options, None)?.0)
    }

    /// Takes a picture of the exact faces of a model; what has no exact form is drawn as its mesh. Also the number of
    /// points evaluated. Styles that measure or show the mesh are drawn from it, by [`Self::render`].
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_exact(
        &self,
        gpu: &Gpu,
        exact: (&ExactRenderer, &ExactModel),
        (scene, model): (&Scene, &Model),
        options: &RenderOptions,
    ) -> Result<(Picture, usize), GpuError> {
        let camera = options.camera(&scene_outline(scene));
        let (mut scenery, _) = scenery_of(scene, model, options.style, Some(exact.1));
        refine_lines(&mut scenery, scene, model, &camera);
        self.picture(gpu, &scenery, &camera, options, Some(exact))
    }

    fn picture(
        &self,
        gpu: &Gpu,
        scenery: &Scenery,
        camera: &Camera,
        options: &RenderOptions,
        exact: Option<(&ExactRenderer, &ExactModel)>,
    ) -> Result<(Picture, usize), GpuError> {
        let target = Target::new(gpu, options.size)?;
        let points = gpu.watched("drawing", || {
            let view = view_buffer(gpu, camera, options);
            let to_data = |p: &Placed| {
                let local = DAffine3::from_translation(scenery.shapes[p.shape].middle);
                placement(camera, &(p.world * local), p.color)
            };
            let placements: Vec<_> = scenery.placed.iter().map(to_data).collect();
            let placements = storage(gpu, "the placements of all parts", &placements)?;
            let scene = bind_group(gpu, &self.faces, &[(0, &view), (1, &placements)]);
            let groups = self.groups(gpu, scenery, &view, &placements)?;
            let frame = match exact {
                Some((renderer, model)) => {
                    Some((renderer, renderer.frame(gpu, model, scenery, camera, &view, &placements)?))
                }
                None => None,
            };
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = target.begin(&mut encoder, options.background);
                pass.set_pipeline(&self.faces);
                pass.set_bind_group(0, &scene, &[]);
                groups.iter().for_each(|group| group.draw_faces(&mut pass));
                if let Some((renderer, frame)) = &frame {
                    renderer.draw(&mut pass, frame);
                }
                if options.lines {
                    pass.set_pipeline(&self.lines);
                    groups.iter().for_each(|group| group.draw_lines(&mut pass));
                }
            }
            gpu.queue.submit([encoder.finish()]);
            Ok(frame.map_or(0, |(_, frame)| frame.points))
        })?;
        Ok((target.read(gpu, options.background)?, points))
    }

    /// Buffers for the shapes that are placed, as many to a group as the limits allow.
    fn groups(
        &self,
        gpu: &Gpu,
        scenery: &Scenery,
        view: &Buffer,
        placements: &Buffer,
    ) -> Result<Vec<Group>, GpuError> {
        let limit = gpu.binding_limit() as usize;
        let mut groups = Vec::new();
        let mut pending = Pending::default();
        let mut first = 0;
        for of_shape in scenery.placed.chunk_by(|a, b| a.shape == b.shape) {
            let shape = &scenery.shapes[of_shape[0].shape];
            let placed = first..first + of_shape.len() as u32;
            first = placed.end;
            if !pending.is_empty() && pending.bytes_with(shape) > limit {
                groups.push(self.upload(gpu, std::mem::take(&mut pending), view, placements)?);
            }
            pending.push(shape, placed);
        }
        if !pending.is_empty() {
            groups.push(self.upload(gpu, pending, view, placements)?);
        }
        Ok(groups)
    }

    fn upload(
        &self,
        gpu: &Gpu,
        pending: Pending,
        view: &Buffer,
        placements: &Buffer,
    ) -> Result<Group, GpuError> {
        let segments = storage(gpu, "the lines of one part", &pending.segments)?;
        Ok(Group {
            vertices: plain_buffer(gpu, "the vertices of one part", &pending.vertices, BufferUsages::VERTEX)?,
            indices: plain_buffer(gpu, "the triangles of one part", &pending.triangles, BufferUsages::INDEX)?,
            lines: bind_group(gpu, &self.lines, &[(0, view), (1, placements), (2, &segments)]),
            draws: pending.draws,
        })
    }
}

/// Shapes gathered for one group.
#[derive(Default)]
struct Pending {
    vertices: Vec<super::Vertex>,
    triangles: Vec<[u32; 3]>,
    segments: Vec<[[f32; 3]; 2]>,
    draws: Vec<Draw>,
}

impl Pending {
    fn is_empty(&self) -> bool {
        self.draws.is_empty()
    }

    /// Bytes of the largest of the buffers, had the shape been added.
    fn bytes_with(&self, shape: &super::Shape) -> usize {
        let vertices = (self.vertices.len() + shape.vertices.len()) * size_of::<super::Vertex>();
        vertices
            .max((self.triangles.len() + shape.triangles.len()) * 12)
            .max((self.segments.len() + shape.segments.len()) * 24)
    }

    fn push(&mut self, shape: &super::Shape, placed: Range<u32>) {
        let (triangles, segments) = (self.triangles.len() as u32, self.segments.len() as u32);
        self.draws.push(Draw {
            indices: 3 * triangles..3 * (triangles + shape.triangles.len() as u32),
            base_vertex: self.vertices.len() as i32,
            line_vertices: 6 * segments..6 * (segments + shape.segments.len() as u32),
            placed,
        });
        self.vertices.extend_from_slice(&shape.vertices);
        self.triangles.extend_from_slice(&shape.triangles);
        self.segments.extend_from_slice(&shape.segments);
    }
}

/// A vertex or index buffer.
fn plain_buffer<T: Pod>(gpu: &Gpu, what: &str, data: &[T], usage: BufferUsages) -> Result<Buffer, GpuError> {
    let bytes: &[u8] = bytemuck::cast_slice(data);
    let limit = gpu.device.limits().max_buffer_size;
    if bytes.len() as u64 > limit {
        let adapter = gpu.name().into();
        return Err(GpuError::TooLarge { what: what.into(), bytes: bytes.len() as u64, limit, adapter });
    }
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what),
        size: bytes.len().max(64) as u64,
        usage: usage | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    if !bytes.is_empty() {
        gpu.queue.write_buffer(&buffer, 0, bytes);
    }
    Ok(buffer)
}

/// The view as the shaders read it.
pub(crate) fn view_buffer(gpu: &Gpu, camera: &Camera, options: &RenderOptions) -> Buffer {
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
    let data = ViewData {
        projection: camera.projection.as_mat4().to_cols_array_2d(),
        viewport: [width, height],
        line_width: width_of_lines,
        eye: camera.distance.unwrap_or(0.0) as f32,
        line_color: [line, line, line * 1.15, 1.0],
        fill: [background[0], background[1], background[2], fill],
        depth: [camera.pixel as f32, 0.0, 0.0, 0.0],
        section,
    };
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("view"),
        size: size_of::<ViewData>() as u64,
        usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&data));
    buffer
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

/// A bind group of uniform and storage buffers, for a layout that the shader implies.
pub(crate) fn bind_group(gpu: &Gpu, pipeline: &RenderPipeline, buffers: &[(u32, &Buffer)]) -> BindGroup {
    let entries: Vec<_> = buffers
        .iter()
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    })
}

/// A pipeline of two entry points of a shader for triangles seen from both sides.
pub(crate) fn pipeline(
    gpu: &Gpu,
    shader: Shader,
    [vertex, fragment]: [&str; 2],
    buffers: &[Option<wgpu::VertexBufferLayout>],
) -> RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(shader.name),
        source: wgpu::ShaderSource::Wgsl(shader.source::<f32>().into()),
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(shader.name),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers,
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::LessEqual),
            stencil: wgpu::StencilState::default(),
            // None: of slivers the slope is noise, and lines are moved nearer instead.
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: SAMPLES, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The textures that a picture is drawn into.
pub(crate) struct Target {
    size: [u32; 2],
    samples: wgpu::TextureView,
    depth: wgpu::TextureView,
    resolved: wgpu::Texture,
}

impl Target {
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if size.iter().any(|&s| s == 0 || s > limit) {
            let [width, height] = size;
            return Err(GpuError::Picture(format!(
                "{width} × {height} pixels are not between 1 and {limit} on {}",
                gpu.name()
            )));
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
        gpu.watched("making room for the picture", || {
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
