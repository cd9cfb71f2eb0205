//! The methods' bounds against closed forms and brute force, and how tight they are.
//!
//! Patches of degree 1 to 20, half of them rational with weights from 1e-3 to 1e3, wild ones and sheets with
//! a little relief.

use super::derivatives::SecondNorms;
use super::node::{Bilinear, Flatness, Measure, off_bilinear};
use super::projected::projected_error;
use super::quadtree::{norm, norm_by_edges};
use super::testing::{distance_to_halves, distance_to_triangle, patch, patches};
use chordal_nurbs::{
    DVec2, DVec3, Facet, NurbsSurface, Surface, SurfaceBounds, UvBox, chord_bound, facet_bound,
};
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
fn largest_off_bilinear(s: &NurbsSurface, n: usize) -> f64 {
    let bilinear = Bilinear::new(s);
    grid(n).fold(0.0, |m: f64, uv| m.max(s.point(uv).distance(bilinear.at(uv))))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Kahlesz, Balázs, Klein 2001, Lemma 1: at equal parameters both pairs of triangles are off by ¼‖T‖, and
    /// no more anywhere.
    #[test]
    fn lemma_1_is_exact_for_either_diagonal(c in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0,
        -1.0f64..1.0), 4)) {
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

    /// Lemma 2, rational patches included: the projected control points bound the distance from the bilinear
    /// surface only with the twist beside them.
    #[test]
    fn lemma_2_bounds_the_distance_from_the_bilinear_surface(s in patches()) {
        let f = Flatness::new(&s, Measure::Conservative);
        let allowed = if s.weights().is_some() { f.error } else { f.bilinear };
        let found = largest_off_bilinear(&s, 16);
        // A rational patch slides along the bilinear surface: there the nearest point counts, not the one at
        // equal parameters.
        if s.weights().is_none() {
            prop_assert!(found <= allowed * (1.0 + 1e-9) + 1e-12, "{found} > {allowed}");
        }
        let halves = distance_to_halves(&s, 12);
        prop_assert!(halves <= f.error * (1.0 + 1e-9) + 1e-12, "{halves} > {}", f.error);
    }

    /// What takes the place of Lemma 2 where parameters count: never below what is found at equal ones,
    /// whatever the weights, and never above Lemma 2 without them.
    #[test]
    fn the_bilinear_surface_is_as_near_at_equal_parameters(s in patches()) {
        let bound = off_bilinear(&s);
        let found = largest_off_bilinear(&s, 16);
        prop_assert!(found <= bound * (1.0 + 1e-9) + 1e-12, "{found} > {bound}");
        let weighted = NurbsSurface::new(
            s.degree(), s.knots_u().to_vec(), s.knots_v().to_vec(), s.points().to_vec(),
                Some(vec![2.5; s.points().len()]),
        ).expect("legal");
        let lemma_2 = Flatness::new(&weighted, Measure::Conservative).bilinear;
        prop_assert!(off_bilinear(&weighted) <= lemma_2 * (1.0 + 1e-12));
    }

    /// Facets over a leaf that is cut by a curve: any triangle with its corners on the leaf is within 2E +
    /// ¼‖T‖ at equal parameters.
    #[test]
    fn any_triangle_over_a_leaf_is_within_twice_its_share(
        s in patches(),
        corners in prop::array::uniform3((0.0f64..=1.0, 0.0f64..=1.0)),
    ) {
        let bound = 2.0 * off_bilinear(&s) + 0.25 * Bilinear::new(&s).twist().length();
        let uv = corners.map(DVec2::from);
        let xyz = uv.map(|p| s.point(p));
        for (i, j) in (0..=12).flat_map(|i| (0..=12 - i).map(move |j| (i, j))) {
            let w = [f64::from(i) / 12.0, f64::from(j) / 12.0, f64::from(12 - i - j) / 12.0];
            let p = s.point(uv[0] * w[0] + uv[1] * w[1] + uv[2] * w[2]);
            let off = p.distance(xyz[0] * w[0] + xyz[1] * w[1] + xyz[2] * w[2]);
            prop_assert!(off <= bound * (1.0 + 1e-9) + 1e-12, "{off} > {bound}");
        }
    }

    /// The grid's bound of both halves, over a patch of any degree.
    #[test]
    fn second_derivatives_bound_both_halves(s in patches()) {
        let error = SecondNorms::of_surface(&s).error(1.0, 1.0);
        let found = distance_to_halves(&s, 12);
        prop_assert!(found <= error * (1.0 + 1e-9) + 1e-12, "{found} > {error}");
    }
}

