//! Arcs and conics: types 100 and 104.

use super::document::{Doc, Ix, Res};
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{Curve, DVec2, Frame, Range, math};
use std::f64::consts::TAU;

/// Ends nearer than this part of the radius are one: the whole circle is meant.
const FULL: f64 = 1e-7;

/// 100: height, centre, start, end; counter-clockwise.
pub(crate) fn arc(doc: &Doc<'_>, ix: Ix) -> Res<(Curve, Range)> {
    let mut args = doc.open(ix)?;
    let height = args.real()?;
    let mut point = || -> Res<DVec2> { Ok(DVec2::new(args.real()?, args.real()?)) };
    let (center, start, end) = (point()?, point()?, point()?);
    let (from, to) = (start - center, end - center);
    let radius = from.length();
    if !(radius > 0.0) {
        return Err(doc.bad(ix, ReadIssue::BadValue { what: "radius", value: Real(0.0) }));
    }
    let frame = Frame { origin: center.extend(height), ..Frame::WORLD };
    let range = ccw(from.to_angle(), to.to_angle(), start.distance(end) <= FULL * radius);
    Ok((Curve::Circle { frame, radius }, range))
}

/// The angles from one direction counter-clockwise to another.
fn ccw(from: f64, to: f64, full: bool) -> Range {
    let from = from.rem_euclid(TAU);
    let turn = (to - from).rem_euclid(TAU);
    Range::new(from, from + if full || turn == 0.0 { TAU } else { turn })
}

/// A conic in its own axes: `a x² + c y² + d x + e y + f = 0` after a turn.
struct Turned {
    x: DVec2,
    y: DVec2,
    a: f64,
    c: f64,
    d: f64,
    e: f64,
    f: f64,
}

/// 104: A x² + B xy + C y² + D x + E y + F = 0, height, start, end.
pub(crate) fn conic(doc: &Doc<'_>, ix: Ix) -> Res<(Curve, Range)> {
    let mut args = doc.open(ix)?;
    let k = args.reals(6)?;
    let height = args.real()?;
    let mut point = || -> Res<DVec2> { Ok(DVec2::new(args.real()?, args.real()?)) };
    let (start, end) = (point()?, point()?);
    let angle = 0.5 * math::atan2(k[1], k[0] - k[2]);
    let (s, c) = math::sin_cos(angle);
    let (x, y) = (DVec2::new(c, s), DVec2::new(-s, c));
    let quadratic = |v: DVec2| k[0] * v.x * v.x + k[1] * v.x * v.y + k[2] * v.y * v.y;
    let linear = |v: DVec2| k[3] * v.x + k[4] * v.y;
    let turned = Turned { x, y, a: quadratic(x), c: quadratic(y), d: linear(x), e: linear(y), f: k[5] };
    let found = turned.curve(height, start, end);
    found.ok_or_else(|| doc.bad(ix, ReadIssue::NotAConic))
}

impl Turned {
    fn curve(self, height: f64, start: DVec2, end: DVec2) -> Option<(Curve, Range)> {
        let largest = self.a.abs().max(self.c.abs());
        let tiny = 1e-12 * largest;
        let curve = if self.a.abs() <= tiny {
            // c y² + d x + e y + f: along x.
            self.parabola([self.x, self.y], [self.c, self.d, self.e], height, start, end)
        } else if self.c.abs() <= tiny {
            self.parabola([self.y, -self.x], [self.a, self.e, -self.d], height, start, end)
        } else {
            self.central(height, start, end)
        };
        curve.filter(|(_, range)| range.is_finite() && range.start < range.end)
    }

    /// A frame in the plane at a height.
    fn frame(origin: DVec2, x: DVec2, y: DVec2, height: f64) -> Frame {
        let (x, y) = (x.extend(0.0), y.extend(0.0));
        Frame { origin: origin.extend(height), x, y, z: x.cross(y) }
    }

    fn central(&self, height: f64, start: DVec2, end: DVec2) -> Option<(Curve, Range)> {
        let local = DVec2::new(-self.d / (2.0 * self.a), -self.e / (2.0 * self.c));
        let center = self.x * local.x + self.y * local.y;
        let level = self.a * local.x * local.x + self.c * local.y * local.y - self.f;
        let (p, q) = (level / self.a, level / self.c);
        let at = |point: DVec2, x: DVec2, y: DVec2| {
            let d = point - center;
            DVec2::new(d.dot(x), d.dot(y))
        };
        if p > 0.0 && q > 0.0 {
            let (a, b) = (p.sqrt(), q.sqrt());
            let angle = |point| {
                let l = at(point, self.x, self.y);
                math::atan2(l.y / b, l.x / a)
            };
            let frame = Self::frame(center, self.x, self.y, height);
            let range = ccw(angle(start), angle(end), start.distance(end) <= FULL * a.min(b));
            return Some((Curve::Ellipse { frame, a, b }, range));
        }
        if p <= 0.0 && q <= 0.0 {
            return None;
        }
        // The branch on which the start lies, its axis towards it.
        let (axis, a, b) =
            if p > 0.0 { (self.x, p.sqrt(), (-q).sqrt()) } else { (self.y, q.sqrt(), (-p).sqrt()) };
        let x = if (start - center).dot(axis) < 0.0 { -axis } else { axis };
        let mut y = x.perp();
        let mut t = [start, end].map(|point| math::asinh(at(point, x, y).y / b));
        if t[0] > t[1] {
            (y, t) = (-y, [-t[0], -t[1]]);
        }
        let frame = Self::frame(center, x, y, height);
        Some((Curve::Hyperbola { frame, a, b }, Range::new(t[0], t[1])))
    }

