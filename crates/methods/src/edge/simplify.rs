//! Polylines with fewer vertices, within a Hausdorff distance.
//!
//! Source: Imai and Iri 1988, the shortest path over shortcuts; Balázs, Guthe, Klein 2004, section 5.1,
//! requires a guaranteed Hausdorff distance and nothing else. A shortcut from vertex i to vertex j is allowed
//! where all vertices between lie within the distance of the segment: distances to a segment are convex, so
//! the stretch between is within it, too, and the nearest points on the segment run from one end to the other
//! without a gap, so the segment is within it of the stretch.
//!
//! Among polylines through a subset of the vertices that keep the ends and whose shortcuts are all allowed
//! and no longer than [`LONGEST`], the result has the fewest vertices.

use chordal_nurbs::{Vector, segment_distance};

/// A shortcut passes over at most this many vertices: it keeps the work linear in the length of the polyline.
const LONGEST: usize = 256;

/// Indices of the vertices that remain, the first and the last among them.
pub fn simplified<V: Vector>(points: &[V], distance: f64) -> Vec<usize> {
    let n = points.len();
    if n < 3 {
        return (0..n).collect();
    }
    let mut links = vec![(usize::MAX, 0); n];
    links[0] = (0, 0);
    for i in 0..n - 1 {
        let reached = links[i].0 + 1;
        for j in i + 1..n.min(i + 1 + LONGEST) {
            if reached < links[j].0 && is_shortcut(&points[i..=j], distance) {
                links[j] = (reached, i);
            }
        }
    }
    let mut kept = vec![n - 1];
    let mut at = n - 1;
    while at != 0 {
        at = links[at].1;
        kept.push(at);
    }
    kept.reverse();
    kept
}

/// All vertices lie within the distance of the segment between the ends.
fn is_shortcut<V: Vector>(points: &[V], distance: f64) -> bool {
    let n = points.len();
    let (first, last) = (points[0], points[n - 1]);
    points[1..n - 1].iter().all(|&p| segment_distance(p, first, last) <= distance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec2;
    use proptest::prelude::*;

    /// The largest distance of samples of one polyline from the other.
    fn one_sided(from: &[DVec2], to: &[DVec2]) -> f64 {
        let samples =
            from.windows(2).flat_map(|w| (0..=20).map(move |k| w[0].lerp(w[1], f64::from(k) / 20.0)));
        samples
            .map(|p| to.windows(2).map(|w| segment_distance(p, w[0], w[1])).fold(f64::INFINITY, f64::min))
            .fold(0.0, f64::max)
    }

    /// The fewest vertices of all subsets, by trying them all.
    fn fewest(points: &[DVec2], distance: f64) -> usize {
        let n = points.len();
        (0u32..1 << (n - 2))
            .filter_map(|bits| {
                let inner = (0..n - 2).filter(|i| bits >> i & 1 == 1).map(|i| i + 1);
                let kept: Vec<usize> = std::iter::once(0).chain(inner).chain([n - 1]).collect();
                let sound = kept.windows(2).all(|w| is_shortcut(&points[w[0]..=w[1]], distance));
                sound.then_some(kept.len())
            })
            .min()
            .unwrap_or(n)
    }

    #[test]
    fn what_is_straight_becomes_one_segment() {
        let points: Vec<DVec2> = (0..50).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
        assert_eq!(simplified(&points, 1e-12), [0, 49]);
        let corner: Vec<DVec2> = [(0., 0.), (1., 0.), (2., 0.), (2., 1.), (2., 2.)].map(DVec2::from).to_vec();
        assert_eq!(simplified(&corner, 0.1), [0, 2, 4]);
    }

    proptest! {
        #[test]
        fn the_hausdorff_distance_holds_and_nothing_is_shorter(
            steps in prop::collection::vec((0.0f64..1.0, -0.5f64..0.5), 3..11),
            distance in 0.01f64..0.6,
        ) {
            let mut at = DVec2::ZERO;
            let points: Vec<DVec2> =
                steps.iter().map(|&(x, y)| { at += DVec2::new(x - 0.2, y); at }).collect();
            let kept = simplified(&points, distance);
            let shorter: Vec<DVec2> = kept.iter().map(|&i| points[i]).collect();
            prop_assert_eq!((kept[0], kept[kept.len() - 1]), (0, points.len() - 1));
            prop_assert!(one_sided(&points, &shorter) <= distance * (1.0 + 1e-9));
            prop_assert!(one_sided(&shorter, &points) <= distance * (1.0 + 1e-9));
            prop_assert_eq!(kept.len(), fewest(&points, distance));
        }
    }
}
