//! The camera: where the eye is, and what fits into the picture.

use crate::error::OptionError;
use chordal_nurbs::math;
use glam::{DAffine3, DMat3, DMat4, DVec3, DVec4};
use std::str::FromStr;

/// The kind of projection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    #[default]
    /// Without perspective.
    Orthographic,
    /// With an angle of 30° from the lower to the upper border.
    Perspective,
}

/// The angle of perspective pictures from the lower to the upper border.
const FIELD_OF_VIEW: f64 = std::f64::consts::PI / 6.0;

/// A direction to look from, or the exact place. Z is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// From this direction, fitted to the model.
    From {
        /// From the model to the eye.
        direction: DVec3,
        /// What is up in the picture.
        up: DVec3,
    },
    /// From `eye` to `target`, millimetres.
    At {
        /// Where the eye is.
        eye: DVec3,
        /// The point that it looks at.
        target: DVec3,
    },
}

/// The named views: the direction from the model to the eye, and what is up.
const NAMED: [(&str, [f64; 3], [f64; 3]); 7] = [
    ("iso", [1.0, -1.0, 0.8], [0.0, 0.0, 1.0]),
    ("top", [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
    ("bottom", [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]),
    ("front", [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]),
    ("back", [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
    ("left", [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ("right", [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
];

impl FromStr for View {
    type Err = OptionError;

    /// A name, or `eye,target`: six numbers, millimetres.
    fn from_str(text: &str) -> Result<Self, OptionError> {
        if let Some((_, direction, up)) = NAMED.iter().find(|(name, ..)| *name == text) {
            return Ok(Self::From { direction: DVec3::from(*direction), up: DVec3::from(*up) });
        }
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse::<f64>()).collect();
        match numbers.as_deref() {
            Ok(&[a, b, c, d, e, f]) if [a, b, c, d, e, f].iter().all(|x| x.is_finite()) => {
                let (eye, target) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
                if eye == target {
                    return Err(OptionError::EyeAtTarget);
                }
                Ok(Self::At { eye, target })
            }
            _ => Err(OptionError::View),
        }
    }
}

/// A camera in double precision: from the world to the view's axes, and from there to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World to view: x right, y up, z towards the eye; the origin is the point looked at.
    pub view: DAffine3,
    /// View to clip space, depth 0 near and 1 far.
    pub projection: DMat4,
    /// Distance of the eye from the origin of the view; `None` where it is infinitely far.
    pub distance: Option<f64>,
    /// Length in the view at its origin that one pixel covers.
    pub pixel: f64,
}

impl Camera {
    /// Looks at the points, all of which end up in the picture of `size` pixels with a margin; `zoom` above 1
    /// comes nearer. A camera at a place of its own is moved only if `fit` is set.
    pub fn looking_at(
        view: View,
        projection: Projection,
        points: &[DVec3],
        size: [u32; 2],
        zoom: f64,
        fit: bool,
    ) -> Self {
        let (low, high) = bounds(points.iter().copied());
        let (direction, up, target) = match view {
            View::From { direction, up } => (direction.normalize_or(DVec3::Z), up, 0.5 * (low + high)),
            View::At { eye, target } => {
                let direction = (eye - target).normalize_or(DVec3::Z);
                (direction, if direction.z.abs() > 0.999 { DVec3::Y } else { DVec3::Z }, target)
            }
        };
        let fitted = fit || matches!(view, View::From { .. });
        let right = up.cross(direction).normalize_or(DVec3::X);
        let axes = DMat3::from_cols(right, direction.cross(right), direction).transpose();
        let to_view = |origin: DVec3| DAffine3::from_mat3_translation(axes, -(axes * origin));
        let origin = if fitted { middle(points, axes) } else { target };
        let view_of = to_view(origin);
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let (half, depth) = extent(points, &view_of, aspect);
        let slope = math::tan(0.5 * FIELD_OF_VIEW);
        let margin = 1.05 / zoom;
        let perspective = projection == Projection::Perspective;
        let distance = match view {
            View::At { eye, target } if !fitted => eye.distance(target) / zoom,
            _ if perspective => distance_for(points, &view_of, aspect, slope) * margin,
            _ => half * margin / slope,
        };
        let half = distance * slope;
        let reach = depth * 1.01 + 1e-9 * (1.0 + distance);
        let (near, far) = if perspective {
            ((distance - reach).max(1e-3 * distance), distance + reach)
        } else {
            (-reach, reach)
        };
        let projection = if perspective {
            perspective_matrix([slope * aspect, slope], near, far, distance)
        } else {
            orthographic_matrix([half * aspect, half], near, far)
        };
        Self {
            view: view_of,
            projection,
            distance: perspective.then_some(distance),
            pixel: 2.0 * half / f64::from(size[1]),
        }
    }
}

/// From a view whose eye is at z = `distance`; `slopes` are those of the right and upper border. Depth 0 near
/// and 1 far.
fn perspective_matrix(slopes: [f64; 2], near: f64, far: f64, distance: f64) -> DMat4 {
    let depth = far / (far - near);
    DMat4::from_cols(
        DVec4::new(1.0 / slopes[0], 0.0, 0.0, 0.0),
        DVec4::new(0.0, 1.0 / slopes[1], 0.0, 0.0),
        DVec4::new(0.0, 0.0, -depth, -1.0),
        DVec4::new(0.0, 0.0, depth * (distance - near), distance),
    )
}

/// From a view seen along -z, its origin in the middle; `near` and `far` are distances along -z.
fn orthographic_matrix(half: [f64; 2], near: f64, far: f64) -> DMat4 {
    let depth = 1.0 / (far - near);
    DMat4::from_cols(
        DVec4::new(1.0 / half[0], 0.0, 0.0, 0.0),
        DVec4::new(0.0, 1.0 / half[1], 0.0, 0.0),
        DVec4::new(0.0, 0.0, -depth, 0.0),
        DVec4::new(0.0, 0.0, -near * depth, 1.0),
    )
}

/// The box of the points; of none, a unit about the origin.
pub(crate) fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points
        .map(|p| (p, p))
        .reduce(|(low, high), (p, _)| (low.min(p), high.max(p)))
        .unwrap_or((DVec3::splat(-0.5), DVec3::splat(0.5)))
}

/// The middle of the points' box along the axes, in the world.
fn middle(points: &[DVec3], axes: DMat3) -> DVec3 {
    let (low, high) = bounds(points.iter().map(|p| axes * *p));
    axes.transpose() * (0.5 * (low + high))
}

/// Half the height that holds all points, and how far they reach along the line of sight.
fn extent(points: &[DVec3], view: &DAffine3, aspect: f64) -> (f64, f64) {
    let mut found = (1e-12_f64, 1e-12_f64);
    for p in points {
        let p = view.transform_point3(*p);
        found.0 = found.0.max(p.y.abs()).max(p.x.abs() / aspect);
        found.1 = found.1.max(p.z.abs());
    }
    found
}

/// The distance of the eye from which all points are seen.
fn distance_for(points: &[DVec3], view: &DAffine3, aspect: f64, slope: f64) -> f64 {
    let needs = points.iter().map(|p| {
        let p = view.transform_point3(*p);
        p.z + p.y.abs().max(p.x.abs() / aspect) / slope
    });
    needs.fold(1e-9, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners() -> Vec<DVec3> {
        (0..8)
            .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1) * 3.0, f64::from(i >> 2) * 2.0) + 1e6)
            .collect()
    }

    /// Every view fits the model: all corners inside, one near the border, in front of the eye.
    #[test]
    fn named_views_fit_the_model() {
        for (name, ..) in NAMED {
            for projection in [Projection::Orthographic, Projection::Perspective] {
                let view = name.parse().unwrap();
                let camera = Camera::looking_at(view, projection, &corners(), [640, 400], 1.0, true);
                let mut reach = 0.0_f64;
                for p in corners() {
                    let clip = camera.projection * camera.view.transform_point3(p).extend(1.0);
                    let ndc = clip.truncate() / clip.w;
                    assert!(ndc.x.abs() < 1.0 && ndc.y.abs() < 1.0, "{name} {ndc}");
                    assert!(ndc.z > 0.0 && ndc.z < 1.0, "{name} {ndc}");
                    reach = reach.max(ndc.x.abs()).max(ndc.y.abs());
                }
                assert!(reach > 0.85, "{name} {reach}");
            }
        }
    }

    #[test]
    fn the_front_is_seen_from_below_y() {
        let camera = Camera::looking_at(
            "front".parse().unwrap(),
            Projection::default(),
            &corners(),
            [100, 100],
            1.0,
            true,
        );
        let right = camera.view.transform_vector3(DVec3::X);
        let up = camera.view.transform_vector3(DVec3::Z);
        assert!(right.abs_diff_eq(DVec3::X, 1e-12) && up.abs_diff_eq(DVec3::Y, 1e-12));
    }

    #[test]
    fn a_camera_is_a_name_or_six_numbers() {
        assert!("1,2,3,4,5,6".parse::<View>().is_ok());
        for text in ["", "1,2,3", "1,2,3,1,2,3", "nan,0,0,1,1,1", "corner"] {
            assert!(text.parse::<View>().is_err(), "{text}");
        }
    }
}
