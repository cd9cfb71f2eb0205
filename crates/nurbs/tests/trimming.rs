//! Trimming curves lifted and made polylines: against the surface itself, brute force, and the paper's own
//! way.
#![allow(clippy::unwrap_used)]

mod common;
use chordal_nurbs::math;
use chordal_nurbs::*;
use common::*;
use proptest::prelude::*;

const CRITERIA: [ChordCriterion; 2] = [ChordCriterion::Point, ChordCriterion::Line];

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

fn sampled_sag(curve: &BezierCurve<DVec3>, from: f64, to: f64, samples: u32) -> f64 {
    let (a, b) = (curve.eval(from), curve.eval(to));
    let at = |k: u32| from + (to - from) * f64::from(k) / f64::from(samples);
    (0..=samples).map(|k| distance_to_segment(curve.eval(at(k)), a, b)).fold(0.0, f64::max)
}

fn random_curve(random: &mut Random, n: usize, rational: bool, decades: f64) -> BezierCurve<DVec3> {
    let points = (0..=n).map(|_| random.point()).collect();
    BezierCurve { points, weights: random.weights(n + 1, rational, decades) }
}

fn plane_curve(
    random: &mut Random,
    n: usize,
    domain: UvBox,
    weights: Option<Vec<f64>>,
) -> BezierCurve<DVec2> {
    let inside = |random: &mut Random| domain.min + domain.size() * DVec2::new(random.unit(), random.unit());
    BezierCurve { points: (0..=n).map(|_| inside(random)).collect(), weights }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Weights from 1e-3 to 1e3 and degrees up to 20: neither criterion is ever undercut, and the line is the
    /// smaller one.
    #[test]
    fn criteria_bound_what_is_sampled(seed: u64, n in 1usize..=20, rational: bool) {
        let curve = random_curve(&mut Random(seed), n, rational, 3.0);
        let found = sampled_sag(&curve, 0.0, 1.0, 400);
        let [point, line] = CRITERIA.map(|c| curve.chord_distance(c).0);
        prop_assert!(found <= line * (1.0 + 1e-12) + 1e-14, "{found} {line}");
        prop_assert!(line <= point * (1.0 + 1e-12));
    }

    /// Every chord of a polyline is within the tolerance, whichever way the curve is cut.
    #[test]
    fn polylines_keep_the_tolerance(seed: u64, n in 1usize..=20, rational: bool, worst: bool, line: bool) {
        let curve = random_curve(&mut Random(seed), n, rational, 3.0);
        let cut = if worst { ChordCut::WorstPoint } else { ChordCut::Midpoint };
        let tolerance = 0.01;
        let t = curve.flattened(tolerance, CRITERIA[usize::from(line)], cut).unwrap();
        prop_assert_eq!((t[0], t[t.len() - 1]), (0.0, 1.0));
        prop_assert!(t.windows(2).all(|w| w[0] < w[1]));
        for w in t.windows(2) {
            let sag = sampled_sag(&curve, w[0], w[1], 24);
            prop_assert!(sag <= tolerance * (1.0 + 1e-9), "{sag}");
        }
    }

    /// Pieces lie on the surface over their plane curves, at equal parameters, rational or not, and hang
    /// together.
    #[test]
    fn lifted_pieces_lie_on_the_surface(
        seed: u64, p in 1usize..=4, q in 1usize..=4, n in 1usize..=4, kinds in 0u8..4, spare in 0usize..4,
    ) {
        let mut random = Random(seed);
        let surface = random.surface([p, q], kinds & 1 == 1, 3.0);
        let weights = random.weights(n + 1, kinds & 2 == 2, 1.0);
        let curve = plane_curve(&mut random, n, surface.domain(), weights);
        let mut raised = curve.clone();
        (0..spare).for_each(|_| raised = raised.elevated());
        let pieces = surface.lift(&raised, LiftOptions::default()).unwrap();
        prop_assert_eq!((pieces[0].range.start, pieces[pieces.len() - 1].range.end), (0.0, 1.0));
        let mut last = 0.0;
        for piece in &pieces {
            prop_assert_eq!(piece.range.start, last);
            last = piece.range.end;
            // A small weight hides a degree from proof; without weights every spare one goes.
            let most = if kinds & 2 == 2 { n + spare } else { n };
            prop_assert!(piece.uv.degree() <= most);
            // The error is relative to the size of what is composed: weights of a patch may differ a million
            // times.
            let slack = piece.error + if kinds & 1 == 1 { 1e-6 } else { 1e-9 };
            for k in 0..=16 {
                // Inside: a knot of full multiplicity may be a jump of the surface.
                let s = (f64::from(k) + 0.01) / 16.02;
                let uv = piece.uv.eval(s);
                let off = piece.xyz.eval(s).distance(surface.point(uv));
                prop_assert!(off <= slack, "{off} {}", piece.error);
                let t = piece.range.start + s * piece.range.length();
                let gap = uv.distance(curve.eval(t));
                // Rational pieces keep the curve, not its parameters; those stay the curve's own here, as
                // nothing is reparametrised.
                prop_assert!(gap <= 1e-8 * (1.0 + surface.domain().size().length()), "{gap}");
            }
        }
    }
}

