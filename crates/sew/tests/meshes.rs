//! Sewing of triangle meshes along their borders.

use chordal_nurbs::math;
use chordal_sew::{MeshSewReport, SewTolerance, SewnMesh, sew_mesh};
use glam::DVec3;
use proptest::prelude::*;

/// Separate meshes as one soup.
#[derive(Clone, Default)]
struct Soup {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// A grid of `m` × `n` cells over the unit square.
    fn grid(&mut self, m: usize, n: usize, turned: bool, at: impl Fn(f64, f64) -> DVec3) {
        let first = self.positions.len() as u32;
        for i in 0..=m {
            for j in 0..=n {
                self.positions.push(at(i as f64 / m as f64, j as f64 / n as f64));
            }
        }
        let index = |i: usize, j: usize| first + (i * (n + 1) + j) as u32;
        for i in 0..m {
            for j in 0..n {
                let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
                for [x, y, z] in [[a, b, c], [a, c, d]] {
                    self.triangles.push(if turned { [x, z, y] } else { [x, y, z] });
                }
            }
        }
    }

    fn sew(&self, tolerance: f64) -> (SewnMesh, MeshSewReport) {
        let (mesh, report) =
            sew_mesh(&self.positions, &self.triangles, SewTolerance::Length(tolerance), None);
        assert!(report.largest_move <= tolerance * (1.0 + 1e-12), "{report:?}");
        (mesh, report)
    }
}

/// The six sides of a cube as maps of the unit square, outward.
fn sides() -> [impl Fn(f64, f64) -> DVec3; 6] {
    std::array::from_fn(|side| {
        move |s: f64, t: f64| {
            let axis = side % 3;
            let up = side >= 3;
            let (s, t) = if up { (s, t) } else { (t, s) };
            let mut q = DVec3::ZERO;
            q[axis] = if up { 1.0 } else { -1.0 };
            q[(axis + 1) % 3] = 2.0 * s - 1.0;
            q[(axis + 2) % 3] = 2.0 * t - 1.0;
            q
        }
    })
}

fn volume(mesh: &SewnMesh) -> f64 {
    mesh.triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

/// A drum: its wall and its two ends are meshes of their own, with other vertices along the circles that they
/// share.
#[test]
fn auto_tells_the_chords_of_a_curve_from_its_openings() {
    let mut soup = Soup::default();
    let turn = std::f64::consts::TAU;
    soup.grid(40, 3, false, |s, t| DVec3::new(math::cos(turn * s), math::sin(turn * s), 2.0 * t));
    for (z, n) in [(0.0, 33_u32), (2.0, 47)] {
        let first = soup.positions.len() as u32;
        soup.positions.push(DVec3::Z * z);
        let rim = (0..n).map(|i| turn * (f64::from(i) + 0.3) / f64::from(n));
        soup.positions.extend(rim.map(|a| DVec3::new(math::cos(a), math::sin(a), z)));
        soup.triangles.extend((0..n).map(|i| [first, first + 1 + i, first + 1 + (i + 1) % n]));
    }
    let (mesh, report) = sew_mesh(&soup.positions, &soup.triangles, SewTolerance::Auto, Some(1e-9));
    assert_eq!((report.open_after, report.closed_shells), (0, 1), "{report:?}");
    let sag = 1.0 - math::cos(0.5 * turn / 33.0);
    assert!(report.tolerance >= sag && report.tolerance < 8.0 * sag, "{report:?}");
    assert!(report.largest_move <= report.tolerance);
    assert!((volume(&mesh).abs() / turn - 1.0).abs() < 0.02, "{}", volume(&mesh));
}

#[test]
fn a_ball_of_six_meshes_of_different_fineness_closes() {
    let mut soup = Soup::default();
    for (i, side) in sides().into_iter().enumerate() {
        soup.grid(5 + i, 7 + 2 * i, i % 2 == 1, |s, t| side(s, t).normalize());
    }
    let (mesh, report) = soup.sew(0.04);
    assert_eq!((report.open_after, report.closed_shells, report.shells), (0, 1, 1), "{report:?}");
    assert_eq!((report.inconsistent, report.folded), (0, 0));
    assert!(report.inserted > 0 && report.open_before > 0);
    let v = volume(&mesh).abs();
    assert!((v - 4.18).abs() < 0.2, "{v}");
    assert_eq!(mesh.sources.len(), mesh.triangles.len());
}

#[test]
fn a_cube_with_t_ends_keeps_its_shape() {
    let mut soup = Soup::default();
    for (i, side) in sides().into_iter().enumerate() {
        soup.grid(1 + i % 3, 1 + (i + 1) % 4, false, side);
    }
    let (mesh, report) = soup.sew(1e-6);
    assert_eq!((report.open_after, report.closed_shells, report.turned), (0, 1, 0), "{report:?}");
    assert!((volume(&mesh) - 8.0).abs() < 1e-5);
    assert!(report.largest_move < 1e-9);
}

#[test]
fn gaps_wider_than_the_tolerance_stay_open() {
    let mut soup = Soup::default();
    soup.grid(4, 4, false, |s, t| DVec3::new(s, t, 0.0));
    soup.grid(3, 5, false, |s, t| DVec3::new(s + 1.01, t, 0.0));
    let (_, report) = soup.sew(0.009);
    assert_eq!((report.sewn, report.merged, report.open_after, report.largest_move), (0, 0, 32, 0.0));
    assert!(report.open.iter().all(|o| o.nearest.is_some_and(|[low, _]| (low - 0.01).abs() < 1e-9)));
    let (_, report) = soup.sew(0.011);
    assert_eq!(report.sewn, 1);
    assert_eq!(report.open_after, 32 - 9);
    assert!((report.largest_move - 0.005).abs() < 1e-4, "both come to the middle: {}", report.largest_move);
}

#[test]
fn three_sheets_meet_in_a_line_and_are_tracked_at_once() {
    let mut soup = Soup::default();
    for (i, angle) in [0.0, 2.0, 4.0].into_iter().enumerate() {
        let turn = math::rotation(DVec3::X, angle);
        soup.grid(3 + i, 4, false, |s, t| turn * DVec3::new(s, t + 1e-4 * i as f64, 0.0));
    }
    let (mesh, report) = soup.sew(1e-3);
    assert_eq!(report.sewn, 3, "each pair of borders");
    // All three lines are one: its edges have three triangles.
    let mut uses = std::collections::BTreeMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *uses.entry((a.min(b), a.max(b))).or_insert(0) += 1;
        }
    }
    let three = uses.values().filter(|&&n| n == 3).count();
    assert!(three >= 5, "{three}");
    let line = uses.iter().filter(|(e, _)| {
        let [a, b] = [e.0, e.1].map(|v| mesh.positions[v as usize]);
        a.y.abs().max(a.z.abs()) < 2e-3 && b.y.abs().max(b.z.abs()) < 2e-3
    });
    assert!(line.map(|l| *l.1).all(|n| n == 3));
}

