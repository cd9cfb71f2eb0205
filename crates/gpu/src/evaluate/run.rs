//! Dispatches: passes over basis rows where the variant has them, then one over all points of all surfaces.

use super::batches::batches as batches_of;
use super::on_device::OnDevice;
use super::on_device::{empty_storage, storage};
use super::plan::{Plan, Search, Variant, Wanted};
use crate::device::Gpu;
use crate::error::{Capability, GpuError, Resource, Task};
use crate::layout::Params;
use crate::real::Real;
use crate::samples::Samples;
use crate::shaders;
use crate::shaders::Shader;
use crate::surfaces::SurfaceSet;
use std::marker::PhantomData;
use std::ops::Range;
use wgpu::{BindGroup, Buffer, BufferUsages, ComputePass, ComputePipeline};

/// The compiled kernels of one variant.
#[derive(Debug)]
pub struct KernelRunner<R> {
    variant: Variant,
    search: Search,
    passes: Option<ComputePipeline>,
    find: Option<ComputePipeline>,
    points: ComputePipeline,
    normals: ComputePipeline,
    jets: ComputePipeline,
    real: PhantomData<R>,
}

/// Workgroups along one axis of a dispatch.
const MOST_GROUPS: u32 = 65_535;

impl<R: Real> KernelRunner<R> {
    /// Compiles a variant.
    ///
    /// # Errors
    /// [`GpuError::Lacks`] for double precision on a device without it, and what [`Gpu::watched`] gives.
    pub fn new(gpu: &Gpu, variant: Variant, search: Search) -> Result<Self, GpuError> {
        if R::WGSL == "f64" && !gpu.has_f64() {
            return Err(GpuError::Lacks { adapter: gpu.name().into(), what: Capability::DoublePrecision });
        }
        let (passes, points) = match variant {
            Variant::Packed => (Some(shaders::BASIS_PACKED), shaders::TENSOR),
            Variant::Unpacked => (Some(shaders::BASIS_UNPACKED), shaders::TENSOR),
            Variant::Indexed => (Some(shaders::BASIS_INDEXED), shaders::TENSOR),
            Variant::Direct => (None, shaders::DIRECT),
            Variant::Bernstein => (None, shaders::BERNSTEIN),
        };
        let find = (search == Search::Device).then_some(shaders::FIND_SPANS);
        gpu.watched(Task::CompilingKernels, || {
            Ok(Self {
                variant,
                search,
                passes: passes.map(|shader| pipeline::<R>(gpu, shader, "main")),
                find: find.map(|shader| pipeline::<R>(gpu, shader, "main")),
                points: pipeline::<R>(gpu, points, "points"),
                normals: pipeline::<R>(gpu, points, "normals"),
                jets: pipeline::<R>(gpu, points, "jets"),
                real: PhantomData,
            })
        })
    }

