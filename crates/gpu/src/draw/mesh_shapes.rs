//! Triangles and lines to draw, from a meshed scene.

use super::camera;
use super::false_color::{distance, diverging, mean_curvature, sequential};
use super::options::Style;
use super::shapes::{Placed, Scenery, Shape, Vertex};
use super::srgb::srgb;
use crate::faces::TrimmedModel;
use chordal_brep::{FaceGeometry, Model, Part};
use chordal_mesh::{FaceMesh, Rgba, Scene, ScenePart};
use chordal_nurbs::{Surface, math};
use glam::{DVec2, DVec3};

/// What the colours of a measured style mean, millimetres (error) or 1 / millimetres (curvature).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Legend {
    /// The value at the lower end of the scale.
    pub low: f64,
    /// The value at the upper end.
    pub high: f64,
}

/// The colour of faces that have none, sRGB.
pub(crate) const DEFAULT_COLOR: [u8; 4] = [182, 190, 200, 255];
/// The colour of faces under the lines of a wireframe.
const PALE: [u8; 4] = [222, 226, 232, 255];
/// A facet is painted with its error at the corners of this many rows of smaller facets.
const ERROR_ROWS: usize = 4;

/// Shapes for a style. `model` is what the scene was made of; measured styles need it.
pub fn mesh_scenery(scene: &Scene, model: &Model, style: Style) -> (Scenery, Option<Legend>) {
    scenery_of(scene, model, style, None)
}

/// As [`mesh_scenery`], without the faces that are drawn exactly.
pub(crate) fn scenery_of(
    scene: &Scene,
    model: &Model,
    style: Style,
    exact: Option<&TrimmedModel>,
) -> (Scenery, Option<Legend>) {
    let mut placements = scene.placements();
    placements.sort_by_key(|p| p.part);
    let placed: Vec<Placed> = placements
        .iter()
        .map(|p| Placed { shape: p.part, world: p.world, color: p.color.filter(|_| style == Style::Shaded) })
        .collect();
    // Of every part the length of its unit, as first placed.
    let mut units = vec![1.0; scene.parts.len()];
    for alike in placed.chunk_by(|a, b| a.shape == b.shape) {
        units[alike[0].shape] = math::cbrt(alike[0].world.matrix3.determinant().abs());
    }
    let mut painted: Vec<(Shape, Vec<f64>)> = scene
        .parts
        .iter()
        .zip(&model.parts)
        .enumerate()
        .map(|(index, (part, of_model))| {
            let meshed = exact.map(|e| e.parts[index].meshed.as_slice());
            shape_of(part, of_model, style, units[index], meshed)
        })
        .collect();
    let legend = paint(&mut painted, style);
    let shapes = painted.into_iter().map(|(shape, _)| shape).collect();
    (Scenery { shapes, placed }, legend)
}

/// The shape of a part and, of measured styles, the value at each vertex; of the faces only those of `only`,
/// which rise.
fn shape_of(
    part: &ScenePart,
    exact: &Part,
    style: Style,
    unit: f64,
    only: Option<&[usize]>,
) -> (Shape, Vec<f64>) {
    let (low, high) = camera::bounds(part_points(part));
    let radius = 0.5 * low.distance(high);
    let mut shape = Shape { middle: 0.5 * (low + high), radius, ..Shape::default() };
    let mut values = Vec::new();
    for (face, mesh) in part.mesh.faces.iter().enumerate() {
        if only.is_some_and(|only| only.binary_search(&face).is_err()) {
            continue;
        }
        let surface = match exact.faces.get(face).map(|f| &f.geometry) {
            Some(FaceGeometry::Surface(surface)) => Some(surface.as_ref()),
            _ => None,
        };
        let first = shape.vertices.len();
        let color = face_color(part.face_colors.get(face).copied().flatten(), style);
        match (style, surface) {
            (Style::Error, Some(surface)) => push_errors(&mut shape, &mut values, part, mesh, surface, unit),
            _ => push_face(&mut shape, &mut values, part, mesh, color, surface.map(|s| (s, style, unit))),
        }
        shape.vertices[first..].iter_mut().for_each(|v| v.face = face as u32);
        if style == Style::Wireframe {
            push_triangle_edges(&mut shape, part, mesh);
        }
    }
    if style != Style::Wireframe {
        for line in &part.mesh.edges {
            let ends = line.windows(2).map(|w| [w[0], w[1]].map(|i| part.mesh.positions[i as usize]));
            shape.segments.extend(ends.map(|e| e.map(|p| local(p, shape.middle))));
        }
    }
    push_triangles_of_the_file(&mut shape, &mut values, part, style);
    (shape, values)
}

