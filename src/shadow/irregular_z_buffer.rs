//! The irregular z-buffer: receivers of one view are filed around a light, and occluders cast over them object by object
//! (Johnson et al. 2005, Aila and Laine 2004). For a view that is drawn once.
//!
//! All is made anew for the points of each call, so that nothing is made where nobody asks: the more points come
//! together, the better. Triangles that are whole go through [certified cells](super::certified). What has holes, is
//! curved or lets light through is rare and has a light buffer of its own, where the scene has such.
//! Under a light infinitely far away that light buffer has everything.

use super::certified::Certified;
use super::rest::Rest;
use super::{
    Basis, Batching, BuildInput, Counters, Crossings, Lights, Resolution, ShadowTester, TesterEntry,
};
use crate::error::Result;
use crate::geometry::LightPosition;
use crate::visibility::{Points, RoundedPoint, SurfacePoint};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// `irregular-z-buffer` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "irregular-z-buffer",
    basis: Basis::Exact,
    lights: Lights::All,
    build: &|input| Ok(Box::new(IrregularZBuffer::new(input)?)),
    of_scene: None,
    expected_tests: |_, queries| 10.0 * queries,
};

/// One light over a scene; what belongs to a view is made when its points come.
pub struct IrregularZBuffer<'a> {
    /// Triangles that are whole, under a light at a point.
    whole: Option<Certified<'a>>,
    resolution: Resolution,
    rest: Rest<'a>,
    /// The most memory that a view has needed so far.
    bytes: AtomicU64,
}

impl<'a> IrregularZBuffer<'a> {
    /// Prepares what does not depend on the view.
    ///
    /// # Errors
    /// Those of a light buffer, where one is needed.
    pub fn new(input: &BuildInput<'a>) -> Result<IrregularZBuffer<'a>> {
        let whole = match input.light {
            LightPosition::Towards(_) => None,
            LightPosition::At(light) => Some(Certified {
                scene: input.scene,
                light,
                set: input.instruction_set,
                memory: input.memory,
            }),
        };
        let (resolution, rest) = (input.resolution, Rest::new(input)?);
        Ok(IrregularZBuffer { whole, resolution, rest, bytes: AtomicU64::new(0) })
    }

    fn occluded_by_whole(
        &self,
        whole: &Certified,
        points: Points<'_>,
        answers: &mut [bool],
    ) -> Result<Counters> {
        let resolution = match self.resolution {
            Resolution::Auto => whole.automatic_resolution(points),
            Resolution::Cells(cells) => cells,
        };
        let work = whole.occluded(points, resolution, answers)?;
        self.bytes.fetch_max(work.bytes, Relaxed);
        Ok(work.counters)
    }
}

impl ShadowTester for IrregularZBuffer<'_> {
    fn batching(&self) -> Batching {
        match self.whole {
            Some(_) => Batching::Whole,
            None => Batching::Chunks,
        }
    }

    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        self.occluded_at(Points::new(&RoundedPoint::all(points), points), answers)
    }

    fn occluded_at(&self, points: Points<'_>, answers: &mut [bool]) -> Result<Counters> {
        let mut counters = match &self.whole {
            Some(whole) => self.occluded_by_whole(whole, points, answers)?,
            None => {
                answers.fill(false);
                Counters::default()
            }
        };
        counters += self.rest.add_occluded(points.exact(), answers)?;
        Ok(counters)
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        self.rest.crossed(points, crossings)
    }

    fn bytes(&self) -> usize {
        self.rest.bytes() + self.bytes.load(Relaxed) as usize
    }
}
