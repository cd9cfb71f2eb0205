//! Closed polygons in the parameter plane.

use chordal_nurbs::DVec2;

/// The area of a polygon; negative where it runs clockwise.
pub(super) fn area(polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    let origin = polygon[0];
    (0..n).map(|i| (polygon[i] - origin).perp_dot(polygon[(i + 1) % n] - origin)).sum::<f64>() * 0.5
}

/// True where the point lies inside the polygon, by an even or odd number of crossings.
pub(super) fn contains(polygon: &[DVec2], p: DVec2) -> bool {
    let mut inside = false;
    let n = polygon.len();
    for i in 0..n {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}