    /// Uploads samples and makes room for the results. What is kept can be run again after an edit of the
    /// surfaces.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] where one list of points, or the knots of the set, exceed a binding; samples
    /// are split.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        surfaces: &OnDevice<R>,
        set: &SurfaceSet<R>,
        samples: &Samples<R>,
        wanted: Wanted,
    ) -> Result<Evaluation<R>, GpuError> {
        gpu.watched(Task::PreparingEvaluation, || {
            let mut batches = Vec::new();
            let mut first = 0;
            for heads in batches_of(set, samples, (self.variant, wanted), gpu.binding_limit()) {
                let part = samples.part(heads);
                let points = first..first + part.len();
                first = points.end;
                batches.push(self.batch(gpu, surfaces, set, (&part, points), wanted)?);
            }
            Ok(Evaluation { wanted, batches, real: PhantomData })
        })
    }

    fn batch(
        &self,
        gpu: &Gpu,
        surfaces: &OnDevice<R>,
        set: &SurfaceSet<R>,
        (samples, points): (&Samples<R>, Range<usize>),
        wanted: Wanted,
    ) -> Result<Batch, GpuError> {
        let plan = Plan::new(set, samples, self.variant, wanted, self.search)?;
        let rows = storage(gpu, Resource::Rows, &plan.tables.rows)?;
        let ts = storage(gpu, Resource::Parameters, &samples.ts)?;
        let basis_bytes = 2 * (plan.tables.half * size_of::<R>()) as u64;
        let basis = empty_storage(gpu, Resource::BasisFunctions, basis_bytes, BufferUsages::empty())?;
        let heads = storage(gpu, Resource::Grids, &samples.heads)?;
        let tiles = storage(gpu, Resource::Tiles, &samples.tiles)?;
        let net = if self.variant == Variant::Bernstein { &surfaces.bezier } else { &surfaces.net };
        let last = if self.passes.is_some() { &basis } else { &ts };
        let bytes = (points.len() * wanted.stride() * size_of::<R>()) as u64;
        let out = empty_storage(gpu, Resource::Points, bytes, BufferUsages::VERTEX)?;
        let buffers = [
            (0, &heads),
            (1, &tiles),
            (2, &rows),
            (3, &surfaces.spans),
            (4, &surfaces.windows),
            (5, net),
            (6, last),
            (7, &out),
        ];
        let group = bind(gpu, self.kernel(wanted), &buffers);
        let levels = plan.tables.levels;
        Ok(Batch {
            passes: self.bind_passes(gpu, surfaces, &plan, (&rows, &ts, &basis))?,
            pass_params: (1..=levels).map(|level| plan.params(level, self.variant)).collect(),
            find: self.bind_find(gpu, set, samples, (&rows, &ts))?,
            rows: plan.tables.rows.len() as u32,
            tiles: samples.tiles.len() as u32,
            params: Params { planes: plan.planes as u32, half: plan.tables.half as u32, ..Params::default() },
            points,
            out,
            group,
        })
    }

    fn bind_passes(
        &self,
        gpu: &Gpu,
        surfaces: &OnDevice<R>,
        plan: &Plan<R>,
        (rows, ts, basis): (&Buffer, &Buffer, &Buffer),
    ) -> Result<Option<BindGroup>, GpuError> {
        let Some(passes) = &self.passes else { return Ok(None) };
        let packs = storage(gpu, Resource::PackedRows, &plan.tables.packs)?;
        let own = storage(gpu, Resource::KnotsOfRows, &plan.tables.windows)?;
        let buffers = match self.variant {
            Variant::Packed => vec![(2, &packs), (4, &own), (7, basis)],
            Variant::Unpacked => vec![(2, rows), (3, &surfaces.spans), (4, &own), (7, basis)],
            _ => vec![(2, rows), (3, &surfaces.spans), (4, &surfaces.windows), (6, ts), (7, basis)],
        };
        Ok(Some(bind(gpu, passes, &buffers)))
    }

    fn bind_find(
        &self,
        gpu: &Gpu,
        set: &SurfaceSet<R>,
        samples: &Samples<R>,
        (rows, ts): (&Buffer, &Buffer),
    ) -> Result<Option<BindGroup>, GpuError> {
        let Some(find) = &self.find else { return Ok(None) };
        let (directions, breaks) = set.search_tables();
        let directions = storage(gpu, Resource::Directions, &directions)?;
        let breaks = storage(gpu, Resource::DistinctKnots, &breaks)?;
        let parameters = storage(gpu, Resource::Parameters, &samples.parameters)?;
        let buffers = [(0, &directions), (1, &breaks), (2, rows), (5, &parameters), (7, ts)];
        Ok(Some(bind(gpu, find, &buffers)))
    }

    fn kernel(&self, wanted: Wanted) -> &ComputePipeline {
        match wanted {
            Wanted::Points => &self.points,
            Wanted::Normals => &self.normals,
            Wanted::First | Wanted::Second => &self.jets,
        }
    }

    /// Runs what was prepared; the points stay on the device.
    ///
    /// # Errors
    /// What [`Gpu::watched`] gives.
    pub fn run(&self, gpu: &Gpu, evaluation: &Evaluation<R>) -> Result<(), GpuError> {
        gpu.watched(Task::Evaluating, || {
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
        // Kernel by kernel, so that the device may work on one batch while another ends.
        for batch in &evaluation.batches {
            let (Some(find), Some(group)) = (&self.find, &batch.find) else { continue };
            let count = batch.rows.div_ceil(64);
            let groups = count.clamp(1, MOST_GROUPS);
            pass.set_pipeline(find);
            pass.set_bind_group(0, group, &[]);
            let params = Params { rows: batch.rows, groups, ..Params::default() };
            pass.set_immediates(0, bytemuck::bytes_of(&params));
            pass.dispatch_workgroups(groups, count.div_ceil(groups), 1);
        }
        for batch in &evaluation.batches {
            let (Some(passes), Some(group)) = (&self.passes, &batch.passes) else { continue };
            pass.set_pipeline(passes);
            pass.set_bind_group(0, group, &[]);
            for params in &batch.pass_params {
                let count = params.rows.div_ceil(8);
                let groups = count.clamp(1, MOST_GROUPS);
                pass.set_immediates(0, bytemuck::bytes_of(&Params { groups, ..*params }));
                pass.dispatch_workgroups(params.columns.div_ceil(8), groups, count.div_ceil(groups));
            }
        }
        pass.set_pipeline(self.kernel(evaluation.wanted));
        for batch in &evaluation.batches {
            let groups = batch.tiles.clamp(1, MOST_GROUPS);
            let params = Params { rows: batch.tiles, groups, ..batch.params };
            pass.set_bind_group(0, &batch.group, &[]);
            pass.set_immediates(0, bytemuck::bytes_of(&params));
            pass.dispatch_workgroups(groups, batch.tiles.div_ceil(groups), 1);
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
    batches: Vec<Batch>,
    real: PhantomData<R>,
}

/// What one dispatch evaluates.
#[derive(Debug)]
struct Batch {
    passes: Option<BindGroup>,
    pass_params: Vec<Params>,
    find: Option<BindGroup>,
    rows: u32,
    tiles: u32,
    params: Params,
    /// Which of all points.
    points: Range<usize>,
    out: Buffer,
    group: BindGroup,
}

impl<R: Real> Evaluation<R> {
    /// The buffers that the points are in, with the range of points of each.
    pub fn buffers(&self) -> impl Iterator<Item = (&Buffer, Range<usize>)> {
        self.batches.iter().map(|batch| (&batch.out, batch.points.clone()))
    }

    /// Brings the results to the host.
    ///
    /// # Errors
    /// [`GpuError::Lost`], and what [`Gpu::watched`] gives.
    pub fn read(&self, gpu: &Gpu) -> Result<Evaluated<R>, GpuError> {
        let stride = self.wanted.stride();
        let mut values = Vec::new();
        for batch in &self.batches {
            let bytes = (batch.points.len() * stride * size_of::<R>()) as u64;
            let read = read_back(gpu, &batch.out, bytes)?;
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
    /// All numbers, point by point.
    pub values: Vec<R>,
}

fn pipeline<R: Real>(gpu: &Gpu, shader: Shader, entry: &str) -> ComputePipeline {
    // The layout is explicit: one derived from the entry point would leave out bindings that it does not
    // read.
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
    gpu.watched(Task::ReadingResults, || {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, bytes);
        gpu.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, .., |_| {});
        gpu.wait()?;
        let view = staging
            .get_mapped_range(..)
            .map_err(|e| GpuError::Device { task: Task::ReadingResults, reason: e.to_string() })?;
        Ok(view.to_vec())
    })
}
