//! The first point of a ray on a surface, exactly.

use super::Crossing;
use super::meeting::discriminant;
use super::on_line::OnLine;
use super::ray_start::RayStart;
use super::root::{self, ExactParameter, Field, exact_place};
use super::shape::Shape;
use crate::geometry::Sign;
use crate::geometry::bounded::Bounded;
use crate::geometry::number::Number;
use crate::geometry::ray_triangle::RayParameter;
use crate::geometry::surd::Surd;
use glam::Vec3;
use std::cmp::Ordering;

/// A point where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvedHit {
    /// The place on the ray.
    pub parameter: RayParameter,
    /// Which of the points of the ray's line on the surface.
    pub crossing: Crossing,
}

impl Shape {
    /// The first point of a ray on this surface, beyond its start. A touch is a hit; a ray that runs in the
    /// surface misses it.
    pub fn first_hit(&self, origin: Vec3, direction: Vec3, start: &RayStart) -> Option<CurvedHit> {
        match rounded_hit(self, origin, direction, start.rounded()) {
            Decided::Hit(hit) => Some(hit),
            Decided::Miss => None,
            Decided::Open => exact_hit(self, origin, direction, &start.exact(origin, direction)),
        }
    }

    /// The place of a crossing on a ray that has it, exactly.
    ///
    /// # Panics
    /// If the ray's line does not pass through the surface so.
    pub fn exact_parameter(&self, origin: Vec3, direction: Vec3, crossing: Crossing) -> ExactParameter {
        root::exact_parameter(origin, direction, self, crossing)
    }

    /// Whether a ray touches the surface at a crossing without passing through.
    pub fn is_touched(&self, origin: Vec3, direction: Vec3) -> bool {
        let in_floats = OnLine::new(self, &root::ray_line::<Bounded>(origin, direction));
        discriminant(&in_floats.surface).sign().unwrap_or_else(|| {
            discriminant(&OnLine::new(self, &root::ray_line::<Surd>(origin, direction)).surface).exact_sign()
        }) == Sign::Zero
    }
}

/// What a filter says.
enum Decided {
    Hit(CurvedHit),
    Miss,
    Open,
}

fn rounded_hit(shape: &Shape, origin: Vec3, direction: Vec3, start: RayParameter) -> Decided {
    let on_line = OnLine::new(shape, &root::ray_line::<Bounded>(origin, direction));
    rounded_roots(&on_line, start).unwrap_or(Decided::Open)
}

/// `None` where bounds leave it open.
fn rounded_roots(on_line: &OnLine<Bounded>, start: RayParameter) -> Option<Decided> {
    let q = &on_line.surface;
    let start = Bounded { value: start.value, error: start.error };
    let crossings: &[Crossing] = match (q[2].sign()?, q[1].sign()) {
        (Sign::Zero, Some(Sign::Zero)) => &[],
        (Sign::Zero, sign) if sign? == Sign::Negative => &[Crossing::Entering],
        (Sign::Zero, _) => &[Crossing::Leaving],
        _ => match discriminant(q).sign()? {
            Sign::Negative => &[],
            Sign::Zero => return None,
            Sign::Positive => &[Crossing::Entering, Crossing::Leaving],
        },
    };
    let mut nearest: Option<(Bounded, Crossing)> = None;
    for &crossing in crossings {
        let t = root::place(q, crossing)?;
        if t.minus(&start).sign()? != Sign::Positive || !is_within(on_line, &t)? {
            continue;
        }
        nearest = match nearest {
            Some((other, _)) if t.minus(&other).sign()? == Sign::Positive => nearest,
            _ => Some((t, crossing)),
        };
    }
    Some(match nearest {
        None => Decided::Miss,
        Some((t, crossing)) => {
            Decided::Hit(CurvedHit { parameter: RayParameter { value: t.value, error: t.error }, crossing })
        }
    })
}

/// Whether the bounds hold at a place of the surface.
fn is_within<N: Field>(on_line: &OnLine<N>, t: &N) -> Option<bool> {
    for [g, h] in &on_line.half_spaces {
        if g.plus(&h.times(t)).sign()? == Sign::Negative {
            return Some(false);
        }
    }
    let Some([c, b, a]) = &on_line.within else { return Some(true) };
    Some(c.plus(&t.times(&b.plus(&a.times(t)))).sign()? != Sign::Negative)
}

fn exact_hit(shape: &Shape, origin: Vec3, direction: Vec3, start: &ExactParameter) -> Option<CurvedHit> {
    let on_line = OnLine::new(shape, &root::ray_line::<Surd>(origin, direction));
    let place = |crossing: Crossing| {
        let t = exact_place(&on_line.surface, crossing)?;
        let is_on_it = t.order(start) == Ordering::Greater && is_exactly_within(&on_line, &t);
        is_on_it.then_some((t, crossing))
    };
    let (_, crossing) = [Crossing::Entering, Crossing::Leaving]
        .into_iter()
        .filter_map(place)
        .min_by(|(t, _), (u, _)| t.order(u))?;
    let parameter = RayParameter { value: 0.0, error: f64::INFINITY };
    Some(CurvedHit { parameter, crossing })
}

