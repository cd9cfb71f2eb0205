//! The proven distance between a surface piece and a flat triangle whose corners lie on the surface.
//!
//! Notation: T the triangle in parameter space with corners p_i, L the affine map of T onto the facet, S the surface,
//! n the facet's unit normal, d_ij = p_j − p_i, λ barycentric coordinates, e = S − L (zero at the corners).
//!
//! **Along n.** For a quadratic f = n·S the error of linear interpolation is exactly −½ Σ_{i<j} λ_i λ_j h_ij with
//! h_ij = D²f\[d_ij, d_ij\]. For any other f the second derivatives are split into a middle (treated so) and a
//! deviation r over T (which adds at most ⅛(r_uu R_u² + 2 r_uv R_u R_v + r_vv R_v²), R the extent of T; this follows
//! from Taylor's formula with integral remainder and Σ λ_i (u − u_i)² ≤ R_u²/4).
//!
//! **Sideways.** The image of an edge of T bends sideways by at most τ (the same formula for the in-plane normal m of the
//! edge). A bend along an inner edge only shifts surface from one facet's side to its neighbour's: what it can cost is τ times
//! the slope of S against the facet. Along a boundary edge, and wherever slope is large, the error is √(N² + τ²).
//!
//! Cylinders, cones and spheres have exact forms instead, in which the closest-point projection maps the facets onto
//! the surface, consistently along shared edges.
//!
//! Sound as long as the mesh lies nearer to the surface than its smallest radius of curvature; the slope test below
//! rejects facets that do not.

use crate::{Piece, Surface, SurfaceBounds};
use glam::{DVec2, DVec3};

/// One facet to be bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Corners in parameter space.
    pub uv: [DVec2; 3],
    /// The surface at these corners.
    pub xyz: [DVec3; 3],
    /// Which edges (opposite corner i) bound the face.
    pub boundary: [bool; 3],
}

/// Upper bound of the two-sided distance between the surface over the triangle and the facet, and of what part of it stems
/// from each edge alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetBound {
    /// The bound for the whole facet; infinite where nothing can be said.
    pub error: f64,
    /// The share of the edge opposite corner i, which no point inside the facet can lower.
    pub edges: [f64; 3],
}

impl FacetBound {
    const NONE: FacetBound = FacetBound { error: f64::INFINITY, edges: [f64::INFINITY; 3] };
    const EXACT: FacetBound = FacetBound { error: 0.0, edges: [0.0; 3] };
}

/// Bounds one facet; `scratch` is reused from call to call.
pub fn facet_bound(bounds: &SurfaceBounds<'_>, facet: &Facet, scratch: &mut Vec<Piece>) -> FacetBound {
    let mut bound = match bounds.surface() {
        Surface::Plane { .. } => FacetBound::EXACT,
        Surface::Cylinder { radius, .. } => cone_bound(facet, [*radius; 3], 1.0),
        Surface::Cone { radius, half_angle, .. } => {
            let radii = facet.uv.map(|p| radius + p.y * half_angle.tan());
            cone_bound(facet, radii, half_angle.cos())
        }
        Surface::Sphere { frame, radius } => sphere_bound(facet, frame.origin, *radius),
        _ => general_bound(bounds, facet, scratch),
    };
    // Evaluation and these formulas are good to a few units in the last place of the largest coordinate.
    let rounding = 32.0 * f64::EPSILON * facet.xyz.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    bound.error += rounding;
    bound
}

/// The largest distance from a chord between radii `a` and `b`, the angle `turn` apart, to the cone (before the factor
/// cos α): f = x − √(x² − y²) with x = w_a + w_b, y² = 4 w_a w_b sin²(turn/2), w_a = λa, w_b = (1−λ)b. The harmonic mean
/// w_a w_b / x is at most 1/(1/√a + 1/√b)², and y²/x² at most sin².
fn cone_chord(a: f64, b: f64, turn: f64) -> f64 {
    if a <= 0.0 || b <= 0.0 {
        return 0.0;
    }
    let (sine, cosine) = (turn * 0.5).sin_cos();
    4.0 * sine * sine / (1.0 / a.sqrt() + 1.0 / b.sqrt()).powi(2) / (1.0 + cosine.abs())
}

