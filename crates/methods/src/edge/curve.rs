//! An edge in the plane of parameters of one of its faces, as Bézier curves over the surface's NURBS form.
//!
//! Source: Balázs, Guthe, Klein 2004, section 4. Three ways, in this order:
//!
//! 1. *The file's curve*, exactly, where the NURBS form has the surface's own parameters and the curve agrees
//!    with the edge.
//! 2. *The edge itself*, exactly, on planes.
//! 3. *Fitted.* Elsewhere (no curve in the file, or angles that the NURBS form turns into rational
//!    parameters) the edge is followed on the surface and fitted by cubics within a hundredth of the
//!    tolerance. The chords are proven against the edge's own curve afterwards, so this costs chords at most.

use chordal_nurbs::{BezierCurve, DVec2, NurbsParameters, NurbsSurface, ParameterMap, Range, Surface, UvBox};
use chordal_tessellate::method::{EdgePiece, EdgeUse, Near};

/// The origin of a curve in the plane of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    File,
    Plane,
    Fitted,
}

impl Source {
    /// The name in the trace.
    pub fn name(self) -> &'static str {
        match self {
            Source::File => "trimming curves of the file",
            Source::Plane => "trimming curves in planes",
            Source::Fitted => "trimming curves fitted",
        }
    }
}

/// A trimming curve in Bézier form.
pub struct TrimmingCurve {
    /// The part of the surface around the curve.
    pub surface: NurbsSurface,
    /// Each with the edge's parameters that its ends belong to.
    pub pieces: Vec<(Range, BezierCurve<DVec2>)>,
    pub source: Source,
    /// The NURBS form has the surface's own parameters.
    pub is_native: bool,
}

/// Largest distance of a fitted curve from the followed edge, as a share of the tolerance. A larger share
/// costs chords, a smaller one pieces.
const FIT: f64 = 0.01;

/// Largest distance of the file's curve from the edge, as a share of the tolerance; curves further off are
/// not used.
const AGREES: f64 = 0.25;

/// Points at which an edge is followed to find out where on the surface it lies.
const PROBES: usize = 16;

/// An interval of the fit is halved at most this often.
const HALVINGS: u32 = 10;

/// The box around a curve grows by this share of its own extent on each side.
const MARGIN: f64 = 0.02;

/// Parameters this share of the domain beyond its end are at its end.
const AT_END: f64 = 1e-6;

impl TrimmingCurve {
    /// The curve of a piece of an edge on one of its faces; `None` where the surface has no exact NURBS form
    /// there.
    pub fn new(edge: &EdgePiece<'_>, one: &EdgeUse<'_, '_>) -> Option<Self> {
        Self::from_file(edge, one).or_else(|| Self::in_plane(edge, one)).or_else(|| Self::fitted(edge, one))
    }

    /// NURBS parameters at a parameter of the edge.
    pub fn uv_at(&self, t: f64) -> DVec2 {
        let at = self.pieces.partition_point(|(range, _)| range.end < t).min(self.pieces.len() - 1);
        let (range, piece) = &self.pieces[at];
        piece.eval((t - range.start) / range.length())
    }

    fn from_file(edge: &EdgePiece<'_>, one: &EdgeUse<'_, '_>) -> Option<Self> {
        let pcurve = one.pcurve?;
        let own = |t: f64| {
            pcurve.range.start + (t - edge.whole.start) / edge.whole.length() * pcurve.range.length()
        };
        let range = Range::new(own(edge.range.start), own(edge.range.end));
        let (surface, map) = form_around(one, pcurve.curve.sampled_box(range))?;
        if !is_identity(&map) {
            return None;
        }
        let agrees = (0..=4).all(|k| {
            let t = edge.range.start + edge.range.length() * f64::from(k) / 4.0;
            let uv = pcurve.curve.point(own(t));
            one.surface.point(uv).distance(edge.curve.point(t)) <= AGREES * edge.tolerance
        });
        if !agrees {
            return None;
        }
        let spline = pcurve.curve.to_nurbs(range).ok()?;
        let back = |s: f64| {
            edge.whole.start + (s - pcurve.range.start) / pcurve.range.length() * edge.whole.length()
        };
        let pieces = spline.bezier_pieces().into_iter();
        let pieces = pieces.map(|(r, piece)| (Range::new(back(r.start), back(r.end)), piece)).collect();
        Some(Self { surface, pieces, source: Source::File, is_native: true })
    }

    fn in_plane(edge: &EdgePiece<'_>, one: &EdgeUse<'_, '_>) -> Option<Self> {
        let Surface::Plane { frame } = one.surface.surface else { return None };
        let spline = edge.curve.to_nurbs(edge.range).ok()?;
        let flat = spline.mapped(|p| frame.local(p).truncate());
        let (surface, _) = form_around(one, UvBox::from_points(flat.points().iter().copied()))?;
        Some(Self { surface, pieces: flat.bezier_pieces(), source: Source::Plane, is_native: true })
    }

