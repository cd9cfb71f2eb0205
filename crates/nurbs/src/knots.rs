//! Knot insertion, cutting, degree elevation and Bézier pieces of B-spline curves and surfaces.

use crate::homogeneous::{self, Homogeneous};
use crate::{
    BezierCurve, BezierPatch, NurbsCurve, NurbsError, NurbsSurface, Range, UvBox, Vector, basis, blossom,
};

impl<V: Vector> NurbsCurve<V> {
    /// The same curve with the interior knot `t` up to `times` more often, but not more than `degree` times
    /// in all.
    ///
    /// # Errors
    /// [`NurbsError::Weight`] or [`NurbsError::NotFinite`] where weights of both signs make a new weight
    /// vanish.
    pub fn insert_knot(&self, t: f64, times: usize) -> Result<Self, NurbsError> {
        self.refine(&vec![t; times])
    }

    /// The same curve with every knot of the list inserted; those outside the open domain are passed over.
    ///
    /// # Errors
    /// As [`Self::insert_knot`].
    pub fn refine(&self, list: &[f64]) -> Result<Self, NurbsError> {
        let domain = self.domain();
        self.rebuilt(self.degree(), |knots, row| {
            for &t in list {
                let multiplicity = knots.iter().filter(|&&k| k == t).count();
                if t > domain.start && t < domain.end && multiplicity < self.degree() {
                    blossom::insert_knot(self.degree(), knots, row, t);
                }
            }
        })
    }

    /// The part over `range` (cut to the domain) with clamped ends and the same parameters.
    ///
    /// # Errors
    /// [`NurbsError::Unbounded`] where nothing is left of the range; otherwise as [`Self::insert_knot`].
    pub fn piece(&self, range: Range) -> Result<Self, NurbsError> {
        let (a, b) = cut_to(self.domain(), range)?;
        self.rebuilt(self.degree(), |knots, row| blossom::cut(self.degree(), knots, row, a, b))
    }

    /// The same curve with clamped ends.
    ///
    /// # Errors
    /// As [`Self::insert_knot`].
    pub fn clamped(&self) -> Result<Self, NurbsError> {
        self.piece(self.domain())
    }

    /// The parts below and above `t`.
    ///
    /// # Errors
    /// [`NurbsError::Unbounded`] where `t` is not inside the domain; otherwise as [`Self::insert_knot`].
    pub fn split(&self, t: f64) -> Result<(Self, Self), NurbsError> {
        let domain = self.domain();
        Ok((self.piece(Range::new(domain.start, t))?, self.piece(Range::new(t, domain.end))?))
    }

    /// The same curve, one degree higher.
    ///
    /// # Errors
    /// [`NurbsError::Degree`] above degree 99; otherwise as [`Self::insert_knot`].
    pub fn elevated(&self) -> Result<Self, NurbsError> {
        self.rebuilt(self.degree() + 1, |knots, row| {
            (*knots, *row) = blossom::elevate_spline(self.degree(), knots, row);
        })
    }

    fn rebuilt(
        &self,
        degree: usize,
        algorithm: impl FnOnce(&mut Vec<f64>, &mut Vec<Homogeneous<V>>),
    ) -> Result<Self, NurbsError> {
        let mut knots = self.knots().to_vec();
        let mut row = homogeneous::homogeneous(self.points(), self.weights());
        algorithm(&mut knots, &mut row);
        let (points, weights) = homogeneous::projected(row, self.weights().is_some());
        Self::new(degree, knots, points, weights)
    }

    /// Every polynomial piece with the range that it covers.
    pub fn bezier_pieces(&self) -> Vec<(Range, BezierCurve<V>)> {
        self.bezier_pieces_within(Range::ALL)
    }

    /// The polynomial pieces whose span overlaps `within`, whole, each with the range that it covers.
    pub fn bezier_pieces_within(&self, within: Range) -> Vec<(Range, BezierCurve<V>)> {
        let spans = basis::spans_within(self.degree(), self.knots(), cut_hull(self.domain(), within));
        let range = |s: usize| Range::new(self.knots()[s], self.knots()[s + 1]);
        spans.into_iter().map(|s| (range(s), self.bezier_of_span(s, range(s)))).collect()
    }

