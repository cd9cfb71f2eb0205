//! What all stages of one part share: its surfaces, the uses of its edges, and the limits.

use crate::budget::{Budget, Spent};
use crate::edge_use::EdgeUse;
use crate::known_faces::KnownFaces;
use crate::limits::{Limits, resolution};
use crate::memo::Memo;
use crate::options::{Cancel, Options};
use chordal_brep::{Face, FaceGeometry, Issue, Loop, MeshIssue, Part, Pcurve};
use chordal_chart::FaceSurface;
use chordal_nurbs::{DVec3, Surface};
use std::borrow::Cow;
use std::sync::Mutex;

/// The share of the tolerance that is aimed at, so that rounding and the last bit of a bound never matter. It
/// costs at most half a percent more triangles.
const AIM: f64 = 0.995;

/// What the faces and edges of a part took so far.
#[derive(Debug, Default)]
pub(crate) struct Efforts {
    pub faces: Vec<Spent>,
    pub edges: Vec<Spent>,
    /// Making loops that do not cross, of all faces together.
    pub healing: Spent,
}

impl Efforts {
    /// With room for all faces and edges of a part; healing adds edges.
    pub fn cover(&mut self, part: &Part) {
        let (faces, edges) = (part.faces.len(), part.edges.len());
        self.faces.resize_with(faces.max(self.faces.len()), Spent::default);
        self.edges.resize_with(edges.max(self.edges.len()), Spent::default);
    }
}

/// One part to be meshed.
pub(crate) struct PartJob<'a> {
    pub part: &'a Part,
    pub limits: Limits,
    pub options: &'a Options,
    pub cancel: &'a Cancel,
    pub resolution: f64,
    pub known: KnownFaces,
    /// What faces and edges took so far, in this pass over the part and earlier ones.
    pub efforts: &'a Efforts,
    /// What they gave in earlier passes; none where nothing is to be kept.
    pub memo: Option<&'a Mutex<Memo>>,
    /// Of every face; the reader's reason where there is none.
    pub surfaces: Vec<Result<FaceSurface<'a>, &'a Issue>>,
    /// Of every edge: the faces that use it, each with its curve in that face's parameters.
    uses: Vec<Vec<(usize, Option<&'a Pcurve>)>>,
    /// Of every face: how far its vertices lie apart.
    reach: Vec<f64>,
}

impl<'a> PartJob<'a> {
    /// `exact` holds the surfaces of all faces, from [`exact_surfaces`].
    pub fn new(
        part: &'a Part,
        exact: &'a [ExactSurface<'a>],
        options: &'a Options,
        efforts: &'a Efforts,
        cancel: &'a Cancel,
    ) -> Self {
        let resolution = resolution(part, options.tolerance);
        Self {
            part,
            limits: Limits {
                tolerance: AIM * options.tolerance,
                boundary: AIM * options.boundary_tolerance.unwrap_or(options.tolerance),
                angle: options.angle.unwrap_or(f64::INFINITY),
                length: options.max_edge.unwrap_or(f64::INFINITY),
            },
            options,
            cancel,
            resolution,
            known: KnownFaces::default(),
            efforts,
            memo: None,
            surfaces: exact
                .iter()
                .map(|found| found.as_ref().map(|s| FaceSurface::new(s, resolution)).map_err(|issue| *issue))
                .collect(),
            uses: uses_of_edges(part),
            reach: part.faces.iter().map(|face| reach(part, face)).collect(),
        }
    }

    /// The same with what earlier passes found out.
    pub fn with_known(mut self, known: KnownFaces) -> Self {
        self.known = known;
        self
    }

    /// The same with a memory of earlier passes.
    pub fn with_memo(mut self, memo: &'a Mutex<Memo>) -> Self {
        self.memo = Some(memo);
        self
    }

    /// Looks into the memory of earlier passes, or adds to it.
    pub fn remembered<T>(&self, look: impl FnOnce(&mut Memo) -> T) -> Option<T> {
        self.memo.and_then(|memo| memo.lock().ok()).map(|mut memo| look(&mut memo))
    }

    /// The faces that use an edge.
    pub fn faces_at(&self, edge: usize) -> impl Iterator<Item = usize> + '_ {
        self.uses[edge].iter().map(|&(face, _)| face)
    }

    /// The uses of an edge, as far as their faces have surfaces.
    pub fn edge_uses(&self, edge: usize) -> Vec<EdgeUse<'_, 'a>> {
        let model = &self.part.edges[edge];
        let with_surface = self.uses[edge].iter().filter_map(|&(face, pcurve)| {
            let surface = self.surfaces[face].as_ref().ok()?;
            Some(EdgeUse { surface, pcurve, reach: self.reach[face] }.paced(model, self.limits.tolerance))
        });
        with_surface.collect()
    }

    /// Runs the work on a face, an edge or the healing of loops within the remaining budget.
    pub fn within_budget<T>(&self, spent: &Spent, work_on: impl FnOnce(Budget) -> T) -> T {
        spent.within(self.options.face_timeout, self.options.file_budget.as_ref(), work_on)
    }

    /// The surface of a face.
    ///
    /// # Errors
    /// Where the reader made none: the reader's reason.
    pub fn surface(&self, face: usize) -> Result<&FaceSurface<'a>, MeshIssue> {
        self.surfaces[face]
            .as_ref()
            .map_err(|issue| MeshIssue::SurfaceNotRead { issue: Box::new((*issue).clone()) })
    }
}

