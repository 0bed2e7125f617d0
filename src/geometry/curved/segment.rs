//! Shadow segments and facing against curved surfaces: bounded floats first, exact numbers where those leave a
//! sign open.

use super::meeting::{Meetings, Reach, meetings};
use super::on_line::{Line, OnLine};
use super::shape::Shape;
use crate::geometry::bounded::Bounded;
use crate::geometry::number::{self, Number, scaled, vector};
use crate::geometry::occlusion::Stage;
use crate::geometry::position::HomogeneousPoint;
use crate::geometry::surd::Surd;
use crate::geometry::{LightPosition, Sign};
use glam::{DVec3, Vec3};

/// Whether a point lies on the surface that it is tested against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Base {
    /// It does, exactly: there the segment begins, and the surface's other root decides.
    Own,
    /// It need not.
    Other,
}

/// The line from a point to a light.
fn line<N: Number>(light: LightPosition, start: [N; 3], weight: N) -> (Line<N>, Reach) {
    match light {
        LightPosition::At(position) => {
            let along = number::minus(&scaled(&vector(position), &weight), &start);
            (Line { start, weight, along }, Reach::Segment)
        }
        LightPosition::Towards(direction) => {
            (Line { start, weight, along: vector(direction) }, Reach::HalfLine)
        }
    }
}

fn rounded_line(light: LightPosition, rounded: DVec3) -> (Line<Bounded>, Reach) {
    line(light, rounded.to_array().map(Bounded::rounded), Bounded::exact(1.0))
}

/// `point` is relative to `origin`.
fn exact_line(light: LightPosition, point: &HomogeneousPoint, origin: Vec3) -> (Line<Surd>, Reach) {
    let weight = point.w.to_surd();
    let from = scaled(&vector::<Surd>(origin), &weight);
    let start = std::array::from_fn(|i| point.xyz[i].to_surd().plus(&from[i]));
    line(light, start, weight)
}

/// How the open segment from a point to a light meets a surface. `rounded` is the exact point with each
/// coordinate correctly rounded; `exact` gives it relative to `origin` when it is needed.
pub(crate) fn meets<'p>(
    shape: &Shape,
    base: Base,
    light: LightPosition,
    rounded: DVec3,
    exact: impl FnOnce() -> &'p HomogeneousPoint,
    origin: Vec3,
) -> (Meetings, Stage) {
    if passes_by(shape, light, rounded) {
        return (Meetings::default(), Stage::Double);
    }
    let (line, reach) = rounded_line(light, rounded);
    let mut on_line = OnLine::new(shape, &line);
    if base == Base::Own {
        on_line.surface[0] = Bounded::exact(0.0);
    }
    if let Some(found) = meetings(&on_line, reach) {
        return (found, Stage::Double);
    }
    let (line, reach) = exact_line(light, exact(), origin);
    let found = meetings(&OnLine::new(shape, &line), reach).expect("exact signs are known");
    (found, Stage::Exact)
}

/// Whether the line of a segment certainly passes by a ball around the surface, which most do.
pub(super) fn passes_by(shape: &Shape, light: LightPosition, rounded: DVec3) -> bool {
    let Some((centre, radius)) = shape.ball() else { return false };
    let along = match light {
        LightPosition::At(light) => light.as_dvec3() - rounded,
        LightPosition::Towards(direction) => direction.as_dvec3(),
    };
    let from = centre - rounded;
    // The line's distance from the centre is |from x along| / |along|. Half a roundoff of the point and one of the
    // difference move the line by less than 4 roundoffs of the coordinates; the cross product, its length and the
    // products on the other side lose 8 of |from| |along|: 1e-12 is 9,000 roundoffs, 1e-14 is 90.
    let doubt = 1e-12 * (rounded.abs().max_element() + centre.abs().max_element() + from.length());
    let reach = radius * (1.0 + 1e-9) + doubt;
    // The direction to a light nearby carries the rounding of the point; that of the light's part is in the doubt.
    let turned = 1e-14 * rounded.abs().max_element() * from.length();
    let across = from.cross(along).length();
    across.is_finite() && across > reach * along.length() + turned
}

/// The side of a surface's tangent plane at a point of it that a light is on: the sign of the polynomial's
/// derivative towards the light.
pub(crate) fn side_of_light<'p>(
    shape: &Shape,
    light: LightPosition,
    rounded: DVec3,
    exact: impl FnOnce() -> &'p HomogeneousPoint,
    origin: Vec3,
) -> Sign {
    let (line, _) = rounded_line(light, rounded);
    let [_, derivative, _] = OnLine::new(shape, &line).surface;
    derivative.sign().unwrap_or_else(|| {
        let (line, _) = exact_line(light, exact(), origin);
        OnLine::new(shape, &line).surface[1].exact_sign()
    })
}
