//! The distances between borders: the merge tolerance `auto`, and the histogram that `info` shows.
//!
//! At three places of every border the distance to the nearest other border is measured. Gaps between faces
//! that should be joined are at the lower end of the histogram, real openings at its upper end. Between them
//! is a range without gaps. The tolerance lies in the widest such range (as a ratio of its ends) between the
//! resolution of the file and [`LARGEST_GAP`] of the part, near its lower end.

use crate::border::{Borders, edge_uses};
use crate::foot::foot;
use crate::natural::add_natural_borders;
use crate::polygon::add_polygon_edges;
use chordal_brep::Part;
use chordal_nurbs::{Box3, math};
use rayon::prelude::*;

/// No joint of a part is wider than this share of its diagonal.
pub(crate) const LARGEST_GAP: f64 = 2e-3;
/// The assumed accuracy of coordinates if the file states none, as a share of the diagonal: files with six
/// digits.
pub(crate) const RESOLUTION: f64 = 1e-6;
/// A range without gaps is clear where its upper end is at least this multiple of its lower end. A smaller
/// value would trust ranges that occur by chance.
pub(crate) const CLEAR: f64 = 4.0;
/// The tolerance is this multiple of the largest gap to be sewn, because ends of edges are further apart than
/// their middles.
const MARGIN: f64 = 3.0;

/// Gaps between two powers of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapBin {
    /// The lower end: zero in the first bin, else `below / 10`.
    pub from: f64,
    /// The upper end.
    pub below: f64,
    /// How many gaps lie between.
    pub count: usize,
}

/// How a merge tolerance was found; lengths in the part's own units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AutoTolerance {
    /// The tolerance that was found.
    pub tolerance: f64,
    /// The accuracy that the file states, or that its coordinates are assumed to have.
    pub resolution: f64,
    /// The range without gaps between the gaps to be sewn and real openings.
    pub empty_range: [f64; 2],
    /// Whether that range is wide enough to be trusted.
    pub clear: bool,
    /// The number of gaps below that range and above it.
    pub gaps: [usize; 2],
    /// The histogram, a bin for every power of ten that has gaps.
    pub histogram: Vec<GapBin>,
}

/// Measures the gaps of a part; `None` where fewer than two edges are used by one face only.
pub fn gap_survey(part: &Part) -> Option<AutoTolerance> {
    let mut whole = part.clone();
    add_natural_borders(&mut whole);
    add_polygon_edges(&mut whole);
    let uses = edge_uses(&whole);
    survey(&whole, &Borders::new(&whole, &uses))
}

/// The survey of borders that are collected already.
pub(crate) fn survey(part: &Part, borders: &Borders) -> Option<AutoTolerance> {
    if borders.all.len() < 2 {
        return None;
    }
    let box3 = Box3::from_points(borders.all.iter().flat_map(|b| b.points.iter().copied()));
    let mut gaps = nearest_gaps(borders);
    gaps.sort_unstable_by(f64::total_cmp);
    Some(choose(&gaps, part.uncertainty, box3.diagonal()))
}

/// The distances of three places of every border from the nearest other border.
fn nearest_gaps(borders: &Borders) -> Vec<f64> {
    (0..borders.all.len())
        .into_par_iter()
        .with_min_len(64)
        .flat_map_iter(|b| {
            let range = borders.all[b].range;
            [0.25, 0.5, 0.75].map(|s| nearest_other(borders, b, range.start + s * range.length()))
        })
        .flatten()
        .collect()
}

/// The distance of a border's point from the nearest other border.
pub(crate) fn nearest_other(borders: &Borders, border: usize, t: f64) -> Option<f64> {
    let p = borders.all[border].curve.point(t);
    // The curve is evaluated only where its chord is nearer than the best distance so far.
    let mut best = f64::INFINITY;
    borders.tree.nearest(p, f64::INFINITY, |chord| {
        let (b, k) = borders.chords[chord as usize];
        if b as usize == border {
            return None;
        }
        let other = &borders.all[b as usize];
        let k = k as usize;
        if borders.distance(chord, p) >= best {
            return None;
        }
        let (d, s) = crate::foot::segment_distance(p, other.points[k], other.points[k + 1]);
        let exact = if other.is_straight() {
            d
        } else {
            foot(&other.curve, other.range, p, other.t[k] + (other.t[k + 1] - other.t[k]) * s).1
        };
        best = best.min(exact);
        Some(exact)
    });
    best.is_finite().then_some(best)
}

