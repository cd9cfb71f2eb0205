//! Random patches to attack bounds with: any degree to 20, weights from 1e-3 to 1e3.

use chordal_nurbs::{DVec2, DVec3, NurbsSurface, math};
use proptest::prelude::*;

/// A Bézier patch over the unit square.
pub fn patch(degree: [usize; 2], points: Vec<DVec3>, weights: Option<Vec<f64>>) -> NurbsSurface {
    let knots = |degree: usize| {
        let mut knots = vec![0.0; degree + 1];
        knots.resize(2 * (degree + 1), 1.0);
        knots
    };
    NurbsSurface::new(degree, knots(degree[0]), knots(degree[1]), points, weights).expect("a legal patch")
}

/// Patches of degree 1 to 20 in either direction: wild ones, and sheets over the unit square with a little
/// relief.
pub fn patches() -> impl Strategy<Value = NurbsSurface> {
    let point = (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, -3.0f64..3.0);
    let net = prop::collection::vec(point, 21 * 21);
    (1usize..=20, 1usize..=20, net, any::<bool>(), any::<bool>()).prop_map(|(p, q, net, rational, wild)| {
        let net = &net[..(p + 1) * (q + 1)];
        let place = |k: usize| {
            let at = DVec2::new((k / (q + 1)) as f64 / p as f64, (k % (q + 1)) as f64 / q as f64);
            if wild { DVec3::ZERO } else { (3.0 * at).extend(0.0) }
        };
        let points = net
            .iter()
            .enumerate()
            .map(|(k, n)| place(k) + DVec3::new(n.0, n.1, n.2) * if wild { 1.0 } else { 0.2 });
        let weights = rational.then(|| net.iter().map(|n| math::pow(10.0, n.3)).collect());
        patch([p, q], points.collect(), weights)
    })
}

/// The distance of a point from a triangle.
pub fn distance_to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let n = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)].iter().all(|&(a, b)| (b - a).cross(p - a).dot(n) >= 0.0);
    if inside && n.length() > 0.0 {
        return (p - a).dot(n.normalize()).abs();
    }
    [(a, b), (b, c), (c, a)].iter().fold(f64::INFINITY, |m, &(a, b)| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
        m.min(p.distance(a.lerp(b, t)))
    })
}

/// The largest distance of samples of a patch from the nearer of its two halves, for the worse of the two
/// diagonals.
pub fn distance_to_halves(s: &NurbsSurface, samples: usize) -> f64 {
    let (low, size) = (s.domain().min, s.domain().size());
    let at = |u: f64, v: f64| s.point(low + size * DVec2::new(u, v));
    let (a, b, c, d) = (at(0., 0.), at(1., 0.), at(1., 1.), at(0., 1.));
    [[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]].into_iter().fold(0.0, |worst: f64, halves| {
        let grid = (0..=samples).flat_map(|i| (0..=samples).map(move |j| (i, j)));
        grid.fold(worst, |worst, (i, j)| {
            let p = at(i as f64 / samples as f64, j as f64 / samples as f64);
            worst.max(distance_to_triangle(p, halves[0]).min(distance_to_triangle(p, halves[1])))
        })
    })
}
