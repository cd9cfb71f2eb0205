//! What one re-evaluation leaves on the device: points, the trim texture, and how the faces in them are
//! drawn.
//!
//! Nothing of a batch changes but by an edit of its surfaces; faces that a later view needs otherwise go into
//! a later one.

use super::blocks::{Blocks, Cells};
use super::choice::Choice;
use super::device_store::{FaceLocation, FaceStore};
use super::face_renderer::FaceRenderer;
use super::mesh_shapes::{DEFAULT_COLOR, local, opacity};
use super::options::Trim;
use super::pipelines::{bind_group, bind_resources};
use super::srgb::linear;
use super::trim_texture::{TrimTexture, Trimmed};
use crate::device::Gpu;
use crate::error::{GpuError, Resource};
use crate::evaluate::storage;
use crate::evaluate::{Evaluation, Wanted};
use crate::faces::{TrimmedFace, grid};
use crate::samples::{Request, Samples};
use crate::surfaces::SurfaceEntry;
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use std::ops::Range;
use wgpu::{BindGroup, BindingResource, Buffer, RenderPass};

/// As `Face` in `exact.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct FaceData {
    offset: [f32; 3],
    size: f32,
    color: [f32; 4],
    first: u32,
    height: u32,
    row_u: u32,
    row_v: u32,
    lists: u32,
    bands: u32,
    pub turn: f32,
    border: u32,
    rectangle: [f32; 4],
    half_texel: [f32; 2],
    plane: u32,
    width: u32,
    borders: u32,
    pub net: u32,
    pub degrees: u32,
    pub cells_v: u32,
    pub spans: [u32; 2],
    pub counts: [u32; 2],
}

/// A face to be evaluated, and where.
pub(crate) struct Member<'a> {
    pub face: &'a TrimmedFace,
    pub location: FaceLocation,
    /// What the part's coordinates are relative to on the device.
    middle: DVec3,
    texels: [f64; 2],
    /// Native parameters of its grid, and pairs of places along its border.
    grid: [Vec<f64>; 2],
    border: Vec<DVec2>,
}

impl<'a> Member<'a> {
    /// As fine as `choice`, or as `most` points allow.
    pub fn new(
        face: &'a TrimmedFace,
        location: FaceLocation,
        middle: DVec3,
        choice: &Choice,
        most: usize,
    ) -> Self {
        let (mut steps, mut error) = (choice.steps, choice.error);
        loop {
            let (grid, border) = (grid(face, steps), face.border(error));
            let member = Self { face, location, middle, texels: choice.texels, grid, border };
            if member.points() <= most || steps == [1.0; 2] {
                return member;
            }
            steps = steps.map(|s| (0.7 * s).floor().max(1.0));
            error *= 2.0;
        }
    }

    pub fn points(&self) -> usize {
        self.grid[0].len() * self.grid[1].len() + self.border.len()
    }
}

/// Points that fit into one binding; a batch has no more, so that no grid is cut.
pub(crate) fn most_points(gpu: &Gpu) -> usize {
    (gpu.binding_limit() / (Wanted::Normals.stride() * size_of::<f32>()) as u64) as usize
}

/// The points of some faces of one store.
#[derive(Debug)]
pub(crate) struct FaceBatch {
    pub store: usize,
    evaluation: Evaluation<f32>,
    faces: Buffer,
    #[cfg(test)]
    places: Buffer,
    data: Vec<FaceData>,
    cells: Vec<Cells>,
    /// For faces and for borders.
    groups: [BindGroup; 2],
    /// Faces that are still drawn from here.
    pub live: usize,
    /// All points.
    pub points: usize,
}

