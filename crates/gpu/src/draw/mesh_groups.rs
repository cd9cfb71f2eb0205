//! Triangles and lines of shapes on the device, as many shapes to a buffer as the limits allow.

use super::pipelines::bind_group;
use super::shapes::{Shape, Vertex};
use crate::device::Gpu;
use crate::error::{GpuError, Resource};
use crate::evaluate::storage;
use bytemuck::Pod;
use std::ops::Range;
use wgpu::{BindGroup, Buffer, BufferUsages, RenderPass, RenderPipeline};

/// The triangles of some shapes.
#[derive(Debug)]
pub(crate) struct Triangles {
    vertices: Buffer,
    indices: Buffer,
    draws: Vec<TriangleDraw>,
}

#[derive(Debug)]
struct TriangleDraw {
    shape: usize,
    indices: Range<u32>,
    base_vertex: i32,
}

/// The lines of some shapes.
#[derive(Debug)]
pub(crate) struct Lines {
    bound: BindGroup,
    draws: Vec<(usize, Range<u32>)>,
}

impl Triangles {
    /// The groups of all shapes.
    pub fn upload(gpu: &Gpu, shapes: &[Shape]) -> Result<Vec<Self>, GpuError> {
        let bytes = |s: &Shape| (s.vertices.len() * size_of::<Vertex>()).max(s.triangles.len() * 12);
        split(shapes, bytes, gpu.binding_limit()).map(|group| Self::of(gpu, shapes, group)).collect()
    }

    fn of(gpu: &Gpu, shapes: &[Shape], group: Range<usize>) -> Result<Self, GpuError> {
        let (mut vertices, mut triangles, mut draws) = (Vec::new(), Vec::new(), Vec::new());
        for shape in group.filter(|s| !shapes[*s].triangles.is_empty()) {
            let (first, base) = (3 * triangles.len() as u32, vertices.len());
            vertices.extend_from_slice(&shapes[shape].vertices);
            triangles.extend_from_slice(&shapes[shape].triangles);
            let indices = first..3 * triangles.len() as u32;
            draws.push(TriangleDraw { shape, indices, base_vertex: base as i32 });
        }
        Ok(Self {
            vertices: plain_buffer(gpu, Resource::Vertices, &vertices, BufferUsages::VERTEX)?,
            indices: plain_buffer(gpu, Resource::Triangles, &triangles, BufferUsages::INDEX)?,
            draws,
        })
    }

    /// Draws every shape in the placements that `placed` gives it.
    pub fn draw(&self, pass: &mut RenderPass, placed: &[Range<u32>]) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for draw in self.draws.iter().filter(|d| !placed[d.shape].is_empty()) {
            pass.draw_indexed(draw.indices.clone(), draw.base_vertex, placed[draw.shape].clone());
        }
    }
}

impl Lines {
    /// The lines of all shapes, for a view and placements.
    pub fn upload(
        gpu: &Gpu,
        pipeline: &RenderPipeline,
        shapes: &[Shape],
        [view, placements]: [&Buffer; 2],
    ) -> Result<Vec<Self>, GpuError> {
        let bytes = |s: &Shape| s.segments.len() * 24;
        let upload = |group: Range<usize>| {
            let (mut segments, mut draws) = (Vec::new(), Vec::new());
            for shape in group.filter(|s| !shapes[*s].segments.is_empty()) {
                let first = 6 * segments.len() as u32;
                segments.extend_from_slice(&shapes[shape].segments);
                draws.push((shape, first..6 * segments.len() as u32));
            }
            let segments = storage(gpu, Resource::Lines, &segments)?;
            Ok(Self {
                bound: bind_group(gpu, pipeline, &[(0, view), (1, placements), (2, &segments)]),
                draws,
            })
        };
        split(shapes, bytes, gpu.binding_limit()).map(upload).collect()
    }

    /// As [`Triangles::draw`].
    pub fn draw(&self, pass: &mut RenderPass, placed: &[Range<u32>]) {
        pass.set_bind_group(0, &self.bound, &[]);
        for (shape, vertices) in self.draws.iter().filter(|(shape, _)| !placed[*shape].is_empty()) {
            pass.draw(vertices.clone(), placed[*shape].clone());
        }
    }
}

/// Runs of shapes of at most `limit` bytes; a shape that is larger by itself stands alone.
fn split(shapes: &[Shape], bytes: impl Fn(&Shape) -> usize, limit: u64) -> std::vec::IntoIter<Range<usize>> {
    let mut groups: Vec<Range<usize>> = Vec::new();
    let mut sum = 0;
    for (index, shape) in shapes.iter().enumerate() {
        let own = bytes(shape) as u64;
        match groups.last_mut() {
            Some(last) if sum + own <= limit => (last.end, sum) = (index + 1, sum + own),
            _ => {
                groups.push(index..index + 1);
                sum = own;
            }
        }
    }
    groups.into_iter()
}

/// A vertex or index buffer.
fn plain_buffer<T: Pod>(
    gpu: &Gpu,
    what: Resource,
    data: &[T],
    usage: BufferUsages,
) -> Result<Buffer, GpuError> {
    let bytes: &[u8] = bytemuck::cast_slice(data);
    let limit = gpu.device.limits().max_buffer_size;
    if bytes.len() as u64 > limit {
        let adapter = gpu.name().into();
        return Err(GpuError::TooLarge { what, bytes: bytes.len() as u64, limit, adapter });
    }
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what.name()),
        size: bytes.len().max(64) as u64,
        usage: usage | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    if !bytes.is_empty() {
        gpu.queue.write_buffer(&buffer, 0, bytes);
    }
    Ok(buffer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_split_at_the_limit() {
        let shape = |n: usize| Shape { segments: vec![Default::default(); n], ..Shape::default() };
        let shapes = [3, 4, 3, 20, 1, 9].map(shape);
        let found: Vec<_> = split(&shapes, |s| s.segments.len(), 10).collect();
        assert_eq!(found, [0..3, 3..4, 4..6]);
    }
}
