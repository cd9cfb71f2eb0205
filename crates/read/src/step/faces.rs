//! Faces and their loops. A face that cannot be understood becomes a failed face.

use super::builder::{Builder, KnownEdge};
use super::document::{Ix, Res};
use super::keyword::Kw;
use chordal_brep::{Coedge, Color, Face, FaceGeometry, FaceId, Loop, Pcurve, Percent, ReadIssue, VertexId};
use chordal_nurbs::{DVec3, Frame, Surface};
use std::sync::Arc;

/// How a shell uses its faces.
#[derive(Clone, Debug, Default)]
pub(crate) struct FaceUse {
    /// Turned over.
    pub flipped: bool,
    /// The shell's colour, for faces without their own.
    pub color: Option<Color>,
    pub layer: Option<String>,
}

/// A face's geometry and loops before they enter the part.
pub(crate) struct Trimmed {
    pub surface: Arc<Surface>,
    pub same_sense: bool,
    pub loops: Vec<Loop>,
}

/// The attributes of a face entity.
struct FaceData {
    name: String,
    bounds: Res<Vec<Ix>>,
    geometry: Option<Res<Ix>>,
    same_sense: bool,
}

/// Corners farther off the plane of their face than this share of the face's extent contradict it: far more
/// than the rounding of coordinates, and so little that the plane of the corners is hardly another one.
const PLANE_CONTRADICTED: f64 = 1e-2;

/// Faces that refer to faces, deeper than this, refer in a circle.
const MAX_FACE_DEPTH: u32 = 8;