impl FaceBatch {
    /// Evaluates faces, all of one store and no more than [`most_points`] of them, for pictures trimmed in
    /// one way.
    pub fn new(
        gpu: &Gpu,
        renderer: &FaceRenderer,
        store: &FaceStore,
        members: &[Member],
        trim: Trim,
        stage: [&Buffer; 2],
    ) -> Result<Self, GpuError> {
        let mut plan = Plan::default();
        members.iter().for_each(|member| plan.push(store, member));
        let samples = Samples::new(&store.set, &plan.requests)?;
        let evaluator = renderer.evaluator(store.set.has_bezier());
        let evaluation = evaluator.prepare(gpu, &store.on_device, &store.set, &samples, Wanted::Normals)?;
        evaluator.run(gpu, &evaluation)?;
        let mut buffers = evaluation.buffers();
        let (Some((points, _)), None) = (buffers.next(), buffers.next()) else {
            return Err(GpuError::TooLarge {
                what: Resource::FaceSamples,
                bytes: (samples.len() * Wanted::Normals.stride() * size_of::<f32>()) as u64,
                limit: gpu.binding_limit(),
                adapter: gpu.name().into(),
            });
        };
        let cells = plan.place(&samples);
        let texture = match trim {
            Trim::Exact => None,
            Trim::Texture => Some(plan.draw_trims(gpu, renderer, store, members)?),
        };
        let faces = storage(gpu, Resource::Faces, &plan.faces)?;
        let places = storage(gpu, Resource::FaceParameters, &plan.places)?;
        let common = [(0, stage[0]), (1, stage[1]), (2, &faces), (3, points)];
        let mut trimmed: Vec<_> = common.iter().map(|(k, b)| (*k, b.as_entire_binding())).collect();
        trimmed.push((4, places.as_entire_binding()));
        trimmed.push((9, store.on_device.bezier.as_entire_binding()));
        match &texture {
            None => {
                trimmed.extend([(5, store.pieces.as_entire_binding()), (6, store.lists.as_entire_binding())])
            }
            Some(texture) => trimmed.extend([
                (7, BindingResource::TextureView(&texture.view)),
                (8, BindingResource::Sampler(&renderer.textures.sampler)),
            ]),
        }
        let groups = [
            bind_resources(gpu, renderer.faces(trim), 0, trimmed),
            bind_group(gpu, &renderer.borders, &common),
        ];
        drop(buffers);
        let (live, points, store) = (members.len(), samples.len(), members[0].location.store);
        Ok(Self {
            store,
            evaluation,
            faces,
            #[cfg(test)]
            places,
            data: plan.faces,
            cells,
            groups,
            live,
            points,
        })
    }

    /// Faces that it was made with.
    pub fn faces(&self) -> usize {
        self.cells.len()
    }

    /// The blocks of some of them, each with the placements it is seen in.
    pub fn blocks(
        &self,
        gpu: &Gpu,
        renderer: &FaceRenderer,
        trim: Trim,
        drawn: &[(usize, Range<u32>)],
    ) -> Result<Blocks, GpuError> {
        Blocks::new(gpu, [renderer.faces(trim), &renderer.borders], &self.cells, drawn)
    }

    /// For the pipeline of the tests that reads what fragments know of their place.
    #[cfg(test)]
    pub fn probe_group(
        &self,
        gpu: &Gpu,
        pipeline: &wgpu::RenderPipeline,
        store: &FaceStore,
        stage: [&Buffer; 2],
    ) -> BindGroup {
        let (points, _) = self.evaluation.buffers().next().expect("a batch is one batch");
        let net = &store.on_device.bezier;
        let buffers =
            [(0, stage[0]), (1, stage[1]), (2, &self.faces), (3, points), (4, &self.places), (9, net)];
        bind_group(gpu, pipeline, &buffers)
    }

    #[cfg(test)]
    pub fn cells(&self) -> &[Cells] {
        &self.cells
    }

    /// The faces as the shaders read them, and the places and spans of all of them.
    #[cfg(test)]
    pub fn known(&self, gpu: &Gpu) -> Result<(&[FaceData], Vec<[f32; 2]>), GpuError> {
        let bytes = crate::evaluate::read_back(gpu, &self.places, self.places.size())?;
        Ok((&self.data, bytemuck::pod_collect_to_vec(&bytes)))
    }

    /// Evaluates all faces again after an edit of their control points that needs no other samples.
    pub fn evaluate_again(
        &mut self,
        gpu: &Gpu,
        renderer: &FaceRenderer,
        store: &FaceStore,
        members: impl Iterator<Item = (usize, FaceLocation, DVec3)>,
    ) -> Result<(), GpuError> {
        for (index, location, middle) in members {
            let frame = store.set.entries()[location.surface].frame;
            let data = &mut self.data[index];
            (data.offset, data.size) = (local(frame.middle, middle), frame.size as f32);
        }
        gpu.queue.write_buffer(&self.faces, 0, bytemuck::cast_slice(&self.data));
        renderer.evaluator(store.set.has_bezier()).run(gpu, &self.evaluation)
    }

    /// Draws faces.
    pub fn draw_faces(&self, pass: &mut RenderPass, renderer: &FaceRenderer, blocks: &Blocks) {
        pass.set_bind_group(0, &self.groups[0], &[]);
        blocks.draw_faces(pass, &renderer.indices);
    }

    /// Draws the strips along their borders.
    pub fn draw_borders(&self, pass: &mut RenderPass, renderer: &FaceRenderer, blocks: &Blocks) {
        pass.set_bind_group(0, &self.groups[1], &[]);
        blocks.draw_borders(pass, &renderer.indices);
    }
}

/// What is evaluated: two requests a face, its grid and its border.
#[derive(Default)]
struct Plan {
    requests: Vec<Request>,
    faces: Vec<FaceData>,
    places: Vec<[f32; 2]>,
}

