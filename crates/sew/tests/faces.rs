//! Sewing of loose faces: what is joined, cut, turned and closed.

use chordal_brep::{
    BodyKind, Coedge, Edge, EdgeId, Face, FaceGeometry, Loop, Part, Source, Vertex, VertexId,
};
use chordal_nurbs::{Curve, DVec3, Frame, Range, Surface, math};
use chordal_sew::{SewReport, SewTolerance, sew_part};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Builds islands.
#[derive(Default)]
struct Islands {
    part: Part,
}

impl Islands {
    fn vertex(&mut self, p: DVec3) -> VertexId {
        self.part.vertices.push(Vertex { point: p, source: Source::default() });
        VertexId::from(self.part.vertices.len() - 1)
    }

    fn edge(&mut self, curve: Curve, range: Range, start: VertexId, end: VertexId) -> EdgeId {
        self.part.edges.push(Edge {
            curve: Some(Arc::new(curve)),
            range,
            start,
            end,
            source: Source::default(),
        });
        EdgeId::from(self.part.edges.len() - 1)
    }

    fn face(&mut self, surface: Surface, loops: Vec<Vec<(EdgeId, bool)>>, same_sense: bool) {
        let coedge = |(edge, forward)| Coedge { edge, forward, pcurves: Vec::new() };
        let one = |l: Vec<(EdgeId, bool)>| Loop::Edges {
            coedges: l.into_iter().map(coedge).collect(),
            outer: true,
        };
        self.part.faces.push(Face {
            geometry: FaceGeometry::Surface(Arc::new(surface)),
            same_sense,
            flipped: false,
            loops: loops.into_iter().map(one).collect(),
            name: String::new(),
            color: None,
            layer: None,
            source: Source::default(),
        });
    }

    /// A flat face; its normal is that of the polygon, and it is seen from behind where `turned`.
    fn polygon(&mut self, points: &[DVec3], turned: bool) {
        let mut points = points.to_vec();
        if turned {
            points.reverse();
        }
        let n = points.len();
        let normal: DVec3 =
            (0..n).map(|i| (points[i] - points[0]).cross(points[(i + 1) % n] - points[0])).sum();
        let plane = Surface::Plane { frame: Frame::new(points[0], normal, points[1] - points[0]) };
        let vertices: Vec<VertexId> = points.iter().map(|&p| self.vertex(p)).collect();
        let sides = (0..n)
            .map(|i| {
                let (a, b) = (points[i], points[(i + 1) % n]);
                let line = Curve::Line { origin: a, direction: b - a };
                (self.edge(line, Range::new(0.0, 1.0), vertices[i], vertices[(i + 1) % n]), true)
            })
            .collect();
        self.face(plane, vec![sides], true);
    }

    fn sew(&self, tolerance: f64) -> (Part, SewReport) {
        let (part, report) = sew_part(&self.part, SewTolerance::Length(tolerance));
        check(&part, &report);
        (part, report)
    }
}

/// What holds for every sewn part.
fn check(part: &Part, report: &SewReport) {
    assert!(report.largest_move <= report.tolerance * (1.0 + 1e-12), "{report:?}");
    for face in &part.faces {
        for a_loop in &face.loops {
            let Loop::Edges { coedges, .. } = a_loop else { continue };
            for (i, coedge) in coedges.iter().enumerate() {
                let next = &coedges[(i + 1) % coedges.len()];
                let edge = &part.edges[coedge.edge.index()];
                let after = &part.edges[next.edge.index()];
                let end = if coedge.forward { edge.end } else { edge.start };
                let start = if next.forward { after.start } else { after.end };
                assert_eq!(end, start, "loops stay closed");
                let curve = edge.curve.as_ref().expect("edges of these tests have curves");
                for (t, v) in [(edge.range.start, edge.start), (edge.range.end, edge.end)] {
                    let off = curve.point(t).distance(part.vertices[v.index()].point);
                    assert!(off <= 2.0 * report.tolerance + 1e-9, "{off}");
                }
            }
        }
    }
    let members: usize = part.shells.iter().map(|s| s.faces.len()).sum();
    assert!(report.sewn == 0 || members == part.faces.len(), "every face is in one shell");
}

fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A rectangle in the plane z = `z`.
fn flat(x: [f64; 2], y: [f64; 2], z: f64) -> [DVec3; 4] {
    [p(x[0], y[0], z), p(x[1], y[0], z), p(x[1], y[1], z), p(x[0], y[1], z)]
}

/// The six sides of a box, outward.
fn cube(low: DVec3, high: DVec3) -> Vec<[DVec3; 4]> {
    let c = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 1 { high[axis] } else { low[axis] };
        p(pick(0), pick(1), pick(2))
    };
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .map(|side| side.map(c))
        .to_vec()
}

fn used_twice(part: &Part) -> usize {
    let mut uses = vec![0; part.edges.len()];
    for face in &part.faces {
        for a_loop in &face.loops {
            if let Loop::Edges { coedges, .. } = a_loop {
                coedges.iter().for_each(|c| uses[c.edge.index()] += 1);
            }
        }
    }
    uses.iter().filter(|&&n| n == 2).count()
}

#[test]
fn two_faces_with_a_common_side_share_it() {
    let mut islands = Islands::default();
    islands.polygon(&flat([0.0, 1.0], [0.0, 1.0], 0.0), false);
    islands.polygon(&flat([1.0, 2.0], [0.0, 1.0], 0.0), false);
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.sewn, report.open.len(), report.shells, report.closed_shells), (1, 6, 1, 0));
    assert_eq!((part.vertices.len(), part.edges.len(), used_twice(&part)), (6, 7, 1));
    assert_eq!(report.largest_move, 0.0);
    // The middle of the side at the left is half a unit from the one below it, which is no opening; all
    // others are as far.
    assert!(report.open.iter().all(|o| o.nearest.is_some_and(|d| d > 0.4)));
}

#[test]
fn a_long_side_is_cut_at_the_ends_of_short_ones() {
    let mut islands = Islands::default();
    islands.polygon(&flat([0.0, 3.0], [-1.0, 0.0], 0.0), false);
    for i in 0..3 {
        islands.polygon(&flat([f64::from(i), f64::from(i) + 1.0], [0.0, 1.0], 0.0), false);
    }
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.cuts, report.sewn, report.shells), (2, 5, 1));
    assert_eq!(used_twice(&part), 5);
    let Loop::Edges { coedges, .. } = &part.faces[0].loops[0] else { panic!("edges") };
    assert_eq!(coedges.len(), 6);
}

#[test]
fn partial_overlaps_are_cut_on_both_sides() {
    let mut islands = Islands::default();
    islands.polygon(&flat([0.0, 2.0], [-1.0, 0.0], 0.0), false);
    islands.polygon(&flat([1.0, 3.0], [0.0, 1.0], 0.0), false);
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.cuts, report.sewn, used_twice(&part)), (2, 1, 1));
}

#[test]
fn three_faces_meet_at_an_edge() {
    let mut islands = Islands::default();
    for angle in [0.0, 2.0, 4.0] {
        let far = DVec3::new(0.0, math::cos(angle), math::sin(angle));
        islands.polygon(&[DVec3::ZERO, DVec3::X, DVec3::X + far, far], false);
    }
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.sewn, report.shared_by_more, report.open.len()), (1, 1, 9));
    assert_eq!((part.edges.len(), part.vertices.len()), (10, 8));
}

