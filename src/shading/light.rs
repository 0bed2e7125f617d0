//! What a light sends to a point, by the rules of `KHR_lights_punctual`.

use crate::scene::{Cone, DirectionalLight, Emitter, Falloff, Light, PointLight};
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
/// outwards, outside its cone, and at the light itself, where no direction is.
///
/// Attenuation is that of `KHR_lights_punctual`: `1 / d^2`, and with a range
/// `max(min(1 - (d / range)^4, 1), 0) / d^2`, unless the light has none; in a cone by the square of how far
/// the cosine has come from the outer to the inner one.
pub fn sample_light(light: &Light, point: DVec3) -> Option<LightSample> {
    match &light.emitter {
        Emitter::Point(light) => sample_point(light, point),
        Emitter::Spot(light) => {
            let sample = sample_point(&light.point, point)?;
            let share = share_in_cone(&light.cone, -sample.towards);
            let irradiance = sample.irradiance.map(|channel| channel * share);
            (share > 0.0).then_some(LightSample { irradiance, ..sample })
        }
        Emitter::Directional(light) => Some(sample_directional(light)),
    }
}

/// 1 inside the inner cone, 0 outside the outer one; `direction` is of unit length and leads from the light.
fn share_in_cone(cone: &Cone, direction: DVec3) -> f64 {
    let cosine = cone.axis.as_dvec3().normalize().dot(direction);
    let (inner, outer) = (f64::from(cone.cos_inner), f64::from(cone.cos_outer));
    let share = ((cosine - outer) / (inner - outer)).clamp(0.0, 1.0);
    share * share
}

fn sample_directional(light: &DirectionalLight) -> LightSample {
    let towards = light.towards.as_dvec3().normalize();
    LightSample { towards, irradiance: light.irradiance.map(f64::from) }
}

fn sample_point(light: &PointLight, point: DVec3) -> Option<LightSample> {
    let offset = light.position.as_dvec3() - point;
    let squared = offset.length_squared();
    let attenuation = match light.falloff {
        Falloff::InverseSquare => 1.0 / squared,
        Falloff::Range(range) => window(squared, f64::from(range)) / squared,
        Falloff::Constant => 1.0,
    };
    // At the light itself no direction is.
    if !(attenuation > 0.0 && attenuation.is_finite() && squared > 0.0) {
        return None;
    }
    Some(LightSample {
        towards: offset / squared.sqrt(),
        irradiance: light.intensity.map(|channel| f64::from(channel) * attenuation),
    })
}

/// 1 near the light, 0 from the range outwards.
fn window(squared_distance: f64, range: f64) -> f64 {
    let ratio = squared_distance / (range * range);
    (1.0 - ratio * ratio).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SpotLight;
    use approx::assert_relative_eq;
    use glam::Vec3;

    fn point_light(falloff: Falloff) -> PointLight {
        PointLight { position: Vec3::new(0.0, 2.0, 0.0), intensity: [8.0, 4.0, 1.0], falloff }
    }

    fn light(falloff: Falloff) -> Light {
        Light::point("test", point_light(falloff))
    }

    #[test]
    fn a_spot_light_fades_from_its_inner_to_its_outer_cone() {
        let cone = Cone { axis: Vec3::new(0.0, -3.0, 0.0), cos_inner: 0.8, cos_outer: 0.6 };
        let spot = SpotLight { point: point_light(Falloff::InverseSquare), cone };
        let spot = Light { name: "spot".into(), emitter: Emitter::Spot(spot) };
        let share = |x: f64| {
            let point = DVec3::new(x, 0.0, 0.0);
            let all = sample_light(&light(Falloff::InverseSquare), point).unwrap().irradiance[0];
            sample_light(&spot, point).map(|sample| sample.irradiance[0] / all)
        };
        assert_eq!(share(0.0), Some(1.0));
        assert_eq!(share(1.4), Some(1.0));
        // The cosine is 0.7, half way between the two.
        let half_way = 2.0 * (1.0f64 / 0.49 - 1.0).sqrt();
        assert_relative_eq!(share(half_way).unwrap(), 0.25, epsilon = 1e-6);
        assert_eq!(share(2.7), None);
    }

    #[test]
    fn a_directional_light_is_the_same_everywhere() {
        let sun = DirectionalLight { towards: Vec3::new(0.0, 0.0, 5.0), irradiance: [3.0, 2.0, 1.0] };
        let sun = Light { name: "sun".into(), emitter: Emitter::Directional(sun) };
        let expected = LightSample { towards: DVec3::Z, irradiance: [3.0, 2.0, 1.0] };
        for point in [DVec3::ZERO, DVec3::splat(1e30)] {
            assert_eq!(sample_light(&sun, point), Some(expected));
        }
    }

    #[test]
    fn without_a_range_it_is_the_inverse_square() {
        let sample = sample_light(&light(Falloff::InverseSquare), DVec3::ZERO).unwrap();
        assert_eq!(sample.towards, DVec3::Y);
        assert_eq!(sample.irradiance, [2.0, 1.0, 0.25]);
    }

    #[test]
    fn with_a_range_it_fades_as_the_gltf_extension_says() {
        let half_way = sample_light(&light(Falloff::Range(4.0)), DVec3::ZERO).unwrap();
        assert_relative_eq!(half_way.irradiance[0], 2.0 * (1.0 - 1.0 / 16.0));
        assert_eq!(sample_light(&light(Falloff::Range(2.0)), DVec3::ZERO), None);
        assert_eq!(sample_light(&light(Falloff::Range(1.0)), DVec3::ZERO), None);
    }

    #[test]
    fn without_falloff_it_is_the_same_at_every_distance() {
        let far = sample_light(&light(Falloff::Constant), DVec3::new(0.0, -1e9, 0.0)).unwrap();
        assert_eq!(far.irradiance, [8.0, 4.0, 1.0]);
    }

    #[test]
    fn at_the_light_itself_there_is_none() {
        assert_eq!(sample_light(&light(Falloff::InverseSquare), DVec3::new(0.0, 2.0, 0.0)), None);
        assert_eq!(sample_light(&light(Falloff::Constant), DVec3::new(0.0, 2.0, 0.0)), None);
    }
}
