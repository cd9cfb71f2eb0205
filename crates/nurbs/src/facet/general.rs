//! Facets of any smooth surface, by enclosures of its second derivatives.
//!
//! Notation: T the triangle in parameter space with corners p_i, L the affine map of T onto the facet, S the surface,
//! n the facet's unit normal, d_ij = p_j − p_i, λ barycentric coordinates, e = S − L (zero at the corners).
//!
//! **Along n.** For a cubic f = n·S the error of linear interpolation is known exactly ([`Cubic`]: its quadratic part is
//! −½ Σ_{i<j} λ_i λ_j h_ij with h_ij = D²f\[d_ij, d_ij\] at the centroid). (For rational surfaces f is the polynomial w n·(S − a).)
//! Any other f is modelled by one; its second derivatives stray from the model's by at most r over T, which adds at most
//! ⅛(r_uu R_u² + 2 r_uv R_u R_v + r_vv R_v²), R the extent of T; this follows from Taylor's formula with integral remainder and
//! Σ λ_i (u − u_i)² ≤ R_u²/4. Where that is not enough, e is evaluated on a lattice of k² small triangles and only what lies between
//! its points is bounded so, of e itself or of its difference from the model: k² times less. Where even that is not enough, the
//! lattice is made finer near the largest error only ([`Closer`]).
//!
//! **Sideways.** The image of an edge of T bends sideways by at most τ (the same formula for the in-plane normal m of the
//! edge). A bend along an inner edge only shifts surface from one facet's side to its neighbour's: what it can cost is the slope
//! of S against the facet times the shift; where the slope is large the error is √(N² + τ²). At a boundary edge the face ends
//! at its curve: the lens between it and the image of the chord lies as near to the edge as the farther of the two.

use super::closer::{Closer, Errors, FINEST};
use super::form::{Cubic, Form};
use super::{Facet, FacetBound, lattice_point};
use crate::{Piece, SurfaceBounds, UvBox};
use glam::{DVec2, DVec3};

/// What all stages of one bound share.
pub(super) struct Frame3 {
    pub n: DVec3,
    /// In-plane normals of the edges, pointing outwards.
    m: [DVec3; 3],
    d: [DVec2; 3],
    length: [f64; 3],
    height: [f64; 3],
    area2: f64,
    size: DVec2,
    least_weight: f64,
    /// What jumps of the first derivative cost, at most.
    kinks: f64,
    kink: DVec2,
}

/// Bounds along the normal and sideways, of the facet and its edges.
#[derive(Clone, Copy)]
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
    // g is as large as the weight times the error: it is divided by the least weight.
    let least_weight = pieces.iter().fold(f64::INFINITY, |m, p| m.min(p.least_weight));
    let frame = Frame3 {
        n,
        m: std::array::from_fn(|i| sides[i].cross(n) / length[i]),
        d: [uv[2] - uv[1], uv[0] - uv[2], uv[1] - uv[0]],
        length,
        height: length.map(|l| cross.length() / l),
        area2: cross.length(),
        size,
        least_weight,
        // A jump J of the first derivative somewhere inside costs interpolation at most J·R/4.
        kinks: 0.25 * (kink.x * size.x + kink.y * size.y),
        kink,
    };
    let centroid = (uv[0] + uv[1] + uv[2]) / 3.0;
    let form = |w: DVec3, anchor: DVec3| {
        Modelled::new(Form::new(pieces, centroid, w, anchor).divided(least_weight), &frame)
    };
    let normal = form(n, facet.xyz[0]);
    let rate = pieces.iter().fold(DVec2::ZERO, |m, p| m.max(p.weight_rate)) / least_weight;
    let sideways: [Modelled; 3] = std::array::from_fn(|i| form(frame.m[i], facet.xyz[(i + 1) % 3]));
    let quick = quick_parts(&frame, &normal, &sideways);
    let mut slope = f64::INFINITY;
    let mut bound = combine(facet, &quick, slope);
    if bound.error > enough {
        // Lengths in the facet are those of its image where the image is not distorted.
        let longest = (0..3).fold(0, |best, i| if length[i] > length[best] { i } else { best });
        let lengthwise = form(sides[longest] / length[longest], facet.xyz[(longest + 1) % 3]);
        let distortion = distortion(&frame, [&sideways[longest], &lengthwise], rate);
        if distortion < 1.0 {
            let flat = steepness(&normal, &frame) + weight_slope(&frame, rate, enough);
            slope = flat / (1.0 - distortion);
            bound = combine(facet, &quick, slope);
        }
    }
    // Where even the least that the enclosures allow on an edge is too much, looking closer is in vain.
    let least: [f64; 3] =
        std::array::from_fn(|i| normal.cubic.mid_edge(i) - normal.form.reach_along(frame.d[i]) / 8.0);
    if bound.error <= enough {
        return bound;
    }
    if least.iter().any(|&e| e > enough) {
        // Of the other edges this much is certain; their upper bounds are not worth knowing.
        return FacetBound { edges: least, ..bound };
    }
    let weight = Modelled::new(Form::weight(pieces, centroid).divided(least_weight), &frame);
    let (mut best, mut seen, mut parts) = (bound, Seen::default(), 4);
    loop {
        seen.look(bounds, facet, &frame, &normal.cubic, parts);
        // The weight strays by this share from linear between the points of the lattice.
        let weights = weight.between(&frame, parts);
        let found = seen.parts(&frame, &normal, &sideways, weights);
        let bound = combine(facet, &found, slope);
        best.error = best.error.min(bound.error);
        best.edges = std::array::from_fn(|i| best.edges[i].min(bound.edges[i]));
        // What lies between the samples shrinks with the square of their number: stop where even the finest lattice is too coarse.
        let (margin, room) = (bound.error - seen.along, enough - seen.along);
        let needed = parts as f64 * (margin / room).sqrt();
        if best.error <= enough || room <= 0.0 || parts >= FINEST || needed > 1.5 * FINEST as f64 {
            return best;
        }
        if parts < 8 && needed <= 8.0 {
            parts = 8;
            continue;
        }
        // How small the error along the normal must be, with what is known of the shifts sideways.
        let target = allowed_along(&found, slope, enough);
        if target > seen.along + normal.between(&frame, FINEST) {
            let (normal, weight, errors) = (&normal, &weight, &mut seen.errors);
            let mut closer = Closer { bounds, facet, frame: &frame, normal, weight, errors };
            return closer_bound(&mut closer, &found, slope, best, parts, target, enough);
        }
        // The shifts are too large, or not known well enough.
        parts = FINEST;
    }
}

