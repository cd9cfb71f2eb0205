//! Facets of any smooth surface, by enclosures of its second derivatives.
//!
//! Notation: T the triangle in parameter space with corners p_i, L the affine map of T onto the facet, S the
//! surface, n the facet's unit normal, d_ij = p_j − p_i, λ barycentric coordinates, e = S − L (zero at the
//! corners).
//!
//! **Along n.** For a cubic f = n·S the error of linear interpolation is known exactly ([`Cubic`]: its
//! quadratic part is −½ Σ_{i<j} λ_i λ_j h_ij with h_ij = D²f\[d_ij, d_ij\] at the centroid). (For rational
//! surfaces f is the polynomial w n·(S − a).) Any other f is modelled by one; its second derivatives stray
//! from the model's by at most r over T, which adds at most ⅛(r_uu R_u² + 2 r_uv R_u R_v + r_vv R_v²), R the
//! extent of T; this follows from Taylor's formula with integral remainder and Σ λ_i (u − u_i)² ≤ R_u²/4.
//! Where that is not enough, e is evaluated on a lattice of k² small triangles and only what lies between its
//! points is bounded so, of e itself or of its difference from the model: k² times less. Where even that is
//! not enough, the lattice is made finer near the largest error only ([`Closer`]).
//!
//! **Sideways.** The image of an edge of T bends sideways by at most τ (the same formula for the in-plane
//! normal m of the edge). A bend along an inner edge only shifts surface from one facet's side to its
//! neighbour's: what it can cost is the slope of S against the facet times the shift; where the slope is
//! large the error is √(N² + τ²). At a boundary edge the face ends at its curve: the lens between it and the
//! image of the chord lies as near to the edge as the farther of the two.

use super::form::Form;
use super::lattice::{Parts, Samples};
use super::refine_bound::{Closer, FINEST};
use super::setting::{Modelled, Setting};
use super::slope::{distortion, steepness, weight_slope};
use super::{Facet, FacetBound};
use crate::math;
use crate::{Piece, SurfaceBounds, UvBox, work};
use glam::{DVec2, DVec3};

/// The work of the models of one piece.
const PIECE: u64 = 200;

/// Bounds a facet, with as little work as shows that it is within `enough`:
///
/// 1. from the enclosures of the second derivatives alone, a shift sideways taken as an error of its own;
/// 2. the same, a shift sideways multiplied by how steep the surface is against the facet;
/// 3. from errors on a lattice and the enclosures between its points, finer as long as that can help;
/// 4. from a lattice that is refined near the largest error only.
pub(super) fn bound(
    bounds: &SurfaceBounds<'_>,
    facet: &Facet,
    enough: f64,
    pieces: &mut Vec<Piece>,
) -> FacetBound {
    let Some(problem) = Problem::new(bounds, facet, enough, pieces) else { return FacetBound::NONE };
    let (bound, slope) = problem.by_derivatives();
    if bound.error <= enough {
        return bound;
    }
    // Where even the least that the enclosures allow on an edge is too much, samples inside the facet cannot
    // help.
    let least = problem.least_on_edges();
    if least.iter().any(|&e| e > enough) {
        // Of the other edges this much is certain; their upper bounds are not worth knowing.
        return FacetBound { edges: least, ..bound };
    }
    problem.by_samples(bound, slope)
}

/// One facet with the models of the surface over it.
struct Problem<'a, 'b> {
    bounds: &'a SurfaceBounds<'b>,
    facet: &'a Facet,
    enough: f64,
    pieces: &'a [Piece],
    setting: Setting,
    centroid: DVec2,
    sides: [DVec3; 3],
    /// The surface along the facet's normal.
    normal: Modelled,
    /// The surface along the outward in-plane normal of each edge.
    sideways: [Modelled; 3],
    /// How fast the weight changes in u and v, over the least weight, at most.
    rate: DVec2,
}

