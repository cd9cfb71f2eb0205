//! Exact forms for cylinders, cones, spheres and tori.

use super::{Facet, FacetBound, lattice};
use crate::Frame;
use crate::math;
use glam::DVec3;

/// The largest angle in radians by which a facet may turn round an axis.
///
/// At π the projection from the axis folds, and the closed forms are no bounds any more. The margin keeps the
/// facets away from there; facets of that size are never within a sensible tolerance.
const MAX_TURN: f64 = 2.6;

/// The largest distance from a chord between radii `a` and `b`, the angle `turn` apart, to the cone (before
/// the factor cos α): f = x − √(x² − y²) with x = w_a + w_b, y² = 4 w_a w_b sin²(turn/2), w_a = λa, w_b =
/// (1−λ)b. The harmonic mean w_a w_b / x is at most 1/(1/√a + 1/√b)², and y²/x² at most sin².
fn cone_chord(a: f64, b: f64, turn: f64) -> f64 {
    if a <= 0.0 || b <= 0.0 {
        return 0.0;
    }
    let (sine, cosine) = math::sin_cos(turn * 0.5);
    4.0 * sine * sine / math::square(1.0 / a.sqrt() + 1.0 / b.sqrt()) / (1.0 + cosine.abs())
}

/// Cylinders and cones, by their radii at the corners.
///
/// The distance of a facet point Σ λ_i r_i e(u_i) to the cone is (Σ w_i − |Σ w_i e_i|) cos α, w_i = λ_i r_i.
/// It grows with each radius, and writing the middle direction as α e_first + β e_last (α + β ≥ 1) turns it
/// into a chord across the facet's whole turn, between its two largest radii, at most α + β times over.
pub(super) fn cone(facet: &Facet, radii: [f64; 3], cosine: f64) -> FacetBound {
    let low = radii.iter().fold(f64::INFINITY, |m, &r| m.min(r));
    let scale = radii.iter().fold(0.0f64, |m, &r| m.max(r.abs()));
    if low < -1e-9 * scale {
        // All on the second nappe: the same cone seen from the other side. Across the apex: no facet of it.
        if radii.iter().all(|&r| r <= 1e-9 * scale) {
            return cone(facet, radii.map(f64::abs), cosine);
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
    if turn > MAX_TURN {
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
        (math::sin(last - middle) + math::sin(middle - first)) / math::sin(turn)
    };
    FacetBound { error: cosine * cone_chord(sorted[0], sorted[1], turn) * spread, edges }
}

/// A sphere: the facet point nearest to the centre is the farthest from the surface.
pub(super) fn sphere(facet: &Facet, center: DVec3, radius: f64) -> FacetBound {
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

/// A torus: the distance ρ to the circle that its tube is drawn around, against the tube's radius.
///
/// ρ is sampled on a lattice over the facet; between the samples it strays from linear by at most a sixth of
/// the largest second derivative along an edge of the lattice. That derivative is at most (d·t₁)²/ρ + |cos
/// θ|/(R + ρ cos θ)·(d·t₂)² ≤ d₁²/ρ + |d|²/q, with d₁ the edge's part in the turning plane of the tube and q
/// the distance to the axis.
pub(super) fn torus(facet: &Facet, frame: &Frame, major: f64, minor: f64, enough: f64) -> FacetBound {
    let local = facet.xyz.map(|p| frame.local(p));
    let [a, b, c] = local;
    let u = facet.uv.map(|p| p.x);
    let (u_low, u_high) = (u[0].min(u[1]).min(u[2]), u[0].max(u[1]).max(u[2]));
    let v = facet.uv.map(|p| p.y);
    let v_turn = v[0].max(v[1]).max(v[2]) - v[0].min(v[1]).min(v[2]);
    let half_turn = 0.5 * (u_high - u_low);
    if half_turn > 0.5 * MAX_TURN || v_turn > MAX_TURN {
        return FacetBound::NONE;
    }
    let (sine, cosine) = math::sin_cos(0.5 * (u_low + u_high));
    let depth = |p: DVec3| {
        let q = p.truncate().length() - major;
        (q * q + p.z * p.z).sqrt() - minor
    };
    let nearest =
        local.iter().map(|p| p.truncate().length()).fold(f64::INFINITY, f64::min) * math::cos(half_turn);
    let second = |d: DVec3, rho: f64| {
        let radial = (d.x * cosine + d.y * sine).abs() + d.truncate().length() * math::sin(half_turn);
        let across = math::square(radial + d.z.abs()).min(d.length_squared());
        // Along the circle: cos θ/q, at most 1/q, and 0 where the facet is seen from above.
        across / rho + d.length_squared() / nearest
    };
    let d = [c - b, a - c, b - a];
    // Small facets need no samples: at the corners ρ is right, and in between it bends this much at most.
    let longest = d.iter().fold(0.0f64, |m, d| m.max(d.length()));
    let rho = minor - 0.6 * longest;
    if rho > 0.5 * minor && nearest > 0.0 {
        let bends = d.map(|d| second(d, rho));
        let error = bends[0].max(bends[1]).max(bends[2]) / 6.0;
        if error <= enough {
            return FacetBound { error, edges: bends.map(|b| b / 8.0) };
        }
    }
    let mut parts = 4;
    loop {
        let mut worst = 0.0f64;
        let mut on_edges = [0.0f64; 3];
        let mut deepest = minor;
        for w in lattice(parts) {
            let g = depth(a * w[0] + b * w[1] + c * w[2]);
            worst = worst.max(g.abs());
            deepest = deepest.min(minor + g);
            for i in 0..3 {
                if w[i] == 0.0 {
                    on_edges[i] = on_edges[i].max(g.abs());
                }
            }
        }
        // ρ changes no faster than position: between samples it is at most an edge of the lattice lower.
        let scale = (parts * parts) as f64;
        let step = longest / parts as f64;
        let rho = deepest - 0.6 * step;
        if !(nearest > 0.0) || parts >= 32 && !(rho > 0.0) {
            return FacetBound::NONE;
        }
        if !(rho > 0.1 * minor) && parts < 32 {
            parts *= 2;
            continue;
        }
        let bends = d.map(|d| second(d, rho) / scale);
        let between = bends[0].max(bends[1]).max(bends[2]) / 6.0;
        let bound = FacetBound {
            error: worst + between,
            edges: std::array::from_fn(|i| on_edges[i] + bends[i] / 8.0),
        };
        // A fold: the facet must not reach the inner half of the tube.
        if worst > 0.7 * minor {
            return FacetBound::NONE;
        }
        if bound.error <= enough || worst > enough {
            return bound;
        }
        if parts >= 32 {
            return FacetBound::NONE;
        }
        parts *= 2;
    }
}
