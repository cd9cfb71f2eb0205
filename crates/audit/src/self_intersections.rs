//! Closed shells whose facets cut each other.
//!
//! A solid whose mesh cuts itself has no inside that a mesher of volumes, a slicer or a Boolean could use,
//! although it is closed and every facet is within its tolerance: thin walls, fillets that are nearly
//! tangent, loose edges.
//!
//! 1. A tree over the boxes of the faces gives pairs of faces that may meet.
//! 2. Pairs of which one is clearly beside the plane of the other are omitted ([`crate::separation`]).
//! 3. Trees over the boxes of their facets, built when first needed, give pairs of facets.
//! 4. Exact predicates decide ([`crate::triangle_pair`]), and where a side of a facet lies in another facet,
//!    what is on both sides of it ([`crate::along_sides`]).
//!
//! Two facets of one face are compared only where the surface can come back to itself, and where no view
//! shows that they lie one beside the other ([`crate::graph`]). The facets of a plane, cylinder, cone, sphere
//! or plain torus lie so because their parameters do not overlap, which is checked in the chart.
//!
//! For each pair of faces, it is then decided whether the faces themselves cut or touch each other in the file
//! ([`crate::exact_crossing`]), or only their facets do.

use crate::along_sides::{Contact, Sides};
use crate::exact_crossing::{Cut, InFile, in_file};
use crate::graph::is_graph;
use crate::report::{FaceCrossing, FacetCrossing};
use crate::separation::PlaneFace;
use crate::triangle_pair::{Facet3, Meeting, cut_points, meeting};
use chordal_brep::{FaceGeometry, FaceId, Part};
use chordal_mesh::PartMesh;
use chordal_nurbs::{Box3, BoxTree, Surface};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Pairs of facets of which all boxes are compared: to put fewer in order takes longer.
const MOST_DIRECT: usize = 4096;

/// Facets of each of two faces that are compared in order: of more, trees find pairs more quickly.
const MOST_IN_ORDER: usize = 1024;

/// Cuts of two faces at which it is decided whether the faces themselves cut each other. Each takes some
/// inversions for every edge of both.
const MOST_PLACES: usize = 16;

/// Comparisons of facets in one shell: about a second, and far more than any sound solid needs. Where facets
/// lie on each other by the thousand, as in a face that runs over itself, more would take minutes. Each pair
/// of faces has an equal share, and at least [`LEAST_TESTS`] and [`TESTS_PER_FACET`], so that no order
/// decides what is found.
const MOST_TESTS: usize = 4_000_000;
const LEAST_TESTS: usize = 2_000;

/// Comparisons of each facet of a pair of faces that are always made, so that the time grows with the mesh
/// and not with its square. Facets of sound faces have a few dozen others near them.
const TESTS_PER_FACET: usize = 256;

/// The facets of one face of a shell.
struct FacetsOfFace {
    face: u32,
    facets: Vec<Facet3>,
    bounds: Box3,
    tree: OnceLock<BoxTree>,
}

/// Two faces with the pairs of their facets that cut each other; the first of each pair is of the first face.
struct Crossing<'f> {
    faces: [&'f FacetsOfFace; 2],
    facets: Vec<[u32; 2]>,
    /// All facets that may cut each other were compared.
    is_complete: bool,
}

/// The pairs of faces of a shell whose facets cut each other, in the order of the faces.
pub(crate) fn self_intersections(part: &Part, mesh: &PartMesh, faces: &[FaceId]) -> Vec<FaceCrossing> {
    let all = facets_of_faces(mesh, faces);
    let describe = |crossing: &Crossing<'_>| {
        let in_file = crossing.in_file(part, mesh);
        FaceCrossing {
            faces: crossing.faces.map(|f| f.face),
            facet_pairs: crossing.facets.len(),
            in_file: in_file != InFile::Apart,
            faces_meet: in_file >= InFile::Touching,
            is_complete: crossing.is_complete,
        }
    };
    crossings(part, mesh, &all).par_iter().map(describe).collect()
}

/// Every two facets of the named closed shells that cut each other, in the order of faces and facets, but for
/// those whose faces cut or touch each other in the file: the places at which to refine a mesh.
pub fn facet_crossings(part: &Part, mesh: &PartMesh, shells: &[u32]) -> Vec<FacetCrossing> {
    let mut found = Vec::new();
    for &shell in shells {
        let all = facets_of_faces(mesh, &part.shells[shell as usize].faces);
        let crossings = crossings(part, mesh, &all);
        let to_part = crossings.par_iter().filter(|crossing| crossing.in_file(part, mesh) < InFile::Touching);
        found.extend(to_part.flat_map_iter(Crossing::facet_crossings).collect::<Vec<_>>());
    }
    found
}

fn facets_of_faces(mesh: &PartMesh, faces: &[FaceId]) -> Vec<FacetsOfFace> {
    faces.par_iter().map(|face| FacetsOfFace::new(mesh, face.index())).collect()
}

