//! Exact faces: the pipelines that evaluate and draw them.

use super::blocks::BlockIndices;
use super::options::Trim;
use super::pipelines::pipeline;
use super::trim_texture::TrimTextures;
use crate::device::Gpu;
use crate::error::{GpuError, Task};
use crate::evaluate::{KernelRunner, Search, Variant};
use crate::shaders;
use wgpu::RenderPipeline;

/// The pipelines of exact pictures.
#[derive(Debug)]
pub struct FaceRenderer {
    /// The fastest that was measured, and the one for surfaces whose Bézier nets exceed a binding.
    evaluators: [KernelRunner<f32>; 2],
    exact: RenderPipeline,
    textured: RenderPipeline,
    pub(crate) borders: RenderPipeline,
    pub(crate) textures: TrimTextures,
    pub(crate) indices: BlockIndices,
}

impl FaceRenderer {
    /// Compiles the kernels and shaders.
    ///
    /// # Errors
    /// What [`Gpu::watched`] gives.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let evaluators = [
            KernelRunner::new(gpu, Variant::Bernstein, Search::Host)?,
            KernelRunner::new(gpu, Variant::Direct, Search::Host)?,
        ];
        gpu.watched(Task::CompilingShaders, || {
            let of = |entries| pipeline(gpu, shaders::FACE, entries, &[]);
            Ok(Self {
                evaluators,
                exact: of(["vertex", "fragment"]),
                textured: of(["vertex", "fragment_texture"]),
                borders: of(["border_vertex", "border_fragment"]),
                textures: TrimTextures::new(gpu),
                indices: BlockIndices::new(gpu),
            })
        })
    }

    pub(crate) fn faces(&self, trim: Trim) -> &RenderPipeline {
        match trim {
            Trim::Exact => &self.exact,
            Trim::Texture => &self.textured,
        }
    }

    /// For sets with Bézier nets or without.
    pub(crate) fn evaluator(&self, has_bezier: bool) -> &KernelRunner<f32> {
        &self.evaluators[usize::from(!has_bezier)]
    }
}
