//! Placements as files round them.

use chordal_brep::ReadIssue;
use chordal_nurbs::{DAffine3, DVec3, math};
use glam::DMat3;

/// Entries that are off by less than this are rounded ones: the axes are meant to be orthogonal.
const ROUNDED: f64 = 1e-4;

/// A placement from its rows: three of the axes and the shift. Rounded axes are made exactly orthogonal
/// again, with the scale they have in the mean.
///
/// # Errors
/// Where the rows flatten space or are not finite.
pub(crate) fn placement(rows: [[f64; 4]; 3]) -> Result<DAffine3, ReadIssue> {
    let column = |i: usize| DVec3::new(rows[0][i], rows[1][i], rows[2][i]);
    let axes = DMat3::from_cols(column(0), column(1), column(2));
    let determinant = axes.determinant();
    if !(axes.is_finite() && column(3).is_finite()) || determinant.abs() < 1e-100 {
        return Err(ReadIssue::FlatPlacement);
    }
    let scale = math::cbrt(determinant.abs());
    let mut unit = axes * (1.0 / scale);
    let off = (unit * unit.transpose() - DMat3::IDENTITY).to_cols_array();
    if !off.iter().all(|d| d.abs() < ROUNDED) {
        return Ok(DAffine3::from_mat3_translation(axes, column(3)));
    }
    // Newton's iteration to the nearest orthogonal matrix; it converges quadratically from here.
    for _ in 0..4 {
        unit = (unit + unit.transpose().inverse()) * 0.5;
    }
    let scale = if (scale - 1.0).abs() < ROUNDED { 1.0 } else { scale };
    Ok(DAffine3::from_mat3_translation(unit * scale, column(3)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_axes_become_orthogonal() {
        let rows = [[0.9239, -0.3827, 0.0, 3.0], [0.3827, 0.9239, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        let m = placement(rows).expect("sound").matrix3;
        let off = (m * m.transpose() - DMat3::IDENTITY).to_cols_array();
        assert!(off.iter().all(|d| d.abs() < 1e-15), "{off:?}");
    }

    #[test]
    fn distortions_stay() {
        let rows = [[2.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0]];
        assert_eq!(placement(rows).expect("sound").matrix3.x_axis, DVec3::X * 2.0);
        assert!(placement([[0.0; 4]; 3]).is_err());
    }
}
