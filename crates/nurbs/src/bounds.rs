//! Enclosures of second derivatives over boxes of parameter space: what every proof of a facet rests on.
//!
//! A box is covered by *pieces*, one for each smooth cell of the surface that it meets. A piece holds the second derivatives at
//! its middle and enclosures of the third derivatives, so the enclosure narrows to the truth as boxes shrink.
//! Cells of a NURBS surface are its Bézier patches (rational ones subdivided), in homogeneous coordinates.

use crate::{Curve, Range, Surface, SurfaceJet, UvBox};
use glam::{DVec2, DVec3, DVec4};

mod cells;
mod net;

use cells::CellTable;

/// Homogeneous vectors near `center`: the spatial part within `radius`, the weight within `weight_radius`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ball4 {
    pub center: DVec4,
    pub radius: f64,
    pub weight_radius: f64,
}

impl Ball4 {
    /// All vectors no longer than `radius`, without a weight.
    fn around_zero(radius: f64) -> Self {
        Self { center: DVec4::ZERO, radius, weight_radius: 0.0 }
    }
}

/// A smooth cell of a surface: derivatives of its homogeneous form (A, w), measured from `origin`, S = origin + A/w.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cell {
    origin: DVec3,
    center: DVec2,
    /// uu, uv, vv at the centre.
    second: [DVec4; 3],
    /// Enclosures of uuu, uuv, uvv, vvv over the cell, around their values at the centre.
    third: [Ball4; 4],
    least_weight: f64,
    /// Bounds of |w_u| and |w_v|.
    weight_rate: DVec2,
    /// Bounds of |Suu|, |Suv|, |Svv|.
    norms: [f64; 3],
}

impl Cell {
    fn piece(&self, b: UvBox) -> Piece {
        let step = b.center() - self.center;
        let [uuu, uuv, uvv, vvv] = self.third.map(|ball| ball.center);
        let [uu, uv, vv] = self.second;
        Piece {
            origin: self.origin,
            second: [
                uu + uuu * step.x + uuv * step.y,
                uv + uuv * step.x + uvv * step.y,
                vv + uvv * step.x + vvv * step.y,
            ],
            third: self.third,
            half: b.size() * 0.5,
            offset: step.abs(),
            least_weight: self.least_weight,
            weight_rate: self.weight_rate,
            norms: self.norms,
        }
    }
}

/// Second derivatives of the homogeneous form (A, w) over a part of a smooth cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// A is measured from here.
    origin: DVec3,
    /// uu, uv, vv in the middle of the piece.
    second: [DVec4; 3],
    third: [Ball4; 4],
    /// Half the extent in u and v.
    half: DVec2,
    /// How far the middle may lie from where `second` was known, which adds to its uncertainty.
    offset: DVec2,
    /// A lower bound of the weight.
    pub least_weight: f64,
    /// Upper bounds of the weight's rates of change.
    pub weight_rate: DVec2,
    /// Upper bounds of |Suu|, |Suv|, |Svv|.
    pub norms: [f64; 3],
}

impl Piece {
    /// The second derivatives of w·(A − (anchor − origin) w) in the middle, and how far they stray from that over the piece.
    pub fn along(&self, w: DVec3, anchor: DVec3) -> ([f64; 3], [f64; 3]) {
        self.along_homogeneous(w.extend(-w.dot(anchor - self.origin)))
    }

    /// The same for the weight itself.
    pub fn weight(&self) -> ([f64; 3], [f64; 3]) {
        self.along_homogeneous(DVec4::W)
    }

    fn along_homogeneous(&self, w: DVec4) -> ([f64; 3], [f64; 3]) {
        let length = w.truncate().length();
        let at_center = self.third.map(|ball| ball.center.dot(w).abs());
        let stray = self.third.map(|ball| ball.radius * length + ball.weight_radius * w.w.abs());
        let (h, far) = (self.half, self.half + self.offset);
        let reach =
            |i: usize| at_center[i] * h.x + at_center[i + 1] * h.y + stray[i] * far.x + stray[i + 1] * far.y;
        (self.second.map(|s| s.dot(w)), [reach(0), reach(1), reach(2)])
    }
}

