//! Triangles with a corner at a pole, proven over sectors that fit each other.
//!
//! A chart gives a pole many points, each of which a few neighbours fan from; between the fans of p_k and
//! p_k+1 a sliver of surface is left that has no triangle over it, only an edge. Seen along parameter lines
//! there are no slivers:
//!
//! ```text
//!   q_x ═══ pole ═══ q_y        one vertex P
//!    │               │
//!    │    sector     │          the surface over the facet X Y P
//!    │               │
//!    x ───────────── y
//! ```
//!
//! The sectors between lines of one parameter cover what the fans and slivers cover, and neighbours share
//! their sides. Over a sector n·(S − X) is bounded for the facet's normal n (second derivatives, with lattice
//! points in between), and the images of the three sides may bend sideways by τ, which costs the slope of S
//! against the facet times τ. A side that is a chord of a model edge ends the face: the lens between the
//! image of its line and the edge is as near to the chord as the two are.
//!
//! Not proven: that slope is sampled, because second derivatives say little of it at a pole; 1.5 times what
//! was seen is used.

use chordal_nurbs::{Component, DVec2, DVec3, Piece, SurfaceBounds, UvBox, math};

/// One side of a triangle, as the prover sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Side {
    /// Another triangle of the face goes on there.
    #[default]
    Inner,
    /// A chord of a model edge, which lies this near to its curve.
    Chord(f64),
}

impl Side {
    pub fn sag(self) -> Option<f64> {
        match self {
            Side::Chord(sag) => Some(sag),
            _ => None,
        }
    }
}

/// A triangle x, y, p with p on a pole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fan {
    pub uv: [DVec2; 3],
    pub xyz: [DVec3; 3],
    /// Opposite x, y and p.
    pub sides: [Side; 3],
    /// The parameter that is constant on the pole line.
    pub axis: usize,
}

/// Lattices over which the error is evaluated until it is small enough.
const PARTS: [usize; 4] = [1, 4, 8, 16];

/// The slope is taken for this much more than what samples show.
const SLOPE_MARGIN: f64 = 1.5;

/// Upper bound of the distance between the sector and the facet; a bound below `enough` is as good as any.
pub(crate) fn fan_bound(bounds: &SurfaceBounds<'_>, fan: &Fan, enough: f64, pieces: &mut Vec<Piece>) -> f64 {
    let [x, y, p] = fan.uv;
    let [px, py, pp] = fan.xyz;
    let Some(n) = (py - px).cross(pp - px).try_normalize() else { return f64::INFINITY };
    let beside = |corner: DVec2| {
        let mut q = p;
        q[1 - fan.axis] = corner[1 - fan.axis];
        q
    };
    let (q_x, q_y) = (beside(x), beside(y));
    let slope = SLOPE_MARGIN * slope(bounds, n, [x, y, q_y, q_x]);
    let mut best = f64::INFINITY;
    for parts in PARTS {
        let one = Along { bounds, n, origin: px, parts };
        let along = one.triangle([x, y, q_y], pieces).max(one.triangle([x, q_y, q_x], pieces));
        let mut error = along;
        let edges = [(y, q_y, py, pp), (q_x, x, pp, px), (x, y, px, py)];
        for (&(a, b, pa, pb), side) in edges.iter().zip(fan.sides) {
            let Some(m) = (pb - pa).cross(n).try_normalize() else { continue };
            let shift = Along { bounds, n: m, origin: pa, parts }.segment(a, b, pieces);
            let leaning = if slope < 0.5 { along + 2.0 * slope * shift } else { f64::INFINITY };
            let whole = math::hypot(along, shift);
            error = error.max(match side {
                // What lies in the lens lies over the facet's plane, and on level ground only its height
                // counts.
                Side::Chord(sag) => math::hypot(one.segment(a, b, pieces), shift).min(leaning).max(sag),
                _ => leaning.min(whole),
            });
        }
        best = best.min(error);
        if best <= enough {
            break;
        }
    }
    best
}

/// The largest slope of the surface against the plane with normal `n` seen over a quadrilateral; infinite
/// where it is upright.
fn slope(bounds: &SurfaceBounds<'_>, n: DVec3, quad: [DVec2; 4]) -> f64 {
    const N: u32 = 3;
    let mut cosine = 1.0f64;
    for i in 0..=N {
        for j in 0..=N {
            // Just inside, where normals are defined by derivatives.
            let s = (f64::from(i) / f64::from(N)).clamp(0.01, 0.99);
            let t = (f64::from(j) / f64::from(N)).clamp(0.01, 0.99);
            let uv = quad[0].lerp(quad[1], s).lerp(quad[3].lerp(quad[2], s), t);
            if let Some(normal) = bounds.normal(uv) {
                cosine = cosine.min(normal.dot(n).abs());
            }
        }
    }
    (1.0 / (cosine * cosine) - 1.0).max(0.0).sqrt()
}