fn is_exactly_within(on_line: &OnLine<Surd>, t: &ExactParameter) -> bool {
    let (n, m) = (&t.numerator, &Surd::rational(t.denominator.clone()));
    let in_half_spaces =
        on_line.half_spaces.iter().all(|[g, h]| g.times(m).plus(&h.times(n)).exact_sign() != Sign::Negative);
    in_half_spaces
        && on_line.within.as_ref().is_none_or(|[c, b, a]| {
            let value = c.times(&m.squared()).plus(&b.times(&n.times(m))).plus(&a.times(&n.squared()));
            value.exact_sign() != Sign::Negative
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::{Disc, InfinitePlane, Quadric};

    fn rounded(shape: &Shape, origin: Vec3, direction: Vec3) -> Decided {
        rounded_hit(shape, origin, direction, RayStart::origin().rounded())
    }

    /// What floats find: the place and the way through.
    #[track_caller]
    fn hit(shape: &Shape, origin: Vec3, direction: Vec3) -> (f64, Crossing) {
        match rounded(shape, origin, direction) {
            Decided::Hit(hit) => (hit.parameter.value, hit.crossing),
            Decided::Miss => panic!("missed"),
            Decided::Open => panic!("open"),
        }
    }

    fn is_missed(shape: &Shape, origin: Vec3, direction: Vec3) -> bool {
        matches!(rounded(shape, origin, direction), Decided::Miss)
    }

    #[test]
    fn ordinary_rays_need_no_exact_arithmetic() {
        let ball = Shape::sphere(Vec3::Z * 5.0, 1.0);
        assert_eq!(hit(&ball, Vec3::ZERO, Vec3::Z), (4.0, Crossing::Entering));
        assert_eq!(hit(&ball, Vec3::Z * 4.5, Vec3::Z), (1.5, Crossing::Leaving));
        assert!(is_missed(&ball, Vec3::X * 3.0, Vec3::Z) && is_missed(&ball, Vec3::ZERO, -Vec3::Z));
        let cylinder = Shape::cylinder(Vec3::ZERO, Vec3::Y * 2.0, 1.0);
        let (place, crossing) = hit(&cylinder, Vec3::new(-3.0, 1.0, 0.0), Vec3::new(1.0, 0.125, 0.0));
        assert!((place - 2.0).abs() < 1e-12 && crossing == Crossing::Entering);
        assert!(is_missed(&cylinder, Vec3::new(-3.0, 3.0, 0.0), Vec3::X));
        let plane = Shape::Plane(InfinitePlane { point: Vec3::Z * 2.0, normal: Vec3::Z });
        assert_eq!(hit(&plane, Vec3::Z * 5.0, -Vec3::Z), (3.0, Crossing::Entering));
        assert_eq!(hit(&plane, Vec3::ZERO, Vec3::Z), (2.0, Crossing::Leaving));
        assert!(is_missed(&plane, Vec3::ZERO, Vec3::X));
        let disc = Shape::Disc(Disc { centre: Vec3::Z * 2.0, normal: Vec3::Z, radius: 1.0 });
        assert_eq!(hit(&disc, Vec3::ZERO, Vec3::Z), (2.0, Crossing::Leaving));
        assert!(is_missed(&disc, Vec3::X * 1.5, Vec3::Z));
    }

    #[test]
    fn the_nearer_of_two_hits_counts_whichever_way_it_goes_through() {
        // x^2 + y^2 - z^2 = 1: along z a ray outside of the waist leaves the inside and enters it again.
        let waist = Shape::Quadric(Quadric {
            reference: Vec3::ZERO,
            second: [1.0, 1.0, -1.0, 0.0, 0.0, 0.0],
            first: Vec3::ZERO,
            constant: -1.0,
            low: Vec3::splat(-20.0),
            high: Vec3::splat(20.0),
        });
        let (place, crossing) = hit(&waist, Vec3::new(2.0, 0.0, -10.0), Vec3::Z);
        assert!((place - (10.0 - 3.0_f64.sqrt())).abs() < 1e-12);
        assert_eq!(crossing, Crossing::Leaving);
    }

    #[test]
    fn rims_belong_to_discs_exactly() {
        let disc = Shape::Disc(Disc { centre: Vec3::Z * 5.0, normal: Vec3::Z, radius: 1.0 });
        let is_hit =
            |x: f32| disc.first_hit(Vec3::ZERO, Vec3::new(x, 0.0, 5.0), &RayStart::origin()).is_some();
        assert_eq!([1.0_f32.next_down(), 1.0, 1.0_f32.next_up()].map(is_hit), [true, true, false]);
    }

    #[test]
    fn a_touch_is_told_from_what_passes_through_or_by() {
        let ball = Shape::sphere(Vec3::Z * 5.0, 1.0);
        let is_touched = |x: f32| ball.is_touched(Vec3::X * x, Vec3::Z);
        let touched = [0.0, 1.0_f32.next_down(), 1.0, 1.0_f32.next_up(), 3.0].map(is_touched);
        assert_eq!(touched, [false, false, true, false, false]);
    }
}
