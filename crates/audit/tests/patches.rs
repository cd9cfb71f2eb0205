//! Bounds of facets against brute force, on random patches: rational, skew, degree 2 to 20, one or several
//! spans.

#![allow(clippy::unwrap_used)]

use chordal_nurbs::{
    Curve, DVec2, DVec3, Facet, Frame, NurbsCurve3, NurbsSurface, Surface, SurfaceBounds, SurfaceInverter,
    UvBox, chord_bound, facet_bound, math,
};

/// Mixed into all random numbers: CHORDAL_SEED hunts elsewhere.
fn seed() -> u64 {
    std::env::var("CHORDAL_SEED")
        .ok()
        .and_then(|s| s.parse::<u64>().ok())
        .map_or(0, |s| s.wrapping_mul(0x9E37_79B9_7F4A_7C15))
}

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
    /// Between 1/10^decades and 10^decades.
    fn scale(&mut self, decades: f64) -> f64 {
        math::pow(10.0, decades * self.signed())
    }
}

/// Clamped knots on 0..1 with inner ones, some of them multiple.
fn knots(random: &mut Random, degree: usize) -> Vec<f64> {
    let mut inner = Vec::new();
    for _ in 0..random.index(3) {
        let knot = random.next();
        let multiplicity = if random.next() < 0.2 { 1 + random.index(degree) } else { 1 };
        inner.extend(std::iter::repeat_n(knot, multiplicity));
    }
    inner.sort_by(f64::total_cmp);
    let mut knots = vec![0.0; degree + 1];
    knots.extend(inner);
    knots.extend(vec![1.0; degree + 1]);
    knots
}

fn patch(random: &mut Random) -> Surface {
    let degree = [2 + random.index(19), 2 + random.index(19)];
    let [ku, kv] = degree.map(|d| knots(random, d));
    let [n, m] = [ku.len() - degree[0] - 1, kv.len() - degree[1] - 1];
    let (x, y) = (random.vector(), random.vector());
    let far = random.vector() * if random.next() < 0.1 { 1e4 } else { 1.0 };
    let noise = math::pow(10.0, -3.0 * random.next());
    let mut points = Vec::with_capacity(n * m);
    for i in 0..n {
        for j in 0..m {
            let at = x * (i as f64 / (n - 1) as f64) + y * (j as f64 / (m - 1) as f64);
            points.push(far + at + random.vector() * noise);
        }
    }
    let decades = match random.index(10) {
        0..3 => 0.0,
        3..8 => 1.0,
        8 => 0.3,
        _ => 3.0,
    };
    let weights = (decades > 0.0).then(|| (0..n * m).map(|_| random.scale(decades)).collect());
    Surface::Nurbs(NurbsSurface::new(degree, ku, kv, points, weights).unwrap())
}

/// A triangle of any size, not too thin, counter-clockwise.
fn triangle(random: &mut Random) -> [DVec2; 3] {
    loop {
        let size = math::pow(10.0, -2.5 * random.next());
        let corner = DVec2::new(random.next(), random.next()) * (1.0 - size);
        let uv: [DVec2; 3] =
            std::array::from_fn(|_| corner + DVec2::new(random.next(), random.next()) * size);
        let area = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]);
        if area > 0.05 * size * size {
            return uv;
        }
    }
}

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    p.distance(a + d * if t.is_finite() { t } else { 0.0 })
}

fn distance_to_triangle(p: DVec3, t: [DVec3; 3]) -> f64 {
    let n = (t[1] - t[0]).cross(t[2] - t[0]);
    let inside = (0..3).all(|i| (t[(i + 1) % 3] - t[i]).cross(p - t[i]).dot(n) >= 0.0);
    if inside && n != DVec3::ZERO {
        return (p - t[0]).dot(n.normalize()).abs();
    }
    (0..3).map(|i| distance_to_segment(p, t[i], t[(i + 1) % 3])).fold(f64::INFINITY, f64::min)
}

fn lattice(parts: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..=parts).flat_map(move |i| {
        (0..=parts - i).map(move |j| [i, j, parts - i - j].map(|k| k as f64 / parts as f64))
    })
}

fn blend2(p: [DVec2; 3], w: [f64; 3]) -> DVec2 {
    p[0] * w[0] + p[1] * w[1] + p[2] * w[2]
}

fn blend3(p: [DVec3; 3], w: [f64; 3]) -> DVec3 {
    p[0] * w[0] + p[1] * w[1] + p[2] * w[2]
}