fn part_points(part: &ScenePart) -> impl Iterator<Item = DVec3> {
    part.mesh.positions.iter().chain(part.pass_through.iter().flat_map(|t| &t.points)).copied()
}

/// Points that reach as far as the scene does, in millimetres: the vertices of all placements, of large
/// scenes the corners of their boxes, and of many those that reach furthest in some direction. What is left
/// out then reaches beyond the others by less than a hundredth of the scene's size, which pictures have as a
/// margin.
pub fn scene_outline(scene: &Scene) -> Vec<DVec3> {
    /// More vertices than this are stood for by boxes.
    const MANY: usize = 2_000_000;
    let placements = scene.placements();
    let count: usize = placements.iter().map(|p| scene.parts[p.part].mesh.positions.len()).sum();
    let mut points = Vec::new();
    for placed in &placements {
        let part = &scene.parts[placed.part];
        if count <= MANY {
            points.extend(part_points(part).map(|p| placed.world.transform_point3(p)));
        } else if part_points(part).next().is_some() {
            let (low, high) = camera::bounds(part_points(part));
            points.extend((0..8).map(|corner| {
                let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                placed.world.transform_point3(DVec3::new(pick(0), pick(1), pick(2)))
            }));
        }
    }
    furthest(points)
}

/// Of many points those that reach furthest in directions all over the sphere, each once: every frame looks
/// at all that are left.
fn furthest(points: Vec<DVec3>) -> Vec<DVec3> {
    const MANY: usize = 50_000;
    /// Neighbours are some 0.16 radians apart, and what lies between two is missed by 1 - cos 0.11 of the
    /// size at most.
    const DIRECTIONS: usize = 500;
    if points.len() <= MANY {
        return points;
    }
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let spiral = (0..DIRECTIONS).map(|k| {
        let z = 1.0 - 2.0 * (k as f64 + 0.5) / DIRECTIONS as f64;
        (math::direction(golden * k as f64) * (1.0 - z * z).sqrt()).extend(z)
    });
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|a| [a, -a]);
    let directions: Vec<DVec3> = spiral.chain(axes).collect();
    let mut best = vec![(f64::NEG_INFINITY, 0); directions.len()];
    for (index, p) in points.iter().enumerate() {
        for (best, d) in best.iter_mut().zip(&directions) {
            let reach = d.dot(*p);
            if reach > best.0 {
                *best = (reach, index);
            }
        }
    }
    let mut found: Vec<usize> = best.into_iter().map(|b| b.1).collect();
    found.sort_unstable();
    found.dedup();
    found.into_iter().map(|index| points[index]).collect()
}

/// Boxes that hold the parts: their meshes, and a margin for the surfaces between the vertices.
pub(crate) fn shape_boxes(scene: &Scene) -> Vec<[DVec3; 2]> {
    let of_part = |part: &ScenePart| {
        let (low, high) = camera::bounds(part_points(part));
        // Meshes are far finer than a tenth of their part.
        let margin = DVec3::splat(0.1 * low.distance(high));
        [low - margin, high + margin]
    };
    scene.parts.iter().map(of_part).collect()
}

