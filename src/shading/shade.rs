//! The colour of a surface point.

use super::LightSample;
use crate::scene::Material;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Light from everywhere, so that shadows are dark and not black: radiance times the diffuse colour, in
/// linear Rec. 709.
///
/// The papers take one constant; that is `above` equal to `below`. The default is a pale blue sky of about
/// 0.1 over a warmer and darker ground, mixed by the height of the normal: surfaces inside a shadow keep
/// their shape, and sky above shadow reads as outdoors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ambient {
    /// On a surface that faces up (+y).
    pub above: [f64; 3],
    /// On a surface that faces down.
    pub below: [f64; 3],
}

impl Default for Ambient {
    fn default() -> Ambient {
        Ambient { above: [0.085, 0.1, 0.13], below: [0.05, 0.046, 0.042] }
    }
}

impl Ambient {
    /// No light but that of the lights.
    pub const NONE: Ambient = Ambient { above: [0.0; 3], below: [0.0; 3] };

    fn at(&self, normal: DVec3) -> [f64; 3] {
        let sky = (0.5 + 0.5 * normal.y).clamp(0.0, 1.0);
        std::array::from_fn(|i| self.below[i] + sky * (self.above[i] - self.below[i]))
    }
}

/// Radiance from a surface point to the viewer, linear Rec. 709.
///
/// `normal` and `view` are unit vectors, the latter from the surface to the viewer; `lights` are those that
/// the point sees. In the papers' terms, with the light's colour `I = irradiance / pi`:
///
/// `diffuse * ambient + sum of I * (diffuse * N.L + specular * (R.V)^shininess)`
///
/// where `R` is `L` mirrored in `N`. The division by pi makes a white Lambert surface reflect all that it
/// receives, as glTF has it. A light behind the shading normal adds nothing, unless the surface lets light through.
pub fn shade(
    material: &Material,
    normal: DVec3,
    view: DVec3,
    ambient: &Ambient,
    lights: &[LightSample],
) -> [f32; 3] {
    let from_everywhere = ambient.at(normal);
    let mut radiance: [f64; 3] = std::array::from_fn(|i| f64::from(material.diffuse[i]) * from_everywhere[i]);
    for light in lights {
        let cosine = normal.dot(light.towards);
        // What shines through from behind is scattered as evenly as what shines from the front.
        let lambert = if material.transmission.is_some() { cosine.abs() } else { cosine };
        if lambert <= 0.0 {
            continue;
        }
        let highlight =
            if cosine > 0.0 { phong(material, normal, view, light.towards, lambert) } else { 0.0 };
        for (i, channel) in radiance.iter_mut().enumerate() {
            let reflected =
                f64::from(material.diffuse[i]) * lambert + f64::from(material.specular[i]) * highlight;
            *channel += light.irradiance[i] * FRAC_1_PI * reflected;
        }
    }
    radiance.map(|channel| channel as f32)
}

/// `(R.V)^shininess`, or 0 where the mirrored light goes away from the viewer.
fn phong(material: &Material, normal: DVec3, view: DVec3, towards: DVec3, lambert: f64) -> f64 {
    if material.specular == [0.0; 3] {
        return 0.0;
    }
    let mirrored = normal * (2.0 * lambert) - towards;
    // Rounding may make the product of two unit vectors a little more than 1, which a high power would show.
    libm::pow(mirrored.dot(view).clamp(0.0, 1.0), f64::from(material.shininess.max(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    fn material(diffuse: f32, specular: f32, shininess: f32) -> Material {
        Material { diffuse: [diffuse; 3], specular: [specular; 3], shininess, ..Material::default() }
    }

    fn light(towards: DVec3, irradiance: f64) -> LightSample {
        LightSample { towards: towards.normalize(), irradiance: [irradiance; 3] }
    }

    #[test]
    fn a_white_surface_under_irradiance_pi_is_one() {
        let colour =
            shade(&material(1.0, 0.0, 1.0), DVec3::Y, DVec3::Y, &Ambient::NONE, &[light(DVec3::Y, PI)]);
        assert_relative_eq!(colour[0], 1.0);
    }

    #[test]
    fn lambert_goes_with_the_cosine_and_lights_add_up() {
        let slanted = light(DVec3::new(0.0, 1.0, 3.0_f64.sqrt()), PI);
        let one = shade(&material(0.5, 0.0, 1.0), DVec3::Y, DVec3::Y, &Ambient::NONE, &[slanted]);
        let two = shade(&material(0.5, 0.0, 1.0), DVec3::Y, DVec3::Y, &Ambient::NONE, &[slanted; 2]);
        assert_relative_eq!(one[1], 0.25, epsilon = 1e-6);
        assert_relative_eq!(two[1], 0.5, epsilon = 1e-6);
    }

    #[test]
    fn the_highlight_peaks_in_the_mirror_direction_and_falls_by_its_power() {
        let (towards, mirrored) = (DVec3::new(1.0, 1.0, 0.0), DVec3::new(-1.0, 1.0, 0.0).normalize());
        let at = |view: DVec3, shininess: f32| {
            let glossy = material(0.0, 1.0, shininess);
            shade(&glossy, DVec3::Y, view, &Ambient::NONE, &[light(towards, PI)])[0]
        };
        assert_relative_eq!(at(mirrored, 1000.0), 1.0, epsilon = 1e-5);
        assert_relative_eq!(at(DVec3::Y, 2.0), 0.5, epsilon = 1e-6);
        assert_relative_eq!(at(DVec3::Y, 8.0), 1.0 / 16.0, epsilon = 1e-6);
        assert_eq!(at(DVec3::new(1.0, -1.0, 0.0).normalize(), 2.0), 0.0);
    }

    #[test]
    fn a_light_behind_the_surface_leaves_the_ambient_term() {
        let ambient = Ambient::default();
        let behind = light(DVec3::NEG_Y, 100.0);
        let colour = shade(&material(1.0, 1.0, 5.0), DVec3::Y, DVec3::Y, &ambient, &[behind]);
        assert_eq!(colour, ambient.above.map(|channel| channel as f32));
        let under = shade(&material(1.0, 0.0, 5.0), DVec3::NEG_Y, DVec3::NEG_Y, &ambient, &[]);
        assert_eq!(under, ambient.below.map(|channel| channel as f32));
        assert_relative_eq!(ambient.at(DVec3::X)[0], (0.085 + 0.05) / 2.0);
    }
}
