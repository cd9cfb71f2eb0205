//! Grids cut into blocks of cells, so that all faces of a batch are drawn by a few calls however many they
//! are.
//!
//! A block is an instance: its record names the face, the placement and its first cell. All blocks of one
//! shape share their indices, so that a corner within a block is calculated once. What of a block lies beyond
//! its grid collapses to nothing.

use super::pipelines::bind_resources;
use crate::device::Gpu;
use crate::error::{GpuError, Resource};
use crate::evaluate::storage;
use bytemuck::{Pod, Zeroable};
use std::collections::BTreeMap;
use std::ops::Range;
use wgpu::{BindGroup, Buffer, BufferUsages, RenderPass, RenderPipeline};

/// Cells along u and v of the shapes of blocks; the last two are pieces of a border, in a row.
const SHAPES: [[u32; 2]; 8] = [[1, 1], [1, 8], [8, 1], [2, 2], [4, 4], [8, 8], [4, 1], [32, 1]];
/// Where the shapes of borders begin.
const BORDERS: usize = 6;

/// One instance, as in `exact.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Block {
    face: u32,
    placement: u32,
    /// The first cell: along u in the lower half, along v in the upper; of a border the number of its first
    /// piece.
    first: u32,
    spare: u32,
}

/// What differs from call to call, as in `exact.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Batch {
    first: u32,
    records: u32,
    placement: u32,
    /// Cells of a block along v.
    rows: u32,
}

/// The indices of all shapes.
#[derive(Debug)]
pub(crate) struct BlockIndices {
    buffer: Buffer,
    ranges: Vec<Range<u32>>,
}

impl BlockIndices {
    pub fn new(gpu: &Gpu) -> Self {
        let (mut all, mut ranges) = (Vec::<u16>::new(), Vec::new());
        for (kind, [columns, rows]) in SHAPES.into_iter().enumerate() {
            let start = all.len() as u32;
            for cell in 0..(columns * rows) as u16 {
                if kind >= BORDERS {
                    all.extend([0, 1, 2, 0, 2, 3].map(|corner| 4 * cell + corner));
                } else {
                    let row = rows as u16 + 1;
                    let at = cell / rows as u16 * row + cell % rows as u16;
                    all.extend([at, at + row, at + 1, at + row, at + row + 1, at + 1]);
                }
            }
            ranges.push(start..all.len() as u32);
        }
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("the indices of blocks"),
            size: (all.len() * size_of::<u16>()).next_multiple_of(4) as u64,
            usage: BufferUsages::INDEX | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&all));
        Self { buffer, ranges }
    }
}

/// How many cells a face has along u and v, and pieces along its border.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells {
    pub grid: [u32; 2],
    pub border: u32,
}

/// The blocks of what is drawn of one batch.
#[derive(Debug)]
pub(crate) struct Blocks {
    /// For the pipelines of faces and of borders.
    groups: [BindGroup; 2],
    batches: Vec<(usize, Range<u32>, Batch)>,
}

impl Blocks {
    /// Of faces (their numbers in the batch and the placements each is seen in), for the pipelines of faces
    /// and borders.
    pub fn new(
        gpu: &Gpu,
        pipelines: [&RenderPipeline; 2],
        cells: &[Cells],
        drawn: &[(usize, Range<u32>)],
    ) -> Result<Self, GpuError> {
        let mut lists: BTreeMap<(usize, u32, u32), Vec<Block>> = BTreeMap::new();
        for (index, placed) in drawn {
            // Faces with one visible placement share draw calls, also where the placements differ.
            let (start, end, placement) =
                if placed.len() == 1 { (0, 1, placed.start) } else { (placed.start, placed.end, 0) };
            let block = |first: u32| Block { face: *index as u32, placement, first, spare: 0 };
            let Cells { grid, border } = cells[*index];
            let kind = shape_for(grid);
            let [columns, rows] = SHAPES[kind];
            let list = lists.entry((kind, start, end)).or_default();
            for i in (0..grid[0]).step_by(columns as usize) {
                list.extend((0..grid[1]).step_by(rows as usize).map(|j| block(i | j << 16)));
            }
            let kind = if border > 8 { BORDERS + 1 } else { BORDERS };
            let list = lists.entry((kind, start, end)).or_default();
            list.extend((0..border).step_by(SHAPES[kind][0] as usize).map(block));
        }
        let mut all = Vec::new();
        let mut batches = Vec::new();
        for ((kind, start, end), list) in lists {
            let (first, records) = (all.len() as u32, list.len() as u32);
            if records > 0 {
                let batch = Batch { first, records, placement: start, rows: SHAPES[kind][1] };
                batches.push((kind, 0..records * (end - start), batch));
            }
            all.extend(list);
        }
        let buffer = storage(gpu, Resource::Blocks, &all)?;
        let groups = pipelines.map(|p| bind_resources(gpu, p, 1, vec![(0, buffer.as_entire_binding())]));
        Ok(Self { groups, batches })
    }

    pub fn draw_faces(&self, pass: &mut RenderPass, indices: &BlockIndices) {
        self.draw(pass, indices, 0, 0..BORDERS);
    }

    pub fn draw_borders(&self, pass: &mut RenderPass, indices: &BlockIndices) {
        self.draw(pass, indices, 1, BORDERS..SHAPES.len());
    }

    fn draw(&self, pass: &mut RenderPass, indices: &BlockIndices, group: usize, kinds: Range<usize>) {
        pass.set_bind_group(1, &self.groups[group], &[]);
        pass.set_index_buffer(indices.buffer.slice(..), wgpu::IndexFormat::Uint16);
        for (kind, instances, batch) in self.batches.iter().filter(|b| kinds.contains(&b.0)) {
            pass.set_immediates(0, bytemuck::bytes_of(batch));
            pass.draw_indexed(indices.ranges[*kind].clone(), 0, instances.clone());
        }
    }
}

/// The shape that calculates the fewest corners.
fn shape_for(grid: [u32; 2]) -> usize {
    let corners = |kind: &usize| {
        let [columns, rows] = SHAPES[*kind];
        grid[0].div_ceil(columns) * grid[1].div_ceil(rows) * (columns + 1) * (rows + 1)
    };
    (0..BORDERS).min_by_key(corners).expect("there are shapes")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_fit_their_grids() {
        let shape = |grid| SHAPES[shape_for(grid)];
        assert_eq!(shape([1, 1]), [1, 1]);
        assert_eq!(shape([1, 40]), [1, 8]);
        assert_eq!(shape([37, 1]), [8, 1]);
        assert_eq!(shape([2, 2]), [2, 2]);
        assert_eq!(shape([64, 64]), [8, 8]);
    }
}
