//! The surfaces of a set as buffers on the device.

use crate::layout::Span;
use crate::{Gpu, GpuError, Real, SurfaceSet};
use std::marker::PhantomData;
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
    /// [`GpuError::TooLarge`] where its control points or knots exceed what the device can bind at once, and what
    /// [`Gpu::watched`] gives.
    pub fn upload(gpu: &Gpu, set: &SurfaceSet<R>) -> Result<Self, GpuError> {
        gpu.watched("uploading surfaces", || {
            let spans = storage(gpu, "the knot spans", &set.spans)?;
            let windows = storage(gpu, "the knots", &set.windows)?;
            let net = storage(gpu, "the control points of the model", &set.net)?;
            let bezier = storage(gpu, "the Bézier points of the model", &set.bezier)?;
            let bytes = [&spans, &windows, &net, &bezier].iter().map(|b| b.size()).sum();
            Ok(Self { spans, windows, net, bezier, bytes, real: PhantomData })
        })
    }

    /// Bytes that the whole set takes.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Uploads surface `index` of the set again, and nothing else; returns the bytes that went.
    ///
    /// # Errors
    /// [`GpuError::NoSuchSurface`], [`GpuError::Lost`].
    pub fn update(&self, gpu: &Gpu, set: &SurfaceSet<R>, index: usize) -> Result<u64, GpuError> {
        let entry = set.entries.get(index).ok_or(GpuError::NoSuchSurface(index))?;
        let mut sent = 0;
        let mut send = |buffer: &Buffer, at: usize, size: usize, bytes: &[u8]| {
            gpu.queue.write_buffer(buffer, (at * size) as u64, bytes);
            sent += bytes.len() as u64;
        };
        gpu.watched("uploading a surface", || {
            let points = |at: u32, count: u32| at as usize..(at + count) as usize;
            let net = bytemuck::cast_slice(&set.net[points(entry.net, entry.points)]);
            send(&self.net, entry.net as usize, size_of::<[R; 4]>(), net);
            if entry.beziers > 0 {
                let cells = bytemuck::cast_slice(&set.bezier[points(entry.bezier, entry.beziers)]);
                send(&self.bezier, entry.bezier as usize, size_of::<[R; 4]>(), cells);
            }
            for d in &entry.directions {
                let windows = bytemuck::cast_slice(&set.windows[points(d.window, d.windows)]);
                send(&self.windows, d.window as usize, size_of::<R>(), windows);
                let spans = bytemuck::cast_slice(&set.spans[points(d.span, d.breaks.len() as u32 - 1)]);
                send(&self.spans, d.span as usize, size_of::<Span>(), spans);
            }
            Ok(())
        })?;
        Ok(sent)
    }
}

/// A storage buffer that holds `data`; `what` names it in errors.
pub(crate) fn storage<T: bytemuck::Pod>(gpu: &Gpu, what: &str, data: &[T]) -> Result<Buffer, GpuError> {
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
    what: &str,
    bytes: u64,
    usage: BufferUsages,
) -> Result<Buffer, GpuError> {
    let limit = gpu.binding_limit();
    if bytes > limit {
        return Err(GpuError::TooLarge { what: what.into(), bytes, limit, adapter: gpu.name().into() });
    }
    Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what),
        size: bytes.max(64),
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC | usage,
        mapped_at_creation: false,
    }))
}
