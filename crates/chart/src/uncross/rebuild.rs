//! New loops of a face from the boundary of its region.

use super::Crossed;
use super::split::{Pieces, narrowed};
use crate::keys::{ChartPoint, Key, Segment};
use chordal_brep::winding::{Strand, outlines};
use chordal_brep::{Coedge, EdgeId, Loop, Part, Pcurve, VertexId};
use chordal_nurbs::{DVec2, Range};
use std::collections::{BTreeMap, BTreeSet};

/// Chart points of one vertex nearer together than this share of the chart are one; the two sides of a seam
/// are further apart.
const ONE_PLACE: f64 = 1e-2;

/// Places this many times nearer together than those of one vertex are one.
const SAME_PLACE: f64 = 1e7;

/// A stretch of a polygon between two vertices.
struct Run {
    points: Vec<DVec2>,
    /// The piece of an edge that it runs along, forwards or backwards; `None` for cuts through the surface.
    piece: Option<(EdgeId, bool)>,
    polygon: u32,
}

/// The loops of the face without crossings, empty where it has no area; `None` where they cannot be made.
pub(super) fn loops(
    crossed: &Crossed<'_, '_>,
    part: &Part,
    pieces: &Pieces,
    guarded: &BTreeSet<EdgeId>,
) -> Option<Vec<Loop>> {
    let face = &part.faces[crossed.face];
    if face.loops.iter().any(|l| matches!(l, Loop::Polygon { .. })) {
        return None;
    }
    let chart = &crossed.chart;
    let Strands { strands, made_of } = Strands::of(crossed, part, pieces)?;
    let outer: Vec<bool> =
        (0..chart.loops.len()).map(|l| l == 0 || area(polygon(crossed, l)) > 0.0).collect();
    let is_inside = |w: &[i32]| {
        let count = |wanted: bool| (0..w.len()).filter(|&l| outer[l] == wanted && w[l] % 2 != 0).count();
        count(true) > count(false)
    };
    let found = outlines(&strands, chart.loops.len(), &is_inside)?;
    let keeps_direction = |s: usize| {
        let net: i32 = strands[s].loops.iter().map(|l| l.1).sum();
        net == i32::from(found.sides[s][0]) - i32::from(found.sides[s][1])
    };
    let is_guarded = |s: usize| made_of[s].is_some_and(|(id, _)| guarded.contains(&id));
    if (0..strands.len()).any(|s| is_guarded(s) && !keeps_direction(s)) {
        return None;
    }
    let (mut new, open) = chains(found.loops, &strands, &made_of);
    new.extend(closed(open, part)?.into_iter().map(|coedges| (coedges, true)));
    // Loops of the chart are oriented by the surface, loops of the part by the face.
    let backwards = !face.same_sense ^ chart.reversed;
    let mut loops: Vec<Loop> =
        new.into_iter().map(|(one, outer)| finished(crossed, part, one, outer, backwards)).collect();
    loops.extend(face.loops.iter().filter(|l| matches!(l, Loop::Vertex(_))).cloned());
    Some(loops)
}

/// The strands of a face, each once however many loops pass it, and the piece of an edge that each is.
struct Strands {
    strands: Vec<Strand>,
    made_of: Vec<Option<(EdgeId, bool)>>,
}

impl Strands {
    fn of(crossed: &Crossed<'_, '_>, part: &Part, pieces: &Pieces) -> Option<Self> {
        let chart = &crossed.chart;
        let runs = runs(crossed, pieces)?;
        let mut nodes = Nodes::new(chart.points.iter().map(|p| p.uv));
        let mut strands: Vec<Strand> = Vec::new();
        let mut made_of: Vec<Option<(EdgeId, bool)>> = Vec::new();
        for run in &runs {
            let vertices = run.piece.map(|(id, forward)| {
                let edge = &part.edges[id.index()];
                if forward { [edge.start, edge.end] } else { [edge.end, edge.start] }
            });
            let piece = match run.piece {
                Some((id, forward)) => match pieces.replacement(id) {
                    Some((stands, same_way)) => Some((stands, forward == same_way)),
                    None => continue,
                },
                None => None,
            };
            let mut points = run.points.clone();
            let last = points.len() - 1;
            let ends = [
                nodes.node(vertices.map(|v| v[0]), points[0]),
                nodes.node(vertices.map(|v| v[1]), points[last]),
            ];
            (points[0], points[last]) = (nodes.points[ends[0] as usize], nodes.points[ends[1] as usize]);
            let beside = |p: DVec2| ends.iter().all(|&n| nodes.is_apart(n, p));
            let inner: Vec<DVec2> = points[1..last].iter().copied().filter(|&p| beside(p)).collect();
            points.splice(1..last, inner);
            let same = (0..strands.len()).find(|&s| {
                let this_way = strands[s].ends == ends && made_of[s] == piece;
                let back = piece.map(|(id, forward)| (id, !forward));
                let other_way = strands[s].ends == [ends[1], ends[0]] && made_of[s] == back;
                piece.is_some() && (this_way || other_way)
            });
            match same {
                Some(s) => {
                    let times = if made_of[s] == piece { 1 } else { -1 };
                    strands[s].loops.push((run.polygon, times));
                }
                None => {
                    strands.push(Strand { ends, points, loops: vec![(run.polygon, 1)] });
                    made_of.push(piece);
                }
            }
        }
        Some(Self { strands, made_of })
    }
}

