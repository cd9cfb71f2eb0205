//! Evaluation by passes over tables: what a graphics processor does, on the CPU, as the reference for
//! kernels.
//!
//! Source: Krishnamurthy, Khardekar, McMains 2009, sections 4 to 6. Every row of a table belongs to one
//! parameter, and every pass does the same to every cell of it, whatever the degree:
//!
//! ```text
//! knot table      t and the 2k knots u_{s−p} … u_{s+p+1} around its span s        k = p + 1
//! first table     0 … 0 1 0: the basis functions of degree 0 with indices s−p … s+1
//! pass d = 1…p    N_i ← (t − u_i)/(u_{i+d} − u_i)·N_i + (u_{i+d+1} − t)/(u_{i+d+1} − u_{i+1})·N_{i+1}
//!                 (0/0 = 0)
//! last pass       rows times the control points that they belong to, summed
//! ```
//!
//! A pass reads one of two tables and writes the other. The last column is zero throughout: with it no cell
//! needs a branch for its right neighbour. Four parameters are packed in one cell, as the four channels of a
//! texture. Sums have non-negative terms only, so every degree is as stable as the exact evaluator
//! ([`crate::NurbsCurve::point`]), which tests compare with.

use crate::basis::find_span;
use crate::homogeneous::{Homogeneous, homogeneous};
use crate::{DVec3, NurbsCurve, NurbsSurface, Vector};

/// Parameters packed in one cell.
const CHANNELS: usize = 4;

type Cell = [f64; CHANNELS];

/// The basis functions that do not vanish at each of many parameters, made by passes.
#[derive(Clone, Debug)]
pub struct BasisTable {
    degree: usize,
    /// Per parameter the index of the first control point with a basis function that is not zero.
    first: Vec<usize>,
    /// Rows of `degree + 2` cells; row r holds the parameters 4r … 4r + 3.
    cells: Vec<Cell>,
    passes: usize,
}

impl BasisTable {
    /// Evaluates at `parameters`, clamped to the domain; knots as those of a [`NurbsCurve`] of this degree.
    fn new(degree: usize, knots: &[f64], parameters: &[f64]) -> Self {
        let end = knots.len() - degree - 1;
        let clamped: Vec<f64> = parameters.iter().map(|t| t.max(knots[degree]).min(knots[end])).collect();
        let spans: Vec<usize> = clamped.iter().map(|&t| find_span(degree, knots, t)).collect();
        let table = KnotTable::new(degree, knots, &clamped, &spans);
        let width = degree + 2;
        let rows = clamped.len().div_ceil(CHANNELS);
        let mut from = vec![[0.0; CHANNELS]; rows * width];
        from.iter_mut().skip(degree).step_by(width).for_each(|cell| *cell = [1.0; CHANNELS]);
        let mut to = vec![[0.0; CHANNELS]; rows * width];
        for pass in 1..=degree {
            for row in 0..rows {
                let at = row * width;
                table.pass(pass, row, &from[at..at + width], &mut to[at..at + width]);
            }
            std::mem::swap(&mut from, &mut to);
        }
        Self { degree, first: spans.iter().map(|s| s - degree).collect(), cells: from, passes: degree }
    }

    /// How many passes were made.
    pub fn passes(&self) -> usize {
        self.passes
    }

    /// The index of the first control point with a basis function that is not zero at parameter `i`.
    pub fn first(&self, i: usize) -> usize {
        self.first[i]
    }

    /// The `degree + 1` basis functions at parameter `i`.
    pub fn values(&self, i: usize) -> impl Iterator<Item = f64> + '_ {
        let width = self.degree + 2;
        let row = &self.cells[i / CHANNELS * width..][..self.degree + 1];
        row.iter().map(move |cell| cell[i % CHANNELS])
    }
}

/// Parameters, each with the knots around its span.
struct KnotTable {
    degree: usize,
    /// Rows of `2·degree + 3` cells: the parameter, then the knots.
    cells: Vec<Cell>,
}

