//! What of a model stays on the device whatever the view: control points, knots and trimming curves, in as
//! many sets as the limits of a binding require.

use crate::device::Gpu;
use crate::error::{GpuError, Resource};
use crate::evaluate::OnDevice;
use crate::evaluate::storage;
use crate::faces::inside::{TrimRange, TrimTable};
use crate::faces::{TrimmedFace, TrimmedModel};
use crate::surfaces::SurfaceSet;
use chordal_nurbs::NurbsSurface;
use wgpu::Buffer;

/// Some faces on the device.
#[derive(Debug)]
pub(crate) struct FaceStore {
    pub set: SurfaceSet<f32>,
    pub on_device: OnDevice<f32>,
    /// The rising pieces of the exact test and their bands.
    pub pieces: Buffer,
    pub lists: Buffer,
    /// The pieces of all loops as they run, for trim textures.
    pub cubics: Buffer,
}

/// Where a face is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceLocation {
    pub store: usize,
    pub surface: usize,
    pub trim: TrimRange,
    /// The number of its first piece among the cubics.
    pub cubics: u32,
}

/// Faces gathered for one store.
struct Pending {
    set: SurfaceSet<f32>,
    trims: TrimTable,
    cubics: Vec<[f32; 4]>,
    bytes: u64,
}

impl Pending {
    fn new(with_bezier: bool) -> Self {
        let set = if with_bezier { SurfaceSet::with_bezier() } else { SurfaceSet::new() };
        Self { set, trims: TrimTable::default(), cubics: Vec::new(), bytes: 0 }
    }

    fn push(&mut self, face: &TrimmedFace, store: usize, bytes: u64) -> FaceLocation {
        self.bytes += bytes;
        let cubics = self.cubics.len() as u32 / 2;
        self.cubics.extend(face.loops.iter().flat_map(|piece| piece.as_f32()));
        let trim = match face.loops.is_empty() {
            true => TrimRange::default(),
            false => self.trims.push(&face.loops),
        };
        FaceLocation { store, surface: self.set.push_surface(&face.surface), trim, cubics }
    }

    fn full(&self, more: u64, limit: u64) -> bool {
        !self.set.is_empty() && (self.bytes + more > limit || self.trims.bytes() > limit / 2)
    }

    fn upload(self, gpu: &Gpu) -> Result<FaceStore, GpuError> {
        Ok(FaceStore {
            on_device: OnDevice::upload(gpu, &self.set)?,
            set: self.set,
            pieces: storage(gpu, Resource::TrimmingCurves, &self.trims.pieces)?,
            lists: storage(gpu, Resource::TrimmingBands, &self.trims.lists)?,
            cubics: storage(gpu, Resource::Loops, &self.cubics)?,
        })
    }
}

/// Uploads the faces of a model: its stores and, part by part, where each face is.
pub(crate) fn upload_faces(
    gpu: &Gpu,
    model: &TrimmedModel,
    limit: u64,
) -> Result<(Vec<FaceStore>, Vec<Vec<FaceLocation>>), GpuError> {
    let mut stores = Vec::new();
    let mut pending = Pending::new(true);
    let mut locations = Vec::new();
    for part in &model.parts {
        let mut of_part = Vec::new();
        for face in &part.faces {
            let bytes = bezier_bytes(&face.surface);
            // A surface whose Bézier nets exceed a binding is evaluated from its knots, in a set of its own.
            let with_bezier = bytes <= limit;
            if pending.full(bytes, limit) || pending.set.has_bezier() != with_bezier {
                let full = std::mem::replace(&mut pending, Pending::new(with_bezier));
                if !full.set.is_empty() {
                    stores.push(full.upload(gpu)?);
                }
            }
            of_part.push(pending.push(face, stores.len(), bytes));
        }
        locations.push(of_part);
    }
    if !pending.set.is_empty() {
        stores.push(pending.upload(gpu)?);
    }
    Ok((stores, locations))
}

/// Bytes of the Bézier nets of a surface; its net and knots take no more.
fn bezier_bytes(surface: &NurbsSurface) -> u64 {
    let [p, q] = surface.degree();
    let cells = (surface.breaks_u().len() - 1) * (surface.breaks_v().len() - 1);
    (cells * (p + 1) * (q + 1) * size_of::<[f32; 4]>()) as u64
}
