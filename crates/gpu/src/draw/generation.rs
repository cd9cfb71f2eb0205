//! What one re-evaluation leaves on the device: points, the trim texture, and how the faces in them are drawn.
//!
//! Nothing of a generation changes but by an edit of its surfaces; faces that a later view needs otherwise go into a later one.

use super::blocks::{Blocks, Cells};
use super::choice::Choice;
use super::exact::ExactRenderer;
use super::mesh_shapes::{DEFAULT_COLOR, local};
use super::pipelines::{bind_group, bind_resources};
use super::residents::{Home, Resident};
use super::trim_texture::{TrimTexture, Trimmed};
use super::{Trim, linear};
use crate::evaluate::storage;
use crate::exact::{ExactFace, grid};
use crate::{Evaluation, Gpu, GpuError, Request, Samples, Wanted};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use std::ops::Range;
use wgpu::{BindGroup, BindingResource, Buffer, RenderPass};

/// As `Face` in `exact.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct FaceData {
    offset: [f32; 3],
    size: f32,
    color: [f32; 4],
    first: u32,
    height: u32,
    row_u: u32,
    row_v: u32,
    lists: u32,
    bands: u32,
    turn: f32,
    border: u32,
    rectangle: [f32; 4],
    half_texel: [f32; 2],
    plane: u32,
    width: u32,
    borders: u32,
    spare: [u32; 3],
}

/// A face to be evaluated, and where.
pub(crate) struct Member<'a> {
    pub face: &'a ExactFace,
    pub home: Home,
    /// What the part's coordinates are relative to on the device.
    middle: DVec3,
    texels: [f64; 2],
    /// Native parameters of its grid, and pairs of places along its border.
    grid: [Vec<f64>; 2],
    border: Vec<DVec2>,
}

