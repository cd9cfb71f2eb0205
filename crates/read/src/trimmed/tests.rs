use super::*;
use chordal_brep::{Coedge, EdgeId};
use chordal_nurbs::{DVec3, NurbsCurve2, NurbsSurface, math};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// A bumpy patch over 0..2 × 0..3.
fn patch() -> Arc<Surface> {
    let mut points = Vec::new();
    for i in 0..4 {
        for j in 0..4 {
            let (x, y) = (f64::from(i), f64::from(j));
            points.push(DVec3::new(x, y, math::sin(x * 1.1) * math::cos(y * 0.7)));
        }
    }
    let knots = |end: f64| vec![0.0, 0.0, 0.0, 0.0, end, end, end, end];
    Arc::new(Surface::Nurbs(NurbsSurface::new([3, 3], knots(2.0), knots(3.0), points, None).unwrap()))
}

/// A tube of radius 1 with u round it, or a ball where `radii` end in zero.
fn round(radii: &[f64]) -> Arc<Surface> {
    let w = FRAC_1_SQRT_2;
    let ring =
        [[1., 0.], [1., 1.], [0., 1.], [-1., 1.], [-1., 0.], [-1., -1.], [0., -1.], [1., -1.], [1., 0.]];
    let mut points = Vec::new();
    let mut weights = Vec::new();
    for (i, [x, y]) in ring.iter().enumerate() {
        for (j, r) in radii.iter().enumerate() {
            points.push(DVec3::new(x * r, y * r, j as f64));
            weights.push(if i % 2 == 1 { w } else { 1.0 });
        }
    }
    let knots_u = vec![0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.];
    let n = radii.len() - 1;
    let knots_v = [vec![0.0; n + 1], vec![1.0; n + 1]].concat();
    Arc::new(Surface::Nurbs(NurbsSurface::new([2, n], knots_u, knots_v, points, Some(weights)).unwrap()))
}

fn rectangle(a: [f64; 2], b: [f64; 2]) -> TrimLoop {
    let corners = [DVec2::from(a), DVec2::new(b[0], a[1]), DVec2::from(b), DVec2::new(a[0], b[1])];
    let pieces = (0..4).map(|k| Piece::line(corners[k], corners[(k + 1) % 4])).collect();
    TrimLoop { pieces, role: Role::ByNesting(Winding::Odd), source: Source::default() }
}

impl Piece {
    fn reversed(mut self) -> Self {
        self.forward = !self.forward;
        self
    }
}

fn backwards(mut trim: TrimLoop) -> TrimLoop {
    trim.pieces = trim.pieces.into_iter().rev().map(Piece::reversed).collect();
    trim
}

fn made(surface: &Arc<Surface>, trims: &[TrimLoop]) -> (Part, Vec<Issue>) {
    let mut part = Part::default();
    let notes = Notes::default();
    let faces = add_faces(&mut part, surface, trims, &Look::default(), &notes);
    assert_eq!(faces.len(), part.faces.len());
    check(&part, surface);
    (part, notes.take())
}

fn coedges(boundary: &Loop) -> &[Coedge] {
    match boundary {
        Loop::Edges { coedges, .. } => coedges,
        _ => panic!("loops of edges only"),
    }
}

/// Loops close by vertices, edges end in their vertices, parameter curves follow their edges.
fn check(part: &Part, surface: &Surface) {
    let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-9, "{a} {b}");
    for coedges in part.faces.iter().flat_map(|f| &f.loops).map(coedges) {
        for (i, coedge) in coedges.iter().enumerate() {
            let ends = |c: &Coedge| {
                let edge = &part.edges[c.edge.index()];
                if c.forward { [edge.start, edge.end] } else { [edge.end, edge.start] }
            };
            assert_eq!(ends(coedge)[1], ends(&coedges[(i + 1) % coedges.len()])[0]);
            let edge = &part.edges[coedge.edge.index()];
            let Some(curve) = &edge.curve else { continue };
            near(curve.point(edge.range.start), part.vertices[edge.start.index()].point);
            near(curve.point(edge.range.end), part.vertices[edge.end.index()].point);
            let pcurve = &coedge.pcurves[0];
            for k in 0..=10 {
                let at = |r: Range| r.start + r.length() * f64::from(k) / 10.0;
                near(surface.point(pcurve.curve.point(at(pcurve.range))), curve.point(at(edge.range)));
            }
        }
    }
}

