//! The diffuse colour of a point on a surface.

use super::normal::barycentric;
use crate::scene::{Image, Mapping, Material, Pattern, PrimitiveIndex, Scene, Texels, Texture};
use crate::scene::{TextureCoordinates, Wrap, dual};
use glam::DVec3;
use std::sync::LazyLock;

/// The diffuse colour of a material at a point of a primitive, linear Rec. 709: the material's own, unless it
/// has a texture.
///
/// The one place where textures are looked at.
pub fn surface_colour(
    scene: &Scene,
    primitive: PrimitiveIndex,
    material: &Material,
    position: DVec3,
) -> [f32; 3] {
    let Some(texture) = material.texture else { return material.diffuse };
    let texture = &scene.textures[texture as usize];
    match place(scene, primitive, texture, position) {
        Some(place) if place.is_finite() => colour(&texture.pattern, material.diffuse, place),
        _ => material.diffuse,
    }
}

/// The coordinates that a texture has at a point.
fn place(scene: &Scene, primitive: PrimitiveIndex, texture: &Texture, position: DVec3) -> Option<DVec3> {
    match texture.mapping {
        Mapping::Solid { origin, size } => Some((position - origin.as_dvec3()) / f64::from(size)),
        Mapping::Planar { origin, u, v } => {
            let from_origin = position - origin.as_dvec3();
            let [along_u, along_v] = dual(u, v)?;
            Some(DVec3::new(along_u.dot(from_origin), along_v.dot(from_origin), 0.0))
        }
        Mapping::Coordinates if scene.is_curved(primitive) => None,
        Mapping::Coordinates => {
            let object = scene.object(primitive);
            let coordinates = object.texture_coordinates.as_ref()?;
            let weights = barycentric(scene.corners(primitive).map(|c| c.as_dvec3()), position);
            Some(interpolated(coordinates, (primitive - object.first) as usize, weights))
        }
    }
}

fn interpolated(given: &TextureCoordinates, triangle: usize, weights: [f64; 3]) -> DVec3 {
    let corners = given.corners[triangle].map(|corner| given.coordinates[corner as usize]);
    let along = |axis: usize| (0..3).map(|i| weights[i] * f64::from(corners[i][axis])).sum::<f64>();
    DVec3::new(along(0), 1.0 - along(1), 0.0)
}

fn colour(pattern: &Pattern, own: [f32; 3], place: DVec3) -> [f32; 3] {
    match pattern {
        Pattern::Checker { other } => {
            let cells: f64 = place.to_array().map(|x| x.floor().rem_euclid(2.0)).iter().sum();
            if cells % 2.0 == 0.0 { own } else { *other }
        }
        Pattern::Image { image, wrap } => {
            let texel = bilinear(image, *wrap, place.x, 1.0 - place.y);
            std::array::from_fn(|i| (f64::from(own[i]) * texel[i]).clamp(0.0, 1.0) as f32)
        }
    }
}

/// The colour between the centres of the four nearest texels; `v` counts downwards.
fn bilinear(image: &Image, wrap: [Wrap; 2], u: f64, v: f64) -> [f64; 3] {
    let (left, across) = split(u * f64::from(image.width) - 0.5);
    let (top, down) = split(v * f64::from(image.height) - 0.5);
    let mut sum = [0.0; 3];
    for (row, vertical) in [(top, 1.0 - down), (top.saturating_add(1), down)] {
        for (column, horizontal) in [(left, 1.0 - across), (left.saturating_add(1), across)] {
            let column = wrap[0].texel(column, image.width);
            let row = wrap[1].texel(row, image.height);
            let texel = texel(image, row as usize * image.width as usize + column as usize);
            for (sum, channel) in sum.iter_mut().zip(texel) {
                *sum += horizontal * vertical * f64::from(channel);
            }
        }
    }
    sum
}

/// The whole part and the rest.
fn split(place: f64) -> (i64, f64) {
    let whole = place.floor();
    // Far away it saturates, where neighbouring texels could not be told apart anyway.
    (whole as i64, place - whole)
}

fn texel(image: &Image, index: usize) -> [f32; 3] {
    match &image.texels {
        Texels::Linear(texels) => texels[index],
        Texels::Srgb(texels) => texels[index].map(|byte| LINEAR[usize::from(byte)]),
    }
}

