//! Which way each triangle faces a light, exactly.

use crate::geometry::{Sign, planes};
use glam::Vec3;

/// The sign of a triangle's orientation as a light sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Facing {
    /// It blocks nothing: its plane holds the light, or it is not of those that are cast here.
    Nothing,
    /// Positive: corners are in the order that [`planes::oriented`] keeps.
    Positive,
    /// Negative.
    Negative,
}

/// The exact sign.
#[cold]
pub(super) fn exactly(light: Vec3, corners: [Vec3; 3]) -> Facing {
    match planes::orientation(light, corners) {
        Sign::Zero => Facing::Nothing,
        Sign::Positive => Facing::Positive,
        Sign::Negative => Facing::Negative,
    }
}

#[cfg(test)]
mod tests {
    use super::super::corners::Corners;
    use super::super::projection::{Projected, Projector};
    use super::*;
    use proptest::prelude::*;

    fn coordinates() -> impl Strategy<Value = Vec3> {
        let coordinate = prop_oneof![-1.0f32..1.0, (-8i8..9).prop_map(|x| f32::from(x) * 0.125)];
        prop::array::uniform3(coordinate).prop_map(Vec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        /// Slivers as seen from the light: two corners and a point near the line between them, on all six sides.
        #[test]
        fn a_certain_sign_is_the_exact_one(
            light in coordinates(),
            a in coordinates(),
            b in coordinates(),
            along in 0.0f32..1.0,
            aside in coordinates(),
            width in prop::sample::select(vec![0.0f32, 1e-7, 1e-5, 0.1]),
            resolution in prop::sample::select(vec![1u32, 3, 512, 4096]),
        ) {
            let corners = [a, b, a + along * (b - a) + width * aside];
            let projector = Projector::new(light, resolution);
            let projected = corners.map(|p| projector.project(p.to_array()));
            let mut sixteen = Corners::default();
            sixteen.set(3, &projected, [0, 1, 2]);
            if sixteen.side[3] != Projected::NOWHERE && let Some(found) = sixteen.facing(&projector)[3] {
                prop_assert_eq!(found, exactly(light, corners));
            }
        }
    }
}