impl Plan {
    fn push(&mut self, store: &FaceStore, member: &Member) {
        let (face, location) = (member.face, member.location);
        let entry = &store.set.entries()[location.surface];
        let frame = entry.frame;
        let [us, vs] = &member.grid;
        let map = &face.parameters;
        let nurbs: [Vec<f64>; 2] = [
            us.iter().map(|&u| map.u.nurbs_from_native(u)).collect(),
            vs.iter().map(|&v| map.v.nurbs_from_native(v)).collect(),
        ];
        let (low, high) = (map.nurbs_from_native(face.uv.min), map.nurbs_from_native(face.uv.max));
        let (row_u, row_v) = (self.places.len() as u32, (self.places.len() + us.len()) as u32);
        for axis in 0..2 {
            let (start, length) = (face.uv.min[axis], face.uv.size()[axis]);
            let (first, over) = (low[axis], high[axis] - low[axis]);
            let both = member.grid[axis].iter().zip(&nurbs[axis]);
            self.places
                .extend(both.map(|(t, n)| [(t - start) / length, (n - first) / over].map(|x| x as f32)));
        }
        let nets = self.push_spans(store.set.has_bezier(), entry, [low, high]);
        let color = face.color.map_or_else(
            || DEFAULT_COLOR.map(|c| linear(f64::from(c) / 255.0) as f32),
            |c| [c[0], c[1], c[2], opacity(c)],
        );
        self.faces.push(FaceData {
            offset: local(frame.middle, member.middle),
            size: frame.size as f32,
            color,
            height: vs.len() as u32,
            row_u,
            row_v,
            lists: location.trim.at,
            bands: location.trim.bands,
            turn: if face.reversed { -1.0 } else { 1.0 },
            ..nets
        });
        let (surface, [us, vs]) = (location.surface, nurbs);
        self.requests.push(Request::Grid { surface, us, vs });
        let border = member.border.iter().map(|p| map.nurbs_from_native(*p)).collect();
        self.requests.push(Request::Points { surface, uvs: border });
    }

    /// The spans that a face between two corners (NURBS parameters) lies in, and where their Bézier nets are.
    fn push_spans(&mut self, has_bezier: bool, entry: &SurfaceEntry, [low, high]: [DVec2; 2]) -> FaceData {
        if !has_bezier {
            return FaceData::zeroed();
        }
        let mut found = FaceData::zeroed();
        let mut first = [0; 2];
        for (axis, direction) in entry.directions.iter().enumerate() {
            let over = high[axis] - low[axis];
            let cells = direction.cells_between(low[axis], high[axis]);
            first[axis] = *cells.start() as u32;
            found.spans[axis] = self.places.len() as u32;
            found.counts[axis] = cells.clone().count() as u32;
            self.places.extend(cells.map(|cell| {
                let [start, end] = [cell, cell + 1].map(|k| direction.breaks[k]);
                [(start - low[axis]) / over, over / (end - start)].map(|x| x as f32)
            }));
        }
        let [p, q] = entry.degree.map(|d| d as u32);
        found.degrees = p | q << 8;
        found.cells_v = entry.directions[1].breaks.len() as u32 - 1;
        found.net = entry.bezier + (first[0] * found.cells_v + first[1]) * (p + 1) * (q + 1);
        found
    }

    /// Enters for each face where its points are, and how many cells it has.
    fn place(&mut self, samples: &Samples<f32>) -> Vec<Cells> {
        let mut cells = Vec::new();
        for (index, face) in self.faces.iter_mut().enumerate() {
            let (own, border) = (samples.range(2 * index), samples.range(2 * index + 1));
            (face.first, face.border) = (own.start as u32, border.start as u32);
            (face.width, face.borders) = (own.len() as u32 / face.height, border.len() as u32 / 2);
            cells.push(Cells { grid: [face.width - 1, face.height - 1], border: face.borders });
        }
        cells
    }

    /// Draws the trim texture, and stores in the faces their places in it.
    fn draw_trims(
        &mut self,
        gpu: &Gpu,
        renderer: &FaceRenderer,
        store: &FaceStore,
        members: &[Member],
    ) -> Result<TrimTexture, GpuError> {
        let trimmed: Vec<usize> = (0..members.len()).filter(|k| !members[*k].face.loops.is_empty()).collect();
        let trims: Vec<Trimmed> = trimmed
            .iter()
            .map(|&k| {
                let Member { face, location, texels, .. } = &members[k];
                Trimmed { texels: *texels, loops: &face.loops, first: location.cubics }
            })
            .collect();
        let texture = renderer.textures.draw(gpu, &trims, &store.cubics)?;
        for (&k, slot) in trimmed.iter().zip(&texture.slots) {
            let face = &mut self.faces[k];
            face.rectangle = slot.rectangle(texture.page);
            face.half_texel = slot.size.map(|s| 0.5 / s as f32);
            face.plane = 4 * slot.layer + slot.channel;
        }
        Ok(texture)
    }
}
