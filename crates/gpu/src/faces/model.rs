//! From the model and its mesh to exact faces: a NURBS form, and loops of cubic pieces in the face's unit
//! square.
//!
//! The mesh supplies what took care to find: the loops of every face in one chart of its parameters, seams
//! and poles among them. Between two samples of an edge the loop is not the chord but a cubic with the
//! directions that the edge's curve has there, carried into the parameters; its distance from the true curve
//! falls with the fourth power of theirs.

use super::cone::{Cone, normal_cone};
use super::edges::EdgeParameters;
use super::outside::outside_faces;
use super::pieces::Cubic;
use chordal_brep::{FaceGeometry, Model};
use chordal_mesh::{FaceMesh, Rgba, Scene};
use chordal_nurbs::{DVec2, DVec3, NurbsParameters, NurbsSurface, Surface, UvBox};
use std::collections::BTreeMap;
use std::sync::Arc;

/// One face that the GPU can evaluate.
#[derive(Clone, Debug)]
pub struct TrimmedFace {
    /// The face's index in its part.
    pub face: usize,
    /// The surface.
    pub surface: NurbsSurface,
    /// How its parameters correspond to those of the model's surface.
    pub parameters: NurbsParameters,
    /// The box of native parameters that is the face's unit square.
    pub uv: UvBox,
    pub(crate) loops: Vec<Cubic>,
    /// Whether the outside is against the surface's normal.
    pub reversed: bool,
    /// The face's own colour, linear.
    pub color: Option<Rgba>,
    /// The largest |S_uu|, |S_uv|, |S_vv| by native parameters, at samples with a margin.
    pub(crate) bends: [f64; 3],
    /// The largest |S_u|, |S_v| there, times the sides of `uv`: how long the unit square's sides become.
    pub(crate) stretch: [f64; 2],
    /// How much the image of the most bent piece of its border bends.
    pub(crate) border_bend: f64,
    /// About how long the shortest of them is, in the part's units.
    pub(crate) shortest_piece: f64,
    /// Native parameters of lines at which the surface may have a kink.
    pub(crate) kinks: [Vec<f64>; 2],
    /// A box that holds the surface, in the part's units; `None` where weights allow none.
    pub(crate) bounds: Option<[DVec3; 2]>,
    /// Normals that all point out of a closed shell; `None` where the back may be seen or no cone is known.
    pub(crate) outward: Option<Cone>,
}

#[cfg(test)]
impl TrimmedFace {
    /// An untrimmed face over the whole of a surface.
    pub(crate) fn whole(surface: NurbsSurface) -> Self {
        let uv = surface.domain();
        let over = Surface::Nurbs(surface);
        untrimmed(&over, uv).expect("a spline is a spline")
    }
}

impl TrimmedFace {
    /// Takes another surface of the same shape of knots over the same parameters: how fine it must be sampled
    /// follows; its back may be seen from now on.
    pub(crate) fn replace_surface(&mut self, surface: &NurbsSurface) {
        let over = Surface::Nurbs(surface.clone());
        let low = self.parameters.nurbs_from_native(self.uv.min);
        let high = self.parameters.nurbs_from_native(self.uv.max);
        let domain = UvBox::from_points([low, high]);
        let scale = domain.size() / self.uv.size();
        let kinks = over.breaks(domain);
        let (bends, stretch) = bends(&over, domain, [&kinks[0], &kinks[1]]);
        let [uu, uv, vv] = bends;
        let [kinks_u, kinks_v] = kinks;
        self.kinks = [
            kinks_u.into_iter().map(|t| self.parameters.u.native_from_nurbs(t)).collect(),
            kinks_v.into_iter().map(|t| self.parameters.v.native_from_nurbs(t)).collect(),
        ];
        self.bends = [uu * scale.x * scale.x, uv * scale.x * scale.y, vv * scale.y * scale.y];
        self.stretch = stretch;
        self.bounds = bounds(surface);
        self.outward = None;
        self.surface = surface.clone();
        self.measure_border();
    }
}