/// What the bytes of sRGB mean, linear.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let encoded = byte as f64 / 255.0;
        let linear =
            if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) };
        linear as f32
    })
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::Shape;
    use crate::scene::{ObjectInput, SceneBuilder};
    use glam::Vec3;
    use std::sync::Arc;

    const WHITE: [f32; 3] = [1.0; 3];
    const BLACK: [f32; 3] = [0.0; 3];

    /// A triangle with texture coordinates, and a sphere, of a white material with this texture.
    fn scene(pattern: Pattern, mapping: Mapping) -> Scene {
        let mut builder = SceneBuilder::new("test");
        let texture = Some(builder.add_texture(Texture { pattern, mapping }).unwrap());
        let material = builder.add_material(Material { diffuse: WHITE, texture, ..Material::default() });
        let corners = vec![[0, 1, 2]];
        let coordinates = vec![[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]];
        let input = ObjectInput {
            material,
            curved: vec![Shape::sphere(Vec3::ZERO, 1.0)],
            texture_coordinates: Some(TextureCoordinates { coordinates, corners: corners.clone() }),
            ..ObjectInput::new("test", vec![Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0], corners)
        };
        builder.add_object(input).unwrap();
        builder.finish()
    }

    fn at(scene: &Scene, primitive: u32, place: [f64; 3]) -> [f32; 3] {
        surface_colour(scene, primitive, scene.material(primitive), DVec3::from(place))
    }

    /// A black texel above and left of a white one, and grey ones.
    fn picture(wrap: Wrap) -> Pattern {
        let grey = [0.5; 3];
        let texels = Texels::Linear(vec![BLACK, grey, grey, WHITE]);
        Pattern::Image { image: Arc::new(Image { width: 2, height: 2, texels }), wrap: [wrap; 2] }
    }

    #[test]
    fn a_solid_checker_changes_at_every_border_of_a_cell() {
        let mapping = Mapping::Solid { origin: Vec3::new(1.0, 0.0, 0.0), size: 2.0 };
        let scene = scene(Pattern::Checker { other: BLACK }, mapping);
        for (place, expected) in [
            ([1.0, 0.0, 0.0], WHITE),
            ([2.9, 1.9, 1.9], WHITE),
            ([3.1, 0.0, 0.0], BLACK),
            ([3.1, 2.1, 0.0], WHITE),
            ([3.1, 2.1, -0.1], BLACK),
            ([0.9, 0.0, 0.0], BLACK),
            ([-1.1, 0.0, 0.0], WHITE),
            ([1e300, 0.0, 0.0], WHITE),
            ([f64::NAN, 0.0, 0.0], WHITE),
        ] {
            assert_eq!(at(&scene, 0, place), expected, "{place:?}");
            assert_eq!(at(&scene, 1, place), expected, "{place:?}");
        }
    }

    #[test]
    fn a_picture_is_met_exactly_at_the_centres_of_texels_and_mixed_between() {
        let mapping = Mapping::Planar { origin: Vec3::ZERO, u: Vec3::X * 4.0, v: Vec3::Y * 4.0 };
        let scene = scene(picture(Wrap::ClampToEdge), mapping);
        // v is upwards: the white texel is below on the right.
        assert_eq!(at(&scene, 0, [1.0, 3.0, 0.0]), BLACK);
        assert_eq!(at(&scene, 0, [3.0, 1.0, 5.0]), WHITE);
        assert_eq!(at(&scene, 0, [1.0, 1.0, 0.0]), [0.5; 3]);
        assert_eq!(at(&scene, 0, [2.0, 2.0, 0.0]), [0.5; 3]);
        assert_eq!(at(&scene, 0, [2.5, 1.0, 0.0]), [0.875; 3]);
        assert_eq!(at(&scene, 0, [-90.0, 90.0, 0.0]), BLACK);
        assert_eq!(at(&scene, 0, [1e300, -1e300, 0.0]), WHITE);
    }

    #[test]
    fn pictures_repeat_and_lie_by_coordinates_where_there_are_some() {
        let repeated = scene(picture(Wrap::Repeat), Mapping::Coordinates);
        // (0.25, 0.25) of the picture from its lower left: grey; a sphere has no coordinates.
        assert_eq!(at(&repeated, 0, [0.5, 0.5, 0.0]), [0.5; 3]);
        assert_eq!(at(&repeated, 0, [0.5, 1.5, 0.0]), BLACK);
        assert_eq!(at(&repeated, 1, [0.5, 1.5, 0.0]), WHITE);
        assert_eq!(at(&repeated, 0, [0.0, 2.0, 0.0]), [0.5; 3]);
    }

    #[test]
    fn bytes_are_decoded_as_srgb() {
        assert_eq!((LINEAR[0], LINEAR[255]), (0.0, 1.0));
        assert!((LINEAR[188] - 0.502_886).abs() < 1e-6 && (LINEAR[10] - 0.003_035_27).abs() < 1e-8);
        let image = Arc::new(Image { width: 1, height: 1, texels: Texels::Srgb(vec![[255, 0, 188]]) });
        let pattern = Pattern::Image { image, wrap: [Wrap::Repeat; 2] };
        let solid = Mapping::Solid { origin: Vec3::ZERO, size: 1.0 };
        let scene = scene(pattern, solid);
        assert_eq!(at(&scene, 1, [0.3, 0.7, 0.0]), [1.0, 0.0, LINEAR[188]]);
    }
}
