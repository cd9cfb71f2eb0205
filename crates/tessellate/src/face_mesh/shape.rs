//! How curved a face is: whether its boundary suffices, strips do, or points are needed inside.

use crate::chart::FaceContext;
use crate::limits::Limits;
use crate::metric::Sizing;
use crate::triangulate::sweep;
use crate::unroll::Chart;
use chordal_nurbs::{DVec2, Surface, UvBox};

/// How the interior is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Flat,
    /// Curved in one parameter only, straight in the other: the boundary suffices.
    Singly {
        axis: usize,
    },
    Doubly,
}

/// How a face of this surface is filled.
pub(crate) fn shape(context: &FaceContext<'_, '_>, limits: &Limits, uv_box: UvBox) -> Shape {
    if limits.length.is_finite() {
        return Shape::Doubly;
    }
    match context.surface.surface {
        Surface::Plane { .. } => Shape::Flat,
        Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Extrusion { .. } => {
            Shape::Singly { axis: 0 }
        }
        Surface::Sphere { .. } | Surface::Torus { .. } => Shape::Doubly,
        _ => sampled_shape(context, limits, uv_box),
    }
}

/// A free surface is singly curved where its metric across one parameter stays far below one chord everywhere.
fn sampled_shape(context: &FaceContext<'_, '_>, limits: &Limits, uv_box: UvBox) -> Shape {
    const N: usize = 6;
    let mut extent = [0.0f64; 2];
    let mut twist = 0.0f64;
    for i in 0..N {
        let mut sum = [0.0; 2];
        for j in 0..N {
            for axis in 0..2 {
                let (a, b) = if axis == 0 { (j, i) } else { (i, j) };
                let at = DVec2::new((a as f64 + 0.5) / N as f64, (b as f64 + 0.5) / N as f64);
                let jet = context.surface.jet(uv_box.min + uv_box.size() * at);
                let Some(s) = Sizing::new(&jet, limits) else { continue };
                let mut d = DVec2::ZERO;
                d[axis] = uv_box.size()[axis] / N as f64;
                sum[axis] += s.metric.length(d);
                let size = uv_box.size();
                twist = twist.max(s.metric.uv.abs() * size.x * size.y / (N * N) as f64);
            }
        }
        for axis in 0..2 {
            extent[axis] = extent[axis].max(sum[axis]);
        }
    }
    let small = 0.05;
    match (extent[0] < small, extent[1] < small) {
        (true, true) => Shape::Flat,
        (false, true) => Shape::Singly { axis: 0 },
        (true, false) => Shape::Singly { axis: 1 },
        _ => Shape::Doubly,
    }
}

pub(crate) fn boundary_triangles(
    points: &[DVec2],
    chart: &Chart,
    shape: Shape,
) -> Result<Vec<[u32; 3]>, Vec<u32>> {
    let result = if shape == (Shape::Singly { axis: 1 }) {
        // A quarter turn keeps the orientation and makes v the direction of the sweep.
        let turned: Vec<DVec2> = points.iter().map(|p| DVec2::new(p.y, -p.x)).collect();
        sweep(&turned, &chart.loops)
    } else {
        sweep(points, &chart.loops)
    };
    result.map_err(|e| vec![e.edge, e.vertex])
}
