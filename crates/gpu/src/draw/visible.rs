//! What a view may show: rejection of parts and faces by bounds that hold them, and of backs by cones of
//! normals.

use super::camera::Camera;
use super::choice::PIXEL_ERROR;
use super::shapes::Scenery;
use crate::faces::TrimmedFace;
use chordal_nurbs::math;
use glam::{DAffine3, DVec3, DVec4};
use std::ops::Range;

/// Lines and borders reach this many pixels beyond the faces that they belong to.
const REACH: f64 = 4.0;
/// Placements whose errors differ by more than this are sampled apart.
const CLASS: f64 = 4.0;

/// The four sides of what a camera sees, in the axes of the view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frustum {
    /// Inside: normal · p + offset ≥ 0.
    planes: [DVec4; 4],
    camera: Camera,
}

impl Frustum {
    /// Of a picture of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let rows = camera.projection.transpose();
        let margin = size.map(|s| 1.0 + 2.0 * REACH / f64::from(s));
        let planes = [
            rows.w_axis * margin[0] + rows.x_axis,
            rows.w_axis * margin[0] - rows.x_axis,
            rows.w_axis * margin[1] + rows.y_axis,
            rows.w_axis * margin[1] - rows.y_axis,
        ];
        Self { planes, camera: *camera }
    }

    /// Rejects nothing.
    pub fn all(camera: &Camera) -> Self {
        Self { planes: [DVec4::W; 4], camera: *camera }
    }

    /// False only where no point of the box can be in the picture.
    pub fn may_show(&self, to_view: &DAffine3, [low, high]: [DVec3; 2]) -> bool {
        let middle = to_view.transform_point3(0.5 * (low + high));
        let half = 0.5 * (high - low);
        let m = to_view.matrix3;
        self.planes.iter().all(|plane| {
            let n = plane.truncate();
            let reach = n.dot(m.x_axis).abs() * half.x
                + n.dot(m.y_axis).abs() * half.y
                + n.dot(m.z_axis).abs() * half.z;
            n.dot(middle) + plane.w + reach >= 0.0
        })
    }

    /// True only where every point of the box is in the picture.
    fn holds(&self, to_view: &DAffine3, [low, high]: [DVec3; 2]) -> bool {
        let corner = |k: usize| DVec3::from_array([0, 1, 2].map(|axis| [low, high][k >> axis & 1][axis]));
        let in_view = |k: usize| to_view.transform_point3(corner(k));
        (0..8).all(|k| self.planes.iter().all(|plane| plane.truncate().dot(in_view(k)) + plane.w >= 0.0))
    }

    /// True where the face shows its back alone, and lies on a closed shell that is seen from outside.
    pub fn faces_away(&self, eye: &Eye, face: &TrimmedFace) -> bool {
        let (Some(cone), Some([low, high])) = (face.outward, face.bounds) else { return false };
        match *eye {
            Eye::Inside => false,
            Eye::Direction(to_eye) => cone.turns_away(to_eye, 0.0),
            Eye::At(eye) => {
                let (middle, radius) = (0.5 * (low + high), 0.5 * low.distance(high));
                let to_eye = eye - middle;
                radius < to_eye.length() && cone.turns_away(to_eye, math::asin(radius / to_eye.length()))
            }
        }
    }
}

/// Where the eye is, seen from a part.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Eye {
    /// In this direction, infinitely far.
    Direction(DVec3),
    At(DVec3),
    /// Within the part, or so near that the picture may begin within it.
    Inside,
}

impl Eye {
    /// For a part about `middle`; `to_view` is its placement.
    fn of(camera: &Camera, to_view: &DAffine3, middle: DVec3, radius: f64) -> Self {
        let from_view = to_view.inverse();
        if !from_view.is_finite() {
            return Self::Inside;
        }
        let Some(distance) = camera.distance else {
            return Self::Direction(from_view.transform_vector3(DVec3::Z));
        };
        let eye = from_view.transform_point3(DVec3::Z * distance);
        let nearest = to_view.transform_point3(middle).z + radius * scale_of(to_view);
        // The picture begins at a thousandth of the distance at most, where it does not begin before all
        // parts.
        let clear = nearest < distance * (1.0 - 2e-3);
        if clear && eye.distance(middle) > radius { Self::At(eye) } else { Self::Inside }
    }
}

/// One shape's visible placements that are sampled alike: a range of those in the view's buffer.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    pub shape: usize,
    /// Of errors; placements of one shape in the same class share samples.
    pub class: i32,
    /// The smallest of its errors, in the part's units.
    pub error: f64,
    pub placed: Range<u32>,
    /// Every placement is in the picture as a whole.
    pub whole: bool,
    /// Placements to view, for rejecting faces; empty if they are too many to be tested one by one.
    views: Vec<(DAffine3, Eye)>,
}