/// Bounds of the first three derivatives of a profile curve over intervals of its parameter.
#[derive(Clone, Debug)]
struct ProfileTable {
    /// Interval i runs from `breaks[i]` to `breaks[i + 1]`; the curve is smooth in it.
    breaks: Vec<f64>,
    /// Norms of the first, second and third derivative per interval.
    norms: Vec<[f64; 3]>,
    /// At `breaks[i]`, the jump of the first derivative.
    jumps: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Prepared {
    /// Third derivatives by formula.
    Elementary,
    Profile(ProfileTable),
    Cells(CellTable),
    /// Nothing can be proven about this kind.
    Unknown,
}

/// A surface prepared for quick bounds over many boxes.
#[derive(Clone, Debug)]
pub struct SurfaceBounds<'a> {
    surface: &'a Surface,
    domain: UvBox,
    wrap: Wrap,
    prepared: Prepared,
}

impl<'a> SurfaceBounds<'a> {
    /// Prepares bounds for boxes inside `domain`, which may reach over the seam of a closed surface. Effort is spent so that
    /// they are tight for facets whose error is about `resolution`.
    pub fn new(surface: &'a Surface, domain: UvBox, resolution: f64) -> Self {
        let wrap = Wrap::of(surface);
        let inside = |range: Range, wrap: Option<Range>| match wrap {
            Some(base) if range.start < base.start || range.end > base.end => base,
            _ => range,
        };
        let base = UvBox::from_ranges(inside(domain.u(), wrap.0[0]), inside(domain.v(), wrap.0[1]));
        let prepared = match surface {
            Surface::Extrusion { profile, .. } => Prepared::Profile(ProfileTable::new(profile, base.u())),
            Surface::Revolution { profile, .. } => Prepared::Profile(ProfileTable::new(profile, base.v())),
            Surface::Nurbs(nurbs) => {
                CellTable::new(nurbs, base, resolution).map_or(Prepared::Unknown, Prepared::Cells)
            }
            Surface::Offset { .. } => Prepared::Unknown,
            _ => Prepared::Elementary,
        };
        Self { surface, domain, wrap, prepared }
    }