pub(crate) fn local(p: DVec3, middle: DVec3) -> [f32; 3] {
    (p - middle).as_vec3().to_array()
}

fn face_color(color: Option<Rgba>, style: Style) -> [u8; 4] {
    match (style, color) {
        (Style::Wireframe, _) => PALE,
        (_, Some(c)) => srgb_bytes(c),
        _ => DEFAULT_COLOR,
    }
}

/// Linear colour as sRGB bytes, and opacity.
pub(crate) fn srgb_bytes(c: Rgba) -> [u8; 4] {
    let byte = |x: f32| (srgb(f64::from(x).clamp(0.0, 1.0)) * 255.0).round() as u8;
    [byte(c[0]), byte(c[1]), byte(c[2]), (255.0 * opacity(c)).round() as u8]
}

/// The opacity of a colour. Nothing is quite invisible: 0 stands for no colour.
pub(crate) fn opacity(c: Rgba) -> f32 {
    c[3].clamp(1.0 / 255.0, 1.0)
}

/// Per part whether something of it is seen through, as it is or as it is placed.
pub(crate) fn seen_through(scene: &Scene, placed: &[Placed]) -> Vec<bool> {
    let veiled = |c: &Option<Rgba>| c.is_some_and(|c| opacity(c) < 1.0);
    let mut found: Vec<bool> = scene.parts.iter().map(|p| p.face_colors.iter().any(veiled)).collect();
    placed.iter().filter(|p| veiled(&p.color)).for_each(|p| found[p.shape] = true);
    found
}

fn push_face(
    shape: &mut Shape,
    values: &mut Vec<f64>,
    part: &ScenePart,
    mesh: &FaceMesh,
    color: [u8; 4],
    exact: Option<(&Surface, Style, f64)>,
) {
    let first = shape.vertices.len() as u32;
    for corner in &mesh.corners {
        shape.vertices.push(Vertex {
            position: local(part.mesh.positions[corner.position as usize], shape.middle),
            normal: corner.normal.as_vec3().to_array(),
            color,
            face: 0,
        });
        values.push(match exact {
            Some((surface, Style::Curvature, unit)) => {
                mean_curvature(surface, corner.uv, corner.normal).map_or(f64::NAN, |h| h / unit)
            }
            _ => 0.0,
        });
    }
    shape.triangles.extend(mesh.triangles.iter().map(|t| t.map(|c| first + c)));
}

