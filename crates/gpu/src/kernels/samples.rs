//! Twin of `samples.wgsl`.

use super::normal::{Tangents, tangents_of, unit_normal};
use super::vector::{V3, V4};
use crate::layout::{Head, Params, Row, Span, Tile};
use crate::real::Real;

/// The buffers of the point kernels.
pub(crate) struct Inputs<'a, R> {
    pub heads: &'a [Head],
    pub tiles: &'a [Tile],
    pub rows: &'a [Row],
    pub spans: &'a [Span],
    pub windows: &'a [R],
    pub net: &'a [[R; 4]],
    pub basis: &'a [R],
    pub ts: &'a [R],
    pub params: Params,
}

/// What one thread evaluates.
#[derive(Clone, Copy)]
pub(crate) struct Sample {
    pub head: Head,
    pub row_u: usize,
    pub row_v: usize,
    pub at: usize,
}

/// The homogeneous derivatives by the parameters of the span: `[by u][by v]`.
pub(crate) type Jet<R> = [[V4<R>; 3]; 3];

impl<R: Real> Inputs<'_, R> {
    /// Every sample of the dispatch, in the order of tiles and threads.
    pub fn samples(&self) -> impl Iterator<Item = Sample> + '_ {
        let tiles = &self.tiles[self.params.tile0 as usize..self.params.rows as usize];
        tiles.iter().flat_map(move |tile| (0..64).filter_map(move |local| self.sample(tile, local)))
    }

    fn sample(&self, tile: &Tile, local: u32) -> Option<Sample> {
        let head = self.heads[tile.head as usize];
        let (i, j) = match head.paired {
            1 => (tile.i + local, 0),
            _ => (tile.i + local / 8, tile.j + local % 8),
        };
        let valid = i < head.width && (head.paired == 1 || j < head.height);
        let row_v = head.row_v + if head.paired == 1 { i } else { j };
        let at = head.first - self.params.out0 + i * if head.paired == 1 { 1 } else { head.height } + j;
        valid.then_some(Sample {
            head,
            row_u: (head.row_u + i) as usize,
            row_v: row_v as usize,
            at: at as usize,
        })
    }

    pub fn span(&self, row: usize) -> Span {
        self.spans[self.rows[row].span as usize]
    }

    /// The homogeneous control point `index`.
    pub fn point(&self, index: usize) -> V4<R> {
        V4(self.net[index])
    }

    pub fn write_point(&self, sample: Sample, h: V4<R>, out: &mut [R]) {
        write3(out, sample.at * 3, h.xyz() * (R::one() / h.w()));
    }

    pub fn write_normal(&self, sample: Sample, t: &Tangents<R>, out: &mut [R]) {
        write3(out, sample.at * 6, t.p);
        write3(out, sample.at * 6 + 3, unit_normal(t, R::from_f64(R::DEGENERATE)));
    }

    /// The inverse lengths of the spans of a sample.
    fn inverses(&self, sample: Sample) -> [R; 2] {
        [sample.row_u, sample.row_v].map(|row| self.windows[self.span(row).window as usize])
    }

    pub fn write_first(&self, sample: Sample, t: &Tangents<R>, out: &mut [R]) {
        let [inverse_u, inverse_v] = self.inverses(sample);
        let at = sample.at * if self.params.planes == 3 { 21 } else { 12 };
        write3(out, at, t.p);
        write3(out, at + 3, t.du * inverse_u);
        write3(out, at + 6, t.dv * inverse_v);
        write3(out, at + 9, unit_normal(t, R::from_f64(R::DEGENERATE)));
    }

    pub fn write_jet(&self, sample: Sample, h: &Jet<R>, out: &mut [R]) {
        let t = tangents_of(h[0][0], h[1][0], h[0][1]);
        self.write_first(sample, &t, out);
        if self.params.planes == 3 {
            let [inverse_u, inverse_v] = self.inverses(sample);
            let at = sample.at * 21;
            let by_w = R::one() / h[0][0].w();
            let Tangents { p, du, dv } = t;
            let twice = |x: R| x + x;
            let duu = (h[2][0].xyz() - du * twice(h[1][0].w()) - p * h[2][0].w()) * by_w;
            let duv = (h[1][1].xyz() - du * h[0][1].w() - dv * h[1][0].w() - p * h[1][1].w()) * by_w;
            let dvv = (h[0][2].xyz() - dv * twice(h[0][1].w()) - p * h[0][2].w()) * by_w;
            write3(out, at + 12, duu * (inverse_u * inverse_u));
            write3(out, at + 15, duv * (inverse_u * inverse_v));
            write3(out, at + 18, dvv * (inverse_v * inverse_v));
        }
    }
}

fn write3<R: Real>(out: &mut [R], at: usize, x: V3<R>) {
    out[at..at + 3].copy_from_slice(&x.0);
}
