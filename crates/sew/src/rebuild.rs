//! Makes the sewn part: vertices merged, edges cut, coedges of several faces on one edge.

use crate::border::Borders;
use crate::cluster::{Clusters, Corner};
use crate::cut::Pieces;
use crate::pair::Joint;
use chordal_brep::{
    Coedge, Edge, EdgeId, FaceGeometry, Issue, Loop, MeshIssue, Part, Pcurve, Vertex, VertexId,
};
use chordal_nurbs::{Range, Surface};

/// Places at which a parameter curve is compared with the edge that it is to follow.
const CHECKS: u32 = 6;

/// Two faces that continue each other across an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Link {
    pub faces: [u32; 2],
    /// Both loops run along the edge in the same direction, which is wrong for two faces seen from one side.
    pub same: bool,
}

/// The decisions of all stages before.
pub(crate) struct Decisions<'a> {
    pub borders: &'a Borders,
    pub corners: &'a [Corner],
    pub clusters: &'a Clusters,
    pub pieces: &'a Pieces,
    pub joints: &'a [Joint],
    /// For each piece, whether it is merged into its vertex.
    pub vanished: &'a [bool],
    pub tolerance: f64,
    /// For each face, the loops that run in the wrong direction.
    pub wrong_loops: &'a [Vec<usize>],
}

/// A sewn part.
#[derive(Debug, Default)]
pub(crate) struct Rebuilt {
    pub part: Part,
    pub links: Vec<Link>,
}

/// How a piece refers to its edge.
#[derive(Clone, Copy)]
struct Reference {
    edge: EdgeId,
    reversed: bool,
    /// The piece whose curve the edge has.
    leader: u32,
}

/// Makes the sewn part.
pub(crate) fn rebuild(part: &Part, decisions: &Decisions<'_>) -> Rebuilt {
    let vertices = VertexMap::new(part, decisions);
    let mut new =
        Part { vertices: vertices.points.clone(), edges: Vec::new(), faces: Vec::new(), ..part.clone() };
    let mut border_of = vec![None; part.edges.len()];
    for (b, border) in decisions.borders.all.iter().enumerate() {
        border_of[border.edge.index()] = Some(b);
    }
    let mut references: Vec<Option<Reference>> = vec![None; decisions.pieces.all.len()];
    let mut kept = vec![EdgeId(0); part.edges.len()];
    let follows = followers(decisions);
    for (e, edge) in part.edges.iter().enumerate() {
        match border_of[e] {
            None => {
                kept[e] = EdgeId::from(new.edges.len());
                let [start, end] = [edge.start, edge.end].map(|v| vertices.of[v.index()]);
                new.edges.push(Edge { start, end, ..edge.clone() });
            }
            Some(b) => {
                let (first, last) = decisions.pieces.of[b];
                for p in first..last {
                    if !follows[p as usize] && !decisions.vanished[p as usize] {
                        let id = EdgeId::from(new.edges.len());
                        references[p as usize] = Some(Reference { edge: id, reversed: false, leader: p });
                        let piece = decisions.pieces.all[p as usize];
                        let [start, end] = piece.ends.map(|c| vertices.of_cluster[c as usize]);
                        new.edges.push(Edge { range: piece.range, start, end, ..edge.clone() });
                    }
                }
            }
        }
    }
    for joint in decisions.joints {
        let leader = references[joint.leader as usize].expect("leaders have edges");
        for &(other, reversed, _) in &joint.others {
            references[other as usize] = Some(Reference { reversed, ..leader });
        }
    }
    let rebuild = Faces {
        part,
        decisions,
        references: &references,
        kept: &kept,
        border_of: &border_of,
        vertices: &vertices,
    };
    new.faces = part.faces.iter().map(|face| rebuild.face(face)).collect();
    Rebuilt { part: new, links: links(decisions, &references) }
}

/// Pieces whose edge is another one's.
fn followers(decisions: &Decisions<'_>) -> Vec<bool> {
    let mut follows = vec![false; decisions.pieces.all.len()];
    decisions.joints.iter().flat_map(|j| &j.others).for_each(|o| follows[o.0 as usize] = true);
    follows
}

fn links(decisions: &Decisions<'_>, references: &[Option<Reference>]) -> Vec<Link> {
    let side = |piece: u32| {
        let of = decisions.borders.all[decisions.pieces.all[piece as usize].border as usize].of;
        let reversed = references[piece as usize].is_some_and(|r| r.reversed);
        let wrong = decisions.wrong_loops[of.face as usize].contains(&(of.in_loop as usize));
        (of.face, of.forward ^ reversed ^ wrong)
    };
    let link = |joint: &Joint| {
        let [a, b] = joint.pair.map(side);
        Link { faces: [a.0, b.0], same: a.1 == b.1 }
    };
    decisions.joints.iter().map(link).collect()
}

/// The new vertex of each vertex.
struct VertexMap {
    of: Vec<VertexId>,
    of_cluster: Vec<VertexId>,
    points: Vec<Vertex>,
}

