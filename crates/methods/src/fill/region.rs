//! The face in its chart as a region: what lies inside its loops, and which chords are near.
//!
//! Chords are sorted into a uniform grid of bins. Inside is decided by counting the chords that a ray to the
//! right crosses, with exact predicates; a point on a chord counts as on either side.

use chordal_nurbs::{DVec2, UvBox};
use chordal_tessellate::method::{Chart, orient};

/// The chords of a face's loops, found by place.
pub struct Region {
    pub uv_box: UvBox,
    chords: Vec<[u32; 2]>,
    points: Vec<DVec2>,
    bins: Vec<Vec<u32>>,
    count: [usize; 2],
}

impl Region {
    pub fn new(chart: &Chart) -> Self {
        let points: Vec<DVec2> = chart.points.iter().map(|p| p.uv).collect();
        let ring = |&(start, end): &(u32, u32)| {
            (start..end).map(move |i| [i, if i + 1 == end { start } else { i + 1 }])
        };
        let chords: Vec<[u32; 2]> = chart.loops.iter().flat_map(ring).collect();
        Self::from_chords(points, chords)
    }

    fn from_chords(points: Vec<DVec2>, chords: Vec<[u32; 2]>) -> Self {
        let side = ((chords.len() as f64).sqrt().ceil() as usize).clamp(1, 512);
        let uv_box = UvBox::from_points(chords.iter().map(|c| points[c[0] as usize]));
        let mut region =
            Self { uv_box, chords, points, bins: vec![Vec::new(); side * side], count: [side; 2] };
        for k in 0..region.chords.len() {
            let [a, b] = region.ends(k as u32);
            for bin in region.bins_of(UvBox::new(a.min(b), a.max(b))) {
                region.bins[bin].push(k as u32);
            }
        }
        region
    }

    /// The two ends of a chord, in the direction of its loop.
    pub fn ends(&self, chord: u32) -> [DVec2; 2] {
        self.chords[chord as usize].map(|v| self.points[v as usize])
    }

    /// Indices of the ends among the chart's points.
    pub fn vertices(&self, chord: u32) -> [u32; 2] {
        self.chords[chord as usize]
    }

    fn bin(&self, axis: usize, t: f64) -> usize {
        let size = self.uv_box.size()[axis];
        let at = (t - self.uv_box.min[axis]) / size * self.count[axis] as f64;
        if at > 0.0 { (at as usize).min(self.count[axis] - 1) } else { 0 }
    }

    fn bins_of(&self, b: UvBox) -> impl Iterator<Item = usize> + use<> {
        let [u0, u1] = [self.bin(0, b.min.x), self.bin(0, b.max.x)];
        let [v0, v1] = [self.bin(1, b.min.y), self.bin(1, b.max.y)];
        let columns = self.count[0];
        (v0..=v1).flat_map(move |j| (u0..=u1).map(move |i| j * columns + i))
    }

    /// Chords whose boxes meet `b`, in their order.
    pub fn near(&self, b: UvBox) -> Vec<u32> {
        let mut found: Vec<u32> = self.bins_of(b).flat_map(|bin| self.bins[bin].iter().copied()).collect();
        found.sort_unstable();
        found.dedup();
        found.retain(|&k| {
            let [p, q] = self.ends(k);
            p.max(q).cmpge(b.min).all() && p.min(q).cmple(b.max).all()
        });
        found
    }

    pub fn contains(&self, p: DVec2) -> bool {
        let right = UvBox::new(p, DVec2::new(self.uv_box.max.x.max(p.x), p.y));
        let crossings = self.near(right).into_iter().filter(|&k| {
            let [a, b] = self.ends(k);
            let up = b.y > a.y;
            (a.y > p.y) != (b.y > p.y) && (orient(a, b, p) > 0.0) == up
        });
        crossings.count() % 2 == 1
    }

    /// True where the face has a point in the box.
    pub fn meets(&self, b: UvBox) -> bool {
        self.is_crossed(b) || self.contains(b.center())
    }

    /// True where a chord has a point in the box.
    pub fn is_crossed(&self, b: UvBox) -> bool {
        self.near(b).into_iter().any(|k| {
            let [p, q] = self.ends(k);
            chord_meets(p, q, b)
        })
    }

