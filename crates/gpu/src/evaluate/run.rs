//! Dispatches: passes over basis rows where the variant has them, then one over all points of all surfaces.

use super::on_device::{empty_storage, storage};
use super::{OnDevice, Plan, Search, Variant, Wanted};
use crate::layout::Params;
use crate::{Gpu, GpuError, Real, Samples, Shader, SurfaceSet, shaders};
use std::marker::PhantomData;
use std::ops::Range;
use wgpu::{BindGroup, Buffer, BufferUsages, ComputePass, ComputePipeline};

/// The compiled kernels of one variant.
#[derive(Debug)]
pub struct Evaluator<R> {
    variant: Variant,
    search: Search,
    passes: Option<ComputePipeline>,
    find: Option<ComputePipeline>,
    points: ComputePipeline,
    jets: ComputePipeline,
    real: PhantomData<R>,
}

/// Workgroups along one axis of a dispatch.
const MOST_GROUPS: u32 = 65_535;

impl<R: Real> Evaluator<R> {
    /// Compiles a variant.
    ///
    /// # Errors
    /// [`GpuError::Lacks`] for double precision on a device without it, and what [`Gpu::watched`] gives.
    pub fn new(gpu: &Gpu, variant: Variant, search: Search) -> Result<Self, GpuError> {
        if R::WGSL == "f64" && !gpu.has_f64() {
            return Err(GpuError::Lacks {
                adapter: gpu.name().into(),
                what: "double precision in shaders".into(),
            });
        }
        let (passes, points) = match variant {
            Variant::Packed => (Some(shaders::BASIS_PACKED), shaders::TENSOR),
            Variant::Unpacked => (Some(shaders::BASIS_UNPACKED), shaders::TENSOR),
            Variant::Indexed => (Some(shaders::BASIS_INDEXED), shaders::TENSOR),
            Variant::Direct => (None, shaders::DIRECT),
            Variant::Bernstein => (None, shaders::BERNSTEIN),
        };
        let find = (search == Search::Device).then_some(shaders::FIND_SPANS);
        gpu.watched("compiling kernels", || {
            Ok(Self {
                variant,
                search,
                passes: passes.map(|shader| pipeline::<R>(gpu, shader, "main")),
                find: find.map(|shader| pipeline::<R>(gpu, shader, "main")),
                points: pipeline::<R>(gpu, points, "points"),
                jets: pipeline::<R>(gpu, points, "jets"),
                real: PhantomData,
            })
        })
    }

