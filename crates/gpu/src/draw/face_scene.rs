//! Exact faces over many frames: a frame uses samples of the frames before it where they are fine enough.
//!
//! 1. Placements and faces that the view cannot show are rejected by bounds (`visible.rs`).
//! 2. For each other face the needed fineness is computed (`choice.rs`). Samples that are fine enough are
//!    kept.
//! 3. The others are evaluated together, in one dispatch for each store, and become a batch (`batch.rs`).
//! 4. Faces of batches that are mostly unused, or small, are evaluated again in a new batch, so that there
//!    are never many batches.

use super::blocks::Blocks;
use super::choice::Choice;
use super::device_store::{FaceLocation, FaceStore, upload_faces};
use super::face_batch::{FaceBatch, Member, most_points};
use super::face_renderer::FaceRenderer;
use super::frame_counts::FrameCounts;
use super::mesh_groups::Triangles;
use super::mesh_shapes::{scene_outline, scenery_of, seen_through, shape_boxes};
use super::options::{Background, RenderOptions, Style, Trim};
use super::picture::Picture;
use super::renderer::{Renderer, Stage, draw};
use super::shapes::Scenery;
use super::still_frame::StillFrame;
use super::target::Target;
use super::view_data::{Standing, standing, view_data};
use super::view_lines::ViewLines;
use super::visible::{Frustum, Shown, Visible};
use crate::device::Gpu;
use crate::error::{GpuError, Task};
use crate::faces::TrimmedModel;
use chordal_brep::Model;
use chordal_mesh::Scene;
use chordal_nurbs::NurbsSurface;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Small batches that are kept before the smaller half of them is evaluated anew.
const MOST_BATCHES: usize = 12;

/// A model on the device.
#[derive(Debug)]
pub struct FaceScene<'a> {
    scene: &'a Scene,
    model: &'a Model,
    exact: TrimmedModel,
    style: Style,
    scenery: Scenery,
    /// Per placement of the scenery.
    standing: Vec<Standing>,
    boxes: Vec<[DVec3; 2]>,
    /// Parts of which some face may show its back alone.
    closed: Vec<bool>,
    outline: Vec<DVec3>,
    stores: Vec<FaceStore>,
    locations: Vec<Vec<FaceLocation>>,
    stage: Stage,
    triangles: Vec<Triangles>,
    lines: ViewLines,
    trim: Trim,
    batches: BTreeMap<u64, FaceBatch>,
    next_batch: u64,
    /// By shape and class, then by face.
    sampled: BTreeMap<(usize, i32), Vec<Option<Sampled>>>,
    /// What is drawn of every batch.
    lists: BTreeMap<u64, List>,
    still_frame: Option<StillFrame>,
    seen: Option<Seen>,
    target: Option<Target>,
}

/// Faces of a batch with the placements they are seen in, and their blocks.
#[derive(Debug)]
struct List {
    drawn: Vec<(usize, Range<u32>)>,
    blocks: Blocks,
}

/// Where a face's samples are.
#[derive(Clone, Copy, Debug)]
struct Sampled {
    batch: u64,
    index: usize,
    choice: Choice,
    /// The surface has changed since.
    stale: bool,
}

/// A face of one level: shape and class, and its number in the part.
type Key = ((usize, i32), usize);

/// A face that is drawn, and the placements it is seen in.
type DrawnFace = (Key, Range<u32>);

/// What options showed: a frame with the same needs neither the placements composed with the camera again nor
/// their bytes sent.
#[derive(Debug)]
struct Seen {
    options: RenderOptions,
    visible: Visible,
    frustum: Frustum,
}

/// A face to be evaluated, and how finely.
type Request = (Key, Choice);

