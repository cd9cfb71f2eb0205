//! What fails costs one face or edge and is reported with its kind; a panic keeps its text.

use chordal_brep::{
    Coedge, Edge, EdgeId, Face, FaceGeometry, Loop, MeshIssue, MethodFault, Part, Source, Vertex, VertexId,
};
use chordal_nurbs::{Curve, DVec3, Frame, Range, Surface};
use chordal_tessellate::method::{
    EdgePiece, EdgeSplitter, EdgeUse, FaceFiller, FaceMesh, FillMethod, FillTask,
};
use chordal_tessellate::{Cancel, Options, PartReport, Trace, remember_panic, tessellate_part};
use std::sync::Arc;
use std::time::Duration;

/// Two unit squares side by side in the plane z = 0, with the edge between them at x = 1.
fn two_squares() -> Part {
    let points = [(0., 0.), (1., 0.), (2., 0.), (2., 1.), (1., 1.), (0., 1.)];
    let ends = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)];
    let at = |i: usize| DVec3::new(points[i].0, points[i].1, 0.0);
    let edge = |&(a, b): &(usize, usize)| Edge {
        curve: Some(Arc::new(Curve::Line { origin: at(a), direction: at(b) - at(a) })),
        range: Range::new(0.0, 1.0),
        start: VertexId::from(a),
        end: VertexId::from(b),
        source: Source { entity: a as u64 + 100, line: 0 },
    };
    let coedge =
        |(edge, forward): (usize, bool)| Coedge { edge: EdgeId::from(edge), forward, pcurves: Vec::new() };
    let frame = Frame { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y, z: DVec3::Z };
    let face = |uses: [(usize, bool); 4]| Face {
        geometry: FaceGeometry::Surface(Arc::new(Surface::Plane { frame })),
        same_sense: true,
        flipped: false,
        loops: vec![Loop::Edges { coedges: uses.map(coedge).to_vec(), outer: true }],
        name: String::new(),
        color: None,
        layer: None,
        source: Source::default(),
    };
    Part {
        vertices: (0..6).map(|i| Vertex { point: at(i), source: Source::default() }).collect(),
        edges: ends.iter().map(edge).collect(),
        faces: vec![
            face([(0, true), (6, true), (4, true), (5, true)]),
            face([(1, true), (2, true), (3, true), (6, false)]),
        ],
        ..Part::default()
    }
}

fn mesh(part: &Part, options: &Options) -> PartReport {
    tessellate_part(part, options, &Cancel::default(), &|_| ()).1
}

/// Panics at the edge that runs along x = 0; leaves the others to the default.
#[derive(Debug)]
struct PanicsAtTheLeft;

impl EdgeSplitter for PanicsAtTheLeft {
    fn name(&self) -> &str {
        "panics at the left"
    }

    fn parameters(&self, piece: &EdgePiece<'_>, _: &[EdgeUse<'_, '_>], _: &mut Trace) -> Option<Vec<f64>> {
        let x = |t: f64| piece.curve.point(t).x;
        assert!(x(piece.range.start) + x(piece.range.end) > 0.0, "the edge at the left");
        None
    }
}

/// Panics at every face.
#[derive(Debug)]
struct PanicsAlways;

impl FillMethod for PanicsAlways {
    fn name(&self) -> &str {
        "panics always"
    }

    fn begin(&self, _: &FaceMesh<'_, '_>, _: FillTask) -> Result<Box<dyn FaceFiller>, MeshIssue> {
        panic!("the face of a test")
    }
}

fn message(issue: &MeshIssue) -> &str {
    match issue {
        MeshIssue::InternalError { message, .. } => message,
        other => panic!("{other}"),
    }
}

#[test]
fn two_squares_are_four_triangles() {
    let report = mesh(&two_squares(), &Options::new(0.01));
    assert_eq!(report.faces.iter().map(|f| f.triangles).collect::<Vec<_>>(), [2, 2]);
    assert!(report.faces.iter().all(|f| f.failed.is_none() && f.mended.is_none() && f.proven_error == 0.0));
    assert!(report.edge_faults.is_empty());
}

#[test]
fn a_panic_on_an_edge_is_reported_and_the_default_takes_over() {
    let options = Options::new(0.01).with_edge_splitter(Some(Arc::new(PanicsAtTheLeft)));
    let report = mesh(&two_squares(), &options);
    assert_eq!(report.edge_faults.len(), 1, "{:?}", report.edge_faults);
    assert_eq!(report.edge_faults[0].0, 5);
    assert!(message(&report.edge_faults[0].1).contains("the edge at the left"));
    assert_eq!(report.faces.iter().map(|f| f.triangles).collect::<Vec<_>>(), [2, 2]);
}

