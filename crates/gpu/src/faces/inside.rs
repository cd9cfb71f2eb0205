//! Twin of `trim.wgsl`, and the search structure that both read.
//!
//! Loops are cut into cubic Bézier pieces that rise in y. A face's unit square is cut into bands of y; each
//! lists the pieces that reach into it. A point is tested against the pieces of its band only, and most of
//! those are decided by their control points. Pieces share their ends to the bit and own their lower end
//! only, so that a ray through a joint counts once.
//!
//! A map of square cells over the unit square comes first: cells that no loop enters are known to be inside
//! or outside as a whole. Only points in the other cells, a few per cent, are tested against pieces.

use super::pieces::Cubic;

/// The pieces of all faces.
#[derive(Clone, Debug, Default)]
pub(crate) struct TrimTable {
    /// Per piece its four x, then its four y.
    pub pieces: Vec<[f32; 4]>,
    pub lists: Vec<u32>,
}

/// Where a face's bands lie in a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TrimRange {
    pub at: u32,
    /// 0: the face fills its square.
    pub bands: u32,
}

/// More bands than this cost more memory than they save pieces.
const MOST_BANDS: usize = 512;

impl TrimTable {
    /// Adds the loops of one face, given as pieces in its unit square.
    pub fn push(&mut self, loops: &[Cubic]) -> TrimRange {
        let first = self.pieces.len() as u32 / 2;
        let rising: Vec<[[f32; 4]; 2]> = loops.iter().flat_map(Cubic::rising).collect();
        let bands = (rising.len() / 2).clamp(1, MOST_BANDS);
        let band_of = |y: f32| ((y * bands as f32).max(0.0) as usize).min(bands - 1);
        let mut members = vec![Vec::new(); bands];
        for (k, [_, ys]) in rising.iter().enumerate() {
            members[band_of(ys[0])..=band_of(ys[3])].iter_mut().for_each(|m| m.push(first + k as u32));
        }
        let at = self.lists.len() as u32;
        let mut map = Map::of(loops);
        self.lists.push(map.side as u32);
        let map_at = self.lists.len();
        // All cells count as undecided until they have been tested.
        self.lists.extend(std::iter::repeat_n(u32::MAX, (map.side * map.side).div_ceil(16)));
        let mut next = (self.lists.len() + bands + 1) as u32;
        self.lists.push(next);
        for m in &members {
            next += m.len() as u32;
            self.lists.push(next);
        }
        self.lists.extend(members.into_iter().flatten());
        self.pieces.extend(rising.into_iter().flatten());
        let range = TrimRange { at, bands: bands as u32 };
        map.fill(|p| inside(self, range, p));
        for (cell, state) in map.cells.iter().enumerate() {
            let (word, shift) = (map_at + cell / 16, 2 * (cell % 16));
            self.lists[word] = self.lists[word] & !(3 << shift) | state << shift;
        }
        range
    }
}

impl TrimTable {
    /// Bytes of the larger of its lists.
    pub fn bytes(&self) -> u64 {
        (self.pieces.len() * size_of::<[f32; 4]>()).max(self.lists.len() * size_of::<u32>()) as u64
    }
}

/// What is known of the cells of a unit square: 0 outside, 1 inside, 2 entered by a loop.
struct Map {
    side: usize,
    cells: Vec<u32>,
}

/// Cells along a side, at least and at most.
const SIDES: [f64; 2] = [16.0, 64.0];
/// Parts of a piece whose boxes stand for it on the map.
const PARTS: usize = 8;

impl Map {
    /// With the cells that loops enter marked, and those beside them within what single precision may move a
    /// curve.
    fn of(loops: &[Cubic]) -> Self {
        let side = (6.0 * (loops.len() as f64).sqrt()).clamp(SIDES[0], SIDES[1]) as usize;
        let mut map = Self { side, cells: vec![0; side * side] };
        let cell = |x: f64| ((x * side as f64).max(0.0) as usize).min(side - 1);
        for piece in loops {
            for k in 0..PARTS {
                let [low, high] = piece.bounds(k as f64 / PARTS as f64, (k + 1) as f64 / PARTS as f64);
                let (low, high) = (low - 1e-5, high + 1e-5);
                for y in cell(low.y)..=cell(high.y) {
                    map.cells[y * side..][cell(low.x)..=cell(high.x)].fill(2);
                }
            }
        }
        map
    }

    /// Asks one cell of every run of unmarked ones along a row for all of them.
    fn fill(&mut self, inside: impl Fn([f32; 2]) -> bool) {
        let side = self.side;
        let middle = |k: usize| (k as f32 + 0.5) / side as f32;
        for (y, row) in self.cells.chunks_mut(side).enumerate() {
            let mut known = None;
            for (x, state) in row.iter_mut().enumerate() {
                if *state != 2 {
                    let answer = *known.get_or_insert_with(|| u32::from(inside([middle(x), middle(y)])));
                    *state = answer;
                } else {
                    known = None;
                }
            }
        }
    }
}

