//! Exact faces: sampled as finely as the view needs, evaluated into buffers and drawn from them.

use super::mesh_shapes::{DEFAULT_COLOR, local};
use super::renderer::{bind_group, pipeline};
use super::{Camera, Scenery, linear};
use crate::evaluate::storage;
use crate::exact::trim::TrimTable;
use crate::exact::{ExactFace, edge_lines, grid};
use crate::{
    Evaluation, Evaluator, ExactModel, Gpu, GpuError, OnDevice, Request, Samples, Search, SurfaceSet,
    Variant, Wanted, shaders,
};
use bytemuck::{Pod, Zeroable};
use chordal_brep::Model;
use chordal_mesh::Scene;
use glam::{DVec2, DVec3};
use std::ops::Range;
use wgpu::{BindGroup, Buffer, RenderPass, RenderPipeline};

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
}

/// The pipelines of exact pictures.
#[derive(Debug)]
pub struct ExactRenderer {
    /// The fastest that was measured, and the one for models whose Bézier nets exceed a binding.
    evaluators: [Evaluator<f32>; 2],
    faces: RenderPipeline,
    borders: RenderPipeline,
}

/// The largest distance between what is drawn and the exact surface, pixels.
pub const PIXEL_ERROR: f64 = 0.5;
/// Places along a border piece at most.
const BORDER_STEPS: f64 = 64.0;

/// One view's samples.
#[derive(Debug)]
pub(crate) struct ExactFrame {
    groups: Vec<[BindGroup; 2]>,
    draws: Vec<FaceDraw>,
    /// All points evaluated.
    pub points: usize,
}

#[derive(Clone, Debug)]
struct FaceDraw {
    face: u32,
    group: usize,
    vertices: u32,
    border_group: usize,
    border_vertices: u32,
    placed: Range<u32>,
}

impl ExactRenderer {
    /// Compiles the kernels and shaders.
    ///
    /// # Errors
    /// What [`Gpu::watched`] gives.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let evaluators = [
            Evaluator::new(gpu, Variant::Bernstein, Search::Host)?,
            Evaluator::new(gpu, Variant::Direct, Search::Host)?,
        ];
        gpu.watched("compiling shaders", || {
            let entries = ["vertex", "fragment"];
            let border = ["border_vertex", "border_fragment"];
            Ok(Self {
                evaluators,
                faces: pipeline(gpu, shaders::EXACT, entries, &[]),
                borders: pipeline(gpu, shaders::EXACT, border, &[]),
            })
        })
    }

    /// Samples and evaluates what `camera` sees, for the placements of the scenery.
    pub(crate) fn frame(
        &self,
        gpu: &Gpu,
        model: &ExactModel,
        scenery: &Scenery,
        camera: &Camera,
        view: &Buffer,
        placements: &Buffer,
    ) -> Result<ExactFrame, GpuError> {
        let mut plan = FramePlan::new(model, scenery, camera, SurfaceSet::with_bezier());
        let [by_nets, by_knots] = &self.evaluators;
        let mut evaluator = by_nets;
        if plan.set.bezier_bytes() > gpu.binding_limit() {
            plan = FramePlan::new(model, scenery, camera, SurfaceSet::new());
            evaluator = by_knots;
        }
        let samples = Samples::new(&plan.set, &plan.requests)?;
        let on_device = OnDevice::upload(gpu, &plan.set)?;
        let evaluation = evaluator.prepare(gpu, &on_device, &plan.set, &samples, Wanted::First)?;
        evaluator.run(gpu, &evaluation)?;
        let (faces, draws) = plan.placed_in(&samples, &evaluation);
        let faces = storage(gpu, "the faces", &faces)?;
        let places = storage(gpu, "the parameters of all grids", &plan.places)?;
        let pieces = storage(gpu, "the trimming curves", &plan.trims.pieces)?;
        let lists = storage(gpu, "the bands of the trimming curves", &plan.trims.lists)?;
        let groups = evaluation.buffers().map(|(points, _)| {
            let common = [(0, view), (1, placements), (2, &faces), (3, points)];
            let trimmed = [&common[..], &[(4, &places), (5, &pieces), (6, &lists)]].concat();
            [bind_group(gpu, &self.faces, &trimmed), bind_group(gpu, &self.borders, &common)]
        });
        let groups = groups.collect();
        Ok(ExactFrame { groups, draws, points: samples.len() })
    }

    pub(crate) fn draw(&self, pass: &mut RenderPass, frame: &ExactFrame) {
        let mut bound = None;
        pass.set_pipeline(&self.faces);
        for draw in &frame.draws {
            if bound.replace(draw.group) != Some(draw.group) {
                pass.set_bind_group(0, &frame.groups[draw.group][0], &[]);
            }
            pass.set_immediates(0, bytemuck::bytes_of(&draw.face));
            pass.draw(0..draw.vertices, draw.placed.clone());
        }
        bound = None;
        pass.set_pipeline(&self.borders);
        for draw in frame.draws.iter().filter(|d| d.border_vertices > 0) {
            if bound.replace(draw.border_group) != Some(draw.border_group) {
                pass.set_bind_group(0, &frame.groups[draw.border_group][1], &[]);
            }
            pass.set_immediates(0, bytemuck::bytes_of(&draw.face));
            pass.draw(0..draw.border_vertices, draw.placed.clone());
        }
    }
}