/// Cylinders and cones, by their radii at the corners.
///
/// The distance of a facet point Σ λ_i r_i e(u_i) to the cone is (Σ w_i − |Σ w_i e_i|) cos α, w_i = λ_i r_i. It grows with each
/// radius, and writing the middle direction as α e_first + β e_last (α + β ≥ 1) turns it into a chord across the facet's whole
/// turn, between its two largest radii, at most α + β times over.
fn cone_bound(facet: &Facet, radii: [f64; 3], cosine: f64) -> FacetBound {
    let low = radii.iter().fold(f64::INFINITY, |m, &r| m.min(r));
    let scale = radii.iter().fold(0.0f64, |m, &r| m.max(r.abs()));
    if low < -1e-9 * scale {
        // All on the second nappe: the same cone seen from the other side. Across the apex: no facet of it.
        if radii.iter().all(|&r| r <= 1e-9 * scale) {
            return cone_bound(facet, radii.map(f64::abs), cosine);
        }
        return FacetBound::NONE;
    }
    // The apex has no angle of its own.
    let apex = radii.map(|r| r <= 1e-9 * scale);
    let edge = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        if apex[j] || apex[k] {
            return 0.0;
        }
        cosine * cone_chord(radii[j], radii[k], facet.uv[j].x - facet.uv[k].x)
    };
    let edges = [edge(0), edge(1), edge(2)];
    let mut u: Vec<f64> = (0..3).filter(|&i| !apex[i]).map(|i| facet.uv[i].x).collect();
    u.sort_by(f64::total_cmp);
    let turn = match u[..] {
        [first, .., last] => last - first,
        _ => 0.0,
    };
    if turn > 2.0 {
        return FacetBound::NONE;
    }
    // With an apex the facet is a fan: its worst chord is the edge facing the apex.
    let &[first, middle, last] = &u[..] else {
        return FacetBound { error: edges[0].max(edges[1]).max(edges[2]), edges };
    };
    let mut sorted = radii;
    sorted.sort_by(|a, b| b.total_cmp(a));
    let same_radius = sorted[0] - sorted[2] <= 1e-12 * scale;
    let spread = if same_radius || turn == 0.0 {
        1.0
    } else {
        ((last - middle).sin() + (middle - first).sin()) / turn.sin()
    };
    FacetBound { error: cosine * cone_chord(sorted[0], sorted[1], turn) * spread, edges }
}

/// A sphere: the facet point nearest to the centre is the farthest from the surface.
fn sphere_bound(facet: &Facet, center: DVec3, radius: f64) -> FacetBound {
    let [a, b, c] = facet.xyz.map(|p| p - center);
    let edge = |p: DVec3, q: DVec3| radius - nearest_on_segment(p, q).length();
    let edges = [edge(b, c), edge(c, a), edge(a, b)];
    let n = (b - a).cross(c - a);
    let worst_edge = edges[0].max(edges[1]).max(edges[2]);
    let inside = n.dot(b.cross(c)) > 0.0 && n.dot(c.cross(a)) > 0.0 && n.dot(a.cross(b)) > 0.0
        || n.dot(b.cross(c)) < 0.0 && n.dot(c.cross(a)) < 0.0 && n.dot(a.cross(b)) < 0.0;
    let error = match n.try_normalize() {
        Some(unit) if inside => radius - unit.dot(a).abs(),
        _ => worst_edge,
    };
    // Over half the radius the projection from the centre folds.
    if error > 0.6 * radius { FacetBound::NONE } else { FacetBound { error, edges } }
}

fn nearest_on_segment(p: DVec3, q: DVec3) -> DVec3 {
    let d = q - p;
    let length2 = d.length_squared();
    if length2 == 0.0 { p } else { p + d * (-p.dot(d) / length2).clamp(0.0, 1.0) }
}

