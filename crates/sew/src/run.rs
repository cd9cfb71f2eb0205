//! The sewing of one part, top to bottom.

use crate::border::{Borders, Use, edge_uses};
use crate::cluster::{Clusters, Corner, cluster};
use crate::cut::{Pieces, cut};
use crate::gaps::{nearest_other, survey};
use crate::natural::add_natural_borders;
use crate::orient::orient;
use crate::pair::{Joint, Pairing, vanishes};
use crate::polygon::add_polygon_edges;
use crate::rebuild::{Decisions, Link, Rebuilt, rebuild};
use crate::report::{OpenEdge, SewReport};
use crate::shells::{affected, body_of_faces, is_whole, regroup};
use crate::uv_loops::wrong_loops;
use chordal_brep::{EdgeId, FaceId, Part};

/// An edge may close into a ring where it is longer than this many tolerances.
const RING: f64 = 4.0;

/// The distance up to which borders are sewn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SewTolerance {
    /// From the file's resolution and the histogram of gaps.
    Auto,
    /// In the part's own units.
    Length(f64),
}

/// True if the file has topology: some edge is used by two faces.
pub fn has_topology(part: &Part) -> bool {
    let other_face = |uses: &Vec<Use>| uses.iter().any(|u| u.face != uses[0].face);
    edge_uses(part).iter().any(|uses| uses.len() > 1 && other_face(uses))
}

/// The number of edges with exactly one use.
pub fn open_edges(part: &Part) -> usize {
    let uses = edge_uses(part);
    part.edges.iter().zip(&uses).filter(|(edge, uses)| uses.len() == 1 && edge.curve.is_some()).count()
}

/// Infers the shared edges of a part. A part with nothing to sew is returned unchanged.
///
/// No vertex and no point of an edge moves by more than the tolerance; edges with two uses stay as they are.
pub fn sew_part(part: &Part, tolerance: SewTolerance) -> (Part, SewReport) {
    let mut given = part.clone();
    let natural = add_natural_borders(&mut given);
    add_polygon_edges(&mut given);
    let uses = edge_uses(&given);
    let borders = Borders::new(&given, &uses);
    let auto = if tolerance == SewTolerance::Auto { survey(&given, &borders) } else { None };
    let length = match tolerance {
        SewTolerance::Length(length) => length,
        SewTolerance::Auto => auto.as_ref().map_or(0.0, |a| a.tolerance),
    };
    let none =
        SewReport { face_moves: vec![0.0; part.faces.len()], tolerance: length, ..SewReport::default() };
    let nothing = borders.all.is_empty() && !part.shells.iter().any(|s| !s.closed);
    let unusable = !(length > 0.0 && length.is_finite());
    if nothing || unusable && !borders.all.is_empty() {
        return (part.clone(), SewReport { auto, ..none });
    }
    let sewing = Sewing { part: &given, uses: &uses, borders: &borders, tolerance: length };
    let mut best = sewing.attempt(&[]);
    // Edges without a partner that are shorter than the tolerance keep the ends of their neighbours apart, so
    // they are merged into vertices.
    let short = sewing.short_open(&best);
    if !short.is_empty() {
        let second = sewing.attempt(&short);
        if second.open_count() < best.open_count() {
            best = second;
        }
    }
    let (sewn, report) = sewing.finish(best);
    if report.sewn == 0 && report.closed_shells == 0 {
        // Borders without a partner are unchanged.
        return (
            part.clone(),
            SewReport { auto, open_before: report.open_before, open: report.open, ..none },
        );
    }
    (sewn, SewReport { auto, natural, ..report })
}

struct Sewing<'a> {
    part: &'a Part,
    uses: &'a [Vec<Use>],
    borders: &'a Borders,
    tolerance: f64,
}

/// One run over all stages.
struct Attempt {
    corners: Vec<Corner>,
    clusters: Clusters,
    pieces: Pieces,
    joints: Vec<Joint>,
    vanished: Vec<bool>,
    /// For each piece, whether it is part of a joint.
    joined: Vec<bool>,
}

impl Attempt {
    fn open_count(&self) -> usize {
        (0..self.joined.len()).filter(|&p| !self.joined[p] && !self.vanished[p]).count()
    }
}

