//! Transcendental functions and powers that give the same bits on every platform.
//!
//! The standard library's sine is that of the platform's C library, and those differ in the last bit: a mesh
//! would depend on the machine that made it. These come from the crate `libm`, which is Rust alone.
//! `clippy.toml` refuses the standard library's. Square roots, absolute values, rounding and `mul_add` are
//! exact everywhere, so they stay methods of `f64`.

use glam::{DQuat, DVec2, DVec3};

macro_rules! from_libm {
    ($($(#[$doc:meta])* $name:ident($($argument:ident),+) = $function:path;)+) => {
        $($(#[$doc])*
        #[inline]
        pub fn $name($($argument: f64),+) -> f64 {
            $function($($argument),+)
        })+
    };
}

from_libm! {
    /// The sine of an angle.
    sin(angle) = libm::sin;
    /// The cosine of an angle.
    cos(angle) = libm::cos;
    /// The tangent of an angle.
    tan(angle) = libm::tan;
    /// The angle from −π/2 to π/2 with this sine.
    asin(sine) = libm::asin;
    /// The angle from 0 to π with this cosine.
    acos(cosine) = libm::acos;
    /// The angle from −π/2 to π/2 with this tangent.
    atan(tangent) = libm::atan;
    /// The angle of the point (x, y), from −π to π.
    atan2(y, x) = libm::atan2;
    /// The hyperbolic sine.
    sinh(x) = libm::sinh;
    /// The hyperbolic cosine.
    cosh(x) = libm::cosh;
    /// The hyperbolic tangent.
    tanh(x) = libm::tanh;
    /// The inverse of the hyperbolic sine.
    asinh(x) = libm::asinh;
    /// The inverse of the hyperbolic tangent.
    atanh(x) = libm::atanh;
    /// The natural logarithm.
    ln(x) = libm::log;
    /// The logarithm to base 2.
    log2(x) = libm::log2;
    /// The logarithm to base 10.
    log10(x) = libm::log10;
    /// `base` to any power.
    pow(base, exponent) = libm::pow;
    /// The cube root.
    cbrt(x) = libm::cbrt;
    /// √(x² + y²), without overflow or underflow in between.
    hypot(x, y) = libm::hypot;
}

/// The sine and the cosine of an angle.
#[inline]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// The unit vector at an angle from the first axis.
#[inline]
pub fn direction(angle: f64) -> DVec2 {
    let (sine, cosine) = sin_cos(angle);
    DVec2::new(cosine, sine)
}

/// The angle between two vectors, from 0 to π; also exact to rounding where it is small.
#[inline]
pub fn angle_between(a: DVec3, b: DVec3) -> f64 {
    atan2(a.cross(b).length(), a.dot(b))
}

/// The angle by which `from` turns, anticlockwise, into `to`, from −π to π.
#[inline]
pub fn angle_to(from: DVec2, to: DVec2) -> f64 {
    atan2(from.perp_dot(to), from.dot(to))
}

/// The rotation about a unit vector, anticlockwise where the vector points to the eye.
pub fn rotation(axis: DVec3, angle: f64) -> DQuat {
    let (sine, cosine) = sin_cos(0.5 * angle);
    DQuat::from_vec4((axis * sine).extend(cosine))
}

/// x².
#[inline]
pub fn square(x: f64) -> f64 {
    x * x
}

/// `base` to a whole power, by repeated squaring. The order of the multiplications, and so the rounding, is
/// fixed; that of the standard library's `powi` is not.
#[inline]
pub fn powi(base: f64, exponent: i32) -> f64 {
    let (mut result, mut factor, mut bits) = (1.0, base, exponent.unsigned_abs());
    while bits > 0 {
        if bits % 2 == 1 {
            result *= factor;
        }
        factor *= factor;
        bits /= 2;
    }
    if exponent < 0 { 1.0 / result } else { result }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A number that depends on every bit of a function's values at 2000 places from `low` to `high`.
    fn fingerprint(low: f64, high: f64, function: fn(f64) -> f64) -> u64 {
        (0..2000).fold(0, |hash: u64, k| {
            let value = function(low + (high - low) * f64::from(k) / 1999.0);
            (hash.rotate_left(5) ^ value.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        })
    }

    /// Written down once. Where another platform or another version of `libm` gives another bit, meshes
    /// change.
    #[test]
    fn the_bits_are_those_of_every_platform() {
        let functions: [(&str, u64, u64); 20] = [
            ("sin", fingerprint(-20.0, 20.0, sin), 0xb690_5c62_9b88_95e5),
            ("cos", fingerprint(-20.0, 20.0, cos), 0x4904_6919_baaf_eed0),
            ("tan", fingerprint(-20.0, 20.0, tan), 0xb89e_fc7b_debe_edf8),
            (
                "sin_cos",
                fingerprint(-20.0, 20.0, |x| sin_cos(x).0 + 3.0 * sin_cos(x).1),
                0x8620_2248_75e7_5f5f,
            ),
            ("asin", fingerprint(-1.0, 1.0, asin), 0xd784_271b_75c3_202b),
            ("acos", fingerprint(-1.0, 1.0, acos), 0xc54e_7f1c_7c60_dfe0),
            ("atan", fingerprint(-20.0, 20.0, atan), 0x8e92_4dbb_1056_5a53),
            ("atan2", fingerprint(-20.0, 20.0, |x| atan2(1.0 - x, x)), 0x3cc5_8bdb_6576_2fd1),
            ("sinh", fingerprint(-20.0, 20.0, sinh), 0xdba4_046c_1c29_d97c),
            ("cosh", fingerprint(-20.0, 20.0, cosh), 0xe708_a23e_bec9_afed),
            ("tanh", fingerprint(-5.0, 5.0, tanh), 0xd927_b7d0_3365_ef4f),
            ("asinh", fingerprint(-20.0, 20.0, asinh), 0x5c43_9cb5_f0fa_5358),
            ("atanh", fingerprint(-0.99, 0.99, atanh), 0x1cfb_99df_8252_5a0c),
            ("ln", fingerprint(0.001, 1000.0, ln), 0xd4e1_0ea2_3117_1092),
            ("log2", fingerprint(0.001, 1000.0, log2), 0x83fe_99ef_f1cd_3af0),
            ("log10", fingerprint(0.001, 1000.0, log10), 0x5f8e_e9a3_efb2_eca8),
            ("pow", fingerprint(0.001, 20.0, |x| pow(x, 2.4)), 0x4ce4_b95f_c4a3_d153),
            ("cbrt", fingerprint(-20.0, 20.0, cbrt), 0xcd4d_0585_f045_7c16),
            ("hypot", fingerprint(-20.0, 20.0, |x| hypot(x, 3.0)), 0x2dbb_86f9_453a_4b26),
            ("powi", fingerprint(-2.0, 2.0, |x| powi(x, 11) + powi(x + 5.0, -7)), 0xc7cb_0897_32a2_cb31),
        ];
        for (name, found, expected) in functions {
            assert_eq!(found, expected, "{name}: {found:#x}");
        }
    }

    proptest! {
        #[test]
        fn whole_powers_are_those_of_the_logarithm(base in 0.1..10.0, exponent in -20..20) {
            let expected = pow(base, f64::from(exponent));
            prop_assert!((powi(base, exponent) - expected).abs() <= 1e-14 * expected);
            prop_assert_eq!(powi(-base, exponent),
                if exponent % 2 == 0 { 1.0 } else { -1.0 } * powi(base, exponent));
        }

        #[test]
        fn angles_between_directions(a in -3.0..3.0, b in -3.0..3.0) {
            let turn: f64 = a - b;
            let expected = turn.abs().min(std::f64::consts::TAU - turn.abs());
            prop_assert!((angle_between(direction(a).extend(0.0), direction(b).extend(0.0)) - expected)
                .abs() < 1e-14);
        }
    }
}
