//! The transfer function of sRGB (IEC 61966-2-1).

/// Linear light of an sRGB value, both 0..=1.
use chordal_nurbs::math;

pub(crate) fn linear(srgb: f64) -> f64 {
    if srgb <= 0.04045 { srgb / 12.92 } else { math::pow((srgb + 0.055) / 1.055, 2.4) }
}

/// The sRGB value of linear light, both 0..=1.
pub(crate) fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * math::pow(linear, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_and_linear_are_inverse() {
        for k in 0..=255 {
            let x = f64::from(k) / 255.0;
            assert!((srgb(linear(x)) - x).abs() < 1e-6);
        }
    }
}
