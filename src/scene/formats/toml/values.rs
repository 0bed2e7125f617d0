//! Numbers as a TOML scene writes them, checked while they are read, so that an error has a line.

use glam::{DVec3, Vec3};
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// The most that a channel of a light may be, so that all that is computed from it is finite.
pub(in crate::scene::formats) const BRIGHTEST: f64 = 1e30;

/// A finite number, written with or without a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Number(pub(super) f64);

/// Exactly so many values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Exactly<T, const N: usize>(pub(super) [T; N]);

/// One number for all three, or three.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OneOrThree(pub(super) DVec3);

/// A place in 32 bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point(pub(super) Vec3);

/// A direction in 32 bits: not zero, not normalised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Direction(pub(super) Vec3);

/// What a surface reflects of each channel, from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Share(pub(super) [f32; 3]);

/// How strong a light is in each channel, from 0 to [`BRIGHTEST`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Strength(pub(super) [f32; 3]);

struct NumberVisitor;

impl Visitor<'_> for NumberVisitor {
    type Value = Number;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Number, E> {
        match number.is_finite() {
            true => Ok(Number(number)),
            false => Err(E::custom(format!("expected a finite number, found {number}"))),
        }
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Number, E> {
        Ok(Number(number as f64))
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Number, D::Error> {
        deserializer.deserialize_any(NumberVisitor)
    }
}

struct ExactlyVisitor<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de> + Copy, const N: usize> Visitor<'de> for ExactlyVisitor<T, N> {
    type Value = Exactly<T, N>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "an array of {N} values")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Exactly<T, N>, A::Error> {
        let mut values = Vec::with_capacity(N);
        while values.len() < N
            && let Some(value) = sequence.next_element()?
        {
            values.push(value);
        }
        let mut found = values.len();
        // serde's own arrays would pass over what is too much.
        while sequence.next_element::<IgnoredAny>()?.is_some() {
            found += 1;
        }
        let values: [T; N] = match values.try_into() {
            Ok(values) if found == N => values,
            _ => return Err(A::Error::custom(format!("expected {N} values, found {found}"))),
        };
        Ok(Exactly(values))
    }
}

impl<'de, T: Deserialize<'de> + Copy, const N: usize> Deserialize<'de> for Exactly<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Exactly<T, N>, D::Error> {
        deserializer.deserialize_any(ExactlyVisitor(PhantomData))
    }
}

struct OneOrThreeVisitor;

impl<'de> Visitor<'de> for OneOrThreeVisitor {
    type Value = OneOrThree;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or an array of 3")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<OneOrThree, E> {
        NumberVisitor.visit_f64(number).map(|Number(number)| OneOrThree(DVec3::splat(number)))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<OneOrThree, E> {
        self.visit_f64(number as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<OneOrThree, A::Error> {
        ExactlyVisitor::<Number, 3>(PhantomData).visit_seq(sequence).map(|three| OneOrThree(three.vector()))
    }
}

impl<'de> Deserialize<'de> for OneOrThree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<OneOrThree, D::Error> {
        deserializer.deserialize_any(OneOrThreeVisitor)
    }
}

impl Exactly<Number, 3> {
    pub(super) fn vector(self) -> DVec3 {
        DVec3::from_array(self.0.map(|Number(number)| number))
    }
}

/// Three numbers rounded to 32 bits.
fn rounded<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec3, D::Error> {
    let exact = Exactly::<Number, 3>::deserialize(deserializer)?.vector();
    let vector = exact.as_vec3();
    match vector.is_finite() {
        true => Ok(vector),
        false => Err(D::Error::custom("expected numbers in the range of 32-bit floats")),
    }
}

impl<'de> Deserialize<'de> for Point {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Point, D::Error> {
        rounded(deserializer).map(Point)
    }
}

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Direction, D::Error> {
        match rounded(deserializer)? {
            Vec3::ZERO => Err(D::Error::custom("expected a direction, found zero in 32 bits")),
            direction => Ok(Direction(direction)),
        }
    }
}

/// One or three channels, each from 0 to `most`.
fn channels<'de, D: Deserializer<'de>>(deserializer: D, most: f64) -> Result<[f32; 3], D::Error> {
    let OneOrThree(exact) = OneOrThree::deserialize(deserializer)?;
    match exact.to_array().iter().find(|channel| !(0.0..=most).contains(*channel)) {
        Some(channel) => {
            Err(D::Error::custom(format!("expected a number from 0 to {most:e}, found {channel}")))
        }
        None => Ok(exact.as_vec3().to_array()),
    }
}

impl<'de> Deserialize<'de> for Share {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Share, D::Error> {
        channels(deserializer, 1.0).map(Share)
    }
}

impl<'de> Deserialize<'de> for Strength {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Strength, D::Error> {
        channels(deserializer, BRIGHTEST).map(Strength)
    }
}
