//! An upper bound of the distance of a surface from linear over a piece of its parameters: from its largest
//! second derivatives, by closed forms and by differences of control points.
//!
//! Over a triangle of parameters with extents R the distance between the surface and the linear interpolation
//! of its corners is at most
//!
//! ```text
//!   ⅛ (|S_uu| R_u² + 2 |S_uv| R_u R_v + |S_vv| R_v²) + ¼ (J_u R_u + J_v R_v)
//! ```
//!
//! with the largest norms over its box (Filip, Magedson, Markot 1986) and J the largest jumps of the first
//! derivatives at knots inside. This shares no code with the bounds of `nurbs`, whose enclosures are tighter:
//! it is to check them.

use chordal_nurbs::{Curve, DVec2, DVec3, NurbsCurve3, NurbsSurface, Surface, UvBox, math};

/// The largest norms of second derivatives, and jumps of first ones, over a box of parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bend {
    pub uu: f64,
    pub uv: f64,
    pub vv: f64,
    pub jumps: DVec2,
    /// Over a smaller box it is smaller: here several spans share it.
    pub is_coarse: bool,
}

impl Bend {
    /// The largest distance from linear over a triangle with these extents.
    pub fn over(&self, extent: DVec2) -> f64 {
        let smooth = self.uu * extent.x * extent.x
            + 2.0 * self.uv * extent.x * extent.y
            + self.vv * extent.y * extent.y;
        smooth / 8.0 + 0.25 * self.jumps.dot(extent)
    }

    /// The bound for a surface within a box of its parameters; `None` if there is no simple bound.
    pub fn of(surface: &Surface, within: UvBox) -> Option<Self> {
        let bend = |uu: f64, uv: f64, vv: f64| Some(Self { uu, uv, vv, ..Self::default() });
        match surface {
            Surface::Plane { .. } => bend(0.0, 0.0, 0.0),
            Surface::Cylinder { radius, .. } => bend(radius.abs(), 0.0, 0.0),
            Surface::Cone { radius, half_angle, .. } => {
                let slope = math::tan(*half_angle);
                let at = |v: f64| (radius + v * slope).abs();
                bend(at(within.min.y).max(at(within.max.y)), slope.abs(), 0.0)
            }
            Surface::Sphere { radius, .. } => {
                let r = radius.abs();
                bend(r * largest_cosine(within), r, r)
            }
            Surface::Torus { major, minor, .. } => {
                let minor = minor.abs();
                bend(major.abs() + minor, minor, minor)
            }
            Surface::Extrusion { profile, .. } => {
                let profile = of_curve(profile, within.min.x, within.max.x)?;
                Some(Self { uu: profile.second, jumps: DVec2::new(profile.jump, 0.0), ..Self::default() })
            }
            Surface::Revolution { profile, axis_origin, axis } => {
                let from_axis = |p: DVec3| (p - axis_origin).reject_from_normalized(*axis).length();
                let radius = from_axis(profile.point(within.min.y));
                let profile = of_curve(profile, within.min.y, within.max.y)?;
                // The profile leaves its start no faster than its first derivative says.
                let radius = radius + profile.first * (within.max.y - within.min.y);
                let jumps = DVec2::new(0.0, profile.jump);
                Some(Self { uu: radius, uv: profile.first, vv: profile.second, jumps, is_coarse: false })
            }
            Surface::Nurbs(nurbs) => Some(Net::of_surface(nurbs, within)?.derivatives().bend),
            _ => None,
        }
    }
}

/// The largest cosine of v on a sphere.
fn largest_cosine(within: UvBox) -> f64 {
    if within.min.y <= 0.0 && within.max.y >= 0.0 {
        return 1.0;
    }
    math::cos(within.min.y).abs().max(math::cos(within.max.y).abs())
}

/// The largest norms of a curve's derivatives, and the largest jump of the first one.
struct CurveBend {
    first: f64,
    second: f64,
    jump: f64,
}

