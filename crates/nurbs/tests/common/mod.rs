//! Random splines of every legal shape, from a seed.
#![allow(dead_code)]

use chordal_nurbs::math;
use chordal_nurbs::*;

/// SplitMix64: a stream that depends on nothing but its seed.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
    pub fn within(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
    pub fn point(&mut self) -> DVec3 {
        DVec3::new(self.within(-1.0, 1.0), self.within(-1.0, 1.0), self.within(-1.0, 1.0))
    }
    /// Weights from 1e-3 to 1e3 (or gentler), or none.
    pub fn weights(&mut self, count: usize, rational: bool, decades: f64) -> Option<Vec<f64>> {
        rational.then(|| (0..count).map(|_| math::pow(10.0, self.within(-decades, decades))).collect())
    }
    pub fn sample(&mut self, range: Range) -> f64 {
        match self.below(10) {
            0 => range.start,
            1 => range.end,
            _ => self.within(range.start, range.end),
        }
    }
    pub fn sub_range(&mut self, range: Range) -> Range {
        let (a, b) = (self.within(range.start, range.end), self.within(range.start, range.end));
        Range::new(a.min(b), a.max(b))
    }

    /// Knots with random multiplicities (sometimes above the degree) and clamped, loose or uniform ends.
    pub fn knots(&mut self, degree: usize) -> Vec<f64> {
        let ends = self.below(3);
        let mut knots = Vec::new();
        let mut t = self.within(-2.0, 2.0);
        match ends {
            0 => knots.extend(vec![t; degree + 1]),
            1 => {
                for _ in 0..=degree {
                    knots.push(t);
                    t += self.within(0.01, 1.0);
                }
            }
            _ => {
                for _ in 0..=degree {
                    knots.push(t);
                    t += 0.5;
                }
            }
        }
        t = knots[degree];
        for _ in 0..self.below(6) {
            t += if ends == 2 { 0.5 } else { self.within(0.05, 1.0) };
            let most = [1, degree, degree + 1, degree + 3][self.below(4)];
            let times = if ends == 2 { 1 } else { 1 + self.below(most) };
            knots.extend(vec![t; times]);
        }
        t += 0.5;
        match ends {
            0 => knots.extend(vec![t; degree + 1]),
            _ => {
                for _ in 0..=degree {
                    knots.push(t);
                    t += if ends == 2 { 0.5 } else { self.within(0.01, 1.0) };
                }
            }
        }
        knots
    }

    pub fn curve(&mut self, degree: usize, rational: bool, decades: f64) -> NurbsCurve3 {
        let knots = self.knots(degree);
        let count = knots.len() - degree - 1;
        let points = (0..count).map(|_| self.point()).collect();
        let weights = self.weights(count, rational, decades);
        NurbsCurve::new(degree, knots, points, weights).expect("a legal curve")
    }

    pub fn surface(&mut self, degree: [usize; 2], rational: bool, decades: f64) -> NurbsSurface {
        let (u, v) = (self.knots(degree[0]), self.knots(degree[1]));
        let count = (u.len() - degree[0] - 1) * (v.len() - degree[1] - 1);
        let points = (0..count).map(|_| self.point()).collect();
        let weights = self.weights(count, rational, decades);
        NurbsSurface::new(degree, u, v, points, weights).expect("a legal surface")
    }
}

/// De Boor's algorithm as the books print it, on homogeneous control points.
pub fn de_boor(degree: usize, knots: &[f64], net: &[DVec4], t: f64) -> DVec4 {
    let count = net.len();
    let mut span =
        (degree..count).rev().find(|&s| knots[s] <= t && knots[s] < knots[s + 1]).unwrap_or(degree);
    while knots[span] == knots[span + 1] {
        span += 1;
    }
    let mut d: Vec<DVec4> = net[span - degree..=span].to_vec();
    for r in 1..=degree {
        for j in (r..=degree).rev() {
            let i = span - degree + j;
            let width = knots[i + degree + 1 - r] - knots[i];
            let alpha = if width == 0.0 { 0.0 } else { (t - knots[i]) / width };
            d[j] = d[j - 1] * (1.0 - alpha) + d[j] * alpha;
        }
    }
    d[degree]
}

pub fn lift(points: &[DVec3], weights: Option<&[f64]>) -> Vec<DVec4> {
    points
        .iter()
        .enumerate()
        .map(|(i, p)| weights.map_or(p.extend(1.0), |w| (*p * w[i]).extend(w[i])))
        .collect()
}

pub fn project(h: DVec4) -> DVec3 {
    h.truncate() / h.w
}