    fn fitted(edge: &EdgePiece<'_>, one: &EdgeUse<'_, '_>) -> Option<Self> {
        let mut stops = vec![edge.range.start];
        stops.extend(edge.curve.all_breaks(edge.range));
        stops.push(edge.range.end);
        let mut near = None;
        let mut places = Vec::with_capacity(PROBES + 1);
        for k in 0..=PROBES {
            let t = edge.range.start + edge.range.length() * k as f64 / PROBES as f64;
            // Without the file's curve, which is missing or too far off here.
            let place = one.surface.invert_from(edge.curve.point(t), near);
            near = Some(place);
            places.push(place);
        }
        let around = UvBox::from_points(places.iter().map(|p| p.uv));
        let (surface, map) = form_around(one, around)?;
        let follow = Follow { edge, one, surface: &surface, map: &map, places: &places };
        let mut pieces = Vec::new();
        for pair in stops.windows(2) {
            let mut stack = vec![(pair[0], pair[1], 0u32)];
            while let Some((a, b, depth)) = stack.pop() {
                match follow.cubic(a, b) {
                    Some(piece) => pieces.push((Range::new(a, b), piece)),
                    None if depth >= HALVINGS => return None,
                    None => {
                        let middle = 0.5 * (a + b);
                        stack.extend([(middle, b, depth + 1), (a, middle, depth + 1)]);
                    }
                }
            }
        }
        let is_native = is_identity(&map);
        Some(Self { surface, pieces, source: Source::Fitted, is_native })
    }
}

fn is_identity(map: &NurbsParameters) -> bool {
    map.u == ParameterMap::Identity && map.v == ParameterMap::Identity
}

/// An edge that is followed on a surface.
struct Follow<'f, 'e, 'a, 's> {
    edge: &'f EdgePiece<'e>,
    one: &'f EdgeUse<'a, 's>,
    surface: &'f NurbsSurface,
    map: &'f NurbsParameters,
    /// Where the probes lie.
    places: &'f [Near],
}

impl Follow<'_, '_, '_, '_> {
    /// NURBS parameters of the edge's point at `t`.
    fn uv(&self, t: f64) -> DVec2 {
        let share = (t - self.edge.range.start) / self.edge.range.length() * PROBES as f64;
        let near = self.places[(share.round().max(0.0) as usize).min(PROBES)];
        let found = self.one.surface.invert_from(self.edge.curve.point(t), Some(near));
        self.map.nurbs_from_native(self.one.surface.nearest_turn(found.uv, near.uv))
    }

    /// The cubic with the edge's place and direction at both ends, where it keeps to the edge between them.
    fn cubic(&self, a: f64, b: f64) -> Option<BezierCurve<DVec2>> {
        let (p, q) = (self.uv(a), self.uv(b));
        let third = (b - a) / 3.0;
        let (d, e) = (self.direction(a, p), self.direction(b, q));
        let points = vec![p, p + d * third, q - e * third, q];
        let straight = |from: DVec2, to: DVec2| BezierCurve { points: vec![from, to], weights: None };
        let cubic = BezierCurve { points, weights: None };
        // Most edges are lines, and a direction may be undefined at a pole.
        [straight(p, q), cubic].into_iter().find(|curve| {
            curve.points.iter().all(|p| p.is_finite())
                && [0.25, 0.5, 0.75].iter().all(|&s| self.keeps_to(curve.eval(s), a + s * (b - a)))
        })
    }

    /// The point at `uv` lies on the edge near parameter `t`, as far as the edge itself lies on the surface.
    fn keeps_to(&self, uv: DVec2, t: f64) -> bool {
        let there = self.surface.point(uv);
        let jet = self.edge.curve.jet(t);
        let allowed = FIT * self.edge.tolerance;
        // A shift along the edge does no harm.
        let off = (there - jet.p).reject_from(jet.d1);
        off.length() <= allowed || there.distance(self.surface.point(self.uv(t))) <= allowed
    }

    /// The direction in the plane that maps to the edge's, by least squares.
    fn direction(&self, t: f64, uv: DVec2) -> DVec2 {
        let (_, du, dv) = self.surface.jet1(uv);
        let step = self.edge.curve.jet(t).d1;
        let (e, f, g) = (du.length_squared(), du.dot(dv), dv.length_squared());
        let (x, y) = (du.dot(step), dv.dot(step));
        DVec2::new(x * g - y * f, y * e - x * f) / (e * g - f * f)
    }
}

/// The exact NURBS form of the surface around a box of its parameters.
fn form_around(one: &EdgeUse<'_, '_>, within: UvBox) -> Option<(NurbsSurface, NurbsParameters)> {
    if !within.is_finite() {
        return None;
    }
    let surface = one.surface.surface;
    if let Surface::Nurbs(spline) = surface {
        let domain = spline.domain();
        let slack = domain.size() * AT_END;
        let inside = within.min.cmpge(domain.min - slack).all() && within.max.cmple(domain.max + slack).all();
        let same = NurbsParameters { u: ParameterMap::Identity, v: ParameterMap::Identity };
        return inside.then(|| (spline.clone(), same));
    }
    // A line of constant parameter has no extent across.
    let extent = within.size().max_element().max(f64::MIN_POSITIVE);
    let mut around = within.inflated((within.size() * MARGIN).max(DVec2::splat(MARGIN * extent)));
    let domain = surface.domain();
    for axis in 0..2 {
        if one.surface.periods[axis].is_none() {
            around.min[axis] = around.min[axis].max(domain.min[axis]);
            around.max[axis] = around.max[axis].min(domain.max[axis]);
        }
    }
    Some((surface.to_nurbs(around).ok()?, surface.nurbs_parameters(around).ok()?))
}
