//! The cells of a NURBS surface: its Bézier patches, cut about as finely as the requested boxes.
//!
//! A box is covered by cells about as large as itself: larger ones would be looser than need be, smaller ones
//! more than need be. So there are levels of cells, each half as large, in each direction, made when first
//! asked for.

use super::net::Patch;
use super::{Cell, Piece, net, overlapped};
use crate::math;
use crate::{NurbsSurface, Range, UvBox};
use glam::{DVec2, DVec3};
use std::sync::OnceLock;

/// The largest number of times that the cells of a patch are halved in each direction.
///
/// Enclosures shrink with the fourth power of the size, so five levels make them a million times smaller.
/// More levels cost memory for facets that are far below any tolerance.
const MAX_LEVEL: usize = 5;

/// What a cell may add to the bound of a facet as large as itself, as a share of the resolution.
///
/// It decides how fine the levels of a patch are. A larger share makes bounds looser, and meshes larger; a
/// smaller one makes more cells, whose making takes longer than what the tighter bounds save.
const SLACK: f64 = 0.02;

/// The cells of one patch at one pair of levels, row by row.
type Level = Vec<OnceLock<Box<Cell>>>;

/// The cells of one patch, made on first use.
#[derive(Clone, Debug, Default)]
struct PatchCells(OnceLock<Levels>);

#[derive(Clone, Debug)]
struct Levels {
    /// No finer level than this is worth its while.
    finest: usize,
    /// Level (a, b) at `a * (finest + 1) + b`.
    levels: Vec<OnceLock<Level>>,
}

/// Cells of a NURBS surface over a part of its domain.
#[derive(Clone, Debug)]
pub(super) struct CellTable {
    pub spans_u: Vec<f64>,
    pub spans_v: Vec<f64>,
    /// The patch over span (i, j) at `i * (spans_v.len() - 1) + j`.
    patches: Vec<Patch>,
    cells: Vec<PatchCells>,
    resolution: f64,
    /// Jumps of Su across `spans_u[i]` and of Sv across `spans_v[j]`, the largest along the line.
    pub jumps_u: Vec<f64>,
    pub jumps_v: Vec<f64>,
}

impl CellTable {
    /// `None` where a weight is not positive: nothing can be bounded then.
    pub fn new(surface: &NurbsSurface, domain: UvBox, resolution: f64) -> Option<Self> {
        let patches = surface.bezier_patches(domain);
        if patches.iter().any(|(_, p)| p.weights.as_ref().is_some_and(|w| w.iter().any(|&w| w <= 0.0))) {
            return None;
        }
        let spans_u = distinct(patches.iter().flat_map(|(b, _)| [b.min.x, b.max.x]));
        let spans_v = distinct(patches.iter().flat_map(|(b, _)| [b.min.y, b.max.y]));
        let rows = spans_v.len() - 1;
        let (mut jumps_u, mut jumps_v) = (vec![0.0f64; spans_u.len()], vec![0.0f64; spans_v.len()]);
        for k in 0..patches.len() {
            let (i, j) = (k / rows, k % rows);
            if i > 0 {
                jumps_u[i] = jumps_u[i].max(net::jump_u(&patches[k - rows], &patches[k]));
            }
            if j > 0 {
                jumps_v[j] = jumps_v[j].max(net::jump_v(&patches[k - 1], &patches[k]));
            }
        }
        let cells = vec![PatchCells::default(); patches.len()];
        let patches = patches.iter().map(|(span, patch)| Patch::new(*span, patch)).collect();
        Some(Self { spans_u, spans_v, patches, cells, resolution, jumps_u, jumps_v })
    }

    /// The surface at a point of the domain, and its weight there: several times quicker than from the knots.
    pub fn point(&self, uv: DVec2) -> (DVec3, f64) {
        let inner = |spans: &[f64], t: f64| spans[1..spans.len() - 1].partition_point(|&s| s <= t);
        let (i, j) = (inner(&self.spans_u, uv.x), inner(&self.spans_v, uv.y));
        let patch = &self.patches[i * (self.spans_v.len() - 1) + j];
        let h = patch.net.point((uv - patch.span.min) / patch.span.size());
        (patch.origin + h.truncate() / h.w, h.w)
    }

    /// Appends the pieces that cover the box; returns the jumps inside it.
    pub fn pieces(&self, b: UvBox, out: &mut Vec<Piece>) -> DVec2 {
        let (i0, i1) = overlapped(&self.spans_u, b.u());
        let (j0, j1) = overlapped(&self.spans_v, b.v());
        for i in i0..i1 {
            for j in j0..j1 {
                self.patch_pieces(i * (self.spans_v.len() - 1) + j, b, out);
            }
        }
        let largest = |jumps: &[f64], from: usize, to: usize| {
            jumps[(from + 1).min(to)..to].iter().fold(0.0f64, |m, &j| m.max(j))
        };
        DVec2::new(largest(&self.jumps_u, i0, i1), largest(&self.jumps_v, j0, j1))
    }

    fn patch_pieces(&self, k: usize, b: UvBox, out: &mut Vec<Piece>) {
        let levels = self.levels(k);
        let span = self.patches[k].span;
        let b = UvBox::new(b.min.max(span.min), b.max.min(span.max));
        let (u_level, v_level) = (levels.level(span.u(), b.u()), levels.level(span.v(), b.v()));
        let (us, vs) = (covered(span.u(), b.u(), u_level), covered(span.v(), b.v(), v_level));
        let size = span.size() / DVec2::new((1 << u_level) as f64, (1 << v_level) as f64);
        for a in us.clone() {
            for c in vs.clone() {
                let corner = span.min + size * DVec2::new(a as f64, c as f64);
                let part = UvBox::new(corner.max(b.min), (corner + size).min(b.max));
                out.push(self.cell(k, [u_level, v_level], [a, c]).piece(part));
            }
        }
    }

    fn levels(&self, k: usize) -> &Levels {
        self.cells[k].0.get_or_init(|| {
            // The slack of a cell shrinks with the fourth power of its size.
            let finest = math::log2(self.patches[k].slack() / (SLACK * self.resolution)) / 4.0;
            let finest = finest.ceil().clamp(0.0, MAX_LEVEL as f64) as usize;
            Levels { finest, levels: vec![OnceLock::new(); (finest + 1) * (finest + 1)] }
        })
    }

    fn cell(&self, k: usize, levels: [usize; 2], at: [usize; 2]) -> &Cell {
        let all = self.levels(k);
        let level = all.levels[levels[0] * (all.finest + 1) + levels[1]]
            .get_or_init(|| vec![OnceLock::new(); 1 << (levels[0] + levels[1])]);
        level[(at[0] << levels[1]) + at[1]]
            .get_or_init(|| Box::new(self.patches[k].cell(at, levels.map(|l| 1 << l))))
    }
}

impl Levels {
    /// The level whose cells are about as long as the range, and no shorter.
    fn level(&self, span: Range, range: Range) -> usize {
        let times = span.length() / range.length().max(f64::MIN_POSITIVE);
        (0..self.finest).take_while(|&level| times >= (2 << level) as f64).count()
    }
}

/// The cells of a level that a range meets.
fn covered(span: Range, range: Range, level: usize) -> std::ops::Range<usize> {
    let count = 1usize << level;
    let scale = count as f64 / span.length();
    let slack = 1e-7 * range.length();
    let from = ((range.start + slack - span.start) * scale).floor().clamp(0.0, (count - 1) as f64) as usize;
    let to =
        ((range.end - slack - span.start) * scale).ceil().clamp((from + 1) as f64, count as f64) as usize;
    from..to
}

fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}
