//! Twin of `bezier.wgsl`: one Bézier net, summed by Horner's rule for Bernstein polynomials.

use super::normal::{Tangents, tangents_of};
use super::vector::V4;
use crate::real::Real;

/// The terms of one difference of order k: its running sum and C(n-k, i) tⁱ.
#[derive(Clone, Copy)]
pub(crate) struct Horner<R> {
    pub sum: V4<R>,
    term: R,
}

impl<R: Real> Horner<R> {
    pub fn start() -> Self {
        Self { sum: V4::default(), term: R::one() }
    }
    pub fn add(&mut self, value: V4<R>, i: u32, n: u32, t: R) {
        self.sum = self.sum * (R::one() - t) + value * self.term;
        self.term = self.term * t * R::from_u32(n - i) / R::from_u32(i + 1);
    }
}

/// n (n - 1), or 0.
pub(crate) fn second_factor<R: Real>(n: u32) -> R {
    if n > 1 { R::from_u32(n) * R::from_u32(n - 1) } else { R::zero() }
}

/// One line of a net along v: value and first two derivatives.
pub(crate) fn line_of<R: Real>(net: &[[R; 4]], start: usize, q: u32, t: R, planes: u32) -> [V4<R>; 3] {
    let mut sums = [Horner::start(); 3];
    let (mut last, mut before) = (V4::default(), V4::default());
    for j in 0..=q {
        let b = V4(net[start + j as usize]);
        sums[0].add(b, j, q, t);
        if planes > 1 && j > 0 {
            sums[1].add(b - last, j - 1, q - 1, t);
        }
        if planes > 2 && j > 1 {
            sums[2].add((b - last) - (last - before), j - 2, q - 2, t);
        }
        (before, last) = (last, b);
    }
    [sums[0].sum, sums[1].sum * R::from_u32(q), sums[2].sum * second_factor(q)]
}

/// One span of a surface: its first control point, its degrees, and a place in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell<R> {
    pub at: usize,
    pub p: u32,
    pub q: u32,
    pub t: [R; 2],
}

impl<R: Real> Cell<R> {
    /// The line of the net at index `i` along u.
    pub fn line(&self, net: &[[R; 4]], i: u32, planes: u32) -> [V4<R>; 3] {
        line_of(net, self.at + (i * (self.q + 1)) as usize, self.q, self.t[1], planes)
    }
}

/// Two sums of one degree less over neighbouring terms: between them lies the value, and from one to the
/// other goes the derivative.
#[derive(Clone, Copy)]
struct Pair<R> {
    low: V4<R>,
    high: V4<R>,
    term: R,
}

impl<R: Real> Pair<R> {
    fn start() -> Self {
        Self { low: V4::default(), high: V4::default(), term: R::one() }
    }
    /// The terms i and i + 1 of n.
    fn add(&mut self, [low, high]: [V4<R>; 2], i: u32, n: u32, t: R) {
        let s = R::one() - t;
        (self.low, self.high) = (self.low * s + low * self.term, self.high * s + high * self.term);
        self.term = self.term * t * R::from_u32(n - 1 - i) / R::from_u32(i + 1);
    }
    fn value(&self, t: R) -> V4<R> {
        self.low * (R::one() - t) + self.high * t
    }
}

/// One line of a net along v: value and derivative.
fn slope_of<R: Real>(net: &[[R; 4]], start: usize, q: u32, t: R) -> [V4<R>; 2] {
    let mut last = V4(net[start]);
    if q == 0 {
        return [last, V4::default()];
    }
    let mut h = Pair::start();
    for j in 0..q {
        let next = V4(net[start + j as usize + 1]);
        h.add([last, next], j, q, t);
        last = next;
    }
    [h.value(t), (h.high - h.low) * R::from_u32(q)]
}

/// Point and first derivatives by the span's parameters. A net has at least two lines.
pub(crate) fn tangents_at<R: Real>(net: &[[R; 4]], cell: &Cell<R>) -> Tangents<R> {
    let Cell { at, p, q, t: [t, t_v] } = *cell;
    let line = |i: u32| slope_of(net, at + (i * (q + 1)) as usize, q, t_v);
    let [mut h0, mut h1] = [Pair::start(); 2];
    let mut last = line(0);
    for i in 0..p {
        let next = line(i + 1);
        h0.add([last[0], next[0]], i, p, t);
        h1.add([last[1], next[1]], i, p, t);
        last = next;
    }
    tangents_of(h0.value(t), (h0.high - h0.low) * R::from_u32(p), h1.value(t))
}