/// Every triangle as a grid of smaller ones, with the distance from the surface at each of their corners.
fn push_errors(
    shape: &mut Shape,
    values: &mut Vec<f64>,
    part: &ScenePart,
    mesh: &FaceMesh,
    surface: &Surface,
    unit: f64,
) {
    for t in &mesh.triangles {
        let corners = t.map(|c| &mesh.corners[c as usize]);
        let positions = corners.map(|c| part.mesh.positions[c.position as usize]);
        let first = shape.vertices.len() as u32;
        for i in 0..=ERROR_ROWS {
            for j in 0..=ERROR_ROWS - i {
                let b = [i, j, ERROR_ROWS - i - j].map(|x| x as f64 / ERROR_ROWS as f64);
                let mix = |x: [DVec3; 3]| x[0] * b[0] + x[1] * b[1] + x[2] * b[2];
                let uv: DVec2 = (0..3).map(|k| corners[k].uv * b[k]).sum();
                let (p, n) = (mix(positions), mix(corners.map(|c| c.normal)));
                shape.vertices.push(Vertex {
                    position: local(p, shape.middle),
                    normal: n.as_vec3().to_array(),
                    color: DEFAULT_COLOR,
                    face: 0,
                });
                values.push(distance(surface, uv, p) * unit);
            }
        }
        // Row i starts after the rows before it, which have ERROR_ROWS + 1 corners and one less each time.
        let at = |i: usize, j: usize| first + (i * (2 * ERROR_ROWS + 3 - i) / 2 + j) as u32;
        for i in 0..ERROR_ROWS {
            for j in 0..ERROR_ROWS - i {
                shape.triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if j + 1 < ERROR_ROWS - i {
                    shape.triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
}

/// The edges of all triangles, those of two triangles once.
fn push_triangle_edges(shape: &mut Shape, part: &ScenePart, mesh: &FaceMesh) {
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for t in &mesh.triangles {
        let at = t.map(|c| mesh.corners[c as usize].position);
        edges.extend([[at[0], at[1]], [at[1], at[2]], [at[2], at[0]]].map(|[a, b]| [a.min(b), a.max(b)]));
    }
    edges.sort_unstable();
    edges.dedup();
    let middle = shape.middle;
    shape.segments.extend(edges.iter().map(|e| e.map(|i| local(part.mesh.positions[i as usize], middle))));
}

/// Triangles that came with the file, with its normals or flat.
fn push_triangles_of_the_file(shape: &mut Shape, values: &mut Vec<f64>, part: &ScenePart, style: Style) {
    for item in &part.pass_through {
        let color = face_color(item.color, style);
        for t in &item.triangles {
            let corners = t.map(|i| item.points[i as usize]);
            let flat = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            let first = shape.vertices.len() as u32;
            for (corner, &index) in corners.iter().zip(t) {
                let normal = item.normals.get(index as usize).copied().unwrap_or(flat);
                shape.vertices.push(Vertex {
                    position: local(*corner, shape.middle),
                    normal: normal.as_vec3().to_array(),
                    color,
                    face: 0,
                });
                values.push(0.0);
            }
            shape.triangles.push([first, first + 1, first + 2]);
        }
    }
}

/// Turns values into colours, over a range common to all shapes.
fn paint(painted: &mut [(Shape, Vec<f64>)], style: Style) -> Option<Legend> {
    let sizes = || painted.iter().flat_map(|(_, values)| values).filter(|v| v.is_finite()).map(|v| v.abs());
    let legend = match style {
        Style::Error => Legend { low: 0.0, high: sizes().fold(0.0, f64::max) },
        Style::Curvature => {
            // Nine tenths of the vertices of bent faces set the range: few sharp fillets must not make the
            // rest look flat.
            let mut bent: Vec<f64> = sizes().filter(|v| *v > 0.0).collect();
            bent.sort_unstable_by(f64::total_cmp);
            let high = bent.get(bent.len() * 9 / 10).copied().unwrap_or(1.0);
            Legend { low: -high, high }
        }
        Style::Shaded | Style::Edges | Style::Wireframe => return None,
    };
    let high = if legend.high > 0.0 { legend.high } else { 1.0 };
    for (shape, values) in painted {
        for (vertex, value) in shape.vertices.iter_mut().zip(values) {
            let x = if value.is_finite() { *value / high } else { 0.0 };
            vertex.color = if style == Style::Error { sequential(x) } else { diverging(x.clamp(-1.0, 1.0)) };
        }
    }
    Some(legend)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A thick shell of points: what is kept reaches as far as all of them but for less than a hundredth, in
    /// any direction.
    #[test]
    fn what_reaches_furthest_is_kept() {
        let at = |k: f64| {
            let z = 1.0 - 2.0 * k / 60_000.0;
            (math::direction(2.4 * k) * (1.0 - z * z).sqrt()).extend(0.3 * z)
                * (0.9 + 0.1 * math::sin(0.7 * k))
        };
        let all: Vec<DVec3> = (0..60_000).map(|k| DVec3::splat(1e4) + at(f64::from(k))).collect();
        let kept = furthest(all.clone());
        assert!(kept.len() <= 506, "{}", kept.len());
        for k in 0..200 {
            let d = at(f64::from(299 * k)).normalize();
            let reach = |points: &[DVec3]| points.iter().map(|p| d.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
            assert!(reach(&all) - reach(&kept) < 0.01, "{d}");
        }
    }
}
