//! Which way each triangle faces a light, exactly.

use super::projection::{Projected, Projector};
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

/// The exact sign; `corners` are asked for if f32 leaves it open.
///
/// On a side the orientation is that of the projection, mirrored where the side looks against its axis. Differences of
/// coordinates are wrong by 2 delta and their own rounding, 2.2 delta in all, each product by 2.4 delta of the sum
/// of its factors and 5 delta^2, the area by 2.6 delta of the sum of all four and 10 delta^2.
#[inline(always)]
pub(super) fn facing(
    projector: &Projector,
    [a, b, c]: [Projected; 3],
    corners: impl Fn() -> [Vec3; 3],
) -> Facing {
    if (a.side == b.side) & (a.side == c.side) & (a.side != Projected::NOWHERE) {
        let (bu, bv, cu, cv) = (b.u - a.u, b.v - a.v, c.u - a.u, c.v - a.v);
        let area = bu * cv - bv * cu;
        let size = (bu.abs() + bv.abs()) + (cu.abs() + cv.abs());
        let slack = 6.0 * projector.delta * (size + 2.0 * projector.delta);
        let (above, below) = match a.side & 1 {
            0 => (Facing::Positive, Facing::Negative),
            _ => (Facing::Negative, Facing::Positive),
        };
        if area > slack {
            return above;
        }
        if area < -slack {
            return below;
        }
    }
    exactly(projector.light, corners())
}

#[cold]
fn exactly(light: Vec3, corners: [Vec3; 3]) -> Facing {
    match planes::orientation(light, corners) {
        Sign::Zero => Facing::Nothing,
        Sign::Positive => Facing::Positive,
        Sign::Negative => Facing::Negative,
    }
}

#[cfg(test)]
mod tests {
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
        fn the_sign_is_the_exact_one(
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
            prop_assert_eq!(facing(&projector, projected, || corners), exactly(light, corners));
        }
    }
}
