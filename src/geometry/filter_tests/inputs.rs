//! Inputs that are hard on float filters: determinants that vanish or nearly do, coordinates of all sizes, denormal
//! ones, and many digits lost to an offset.

use crate::geometry::{ExactPosition, LightPosition, LightSpace};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// A light, a triangle, and a point whose segment passes close by the triangle's border or ends close by its plane.
#[derive(Debug, Clone)]
pub struct Situation {
    pub space: LightSpace,
    pub corners: [Vec3; 3],
    pub position: ExactPosition,
}

/// How coordinates of a lattice become floats.
#[derive(Debug, Clone, Copy)]
enum Size {
    /// All times one power of two, after an offset: exact, but for the widest offsets.
    Even { offset: f64, exponent: i32 },
    /// Each axis times one of its own.
    Uneven { exponents: [i32; 3] },
}

impl Size {
    fn place(self, p: DVec3) -> DVec3 {
        match self {
            Size::Even { offset, exponent } => (p + offset) * 2.0_f64.powi(exponent),
            Size::Uneven { exponents } => p * DVec3::from_array(exponents.map(|e| 2.0_f64.powi(e))),
        }
    }
}

fn size() -> impl Strategy<Value = Size> {
    let exponent = || prop_oneof![4 => -120..=119_i32, 2 => -3..=3_i32, 2 => -149..=-125_i32];
    prop_oneof![
        3 => (prop::sample::select(vec![0.0, 0.0, 64.0, 1048576.0, 6e6]), exponent())
            .prop_map(|(offset, exponent)| Size::Even { offset, exponent: exponent.min(if offset > 0.0 { 100 } else { 119 }) }),
        1 => prop::array::uniform3(exponent()).prop_map(|exponents| Size::Uneven { exponents }),
    ]
}

/// Eight points: of the lattice, where much is exact and coincides, or all of them rough, where everything is rounded.
fn points() -> impl Strategy<Value = [DVec3; 8]> {
    let point = || prop::array::uniform3(-6..=6_i32);
    let beside = || prop::array::uniform3(-0.5..0.5_f64);
    let rough = prop::sample::select(vec![0.0, 1.0]);
    (prop::array::uniform8(point()), prop::array::uniform8(beside()), rough).prop_map(
        |(points, beside, rough)| {
            let place =
                |i: usize| DVec3::from_array(points[i].map(f64::from)) + rough * DVec3::from_array(beside[i]);
            std::array::from_fn(place)
        },
    )
}

/// Steps of an ulp for each coordinate, mostly none.
fn nudge() -> impl Strategy<Value = [i8; 3]> {
    prop::array::uniform3(prop_oneof![4 => Just(0_i8), 1 => -2..=2_i8])
}

fn rounded(p: DVec3, nudge: [i8; 3]) -> Vec3 {
    let mut p = p.as_vec3().to_array();
    for (x, steps) in p.iter_mut().zip(nudge) {
        for _ in 0..steps.unsigned_abs() {
            *x = if steps > 0 { x.next_up() } else { x.next_down() };
        }
    }
    Vec3::from(p)
}

prop_compose! {
    /// The segment's end is `depth` times as far from the light as a place of the triangle, which is a corner, on an
    /// edge or inside, and on the triangle itself where `depth` is 1.
    pub fn situation()(
        size in size(),
        is_far in any::<bool>(),
        points in points(),
        weights in prop::array::uniform3(0..=3_u8),
        depth in prop::sample::select(vec![0.5, 0.999_999_9, 1.0, 1.0, 1.000_000_1, 1.25, 2.0, 8.0]),
        nudges in prop::array::uniform5(nudge()),
        on_ray in any::<bool>(),
    ) -> Situation {
        let [light, eye, first, second, a, b, c, _] = points;
        let corners = [a, b, c];
        let total = weights.iter().map(|&w| f64::from(w)).sum::<f64>().max(1.0);
        let target = (0..3).fold(DVec3::ZERO, |sum, i| sum + corners[i] * (f64::from(weights[i]) / total));
        let place = |p: DVec3, i: usize| rounded(size.place(p), nudges[i]);
        let (end, light) = if is_far {
            // A direction has a size of its own.
            let towards = rounded(light, [0; 3]);
            let towards = if towards == Vec3::ZERO { Vec3::Y } else { towards };
            (target - (depth - 1.0) * towards.as_dvec3(), LightPosition::Towards(towards))
        } else {
            (light + depth * (target - light), LightPosition::At(place(light, 3)))
        };
        let corners = [0, 1, 2].map(|i| place(corners[i], i));
        let end_on_grid = place(end, 4);
        let position = if on_ray {
            let origin = place(eye, 4);
            // A plane through about the same place.
            let triangle = [end, end + first, end + second].map(|p| place(p, 4));
            ExactPosition::OnRay { origin, direction: end_on_grid - origin, triangle }
        } else {
            ExactPosition::Bare(end_on_grid)
        };
        let low = corners.into_iter().reduce(Vec3::min).expect("three");
        let high = corners.into_iter().reduce(Vec3::max).expect("three");
        Situation { space: LightSpace::new(light, (low, high)), corners, position }
    }
}

impl Situation {
    /// Whether all coordinates are finite.
    pub fn is_finite(&self) -> bool {
        let (light, _) = self.space.light().homogeneous();
        let position = match self.position {
            ExactPosition::Bare(p) => p.is_finite(),
            ExactPosition::OnRay { origin, direction, triangle } => {
                origin.is_finite()
                    && direction.is_finite()
                    && direction != Vec3::ZERO
                    && triangle.iter().all(|p| p.is_finite())
            }
            ExactPosition::OnCurved { .. } => false,
        };
        light.is_finite() && position && self.corners.iter().all(|p| p.is_finite())
    }
}