/// The tolerance from sorted gaps.
pub(crate) fn choose(gaps: &[f64], uncertainty: Option<f64>, diagonal: f64) -> AutoTolerance {
    choose_below(gaps, uncertainty, diagonal, LARGEST_GAP * diagonal)
}

/// The tolerance from sorted gaps, where gaps larger than `cap` are openings.
pub(crate) fn choose_below(gaps: &[f64], uncertainty: Option<f64>, diagonal: f64, cap: f64) -> AutoTolerance {
    let resolution = uncertainty.filter(|u| *u > 0.0 && u.is_finite()).unwrap_or(RESOLUTION * diagonal);
    let resolution = resolution.min(cap / CLEAR).max(16.0 * f64::EPSILON * diagonal);
    let mut values = vec![resolution];
    values.extend(gaps.iter().copied().filter(|&g| g > resolution && g < cap));
    values.push(gaps.iter().copied().find(|&g| g >= cap).map_or(cap, |g| g.min(cap * CLEAR)));
    let ratio = |w: &[f64]| w[1] / w[0];
    // Of two equally wide ranges the upper one: more is sewn.
    let widest = values.windows(2).map(ratio).fold(1.0, f64::max);
    let empty_range =
        values.windows(2).rev().find(|w| ratio(w) >= widest * (1.0 - 1e-9)).unwrap_or(&values[..2]);
    let clear = widest >= CLEAR;
    let tolerance = if clear { empty_range[0] * widest.sqrt().min(MARGIN) } else { resolution };
    let below = gaps.partition_point(|&g| g <= tolerance);
    AutoTolerance {
        tolerance,
        resolution,
        empty_range: [empty_range[0], empty_range[1]],
        clear,
        gaps: [below, gaps.len() - below],
        histogram: histogram(gaps, resolution),
    }
}

fn histogram(gaps: &[f64], resolution: f64) -> Vec<GapBin> {
    let floor = math::pow(10.0, math::log10(resolution).floor() - 3.0);
    let decade = |g: f64| if g < floor { f64::NEG_INFINITY } else { math::log10(g).floor() };
    gaps.chunk_by(|a, b| decade(*a) == decade(*b))
        .map(|chunk| {
            let low = decade(chunk[0]);
            let (from, below) = if low.is_finite() {
                (math::pow(10.0, low), math::pow(10.0, low + 1.0))
            } else {
                (0.0, floor)
            };
            GapBin { from, below, count: chunk.len() }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tolerance_lies_in_the_empty_range() {
        let mut gaps: Vec<f64> = (0..90).map(|i| 1e-6 * f64::from(i)).collect();
        gaps.extend([0.5, 0.7, 3.0]);
        let found = choose(&gaps, None, 100.0);
        assert!(found.clear);
        assert!(found.tolerance > 1e-4 && found.tolerance < 0.2, "{found:?}");
        assert_eq!(found.gaps, [90, 3]);
        assert_eq!(found.histogram.iter().map(|b| b.count).sum::<usize>(), 93);
        // Joints of 0.01 are loose, and there is nothing else before 0.2.
        let loose: Vec<f64> = (0..90).map(|i| 0.01 * f64::from(i) / 90.0).chain([5.0]).collect();
        let found = choose(&loose, Some(1e-3), 100.0);
        assert!(found.tolerance > 0.0099 && found.tolerance < 0.2, "{found:?}");
    }

    #[test]
    fn without_an_empty_range_the_resolution_of_the_file_is_used() {
        let gaps: Vec<f64> = (0..60).map(|i| 1e-4 * math::powi(1.2, i)).collect();
        let found = choose(&gaps, Some(2e-4), 100.0);
        assert!(!found.clear);
        assert_eq!(found.tolerance, 2e-4);
    }
}
