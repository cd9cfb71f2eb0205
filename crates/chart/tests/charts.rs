//! Charts of small faces through the public functions of the crate.

use chordal_brep::{Coedge, Edge, EdgeId, Face, FaceGeometry, Loop, Part, Source, Vertex, VertexId};
use chordal_chart::{
    Chart, ChartPoint, Crossed, EdgeSamples, FaceSurface, Key, SeamMetric, Seams, Segment, TrimmedFace,
    coarse_chords, loops_cross, uncrossed,
};
use chordal_nurbs::{Curve, DVec2, DVec3, Frame, Range, Surface, SurfaceJet};
use std::f64::consts::TAU;
use std::sync::Arc;

const RESOLUTION: f64 = 1e-6;

/// Lengths in space.
#[derive(Debug)]
struct InSpace;

impl SeamMetric for InSpace {
    fn length(&self, jet: &SurfaceJet, step_uv: DVec2) -> f64 {
        (jet.du * step_uv.x + jet.dv * step_uv.y).length()
    }
}

/// A part of one face, with its sampled edges.
struct Sheet {
    part: Part,
    edges: Vec<EdgeSamples>,
}

impl Sheet {
    fn new(surface: Surface) -> Self {
        let face = Face {
            geometry: FaceGeometry::Surface(Arc::new(surface)),
            same_sense: true,
            flipped: false,
            loops: Vec::new(),
            name: String::new(),
            color: None,
            layer: None,
            source: Source::default(),
        };
        Self { part: Part { faces: vec![face], ..Part::default() }, edges: Vec::new() }
    }

    fn vertex(&mut self, point: DVec3) -> VertexId {
        self.part.vertices.push(Vertex { point, source: Source::default() });
        VertexId::from(self.part.vertices.len() - 1)
    }

    /// Adds an edge in this number of equal chords.
    fn edge(&mut self, curve: Curve, range: Range, ends: [VertexId; 2], chords: usize) -> Coedge {
        let t: Vec<f64> =
            (0..=chords).map(|k| range.start + range.length() * k as f64 / chords as f64).collect();
        let points = t.iter().map(|&t| curve.point(t)).collect();
        let sag = t.windows(2).map(|t| curve.chord_error(t[0], t[1])).collect();
        self.edges.push(EdgeSamples { t, points, sag });
        let [start, end] = ends;
        let source = Source::default();
        self.part.edges.push(Edge { curve: Some(Arc::new(curve)), range, start, end, source });
        Coedge { edge: EdgeId::from(self.part.edges.len() - 1), forward: true, pcurves: Vec::new() }
    }

    fn add_loop(&mut self, coedges: Vec<Coedge>, outer: bool) {
        self.part.faces[0].loops.push(Loop::Edges { coedges, outer });
    }

    /// Adds a loop of straight edges in the plane z = 0.
    fn add_polygon(&mut self, corners: &[(f64, f64)], outer: bool) {
        let points: Vec<DVec3> = corners.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect();
        let vertices: Vec<VertexId> = points.iter().map(|&p| self.vertex(p)).collect();
        let n = points.len();
        let coedges = (0..n).map(|i| {
            let next = (i + 1) % n;
            let line = Curve::Line { origin: points[i], direction: points[next] - points[i] };
            self.edge(line, Range::new(0.0, 1.0), [vertices[i], vertices[next]], 1)
        });
        let coedges = coedges.collect();
        self.add_loop(coedges, outer);
    }

    fn with_face<T>(&self, look: impl FnOnce(&TrimmedFace<'_, '_>) -> T) -> T {
        let face = &self.part.faces[0];
        let surface = FaceSurface::new(face.surface().expect("a surface"), RESOLUTION);
        look(&TrimmedFace {
            part: &self.part,
            face,
            surface: &surface,
            edges: &self.edges,
            touching: false,
            resolution: RESOLUTION,
        })
    }

    fn chart(&self) -> Chart {
        let seams = Seams { metric: &InSpace, chord: 0.5, tolerance: 0.1 };
        self.with_face(|face| Chart::new(face, &seams, false).expect("a chart"))
    }
}

