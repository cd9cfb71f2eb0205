//! A free-form curve or surface with its body, as geometry.

use super::basis::{Basis, Direction, Spline};
use crate::trimmed::{Piece, Role, TrimLoop};
use chordal_brep::{ReadIssue, Real, Source};
use chordal_nurbs::{Curve2, DVec2, DVec3, DVec4, NurbsCurve2, NurbsSurface, Range, Surface, UvBox};
use std::sync::Arc;

/// The attributes that elements take from the statements before them.
#[derive(Clone, Debug)]
pub(super) struct Attributes {
    pub basis: Option<Basis>,
    pub rational: bool,
    /// In u and v.
    pub degree: [usize; 2],
    pub step: [usize; 2],
    pub matrix: [Arc<[f64]>; 2],
}

impl Default for Attributes {
    fn default() -> Self {
        let none: Arc<[f64]> = Arc::new([]);
        Self { basis: None, rational: false, degree: [0; 2], step: [0; 2], matrix: [none.clone(), none] }
    }
}

/// A range of a curve of parameter space, by its number from 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurveUse {
    pub start: f64,
    pub end: f64,
    pub curve: usize,
}

/// A loop of a surface's body.
#[derive(Clone, Debug)]
pub(super) struct LoopUse {
    pub hole: bool,
    pub uses: Result<Vec<CurveUse>, ReadIssue>,
    pub source: Source,
}

/// What an element is made of.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// `curv`: loose.
    Curve,
    /// `curv2`: its control points in parameter space with their weights.
    Curve2(Result<Vec<DVec3>, ReadIssue>),
    /// `surf`: its range, and its control points with their weights.
    Surface { range: Option<UvBox>, points: Result<Vec<DVec4>, ReadIssue> },
}

/// An element whose body is being read.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub kind: Kind,
    pub attributes: Attributes,
    pub parameters: [Vec<f64>; 2],
    pub loops: Vec<LoopUse>,
    pub source: Source,
}

impl Element {
    /// The parametric curve of a `curv2` element.
    ///
    /// # Errors
    /// A sentence, where it makes no sense.
    pub(super) fn curve2(&mut self, points: &[DVec3]) -> Result<Curve2, ReadIssue> {
        if self.parameters[0].is_empty() {
            self.parameters[0] = self.default_breaks(points.len())?;
        }
        let rows = points.iter().map(|p| vec![DVec4::new(p.x, p.y, 0.0, p.z)]).collect();
        let spline = self.along(0, rows)?;
        let points: Vec<DVec4> = spline.rows.into_iter().flatten().collect();
        let (points, weights) = self.projected(points);
        let points = points.into_iter().map(DVec3::truncate).collect();
        let curve = NurbsCurve2::new(self.attributes.degree[0], spline.knots, points, weights);
        curve.map(Curve2::Nurbs).map_err(ReadIssue::from)
    }

    /// The surface of a `surf` element over its own range; guesses are passed to `warn`.
    ///
    /// # Errors
    /// A sentence, where it makes no sense.
    pub(super) fn surface(
        &mut self,
        range: Option<UvBox>,
        points: &[DVec4],
        warn: &mut dyn FnMut(ReadIssue),
    ) -> Result<Surface, ReadIssue> {
        let range = range.ok_or(ReadIssue::Missing { what: "parameter range of four numbers" })?;
        for (axis, ends) in [range.u(), range.v()].into_iter().enumerate() {
            if self.parameters[axis].is_empty() {
                if self.attributes.basis == Some(Basis::Bspline) {
                    return Err(ReadIssue::Missing { what: ["knots along u", "knots along v"][axis] });
                }
                warn(ReadIssue::OneSegment { direction: ["u", "v"][axis] });
                self.parameters[axis] = vec![ends.start, ends.end];
            }
        }
        let counts = [self.direction(0)?.control_points()?, self.direction(1)?.control_points()?];
        if counts[0].checked_mul(counts[1]) != Some(points.len()) {
            let [u, v] = counts;
            return Err(ReadIssue::Count {
                what: "control points",
                found: points.len(),
                expected: u.saturating_mul(v),
            });
        }
        // Files run fastest along u.
        let across = |i: usize| (0..counts[1]).map(|j| points[j * counts[0] + i]).collect();
        let along_u = self.along(0, (0..counts[0]).map(across).collect())?;
        let columns = transposed(&along_u.rows);
        let along_v = self.along(1, columns)?;
        let net: Vec<DVec4> = transposed(&along_v.rows).into_iter().flatten().collect();
        let (points, weights) = self.projected(net);
        let degree = self.attributes.degree;
        let nurbs = NurbsSurface::new(degree, along_u.knots, along_v.knots, points, weights)
            .map_err(ReadIssue::from)?;
        Ok(Surface::Nurbs(restricted(nurbs, range, warn)?))
    }

    /// The loop that a `trim` or `hole` statement makes of the curves of the file.
    ///
    /// # Errors
    /// A sentence, where it refers to a curve that is not there.
    pub(super) fn trim(
        trim: &LoopUse,
        curves: &[Result<Curve2, ReadIssue>],
        warn: &mut dyn FnMut(ReadIssue),
    ) -> Result<TrimLoop, ReadIssue> {
        let mut pieces = Vec::new();
        for used in trim.uses.as_ref().map_err(ReadIssue::clone)? {
            pieces.push(piece(used, curves, warn)?);
        }
        let role = if trim.hole { Role::Hole } else { Role::Outer };
        Ok(TrimLoop { pieces, role, source: trim.source })
    }

