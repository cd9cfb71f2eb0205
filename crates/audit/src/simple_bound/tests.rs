use super::*;
use chordal_mesh::FaceMesh;
use chordal_nurbs::{Curve, DVec3, Frame, NurbsCurve3, NurbsSurface};

/// Numbers in 0..1 that repeat from run to run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }

    fn index(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    /// Clamped knots on 0..1 with inner ones, some of them multiple.
    fn knots(&mut self, degree: usize) -> Vec<f64> {
        let mut inner = Vec::new();
        for _ in 0..self.index(3) {
            let knot = self.next();
            let multiplicity = if self.next() < 0.3 { 1 + self.index(degree) } else { 1 };
            inner.extend(std::iter::repeat_n(knot, multiplicity));
        }
        inner.sort_by(f64::total_cmp);
        [vec![0.0; degree + 1], inner, vec![1.0; degree + 1]].concat()
    }

    fn weights(&mut self, count: usize) -> Option<Vec<f64>> {
        let decades = [0.0, 0.3, 1.0][self.index(3)];
        (decades > 0.0).then(|| (0..count).map(|_| math::pow(10.0, decades * self.signed())).collect())
    }

    /// A skew, noisy patch.
    fn patch(&mut self) -> Surface {
        let degree = [1 + self.index(8), 1 + self.index(8)];
        let [ku, kv] = degree.map(|d| self.knots(d));
        let [n, m] = [ku.len() - degree[0] - 1, kv.len() - degree[1] - 1];
        let (x, y) = (self.vector(), self.vector());
        let far = self.vector() * if self.next() < 0.1 { 1e4 } else { 1.0 };
        let noise = math::pow(10.0, -3.0 * self.next());
        let at = |i: usize, n: usize| i as f64 / (n - 1) as f64;
        let all = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
        let points = all.map(|(i, j)| far + x * at(i, n) + y * at(j, m) + self.vector() * noise).collect();
        let weights = self.weights(n * m);
        Surface::Nurbs(NurbsSurface::new(degree, ku, kv, points, weights).expect("a surface"))
    }

    fn extrusion(&mut self) -> Surface {
        let degree = 1 + self.index(5);
        let knots = self.knots(degree);
        let n = knots.len() - degree - 1;
        let points = (0..n).map(|i| DVec3::X * i as f64 + self.vector()).collect();
        let weights = self.weights(n);
        let profile = NurbsCurve3::new(degree, knots, points, weights).expect("a curve");
        Surface::Extrusion { profile: Curve::Nurbs(profile), direction: self.vector() }
    }

    fn surface(&mut self) -> Surface {
        let frame = Frame::new(self.vector(), self.vector(), DVec3::new(0.3, 0.2, 1.0));
        let radius = 0.1 + self.next();
        match self.index(16) {
            0 => Surface::Cylinder { frame, radius },
            1 => Surface::Cone { frame, radius, half_angle: 1.2 * self.signed() },
            2 => Surface::Sphere { frame, radius },
            3 => Surface::Torus { frame, major: radius, minor: 0.8 * radius * self.next() },
            4 => self.extrusion(),
            5 => {
                let circle = Curve::Circle { frame: Frame::new(DVec3::X, DVec3::Y, DVec3::X), radius: 0.3 };
                Surface::Revolution { profile: circle, axis_origin: DVec3::ZERO, axis: DVec3::Z }
            }
            _ => self.patch(),
        }
    }

    /// A triangle of any size, some of them needles.
    fn triangle(&mut self) -> [DVec2; 3] {
        loop {
            let size = math::pow(10.0, -2.0 * self.next());
            let squeeze = if self.next() < 0.3 { math::pow(10.0, -2.0 * self.next()) } else { 1.0 };
            let corner = DVec2::new(self.next(), self.next()) * (1.0 - size);
            let (sine, cosine) = math::sin_cos(self.next());
            let turn = DVec2::new(cosine, sine);
            let uv: [DVec2; 3] = std::array::from_fn(|_| {
                corner + turn.rotate(DVec2::new(self.next(), squeeze * self.next())) * size
            });
            let area = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]);
            let inside = uv.iter().all(|p| p.cmpge(DVec2::ZERO).all() && p.cmple(DVec2::ONE).all());
            if inside && area > 0.02 * squeeze * size * size {
                return uv;
            }
        }
    }
}

fn lattice(parts: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..=parts).flat_map(move |i| {
        (0..=parts - i).map(move |j| [i, j, parts - i - j].map(|k| k as f64 / parts as f64))
    })
}

fn blend(uv: [DVec2; 3], w: [f64; 3]) -> DVec2 {
    uv[0] * w[0] + uv[1] * w[1] + uv[2] * w[2]
}

/// The distance from a point to the image of a triangle: from the nearest point of a lattice by ever smaller
/// steps, until it is within `enough`.
fn distance_to_image(surface: &Surface, uv: [DVec2; 3], p: DVec3, enough: f64) -> f64 {
    let at = |w: [f64; 3]| surface.point(blend(uv, w)).distance(p);
    let start = lattice(12).min_by(|a, b| at(*a).total_cmp(&at(*b))).expect("a point");
    let (mut best, mut w, mut step) = (at(start), start, 0.05);
    while step > 1e-9 && best > enough {
        let steps =
            [[1., -1., 0.], [-1., 1., 0.], [1., 0., -1.], [-1., 0., 1.], [0., 1., -1.], [0., -1., 1.]];
        let tries = steps.map(|d| {
            let moved: [f64; 3] = std::array::from_fn(|i| (w[i] + step * d[i]).max(0.0));
            let sum: f64 = moved.iter().sum();
            moved.map(|m| m / sum)
        });
        let nearest = tries.into_iter().map(|t| (at(t), t)).min_by(|a, b| a.0.total_cmp(&b.0));
        match nearest.filter(|found| found.0 < best) {
            Some(found) => (best, w) = found,
            None => step *= 0.5,
        }
    }
    best
}