fn polygons(chart: &Chart) -> Vec<&[ChartPoint]> {
    chart.loops.iter().map(|&(start, end)| &chart.points[start as usize..end as usize]).collect()
}

fn area(polygon: &[ChartPoint]) -> f64 {
    let n = polygon.len();
    (0..n).map(|i| 0.5 * polygon[i].uv.perp_dot(polygon[(i + 1) % n].uv)).sum()
}

#[test]
fn a_hole_that_runs_as_an_outer_loop_is_reversed() {
    let mut sheet = Sheet::new(Surface::Plane { frame: Frame::WORLD });
    sheet.add_polygon(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)], false);
    sheet.add_polygon(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)], true);
    let chart = sheet.chart();
    assert_eq!(polygons(&chart).into_iter().map(area).collect::<Vec<_>>(), [16.0, -1.0]);
    assert!(!chart.reversed && chart.private.is_empty());
    assert!(!loops_cross(&chart));
}

#[test]
fn a_band_of_a_cylinder_is_cut_open_along_a_seam() {
    let mut sheet = Sheet::new(Surface::Cylinder { frame: Frame::WORLD, radius: 1.0 });
    for (z, forward) in [(0.0, true), (2.0, false)] {
        let frame = Frame { origin: DVec3::new(0.0, 0.0, z), ..Frame::WORLD };
        let start = sheet.vertex(DVec3::new(1.0, 0.0, z));
        let circle = Curve::Circle { frame, radius: 1.0 };
        let coedge = sheet.edge(circle, Range::new(0.0, TAU), [start, start], 16);
        sheet.add_loop(vec![Coedge { forward, ..coedge }], forward);
    }
    let chart = sheet.chart();
    let [polygon] = polygons(&chart)[..] else { panic!("one polygon") };
    assert!((area(polygon) - 2.0 * TAU).abs() < 1e-6);
    // Two units in chords of half a unit: three points inside each side of the seam.
    assert_eq!(chart.private.len(), 3);
    for k in 0..3 {
        let both: Vec<&ChartPoint> = polygon.iter().filter(|p| p.key == Key::Private(k)).collect();
        assert_eq!(both.len(), 2);
        assert!(both.iter().all(|p| p.segment == Segment::Seam));
        assert!(((both[0].uv - both[1].uv).abs() - DVec2::new(TAU, 0.0)).length() < 1e-6);
    }
}

#[test]
fn a_coarse_chord_across_another_loop_is_named() {
    // A circle of four chords; a hole inside the circle, partly beyond the first chord.
    let mut sheet = Sheet::new(Surface::Plane { frame: Frame::WORLD });
    let start = sheet.vertex(DVec3::X);
    let circle = Curve::Circle { frame: Frame::WORLD, radius: 1.0 };
    let coedge = sheet.edge(circle, Range::new(0.0, TAU), [start, start], 4);
    sheet.add_loop(vec![coedge], true);
    sheet.add_polygon(&[(0.4, 0.4), (0.4, 0.65), (0.65, 0.65), (0.65, 0.4)], false);
    let chart = sheet.chart();
    assert!(loops_cross(&chart));
    let coarse = sheet.with_face(|face| coarse_chords(face, &chart, &[], &|| false));
    assert_eq!(coarse, [(0, 0)], "the first chord of the circle");
}

#[test]
fn a_figure_of_eight_gets_a_vertex_where_it_crosses() {
    let mut sheet = Sheet::new(Surface::Plane { frame: Frame::WORLD });
    sheet.add_polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)], true);
    let chart = sheet.chart();
    assert!(loops_cross(&chart));
    let coarse = sheet.with_face(|face| coarse_chords(face, &chart, &[], &|| false));
    assert!(coarse.is_empty(), "straight edges are not too coarse");
    let healed = sheet
        .with_face(|context| uncrossed(&sheet.part, &[Crossed { face: 0, context, chart }], RESOLUTION, 0.1));
    let healed = healed.expect("the loop changes");
    assert_eq!(healed.faces, [(0, 1)]);
    let [crossing] = &healed.part.vertices[4..] else { panic!("one new vertex") };
    assert!(crossing.point.distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-9);
    assert_eq!(healed.part.edges.len(), 6, "two edges are cut");
}