impl<'a> FaceScene<'a> {
    /// Uploads what does not change with the view. `scene` and `model` are those that `exact` was made of.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] for a face beyond what the device binds at once, and what [`Gpu::watched`]
    /// gives.
    pub fn new(
        gpu: &Gpu,
        mut exact: TrimmedModel,
        (scene, model): (&'a Scene, &'a Model),
        style: Style,
    ) -> Result<Self, GpuError> {
        let (mut scenery, _) = scenery_of(scene, model, style, Some(&exact));
        // Backs are visible through faces that are not opaque.
        let veiled = seen_through(scene, &scenery.placed);
        for (part, _) in exact.parts.iter_mut().zip(veiled).filter(|(_, veiled)| *veiled) {
            part.faces.iter_mut().for_each(|f| f.outward = None);
        }
        // Lines are made for the view.
        scenery.shapes.iter_mut().for_each(|shape| shape.segments.clear());
        gpu.watched(Task::UploadingModel, || {
            let (stores, locations) = upload_faces(gpu, &exact, gpu.binding_limit())?;
            Ok(Self {
                standing: standing(&scenery),
                boxes: shape_boxes(scene),
                outline: scene_outline(scene),
                stage: Stage::new(gpu, scenery.placed.len())?,
                triangles: Triangles::upload(gpu, &scenery.shapes)?,
                lines: ViewLines::new(scenery.shapes.len()),
                closed: exact.parts.iter().map(|p| p.faces.iter().any(|f| f.outward.is_some())).collect(),
                trim: Trim::default(),
                batches: BTreeMap::new(),
                next_batch: 0,
                sampled: BTreeMap::new(),
                lists: BTreeMap::new(),
                still_frame: None,
                seen: None,
                target: None,
                scene,
                model,
                exact,
                style,
                scenery,
                stores,
                locations,
            })
        })
    }

    /// The faces that are drawn exactly, and those that are not.
    pub fn exact(&self) -> &TrimmedModel {
        &self.exact
    }

    /// All points that are on the device.
    pub fn points(&self) -> usize {
        self.batches.values().map(|g| g.points).sum()
    }

    /// Puts a surface of the same degrees and counts in the place of that of face `face` (a number among the
    /// exact faces of `part`), and uploads it; the bytes that went. Trims keep their place in the parameters;
    /// lines and bounds that other faces have of it do not move, so that pictures of moving surfaces leave
    /// lines out.
    ///
    /// # Errors
    /// [`GpuError::NoSuchSurface`], [`GpuError::OtherShape`], and what [`Gpu::watched`] gives.
    pub fn set_surface(
        &mut self,
        gpu: &Gpu,
        part: usize,
        face: usize,
        surface: &NurbsSurface,
    ) -> Result<u64, GpuError> {
        let location = *self
            .locations
            .get(part)
            .and_then(|of_part| of_part.get(face))
            .ok_or(GpuError::NoSuchSurface(face))?;
        let store = &mut self.stores[location.store];
        let edit = store.set.replace(location.surface, surface)?;
        let sent = store.on_device.update(gpu, &store.set, location.surface, edit)?;
        (self.still_frame, self.seen) = (None, None);
        let of_part = &mut self.exact.parts[part];
        of_part.faces[face].replace_surface(surface);
        // A shell that moves may open.
        of_part.faces.iter_mut().for_each(|f| f.outward = None);
        self.closed[part] = false;
        if let Some([low, high]) = of_part.faces[face].bounds {
            let [l, h] = self.boxes[part];
            self.boxes[part] = [l.min(low), h.max(high)];
        }
        for (_, faces) in self.sampled.iter_mut().filter(|(key, _)| key.0 == part) {
            // Samples know their place by its span.
            if edit.knots {
                forget(&mut self.batches, faces[face].take());
            }
            faces[face].iter_mut().for_each(|s| s.stale = true);
        }
        Ok(sent)
    }