/// A short curve far from the origin of its plane: its points are rounded by more than 1e-12 of its size.
#[test]
fn spare_degrees_of_short_curves_far_away_go_too() {
    let mut random = Random(13991224330803915634);
    let surface = random.surface([4, 3], false, 3.0);
    let weights = random.weights(3, false, 1.0);
    let curve = plane_curve(&mut random, 2, surface.domain(), weights);
    let pieces = surface.lift(&curve.elevated().elevated(), LiftOptions::default()).unwrap();
    assert!(pieces.iter().all(|piece| piece.uv.degree() == 2), "{pieces:?}");
}

/// The paper's way, interpolation at equal parameters, where it is sound: low degree, polynomial.
#[test]
fn lifting_agrees_with_collocation() {
    let mut random = Random(5);
    for (p, q, n) in [(1, 1, 1), (2, 1, 2), (2, 2, 2), (3, 2, 1), (3, 3, 2)] {
        let knots = |d: usize| {
            let mut k = vec![0.0; d + 1];
            k.resize(2 * (d + 1), 1.0);
            k
        };
        let points = (0..(p + 1) * (q + 1)).map(|_| random.point()).collect();
        let surface = NurbsSurface::new([p, q], knots(p), knots(q), points, None).unwrap();
        let curve = plane_curve(&mut random, n, surface.domain(), None);
        let degree = n * (p + q);
        let samples: Vec<DVec3> =
            (0..=degree).map(|k| surface.point(curve.eval(k as f64 / degree as f64))).collect();
        let collocated = collocated(&samples);
        let pieces = surface.lift(&curve, LiftOptions { lossless: 0.0, ..LiftOptions::default() }).unwrap();
        assert_eq!((pieces.len(), pieces[0].xyz.degree()), (1, degree));
        for (a, b) in pieces[0].xyz.points.iter().zip(&collocated) {
            assert!(a.distance(*b) < 1e-9, "{a} {b}");
        }
    }
}

/// Control points of the polynomial through samples at equal parameters, by elimination with pivots.
fn collocated(samples: &[DVec3]) -> Vec<DVec3> {
    let n = samples.len() - 1;
    let binomial = |i: usize| (0..i).fold(1.0, |b, k| b * (n - k) as f64 / (k + 1) as f64);
    let mut rows: Vec<(Vec<f64>, DVec3)> = (0..=n)
        .map(|k| {
            let t = k as f64 / n as f64;
            let basis =
                (0..=n).map(|i| binomial(i) * math::powi(t, i as i32) * math::powi(1.0 - t, (n - i) as i32));
            (basis.collect(), samples[k])
        })
        .collect();
    for c in 0..=n {
        let pivot = (c..=n).max_by(|&a, &b| rows[a].0[c].abs().total_cmp(&rows[b].0[c].abs())).unwrap();
        rows.swap(c, pivot);
        let (row, right) = rows[c].clone();
        for (r, other) in rows.iter_mut().enumerate() {
            let factor = if r == c { 0.0 } else { other.0[c] / row[c] };
            other.0.iter_mut().zip(&row).for_each(|(x, y)| *x -= factor * y);
            other.1 -= right * factor;
        }
    }
    (0..=n).map(|i| rows[i].1 / rows[i].0[i]).collect()
}

/// A straight trimming curve along a knot line is cut nowhere; across the lines it is cut at every one.
#[test]
fn knot_lines_cut_what_crosses_them() {
    let mut random = Random(8);
    let knots = vec![0., 0., 0., 1., 2., 3., 3., 3.];
    let points = (0..25).map(|_| random.point()).collect();
    let surface = NurbsSurface::new([2, 2], knots.clone(), knots, points, None).unwrap();
    let line = |a: (f64, f64), b: (f64, f64)| BezierCurve { points: vec![a.into(), b.into()], weights: None };
    let count = |a, b| surface.lift(&line(a, b), LiftOptions::default()).unwrap().len();
    assert_eq!(count((1.0, 0.2), (1.0, 0.8)), 1);
    assert_eq!(count((1.0, 0.0), (1.0, 3.0)), 3);
    assert_eq!(count((0.1, 0.2), (2.9, 2.7)), 5);
    // Along an iso-line the lifted curve has the degree of the surface in that direction.
    let along = surface.lift(&line((0.5, 0.1), (0.5, 0.9)), LiftOptions::default()).unwrap();
    assert_eq!((along[0].xyz.degree(), along[0].uv.degree()), (2, 1));
}