/// Second derivatives of w·S over the pieces: the middle of the enclosure and how far it reaches, for uu, uv, vv.
#[derive(Clone, Copy)]
struct Form {
    middle: [f64; 3],
    reach: [f64; 3],
}

impl Form {
    fn new(pieces: &[Piece], w: DVec3) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for piece in pieces {
            let (value, reach) = piece.along(w);
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

fn general_bound(bounds: &SurfaceBounds<'_>, facet: &Facet, pieces: &mut Vec<Piece>) -> FacetBound {
    let uv = facet.uv;
    let uv_box = crate::UvBox::from_points(uv);
    pieces.clear();
    let kink = bounds.pieces(uv_box, pieces);
    let sides = [facet.xyz[2] - facet.xyz[1], facet.xyz[0] - facet.xyz[2], facet.xyz[1] - facet.xyz[0]];
    let area2 = sides[0].cross(sides[1]);
    let Some(n) = area2.try_normalize() else { return FacetBound::NONE };
    if pieces.is_empty() {
        return FacetBound::NONE;
    }
    let d = [uv[2] - uv[1], uv[0] - uv[2], uv[1] - uv[0]];
    let size = uv_box.size();
    // A jump J of the first derivative somewhere inside costs interpolation at most J·R/4.
    let kinks = 0.25 * (kink.x * size.x + kink.y * size.y);

    // 1. Along the normal.
    let normal = Form::new(pieces, n);
    let h = d.map(|d| normal.middle_along(d));
    let along = largest_quadratic(h) + normal.reach_along(size) / 8.0 + kinks;

    // 2. Sideways, edge by edge.
    let length = sides.map(DVec3::length);
    let height = length.map(|l| area2.length() / l);
    let mut sideways = [0.0; 3];
    for i in 0..3 {
        let m = n.cross(sides[i]) / length[i];
        let form = Form::new(pieces, m);
        let t = d.map(|d| form.middle_along(d));
        let own = (t[i].abs() + form.reach_along(d[i])) / 8.0;
        // Inside T the other two edges' terms are outweighed by the distance from this edge, unless T is very flat.
        let others = 0.5 * (t[(i + 1) % 3].abs() + t[(i + 2) % 3].abs()) + 0.5 * form.reach_along(size);
        sideways[i] = own + kinks + (others - height[i]).max(0.0);
    }

    // 3. What a sideways shift costs along inner edges: the slope of S against the facet.
    let slope = slope(&normal, &d, &h, &length, size, kink, area2.length());
    let mut error = along;
    let mut edges = [0.0; 3];
    for i in 0..3 {
        let edge_along = (h[i].abs() + normal.reach_along(d[i])) / 8.0 + kinks;
        edges[i] = edge_along.hypot(sideways[i]);
        let inner = if slope < 0.5 { along + 2.0 * slope * sideways[i] } else { f64::INFINITY };
        let whole = along.hypot(sideways[i]);
        let cost = if facet.boundary[i] { edges[i].max(inner.min(whole)) } else { inner.min(whole) };
        error = error.max(cost);
    }
    FacetBound { error, edges }
}

/// Bounds the slope of S over the facet: f = n·S has a derivative along side ij of at most
/// ½ max(|h_ij|, |h_jk − h_ik|) plus its deviation; two sides give the gradient.
fn slope(
    normal: &Form,
    d: &[DVec2; 3],
    h: &[f64; 3],
    length: &[f64; 3],
    size: DVec2,
    kink: DVec2,
    area2: f64,
) -> f64 {
    let along = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let reach = (normal.reach[0] * size.x + normal.reach[1] * size.y) * d[i].x.abs()
            + (normal.reach[1] * size.x + normal.reach[2] * size.y) * d[i].y.abs();
        let jump = kink.x * d[i].x.abs() + kink.y * d[i].y.abs();
        (0.5 * h[i].abs().max((h[j] - h[k]).abs()) + reach + jump) / length[i]
    };
    let mut best = f64::INFINITY;
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let sine = area2 / (length[j] * length[k]);
        best = best.min((along(j) + along(k)) / sine);
    }
    best
}
