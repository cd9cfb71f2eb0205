//! What one re-evaluation leaves on the device: points, the trim texture, and how the faces in them are drawn.
//!
//! Nothing of a generation changes but by an edit of its surfaces; faces that a later view needs otherwise go into a later one.

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
use glam::DVec3;
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
    spare: u32,
}

/// A face to be evaluated.
pub(crate) struct Member<'a> {
    pub face: &'a ExactFace,
    pub home: Home,
    /// What the part's coordinates are relative to on the device.
    pub middle: DVec3,
    pub choice: Choice,
}

/// How one face of a generation is drawn.
#[derive(Clone, Copy, Debug)]
struct FaceDraw {
    group: usize,
    vertices: u32,
    border_group: usize,
    border_vertices: u32,
}

/// The points of some faces of one resident.
#[derive(Debug)]
pub(crate) struct Generation {
    pub resident: usize,
    evaluation: Evaluation<f32>,
    faces: Buffer,
    data: Vec<FaceData>,
    draws: Vec<FaceDraw>,
    /// Per buffer of points, of faces and of borders.
    groups: Vec<[BindGroup; 2]>,
    /// Faces that are still drawn from here.
    pub live: usize,
    /// All points.
    pub points: usize,
}

impl Generation {
    /// Evaluates faces, all of one resident, for pictures trimmed in one way.
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
        let buffers: Vec<Range<usize>> = evaluation.buffers().map(|(_, range)| range).collect();
        let draws = plan.place(&samples, &buffers);
        let texture = match trim {
            Trim::Exact => None,
            Trim::Texture => Some(plan.draw_trims(gpu, renderer, resident, members)?),
        };
        let faces = storage(gpu, "the faces", &plan.faces)?;
        let places = storage(gpu, "the parameters of all grids", &plan.places)?;
        let groups = evaluation.buffers().map(|(points, _)| {
            let common = [(0, stage[0]), (1, stage[1]), (2, &faces), (3, points)];
            let mut trimmed: Vec<_> = common.iter().map(|(k, b)| (*k, b.as_entire_binding())).collect();
            trimmed.push((4, places.as_entire_binding()));
            match &texture {
                None => trimmed.extend([
                    (5, resident.pieces.as_entire_binding()),
                    (6, resident.lists.as_entire_binding()),
                ]),
                Some(texture) => trimmed.extend([
                    (7, BindingResource::TextureView(&texture.view)),
                    (8, BindingResource::Sampler(&renderer.textures.sampler)),
                ]),
            }
            [bind_resources(gpu, renderer.faces(trim), trimmed), bind_group(gpu, &renderer.borders, &common)]
        });
        let groups = groups.collect();
        let (live, points, resident) = (members.len(), samples.len(), members[0].home.resident);
        Ok(Self { resident, evaluation, faces, data: plan.faces, draws, groups, live, points })
    }

    /// Faces that it was made with.
    pub fn draws(&self) -> usize {
        self.draws.len()
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

    /// Draws faces (their indices here and the placements each is seen in).
    pub fn draw_faces<'d>(
        &self,
        pass: &mut RenderPass,
        faces: impl Iterator<Item = &'d (usize, Range<u32>)>,
    ) {
        let mut bound = None;
        for (index, placed) in faces {
            let draw = self.draws[*index];
            if bound.replace(draw.group) != Some(draw.group) {
                pass.set_bind_group(0, &self.groups[draw.group][0], &[]);
            }
            pass.set_immediates(0, bytemuck::bytes_of(&(*index as u32)));
            pass.draw(0..draw.vertices, placed.clone());
        }
    }

    /// Draws the strips along their borders.
    pub fn draw_borders<'d>(
        &self,
        pass: &mut RenderPass,
        faces: impl Iterator<Item = &'d (usize, Range<u32>)>,
    ) {
        let mut bound = None;
        for (index, placed) in faces {
            let draw = self.draws[*index];
            if draw.border_vertices == 0 {
                continue;
            }
            if bound.replace(draw.border_group) != Some(draw.border_group) {
                pass.set_bind_group(0, &self.groups[draw.border_group][1], &[]);
            }
            pass.set_immediates(0, bytemuck::bytes_of(&(*index as u32)));
            pass.draw(0..draw.border_vertices, placed.clone());
        }
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
        let [us, vs] = grid(face, member.choice.steps);
        let (row_u, row_v) = (self.places.len() as u32, (self.places.len() + us.len()) as u32);
        for (axis, ts) in [&us, &vs].into_iter().enumerate() {
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
        let border = face.border(member.choice.error).into_iter().map(|p| map.nurbs_from_native(p)).collect();
        self.requests.push(Request::Points { surface, uvs: border });
    }

    /// Tells the faces where their points are, in buffers of these ranges, and gives what is drawn of them.
    fn place(&mut self, samples: &Samples<f32>, buffers: &[Range<usize>]) -> Vec<FaceDraw> {
        let buffer_of =
            |point: usize| buffers.partition_point(|b| b.end <= point).min(buffers.len().max(1) - 1);
        let mut draws = Vec::new();
        for (index, face) in self.faces.iter_mut().enumerate() {
            let (own, border) = (samples.range(2 * index), samples.range(2 * index + 1));
            let (group, border_group) = (buffer_of(own.start), buffer_of(border.start));
            face.first = (own.start - buffers[group].start) as u32;
            face.border = (border.start - buffers[border_group].start) as u32;
            let columns = own.len() as u32 / face.height;
            // A border that is cut between two buffers is left to the lines.
            let whole = border.end <= buffers[border_group].end;
            draws.push(FaceDraw {
                group,
                vertices: 6 * (columns - 1) * (face.height - 1),
                border_group,
                border_vertices: if whole { 3 * border.len() as u32 } else { 0 },
            });
        }
        draws
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
                let Member { face, home, choice, .. } = &members[k];
                Trimmed { texels: choice.texels, loops: &face.loops, first: home.cubics }
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
