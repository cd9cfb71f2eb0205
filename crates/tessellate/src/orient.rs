//! Which way faces face, where a file contradicts itself.
//!
//! Where a loop runs against the sense of its face, one of the two is wrong. Triangles follow the loop at first. Afterwards
//! each such face is compared with its neighbours: along a common edge two faces of one shell run in opposite
//! directions. Faces without doubt stay as they are; from them the others are settled outwards, those first most of whose
//! boundary is settled, each by the majority of its settled chords.

use crate::chart::Key;
use crate::face::FaceResult;

/// A chord of an edge between two faces that run along it the same way, which is wrong, or opposite ways.
struct Meeting {
    faces: [u32; 2],
    same: bool,
}

/// Turns over the doubtful faces that contradict most of their neighbours.
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
        // How many chords to settled neighbours there are, how many of them contradict.
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

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec3;

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
}