/// A loop by the pieces of edges that it passes, each with its direction.
type Chain = Vec<(EdgeId, bool)>;

/// The loops along edges, each with whether it is an outer one, and the parts along edges of loops that also
/// pass cuts through the surface.
fn chains(
    loops: Vec<Vec<(usize, bool)>>,
    strands: &[Strand],
    made_of: &[Option<(EdgeId, bool)>],
) -> (Vec<(Chain, bool)>, Vec<Chain>) {
    let mut new = Vec::new();
    let mut open = Vec::new();
    for one in loops {
        let coedges = |part_of: &[(usize, bool)]| -> Vec<(EdgeId, bool)> {
            let along = |&(s, forward): &(usize, bool)| made_of[s].map(|(id, way)| (id, way == forward));
            part_of.iter().filter_map(along).collect()
        };
        match one.iter().position(|&(s, _)| made_of[s].is_none()) {
            None => {
                let points: Vec<DVec2> =
                    one.iter().flat_map(|&(s, forward)| along(&strands[s], forward)).collect();
                new.push((coedges(&one), area(points.into_iter()) > 0.0));
            }
            Some(cut) => {
                let turned: Vec<(usize, bool)> = one[cut..].iter().chain(&one[..cut]).copied().collect();
                let runs = turned.split(|&(s, _)| made_of[s].is_none()).filter(|run| !run.is_empty());
                open.extend(runs.map(coedges));
            }
        }
    }
    (new, open)
}

/// The polygons of the chart, cut at vertices and at the cuts of edges.
fn runs(crossed: &Crossed<'_, '_>, pieces: &Pieces) -> Option<Vec<Run>> {
    let chart = &crossed.chart;
    let mut runs = Vec::new();
    for (l, &(start, end)) in chart.loops.iter().enumerate() {
        let mut of_loop: Vec<Run> = Vec::new();
        let points = &chart.points[start as usize..end as usize];
        // Begin at a vertex of the part, so that no run continues over the end of the polygon.
        let first = points.iter().position(|p| matches!(p.key, Key::Vertex(_)))?;
        for i in 0..points.len() {
            let a = &points[(first + i) % points.len()];
            let b = &points[(first + i + 1) % points.len()];
            let begins = i == 0 || matches!(a.key, Key::Vertex(_));
            for (k, (piece, ends)) in stretches(crossed, pieces, a, b).into_iter().enumerate() {
                match of_loop.last_mut() {
                    Some(last) if last.piece == piece && !(begins && k == 0) => last.points.push(ends[1]),
                    _ => of_loop.push(Run { points: ends.to_vec(), piece, polygon: l as u32 }),
                }
            }
        }
        runs.append(&mut of_loop);
    }
    Some(runs)
}

/// The piece of an edge that a stretch runs along, forwards or backwards, and the ends of the stretch; no
/// piece for cuts through the surface.
type Stretch = (Option<(EdgeId, bool)>, [DVec2; 2]);

/// One side of a polygon, cut where its edge is: the pieces it runs along, and from where to where.
fn stretches(crossed: &Crossed<'_, '_>, pieces: &Pieces, a: &ChartPoint, b: &ChartPoint) -> Vec<Stretch> {
    let Segment::Edge { edge, chord } = a.segment else { return vec![(None, [a.uv, b.uv])] };
    let samples = &crossed.context.edges[edge as usize];
    let k = chord as usize;
    let forward = runs_forward(crossed, edge, chord, a, b);
    let (t0, t1) = (samples.t[k], samples.t[k + 1]);
    let mut stops: Vec<f64> = pieces.cuts(edge).iter().copied().filter(|&t| t > t0 && t < t1).collect();
    stops.insert(0, t0);
    stops.push(t1);
    if !forward {
        stops.reverse();
    }
    let [from, to] = [stops[0], stops[stops.len() - 1]];
    let at = |t: f64| {
        let share = (t - from) / (to - from);
        let guess = a.uv.lerp(b.uv, share);
        if share == 0.0 || share == 1.0 {
            return guess;
        }
        let curve = crossed.context.part.edges[edge as usize].curve.as_deref();
        curve.map_or(guess, |c| crossed.context.surface.descend(c.point(t), guess))
    };
    let piece = |pair: &[f64]| {
        let id = pieces.piece(edge, 0.5 * (pair[0] + pair[1]));
        (Some((id, forward)), [at(pair[0]), at(pair[1])])
    };
    stops.windows(2).map(piece).collect()
}

/// Whether a side runs along its edge in the edge's direction.
fn runs_forward(crossed: &Crossed<'_, '_>, edge: u32, chord: u32, a: &ChartPoint, b: &ChartPoint) -> bool {
    let last = crossed.context.edges[edge as usize].sag.len() as u32;
    match (a.key, b.key) {
        (Key::Edge(e, i), _) if e == edge => i == chord,
        (_, Key::Edge(e, i)) if e == edge => i == chord + 1,
        _ => {
            let of_edge = &crossed.context.part.edges[edge as usize];
            debug_assert!(last <= 1 || of_edge.start != of_edge.end);
            a.key == Key::Vertex(of_edge.start.0)
        }
    }
}