    pub(crate) fn draw(
        &mut self,
        gpu: &Gpu,
        (renderer, exact): (&Renderer, &FaceRenderer),
        options: &RenderOptions,
    ) -> Result<FrameCounts, GpuError> {
        if self.target.as_ref().is_none_or(|t| t.size != options.size) {
            self.target = Some(Target::new(gpu, options.size)?);
        }
        gpu.watched(Task::Drawing, || {
            let kept = self.seen.take().filter(|seen| seen.options == *options);
            let seen = kept.unwrap_or_else(|| self.see(gpu, options));
            let Seen { visible, frustum, .. } = &seen;
            let backs = options.reject && options.section.is_none();
            let still_frame = self.still_frame.as_ref().filter(|_| self.trim == options.trim);
            let mut counts = match still_frame.and_then(|c| c.counts(visible, backs, &self.closed)) {
                Some(counts) => counts,
                None => {
                    let (counts, keys) = self.evaluate(gpu, exact, visible, frustum, options)?;
                    self.list_blocks(gpu, exact, &keys)?;
                    self.still_frame = self.still_frame(visible, &counts);
                    counts
                }
            };
            counts.placements_outside = self.scenery.placed.len() - visible.order.len();
            if options.lines {
                let parts = (self.scene, self.model);
                self.lines.refine(gpu, renderer, parts, &mut self.scenery, visible, self.stage.buffers())?;
            }
            let target = self.target.as_ref().expect("made above");
            draw(gpu, target, options.background, |pass| {
                renderer.draw_triangles(gpu, pass, &self.stage, &self.triangles, &visible.placed);
                pass.set_pipeline(exact.faces(self.trim));
                for (id, list) in &self.lists {
                    self.batches[id].draw_faces(pass, exact, &list.blocks);
                }
                pass.set_pipeline(&exact.borders);
                for (id, list) in &self.lists {
                    self.batches[id].draw_borders(pass, exact, &list.blocks);
                }
                if options.lines {
                    renderer.draw_lines(pass, self.lines.get(), &visible.placed);
                }
            });
            self.seen = Some(seen);
            Ok(counts)
        })
    }

    /// What the next frame may reuse, if this frame shows everything.
    fn still_frame(&self, visible: &Visible, counts: &FrameCounts) -> Option<StillFrame> {
        let textured = self.trim == Trim::Texture;
        StillFrame::of(visible, counts, |level| {
            let slots = self.sampled[&(level.shape, level.class)].iter();
            let errors = slots.zip(&self.exact.parts[level.shape].faces);
            errors.map(|(slot, face)| Some(slot.as_ref()?.choice.errors_served(face, textured))).collect()
        })
    }

    /// The picture drawn last.
    pub(crate) fn read(&self, gpu: &Gpu, background: Background) -> Result<Picture, GpuError> {
        match &self.target {
            Some(target) => target.read(gpu, background),
            None => Err(GpuError::NothingDrawn),
        }
    }

    /// What the options show; the view and its placements go to the device.
    fn see(&self, gpu: &Gpu, options: &RenderOptions) -> Seen {
        let camera = options.camera(&self.outline);
        let frustum =
            if options.reject { Frustum::new(&camera, options.size) } else { Frustum::all(&camera) };
        let visible = Visible::new(&self.scenery, &self.boxes, &frustum);
        let data: Vec<_> = visible.order.iter().map(|&k| self.standing[k].in_view(&camera)).collect();
        self.stage.set(gpu, &view_data(&camera, options), &data);
        Seen { options: *options, visible, frustum }
    }

    /// Rejects, chooses, and evaluates what has no samples that serve; the faces to draw and where.
    fn evaluate(
        &mut self,
        gpu: &Gpu,
        renderer: &FaceRenderer,
        visible: &Visible,
        frustum: &Frustum,
        options: &RenderOptions,
    ) -> Result<(FrameCounts, Vec<DrawnFace>), GpuError> {
        if self.trim != options.trim {
            (self.trim, self.batches, self.sampled) = (options.trim, BTreeMap::new(), BTreeMap::new());
            self.lists.clear();
        }
        self.forget_levels(visible);
        let retired = self.batches_to_retire(gpu);
        let leave_out_backs = options.reject && options.section.is_none();
        let (mut counts, mut keys, mut requests) =
            (FrameCounts::default(), Vec::new(), Vec::<Request>::new());
        for level in &visible.levels {
            let at = (level.shape, level.class);
            let faces = &self.exact.parts[level.shape].faces;
            let sampled = self.sampled.entry(at).or_insert_with(|| vec![None; faces.len()]);
            for (index, face) in faces.iter().enumerate() {
                match level.shows(frustum, face, leave_out_backs) {
                    Shown::Outside => counts.outside += 1,
                    Shown::Back => counts.backs += 1,
                    Shown::Yes => {
                        let needed = Choice::of(face, level.error);
                        match &sampled[index] {
                            None => requests.push(((at, index), needed)),
                            Some(s) if !s.choice.serves(&needed, options.trim == Trim::Texture) => {
                                requests.push(((at, index), needed.with_reserve(face)));
                            }
                            Some(s) if s.stale || retired.contains(&s.batch) => {
                                requests.push(((at, index), s.choice));
                            }
                            Some(_) => {}
                        }
                        keys.push(((at, index), level.placed.clone()));
                    }
                }
            }
        }
        counts.faces = keys.len();
        counts.evaluated = requests.len();
        counts.points = self.evaluate_requested(gpu, renderer, requests, &retired)?;
        self.release(&retired);
        Ok((counts, keys))
    }