/// The distance from a point to the image of a triangle, looked for from `start` by ever smaller steps until
/// it is within `enough`.
fn distance_to_image(surface: &Surface, uv: [DVec2; 3], p: DVec3, start: [f64; 3], enough: f64) -> f64 {
    let at = |w: [f64; 3]| surface.point(blend2(uv, w)).distance(p);
    let (mut best, mut w, mut step) = (at(start), start, 0.1);
    while step > 1e-10 && best > enough {
        let directions =
            [[1., -1., 0.], [-1., 1., 0.], [1., 0., -1.], [-1., 0., 1.], [0., 1., -1.], [0., -1., 1.]];
        let tries = directions.map(|d| {
            let moved: [f64; 3] = std::array::from_fn(|i| (w[i] + step * d[i]).max(0.0));
            let sum: f64 = moved.iter().sum();
            moved.map(|m| m / sum)
        });
        match tries.into_iter().map(|t| (at(t), t)).min_by(|a, b| a.0.total_cmp(&b.0)).filter(|b| b.0 < best)
        {
            Some((distance, t)) => (best, w) = (distance, t),
            None => step *= 0.5,
        }
    }
    best
}

/// What brute force sees of one facet.
struct Seen {
    /// Along the facet's normal.
    along: f64,
    /// From the surface to the facet.
    to_facet: f64,
    /// From the images of the sides to the facet's sides.
    sag: [f64; 3],
    /// Points of the surface over the facet.
    points: Vec<DVec3>,
}

fn look(surface: &Surface, uv: [DVec2; 3], xyz: [DVec3; 3], n: DVec3) -> Seen {
    let mut seen = Seen { along: 0.0, to_facet: 0.0, sag: [0.0; 3], points: Vec::new() };
    for w in lattice(10) {
        let p = surface.point(blend2(uv, w));
        seen.points.push(p);
        seen.along = seen.along.max((p - xyz[0]).dot(n).abs());
        seen.to_facet = seen.to_facet.max(distance_to_triangle(p, xyz));
        for i in (0..3).filter(|&i| w[i] == 0.0) {
            seen.sag[i] = seen.sag[i].max(distance_to_segment(p, xyz[(i + 1) % 3], xyz[(i + 2) % 3]));
        }
    }
    seen
}

fn quantiles(name: &str, mut ratios: Vec<f64>) {
    ratios.sort_by(f64::total_cmp);
    let at = |q: f64| ratios[((ratios.len() - 1) as f64 * q) as usize];
    let [median, p95, p99, largest] = [0.5, 0.95, 0.99, 1.0].map(at);
    println!(
        "{name}: bound / truth of {}: median {median:.3}, 95 % {p95:.2}, 99 % {p99:.2}, largest {largest:.1}",
        ratios.len()
    );
}

#[test]
fn no_facet_of_ten_thousand_patches_is_farther_off_than_its_bound() {
    let mut random = Random(seed().rotate_left(7) ^ 0x9E37_79B9_7F4A_7C15);
    let (mut inner, mut bounded) = (Vec::new(), Vec::new());
    let (mut infinite, mut far_sides) = (0, 0);
    let mut scratch = Vec::new();
    for round in 0..10_000 {
        let surface = patch(&mut random);
        let uv = triangle(&mut random);
        let xyz = uv.map(|p| surface.point(p));
        let Some(n) = (xyz[1] - xyz[0]).cross(xyz[2] - xyz[0]).try_normalize() else { continue };
        let seen = look(&surface, uv, xyz, n);
        // Bounds are pursued as far as they seem to be needed.
        let enough = seen.along.max(1e-9) * random.scale(0.5);
        let bounds = SurfaceBounds::new(&surface, UvBox::from_points(uv), enough);
        let scale = xyz.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
        let slack = 1e-9 * seen.along + 1e-13 * scale;

        // An inner facet: the surface over it is nowhere farther from its plane.
        let facet = Facet { uv, xyz, sag: [None; 3] };
        let error = facet_bound(&bounds, &facet, enough, &mut scratch).error;
        assert!(
            error >= seen.along - slack,
            "patch {round}: {error:e} is below {:e}: {surface:?} {uv:?}",
            seen.along
        );
        if error.is_infinite() {
            infinite += 1;
        } else if seen.along > 1e-11 * scale {
            inner.push(error / seen.along);
        }

        // A facet that is all of its face: no point of either is farther from the other.
        let facet = Facet { sag: seen.sag.map(|sag| Some(1.01 * sag)), ..facet };
        let error = facet_bound(&bounds, &facet, enough, &mut scratch).error;
        assert!(
            error >= seen.to_facet - slack,
            "patch {round}, bounded: {error:e} is below {:e}: {surface:?} {uv:?}",
            seen.to_facet
        );
        if error.is_finite() && seen.to_facet > 1e-11 * scale {
            bounded.push(error / seen.to_facet);
            for w in lattice(4) {
                let p = blend3(xyz, w);
                if seen.points.iter().any(|q| q.distance(p) <= error) {
                    continue;
                }
                far_sides += 1;
                let mut distance = distance_to_image(&surface, uv, p, w, error);
                if distance > error {
                    let near = |w: &[f64; 3]| surface.point(blend2(uv, *w)).distance(p);
                    let start = lattice(60).min_by(|a, b| near(a).total_cmp(&near(b))).unwrap();
                    distance = distance_to_image(&surface, uv, p, start, error);
                }
                assert!(
                    distance <= error + slack,
                    "patch {round}, facet to surface: {error:e} is below {distance:e}: {surface:?} {uv:?} \
                     {w:?}"
                );
            }
        }
    }
    println!("{infinite} facets have no bound; {far_sides} points needed a search");
    quantiles("inner facets", inner);
    quantiles("whole faces", bounded);
}