/// A chord that bends by less than this share of its length bends to no side in particular.
const STRAIGHT: f64 = 1e-7;

/// See [`super::chord_bound`]: the distance from the chord at the ends of equal parts of the segment, and between them the error of
/// linear interpolation across the chord, in two directions.
pub(super) fn chord_bound(
    bounds: &SurfaceBounds<'_>,
    uv: [DVec2; 2],
    xyz: [DVec3; 2],
    parts: usize,
    pieces: &mut Vec<Piece>,
) -> f64 {
    let Some(chord) = (xyz[1] - xyz[0]).try_normalize() else { return f64::INFINITY };
    let middle = uv[0].midpoint(uv[1]);
    // Where it bends to, and not to any side: the bound must not depend on how the part lies in space.
    let bend = (bounds.point(middle) - xyz[0].midpoint(xyz[1])).reject_from_normalized(chord);
    let straight = bend.length() <= STRAIGHT * xyz[0].distance(xyz[1]);
    let side =
        if straight { bounds.normal(middle).map(|n| n.reject_from_normalized(chord)) } else { Some(bend) };
    let across = side.and_then(DVec3::try_normalize).unwrap_or_else(|| chord.any_orthonormal_vector());
    let axes = [across, chord.cross(across)];
    let d = (uv[1] - uv[0]) / parts as f64;
    let at = |i: usize| uv[0].lerp(uv[1], i as f64 / parts as f64);
    let off = |i: usize| (bounds.point(at(i)) - xyz[0]).reject_from_normalized(chord).length();
    let mut part = |i: usize| {
        pieces.clear();
        let kink = bounds.pieces(UvBox::from_points([at(i), at(i + 1)]), pieces);
        if pieces.is_empty() {
            return f64::INFINITY;
        }
        let least_weight = pieces.iter().fold(f64::INFINITY, |m, p| m.min(p.least_weight));
        let [a, b] = axes.map(|w| {
            Form::new(pieces, at(i).midpoint(at(i + 1)), w, xyz[0]).largest_along(d) / (8.0 * least_weight)
        });
        let between = a.hypot(b) + 0.25 * kink.dot(d.abs());
        if parts == 1 {
            return between;
        }
        // Between its ends the weight may be smaller than there by this share.
        let rate = pieces.iter().fold(DVec2::ZERO, |m, p| m.max(p.weight_rate)) / least_weight;
        off(i).max(off(i + 1)) * (1.0 + rate.dot(d.abs())) + between
    };
    (0..parts).fold(0.0, |worst: f64, i| worst.max(part(i)))
}

/// The largest error along the normal with which a facet whose image shifts so far sideways passes.
fn allowed_along(parts: &Parts, slope: f64, enough: f64) -> f64 {
    parts.sideways.iter().fold(enough, |least, &shift| {
        let leaning = if slope < 0.5 { enough - 2.0 * slope * shift } else { 0.0 };
        least.min(leaning.max((enough * enough - shift * shift).max(0.0).sqrt()))
    })
}

