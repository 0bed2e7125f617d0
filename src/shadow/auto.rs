//! `auto`: the irregular z-buffer for a view that is drawn once, the light buffer for all that are drawn after it.
//!
//! Whether there will be another view is not known when the first comes. Nothing is lost by waiting for it, or not much: what
//! is made for one view and dropped costs about as much as cells that are kept, with a million triangles and a million and
//! a half queries 150 to 300 ms against 140 to 600 ms on the machine of ARCHITECTURE's figures, and from the second
//! view on a query of kept cells takes a third to a quarter of the time. So the first view makes nothing that stays, and the second one
//! does. A scene of few triangles has cells at once: there, points are what takes the time.
//!
//! What is chosen depends on counts alone, and no answer depends on it.

use super::irregular_z_buffer::IrregularZBuffer;
use super::{
    Basis, Batching, BuildInput, Counters, Crossings, Lights, ShadowTester, TesterEntry, kept_light_buffer,
};
use crate::error::Result;
use crate::visibility::{Points, RoundedPoint, SurfacePoint};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// `auto`, beside the registry: a choice among its testers.
pub static ENTRY: TesterEntry = TesterEntry {
    name: "auto",
    basis: Basis::Exact,
    lights: Lights::All,
    build: &|input| Ok(Box::new(Auto::new(input)?)),
    of_scene: None,
    expected_tests: |_, queries| 10.0 * queries,
};

/// Cells of a scene with at most so many triangles are kept from the first view on.
const FEW_TRIANGLES: usize = 4096;

/// One light over a scene.
pub struct Auto<'a> {
    input: BuildInput<'a>,
    once: IrregularZBuffer<'a>,
    kept: OnceLock<Box<dyn ShadowTester + 'a>>,
    /// Whether somebody asked before.
    was_asked: AtomicBool,
}

impl<'a> Auto<'a> {
    /// Prepares the first view.
    ///
    /// # Errors
    /// Those of the irregular z-buffer.
    pub fn new(input: &BuildInput<'a>) -> Result<Auto<'a>> {
        let once = IrregularZBuffer::new(input)?;
        let was_asked = AtomicBool::new(input.scene.triangles.len() <= FEW_TRIANGLES);
        Ok(Auto { input: *input, once, kept: OnceLock::new(), was_asked })
    }

    /// Cells that are kept. If two ask for them at once, one makes them in vain.
    fn kept(&self) -> Result<&dyn ShadowTester> {
        if let Some(kept) = self.kept.get() {
            return Ok(kept.as_ref());
        }
        let kept = (kept_light_buffer::ENTRY.build)(&self.input)?;
        Ok(self.kept.get_or_init(|| kept).as_ref())
    }
}

impl ShadowTester for Auto<'_> {
    fn batching(&self) -> Batching {
        Batching::Whole
    }

    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        self.occluded_at(Points::new(&RoundedPoint::all(points), points), answers)
    }

    fn occluded_at(&self, points: Points<'_>, answers: &mut [bool]) -> Result<Counters> {
        match self.was_asked.swap(true, Relaxed) {
            true => self.kept()?.occluded_at(points, answers),
            false => self.once.occluded_at(points, answers),
        }
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        self.once.crossed(points, crossings)
    }

    fn bytes(&self) -> usize {
        self.once.bytes() + self.kept.get().map_or(0, |kept| kept.bytes())
    }

    fn statistics(&self) -> Vec<(&'static str, String)> {
        let choice = if self.kept.get().is_some() { "light-buffer" } else { "irregular-z-buffer" };
        let mut statistics = vec![("chosen", choice.to_string())];
        statistics.extend(self.kept.get().iter().flat_map(|kept| kept.statistics()));
        statistics
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ObjectInput, SceneBuilder};
    use crate::shadow::{SceneIndex, exact};
    use glam::Vec3;

    /// A net of triangles with so many squares a side, one above the middle of a larger square.
    fn nets(squares: usize) -> crate::scene::Scene {
        let mut builder = SceneBuilder::new("nets");
        for (size, height) in [(4.0, 0.0), (1.0, 1.0)] {
            let corner = |i: usize| {
                let (x, y) = (i % (squares + 1), i / (squares + 1));
                let place = |k: usize| size * (k as f32 / squares as f32 - 0.5);
                Vec3::new(place(x), place(y), height)
            };
            let vertices = (0..(squares + 1) * (squares + 1)).map(corner).collect();
            let cell = |i: usize| (i / squares * (squares + 1) + i % squares) as u32;
            let next = squares as u32 + 1;
            let triangles = (0..squares * squares).map(cell);
            let triangles = triangles.flat_map(|i| [[i, i + 1, i + next], [i + 1, i + next + 1, i + next]]);
            builder.add_object(ObjectInput::new("net", vertices, triangles.collect())).unwrap();
        }
        builder.finish()
    }

    #[test]
    fn the_second_view_finds_cells_that_are_kept_and_no_answer_changes() {
        for (squares, from_the_first) in [(8, true), (40, false)] {
            let scene = nets(squares);
            let (index, eye) = (SceneIndex::new(&scene), Vec3::new(0.0, 0.5, 9.0));
            let input = BuildInput::new(&scene, &index, Vec3::new(0.3, 0.2, 3.0));
            let floor = 0..2 * (squares * squares) as u32;
            let towards = |t| scene.corners(t).into_iter().sum::<Vec3>() / 3.0 - eye;
            let points: Vec<_> = floor.map(|t| SurfacePoint::on_ray(&scene, eye, towards(t), t)).collect();
            let ask = |tester: &dyn ShadowTester| {
                let mut answers = vec![false; points.len()];
                tester.occluded(&points, &mut answers).unwrap();
                answers
            };
            let truth = ask((exact::ENTRY.build)(&input).unwrap().as_ref());
            assert!(truth.contains(&true) && truth.contains(&false));
            let auto = Auto::new(&input).unwrap();
            assert_eq!(ask(&auto), truth);
            assert_eq!(auto.kept.get().is_some(), from_the_first);
            assert_eq!(ask(&auto), truth);
            assert_eq!(auto.statistics()[0], ("chosen", "light-buffer".to_string()));
        }
    }
}
