//! Lights. Colours are linear Rec. 709; kinds and units are those of glTF's `KHR_lights_punctual`.

use crate::geometry::LightPosition;
use crate::geometry::cone::LightCone;
use glam::{DAffine3, DVec3, Vec3};

/// A light with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// The name that the scene file gives it; unique after loading.
    pub name: String,
    /// Where it is, where it shines, and how strong.
    pub emitter: Emitter,
}

/// The kinds of lights.
#[derive(Debug, Clone, PartialEq)]
pub enum Emitter {
    /// Shines from one point equally in all directions.
    Point(PointLight),
    /// Shines from one point into a cone.
    Spot(SpotLight),
    /// Shines from infinitely far away.
    Directional(DirectionalLight),
}

/// A light that shines from one point equally in all directions.
#[derive(Debug, Clone, PartialEq)]
pub struct PointLight {
    /// Position in world space.
    pub position: Vec3,
    /// Radiant intensity (power per solid angle).
    pub intensity: [f32; 3],
    /// How its light thins out with distance.
    pub falloff: Falloff,
}

/// How light thins out with distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Falloff {
    /// With the square of the distance, as in nature.
    InverseSquare,
    /// With the square of the distance, down to nothing at this distance, by glTF's rule; above 0.
    Range(f32),
    /// Not at all, as in both papers and NFF: what is said as intensity is the irradiance at any distance.
    Constant,
}

/// A point light that shines into a cone.
#[derive(Debug, Clone, PartialEq)]
pub struct SpotLight {
    /// The light in the direction of the axis.
    pub point: PointLight,
    /// Where it shines.
    pub cone: Cone,
}

/// The cone of a spot light, half its opening below a right angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Where the light looks, in world space; not zero, not normalised.
    pub axis: Vec3,
    /// Cosine of the angle from the axis within which the light has its full strength, above `cos_outer`.
    pub cos_inner: f32,
    /// Cosine of the angle from the axis at which nothing is left, from 0 up. Those very bits are the cone:
    /// a point is in it if the exact cosine is above.
    pub cos_outer: f32,
}

/// A light that shines from infinitely far away, along parallel lines.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectionalLight {
    /// From surfaces towards the light, in world space; not zero, not normalised.
    pub towards: Vec3,
    /// Irradiance on a surface that faces it (power per area).
    pub irradiance: [f32; 3],
}

impl Light {
    /// A light that shines equally in all directions.
    pub fn point(name: impl Into<String>, light: PointLight) -> Light {
        Light { name: name.into(), emitter: Emitter::Point(light) }
    }

    /// The far end of its shadow segments.
    pub fn position(&self) -> LightPosition {
        match &self.emitter {
            Emitter::Point(light) | Emitter::Spot(SpotLight { point: light, .. }) => {
                LightPosition::At(light.position)
            }
            Emitter::Directional(light) => LightPosition::Towards(light.towards),
        }
    }

    /// The cone that it shines into, if it is a spot light.
    pub fn cone(&self) -> Option<&Cone> {
        match &self.emitter {
            Emitter::Spot(light) => Some(&light.cone),
            Emitter::Point(_) | Emitter::Directional(_) => None,
        }
    }

    /// The points that it shines on, if it is a spot light.
    pub fn lit_cone(&self) -> Option<LightCone> {
        match &self.emitter {
            Emitter::Spot(SpotLight { point, cone }) => {
                Some(LightCone { apex: point.position, axis: cone.axis, cosine: cone.cos_outer })
            }
            Emitter::Point(_) | Emitter::Directional(_) => None,
        }
    }

    /// Its strength: radiant intensity, or irradiance if it is infinitely far away.
    pub fn strength(&self) -> [f32; 3] {
        match &self.emitter {
            Emitter::Point(light) | Emitter::Spot(SpotLight { point: light, .. }) => light.intensity,
            Emitter::Directional(light) => light.irradiance,
        }
    }

    /// The light where a transform takes it, each coordinate computed in f64 and rounded once, or `None` if
    /// that leaves no finite position or no direction. Strength, range and cone stay as they are.
    pub fn transformed(&self, transform: &DAffine3) -> Option<Light> {
        let place = |point: Vec3| {
            let placed = transform.transform_point3(point.as_dvec3()).as_vec3();
            placed.is_finite().then_some(placed)
        };
        let turn = |direction: Vec3| direction_of(transform.transform_vector3(direction.as_dvec3()));
        let mut light = self.clone();
        match &mut light.emitter {
            Emitter::Point(point) => point.position = place(point.position)?,
            Emitter::Spot(SpotLight { point, cone }) => {
                point.position = place(point.position)?;
                cone.axis = turn(cone.axis)?;
            }
            Emitter::Directional(light) => light.towards = turn(light.towards)?,
        }
        Some(light)
    }

    /// The kind in one word.
    pub fn kind(&self) -> &'static str {
        match self.emitter {
            Emitter::Point(_) => "point",
            Emitter::Spot(_) => "spot",
            Emitter::Directional(_) => "directional",
        }
    }
}

impl Cone {
    /// A cone by the cosines of its angles in f64, the outer one from 0 up and not above the inner one.
    pub(super) fn new(axis: Vec3, cos_inner: f64, cos_outer: f64) -> Cone {
        let cos_outer = (cos_outer as f32).max(0.0);
        let mut cos_inner = cos_inner as f32;
        // Equal angles make a hard border, and close ones can have one cosine in f32.
        if cos_inner <= cos_outer {
            cos_inner = cos_outer.next_up();
        }
        Cone { axis, cos_inner, cos_outer }
    }
}

/// A direction rounded once, if that leaves one.
pub(super) fn direction_of(exact: DVec3) -> Option<Vec3> {
    let direction = exact.as_vec3();
    (direction.is_finite() && direction != Vec3::ZERO).then_some(direction)
}
