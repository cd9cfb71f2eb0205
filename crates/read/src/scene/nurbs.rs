//! Spline surfaces and curves from nets of homogeneous control points, u running fastest.

use super::knots::{Direction, direction};
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve2, DVec2, DVec3, DVec4, NurbsCurve2, NurbsSurface};

/// Control points nearer together than this share of the net's size are one: files hold 32-bit numbers.
const ONE_POINT: f64 = 1e-6;

/// The rounding of six digits, as a fraction of the net's size, and a little more for weights of six digits.
const ROUNDED: f64 = 4e-6;

/// A control net as a node gives it; points are (wx, wy, wz, w).
#[derive(Debug)]
pub(crate) struct Net<'a> {
    pub points: Vec<DVec4>,
    pub counts: [usize; 2],
    pub orders: [usize; 2],
    pub knots: [&'a [f64]; 2],
    /// The node calls the direction closed.
    pub closed: [bool; 2],
}

/// Makes points homogeneous: `points` are already multiplied by their weights, as X3D, VRML and GLU have it.
/// Weights that are not one for each point are not used.
pub(crate) fn weighted(points: &[DVec3], weights: &[f64]) -> Vec<DVec4> {
    let all = weights.len() == points.len();
    points.iter().enumerate().map(|(i, p)| p.extend(if all { weights[i] } else { 1.0 })).collect()
}

/// The surface of a net, and what was repaired.
///
/// # Errors
/// Where the net makes no surface.
pub(crate) fn surface(net: &Net<'_>) -> Result<(NurbsSurface, Vec<ReadIssue>), ReadIssue> {
    let [count_u, count_v] = net.counts;
    let needed = count_u.checked_mul(count_v).filter(|&n| n > 0).ok_or(ReadIssue::TooFew {
        what: "control points",
        found: 0,
        least: 1,
    })?;
    if net.points.len() < needed {
        return Err(ReadIssue::TooFew { what: "control points", found: net.points.len(), least: needed });
    }
    let at = |i: usize, j: usize| net.points[j * count_u + i];
    let same = same_points(&net.points[..needed]);
    let meets_u = (0..count_v).all(|j| same(at(0, j), at(count_u - 1, j)));
    let meets_v = (0..count_u).all(|i| same(at(i, 0), at(i, count_v - 1)));
    let mut notes = Vec::new();
    let mut along = |axis: usize, meets: bool| -> Result<Direction, ReadIssue> {
        let closed = net.closed[axis] && meets;
        let found = direction(net.counts[axis], net.orders[axis], net.knots[axis], closed)?;
        note_knots(&found, net.knots[axis].len(), ["u", "v"][axis], &mut notes);
        Ok(found)
    };
    let (u, v) = (along(0, meets_u)?, along(1, meets_v)?);
    // The first point is the last one, too: what follows it comes next.
    let wrapped = |k: usize, count: usize| if k < count { k } else { k - count + 1 };
    let mut points = Vec::with_capacity((count_u + u.wrapped) * (count_v + v.wrapped));
    for i in 0..count_u + u.wrapped {
        for j in 0..count_v + v.wrapped {
            points.push(at(wrapped(i, count_u), wrapped(j, count_v)));
        }
    }
    let weights: Vec<f64> = points.iter().map(|p| p.w).collect();
    let mut points: Vec<DVec3> = points.into_iter().map(|p| p.truncate() / p.w).collect();
    join_rounded(&mut points, &[&u, &v]);
    let surface = NurbsSurface::new([u.degree, v.degree], u.knots, v.knots, points, Some(weights))
        .map_err(ReadIssue::from)?;
    Ok((surface, notes))
}

