//! What an `f` line begins: a material, and the object of the primitives that follow it.

use super::words::{Complaint, Words};
use crate::geometry::curved::Shape;
use crate::scene::formats::limits::{MAX_CONCAVE_CORNERS, MAX_CURVED, MAX_FILLS, MAX_TRIANGLES};
use crate::scene::formats::polygon;
use crate::scene::formats::shading_normals::{self, NO_NORMAL};
use crate::scene::formats::text::counted;
use crate::scene::{Material, ObjectInput, SceneBuilder, SmoothNormals, Transmission};
use glam::Vec3;

/// Whether the corners of a polygon have normals.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Corners {
    /// `p`
    Flat,
    /// `pp`
    Smooth,
}

/// The object that is being read, and what is known of those before it.
#[derive(Default)]
pub(super) struct Fills {
    /// The `f` lines so far.
    count: usize,
    /// What [`SceneBuilder::add_material`] returned for the last of them.
    material: u32,
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Polygons that the triangles were cut from.
    polygons: u32,
    curved: Vec<Shape>,
    normals: Vec<Vec3>,
    /// Indices into `normals` for each triangle, or [`NO_NORMAL`].
    normal_corners: Vec<[u32; 3]>,
    /// What is not drawn as the file has it.
    without_fill: usize,
    flat: usize,
    crossed: usize,
    normals_replaced: usize,
}

impl Fills {
    fn name(&self) -> String {
        format!("fill-{}", self.count)
    }

    /// Reads what follows `f`: `r g b Kd Ks shine T ior`.
    ///
    /// # Errors
    /// A transmittance that is no share, and one above 0 with an index of refraction that is none.
    pub(super) fn begin(&mut self, words: &mut Words, builder: &mut SceneBuilder) -> Result<(), Complaint> {
        self.finish_object(builder).map_err(|why| (words.line(), why))?;
        let [r, g, b, diffuse, specular, shininess, transmittance, refraction] = words.finite()?;
        self.count += 1;
        if self.count > MAX_FILLS {
            return Err((words.line(), format!("expected at most {MAX_FILLS} materials")));
        }
        let transmission = transmission(transmittance, refraction).map_err(|why| (words.line(), why))?;
        let reflected = [specular.clamp(0.0, 1.0); 3];
        self.material = builder.add_material(Material {
            name: self.name(),
            diffuse: [r, g, b].map(|channel| (channel * diffuse).clamp(0.0, 1.0)),
            specular: reflected,
            shininess: shininess.max(1.0),
            mirror: reflected,
            transmission,
            ..Material::default()
        });
        Ok(())
    }

    /// Reads what follows `p` or `pp`: a count, and then so many points or points with normals.
    pub(super) fn polygon(
        &mut self,
        corners: Corners,
        words: &mut Words,
        builder: &SceneBuilder,
    ) -> Result<(), Complaint> {
        let first = words.line();
        let numbers_each = if corners == Corners::Smooth { 6 } else { 3 };
        let count = words.count(numbers_each)?;
        let triangles = builder.triangle_count() + self.triangles.len() + count.saturating_sub(2);
        if triangles as u64 > MAX_TRIANGLES {
            return Err((first, format!("expected at most {MAX_TRIANGLES} triangles")));
        }
        let (position, normal) = (self.positions.len(), self.normals.len());
        for _ in 0..count {
            self.positions.push(words.numbers()?.into());
            if corners == Corners::Smooth {
                let direction = Vec3::from(words.numbers()?).as_dvec3();
                self.normals.push(shading_normals::unit(direction).unwrap_or(Vec3::ZERO));
            }
        }
        if count < 3 {
            self.flat += 1;
            self.positions.truncate(position);
            self.normals.truncate(normal);
            return Ok(());
        }
        self.without_fill += usize::from(self.count == 0);
        self.polygons += 1;
        let cut = polygon::triangulate(&self.positions[position..], MAX_CONCAVE_CORNERS);
        let cut = cut.map_err(|why| (first, why))?;
        self.crossed += usize::from(cut.crossed);
        for triangle in cut.triangles {
            self.triangles.push(triangle.map(|corner| (position + corner) as u32));
            self.normal_corners.push(match corners {
                Corners::Smooth => triangle.map(|corner| (normal + corner) as u32),
                Corners::Flat => [NO_NORMAL; 3],
            });
        }
        Ok(())
    }

    /// Takes a curved surface.
    ///
    /// # Errors
    /// If there are too many.
    pub(super) fn curved(
        &mut self,
        shape: Shape,
        words: &Words,
        builder: &SceneBuilder,
    ) -> Result<(), Complaint> {
        if (builder.curved_count() + self.curved.len()) as u64 == MAX_CURVED {
            return Err((
                words.line(),
                format!("expected at most {MAX_CURVED} spheres, cylinders and cones"),
            ));
        }
        self.without_fill += usize::from(self.count == 0);
        self.curved.push(shape);
        Ok(())
    }

    /// Adds the object of the last `f` line, if it has primitives.
    pub(super) fn finish_object(&mut self, builder: &mut SceneBuilder) -> Result<(), String> {
        let positions = std::mem::take(&mut self.positions);
        let triangles = std::mem::take(&mut self.triangles);
        let normals = std::mem::take(&mut self.normals);
        let corners = std::mem::take(&mut self.normal_corners);
        let curved = std::mem::take(&mut self.curved);
        let polygons = std::mem::take(&mut self.polygons);
        if triangles.is_empty() && curved.is_empty() {
            return Ok(());
        }
        let normals = (!normals.is_empty()).then(|| {
            let mut normals = SmoothNormals { normals, corners };
            self.normals_replaced += shading_normals::repair(&mut normals, &positions, &triangles);
            normals
        });
        let input = ObjectInput {
            material: self.material,
            polygons: Some(polygons),
            curved,
            normals,
            ..ObjectInput::new(self.name(), positions, triangles)
        };
        builder.add_object(input).map_err(|error| error.to_string())
    }

    /// Says what is not drawn as the file has it.
    pub(super) fn warn(&self, builder: &mut SceneBuilder) {
        for (count, what, noun) in [
            (self.without_fill, "what comes before the first `f` is drawn grey", "primitive"),
            (self.flat, "polygons of fewer than three corners are not drawn", "polygon"),
            (
                self.crossed,
                "outlines that cross themselves are cut into triangles as far as possible",
                "polygon",
            ),
            (
                self.normals_replaced,
                "normals of zero or infinite length are replaced by the face's",
                "corner",
            ),
        ] {
            if count > 0 {
                builder.warn(format!("{what} ({})", counted(count, noun)));
            }
        }
    }
}

/// What passes through a surface; nothing if the transmittance is 0, and then the index means nothing.
fn transmission(transmittance: f32, refractive_index: f32) -> Result<Option<Transmission>, String> {
    if !(0.0..=1.0).contains(&transmittance) {
        return Err(format!("expected a transmittance from 0 to 1, found {transmittance}"));
    }
    if transmittance == 0.0 {
        return Ok(None);
    }
    if refractive_index <= 0.0 {
        return Err(format!("expected an index of refraction above 0, found {refractive_index}"));
    }
    Ok(Some(Transmission { transmittance: [transmittance; 3], refractive_index }))
}