    /// Uploads samples and makes room for the results. What is kept can be run again after an edit of the surfaces.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] where the rows of all parameters exceed a binding; points are split.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        surfaces: &OnDevice<R>,
        set: &SurfaceSet<R>,
        samples: &Samples<R>,
        wanted: Wanted,
    ) -> Result<Evaluation<R>, GpuError> {
        let plan = Plan::new(set, samples, self.variant, wanted, self.search)?;
        gpu.watched("preparing an evaluation", || {
            let rows = storage(gpu, "the rows of all parameters", &plan.tables.rows)?;
            let ts = storage(gpu, "all parameters", &samples.ts)?;
            let basis_bytes = 2 * (plan.tables.half * size_of::<R>()) as u64;
            let basis =
                empty_storage(gpu, "the basis functions of all rows", basis_bytes, BufferUsages::empty())?;
            let passes = match &self.passes {
                None => None,
                Some(passes) => {
                    let packs = storage(gpu, "packs", &plan.tables.packs)?;
                    let own = storage(gpu, "the knots of all rows", &plan.tables.windows)?;
                    let copied = self.variant != Variant::Indexed;
                    let buffers = match self.variant {
                        Variant::Packed => vec![(2, &packs), (4, &own), (7, &basis)],
                        _ if copied => vec![(2, &rows), (3, &surfaces.spans), (4, &own), (7, &basis)],
                        _ => vec![
                            (2, &rows),
                            (3, &surfaces.spans),
                            (4, &surfaces.windows),
                            (6, &ts),
                            (7, &basis),
                        ],
                    };
                    Some(bind(gpu, passes, &buffers))
                }
            };
            let find = match &self.find {
                None => None,
                Some(find) => {
                    let (directions, breaks) = set.search_tables();
                    let directions = storage(gpu, "the directions of all surfaces", &directions)?;
                    let breaks = storage(gpu, "all distinct knots", &breaks)?;
                    let parameters = storage(gpu, "all parameters", &samples.parameters)?;
                    let buffers = [(0, &directions), (1, &breaks), (2, &rows), (5, &parameters), (7, &ts)];
                    Some((bind(gpu, find, &buffers), plan.tables.rows.len() as u32))
                }
            };
            let heads = storage(gpu, "the grids", &samples.heads)?;
            let tiles = storage(gpu, "the tiles of all grids", &samples.tiles)?;
            let net = if self.variant == Variant::Bernstein { &surfaces.bezier } else { &surfaces.net };
            let last = if self.passes.is_some() { &basis } else { &ts };
            let mut outputs = Vec::new();
            for batch in batches(samples, wanted.stride() * size_of::<R>(), gpu.binding_limit())? {
                let bytes = (batch.points.len() * wanted.stride() * size_of::<R>()) as u64;
                let out = empty_storage(gpu, "the points", bytes, BufferUsages::VERTEX)?;
                let kernel = self.kernel(wanted);
                let group = bind(
                    gpu,
                    kernel,
                    &[
                        (0, &heads),
                        (1, &tiles),
                        (2, &rows),
                        (3, &surfaces.spans),
                        (4, &surfaces.windows),
                        (5, net),
                        (6, last),
                        (7, &out),
                    ],
                );
                outputs.push(Output { batch, out, group });
            }
            let levels = plan.tables.levels;
            let pass_params = (1..=levels).map(|level| plan.params(level, self.variant)).collect();
            let params =
                Params { planes: plan.planes as u32, half: plan.tables.half as u32, ..Params::default() };
            Ok(Evaluation { wanted, passes, pass_params, find, outputs, params, real: PhantomData })
        })
    }

    fn kernel(&self, wanted: Wanted) -> &ComputePipeline {
        if wanted == Wanted::Points { &self.points } else { &self.jets }
    }

    /// Runs what was prepared; the points stay on the device.
    ///
    /// # Errors
    /// What [`Gpu::watched`] gives.
    pub fn run(&self, gpu: &Gpu, evaluation: &Evaluation<R>) -> Result<(), GpuError> {
        gpu.watched("evaluating", || {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                self.encode(&mut pass, evaluation);
            }
            gpu.queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    fn encode(&self, pass: &mut ComputePass, evaluation: &Evaluation<R>) {
        if let (Some(find), Some((group, rows))) = (&self.find, &evaluation.find) {
            let count = rows.div_ceil(64);
            let groups = count.clamp(1, MOST_GROUPS);
            pass.set_pipeline(find);
            pass.set_bind_group(0, group, &[]);
            pass.set_immediates(0, bytemuck::bytes_of(&Params { rows: *rows, groups, ..Params::default() }));
            pass.dispatch_workgroups(groups, count.div_ceil(groups), 1);
        }
        if let (Some(passes), Some(group)) = (&self.passes, &evaluation.passes) {
            pass.set_pipeline(passes);
            pass.set_bind_group(0, group, &[]);
            for params in &evaluation.pass_params {
                let count = params.rows.div_ceil(8);
                let groups = count.clamp(1, MOST_GROUPS);
                pass.set_immediates(0, bytemuck::bytes_of(&Params { groups, ..*params }));
                pass.dispatch_workgroups(params.columns.div_ceil(8), groups, count.div_ceil(groups));
            }
        }
        pass.set_pipeline(self.kernel(evaluation.wanted));
        for output in &evaluation.outputs {
            let tiles = &output.batch.tiles;
            let count = tiles.end - tiles.start;
            let groups = count.clamp(1, MOST_GROUPS);
            let params = Params {
                tile0: tiles.start,
                rows: tiles.end,
                out0: output.batch.points.start,
                groups,
                ..evaluation.params
            };
            pass.set_bind_group(0, &output.group, &[]);
            pass.set_immediates(0, bytemuck::bytes_of(&params));
            pass.dispatch_workgroups(groups, count.div_ceil(groups), 1);
        }
    }

    /// Prepares, runs and reads back.
    ///
    /// # Errors
    /// As [`Self::prepare`] and [`Self::run`].
    pub fn evaluate(
        &self,
        gpu: &Gpu,
        set: &SurfaceSet<R>,
        samples: &Samples<R>,
        wanted: Wanted,
    ) -> Result<Evaluated<R>, GpuError> {
        let surfaces = OnDevice::upload(gpu, set)?;
        let evaluation = self.prepare(gpu, &surfaces, set, samples, wanted)?;
        self.run(gpu, &evaluation)?;
        evaluation.read(gpu)
    }
}

/// Samples on the device, with room for their results.
#[derive(Debug)]
pub struct Evaluation<R> {
    wanted: Wanted,
    passes: Option<BindGroup>,
    pass_params: Vec<Params>,
    find: Option<(BindGroup, u32)>,
    outputs: Vec<Output>,
    params: Params,
    real: PhantomData<R>,
}

/// The points of one dispatch.
#[derive(Debug)]
struct Output {
    batch: Batch,
    out: Buffer,
    group: BindGroup,
}

#[derive(Clone, Debug)]
struct Batch {
    tiles: Range<u32>,
    points: Range<u32>,
}

/// Cuts the points between heads so that no output is larger than a binding.
fn batches<R: Real>(samples: &Samples<R>, point_bytes: usize, limit: u64) -> Result<Vec<Batch>, GpuError> {
    let mut found: Vec<Batch> = Vec::new();
    let mut tile = 0;
    for of_head in samples.tiles.chunk_by(|a, b| a.head == b.head) {
        let head = samples.heads[of_head[0].head as usize];
        let (end, tile_end) = (head.first + head.points(), tile + of_head.len() as u32);
        match found.last_mut() {
            Some(last) if u64::from(end - last.points.start) * point_bytes as u64 <= limit => {
                (last.tiles.end, last.points.end) = (tile_end, end);
            }
            _ => found.push(Batch { tiles: tile..tile_end, points: head.first..end }),
        }
        tile = tile_end;
    }
    Ok(found)
}

impl<R: Real> Evaluation<R> {
    /// The buffers that the points are in, with the range of points of each.
    pub fn buffers(&self) -> impl Iterator<Item = (&Buffer, Range<usize>)> {
        self.outputs.iter().map(|o| (&o.out, o.batch.points.start as usize..o.batch.points.end as usize))
    }

    /// Brings the results to the host.
    ///
    /// # Errors
    /// [`GpuError::Lost`], and what [`Gpu::watched`] gives.
    pub fn read(&self, gpu: &Gpu) -> Result<Evaluated<R>, GpuError> {
        let stride = self.wanted.stride();
        let mut values = Vec::new();
        for output in &self.outputs {
            let bytes = (output.batch.points.len() * stride * size_of::<R>()) as u64;
            let read = read_back(gpu, &output.out, bytes)?;
            values.extend(bytemuck::pod_collect_to_vec::<u8, R>(&read));
        }
        Ok(Evaluated { stride, values })
    }
}

/// Results on the host, in the local coordinates of each surface.
#[derive(Clone, Debug)]
pub struct Evaluated<R> {
    /// Numbers per point.
    pub stride: usize,
    pub values: Vec<R>,
}

fn pipeline<R: Real>(gpu: &Gpu, shader: Shader, entry: &str) -> ComputePipeline {
    // Said outright: a layout derived from the entry point would leave out what that one does not read.
    let entries: Vec<_> =
        shader.bindings.iter().map(|&(binding, read_only)| storage_entry(binding, read_only)).collect();
    let group = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(shader.name),
        entries: &entries,
    });
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(shader.name),
        bind_group_layouts: &[Some(&group)],
        immediate_size: size_of::<Params>() as u32,
    });
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(shader.name),
        source: wgpu::ShaderSource::Wgsl(shader.source::<R>().into()),
    });
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(shader.name),
        layout: Some(&layout),
        module: &module,
        entry_point: Some(entry),
        compilation_options: Default::default(),
        cache: None,
    })
}

fn storage_entry(binding: u32, read_only: bool) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

fn bind(gpu: &Gpu, pipeline: &ComputePipeline, buffers: &[(u32, &Buffer)]) -> BindGroup {
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

/// The first `bytes` of a buffer, after everything submitted before.
pub(crate) fn read_back(gpu: &Gpu, buffer: &Buffer, bytes: u64) -> Result<Vec<u8>, GpuError> {
    if bytes == 0 {
        return Ok(Vec::new());
    }
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: bytes,
        usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.watched("reading results", || {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, bytes);
        gpu.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, .., |_| {});
        gpu.wait()?;
        let view = staging
            .get_mapped_range(..)
            .map_err(|e| GpuError::Device { doing: "reading results".into(), reason: e.to_string() })?;
        Ok(view.to_vec())
    })
}
