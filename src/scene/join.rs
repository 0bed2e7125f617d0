//! Parts of an object put together.

use super::formats::shading_normals::{self, NO_NORMAL};
use super::{ObjectInput, SmoothNormals, TextureCoordinates};

impl ObjectInput {
    /// One object of several, with the name, the material and the part in shadows of the first. Where only some
    /// have shading normals the others are flat; where only some have texture coordinates the others have
    /// (0, 0).
    ///
    /// `None` if there are none.
    pub(super) fn join(parts: Vec<ObjectInput>) -> Option<ObjectInput> {
        let mut parts = parts.into_iter();
        let mut whole = parts.next()?;
        for part in parts {
            whole.append(part);
        }
        if let Some(normals) = &mut whole.normals {
            shading_normals::repair(normals, &whole.positions, &whole.triangles);
        }
        Some(whole)
    }

    fn append(&mut self, part: ObjectInput) {
        let before = self.triangles.len();
        if self.normals.is_some() || part.normals.is_some() {
            let whole = self.normals.get_or_insert_with(|| SmoothNormals {
                normals: Vec::new(),
                corners: vec![[NO_NORMAL; 3]; before],
            });
            let first = whole.normals.len() as u32;
            let flat =
                || SmoothNormals { normals: Vec::new(), corners: vec![[NO_NORMAL; 3]; part.triangles.len()] };
            let SmoothNormals { normals, corners } = part.normals.unwrap_or_else(flat);
            let renumber = |corner: u32| if corner == NO_NORMAL { corner } else { first + corner };
            whole.corners.extend(corners.into_iter().map(|corners| corners.map(renumber)));
            whole.normals.extend(normals);
        }
        if self.texture_coordinates.is_some() || part.texture_coordinates.is_some() {
            let nowhere = |triangles: usize| TextureCoordinates {
                coordinates: vec![[0.0; 2]],
                corners: vec![[0; 3]; triangles],
            };
            let whole = self.texture_coordinates.get_or_insert_with(|| nowhere(before));
            let first = whole.coordinates.len() as u32;
            let given = part.texture_coordinates.unwrap_or_else(|| nowhere(part.triangles.len()));
            whole.corners.extend(given.corners.into_iter().map(|corners| corners.map(|c| first + c)));
            whole.coordinates.extend(given.coordinates);
        }
        let polygons = |polygons: Option<u32>, triangles: usize| polygons.unwrap_or(triangles as u32);
        let more = polygons(part.polygons, part.triangles.len());
        self.polygons = Some(polygons(self.polygons, before).saturating_add(more));
        let first = self.positions.len() as u32;
        self.triangles.extend(part.triangles.into_iter().map(|triangle| triangle.map(|v| first + v)));
        self.positions.extend(part.positions);
        self.curved.extend(part.curved);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::Shape;
    use glam::Vec3;

    fn triangle(z: f32) -> ObjectInput {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + Vec3::Z * z).to_vec();
        ObjectInput { polygons: Some(1), ..ObjectInput::new("part", positions, vec![[0, 1, 2]]) }
    }

    #[test]
    fn everything_of_all_parts_is_there_under_its_new_number() {
        let corners = vec![[0, 0, 1]];
        let smooth = ObjectInput {
            normals: Some(SmoothNormals { normals: vec![Vec3::X, Vec3::Y], corners: corners.clone() }),
            texture_coordinates: Some(TextureCoordinates { coordinates: vec![[0.5; 2], [1.0; 2]], corners }),
            curved: vec![Shape::sphere(Vec3::ZERO, 1.0)],
            ..triangle(1.0)
        };
        let whole = ObjectInput::join(vec![triangle(0.0), smooth, triangle(2.0)]).unwrap();
        assert_eq!(whole.triangles, [[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
        assert_eq!((whole.positions[3], whole.polygons, whole.curved.len()), (Vec3::Z, Some(3), 1));
        let normals = whole.normals.unwrap();
        let of = |t: usize| normals.corners[t].map(|corner| normals.normals[corner as usize]);
        assert_eq!((of(0), of(1), of(2)), ([Vec3::Z; 3], [Vec3::X, Vec3::X, Vec3::Y], [Vec3::Z; 3]));
        let texture = whole.texture_coordinates.unwrap();
        let of = |t: usize| texture.corners[t].map(|corner| texture.coordinates[corner as usize]);
        assert_eq!((of(0), of(1), of(2)), ([[0.0; 2]; 3], [[0.5; 2], [0.5; 2], [1.0; 2]], [[0.0; 2]; 3]));
        assert!(ObjectInput::join(Vec::new()).is_none());
    }
}
