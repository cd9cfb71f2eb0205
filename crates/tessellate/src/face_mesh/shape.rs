//! How curved a face is: whether its boundary suffices, strips suffice, or points are needed inside.

use crate::face_context::FaceContext;
use crate::limits::Limits;
use crate::metric::Sizing;
use crate::triangulate::sweep;
use chordal_chart::Chart;
use chordal_nurbs::{DVec2, Surface, UvBox};

/// How the interior is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Flat,
    /// Curved in one parameter only and straight in the other: the boundary suffices.
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
    match context.trimmed.surface.surface {
        Surface::Plane { .. } => Shape::Flat,
        Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Extrusion { .. } => {
            Shape::Singly { axis: 0 }
        }
        Surface::Sphere { .. } | Surface::Torus { .. } => Shape::Doubly,
        _ => sampled_shape(context, limits, uv_box),
    }
}

/// Samples of a free surface in each direction, to find out whether it is curved. Bends between them are
/// missed: then the proof inserts points.
const SAMPLES: usize = 6;

/// A direction that needs fewer chords than this across the whole face is straight.
const STRAIGHT: f64 = 0.05;

/// A free surface is singly curved where its metric across one parameter stays far below one chord
/// everywhere.
fn sampled_shape(context: &FaceContext<'_, '_>, limits: &Limits, uv_box: UvBox) -> Shape {
    let extent = chords_across(context, limits, uv_box);
    match (extent[0] < STRAIGHT, extent[1] < STRAIGHT) {
        (true, true) => Shape::Flat,
        (false, true) => Shape::Singly { axis: 0 },
        (true, false) => Shape::Singly { axis: 1 },
        _ => Shape::Doubly,
    }
}

/// About how many chords a face takes along u and along v.
fn chords_across(context: &FaceContext<'_, '_>, limits: &Limits, uv_box: UvBox) -> [f64; 2] {
    let mut extent = [0.0f64; 2];
    for i in 0..SAMPLES {
        let mut sum = [0.0; 2];
        for j in 0..SAMPLES {
            for axis in 0..2 {
                let (a, b) = if axis == 0 { (j, i) } else { (i, j) };
                let at = DVec2::new((a as f64 + 0.5) / SAMPLES as f64, (b as f64 + 0.5) / SAMPLES as f64);
                let jet = context.trimmed.surface.jet(uv_box.min + uv_box.size() * at);
                let Some(s) = Sizing::new(&jet, limits) else { continue };
                let mut d = DVec2::ZERO;
                d[axis] = uv_box.size()[axis] / SAMPLES as f64;
                sum[axis] += s.metric.length(d);
            }
        }
        for axis in 0..2 {
            extent[axis] = extent[axis].max(sum[axis]);
        }
    }
    extent
}

/// A face that takes this many times as many chords along v as along u is swept along v. A smaller factor
/// would change the triangles of faces that do not need it.
const LONG: f64 = 32.0;

/// The parameter along which the boundary is swept into triangles: that in which the face is curved, or much
/// longer.
///
/// Swept across, a long helical strip would begin with triangles over all its turns, which no flips undo in a
/// reasonable time.
pub(crate) fn sweep_axis(
    context: &FaceContext<'_, '_>,
    limits: &Limits,
    uv_box: UvBox,
    shape: Shape,
) -> usize {
    match shape {
        Shape::Singly { axis } => axis,
        Shape::Doubly if !context.trimmed.surface.is_elementary() => {
            let [u, v] = chords_across(context, limits, uv_box);
            usize::from(v > LONG * u.max(1.0))
        }
        _ => 0,
    }
}

pub(crate) fn boundary_triangles(
    points: &[DVec2],
    chart: &Chart,
    axis: usize,
) -> Result<Vec<[u32; 3]>, Vec<u32>> {
    let result = if axis == 1 {
        // A quarter turn keeps the orientation and makes v the direction of the sweep.
        let turned: Vec<DVec2> = points.iter().map(|p| DVec2::new(p.y, -p.x)).collect();
        sweep(&turned, &chart.loops)
    } else {
        sweep(points, &chart.loops)
    };
    result.map_err(|e| vec![e.edge, e.vertex])
}