fn of_curve(curve: &Curve, from: f64, to: f64) -> Option<CurveBend> {
    let smooth = |first: f64, second: f64| Some(CurveBend { first, second, jump: 0.0 });
    match curve {
        Curve::Line { direction, .. } => smooth(direction.length(), 0.0),
        Curve::Circle { radius, .. } => smooth(radius.abs(), radius.abs()),
        Curve::Ellipse { a, b, .. } => smooth(a.abs().max(b.abs()), a.abs().max(b.abs())),
        Curve::Nurbs(nurbs) => {
            let found = Net::of_curve(nurbs, from, to)?.derivatives();
            Some(CurveBend { first: found.first.x, second: found.bend.uu, jump: found.bend.jumps.x })
        }
        _ => None,
    }
}

/// A control point times its weight, and the weight.
#[derive(Clone, Copy, Default)]
struct Weighted {
    point: DVec3,
    weight: f64,
}

/// Control points or their differences; v runs fastest.
struct Grid {
    count: [usize; 2],
    items: Vec<Weighted>,
}

impl Grid {
    /// The largest norms of points and weights.
    fn largest(&self) -> Weighted {
        self.items.iter().fold(Weighted::default(), |m, item| Weighted {
            point: DVec3::X * m.point.x.max(item.point.length()),
            weight: m.weight.max(item.weight.abs()),
        })
    }

    fn at(&self, i: usize, j: usize) -> Weighted {
        self.items[i * self.count[1] + j]
    }
}

/// The control points that a B-spline depends on within a box.
struct Net<'a> {
    degree: [usize; 2],
    knots: [&'a [f64]; 2],
    /// The index of the first control point of the grid.
    first: [usize; 2],
    grid: Grid,
    least_weight: f64,
    /// The largest distance of a control point from the first one.
    reach: f64,
}

/// The largest norms of first derivatives, and what [`Bend`] says.
struct Derivatives {
    first: DVec2,
    bend: Bend,
}

impl<'a> Net<'a> {
    fn of_surface(nurbs: &'a NurbsSurface, within: UvBox) -> Option<Self> {
        let knots = [nurbs.knots_u(), nurbs.knots_v()];
        let of_v = nurbs.counts()[1];
        let at = |i: usize, j: usize| {
            let index = i * of_v + j;
            (nurbs.points()[index], nurbs.weights().map_or(1.0, |w| w[index]))
        };
        Self::new(nurbs.degree(), knots, [(within.min.x, within.max.x), (within.min.y, within.max.y)], at)
    }

    /// A curve is a surface that is constant along v.
    fn of_curve(nurbs: &'a NurbsCurve3, from: f64, to: f64) -> Option<Self> {
        let at = |i: usize, _| (nurbs.points()[i], nurbs.weights().map_or(1.0, |w| w[i]));
        Self::new([nurbs.degree(), 0], [nurbs.knots(), &[0.0, 1.0]], [(from, to), (0.0, 1.0)], at)
    }