impl VertexMap {
    fn new(part: &Part, decisions: &Decisions<'_>) -> Self {
        let Decisions { corners, clusters, .. } = *decisions;
        // A cluster takes the place of its lowest vertex.
        let mut stands_for: Vec<u32> = (0..part.vertices.len() as u32).collect();
        let mut target = vec![None; part.vertices.len()];
        for cluster in &clusters.all {
            let vertex = |m: &u32| corners[*m as usize].vertex;
            let lowest = cluster.members.iter().map(vertex).min().expect("clusters have members");
            cluster.members.iter().for_each(|m| stands_for[vertex(m) as usize] = lowest);
            target[lowest as usize] = Some(cluster.target);
        }
        let mut of = Vec::with_capacity(part.vertices.len());
        let mut points = Vec::new();
        for (v, vertex) in part.vertices.iter().enumerate() {
            if stands_for[v] as usize == v {
                of.push(VertexId::from(points.len()));
                points.push(Vertex { point: target[v].unwrap_or(vertex.point), ..vertex.clone() });
            } else {
                of.push(of[stands_for[v] as usize]);
            }
        }
        let first = |c: &crate::cluster::Cluster| of[corners[c.members[0] as usize].vertex as usize];
        let of_cluster = clusters.all.iter().map(first).collect();
        Self { of, of_cluster, points }
    }
}

struct Faces<'a> {
    part: &'a Part,
    decisions: &'a Decisions<'a>,
    references: &'a [Option<Reference>],
    kept: &'a [EdgeId],
    border_of: &'a [Option<usize>],
    vertices: &'a VertexMap,
}

impl Faces<'_> {
    fn face(&self, face: &chordal_brep::Face) -> chordal_brep::Face {
        let mut new = face.clone();
        let had_edges = face.loops.iter().any(|l| matches!(l, Loop::Edges { .. }));
        let surface = match &face.geometry {
            FaceGeometry::Surface(surface) => Some(surface.as_ref()),
            FaceGeometry::Failed(_) => None,
        };
        new.loops = face.loops.iter().filter_map(|l| self.one_loop(l, surface)).collect();
        let has_edges = new.loops.iter().any(|l| matches!(l, Loop::Edges { .. }));
        if had_edges && !has_edges {
            new.geometry = FaceGeometry::Failed(Issue::error(face.source, MeshIssue::NoArea));
        }
        new
    }

    /// A loop is dropped where all its edges vanish.
    fn one_loop(&self, a_loop: &Loop, surface: Option<&Surface>) -> Option<Loop> {
        match a_loop {
            Loop::Vertex(v) => Some(Loop::Vertex(self.vertices.of[v.index()])),
            Loop::Polygon { vertices, outer } => {
                let vertices = vertices.iter().map(|v| self.vertices.of[v.index()]).collect();
                Some(Loop::Polygon { vertices, outer: *outer })
            }
            Loop::Edges { coedges, outer } => {
                let new: Vec<Coedge> = coedges.iter().flat_map(|c| self.coedge(c, surface)).collect();
                (!new.is_empty() || coedges.is_empty()).then_some(Loop::Edges { coedges: new, outer: *outer })
            }
        }
    }

    fn coedge(&self, coedge: &Coedge, surface: Option<&Surface>) -> Vec<Coedge> {
        let Some(b) = self.border_of[coedge.edge.index()] else {
            return vec![Coedge { edge: self.kept[coedge.edge.index()], ..coedge.clone() }];
        };
        let (first, last) = self.decisions.pieces.of[b];
        let whole = self.part.edges[coedge.edge.index()].range;
        let of_piece = |p: u32| {
            let reference = self.references[p as usize]?;
            let pcurves = coedge.pcurves.iter().filter_map(|c| self.pcurve(c, whole, p, reference, surface));
            Some(Coedge {
                edge: reference.edge,
                forward: coedge.forward ^ reference.reversed,
                pcurves: pcurves.collect(),
            })
        };
        let mut new: Vec<Coedge> = (first..last).filter_map(of_piece).collect();
        if !coedge.forward {
            new.reverse();
        }
        new
    }

    /// The parameter curve of a piece, where it goes along with the edge that the piece has now.
    fn pcurve(
        &self,
        pcurve: &Pcurve,
        whole: Range,
        piece: u32,
        reference: Reference,
        surface: Option<&Surface>,
    ) -> Option<Pcurve> {
        let own = self.decisions.pieces.all[piece as usize].range;
        let at = |t: f64| pcurve.range.start + (t - whole.start) / whole.length() * pcurve.range.length();
        let range = if own == whole { pcurve.range } else { Range::new(at(own.start), at(own.end)) };
        if reference.leader == piece {
            return Some(Pcurve { curve: pcurve.curve.clone(), range });
        }
        let leader = self.decisions.pieces.all[reference.leader as usize];
        let curve = &self.decisions.borders.all[leader.border as usize].curve;
        let range = if reference.reversed { Range::new(range.end, range.start) } else { range };
        let surface = surface?;
        let follows = (0..=CHECKS).all(|i| {
            let share = f64::from(i) / f64::from(CHECKS);
            let p = curve.point(leader.range.start + share * leader.range.length());
            let q = surface.point(pcurve.curve.point(range.start + share * range.length()));
            q.distance(p) <= self.decisions.tolerance
        });
        follows.then(|| Pcurve { curve: pcurve.curve.clone(), range })
    }
}
