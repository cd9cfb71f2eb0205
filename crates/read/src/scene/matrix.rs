//! Transforms as nodes write them.

use super::graph::Node;
use chordal_nurbs::{DAffine3, DVec3, math};
use glam::{DMat4, DQuat};

/// The transform of a `Transform` node: translation · center · rotation · scale (along scaleOrientation) ·
/// −center. Inventor calls the scale `scaleFactor`, VRML and X3D `scale`. Angles are in units of `radians`.
pub(crate) fn of_transform(node: &Node, radians: f64) -> DAffine3 {
    let vector = |name, default: f64| DVec3::from(node.vector(name, [default; 3]));
    let center = vector("center", 0.0);
    let scale_name = if node.field("scaleFactor").is_some() { "scaleFactor" } else { "scale" };
    let scale = vector(scale_name, 1.0);
    let oriented = rotation(node, "scaleOrientation", radians);
    DAffine3::from_translation(vector("translation", 0.0) + center)
        * DAffine3::from_quat(rotation(node, "rotation", radians))
        * DAffine3::from_quat(oriented)
        * DAffine3::from_scale(scale)
        * DAffine3::from_quat(oriented.inverse())
        * DAffine3::from_translation(-center)
}

/// An axis with an angle in units of `radians`.
pub(crate) fn rotation(node: &Node, name: &str, radians: f64) -> DQuat {
    match *node.numbers(name) {
        [x, y, z, angle, ..] if angle.is_finite() => DVec3::new(x, y, z)
            .try_normalize()
            .map_or(DQuat::IDENTITY, |axis| math::rotation(axis, angle * radians)),
        _ => DQuat::IDENTITY,
    }
}

/// Sixteen numbers row by row, points multiplied from the left: the translation is the last row.
pub(crate) fn of_rows(rows: &[f64]) -> DAffine3 {
    match <[f64; 16]>::try_from(rows.get(..16).unwrap_or_default()) {
        Ok(rows) if rows.iter().all(|x| x.is_finite()) => DAffine3::from_mat4(DMat4::from_cols_array(&rows)),
        _ => DAffine3::IDENTITY,
    }
}
