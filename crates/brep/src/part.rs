//! One part: vertices, edges, faces, shells and bodies in the part's own coordinates and units.

use crate::{EdgeId, FaceId, Issue, ShellId, Source, VertexId};
use chordal_nurbs::{Curve, Curve2, DVec3, Range, Surface};
use std::sync::Arc;

/// Linear RGB with opacity, each 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub [f32; 4]);

/// A corner shared by edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Vertex {
    /// In the coordinates and unit of the part.
    pub point: DVec3,
    /// The entity of the vertex.
    pub source: Source,
}

/// A curve piece shared by the faces that meet along it.
///
/// The edge runs from `start` at `range.start` to `end` at `range.end`, with `range.start < range.end`.
/// Readers swap the vertices (and every coedge's direction) where the file runs the edge against its curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// `None`: the edge is a single point (a pole, an apex).
    pub curve: Option<Arc<Curve>>,
    /// The part of the curve that the edge is.
    pub range: Range,
    /// The vertex at `range.start`.
    pub start: VertexId,
    /// The vertex at `range.end`.
    pub end: VertexId,
    /// The entity of the edge.
    pub source: Source,
}

/// One use of an edge by a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Coedge {
    /// The edge that is used.
    pub edge: EdgeId,
    /// True where the loop runs along the edge from its start to its end.
    pub forward: bool,
    /// The file's curves for this edge in the parameter space of this face's surface: none, one, or (along a
    /// seam) both. They share the edge's parameter range unless their own says otherwise; not yet checked
    /// against the edge.
    pub pcurves: Vec<Pcurve>,
}

/// A curve in parameter space with the range that corresponds to the edge's range, start to start.
#[derive(Clone, Debug, PartialEq)]
pub struct Pcurve {
    /// The curve in the parameter space of the face's surface.
    pub curve: Arc<Curve2>,
    /// The part of it that corresponds to the edge's range, start to start.
    pub range: Range,
}

/// A closed chain of coedges, or a single vertex on a closed surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Loop {
    /// In the order and direction of the file, orientation flags of the bound already applied.
    Edges {
        /// The uses of edges, each starting where the one before ends.
        coedges: Vec<Coedge>,
        /// True if the file states that it is the outer boundary of the face.
        outer: bool,
    },
    /// The loop is one point (VERTEX_LOOP): it cuts nothing off.
    Vertex(VertexId),
    /// A polygon of points without edges (POLY_LOOP), each a vertex of the part.
    Polygon {
        /// The corners in order, the first not repeated at the end.
        vertices: Vec<VertexId>,
        /// True if the file states that it is the outer boundary of the face.
        outer: bool,
    },
}

/// The surface of a face, or why it has none.
#[derive(Clone, Debug, PartialEq)]
pub enum FaceGeometry {
    /// The surface on which the face lies.
    Surface(Arc<Surface>),
    /// The face cannot be used; it stays in the model and is reported with this reason.
    Failed(Issue),
}

/// A bounded piece of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The surface, or why the face has none.
    pub geometry: FaceGeometry,
    /// The face's normal is the surface's. Loops run with material on their left seen against the **face's**
    /// normal.
    pub same_sense: bool,
    /// The shell uses the face turned over (a void's shell): triangles are written the other way round.
    pub flipped: bool,
    /// Empty: the whole surface.
    pub loops: Vec<Loop>,
    /// The name in the file; may be empty.
    pub name: String,
    /// The face's own colour.
    pub color: Option<Color>,
    /// The layer in the file.
    pub layer: Option<String>,
    /// The entity of the face.
    pub source: Source,
}

impl Face {
    /// The surface; `None` for a face that failed.
    pub fn surface(&self) -> Option<&Surface> {
        match &self.geometry {
            FaceGeometry::Surface(surface) => Some(surface),
            FaceGeometry::Failed(_) => None,
        }
    }

    /// Why the face has no surface; `None` for a face that has one.
    pub fn failure(&self) -> Option<&Issue> {
        match &self.geometry {
            FaceGeometry::Surface(_) => None,
            FaceGeometry::Failed(issue) => Some(issue),
        }
    }

    /// True where triangles must run against the surface's own normal Su × Sv.
    pub fn normal_reversed(&self) -> bool {
        !self.same_sense ^ self.flipped
    }
}

/// Faces joined along edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Shell {
    /// The faces, each once.
    pub faces: Vec<FaceId>,
    /// Whether the file states that it bounds a volume.
    pub closed: bool,
    /// The entity of the shell.
    pub source: Source,
}

/// What a body is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// An outer shell and its voids.
    Solid,
    /// Open or unclassified shells.
    Sheet,
    /// Faces that the file groups without a shell.
    FaceSet,
}

/// A named, coloured group of shells.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// What the body is.
    pub kind: BodyKind,
    /// Of a solid the outer shell first, then its voids.
    pub shells: Vec<ShellId>,
    /// The name in the file; may be empty.
    pub name: String,
    /// The colour of faces without their own.
    pub color: Option<Color>,
    /// The layer in the file.
    pub layer: Option<String>,
    /// The entity of the body.
    pub source: Source,
}

/// What a loose item is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LooseKind {
    /// A curve.
    Wire,
    /// A point.
    Point,
}

/// A curve or point of the file that belongs to no face: it has no triangles and is reported.
#[derive(Clone, Debug, PartialEq)]
pub struct LooseItem {
    /// What it is.
    pub kind: LooseKind,
    /// The name in the file; may be empty.
    pub name: String,
    /// The entity of the item.
    pub source: Source,
}

/// Triangles that were in the file already: passed through, nothing is proven about them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TessellatedItem {
    /// The name in the file; may be empty.
    pub name: String,
    /// The corners, in the coordinates and unit of the part.
    pub points: Vec<DVec3>,
    /// Three positions in `points` each, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// One per point, or empty.
    pub normals: Vec<DVec3>,
    /// The colour of the item.
    pub color: Option<Color>,
    /// The entity of the item.
    pub source: Source,
}

/// One part, meshed once however often it is placed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// The name in the file; may be empty.
    pub name: String,
    /// Corners; [`VertexId`] is the position.
    pub vertices: Vec<Vertex>,
    /// Edges, each once however many faces use it; [`EdgeId`] is the position.
    pub edges: Vec<Edge>,
    /// Faces, the failed ones with their reasons; [`FaceId`] is the position.
    pub faces: Vec<Face>,
    /// Shells; [`ShellId`] is the position.
    pub shells: Vec<Shell>,
    /// Bodies; [`crate::BodyId`] is the position.
    pub bodies: Vec<Body>,
    /// Curves and points that belong to no face.
    pub loose: Vec<LooseItem>,
    /// Triangles that the file holds already.
    pub tessellated: Vec<TessellatedItem>,
    /// The colour of faces and bodies without their own.
    pub color: Option<Color>,
    /// The file's own statement of accuracy, in the part's units (UNCERTAINTY_MEASURE), where it makes one.
    pub uncertainty: Option<f64>,
    /// The entity of the part.
    pub source: Source,
}