    pub fn surface(&self) -> &'a Surface {
        self.surface
    }

    pub fn domain(&self) -> UvBox {
        self.domain
    }

    /// The surface at a point of the chart.
    pub fn point(&self, p_uv: DVec2) -> DVec3 {
        self.wrap.point(self.surface, p_uv)
    }

    /// The unit normal of the surface, at any turn of a closed one; `None` where it has none.
    pub fn normal(&self, p_uv: DVec2) -> Option<DVec3> {
        self.surface.normal(self.wrap.apply(p_uv))
    }

    /// False where nothing can be proven: weights that are not positive, offsets of free surfaces.
    pub fn is_bounded(&self) -> bool {
        !matches!(self.prepared, Prepared::Unknown)
    }

    /// Parameters inside the box at which the first derivative jumps: (in u, in v).
    pub fn creases(&self) -> (Vec<f64>, Vec<f64>) {
        let pick = |breaks: &[f64], jumps: &[f64]| {
            (1..breaks.len().saturating_sub(1))
                .filter(|&i| jumps[i] > 0.0)
                .map(|i| breaks[i])
                .collect::<Vec<_>>()
        };
        match (&self.prepared, self.surface) {
            (Prepared::Profile(t), Surface::Extrusion { .. }) => (pick(&t.breaks, &t.jumps), Vec::new()),
            (Prepared::Profile(t), _) => (Vec::new(), pick(&t.breaks, &t.jumps)),
            (Prepared::Cells(t), _) => (pick(&t.spans_u, &t.jumps_u), pick(&t.spans_v, &t.jumps_v)),
            _ => (Vec::new(), Vec::new()),
        }
    }

    /// Appends the pieces that cover `uv_box`; returns the jumps of Su and Sv inside it. No piece: nothing is known.
    pub fn pieces(&self, uv_box: UvBox, out: &mut Vec<Piece>) -> DVec2 {
        let mut jump = DVec2::ZERO;
        let (us, u_count) = wrap_range(uv_box.u(), self.wrap.0[0]);
        let (vs, v_count) = wrap_range(uv_box.v(), self.wrap.0[1]);
        for &u in &us[..u_count] {
            for &v in &vs[..v_count] {
                jump = jump.max(self.pieces_inside(UvBox::from_ranges(u, v), out));
            }
        }
        jump
    }

    fn pieces_inside(&self, b: UvBox, out: &mut Vec<Piece>) -> DVec2 {
        match &self.prepared {
            Prepared::Unknown => DVec2::ZERO,
            Prepared::Elementary => {
                self.push(b, self.elementary_third(b), out);
                DVec2::ZERO
            }
            Prepared::Profile(table) => self.profile_pieces(table, b, out),
            Prepared::Cells(table) => table.pieces(b, out),
        }
    }

    /// A piece of a surface that is known by its second derivatives in the middle and bounds of the third.
    fn push(&self, b: UvBox, third: [f64; 4], out: &mut Vec<Piece>) {
        let jet = self.surface.jet(b.center());
        let half = b.size() * 0.5;
        let norm = |d: DVec3, i: usize| d.length() + third[i] * half.x + third[i + 1] * half.y;
        out.push(Piece {
            origin: DVec3::ZERO,
            second: [jet.duu, jet.duv, jet.dvv].map(|d| d.extend(0.0)),
            third: third.map(Ball4::around_zero),
            half,
            offset: DVec2::ZERO,
            least_weight: 1.0,
            weight_rate: DVec2::ZERO,
            norms: [norm(jet.duu, 0), norm(jet.duv, 1), norm(jet.dvv, 2)],
        });
    }

    /// Third derivatives of surfaces that are trigonometric in u (and v).
    fn elementary_third(&self, b: UvBox) -> [f64; 4] {
        match self.surface {
            Surface::Cylinder { radius, .. } => [*radius, 0.0, 0.0, 0.0],
            Surface::Cone { radius, half_angle, .. } => {
                let t = half_angle.tan();
                let r = (radius + b.min.y * t).abs().max((radius + b.max.y * t).abs());
                [r, t.abs(), 0.0, 0.0]
            }
            Surface::Sphere { radius, .. } => [*radius; 4],
            Surface::Torus { major, minor, .. } => [major + minor, *minor, *minor, *minor],
            _ => [0.0; 4],
        }
    }

    fn profile_pieces(&self, table: &ProfileTable, b: UvBox, out: &mut Vec<Piece>) -> DVec2 {
        let extrusion = matches!(self.surface, Surface::Extrusion { .. });
        let along = if extrusion { b.u() } else { b.v() };
        let (from, to) = overlapped(&table.breaks, along);
        let mut jump = 0.0f64;
        for i in from..to {
            let range = Range::new(along.start.max(table.breaks[i]), along.end.min(table.breaks[i + 1]));
            let [first, second, third] = table.norms[i];
            if i > from {
                jump = jump.max(table.jumps[i]);
            }
            if extrusion {
                self.push(UvBox::from_ranges(range, b.v()), [third, 0.0, 0.0, 0.0], out);
            } else {
                let piece = UvBox::from_ranges(b.u(), range);
                let radius = self.largest_radius(piece, first);
                self.push(piece, [radius, first, second, third], out);
            }
        }
        if extrusion { DVec2::new(jump, 0.0) } else { DVec2::new(0.0, jump) }
    }

    /// The largest distance from the axis of a revolution over a box, from its middle and the profile's speed.
    fn largest_radius(&self, b: UvBox, speed: f64) -> f64 {
        let Surface::Revolution { axis_origin, axis, .. } = self.surface else { return 0.0 };
        let d = self.surface.point(b.center()) - *axis_origin;
        let axis = axis.normalize_or_zero();
        (d - axis * d.dot(axis)).length() + speed * 0.5 * b.size().y
    }
}

/// The ranges of a closed surface to which parameters must be brought back, because it does not repeat by itself as angles do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrap([Option<Range>; 2]);

impl Wrap {
    pub fn of(surface: &Surface) -> Self {
        let [period_u, period_v] = surface.periods();
        let domain = surface.domain();
        let closed = |period: Option<f64>, range: Range| period.filter(|_| range.is_finite()).map(|_| range);
        Self(match surface {
            Surface::Extrusion { .. } => [closed(period_u, domain.u()), None],
            Surface::Revolution { .. } => [None, closed(period_v, domain.v())],
            Surface::Nurbs(_) | Surface::Offset { .. } => {
                [closed(period_u, domain.u()), closed(period_v, domain.v())]
            }
            _ => [None, None],
        })
    }

