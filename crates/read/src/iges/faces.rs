//! Faces that bring their own boundaries: trimmed surfaces (144), bounded ones (143), planes (108), and
//! surfaces that are faces by themselves.
//!
//! A boundary is given in space, in parameter space, or both. The curves in space become the edges where they
//! lie on the surface, since neighbours have the same; otherwise the curves in parameter space do.

use super::boundaries::{self, Boundary, LOOSE, Preference};
use super::builder::Builder;
use super::document::{Ix, Res};
use super::matrix;
use super::own_border::stands_for_border;
use super::simpler::elementary;
use super::surfaces::{Patch, surface};
use crate::trimmed::{self, Look, Piece, Role, TrimLoop};
use chordal_brep::{Face, FaceGeometry, FaceId, Loop, ReadIssue};
use chordal_nurbs::{DAffine3, DVec2, UvBox};
use std::sync::Arc;

/// Curves lie on a surface within this part of their boundary's size.
const ON_SURFACE: f64 = 1e-3;

impl Builder<'_, '_> {
    /// Adds the faces of an entity, however broken it is; none where it is not a face.
    pub(crate) fn faces(&mut self, ix: Ix) -> Vec<FaceId> {
        let look = self.look(ix);
        let made = match self.doc.kind(ix) {
            144 => self.trimmed_surface(ix, &look),
            143 => self.bounded_surface(ix, &look),
            108 => self.plane(ix, &look),
            _ => self.whole_surface(ix, &look),
        };
        made.unwrap_or_else(|bad| vec![self.failed(bad, &look)])
    }

    /// 144: surface, whether the outer boundary is given, number of inner boundaries, outer one, inner ones.
    fn trimmed_surface(&mut self, ix: Ix, look: &Look) -> Res<Vec<FaceId>> {
        let by = matrix::of_entity(self.doc, ix)?;
        let mut args = self.doc.open(ix)?;
        let basis = args.reference()?;
        let has_outer = args.integer()? == 1;
        let holes = args.count()?;
        let outer = args.optional_reference()?.filter(|_| has_outer);
        let inner = (0..holes).map(|_| args.reference()).collect::<Res<Vec<Ix>>>()?;
        let patch = surface(self.doc, basis, &by)?;
        self.bounded(ix, &by, patch, outer, &inner, look)
    }

    fn curve_on_surface(&self, ix: Ix, by: &DAffine3, patch: &Patch) -> Res<Boundary> {
        match self.doc.kind(ix) {
            142 => {
                boundaries::curve_on_surface(self.doc, ix, &(*by * matrix::of_entity(self.doc, ix)?), patch)
            }
            141 => boundaries::boundary(self.doc, ix, &(*by * matrix::of_entity(self.doc, ix)?), patch),
            _ => Err(self.doc.unknown(ix, "a boundary")),
        }
    }

    /// 143: which curves there are, surface, number of boundaries, boundaries; the first of them the outer
    /// one.
    fn bounded_surface(&mut self, ix: Ix, look: &Look) -> Res<Vec<FaceId>> {
        let by = matrix::of_entity(self.doc, ix)?;
        let mut args = self.doc.open(ix)?;
        args.skip(1);
        let basis = args.reference()?;
        let count = args.count()?;
        let list = (0..count).map(|_| args.reference()).collect::<Res<Vec<Ix>>>()?;
        let patch = surface(self.doc, basis, &by)?;
        let (outer, inner) = match list.split_first() {
            Some((&outer, inner)) => (Some(outer), inner),
            None => (None, &[][..]),
        };
        self.bounded(ix, &by, patch, outer, inner, look)
    }

    fn boundaries(&self, list: &[Ix], by: &DAffine3, patch: &Patch) -> Res<Vec<Boundary>> {
        list.iter().map(|&boundary| self.curve_on_surface(boundary, by, patch)).collect()
    }