/// Files of these formats hold about six digits. Sides that differ by less than six digits can express are
/// meant to be one point (a pole), or to meet: they are made to.
fn join_rounded(points: &mut [DVec3], directions: &[&Direction; 2]) {
    let size = points.iter().fold(0.0, |d: f64, p| d.max((*p - points[0]).abs().max_element()));
    let near = |a: DVec3, b: DVec3| (a - b).abs().max_element() <= ROUNDED * size;
    let counts = directions.map(|d| d.knots.len() - d.degree - 1);
    for axis in 0..2 {
        let Direction { degree, knots, .. } = directions[axis];
        let same = |knots: &[f64]| knots.windows(2).all(|k| k[0] == k[1]);
        let clamped = [same(&knots[1..=*degree]), same(&knots[counts[axis]..counts[axis] + degree])];
        let along = counts[1 - axis];
        let at = |side: usize, k: usize| {
            let row = if side == 0 { 0 } else { counts[axis] - 1 };
            if axis == 0 { row * counts[1] + k } else { k * counts[1] + row }
        };
        for side in (0..2).filter(|&side| clamped[side]) {
            let first = points[at(side, 0)];
            if (0..along).all(|k| near(points[at(side, k)], first)) {
                (0..along).for_each(|k| points[at(side, k)] = first);
            }
        }
        if clamped == [true; 2] && (0..along).all(|k| near(points[at(0, k)], points[at(1, k)])) {
            (0..along).for_each(|k| points[at(1, k)] = points[at(0, k)]);
        }
    }
}

/// A curve of parameter space; points are (wx, wy, w).
///
/// # Errors
/// Where they make no curve.
pub(crate) fn curve2(
    points: &[DVec3],
    order: usize,
    knots: &[f64],
    closed: bool,
    notes: &mut Vec<ReadIssue>,
) -> Result<Curve2, ReadIssue> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return Err(ReadIssue::TooFew { what: "control points", found: 0, least: 1 });
    };
    let homogeneous: Vec<DVec4> = points.iter().map(|p| p.extend(0.0)).collect();
    let closed = closed && same_points(&homogeneous)(first.extend(0.0), last.extend(0.0));
    let found = direction(points.len(), order, knots, closed)?;
    note_knots(&found, knots.len(), "curve", notes);
    let all = || points.iter().chain(&points[1..=found.wrapped]);
    let weights = all().map(|p| p.z).collect();
    let cartesian = all().map(|p| DVec2::new(p.x, p.y) / p.z).collect();
    let curve = NurbsCurve2::new(found.degree, found.knots.clone(), cartesian, Some(weights));
    curve.map(Curve2::Nurbs).map_err(ReadIssue::from)
}

fn note_knots(found: &Direction, given: usize, which: &'static str, notes: &mut Vec<ReadIssue>) {
    if found.replaced {
        let needed = found.knots.len() - found.wrapped;
        notes.push(ReadIssue::KnotsReplaced { which, found: given, expected: needed });
    }
}

/// Compares points against the size of their net.
fn same_points(points: &[DVec4]) -> impl Fn(DVec4, DVec4) -> bool + use<> {
    let size = points.iter().fold(0.0, |d: f64, p| d.max((*p - points[0]).abs().max_element()));
    move |a, b| (a - b).abs().max_element() <= ONE_POINT * size
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::Surface;

    #[test]
    fn poles_and_seams_of_six_digits_are_exact() {
        // A ring at each of three heights, the outer ones points but for rounding; the last column off by
        // rounding.
        let off = |i: usize, j: usize| 1e-6 * ((3 * i + 5 * j) % 4) as f64;
        let ring = [[1., 0.], [1., 1.], [-1., 1.], [-1., -1.], [1., -1.], [1., 0.]];
        let mut points = Vec::new();
        for j in 0..3 {
            for (i, [x, y]) in ring.iter().enumerate() {
                let r = if j == 1 { 1.0 } else { 0.0 };
                points.push(DVec4::new(x * r + off(i, j), y * r - off(j, i), j as f64, 1.0));
            }
        }
        let net = Net { points, counts: [6, 3], orders: [3, 3], knots: [&[], &[]], closed: [false; 2] };
        let surface = Surface::Nurbs(surface(&net).unwrap().0);
        assert!(surface.periods()[0].is_some() && surface.periods()[1].is_none());
        assert_eq!(surface.poles().len(), 2);
    }

    #[test]
    fn what_differs_by_more_than_rounding_stays() {
        let ring = [[1., 0.], [1., 1.], [-1., 1.], [-1., -1.], [1., -1.], [1., 1e-4]];
        let points = [0.0, 1.0].iter().flat_map(|z| ring.map(|[x, y]| DVec4::new(x, y, *z, 1.0))).collect();
        let net = Net { points, counts: [6, 2], orders: [3, 2], knots: [&[], &[]], closed: [true; 2] };
        assert_eq!(Surface::Nurbs(surface(&net).unwrap().0).periods(), [None, None]);
    }
}
