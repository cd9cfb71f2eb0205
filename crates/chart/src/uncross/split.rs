//! Edges cut where they meet others, for all faces that use them; edges that lie on each other become one.

use super::Meeting;
use super::looseness::Looseness;
use chordal_brep::{Coedge, Edge, EdgeId, Loop, Part, Pcurve, Vertex, VertexId};
use chordal_nurbs::{Curve, CurveInverter, DVec3, Range};
use std::collections::{BTreeMap, BTreeSet};

/// What became of the edges of a part.
pub(super) struct Pieces {
    /// The vertex of each meeting.
    pub vertices: Vec<VertexId>,
    /// Per edge of the part before, its cuts in increasing order.
    cuts: BTreeMap<u32, Vec<f64>>,
    /// Per edge of the part before that was cut, its pieces in order.
    ids: BTreeMap<u32, Vec<EdgeId>>,
    /// Edges that another one stands for, and whether that one runs the same way.
    merged: BTreeMap<u32, (EdgeId, bool)>,
    /// Edges shorter than the resolution, that are one point.
    gone: Vec<EdgeId>,
}

impl Pieces {
    /// The cuts of an edge between two parameters, in increasing order.
    pub(super) fn cuts(&self, edge: u32) -> &[f64] {
        self.cuts.get(&edge).map_or(&[], Vec::as_slice)
    }

    /// The piece of an edge that a parameter lies on, before edges were merged.
    pub(super) fn piece(&self, edge: u32, t: f64) -> EdgeId {
        let index = self.cuts(edge).iter().filter(|&&cut| cut < t).count();
        self.ids.get(&edge).map_or(EdgeId(edge), |ids| ids[index])
    }

    /// The edge that stands for another, whether it runs the same way; `None` for one that is a point.
    pub(super) fn standing_for(&self, edge: EdgeId) -> Option<(EdgeId, bool)> {
        if self.gone.contains(&edge) {
            return None;
        }
        Some(self.merged.get(&edge.0).copied().unwrap_or((edge, true)))
    }

