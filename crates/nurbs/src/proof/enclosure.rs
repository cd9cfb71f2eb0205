//! Enclosures of second derivatives over boxes of parameter space: what every proof of a facet rests on.
//!
//! A box is covered by *pieces*, one for each smooth cell of the surface that it meets. A piece holds the
//! second derivatives at its middle and enclosures of the third derivatives, so the enclosure narrows to the
//! truth as boxes shrink. Cells of a NURBS surface are its Bézier patches (rational ones subdivided), in
//! homogeneous coordinates.

use crate::{Range, Surface, SurfaceJet, UvBox};
use glam::{DVec2, DVec3, DVec4};

mod cells;
mod net;
mod swept;

use cells::CellTable;
use swept::{ProfileTable, Thirds};

/// Homogeneous vectors near `center`: the spatial part within `radius`, the weight within `weight_radius`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Ball4 {
    /// The middle of the ball: spatial part and weight.
    pub center: DVec4,
    /// The radius of the spatial part.
    pub radius: f64,
    /// The largest difference of the weight.
    pub weight_radius: f64,
}

impl Ball4 {
    /// Vectors without a weight.
    fn around(center: DVec3, radius: f64) -> Self {
        Self { center: center.extend(0.0), radius, weight_radius: 0.0 }
    }
}

/// A smooth cell of a surface: derivatives of its homogeneous form (A, w), measured from `origin`,
/// S = origin + A/w.
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
            center: b.center(),
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
    /// The middle of the piece; not finite where the piece stands for several places of a closed surface.
    pub(crate) center: DVec2,
    /// Half the extent in u and v.
    pub(crate) half: DVec2,
    /// How far the middle may lie from where `second` was known, which adds to its uncertainty.
    pub(crate) offset: DVec2,
    /// A lower bound of the weight.
    pub least_weight: f64,
    /// Upper bounds of the weight's rates of change.
    pub weight_rate: DVec2,
    /// Upper bounds of |Suu|, |Suv|, |Svv|.
    pub norms: [f64; 3],
}

impl Piece {
    /// The derivatives of w·(A − (anchor − origin) w).
    pub fn along(&self, w: DVec3, anchor: DVec3) -> Component {
        self.along_homogeneous(w.extend(-w.dot(anchor - self.origin)))
    }

    /// The same for the weight itself.
    pub fn weight(&self) -> Component {
        self.along_homogeneous(DVec4::W)
    }

    /// How far second derivatives stray from those in the middle over the piece.
    pub fn reach(&self, along: &Component) -> [f64; 3] {
        let (h, far) = (self.half, self.half + self.offset);
        let Component { third, stray, .. } = along;
        std::array::from_fn(|i| {
            third[i].abs() * h.x + third[i + 1].abs() * h.y + stray[i] * far.x + stray[i + 1] * far.y
        })
    }

    fn along_homogeneous(&self, w: DVec4) -> Component {
        let length = w.truncate().length();
        Component {
            second: self.second.map(|s| s.dot(w)),
            third: self.third.map(|ball| ball.center.dot(w)),
            stray: self.third.map(|ball| ball.radius * length + ball.weight_radius * w.w.abs()),
        }
    }
}

/// Second derivatives of one coordinate over a piece.
#[derive(Clone, Copy, Debug)]
pub struct Component {
    /// uu, uv, vv in the middle.
    pub second: [f64; 3],
    /// uuu, uuv, uvv, vvv somewhere in the piece's cell.
    pub third: [f64; 4],
    /// How far the third derivatives stray from these.
    pub stray: [f64; 4],
}

#[derive(Clone, Debug)]
enum Prepared {
    /// Higher derivatives by formula.
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
    /// Prepares bounds for boxes inside `domain`, which may reach over the seam of a closed surface. Effort
    /// is spent so that they are tight for facets whose error is about `resolution`.
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