/// With all control points on a hyperbolic paraboloid (E = 0) weights alone move the patch off the two
/// halves: further than the ¼‖T‖ that polynomial patches need, never further than ½‖T‖.
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

/// Equation 3 of Kahlesz, Balázs, Klein 2001 looks at one corner: where all sides leave it together and the
/// opposite corner lies behind it, the map stretches 2 + √2 times as much at that corner, and never more than
/// that.
#[test]
fn equation_3_is_too_small_by_two_and_the_root_of_two_at_most() {
    let back = -std::f64::consts::SQRT_2;
    let worst = twisted(&[(0., 0., 0.), (1., 0., 0.), (1., 0., 0.), (back, 0., 0.)]);
    let most = 2.0 - back;
    assert!((norm_by_edges(&worst) - 1.0).abs() < 1e-15);
    assert!((norm(&worst) - most).abs() < 1e-12, "{}", norm(&worst));
    let mut runner = TestRunner::deterministic();
    for _ in 0..2000 {
        let s = patches().new_tree(&mut runner).expect("a patch").current();
        assert!(norm(&s) <= most * norm_by_edges(&s) * (1.0 + 1e-12));
    }
}

const KINDS: [(bool, bool); 4] = [(false, false), (false, true), (true, false), (true, true)];

/// Which of the kinds a patch is: rational, of a degree over 4.
fn kind(s: &NurbsSurface) -> usize {
    let high = s.degree()[0].max(s.degree()[1]) > 4;
    KINDS.iter().position(|&k| k == (s.weights().is_some(), high)).expect("all kinds")
}

/// A row per kind with the median and the 95th percentile of every column.
fn print_quantiles<const N: usize>(columns: [&str; N], ratios: &[Vec<[f64; N]>]) {
    println!("| patches | {} |\n|{}", columns.join(" | "), "---|".repeat(N + 1));
    for ((rational, high), of_kind) in KINDS.into_iter().zip(ratios) {
        let column = |c: usize| {
            let mut all: Vec<f64> = of_kind.iter().map(|r| r[c]).collect();
            all.sort_unstable_by(f64::total_cmp);
            let at = |share: f64| all[((all.len() - 1) as f64 * share) as usize];
            let shown = |x: f64| if x < 1e4 { format!("{x:.2}") } else { format!("{x:.0e}") };
            format!("{} / {}", shown(at(0.5)), shown(at(0.95)))
        };
        let name = if rational { "rational" } else { "polynomial" };
        let degrees = if high { "to 20" } else { "1 to 4" };
        let cells: Vec<String> = (0..N).map(column).collect();
        println!("| {name}, degree {degrees} | {} |", cells.join(" | "));
    }
}

/// How tight bounds are: the bound over what was found, median and 95th percentile. Run with `--ignored
/// --nocapture`; the table stands in docs/methods.md.
#[test]
#[ignore = "prints a table, tests nothing"]
fn tightness() {
    let mut runner = TestRunner::deterministic();
    let mut ratios: Vec<Vec<[f64; 5]>> = vec![Vec::new(); KINDS.len()];
    for _ in 0..1500 {
        let s = patches().new_tree(&mut runner).expect("a patch").current();
        let found = distance_to_halves(&s, 12);
        let at_equal = largest_off_bilinear(&s, 16);
        if found < 1e-9 || at_equal < 1e-9 {
            continue;
        }
        ratios[kind(&s)].push([
            Flatness::new(&s, Measure::Conservative).error / found,
            projected_error(&s, Measure::Conservative) / found,
            SecondNorms::of_surface(&s).error(1.0, 1.0) / found,
            off_bilinear(&s) / at_equal,
            norm(&s) / norm_by_edges(&s),
        ]);
    }
    let columns = [
        "Lemmas 1 and 2",
        "projected net",
        "second derivatives",
        "E at equal parameters",
        "‖bl‖ over equation 3",
    ];
    print_quantiles(columns, &ratios);
}

