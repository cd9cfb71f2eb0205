//! Triangles restricted by size: none spans more of the plane of parameters than the bound allows.
//!
//! Source: Piegl and Richard 1995, *Tessellating trimmed NURBS surfaces*, who fill faces so that no side of a
//! triangle is longer than the second derivatives allow; Sheng and Hirsch 1992 alike. For a triangle of any
//! shape within a box of sides a and b, linear interpolation of S is off by ½ Σ λᵢ (pᵢ − x)ᵀ H (pᵢ − x) at
//! most, and each mean of squares by at most a quarter of the square of the box, so
//!
//! ```text
//! ‖S − L‖ ≤ ⅛ (a² M_uu + 2ab M_uv + b² M_vv)        as for a cell of that size, see [`super::derivatives`]
//! ```
//!
//! M is estimated here along each side, from the normal parts of the second derivatives at its ends and its
//! middle: one for the whole face would fill flat places as densely as the most curved one. Chords of the
//! loops belong to the edges: a side is too long where it is longer than the triangle's chords, too.

use super::derivatives::SecondNorms;
use super::region::Region;
use chordal_nurbs::DVec2;
use chordal_tessellate::method::{FaceMesh, FaceSurface, NONE};

/// Sides may be off by this many tolerances. Halves of sides that are barely too long would be far too short.
const SLACK: f64 = 1.25;

/// A new point keeps this share of the halved side as distance from a chord.
const BESIDE: f64 = 0.2;

/// A side that is too long for the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oversized {
    /// The middle of the side.
    pub middle: DVec2,
    /// Most of its error comes from what it spans in this direction.
    pub axis: usize,
}

/// The error that second derivatives about there expect of a side, and the direction that most of it comes
/// from.
fn side_error(surface: &FaceSurface<'_>, p: DVec2, q: DVec2) -> (f64, usize) {
    let norms = [p, p.midpoint(q), q].into_iter().fold(SecondNorms::default(), |norms, at| {
        let jet = surface.jet(at);
        let Some(n) = jet.du.cross(jet.dv).try_normalize() else { return norms };
        let [uu, uv, vv] = [jet.duu, jet.duv, jet.dvv].map(|d| d.dot(n).abs());
        norms.max(SecondNorms { uu, uv, vv })
    });
    let span = (q - p).abs();
    let axis = usize::from(span.y * span.y * norms.vv > span.x * span.x * norms.uu);
    (norms.error(span.x, span.y), axis)
}

/// The inner side of a triangle that is most too long, where one is that has room for a point in its middle.
pub fn oversized(face: &FaceMesh<'_, '_>, region: &Region, t: u32, tolerance: f64) -> Option<Oversized> {
    let uv = face.mesh().corners(t);
    let sides = [0, 1, 2].map(|i| [uv[(i + 1) % 3], uv[(i + 2) % 3]]);
    let errors = sides.map(|[p, q]| side_error(face.surface(), p, q));
    let is_chord = face.mesh().neighbors[t as usize].map(|n| n == NONE);
    let of_chords = (0..3).filter(|&i| is_chord[i]).fold(0.0, |m: f64, i| m.max(errors[i].0));
    let limit = SLACK * tolerance.max(of_chords);
    let room = |i: usize| {
        let [p, q] = sides[i];
        region.nearest(p.midpoint(q), (q - p).abs(), BESIDE).is_none()
    };
    let inner = (0..3).filter(|&i| !is_chord[i] && errors[i].0 > limit && room(i));
    let i = inner.max_by(|&i, &j| errors[i].0.total_cmp(&errors[j].0))?;
    Some(Oversized { middle: sides[i][0].midpoint(sides[i][1]), axis: errors[i].1 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::testing::{distance_to_triangle, patch, patches};
    use chordal_nurbs::{DVec3, UvBox};
    use proptest::prelude::*;

    /// z = u²/2 over a triangle that is no half of its box: its lowest side is ⅛ off in its middle, all that
    /// the bound of its box allows.
    #[test]
    fn a_triangle_of_any_shape_reaches_the_bound_of_its_box() {
        // Wide, so that heights are distances.
        let wide = 1e5;
        let rows = [(0.0, 0.0), (0.5, 0.0), (1.0, 0.5)];
        let points = rows.iter().flat_map(|&(u, z)| [0.0, 1.0].map(|v| DVec3::new(wide * u, wide * v, z)));
        let s = patch([2, 1], points.collect(), None);
        let uv = [(0.0, 0.2), (1.0, 0.2), (0.3, 0.2 + 1e-3)].map(DVec2::from);
        let b = UvBox::from_points(uv);
        let bound = SecondNorms::of_surface(&s).error(b.size().x, b.size().y);
        let off = distance_to_triangle(s.point(DVec2::new(0.5, 0.2)), uv.map(|p| s.point(p)));
        assert!((off - 0.125).abs() < 1e-6, "{off}");
        assert!((bound - 0.125).abs() < 1e-12, "{bound}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]
        #[test]
        fn a_triangle_of_any_shape_keeps_the_bound_of_its_box(
            s in patches(),
            corners in prop::array::uniform3((0.0f64..=1.0, 0.0f64..=1.0)),
        ) {
            let (low, size) = (s.domain().min, s.domain().size());
            let uv = corners.map(|c| low + size * DVec2::from(c));
            let b = UvBox::from_points(uv.iter().copied());
            let bound = SecondNorms::of_surface(&s).error(b.size().x, b.size().y);
            let xyz = uv.map(|p| s.point(p));
            for i in 0..=12 {
                for j in 0..=12 - i {
                    let (x, y) = (f64::from(i) / 12.0, f64::from(j) / 12.0);
                    let at = uv[0] + (uv[1] - uv[0]) * x + (uv[2] - uv[0]) * y;
                    let off = distance_to_triangle(s.point(at), xyz);
                    prop_assert!(off <= bound * (1.0 + 1e-9) + 1e-12, "{} > {}", off, bound);
                }
            }
        }
    }
}