/// Bounds of |n·(S − origin)|.
struct Along<'a, 'b> {
    bounds: &'a SurfaceBounds<'b>,
    n: DVec3,
    origin: DVec3,
    parts: usize,
}

impl Along<'_, '_> {
    fn at(&self, uv: DVec2) -> f64 {
        (self.bounds.point(uv) - self.origin).dot(self.n).abs()
    }

    fn triangle(&self, uv: [DVec2; 3], pieces: &mut Vec<Piece>) -> f64 {
        let d = [uv[2] - uv[1], uv[0] - uv[2], uv[1] - uv[0]];
        if d.contains(&DVec2::ZERO) {
            return 0.0;
        }
        let mut seen = 0.0f64;
        for i in 0..=self.parts {
            for j in 0..=self.parts - i {
                let w = [i, j, self.parts - i - j].map(|k| k as f64 / self.parts as f64);
                seen = seen.max(self.at(uv[0] * w[0] + uv[1] * w[1] + uv[2] * w[2]));
            }
        }
        // Σ λ_i λ_j |h_ij| / 2 is at most the largest |h| over 6.
        self.with_between(seen, UvBox::from_points(uv), &d, 1.0 / 6.0, pieces)
    }

    fn segment(&self, a: DVec2, b: DVec2, pieces: &mut Vec<Piece>) -> f64 {
        let at = |i: usize| self.at(a.lerp(b, i as f64 / self.parts as f64));
        let seen = (0..=self.parts).map(at).fold(0.0, f64::max);
        self.with_between(seen, UvBox::from_points([a, b]), &[b - a], 1.0 / 8.0, pieces)
    }

    /// Adds how far n·(S − origin) may stray between points of the lattice: its product with the weight w is
    /// a polynomial g, so it is at most (seen · (w + bend of w) + bend of g) / w.
    fn with_between(
        &self,
        seen: f64,
        uv_box: UvBox,
        d: &[DVec2],
        share: f64,
        pieces: &mut Vec<Piece>,
    ) -> f64 {
        pieces.clear();
        let kink = self.bounds.pieces(uv_box, pieces);
        if pieces.is_empty() {
            return f64::INFINITY;
        }
        let size = uv_box.size();
        let scale = 1.0 / (self.parts * self.parts) as f64;
        let least = pieces.iter().fold(f64::INFINITY, |m, p| m.min(p.least_weight));
        let value =
            bend(enclosures(pieces, |p| p.along(self.n, self.origin)), d, share, size) * scale / least;
        let weight = bend(enclosures(pieces, Piece::weight), d, share, size) * scale / least;
        let kinks = 0.25 * (kink.x * size.x + kink.y * size.y) / self.parts as f64;
        seen * (1.0 + weight) + value + kinks
    }
}

/// Second derivatives in the middle of each piece and how far they stray.
fn enclosures(
    pieces: &[Piece],
    along: impl Fn(&Piece) -> Component,
) -> impl Iterator<Item = ([f64; 3], [f64; 3])> {
    pieces.iter().map(move |piece| {
        let along = along(piece);
        (along.second, piece.reach(&along))
    })
}

/// How far a function with these second derivatives (middle and reach, piece by piece) strays from linear.
fn bend(forms: impl Iterator<Item = ([f64; 3], [f64; 3])>, d: &[DVec2], share: f64, size: DVec2) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (value, reach) in forms {
        for i in 0..3 {
            low[i] = low[i].min(value[i] - reach[i]);
            high[i] = high[i].max(value[i] + reach[i]);
        }
    }
    let m = |i: usize| 0.5 * (low[i] + high[i]);
    let r = |i: usize| 0.5 * (high[i] - low[i]);
    let h = |d: &DVec2| (m(0) * d.x * d.x + 2.0 * m(1) * d.x * d.y + m(2) * d.y * d.y).abs();
    let reach = r(0) * size.x * size.x + 2.0 * r(1) * size.x * size.y + r(2) * size.y * size.y;
    d.iter().map(h).fold(0.0, f64::max) * share + reach / 8.0
}
