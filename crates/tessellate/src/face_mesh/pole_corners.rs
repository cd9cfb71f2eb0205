//! Corners of triangles at a pole: all points of its line are one vertex, but each triangle sees the pole
//! from its own side and needs its own parameters and normal there.

use super::FaceMesh;
use chordal_chart::Key;
use chordal_nurbs::orient;
use chordal_nurbs::{DVec2, DVec3};

/// Corners at poles are taken this share of their triangle off the pole. Bounds of cones call places up to
/// twice as far away the apex; on the pole itself, rounding decides which side the normal is taken from.
const BESIDE_POLE: f64 = 5e-10;

impl FaceMesh<'_, '_> {
    /// The normals by which the edges of a triangle turn: those that its corners are written with.
    pub(crate) fn turning_normals(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        let mut normals = triangle.map(|v| self.vertices.normals[v as usize]);
        if let Some((i, uv)) = self.pole_corner(triangle) {
            normals[i] = self.surface().normal(uv);
        }
        normals
    }

    /// The corner of a triangle that lies on a pole, and the place just beside the pole between the
    /// triangle's other two corners, where its normal is taken from.
    fn pole_corner(&self, triangle: [u32; 3]) -> Option<(usize, DVec2)> {
        let i = (0..3).find(|&i| self.vertices.at_pole[triangle[i] as usize])?;
        let corner = triangle[i] as usize;
        let pole = self.surface().pole_at(self.vertices.xyz[corner], self.context.trimmed.resolution)?;
        let along = 1 - pole.axis;
        let [a, b] = [1, 2].map(|k| self.mesh.points[triangle[(i + k) % 3] as usize]);
        let own = self.mesh.points[corner];
        let mut uv = own;
        uv[pole.axis] += BESIDE_POLE * (a.midpoint(b)[pole.axis] - uv[pole.axis]);
        uv[along] = 0.5 * (a[along] + b[along]);
        let side = |uv: DVec2| orient(uv, a, b);
        // A triangle so thin that it would turn over keeps the corner's own place along the pole, or
        // altogether.
        let places = [uv, if along == 0 { DVec2::new(own.x, uv.y) } else { DVec2::new(uv.x, own.y) }];
        let uv = places.into_iter().find(|&uv| side(uv) * side(own) > 0.0).unwrap_or(own);
        Some((i, uv))
    }

    /// Gives each triangle at a pole a corner of its own there. Returns how far these corners lie off the
    /// pole's vertex.
    pub(super) fn separate_pole_corners(&mut self, triangles: &mut [[u32; 3]], keys: &mut Vec<Key>) -> f64 {
        let mut gap = 0.0f64;
        if !self.touches_pole() {
            return gap;
        }
        for triangle in triangles {
            let Some((i, uv)) = self.pole_corner(*triangle) else { continue };
            let pole_corner = triangle[i] as usize;
            triangle[i] = self.mesh.points.len() as u32;
            keys.push(keys[pole_corner]);
            self.mesh.points.push(uv);
            self.vertices.normals.push(self.surface().normal(uv));
            gap = gap.max(self.surface().point(uv).distance(self.position(keys[pole_corner])));
        }
        gap
    }
}
