//! How steep the surface can be against its facet, and how much its image can be distorted in the facet's
//! plane.

use super::setting::{Modelled, Setting};
use crate::math;
use glam::DVec2;

/// What a changing weight adds to the slope of (g/w): at most |g/w|·|w'|/w per length.
pub(super) fn weight_slope(setting: &Setting, rate: DVec2, error: f64) -> f64 {
    if rate == DVec2::ZERO {
        return 0.0;
    }
    let along = |i: usize| {
        error * (rate.x * setting.d[i].x.abs() + rate.y * setting.d[i].y.abs()) / setting.length[i]
    };
    (0..3).fold(f64::INFINITY, |best, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        best.min((along(j) + along(k)) * setting.length[j] * setting.length[k] / setting.area2)
    })
}

/// How much the image of T is stretched, sheared or turned in the facet's plane against the facet, at most:
/// |D(S − L)| there, in two directions at right angles. Below 1 the image is a graph over the facet's plane,
/// and its slope is that over T divided by the remainder.
pub(super) fn distortion(setting: &Setting, across: [&Modelled; 2], rate: DVec2) -> f64 {
    let [a, b] = across.map(|f| steepness(f, setting) + weight_distortion(setting, f, rate));
    math::hypot(a, b)
}

/// What a changing weight adds to it: of w·e the error of interpolation leaves out −Σ λ_i λ_j (w_i − w_j)(l_i
/// − l_j), l the coordinate of L; and e itself is divided by the weight.
fn weight_distortion(setting: &Setting, f: &Modelled, rate: DVec2) -> f64 {
    if rate == DVec2::ZERO {
        return 0.0;
    }
    let size = f.cubic.largest() + f.form.reach_along(setting.size) / 8.0;
    let change = rate.dot(setting.size);
    let longest = setting.length.iter().fold(0.0f64, |m, l| m.max(*l));
    let sine = |j: usize, k: usize| setting.area2 / (setting.length[j] * setting.length[k]);
    let product = (0..3).fold(f64::INFINITY, |best, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        best.min(3.0 * change * longest * (1.0 / setting.length[j] + 1.0 / setting.length[k]) / sine(j, k))
    });
    product + weight_slope(setting, rate, size)
}

/// Bounds the slope of S over the facet: f = n·S has a derivative along side ij of at most ½ max(|h_ij|,
/// |h_jk − h_ik|), six times the largest coefficient of the cubic part (a derivative's coefficients are three
/// times differences of two), and the remainder's share; two sides give the gradient.
pub(super) fn steepness(normal: &Modelled, setting: &Setting) -> f64 {
    let Setting { d, length, size, kink, area2, .. } = setting;
    let (h, reach) = (&normal.cubic.h, &normal.form.reach);
    let cubic = 6.0 * normal.cubic.cubic_part();
    let along = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let reach = (reach[0] * size.x + reach[1] * size.y) * d[i].x.abs()
            + (reach[1] * size.x + reach[2] * size.y) * d[i].y.abs();
        let jump = kink.x * d[i].x.abs() + kink.y * d[i].y.abs();
        (0.5 * h[i].abs().max((h[j] - h[k]).abs()) + cubic + reach + jump) / length[i]
    };
    (0..3).fold(f64::INFINITY, |best, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let sine = area2 / (length[j] * length[k]);
        best.min((along(j) + along(k)) / sine)
    })
}
