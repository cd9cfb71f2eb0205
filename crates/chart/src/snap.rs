//! Rounding of parameters to a grid, so that rounding errors never decide how triangles are connected.

use chordal_nurbs::{DVec2, math};

/// A grid of parameters, finer than any measured length and coarser than rounding errors. Whatever decides
/// how triangles are connected lies on this grid. Otherwise rounding would decide which of two points comes
/// first, or on which side of an edge a point lies, and a part would get another mesh at another place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grid {
    /// The distances of the grid: powers of two, so that places on it are exact; 0 where there is no grid.
    quantum: DVec2,
}

/// The grid has between 2 to this power and twice as many places across a face. A step is less than a
/// millionth of a tolerance of 0.01 %, and 2¹⁶ times the rounding error of a double.
const GRID_BITS: i32 = 36;

impl Grid {
    /// The grid for charts of this extent.
    pub fn over(extent: DVec2) -> Self {
        // Extents are often powers of two. The factor keeps them away from the values at which the grid
        // changes.
        let quantum = |length: f64| {
            let exponent = math::log2(0.7 * length).floor();
            if exponent.abs() < 900.0 { math::powi(2.0, exponent as i32 - GRID_BITS) } else { 0.0 }
        };
        Self { quantum: DVec2::new(quantum(extent.x), quantum(extent.y)) }
    }

    /// The nearest place on the grid.
    pub fn snap(&self, p_uv: DVec2) -> DVec2 {
        let snap = |t: f64, quantum: f64| if quantum > 0.0 { (t / quantum).round() * quantum } else { t };
        DVec2::new(snap(p_uv.x, self.quantum.x), snap(p_uv.y, self.quantum.y))
    }
}

/// Places that are spread by a measured rate are rounded to multiples of this share of the range, counted
/// from the place by an even rate.
const SPREAD_QUANTUM: f64 = 1.0 / (1u64 << 24) as f64;

/// A place within a range of this length, rounded so that another rounding of the measured rate gives the
/// same place.
pub fn settled(uneven: f64, even: f64, range: f64) -> f64 {
    let quantum = range * SPREAD_QUANTUM;
    if quantum == 0.0 { uneven } else { even + ((uneven - even) / quantum).round() * quantum }
}