impl Sewing<'_> {
    /// Sews; the borders in `vanishing` (in increasing order) may become a single vertex.
    fn attempt(&self, vanishing: &[u32]) -> Attempt {
        let (corners, corner_of) = self.corners();
        let apart = self.apart(&corners, &corner_of, vanishing);
        let clusters = cluster(&corners, &apart, self.tolerance);
        let cluster_of = |v: u32| clusters.of[corner_of[v as usize] as usize];
        let ends: Vec<[u32; 2]> = self.borders.all.iter().map(|b| b.ends.map(cluster_of)).collect();
        let pieces = cut(self.borders, &ends, &clusters, self.tolerance);
        let gone = |p: &crate::cut::Piece| {
            let border = &self.borders.all[p.border as usize];
            vanishing.binary_search(&p.border).is_ok()
                && vanishes(border, p, clusters.all[p.ends[0] as usize].target, self.tolerance)
        };
        let vanished: Vec<bool> = pieces.all.iter().map(gone).collect();
        let body = body_of_faces(self.part);
        let pairing = Pairing {
            part: self.part,
            borders: self.borders,
            pieces: &pieces,
            body: &body,
            tolerance: self.tolerance,
        };
        let mut joints = pairing.joints();
        joints.retain(|j| !vanished[j.leader as usize] && j.others.iter().all(|o| !vanished[o.0 as usize]));
        let mut joined = vec![false; pieces.all.len()];
        for joint in &joints {
            joined[joint.leader as usize] = true;
            joint.others.iter().for_each(|o| joined[o.0 as usize] = true);
        }
        Attempt { corners, clusters, pieces, joints, vanished, joined }
    }

    /// The ends of the borders, and per vertex its corner.
    fn corners(&self) -> (Vec<Corner>, Vec<u32>) {
        let mut wanted = vec![false; self.part.vertices.len()];
        self.borders.all.iter().flat_map(|b| b.ends).for_each(|v| wanted[v as usize] = true);
        let mut anchored = vec![false; self.part.vertices.len()];
        for (edge, uses) in self.part.edges.iter().zip(self.uses) {
            if uses.len() > 1 && edge.curve.is_some() {
                [edge.start, edge.end].iter().for_each(|v| anchored[v.index()] = true);
            }
        }
        let mut corner_of = vec![u32::MAX; wanted.len()];
        let mut corners = Vec::new();
        for v in (0..wanted.len()).filter(|&v| wanted[v]) {
            corner_of[v] = corners.len() as u32;
            let point = self.part.vertices[v].point;
            corners.push(Corner { vertex: v as u32, point, anchored: anchored[v] });
        }
        (corners, corner_of)
    }

    /// Per corner, the corners at the other ends of edges that must stay edges.
    fn apart(&self, corners: &[Corner], corner_of: &[u32], vanishing: &[u32]) -> Vec<Vec<u32>> {
        let mut stays = vec![true; self.part.edges.len()];
        for (b, border) in self.borders.all.iter().enumerate() {
            let may = vanishing.binary_search(&(b as u32)).is_ok();
            stays[border.edge.index()] = !may && border.length <= RING * self.tolerance;
        }
        let mut apart = vec![Vec::new(); corners.len()];
        for (e, edge) in self.part.edges.iter().enumerate().filter(|(e, _)| stays[*e]) {
            let [a, b] = [edge.start, edge.end].map(|v| corner_of[v.index()]);
            if a != b && a != u32::MAX && b != u32::MAX && self.part.edges[e].curve.is_some() {
                apart[a as usize].push(b);
                apart[b as usize].push(a);
            }
        }
        apart
    }

    /// Borders shorter than the tolerance of which a piece stayed open.
    fn short_open(&self, attempt: &Attempt) -> Vec<u32> {
        let open = |b: usize| {
            let (first, last) = attempt.pieces.of[b];
            (first..last).any(|p| !attempt.joined[p as usize])
        };
        (0..self.borders.all.len())
            .filter(|&b| self.borders.all[b].length <= self.tolerance && open(b))
            .map(|b| b as u32)
            .collect()
    }

    fn finish(&self, attempt: Attempt) -> (Part, SewReport) {
        let Attempt { corners, clusters, pieces, joints, vanished, .. } = &attempt;
        let wrong_loops = wrong_loops(self.part);
        let decisions = Decisions {
            borders: self.borders,
            corners,
            clusters,
            pieces,
            joints,
            vanished,
            tolerance: self.tolerance,
            wrong_loops: &wrong_loops,
        };
        let Rebuilt { part: mut sewn, mut links } = rebuild(self.part, &decisions);
        links.extend(self.old_links(&wrong_loops));
        let given = self.part;
        let flipped: Vec<bool> = sewn.faces.iter().map(|f| f.flipped).collect();
        let mut has_border = vec![false; sewn.faces.len()];
        self.borders.all.iter().for_each(|b| has_border[b.of.face as usize] = true);
        // A whole surface that is closed in itself is a shell, independent of the file.
        let in_open = sewn.shells.iter().filter(|s| !s.closed).flat_map(|s| &s.faces);
        in_open.filter(|f| is_whole(&sewn, **f)).for_each(|f| has_border[f.index()] = true);
        let affected = affected(&sewn, &has_border);
        links.retain(|l| l.faces.iter().all(|&f| affected[f as usize]));
        let oriented = orient(sewn.faces.len(), &flipped, &links);
        for (face, _) in sewn.faces.iter_mut().zip(&oriented.turn).filter(|(_, turn)| **turn) {
            face.flipped = !face.flipped;
        }
        let shells = regroup(&mut sewn, &affected, &oriented, &links);
        let moves = self.face_moves(&attempt);
        let report = SewReport {
            tolerance: self.tolerance,
            open_before: self.borders.all.len(),
            sewn: joints.len(),
            shared_by_more: joints.iter().filter(|j| j.others.len() > 1).count(),
            cuts: pieces.all.len() - self.borders.all.len(),
            vanished: vanished.iter().filter(|&&v| v).count(),
            open: still_open(&sewn),
            largest_move: moves.iter().copied().fold(0.0, f64::max),
            face_moves: moves,
            turned: given.faces.iter().zip(&sewn.faces).filter(|(a, b)| a.flipped != b.flipped).count(),
            contradictions: oriented.contradictions,
            shells: shells.shells,
            closed_shells: shells.closed,
            ..SewReport::default()
        };
        (sewn, report)
    }

    /// Faces that the file joined already.
    fn old_links(&self, wrong_loops: &[Vec<usize>]) -> Vec<Link> {
        let forward = |u: Use| u.forward ^ wrong_loops[u.face as usize].contains(&(u.in_loop as usize));
        let pair = |uses: &Vec<Use>| {
            let [a, b] = uses[..] else { return None };
            Some(Link { faces: [a.face, b.face], same: forward(a) == forward(b) })
        };
        let is_curve = |e: &usize| self.part.edges[*e].curve.is_some();
        (0..self.uses.len()).filter(is_curve).filter_map(|e| pair(&self.uses[e])).collect()
    }

    /// For each face, the largest distance that its border was moved by.
    fn face_moves(&self, attempt: &Attempt) -> Vec<f64> {
        let mut moves = vec![0.0_f64; self.part.faces.len()];
        for (p, piece) in attempt.pieces.all.iter().enumerate() {
            let border = &self.borders.all[piece.border as usize];
            let of_face = &mut moves[border.of.face as usize];
            let at = [piece.range.start, piece.range.end];
            for (t, cluster) in at.into_iter().zip(piece.ends) {
                let end = if t == border.range.start {
                    self.part.vertices[border.ends[0] as usize].point
                } else if t == border.range.end {
                    self.part.vertices[border.ends[1] as usize].point
                } else {
                    border.curve.point(t)
                };
                *of_face = of_face.max(end.distance(attempt.clusters.all[cluster as usize].target));
            }
            if attempt.vanished[p] {
                *of_face = of_face.max(0.5 * border.length);
            }
        }
        for (other, _, distance) in attempt.joints.iter().flat_map(|j| &j.others) {
            let border = &self.borders.all[attempt.pieces.all[*other as usize].border as usize];
            moves[border.of.face as usize] = moves[border.of.face as usize].max(*distance);
        }
        moves
    }
}

/// The edges with one use, and how far each is from the nearest other one.
fn still_open(part: &Part) -> Vec<OpenEdge> {
    let uses = edge_uses(part);
    let borders = Borders::new(part, &uses);
    let open = |(b, border): (usize, &crate::border::Border)| OpenEdge {
        edge: EdgeId(border.edge.0),
        face: FaceId(border.of.face),
        source: part.edges[border.edge.index()].source,
        length: border.length,
        nearest: nearest_other(&borders, b, 0.5 * (border.range.start + border.range.end)),
    };
    borders.all.iter().enumerate().map(open).collect()
}