#[test]
fn no_chord_of_a_patch_is_farther_off_than_its_bound() {
    let mut random = Random(seed().rotate_left(11) ^ 0x2545_F491_4F6C_DD1D);
    let (mut ratios, mut in_parts, mut scratch) = (Vec::new(), Vec::new(), Vec::new());
    for round in 0..3_000 {
        let surface = patch(&mut random);
        let [a, b, _] = triangle(&mut random);
        let ends = [a, b].map(|p| surface.point(p));
        let line = (ends[1] - ends[0]).normalize_or_zero();
        let off = |t: f64| (surface.point(a.lerp(b, t)) - ends[0]).reject_from_normalized(line).length();
        let seen = (0..=200).map(|k| off(f64::from(k) / 200.0)).fold(0.0, f64::max);
        let bounds = SurfaceBounds::new(&surface, UvBox::from_points([a, b]), seen.max(1e-9));
        let scale = ends[0].abs().max_element();
        for (parts, ratios) in [(1, &mut ratios), (8, &mut in_parts)] {
            let bound = chord_bound(&bounds, [a, b], ends, parts, &mut scratch);
            let enough = seen * (1.0 - 1e-9) - 1e-13 * scale;
            assert!(bound >= enough, "patch {round}, {parts} parts: {bound:e} is below {seen:e}");
            if bound.is_finite() && seen > 1e-11 * scale {
                ratios.push(bound / seen);
            }
        }
    }
    assert!(ratios.len() > 2_000, "only {} chords have a bound", ratios.len());
    quantiles("chords", ratios);
    quantiles("chords in eight parts", in_parts);
}

/// Along the nose of a ring thin facets shift sideways by more than they are high: their own plane says
/// little of how steep the surface is.
#[test]
fn no_sliver_on_a_nose_is_farther_off_than_its_bound() {
    let mut random = Random(seed().rotate_left(17) ^ 0x1234_5678_9ABC_DEF1);
    let mut scratch = Vec::new();
    let (mut bounded, mut wide) = (0, 0);
    for round in 0..4_000 {
        // (x, −x²/2R − y²/2r, y) for x within ±6 and y within ±1; facets keep off the surface's own ends.
        let (large, small) = (28.0 * random.scale(0.3), 0.2 * random.scale(0.3));
        let mut points = Vec::new();
        for (x, xx) in [(-6.0, 36.0), (0.0, -36.0), (6.0, 36.0)] {
            for (y, yy) in [(-1.0, 1.0), (0.0, -1.0), (1.0, 1.0)] {
                points.push(DVec3::new(x, -xx / (2.0 * large) - yy / (2.0 * small), y));
            }
        }
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let surface = Surface::Nurbs(NurbsSurface::new([2, 2], knots.clone(), knots, points, None).unwrap());
        let middle = DVec2::new(0.5 + 0.05 * random.signed(), 0.5 + 0.2 * random.signed());
        let along = 0.45 * random.next();
        let aside = |random: &mut Random| 0.02 * random.scale(1.0) * random.signed();
        let uv = [
            middle + DVec2::new(-along, aside(&mut random)),
            middle + DVec2::new(along, aside(&mut random)),
            middle + DVec2::new(along * random.signed(), aside(&mut random)),
        ];
        let uv = uv.map(|p| p.clamp(DVec2::splat(0.15), DVec2::splat(0.85)));
        let xyz = uv.map(|p| surface.point(p));
        let bounds = SurfaceBounds::new(&surface, UvBox::from_points(uv), 0.1);
        for enough in [0.03, 0.1, 0.2] {
            let facet = Facet { uv, xyz, sag: [None; 3] };
            let error = facet_bound(&bounds, &facet, enough, &mut scratch).error;
            if error > enough {
                continue;
            }
            bounded += 1;
            let inverter = SurfaceInverter::new(&surface, surface.domain());
            let farthest =
                lattice(12).map(|w| inverter.invert(blend3(xyz, w), None).distance).fold(0.0, f64::max);
            wide += usize::from(farthest > 0.5 * error);
            assert!(
                farthest <= error + 1e-9,
                "facet {round}: {error} is below {farthest}: {surface:?} {uv:?}"
            );
        }
    }
    assert!(bounded > 1_000 && wide > 50, "{bounded} facets, {wide} near their bound");
}