/// The pairs of faces whose facets cut each other, in the order of the faces.
fn crossings<'f>(part: &Part, mesh: &PartMesh, all: &'f [FacetsOfFace]) -> Vec<Crossing<'f>> {
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    BoxTree::new(all.iter().map(|f| f.bounds)).own_pairs(&mut |i, j| pairs.push((i, j)));
    leave_out_separate(part, mesh, all, &mut pairs);
    pairs.extend(
        (0..all.len()).filter(|&i| may_meet_itself(part, mesh, all[i].face)).map(|i| (i as u32, i as u32)),
    );
    let most = (MOST_TESTS / pairs.len().max(1)).max(LEAST_TESTS);
    let cuts = |&(i, j): &(u32, u32)| {
        let (a, b) = (&all[i as usize], &all[j as usize]);
        let (a, b) = if a.face <= b.face { (a, b) } else { (b, a) };
        let facets = a.facets.len() + if i == j { 0 } else { b.facets.len() };
        let mut cuts =
            Cuts { facets: Vec::new(), contacts: Vec::new(), left: most.max(TESTS_PER_FACET * facets) };
        if i == j {
            a.cuts_of_its_own(&mut cuts)
        } else {
            a.cuts_with(b, &mut cuts)
        }
        let is_found = !cuts.facets.is_empty() || !cuts.contacts.is_empty() || cuts.left == 0;
        is_found.then_some(([a, b], cuts))
    };
    let mut found: Vec<([&'f FacetsOfFace; 2], Cuts)> = pairs.par_iter().filter_map(cuts).collect();
    found.sort_unstable_by_key(|(faces, _)| faces.map(|f| f.face));
    add_cuts_along_sides(all, &mut found);
    let crossing = |(faces, cuts): ([&'f FacetsOfFace; 2], Cuts)| {
        let Cuts { mut facets, left, .. } = cuts;
        facets.sort_unstable();
        let is_complete = left > 0;
        (!facets.is_empty() || !is_complete).then_some(Crossing { faces, facets, is_complete })
    };
    found.into_iter().filter_map(crossing).collect()
}

/// Where sides of facets lie in others, the facets on both sides of them tell whether they cut.
fn add_cuts_along_sides(all: &[FacetsOfFace], found: &mut [([&FacetsOfFace; 2], Cuts)]) {
    if found.iter().all(|(_, cuts)| cuts.contacts.is_empty()) {
        return;
    }
    let facets = |([a, b], contact): ([&FacetsOfFace; 2], &Contact)| {
        [a.facets[contact.facets[0] as usize], b.facets[contact.facets[1] as usize]]
    };
    let contacts = found.iter().flat_map(|(faces, cuts)| cuts.contacts.iter().map(|c| (*faces, c)));
    let wanted = contacts.map(|(faces, contact)| (facets((faces, contact)), contact.meeting));
    let sides = Sides::new(wanted, all.iter().flat_map(|f| &f.facets));
    for (faces, cuts) in found {
        let is_cut = |contact: &&Contact| sides.is_cut(&facets((*faces, contact)), contact.meeting);
        cuts.facets.extend(cuts.contacts.iter().filter(is_cut).map(|contact| contact.facets));
    }
}

/// Leaves out the pairs of which one face is clearly beside the plane of the other.
fn leave_out_separate(part: &Part, mesh: &PartMesh, all: &[FacetsOfFace], pairs: &mut Vec<(u32, u32)>) {
    let planes: Vec<Option<PlaneFace>> =
        all.iter().map(|f| PlaneFace::new(part, mesh, f.face as usize)).collect();
    let is_beside = |plane: u32, other: u32| {
        let other = &all[other as usize];
        let is_beside =
            |p: &PlaneFace| p.is_beside(&mesh.faces[other.face as usize], &other.bounds, &mesh.positions);
        planes[plane as usize].as_ref().is_some_and(is_beside)
    };
    pairs.retain(|&(i, j)| !is_beside(i, j) && !is_beside(j, i));
}

/// False for surfaces on which points with different parameters are different points, and where a view shows
/// that no facet is over another one.
fn may_meet_itself(part: &Part, mesh: &PartMesh, face: u32) -> bool {
    match &part.faces[face as usize].geometry {
        FaceGeometry::Failed(_) => false,
        FaceGeometry::Surface(surface) => match surface.as_ref() {
            Surface::Plane { .. }
            | Surface::Cylinder { .. }
            | Surface::Cone { .. }
            | Surface::Sphere { .. } => false,
            Surface::Torus { major, minor, .. } => major.abs() < minor.abs(),
            _ => !is_graph(mesh, &mesh.faces[face as usize]),
        },
    }
}

impl Crossing<'_> {
    /// The two facets of each pair.
    fn pairs(&self) -> impl Iterator<Item = [&Facet3; 2]> + '_ {
        let [a, b] = self.faces;
        self.facets.iter().map(|&[s, t]| [&a.facets[s as usize], &b.facets[t as usize]])
    }

    fn facet_crossings(&self) -> impl Iterator<Item = FacetCrossing> + '_ {
        let faces = self.faces.map(|f| f.face);
        self.pairs().map(move |[s, t]| FacetCrossing { faces, bounds: cut_points(s, t) })
    }

    /// Whether the two exact faces cross or touch at each of some places, distributed over all cuts of their
    /// facets: faces that touch at one place do not excuse facets that cross at another one.
    fn in_file(&self, part: &Part, mesh: &PartMesh) -> InFile {
        let faces = self.faces.map(|f| f.face as usize);
        let cuts = self.pairs().zip(&self.facets).step_by(self.facets.len().div_ceil(MOST_PLACES).max(1));
        cuts.map(|([s, t], &facets)| in_file(part, mesh, faces, facets, Cut::of(s, t)))
            .min()
            .unwrap_or(InFile::Apart)
    }
}