    /// The part over `range`, which must lie in one span, over 0..=1. A range of no length gives a constant.
    pub fn bezier_over(&self, range: Range) -> BezierCurve<V> {
        let domain = self.domain();
        let (a, b) = (domain.clamp(range.start), domain.clamp(range.end));
        let span = basis::find_span(self.degree(), self.knots(), 0.5 * (a + b));
        self.bezier_of_span(span, Range::new(a.min(b), a.max(b)))
    }

    /// The polynomial of a span as a Bézier curve over `range`.
    pub(crate) fn bezier_of_span(&self, span: usize, range: Range) -> BezierCurve<V> {
        let p = self.degree();
        let weights = self.weights().map(|w| &w[span - p..=span]);
        let mut row = homogeneous::homogeneous(&self.points()[span - p..=span], weights);
        blossom::span_to_bezier(&mut row, &self.knots()[span + 1 - p..=span + p], range.start, range.end);
        BezierCurve::from_homogeneous(row, weights.is_some())
    }
}

impl NurbsSurface {
    /// The polynomial pieces whose spans overlap `within`, u outer and v inner, each with the whole box of
    /// its span.
    pub fn bezier_patches(&self, within: UvBox) -> Vec<(UvBox, BezierPatch)> {
        let domain = self.domain();
        let [p, q] = self.degree();
        let (knots_u, knots_v) = (self.knots_u(), self.knots_v());
        let spans_u = basis::spans_within(p, knots_u, cut_hull(domain.u(), within.u()));
        let spans_v = basis::spans_within(q, knots_v, cut_hull(domain.v(), within.v()));
        let (Some(&first), Some(&last)) = (spans_v.first(), spans_v.last()) else { return Vec::new() };
        let columns = first - q..last + 1;
        let net = homogeneous::homogeneous(self.points(), self.weights());
        let mut patches = Vec::with_capacity(spans_u.len() * spans_v.len());
        for &s in &spans_u {
            let strip = self.strip_to_bezier(&net, s, columns.clone());
            for &t in &spans_v {
                let mut cell = Vec::with_capacity((p + 1) * (q + 1));
                for row in strip.chunks_exact(columns.len()) {
                    let at = cell.len();
                    cell.extend_from_slice(&row[t - q - columns.start..=t - columns.start]);
                    blossom::span_to_bezier(
                        &mut cell[at..],
                        &knots_v[t + 1 - q..=t + q],
                        knots_v[t],
                        knots_v[t + 1],
                    );
                }
                let range = UvBox::from_ranges(
                    Range::new(knots_u[s], knots_u[s + 1]),
                    Range::new(knots_v[t], knots_v[t + 1]),
                );
                patches.push((range, BezierPatch::from_homogeneous([p, q], cell, self.weights().is_some())));
            }
        }
        patches
    }

    /// Rows `s-p..=s` of the net made Bézier along u, for these columns.
    fn strip_to_bezier<T: Vector>(&self, net: &[T], s: usize, columns: std::ops::Range<usize>) -> Vec<T> {
        let p = self.degree()[0];
        let stride = self.counts()[1];
        let knots = self.knots_u();
        let mut strip = vec![T::default(); (p + 1) * columns.len()];
        let mut column = Vec::with_capacity(p + 1);
        for (at, j) in columns.clone().enumerate() {
            column.clear();
            column.extend((s - p..=s).map(|i| net[i * stride + j]));
            blossom::span_to_bezier(&mut column, &knots[s + 1 - p..=s + p], knots[s], knots[s + 1]);
            for (i, &h) in column.iter().enumerate() {
                strip[i * columns.len() + at] = h;
            }
        }
        strip
    }

    /// The part over `within` (cut to the domain) with clamped ends and the same parameters.
    ///
    /// # Errors
    /// [`NurbsError::Unbounded`] where nothing is left of the box; [`NurbsError::Weight`] or
    /// [`NurbsError::NotFinite`] where weights of both signs make a new weight vanish.
    pub fn piece(&self, within: UvBox) -> Result<Self, NurbsError> {
        let (u, v) = (cut_to(self.domain().u(), within.u())?, cut_to(self.domain().v(), within.v())?);
        let [p, q] = self.degree();
        let cut = self.rebuilt_v(q, |knots, row| blossom::cut(q, knots, row, v.0, v.1))?;
        Ok(cut.swapped().rebuilt_v(p, |knots, row| blossom::cut(p, knots, row, u.0, u.1))?.swapped())
    }