    /// A surface cut out by boundaries; without an outer one, its own border is that.
    fn bounded(
        &mut self,
        ix: Ix,
        by: &DAffine3,
        patch: Patch,
        outer: Option<Ix>,
        inner: &[Ix],
        look: &Look,
    ) -> Res<Vec<FaceId>> {
        let list: Vec<Ix> = outer.into_iter().chain(inner.iter().copied()).collect();
        if list.is_empty() {
            return self.whole(ix, &patch, look);
        }
        let has_outer = outer.is_some();
        let resolution = self.resolution();
        let slack = |boundary: &Boundary| (LOOSE * boundary.size()).max(4.0 * resolution);
        let mut all = self.boundaries(&list, by, &patch)?;
        if has_outer && all.len() == 1 && stands_for_border(&all[0], &patch, resolution) {
            self.doc.warn(all[0].ix, ReadIssue::BoundaryIsBorder);
            return self.whole(ix, &patch, look);
        }
        if has_outer
            && let Some(simple) = elementary(&patch)
            && all.iter().all(|b| !b.model.is_empty() && b.model_off(&simple) <= slack(b))
        {
            let same = simple.reversed == patch.reversed;
            let turns =
                all.iter().map(|b| known_turn(b, &patch, resolution).map(|ccw| ccw == same)).collect();
            return self.cut_in_space(ix, &simple, all, turns, has_outer, look);
        }
        let turns: Vec<Option<bool>> = all.iter().map(|b| known_turn(b, &patch, resolution)).collect();
        if all.iter_mut().all(|boundary| in_space(boundary, &patch, resolution)) {
            return self.cut_in_space(ix, &patch, all, turns, has_outer, look);
        }
        // Where the two descriptions disagree, the one off the surface is wrong.
        let has_parameters = all.iter().all(|b| !b.parameters.is_empty());
        let in_parameters = has_parameters
            && (all.iter().all(|b| b.parameters_fit(&patch, resolution))
                || all.iter().any(|b| b.model.is_empty() || b.model_off(&patch) > slack(b)));
        if in_parameters {
            return Ok(self.cut_in_parameters(&patch, &all, has_outer, look));
        }
        if let Some(missing) = all.iter().find(|boundary| boundary.model.is_empty()) {
            return Err(self.doc.bad(missing.ix, ReadIssue::MixedCurves));
        }
        self.cut_in_space(ix, &patch, all, turns, has_outer, look)
    }

    /// All boundaries as curves of parameter space.
    fn cut_in_parameters(
        &mut self,
        patch: &Patch,
        all: &[Boundary],
        has_outer: bool,
        look: &Look,
    ) -> Vec<FaceId> {
        let trims = all.iter().enumerate().map(|(i, boundary)| TrimLoop {
            pieces: boundary
                .parameters
                .iter()
                .map(|p| Piece {
                    curve: Arc::new(p.segment.curve.clone()),
                    range: p.segment.range,
                    forward: p.forward,
                })
                .collect(),
            role: if i == 0 && has_outer { Role::Outer } else { Role::Hole },
            source: self.doc.source(boundary.ix),
        });
        let trims: Vec<TrimLoop> = trims.collect();
        self.add_faces(patch, &trims, look)
    }

    fn add_faces(&mut self, patch: &Patch, trims: &[TrimLoop], look: &Look) -> Vec<FaceId> {
        let look = Look { flipped: look.flipped != patch.reversed, ..look.clone() };
        let surface = Arc::new(patch.surface.clone());

        trimmed::add_faces(&mut self.build.part, &surface, trims, &look, &self.doc.notes)
    }

