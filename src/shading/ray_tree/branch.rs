//! Directions of reflected and refracted rays.

use glam::DVec3;

/// The mirrored direction; `normal` is of unit length.
pub fn reflected(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - normal * (2.0 * direction.dot(normal))
}

/// The direction behind a surface by Snell's law, `None` where reflection is total.
///
/// `direction` and `normal` are of unit length, the normal on the side that the direction comes from; `ratio` is
/// the refractive index of that side over that of the other.
pub fn refracted(direction: DVec3, normal: DVec3, ratio: f64) -> Option<DVec3> {
    let cosine = -direction.dot(normal);
    let squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    (squared >= 0.0).then(|| direction * ratio + normal * (ratio * cosine - squared.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_mirror_turns_the_part_along_the_normal() {
        let direction = DVec3::new(0.6, -0.8, 0.0);
        assert!((reflected(direction, DVec3::Y) - DVec3::new(0.6, 0.8, 0.0)).length() < 1e-15);
    }

    #[test]
    fn sines_are_in_the_ratio_of_the_indices() {
        let direction = DVec3::new(0.6, -0.8, 0.0);
        let bent = refracted(direction, DVec3::Y, 1.0 / 1.5).unwrap();
        assert_relative_eq!(bent.length(), 1.0, epsilon = 1e-15);
        assert_relative_eq!(bent.x, 0.6 / 1.5, epsilon = 1e-15);
        assert!(bent.y < 0.0);
        assert!((refracted(direction, DVec3::Y, 1.0).unwrap() - direction).length() < 1e-15);
    }

    #[test]
    fn beyond_the_critical_angle_reflection_is_total() {
        let at = |sine: f64| DVec3::new(sine, -(1.0 - sine * sine).sqrt(), 0.0);
        assert!(refracted(at(0.66), DVec3::Y, 1.5).is_some());
        assert!(refracted(at(0.67), DVec3::Y, 1.5).is_none());
    }
}