#[test]
fn a_panic_on_a_face_keeps_its_text_and_place() {
    std::panic::set_hook(Box::new(remember_panic));
    let options = Options::new(0.01).with_fill_method(Some(Arc::new(PanicsAlways)));
    let report = mesh(&two_squares(), &options);
    let _ = std::panic::take_hook();
    for face in &report.faces {
        let mended = face.mended.as_ref().expect("the panic is reported");
        assert_eq!(message(mended), "the face of a test");
        let MeshIssue::InternalError { location: Some(place), .. } = mended else { panic!("{mended}") };
        assert!(place.contains("failures.rs:"), "{place}");
        assert!(mended.to_string().contains("please report it"), "{mended}");
        assert_eq!((face.triangles, &face.failed), (2, &None));
    }
}

/// Cannot fill any face.
#[derive(Debug)]
struct GivesUp;

impl FillMethod for GivesUp {
    fn name(&self) -> &str {
        "gives up"
    }

    fn begin(&self, _: &FaceMesh<'_, '_>, _: FillTask) -> Result<Box<dyn FaceFiller>, MeshIssue> {
        Err(MeshIssue::TooManyCells { most: 1 })
    }
}

#[test]
fn a_method_that_gives_up_does_not_pass_for_the_default() {
    let report = mesh(&two_squares(), &Options::new(0.01).with_fill_method(Some(Arc::new(GivesUp))));
    let cause = MethodFault::Issue(Box::new(MeshIssue::TooManyCells { most: 1 }));
    let given_up = Some(MeshIssue::MethodGaveUp { method: "gives up".into(), cause });
    for face in &report.faces {
        assert_eq!((face.triangles, &face.failed, &face.given_up), (2, &None, &given_up));
    }
    assert_eq!(report.edges_given_up, 0);
    let report = mesh(&two_squares(), &Options::new(0.01));
    assert!(report.faces.iter().all(|face| face.given_up.is_none()));
}

/// Cuts no edge but the one between the squares.
#[derive(Debug)]
struct CutsOne;

impl EdgeSplitter for CutsOne {
    fn name(&self) -> &str {
        "cuts one"
    }

    fn parameters(&self, piece: &EdgePiece<'_>, _: &[EdgeUse<'_, '_>], _: &mut Trace) -> Option<Vec<f64>> {
        let is_between = piece.curve.point(0.0).x == 1.0 && piece.curve.point(1.0).x == 1.0;
        is_between.then(|| vec![0.0, 1.0])
    }
}

#[test]
fn edges_that_a_method_gives_up_are_counted() {
    let report = mesh(&two_squares(), &Options::new(0.01).with_edge_splitter(Some(Arc::new(CutsOne))));
    assert_eq!(report.edges_given_up, 6);
    assert_eq!(mesh(&two_squares(), &Options::new(0.01)).edges_given_up, 0);
}

#[test]
fn failures_have_kinds() {
    let mut open = two_squares();
    let Loop::Edges { coedges, .. } = &mut open.faces[0].loops[0] else { unreachable!() };
    coedges.remove(1);
    let report = mesh(&open, &Options::new(0.01));
    assert_eq!(report.faces[0].failed, Some(MeshIssue::LoopNotClosed { edge: 1, next: 2 }));
    assert_eq!(report.faces[1].triangles, 2, "one face costs its neighbour nothing");

    let mut bare = two_squares();
    bare.faces[0].loops.clear();
    assert_eq!(mesh(&bare, &Options::new(0.01)).faces[0].failed, Some(MeshIssue::UnboundedSurface));

    let cancel = Cancel::default();
    cancel.cancel();
    let (_, report) = tessellate_part(&two_squares(), &Options::new(0.01), &cancel, &|_| ());
    assert!(report.faces.iter().all(|f| f.failed == Some(MeshIssue::Cancelled)));

    // Without any time, each face fails for that reason.
    let hurried = Options::new(0.01).with_face_timeout(Some(Duration::ZERO));
    let report = mesh(&two_squares(), &hurried);
    let failed: Vec<_> = report.faces.iter().map(|face| face.failed.clone()).collect();
    assert!(failed.iter().all(|f| matches!(f, Some(MeshIssue::OutOfTime { .. }))), "{failed:?}");
}
