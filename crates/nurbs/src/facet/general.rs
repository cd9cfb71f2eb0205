//! Facets of any smooth surface, by enclosures of its second derivatives.
//!
//! Notation: T the triangle in parameter space with corners p_i, L the affine map of T onto the facet, S the surface,
//! n the facet's unit normal, d_ij = p_j − p_i, λ barycentric coordinates, e = S − L (zero at the corners).
//!
//! **Along n.** For a quadratic f = n·S the error of linear interpolation is exactly −½ Σ_{i<j} λ_i λ_j h_ij with
//! h_ij = D²f\[d_ij, d_ij\]. (For rational surfaces f is the polynomial w n·(S − a).) For any other f the second derivatives are split into a middle (treated so) and a
//! deviation r over T (which adds at most ⅛(r_uu R_u² + 2 r_uv R_u R_v + r_vv R_v²), R the extent of T; this follows
//! from Taylor's formula with integral remainder and Σ λ_i (u − u_i)² ≤ R_u²/4). Where that is not enough, e is evaluated
//! on a lattice of k² small triangles and only what lies between its points is bounded so: k² times less.
//!
//! **Sideways.** The image of an edge of T bends sideways by at most τ (the same formula for the in-plane normal m of the
//! edge). A bend along an inner edge only shifts surface from one facet's side to its neighbour's: what it can cost is the slope
//! of S against the facet times the shift; where the slope is large the error is √(N² + τ²). At a boundary edge the face ends
//! at its curve: the lens between it and the image of the chord lies as near to the edge as the farther of the two.

use super::{Facet, FacetBound, lattice};
use crate::{Piece, SurfaceBounds, UvBox};
use glam::{DVec2, DVec3};

/// Second derivatives of g = w·(A − a w) over the pieces: the middle of the enclosure and how far it reaches, for uu, uv, vv.
#[derive(Clone, Copy)]
struct Form {
    middle: [f64; 3],
    reach: [f64; 3],
}

impl Form {
    /// Of w·(S − anchor), times the weight.
    fn new(pieces: &[Piece], w: DVec3, anchor: DVec3) -> Self {
        Self::enclosing(pieces.iter().map(|piece| piece.along(w, anchor)))
    }

    /// Of the weight.
    fn weight(pieces: &[Piece]) -> Self {
        Self::enclosing(pieces.iter().map(Piece::weight))
    }

    fn enclosing(forms: impl Iterator<Item = ([f64; 3], [f64; 3])>) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for (value, reach) in forms {
            for i in 0..3 {
                low[i] = low[i].min(value[i] - reach[i]);
                high[i] = high[i].max(value[i] + reach[i]);
            }
        }
        Self {
            middle: std::array::from_fn(|i| 0.5 * (low[i] + high[i])),
            reach: std::array::from_fn(|i| 0.5 * (high[i] - low[i])),
        }
    }

    fn divided(mut self, by: f64) -> Self {
        for i in 0..3 {
            self.middle[i] /= by;
            self.reach[i] /= by;
        }
        self
    }

    fn middle_along(&self, d: DVec2) -> f64 {
        self.middle[0] * d.x * d.x + 2.0 * self.middle[1] * d.x * d.y + self.middle[2] * d.y * d.y
    }

    fn reach_along(&self, d: DVec2) -> f64 {
        self.reach[0] * d.x * d.x + 2.0 * self.reach[1] * (d.x * d.y).abs() + self.reach[2] * d.y * d.y
    }
}

/// The largest |½ Σ_{i<j} λ_i λ_j h_ij| over the triangle: on an edge, or at the critical point inside.
fn largest_quadratic(h: [f64; 3]) -> f64 {
    // h[i] belongs to the edge opposite corner i.
    let [c, b, a] = h;
    let on_edges = a.abs().max(b.abs()).max(c.abs()) / 8.0;
    let weights = [c * (a + b - c), b * (a + c - b), a * (b + c - a)];
    let inside = weights.iter().all(|&w| w > 0.0) || weights.iter().all(|&w| w < 0.0);
    let sum = weights[0] + weights[1] + weights[2];
    if inside && sum != 0.0 { on_edges.max((a * b * c / (2.0 * sum)).abs()) } else { on_edges }
}

/// The finest lattice on which the error is evaluated.
const MAX_PARTS: usize = 16;

/// What all stages of one bound share.
struct Frame3 {
    n: DVec3,
    /// In-plane normals of the edges, pointing outwards.
    m: [DVec3; 3],
    d: [DVec2; 3],
    length: [f64; 3],
    height: [f64; 3],
    area2: f64,
    size: DVec2,
    /// What jumps of the first derivative cost, at most.
    kinks: f64,
    kink: DVec2,
}

/// Bounds along the normal and sideways, of the facet and its edges.
struct Parts {
    along: f64,
    along_edges: [f64; 3],
    /// How far the image of T reaches over each edge, or falls short of it.
    sideways: [f64; 3],
    /// How far the image of each edge bends.
    bends: [f64; 3],
}