    /// All boundaries as curves in space; `turns` is the direction of each in our parameters.
    fn cut_in_space(
        &mut self,
        ix: Ix,
        patch: &Patch,
        all: Vec<Boundary>,
        turns: Vec<Option<bool>>,
        has_outer: bool,
        look: &Look,
    ) -> Res<Vec<FaceId>> {
        let mut loops = Vec::new();
        for (i, (boundary, turn)) in all.into_iter().zip(turns).enumerate() {
            let outer = i == 0 && has_outer;
            let size = boundary.size();
            match self.model_loop(boundary.ix, boundary.model, size, patch, outer, turn) {
                Some(coedges) => loops.push(Loop::Edges { coedges, outer }),
                None if outer => return Err(self.doc.bad(boundary.ix, ReadIssue::NoExtent)),
                None => self.doc.warn(boundary.ix, ReadIssue::InnerBoundaryIgnored),
            }
        }
        if !has_outer {
            let faces = self.whole(ix, patch, look)?;
            if let Some(face) = faces.first() {
                self.build.part.faces[face.index()].loops.extend(loops);
            }
            return Ok(faces);
        }
        let id = FaceId::from(self.build.part.faces.len());
        self.build.part.faces.push(Face {
            geometry: FaceGeometry::Surface(Arc::new(patch.surface.clone())),
            same_sense: true,
            flipped: look.flipped != patch.reversed,
            loops,
            name: look.name.clone(),
            color: look.color,
            layer: look.layer.clone(),
            source: look.source,
        });
        Ok(vec![id])
    }

    /// A surface without boundaries.
    fn whole_surface(&mut self, ix: Ix, look: &Look) -> Res<Vec<FaceId>> {
        let patch = surface(self.doc, ix, &DAffine3::IDENTITY)?;
        self.whole(ix, &patch, look)
    }

    fn whole(&mut self, ix: Ix, patch: &Patch, look: &Look) -> Res<Vec<FaceId>> {
        let trims: Vec<TrimLoop> = patch.bounds.iter().map(|uv| rectangle(*uv, look)).collect();
        if trims.is_empty() && !patch.surface.domain().is_finite() {
            return Err(self.doc.bad(ix, ReadIssue::SurfaceUnbounded));
        }
        Ok(self.add_faces(patch, &trims, look))
    }

    /// 108: four coefficients, the curve that bounds it.
    fn plane(&mut self, ix: Ix, look: &Look) -> Res<Vec<FaceId>> {
        let by = matrix::of_entity(self.doc, ix)?;
        let mut args = self.doc.open(ix)?;
        args.skip(4);
        let Some(curve) = args.optional_reference()? else {
            return Err(self.doc.bad(ix, ReadIssue::SurfaceUnbounded));
        };
        let patch = surface(self.doc, ix, &DAffine3::IDENTITY)?;
        let boundary = boundaries::in_space(self.doc, curve, &by)?;
        self.cut_in_space(ix, &patch, vec![boundary], vec![None], true, look)
    }
}

/// True where the curves in space are good edges: they lie on the surface, and each has its curve in
/// parameter space where there are any.
fn in_space(boundary: &mut Boundary, patch: &Patch, resolution: f64) -> bool {
    if boundary.model.is_empty() {
        return false;
    }
    if boundary.parameters.is_empty() {
        return true;
    }
    // Where equal shares of the two are not one point, neither helps the other: one of them must do.
    if !boundary.match_pieces(patch, resolution) || !boundary.paced() {
        return false;
    }
    let strict = if boundary.preference == Preference::Parameters { 1.0 } else { 10.0 };
    boundary.off_surface(patch) <= (ON_SURFACE * boundary.size()).max(strict * resolution)
}

/// Which way the pieces in space run in the parameters of the patch. Where the file's two descriptions of the
/// boundary are not at one place, their points say nothing of each other; that both run the same way is then
/// all that is left.
fn known_turn(boundary: &Boundary, patch: &Patch, resolution: f64) -> Option<bool> {
    if boundary.parameters_fit(patch, resolution) {
        boundary.turn(patch)
    } else {
        boundary.parameter_turn(patch)
    }
}

fn rectangle(uv: UvBox, look: &Look) -> TrimLoop {
    let corners = [uv.min, DVec2::new(uv.max.x, uv.min.y), uv.max, DVec2::new(uv.min.x, uv.max.y)];
    let pieces = (0..4).map(|k| Piece::line(corners[k], corners[(k + 1) % 4])).collect();
    TrimLoop { pieces, role: Role::Outer, source: look.source }
}
