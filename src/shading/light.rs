//! What a point light sends to a point, by glTF's rules.

use crate::scene::PointLight;
use glam::DVec3;

/// Light that arrives at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSample {
    /// Unit vector from the point to the light.
    pub towards: DVec3,
    /// Irradiance on a surface that faces the light (power per area), linear Rec. 709.
    pub irradiance: [f64; 3],
}

/// What an unshadowed light sends to a point in world space; `None` where it sends nothing: from its range
/// outwards, and at the light itself, where no direction is.
///
/// Attenuation is that of `KHR_lights_punctual`: `1 / d^2`, and with a range
/// `max(min(1 - (d / range)^4, 1), 0) / d^2`.
pub fn sample_light(light: &PointLight, point: DVec3) -> Option<LightSample> {
    let offset = light.position.as_dvec3() - point;
    let squared = offset.length_squared();
    let attenuation = window(squared, light.range) / squared;
    if !(attenuation > 0.0 && attenuation.is_finite()) {
        return None;
    }
    Some(LightSample {
        towards: offset / squared.sqrt(),
        irradiance: light.intensity.map(|channel| f64::from(channel) * attenuation),
    })
}

/// 1 near the light, 0 from the range outwards.
fn window(squared_distance: f64, range: Option<f32>) -> f64 {
    let Some(range) = range.map(f64::from) else { return 1.0 };
    let ratio = squared_distance / (range * range);
    (1.0 - ratio * ratio).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use glam::Vec3;

    fn light(range: Option<f32>) -> PointLight {
        PointLight { position: Vec3::new(0.0, 2.0, 0.0), intensity: [8.0, 4.0, 1.0], range }
    }

    #[test]
    fn without_a_range_it_is_the_inverse_square() {
        let sample = sample_light(&light(None), DVec3::ZERO).unwrap();
        assert_eq!(sample.towards, DVec3::Y);
        assert_eq!(sample.irradiance, [2.0, 1.0, 0.25]);
    }

    #[test]
    fn with_a_range_it_fades_as_the_gltf_extension_says() {
        let half_way = sample_light(&light(Some(4.0)), DVec3::ZERO).unwrap();
        assert_relative_eq!(half_way.irradiance[0], 2.0 * (1.0 - 1.0 / 16.0));
        assert_eq!(sample_light(&light(Some(2.0)), DVec3::ZERO), None);
        assert_eq!(sample_light(&light(Some(1.0)), DVec3::ZERO), None);
    }

    #[test]
    fn at_the_light_itself_there_is_none() {
        assert_eq!(sample_light(&light(None), DVec3::new(0.0, 2.0, 0.0)), None);
        assert_eq!(sample_light(&light(Some(0.0)), DVec3::ZERO), None);
    }
}
