//! Colours: linear in the scene and in glTF, sRGB bytes in the other formats.

use chordal_mesh::Rgba;

/// The colour of faces without one, in formats that require a colour.
pub(crate) const UNCOLORED: Rgba = [0.6, 0.6, 0.6, 1.0];

/// A colour's bits, to order and compare by.
pub(crate) type ColorKey = [u32; 4];

pub(crate) fn key(color: Rgba) -> ColorKey {
    color.map(f32::to_bits)
}

/// A colour with every part between 0 and 1; what is not a number becomes 0 (1 for opacity).
pub(crate) fn clamped(color: Rgba) -> Rgba {
    let part = |c: f32, missing: f32| if c.is_nan() { missing } else { c.clamp(0.0, 1.0) };
    [part(color[0], 0.0), part(color[1], 0.0), part(color[2], 0.0), part(color[3], 1.0)]
}

/// The standard transfer function (IEC 61966-2-1), linear to sRGB.
pub(crate) fn srgb(linear: f32) -> f64 {
    let c = f64::from(linear);
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * libm::pow(c, 1.0 / 2.4) - 0.055 }
}

/// sRGB bytes with opacity.
pub(crate) fn srgb_bytes(color: Rgba) -> [u8; 4] {
    let [r, g, b, a] = clamped(color);
    let byte = |c: f64| (c * 255.0).round() as u8;
    [byte(srgb(r)), byte(srgb(g)), byte(srgb(b)), byte(f64::from(a))]
}

/// `RRGGBB`, with `AA` after it unless opaque.
pub(crate) fn hex(color: Rgba) -> String {
    let [r, g, b, a] = srgb_bytes(color);
    if a == 255 { format!("{r:02X}{g:02X}{b:02X}") } else { format!("{r:02X}{g:02X}{b:02X}{a:02X}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_of_known_values() {
        assert_eq!(srgb_bytes([0.0, 1.0, 0.214_041_14, 0.5]), [0, 255, 128, 128]);
        assert_eq!(hex([1.0, 0.0, 0.0, 1.0]), "FF0000");
        assert_eq!(srgb_bytes([f32::NAN, 7.0, -1.0, f32::NAN]), [0, 255, 0, 255]);
    }
}