/// Where strands meet: a vertex, at one place of the chart.
struct Nodes {
    /// Places further apart than this along an axis are different.
    near: DVec2,
    of_vertex: BTreeMap<u32, Vec<u32>>,
    of_place: BTreeMap<[u64; 2], u32>,
    points: Vec<DVec2>,
}

impl Nodes {
    fn new(points: impl Iterator<Item = DVec2>) -> Self {
        let (low, high) =
            points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        Self {
            near: (high - low) * ONE_PLACE,
            of_vertex: BTreeMap::new(),
            of_place: BTreeMap::new(),
            points: Vec::new(),
        }
    }

    /// True for a place that is not the place of the node.
    fn is_apart(&self, node: u32, uv: DVec2) -> bool {
        let d = (self.points[node as usize] - uv).abs() * SAME_PLACE;
        d.x > self.near.x || d.y > self.near.y
    }

    fn node(&mut self, vertex: Option<VertexId>, uv: DVec2) -> u32 {
        let place = [(uv.x + 0.0).to_bits(), (uv.y + 0.0).to_bits()];
        let is_near = |n: &&u32| {
            let d = (self.points[**n as usize] - uv).abs();
            d.x <= self.near.x && d.y <= self.near.y
        };
        let known = self.of_place.get(&place).or_else(|| {
            let of_vertex = vertex.and_then(|v| self.of_vertex.get(&v.0));
            of_vertex.into_iter().flatten().find(is_near)
        });
        let node = known.copied().unwrap_or_else(|| {
            self.points.push(uv);
            self.points.len() as u32 - 1
        });
        self.of_place.insert(place, node);
        if let Some(v) = vertex {
            let of_vertex = self.of_vertex.entry(v.0).or_default();
            if !of_vertex.contains(&node) {
                of_vertex.push(node);
            }
        }
        node
    }
}

fn polygon<'a>(crossed: &'a Crossed<'_, '_>, index: usize) -> impl Iterator<Item = DVec2> + 'a {
    let (start, end) = crossed.chart.loops[index];
    crossed.chart.points[start as usize..end as usize].iter().map(|p| p.uv)
}

fn area(points: impl Iterator<Item = DVec2>) -> f64 {
    let points: Vec<DVec2> = points.collect();
    let n = points.len();
    let origin = points.first().copied().unwrap_or_default();
    (0..n).map(|i| 0.5 * (points[i] - origin).perp_dot(points[(i + 1) % n] - origin)).sum()
}

/// The points of a strand in a direction, without the last.
fn along(strand: &Strand, forward: bool) -> Vec<DVec2> {
    let mut points = strand.points.clone();
    if !forward {
        points.reverse();
    }
    points.pop();
    points
}

/// Joins chains that were interrupted by cuts through the surface, at their common vertices.
fn closed(mut open: Vec<Vec<(EdgeId, bool)>>, part: &Part) -> Option<Vec<Vec<(EdgeId, bool)>>> {
    let start = |&(id, forward): &(EdgeId, bool)| {
        let edge = &part.edges[id.index()];
        if forward { edge.start } else { edge.end }
    };
    let end = |&(id, forward): &(EdgeId, bool)| start(&(id, !forward));
    let mut loops = Vec::new();
    while let Some(mut one) = open.pop() {
        while end(one.last()?) != start(one.first()?) {
            let next = open.iter().position(|other| other.first().map(start) == one.last().map(end))?;
            one.extend(open.remove(next));
        }
        loops.push(one);
    }
    Some(loops)
}

/// A loop of the face.
fn finished(
    crossed: &Crossed<'_, '_>,
    part: &Part,
    mut one: Vec<(EdgeId, bool)>,
    outer: bool,
    backwards: bool,
) -> Loop {
    if backwards {
        one.reverse();
        one.iter_mut().for_each(|(_, forward)| *forward = !*forward);
    }
    let coedges = one
        .into_iter()
        .map(|(edge, forward)| Coedge { edge, forward, pcurves: pcurves(crossed, part, edge, forward) })
        .collect();
    Loop::Edges { coedges, outer }
}

/// The face's parameter curves for an edge, from the coedge that ran along it.
fn pcurves(crossed: &Crossed<'_, '_>, part: &Part, edge: EdgeId, forward: bool) -> Vec<Pcurve> {
    let coedges = || {
        part.faces[crossed.face].loops.iter().flat_map(|l| match l {
            Loop::Edges { coedges, .. } => coedges.as_slice(),
            _ => &[],
        })
    };
    let own = coedges().find(|c| c.edge == edge && c.forward == forward);
    let any = own.or_else(|| coedges().find(|c| c.edge == edge));
    let range: Range = part.edges[edge.index()].range;
    any.map_or_else(Vec::new, |c| narrowed(&c.pcurves, range, range))
}
