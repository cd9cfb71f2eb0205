//! The orientation of faces: along a common edge, the loops of two faces of one shell run in opposite
//! directions.

use crate::rebuild::Link;

/// The result of orienting.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Oriented {
    /// For each face, whether it must be turned over.
    pub turn: Vec<bool>,
    /// For each face, the component of linked faces that it belongs to.
    pub component: Vec<u32>,
    pub components: usize,
    /// Links whose faces still contradict each other (a Möbius band, loops that run the wrong way).
    pub contradictions: usize,
}

/// Walks outwards from the lowest face of every component. Of the two possible orientations the one that
/// turns fewer faces is taken.
pub(crate) fn orient(faces: usize, flipped: &[bool], links: &[Link]) -> Oriented {
    let mut of_face: Vec<Vec<u32>> = vec![Vec::new(); faces];
    for (k, link) in links.iter().enumerate() {
        link.faces.iter().for_each(|&f| of_face[f as usize].push(k as u32));
    }
    let mut found =
        Oriented { turn: vec![false; faces], component: vec![u32::MAX; faces], ..Oriented::default() };
    let wrong = |turn: &[bool], link: &Link| {
        let side = |f: u32| flipped[f as usize] ^ turn[f as usize];
        link.faces[0] != link.faces[1] && link.same ^ side(link.faces[0]) ^ side(link.faces[1])
    };
    for start in 0..faces {
        if found.component[start] != u32::MAX {
            continue;
        }
        let mut members = vec![start as u32];
        found.component[start] = found.components as u32;
        let mut at = 0;
        while at < members.len() {
            let f = members[at];
            at += 1;
            for &k in &of_face[f as usize] {
                let link = &links[k as usize];
                let next = if link.faces[0] == f { link.faces[1] } else { link.faces[0] };
                if found.component[next as usize] == u32::MAX {
                    found.component[next as usize] = found.components as u32;
                    found.turn[next as usize] = wrong(&found.turn, link);
                    members.push(next);
                }
            }
        }
        settle(&members, &of_face, links, &mut found.turn, &wrong);
        let turned = members.iter().filter(|&&f| found.turn[f as usize]).count();
        if 2 * turned > members.len() {
            members.iter().for_each(|&f| found.turn[f as usize] ^= true);
        }
        found.components += 1;
    }
    found.contradictions = links.iter().filter(|l| wrong(&found.turn, l)).count();
    found
}

/// Rounds in which faces are turned that contradict most of their neighbours.
const ROUNDS: usize = 16;

fn settle(
    members: &[u32],
    of_face: &[Vec<u32>],
    links: &[Link],
    turn: &mut [bool],
    wrong: &impl Fn(&[bool], &Link) -> bool,
) {
    for _ in 0..ROUNDS {
        let mut changed = false;
        for &f in members {
            let own = &of_face[f as usize];
            let bad = own.iter().filter(|&&k| wrong(turn, &links[k as usize])).count();
            if 2 * bad > own.len() {
                turn[f as usize] ^= true;
                changed = true;
            }
        }
        if !changed {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A closed ring of faces, each turned at will, agrees afterwards.
        #[test]
        fn rings_agree(flipped in prop::collection::vec(any::<bool>(), 3..40)) {
            let n = flipped.len() as u32;
            let links: Vec<Link> = (0..n).map(|f| Link { faces: [f, (f + 1) % n], same: false }).collect();
            let found = orient(flipped.len(), &flipped, &links);
            prop_assert_eq!((found.components, found.contradictions), (1, 0));
            let first = flipped[0] ^ found.turn[0];
            prop_assert!((0..flipped.len()).all(|f| flipped[f] ^ found.turn[f] == first));
            prop_assert!(2 * found.turn.iter().filter(|&&t| t).count() <= flipped.len());
        }
    }

    #[test]
    fn a_moebius_band_contradicts_itself_once() {
        let link = |a, b, same| Link { faces: [a, b], same };
        let found = orient(4, &[false; 4], &[link(0, 1, false), link(1, 2, false), link(2, 0, true)]);
        assert_eq!((found.components, found.contradictions), (2, 1));
    }
}