#[test]
fn the_tolerance_is_what_decides() {
    let gap = 0.01;
    let mut islands = Islands::default();
    islands.polygon(&flat([0.0, 1.0], [0.0, 1.0], 0.0), false);
    islands.polygon(&flat([1.0 + gap, 2.0], [0.0, 1.0], 0.0), false);
    let (_, just_over) = islands.sew(gap * 1.0001);
    assert_eq!(just_over.sewn, 1);
    assert!(just_over.largest_move > 0.49 * gap);
    let (same, just_under) = islands.sew(gap * 0.9999);
    assert_eq!((just_under.sewn, just_under.open.len()), (0, 8));
    assert_eq!(same.vertices, islands.part.vertices);
    let nearest: Vec<f64> = just_under.open.iter().filter_map(|o| o.nearest).collect();
    assert!(nearest.iter().filter(|d| (**d - gap).abs() < 1e-12).count() == 2, "{nearest:?}");
}

#[test]
fn a_cube_of_six_islands_is_a_solid_whatever_way_they_face() {
    for bits in [0_u32, 0b000001, 0b101010, 0b111110, 0b111111] {
        let mut islands = Islands::default();
        for (i, side) in cube(p(1.0, 2.0, 3.0), p(2.0, 4.0, 4.0)).iter().enumerate() {
            islands.polygon(side, bits >> i & 1 == 1);
        }
        let (part, report) = islands.sew(1e-6);
        assert_eq!((report.sewn, report.open.len(), report.closed_shells), (12, 0, 1));
        assert_eq!((part.vertices.len(), part.edges.len()), (8, 12));
        assert_eq!(part.bodies.iter().map(|b| b.kind).collect::<Vec<_>>(), [BodyKind::Solid]);
        assert!(part.shells[0].closed);
        assert_eq!(report.contradictions, 0);
        // Outward: the normal of each face points away from the middle.
        for face in &part.faces {
            let FaceGeometry::Surface(surface) = &face.geometry else { panic!("a plane") };
            let Surface::Plane { frame } = surface.as_ref() else { panic!("a plane") };
            let out = if face.normal_reversed() { -frame.z } else { frame.z };
            assert!(out.dot(frame.origin - p(1.5, 3.0, 3.5)) > 0.0, "{bits:b}");
        }
    }
}

/// A plate with a hole whose loop runs the wrong way, and the wall of a peg in it.
#[test]
fn holes_that_run_the_wrong_way_turn_nobody_over() {
    for wrong in [false, true] {
        let mut islands = Islands::default();
        islands.polygon(&flat([0.0, 3.0], [0.0, 3.0], 0.0), false);
        let hole = flat([1.0, 2.0], [1.0, 2.0], 0.0);
        let before = islands.part.faces.len();
        islands.polygon(&hole, !wrong);
        let ring = islands.part.faces.remove(before).loops;
        islands.part.faces[0].loops.extend(ring);
        for i in 0..4 {
            let (a, b) = (hole[i], hole[(i + 1) % 4]);
            islands.polygon(&[a, b, b + DVec3::Z, a + DVec3::Z], false);
        }
        let (part, report) = islands.sew(1e-6);
        assert_eq!((report.sewn, report.contradictions, report.shells), (8, 0, 1), "{wrong}");
        // The walls of the peg agree with each other and with the plate: all or none are turned.
        let flipped: Vec<bool> = part.faces.iter().map(|f| f.flipped).collect();
        assert!(flipped.iter().all(|f| *f == flipped[0]), "{wrong}: {flipped:?}");
    }
}

#[test]
fn stacked_cubes_stay_two_solids() {
    let mut islands = Islands::default();
    for z in [0.0, 1.0] {
        cube(p(0.0, 0.0, z), p(1.0, 1.0, z + 1.0)).iter().for_each(|side| islands.polygon(side, false));
    }
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.closed_shells, report.open.len()), (2, 0));
    assert!(part.shells.iter().all(|s| s.faces.len() == 6), "each keeps its own faces");
}

