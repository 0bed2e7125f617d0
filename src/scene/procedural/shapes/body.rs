//! What one object is made of.

use super::mesh::Mesh;
use crate::geometry::curved::Shape;

/// Polygons and curved surfaces that make one object.
#[derive(Debug, Clone, Default)]
pub(in crate::scene::procedural) struct Body {
    /// Its polygons.
    pub mesh: Mesh,
    /// Its curved surfaces.
    pub curved: Vec<Shape>,
}

impl From<Mesh> for Body {
    fn from(mesh: Mesh) -> Body {
        Body { mesh, curved: Vec::new() }
    }
}

impl From<Shape> for Body {
    fn from(shape: Shape) -> Body {
        Body { mesh: Mesh::default(), curved: vec![shape] }
    }
}

impl<const N: usize> From<[Shape; N]> for Body {
    fn from(shapes: [Shape; N]) -> Body {
        Body { mesh: Mesh::default(), curved: shapes.to_vec() }
    }
}

impl<const N: usize> From<(Mesh, [Shape; N])> for Body {
    fn from((mesh, shapes): (Mesh, [Shape; N])) -> Body {
        Body { mesh, curved: shapes.to_vec() }
    }
}
