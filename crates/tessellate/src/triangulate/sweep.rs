//! Triangulation of polygons with holes by one sweep, without any new vertex.
//!
//! Source: the decomposition of a polygon into *monotone mountains* along the diagonals of its trapezoids
//! (Fournier and Montuno 1984; Seidel 1991, section 4), here done while a Shamos–Hoey sweep runs from left to
//! right.
//!
//! ```text
//!   e_top  ----------o            Between two neighbouring active edges lies a trapezoid. It began at a
//!        l .   trapezoid  . p     vertex l and ends at the next vertex p that touches it; l–p is a diagonal
//!   e_bottom ---------------o     (or an edge). The diagonals cut the polygon into one mountain per edge: a
//!                                 chain of vertices over that edge, which a stack turns into triangles as
//!                                 the vertices arrive.
//! ```
//!
//! Each polygon edge has the interior on exactly one side, so each edge owns exactly one mountain, and every
//! triangle of it lies within the x-range of that edge. **That is why singly curved faces need no interior
//! vertex:** with x the curved direction, no triangle turns further than a boundary chord does.
//!
//! Ties in x are broken by y, then by index: an infinitesimal shear, so vertical edges need no case of their
//! own. Not guaranteed: loops that cross are noticed where they spoil a mountain, not everywhere.

use chordal_nurbs::DVec2;
use chordal_nurbs::orient;

/// Why a polygon could not be triangulated; the vertices near the place where two chains cross.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SweepError {
    /// The edge from this vertex to the next in its loop is one of the culprits.
    pub edge: u32,
    /// A vertex that lies on the wrong side of it.
    pub vertex: u32,
}

struct Sweep<'a> {
    points: &'a [DVec2],
    next: Vec<u32>,
    previous: Vec<u32>,
    /// Active edges from bottom to top; an edge is named by its first vertex.
    active: Vec<u32>,
    /// The mountain of each edge: vertices not yet cut off.
    chains: Vec<Vec<u32>>,
    triangles: Vec<[u32; 3]>,
}

/// Triangulates the region to the left of all `loops`, each a run of consecutive `points` (start, end); the
/// outer ones run counter-clockwise, holes clockwise. Triangles come out counter-clockwise; where vertices
/// touch an edge or each other some may have no area.
pub fn sweep(points: &[DVec2], loops: &[(u32, u32)]) -> Result<Vec<[u32; 3]>, SweepError> {
    swept(points, loops).or_else(|error| {
        // The order of vertices distinguishes -0 and 0, the predicates do not: where a loop touches itself on
        // such a line, that leads the sweep astray.
        let zeros_joined: Vec<DVec2> = points.iter().map(|p| *p + DVec2::ZERO).collect();
        swept(&zeros_joined, loops).map_err(|_| error)
    })
}

fn swept(points: &[DVec2], loops: &[(u32, u32)]) -> Result<Vec<[u32; 3]>, SweepError> {
    let mut next = vec![0; points.len()];
    let mut previous = vec![0; points.len()];
    for &(start, end) in loops {
        for i in start..end {
            let after = if i + 1 == end { start } else { i + 1 };
            next[i as usize] = after;
            previous[after as usize] = i;
        }
    }
    let mut events: Vec<u32> = loops.iter().flat_map(|&(start, end)| start..end).collect();
    events.sort_unstable_by(|&a, &b| compare(points, a, b));
    let mut sweep = Sweep {
        points,
        next,
        previous,
        active: Vec::with_capacity(16),
        chains: vec![Vec::new(); points.len()],
        triangles: Vec::with_capacity(points.len() + 2 * loops.len()),
    };
    for vertex in events {
        sweep.visit(vertex)?;
    }
    Ok(sweep.triangles)
}

fn compare(points: &[DVec2], a: u32, b: u32) -> std::cmp::Ordering {
    let (p, q) = (points[a as usize], points[b as usize]);
    p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(a.cmp(&b))
}

