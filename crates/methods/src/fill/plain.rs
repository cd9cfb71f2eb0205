//! A metric without curvature: the plane of parameters, stretched as the surface is on average.

use chordal_nurbs::{DVec2, UvBox};
use chordal_tessellate::method::{FaceSurface, Metric};

/// The mean first fundamental form, without its mixed part.
pub fn mean_metric(surface: &FaceSurface<'_>, uv_box: UvBox) -> Metric {
    const N: usize = 5;
    let mut sum = Metric::default();
    for i in 0..N * N {
        let at = DVec2::new((i / N) as f64 + 0.5, (i % N) as f64 + 0.5) / N as f64;
        let jet = surface.jet(uv_box.min + uv_box.size() * at);
        let own = Metric { uu: jet.du.length_squared(), uv: 0.0, vv: jet.dv.length_squared() };
        sum = sum.plus(own, 1.0 / (N * N) as f64);
    }
    // A direction in which the surface does not move still gets a width.
    let floor = 1e-12 * (sum.uu + sum.vv);
    Metric { uu: sum.uu.max(floor), uv: 0.0, vv: sum.vv.max(floor) }
}
