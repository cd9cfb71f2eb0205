//! Which faces are evaluated for a frame, and in which batches their samples are kept.

use super::{DrawnFace, FaceScene, Request, Sampled};
use crate::device::Gpu;
use crate::draw::choice::Choice;
use crate::draw::face_batch::FaceBatch;
use crate::draw::face_batch::Member;
use crate::draw::face_batch::most_points;
use crate::draw::face_renderer::FaceRenderer;
use crate::draw::frame_counts::FrameCounts;
use crate::draw::options::RenderOptions;
use crate::draw::options::Trim;
use crate::draw::visible::Frustum;
use crate::draw::visible::Shown;
use crate::draw::visible::Visible;
use crate::error::GpuError;
use std::collections::BTreeMap;
use std::collections::BTreeSet;

/// Small batches that are kept before the smaller half of them is evaluated anew.
const MOST_BATCHES: usize = 12;

impl FaceScene<'_> {
    /// Rejects, chooses, and evaluates what has no samples that serve; the faces to draw and where.
    pub(super) fn evaluate(
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
}

/// Removes samples from their batch. A batch without samples is dropped.
pub(super) fn forget(batches: &mut BTreeMap<u64, FaceBatch>, old: Option<Sampled>) {
    let Some(old) = old else { return };
    if let Some(batch) = batches.get_mut(&old.batch) {
        batch.live -= 1;
        if batch.live == 0 {
            batches.remove(&old.batch);
        }
    }
}
