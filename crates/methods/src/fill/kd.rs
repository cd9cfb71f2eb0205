//! Cuts in one direction at a time: kd-tree and binary subdivision.
//!
//! Source: Balázs, Guthe, Klein 2004, section 5.2. The worst point is the control point (k, l) farthest from
//! the bilinear surface through the node's corners, at the parameters (ξ_k, η_l).
//!
//! ```text
//! kd-tree   the line u = ξ_k or v = η_l that leaves the node's halves closer to S(ξ_k, η_l) gives the
//!           direction; the cut lies there, or half way
//! binary    the direction in which lines of the net bend more; the cut lies half way, or where they bend
//!           most
//! ```
//!
//! The paper leaves the direction of its binary subdivision open; bending more is what its Figure 2 shows.

use super::Cut;
use super::cells::{Rule, Split};
use super::node::{Bilinear, Flatness, Measure};
use chordal_nurbs::{DVec2, NurbsSurface};

/// The kd-tree.
#[derive(Clone, Copy, Debug)]
pub struct Kd(pub Cut);

/// Binary subdivision.
#[derive(Clone, Copy, Debug)]
pub struct Binary(pub Cut);

/// Cuts nearer to a side than this share of the node would leave a part that changes nothing.
const SIDE: f64 = 1e-3;

impl Rule for Kd {
    fn name(&self) -> &'static str {
        match self.0 {
            Cut::Midpoint => "kd-tree cells, cut half way",
            Cut::WorstPoint => "kd-tree cells, cut at the worst point",
        }
    }

    fn cuts(&self, piece: &NurbsSurface, tolerance: f64, measure: Measure) -> Vec<Split> {
        let flatness = Flatness::new(piece, measure);
        if flatness.error <= tolerance {
            return Vec::new();
        }
        let Some(axis) = nearer_line(piece, &flatness) else { return vec![across_longer_side(piece)] };
        let at = match self.0 {
            Cut::Midpoint => piece.domain().center()[axis],
            Cut::WorstPoint => flatness.worst[axis],
        };
        vec![Split { axis, at }]
    }
}

impl Rule for Binary {
    fn name(&self) -> &'static str {
        match self.0 {
            Cut::Midpoint => "binary cells, cut half way",
            Cut::WorstPoint => "binary cells, cut where they bend most",
        }
    }

    fn cuts(&self, piece: &NurbsSurface, tolerance: f64, measure: Measure) -> Vec<Split> {
        let flatness = Flatness::new(piece, measure);
        if flatness.error <= tolerance {
            return Vec::new();
        }
        let [u, v] = flatness.bend;
        let axis = usize::from(v.0 > u.0);
        let (bend, worst) = flatness.bend[axis];
        if bend <= 1e-9 * flatness.error {
            return vec![across_longer_side(piece)];
        }
        let at = match self.0 {
            Cut::WorstPoint if is_inside(piece, axis, worst) => worst,
            _ => piece.domain().center()[axis],
        };
        vec![Split { axis, at }]
    }
}

/// The direction whose line through the worst point, once it is a border of cells, passes nearer to the
/// surface there.
fn nearer_line(piece: &NurbsSurface, flatness: &Flatness) -> Option<usize> {
    let domain = piece.domain();
    let w = flatness.worst;
    if flatness.bilinear <= 1e-9 * flatness.error {
        return None;
    }
    let t = (w - domain.min) / domain.size();
    let on_surface = piece.point(w);
    let off = |axis: usize| {
        if !is_inside(piece, axis, w[axis]) {
            return f64::INFINITY;
        }
        let (mut a, mut b) = (w, w);
        a[1 - axis] = domain.min[1 - axis];
        b[1 - axis] = domain.max[1 - axis];
        piece.point(a).lerp(piece.point(b), t[1 - axis]).distance(on_surface)
    };
    let off = [off(0), off(1)];
    match off {
        [u, v] if u.is_infinite() && v.is_infinite() => None,
        [u, v] => Some(usize::from(v < u)),
    }
}

fn is_inside(piece: &NurbsSurface, axis: usize, t: f64) -> bool {
    let domain = piece.domain();
    let margin = SIDE * domain.size()[axis];
    t > domain.min[axis] + margin && t < domain.max[axis] - margin
}