    /// The surface that the bounds are of.
    pub fn surface(&self) -> &'a Surface {
        self.surface
    }

    /// The box of parameters that was given to [`SurfaceBounds::new`].
    pub fn domain(&self) -> UvBox {
        self.domain
    }

    /// The surface at a point of the chart.
    pub fn point(&self, p_uv: DVec2) -> DVec3 {
        self.wrap.point(self.surface, p_uv)
    }

    /// The surface at a point of the chart and its weight there, to rounding.
    pub(crate) fn weighted_point(&self, p_uv: DVec2) -> (DVec3, f64) {
        match &self.prepared {
            Prepared::Cells(table) => table.point(self.wrap.apply(p_uv)),
            _ => (self.point(p_uv), 1.0),
        }
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

    /// Appends the pieces that cover `uv_box`; returns the jumps of Su and Sv inside it. No piece: nothing is
    /// known.
    pub fn pieces(&self, uv_box: UvBox, out: &mut Vec<Piece>) -> DVec2 {
        let mut jump = DVec2::ZERO;
        let (us, u_count) = wrap_range(uv_box.u(), self.wrap.0[0]);
        let (vs, v_count) = wrap_range(uv_box.v(), self.wrap.0[1]);
        for &(u, u_shift) in &us[..u_count] {
            for &(v, v_shift) in &vs[..v_count] {
                let from = out.len();
                jump = jump.max(self.pieces_inside(UvBox::from_ranges(u, v), out));
                let shift = DVec2::new(u_shift, v_shift);
                out[from..].iter_mut().for_each(|piece| piece.center += shift);
            }
        }
        jump
    }

    fn pieces_inside(&self, b: UvBox, out: &mut Vec<Piece>) -> DVec2 {
        match &self.prepared {
            Prepared::Unknown => DVec2::ZERO,
            Prepared::Elementary => {
                self.push(b, out, |jet, half| swept::elementary_thirds(self.surface, b, jet, half));
                DVec2::ZERO
            }
            Prepared::Profile(table) => table.pieces(self, b, out),
            Prepared::Cells(table) => table.pieces(b, out),
        }
    }

    /// A piece of a surface that is known by its derivatives in the middle and bounds of the fourth.
    fn push(&self, b: UvBox, out: &mut Vec<Piece>, thirds: impl FnOnce(&SurfaceJet, DVec2) -> Thirds) {
        let jet = self.surface.jet(b.center());
        let half = b.size() * 0.5;
        let Thirds { center, stray } = thirds(&jet, half);
        let third: [Ball4; 4] = std::array::from_fn(|i| Ball4::around(center[i], stray[i]));
        let norm = |d: DVec3, i: usize| {
            let rate = |ball: &Ball4| ball.center.length() + ball.radius;
            d.length() + rate(&third[i]) * half.x + rate(&third[i + 1]) * half.y
        };
        out.push(Piece {
            origin: DVec3::ZERO,
            second: [jet.duu, jet.duv, jet.dvv].map(|d| d.extend(0.0)),
            center: b.center(),
            half,
            offset: DVec2::ZERO,
            least_weight: 1.0,
            weight_rate: DVec2::ZERO,
            norms: [norm(jet.duu, 0), norm(jet.duv, 1), norm(jet.dvv, 2)],
            third,
        });
    }
}

/// The ranges of a closed surface to which parameters must be brought back, because it does not repeat by
/// itself as angles do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrap([Option<Range>; 2]);

impl Wrap {
    /// The closed directions of a surface.
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

    /// The surface at a point of such a chart. Quicker than asking the surface, which would look for its seam
    /// each time.
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

/// The parts of the base range that a range covers after wrapping: up to two, each with what leads back to
/// where it was.
fn wrap_range(range: Range, base: Option<Range>) -> ([(Range, f64); 2], usize) {
    let Some(base) = base else { return ([(range, 0.0); 2], 1) };
    if range.start >= base.start && range.end <= base.end {
        return ([(range, 0.0); 2], 1);
    }
    if range.length() >= base.length() {
        return ([(base, f64::NAN); 2], 1);
    }
    let start = base.start + (range.start - base.start).rem_euclid(base.length());
    let (end, shift) = (start + range.length(), range.start - start);
    if end <= base.end {
        return ([(Range::new(start, end), shift); 2], 1);
    }
    let before = (Range::new(start, base.end), shift);
    ([before, (Range::new(base.start, base.start + (end - base.end)), shift + base.length())], 2)
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