impl<'a> Member<'a> {
    /// As `choice` says, or as finely as `most` points allow.
    pub fn new(face: &'a ExactFace, home: Home, middle: DVec3, choice: &Choice, most: usize) -> Self {
        let (mut steps, mut error) = (choice.steps, choice.error);
        loop {
            let (grid, border) = (grid(face, steps), face.border(error));
            let member = Self { face, home, middle, texels: choice.texels, grid, border };
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

/// Points that fit into one binding; a generation has no more, so that no grid is cut.
pub(crate) fn most_points(gpu: &Gpu) -> usize {
    (gpu.binding_limit() / (Wanted::First.stride() * size_of::<f32>()) as u64) as usize
}

/// The points of some faces of one resident.
#[derive(Debug)]
pub(crate) struct Generation {
    pub resident: usize,
    evaluation: Evaluation<f32>,
    faces: Buffer,
    data: Vec<FaceData>,
    cells: Vec<Cells>,
    /// For faces and for borders.
    groups: [BindGroup; 2],
    /// Faces that are still drawn from here.
    pub live: usize,
    /// All points.
    pub points: usize,
}

impl Generation {
    /// Evaluates faces, all of one resident and no more than [`most_points`] of them, for pictures trimmed in one way.
    pub fn new(
        gpu: &Gpu,
        renderer: &ExactRenderer,
        resident: &Resident,
        members: &[Member],
        trim: Trim,
        stage: [&Buffer; 2],
    ) -> Result<Self, GpuError> {
        let mut plan = Plan::default();
        members.iter().for_each(|member| plan.push(resident, member));
        let samples = Samples::new(&resident.set, &plan.requests)?;
        let evaluator = renderer.evaluator(resident.set.has_bezier());
        let evaluation =
            evaluator.prepare(gpu, &resident.on_device, &resident.set, &samples, Wanted::First)?;
        evaluator.run(gpu, &evaluation)?;
        let mut buffers = evaluation.buffers();
        let (Some((points, _)), None) = (buffers.next(), buffers.next()) else {
            return Err(GpuError::TooLarge {
                what: "the samples of some faces".into(),
                bytes: (samples.len() * Wanted::First.stride() * size_of::<f32>()) as u64,
                limit: gpu.binding_limit(),
                adapter: gpu.name().into(),
            });
        };
        let cells = plan.place(&samples);
        let texture = match trim {
            Trim::Exact => None,
            Trim::Texture => Some(plan.draw_trims(gpu, renderer, resident, members)?),
        };
        let faces = storage(gpu, "the faces", &plan.faces)?;
        let places = storage(gpu, "the parameters of all grids", &plan.places)?;
        let common = [(0, stage[0]), (1, stage[1]), (2, &faces), (3, points)];
        let mut trimmed: Vec<_> = common.iter().map(|(k, b)| (*k, b.as_entire_binding())).collect();
        trimmed.push((4, places.as_entire_binding()));
        match &texture {
            None => trimmed
                .extend([(5, resident.pieces.as_entire_binding()), (6, resident.lists.as_entire_binding())]),
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
        let (live, points, resident) = (members.len(), samples.len(), members[0].home.resident);
        Ok(Self { resident, evaluation, faces, data: plan.faces, cells, groups, live, points })
    }

    /// Faces that it was made with.
    pub fn faces(&self) -> usize {
        self.cells.len()
    }

    /// The blocks of some of them, each with the placements it is seen in.
    pub fn blocks(
        &self,
        gpu: &Gpu,
        renderer: &ExactRenderer,
        trim: Trim,
        drawn: &[(usize, Range<u32>)],
    ) -> Result<Blocks, GpuError> {
        Blocks::new(gpu, [renderer.faces(trim), &renderer.borders], &self.cells, drawn)
    }

    /// Evaluates all faces again after an edit of their control points that needs no other samples.
    pub fn again(
        &mut self,
        gpu: &Gpu,
        renderer: &ExactRenderer,
        resident: &Resident,
        members: impl Iterator<Item = (usize, Home, DVec3)>,
    ) -> Result<(), GpuError> {
        for (index, home, middle) in members {
            let frame = resident.set.entries()[home.surface].frame;
            let data = &mut self.data[index];
            (data.offset, data.size) = (local(frame.middle, middle), frame.size as f32);
        }
        gpu.queue.write_buffer(&self.faces, 0, bytemuck::cast_slice(&self.data));
        renderer.evaluator(resident.set.has_bezier()).run(gpu, &self.evaluation)
    }

    /// Draws faces.
    pub fn draw_faces(&self, pass: &mut RenderPass, renderer: &ExactRenderer, blocks: &Blocks) {
        pass.set_bind_group(0, &self.groups[0], &[]);
        blocks.draw_faces(pass, &renderer.indices);
    }

    /// Draws the strips along their borders.
    pub fn draw_borders(&self, pass: &mut RenderPass, renderer: &ExactRenderer, blocks: &Blocks) {
        pass.set_bind_group(0, &self.groups[1], &[]);
        blocks.draw_borders(pass, &renderer.indices);
    }
}

/// What is evaluated: two requests a face, its grid and its border.
#[derive(Default)]
struct Plan {
    requests: Vec<Request>,
    faces: Vec<FaceData>,
    places: Vec<f32>,
}

impl Plan {
    fn push(&mut self, resident: &Resident, member: &Member) {
        let (face, home) = (member.face, member.home);
        let frame = resident.set.entries()[home.surface].frame;
        let [us, vs] = &member.grid;
        let (row_u, row_v) = (self.places.len() as u32, (self.places.len() + us.len()) as u32);
        for (axis, ts) in [us, vs].into_iter().enumerate() {
            let (start, length) = (face.uv.min[axis], face.uv.size()[axis]);
            self.places.extend(ts.iter().map(|t| ((t - start) / length) as f32));
        }
        let color = face.color.map_or_else(
            || DEFAULT_COLOR.map(|c| linear(f64::from(c) / 255.0) as f32),
            |c| [c[0], c[1], c[2], 1.0],
        );
        self.faces.push(FaceData {
            offset: local(frame.middle, member.middle),
            size: frame.size as f32,
            color,
            height: vs.len() as u32,
            row_u,
            row_v,
            lists: home.trim.at,
            bands: home.trim.bands,
            turn: if face.reversed { -1.0 } else { 1.0 },
            ..FaceData::zeroed()
        });
        let (map, surface) = (&face.parameters, home.surface);
        self.requests.push(Request::Grid {
            surface,
            us: us.iter().map(|&u| map.u.nurbs_from_native(u)).collect(),
            vs: vs.iter().map(|&v| map.v.nurbs_from_native(v)).collect(),
        });
        let border = member.border.iter().map(|p| map.nurbs_from_native(*p)).collect();
        self.requests.push(Request::Points { surface, uvs: border });
    }

    /// Tells the faces where their points are, and how many cells they have.
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

    /// Draws the trim texture, and tells the faces where they are in it.
    fn draw_trims(
        &mut self,
        gpu: &Gpu,
        renderer: &ExactRenderer,
        resident: &Resident,
        members: &[Member],
    ) -> Result<TrimTexture, GpuError> {
        let trimmed: Vec<usize> = (0..members.len()).filter(|k| !members[*k].face.loops.is_empty()).collect();
        let wishes: Vec<Trimmed> = trimmed
            .iter()
            .map(|&k| {
                let Member { face, home, texels, .. } = &members[k];
                Trimmed { texels: *texels, loops: &face.loops, first: home.cubics }
            })
            .collect();
        let texture = renderer.textures.draw(gpu, &wishes, &resident.cubics)?;
        for (&k, slot) in trimmed.iter().zip(&texture.slots) {
            let face = &mut self.faces[k];
            face.rectangle = slot.rectangle(texture.page);
            face.half_texel = slot.size.map(|s| 0.5 / s as f32);
            face.plane = 4 * slot.layer + slot.channel;
        }
        Ok(texture)
    }
}
