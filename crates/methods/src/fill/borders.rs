//! The borders of rectangular cells as a graph: unique corners, and sides cut wherever another cell has a
//! corner on them.
//!
//! The corner of a small cell in the side of a large one (a T-vertex) becomes a vertex of both, so no crack
//! can open between them. Source: Kahlesz, Balázs, Klein 2001, section 2 (unique vertices, `splitEdge`).

use chordal_nurbs::{DVec2, UvBox};

/// The corners of cells and the pieces of their sides.
#[derive(Clone, Debug, Default)]
pub struct Borders {
    /// Distinct corners, sorted by v, then by u.
    pub corners: Vec<DVec2>,
    /// The extent of the smallest cell at each corner.
    pub extent: Vec<DVec2>,
    /// Pieces of sides between successive corners (along u where both have the same v), each once, smaller
    /// index first.
    pub pieces: Vec<(u32, u32)>,
    /// The corners by u, then by v.
    columns: Vec<u32>,
}

/// By v, then by u.
fn by_rows(a: &DVec2, b: &DVec2) -> std::cmp::Ordering {
    a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x))
}

/// By u, then by v.
fn by_columns(a: &DVec2, b: &DVec2) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

impl Borders {
    /// Borders of cells that do not overlap; neighbours agree in their coordinates to the last bit.
    pub fn new(cells: &[UvBox]) -> Self {
        // Zeros of both signs are one coordinate.
        let four = |b: &UvBox| {
            [b.min, DVec2::new(b.max.x, b.min.y), b.max, DVec2::new(b.min.x, b.max.y)].map(|p| p + 0.0)
        };
        let mut corners: Vec<DVec2> = cells.iter().flat_map(four).collect();
        corners.sort_unstable_by(by_rows);
        corners.dedup();
        let index = |p: &DVec2| corners.partition_point(|q| by_rows(q, p).is_lt());
        let mut extent = vec![DVec2::INFINITY; corners.len()];
        for cell in cells {
            for corner in four(cell) {
                let at = index(&corner);
                extent[at] = extent[at].min(cell.size());
            }
        }
        let mut columns: Vec<u32> = (0..corners.len() as u32).collect();
        columns.sort_unstable_by(|&a, &b| by_columns(&corners[a as usize], &corners[b as usize]));
        let mut pieces = Vec::with_capacity(2 * corners.len());
        for cell in cells {
            let [a, b, c, d] = four(cell);
            for (from, to) in [(a, b), (d, c)] {
                pieces.extend((index(&from)..index(&to)).map(|i| (i as u32, i as u32 + 1)));
            }
            for (from, to) in [(a, d), (b, c)] {
                let place =
                    |p: &DVec2| columns.partition_point(|&q| by_columns(&corners[q as usize], p).is_lt());
                let run = &columns[place(&from)..=place(&to)];
                pieces.extend(run.windows(2).map(|w| (w[0].min(w[1]), w[0].max(w[1]))));
            }
        }
        pieces.sort_unstable();
        pieces.dedup();
        Self { corners, extent, pieces, columns }
    }

    /// The corners around a cell, counter-clockwise from its lower left one; corners of smaller neighbours in
    /// its sides included.
    pub fn ring(&self, cell: UvBox) -> Vec<u32> {
        let row = |p: DVec2| self.corners.partition_point(|q| by_rows(q, &(p + 0.0)).is_lt());
        let corner = |i: u32| &self.corners[i as usize];
        let column = |p: DVec2| self.columns.partition_point(|&q| by_columns(corner(q), &(p + 0.0)).is_lt());
        let (low_right, high_left) = (DVec2::new(cell.max.x, cell.min.y), DVec2::new(cell.min.x, cell.max.y));
        let mut ring: Vec<u32> = (row(cell.min) as u32..row(low_right) as u32).collect();
        ring.extend(&self.columns[column(low_right)..column(cell.max)]);
        ring.extend((row(high_left) as u32 + 1..=row(cell.max) as u32).rev());
        ring.extend(self.columns[column(cell.min) + 1..=column(high_left)].iter().rev());
        ring
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_in_a_neighbours_side_cuts_it() {
        // One large cell on the left, two small ones on the right.
        let cell = |a: (f64, f64), b: (f64, f64)| UvBox::new(DVec2::from(a), DVec2::from(b));
        let cells = [cell((-1., 0.), (1., 2.)), cell((1., 0.), (2., 1.)), cell((1., 1.), (2., 2.))];
        let borders = Borders::new(&cells);
        assert_eq!(borders.corners.len(), 8);
        // Sides: bottom 2, top 2, left 1, middle 2, right 2, between the small ones 1.
        assert_eq!(borders.pieces.len(), 10);
        for &(a, b) in &borders.pieces {
            let d = borders.corners[b as usize] - borders.corners[a as usize];
            assert!(d.x == 0.0 || d.y == 0.0);
            assert!(d.length() <= 2.0);
        }
        let t = borders.corners.iter().position(|&p| p == DVec2::new(1.0, 1.0)).expect("there");
        assert_eq!(borders.extent[t], DVec2::ONE);
        let around =
            |c: UvBox| borders.ring(c).iter().map(|&i| borders.corners[i as usize]).collect::<Vec<_>>();
        let expected = [(-1., 0.), (1., 0.), (1., 1.), (1., 2.), (-1., 2.)].map(DVec2::from);
        assert_eq!(around(cells[0]), expected);
        assert_eq!(around(cells[1]), [(1., 0.), (2., 0.), (2., 1.), (1., 1.)].map(DVec2::from));
    }
}
