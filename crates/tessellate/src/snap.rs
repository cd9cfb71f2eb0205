//! A grid of parameters on which charts lie.

use chordal_nurbs::DVec2;

/// A grid of parameters finer than anything that is measured and coarser than rounding. Whatever decides how triangles join lies
/// on it: else rounding would decide which of two points comes first or on which side of an edge one lies, and the same
/// part would get another mesh elsewhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grid {
    /// Powers of two, so that places on the grid are exact; 0 where there is none.
    quantum: DVec2,
}

/// The grid has 2 to this power places across a face, or up to twice as many.
const GRID_BITS: i32 = 36;

impl Grid {
    /// The grid for charts of this extent.
    pub fn over(extent: DVec2) -> Self {
        // Extents are often powers of two themselves: keep away from where the grid changes.
        let quantum = |length: f64| {
            let exponent = (0.7 * length).log2().floor();
            if exponent.abs() < 900.0 { 2f64.powi(exponent as i32 - GRID_BITS) } else { 0.0 }
        };
        Self { quantum: DVec2::new(quantum(extent.x), quantum(extent.y)) }
    }

    /// The nearest place on the grid.
    pub fn snap(&self, p_uv: DVec2) -> DVec2 {
        let snap = |t: f64, quantum: f64| if quantum > 0.0 { (t / quantum).round() * quantum } else { t };
        DVec2::new(snap(p_uv.x, self.quantum.x), snap(p_uv.y, self.quantum.y))
    }
}

/// Places that are spread by a measured rate lie at whole multiples of this share of the range from where an even rate would
/// put them.
const SPREAD_QUANTUM: f64 = 1.0 / (1u64 << 24) as f64;

/// A place within a range of this length, moved by less than anyone can tell to where another rounding of the measured rate
/// would have put it too.
pub(crate) fn settled(uneven: f64, even: f64, range: f64) -> f64 {
    let quantum = range * SPREAD_QUANTUM;
    if quantum == 0.0 { uneven } else { even + ((uneven - even) / quantum).round() * quantum }
}