pub(super) fn bound(
    bounds: &SurfaceBounds<'_>,
    facet: &Facet,
    enough: f64,
    pieces: &mut Vec<Piece>,
) -> FacetBound {
    let uv = facet.uv;
    let uv_box = UvBox::from_points(uv);
    pieces.clear();
    let kink = bounds.pieces(uv_box, pieces);
    let sides = [facet.xyz[2] - facet.xyz[1], facet.xyz[0] - facet.xyz[2], facet.xyz[1] - facet.xyz[0]];
    let cross = sides[0].cross(sides[1]);
    let Some(n) = cross.try_normalize() else { return FacetBound::NONE };
    if pieces.is_empty() {
        return FacetBound::NONE;
    }
    let size = uv_box.size();
    let length = sides.map(DVec3::length);
    let frame = Frame3 {
        n,
        m: std::array::from_fn(|i| sides[i].cross(n) / length[i]),
        d: [uv[2] - uv[1], uv[0] - uv[2], uv[1] - uv[0]],
        length,
        height: length.map(|l| cross.length() / l),
        area2: cross.length(),
        size,
        // A jump J of the first derivative somewhere inside costs interpolation at most J·R/4.
        kinks: 0.25 * (kink.x * size.x + kink.y * size.y),
        kink,
    };
    // g is as large as the weight times the error: it is divided by the least weight.
    let least_weight = pieces.iter().fold(f64::INFINITY, |m, p| m.min(p.least_weight));
    let form = |w: DVec3, anchor: DVec3| Form::new(pieces, w, anchor).divided(least_weight);
    let normal = form(n, facet.xyz[0]);
    let h = frame.d.map(|d| normal.middle_along(d));
    let rate = pieces.iter().fold(DVec2::ZERO, |m, p| m.max(p.weight_rate)) / least_weight;
    let slope = slope(&normal, &frame, &h) + weight_slope(&frame, rate, enough);
    let sideways: [Form; 3] = std::array::from_fn(|i| form(frame.m[i], facet.xyz[(i + 1) % 3]));
    let quick = quick_parts(&frame, &normal, &h, &sideways);
    let bound = combine(facet, &quick, slope);
    // Where even the least that the enclosures allow on an edge is too much, looking closer is in vain.
    let least: [f64; 3] = std::array::from_fn(|i| (h[i].abs() - normal.reach_along(frame.d[i])) / 8.0);
    if bound.error <= enough {
        return bound;
    }
    if least.iter().any(|&e| e > enough) {
        // Of the other edges this much is certain; their upper bounds are not worth knowing.
        return FacetBound { edges: least, ..bound };
    }
    let mut best = bound;
    let mut parts = 4;
    loop {
        let weights = weight_bend(&Form::weight(pieces), &frame, parts) / least_weight;
        let (mut closer, seen) = sampled_parts(bounds, facet, &frame, &normal, &sideways, parts);
        closer.grow(1.0 + weights);
        let bound = combine(facet, &closer, slope);
        best.error = best.error.min(bound.error);
        best.edges = std::array::from_fn(|i| best.edges[i].min(bound.edges[i]));
        // What lies between the samples shrinks with the square of their number: stop where even the finest lattice is too coarse.
        let (margin, room) = (bound.error - seen, enough - seen);
        if best.error <= enough || room <= 0.0 || parts >= MAX_PARTS {
            return best;
        }
        let needed = parts as f64 * (margin / room).sqrt();
        if needed > 1.5 * MAX_PARTS as f64 {
            return best;
        }
        parts = if needed <= 8.0 && parts < 8 { 8 } else { MAX_PARTS };
    }
}

impl Parts {
    fn grow(&mut self, factor: f64) {
        self.along *= factor;
        for values in [&mut self.along_edges, &mut self.sideways, &mut self.bends] {
            values.iter_mut().for_each(|v| *v *= factor);
        }
    }
}

/// How far the weight strays from linear between the points of a lattice: a value between samples may be larger by that share.
fn weight_bend(weight: &Form, frame: &Frame3, parts: usize) -> f64 {
    let worst = frame.d.iter().fold(0.0f64, |m, &d| m.max(weight.middle_along(d).abs()));
    (worst / 6.0 + weight.reach_along(frame.size) / 8.0) / (parts * parts) as f64
}

/// What a changing weight adds to the slope of (g/w): at most |g/w|·|w'|/w per length.
fn weight_slope(frame: &Frame3, rate: DVec2, error: f64) -> f64 {
    if rate == DVec2::ZERO {
        return 0.0;
    }
    let along =
        |i: usize| error * (rate.x * frame.d[i].x.abs() + rate.y * frame.d[i].y.abs()) / frame.length[i];
    (0..3).fold(f64::INFINITY, |best, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        best.min((along(j) + along(k)) * frame.length[j] * frame.length[k] / frame.area2)
    })
}

