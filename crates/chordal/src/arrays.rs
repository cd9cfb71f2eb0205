//! The mesh as flat arrays, as other languages and graphics interfaces take it.

use crate::error::{Error, RequestError};
use crate::meshed::{Meshed, Place};
use chordal_brep::PartId;
use chordal_mesh::ScenePart;
use chordal_nurbs::DVec3;

/// What [`Arrays::faces`] has for a triangle that was in the file already.
pub const NO_FACE: u32 = u32::MAX;

/// All triangles as placed, in the order of [`Meshed::triangles`].
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Arrays {
    /// Millimetres; neighbouring triangles share their vertices by index. Every placement has vertices of its
    /// own.
    pub positions: Vec<[f64; 3]>,
    /// Indices into `positions`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The face of every triangle, counted over all parts of the model in their order; [`NO_FACE`] for
    /// triangles that were in the file already.
    pub faces: Vec<u32>,
    /// The part of every triangle: an index into the parts of the model.
    pub parts: Vec<u32>,
    /// The placement of every triangle, below [`Meshed::placement_count`].
    pub placements: Vec<u32>,
}

impl Meshed {
    /// The mesh as flat arrays.
    ///
    /// ```
    /// let model = chordal::Model::open("../../corpus/bracket.step")?;
    /// let arrays = chordal::Mesher::default().mesh(&model)?.arrays()?;
    /// assert_eq!(arrays.triangles.len(), arrays.faces.len());
    /// # Ok::<(), chordal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Request`] where the mesh has more vertices than 32 bits can count.
    pub fn arrays(&self) -> Result<Arrays, Error> {
        let first_faces = self.first_faces();
        let mut arrays = Arrays::default();
        for place in self.places() {
            let part = &self.scene().parts[place.part.index()];
            arrays.add_part(part, &place, first_faces[place.part.index()])?;
        }
        Ok(arrays)
    }

    /// The number of the first face of every part, counted over all parts.
    fn first_faces(&self) -> Vec<u32> {
        let mut count = 0;
        let first = |part: &chordal_brep::Part| {
            let first = count;
            count += part.faces.len() as u32;
            first
        };
        self.brep().parts.iter().map(first).collect()
    }
}

impl Arrays {
    fn add_part(&mut self, part: &ScenePart, place: &Place, first_face: u32) -> Result<(), Error> {
        let base = self.add_points(&part.mesh.positions, place)?;
        for face in &part.mesh.faces {
            let position = |corner: u32| base + face.corners[corner as usize].position;
            self.add_triangles(&face.triangles, place, first_face + face.face, position);
        }
        for item in &part.pass_through {
            let base = self.add_points(&item.points, place)?;
            self.add_triangles(&item.triangles, place, NO_FACE, |point| base + point);
        }
        Ok(())
    }

    /// Adds vertices, and returns the index of the first.
    fn add_points(&mut self, points: &[DVec3], place: &Place) -> Result<u32, Error> {
        let base = self.positions.len();
        let count = base + points.len();
        if u32::try_from(count).is_err() {
            return Err(RequestError::TooManyVertices { count }.into());
        }
        self.positions.extend(points.iter().map(|&p| place.world.transform_point3(p).to_array()));
        Ok(base as u32)
    }

    fn add_triangles(
        &mut self,
        triangles: &[[u32; 3]],
        place: &Place,
        face: u32,
        position: impl Fn(u32) -> u32,
    ) {
        let count = self.triangles.len() + triangles.len();
        self.triangles.extend(triangles.iter().map(|&triangle| place.winding(triangle).map(&position)));
        self.faces.resize(count, face);
        let PartId(part) = place.part;
        self.parts.resize(count, part);
        self.placements.resize(count, place.placement as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mesher, Model};
    use std::collections::BTreeSet;

    #[test]
    fn the_arrays_are_the_triangles() {
        let model = Model::open("../../corpus/mapped_items.step").expect("a model");
        let meshed = Mesher::default().mesh(&model).expect("a mesh");
        let arrays = meshed.arrays().expect("arrays");
        assert!(meshed.placement_count() > 1, "the model has several placements");
        assert_eq!(arrays.triangles.len(), meshed.triangles().count());
        let first = meshed.first_faces();
        for (i, triangle) in meshed.triangles().enumerate() {
            let corners = arrays.triangles[i].map(|corner| arrays.positions[corner as usize]);
            assert_eq!(corners, triangle.positions.map(|p| p.to_array()));
            assert_eq!(arrays.parts[i], triangle.part.0);
            assert_eq!(arrays.placements[i] as usize, triangle.placement);
            let face = triangle.face.map_or(NO_FACE, |face| first[triangle.part.index()] + face.0);
            assert_eq!(arrays.faces[i], face);
        }
        let used: BTreeSet<u32> = arrays.triangles.iter().flatten().copied().collect();
        assert_eq!(used.len(), arrays.positions.len(), "every vertex is used");
    }
}