/// A part's exact faces, and those that have no exact NURBS form and stay meshed.
#[derive(Clone, Debug, Default)]
pub struct TrimmedPart {
    /// The exact faces.
    pub faces: Vec<TrimmedFace>,
    /// The other faces, by index.
    pub meshed: Vec<usize>,
}

/// A model's parts, in its order.
#[derive(Clone, Debug, Default)]
pub struct TrimmedModel {
    /// The parts.
    pub parts: Vec<TrimmedPart>,
}

/// Exact faces of everything that was meshed.
pub fn trimmed_model(scene: &Scene, model: &Model) -> TrimmedModel {
    let parts = scene.parts.iter().zip(&model.parts).map(|(scene_part, part)| {
        let mesh = &scene_part.mesh;
        let edges = EdgeParameters::new(part, mesh);
        let mut found = TrimmedPart::default();
        let outside = outside_faces(mesh);
        for (index, (face, of_face)) in part.faces.iter().zip(&mesh.faces).enumerate() {
            if of_face.triangles.is_empty() {
                continue;
            }
            let exact = match &face.geometry {
                FaceGeometry::Surface(surface) => exact_face(surface, of_face, &edges),
                FaceGeometry::Failed(_) => None,
            };
            match exact {
                Some(exact) => found.faces.push(TrimmedFace {
                    face: index,
                    outward: outside[index].and_then(|area| Some(normal_cone(&exact.surface)?.towards(area))),
                    reversed: face.normal_reversed(),
                    color: scene_part.face_colors.get(index).copied().flatten(),
                    ..exact
                }),
                None => found.meshed.push(index),
            }
        }
        found
    });
    TrimmedModel { parts: parts.collect() }
}

fn exact_face(surface: &Arc<Surface>, of_face: &FaceMesh, edges: &EdgeParameters) -> Option<TrimmedFace> {
    let uv = UvBox::from_points(of_face.corners.iter().map(|c| c.uv));
    if !(uv.size().min_element() > 0.0) || !uv.is_finite() {
        return None;
    }
    let face = TrimmedFace { loops: loops(surface, of_face, edges, uv), ..untrimmed(surface, uv)? };
    Some(face.with_border())
}

/// The face that fills the box.
fn untrimmed(surface: &Surface, uv: UvBox) -> Option<TrimmedFace> {
    let nurbs = surface.to_nurbs(uv).ok()?;
    let parameters = surface.nurbs_parameters(uv).ok()?;
    let [kinks_u, kinks_v] = surface.breaks(uv);
    let (bends, stretch) = bends(surface, uv, [&kinks_u, &kinks_v]);
    let face = TrimmedFace {
        face: 0,
        bounds: bounds(&nurbs),
        surface: nurbs,
        parameters,
        uv,
        loops: Vec::new(),
        reversed: false,
        color: None,
        bends,
        stretch,
        kinks: [kinks_u, kinks_v],
        outward: None,
        border_bend: 0.0,
        shortest_piece: 0.0,
    };
    Some(face.with_border())
}

