//! Subdivisions that are made at once: the uniform grid, and a fixed number of cells per control cell.
//!
//! Source: the survey of the Blender wiki, "Uniform Grid Cut" and "Direct Tessellation", after Piegl and
//! Richard 1995; how many lines are needed follows from [`super::derivatives`]. Both guarantee their error
//! and pay for it: the most curved place decides for the whole face. Where the common proof still finds a
//! triangle too coarse, all cells are halved.
//!
//! ```text
//! uniform grid    n × m cells, the fewest with ⅛(M_uu/n² + 2M_uv/nm + M_vv/m²) ≤ ε over the unit square
//! control cells   lines through the Greville abscissae, k × k cells between them,
//!                 k² ≥ the largest cell's error over ε
//! ```

use super::cells::{Rule, Split};
use super::derivatives::SecondNorms;
use super::node::{Measure, greville};
use chordal_nurbs::NurbsSurface;

/// A grid of equal cells.
#[derive(Clone, Copy, Debug)]
pub struct UniformGrid {
    /// The number of lines in each direction, as a multiple of the number that the bound requires.
    pub finer: [usize; 2],
}

impl UniformGrid {
    /// The coarsest grid within the bound.
    pub const COARSEST: Self = Self { finer: [1; 2] };
}

/// A fixed number of cells per control cell; zero: as many as the bound requires.
#[derive(Clone, Copy, Debug)]
pub struct ControlCells {
    pub per_cell: u32,
}

/// No grid is finer than this in one direction, and none has more cells.
const MOST_LINES: f64 = 2000.0;
const MOST_CELLS: f64 = 250_000.0;

/// The number of lines where the bound requires more than the limit.
const BEYOND: usize = 32;

impl Rule for UniformGrid {
    fn name(&self) -> &'static str {
        "uniform grid cells"
    }

    fn first_cuts(&self, root: &NurbsSurface, tolerance: f64) -> Vec<Split> {
        let size = root.domain().size();
        let (n, m) = fewest(&SecondNorms::of_surface(root).over(size), tolerance);
        let (n, m) = (n * self.finer[0], m * self.finer[1]);
        let at = |axis: usize, k: usize, n: usize| Split {
            axis,
            at: root.domain().min[axis] + size[axis] * k as f64 / n as f64,
        };
        (1..n).map(|k| at(0, k, n)).chain((1..m).map(|k| at(1, k, m))).collect()
    }

    fn cuts(&self, _: &NurbsSurface, _: f64, _: Measure) -> Vec<Split> {
        Vec::new()
    }

    fn forced(&self, piece: &NurbsSurface, _: Measure) -> Vec<Split> {
        halves(piece)
    }

    fn is_uniform(&self) -> bool {
        true
    }
}

impl Rule for ControlCells {
    fn name(&self) -> &'static str {
        "parts of control cells"
    }

    fn first_cuts(&self, root: &NurbsSurface, tolerance: f64) -> Vec<Split> {
        let [p, q] = root.degree();
        let [m, n] = root.counts();
        let lines = [greville(p, root.knots_u(), m), greville(q, root.knots_v(), n)];
        let parts = if self.per_cell > 0 { self.per_cell as usize } else { needed(root, &lines, tolerance) };
        let mut cuts = Vec::new();
        for (axis, lines) in lines.iter().enumerate() {
            for (i, pair) in lines.windows(2).enumerate() {
                let first = usize::from(i == 0);
                let at = |k: usize| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64;
                cuts.extend((first..parts).map(|k| Split { axis, at: at(k) }));
            }
        }
        cuts
    }

    fn cuts(&self, _: &NurbsSurface, _: f64, _: Measure) -> Vec<Split> {
        Vec::new()
    }

    fn forced(&self, piece: &NurbsSurface, _: Measure) -> Vec<Split> {
        halves(piece)
    }

    fn is_uniform(&self) -> bool {
        true
    }
}

/// Half way in both directions.
pub fn halves(piece: &NurbsSurface) -> Vec<Split> {
    let middle = piece.domain().center();
    vec![Split { axis: 0, at: middle.x }, Split { axis: 1, at: middle.y }]
}

