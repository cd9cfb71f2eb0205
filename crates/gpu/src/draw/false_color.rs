//! Colours for values on faces: the curvature of the exact surface, or the distance of the mesh from it.

use chordal_nurbs::{DVec2, DVec3, Surface, math};

/// The mean curvature at `uv` for the unit normal given; `None` where the surface has no tangent plane.
pub(crate) fn mean_curvature(surface: &Surface, uv: DVec2, normal: DVec3) -> Option<f64> {
    let jet = surface.jet(uv);
    let (e, f, g) = (jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.dv.dot(jet.dv));
    let (l, m, n) = (jet.duu.dot(normal), jet.duv.dot(normal), jet.dvv.dot(normal));
    let area = e * g - f * f;
    // Towards a pole the area element vanishes; there it holds rounding errors only.
    let regular = area > 1e-12 * math::square(e.max(g));
    // A convex outside bends away from its normal.
    regular.then(|| -(e * n - 2.0 * f * m + g * l) / (2.0 * area)).filter(|h| h.is_finite())
}

/// The distance of a point of a facet from the surface along the surface's normal at the facet's parameters
/// there.
pub(crate) fn distance(surface: &Surface, uv: DVec2, p: DVec3) -> f64 {
    let offset = surface.point(uv) - p;
    surface.normal(uv).map_or(offset.length(), |n| offset.dot(n).abs())
}

/// From blue over pale grey to red, -1..=1.
pub(crate) fn diverging(x: f64) -> [u8; 4] {
    let stops = [[38, 84, 178], [120, 166, 222], [228, 229, 231], [236, 150, 110], [176, 26, 40]];
    ramp(&stops, 0.5 + 0.5 * x)
}

/// From dark blue over green to yellow, 0..=1.
pub(crate) fn sequential(x: f64) -> [u8; 4] {
    let stops = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
    ramp(&stops, x)
}

fn ramp(stops: &[[u8; 3]; 5], x: f64) -> [u8; 4] {
    let x = if x.is_finite() { x.clamp(0.0, 1.0) * 4.0 } else { 0.0 };
    let (k, t) = ((x as usize).min(3), x - f64::from((x as u32).min(3)));
    let mix = |c: usize| (f64::from(stops[k][c]) * (1.0 - t) + f64::from(stops[k + 1][c]) * t).round() as u8;
    [mix(0), mix(1), mix(2), 0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::Frame;

    #[test]
    fn a_sphere_bends_by_one_over_its_radius() {
        let frame = Frame::new(DVec3::ONE, DVec3::Z, DVec3::X);
        let sphere = Surface::Sphere { frame, radius: 4.0 };
        let uv = DVec2::new(1.0, 0.3);
        let n = sphere.normal(uv).unwrap();
        assert!((mean_curvature(&sphere, uv, n).unwrap() - 0.25).abs() < 1e-12);
        assert!((mean_curvature(&sphere, uv, -n).unwrap() + 0.25).abs() < 1e-12);
        let p = sphere.point(uv) + 0.125 * n;
        assert!((distance(&sphere, uv, p) - 0.125).abs() < 1e-12);
    }

    #[test]
    fn ramps_run_from_end_to_end() {
        assert_eq!(sequential(0.0), [68, 1, 84, 0]);
        assert_eq!(sequential(2.0), [253, 231, 37, 0]);
        assert_eq!(diverging(0.0), [228, 229, 231, 0]);
        assert_eq!(diverging(f64::NAN), [38, 84, 178, 0]);
    }
}