/// The sides of triangles that one triangle alone has, as curves in the unit square; none where they are its
/// border.
fn loops(surface: &Surface, of_face: &FaceMesh, edges: &EdgeParameters, uv: UvBox) -> Vec<Cubic> {
    let mut sides: BTreeMap<[u32; 2], (u32, [u32; 2])> = BTreeMap::new();
    for t in &of_face.triangles {
        for side in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
            let key = [side[0].min(side[1]), side[0].max(side[1])];
            sides.entry(key).and_modify(|s| s.0 += 1).or_insert((1, side));
        }
    }
    let unit = |p: DVec2| (p - uv.min) / uv.size();
    let mut doubled_area = 0.0;
    let mut found = Vec::new();
    let mut line = |p: DVec2, q: DVec2| {
        doubled_area += p.perp_dot(q);
        Cubic::line(p, q)
    };
    for (_, [a, b]) in sides.into_values().filter(|s| s.0 == 1) {
        let [from, to] = [a, b].map(|i| &of_face.corners[i as usize]);
        let (p, q) = (unit(from.uv), unit(to.uv));
        let straight = line(p, q);
        // Triangles about a pole have a corner there each, anywhere along the line that it is in the
        // parameters. Their sides go to it straight, so that those of neighbours cancel, and then along it.
        let around = |end: DVec2, pole: DVec2, axis: usize| {
            let mut foot = pole;
            foot[axis] = end[axis];
            foot
        };
        if let Some(axis) = pole(surface, to.uv, uv) {
            let foot = around(p, q, axis);
            found.extend([line(p, foot), line(foot, q)]);
            line(q, p);
        } else if let Some(axis) = pole(surface, from.uv, uv) {
            let foot = around(q, p, axis);
            found.extend([line(p, foot), line(foot, q)]);
            line(q, p);
        } else {
            let derivative = |uv_of: DVec2, d: DVec3| carried(surface, uv_of, d).map(|d| d / uv.size());
            let curved = edges.derivatives(from.position, to.position).and_then(|[d0, d1]| {
                Some(Cubic::hermite(p, q, derivative(from.uv, d0)?, derivative(to.uv, d1)?))
            });
            found.push(curved.unwrap_or(straight));
        }
    }
    // A polygon within the square as large as the square is the square.
    if 0.5 * doubled_area.abs() >= 1.0 - 1e-12 { Vec::new() } else { Cubic::chained(found) }
}

/// Where the surface has a pole: the axis of parameters along which it does not move there.
fn pole(surface: &Surface, at: DVec2, uv: UvBox) -> Option<usize> {
    let (_, du, dv) = surface.jet1(at);
    let reach = [du.length() * uv.size().x, dv.length() * uv.size().y];
    // Rounding of a radius that should be 0, against the face's size.
    (0..2).find(|&axis| reach[axis] <= 1e-7 * reach[1 - axis])
}

/// The derivative in the parameters of which `d` is the image; `None` where the surface has no tangent plane.
fn carried(surface: &Surface, uv: DVec2, d: DVec3) -> Option<DVec2> {
    let (_, su, sv) = surface.jet1(uv);
    let (e, f, g) = (su.dot(su), su.dot(sv), sv.dot(sv));
    let area = e * g - f * f;
    let (a, b) = (su.dot(d), sv.dot(d));
    let found = DVec2::new(g * a - f * b, e * b - f * a) / area;
    (area > 1e-12 * e * g).then_some(found).filter(|d| d.is_finite())
}

/// The box of the control points, which holds the surface where no weight is negative.
fn bounds(surface: &NurbsSurface) -> Option<[DVec3; 2]> {
    if surface.weights().is_some_and(|w| w.iter().any(|w| !(*w > 0.0))) {
        return None;
    }
    let fold = |f: fn(DVec3, DVec3) -> DVec3| surface.points().iter().copied().reduce(f);
    Some([fold(DVec3::min)?, fold(DVec3::max)?])
}

/// The largest second derivatives at a few samples of every span and a fifth more, and the largest first ones
/// times the sides of the box.
fn bends(surface: &Surface, uv: UvBox, kinks: [&[f64]; 2]) -> ([f64; 3], [f64; 2]) {
    let samples = |axis: usize| {
        let count = (4 * (kinks[axis].len() + 1)).clamp(9, 65);
        let (start, length) = (uv.min[axis], uv.size()[axis]);
        (0..count).map(move |k| start + length * ((k as f64 + 0.5) / count as f64)).collect::<Vec<_>>()
    };
    let (us, vs) = (samples(0), samples(1));
    let mut found = [0.0_f64; 5];
    for &u in &us {
        for &v in &vs {
            let jet = surface.jet(DVec2::new(u, v));
            for (slot, d) in found.iter_mut().zip([jet.duu, jet.duv, jet.dvv, jet.du, jet.dv]) {
                *slot = slot.max(d.length());
            }
        }
    }
    let [uu, uv_, vv, u, v] = found.map(|d| if d.is_finite() { d } else { 0.0 });
    ([uu, uv_, vv].map(|d| 1.2 * d), [u * uv.size().x, v * uv.size().y])
}
