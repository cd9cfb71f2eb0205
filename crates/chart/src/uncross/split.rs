//! Divides edges at the places where they meet, for all faces that use them. Edges that coincide between the
//! same two vertices are replaced by one of them.

use super::Meeting;
use super::looseness::Looseness;
use chordal_brep::{Coedge, Edge, EdgeId, Loop, Part, Pcurve, Vertex, VertexId};
use chordal_nurbs::{Curve, CurveInverter, DVec3, Range};
use std::collections::{BTreeMap, BTreeSet};

/// Which edges replace the edges of a part after the division.
pub(super) struct Pieces {
    /// The vertex at each meeting, in the order of the meetings.
    pub vertices: Vec<VertexId>,
    /// For each divided edge, the parameters at which it is divided, in increasing order.
    cuts: BTreeMap<u32, Vec<f64>>,
    /// For each divided edge, its pieces in the order of the parameter.
    ids: BTreeMap<u32, Vec<EdgeId>>,
    /// For each edge that is replaced by a coincident one: that edge, and whether both have the same
    /// direction.
    merged: BTreeMap<u32, (EdgeId, bool)>,
    /// Closed edges shorter than the resolution; they are removed from the loops.
    removed: Vec<EdgeId>,
}

impl Pieces {
    /// The parameters at which an edge is divided, in increasing order.
    pub(super) fn cuts(&self, edge: u32) -> &[f64] {
        self.cuts.get(&edge).map_or(&[], Vec::as_slice)
    }

    /// The piece of an edge that contains a parameter, before coincident edges are replaced.
    pub(super) fn piece(&self, edge: u32, t: f64) -> EdgeId {
        let index = self.cuts(edge).iter().filter(|&&cut| cut < t).count();
        self.ids.get(&edge).map_or(EdgeId(edge), |ids| ids[index])
    }

    /// The edge that replaces an edge, and whether both have the same direction; `None` for a removed edge.
    pub(super) fn replacement(&self, edge: EdgeId) -> Option<(EdgeId, bool)> {
        if self.removed.contains(&edge) {
            return None;
        }
        Some(self.merged.get(&edge.0).copied().unwrap_or((edge, true)))
    }

    /// The coedges that replace a coedge, along the pieces of its edge.
    fn coedges_for(&self, coedge: &Coedge, part: &Part) -> Vec<Coedge> {
        let Some(ids) = self.ids.get(&coedge.edge.0) else {
            return self.coedge(coedge.edge, coedge.forward, coedge.pcurves.clone()).into_iter().collect();
        };
        let start = part.edges[ids[0].index()].range.start;
        let end = part.edges[ids[ids.len() - 1].index()].range.end;
        let whole = Range::new(start, end);
        let piece = |id: &EdgeId| {
            let range = part.edges[id.index()].range;
            self.coedge(*id, coedge.forward, narrowed(&coedge.pcurves, whole, range))
        };
        let mut pieces: Vec<Coedge> = ids.iter().filter_map(piece).collect();
        if !coedge.forward {
            pieces.reverse();
        }
        pieces
    }

    /// A coedge along the edge that replaces `edge`.
    pub(super) fn coedge(&self, edge: EdgeId, forward: bool, pcurves: Vec<Pcurve>) -> Option<Coedge> {
        let (replaced, same_way) = self.replacement(edge)?;
        // Parameter curves belong to the parameters of one edge curve, so those of a replaced edge are
        // dropped.
        let pcurves = if replaced == edge { pcurves } else { Vec::new() };
        Some(Coedge { edge: replaced, forward: forward == same_way, pcurves })
    }
}

/// The parts of an edge's parameter curves that belong to one piece of the edge.
pub(super) fn narrowed(pcurves: &[Pcurve], whole: Range, piece: Range) -> Vec<Pcurve> {
    let one = |pcurve: &Pcurve| {
        let at = |t: f64| pcurve.range.start + (t - whole.start) / whole.length() * pcurve.range.length();
        Pcurve { curve: pcurve.curve.clone(), range: Range::new(at(piece.start), at(piece.end)) }
    };
    pcurves.iter().map(one).collect()
}