/// The signed area that a loop encloses in parameter space.
fn area(part: &Part, boundary: &Loop) -> f64 {
    let mut points = Vec::new();
    for coedge in coedges(boundary) {
        let Some(pcurve) = coedge.pcurves.first() else { continue };
        assert!(part.edges.len() > coedge.edge.index());
        let at = |k: i32| {
            let share = f64::from(if coedge.forward { k } else { 64 - k }) / 64.0;
            pcurve.curve.point(pcurve.range.start + pcurve.range.length() * share)
        };
        points.extend((0..64).map(at));
    }
    let n = points.len();
    (0..n).map(|i| points[i].perp_dot(points[(i + 1) % n])).sum::<f64>() * 0.5
}

#[test]
fn a_patch_without_trims_ends_at_its_four_sides() {
    let (part, warnings) = made(&patch(), &[]);
    assert!(warnings.is_empty());
    assert_eq!((part.faces.len(), part.edges.len(), part.vertices.len()), (1, 4, 4));
    assert!((area(&part, &part.faces[0].loops[0]) - 6.0).abs() < 1e-12);
    // The sides are the surface's own control points, not curves on it.
    assert!(part.edges.iter().all(|e| matches!(e.curve.as_deref(), Some(chordal_nurbs::Curve::Nurbs(_)))));
}

#[test]
fn nesting_makes_holes_and_islands_whatever_the_direction() {
    let trims = || {
        [
            rectangle([0.1, 0.1], [1.9, 2.9]),
            rectangle([0.3, 0.3], [1.5, 2.5]),
            rectangle([0.5, 0.5], [0.9, 0.9]),
            rectangle([1.0, 1.0], [1.4, 2.0]),
        ]
    };
    for turned in 0..16u32 {
        let trims: Vec<TrimLoop> = trims()
            .into_iter()
            .enumerate()
            .map(|(i, trim)| if turned >> i & 1 == 1 { backwards(trim) } else { trim })
            .collect();
        let (part, _) = made(&patch(), &trims);
        let mut found: Vec<Vec<f64>> = part
            .faces
            .iter()
            .map(|f| f.loops.iter().map(|l| (area(&part, l) * 1e6).round() / 1e6).collect())
            .collect();
        found.sort_by(|a, b| b[0].total_cmp(&a[0]));
        assert_eq!(found, [vec![5.04, -2.64], vec![0.4], vec![0.16]]);
    }
}

#[test]
fn the_even_convention_keeps_what_the_odd_one_drops() {
    let trims = [
        rectangle([0.1, 0.1], [1.9, 2.9]),
        rectangle([0.3, 0.3], [1.5, 2.5]),
        rectangle([0.5, 0.5], [0.9, 0.9]),
        rectangle([1.0, 1.0], [1.4, 2.0]),
    ];
    let even = |trim: &TrimLoop| TrimLoop { role: Role::ByNesting(Winding::Even), ..trim.clone() };
    let areas = |trims: Vec<TrimLoop>| {
        let (part, _) = made(&patch(), &trims);
        let mut found: Vec<Vec<f64>> = part
            .faces
            .iter()
            .map(|f| f.loops.iter().map(|l| (area(&part, l) * 1e6).round() / 1e6).collect())
            .collect();
        found.sort_by(|a, b| b[0].total_cmp(&a[0]));
        found
    };
    assert_eq!(areas(trims.iter().map(even).collect()), [vec![6.0, -5.04], vec![2.64, -0.16, -0.4]]);
    // One loop is a hole; the border itself as a loop is nothing more, and leaves what is inside the next
    // one.
    assert_eq!(areas(vec![even(&trims[0])]), [vec![6.0, -5.04]]);
    let border = rectangle([0.0, 0.0], [2.0, 3.0]);
    assert_eq!(areas(vec![even(&border), even(&trims[1])]), [vec![2.64]]);
}

#[test]
fn holes_alone_are_cut_into_the_whole_surface() {
    let hole = TrimLoop { role: Role::Hole, ..rectangle([0.5, 0.5], [1.0, 1.0]) };
    let (part, _) = made(&patch(), &[hole]);
    let areas: Vec<f64> = part.faces[0].loops.iter().map(|l| area(&part, l)).collect();
    assert!((areas[0] - 6.0).abs() < 1e-9 && (areas[1] + 0.25).abs() < 1e-9, "{areas:?}");
}