/// The pairs of facets that cut each other, found within the limit of comparisons.
struct Cuts {
    facets: Vec<[u32; 2]>,
    /// Pairs of which a side of one lies in the other.
    contacts: Vec<Contact>,
    left: usize,
}

impl Cuts {
    fn compare(&mut self, pair: [u32; 2], s: &Facet3, t: &Facet3) {
        if self.left > 0 {
            self.left -= 1;
            match meeting(s, t) {
                Meeting::Apart => {}
                Meeting::Cut => self.facets.push(pair),
                meeting => self.contacts.push(Contact { facets: pair, meeting }),
            }
        }
    }
}

impl FacetsOfFace {
    fn new(mesh: &PartMesh, face: usize) -> Self {
        let of_face = &mesh.faces[face];
        let facet = |t: &[u32; 3]| {
            let corners = t.map(|c| of_face.corners[c as usize].position);
            Facet3::new(corners, corners.map(|p| mesh.positions[p as usize]))
        };
        let facets: Vec<Facet3> = of_face.triangles.iter().map(facet).collect();
        let bounds = facets.iter().fold(Box3::EMPTY, |all, f| all.union(f.bounds()));
        Self { face: face as u32, facets, bounds, tree: OnceLock::new() }
    }

    fn tree(&self) -> &BoxTree {
        self.tree.get_or_init(|| BoxTree::new(self.facets.iter().map(Facet3::bounds)))
    }

    /// The facets that meet a box, each with its own box.
    fn within(&self, region: &Box3) -> Vec<(Box3, u32)> {
        let all = self.facets.iter().map(Facet3::bounds).zip(0..);
        all.filter(|(bounds, _)| bounds.meets(region)).collect()
    }

    fn cuts_with(&self, other: &Self, cuts: &mut Cuts) {
        pairs_between(self, other, &mut |i, j| {
            cuts.compare([i, j], &self.facets[i as usize], &other.facets[j as usize]);
        });
    }

    fn cuts_of_its_own(&self, cuts: &mut Cuts) {
        self.tree().own_pairs(&mut |i, j| {
            cuts.compare([i, j], &self.facets[i as usize], &self.facets[j as usize]);
        });
    }
}

/// Calls `visit` for every facet of one face and facet of another whose boxes meet. Of neighbours only the
/// facets in what their boxes have in common are looked at: in order along its longest side, or in trees
/// where they are many.
fn pairs_between(a: &FacetsOfFace, b: &FacetsOfFace, visit: &mut impl FnMut(u32, u32)) {
    let common = Box3 { min: a.bounds.min.max(b.bounds.min), max: a.bounds.max.min(b.bounds.max) };
    let (mut of_a, mut of_b) = (a.within(&common), b.within(&common));
    if of_a.len().min(of_b.len()) > MOST_IN_ORDER {
        let tree = |all: &[(Box3, u32)]| BoxTree::new(all.iter().map(|item| item.0));
        tree(&of_a).pairs_with(&tree(&of_b), &mut |i, j| visit(of_a[i as usize].1, of_b[j as usize].1));
        return;
    }
    if of_a.len() * of_b.len() <= MOST_DIRECT {
        for (one, i) in &of_a {
            of_b.iter().filter(|item| item.0.meets(one)).for_each(|item| visit(*i, item.1));
        }
        return;
    }
    let axis = (common.max - common.min).max_position();
    for list in [&mut of_a, &mut of_b] {
        list.sort_unstable_by(|s, t| s.0.min[axis].total_cmp(&t.0.min[axis]));
    }
    let (mut i, mut j) = (0, 0);
    while i < of_a.len() && j < of_b.len() {
        let ((one, s), (other, t)) = (of_a[i], of_b[j]);
        if one.min[axis] <= other.min[axis] {
            follow(&one, &of_b[j..], axis, &mut |t| visit(s, t));
            i += 1;
        } else {
            follow(&other, &of_a[i..], axis, &mut |s| visit(s, t));
            j += 1;
        }
    }
}

/// Calls `visit` for the items whose boxes meet `one`; they are in order along an axis.
fn follow(one: &Box3, items: &[(Box3, u32)], axis: usize, visit: &mut impl FnMut(u32)) {
    let reached = items.iter().take_while(|item| item.0.min[axis] <= one.max[axis]);
    reached.filter(|item| item.0.meets(one)).for_each(|item| visit(item.1));
}
