//! Polygons as triangles.

use chordal_nurbs::{DVec2, DVec3};

/// Polygons with more corners than this are cut as a fan, which takes linear time.
const MOST_CORNERS: usize = 2_000;

/// Triangles of lists of corners that −1 ends, as positions in `points`; how many polygons were left out
/// because they are no polygons.
pub(crate) fn indexed(points: &[DVec3], index: &[f64]) -> (Vec<[u32; 3]>, usize) {
    let mut triangles = Vec::new();
    let mut lost = 0;
    for polygon in index.split(|&i| i < 0.0) {
        if polygon.is_empty() {
            continue;
        }
        let corners: Option<Vec<u32>> =
            polygon.iter().map(|&i| (i < points.len() as f64).then_some(i as u32)).collect();
        match corners {
            Some(corners) if corners.len() > 2 => triangulate(points, &corners, &mut triangles),
            _ => lost += 1,
        }
    }
    (triangles, lost)
}

/// Triangles of strips: each corner makes one with the two before it.
pub(crate) fn strip(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    for (k, w) in corners.windows(3).enumerate() {
        push(if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] }, triangles);
    }
}

/// Triangles around the first corner.
pub(crate) fn fan(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    for pair in corners[1..].windows(2) {
        push([corners[0], pair[0], pair[1]], triangles);
    }
}

fn push(t: [u32; 3], triangles: &mut Vec<[u32; 3]>) {
    if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
        triangles.push(t);
    }
}

/// Cuts ears off a polygon seen along its mean normal; convex ones become fans.
pub(crate) fn triangulate(points: &[DVec3], corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let n = corners.len();
    let flat = flattened(points, corners);
    let turn = |a: usize, b: usize, c: usize| (flat[b] - flat[a]).perp_dot(flat[c] - flat[b]);
    let convex = (0..n).all(|i| turn(i, (i + 1) % n, (i + 2) % n) >= 0.0);
    if n == 3 || convex || n > MOST_CORNERS {
        return fan(corners, triangles);
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut at = 0;
    let mut tried = 0;
    while left.len() > 3 {
        let m = left.len();
        let [a, b, c] = [left[at % m], left[(at + 1) % m], left[(at + 2) % m]];
        let encloses = |&p: &usize| {
            flat[p] != flat[a]
                && flat[p] != flat[b]
                && flat[p] != flat[c]
                && turn_of(flat[a], flat[b], flat[p]) >= 0.0
                && turn_of(flat[b], flat[c], flat[p]) >= 0.0
                && turn_of(flat[c], flat[a], flat[p]) >= 0.0
        };
        // A polygon that crosses itself may have no ears: take what comes.
        let ear = turn(a, b, c) > 0.0 && !left.iter().any(encloses);
        if ear || tried >= m {
            push([corners[a], corners[b], corners[c]], triangles);
            left.remove((at + 1) % m);
            tried = 0;
            at = if at >= left.len() { 0 } else { at };
        } else {
            at = (at + 1) % m;
            tried += 1;
        }
    }
    push([corners[left[0]], corners[left[1]], corners[left[2]]], triangles);
}

fn turn_of(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - b)
}

/// The corners in the plane of the polygon's vector area (Newell's method), counter-clockwise.
fn flattened(points: &[DVec3], corners: &[u32]) -> Vec<DVec2> {
    let at = |i: usize| points[corners[i % corners.len()] as usize] - points[corners[0] as usize];
    let area: DVec3 = (0..corners.len()).map(|i| at(i).cross(at(i + 1))).sum();
    let Some(normal) = area.try_normalize() else { return vec![DVec2::ZERO; corners.len()] };
    let (x, y) = normal.any_orthonormal_pair();
    (0..corners.len()).map(|i| DVec2::new(at(i).dot(x), at(i).dot(y))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        let at = |i: u32| points[i as usize];
        triangles.iter().map(|t| (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).z * 0.5).sum()
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        // A comb with five teeth.
        let mut points = vec![DVec3::new(0.0, -1.0, 0.0), DVec3::new(10.0, -1.0, 0.0)];
        points.extend(
            (0..=10).rev().map(|i| DVec3::new(f64::from(i), if i % 2 == 0 { 3.0 } else { 0.0 }, 0.0)),
        );
        let index: Vec<f64> = (0..points.len()).map(|i| i as f64).collect();
        let (triangles, lost) = indexed(&points, &index);
        assert_eq!((triangles.len(), lost), (points.len() - 2, 0));
        assert!((area(&points, &triangles) - (10.0 + 15.0)).abs() < 1e-12);
        assert!(triangles.iter().all(|t| area(&points, &[*t]) >= 0.0));
    }

    #[test]
    fn indices_outside_of_the_list_lose_their_polygon() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let (triangles, lost) =
            indexed(&points, &[0.0, 1.0, 2.0, -1.0, 0.0, 1.0, 3.0, -1.0, 0.0, 1.0, -1.0, f64::NAN]);
        assert_eq!((triangles.len(), lost), (1, 3));
    }

    #[test]
    fn polygons_without_area_do_not_hang() {
        let points = [DVec3::ZERO; 9];
        let index: Vec<f64> = (0..9).map(f64::from).collect();
        assert_eq!(indexed(&points, &index).1, 0);
        let crossing = [DVec3::ZERO, DVec3::new(1., 1., 0.), DVec3::new(1., 0., 0.), DVec3::new(0., 1., 0.)];
        assert_eq!(indexed(&crossing, &[0., 1., 2., 3.]).0.len(), 2);
    }
}
