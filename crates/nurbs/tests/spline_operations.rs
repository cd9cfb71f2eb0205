//! Every operation that must not change a curve or a surface leaves it where it was.
#![allow(clippy::unwrap_used)]

mod common;
use chordal_nurbs::math;
use chordal_nurbs::*;
use common::*;
use proptest::prelude::*;

fn uv_of(random: &mut Random, domain: UvBox) -> DVec2 {
    DVec2::new(random.sample(domain.u()), random.sample(domain.v()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn curves_keep_their_place(seed: u64, degree in 1usize..=12, rational: bool) {
        let mut random = Random(seed);
        let curve = random.curve(degree, rational, 1.0);
        let domain = curve.domain();
        let at = random.within(domain.start, domain.end);
        let list: Vec<f64> = (0..5).map(|_| random.sample(domain)).collect();
        let cut = random.sub_range(domain);
        let (low, high) = curve.split(at).unwrap();
        prop_assert_eq!(low.domain(), Range::new(domain.start, at));
        prop_assert_eq!(high.domain(), Range::new(at, domain.end));
        prop_assert!(low.points().last().unwrap().distance(high.points()[0]) < 1e-13);
        let same = [
            curve.insert_knot(at, 1 + random.below(degree + 2)).unwrap(),
            curve.refine(&list).unwrap(),
            curve.clamped().unwrap(),
            curve.elevated().unwrap(),
            curve.elevated().unwrap().elevated().unwrap(),
            curve.piece(cut).unwrap(),
            low,
            high,
        ];
        for (k, other) in same.iter().enumerate() {
            for _ in 0..8 {
                // Knots of multiplicity above the degree are jumps: stay off them.
                let t = random.within(other.domain().start, other.domain().end);
                let gap = curve.point(t).distance(other.point(t));
                prop_assert!(gap < 1e-11, "operation {k} at {t}: {gap}");
            }
        }
        let backwards = curve.reversed();
        prop_assert_eq!(backwards.domain(), domain);
        for _ in 0..8 {
            let t = random.within(domain.start, domain.end);
            prop_assert!(curve.point(t).distance(backwards.point(domain.start + domain.end - t)) < 1e-11);
        }
        prop_assert_eq!(same[3].degree(), degree + 1);
    }

    #[test]
    fn bezier_pieces_are_the_curve(seed: u64, degree in prop_oneof![1usize..=9, 10usize..=40],
        rational: bool) {
        let mut random = Random(seed);
        let curve = random.curve(degree, rational, 1.0);
        let mut end = curve.domain().start;
        for (range, piece) in curve.bezier_pieces() {
            prop_assert_eq!(range.start, end);
            end = range.end;
            let part = random.sub_range(range);
            let restricted = curve.bezier_over(part);
            let again = piece.restricted(
                (part.start - range.start) / range.length(),
                (part.end - range.start) / range.length(),
            );
            let (below, above) = piece.split(0.3);
            for _ in 0..5 {
                let s = random.unit();
                let t = range.start + s * range.length();
                let scale = (degree as f64).max(1.0);
                prop_assert!(curve.point(t).distance(piece.eval(s)) < 1e-12 * scale);
                let [_, d1, d2] = piece.jet(s);
                let [_, c1, c2] = curve.jet(t);
                prop_assert!((d1 / range.length())
                    .distance(c1) < 1e-9 * (c1.length() + scale / range.length()));
                prop_assert!((d2 / math::square(range.length()))
                    .distance(c2) < 1e-8 * (c2.length() + math::square(scale / range.length())));
                let inside = curve.point(part.start + s * part.length());
                prop_assert!(restricted.eval(s).distance(inside) < 1e-11 * scale);
                prop_assert!(again.eval(s).distance(inside) < 1e-11 * scale);
                prop_assert!(below.eval(s).distance(piece.eval(0.3 * s)) < 1e-12 * scale);
                prop_assert!(above.eval(s).distance(piece.eval(0.3 + 0.7 * s)) < 1e-12 * scale);
                prop_assert!(piece.reversed().eval(s).distance(piece.eval(1.0 - s)) < 1e-12 * scale);
                prop_assert!(piece.elevated().eval(s).distance(piece.eval(s)) < 1e-12 * scale);
                let turned = piece.restricted(0.8, 0.1);
                prop_assert!(turned.eval(s).distance(piece.eval(0.8 - 0.7 * s)) < 1e-12 * scale);
            }
        }
        prop_assert_eq!(end, curve.domain().end);
    }

    #[test]
    fn surfaces_keep_their_place(seed: u64, p in 1usize..=5, q in 1usize..=5, rational: bool) {
        let mut random = Random(seed);
        let surface = random.surface([p, q], rational, 1.0);
        let domain = surface.domain();
        let at = DVec2::new(random.within(domain.min.x, domain.max.x),
            random.within(domain.min.y, domain.max.y));
        let cut = UvBox::from_ranges(random.sub_range(domain.u()), random.sub_range(domain.v()));
        let (left, right) = surface.split_u(at.x).unwrap();
        let (low, high) = surface.split_v(at.y).unwrap();
        let same = [
            surface.insert_knot_u(at.x, 1 + random.below(p)).unwrap(),
            surface.insert_knot_v(at.y, 1 + random.below(q)).unwrap(),
            surface.clamped().unwrap(),
            surface.elevated_u().unwrap(),
            surface.elevated_v().unwrap(),
            surface.piece(cut).unwrap(),
            left,
            right,
            low,
            high,
        ];
        for (k, other) in same.iter().enumerate() {
            for _ in 0..5 {
                let uv = DVec2::new(
                    random.within(other.domain().min.x, other.domain().max.x),
                    random.within(other.domain().min.y, other.domain().max.y),
                );
                prop_assert!(surface.point(uv).distance(other.point(uv)) < 1e-11, "operation {k}");
            }
        }
        let uv = uv_of(&mut random, domain);
        prop_assert!(surface.swapped().point(DVec2::new(uv.y, uv.x)).distance(surface.point(uv)) < 1e-12);
        let uv = at;
        let mirrored = domain.min + domain.max - uv;
        prop_assert!(surface.reversed_u().point(DVec2::new(mirrored.x, uv.y))
            .distance(surface.point(uv)) < 1e-11);
        prop_assert!(surface.reversed_v().point(DVec2::new(uv.x, mirrored.y))
            .distance(surface.point(uv)) < 1e-11);
        let map = DAffine3::from_quat(math::rotation(DVec3::Y, 0.7)) * DAffine3::from_scale(DVec3::new(1.0,
            -2.0, 3.0));
        prop_assert!(surface.transformed(&map).point(uv)
            .distance(map.transform_point3(surface.point(uv))) < 1e-12);
    }

    #[test]
    fn bezier_patches_are_the_surface(seed: u64, p in 1usize..=6, q in 1usize..=6, rational: bool) {
        let mut random = Random(seed);
        let surface = random.surface([p, q], rational, 1.0);
        let patches = surface.bezier_patches(surface.domain());
        prop_assert_eq!(patches.len(), (surface.breaks_u().len() - 1) * (surface.breaks_v().len() - 1));
        for (cell, patch) in &patches {
            let part = UvBox::from_ranges(random.sub_range(Range::new(0.0, 1.0)),
                random.sub_range(Range::new(0.0, 1.0)));
            let restricted = patch.restricted(part);
            let ((left, right), (low, high)) = (patch.split_u(0.4), patch.split_v(0.6));
            for _ in 0..3 {
                let st = DVec2::new(random.unit(), random.unit());
                let uv = cell.min + st * cell.size();
                prop_assert!(surface.point(uv).distance(patch.eval(st)) < 1e-12);
                let (found, expected) = (patch.jet(st), surface.jet(uv));
                let scale = 1.0 + found.duv.length() + found.du.length() * found.dv.length();
                prop_assert!((found.duv / (cell.size().x * cell.size().y)).distance(expected.duv)
                    < 1e-9 * scale / (cell.size().x * cell.size().y));
                prop_assert!(restricted.eval(st).distance(patch.eval(part.min + st * part.size())) < 1e-12);
                prop_assert!(left.eval(st).distance(patch.eval(st * DVec2::new(0.4, 1.0))) < 1e-12);
                prop_assert!(right.eval(st).distance(patch.eval(DVec2::new(0.4 + 0.6 * st.x, st.y))) < 1e-12);
                prop_assert!(low.eval(st).distance(patch.eval(st * DVec2::new(1.0, 0.6))) < 1e-12);
                prop_assert!(high.eval(st).distance(patch.eval(DVec2::new(st.x, 0.6 + 0.4 * st.y))) < 1e-12);
                prop_assert!(patch.elevated_u().elevated_v().eval(st).distance(patch.eval(st)) < 1e-12);
                if let (Some(du), Some(dv)) = (patch.hodograph_u(), patch.hodograph_v()) {
                    prop_assert!(du.eval(st).distance(found.du) < 1e-11);
                    prop_assert!(dv.eval(st).distance(found.dv) < 1e-11);
                }
            }
        }
        let inner = UvBox::from_ranges(random.sub_range(surface.domain().u()),
            random.sub_range(surface.domain().v()));
        let expected: Vec<_> = patches
            .into_iter()
            .filter(|(c, _)| c.min.cmplt(inner.max).all() && c.max.cmpgt(inner.min).all())
            .collect();
        prop_assert_eq!(surface.bezier_patches(inner), expected);
    }

    /// The composed curve passes through S(c(t)), whatever is rational.
    #[test]
    fn composition_is_pointwise(seed: u64, p in 1usize..=5, q in 1usize..=5, d in 1usize..=5,
        kinds in 0u8..4) {
        let mut random = Random(seed);
        let patch = {
            let count = (p + 1) * (q + 1);
            let points = (0..count).map(|_| random.point()).collect();
            BezierPatch { degree: [p, q], points, weights: random.weights(count, kinds & 1 == 1, 1.0) }
        };
        let points = (0..=d).map(|_| DVec2::new(random.unit(), random.unit())).collect();
        let curve = BezierCurve { points, weights: random.weights(d + 1, kinds & 2 == 2, 1.0) };
        let composed = patch.compose(&curve).unwrap();
        prop_assert_eq!(composed.degree(), d * (p + q));
        prop_assert_eq!(composed.weights.is_some(), kinds != 0);
        for _ in 0..10 {
            let t = random.unit();
            prop_assert!(composed.eval(t).distance(patch.eval(curve.eval(t))) < 1e-11);
        }
    }

    /// What was elevated comes back exactly; what was not comes back with an error that holds.
    #[test]
    fn reduction_keeps_its_bound(seed: u64, n in 1usize..=20, rational: bool,
        perturbation in prop_oneof![Just(0.0), 1e-9..1.0f64]) {
        let mut random = Random(seed);
        let points: Vec<DVec3> = (0..=n).map(|_| random.point() * 10.0).collect();
        let original = BezierCurve { points, weights: random.weights(n + 1, rational, 0.3) };
        let mut raised = original.elevated();
        for p in &mut raised.points {
            *p += random.point() * perturbation * 1e-3;
        }
        for w in raised.weights.iter_mut().flatten() {
            *w *= 1.0 + 0.2 * perturbation * random.unit();
        }
        let (lower, error) = raised.reduced().unwrap();
        prop_assert_eq!(lower.degree(), n);
        if perturbation == 0.0 {
            prop_assert!(error < 1e-10, "{error}");
        }
        let finite = error < f64::INFINITY;
        prop_assert!(finite || rational && perturbation > 0.0);
        prop_assert!(lower.points[0].distance(raised.points[0]) < 1e-12);
        prop_assert!(lower.points[n].distance(raised.points[n + 1]) < 1e-12);
        for k in 0..=100 {
            let t = f64::from(k) / 100.0;
            prop_assert!(lower.eval(t).distance(raised.eval(t)) <= error);
        }
    }
}

/// What is a line, a cubic, a rational quintic raised to degree 60 or 100 falls back within a tiny budget.
#[test]
fn high_degrees_fall_to_what_they_are() {
    let mut random = Random(11);
    for (low, high, rational, budget) in
        [(1, 100, false, 1e-9), (3, 100, false, 1e-7), (5, 60, false, 1e-6), (2, 30, true, 1e-6)]
    {
        let points = (0..=low).map(|_| random.point()).collect();
        let original = BezierCurve { points, weights: random.weights(low + 1, rational, 0.3) };
        let mut raised = original.clone();
        while raised.degree() < high {
            raised = raised.elevated();
        }
        let (found, error) = raised.reduced_within(budget);
        assert_eq!(found.degree(), low, "from {high}: {error}");
        for k in 0..=100 {
            let t = f64::from(k) / 100.0;
            assert!(found.eval(t).distance(original.eval(t)) <= error.max(1e-12));
        }
    }
}

#[test]
fn pieces_outside_the_domain_are_refused() {
    let curve = Random(3).curve(3, false, 0.0);
    let end = curve.domain().end;
    assert!(matches!(curve.piece(Range::new(end + 1.0, end + 2.0)), Err(NurbsError::Unbounded(..))));
    assert!(curve.split(end).is_err());
}