    /// A coedge along what became of its edge.
    fn renewed(&self, coedge: &Coedge, part: &Part) -> Vec<Coedge> {
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

    /// A coedge along the edge that stands for this one.
    pub(super) fn coedge(&self, edge: EdgeId, forward: bool, pcurves: Vec<Pcurve>) -> Option<Coedge> {
        let (stands, same_way) = self.standing_for(edge)?;
        // Another curve's parameters are no good for this one.
        let pcurves = if stands == edge { pcurves } else { Vec::new() };
        Some(Coedge { edge: stands, forward: forward == same_way, pcurves })
    }
}

/// Parameter curves of a whole edge, narrowed to a piece of it.
pub(super) fn narrowed(pcurves: &[Pcurve], whole: Range, piece: Range) -> Vec<Pcurve> {
    let one = |pcurve: &Pcurve| {
        let at = |t: f64| pcurve.range.start + (t - whole.start) / whole.length() * pcurve.range.length();
        Pcurve { curve: pcurve.curve.clone(), range: Range::new(at(piece.start), at(piece.end)) }
    };
    pcurves.iter().map(one).collect()
}

/// Cuts the edges of a part where they meet.
pub(super) fn split(part: &mut Part, meetings: &[Meeting], loose: &Looseness) -> Pieces {
    let resolution = loose.resolution;
    let stands = join_vertices(part, meetings, resolution);
    let mut wanted: BTreeMap<u32, Vec<(f64, VertexId)>> = BTreeMap::new();
    let old = part.vertices.len();
    let mut vertices = Vec::with_capacity(meetings.len());
    for meeting in meetings {
        let vertex = standing(&stands, vertex_of(part, meeting, old, resolution));
        vertices.push(vertex);
        for stop in &meeting.stops {
            wanted.entry(stop.edge).or_default().push((stop.t, vertex));
        }
    }
    let mut pieces = Pieces {
        vertices,
        cuts: BTreeMap::new(),
        ids: BTreeMap::new(),
        merged: BTreeMap::new(),
        gone: Vec::new(),
    };
    for (edge, stops) in wanted {
        cut_edge(part, edge, stops, loose, &mut pieces);
    }
    merge(part, &mut pieces, loose);
    let mut faces = std::mem::take(&mut part.faces);
    for face in &mut faces {
        for a_loop in &mut face.loops {
            if let Loop::Edges { coedges, .. } = a_loop {
                *coedges = coedges.iter().flat_map(|coedge| pieces.renewed(coedge, part)).collect();
            }
        }
    }
    part.faces = faces;
    pieces
}

/// Makes vertices one that meet within the resolution, unless an edge runs from one to the other.
fn join_vertices(part: &mut Part, meetings: &[Meeting], resolution: f64) -> BTreeMap<VertexId, VertexId> {
    let joined: BTreeSet<[VertexId; 2]> =
        part.edges.iter().map(|e| [e.start.min(e.end), e.start.max(e.end)]).collect();
    let mut stands: BTreeMap<VertexId, VertexId> = BTreeMap::new();
    for meeting in meetings {
        let Some(vertex) = meeting.vertex else { continue };
        for stop in &meeting.stops {
            let edge = &part.edges[stop.edge as usize];
            let Some(curve) = edge.curve.as_deref() else { continue };
            for (t, end) in [(edge.range.start, edge.start), (edge.range.end, edge.end)] {
                let apart = part.vertices[end.index()].point.distance(meeting.point);
                let [a, b] = [vertex, end].map(|v| standing(&stands, v));
                let (a, b) = (a.min(b), a.max(b));
                if a != b
                    && apart <= resolution
                    && is_still(curve, stop.t, t, resolution)
                    && !joined.contains(&[a, b])
                {
                    stands.insert(b, a);
                }
            }
        }
    }
    for edge in &mut part.edges {
        edge.start = standing(&stands, edge.start);
        edge.end = standing(&stands, edge.end);
    }
    stands
}

/// The vertex that stands for another.
fn standing(stands: &BTreeMap<VertexId, VertexId>, mut vertex: VertexId) -> VertexId {
    while let Some(&next) = stands.get(&vertex) {
        vertex = next;
    }
    vertex
}

/// The vertex at a meeting: one that is there already, or a new one.
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

/// Cuts one edge; cuts that leave a piece without length are left out.
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
    // Where a hook at an end is cut off, what else is met along it is of no account.
    let hooks_back = |stop: &(f64, VertexId), vertex: VertexId, end: f64| {
        stop.1 == vertex && is_still(curve, stop.0, end, loose.of_hook(index))
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
        if vertex == at && is_still(curve, before, t, resolution) || t <= before || t >= edge.range.end {
            continue;
        }
        kept.push((t, vertex));
    }
    while kept.len() > 1 {
        let (t, vertex) = kept[kept.len() - 1];
        if vertex != edge.end || !is_still(curve, t, edge.range.end, resolution) {
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
        // The first piece keeps the edge's place.
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

/// True where a curve stays within the resolution between two parameters.
pub(super) fn is_still(curve: &Curve, a: f64, b: f64, resolution: f64) -> bool {
    let start = curve.point(a);
    (1..=4).all(|k| curve.point(a + (b - a) * f64::from(k) / 4.0).distance(start) <= resolution)
}

/// Finds pieces that lie on other edges between the same vertices, and pieces that are points.
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
                && is_still(curve, edge.range.start, edge.range.end, loose.of_hook(of_whole(one)))
            {
                pieces.gone.push(one);
                continue;
            }
            let same = group[..k].iter().find_map(|&other| {
                let is_free = !pieces.merged.contains_key(&other.0) && !pieces.gone.contains(&other);
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

/// Edges shorter than so many times what they may lie apart have no direction of their own.
const SHORT: f64 = 4.0;

/// Whether an edge lies on another one between the same two vertices, and then whether both run the same way.
fn lies_on(one: &Edge, other: &Edge, apart: f64) -> Option<bool> {
    let (a, b) = (one.curve.as_deref()?, other.curve.as_deref()?);
    let at = |k: u32| one.range.start + one.range.length() * f64::from(k) / 8.0;
    let inverter = CurveInverter::new(b, other.range);
    let found: Vec<(f64, DVec3)> =
        (1..8).map(|k| (inverter.invert(a.point(at(k)), None).t, a.point(at(k)))).collect();
    let near = found.iter().all(|(t, p)| b.point(*t).distance(*p) <= apart);
    // Both are short of being the same stretch where one goes round and the other does not.
    let rises = found.windows(2).all(|pair| pair[1].0 > pair[0].0);
    let falls = found.windows(2).all(|pair| pair[1].0 < pair[0].0);
    if one.start != one.end && is_short(one, a, apart) && is_short(other, b, apart) {
        return Some(one.start == other.start);
    }
    (near && (rises || falls)).then_some(rises)
}

fn is_short(edge: &Edge, curve: &Curve, apart: f64) -> bool {
    is_still(curve, edge.range.start, edge.range.end, SHORT * apart)
}