impl<'a, 'b> Problem<'a, 'b> {
    /// `None` if nothing can be proven: a facet without area, or a surface without enclosures.
    fn new(
        bounds: &'a SurfaceBounds<'b>,
        facet: &'a Facet,
        enough: f64,
        pieces: &'a mut Vec<Piece>,
    ) -> Option<Self> {
        let uv = facet.uv;
        let uv_box = UvBox::from_points(uv);
        pieces.clear();
        let kink = bounds.pieces(uv_box, pieces);
        work::count(PIECE * pieces.len() as u64);
        let pieces: &[Piece] = pieces;
        let sides = [facet.xyz[2] - facet.xyz[1], facet.xyz[0] - facet.xyz[2], facet.xyz[1] - facet.xyz[0]];
        let cross = sides[0].cross(sides[1]);
        let n = cross.try_normalize()?;
        if pieces.is_empty() {
            return None;
        }
        let size = uv_box.size();
        let length = sides.map(DVec3::length);
        // g is as large as the weight times the error: it is divided by the least weight.
        let least_weight = pieces.iter().fold(f64::INFINITY, |m, p| m.min(p.least_weight));
        let setting = Setting {
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
        let along = |w: DVec3, anchor: DVec3| model(pieces, centroid, &setting, w, anchor);
        let normal = along(n, facet.xyz[0]);
        let rate = pieces.iter().fold(DVec2::ZERO, |m, p| m.max(p.weight_rate)) / least_weight;
        let sideways = std::array::from_fn(|i| along(setting.m[i], facet.xyz[(i + 1) % 3]));
        Some(Self { bounds, facet, enough, pieces, setting, centroid, sides, normal, sideways, rate })
    }

    /// Steps 1 and 2: the bound, and the slope of the surface against the facet, infinite where it was not
    /// needed or is not known.
    fn by_derivatives(&self) -> (FacetBound, f64) {
        let Self { facet, setting, sideways, .. } = self;
        let quick = quick_parts(setting, &self.normal, sideways);
        let bound = combine(facet, &quick, f64::INFINITY);
        if bound.error <= self.enough {
            return (bound, f64::INFINITY);
        }
        // Lengths in the facet are those of its image where the image is not distorted.
        let length = &setting.length;
        let longest = (0..3).fold(0, |best, i| if length[i] > length[best] { i } else { best });
        let direction = self.sides[longest] / length[longest];
        let anchor = facet.xyz[(longest + 1) % 3];
        let lengthwise = model(self.pieces, self.centroid, setting, direction, anchor);
        let distortion = distortion(setting, [&sideways[longest], &lengthwise], self.rate);
        // At 1 or more the image may fold over itself, and has no slope.
        if distortion < 1.0 {
            let flat = steepness(&self.normal, setting) + weight_slope(setting, self.rate, self.enough);
            let slope = flat / (1.0 - distortion);
            return (combine(facet, &quick, slope), slope);
        }
        (bound, f64::INFINITY)
    }

    /// A lower bound of what the enclosures allow for the error in the middle of each edge.
    fn least_on_edges(&self) -> [f64; 3] {
        let Modelled { form, cubic } = &self.normal;
        std::array::from_fn(|i| cubic.mid_edge(i) - form.reach_along(self.setting.d[i]) / 8.0)
    }

    /// Steps 3 and 4, from the bound and slope of the steps before.
    fn by_samples(&self, bound: FacetBound, slope: f64) -> FacetBound {
        let Self { bounds, facet, enough, setting, normal, sideways, .. } = self;
        let enough = *enough;
        let weight =
            Modelled::new(Form::weight(self.pieces, self.centroid).divided(setting.least_weight), setting);
        let (mut best, mut samples, mut parts) = (bound, Samples::default(), 4);
        loop {
            samples.look(bounds, facet, setting, &normal.cubic, parts);
            // The weight strays by this share from linear between the points of the lattice.
            let weights = weight.between(setting, parts);
            let found = samples.parts(setting, normal, sideways, weights);
            let bound = combine(facet, &found, slope);
            best.error = best.error.min(bound.error);
            best.edges = std::array::from_fn(|i| best.edges[i].min(bound.edges[i]));
            // What lies between the samples shrinks with the square of their number: stop where even the
            // finest lattice is too coarse.
            let (margin, room) = (bound.error - samples.along, enough - samples.along);
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
            if target > samples.along + normal.between(setting, FINEST) {
                let errors = &mut samples.errors;
                let mut closer = Closer { bounds, facet, setting, normal, weight: &weight, errors };
                return closer_bound(&mut closer, &found, slope, best, parts, target, enough);
            }
            // The shifts are too large, or not known well enough.
            parts = FINEST;
        }
    }
}

/// The surface's coordinate along `w` from `anchor`, times the weight, over the least weight.
fn model(pieces: &[Piece], centroid: DVec2, setting: &Setting, w: DVec3, anchor: DVec3) -> Modelled {
    Modelled::new(Form::new(pieces, centroid, w, anchor).divided(setting.least_weight), setting)
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

/// From the second derivatives alone.
fn quick_parts(setting: &Setting, normal: &Modelled, sideways: &[Modelled; 3]) -> Parts {
    let on_edge =
        |f: &Modelled, i: usize| f.cubic.on_edge(i) + f.form.reach_along(setting.d[i]) / 8.0 + setting.kinks;
    let bends: [f64; 3] = std::array::from_fn(|i| on_edge(&sideways[i], i));
    Parts {
        along: normal.cubic.largest() + normal.form.reach_along(setting.size) / 8.0 + setting.kinks,
        along_edges: std::array::from_fn(|i| on_edge(normal, i)),
        sideways: std::array::from_fn(|i| {
            let Modelled { form, cubic } = &sideways[i];
            // Inside T the other two edges' terms are outweighed by the distance from this edge, unless T is
            // very flat: of the cubic's terms those with λ_i weigh 1 − (1 − λ_i)³ ≤ 3 λ_i.
            let others = 0.5 * (cubic.h[(i + 1) % 3].abs() + cubic.h[(i + 2) % 3].abs())
                + 3.0 * cubic.cubic_part()
                + 0.5 * form.reach_along(setting.size);
            bends[i] + (others - setting.height[i]).max(0.0)
        }),
        bends,
    }
}

/// Joins what was bounded along the normal and sideways.
fn combine(facet: &Facet, parts: &Parts, slope: f64) -> FacetBound {
    let mut error = parts.along;
    let mut edges = parts.along_edges;
    for i in 0..3 {
        let shift = parts.sideways[i];
        let leaning = if slope < 0.5 { parts.along + 2.0 * slope * shift } else { f64::INFINITY };
        error = error.max(leaning.min(math::hypot(parts.along, shift)));
        if facet.sag[i].is_some() {
            // The image of the chord and the boundary curve both lie near the edge, which is convex: so does
            // what is between.
            edges[i] = math::hypot(edges[i], parts.bends[i]);
            error = error.max(edges[i]);
        }
    }
    FacetBound { error, edges }
}