    /// `c η² + d ξ + e η + f = 0` with ξ and η along two axes.
    fn parabola(
        &self,
        [along, across]: [DVec2; 2],
        [c, d, e]: [f64; 3],
        height: f64,
        start: DVec2,
        end: DVec2,
    ) -> Option<(Curve, Range)> {
        if c == 0.0 || d == 0.0 {
            return None;
        }
        let eta = -e / (2.0 * c);
        let xi = (c * eta * eta - self.f) / d;
        let origin = along * xi + across * eta;
        // ξ − ξ0 = −c/d (η − η0)² = (η − η0)² / 4f.
        let focal = -d / (4.0 * c);
        let x = along * focal.signum();
        let (mut y, focal) = (across, focal.abs());
        let mut t = [start, end].map(|point| (point - origin).dot(y) / (2.0 * focal));
        if t[0] > t[1] {
            (y, t) = (-y, [-t[0], -t[1]]);
        }
        let frame = Self::frame(origin, x, y, height);
        Some((Curve::Parabola { frame, focal }, Range::new(t[0], t[1])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec3;

    /// The conic through `start` and `end` as the record would give it.
    fn conic_of(k: [f64; 6], start: DVec2, end: DVec2) -> (Curve, Range) {
        let angle = 0.5 * math::atan2(k[1], k[0] - k[2]);
        let (s, c) = math::sin_cos(angle);
        let (x, y) = (DVec2::new(c, s), DVec2::new(-s, c));
        let q = |v: DVec2| k[0] * v.x * v.x + k[1] * v.x * v.y + k[2] * v.y * v.y;
        let l = |v: DVec2| k[3] * v.x + k[4] * v.y;
        let turned = Turned { x, y, a: q(x), c: q(y), d: l(x), e: l(y), f: k[5] };
        turned.curve(2.0, start, end).expect("a conic")
    }

    fn check(k: [f64; 6], start: DVec2, end: DVec2) {
        let (curve, range) = conic_of(k, start, end);
        assert!(curve.point(range.start).distance(start.extend(2.0)) < 1e-12, "{curve:?}");
        assert!(curve.point(range.end).distance(end.extend(2.0)) < 1e-12, "{curve:?}");
        for i in 0..=10 {
            let p: DVec3 = curve.point(range.start + range.length() * f64::from(i) / 10.0);
            let [a, b, c, d, e, f] = k;
            let left = a * p.x * p.x + b * p.x * p.y + c * p.y * p.y + d * p.x + e * p.y + f;
            assert!(left.abs() < 1e-11, "{left} at {p} of {curve:?}");
        }
    }

    #[test]
    fn ellipses_hyperbolas_and_parabolas_anywhere() {
        let at = |f: &dyn Fn(f64) -> DVec2, s: f64, e: f64| (f(s), f(e));
        // (x − 1)²/9 + (y + 2)²/4 = 1.
        let ellipse = |t: f64| DVec2::new(1.0 + 3.0 * math::cos(t), -2.0 + 2.0 * math::sin(t));
        let (s, e) = at(&ellipse, 0.3, 4.0);
        check([4.0, 0.0, 9.0, -8.0, 36.0, 4.0], s, e);
        // xy = 1, both ways along the third quadrant's branch.
        let hyperbola = |t: f64| DVec2::new(-t, -1.0 / t);
        let (s, e) = at(&hyperbola, 0.5, 3.0);
        check([0.0, 1.0, 0.0, 0.0, 0.0, -1.0], s, e);
        check([0.0, 1.0, 0.0, 0.0, 0.0, -1.0], e, s);
        // y = x² − 2x and x = −2y², both ways.
        let (s, e) = (DVec2::new(0.0, 0.0), DVec2::new(3.0, 3.0));
        check([1.0, 0.0, 0.0, -2.0, -1.0, 0.0], s, e);
        check([1.0, 0.0, 0.0, -2.0, -1.0, 0.0], e, s);
        check([0.0, 0.0, 2.0, 1.0, 0.0, 0.0], DVec2::new(-2.0, -1.0), DVec2::new(-8.0, 2.0));
    }
}