/// What one view evaluates: two requests a face, its grid and its border.
#[derive(Default)]
struct FramePlan {
    set: SurfaceSet<f32>,
    requests: Vec<Request>,
    faces: Vec<FaceData>,
    placed: Vec<Range<u32>>,
    places: Vec<f32>,
    trims: TrimTable,
}

impl FramePlan {
    fn new(model: &ExactModel, scenery: &Scenery, camera: &Camera, set: SurfaceSet<f32>) -> Self {
        let mut plan = Self { set, ..Self::default() };
        let mut first = 0;
        for of_shape in scenery.placed.chunk_by(|a, b| a.shape == b.shape) {
            let placed = first..first + of_shape.len() as u32;
            first = placed.end;
            let shape = of_shape[0].shape;
            let error = part_error(scenery, shape, camera);
            for face in &model.parts[shape].faces {
                plan.push(face, scenery.shapes[shape].middle, error, placed.clone());
            }
        }
        plan
    }

    fn push(&mut self, face: &ExactFace, middle: DVec3, error: f64, placed: Range<u32>) {
        let surface = self.set.push_surface(&face.surface);
        let frame = self.set.entries()[surface].frame;
        let [us, vs] = grid(face, error);
        let (row_u, row_v) = (self.places.len() as u32, (self.places.len() + us.len()) as u32);
        for (axis, ts) in [&us, &vs].into_iter().enumerate() {
            let (start, length) = (face.uv.min[axis], face.uv.size()[axis]);
            self.places.extend(ts.iter().map(|t| ((t - start) / length) as f32));
        }
        let trim = match face.loops.is_empty() {
            true => Default::default(),
            false => self.trims.push(&face.loops),
        };
        let border = border(face, error);
        let color = face.color.map_or_else(
            || DEFAULT_COLOR.map(|c| linear(f64::from(c) / 255.0) as f32),
            |c| [c[0], c[1], c[2], 1.0],
        );
        self.faces.push(FaceData {
            offset: local(frame.middle, middle),
            size: frame.size as f32,
            color,
            first: 0,
            height: vs.len() as u32,
            row_u,
            row_v,
            lists: trim.at,
            bands: trim.bands,
            turn: if face.reversed { -1.0 } else { 1.0 },
            border: 0,
        });
        let map = &face.parameters;
        self.requests.push(Request::Grid {
            surface,
            us: us.iter().map(|&u| map.u.nurbs_from_native(u)).collect(),
            vs: vs.iter().map(|&v| map.v.nurbs_from_native(v)).collect(),
        });
        let border = border.into_iter().map(|p| map.nurbs_from_native(p)).collect();
        self.requests.push(Request::Points { surface, uvs: border });
        self.placed.push(placed);
    }

