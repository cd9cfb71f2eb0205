//! Orientation of faces where a file contradicts itself.
//!
//! Where a loop runs against the sense of its face, one of the two is wrong. Triangles follow the loop at
//! first. Afterwards each such doubtful face is compared with its neighbours: along a common edge, two faces
//! of one shell run in opposite directions. Faces without doubt are never changed. The doubtful ones are
//! decided one by one, first the face that has the largest share of its boundary with decided faces, by the
//! majority of its chords.

use crate::face_result::FaceResult;
use chordal_brep::{BodyKind, Part, Shell};
use chordal_chart::{EdgeSamples, Key};
use chordal_nurbs::DVec3;

/// A chord between two faces: they run along it in the same direction, which is wrong, or in opposite ones.
struct Meeting {
    faces: [u32; 2],
    same: bool,
}

/// Reverses the doubtful faces that contradict most of their neighbours.
pub(crate) fn settle_orientation(faces: &mut [Option<Box<FaceResult>>]) {
    let mut open: Vec<u32> = Vec::new();
    let mut settled = vec![true; faces.len()];
    for (i, face) in faces.iter().enumerate() {
        if face.as_ref().is_some_and(|f| f.doubtful) {
            open.push(i as u32);
            settled[i] = false;
        }
    }
    if open.is_empty() {
        return;
    }
    let mut meetings = meetings(faces);
    let mut of_face: Vec<Vec<u32>> = vec![Vec::new(); faces.len()];
    for (k, meeting) in meetings.iter().enumerate() {
        meeting.faces.iter().for_each(|&f| of_face[f as usize].push(k as u32));
    }
    while !open.is_empty() {
        // The number of chords to decided neighbours, and how many of them contradict.
        let votes = |f: u32| {
            let known = of_face[f as usize].iter().map(|&k| &meetings[k as usize]).filter(|m| {
                let other = if m.faces[0] == f { m.faces[1] } else { m.faces[0] };
                settled[other as usize]
            });
            known.fold((0usize, 0usize), |(all, wrong), m| (all + 1, wrong + usize::from(m.same)))
        };
        let share = |f: u32| votes(f).0 as f64 / of_face[f as usize].len().max(1) as f64;
        let next = (0..open.len()).max_by(|&i, &j| share(open[i]).total_cmp(&share(open[j])).then(j.cmp(&i)));
        let f = open.remove(next.expect("some are open"));
        let (all, wrong) = votes(f);
        settled[f as usize] = true;
        if 2 * wrong > all {
            of_face[f as usize].iter().for_each(|&k| meetings[k as usize].same ^= true);
            if let Some(face) = &mut faces[f as usize] {
                face.turn_over();
            }
        }
    }
}

/// Every chord that exactly two faces share.
fn meetings(faces: &[Option<Box<FaceResult>>]) -> Vec<Meeting> {
    let mut sides: Vec<([Key; 2], u32, bool)> = Vec::new();
    for (f, face) in faces.iter().enumerate() {
        let Some(face) = face else { continue };
        for t in &face.triangles {
            for i in 0..3 {
                let (a, b) = (face.keys[t[i] as usize], face.keys[t[(i + 1) % 3] as usize]);
                if !matches!(a, Key::Private(_)) && !matches!(b, Key::Private(_)) {
                    sides.push(([a.min(b), a.max(b)], f as u32, a < b));
                }
            }
        }
    }
    sides.sort_unstable();
    let pairs =
        sides.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() == 2 && group[0].1 != group[1].1);
    pairs.map(|pair| Meeting { faces: [pair[0].1, pair[1].1], same: pair[0].2 == pair[1].2 }).collect()
}

/// Reverses the closed shells of solids whose volume has the wrong sign: the outer shell encloses a positive
/// volume, a void a negative one.
pub(crate) fn turn_inside_out(part: &Part, edges: &[EdgeSamples], faces: &mut [Option<Box<FaceResult>>]) {
    let mut uses = vec![0u32; faces.len()];
    part.shells.iter().flat_map(|s| &s.faces).for_each(|f| uses[f.index()] += 1);
    for body in part.bodies.iter().filter(|b| b.kind == BodyKind::Solid) {
        for (i, shell) in body.shells.iter().enumerate() {
            let shell = &part.shells[shell.index()];
            let sign = if i == 0 { 1.0 } else { -1.0 };
            let own = shell.faces.iter().all(|f| uses[f.index()] == 1);
            let wrong = |v: f64| sign * v < 0.0;
            if own && volume(part, edges, shell, faces).is_some_and(wrong) && is_closed(shell, faces) {
                for f in &shell.faces {
                    faces[f.index()].iter_mut().for_each(|face| face.turn_over());
                }
            }
        }
    }
}

