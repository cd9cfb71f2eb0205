//! Sites: places at which borders, however many, become one vertex.
//!
//! Correspondences between two borders at a time do not suffice where three and more meet: what one pair of
//! borders gets, the third one lacks, and a slit remains. So vertices come first, then all borders:
//!
//! 1. Vertices of borders that are sewn to each other become one site where they correspond, or lie nearer
//!    together than [`NEAR`]; never two that are close to each other along one border.
//! 2. Every border at a site that has no vertex there gets one, at the place that corresponds, or at the
//!    nearest one: that of the common reparametrisation of all of them.

use super::boundary::{Boundaries, neighbours};
use super::closest::{Edges, Place, between, near_places};
use super::track::Joints;
use crate::cluster::{Clusters, Corner, cluster_pairs};
use chordal_nurbs::{Box3, BoxTree};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Vertices of two borders within this share of the tolerance are one: which of them comes first along the
/// line is noise, and would differ from border to border.
const NEAR: f64 = 0.75;
/// A border has one vertex at a site along this many tolerances.
const APART: f64 = 4.0;

/// Vertices that become one.
pub(crate) type Merge = (f64, u32, u32);

/// A new vertex of a border, and the vertex that it is merged with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Insertion {
    pub place: Place,
    pub vertex: u32,
    pub distance: f64,
}

/// What an earlier attempt could not join without moving a vertex too far.
#[derive(Debug, Default)]
pub(crate) struct Refused {
    /// Two vertices.
    pub merges: BTreeSet<[u32; 2]>,
    /// A vertex, and the border that was to get one for it.
    pub insertions: BTreeSet<[u32; 2]>,
}

/// What is to be inserted and merged.
#[derive(Debug, Default)]
pub(crate) struct Sites {
    pub merges: Vec<Merge>,
    pub insertions: Vec<Insertion>,
}

struct Finder<'a> {
    boundaries: &'a Boundaries,
    tolerance: f64,
    /// Per vertex, its border and its number in it.
    owner: Vec<Option<(u32, u32)>>,
    /// Pairs of borders that are sewn along a stretch, the lower number first.
    sewn: BTreeSet<[u32; 2]>,
}

impl Sites {
    pub fn new(boundaries: &Boundaries, joints: &Joints, tolerance: f64, refused: &Refused) -> Self {
        if joints.pairs.is_empty() {
            return Self::default();
        }
        let finder = Finder::new(boundaries, joints, tolerance);
        let mut merges = finder.corresponding(joints);
        merges.extend(finder.near_vertices());
        merges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        merges.dedup();
        merges.retain(|m| !refused.merges.contains(&[m.1, m.2]));
        let mut apart = finder.apart(&merges);
        for &[a, b] in &refused.merges {
            apart[a as usize].push(b);
            apart[b as usize].push(a);
        }
        let corner = |(i, &point): (usize, &DVec3)| Corner { vertex: i as u32, point, anchored: false };
        let corners: Vec<Corner> = boundaries.positions.iter().enumerate().map(corner).collect();
        let clusters = cluster_pairs(&corners, &apart, NEAR * tolerance, &merges);
        merges.retain(|m| clusters.of[m.1 as usize] == clusters.of[m.2 as usize]);
        let mut insertions = finder.insertions(joints, &clusters);
        insertions.retain(|one| !refused.insertions.contains(&[one.vertex, one.place.border]));
        Self { merges, insertions }
    }
}

/// True for a place that is a vertex.
fn is_vertex(place: &Place) -> bool {
    place.share == 0.0 || place.share == 1.0
}

impl<'a> Finder<'a> {
    fn new(boundaries: &'a Boundaries, joints: &Joints, tolerance: f64) -> Self {
        let mut owner = vec![None; boundaries.positions.len()];
        for (b, boundary) in boundaries.all.iter().enumerate() {
            for (i, &v) in boundary.vertices.iter().enumerate() {
                owner[v as usize] = Some((b as u32, i as u32));
            }
        }
        let borders = |p: &super::track::Pair| {
            let [a, b] = p.places.map(|place| place.border);
            [a.min(b), a.max(b)]
        };
        Self { boundaries, tolerance, owner, sewn: joints.pairs.iter().map(borders).collect() }
    }

    /// The vertex of a place at an end of its edge.
    fn vertex(&self, place: &Place) -> u32 {
        let ends = self.boundaries.all[place.border as usize].edge(place.edge as usize);
        ends[usize::from(place.share == 1.0)]
    }

    fn are_sewn(&self, a: u32, b: u32) -> bool {
        self.sewn.contains(&[a.min(b), a.max(b)])
    }

    /// The length of a border up to one of its vertices.
    fn along(&self, (border, i): (u32, u32)) -> f64 {
        self.boundaries.all[border as usize].along[i as usize]
    }

    /// Vertices that correspond to each other.
    fn corresponding(&self, joints: &Joints) -> Vec<Merge> {
        let both = joints.pairs.iter().filter(|p| p.places.iter().all(is_vertex));
        let merge = |p: &super::track::Pair| {
            let [a, b] = p.places.each_ref().map(|place| self.vertex(place));
            (p.distance, a.min(b), a.max(b))
        };
        both.map(merge).filter(|m| m.1 != m.2).collect()
    }