/// True where the facets are the mesh by the projection onto the surface, and not by parameters.
fn is_projected(surface: &Surface) -> bool {
    matches!(surface, Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Sphere { .. })
}

/// The largest distance seen by brute force. `with_way_back`: also from the facet to the surface.
fn seen(surface: &Surface, facet: &Facet, enough: f64, with_way_back: bool) -> f64 {
    let on_facet = |w: [f64; 3]| facet.xyz[0] * w[0] + facet.xyz[1] * w[1] + facet.xyz[2] * w[2];
    if is_projected(surface) {
        let depth = |w| {
            let p = on_facet(w);
            match surface {
                Surface::Sphere { frame, radius } => radius - p.distance(frame.origin),
                Surface::Cylinder { frame, radius } => radius - frame.local(p).truncate().length(),
                Surface::Cone { frame, radius, half_angle } => {
                    let local = frame.local(p);
                    (radius + local.z * math::tan(*half_angle) - local.truncate().length())
                        * math::cos(*half_angle)
                }
                _ => 0.0,
            }
        };
        return lattice(24).map(depth).fold(0.0, f64::max);
    }
    let there = |w| {
        let p = surface.point(blend(facet.uv, w));
        crate::triangle_tree::closest_point(p, facet.xyz).distance(p)
    };
    let seen = lattice(24).map(there).fold(0.0, f64::max);
    if !with_way_back {
        return seen;
    }
    lattice(6).map(|w| distance_to_image(surface, facet.uv, on_facet(w), enough)).fold(seen, f64::max)
}

/// Bound and truth of one random facet, where there is a simple bound.
fn trial(random: &mut Random, with_way_back: bool) -> Option<[f64; 2]> {
    let surface = random.surface();
    let uv = random.triangle();
    let facet = Facet { uv, xyz: uv.map(|p| surface.point(p)), sag: [None; 3] };
    let mesh = FaceMesh::default();
    let chart = Chart::of(&surface, &mesh, 1.0, 0.0);
    let (simple, mut scratch) = (SimpleBound::new(&surface), Scratch::default());
    let bound = simple.of(&chart, &facet, f64::INFINITY, &mut scratch)?;
    let truth = seen(&surface, &facet, bound, with_way_back);
    assert!(truth <= bound * (1.0 + 1e-9) + 1e-12, "{truth} > {bound}: {surface:?} {uv:?}");
    // What a smaller limit makes of it holds as well, and a wrong claim is never confirmed.
    let rounding = 1e-13 * (1.0 + facet.xyz[0].length());
    let there = seen(&surface, &facet, 0.0, false);
    for claim in [0.99, 0.8].map(|share| share * there) {
        let bound = simple.of(&chart, &facet, claim, &mut scratch);
        assert!(
            bound.is_none_or(|bound| bound + rounding > claim),
            "{bound:?} confirms {claim}: {surface:?} {uv:?}"
        );
    }
    Some([bound, truth])
}

#[test]
fn no_random_facet_is_farther_off_than_its_bound() {
    let mut random = Random(0x5EED_0001);
    let bounded = (0..12_000).filter(|i| trial(&mut random, i % 10 == 0).is_some()).count();
    assert!(bounded > 5_000, "{bounded}");
}

/// On a smooth patch facets are graphs over their planes: the bound is little more than the distance.
#[test]
fn the_bound_of_a_smooth_patch_is_tight() {
    let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0].to_vec();
    let height = |i: usize, j: usize| 0.2 * math::sin(0.8 * i as f64) * math::cos(0.7 * j as f64);
    let all = (0..4).flat_map(|i| (0..4).map(move |j| (i, j)));
    let points = all.map(|(i, j)| DVec3::new(i as f64, j as f64, height(i, j))).collect();
    let surface =
        Surface::Nurbs(NurbsSurface::new([3, 3], knots.clone(), knots, points, None).expect("a surface"));
    let mesh = FaceMesh::default();
    let chart = Chart::of(&surface, &mesh, 1.0, 0.0);
    let simple = SimpleBound::new(&surface);
    let mut random = Random(0x5EED_0002);
    let mut ratios: Vec<f64> = Vec::new();
    for _ in 0..300 {
        let corner = DVec2::new(random.next(), random.next()) * 0.8;
        let uv = [corner, corner + DVec2::new(0.2, 0.0), corner + DVec2::new(0.1, 0.2)];
        let facet = Facet { uv, xyz: uv.map(|p| surface.point(p)), sag: [None; 3] };
        let truth = seen(&surface, &facet, 0.0, false);
        let limit = 1.2 * truth;
        let bound = simple.of(&chart, &facet, limit, &mut Scratch::default());
        ratios.push(bound.map_or(f64::INFINITY, |bound| bound / truth));
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[ratios.len() / 2] < 1.2, "{}", ratios[ratios.len() / 2]);
}

#[test]
fn places_count_indices() {
    for degree in 0..9 {
        for (i, index) in blossom::indices(degree).enumerate() {
            assert_eq!(blossom::place(degree, index), i);
        }
    }
}
