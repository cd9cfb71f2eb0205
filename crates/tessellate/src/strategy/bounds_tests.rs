//! The methods' bounds against closed forms and brute force, and how tight they are.
//!
//! Patches of degree 1 to 20, half of them rational with weights from 1e-3 to 1e3, wild ones and sheets with a little relief.

use super::derivatives::SecondNorms;
use super::node::{Bilinear, Flatness, Measure};
use super::projected::projected_error;
use super::quadtree::{norm, norm_by_edges};
use super::testing::{distance_to_halves, distance_to_triangle, patch, patches};
use chordal_nurbs::{DVec2, DVec3, NurbsSurface};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

fn grid(n: usize) -> impl Iterator<Item = DVec2> {
    (0..=n * n + 2 * n).map(move |k| DVec2::new((k / (n + 1)) as f64, (k % (n + 1)) as f64) / n as f64)
}

fn twisted(corners: &[(f64, f64, f64)]) -> NurbsSurface {
    patch([1, 1], corners.iter().map(|&p| DVec3::from(p)).collect(), None)
}

/// The largest distance of a patch from the bilinear surface through its corners, at equal parameters.
fn off_bilinear(s: &NurbsSurface, n: usize) -> f64 {
    let bilinear = Bilinear::new(s);
    grid(n).fold(0.0, |m: f64, uv| m.max(s.point(uv).distance(bilinear.at(uv))))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Kahlesz, Balázs, Klein 2001, Lemma 1: at equal parameters both pairs of triangles are off by ¼‖T‖, and no more anywhere.
    #[test]
    fn lemma_1_is_exact_for_either_diagonal(c in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0), 4)) {
        let s = twisted(&c);
        let bound = 0.25 * Bilinear::new(&s).twist().length();
        let corner = |u: f64, v: f64| s.point(DVec2::new(u, v));
        let [a, b, d] = [corner(0., 0.), corner(1., 0.), corner(0., 1.)];
        let e = corner(1., 1.);
        let along = |uv: DVec2, main: bool| match (main, uv.x >= uv.y, uv.x + uv.y <= 1.0) {
            (true, true, _) => a + (b - a) * uv.x + (e - b) * uv.y,
            (true, false, _) => a + (e - d) * uv.x + (d - a) * uv.y,
            (false, _, true) => a + (b - a) * uv.x + (d - a) * uv.y,
            (false, _, false) => e + (d - e) * (1.0 - uv.x) + (b - e) * (1.0 - uv.y),
        };
        for main in [true, false] {
            let largest = grid(16).fold(0.0, |m: f64, uv| m.max(s.point(uv).distance(along(uv, main))));
            prop_assert!((largest - bound).abs() <= 1e-12, "{largest} {bound}");
        }
    }

    /// Lemma 2, rational patches included: the projected control points bound the distance from the bilinear surface only with the
    /// twist beside them.
    #[test]
    fn lemma_2_bounds_the_distance_from_the_bilinear_surface(s in patches()) {
        let f = Flatness::new(&s, Measure::Conservative);
        let allowed = if s.weights().is_some() { f.error } else { f.bilinear };
        let found = off_bilinear(&s, 16);
        // A rational patch slides along the bilinear surface: there the nearest point counts, not the one at equal parameters.
        if s.weights().is_none() {
            prop_assert!(found <= allowed * (1.0 + 1e-9) + 1e-12, "{found} > {allowed}");
        }
        let halves = distance_to_halves(&s, 12);
        prop_assert!(halves <= f.error * (1.0 + 1e-9) + 1e-12, "{halves} > {}", f.error);
    }

    /// The grid's bound of both halves, over a patch of any degree.
    #[test]
    fn second_derivatives_bound_both_halves(s in patches()) {
        let error = SecondNorms::of_surface(&s).error(1.0, 1.0);
        let found = distance_to_halves(&s, 12);
        prop_assert!(found <= error * (1.0 + 1e-9) + 1e-12, "{found} > {error}");
    }
}

/// With all control points on a hyperbolic paraboloid (E = 0) weights alone move the patch off the two halves: further than the ¼‖T‖
/// that polynomial patches need, never further than ½‖T‖.
#[test]
fn rational_patches_need_half_the_twist() {
    let mut worst = 0.0f64;
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let points = grid(3).map(|uv| DVec3::new(uv.x, uv.y, uv.x * uv.y)).collect();
        let weights = (0..16).map(|k| if k == 4 * i + j { 1e3 } else { 1.0 }).collect();
        let s = patch([3, 3], points, Some(weights));
        let f = Flatness::new(&s, Measure::Conservative);
        assert!(f.bilinear < 1e-15 && (f.error - 0.5).abs() < 1e-15);
        let corner = |u: f64, v: f64| s.point(DVec2::new(u, v));
        let flat = |p: DVec3| DVec3::new(p.x, p.y, 0.0);
        let (a, b, c, d) = (corner(0., 0.), corner(1., 0.), corner(1., 1.), corner(0., 1.));
        for halves in [[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]] {
            for uv in grid(24) {
                // Measured straight up, as at equal places the lemma does.
                let p = s.point(uv);
                let over = |t: [DVec3; 3]| distance_to_triangle(flat(p), t.map(flat)) < 1e-12;
                let height = |[a, b, c]: [DVec3; 3]| {
                    let n = (b - a).cross(c - a);
                    ((p - a).dot(n) / n.z).abs()
                };
                let off = halves.into_iter().filter(|t| over(*t)).map(height).fold(0.0, f64::max);
                worst = worst.max(off);
            }
        }
        assert!(distance_to_halves(&s, 16) <= f.error);
    }
    assert!(worst > 0.3 && worst <= 0.5, "{worst}");
}

/// How tight bounds are: the bound over what was found, median and 95th percentile. Run with `--ignored --nocapture`; the table
/// stands in docs/strategies.md.
#[test]
#[ignore = "prints a table, tests nothing"]
fn tightness() {
    let mut runner = TestRunner::deterministic();
    let kinds = [(false, false), (false, true), (true, false), (true, true)];
    let mut ratios: Vec<Vec<[f64; 4]>> = vec![Vec::new(); kinds.len()];
    for _ in 0..1500 {
        let s = patches().new_tree(&mut runner).expect("a patch").current();
        let found = distance_to_halves(&s, 12);
        if found < 1e-9 {
            continue;
        }
        let high = s.degree()[0].max(s.degree()[1]) > 4;
        let kind = kinds.iter().position(|&k| k == (s.weights().is_some(), high)).expect("all kinds");
        ratios[kind].push([
            Flatness::new(&s, Measure::Conservative).error / found,
            projected_error(&s, Measure::Conservative) / found,
            SecondNorms::of_surface(&s).error(1.0, 1.0) / found,
            norm(&s) / norm_by_edges(&s),
        ]);
    }
    println!("| patches | Lemmas 1 and 2 | projected net | second derivatives | ‖bl‖ over equation 3 |");
    println!("|---|---|---|---|---|");
    for ((rational, high), of_kind) in kinds.into_iter().zip(&ratios) {
        let column = |c: usize| {
            let mut all: Vec<f64> = of_kind.iter().map(|r| r[c]).collect();
            all.sort_unstable_by(f64::total_cmp);
            let at = |share: f64| all[((all.len() - 1) as f64 * share) as usize];
            format!("{:.2} / {:.2}", at(0.5), at(0.95))
        };
        println!(
            "| {}, degree {} | {} | {} | {} | {} |",
            if rational { "rational" } else { "polynomial" },
            if high { "to 20" } else { "1 to 4" },
            column(0),
            column(1),
            column(2),
            column(3)
        );
    }
}
