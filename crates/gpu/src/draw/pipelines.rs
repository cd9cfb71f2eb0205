//! Pipelines for drawing into pictures, and what is bound to them.

use crate::device::Gpu;
use crate::shaders::Shader;
use wgpu::{BindGroup, BindingResource, Buffer, RenderPipeline, ShaderModule, TextureFormat};

/// The formats of pictures, and the samples of each of their pixels.
pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8UnormSrgb;
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;
pub(crate) const SAMPLES: u32 = 4;

/// A bind group of whole buffers, for a layout that the shader implies.
pub(crate) fn bind_group(gpu: &Gpu, pipeline: &RenderPipeline, buffers: &[(u32, &Buffer)]) -> BindGroup {
    let resources: Vec<_> = buffers.iter().map(|(binding, b)| (*binding, b.as_entire_binding())).collect();
    bind_resources(gpu, pipeline, 0, resources)
}

/// A bind group of buffers, textures and samplers, by the number of the group.
pub(crate) fn bind_resources(
    gpu: &Gpu,
    pipeline: &RenderPipeline,
    group: u32,
    resources: Vec<(u32, BindingResource)>,
) -> BindGroup {
    let entries: Vec<_> =
        resources.into_iter().map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(group),
        entries: &entries,
    })
}

pub(crate) fn module(gpu: &Gpu, shader: Shader) -> ShaderModule {
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(shader.name),
        source: wgpu::ShaderSource::Wgsl(shader.source::<f32>().into()),
    })
}

/// A pipeline of two entry points of a shader for triangles seen from both sides.
pub(crate) fn pipeline(
    gpu: &Gpu,
    shader: Shader,
    [vertex, fragment]: [&str; 2],
    buffers: &[Option<wgpu::VertexBufferLayout>],
) -> RenderPipeline {
    pipeline_into(gpu, shader, [vertex, fragment], buffers, (&[COLOR], SAMPLES))
}

/// As [`pipeline`], into targets of other formats, with a number of samples per pixel.
pub(crate) fn pipeline_into(
    gpu: &Gpu,
    shader: Shader,
    [vertex, fragment]: [&str; 2],
    buffers: &[Option<wgpu::VertexBufferLayout>],
    (targets, count): (&[TextureFormat], u32),
) -> RenderPipeline {
    let module = module(gpu, shader);
    let targets: Vec<_> = targets.iter().map(|&format| Some(format.into())).collect();
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
        multisample: wgpu::MultisampleState { count, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