    /// Evaluates the requested faces; returns the number of points.
    fn evaluate_requested(
        &mut self,
        gpu: &Gpu,
        renderer: &FaceRenderer,
        requests: Vec<Request>,
        retired: &BTreeSet<u64>,
    ) -> Result<usize, GpuError> {
        let mut by_batch: BTreeMap<Option<u64>, Vec<Request>> = BTreeMap::new();
        for request in requests {
            let (at, face) = request.0;
            by_batch.entry(self.sampled[&at][face].map(|s| s.batch)).or_default().push(request);
        }
        let mut by_store: BTreeMap<usize, Vec<Request>> = BTreeMap::new();
        let mut points = 0;
        for (id, requests) in by_batch {
            match id.filter(|id| !retired.contains(id)) {
                Some(id) if self.covers_batch(id, &requests) => {
                    points += self.evaluate_in_place(gpu, renderer, id, &requests)?
                }
                _ => {
                    for request in requests {
                        let ((shape, _), face) = request.0;
                        by_store.entry(self.locations[shape][face].store).or_default().push(request);
                    }
                }
            }
        }
        for (store, requests) in by_store {
            points += self.evaluate_in_new_batches(gpu, renderer, store, &requests)?;
        }
        Ok(points)
    }

    /// True where the requests are for all faces of a batch, with the samples that they have.
    fn covers_batch(&self, id: u64, requests: &[Request]) -> bool {
        let same =
            |((at, face), choice): &Request| self.sampled[at][*face].is_some_and(|s| s.choice == *choice);
        self.batches[&id].live == requests.len() && requests.iter().all(same)
    }

    /// Evaluates a batch in place after an edit of its surfaces; returns the number of points.
    fn evaluate_in_place(
        &mut self,
        gpu: &Gpu,
        renderer: &FaceRenderer,
        id: u64,
        requests: &[Request],
    ) -> Result<usize, GpuError> {
        let mut members = Vec::new();
        for ((at, face), _) in requests {
            let slot = self.sampled.get_mut(at).and_then(|faces| faces[*face].as_mut());
            if let Some(sampled) = slot {
                sampled.stale = false;
                members.push((sampled.index, self.locations[at.0][*face], self.scenery.shapes[at.0].middle));
            }
        }
        let Some(batch) = self.batches.get_mut(&id) else { return Ok(0) };
        batch.evaluate_again(gpu, renderer, &self.stores[batch.store], members.into_iter())?;
        Ok(batch.points)
    }

    /// Makes new batches for faces of one store, as many as the limits of the device require; returns the
    /// number of points.
    fn evaluate_in_new_batches(
        &mut self,
        gpu: &Gpu,
        renderer: &FaceRenderer,
        store: usize,
        requests: &[Request],
    ) -> Result<usize, GpuError> {
        let most = most_points(gpu);
        let members: Vec<Member> = requests
            .iter()
            .map(|((at, face), choice)| {
                let middle = self.scenery.shapes[at.0].middle;
                Member::new(
                    &self.exact.parts[at.0].faces[*face],
                    self.locations[at.0][*face],
                    middle,
                    choice,
                    most,
                )
            })
            .collect();
        let (mut first, mut points) = (0, 0);
        while first < members.len() {
            let mut sum = members[first].points();
            let mut end = first + 1;
            while end < members.len() && sum + members[end].points() <= most {
                sum += members[end].points();
                end += 1;
            }
            let some = &members[first..end];
            let stage = self.stage.buffers();
            let made = FaceBatch::new(gpu, renderer, &self.stores[store], some, self.trim, stage)?;
            points += made.points;
            let id = self.next_batch;
            self.next_batch += 1;
            self.batches.insert(id, made);
            for (index, &((at, face), choice)) in requests[first..end].iter().enumerate() {
                let slot = &mut self.sampled.get_mut(&at).expect("entered when the face was requested")[face];
                let old = slot.replace(Sampled { batch: id, index, choice, stale: false });
                forget(&mut self.batches, old);
            }
            first = end;
        }
        Ok(points)
    }

