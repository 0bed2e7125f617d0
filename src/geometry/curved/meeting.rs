//! Where an open segment meets a surface: how often it passes through, and whether it only touches.
//!
//! The polynomial along the segment is of degree 2 at most, and linear bounds leave one interval of it. How
//! many roots lie in there follows from signs of the polynomial and its derivative at the ends and of the
//! discriminant, so that no root is ever computed: in exact arithmetic everything stays in one field Q(sqrt d).

use super::on_line::OnLine;
use crate::geometry::Sign::{self, Negative, Positive, Zero};
use crate::geometry::number::Number;
use std::cmp::Ordering;

/// Where segments end; their ends do not belong to them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reach {
    /// From 0 to 1.
    Segment,
    /// From 0 without end.
    HalfLine,
}

/// How a segment meets a surface.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Meetings {
    /// How often it passes through from one side to the other, 0 to 2.
    pub crossings: u8,
    /// Whether it touches without passing through.
    pub touches: bool,
}

impl Meetings {
    const NONE: Meetings = Meetings { crossings: 0, touches: false };
    const TOUCH: Meetings = Meetings { crossings: 0, touches: true };

    fn through(crossings: u8) -> Meetings {
        Meetings { crossings, touches: false }
    }

    /// Whether it meets the surface at all.
    pub fn any(self) -> bool {
        self.crossings > 0 || self.touches
    }
}

/// An end of an interval: numerator / denominator, or infinite where that is zero.
#[derive(Clone)]
struct End<N> {
    numerator: N,
    denominator: N,
    kind: EndKind,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum EndKind {
    /// Not part of the interval.
    Open,
    /// Part of it.
    Closed,
    /// Open and infinite.
    Infinite,
}

impl<N: Number> End<N> {
    fn open(at: f32) -> End<N> {
        End { numerator: N::exactly(at), denominator: N::exactly(1.0), kind: EndKind::Open }
    }

    fn infinite() -> End<N> {
        End { numerator: N::exactly(1.0), denominator: N::exactly(0.0), kind: EndKind::Infinite }
    }

    /// The sign of c + b t + a t^2 there, or beyond everything if it is infinite.
    fn sign_of(&self, [c, b, a]: &[N; 3]) -> Option<Sign> {
        if self.kind == EndKind::Infinite {
            return leading_sign([a, b, c]);
        }
        let (n, m) = (&self.numerator, &self.denominator);
        c.times(&m.squared()).plus(&b.times(&n.times(m))).plus(&a.times(&n.squared())).sign()
    }

    /// The sign of b + 2 a t there.
    fn slope_of(&self, [_, b, a]: &[N; 3]) -> Option<Sign> {
        if self.kind == EndKind::Infinite {
            return leading_sign([a, b, b]);
        }
        let rise = a.times(&self.numerator);
        b.times(&self.denominator).plus(&rise).plus(&rise).sign()
    }