    /// Vertices of borders that are sewn to each other, nearer together than [`NEAR`].
    fn near_vertices(&self) -> Vec<Merge> {
        let point = |v: u32| self.boundaries.point(v);
        let vertices: Vec<u32> =
            (0..self.owner.len() as u32).filter(|&v| self.owner[v as usize].is_some()).collect();
        let tree = BoxTree::new(vertices.iter().map(|&v| Box3 { min: point(v), max: point(v) }));
        let near = NEAR * self.tolerance;
        let mut found = Vec::new();
        for &v in &vertices {
            let Some(of_v) = self.owner[v as usize] else { continue };
            tree.meeting(Box3 { min: point(v), max: point(v) }.inflated(near), |k| {
                let w = vertices[k as usize];
                let Some(of_w) = self.owner[w as usize] else { return };
                let distance = point(v).distance(point(w));
                let is_other_place =
                    of_v.0 != of_w.0 || self.is_apart(of_v.0, self.along(of_v), self.along(of_w));
                if v < w && distance <= near && is_other_place && self.are_sewn(of_v.0, of_w.0) {
                    found.push((distance, v, w));
                }
            });
        }
        found
    }

    /// True where a border runs on for long between two of its places.
    fn is_apart(&self, border: u32, a: f64, b: f64) -> bool {
        between(self.boundaries, border, a, b) > APART * self.tolerance
    }

    /// Per vertex, those that it must not become one with: beside it along its border or in a triangle.
    fn apart(&self, merges: &[Merge]) -> Vec<Vec<u32>> {
        let mut apart = neighbours(&self.boundaries.triangles, merges, self.owner.len());
        for (b, boundary) in self.boundaries.all.iter().enumerate() {
            let n = boundary.vertices.len();
            for i in 0..n {
                for step in 1..n {
                    let j = (i + step) % n;
                    let is_open_end = !boundary.closed && i + step >= n;
                    if is_open_end || self.is_apart(b as u32, boundary.along[i], boundary.along[j]) {
                        break;
                    }
                    apart[boundary.vertices[i] as usize].push(boundary.vertices[j]);
                    apart[boundary.vertices[j] as usize].push(boundary.vertices[i]);
                }
            }
        }
        apart
    }

    /// New vertices of borders that lack one at a site.
    fn insertions(&self, joints: &Joints, clusters: &Clusters) -> Vec<Insertion> {
        let mut wanted: BTreeMap<(u32, u32), Vec<Insertion>> = BTreeMap::new();
        let mut want = |one: Insertion| {
            let site = clusters.of[one.vertex as usize];
            wanted.entry((site, one.place.border)).or_default().push(one);
        };
        for p in &joints.pairs {
            for side in 0..2 {
                let (own, place) = (p.places[side], p.places[1 - side]);
                if is_vertex(&own) && !is_vertex(&place) {
                    want(Insertion { place, vertex: self.vertex(&own), distance: p.distance });
                }
            }
        }
        self.complete(clusters, &mut wanted);
        let mut found = Vec::new();
        for ((site, border), places) in wanted {
            found.extend(self.one_each(border, places, &clusters.all[site as usize].members));
        }
        found
    }

    /// Adds the nearest places of borders that are sewn to one at a site.
    fn complete(&self, clusters: &Clusters, wanted: &mut BTreeMap<(u32, u32), Vec<Insertion>>) {
        let edges = Edges::new(self.boundaries);
        let mut borders: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        for &(site, border) in wanted.keys() {
            borders.entry(site).or_default().insert(border);
        }
        for (site, cluster) in clusters.all.iter().enumerate() {
            let own: Vec<u32> =
                cluster.members.iter().filter_map(|&m| Some(self.owner[m as usize]?.0)).collect();
            if own.len() > 1 || borders.contains_key(&(site as u32)) {
                borders.entry(site as u32).or_default().extend(own);
            }
        }
        for (site, known) in borders {
            let cluster = &clusters.all[site as usize];
            let vertex = cluster.members[0];
            for (place, distance) in near_places(self.boundaries, &edges, cluster.target, self.tolerance) {
                if !is_vertex(&place) && known.iter().any(|&border| self.are_sewn(border, place.border)) {
                    let one = Insertion { place, vertex, distance };
                    wanted.entry((site, place.border)).or_default().push(one);
                }
            }
        }
    }

    /// The closest of the places of a border that are near each other; none where the site has a vertex of
    /// the border there.
    fn one_each(&self, border: u32, mut places: Vec<Insertion>, members: &[u32]) -> Vec<Insertion> {
        let has_vertex = |along: f64| {
            members
                .iter()
                .filter_map(|&m| self.owner[m as usize])
                .any(|of| of.0 == border && !self.is_apart(border, self.along(of), along))
        };
        places.retain(|one| !has_vertex(one.place.along));
        places
            .sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.place.along.total_cmp(&b.place.along)));
        let mut kept: Vec<Insertion> = Vec::new();
        for one in places {
            if kept.iter().all(|k| self.is_apart(border, k.place.along, one.place.along)) {
                kept.push(one);
            }
        }
        kept
    }
}