/// Divides the edges of a part at the meetings.
pub(super) fn split(part: &mut Part, meetings: &[Meeting], loose: &Looseness) -> Pieces {
    let resolution = loose.resolution;
    let replaced = join_vertices(part, meetings, resolution);
    let mut divisions: BTreeMap<u32, Vec<(f64, VertexId)>> = BTreeMap::new();
    let old = part.vertices.len();
    let mut vertices = Vec::with_capacity(meetings.len());
    for meeting in meetings {
        let vertex = current(&replaced, vertex_of(part, meeting, old, resolution));
        vertices.push(vertex);
        for stop in &meeting.stops {
            divisions.entry(stop.edge).or_default().push((stop.t, vertex));
        }
    }
    let mut pieces = Pieces {
        vertices,
        cuts: BTreeMap::new(),
        ids: BTreeMap::new(),
        merged: BTreeMap::new(),
        removed: Vec::new(),
    };
    for (edge, stops) in divisions {
        cut_edge(part, edge, stops, loose, &mut pieces);
    }
    merge(part, &mut pieces, loose);
    let mut faces = std::mem::take(&mut part.faces);
    for face in &mut faces {
        for a_loop in &mut face.loops {
            if let Loop::Edges { coedges, .. } = a_loop {
                *coedges = coedges.iter().flat_map(|coedge| pieces.coedges_for(coedge, part)).collect();
            }
        }
    }
    part.faces = faces;
    pieces
}

/// Unites vertices that coincide within the resolution, unless an edge connects them. The result maps each
/// vertex to the one that replaces it.
fn join_vertices(part: &mut Part, meetings: &[Meeting], resolution: f64) -> BTreeMap<VertexId, VertexId> {
    let joined: BTreeSet<[VertexId; 2]> =
        part.edges.iter().map(|e| [e.start.min(e.end), e.start.max(e.end)]).collect();
    let mut replaced: BTreeMap<VertexId, VertexId> = BTreeMap::new();
    for meeting in meetings {
        let Some(vertex) = meeting.vertex else { continue };
        for stop in &meeting.stops {
            let edge = &part.edges[stop.edge as usize];
            let Some(curve) = edge.curve.as_deref() else { continue };
            for (t, end) in [(edge.range.start, edge.start), (edge.range.end, edge.end)] {
                let apart = part.vertices[end.index()].point.distance(meeting.point);
                let [a, b] = [vertex, end].map(|v| current(&replaced, v));
                let (a, b) = (a.min(b), a.max(b));
                if a != b
                    && apart <= resolution
                    && stays_within(curve, stop.t, t, resolution)
                    && !joined.contains(&[a, b])
                {
                    replaced.insert(b, a);
                }
            }
        }
    }
    for edge in &mut part.edges {
        edge.start = current(&replaced, edge.start);
        edge.end = current(&replaced, edge.end);
    }
    replaced
}

/// The vertex that replaces a vertex, or the vertex itself.
fn current(replaced: &BTreeMap<VertexId, VertexId>, mut vertex: VertexId) -> VertexId {
    while let Some(&next) = replaced.get(&vertex) {
        vertex = next;
    }
    vertex
}

/// The vertex at a meeting: an existing one within the resolution, else a new one.
fn vertex_of(part: &mut Part, meeting: &Meeting, old: usize, resolution: f64) -> VertexId {
    if let Some(vertex) = meeting.vertex {
        return vertex;
    }
    let ends = meeting.stops.iter().flat_map(|s| {
        let edge = &part.edges[s.edge as usize];
        [edge.start, edge.end]
    });
    let new = (old..part.vertices.len()).map(VertexId::from);
    let near = |v: &VertexId| part.vertices[v.index()].point.distance(meeting.point) <= resolution;
    if let Some(known) = ends.chain(new).find(near) {
        return known;
    }
    let source = part.edges[meeting.stops[0].edge as usize].source;
    part.vertices.push(Vertex { point: meeting.point, source });
    VertexId::from(part.vertices.len() - 1)
}

/// Divides one edge. Divisions that would make a piece without length are omitted.
fn cut_edge(
    part: &mut Part,
    index: u32,
    mut stops: Vec<(f64, VertexId)>,
    loose: &Looseness,
    pieces: &mut Pieces,
) {
    let resolution = loose.resolution;
    let edge = part.edges[index as usize].clone();
    let Some(curve) = edge.curve.as_deref() else { return };
    stops.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    // An edge may run past its end vertex and come back (a hook). The hook is removed, with all divisions on
    // it.
    let hooks_back = |stop: &(f64, VertexId), vertex: VertexId, end: f64| {
        stop.1 == vertex && stays_within(curve, stop.0, end, loose.of_hook(index))
    };
    if let Some(last) = stops.iter().rposition(|stop| hooks_back(stop, edge.start, edge.range.start)) {
        stops.drain(..last);
    }
    if let Some(first) = stops.iter().position(|stop| hooks_back(stop, edge.end, edge.range.end)) {
        stops.truncate(first + 1);
    }
    let mut kept: Vec<(f64, VertexId)> = vec![(edge.range.start, edge.start)];
    for (t, vertex) in stops {
        let (before, at) = kept[kept.len() - 1];
        if vertex == at && stays_within(curve, before, t, resolution) || t <= before || t >= edge.range.end {
            continue;
        }
        kept.push((t, vertex));
    }
    while kept.len() > 1 {
        let (t, vertex) = kept[kept.len() - 1];
        if vertex != edge.end || !stays_within(curve, t, edge.range.end, resolution) {
            break;
        }
        kept.pop();
    }
    if kept.len() == 1 {
        return;
    }
    kept.push((edge.range.end, edge.end));
    let mut ids = Vec::with_capacity(kept.len() - 1);
    for (k, pair) in kept.windows(2).enumerate() {
        let piece = Edge {
            range: Range::new(pair[0].0, pair[1].0),
            start: pair[0].1,
            end: pair[1].1,
            ..edge.clone()
        };
        // The first piece keeps the index of the edge.
        if k == 0 {
            part.edges[index as usize] = piece;
            ids.push(EdgeId(index));
        } else {
            ids.push(EdgeId::from(part.edges.len()));
            part.edges.push(piece);
        }
    }
    pieces.cuts.insert(index, kept[1..kept.len() - 1].iter().map(|k| k.0).collect());
    pieces.ids.insert(index, ids);
}

