//! Frames in their order, and those together between which no object moves.

use super::{Animation, Pose};
use crate::error::Result;
use crate::scene::{Camera, Light, Scene};
use std::borrow::Cow;

/// A frame by its number and its time in seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// The number.
    pub frame: u32,
    /// When that is.
    pub time: f64,
}

/// Objects as they are in some frames, one after the other.
pub struct Still<'a> {
    /// The objects, with what they are made of. Its lights and cameras are those at rest, and not those of the frames
    /// ([`Animation::sights`]).
    pub scene: Cow<'a, Scene>,
    /// The frames, at least one.
    pub moments: Vec<Moment>,
}

/// What a frame has beside objects.
#[derive(Debug, Clone)]
pub struct Sights {
    /// The lights at that time.
    pub lights: Vec<Light>,
    /// The cameras at that time.
    pub cameras: Vec<Camera>,
}

/// All frames in their order, put together where no object moves.
pub struct Stills<'a, I: Iterator<Item = Moment>> {
    animation: &'a Animation,
    moments: I,
    /// Of the moment that was looked at and begins the next still.
    next: Option<(Moment, Pose)>,
}

impl Animation {
    /// The frames of an animation in the order that they are given in.
    pub fn stills<I: IntoIterator<Item = Moment>>(&self, moments: I) -> Stills<'_, I::IntoIter> {
        Stills { animation: self, moments: moments.into_iter(), next: None }
    }

    /// Lights and cameras at a moment.
    ///
    /// # Errors
    /// As [`Animation::pose`].
    pub fn sights(&self, moment: Moment) -> Result<Sights> {
        let pose = self.pose(moment.time)?;
        Ok(Sights { lights: self.lights(&pose)?, cameras: self.cameras(&pose)? })
    }
}

impl<'a, I: Iterator<Item = Moment>> Stills<'a, I> {
    fn posed(&mut self) -> Result<Option<(Moment, Pose)>> {
        if let Some(next) = self.next.take() {
            return Ok(Some(next));
        }
        let Some(moment) = self.moments.next() else { return Ok(None) };
        Ok(Some((moment, self.animation.pose(moment.time)?)))
    }

    fn still(&mut self) -> Result<Option<Still<'a>>> {
        let Some((first, pose)) = self.posed()? else { return Ok(None) };
        let mut moments = vec![first];
        while let Some((moment, other)) = self.posed()? {
            if !self.animation.is_still(&pose, &other) {
                self.next = Some((moment, other));
                break;
            }
            moments.push(moment);
        }
        Ok(Some(Still { scene: self.animation.objects(&pose)?, moments }))
    }
}

impl<'a, I: Iterator<Item = Moment>> Iterator for Stills<'a, I> {
    type Item = Result<Still<'a>>;

    fn next(&mut self) -> Option<Result<Still<'a>>> {
        self.still().transpose()
    }
}
