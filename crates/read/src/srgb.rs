//! Colours of files are the sRGB values that a screen shows; the model holds linear ones.

/// The sRGB transfer function, undone.
use chordal_nurbs::math;

pub(crate) fn linear(value: f64) -> f32 {
    let value = value.clamp(0.0, 1.0);
    (if value <= 0.04045 { value / 12.92 } else { math::pow((value + 0.055) / 1.055, 2.4) }) as f32
}

#[cfg(test)]
mod tests {
    use super::linear;

    #[test]
    fn srgb_to_linear() {
        assert_eq!(linear(0.0), 0.0);
        assert_eq!(linear(1.0), 1.0);
        assert!((linear(0.5) - 0.214_041_14).abs() < 1e-6);
        assert_eq!(linear(7.0), 1.0);
    }
}
