//! Faces from a surface and loops of curves in its parameter space: for formats without edges.
//!
//! Each loop is closed and cut at its corners ([`chain`]), loops that cross become loops that do not
//! ([`untangle`]), loops are classified as outer ones and holes ([`nest`]), and their pieces become edges
//! of the part ([`edges`]). A surface without trims gets its own border ([`natural`]).
//!
//! What the caller gives runs in the surface's parameters; directions do not matter: outer loops are made to
//! run counter-clockwise, holes clockwise.

mod chain;
mod clip;
mod edges;
mod meet;
mod natural;
mod nest;
mod polygon;
#[cfg(test)]
mod tests;
mod untangle;

use crate::Winding;
use crate::assemble::Notes;
use chordal_brep::{
    Body, BodyId, BodyKind, Color, Face, FaceGeometry, FaceId, Issue, Loop, Part, ReadIssue, Shell, ShellId,
    Source,
};
use chordal_nurbs::{Curve2, DVec2, Range, Surface, UvBox};
use std::sync::Arc;

/// A piece of a loop: a curve of parameter space over a range, run backwards unless `forward`.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub curve: Arc<Curve2>,
    pub range: Range,
    pub forward: bool,
}

impl Piece {
    /// The whole of a bounded curve.
    pub(crate) fn whole(curve: Curve2) -> Self {
        let range = curve.domain();
        Self { curve: Arc::new(curve), range, forward: true }
    }

    /// The straight line from `a` to `b`.
    pub(crate) fn line(a: DVec2, b: DVec2) -> Self {
        let curve = Curve2::Line { origin: a, direction: b - a };
        Self { curve: Arc::new(curve), range: Range::new(0.0, 1.0), forward: true }
    }

    /// The point at `share` (0..=1) of the piece in its running direction.
    pub(crate) fn at(&self, share: f64) -> DVec2 {
        let share = if self.forward { share } else { 1.0 - share };
        let t = if share == 1.0 { self.range.end } else { self.range.start + share * self.range.length() };
        self.curve.point(t)
    }
}

/// What a loop is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// The format states that the face lies inside.
    Outer,
    /// The format states that the face lies outside.
    Hole,
    /// By how many other loops are around it, and the convention.
    ByNesting(Winding),
}

/// A chain of pieces that closes, or is closed.
#[derive(Clone, Debug)]
pub(crate) struct TrimLoop {
    pub pieces: Vec<Piece>,
    pub role: Role,
    pub source: Source,
}

/// What a face has besides its shape.
#[derive(Clone, Debug, Default)]
pub(crate) struct Look {
    pub name: String,
    pub color: Option<Color>,
    pub layer: Option<String>,
    /// Triangles run against the surface's normal.
    pub flipped: bool,
    pub source: Source,
}

/// Adds the face that `trims` cut out of a surface (without trims: all of it); where they have several outer
/// loops, one face for each. What was repaired is added to `notes`; a face that cannot be made becomes a
/// failed one.
pub(crate) fn add_faces(
    part: &mut Part,
    surface: &Arc<Surface>,
    trims: &[TrimLoop],
    look: &Look,
    notes: &Notes,
) -> Vec<FaceId> {
    let scale = Scale::new(surface, trims);
    let mut chains = Vec::with_capacity(trims.len());
    let mut problem = None;
    for (i, trim) in trims.iter().enumerate() {
        match chain::closed(trim, i, &scale, notes) {
            Ok(Some(found)) => chains.push(found),
            Ok(None) => {}
            Err(reason) => problem = problem.or(Some(reason)),
        }
    }
    let groups = match problem {
        Some(reason) => Err(reason),
        None if chains.is_empty() => Ok(vec![natural::loops(surface)]),
        None => nest::groups(surface, chains, &scale).map(|groups| {
            if let Some(places) = groups.untangled {
                notes.warn(look.source, ReadIssue::TrimsUntangled { loops: trims.len(), places });
            }
            groups.faces
        }),
    };
    match groups {
        Ok(groups) => groups
            .into_iter()
            .map(|chains| {
                let loops = edges::loops(part, surface, chains, &scale);
                push_face(part, FaceGeometry::Surface(surface.clone()), loops, look)
            })
            .collect(),
        Err(reason) => {
            vec![push_face(part, FaceGeometry::Failed(Issue::error(look.source, reason)), Vec::new(), look)]
        }
    }
}

/// Adds a face that could not be understood.
pub(crate) fn add_failed(part: &mut Part, reason: impl Into<ReadIssue>, look: &Look) -> FaceId {
    push_failed(part, Issue::error(look.source, reason.into()), look)
}

/// Adds a face that fails because of an issue, which may be one of another entity.
pub(crate) fn push_failed(part: &mut Part, issue: Issue, look: &Look) -> FaceId {
    push_face(part, FaceGeometry::Failed(issue), Vec::new(), look)
}

/// Adds a body of one shell that holds these faces.
pub(crate) fn add_body(part: &mut Part, faces: Vec<FaceId>, kind: BodyKind, look: &Look) -> BodyId {
    let shell = ShellId::from(part.shells.len());
    part.shells.push(Shell { faces, closed: kind == BodyKind::Solid, source: look.source });
    let id = BodyId::from(part.bodies.len());
    part.bodies.push(Body {
        kind,
        shells: vec![shell],
        name: look.name.clone(),
        color: look.color,
        layer: look.layer.clone(),
        source: look.source,
    });
    id
}

fn push_face(part: &mut Part, geometry: FaceGeometry, loops: Vec<Loop>, look: &Look) -> FaceId {
    let id = FaceId::from(part.faces.len());
    part.faces.push(Face {
        geometry,
        same_sense: true,
        flipped: look.flipped,
        loops,
        name: look.name.clone(),
        color: look.color,
        layer: look.layer.clone(),
        source: look.source,
    });
    id
}

/// The parameter space that lengths of parameters are measured against.
#[derive(Clone, Debug)]
struct Scale {
    /// The surface's domain, or where that is unbounded the box of the loops.
    uv: UvBox,
    periods: [Option<f64>; 2],
    /// Directions in which the surface ends.
    bounded: [bool; 2],
}

impl Scale {
    fn new(surface: &Surface, trims: &[TrimLoop]) -> Self {
        let domain = surface.domain();
        let pieces = || trims.iter().flat_map(|trim| &trim.pieces);
        let seen = pieces()
            .filter(|piece| piece.range.is_finite())
            .map(|piece| piece.curve.sampled_box(piece.range))
            .fold(UvBox::EMPTY, |all, b| all.including(b.min).including(b.max));
        let mut uv = domain;
        let mut bounded = [true; 2];
        for axis in 0..2 {
            if !(domain.min[axis].is_finite() && domain.max[axis].is_finite()) {
                bounded[axis] = false;
                uv.min[axis] = seen.min[axis];
                uv.max[axis] = seen.max[axis];
            }
        }
        let periods = surface.periods();
        for axis in 0..2 {
            bounded[axis] &= periods[axis].is_none();
        }
        Self { uv, periods, bounded }
    }

    /// Parameters as shares of the domain.
    fn unit(&self, p_uv: DVec2) -> DVec2 {
        let size = self.uv.size();
        let safe = |length: f64| if length > 0.0 { length } else { 1.0 };
        (p_uv - self.uv.min) / DVec2::new(safe(size.x), safe(size.y))
    }
}