    fn order(&self, other: &End<N>) -> Option<Ordering> {
        let difference =
            self.numerator.times(&other.denominator).minus(&other.numerator.times(&self.denominator));
        Some(match difference.sign()? {
            Negative => Ordering::Less,
            Zero => Ordering::Equal,
            Positive => Ordering::Greater,
        })
    }
}

/// The sign of the first that is not zero.
fn leading_sign<N: Number>(coefficients: [&N; 3]) -> Option<Sign> {
    for coefficient in coefficients {
        match coefficient.sign()? {
            Zero => {}
            sign => return Some(sign),
        }
    }
    Some(Zero)
}

/// How a segment meets a surface, unless rounding leaves it open. A segment that lies in the surface does not
/// meet it, as none meets a triangle edge-on.
pub(super) fn meetings<N: Number>(on_line: &OnLine<N>, reach: Reach) -> Option<Meetings> {
    let q = &on_line.surface;
    if let Some(within) = &on_line.within {
        return meeting_with_plane(q, within, reach);
    }
    let mut low = End::open(0.0);
    let mut high = match reach {
        Reach::Segment => End::open(1.0),
        Reach::HalfLine => End::infinite(),
    };
    for [g, h] in &on_line.half_spaces {
        match h.sign()? {
            Zero if g.sign()? == Negative => return Some(Meetings::NONE),
            Zero => {}
            Positive => {
                let end = End { numerator: g.negated(), denominator: h.clone(), kind: EndKind::Closed };
                if end.order(&low)? == Ordering::Greater {
                    low = end;
                }
            }
            Negative => {
                let end = End { numerator: g.clone(), denominator: h.negated(), kind: EndKind::Closed };
                if end.order(&high)? == Ordering::Less {
                    high = end;
                }
            }
        }
    }
    match low.order(&high)? {
        Ordering::Greater => Some(Meetings::NONE),
        Ordering::Equal => {
            let one_point = low.kind == EndKind::Closed && high.kind == EndKind::Closed;
            let met = one_point && low.sign_of(q)? == Zero && !vanishes(q)?;
            Some(if met { Meetings::TOUCH } else { Meetings::NONE })
        }
        Ordering::Less => between(q, &low, &high),
    }
}

fn vanishes<N: Number>(q: &[N; 3]) -> Option<bool> {
    Some(leading_sign([&q[2], &q[1], &q[0]])? == Zero)
}

/// Roots between two different ends.
fn between<N: Number>(q: &[N; 3], low: &End<N>, high: &End<N>) -> Option<Meetings> {
    let closed = |end: &End<N>| u8::from(end.kind == EndKind::Closed);
    match (low.sign_of(q)?, high.sign_of(q)?) {
        (Zero, Zero) => {
            // Both ends are roots, or everything is.
            let count = closed(low) + closed(high);
            Some(if count > 0 && vanishes(q)? { Meetings::NONE } else { Meetings::through(count) })
        }
        (Zero, at_high) => {
            let root = Meetings::through(closed(low));
            match low.slope_of(q)? {
                Zero => Some(if closed(low) > 0 { Meetings::TOUCH } else { Meetings::NONE }),
                slope if slope == at_high => Some(root),
                _ => Some(Meetings::through(root.crossings + 1)),
            }
        }
        (at_low, Zero) => {
            let root = Meetings::through(closed(high));
            match high.slope_of(q)? {
                Zero => Some(if closed(high) > 0 { Meetings::TOUCH } else { Meetings::NONE }),
                slope if slope != at_low => Some(root),
                _ => Some(Meetings::through(root.crossings + 1)),
            }
        }
        (at_low, at_high) if at_low != at_high => Some(Meetings::through(1)),
        (sign, _) => {
            // Two roots or none: the polynomial has to turn in between.
            let turns = low.slope_of(q)? == -sign && high.slope_of(q)? == sign;
            if !turns {
                return Some(Meetings::NONE);
            }
            Some(match discriminant(q).sign()? {
                Negative => Meetings::NONE,
                Zero => Meetings::TOUCH,
                Positive => Meetings::through(2),
            })
        }
    }
}

/// b^2 - 4 a c.
pub(super) fn discriminant<N: Number>([c, b, a]: &[N; 3]) -> N {
    let product = a.times(c);
    let twice = product.plus(&product);
    b.squared().minus(&twice.plus(&twice))
}

/// For a polynomial of degree 1, and a bound that must hold at its root.
fn meeting_with_plane<N: Number>([c, b, _]: &[N; 3], within: &[N; 3], reach: Reach) -> Option<Meetings> {
    // The root -c / b is above 0, and below 1 if that is the end.
    let slope = b.sign()?;
    if slope == Zero || c.sign()? != -slope {
        return Some(Meetings::NONE);
    }
    if reach == Reach::Segment && b.plus(c).sign()? != slope {
        return Some(Meetings::NONE);
    }
    let at_root = within[0]
        .times(&b.squared())
        .minus(&within[1].times(&b.times(c)))
        .plus(&within[2].times(&c.squared()));
    Some(if at_root.sign()? == Negative { Meetings::NONE } else { Meetings::through(1) })
}