    /// `None` where a knot inside tears the surface apart.
    fn new(
        degree: [usize; 2],
        knots: [&'a [f64]; 2],
        within: [(f64, f64); 2],
        at: impl Fn(usize, usize) -> (DVec3, f64),
    ) -> Option<Self> {
        let mut first = [0; 2];
        let mut count = [0; 2];
        for axis in 0..2 {
            let [from, to] = spans(degree[axis], knots[axis], within[axis]);
            first[axis] = from - degree[axis];
            count[axis] = to - first[axis] + 1;
            let inner = &knots[axis][from + 1..=to];
            if inner.chunk_by(|a, b| a == b).any(|run| run.len() > degree[axis]) {
                return None;
            }
        }
        let (origin, _) = at(first[0], first[1]);
        let mut net = Self {
            degree,
            knots,
            first,
            grid: Grid { count, items: Vec::with_capacity(count[0] * count[1]) },
            least_weight: f64::INFINITY,
            reach: 0.0,
        };
        for i in 0..count[0] {
            for j in 0..count[1] {
                let (point, weight) = at(first[0] + i, first[1] + j);
                let point = point - origin;
                net.least_weight = net.least_weight.min(weight);
                net.reach = net.reach.max(point.length());
                net.grid.items.push(Weighted { point: point * weight, weight });
            }
        }
        (net.least_weight > 0.0).then_some(net)
    }

    /// The control points of the derivative along an axis, of a grid that was derived `order` times along it.
    fn derived(&self, grid: &Grid, axis: usize, order: usize) -> Grid {
        let mut count = grid.count;
        let degree = self.degree[axis];
        if order >= degree || count[axis] < 2 {
            return Grid { count: [0, 0], items: Vec::new() };
        }
        count[axis] -= 1;
        let mut items = Vec::with_capacity(count[0] * count[1]);
        for i in 0..count[0] {
            for j in 0..count[1] {
                let step = [1 - axis, axis];
                let (a, b) = (grid.at(i, j), grid.at(i + step[0], j + step[1]));
                let index = self.first[axis] + [i, j][axis];
                let knots = self.knots[axis];
                // Over a gap of zero there is no span that depends on the difference.
                let gap = knots[index + degree + 1] - knots[index + order + 1];
                let share = if gap > 0.0 { (degree - order) as f64 / gap } else { 0.0 };
                let (point, weight) = ((b.point - a.point) * share, (b.weight - a.weight) * share);
                items.push(Weighted { point, weight });
            }
        }
        Grid { count, items }
    }

    /// The bounds by the quotient rule: S = A / w, with A measured from a control point.
    fn derivatives(&self) -> Derivatives {
        let [by_u, by_v] = [0, 1].map(|axis| self.derived(&self.grid, axis, 0));
        let by_uv = self.derived(&by_u, 1, 0).largest();
        let [by_uu, by_vv] =
            [(&by_u, 0), (&by_v, 1)].map(|(grid, axis)| self.derived(grid, axis, 1).largest());
        let [u, v] = [&by_u, &by_v].map(Grid::largest);
        let (w, reach) = (self.least_weight, self.reach);
        let first = |d: Weighted| (d.point.x + d.weight * reach) / w;
        let (s_u, s_v) = (first(u), first(v));
        let twice =
            |d: Weighted, of: Weighted, s: f64| (d.point.x + 2.0 * of.weight * s + d.weight * reach) / w;
        let jumps = DVec2::new(first(self.jump(&by_u, 0)), first(self.jump(&by_v, 1)));
        let is_coarse = (0..2).any(|axis| self.grid.count[axis] > self.degree[axis] + 1);
        let uv = (by_uv.point.x + u.weight * s_v + v.weight * s_u + by_uv.weight * reach) / w;
        let bend = Bend { uu: twice(by_uu, u, s_u), uv, vv: twice(by_vv, v, s_v), jumps, is_coarse };
        Derivatives { first: DVec2::new(s_u, s_v), bend }
    }

    /// The largest jump of a first derivative along its axis, at knots as many as the degree.
    fn jump(&self, derived: &Grid, axis: usize) -> Weighted {
        let (degree, first) = (self.degree[axis], self.first[axis]);
        let count = derived.count;
        let knots = &self.knots[axis][first + degree + 1..first + degree + self.grid.count[axis] - degree];
        let mut largest = Weighted::default();
        let mut start = 0;
        for run in knots.chunk_by(|a, b| a == b) {
            // Control point `start + degree` of the grid is on the surface at this knot.
            let after = start + degree;
            if run.len() == degree && after < count[axis] {
                for other in 0..count[1 - axis] {
                    let at = |i: usize| if axis == 0 { derived.at(i, other) } else { derived.at(other, i) };
                    let (a, b) = (at(after - 1), at(after));
                    largest.point.x = largest.point.x.max(a.point.distance(b.point));
                    largest.weight = largest.weight.max((a.weight - b.weight).abs());
                }
            }
            start += run.len();
        }
        largest
    }
}

/// The first and the last of the spans that meet an interval.
fn spans(degree: usize, knots: &[f64], (from, to): (f64, f64)) -> [usize; 2] {
    let last = knots.len() - degree - 1;
    let inner = &knots[degree + 1..last];
    let end = degree + inner.partition_point(|&k| k < to);
    [(degree + inner.partition_point(|&k| k <= from)).min(end), end]
}