impl Builder<'_> {
    /// Adds the face of an entity, however broken it is.
    pub(crate) fn face(&mut self, ix: Ix, how: &FaceUse) -> FaceId {
        self.face_at(ix, how, 0)
    }

    fn face_at(&mut self, ix: Ix, how: &FaceUse, depth: u32) -> FaceId {
        if self.doc.kw(ix) == Kw::OrientedFace
            && depth < MAX_FACE_DEPTH
            && let Ok(mut args) = self.doc.open(ix)
        {
            args.skip(2);
            if let Ok(element) = args.reference() {
                let flipped = how.flipped == args.logical(true);
                return self.face_at(element, &FaceUse { flipped, ..how.clone() }, depth + 1);
            }
        }
        let mut name = String::new();
        let built = self.read_face(ix, &mut name);
        let color = self.color(ix).or(how.color);
        let layer = self.layer(ix).or_else(|| how.layer.clone());
        self.push_face(ix, built, name, how.flipped, color, layer)
    }

    /// Adds a face, failed or not.
    pub(crate) fn push_face(
        &mut self,
        ix: Ix,
        built: Res<Trimmed>,
        name: String,
        flipped: bool,
        color: Option<Color>,
        layer: Option<String>,
    ) -> FaceId {
        let (geometry, same_sense, loops) = match built {
            Ok(trimmed) => (FaceGeometry::Surface(trimmed.surface), trimmed.same_sense, trimmed.loops),
            Err(bad) => (FaceGeometry::Failed(bad.into_error()), true, Vec::new()),
        };
        let id = FaceId::from(self.build.part.faces.len());
        let source = self.doc.source(ix);
        self.build.part.faces.push(Face { geometry, same_sense, flipped, loops, name, color, layer, source });
        id
    }

    fn read_face(&mut self, ix: Ix, name: &mut String) -> Res<Trimmed> {
        let data = self.face_data(ix, 0)?;
        *name = data.name;
        let bounds = data.bounds?;
        let Some(geometry) = data.geometry else { return self.polygon_face(ix, &bounds) };
        let geometry = geometry?;
        let (basis, same_sense) = self.face_surface(geometry, data.same_sense)?;
        let surface = self.geometry.surface(basis)?;
        let loops = bounds.iter().map(|&bound| self.bound(bound, geometry)).collect::<Res<Vec<_>>>()?;
        if loops.is_empty() && geometry != basis {
            // The surface brings its own bounds.
            let mut trimmed = self.trimmed_surface(geometry)?;
            trimmed.same_sense = trimmed.same_sense == data.same_sense;
            return Ok(trimmed);
        }
        let (surface, same_sense) = self.plane_of_corners(ix, surface, same_sense, &loops);
        Ok(Trimmed { surface, same_sense, loops })
    }

    /// The plane of a face whose loops are all polygons: that of the corners where they are not on the one
    /// that the file gives. Another surface is returned as it is.
    fn plane_of_corners(
        &self,
        ix: Ix,
        surface: Arc<Surface>,
        same_sense: bool,
        loops: &[Loop],
    ) -> (Arc<Surface>, bool) {
        let Surface::Plane { frame } = &*surface else { return (surface, same_sense) };
        let Some(polygons) = self.polygons(loops) else { return (surface, same_sense) };
        let Some(own) = largest_plane(&polygons) else { return (surface, same_sense) };
        let points = || polygons.iter().flatten();
        let off = |frame: &Frame| points().map(|p| frame.local(*p).z.abs()).fold(0.0, f64::max);
        let extent = points().map(|p| p.distance(polygons[0][0])).fold(0.0, f64::max);
        let (share, own_share) = (off(frame) / extent, off(&own) / extent);
        if share <= PLANE_CONTRADICTED || own_share > 0.1 * share {
            return (surface, same_sense);
        }
        self.doc.warn(ix, ReadIssue::PlaneContradicted { off: Percent::of(share) });
        (Arc::new(Surface::Plane { frame: own }), true)
    }

    /// The corners of the loops, where all are polygons.
    fn polygons(&self, loops: &[Loop]) -> Option<Vec<Vec<DVec3>>> {
        let corners = |boundary: &Loop| match boundary {
            Loop::Polygon { vertices, .. } => {
                Some(vertices.iter().map(|&v| self.build.point_of(v)).collect::<Vec<DVec3>>())
            }
            _ => None,
        };
        loops.iter().map(corners).collect()
    }

    /// The surface under trimmed and oriented surfaces, and the face's sense against that.
    fn face_surface(&mut self, ix: Ix, same_sense: bool) -> Res<(Ix, bool)> {
        let (mut at, mut sense) = (ix, same_sense);
        for _ in 0..MAX_FACE_DEPTH {
            let mut args = self.doc.open(at)?;
            args.skip(1);
            match self.doc.kw(at) {
                Kw::RectangularTrimmedSurface => {
                    let basis = args.reference()?;
                    args.skip(4);
                    sense = sense == (args.logical(true) == args.logical(true));
                    at = basis;
                }
                Kw::OrientedSurface => {
                    let basis = args.reference()?;
                    sense = sense == args.logical(true);
                    at = basis;
                }
                Kw::CurveBoundedSurface => at = args.reference()?,
                _ => return Ok((at, sense)),
            }
        }
        Err(self.doc.recursive(ix, MAX_FACE_DEPTH))
    }

    fn face_data(&self, ix: Ix, depth: u32) -> Res<FaceData> {
        let doc = self.doc;
        let mut args = doc.open(ix)?;
        match doc.kw(ix) {
            Kw::AdvancedFace | Kw::FaceSurface => {
                let (name, bounds, geometry) =
                    (args.string(), args.references_strict(), Some(args.reference()));
                Ok(FaceData { name, bounds, geometry, same_sense: args.logical(true) })
            }
            Kw::Face => {
                let (name, bounds) = (args.string(), args.references_strict());
                Ok(FaceData { name, bounds, geometry: None, same_sense: true })
            }
            Kw::Subface if depth < MAX_FACE_DEPTH => {
                let (name, bounds) = (args.string(), args.references_strict());
                let parent = self.face_data(args.reference()?, depth + 1)?;
                Ok(FaceData { name, bounds, ..parent })
            }
            Kw::Complex => {
                let bounds = doc.leaf(ix, Kw::Face)?.references_strict();
                let name = doc
                    .find_leaf(ix, Kw::RepresentationItem)?
                    .map(|mut args| args.string())
                    .unwrap_or_default();
                let mut surface = doc.leaf(ix, Kw::FaceSurface)?;
                let geometry = Some(surface.reference());
                Ok(FaceData { name, bounds, geometry, same_sense: surface.logical(true) })
            }
            _ => Err(doc.unknown(ix, "a face")),
        }
    }

    /// FACE_BOUND: a loop, reversed where its orientation is false.
    fn bound(&mut self, ix: Ix, surface: Ix) -> Res<Loop> {
        let kind = if self.doc.kw(ix) == Kw::FaceOuterBound { Kw::FaceOuterBound } else { Kw::FaceBound };
        let mut args = self.doc.leaf(ix, kind)?;
        args.skip(1);
        let boundary = args.reference()?;
        let forward = args.logical(true);
        let outer = kind == Kw::FaceOuterBound;
        match self.doc.kw(boundary) {
            Kw::VertexLoop => {
                let mut args = self.doc.open(boundary)?;
                args.skip(1);
                Ok(Loop::Vertex(self.vertex(args.reference()?)?))
            }
            Kw::PolyLoop => {
                let mut vertices = self.polygon(boundary)?;
                if !forward {
                    vertices.reverse();
                }
                Ok(Loop::Polygon { vertices, outer })
            }
            _ => Ok(Loop::Edges { coedges: self.edge_loop(boundary, surface, forward)?, outer }),
        }
    }

    fn polygon(&mut self, ix: Ix) -> Res<Vec<VertexId>> {
        let mut args = self.doc.leaf(ix, Kw::PolyLoop)?;
        args.skip(1);
        let mut vertices = Vec::new();
        for point_ix in args.references_strict()? {
            let point = self.geometry.point(point_ix)?;
            let vertex = self.corner(point, self.doc.source(point_ix));
            if vertices.last() != Some(&vertex) {
                vertices.push(vertex);
            }
        }
        if vertices.len() > 1 && vertices.first() == vertices.last() {
            vertices.pop();
        }
        if vertices.len() < 3 {
            Err(self
                .doc
                .bad(ix, ReadIssue::TooFew { what: "distinct points", found: vertices.len(), least: 3 }))
        } else {
            Ok(vertices)
        }
    }

    /// EDGE_LOOP: its coedges in running order.
    fn edge_loop(&mut self, ix: Ix, surface: Ix, forward: bool) -> Res<Vec<Coedge>> {
        let kind = if self.doc.kw(ix) == Kw::Path { Kw::Path } else { Kw::EdgeLoop };
        let mut args = self.doc.leaf(ix, kind)?;
        if self.doc.kw(ix) != Kw::Complex {
            args.skip(1);
        }
        let mut coedges = Vec::new();
        let mut lost = Vec::new();
        let references = args.references()?;
        let edges = references.len();
        for oriented in references {
            match oriented.and_then(|oriented| self.oriented_edge(oriented)) {
                Ok((edge, along)) => coedges.push(coedge(&edge, along, surface)),
                Err(bad) => lost.push(bad),
            }
        }
        if coedges.is_empty() && lost.is_empty() {
            return Err(self.doc.bad(ix, ReadIssue::NoEdges));
        }
        // If at least half of the edges remain, straight ones replace the missing ones below.
        match lost.into_iter().next() {
            Some(bad) if coedges.len() < 2 || coedges.len() < edges - coedges.len() => return Err(bad),
            Some(bad) => {
                let cause = bad.into_cause(self.doc.source(ix));
                self.doc.lose(ix, ReadIssue::EdgesLost { lost: edges - coedges.len(), edges, cause });
            }
            None => {}
        }
        self.mend_chain(ix, &mut coedges);
        if !forward {
            coedges.reverse();
            coedges.iter_mut().for_each(|c| c.forward = !c.forward);
        }
        Ok(coedges)
    }

    /// ORIENTED_EDGE(name, *, *, element, orientation), or a bare edge; whether the loop runs along the
    /// entity.
    fn oriented_edge(&mut self, ix: Ix) -> Res<(KnownEdge, bool)> {
        let (mut at, mut along) = (ix, true);
        for _ in 0..MAX_FACE_DEPTH {
            if self.doc.kw(at) != Kw::OrientedEdge {
                return Ok((self.edge(at)?, along));
            }
            let mut args = self.doc.open(at)?;
            args.skip(3);
            at = args.reference()?;
            along = along == args.logical(true);
        }
        Err(self.doc.recursive(ix, MAX_FACE_DEPTH))
    }

    /// A FACE without a surface: the plane of its polygons.
    fn polygon_face(&mut self, ix: Ix, bounds: &[Ix]) -> Res<Trimmed> {
        let loops = bounds.iter().map(|&bound| self.bound(bound, ix)).collect::<Res<Vec<_>>>()?;
        let Some(polygons) = self.polygons(&loops) else {
            return Err(self.doc.bad(ix, ReadIssue::NoSurface));
        };
        match largest_plane(&polygons) {
            Some(frame) => {
                Ok(Trimmed { surface: Arc::new(Surface::Plane { frame }), same_sense: true, loops })
            }
            None => Err(self.doc.bad(ix, ReadIssue::NoArea)),
        }
    }
}

