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