/// Looks closer where the lattice showed errors near the target; improves on `best` where that succeeds.
fn closer_bound(
    closer: &mut Closer<'_, '_>,
    found: &Parts,
    slope: f64,
    mut best: FacetBound,
    parts: usize,
    target: f64,
    enough: f64,
) -> FacetBound {
    let mut edges = found.along_edges;
    for i in 0..3 {
        if closer.facet.sag[i].is_some() {
            let allowed = (enough * enough - found.bends[i] * found.bends[i]).max(0.0).sqrt();
            edges[i] = closer.edge_bound(i, parts, allowed).unwrap_or(f64::INFINITY).min(edges[i]);
        }
    }
    let along = closer.bound(parts, target).unwrap_or(f64::INFINITY).min(found.along);
    let bound = combine(closer.facet, &Parts { along, along_edges: edges, ..*found }, slope);
    best.error = best.error.min(bound.error);
    best.edges = std::array::from_fn(|i| best.edges[i].min(bound.edges[i]));
    best
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
fn quick_parts(frame: &Frame3, normal: &Modelled, sideways: &[Modelled; 3]) -> Parts {
    let on_edge =
        |f: &Modelled, i: usize| f.cubic.on_edge(i) + f.form.reach_along(frame.d[i]) / 8.0 + frame.kinks;
    let bends: [f64; 3] = std::array::from_fn(|i| on_edge(&sideways[i], i));
    Parts {
        along: normal.cubic.largest() + normal.form.reach_along(frame.size) / 8.0 + frame.kinks,
        along_edges: std::array::from_fn(|i| on_edge(normal, i)),
        sideways: std::array::from_fn(|i| {
            let Modelled { form, cubic } = &sideways[i];
            // Inside T the other two edges' terms are outweighed by the distance from this edge, unless T is very flat: of the
            // cubic's terms those with λ_i weigh 1 − (1 − λ_i)³ ≤ 3 λ_i.
            let others = 0.5 * (cubic.h[(i + 1) % 3].abs() + cubic.h[(i + 2) % 3].abs())
                + 3.0 * cubic.cubic_part()
                + 0.5 * form.reach_along(frame.size);
            bends[i] + (others - frame.height[i]).max(0.0)
        }),
        bends,
    }
}

/// Second derivatives in one direction and the interpolation error that they make.
pub(super) struct Modelled {
    form: Form,
    cubic: Cubic,
}

impl Modelled {
    fn new(form: Form, frame: &Frame3) -> Self {
        Self { cubic: form.error(&frame.d), form }
    }

    /// What lies between the points of a lattice, at most.
    pub fn between(&self, frame: &Frame3, parts: usize) -> f64 {
        let scale = 1.0 / (parts * parts) as f64;
        (self.cubic.largest_between(parts) + self.form.reach_along(frame.size) / 8.0) * scale
            + frame.kinks / parts as f64
    }

    /// What a lattice does not show of the difference from the model, along `d`.
    fn remainder(&self, d: DVec2, frame: &Frame3, parts: usize) -> f64 {
        let parts = parts as f64;
        self.form.reach_along(d) / (8.0 * parts * parts) + frame.kinks / parts
    }

    /// The same on edge `i`.
    pub fn between_on_edge(&self, frame: &Frame3, i: usize, parts: usize) -> f64 {
        let parts = parts as f64;
        (self.cubic.steepest(i) + self.form.reach_along(frame.d[i])) / (8.0 * parts * parts)
            + frame.kinks / parts
    }
}

/// What evaluation at the points of a lattice has shown, at most.
#[derive(Default)]
struct Seen {
    /// The lattice seen so far divides edges in so many parts.
    parts: usize,
    along: f64,
    along_edges: [f64; 3],
    /// How far w·(S − a)·n is from its model.
    off: f64,
    off_edges: [f64; 3],
    sideways: [f64; 3],
    bends: [f64; 3],
    errors: Errors,
}

impl Seen {
    /// Looks at the points of a lattice that were not seen before.
    fn look(
        &mut self,
        bounds: &SurfaceBounds<'_>,
        facet: &Facet,
        frame: &Frame3,
        model: &Cubic,
        parts: usize,
    ) {
        let known = parts.checked_div(self.parts).unwrap_or(parts);
        for i in 0..=parts {
            for j in 0..=parts - i {
                if !(i.is_multiple_of(known) && j.is_multiple_of(known)) {
                    let along = self.look_at(bounds, facet, frame, model, lattice_point(i, j, parts));
                    self.errors.set(i * FINEST / parts, j * FINEST / parts, along);
                }
            }
        }
        self.parts = parts;
    }

    /// Returns the error along the normal.
    fn look_at(
        &mut self,
        bounds: &SurfaceBounds<'_>,
        facet: &Facet,
        frame: &Frame3,
        model: &Cubic,
        w: [f64; 3],
    ) -> f64 {
        let blend = |p: [DVec3; 3]| p[0] * w[0] + p[1] * w[1] + p[2] * w[2];
        let uv = facet.uv[0] * w[0] + facet.uv[1] * w[1] + facet.uv[2] * w[2];
        let (p, weight) = bounds.weighted_point(uv);
        let e = p - blend(facet.xyz);
        let along = e.dot(frame.n);
        let off = (along * (weight / frame.least_weight) - model.at(w)).abs();
        self.along = self.along.max(along.abs());
        self.off = self.off.max(off);
        for i in 0..3 {
            let out = e.dot(frame.m[i]);
            self.sideways[i] = self.sideways[i].max(out - frame.height[i] * w[i]);
            if w[i] == 0.0 {
                self.along_edges[i] = self.along_edges[i].max(along.abs());
                self.off_edges[i] = self.off_edges[i].max(off);
                self.bends[i] = self.bends[i].max(out.abs());
            }
        }
        along.abs()
    }

    /// Bounds from what was seen and what lies between; `weights` is the share by which values between samples may be larger
    /// because the weight changes.
    fn parts(&self, frame: &Frame3, normal: &Modelled, forms: &[Modelled; 3], weights: f64) -> Parts {
        let grow = 1.0 + weights;
        let bends =
            std::array::from_fn(|i| (self.bends[i] + forms[i].between_on_edge(frame, i, self.parts)) * grow);
        let direct = (self.along + normal.between(frame, self.parts)) * grow;
        let modelled = normal.cubic.largest() + self.off + normal.remainder(frame.size, frame, self.parts);
        Parts {
            along: direct.min(modelled),
            along_edges: std::array::from_fn(|i| {
                let direct = (self.along_edges[i] + normal.between_on_edge(frame, i, self.parts)) * grow;
                let off = self.off_edges[i] + normal.remainder(frame.d[i], frame, self.parts);
                direct.min(normal.cubic.on_edge(i) + off)
            }),
            sideways: std::array::from_fn(|i| {
                ((self.sideways[i] + forms[i].between(frame, self.parts)) * grow).max(bends[i])
            }),
            bends,
        }
    }
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

/// How much the image of T is stretched, sheared or turned in the facet's plane against the facet, at most: |D(S − L)| there, in two
/// directions at right angles. Below 1 the image is a graph over the facet's plane, and its slope is that over T divided by what is left.
fn distortion(frame: &Frame3, across: [&Modelled; 2], rate: DVec2) -> f64 {
    let [a, b] = across.map(|f| steepness(f, frame) + weight_distortion(frame, f, rate));
    a.hypot(b)
}

/// What a changing weight adds to it: of w·e the error of interpolation leaves out −Σ λ_i λ_j (w_i − w_j)(l_i − l_j), l the coordinate
/// of L; and e itself is divided by the weight.
fn weight_distortion(frame: &Frame3, f: &Modelled, rate: DVec2) -> f64 {
    if rate == DVec2::ZERO {
        return 0.0;
    }
    let size = f.cubic.largest() + f.form.reach_along(frame.size) / 8.0;
    let change = rate.dot(frame.size);
    let longest = frame.length.iter().fold(0.0f64, |m, l| m.max(*l));
    let sine = |j: usize, k: usize| frame.area2 / (frame.length[j] * frame.length[k]);
    let product = (0..3).fold(f64::INFINITY, |best, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        best.min(3.0 * change * longest * (1.0 / frame.length[j] + 1.0 / frame.length[k]) / sine(j, k))
    });
    product + weight_slope(frame, rate, size)
}

/// Bounds the slope of S over the facet: f = n·S has a derivative along side ij of at most
/// ½ max(|h_ij|, |h_jk − h_ik|), six times the largest coefficient of the cubic part (a derivative's coefficients are three times
/// differences of two), and the remainder's share; two sides give the gradient.
fn steepness(normal: &Modelled, frame: &Frame3) -> f64 {
    let Frame3 { d, length, size, kink, area2, .. } = frame;
    let (h, reach) = (&normal.cubic.h, &normal.form.reach);
    let cubic = 6.0 * normal.cubic.cubic_part();
    let along = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let reach = (reach[0] * size.x + reach[1] * size.y) * d[i].x.abs()
            + (reach[1] * size.x + reach[2] * size.y) * d[i].y.abs();
        let jump = kink.x * d[i].x.abs() + kink.y * d[i].y.abs();
        (0.5 * h[i].abs().max((h[j] - h[k]).abs()) + cubic + reach + jump) / length[i]
    };
    (0..3).fold(f64::INFINITY, |best, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let sine = area2 / (length[j] * length[k]);
        best.min((along(j) + along(k)) / sine)
    })
}