#[test]
fn a_shell_in_a_shell_is_a_void_and_one_in_that_is_a_solid() {
    let mut islands = Islands::default();
    for (k, size) in [4.0, 3.0, 2.0].into_iter().enumerate() {
        let sides = cube(DVec3::splat(-size), DVec3::splat(size));
        // The inner two are put in order first.
        sides.iter().enumerate().for_each(|(i, side)| islands.polygon(side, k > 0 && i == 2));
    }
    cap(&mut islands, 0.5, 0.0, true);
    bowl(&mut islands, 0.5, 0.0);
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.closed_shells, report.open.len()), (4, 0));
    let shells: Vec<usize> = part.bodies.iter().map(|b| b.shells.len()).collect();
    assert_eq!(shells.iter().sum::<usize>(), 4);
    assert_eq!(shells[0], 2, "the largest has the second as its void: {shells:?}");
}

/// Half of a cylinder's wall, from angle `from`, with `same_sense`.
fn half_wall(islands: &mut Islands, from: f64, offset: DVec3) {
    let frame = Frame { origin: offset, ..Frame::WORLD };
    let top = Frame { origin: offset + DVec3::Z * 2.0, ..frame };
    let corner = |f: &Frame, angle: f64| f.origin + f.radial(angle);
    let points =
        [corner(&frame, from), corner(&frame, from + PI), corner(&top, from + PI), corner(&top, from)];
    let v = points.map(|q| islands.vertex(q));
    let arc = Range::new(from, from + PI);
    let line = |a: DVec3, b: DVec3| Curve::Line { origin: a, direction: b - a };
    let bottom = islands.edge(Curve::Circle { frame, radius: 1.0 }, arc, v[0], v[1]);
    let right = islands.edge(line(points[1], points[2]), Range::new(0.0, 1.0), v[1], v[2]);
    let above = islands.edge(Curve::Circle { frame: top, radius: 1.0 }, arc, v[3], v[2]);
    let left = islands.edge(line(points[0], points[3]), Range::new(0.0, 1.0), v[0], v[3]);
    let sides = vec![(bottom, true), (right, true), (above, false), (left, false)];
    islands.face(Surface::Cylinder { frame, radius: 1.0 }, vec![sides], true);
}

/// A cap whose circle begins at `seam`, facing up or down.
fn cap(islands: &mut Islands, z: f64, seam: f64, up: bool) {
    let frame = Frame { origin: DVec3::Z * z, ..Frame::WORLD };
    let v = islands.vertex(frame.origin + frame.radial(seam));
    let ring = islands.edge(Curve::Circle { frame, radius: 1.0 }, Range::new(seam, seam + TAU), v, v);
    islands.face(Surface::Plane { frame }, vec![vec![(ring, up)]], up);
}

#[test]
fn two_half_walls_and_two_caps_are_a_solid() {
    let mut islands = Islands::default();
    half_wall(&mut islands, 0.3, DVec3::ZERO);
    half_wall(&mut islands, 0.3 + PI, DVec3::new(1e-4, -1e-4, 0.0));
    cap(&mut islands, 0.0, 1.0, false);
    cap(&mut islands, 2.0, 4.0, true);
    let (part, report) = islands.sew(1e-3);
    assert_eq!((report.closed_shells, report.open.len()), (1, 0), "{report:?}");
    // The caps' circles are cut at the walls' seams, and the walls' arcs at the circles' ends.
    assert_eq!(report.cuts, 6);
    assert_eq!((part.edges.len(), part.vertices.len()), (8, 6));
    assert!(report.largest_move > 5e-5);
}

/// The lower half of a ball under the plane z = `z`.
fn bowl(islands: &mut Islands, z: f64, seam: f64) {
    let frame = Frame { origin: DVec3::Z * z, ..Frame::WORLD };
    let v = islands.vertex(frame.origin + frame.radial(seam));
    let ring = islands.edge(Curve::Circle { frame, radius: 1.0 }, Range::new(seam, seam + TAU), v, v);
    islands.face(Surface::Sphere { frame, radius: 1.0 }, vec![vec![(ring, false)]], true);
}

