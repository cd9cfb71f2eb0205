//! An edge as seen from the faces that use it: where on their surfaces it runs, and how short they need its
//! chords.
//!
//! A method of another crate may choose the chords of edges: it implements [`EdgeSplitter`] over an
//! [`EdgePiece`].

use crate::limits::Limits;
use crate::metric::Sizing;
use crate::trace::Trace;
use chordal_brep::{Edge, Pcurve};
use chordal_chart::{FaceSurface, Near};
use chordal_nurbs::{Curve, CurveJet, DVec2, DVec3, Range, SurfaceJet};
use std::fmt::Debug;

/// A way to cut edges into chords, in place of the default one.
pub trait EdgeSplitter: Debug + Send + Sync {
    /// The name in reports.
    fn name(&self) -> &str;

    /// Increasing parameters of the vertices along a piece of an edge, both ends of its range included.
    /// `None`: the default method cuts this piece. Chords that are too far off the curve are halved
    /// afterwards.
    fn parameters(
        &self,
        piece: &EdgePiece<'_>,
        uses: &[EdgeUse<'_, '_>],
        trace: &mut Trace,
    ) -> Option<Vec<f64>>;

    /// True for a method that approximates curves in space. Methods that fill faces then leave the chords of
    /// edges alone, and use the whole tolerance for the surface.
    fn is_in_space(&self) -> bool {
        false
    }
}

/// A piece of an edge without corners.
#[derive(Clone, Copy, Debug)]
pub struct EdgePiece<'a> {
    /// The curve of the edge.
    pub curve: &'a Curve,
    /// The range of the whole edge.
    pub whole: Range,
    /// The range of the piece.
    pub range: Range,
    /// Largest distance of a chord from the curve, in the part's units.
    pub tolerance: f64,
}

/// A face that uses the edge.
#[derive(Debug)]
pub struct EdgeUse<'a, 's> {
    pub surface: &'a FaceSurface<'s>,
    pub pcurve: Option<&'a Pcurve>,
    /// The diagonal of the box of the face's edges: how far the face may reach across this edge.
    pub reach: f64,
}

/// Chords along a doubly curved face have this share of the allowed length. A triangle over a full chord
/// would be over the tolerance at any height.
const DOUBLY_CURVED_CHORD: f64 = 0.9;

/// Where the last probe lay on the surface of a face, and how fast the curve moved there.
#[derive(Clone, Copy)]
pub(crate) struct Track {
    t: f64,
    place: Near,
    rate: DVec2,
}

/// A probe is found by one step from the last one if that step misses the curve by at most this share of its
/// length. Otherwise the whole surface is searched, which is slower by far.
const ON_TRACK: f64 = 0.1;

/// Places along an edge at which its parameter curve is compared with it.
const PACE_CHECKS: u32 = 8;

impl EdgeUse<'_, '_> {
    /// The same use without the parameter curve, if that runs at another pace than the edge: equal shares of
    /// the two are then different places, although both may be the same line.
    pub(crate) fn paced(self, edge: &Edge, tolerance: f64) -> Self {
        let (Some(curve), Some(_), false) =
            (edge.curve.as_deref(), self.pcurve, self.surface.is_elementary())
        else {
            return self;
        };
        let strays = (1..PACE_CHECKS).any(|i| {
            let t = edge.range.start + edge.range.length() * f64::from(i) / f64::from(PACE_CHECKS);
            let p = curve.point(t);
            let beside = self.surface.point(self.parameters(p, t, edge.range, None).uv).distance(p);
            let nearest = || self.surface.point(self.surface.invert_from(p, None).uv).distance(p);
            beside > tolerance && nearest() < 0.5 * beside
        });
        Self { pcurve: self.pcurve.filter(|_| !strays), ..self }
    }

    /// The parameters of the point at `t`: by the file's parameter curve if there is one, else those of the
    /// nearest point of the surface.
    pub(crate) fn parameters(&self, p_xyz: DVec3, t: f64, range: Range, near: Option<Near>) -> Near {
        let from_file = self.pcurve.filter(|_| !self.surface.is_elementary()).map(|p| {
            let share = (t - range.start) / range.length();
            let own = p.range.start + share * p.range.length();
            p.curve.point(own)
        });
        from_file.map_or_else(|| self.surface.invert_from(p_xyz, near), Near::on_surface)
    }

    /// Chords per unit of parameter that the face needs.
    pub(crate) fn rate(
        &self,
        jet: &CurveJet,
        t: f64,
        range: Range,
        track: &mut Option<Track>,
        limits: &Limits,
    ) -> f64 {
        if matches!(self.surface.surface, chordal_nurbs::Surface::Plane { .. }) {
            return 0.0;
        }
        let (place, s) = self.place(jet, t, range, track.as_ref());
        // The direction in parameter space that maps to the curve's tangent, by least squares.
        let d = least_squares(&s, jet.d1);
        *track = Some(Track { t, place, rate: d });
        // Where the edge lies off the surface, it is unknown which of two folds is meant.
        let off = s.p.distance(jet.p);
        let Some(sizing) = Sizing::known_within(&s, limits, off) else { return 0.0 };
        let rate = sizing.metric.length(d);
        // The face is curved across the edge as well, and reaches far enough for a second row of triangles.
        let across = sizing.metric.determinant().max(0.0).sqrt() / sizing.area.max(1e-300) * jet.d1.length()
            / rate.max(1e-300);
        let doubly = sizing.gauss > 0.0 && across * self.reach > 0.7;
        if doubly { rate / DOUBLY_CURVED_CHORD } else { rate }
    }

    /// Parameters of a point of the edge, and the surface near them.
    fn place(&self, jet: &CurveJet, t: f64, range: Range, track: Option<&Track>) -> (Near, SurfaceJet) {
        if let Some(track) = track.filter(|_| self.pcurve.is_none() && !self.surface.is_elementary())
            && let Some(found) = self.followed(jet, t, track)
        {
            return found;
        }
        let place = self.parameters(jet.p, t, range, track.map(|track| track.place));
        (place, self.surface.jet(place.uv))
    }

    /// The parameters by a straight step from the last probe and one Gauss–Newton step: as exact as a spacing
    /// needs.
    fn followed(&self, jet: &CurveJet, t: f64, track: &Track) -> Option<(Near, SurfaceJet)> {
        let guess = self.surface.inside(track.place.uv + track.rate * (t - track.t));
        let s = self.surface.jet(guess);
        let r = jet.p - s.p;
        let on_track = r.length() <= ON_TRACK * jet.d1.length() * (t - track.t).abs();
        let uv = self.surface.inside(guess + least_squares(&s, r));
        (on_track && uv.is_finite()).then_some((Near { uv, ..track.place }, s))
    }
}

/// The step in parameter space whose image comes nearest to a step in space.
fn least_squares(s: &SurfaceJet, step: DVec3) -> DVec2 {
    let (e, f, g) = (s.du.length_squared(), s.du.dot(s.dv), s.dv.length_squared());
    let (a, b) = (s.du.dot(step), s.dv.dot(step));
    DVec2::new(a * g - b * f, b * e - a * f) / (e * g - f * f)
}