    /// The faces with the places of their points in the buffers, and what is drawn of them.
    fn placed_in(
        &self,
        samples: &Samples<f32>,
        evaluation: &Evaluation<f32>,
    ) -> (Vec<FaceData>, Vec<FaceDraw>) {
        let buffers: Vec<Range<usize>> = evaluation.buffers().map(|(_, range)| range).collect();
        let buffer_of =
            |point: usize| buffers.partition_point(|b| b.end <= point).min(buffers.len().max(1) - 1);
        let mut faces = self.faces.clone();
        let mut draws = Vec::new();
        for (index, face) in faces.iter_mut().enumerate() {
            let (own, border) = (samples.range(2 * index), samples.range(2 * index + 1));
            let (group, border_group) = (buffer_of(own.start), buffer_of(border.start));
            face.first = (own.start - buffers[group].start) as u32;
            face.border = (border.start - buffers[border_group].start) as u32;
            let columns = own.len() as u32 / face.height;
            // A border that is cut between two buffers is left to the lines.
            let whole = border.end <= buffers[border_group].end;
            draws.push(FaceDraw {
                face: index as u32,
                group,
                vertices: 6 * (columns - 1) * (face.height - 1),
                border_group,
                border_vertices: if whole { 3 * border.len() as u32 } else { 0 },
                placed: self.placed[index].clone(),
            });
        }
        (faces, draws)
    }
}

/// The error allowed in the units of a part: that of its nearest and largest placement.
pub(crate) fn part_error(scenery: &Scenery, shape: usize, camera: &Camera) -> f64 {
    let of_shape = scenery.placed.iter().filter(|p| p.shape == shape);
    let errors = of_shape.map(|placed| {
        let world = placed.world;
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|a| world.transform_vector3(a).length());
        let at = camera.view.transform_point3(world.transform_point3(scenery.shapes[shape].middle));
        let radius = scenery.shapes[shape].radius * x.max(y).max(z);
        // Nearer things are larger, but what is behind the eye is not seen.
        let nearer = camera.distance.map_or(1.0, |d| ((d - at.z - radius) / d).max(0.02));
        PIXEL_ERROR * camera.pixel * nearer / x.max(y).max(z)
    });
    errors.fold(f64::INFINITY, f64::min)
}

/// Pairs of native parameters, the ends of short pieces of the border of a face; its square where it has no loops.
fn border(face: &ExactFace, error: f64) -> Vec<DVec2> {
    let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let whole: Vec<_> = (0..4).map(|k| crate::exact::Cubic::line(square[k], square[(k + 1) % 4])).collect();
    let loops = if face.loops.is_empty() { &whole } else { &face.loops };
    let [uu, uv, vv] = face.bends;
    let size = face.uv.size();
    let mut found = Vec::new();
    for piece in loops {
        let d = piece.length_by_axis() * size;
        let bend = uu * d.x * d.x + 2.0 * uv * d.x * d.y + vv * d.y * d.y;
        // Half the error for the surface's bend; the piece's own is of the same order.
        let steps = (bend / (2.0 * error)).sqrt().ceil().clamp(2.0, BORDER_STEPS);
        let at = |k: f64| face.uv.clamp(face.uv.min + piece.at(k / steps) * size);
        found.extend((0..steps as u32).flat_map(|k| [at(f64::from(k)), at(f64::from(k) + 1.0)]));
    }
    found
}

/// Replaces the lines of shapes by ones as fine as the view needs.
pub(crate) fn refine_lines(scenery: &mut Scenery, scene: &Scene, model: &Model, camera: &Camera) {
    for shape in 0..scenery.shapes.len() {
        let error = 0.5 * part_error(scenery, shape, camera);
        if error.is_finite() {
            let lines = edge_lines(&model.parts[shape], &scene.parts[shape].mesh, error);
            let middle = scenery.shapes[shape].middle;
            scenery.shapes[shape].segments = lines.iter().map(|e| e.map(|p| local(p, middle))).collect();
        }
    }
}