/// The surface to mesh on, or why the reader made none.
pub(crate) type ExactSurface<'a> = Result<Cow<'a, Surface>, &'a Issue>;

/// The surfaces to mesh on: offsets of elementary surfaces are elementary themselves.
pub(crate) fn exact_surfaces(part: &Part) -> Vec<ExactSurface<'_>> {
    part.faces.iter().map(exact_surface).collect()
}

fn exact_surface(face: &Face) -> ExactSurface<'_> {
    match &face.geometry {
        FaceGeometry::Failed(issue) => Err(issue),
        FaceGeometry::Surface(surface) => Ok(match surface.as_ref() {
            Surface::Offset { .. } => Cow::Owned(surface.as_ref().clone().simplified()),
            other => Cow::Borrowed(other),
        }),
    }
}

fn uses_of_edges(part: &Part) -> Vec<Vec<(usize, Option<&Pcurve>)>> {
    let mut uses = vec![Vec::new(); part.edges.len()];
    for (f, face) in part.faces.iter().enumerate().filter(|(_, face)| face.failure().is_none()) {
        for a_loop in &face.loops {
            let Loop::Edges { coedges, .. } = a_loop else { continue };
            for coedge in coedges {
                uses[coedge.edge.index()].push((f, coedge.pcurves.first()));
            }
        }
    }
    uses
}

/// The edges of a face, as its loops run along them.
pub(crate) fn edges_of_face(part: &Part, face: usize) -> impl Iterator<Item = usize> + '_ {
    let coedges = part.faces[face].loops.iter().flat_map(|a_loop| match a_loop {
        Loop::Edges { coedges, .. } => coedges.as_slice(),
        _ => &[],
    });
    coedges.map(|coedge| coedge.edge.index())
}

/// The diagonal of the box of points of a face's edges.
fn reach(part: &Part, face: &Face) -> f64 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut add = |p: DVec3| (low, high) = (low.min(p), high.max(p));
    for a_loop in &face.loops {
        if let Loop::Edges { coedges, .. } = a_loop {
            for coedge in coedges {
                let edge = &part.edges[coedge.edge.index()];
                add(part.vertices[edge.start.index()].point);
                if let Some(curve) = &edge.curve {
                    add(curve.point(0.5 * (edge.range.start + edge.range.end)));
                }
            }
        }
    }
    if low.is_finite() { (high - low).length() } else { 0.0 }
}