    /// The surface at a point of such a chart. Quicker than asking the surface, which would look for its seam each time.
    pub fn point(&self, surface: &Surface, p_uv: DVec2) -> DVec3 {
        match surface {
            Surface::Nurbs(nurbs) => nurbs.point(self.apply(p_uv)),
            _ => surface.point(self.apply(p_uv)),
        }
    }

    /// As [`Wrap::point`], with derivatives.
    pub fn jet(&self, surface: &Surface, p_uv: DVec2) -> SurfaceJet {
        match surface {
            Surface::Nurbs(nurbs) => nurbs.jet(self.apply(p_uv)),
            _ => surface.jet(self.apply(p_uv)),
        }
    }

    /// Brings a point of a chart that runs over the seam back to the surface's own domain.
    pub fn apply(&self, p_uv: DVec2) -> DVec2 {
        DVec2::new(wrap_into(p_uv.x, self.0[0]), wrap_into(p_uv.y, self.0[1]))
    }
}

fn wrap_into(t: f64, base: Option<Range>) -> f64 {
    match base {
        Some(base) if !base.contains(t) => {
            let wrapped = base.start + (t - base.start).rem_euclid(base.length());
            base.clamp(wrapped)
        }
        _ => t,
    }
}

/// The parts of the base range that a range covers after wrapping: up to three (all of it, or two ends).
fn wrap_range(range: Range, base: Option<Range>) -> ([Range; 2], usize) {
    let Some(base) = base else { return ([range; 2], 1) };
    if range.start >= base.start && range.end <= base.end {
        return ([range; 2], 1);
    }
    if range.length() >= base.length() {
        return ([base; 2], 1);
    }
    let start = base.start + (range.start - base.start).rem_euclid(base.length());
    let end = start + range.length();
    if end <= base.end {
        return ([Range::new(start, end); 2], 1);
    }
    ([Range::new(start, base.end), Range::new(base.start, base.start + (end - base.end))], 2)
}

/// Indices of the intervals between `breaks` that a range meets in more than a point; at least one.
fn overlapped(breaks: &[f64], range: Range) -> (usize, usize) {
    let last = breaks.len() - 1;
    // Ends that were computed land on a knot only nearly; a strip this thin cannot change a bound.
    let slack = 1e-7 * range.length();
    let from = breaks[1..last].partition_point(|&b| b <= range.start + slack);
    let to = breaks[1..last].partition_point(|&b| b < range.end - slack);
    (from, to.max(from) + 1)
}

/// Splits each interval into `parts`.
fn subdivided(breaks: &[f64], parts: usize) -> Vec<f64> {
    let mut fine = Vec::with_capacity((breaks.len() - 1) * parts + 1);
    for pair in breaks.windows(2) {
        fine.extend((0..parts).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64));
    }
    fine.extend(breaks.last());
    fine
}

impl ProfileTable {
    /// Bounds over quarters of every smooth piece keep the enclosures tight without a search per facet.
    const PARTS: usize = 4;

    fn new(profile: &Curve, range: Range) -> Self {
        let mut coarse = vec![range.start];
        coarse.extend(profile.all_breaks(range));
        coarse.push(range.end);
        let breaks = subdivided(&coarse, Self::PARTS);
        let norms = breaks
            .windows(2)
            .map(|p| [1, 2, 3].map(|order| profile.derivative_bound(order, Range::new(p[0], p[1]))))
            .collect();
        let jumps = breaks.iter().enumerate().map(|(i, &t)| {
            if i == 0 || i + 1 == breaks.len() || i % Self::PARTS != 0 {
                return 0.0;
            }
            let step = 1e-9 * (breaks[i + 1] - breaks[i - 1]);
            let (before, after) = (profile.jet(t - step), profile.jet(t + step));
            let jump = (after.d1 - before.d1).length();
            let smooth = 4.0 * step * (after.d2.length() + before.d2.length()) + 1e-9 * after.d1.length();
            if jump > smooth { jump } else { 0.0 }
        });
        let jumps = jumps.collect();
        Self { breaks, norms, jumps }
    }
}
