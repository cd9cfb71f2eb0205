use super::*;
use crate::halves::Halves;
use chordal_mesh::{Corner, FaceMesh};
use chordal_nurbs::{Curve, Facet, Frame, NurbsSurface, SurfaceBounds, facet_bound, math};

/// A grid of two triangles per cell over a box of parameters.
fn grid(surface: &Surface, within: UvBox, cells: u32) -> FaceMesh {
    let at = |i: u32, j: u32| {
        let share = DVec2::new(f64::from(i), f64::from(j)) / f64::from(cells);
        let uv = within.min + share * within.size();
        Corner { position: 0, uv, normal: surface.normal(uv).unwrap_or(DVec3::Z) }
    };
    let index = |i: u32, j: u32| i * (cells + 1) + j;
    let corners = (0..=cells).flat_map(|i| (0..=cells).map(move |j| at(i, j))).collect();
    let cell = |k: u32| {
        let (i, j) = (k / cells, k % cells);
        let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    FaceMesh { corners, triangles: (0..cells * cells).flat_map(cell).collect(), ..FaceMesh::default() }
}

fn chart<'a>(surface: &'a Surface, mesh: &'a FaceMesh) -> Chart<'a> {
    let mut chart = Chart::of(surface, mesh, 1.0, 0.0);
    chart.xyz = mesh.corners.iter().map(|c| surface.point(c.uv)).collect();
    chart
}

/// The largest bound of the facets by `chordal_nurbs`, about as tight as it gets.
fn first_bound(chart: &Chart<'_>) -> f64 {
    let mut enough = 1.0;
    let mut bound = first_bound_within(chart, enough);
    while bound <= enough {
        enough = 0.95 * bound;
        bound = first_bound_within(chart, enough);
    }
    enough / 0.95
}

fn first_bound_within(chart: &Chart<'_>, enough: f64) -> f64 {
    let bounds = SurfaceBounds::new(chart.surface, chart.uv_box, 1e-9);
    let bound = |t: &[u32; 3]| {
        let uv = t.map(|c| chart.mesh.corners[c as usize].uv);
        let xyz = t.map(|c| chart.xyz[c as usize]);
        facet_bound(&bounds, &Facet { uv, xyz, sag: [None; 3] }, enough, &mut Vec::new()).error
    };
    chart.mesh.triangles.iter().map(bound).fold(0.0, f64::max)
}

/// A patch with heights over a square; `height` of the control points.
fn patch(count: usize, weights: bool, height: impl Fn(usize, usize) -> f64) -> Surface {
    let knots: Vec<f64> =
        (0..count + 4).map(|i| (i.clamp(3, count) - 3) as f64 / (count - 3) as f64).collect();
    let share = |i: usize| (knots[i + 1] + knots[i + 2] + knots[i + 3]) / 3.0;
    let all = || (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
    let points = all().map(|(i, j)| DVec3::new(share(i), share(j), height(i, j))).collect();
    let weights = weights.then(|| all().map(|(i, j)| 1.0 + 0.3 * ((i * 7 + j * 5) % 4) as f64).collect());
    Surface::Nurbs(
        NurbsSurface::new([3, 3], knots.clone(), knots.clone(), points, weights).expect("a surface"),
    )
}

fn surfaces() -> Vec<(&'static str, Surface, UvBox)> {
    let square = UvBox::new(DVec2::ZERO, DVec2::ONE);
    let angles = UvBox::new(DVec2::new(0.2, 0.1), DVec2::new(1.4, 1.2));
    let frame = Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X);
    let wave = |i: usize, j: usize| 0.1 * math::sin(1.3 * i as f64) * math::cos(0.9 * j as f64);
    let circle = Curve::Circle { frame, radius: 0.7 };
    let profile =
        Curve::Circle { frame: Frame::new(DVec3::new(1.0, 0.0, 0.0), -DVec3::Y, DVec3::X), radius: 0.3 };
    vec![
        ("patch", patch(6, false, wave), square),
        ("rational patch", patch(6, true, wave), square),
        ("cylinder", Surface::Cylinder { frame, radius: 0.5 }, angles),
        ("cone", Surface::Cone { frame, radius: 0.5, half_angle: 0.4 }, angles),
        ("sphere", Surface::Sphere { frame, radius: 0.5 }, angles),
        ("torus", Surface::Torus { frame, major: 1.0, minor: 0.3 }, angles),
        ("extrusion", Surface::Extrusion { profile: circle, direction: DVec3::Z }, angles),
        ("revolution", Surface::Revolution { profile, axis_origin: DVec3::ZERO, axis: DVec3::Z }, angles),
    ]
}

/// What the second bound says of all facets of a mesh against a limit: how many it confirms, and whether it
/// refutes the limit.
fn outcome(chart: &Chart<'_>, limit: f64) -> (usize, bool) {
    let all: Vec<Pick> =
        (0..chart.mesh.triangles.len()).map(|triangle| Pick { triangle, is_bounded: true }).collect();
    let mut sides = vec![[Side::Inner; 3]; all.len()];
    for half in Halves::of(&chart.mesh.triangles, chart.mesh.corners.len()).single {
        sides[half.triangle as usize][half.side as usize] = Side::Chord(0.0);
    }
    let second = SecondBound { chart, sides: &sides, simple: None, limit, enough: limit * (1.0 + SLACK) };
    let confirmed = all.iter().filter(|&&pick| second.judge(pick, true).is_confirmed).count();
    (confirmed, second.refuted(&all).is_some())
}

#[test]
fn a_sound_bound_is_confirmed() {
    for (name, surface, within) in surfaces() {
        let mesh = grid(&surface, within, 6);
        let chart = chart(&surface, &mesh);
        let bound = first_bound(&chart);
        assert!(bound.is_finite(), "{name}");
        let (confirmed, refuted) = outcome(&chart, bound);
        assert!(!refuted, "{name}: {bound}");
        assert!(
            10 * confirmed >= 9 * mesh.triangles.len(),
            "{name}: {confirmed} of {}",
            mesh.triangles.len()
        );
    }
}

#[test]
fn an_unsound_bound_is_refuted() {
    for (name, surface, within) in surfaces() {
        let mesh = grid(&surface, within, 6);
        let chart = chart(&surface, &mesh);
        // As if the bound of `chordal_nurbs` were wrong by a fifth.
        let (_, refuted) = outcome(&chart, 0.8 * first_bound(&chart));
        assert!(refuted, "{name}");
    }
}

#[test]
fn a_bump_between_points_is_found() {
    // A flat patch with one control point raised, far from all fifteen points of a facet's lattice.
    let surface = patch(40, false, |i, j| if (i, j) == (11, 8) { 0.02 } else { 0.0 });
    let mesh = grid(&surface, UvBox::new(DVec2::ZERO, DVec2::ONE), 1);
    let chart = chart(&surface, &mesh);
    let seen = |parts: u32| {
        let at = |i: u32, j: u32| DVec2::new(f64::from(i), f64::from(j)) / f64::from(parts);
        let points = (0..=parts).flat_map(|i| (0..=parts).map(move |j| at(i, j)));
        points.map(|uv| surface.point(uv).z).fold(0.0, f64::max)
    };
    assert!(seen(4) < 1e-4 && seen(200) > 5e-3, "{} {}", seen(4), seen(200));
    assert_eq!(outcome(&chart, 1e-3).0, 1, "the other facet is flat");
    assert!(outcome(&chart, 1e-3).1);
}

#[test]
fn points_beyond_the_end_of_a_face_refute_nothing() {
    // One facet of a cone, and nothing beside it: the straight side of its parameters bulges over its chord,
    // and is farther from the facet's plane than any point of the cone over the facet.
    let frame = Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X);
    let surface = Surface::Cone { frame, radius: 20.0, half_angle: 0.896 };
    let corners = [[0.0, 0.0], [0.1, 0.0], [0.22, 2.3]].map(|[u, v]| DVec2::new(u, v));
    let corner = |uv| Corner { position: 0, uv, normal: surface.normal(uv).unwrap_or(DVec3::Z) };
    let mesh =
        FaceMesh { corners: corners.map(corner).to_vec(), triangles: vec![[0, 1, 2]], ..FaceMesh::default() };
    let chart = chart(&surface, &mesh);
    let bound = first_bound(&chart);
    assert!(!outcome(&chart, bound).1, "{bound}");
    let [a, b, c] = corners.map(|uv| surface.point(uv));
    let normal = (b - a).cross(c - a).normalize();
    let middle = surface.point(corners[0].midpoint(corners[2]));
    assert!((middle - a).dot(normal).abs() > 1.05 * bound, "the side bulges less than it must for this test");
    assert!(outcome(&chart, 0.3 * bound).1, "what lies over the facet is still looked at");
}