/// The plane of the polygon with the largest area, its normal that around which it runs.
fn largest_plane(polygons: &[Vec<DVec3>]) -> Option<Frame> {
    let mut best: Option<(f64, Frame)> = None;
    for points in polygons {
        let area = newell(points);
        if best.is_none_or(|(largest, _)| area.length() > largest) {
            best = Some((area.length(), Frame::new(points[0], area, points[1] - points[0])));
        }
    }
    best.filter(|&(area, _)| area > 0.0).map(|(_, frame)| frame)
}

/// The vector area of a polygon (Newell's method).
fn newell(points: &[DVec3]) -> DVec3 {
    let origin = points[0];
    let next = |i: usize| points[(i + 1) % points.len()] - origin;
    (0..points.len()).map(|i| (points[i] - origin).cross(next(i))).sum::<DVec3>() * 0.5
}

/// The use of an edge by a loop of a face on the surface of entity `surface`.
fn coedge(edge: &KnownEdge, along: bool, surface: Ix) -> Coedge {
    let pcurves = edge.pcurves.iter().filter(|pcurve| pcurve.surface == surface);
    let pcurves = pcurves.map(|pcurve| Pcurve { curve: pcurve.curve.clone(), range: pcurve.range }).collect();
    Coedge { edge: edge.id, forward: along != edge.swapped, pcurves }
}