    /// Batches whose faces move to new ones: the smaller half of the small batches where there are too many,
    /// and batches that are mostly unused.
    fn batches_to_retire(&self, gpu: &Gpu) -> BTreeSet<u64> {
        let small = |g: &FaceBatch| 2 * g.points < most_points(gpu);
        let mut by_use: Vec<(usize, u64)> =
            self.batches.iter().filter(|(_, g)| small(g)).map(|(id, g)| (g.live, *id)).collect();
        by_use.sort_unstable();
        let retired = if by_use.len() > MOST_BATCHES { by_use.len() / 2 } else { 0 };
        let unused = self.batches.iter().filter(|(_, g)| 4 * g.live < g.faces());
        by_use.iter().take(retired).map(|(_, id)| *id).chain(unused.map(|(id, _)| *id)).collect()
    }

    /// Drops retired batches. Faces that are still in them are not visible now.
    fn release(&mut self, retired: &BTreeSet<u64>) {
        for slot in self.sampled.values_mut().flatten() {
            if slot.is_some_and(|s| retired.contains(&s.batch)) {
                forget(&mut self.batches, slot.take());
            }
        }
    }

    /// Drops the samples of classes that no placement of a visible shape is in any more.
    fn forget_levels(&mut self, visible: &Visible) {
        let used: BTreeSet<(usize, i32)> = visible.levels.iter().map(|l| (l.shape, l.class)).collect();
        let seen: BTreeSet<usize> = visible.levels.iter().map(|l| l.shape).collect();
        let gone: Vec<_> =
            self.sampled.keys().filter(|k| seen.contains(&k.0) && !used.contains(k)).copied().collect();
        for key in gone {
            for old in self.sampled.remove(&key).into_iter().flatten() {
                forget(&mut self.batches, old);
            }
        }
    }

    /// What is drawn of every batch; lists that were made for the same faces before are kept.
    fn list_blocks(
        &mut self,
        gpu: &Gpu,
        renderer: &FaceRenderer,
        keys: &[DrawnFace],
    ) -> Result<(), GpuError> {
        let mut drawn: BTreeMap<u64, Vec<(usize, Range<u32>)>> = BTreeMap::new();
        for ((at, face), placed) in keys {
            if let Some(sampled) = self.sampled[at][*face] {
                drawn.entry(sampled.batch).or_default().push((sampled.index, placed.clone()));
            }
        }
        self.lists.retain(|id, _| drawn.contains_key(id));
        for (id, drawn) in drawn {
            if self.lists.get(&id).is_none_or(|list| list.drawn != drawn) {
                let blocks = self.batches[&id].blocks(gpu, renderer, self.trim, &drawn)?;
                self.lists.insert(id, List { drawn, blocks });
            }
        }
        Ok(())
    }

    /// The style that the scene was made for.
    pub fn style(&self) -> Style {
        self.style
    }
}

/// Exact faces through the renderer that also draws meshes.
impl Renderer {
    /// Draws a frame of exact faces and leaves it on the device; what has no exact form is drawn as its mesh.
    /// Styles that measure or show the mesh are drawn from it, by [`Self::render`].
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn draw_faces(
        &self,
        gpu: &Gpu,
        exact: &FaceRenderer,
        scene: &mut FaceScene,
        options: &RenderOptions,
    ) -> Result<FrameCounts, GpuError> {
        scene.draw(gpu, (self, exact), options)
    }

    /// As [`Self::draw_faces`], and brings the picture to the host.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_faces(
        &self,
        gpu: &Gpu,
        exact: &FaceRenderer,
        scene: &mut FaceScene,
        options: &RenderOptions,
    ) -> Result<(Picture, FrameCounts), GpuError> {
        let counts = scene.draw(gpu, (self, exact), options)?;
        Ok((scene.read(gpu, options.background)?, counts))
    }
}

/// Takes samples from the batch they are in; one without any is dropped.
fn forget(batches: &mut BTreeMap<u64, FaceBatch>, old: Option<Sampled>) {
    let Some(old) = old else { return };
    if let Some(batch) = batches.get_mut(&old.batch) {
        batch.live -= 1;
        if batch.live == 0 {
            batches.remove(&old.batch);
        }
    }
}

#[cfg(test)]
#[path = "probe_tests.rs"]
mod probe_tests;