#[test]
fn a_sheet_rolled_into_a_tube_is_sewn_to_itself() {
    let mut soup = Soup::default();
    soup.grid(40, 5, false, |s, t| {
        let angle = 0.002 + s * (std::f64::consts::TAU - 0.004);
        DVec3::new(math::cos(angle), math::sin(angle), t)
    });
    let (_, report) = soup.sew(0.01);
    // Two stretches: the border begins in one of its corners.
    assert!(report.sewn <= 2);
    assert_eq!((report.open_after, report.open.len()), (80, 2), "{report:?}");
    assert!(report.open.iter().all(|o| o.nearest.is_some_and(|[low, high]| low > 0.99 && high < 1.01)));
}

#[test]
fn auto_finds_the_empty_range() {
    let mut soup = Soup::default();
    for (i, side) in sides().into_iter().enumerate().take(5) {
        soup.grid(20 + i, 27 + 2 * i, false, |s, t| side(s, t).normalize());
    }
    let (_, report) = sew_mesh(&soup.positions, &soup.triangles, SewTolerance::Auto, None);
    let auto = report.auto.as_ref().expect("a survey");
    assert!(auto.clear, "{auto:?}");
    // One side of the ball is missing, and stays so.
    assert_eq!((report.open.len(), report.shells), (1, 1), "{report:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Two sheets with a common curved border of different fineness, both moved about a little: one border is
    /// left.
    #[test]
    fn curved_borders_of_any_fineness_are_sewn(
        m in 2_usize..30, n in 2_usize..30, bend in 0.0..0.5_f64,
        jitter in prop::collection::vec(-1.0..1.0_f64, 40), turned in any::<bool>(),
    ) {
        let curve = |t: f64| DVec3::new(bend * math::sin(3.0 * t), t, bend * t * t);
        let sag = 9.0 * bend / 8.0 / math::square(m.min(n) as f64);
        let tolerance = 3.0 * sag + 2e-3;
        prop_assume!(tolerance < 0.4 / m.max(n) as f64);
        let wobble = |t: f64, k: usize| {
            let i = (t * 37.0).round() as usize + k;
            DVec3::new(jitter[i % 40], jitter[(i + 11) % 40], jitter[(i + 23) % 40]) * 3e-4
        };
        let mut soup = Soup::default();
        soup.grid(4, m, false, |s, t| curve(t) + DVec3::X * (s - 1.0) + wobble(t, 0));
        soup.grid(4, n, turned, |s, t| curve(t) + DVec3::X * s + wobble(t, 17));
        let (mesh, report) = soup.sew(tolerance);
        prop_assert_eq!((report.shells, report.open.len(), report.inconsistent), (1, 1, 0), "{:?}", report);
        prop_assert_eq!(report.open_after, 16 + m + n);
        // Every vertex of the result has a given vertex, or a point of a border, within the tolerance.
        for p in &mesh.positions {
            let near = soup.positions.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
            prop_assert!(near <= tolerance + 1.0 / m.min(n) as f64);
        }
    }
}