/// From the second derivatives alone.
fn quick_parts(frame: &Frame3, normal: &Form, h: &[f64; 3], forms: &[Form; 3]) -> Parts {
    let d = &frame.d;
    let along = largest_quadratic(*h) + normal.reach_along(frame.size) / 8.0 + frame.kinks;
    let along_edges = std::array::from_fn(|i| (h[i].abs() + normal.reach_along(d[i])) / 8.0 + frame.kinks);
    let bends: [f64; 3] = std::array::from_fn(|i| {
        (forms[i].middle_along(d[i]).abs() + forms[i].reach_along(d[i])) / 8.0 + frame.kinks
    });
    let sideways = std::array::from_fn(|i| {
        let t = d.map(|d| forms[i].middle_along(d));
        // Inside T the other two edges' terms are outweighed by the distance from this edge, unless T is very flat.
        let others =
            0.5 * (t[(i + 1) % 3].abs() + t[(i + 2) % 3].abs()) + 0.5 * forms[i].reach_along(frame.size);
        bends[i] + (others - frame.height[i]).max(0.0)
    });
    Parts { along, along_edges, sideways, bends }
}

/// With the error evaluated on a lattice; also returns the largest value seen along the normal.
fn sampled_parts(
    bounds: &SurfaceBounds<'_>,
    facet: &Facet,
    frame: &Frame3,
    normal: &Form,
    forms: &[Form; 3],
    parts: usize,
) -> (Parts, f64) {
    let scale = 1.0 / (parts * parts) as f64;
    let between = |form: &Form| {
        let worst = frame.d.iter().fold(0.0f64, |m, &d| m.max(form.middle_along(d).abs()));
        (worst / 6.0 + form.reach_along(frame.size) / 8.0) * scale + frame.kinks / parts as f64
    };
    let mut seen = 0.0f64;
    let mut edges = [0.0f64; 3];
    let (mut sideways, mut bends) = ([0.0f64; 3], [0.0f64; 3]);
    for w in lattice(parts) {
        let blend = |p: [DVec3; 3]| p[0] * w[0] + p[1] * w[1] + p[2] * w[2];
        let uv = facet.uv[0] * w[0] + facet.uv[1] * w[1] + facet.uv[2] * w[2];
        let e = bounds.point(uv) - blend(facet.xyz);
        let along = e.dot(frame.n).abs();
        seen = seen.max(along);
        for i in 0..3 {
            let out = e.dot(frame.m[i]);
            sideways[i] = sideways[i].max(out - frame.height[i] * w[i]);
            if w[i] == 0.0 {
                edges[i] = edges[i].max(along);
                bends[i] = bends[i].max(out.abs());
            }
        }
    }
    let between_on_edge = |form: &Form, i: usize| {
        (form.middle_along(frame.d[i]).abs() + form.reach_along(frame.d[i])) / 8.0 * scale
            + frame.kinks / parts as f64
    };
    let bends = std::array::from_fn(|i| bends[i] + between_on_edge(&forms[i], i));
    let parts = Parts {
        along: seen + between(normal),
        along_edges: std::array::from_fn(|i| edges[i] + between_on_edge(normal, i)),
        sideways: std::array::from_fn(|i| (sideways[i] + between(&forms[i])).max(bends[i])),
        bends,
    };
    (parts, seen)
}

/// Joins what was bounded along the normal and sideways.
fn combine(facet: &Facet, parts: &Parts, slope: f64) -> FacetBound {
    let mut error = parts.along;
    let mut edges = parts.along_edges;
    for i in 0..3 {
        let shift = parts.sideways[i];
        let leaning = if slope < 0.5 { parts.along + 2.0 * slope * shift } else { f64::INFINITY };
        error = error.max(leaning.min(parts.along.hypot(shift)));
        if facet.sag[i].is_some() {
            // The image of the chord and the boundary curve both lie near the edge, which is convex: so does what is between.
            edges[i] = edges[i].hypot(parts.bends[i]);
            error = error.max(edges[i]);
        }
    }
    FacetBound { error, edges }
}

/// Bounds the slope of S over the facet: f = n·S has a derivative along side ij of at most
/// ½ max(|h_ij|, |h_jk − h_ik|) plus its deviation; two sides give the gradient.
fn slope(normal: &Form, frame: &Frame3, h: &[f64; 3]) -> f64 {
    let Frame3 { d, length, size, kink, area2, .. } = frame;
    let along = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let reach = (normal.reach[0] * size.x + normal.reach[1] * size.y) * d[i].x.abs()
            + (normal.reach[1] * size.x + normal.reach[2] * size.y) * d[i].y.abs();
        let jump = kink.x * d[i].x.abs() + kink.y * d[i].y.abs();
        (0.5 * h[i].abs().max((h[j] - h[k]).abs()) + reach + jump) / length[i]
    };
    (0..3).fold(f64::INFINITY, |best, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let sine = area2 / (length[j] * length[k]);
        best.min((along(j) + along(k)) / sine)
    })
}