/// Six times the volume that a shell encloses; `None` where a face is missing or the volume is only rounding.
fn volume(
    part: &Part,
    edges: &[EdgeSamples],
    shell: &Shell,
    faces: &[Option<Box<FaceResult>>],
) -> Option<f64> {
    let mut origin = None;
    let (mut sum, mut sum_of_sizes) = (0.0, 0.0);
    for f in &shell.faces {
        let face = faces[f.index()].as_ref()?;
        let position = |v: u32| match face.keys[v as usize] {
            Key::Vertex(v) => part.vertices[v as usize].point,
            Key::Edge(e, i) => edges[e as usize].points[i as usize],
            Key::Private(k) => face.private[k as usize],
        };
        for t in &face.triangles {
            let [a, b, c]: [DVec3; 3] = t.map(position);
            let origin = *origin.get_or_insert(a);
            let six = (a - origin).dot((b - origin).cross(c - origin));
            sum += six;
            sum_of_sizes += six.abs();
        }
    }
    (sum.abs() > 1e-9 * sum_of_sizes).then_some(sum)
}

/// True where every chord is used equally often in both directions.
fn is_closed(shell: &Shell, faces: &[Option<Box<FaceResult>>]) -> bool {
    let mut sides: Vec<([(Key, usize); 2], i32)> = Vec::new();
    for f in &shell.faces {
        let Some(face) = &faces[f.index()] else { return false };
        let owned = |key: Key| (key, if matches!(key, Key::Private(_)) { f.index() } else { usize::MAX });
        for t in &face.triangles {
            for i in 0..3 {
                let (a, b) = (owned(face.keys[t[i] as usize]), owned(face.keys[t[(i + 1) % 3] as usize]));
                sides.push(([a.min(b), a.max(b)], if a < b { 1 } else { -1 }));
            }
        }
    }
    sides.sort_unstable();
    sides.chunk_by(|a, b| a.0 == b.0).all(|group| group.iter().map(|s| s.1).sum::<i32>() == 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_brep::{Body, FaceId, ShellId, Source, Vertex};

    /// The four faces of a tetrahedron, each one triangle.
    fn tetrahedron(turned: [bool; 4], doubtful: [bool; 4]) -> Vec<Option<Box<FaceResult>>> {
        let corners = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let face = |f: usize| {
            let [a, b, c] = corners[f];
            let mut result = FaceResult {
                keys: [a, b, c].map(Key::Vertex).to_vec(),
                triangles: vec![[0, 1, 2]],
                normals: vec![DVec3::Z; 3],
                doubtful: doubtful[f],
                ..FaceResult::default()
            };
            if turned[f] {
                result.turn_over();
            }
            Some(Box::new(result))
        };
        (0..4).map(face).collect()
    }

    fn contradictions(faces: &[Option<Box<FaceResult>>]) -> usize {
        meetings(faces).iter().filter(|m| m.same).count()
    }

    #[test]
    fn doubtful_faces_follow_their_neighbours() {
        for bits in 0..16u32 {
            let doubtful: [bool; 4] = std::array::from_fn(|f| f != 1 && bits >> f & 1 == 1);
            let mut faces = tetrahedron(doubtful, doubtful);
            settle_orientation(&mut faces);
            assert_eq!(contradictions(&faces), 0, "{doubtful:?}");
        }
    }

    #[test]
    fn faces_without_doubt_stay() {
        let mut faces = tetrahedron([true, false, false, false], [false; 4]);
        settle_orientation(&mut faces);
        assert_eq!(contradictions(&faces), 3);
        assert_eq!(faces[0].as_ref().map(|f| f.triangles[0]), Some([0, 2, 1]));
    }

    #[test]
    fn shells_of_solids_enclose_what_their_place_says() {
        let vertex = |p: [f64; 3]| Vertex { point: p.into(), source: Source::default() };
        let shell =
            Shell { faces: (0..4usize).map(FaceId::from).collect(), closed: true, source: Source::default() };
        let body = |shells: Vec<usize>| Body {
            kind: BodyKind::Solid,
            shells: shells.into_iter().map(ShellId::from).collect(),
            name: String::new(),
            color: None,
            layer: None,
            source: Source::default(),
        };
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let empty = Shell { faces: Vec::new(), ..shell.clone() };
        let mut part =
            Part { vertices: corners.map(vertex).to_vec(), shells: vec![shell, empty], ..Part::default() };
        for (shells, sign) in [(vec![0], 1.0), (vec![1, 0], -1.0)] {
            part.bodies = vec![body(shells)];
            for turned in [false, true] {
                let mut faces = tetrahedron([turned; 4], [false; 4]);
                turn_inside_out(&part, &[], &mut faces);
                assert_eq!(volume(&part, &[], &part.shells[0], &faces), Some(sign));
            }
            // An open shell encloses nothing.
            let mut faces = tetrahedron([true, true, true, false], [false; 4]);
            let before = faces.iter().flatten().map(|f| f.triangles.clone()).collect::<Vec<_>>();
            turn_inside_out(&part, &[], &mut faces);
            let after = faces.iter().flatten().map(|f| f.triangles.clone()).collect::<Vec<_>>();
            assert_eq!(before, after);
        }
    }
}