fn cubic([a, b, c, d]: [f32; 4], t: f32) -> f32 {
    let s = 1.0 - t;
    ((a * s + 3.0 * b * t) * s + 3.0 * c * t * t) * s + d * t * t * t
}

/// As `inside` of the shader, which tests four places at once.
pub(crate) fn inside(table: &TrimTable, range: TrimRange, p: [f32; 2]) -> bool {
    if range.bands == 0 {
        return true;
    }
    let at = range.at as usize;
    let side = table.lists[at] as usize;
    let column = |x: f32| (x * side as f32).clamp(0.0, side as f32 - 1.0) as usize;
    let cell = column(p[1]) * side + column(p[0]);
    let known = table.lists[at + 1 + cell / 16] >> (2 * (cell % 16)) & 3;
    if known < 2 {
        return known == 1;
    }
    let band = (p[1] * range.bands as f32).clamp(0.0, range.bands as f32 - 1.0) as usize;
    let offset = |k: usize| table.lists[at + 1 + (side * side).div_ceil(16) + band + k] as usize;
    let mut odd = false;
    for &piece in &table.lists[offset(0)..offset(1)] {
        let (xs, ys) = (table.pieces[2 * piece as usize], table.pieces[2 * piece as usize + 1]);
        if p[1] < ys[0] || p[1] >= ys[3] || p[0] >= xs.into_iter().fold(f32::MIN, f32::max) {
            continue;
        }
        if p[0] < xs.into_iter().fold(f32::MAX, f32::min) || cubic(xs, at_height(ys, p[1])) > p[0] {
            odd = !odd;
        }
    }
    odd
}

/// The parameter at which a rising piece has a height, as `at_heights` of the shader.
fn at_height(ys: [f32; 4], height: f32) -> f32 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = ((height - ys[0]) / (ys[3] - ys[0])).clamp(low, high);
    for _ in 0..12 {
        let off = cubic(ys, t) - height;
        if off.abs() <= 1e-7 {
            break;
        }
        if off <= 0.0 {
            low = t;
        } else {
            high = t;
        }
        let s = 1.0 - t;
        let slope = 3.0 * ((ys[1] - ys[0]) * s * s + 2.0 * (ys[2] - ys[1]) * s * t + (ys[3] - ys[2]) * t * t);
        let next = t - off / slope;
        t = if next >= low && next <= high { next } else { 0.5 * (low + high) };
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec2;

    /// A circle of four quarters about the middle of the square.
    fn circle(radius: f64) -> Vec<Cubic> {
        let k = 0.552_284_749_831 * radius;
        let axis = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
        (0..4)
            .map(|i| {
                let (a, b) = (axis[i], axis[(i + 1) % 4]);
                let middle = DVec2::splat(0.5);
                let points = [a * radius, a * radius + b * k, b * radius + a * k, b * radius];
                Cubic::new(points.map(|p| middle + p))
            })
            .collect()
    }

    #[test]
    fn an_island_in_a_hole_is_inside() {
        let mut table = TrimTable::default();
        // Another face before it: ranges are its own.
        table.push(&circle(0.2));
        let loops: Vec<Cubic> = [0.48, 0.3, 0.1].into_iter().flat_map(circle).collect();
        let range = table.push(&loops);
        for i in 0..200 {
            for j in 0..200 {
                let p = DVec2::new(f64::from(i), f64::from(j)) / 199.0;
                let r = p.distance(DVec2::splat(0.5));
                // Four cubics are a circle to 3e-4 of its radius.
                if [0.48, 0.3, 0.1].iter().any(|c: &f64| (c - r).abs() < 3e-4) {
                    continue;
                }
                let expected = r < 0.48 && r > 0.3 || r < 0.1;
                assert_eq!(inside(&table, range, p.as_vec2().to_array()), expected, "{p}");
            }
        }
    }

    /// A concave polygon of straight pieces against the even-odd rule over its edges, at points level with
    /// its corners too.
    #[test]
    fn concave_polygons_are_what_the_crossing_rule_says() {
        let corners = [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.5, 0.3], [0.5, 0.7], [0.3, 0.3], [0.1, 0.9]];
        let corners = corners.map(DVec2::from);
        let n = corners.len();
        let loops: Vec<Cubic> = (0..n).map(|i| Cubic::line(corners[i], corners[(i + 1) % n])).collect();
        let mut table = TrimTable::default();
        let range = table.push(&loops);
        for i in 0..=100 {
            for j in 0..=100 {
                let p = DVec2::new(f64::from(i) / 100.0 + 3e-4, f64::from(j) / 100.0).as_vec2();
                let mut odd = false;
                for k in 0..n {
                    let (a, b) = (corners[k].as_vec2(), corners[(k + 1) % n].as_vec2());
                    if (a.y <= p.y) != (b.y <= p.y) {
                        odd ^= a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x;
                    }
                }
                assert_eq!(inside(&table, range, p.to_array()), odd, "{p}");
            }
        }
    }
}
