//! The surfaces of a set as buffers on the device.

use crate::device::Gpu;
use crate::error::{GpuError, Resource, Task};
use crate::real::Real;
use crate::surfaces::{Edit, SurfaceSet};
use std::marker::PhantomData;
use std::ops::Range;
use wgpu::{Buffer, BufferUsages};

/// A set of surfaces on the device. An edit uploads one surface.
#[derive(Debug)]
pub struct OnDevice<R> {
    pub(crate) spans: Buffer,
    pub(crate) windows: Buffer,
    pub(crate) net: Buffer,
    pub(crate) bezier: Buffer,
    bytes: u64,
    real: PhantomData<R>,
}

impl<R: Real> OnDevice<R> {
    /// Uploads the set.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] where its control points or knots exceed what the device can bind at once, and
    /// what [`Gpu::watched`] gives.
    pub fn upload(gpu: &Gpu, set: &SurfaceSet<R>) -> Result<Self, GpuError> {
        gpu.watched(Task::UploadingSurfaces, || {
            let spans = storage(gpu, Resource::KnotSpans, &set.spans)?;
            let windows = storage(gpu, Resource::Knots, &set.windows)?;
            let net = storage(gpu, Resource::ControlPoints, &set.net)?;
            let bezier = storage(gpu, Resource::BezierPoints, &set.bezier)?;
            let bytes = [&spans, &windows, &net, &bezier].iter().map(|b| b.size()).sum();
            Ok(Self { spans, windows, net, bezier, bytes, real: PhantomData })
        })
    }

    /// Bytes that the whole set takes.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Uploads of surface `index` of the set what an edit changed, and nothing else; returns the bytes that
    /// went.
    ///
    /// # Errors
    /// [`GpuError::NoSuchSurface`], [`GpuError::Lost`].
    pub fn update(&self, gpu: &Gpu, set: &SurfaceSet<R>, index: usize, edit: Edit) -> Result<u64, GpuError> {
        let entry = set.entries.get(index).ok_or(GpuError::NoSuchSurface(index))?;
        gpu.watched(Task::UploadingSurfaces, || {
            let mut sent = 0;
            if edit.points {
                sent += send(gpu, &self.net, &set.net, entry.net_range());
            }
            if edit.points || edit.knots {
                sent += send(gpu, &self.bezier, &set.bezier, entry.bezier_range());
            }
            for d in entry.directions.iter().filter(|_| edit.knots) {
                sent += send(gpu, &self.windows, &set.windows, d.windows());
                sent += send(gpu, &self.spans, &set.spans, d.spans());
            }
            Ok(sent)
        })
    }
}

/// Uploads a part of a buffer's data; the bytes that went.
fn send<T: bytemuck::Pod>(gpu: &Gpu, buffer: &Buffer, data: &[T], part: Range<usize>) -> u64 {
    let bytes: &[u8] = bytemuck::cast_slice(&data[part.clone()]);
    gpu.queue.write_buffer(buffer, (part.start * size_of::<T>()) as u64, bytes);
    bytes.len() as u64
}

/// A storage buffer that holds `data`; `what` names it in errors.
pub(crate) fn storage<T: bytemuck::Pod>(gpu: &Gpu, what: Resource, data: &[T]) -> Result<Buffer, GpuError> {
    let bytes: &[u8] = bytemuck::cast_slice(data);
    let buffer = empty_storage(gpu, what, bytes.len() as u64, BufferUsages::empty())?;
    if !bytes.is_empty() {
        gpu.queue.write_buffer(&buffer, 0, bytes);
    }
    Ok(buffer)
}

/// A storage buffer of at least one vector; refused where it is too large to be bound.
pub(crate) fn empty_storage(
    gpu: &Gpu,
    what: Resource,
    bytes: u64,
    usage: BufferUsages,
) -> Result<Buffer, GpuError> {
    let limit = gpu.binding_limit();
    if bytes > limit {
        return Err(GpuError::TooLarge { what, bytes, limit, adapter: gpu.name().into() });
    }
    Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what.name()),
        size: bytes.max(64),
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC | usage,
        mapped_at_creation: false,
    }))
}