#[test]
fn rings_that_begin_elsewhere_are_one_edge_of_two_pieces() {
    let mut islands = Islands::default();
    cap(&mut islands, 0.0, 0.5, true);
    bowl(&mut islands, 0.0, 2.5);
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.cuts, report.sewn, report.open.len()), (2, 2, 0));
    assert_eq!((part.edges.len(), part.vertices.len(), report.closed_shells), (2, 2, 1));
    // And with the same beginning, run either way, one ring.
    let mut islands = Islands::default();
    cap(&mut islands, 0.0, 0.5, true);
    bowl(&mut islands, 1e-7, 0.5);
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.cuts, report.sewn, part.edges.len()), (0, 1, 1));
    assert_eq!(report.turned, 0, "it faces outward already");
}

#[test]
fn copies_of_a_face_are_not_sewn_to_each_other() {
    let mut islands = Islands::default();
    for turned in [false, true, false] {
        islands.polygon(&flat([0.0, 1.0], [0.0, 1.0], 0.0), turned);
    }
    cap(&mut islands, 5.0, 0.5, true);
    cap(&mut islands, 5.0, 0.5, false);
    let (_, report) = islands.sew(1e-6);
    assert_eq!((report.sewn, report.closed_shells), (0, 0));
}

#[test]
fn a_seam_of_two_edges_is_closed_and_a_thin_face_is_not() {
    let mut islands = Islands::default();
    let frame = Frame::WORLD;
    let top = Frame { origin: DVec3::Z * 2.0, ..frame };
    let [a, b, c, d] = [frame, frame, top, top].map(|f| islands.vertex(f.origin + f.radial(0.0)));
    let full = Range::new(0.0, TAU);
    let line = Curve::Line { origin: DVec3::X, direction: DVec3::Z * 2.0 };
    let bottom = islands.edge(Curve::Circle { frame, radius: 1.0 }, full, a, b);
    let right = islands.edge(line.clone(), Range::new(0.0, 1.0), b, c);
    let above = islands.edge(Curve::Circle { frame: top, radius: 1.0 }, full, d, c);
    let left = islands.edge(line, Range::new(0.0, 1.0), a, d);
    let sides = vec![(bottom, true), (right, true), (above, false), (left, false)];
    islands.face(Surface::Cylinder { frame, radius: 1.0 }, vec![sides], true);
    let (part, report) = islands.sew(1e-6);
    assert_eq!((report.sewn, report.open.len()), (1, 2));
    assert_eq!(part.vertices.len(), 2);
    // A strip thinner than the tolerance keeps its two sides.
    let mut islands = Islands::default();
    islands.polygon(&flat([0.0, 1.0], [0.0, 1e-4], 0.0), false);
    let (_, report) = islands.sew(1e-3);
    assert_eq!(report.sewn, 0);
}

#[test]
fn an_edge_shorter_than_the_tolerance_does_not_keep_neighbours_apart() {
    let mut islands = Islands::default();
    let d = 4e-4;
    // Its corner is cut off; the neighbours meet in a point there.
    islands.polygon(
        &[p(0.0, 0.0, 0.0), p(1.0 - d, 0.0, 0.0), p(1.0, d, 0.0), p(1.0, 1.0, 0.0), p(0.0, 1.0, 0.0)],
        false,
    );
    islands.polygon(&flat([1.0, 2.0], [0.0, 1.0], 0.0), false);
    islands.polygon(&flat([0.0, 1.0], [-1.0, 0.0], 0.0), false);
    let (part, report) = islands.sew(1e-3);
    assert_eq!((report.open.len(), report.shells), (8, 1), "{report:?}");
    assert!(used_twice(&part) >= 2);
}

