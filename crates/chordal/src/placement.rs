//! How often and how large the parts of a model are placed.

use chordal_brep::Model;
use chordal_nurbs::math;
use glam::{DAffine3, DMat3};

/// All placements of one part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartUse {
    /// How often the part is placed.
    pub instances: usize,
    /// The largest factor by which a placement stretches a length of the part on its way to millimetres; 1
    /// where the part is never placed.
    pub scale: f64,
    /// To millimetres, in the order of the tree.
    pub worlds: Vec<DAffine3>,
}

/// The uses of every part of the model, in its order.
pub fn part_uses(model: &Model) -> Vec<PartUse> {
    let mut uses = vec![PartUse { instances: 0, scale: 0.0, worlds: Vec::new() }; model.parts.len()];
    for placement in model.placements() {
        let part = &mut uses[placement.part.index()];
        part.instances += 1;
        part.scale = part.scale.max(largest_scale(placement.world.matrix3));
        part.worlds.push(placement.world);
    }
    for part in uses.iter_mut().filter(|u| !(u.scale > 0.0 && u.scale.is_finite())) {
        part.scale = 1.0;
    }
    uses
}

/// The largest singular value: the closed form for the eigenvalues of MᵀM (Smith 1961).
pub(crate) fn largest_scale(m: DMat3) -> f64 {
    let a = m.transpose() * m;
    let (xx, yy, zz) = (a.x_axis.x, a.y_axis.y, a.z_axis.z);
    let (xy, xz, yz) = (a.y_axis.x, a.z_axis.x, a.z_axis.y);
    let mean = (xx + yy + zz) / 3.0;
    let off = 2.0 * (xy * xy + xz * xz + yz * yz);
    let p =
        ((math::square(xx - mean) + math::square(yy - mean) + math::square(zz - mean) + off) / 6.0).sqrt();
    // A uniform scale, up to rounding: the diagonal has it more accurately than the general formula.
    if p <= 1e-12 * mean {
        return mean.sqrt();
    }
    let b = (a - DMat3::from_diagonal(glam::DVec3::splat(mean))) * (1.0 / p);
    let angle = math::acos((b.determinant() / 2.0).clamp(-1.0, 1.0)) / 3.0;
    (mean + 2.0 * p * math::cos(angle)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    proptest! {
        /// No unit vector is stretched by more, and the bound is reached.
        #[test]
        fn largest_scale_is_the_norm(
            axis in prop::array::uniform3(-1.0..1.0), turn in 0.0..6.0,
            scale in prop::array::uniform3(0.01..100.0),
        ) {
            let turn = math::rotation(DVec3::from(axis).try_normalize().unwrap_or(DVec3::X), turn);
            let [there, back] = [turn, turn.inverse()].map(DMat3::from_quat);
            let m = there * DMat3::from_diagonal(DVec3::from(scale)) * back;
            let expected = scale.iter().fold(0.0_f64, |a, b| a.max(*b));
            prop_assert!((largest_scale(m) - expected).abs() < 1e-7 * expected);
            let mirrored = DMat3::from_quat(turn) * DMat3::from_diagonal(DVec3::new(-2.5, 2.5, 2.5));
            prop_assert!((largest_scale(mirrored) - 2.5).abs() < 1e-12);
        }
    }

    #[test]
    fn scale_of_the_identity_is_one() {
        assert_eq!(largest_scale(DMat3::IDENTITY), 1.0);
    }
}
