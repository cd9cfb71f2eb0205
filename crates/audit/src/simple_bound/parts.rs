//! The parts of a triangle of parameters between the knots of a spline.

use chordal_nurbs::DVec2;

/// Pieces into which a triangle is cut at most; cut into more, the mesher's own bound is as quick.
const MOST_CELLS: usize = 6;

/// A strip of this share of the triangle cannot change a bound: parameters land on a knot only nearly.
const THIN: f64 = 1e-9;

/// A corner of a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub uv: DVec2,
    /// Bit i: it lies on the side of the triangle opposite corner i.
    pub sides: u8,
}

/// The parameters of knots inside a range.
fn inside(knots: &[f64], from: f64, to: f64) -> &[f64] {
    let slack = THIN * (to - from);
    let start = knots.partition_point(|&k| k <= from + slack);
    let end = knots.partition_point(|&k| k < to - slack);
    &knots[start..end.max(start)]
}

/// The whole triangle as one part.
pub(super) fn whole(uv: [DVec2; 3]) -> [Corner; 3] {
    std::array::from_fn(|i| Corner { uv: uv[i], sides: 0b111 & !(1 << i) })
}

/// Calls `visit` for triangles that together are the triangle, each within one span in both directions;
/// `None` where they are too many.
pub(super) fn for_parts(
    uv: [DVec2; 3],
    knots: [&[f64]; 2],
    visit: &mut impl FnMut(&[Corner; 3]) -> Option<()>,
) -> Option<()> {
    let low = uv[0].min(uv[1]).min(uv[2]);
    let high = uv[0].max(uv[1]).max(uv[2]);
    let whole = whole(uv);
    let cuts: [&[f64]; 2] = std::array::from_fn(|axis| inside(knots[axis], low[axis], high[axis]));
    if cuts.iter().all(|c| c.is_empty()) {
        return visit(&whole);
    }
    let [us, vs] = cuts.map(|cuts| {
        let mut cuts = cuts.to_vec();
        cuts.dedup();
        cuts
    });
    if (us.len() + 1) * (vs.len() + 1) > MOST_CELLS {
        return None;
    }
    for_strips(&whole, 0, &us, &mut |strip| {
        for_strips(strip, 1, &vs, &mut |cell| {
            (1..cell.len().saturating_sub(1)).try_for_each(|i| visit(&[cell[0], cell[i], cell[i + 1]]))
        })
    })
}

/// Calls `visit` for what lies between the cuts along one direction.
fn for_strips(
    polygon: &[Corner],
    axis: usize,
    cuts: &[f64],
    visit: &mut impl FnMut(&[Corner]) -> Option<()>,
) -> Option<()> {
    let mut rest = polygon.to_vec();
    for &cut in cuts {
        visit(&beside(&rest, axis, cut, 1.0))?;
        rest = beside(&rest, axis, cut, -1.0);
    }
    visit(&rest)
}

/// The part of a convex polygon on one side of a cut.
fn beside(polygon: &[Corner], axis: usize, cut: f64, sign: f64) -> Vec<Corner> {
    let depth = |c: &Corner| sign * (cut - c.uv[axis]);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, corner) in polygon.iter().enumerate() {
        let next = &polygon[(i + 1) % polygon.len()];
        let (d, e) = (depth(corner), depth(next));
        if d >= 0.0 {
            kept.push(*corner);
        }
        if d * e < 0.0 {
            let mut uv = corner.uv.lerp(next.uv, d / (d - e));
            uv[axis] = cut;
            kept.push(Corner { uv, sides: corner.sides & next.sides });
        }
    }
    kept
}