    /// The same surface with clamped sides.
    ///
    /// # Errors
    /// As [`Self::piece`].
    pub fn clamped(&self) -> Result<Self, NurbsError> {
        self.piece(self.domain())
    }

    /// The parts below and above u = `t`.
    ///
    /// # Errors
    /// As [`Self::piece`]; `t` must be inside the domain.
    pub fn split_u(&self, t: f64) -> Result<(Self, Self), NurbsError> {
        let UvBox { min, max } = self.domain();
        Ok((
            self.piece(UvBox::new(min, glam::DVec2::new(t, max.y)))?,
            self.piece(UvBox::new(glam::DVec2::new(t, min.y), max))?,
        ))
    }

    /// The parts below and above v = `t`.
    ///
    /// # Errors
    /// As [`Self::piece`]; `t` must be inside the domain.
    pub fn split_v(&self, t: f64) -> Result<(Self, Self), NurbsError> {
        let (below, above) = self.swapped().split_u(t)?;
        Ok((below.swapped(), above.swapped()))
    }

    /// The same surface with the interior knot `t` in v up to `times` more often, at most `degree` times in
    /// all.
    ///
    /// # Errors
    /// As [`Self::piece`].
    pub fn insert_knot_v(&self, t: f64, times: usize) -> Result<Self, NurbsError> {
        let (degree, domain) = (self.degree()[1], self.domain().v());
        let present = self.knots_v().iter().filter(|&&k| k == t).count();
        let times =
            if t > domain.start && t < domain.end { times.min(degree.saturating_sub(present)) } else { 0 };
        self.rebuilt_v(degree, |knots, row| {
            for _ in 0..times {
                blossom::insert_knot(degree, knots, row, t);
            }
        })
    }

    /// The same surface with the interior knot `t` in u up to `times` more often, at most `degree` times in
    /// all.
    ///
    /// # Errors
    /// As [`Self::piece`].
    pub fn insert_knot_u(&self, t: f64, times: usize) -> Result<Self, NurbsError> {
        Ok(self.swapped().insert_knot_v(t, times)?.swapped())
    }

    /// The same surface, one degree higher in v.
    ///
    /// # Errors
    /// [`NurbsError::Degree`] above degree 99; otherwise as [`Self::piece`].
    pub fn elevated_v(&self) -> Result<Self, NurbsError> {
        let degree = self.degree()[1];
        self.rebuilt_v(degree + 1, |knots, row| (*knots, *row) = blossom::elevate_spline(degree, knots, row))
    }

    /// The same surface, one degree higher in u.
    ///
    /// # Errors
    /// [`NurbsError::Degree`] above degree 99; otherwise as [`Self::piece`].
    pub fn elevated_u(&self) -> Result<Self, NurbsError> {
        Ok(self.swapped().elevated_v()?.swapped())
    }

    /// Applies one algorithm on knots and control points to every row along v.
    fn rebuilt_v(
        &self,
        degree: usize,
        algorithm: impl Fn(&mut Vec<f64>, &mut Vec<Homogeneous<glam::DVec3>>),
    ) -> Result<Self, NurbsError> {
        let net = homogeneous::homogeneous(self.points(), self.weights());
        let mut knots = self.knots_v().to_vec();
        let mut rebuilt = Vec::with_capacity(net.len());
        for line in net.chunks_exact(self.counts()[1]) {
            knots = self.knots_v().to_vec();
            let mut row = line.to_vec();
            algorithm(&mut knots, &mut row);
            rebuilt.append(&mut row);
        }
        let (points, weights) = homogeneous::projected(rebuilt, self.weights().is_some());
        Self::new([self.degree()[0], degree], self.knots_u().to_vec(), knots, points, weights)
    }
}

/// The common part of two ranges, which must have a length.
fn cut_to(domain: Range, range: Range) -> Result<(f64, f64), NurbsError> {
    let (a, b) = (domain.clamp(range.start), domain.clamp(range.end));
    if a < b { Ok((a, b)) } else { Err(NurbsError::Unbounded(range.start, range.end)) }
}

/// The range cut to the domain; one of no length is widened to meet the span that it lies in.
fn cut_hull(domain: Range, range: Range) -> Range {
    let (a, b) = (domain.clamp(range.start), domain.clamp(range.end));
    if a < b {
        return Range::new(a, b);
    }
    Range::new(a.next_down(), b.next_up())
}