/// The same for triangles of any shape, whole ones and such of 1/16 and 1/256 of the patch's side: the proof
/// of facets, second derivatives over their boxes, and 2E + ¼‖T‖ of the whole patch; and for chords, in one
/// part and in eight.
#[test]
#[ignore = "prints a table, tests nothing"]
fn tightness_for_triangles() {
    let mut runner = TestRunner::deterministic();
    let corners = prop::array::uniform4((0.0f64..=1.0, 0.0f64..=1.0));
    for size in [1.0, 1.0 / 16.0, 1.0 / 256.0] {
        let mut ratios: Vec<Vec<[f64; 5]>> = vec![Vec::new(); KINDS.len()];
        for _ in 0..1500 {
            let s = patches().new_tree(&mut runner).expect("a patch").current();
            let [from, corners @ ..] =
                corners.new_tree(&mut runner).expect("corners").current().map(DVec2::from);
            let uv = corners.map(|c| from * (1.0 - size) + c * size);
            if let Some(row) = of_triangle(&s, uv) {
                ratios[kind(&s)].push(row);
            }
        }
        println!("triangles of size {size}");
        let columns = ["proof", "second derivatives of the box", "2E + ¼‖T‖", "chord", "chord in 8 parts"];
        print_quantiles(columns, &ratios);
    }
}

/// Each bound over what was found for one triangle; none where it is a sliver or flat.
fn of_triangle(s: &NurbsSurface, mut uv: [DVec2; 3]) -> Option<[f64; 5]> {
    let area = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]);
    let b = UvBox::from_points(uv);
    if area < 0.0 {
        uv.swap(1, 2);
    }
    let xyz = uv.map(|p| s.point(p));
    let chord = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let off = |n: i32| {
            let p = s.point(uv[j].lerp(uv[k], f64::from(n) / 64.0));
            distance_to_triangle(p, [xyz[j], xyz[k], xyz[k]])
        };
        (0..=64).map(off).fold(0.0, f64::max)
    };
    let sag = [0, 1, 2].map(chord);
    let mut found = 0.0f64;
    for (i, j) in (0..=16).flat_map(|i| (0..=16 - i).map(move |j| (i, j))) {
        let w = [i, j, 16 - i - j].map(|k| f64::from(k) / 16.0);
        let p = s.point(uv[0] * w[0] + uv[1] * w[1] + uv[2] * w[2]);
        found = found.max(distance_to_triangle(p, xyz));
    }
    if area.abs() < 0.05 * b.size().x * b.size().y || found < 1e-9 || sag[0] < 1e-9 {
        return None;
    }
    let surface = Surface::Nurbs(s.clone());
    let bounds = SurfaceBounds::new(&surface, b, found);
    let mut scratch = Vec::new();
    let facet = Facet { uv, xyz, sag: sag.map(Some) };
    let whole = 2.0 * off_bilinear(s) + 0.25 * Bilinear::new(s).twist().length();
    let mut chord =
        |parts: usize| chord_bound(&bounds, [uv[1], uv[2]], [xyz[1], xyz[2]], parts, &mut scratch) / sag[0];
    let chords = [chord(1), chord(8)];
    Some([
        facet_bound(&bounds, &facet, found, &mut scratch).error / found,
        SecondNorms::of_surface(s).error(b.size().x, b.size().y) / found,
        whole / found,
        chords[0],
        chords[1],
    ])
}