    /// The chord nearest to `p` with `p` within `reach` of it, lengths counted in `scale` per direction.
    pub fn nearest(&self, p: DVec2, scale: DVec2, reach: f64) -> Option<u32> {
        let around = UvBox::new(p, p).inflated(scale * reach);
        let distance = |k: u32| {
            let [a, b] = self.ends(k).map(|q| (q - p) / scale);
            let d = b - a;
            let t = (-a.dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (a + d * t).length()
        };
        let near = self.near(around).into_iter().map(|k| (distance(k), k));
        near.filter(|&(d, _)| d <= reach).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
    }

    /// Where the segment from `p` along `axis` to the coordinate `to` crosses chords: (coordinate, chord), in
    /// order from `p`.
    pub fn crossings(&self, p: DVec2, axis: usize, to: f64) -> Vec<(f64, u32)> {
        let mut q = p;
        q[axis] = to;
        let level = p[1 - axis];
        let (low, high) = (p[axis].min(to), p[axis].max(to));
        let mut found: Vec<(f64, u32)> = self
            .near(UvBox::new(p.min(q), p.max(q)))
            .into_iter()
            .filter_map(|k| {
                let [a, b] = self.ends(k);
                if (a[1 - axis] > level) == (b[1 - axis] > level) {
                    return None;
                }
                let t = (level - a[1 - axis]) / (b[1 - axis] - a[1 - axis]);
                let at = a[axis] + t * (b[axis] - a[axis]);
                (at >= low && at <= high).then_some((at, k))
            })
            .collect();
        found.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        if to < p[axis] {
            found.reverse();
        }
        found
    }
}

/// True where the chord from `p` to `q` has a point in the closed box.
pub fn chord_meets(p: DVec2, q: DVec2, b: UvBox) -> bool {
    if b.contains(p) || b.contains(q) {
        return true;
    }
    let corners = [b.min, DVec2::new(b.max.x, b.min.y), b.max, DVec2::new(b.min.x, b.max.y)];
    let sides = corners.map(|c| orient(p, q, c));
    let beside = sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0);
    !beside && p.max(q).cmpge(b.min).all() && p.min(q).cmple(b.max).all()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of side 4 with a diamond hole around its middle.
    fn square_with_hole() -> Region {
        let p =
            [(0., 0.), (4., 0.), (4., 4.), (0., 4.), (2., 1.), (1., 2.), (2., 3.), (3., 2.)].map(DVec2::from);
        let chords = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]];
        Region::from_chords(p.to_vec(), chords.to_vec())
    }

    #[test]
    fn inside_agrees_with_the_closed_form() {
        let region = square_with_hole();
        for i in 0..41 {
            for j in 0..41 {
                let p = DVec2::new(0.123 * f64::from(i) - 0.3, 0.119 * f64::from(j) - 0.3);
                let square = p.cmpgt(DVec2::ZERO).all() && p.cmplt(DVec2::splat(4.0)).all();
                let hole = (p.x - 2.0).abs() + (p.y - 2.0).abs() < 1.0;
                assert_eq!(region.contains(p), square && !hole, "{p}");
            }
        }
    }

    #[test]
    fn boxes_meet_the_region_or_not() {
        let region = square_with_hole();
        let b = |x: f64, y: f64, r: f64| UvBox::new(DVec2::new(x - r, y - r), DVec2::new(x + r, y + r));
        assert!(region.meets(b(0.5, 0.5, 0.1)));
        assert!(!region.meets(b(2.0, 2.0, 0.4)), "inside the hole");
        assert!(region.meets(b(2.0, 2.0, 0.6)), "its corners leave the hole");
        assert!(!region.meets(b(5.0, 5.0, 0.5)));
        assert!(region.meets(b(2.0, 2.0, 9.0)));
    }

    #[test]
    fn a_line_through_the_hole_crosses_four_chords() {
        let region = square_with_hole();
        let at: Vec<f64> = region.crossings(DVec2::new(5.0, 1.5), 0, -1.0).into_iter().map(|c| c.0).collect();
        assert_eq!(at, [4.0, 2.5, 1.5, 0.0]);
        assert_eq!(region.nearest(DVec2::new(0.1, 2.0), DVec2::ONE, 0.2), Some(3));
        assert_eq!(region.nearest(DVec2::new(0.1, 2.0), DVec2::new(0.1, 1.0), 0.2), None);
    }
}