/// True if a curve stays within the resolution of its point at `a`, from `a` to `b`, at four samples.
pub(super) fn stays_within(curve: &Curve, a: f64, b: f64, resolution: f64) -> bool {
    let start = curve.point(a);
    (1..=4).all(|k| curve.point(a + (b - a) * f64::from(k) / 4.0).distance(start) <= resolution)
}

/// Finds the pieces that coincide with another edge between the same vertices, and those without length.
fn merge(part: &Part, pieces: &mut Pieces, loose: &Looseness) {
    let whole: BTreeMap<EdgeId, u32> =
        pieces.ids.iter().flat_map(|(&edge, ids)| ids.iter().map(move |&id| (id, edge))).collect();
    let of_whole = |id: EdgeId| whole.get(&id).copied().unwrap_or(id.0);
    let made: Vec<EdgeId> = pieces.ids.values().flatten().copied().collect();
    let mut between: BTreeMap<[VertexId; 2], Vec<EdgeId>> = BTreeMap::new();
    let key = |e: &Edge| [e.start.min(e.end), e.start.max(e.end)];
    for id in &made {
        between.entry(key(&part.edges[id.index()])).or_default();
    }
    for (i, edge) in part.edges.iter().enumerate() {
        if let Some(group) = between.get_mut(&key(edge)) {
            group.push(EdgeId::from(i));
        }
    }
    for group in between.values() {
        for (k, &one) in group.iter().enumerate() {
            let edge = &part.edges[one.index()];
            let Some(curve) = edge.curve.as_deref() else { continue };
            if edge.start == edge.end
                && stays_within(curve, edge.range.start, edge.range.end, loose.of_hook(of_whole(one)))
            {
                pieces.removed.push(one);
                continue;
            }
            let same = group[..k].iter().find_map(|&other| {
                let is_free = !pieces.merged.contains_key(&other.0) && !pieces.removed.contains(&other);
                let apart = loose.between(of_whole(one), of_whole(other));
                let same_way = is_free.then(|| lies_on(edge, &part.edges[other.index()], apart)).flatten();
                same_way.map(|same_way| (other, same_way))
            });
            if let Some(same) = same {
                pieces.merged.insert(one.0, same);
            }
        }
    }
}

/// Edges shorter than this many times the distance within which edges coincide are united without a test of
/// shape: the distance hides their direction. A larger value would unite edges that bound a sliver.
const SHORT_EDGE: f64 = 4.0;

/// `Some` if an edge coincides with another one between the same two vertices, within the distance `apart`:
/// true if both have the same direction.
fn lies_on(one: &Edge, other: &Edge, apart: f64) -> Option<bool> {
    let (a, b) = (one.curve.as_deref()?, other.curve.as_deref()?);
    let at = |k: u32| one.range.start + one.range.length() * f64::from(k) / 8.0;
    let inverter = CurveInverter::new(b, other.range);
    let found: Vec<(f64, DVec3)> =
        (1..8).map(|k| (inverter.invert(a.point(at(k)), None).t, a.point(at(k)))).collect();
    let near = found.iter().all(|(t, p)| b.point(*t).distance(*p) <= apart);
    // Of two coincident edges, the parameters of the closest points increase or decrease monotonically. If
    // one edge goes round a closed curve and the other does not, they do neither.
    let rises = found.windows(2).all(|pair| pair[1].0 > pair[0].0);
    let falls = found.windows(2).all(|pair| pair[1].0 < pair[0].0);
    if one.start != one.end && is_short(one, a, apart) && is_short(other, b, apart) {
        return Some(one.start == other.start);
    }
    (near && (rises || falls)).then_some(rises)
}

fn is_short(edge: &Edge, curve: &Curve, apart: f64) -> bool {
    stays_within(curve, edge.range.start, edge.range.end, SHORT_EDGE * apart)
}