/// Above this number, placements are not tested face by face.
const ASKED: usize = 16;

impl Level {
    /// Whether some placement may show the face: in the picture, and, where backs are left out, from its
    /// outside.
    pub fn shows(&self, frustum: &Frustum, face: &TrimmedFace, leave_out_backs: bool) -> Shown {
        if self.whole && !(leave_out_backs && face.outward.is_some()) {
            return Shown::Yes;
        }
        let Some(bounds) = face.bounds.filter(|_| !self.views.is_empty()) else { return Shown::Yes };
        let mut found = Shown::Outside;
        for (to_view, eye) in &self.views {
            if !frustum.may_show(to_view, bounds) {
                continue;
            }
            if !(leave_out_backs && frustum.faces_away(eye, face)) {
                return Shown::Yes;
            }
            found = Shown::Back;
        }
        found
    }
}

/// Why a face is not drawn, if so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    Yes,
    /// Of the frustum.
    Outside,
    Back,
}

/// The placements that a view may show, ordered as its buffer holds them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Visible {
    /// Indices into the scenery's placements.
    pub order: Vec<usize>,
    pub levels: Vec<Level>,
    /// Per shape all its visible placements.
    pub placed: Vec<Range<u32>>,
}

impl Visible {
    /// Of the placements of a scenery; `boxes` hold the shapes.
    pub fn new(scenery: &Scenery, boxes: &[[DVec3; 2]], frustum: &Frustum) -> Self {
        let camera = &frustum.camera;
        let mut visible = Self { placed: vec![0..0; scenery.shapes.len()], ..Self::default() };
        let mut first = 0;
        for of_shape in scenery.placed.chunk_by(|a, b| a.shape == b.shape) {
            let shape = of_shape[0].shape;
            let mut seen: Vec<(f64, usize, DAffine3)> = Vec::new();
            for (k, placed) in of_shape.iter().enumerate() {
                let to_view = camera.view * placed.world;
                if frustum.may_show(&to_view, boxes[shape]) {
                    let s = &scenery.shapes[shape];
                    seen.push((error_of(camera, &to_view, s.middle, s.radius), first + k, to_view));
                }
            }
            first += of_shape.len();
            visible.push(scenery, boxes, frustum, shape, seen);
        }
        visible
    }

    fn push(
        &mut self,
        scenery: &Scenery,
        boxes: &[[DVec3; 2]],
        frustum: &Frustum,
        shape: usize,
        mut seen: Vec<(f64, usize, DAffine3)>,
    ) {
        let (camera, start) = (&frustum.camera, self.order.len() as u32);
        let (low, high) = seen.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), s| (l.min(s.0), h.max(s.0)));
        let classes = high > CLASS * low;
        let class_of =
            |error: f64| if classes { (math::ln(error) / math::ln(CLASS)).floor() as i32 } else { i32::MAX };
        if classes {
            // Nearest first: fragments behind them then fail the depth test early.
            seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        let s = &scenery.shapes[shape];
        for alike in seen.chunk_by(|a, b| class_of(a.0) == class_of(b.0)) {
            let placed = self.order.len() as u32..(self.order.len() + alike.len()) as u32;
            let asked = if alike.len() <= ASKED { alike } else { &[] };
            let views = asked
                .iter()
                .map(|(_, _, to_view)| (*to_view, Eye::of(camera, to_view, s.middle, s.radius)))
                .collect();
            let error = alike.iter().map(|s| s.0).fold(f64::INFINITY, f64::min);
            self.order.extend(alike.iter().map(|s| s.1));
            let whole = asked.iter().all(|(_, _, to_view)| frustum.holds(to_view, boxes[shape]));
            self.levels.push(Level { shape, class: class_of(error), error, placed, whole, views });
        }
        self.placed[shape] = start..self.order.len() as u32;
    }
}

fn scale_of(to_view: &DAffine3) -> f64 {
    let m = to_view.matrix3;
    m.x_axis.length().max(m.y_axis.length()).max(m.z_axis.length())
}

/// The error allowed in the units of a part that is placed so.
fn error_of(camera: &Camera, to_view: &DAffine3, middle: DVec3, radius: f64) -> f64 {
    let scale = scale_of(to_view);
    let at = to_view.transform_point3(middle);
    // Nearer things are larger, but what is behind the eye is not seen.
    let nearer = camera.distance.map_or(1.0, |d| ((d - at.z - radius * scale) / d).max(0.02));
    PIXEL_ERROR * camera.pixel * nearer / scale
}