    fn direction(&self, axis: usize) -> Result<Direction<'_>, ReadIssue> {
        Ok(Direction {
            basis: self.attributes.basis.ok_or(ReadIssue::Missing { what: "cstype statement before it" })?,
            degree: self.attributes.degree[axis],
            parameters: &self.parameters[axis],
            step: self.attributes.step[axis],
            matrix: &self.attributes.matrix[axis],
        })
    }

    /// As a B-spline along one direction; in homogeneous coordinates, where the curve is polynomial.
    fn along(&self, axis: usize, rows: Vec<Vec<DVec4>>) -> Result<Spline, ReadIssue> {
        self.direction(axis)?.spline(rows)
    }

    /// One breakpoint more than there are segments.
    fn default_breaks(&self, points: usize) -> Result<Vec<f64>, ReadIssue> {
        let n = self.attributes.degree[0];
        let segments = match self.attributes.basis {
            Some(Basis::Bezier) => points.saturating_sub(1) / n.max(1),
            Some(Basis::Cardinal) => points.saturating_sub(3),
            Some(Basis::Taylor) => points / (n + 1),
            Some(Basis::Matrix) => points.saturating_sub(n + 1) / self.attributes.step[0].max(1) + 1,
            Some(Basis::Bspline) => return Err(ReadIssue::Missing { what: "knots" }),
            None => return Err(ReadIssue::Missing { what: "cstype statement before it" }),
        };
        Ok((0..=segments).map(|s| s as f64).collect())
    }

    /// Points, and weights where the type is rational.
    fn projected(&self, net: Vec<DVec4>) -> (Vec<DVec3>, Option<Vec<f64>>) {
        if !self.attributes.rational {
            return (net.into_iter().map(DVec4::truncate).collect(), None);
        }
        let weights = net.iter().map(|p| p.w).collect();
        (net.into_iter().map(|p| p.truncate() / p.w).collect(), Some(weights))
    }
}

/// A point with its weight in homogeneous form, as rational types use it; others leave the weight out of
/// account.
pub(super) fn homogeneous(point: DVec3, weight: f64, rational: bool) -> DVec4 {
    if rational { (point * weight).extend(weight) } else { point.extend(1.0) }
}

fn transposed(rows: &[Vec<DVec4>]) -> Vec<Vec<DVec4>> {
    let width = rows.first().map_or(0, Vec::len);
    (0..width).map(|j| rows.iter().map(|row| row[j]).collect()).collect()
}

/// Ranges that go beyond the domain by less than this share of it mean its end.
const ROUNDING: f64 = 1e-9;

/// The surface over the range that the element states; what lies beyond the domain is no part of it.
fn restricted(
    nurbs: NurbsSurface,
    range: UvBox,
    warn: &mut dyn FnMut(ReadIssue),
) -> Result<NurbsSurface, ReadIssue> {
    let domain = nurbs.domain();
    let cut = UvBox::new(domain.clamp(range.min), domain.clamp(range.max));
    let size = domain.size();
    let beyond = ((range.min - cut.min).abs() / size).max((range.max - cut.max).abs() / size).max_element();
    if beyond > ROUNDING {
        let axis = if (range.u().start, range.u().end) == (cut.u().start, cut.u().end) {
            range.v()
        } else {
            range.u()
        };
        warn(ReadIssue::RangeCut { start: Real(axis.start), end: Real(axis.end) });
    }
    if (cut.size() / size).min_element() <= ROUNDING {
        return Err(ReadIssue::OutsideDomain);
    }
    if cut == domain { Ok(nurbs) } else { nurbs.piece(cut).map_err(ReadIssue::from) }
}

/// A curve over a range; a greater start runs it backwards.
fn piece(
    used: &CurveUse,
    curves: &[Result<Curve2, ReadIssue>],
    warn: &mut dyn FnMut(ReadIssue),
) -> Result<Piece, ReadIssue> {
    let number = used.curve;
    let curve = match number.checked_sub(1).and_then(|i| curves.get(i)) {
        Some(Ok(curve)) => curve,
        Some(Err(why)) => return Err(why.clone().within("trim curve", number)),
        None => return Err(ReadIssue::NotFound { what: "trim curve", number: number as i64 }),
    };
    let domain = curve.domain();
    let (a, b) = (domain.clamp(used.start), domain.clamp(used.end));
    if (a - used.start).abs().max((b - used.end).abs()) > ROUNDING * domain.length() {
        let cut = ReadIssue::RangeCut { start: Real(used.start), end: Real(used.end) };
        warn(cut.within("trim curve", number));
    }
    let range = Range::new(a.min(b), a.max(b));
    if range.length() <= ROUNDING * domain.length() {
        return Err(ReadIssue::EmptyRange { start: Real(used.start), end: Real(used.end) }
            .within("trim curve", number));
    }
    Ok(Piece { curve: Arc::new(curve.clone()), range, forward: used.start <= used.end })
}

/// A control point of parameter space with its weight.
pub(super) fn homogeneous2(point: DVec2, weight: f64, rational: bool) -> DVec3 {
    if rational { (point * weight).extend(weight) } else { point.extend(1.0) }
}
