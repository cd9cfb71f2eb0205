//! The binary chunk, its views and its accessors. Every view starts at a multiple of four bytes.

use super::json::{ARRAY_BUFFER, Accessor, BufferView, ELEMENT_ARRAY_BUFFER, FLOAT, U16, U32};
use glam::Vec3;

#[derive(Debug, Default)]
pub(super) struct Data {
    pub bytes: Vec<u8>,
    pub views: Vec<BufferView>,
    pub accessors: Vec<Accessor>,
}

impl Data {
    /// Appends vectors; positions must state their box.
    pub fn vectors(&mut self, vectors: &[Vec3], with_box: bool) -> usize {
        let start = self.bytes.len();
        self.bytes.reserve(12 * vectors.len());
        for number in vectors.iter().flat_map(|v| v.to_array()) {
            self.bytes.extend_from_slice(&number.to_le_bytes());
        }
        let wide = |v: Vec3| v.to_array().map(f64::from);
        let low = vectors.iter().copied().reduce(Vec3::min).map(wide);
        let high = vectors.iter().copied().reduce(Vec3::max).map(wide);
        let (min, max) = if with_box { (low, high) } else { (None, None) };
        self.accessor(start, FLOAT, vectors.len(), "VEC3", Some(ARRAY_BUFFER), (min, max))
    }

    /// Appends indices below `vertices`, in 16 bits where they fit: 65535 itself is reserved.
    pub fn indices(&mut self, indices: &[u32], vertices: usize) -> usize {
        let start = self.bytes.len();
        let component = if vertices <= 65535 { U16 } else { U32 };
        for &index in indices {
            if component == U16 {
                self.bytes.extend_from_slice(&(index as u16).to_le_bytes());
            } else {
                self.bytes.extend_from_slice(&index.to_le_bytes());
            }
        }
        self.accessor(start, component, indices.len(), "SCALAR", Some(ELEMENT_ARRAY_BUFFER), (None, None))
    }

    /// Appends numbers that are no vertex indices.
    pub fn numbers(&mut self, numbers: &[u32]) -> usize {
        let start = self.bytes.len();
        numbers.iter().for_each(|n| self.bytes.extend_from_slice(&n.to_le_bytes()));
        self.accessor(start, U32, numbers.len(), "SCALAR", None, (None, None))
    }

    fn accessor(
        &mut self,
        byte_offset: usize,
        component_type: u32,
        count: usize,
        kind: &'static str,
        target: Option<u32>,
        (min, max): (Option<[f64; 3]>, Option<[f64; 3]>),
    ) -> usize {
        let byte_length = self.bytes.len() - byte_offset;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let buffer_view = self.views.len();
        self.views.push(BufferView { buffer: 0, byte_offset, byte_length, target });
        self.accessors.push(Accessor { buffer_view, component_type, count, kind, min, max });
        self.accessors.len() - 1
    }
}
