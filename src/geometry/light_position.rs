//! Where a light is, and the coordinates that everything is held against it in.

use glam::Vec3;

/// A light as the far end of all its segments, in homogeneous coordinates (x, y, z, w).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightPosition {
    /// A point in world space, w = 1.
    At(Vec3),
    /// Infinitely far away in this direction, w = 0: from surfaces towards the light, in world space, not
    /// zero and not normalised. Its segments are half-lines.
    Towards(Vec3),
}

impl From<Vec3> for LightPosition {
    fn from(point: Vec3) -> LightPosition {
        LightPosition::At(point)
    }
}

impl LightPosition {
    /// Point or direction, and the weight that tells which: 1 or 0.
    pub fn homogeneous(self) -> (Vec3, f32) {
        match self {
            LightPosition::At(point) => (point, 1.0),
            LightPosition::Towards(direction) => (direction, 0.0),
        }
    }
}

/// A light and the origin of coordinates relative to it.
///
/// The origin takes part in no answer. It is the light itself, where most planes of a point light meet, or
/// the middle of the casters, so that their coordinates are no larger than they must be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSpace {
    light: LightPosition,
    origin: Vec3,
    reach: f64,
}

impl LightSpace {
    /// The space of a light over casters inside a box, given by its lowest and highest corner.
    pub fn new(light: LightPosition, (low, high): (Vec3, Vec3)) -> LightSpace {
        match light {
            LightPosition::At(point) => LightSpace::from(point),
            LightPosition::Towards(_) => {
                let origin = low * 0.5 + high * 0.5;
                let far = (high.as_dvec3() - origin.as_dvec3()).max(origin.as_dvec3() - low.as_dvec3());
                LightSpace { light, origin, reach: far.element_sum() * (1.0 + 8.0 * f64::EPSILON) }
            }
        }
    }

    /// The light.
    pub fn light(&self) -> LightPosition {
        self.light
    }

    /// What coordinates are relative to, in world space.
    pub fn origin(&self) -> Vec3 {
        self.origin
    }

    /// For a light infinitely far away, at least the sum of the absolute coordinates of any caster's corner
    /// relative to the origin; 0 for a light at a point.
    pub fn reach(&self) -> f64 {
        self.reach
    }
}

impl From<Vec3> for LightSpace {
    /// The space of a light at a point, which needs to know nothing of the casters.
    fn from(point: Vec3) -> LightSpace {
        LightSpace { light: LightPosition::At(point), origin: point, reach: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_has_no_weight() {
        let v = Vec3::new(1.0, -2.0, 3.0);
        assert_eq!(LightPosition::At(v).homogeneous(), (v, 1.0));
        assert_eq!(LightPosition::Towards(v).homogeneous(), (v, 0.0));
    }

    #[test]
    fn the_reach_is_that_of_the_farthest_corner_from_the_middle() {
        let bounds = (Vec3::new(-1.0, 0.0, 2.0), Vec3::new(3.0, 1.0, 10.0));
        let far = LightSpace::new(LightPosition::Towards(Vec3::Y), bounds);
        assert_eq!(far.origin(), Vec3::new(1.0, 0.5, 6.0));
        // 2 + 0.5 + 4, rounded up.
        assert!(far.reach() >= 6.5 && far.reach() < 6.5 * (1.0 + 1e-14), "{:e}", far.reach());
        let near = LightSpace::new(LightPosition::At(Vec3::Y), bounds);
        assert_eq!((near.origin(), near.reach()), (Vec3::Y, 0.0));
        // A middle that is rounded, away from either end.
        let wide = (Vec3::splat(-1.0), Vec3::splat(f32::MAX));
        let wide = LightSpace::new(LightPosition::Towards(Vec3::Y), wide);
        let corner = |x: f32| (Vec3::splat(x).as_dvec3() - wide.origin().as_dvec3()).abs().element_sum();
        assert!(wide.reach() >= corner(-1.0) && wide.reach() >= corner(f32::MAX));
    }
}