/// Above the cap degrees go where the allowance pays for it, and the price is told.
#[test]
fn the_degree_cap_costs_what_it_says() {
    let mut random = Random(21);
    let knots = |d: usize| {
        let mut k = vec![0.0; d + 1];
        k.resize(2 * (d + 1), 1.0);
        k
    };
    let points =
        (0..36).map(|i| DVec3::new(f64::from(i / 6), f64::from(i % 6), 0.3 * random.unit())).collect();
    let surface = NurbsSurface::new([5, 5], knots(5), knots(5), points, None).unwrap();
    let curve = BezierCurve {
        points: [(0.1, 0.1), (0.4, 0.9), (0.7, 0.2), (0.9, 0.9)].map(DVec2::from).to_vec(),
        weights: None,
    };
    let exact = surface.lift(&curve, LiftOptions::default()).unwrap();
    assert_eq!(exact[0].xyz.degree(), 30);
    let capped = surface.lift(&curve, LiftOptions { allowance: 1e-3, ..LiftOptions::default() }).unwrap();
    assert!(capped[0].xyz.degree() <= 20 && capped[0].error <= 1e-3 && capped[0].error > 0.0);
    for k in 0..=200 {
        let t = f64::from(k) / 200.0;
        assert!(capped[0].xyz.eval(t).distance(surface.point(curve.eval(t))) <= capped[0].error);
    }
}

/// How tight the criteria are; run with `--nocapture` for the table that docs/methods.md quotes.
#[test]
fn tightness_of_the_criteria() {
    println!("degree, rational: median and 95th percentile of bound over sampled distance, point | line");
    for (n, decades) in
        [(2, 0.0), (3, 0.0), (5, 0.0), (9, 0.0), (20, 0.0), (3, 0.5), (3, 3.0), (9, 3.0), (20, 3.0)]
    {
        let mut random = Random(n as u64 + 1);
        let mut ratios = [Vec::new(), Vec::new()];
        for _ in 0..400 {
            let curve = random_curve(&mut random, n, decades > 0.0, decades);
            let found = sampled_sag(&curve, 0.0, 1.0, 400);
            for (list, c) in ratios.iter_mut().zip(CRITERIA) {
                list.push(curve.chord_distance(c).0 / found.max(1e-300));
            }
        }
        let at = |list: &mut Vec<f64>, share: f64| {
            list.sort_unstable_by(f64::total_cmp);
            list[(share * (list.len() - 1) as f64) as usize]
        };
        let [point, line] = ratios.each_mut().map(|l| (at(l, 0.5), at(l, 0.95)));
        println!("{n:>2}, 1e±{decades}: {:.2} {:.2} | {:.2} {:.2}", point.0, point.1, line.0, line.1);
        assert!(line.0 <= point.0 && line.0 >= 1.0);
        assert!(decades > 0.0 || n > 3 || line.0 < 1.8, "{}", line.0);
    }
}

/// Degree reduction as printed compares the recursion from the left with the one from the right: both lose
/// all digits towards their far ends. Each up to the middle, they agree.
#[test]
fn reduction_as_printed_explodes() {
    let mut random = Random(77);
    let mut curve = random_curve(&mut random, 3, false, 0.0);
    while curve.degree() < 100 {
        curve = curve.elevated();
    }
    let (p, n) = (&curve.points, 100usize);
    let mut forward = vec![p[0]; n];
    for i in 1..n {
        forward[i] = (p[i] * n as f64 - forward[i - 1] * i as f64) / (n - i) as f64;
    }
    let mut backward = vec![p[n]; n];
    for i in (1..n).rev() {
        backward[i - 1] = (p[i] * n as f64 - backward[i] * (n - i) as f64) / i as f64;
    }
    let apart = forward.iter().zip(&backward).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart > 1e10, "{apart:e}");
    let (lower, error) = curve.reduced().unwrap();
    assert!(lower.degree() == 99 && error < 1e-12, "{error:e}");
}
