//! What certified cells do not hold: primitives with holes, curved ones and transparent ones, and everything under a light
//! infinitely far away. That is rare, and has a light buffer as in 1986 where the scene has such.

use super::light_buffer::LightBuffer;
use super::{BuildInput, Counters, Crossings, Receivers, SceneIndex, ShadowTester};
use crate::error::Result;
use crate::geometry::LightPosition;
use crate::visibility::SurfacePoint;

/// All that is cast beside triangles that are whole; nothing in most scenes.
pub struct Rest<'a>(Option<LightBuffer<'a>>);

impl<'a> Rest<'a> {
    /// What is to be asked beside certified cells.
    ///
    /// # Errors
    /// Those of a light buffer, where one is needed.
    pub fn new(input: &BuildInput<'a>) -> Result<Rest<'a>> {
        let index = match input.light {
            LightPosition::Towards(_) => Some(input.index),
            LightPosition::At(_) => input.index.beside_whole_triangles(input.scene),
        };
        Ok(Rest(index.map(|index| LightBuffer::new(&rest_of(input, index))).transpose()?))
    }

    /// Whether there is nothing.
    pub fn is_empty(&self) -> bool {
        self.0.is_none()
    }

    /// Sets more of the answers: who is dark already need not ask.
    ///
    /// # Errors
    /// Those of the light buffer.
    pub fn add_occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let Some(rest) = &self.0 else { return Ok(Counters::default()) };
        let open: Vec<usize> = (0..points.len()).filter(|&i| !answers[i]).collect();
        let asked: Vec<SurfacePoint> = open.iter().map(|&i| points[i]).collect();
        let mut found = vec![false; asked.len()];
        let counters = rest.occluded(&asked, &mut found)?;
        for (i, occluded) in open.into_iter().zip(found) {
            answers[i] = occluded;
        }
        Ok(counters)
    }

    /// As [`ShadowTester::crossed`].
    ///
    /// # Errors
    /// Those of the light buffer.
    pub fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        match &self.0 {
            Some(rest) => rest.crossed(points, crossings),
            None => {
                points.iter().for_each(|_| crossings.push([]));
                Ok(Counters::default())
            }
        }
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.0.as_ref().map_or(0, |rest| rest.bytes())
    }
}

/// The same input over another index. Receivers on what is not in it are in no list, so that its lists must hold for
/// points anywhere.
fn rest_of<'a>(input: &BuildInput<'a>, index: &'a SceneIndex) -> BuildInput<'a> {
    match std::ptr::eq(index, input.index) {
        true => *input,
        false => BuildInput { index, receivers: Receivers::Anywhere, ..*input },
    }
}
