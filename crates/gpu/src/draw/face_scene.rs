//! Exact faces over many frames: a frame uses samples of the frames before it where they are fine enough.
//!
//! 1. Placements and faces that the view cannot show are rejected by bounds (`visible.rs`).
//! 2. For each other face the needed fineness is computed (`choice.rs`). Samples that are fine enough are
//!    kept.
//! 3. The others are evaluated together, in one dispatch for each store, and become a batch (`batch.rs`).
//! 4. Faces of batches that are mostly unused, or small, are evaluated again in a new batch, so that there
//!    are never many batches.

mod evaluation;

use self::evaluation::forget;
use super::blocks::Blocks;
use super::choice::Choice;
use super::device_store::{FaceLocation, FaceStore, upload_faces};
use super::face_batch::FaceBatch;
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
use super::visible::{Frustum, Visible};
use crate::device::Gpu;
use crate::error::{GpuError, Task};
use crate::faces::TrimmedModel;
use chordal_brep::Model;
use chordal_mesh::Scene;
use chordal_nurbs::NurbsSurface;
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;

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

#[cfg(test)]
#[path = "probe_tests.rs"]
mod probe_tests;