#[test]
fn edges_that_are_shared_already_are_not_touched() {
    let mut islands = Islands::default();
    islands.polygon(&flat([0.0, 1.0], [0.0, 1.0], 0.0), false);
    islands.polygon(&flat([1.0, 2.0], [0.0, 1.0], 0.0), false);
    let (joined, _) = islands.sew(1e-6);
    let mut more = Islands { part: joined.clone() };
    more.polygon(&flat([0.0, 2.0], [-1.0, -1e-4], 0.0), false);
    let (part, report) = more.sew(1e-3);
    assert_eq!((report.sewn, report.cuts), (2, 1));
    // The vertices of the shared edge stay where they are, and the new face comes to them.
    let shared = |part: &Part| {
        let edge = part.edges.iter().find(|e| {
            let middle = e.curve.as_ref().unwrap().point(0.5 * (e.range.start + e.range.end));
            middle.distance(p(1.0, 0.5, 0.0)) < 1e-9
        });
        edge.map(|e| [part.vertices[e.start.index()].point, part.vertices[e.end.index()].point])
    };
    assert_eq!(shared(&part), shared(&joined));
}

/// A box whose sides are cut into rectangles, each moved a little.
fn loose_box(cuts: &[Vec<f64>; 3], jitter: &[f64], turned: &[bool]) -> Islands {
    let mut islands = Islands::default();
    let mut k = 0;
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for end in [0.0, 1.0] {
            // Other cuts on opposite sides: T-ends everywhere.
            let own = |a: usize| -> Vec<f64> {
                let skip = usize::from(end == 1.0);
                let mut c = vec![0.0];
                c.extend(cuts[a].iter().skip(skip * (axis + a) % 2).copied());
                c.push(1.0);
                c
            };
            for x in own(u).windows(2) {
                for y in own(v).windows(2) {
                    let corner = |s: f64, t: f64| {
                        let mut q = DVec3::ZERO;
                        (q[axis], q[u], q[v]) = (end, s, t);
                        q
                    };
                    let mut points =
                        vec![corner(x[0], y[0]), corner(x[1], y[0]), corner(x[1], y[1]), corner(x[0], y[1])];
                    for q in &mut points {
                        *q += DVec3::from(std::array::from_fn(|i| jitter[(k * 7 + i) % jitter.len()]));
                        k += 1;
                    }
                    let flip = turned[k % turned.len()] ^ (end == 0.0);
                    islands.polygon(&points, flip);
                }
            }
        }
    }
    islands
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// A box of loose patches closes at a tolerance a few times their jitter, and no vertex moves further
    /// than that.
    #[test]
    fn loose_boxes_close(
        cuts in prop::array::uniform3(prop::collection::vec(1..9_u32, 0..4)),
        jitter in prop::collection::vec(-1e-4..1e-4_f64, 50..80),
        turned in prop::collection::vec(any::<bool>(), 20..40),
    ) {
        let cuts = cuts.map(|mut c| {
            c.sort_unstable();
            c.dedup();
            c.iter().map(|&i| f64::from(i) / 10.0).collect::<Vec<f64>>()
        });
        let islands = loose_box(&cuts, &jitter, &turned);
        let (part, report) = islands.sew(1e-3);
        prop_assert_eq!(report.open.len(), 0, "{:?}", report);
        prop_assert_eq!((report.closed_shells, report.shells, report.contradictions), (1, 1, 0));
        prop_assert_eq!(part.bodies.len(), 1);
        // The same, whatever the order of the faces.
        let mut other = Islands { part: islands.part.clone() };
        other.part.faces.reverse();
        let (_, again) = other.sew(1e-3);
        prop_assert_eq!(again.open.len(), 0);
    }

    /// Openings wider than the tolerance stay, whatever lies around.
    #[test]
    fn openings_stay(gap in 2e-3..0.1_f64, along in 0.0..0.9_f64) {
        let mut islands = Islands::default();
        islands.polygon(&flat([0.0, 1.0], [0.0, 1.0], 0.0), false);
        islands.polygon(&flat([1.0 + gap, 2.0], [along, along + 1.0], 0.0), false);
        let (_, report) = islands.sew(1e-3);
        prop_assert_eq!((report.sewn, report.largest_move), (0, 0.0));
    }
}