/// A parallelogram of a patch as a grid of facets whose inner corners are shaken.
struct Grid {
    uv: Vec<DVec2>,
    xyz: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
}

const CELLS: usize = 3;

impl Grid {
    /// Half the parallelogram over a triangle of the unit square mapped to `uv_box`: it lies inside.
    fn new(random: &mut Random, surface: &Surface, uv_box: UvBox) -> Self {
        let [o, a, b] = triangle(random).map(|p| uv_box.min + p * uv_box.size());
        let (a, b) = ((a - o) * 0.5, (b - o) * 0.5);
        let mut uv = Vec::new();
        for i in 0..=CELLS {
            for j in 0..=CELLS {
                let inner = i > 0 && j > 0 && i < CELLS && j < CELLS;
                let mut at = DVec2::new(i as f64, j as f64);
                if inner {
                    at += 0.35 * DVec2::new(random.signed(), random.signed());
                }
                uv.push(o + (a * at.x + b * at.y) / CELLS as f64);
            }
        }
        let index = |i: usize, j: usize| i * (CELLS + 1) + j;
        let mut triangles = Vec::new();
        for i in 0..CELLS {
            for j in 0..CELLS {
                let c = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
                triangles.extend(if random.next() < 0.5 {
                    [[c[0], c[1], c[2]], [c[0], c[2], c[3]]]
                } else {
                    [[c[0], c[1], c[3]], [c[1], c[2], c[3]]]
                });
            }
        }
        let xyz = uv.iter().map(|&p| surface.point(p)).collect();
        Self { uv, xyz, triangles }
    }

    /// How far the image of a side on the border lies from its chord.
    fn sag(&self, surface: &Surface, a: usize, b: usize) -> Option<f64> {
        let on = |k: usize, side: usize| match side {
            0 => k / (CELLS + 1) == 0,
            1 => k / (CELLS + 1) == CELLS,
            2 => k.is_multiple_of(CELLS + 1),
            _ => k % (CELLS + 1) == CELLS,
        };
        (0..4).any(|side| on(a, side) && on(b, side)).then(|| {
            let off = |k: i32| {
                let p = surface.point(self.uv[a].lerp(self.uv[b], f64::from(k) / 24.0));
                distance_to_segment(p, self.xyz[a], self.xyz[b])
            };
            1.01 * (0..=24).map(off).fold(0.0, f64::max)
        })
    }

    fn facet(&self, surface: &Surface, t: [usize; 3]) -> Facet {
        Facet {
            uv: t.map(|k| self.uv[k]),
            xyz: t.map(|k| self.xyz[k]),
            sag: std::array::from_fn(|i| self.sag(surface, t[(i + 1) % 3], t[(i + 2) % 3])),
        }
    }

    fn distance(&self, p: DVec3) -> f64 {
        let to = |t: &[usize; 3]| distance_to_triangle(p, t.map(|k| self.xyz[k]));
        self.triangles.iter().map(to).fold(f64::INFINITY, f64::min)
    }
}

/// The worst bound of a grid and its measured distance from the surface; `None` where the surface
/// degenerates.
fn bound_and_truth(random: &mut Random, surface: &Surface, uv_box: UvBox) -> Option<(f64, f64)> {
    let grid = Grid::new(random, surface, uv_box);
    let facets: Vec<Facet> = grid.triangles.iter().map(|&t| grid.facet(surface, t)).collect();
    if facets.iter().any(|f| span_nothing(f.xyz[1] - f.xyz[0], f.xyz[2] - f.xyz[0])) {
        return None;
    }
    let mut measured = 0.0f64;
    for f in &facets {
        for w in lattice(5) {
            measured = measured.max(grid.distance(surface.point(blend2(f.uv, w))));
        }
    }
    let enough = measured.max(1e-9) * random.scale(0.5);
    let bounds = SurfaceBounds::new(surface, UvBox::from_points(grid.uv.iter().copied()), enough);
    let mut scratch = Vec::new();
    let error =
        facets.iter().map(|f| facet_bound(&bounds, f, enough, &mut scratch).error).fold(0.0, f64::max);
    let scale = grid.xyz.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    let slack = 1e-9 * measured + 1e-13 * scale;
    assert!(error >= measured - slack, "{error:e} is below {measured:e}: {surface:?} {:?}", grid.uv);
    (error.is_finite() && measured > 1e-11 * scale).then_some((error, measured))
}