/// Half way across the direction in which the corners lie farther apart: what a node needs that is only
/// twisted.
pub fn across_longer_side(piece: &NurbsSurface) -> Split {
    let domain = piece.domain();
    let bilinear = Bilinear::new(piece);
    let c = |x: f64, y: f64| bilinear.at(domain.min + domain.size() * DVec2::new(x, y));
    let along_u = c(0., 0.).distance(c(1., 0.)).max(c(0., 1.).distance(c(1., 1.)));
    let along_v = c(0., 0.).distance(c(0., 1.)).max(c(1., 0.).distance(c(1., 1.)));
    let axis = usize::from(along_v > along_u);
    Split { axis, at: domain.center()[axis] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::testing::patches;
    use chordal_nurbs::DVec3;
    use proptest::strategy::{Strategy, ValueTree};
    use proptest::test_runner::TestRunner;

    /// z = height(u) on degree (3, 1), u and x equal.
    fn sheet(heights: [f64; 4], swap: bool) -> NurbsSurface {
        let points =
            (0..4).flat_map(|i| [0.0, 1.0].map(|v| DVec3::new(i as f64 / 3.0, v, heights[i]))).collect();
        let s = NurbsSurface::new(
            [3, 1],
            vec![0., 0., 0., 0., 1., 1., 1., 1.],
            vec![0., 0., 1., 1.],
            points,
            None,
        )
        .expect("valid");
        if swap { s.swapped() } else { s }
    }

    #[test]
    fn a_sheet_is_cut_across_its_bend_at_its_worst_point() {
        for swap in [false, true] {
            let piece = sheet([0.0, 0.0, 1.0, 0.0], swap);
            let axis = usize::from(swap);
            let third = 2.0 / 3.0;
            for (rule, at) in [
                (&Kd(Cut::WorstPoint) as &dyn Rule, third),
                (&Kd(Cut::Midpoint), 0.5),
                (&Binary(Cut::WorstPoint), third),
                (&Binary(Cut::Midpoint), 0.5),
            ] {
                let cuts = rule.cuts(&piece, 0.1, Measure::Conservative);
                assert_eq!(cuts.len(), 1);
                assert_eq!(cuts[0].axis, axis, "{}", rule.name());
                assert!((cuts[0].at - at).abs() < 1e-12, "{}", rule.name());
                assert!(rule.cuts(&piece, 2.0, Measure::Conservative).is_empty());
            }
        }
    }

    /// DESIGN 4: the worst point is argmax ‖P_kl − B(k/m, l/n)‖; it is cut at k/m or at l/n, whichever line,
    /// once it is a border of two nodes, has its bilinear approximation nearer to S(k/m, l/n).
    #[test]
    fn the_worst_point_and_the_direction_are_the_documents() {
        let mut runner = TestRunner::deterministic();
        let (mut seen, mut along) = (0, [0, 0]);
        while seen < 400 {
            let piece = patches().new_tree(&mut runner).expect("a patch").current();
            let [m, n] = piece.degree();
            if piece.weights().is_some() || m < 2 || n < 2 {
                continue;
            }
            seen += 1;
            let p = piece.points();
            let corner = |i: usize, j: usize| p[i * m * (n + 1) + j * n];
            let bilinear = |u: f64, v: f64| {
                (corner(0, 0) * (1.0 - v) + corner(0, 1) * v) * (1.0 - u)
                    + (corner(1, 0) * (1.0 - v) + corner(1, 1) * v) * u
            };
            let at = |k: usize| [(k / (n + 1)) as f64 / m as f64, (k % (n + 1)) as f64 / n as f64];
            let off = |k: &usize| p[*k].distance(bilinear(at(*k)[0], at(*k)[1]));
            let worst = (0..p.len()).max_by(|a, b| off(a).total_cmp(&off(b))).expect("points");
            let [u, v] = at(worst);
            let s = |u: f64, v: f64| piece.point(DVec2::new(u, v));
            // The border's bilinear approximation is the chord between its ends on the surface.
            let by_u = s(u, 0.0).lerp(s(u, 1.0), v).distance(s(u, v));
            let by_v = s(0.0, v).lerp(s(1.0, v), u).distance(s(u, v));
            let inside = |t: f64| t > SIDE && t < 1.0 - SIDE;
            let axis = match (inside(u), inside(v)) {
                (true, false) => 0,
                (false, true) => 1,
                _ => usize::from(by_v < by_u),
            };
            along[axis] += 1;
            let cuts = Kd(Cut::WorstPoint).cuts(&piece, 1e-9, Measure::Conservative);
            assert_eq!(cuts.len(), 1);
            assert_eq!(cuts[0].axis, axis);
            assert!((cuts[0].at - [u, v][axis]).abs() < 1e-12);
        }
        assert!(along[0] > 50 && along[1] > 50, "{along:?}");
    }

    #[test]
    fn a_twisted_node_without_bend_is_cut_across_its_longer_side() {
        let points = vec![DVec3::ZERO, DVec3::Y, DVec3::X * 3.0, DVec3::new(3.0, 1.0, 1.0)];
        let knots = || vec![0., 0., 1., 1.];
        let piece = NurbsSurface::new([1, 1], knots(), knots(), points, None).expect("valid");
        for rule in [&Kd(Cut::WorstPoint) as &dyn Rule, &Binary(Cut::WorstPoint)] {
            assert_eq!(rule.cuts(&piece, 0.1, Measure::Conservative), [Split { axis: 0, at: 0.5 }]);
        }
    }
}
