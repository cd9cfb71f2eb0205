//! Facets that cut each other along a side of one of them.
//!
//! Where a side of a facet lies in another facet, or along a side of it, the two only touch. The surface cuts
//! the other one if it goes on across the side to where the other one's far side is:
//!
//! ```text
//!     p                         p      r
//!     │ the side, seen           ╲    ╱    p, q and r, s about the line that two sides have in common:
//!  ───●───── facet                ╲  ╱     they cut where r and s are on different sides of p, q
//!     │ along itself              ╱●╲
//!     q                          q   s
//! ```
//!
//! Sides with other than two facets are left to the audit of the shell.

use crate::halves::half_key;
use crate::triangle_pair::{Facet3, Meeting, is_between};
use chordal_nurbs::DVec3;
use rustc_hash::FxHashMap;

/// Two facets, of which a side of one lies in the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// Their indices in their faces.
    pub facets: [u32; 2],
    pub meeting: Meeting,
}

/// The corners opposite some sides of a mesh, in all facets that have the side.
pub(crate) struct Sides {
    opposite: FxHashMap<u64, Vec<DVec3>>,
}

/// The key of the side opposite a corner.
fn side_key(facet: &Facet3, opposite: usize) -> u64 {
    let corners = facet.corners();
    half_key(corners[(opposite + 1) % 3], corners[(opposite + 2) % 3]).0
}

/// Its ends.
fn side(facet: &Facet3, opposite: usize) -> [DVec3; 2] {
    let xyz = facet.xyz();
    [xyz[(opposite + 1) % 3], xyz[(opposite + 2) % 3]]
}

/// The sides that matter where two facets meet.
fn sides_of_meeting([s, t]: [Facet3; 2], meeting: Meeting) -> impl Iterator<Item = u64> {
    let keys = match meeting {
        Meeting::Apart | Meeting::Cut => [None, None],
        Meeting::SideInside { first, opposite } => {
            [Some(side_key(if first { &s } else { &t }, opposite)), None]
        }
        Meeting::Sides { opposite: [i, j] } => [Some(side_key(&s, i)), Some(side_key(&t, j))],
    };
    keys.into_iter().flatten()
}

impl Sides {
    /// Those of `contacts`, with the facets among `all` that have them.
    pub fn new<'f>(
        contacts: impl Iterator<Item = ([Facet3; 2], Meeting)>,
        all: impl Iterator<Item = &'f Facet3>,
    ) -> Self {
        let wanted = contacts.flat_map(|(facets, meeting)| sides_of_meeting(facets, meeting));
        let mut opposite: FxHashMap<u64, Vec<DVec3>> = wanted.map(|key| (key, Vec::new())).collect();
        for facet in all {
            for i in 0..3 {
                if let Some(found) = opposite.get_mut(&side_key(facet, i)) {
                    found.push(facet.xyz()[i]);
                }
            }
        }
        Self { opposite }
    }

    fn both(&self, key: u64) -> Option<[DVec3; 2]> {
        self.opposite.get(&key)?.as_slice().try_into().ok()
    }

    /// True where the surfaces cut each other along the sides at which two facets meet.
    pub fn is_cut(&self, [s, t]: &[Facet3; 2], meeting: Meeting) -> bool {
        match meeting {
            Meeting::Apart => false,
            Meeting::Cut => true,
            Meeting::SideInside { first, opposite } => {
                let (of, other) = if first { (s, t) } else { (t, s) };
                let both = self.both(side_key(of, opposite));
                both.is_some_and(|[p, q]| other.side_of(p) * other.side_of(q) < 0.0)
            }
            Meeting::Sides { opposite: [i, j] } => {
                let both = self.both(side_key(s, i)).zip(self.both(side_key(t, j)));
                let is_apart = |([p, q], [r, other]): ([DVec3; 2], [DVec3; 2])| {
                    let is_between = |point| is_between(side(s, i), p, q, point);
                    is_between(r).zip(is_between(other)).is_some_and(|(r, s)| r != s)
                };
                both.is_some_and(is_apart)
            }
        }
    }
}