impl Sweep<'_> {
    fn point(&self, vertex: u32) -> DVec2 {
        self.points[vertex as usize]
    }

    fn is_before(&self, a: u32, b: u32) -> bool {
        compare(self.points, a, b).is_lt()
    }

    /// The ends of an edge from left to right.
    fn ends(&self, edge: u32) -> (u32, u32) {
        let other = self.next[edge as usize];
        if self.is_before(edge, other) { (edge, other) } else { (other, edge) }
    }

    /// Loops run with the interior on their left, so an edge that runs to the right has it above.
    fn interior_above(&self, edge: u32) -> bool {
        self.is_before(edge, self.next[edge as usize])
    }

    fn visit(&mut self, vertex: u32) -> Result<(), SweepError> {
        let (incoming, outgoing) = (self.previous[vertex as usize], vertex);
        let incoming_is_left = self.is_before(self.previous[vertex as usize], vertex);
        let outgoing_is_left = self.is_before(self.next[vertex as usize], vertex);
        match (incoming_is_left, outgoing_is_left) {
            (false, false) => self.start(vertex, incoming, outgoing),
            (true, true) => self.end(vertex, incoming, outgoing),
            (true, false) => self.pass(vertex, incoming, outgoing),
            (false, true) => self.pass(vertex, outgoing, incoming),
        }
    }

    /// Both edges begin here.
    fn start(&mut self, vertex: u32, incoming: u32, outgoing: u32) -> Result<(), SweepError> {
        let (a, b) = (self.previous[vertex as usize], self.next[vertex as usize]);
        let turn = orient(self.point(vertex), self.point(a), self.point(b));
        let (lower, upper) = if turn > 0.0 || (turn == 0.0 && self.interior_above(outgoing) && a > b) {
            (incoming, outgoing)
        } else {
            (outgoing, incoming)
        };
        let towards = if lower == incoming { a } else { b };
        let at = self.active.partition_point(|&e| self.is_above(e, vertex, towards));
        if at > 0 && self.interior_above(self.active[at - 1]) {
            let below = self.active[at - 1];
            let above = *self.active.get(at).ok_or(SweepError { edge: below, vertex })?;
            self.append(below, vertex);
            self.append(above, vertex);
        }
        self.active.splice(at..at, [lower, upper]);
        self.chains[lower as usize].push(vertex);
        self.chains[upper as usize].push(vertex);
        Ok(())
    }

    /// Both edges end here.
    fn end(&mut self, vertex: u32, incoming: u32, outgoing: u32) -> Result<(), SweepError> {
        let at = self.locate(vertex, incoming)?;
        let lower_at = match (self.active.get(at + 1), at.checked_sub(1).map(|i| self.active[i])) {
            (Some(&e), _) if e == outgoing => at,
            (_, Some(e)) if e == outgoing => at - 1,
            _ => return Err(SweepError { edge: incoming, vertex }),
        };
        let (lower, upper) = (self.active[lower_at], self.active[lower_at + 1]);
        if self.interior_above(lower) {
            self.close(lower, vertex)?;
            self.close(upper, vertex)?;
        } else {
            // The exterior ends: the trapezoids below and above become one.
            let outside = SweepError { edge: lower, vertex };
            let below = lower_at.checked_sub(1).map(|i| self.active[i]).ok_or(outside)?;
            let above = *self.active.get(lower_at + 2).ok_or(outside)?;
            self.append(below, vertex);
            self.close(lower, vertex)?;
            self.close(upper, vertex)?;
            self.append(above, vertex);
        }
        self.active.drain(lower_at..lower_at + 2);
        Ok(())
    }

    /// `left` ends here and `right` takes its place.
    fn pass(&mut self, vertex: u32, left: u32, right: u32) -> Result<(), SweepError> {
        let at = self.locate(vertex, left)?;
        let outside = SweepError { edge: left, vertex };
        let facing = if self.interior_above(left) {
            self.active.get(at + 1)
        } else {
            self.active.get(at.wrapping_sub(1))
        };
        let facing = *facing.ok_or(outside)?;
        self.append(facing, vertex);
        self.close(left, vertex)?;
        self.active[at] = right;
        self.chains[right as usize].push(vertex);
        Ok(())
    }

    /// True where `vertex` lies above `edge`; on it, where `towards` does.
    fn is_above(&self, edge: u32, vertex: u32, towards: u32) -> bool {
        let (left, right) = self.ends(edge);
        let side = orient(self.point(left), self.point(right), self.point(vertex));
        if side != 0.0 {
            return side > 0.0;
        }
        orient(self.point(left), self.point(right), self.point(towards)) > 0.0
    }

    /// The index of the active edge that ends at `vertex`.
    fn locate(&self, vertex: u32, edge: u32) -> Result<usize, SweepError> {
        let p = self.point(vertex);
        let guess = self.active.partition_point(|&e| {
            let (left, right) = self.ends(e);
            orient(self.point(left), self.point(right), p) > 0.0
        });
        // Other edges may pass through the same point, so the guess is only where to begin.
        let near = (guess..(guess + 3).min(self.active.len())).find(|&i| self.active[i] == edge);
        near.or_else(|| self.active.iter().position(|&e| e == edge)).ok_or(SweepError { edge, vertex })
    }

    /// The trapezoid beside `edge` ends at `vertex`: the vertex joins the mountain and cuts off the vertices
    /// that it sees.
    fn append(&mut self, edge: u32, vertex: u32) {
        let above = self.interior_above(edge);
        let p = self.point(vertex);
        let chain = &mut self.chains[edge as usize];
        while let [.., a, b] = chain[..] {
            let turn = orient(self.points[a as usize], self.points[b as usize], p);
            if above && turn < 0.0 {
                self.triangles.push([a, vertex, b]);
            } else if !above && turn > 0.0 {
                self.triangles.push([a, b, vertex]);
            } else {
                break;
            }
            chain.pop();
        }
        chain.push(vertex);
    }

    /// `edge` ends at `vertex`, and with it its mountain.
    fn close(&mut self, edge: u32, vertex: u32) -> Result<(), SweepError> {
        self.append(edge, vertex);
        let above = self.interior_above(edge);
        let mut chain = std::mem::take(&mut self.chains[edge as usize]);
        // The remaining vertices lie on the edge itself. They are cut off from the end as triangles without
        // area.
        while chain.len() > 2 {
            let (a, b, c) = (chain[chain.len() - 3], chain[chain.len() - 2], chain[chain.len() - 1]);
            if orient(self.point(a), self.point(b), self.point(c)) != 0.0 {
                return Err(SweepError { edge, vertex: b });
            }
            self.triangles.push(if above { [a, c, b] } else { [a, b, c] });
            chain.remove(chain.len() - 2);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;
    use proptest::prelude::*;

    fn area(points: &[DVec2], t: &[u32; 3]) -> f64 {
        let [a, b, c] = t.map(|i| points[i as usize]);
        0.5 * (b - a).perp_dot(c - a)
    }

    fn check(points: &[DVec2], loops: &[(u32, u32)], expected: f64) -> Vec<[u32; 3]> {
        let triangles = sweep(points, loops).expect("simple polygon");
        let holes = loops.len() - 1;
        assert_eq!(triangles.len(), points.len() + 2 * holes - 2);
        assert!(triangles.iter().all(|t| area(points, t) >= 0.0));
        let total: f64 = triangles.iter().map(|t| area(points, t)).sum();
        assert!((total - expected).abs() < 1e-9 * expected.abs().max(1.0), "{total} for {expected}");
        triangles
    }

    fn shoelace(p: &[DVec2]) -> f64 {
        (0..p.len()).map(|i| p[i].perp_dot(p[(i + 1) % p.len()])).sum::<f64>() * 0.5
    }

    #[test]
    fn square_with_square_hole() {
        let p =
            [(0., 0.), (4., 0.), (4., 4.), (0., 4.), (1., 1.), (1., 3.), (3., 3.), (3., 1.)].map(DVec2::from);
        check(&p, &[(0, 4), (4, 8)], 12.0);
    }

    #[test]
    fn comb_with_collinear_points() {
        let p = [
            (0., 0.),
            (1., 0.),
            (2., 0.),
            (3., 0.),
            (3., 2.),
            (2., 2.),
            (2., 1.),
            (1., 1.),
            (1., 2.),
            (0., 2.),
        ]
        .map(DVec2::from);
        check(&p, &[(0, 10)], 5.0);
    }

    #[test]
    fn no_triangle_is_wider_than_a_boundary_edge() {
        let n = 200;
        let p: Vec<DVec2> = (0..n)
            .map(|i| {
                let t = std::f64::consts::TAU * f64::from(i) / f64::from(n);
                math::direction(t) * (2.0 + math::sin(5.0 * t))
            })
            .collect();
        let triangles = check(&p, &[(0, n as u32)], shoelace(&p));
        let widest_edge = (0..p.len()).map(|i| (p[i].x - p[(i + 1) % p.len()].x).abs()).fold(0.0, f64::max);
        for t in triangles {
            let x = t.map(|i| p[i as usize].x);
            let range = x.iter().fold(f64::MIN, |a, &b| a.max(b)) - x.iter().fold(f64::MAX, |a, &b| a.min(b));
            assert!(range <= widest_edge * (1.0 + 1e-12));
        }
    }

    #[test]
    fn crossing_loops_are_an_error() {
        let p = [(0., 0.), (2., 2.), (2., 0.), (0., 2.)].map(DVec2::from);
        assert!(sweep(&p, &[(0, 4)]).is_err());
    }

    #[test]
    fn zeros_of_both_signs_are_one_coordinate() {
        let corners = [
            (-0.0, 3.0),
            (0.0, 1.0),
            (1.0, 1.0),
            (1.0, -1.0),
            (-0.0, -1.0),
            (0.0, -3.0),
            (3.0, -3.0),
            (3.0, 3.0),
        ];
        check(&corners.map(DVec2::from), &[(0, 8)], 16.0);
    }

    #[test]
    fn hole_touching_the_outer_loop_at_a_vertex() {
        let p = [(0., 0.), (4., 0.), (4., 4.), (0., 4.), (0., 0.), (1., 2.), (2., 1.)].map(DVec2::from);
        check(&p, &[(0, 4), (4, 7)], 16.0 - 1.5);
    }

    proptest! {
        #[test]
        fn star_polygons_with_a_hole(radii in prop::collection::vec(0.6f64..2.0, 3..60),
            turn in 0.0f64..6.3) {
            let n = radii.len();
            let mut p: Vec<DVec2> = (0..n)
                .map(|i| math::direction(turn + std::f64::consts::TAU * i as f64 / n as f64) * radii[i])
                .collect();
            let outer = shoelace(&p);
            // The hole is small enough to stay inside even a triangle of the smallest radius.
            p.extend((0..5).map(|i| math::direction(turn - 1.3 * f64::from(i)) * 0.25));
            let hole = shoelace(&p[n..]);
            prop_assume!(hole < 0.0);
            check(&p, &[(0, n as u32), (n as u32, n as u32 + 5)], outer + hole);
        }
    }
}