#[test]
fn open_chains_are_closed_and_owned_up_to() {
    let mut trim = rectangle([0.2, 0.2], [1.8, 2.8]);
    trim.pieces.remove(2);
    let (part, warnings) = made(&patch(), &[trim]);
    assert_eq!(coedges(&part.faces[0].loops[0]).len(), 4);
    assert!((area(&part, &part.faces[0].loops[0]) - 1.6 * 2.6).abs() < 1e-9);
    let said = warnings[0].to_string();
    assert!(said.contains("trim loop 1 is open by up to 80 % of the parameter range"), "{said}");
    // 32-bit rounding is no gap.
    let mut trim = rectangle([0.2, 0.2], [1.8, 2.8]);
    trim.pieces[2] = Piece::line(DVec2::new(1.8, 2.8000001), DVec2::new(0.2000001, 2.8));
    let mut part = Part::default();
    let notes = Notes::default();
    add_faces(&mut part, &patch(), &[trim], &Look::default(), &notes);
    assert_eq!((part.edges.len(), part.vertices.len(), notes.take().len()), (4, 4, 0));
}

#[test]
fn corners_become_vertices() {
    let corners = [[0.5, 0.5], [1.5, 0.5], [1.5, 2.0], [0.5, 2.0], [0.5, 0.5]].map(DVec2::from).to_vec();
    let polyline = Piece::whole(Curve2::Polyline(corners.clone()));
    let knots = vec![0., 0., 1., 2., 3., 4., 4.];
    let spline = Piece::whole(Curve2::Nurbs(NurbsCurve2::new(1, knots, corners, None).unwrap()));
    for piece in [polyline.clone(), spline, polyline.reversed()] {
        let trim =
            TrimLoop { pieces: vec![piece], role: Role::ByNesting(Winding::Odd), source: Source::default() };
        let (part, warnings) = made(&patch(), &[trim]);
        assert_eq!((part.edges.len(), part.vertices.len(), warnings.len()), (4, 4, 0));
        assert!((area(&part, &part.faces[0].loops[0]) - 1.5).abs() < 1e-9);
    }
}

#[test]
fn a_closed_surface_has_loops_at_its_ends_only() {
    let (part, _) = made(&round(&[1.0, 1.0]), &[]);
    assert_eq!((part.faces[0].loops.len(), part.edges.len(), part.vertices.len()), (2, 2, 2));
    // The rectangle of the whole domain says the same.
    let (part, _) = made(&round(&[1.0, 1.0]), &[rectangle([0.0, 0.0], [4.0, 1.0])]);
    assert_eq!((part.faces[0].loops.len(), part.edges.len()), (2, 2));
    let (part, _) = made(&round(&[1.0, 0.0]), &[]);
    assert_eq!(part.faces[0].loops.len(), 1);
    let (part, _) = made(&round(&[0.0, 1.0, 0.0]), &[]);
    assert!(part.faces[0].loops.is_empty());
}

#[test]
fn a_piece_along_both_sides_of_a_seam_is_one_edge() {
    let wavy: Vec<DVec2> = (0..=40)
        .map(|k| DVec2::new(f64::from(k) / 10.0, 0.7 + 0.1 * math::sin(PI * f64::from(k) / 20.0)))
        .collect();
    let pieces = vec![
        Piece::line(DVec2::ZERO, DVec2::new(4.0, 0.0)),
        Piece::line(DVec2::new(4.0, 0.0), wavy[40]),
        Piece::whole(Curve2::Polyline(wavy.clone())).reversed(),
        Piece::line(wavy[0], DVec2::ZERO),
    ];
    let trim = TrimLoop { pieces, role: Role::ByNesting(Winding::Odd), source: Source::default() };
    let (part, warnings) = made(&round(&[1.0, 1.0]), &[trim]);
    assert!(warnings.is_empty(), "{warnings:?}");
    let edges: Vec<EdgeId> = coedges(&part.faces[0].loops[0]).iter().map(|c| c.edge).collect();
    assert_eq!((part.vertices.len(), part.edges.len(), edges.len()), (2, 3, 4));
    assert_eq!(edges[1], edges[3]);
}

#[test]
fn a_loop_that_leaves_its_surface_is_cut_off_there() {
    let (part, _) = made(&patch(), &[rectangle([1.0, 1.0], [2.5, 2.0])]);
    assert_eq!(coedges(&part.faces[0].loops[0]).len(), 4);
    let (part, _) = made(&patch(), &[rectangle([2.1, 1.0], [2.5, 2.0])]);
    let failure = part.faces[0].failure().expect("no face is made");
    assert_eq!(failure.kind, ReadIssue::TrimsBeyond.into());
}

#[test]
fn loops_without_finite_extent_fail_their_face() {
    let endless = Curve2::Line { origin: DVec2::ZERO, direction: DVec2::X };
    let piece = Piece { curve: Arc::new(endless), range: Range::ALL, forward: true };
    let trim =
        TrimLoop { pieces: vec![piece], role: Role::ByNesting(Winding::Odd), source: Source::default() };
    let (part, _) = made(&patch(), &[trim]);
    assert!(matches!(part.faces[0].geometry, FaceGeometry::Failed(_)));
}
