//! Spans along which a surface stands still.
//!
//! Some programs write nets in which the same control points follow each other so often that a whole span of
//! the parameter is one line of the surface. There a mesh could only have triangles without area. Without
//! these spans the surface is the same set of points.

use super::NurbsSurface;
use crate::{Range, UvBox};

/// Control points nearer together than this part of the net's size are the same point.
const SAME_POINT: f64 = 1e-12;

impl NurbsSurface {
    /// The same points without spans of u and of v along which nothing moves; behind such a span the
    /// parameter is less by its length. `None` where there is none, or where nothing else is left.
    pub fn without_still_spans(&self) -> Option<Self> {
        let along_v = self.without_still_spans_v();
        let swapped = along_v.as_ref().unwrap_or(self).swapped();
        match swapped.without_still_spans_v() {
            Some(both) => Some(both.swapped()),
            None => along_v,
        }
    }

    fn without_still_spans_v(&self) -> Option<Self> {
        let mut kept = self.clone();
        let mut removed = false;
        while let Some(span) = kept.still_span_v() {
            kept = kept.without_v(span)?;
            removed = true;
        }
        removed.then_some(kept)
    }

    /// The first span of v along which no point moves.
    fn still_span_v(&self) -> Option<Range> {
        let tolerance = SAME_POINT * self.net_size();
        let row = |i: usize| i * self.count_v;
        let stands_still = |k: usize| {
            (0..self.count_u).all(|i| {
                let columns = row(i) + k - self.degree_v..=row(i) + k;
                let (first, mut rest) = (*columns.start(), columns);
                rest.all(|j| {
                    let same_weight = self.weights.as_ref().is_none_or(|w| w[j] == w[first]);
                    self.points[j].distance(self.points[first]) <= tolerance && same_weight
                })
            })
        };
        (self.degree_v..self.count_v)
            .filter(|&k| self.knots_v[k] < self.knots_v[k + 1])
            .find(|&k| stands_still(k))
            .map(|k| Range::new(self.knots_v[k], self.knots_v[k + 1]))
    }

    /// The surface before a span of v, joined with the surface behind it.
    fn without_v(&self, span: Range) -> Option<Self> {
        let domain = self.domain();
        let part = |from: f64, to: f64| {
            let uv = UvBox::from_ranges(domain.u(), Range::new(from, to));
            (from < to).then(|| self.piece(uv).ok()).flatten()
        };
        let before = part(domain.min.y, span.start);
        let behind = part(span.end, domain.max.y);
        let (before, behind) = match (before, behind) {
            (Some(before), Some(behind)) => (before, behind),
            (one, other) => return one.or(other),
        };
        let mut knots_v = before.knots_v.clone();
        knots_v.pop();
        knots_v.extend(behind.knots_v[self.degree_v + 1..].iter().map(|t| t - span.length()));
        let mut points = Vec::new();
        let mut weights = Vec::new();
        for i in 0..before.count_u {
            let first = i * before.count_v..(i + 1) * before.count_v;
            // The joint is the last column of the one and the first of the other.
            let second = i * behind.count_v + 1..(i + 1) * behind.count_v;
            points.extend_from_slice(&before.points[first.clone()]);
            points.extend_from_slice(&behind.points[second.clone()]);
            for (part, range) in [(&before, first), (&behind, second)] {
                match &part.weights {
                    Some(w) => weights.extend_from_slice(&w[range]),
                    None => weights.extend(range.map(|_| 1.0)),
                }
            }
        }
        let degree = [self.degree_u, self.degree_v];
        Self::new(degree, before.knots_u, knots_v, points, Some(weights)).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};

    /// Three parabolas over two rows; the middle one stands still in both.
    fn surface(second_row_moves: bool) -> NurbsSurface {
        let along = [0.0, 0.5, 1.0, 1.0, 1.0, 1.5, 2.0];
        let mut points: Vec<DVec3> = along.iter().map(|&y| DVec3::new(0.0, y, y * y)).collect();
        points.extend(along.iter().map(|&y| DVec3::new(1.0, y, 0.0)));
        if second_row_moves {
            points[along.len() + 3].z = 0.1;
        }
        let knots_v = vec![0.0, 0.0, 0.0, 1.0, 1.0, 4.0, 4.0, 5.0, 5.0, 5.0];
        NurbsSurface::new([1, 2], vec![0.0, 0.0, 1.0, 1.0], knots_v, points, None).expect("a surface")
    }

    #[test]
    fn a_span_that_stands_still_is_left_out() {
        let old = surface(false);
        let new = old.without_still_spans().expect("one span is left out");
        assert_eq!(new.knots_v(), [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
        for k in 0..=20 {
            let v = f64::from(k) * 0.1;
            let before = if v <= 1.0 { v } else { v + 3.0 };
            let [p, q] = [(&old, before), (&new, v)].map(|(s, v)| s.point(DVec2::new(0.3, v)));
            assert!(p.distance(q) < 1e-12, "{v}: {p} {q}");
        }
        assert!(new.without_still_spans().is_none());
        let across = old.swapped().without_still_spans().expect("the same along u");
        assert_eq!(across.swapped().points(), new.points());
    }

    #[test]
    fn a_span_in_which_one_row_moves_stays() {
        assert!(surface(true).without_still_spans().is_none());
    }
}