/// The grid with the fewest cells whose error is within the tolerance.
pub fn fewest(norms: &SecondNorms, tolerance: f64) -> (usize, usize) {
    let rows = |n: f64| {
        // ⅛(a²U + 2abW + b²V) = ε solved for b, a = 1/n.
        let a = 1.0 / n;
        let rest = 8.0 * tolerance - a * a * norms.uu;
        if !(rest > 0.0) {
            return f64::INFINITY;
        }
        let w = a * norms.uv;
        let b = rest / (w + (w * w + norms.vv * rest).sqrt());
        (1.0 / b).ceil().max(1.0)
    };
    let mut best = (f64::INFINITY, f64::INFINITY);
    let mut n = 1.0;
    while n <= MOST_LINES {
        let m = rows(n);
        if n * m < best.0 * best.1 {
            best = (n, m);
        }
        if m <= 1.0 {
            break;
        }
        n += 1.0;
    }
    // A bound this loose is of no use here; the proof that all methods share refines the cells.
    if best.0 * best.1 <= MOST_CELLS { (best.0 as usize, best.1 as usize) } else { (BEYOND, BEYOND) }
}

/// Parts per side of every control cell.
fn needed(root: &NurbsSurface, lines: &[Vec<f64>; 2], tolerance: f64) -> usize {
    let widest = |lines: &[f64], from: f64, to: f64| {
        lines.windows(2).filter(|w| w[1] > from && w[0] < to).fold(0.0f64, |m, w| m.max(w[1] - w[0]))
    };
    let worst = root.bezier_patches(root.domain()).iter().fold(0.0f64, |worst, (b, patch)| {
        let size = b.size();
        let (du, dv) = (widest(&lines[0], b.min.x, b.max.x), widest(&lines[1], b.min.y, b.max.y));
        worst.max(SecondNorms::of_patch(patch).error(du / size.x, dv / size.y))
    });
    let parts = (worst / tolerance).sqrt().ceil();
    let [m, n] = [0, 1].map(|axis| lines[axis].len() as f64);
    if m * n * parts * parts <= MOST_CELLS {
        parts.max(1.0) as usize
    } else {
        ((BEYOND as f64 / m.max(n)).ceil() as usize).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::DVec3;

    #[test]
    fn the_grid_is_the_smallest_that_holds_the_bound() {
        let norms = SecondNorms { uu: 3.0, uv: 0.7, vv: 11.0 };
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            let (n, m) = fewest(&norms, tolerance);
            let error = |n: usize, m: usize| norms.error(1.0 / n as f64, 1.0 / m as f64);
            assert!(error(n, m) <= tolerance * (1.0 + 1e-12));
            for k in 1..=n * m {
                for (a, b) in (1..=k).filter(|a| k % a == 0).map(|a| (a, k / a)) {
                    assert!(a * b >= n * m || error(a, b) > tolerance, "{a} × {b} beats {n} × {m}");
                }
            }
        }
    }

    #[test]
    fn a_cylinder_patch_is_cut_in_one_direction_only() {
        // z = u², straight in v: M_uu = 2, so n = ⌈√(2/8ε)⌉ = 5 for ε = 0.011.
        let rows = [(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)];
        let points = rows.iter().flat_map(|&(u, z)| [0.0, 1.0].map(|v| DVec3::new(u, v, z))).collect();
        let knots = vec![0., 0., 0., 1., 1., 1.];
        let s = NurbsSurface::new([2, 1], knots, vec![0., 0., 1., 1.], points, None).expect("valid");
        let cuts = UniformGrid::COARSEST.first_cuts(&s, 0.011);
        assert_eq!(cuts.len(), 4);
        assert!(cuts.iter().all(|c| c.axis == 0));
        // Two control cells along u of width ½: the worst has error ⅛·2·¼ = 1/16, so ⌈√5.7⌉ = 3 parts; v gets
        // as many.
        let cuts = ControlCells { per_cell: 0 }.first_cuts(&s, 0.011);
        assert_eq!(cuts.iter().filter(|c| c.axis == 0).count(), 5);
    }
}