impl KnotTable {
    fn new(degree: usize, knots: &[f64], parameters: &[f64], spans: &[usize]) -> Self {
        let width = 2 * degree + 3;
        let rows = parameters.len().div_ceil(CHANNELS);
        let mut cells = vec![[0.0; CHANNELS]; rows * width];
        for row in 0..rows {
            for channel in 0..CHANNELS {
                // Channels beyond the last parameter repeat it.
                let i = (row * CHANNELS + channel).min(parameters.len() - 1);
                let cells = &mut cells[row * width..][..width];
                cells[0][channel] = parameters[i];
                for (cell, &knot) in cells[1..].iter_mut().zip(&knots[spans[i] - degree..]) {
                    cell[channel] = knot;
                }
            }
        }
        Self { degree, cells }
    }

    /// One pass over one row: column j holds the function with index s − p + j, its knots begin in column 1 +
    /// j.
    fn pass(&self, d: usize, row: usize, from: &[Cell], to: &mut [Cell]) {
        let width = 2 * self.degree + 3;
        let (t, knots) = self.cells[row * width..][..width].split_first().expect("at least three columns");
        for j in 0..=self.degree {
            for c in 0..CHANNELS {
                let [low, after_low] = [knots[j][c], knots[j + 1][c]];
                let high = knots[j + d + 1][c];
                let up = ratio(t[c] - low, knots[j + d][c] - low);
                let down = ratio(high - t[c], high - after_low);
                to[j][c] = up * from[j][c] + down * from[j + 1][c];
            }
        }
    }
}

/// The quotient, 0 for 0/0: repeated knots make it.
fn ratio(over: f64, under: f64) -> f64 {
    if under == 0.0 { 0.0 } else { over / under }
}

impl<V: Vector> NurbsCurve<V> {
    /// The points at many parameters by passes over tables; the same as [`Self::point`] up to rounding.
    pub fn points_by_passes(&self, parameters: &[f64]) -> Vec<V> {
        if parameters.is_empty() {
            return Vec::new();
        }
        let table = BasisTable::new(self.degree(), self.knots(), parameters);
        let net = homogeneous(self.points(), self.weights());
        let sum = |i: usize| weighted(table.values(i), &net[table.first(i)..]).project();
        (0..parameters.len()).map(sum).collect()
    }

    /// The basis functions at many parameters by passes.
    pub fn basis_by_passes(&self, parameters: &[f64]) -> BasisTable {
        BasisTable::new(self.degree(), self.knots(), parameters)
    }
}

impl NurbsSurface {
    /// The points of the grid `us` × `vs` (u outer, v inner) by passes over tables; the same as
    /// [`Self::point`] up to rounding.
    pub fn points_by_passes(&self, us: &[f64], vs: &[f64]) -> Vec<DVec3> {
        if us.is_empty() || vs.is_empty() {
            return Vec::new();
        }
        let [p, q] = self.degree();
        let tables = [BasisTable::new(p, self.knots_u(), us), BasisTable::new(q, self.knots_v(), vs)];
        let net = homogeneous(self.points(), self.weights());
        let columns = self.counts()[1];
        let mut points = Vec::with_capacity(us.len() * vs.len());
        for i in 0..us.len() {
            for j in 0..vs.len() {
                let row = |k: usize| {
                    let at = (tables[0].first(i) + k) * columns + tables[1].first(j);
                    weighted(tables[1].values(j), &net[at..])
                };
                let rows: Vec<Homogeneous<DVec3>> = (0..=p).map(row).collect();
                points.push(weighted(tables[0].values(i), &rows).project());
            }
        }
        points
    }
}

fn weighted<V: Vector>(factors: impl Iterator<Item = f64>, points: &[Homogeneous<V>]) -> Homogeneous<V> {
    factors.zip(points).fold(Homogeneous::default(), |sum, (factor, &p)| sum + p * factor)
}
