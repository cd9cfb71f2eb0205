//! A free-form curve or surface with its body, as geometry.

use super::basis::{Basis, Direction, Spline};
use crate::trimmed::{Piece, Role, TrimLoop};
use chordal_brep::Source;
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
    pub uses: Result<Vec<CurveUse>, String>,
    pub source: Source,
}

/// What an element is made of.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// `curv`: loose.
    Curve,
    /// `curv2`: its control points in parameter space with their weights.
    Curve2(Result<Vec<DVec3>, String>),
    /// `surf`: its range, and its control points with their weights.
    Surface { range: Option<UvBox>, points: Result<Vec<DVec4>, String> },
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
    pub(super) fn curve2(&mut self, points: &[DVec3]) -> Result<Curve2, String> {
        if self.parameters[0].is_empty() {
            self.parameters[0] = self.default_breaks(points.len())?;
        }
        let rows = points.iter().map(|p| vec![DVec4::new(p.x, p.y, 0.0, p.z)]).collect();
        let spline = self.along(0, rows)?;
        let points: Vec<DVec4> = spline.rows.into_iter().flatten().collect();
        let (points, weights) = self.projected(points);
        let points = points.into_iter().map(DVec3::truncate).collect();
        let curve = NurbsCurve2::new(self.attributes.degree[0], spline.knots, points, weights);
        curve.map(Curve2::Nurbs).map_err(|e| e.to_string())
    }

    /// The surface of a `surf` element over its own range; what was guessed is told to `warn`.
    ///
    /// # Errors
    /// A sentence, where it makes no sense.
    pub(super) fn surface(
        &mut self,
        range: Option<UvBox>,
        points: &[DVec4],
        warn: &mut dyn FnMut(String),
    ) -> Result<Surface, String> {
        let range = range.ok_or("its parameter range is not four numbers")?;
        for (axis, ends) in [range.u(), range.v()].into_iter().enumerate() {
            if self.parameters[axis].is_empty() {
                if self.attributes.basis == Some(Basis::Bspline) {
                    return Err(format!("it has no knots in {}", ["u", "v"][axis]));
                }
                warn(format!("it has no parameters in {}: one segment is meant", ["u", "v"][axis]));
                self.parameters[axis] = vec![ends.start, ends.end];
            }
        }
        let counts = [self.direction(0)?.control_points()?, self.direction(1)?.control_points()?];
        if counts[0].checked_mul(counts[1]) != Some(points.len()) {
            let [u, v] = counts;
            return Err(format!("{} control points where its parameters need {u} × {v}", points.len()));
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
            .map_err(|e| e.to_string())?;
        Ok(Surface::Nurbs(restricted(nurbs, range, warn)?))
    }

    /// The loop that a `trim` or `hole` statement makes of the curves of the file.
    ///
    /// # Errors
    /// A sentence, where it refers to a curve that is not there.
    pub(super) fn trim(
        trim: &LoopUse,
        curves: &[Result<Curve2, String>],
        warn: &mut dyn FnMut(String),
    ) -> Result<TrimLoop, String> {
        let mut pieces = Vec::new();
        for used in trim.uses.as_ref().map_err(String::clone)? {
            pieces.push(piece(used, curves, warn)?);
        }
        let role = if trim.hole { Role::Hole } else { Role::Outer };
        Ok(TrimLoop { pieces, role, source: trim.source })
    }

    fn direction(&self, axis: usize) -> Result<Direction<'_>, String> {
        Ok(Direction {
            basis: self.attributes.basis.ok_or("no cstype statement comes before it")?,
            degree: self.attributes.degree[axis],
            parameters: &self.parameters[axis],
            step: self.attributes.step[axis],
            matrix: &self.attributes.matrix[axis],
        })
    }

    /// As a B-spline along one direction; in homogeneous coordinates, where the curve is polynomial.
    fn along(&self, axis: usize, rows: Vec<Vec<DVec4>>) -> Result<Spline, String> {
        self.direction(axis)?.spline(rows)
    }

    /// One breakpoint more than there are segments.
    fn default_breaks(&self, points: usize) -> Result<Vec<f64>, String> {
        let n = self.attributes.degree[0];
        let segments = match self.attributes.basis {
            Some(Basis::Bezier) => points.saturating_sub(1) / n.max(1),
            Some(Basis::Cardinal) => points.saturating_sub(3),
            Some(Basis::Taylor) => points / (n + 1),
            Some(Basis::Matrix) => points.saturating_sub(n + 1) / self.attributes.step[0].max(1) + 1,
            Some(Basis::Bspline) => return Err("it has no knots".into()),
            None => return Err("no cstype statement comes before it".into()),
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

/// A point with its weight in homogeneous form, as rational types use it; others leave the weight out of account.
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
    warn: &mut dyn FnMut(String),
) -> Result<NurbsSurface, String> {
    let domain = nurbs.domain();
    let cut = UvBox::new(domain.clamp(range.min), domain.clamp(range.max));
    let size = domain.size();
    let beyond = ((range.min - cut.min).abs() / size).max((range.max - cut.max).abs() / size).max_element();
    if beyond > ROUNDING {
        let (r, d) = (range, domain);
        warn(format!("its range {} {} is cut to its domain {} {}", r.min, r.max, d.min, d.max));
    }
    if (cut.size() / size).min_element() <= ROUNDING {
        return Err(format!("its range {} {} spans none of its domain", range.min, range.max));
    }
    if cut == domain { Ok(nurbs) } else { nurbs.piece(cut).map_err(|e| e.to_string()) }
}

/// A curve over a range; a greater start runs it backwards.
fn piece(
    used: &CurveUse,
    curves: &[Result<Curve2, String>],
    warn: &mut dyn FnMut(String),
) -> Result<Piece, String> {
    let number = used.curve;
    let curve = match number.checked_sub(1).and_then(|i| curves.get(i)) {
        Some(Ok(curve)) => curve,
        Some(Err(why)) => return Err(format!("its trim uses curve {number}: {why}")),
        None => {
            return Err(format!("its trim uses curve {number}, and there are {} before it", curves.len()));
        }
    };
    let domain = curve.domain();
    let (a, b) = (domain.clamp(used.start), domain.clamp(used.end));
    if (a - used.start).abs().max((b - used.end).abs()) > ROUNDING * domain.length() {
        let (s, e, d) = (used.start, used.end, domain);
        warn(format!("its trim uses curve {number} over {s}..{e}, cut to its domain {}..{}", d.start, d.end));
    }
    let range = Range::new(a.min(b), a.max(b));
    if range.length() <= ROUNDING * domain.length() {
        return Err(format!("its trim uses curve {number} over {}..{}", used.start, used.end));
    }
    Ok(Piece { curve: Arc::new(curve.clone()), range, forward: used.start <= used.end })
}

/// A control point of parameter space with its weight.
pub(super) fn homogeneous2(point: DVec2, weight: f64, rational: bool) -> DVec3 {
    if rational { (point * weight).extend(weight) } else { point.extend(1.0) }
}