#[test]
fn no_mesh_of_a_thousand_patches_is_farther_off_than_its_worst_facet() {
    let mut random = Random(seed() ^ 0xD1B5_4A32_D192_ED03);
    let unit = UvBox::new(DVec2::ZERO, DVec2::ONE);
    let ratios = (0..1_000).filter_map(|_| {
        let surface = patch(&mut random);
        bound_and_truth(&mut random, &surface, unit).map(|(error, truth)| error / truth)
    });
    quantiles("meshes of patches", ratios.collect());
}

/// One of each kind with a form of its own, or with a profile.
fn native(random: &mut Random, kind: usize) -> (&'static str, Surface, UvBox) {
    let frame = Frame::new(random.vector() * random.scale(2.0), random.vector(), random.vector());
    let radius = random.scale(1.0);
    let start = DVec2::new(6.0 * random.next(), random.signed());
    let reach = |u: f64, v: f64| UvBox::new(start, start + DVec2::new(u, v));
    let profile = |random: &mut Random| {
        let degree = 2 + random.index(5);
        let knots = knots(random, degree);
        let n = knots.len() - degree - 1;
        let at = |i: usize, random: &mut Random| {
            frame.origin
                + frame.x * (2.0 + random.signed()) * radius
                + frame.z * (i as f64 / n as f64 * radius)
        };
        let points = (0..n).map(|i| at(i, random)).collect();
        let weights = (random.next() < 0.5).then(|| (0..n).map(|_| random.scale(0.5)).collect());
        Curve::Nurbs(NurbsCurve3::new(degree, knots, points, weights).unwrap())
    };
    match kind {
        0 => ("cylinders", Surface::Cylinder { frame, radius }, reach(2.5, 3.0 * radius)),
        1 => {
            let half_angle = 1.4 * random.signed();
            // Away from the apex, on either side of it.
            let room = 0.8 * radius / math::tan(half_angle).abs();
            let low = if half_angle > 0.0 { -room } else { 0.0 };
            let uv = UvBox::new(DVec2::new(start.x, low), DVec2::new(start.x + 2.5, low + room));
            ("cones", Surface::Cone { frame, radius, half_angle }, uv)
        }
        2 => {
            let uv = UvBox::new(DVec2::new(start.x, -1.3), DVec2::new(start.x + 2.0, 1.3));
            ("spheres", Surface::Sphere { frame, radius }, uv)
        }
        3 => {
            let major = radius * (1.05 + 3.0 * random.next());
            ("tori", Surface::Torus { frame, major, minor: radius }, reach(2.0, 2.0))
        }
        4 => {
            let uv = UvBox::new(DVec2::ZERO, DVec2::new(1.0, 2.0));
            ("extrusions", Surface::Extrusion { profile: profile(random), direction: frame.z + frame.y }, uv)
        }
        _ => {
            let uv = UvBox::new(DVec2::new(start.x, 0.0), DVec2::new(start.x + 2.0, 1.0));
            let profile = profile(random);
            ("revolutions", Surface::Revolution { profile, axis_origin: frame.origin, axis: frame.z }, uv)
        }
    }
}

#[test]
fn no_mesh_of_a_native_surface_is_farther_off_than_its_worst_facet() {
    let mut random = Random(seed() ^ 0x2545_F491_4F6C_DD1D);
    for kind in 0..6 {
        let mut ratios = Vec::new();
        let mut of = "";
        for _ in 0..400 {
            let (name, surface, uv_box) = native(&mut random, kind);
            of = name;
            ratios.extend(bound_and_truth(&mut random, &surface, uv_box).map(|(error, truth)| error / truth));
        }
        assert!(ratios.len() > 200, "only {} {of} with a bound", ratios.len());
        quantiles(of, ratios);
    }
}

fn span_nothing(a: DVec3, b: DVec3) -> bool {
    a.cross(b).length() <= 1e-9 * a.length() * b.length()
}
