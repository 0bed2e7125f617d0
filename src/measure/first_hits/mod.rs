//! Who finds what a camera sees fastest: the t-buffer, or Embree with rays from the camera.
//!
//! *Frame* is the time from indexed triangles to the triangle of every pixel: Embree's build and all its rays, and all
//! that the t-buffer does. *Query* is without Embree's build; the t-buffer has none. Embree is handed its buffers and the
//! directions of its rays in the form that it reads, and its device is there; none of that is timed. Every grouping,
//! build quality and mode of denormals takes part, in rows and in tiles, in a fast scene and said to be coherent.
//!
//! As in [`bench`](super::bench): a quick round of everyone, and rounds of the best, in which each has a turn.

#[cfg(feature = "embree")]
mod rival;

use super::{Repeated, timed};
use crate::error::Result;
use crate::scene::{Camera, ImageSize, PrimitiveIndex, Scene};
use crate::visibility::t_buffer;

/// What is looked at.
#[derive(Clone, Copy)]
pub struct Look<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Who looks.
    pub camera: &'a Camera,
    /// Of the image.
    pub size: ImageSize,
}

/// One that finds first hits.
#[derive(Debug, Clone)]
pub struct Row {
    /// `t-buffer`, or a mode of Embree.
    pub method: String,
    /// The order of Embree's rays.
    pub order: Option<&'static str>,
    /// Seconds to build.
    pub build: Repeated,
    /// Seconds to ask.
    pub query: Repeated,
    /// Seconds for both.
    pub frame: Repeated,
    /// Pixels at which it sees another triangle than the t-buffer does, whose answers are exact.
    pub differ: u64,
    /// Whether it took part in the rounds.
    pub in_rounds: bool,
}

/// What was measured.
pub struct Measured {
    /// The t-buffer first.
    pub rows: Vec<Row>,
    /// Why Embree is not there, if it is not.
    pub skipped: Option<String>,
}

/// Seconds, and what was seen.
struct Turn {
    build: f64,
    query: f64,
    primitives: Vec<Option<PrimitiveIndex>>,
}

impl Row {
    fn new(method: String, order: Option<&'static str>) -> Row {
        let none = Repeated::default();
        Row {
            method,
            order,
            build: none.clone(),
            query: none.clone(),
            frame: none,
            differ: 0,
            in_rounds: false,
        }
    }

    fn add(&mut self, turn: &Turn, truth: &[Option<PrimitiveIndex>]) {
        self.build.push(turn.build);
        self.query.push(turn.query);
        self.frame.push(turn.build + turn.query);
        self.differ = turn.primitives.iter().zip(truth).filter(|(one, other)| one != other).count() as u64;
    }
}

impl Measured {
    /// The fastest of Embree's over the t-buffer, by a median.
    fn ratio(&self, time: fn(&Row) -> &Repeated) -> Option<f64> {
        let (own, others) = self.rows.split_first()?;
        let others = others.iter().filter(|row| row.in_rounds).map(|row| time(row).median());
        let own = time(own).median();
        others.reduce(f64::min).filter(|_| own > 0.0).map(|embree| embree / own)
    }

    /// Of rays alone.
    pub fn query(&self) -> Option<f64> {
        self.ratio(|row| &row.query)
    }

    /// Of build and rays.
    pub fn frame(&self) -> Option<f64> {
        self.ratio(|row| &row.frame)
    }
}

fn own_turn(look: Look) -> Turn {
    let found = timed(|| t_buffer::first_hits(look.scene, look.camera, look.size));
    Turn { build: 0.0, query: found.seconds, primitives: found.value.primitives }
}

/// Measures with the threads of the pool that this is called in: so many rounds, and so many of Embree's best in them
/// for rays and as many for frames.
///
/// # Errors
/// What Embree reports.
pub fn measure(look: Look, rounds: u32, finalists: usize) -> Result<Measured> {
    let first = own_turn(look);
    let mut rows = vec![Row::new("t-buffer".into(), None)];
    rows[0].in_rounds = true;
    #[cfg(feature = "embree")]
    let skipped = {
        let why = rival::why_not(look.scene);
        if why.is_none() {
            rival::measure(look, &mut rows, &first, rounds, finalists)?;
        }
        why
    };
    #[cfg(not(feature = "embree"))]
    let skipped = {
        let _ = finalists;
        Some("this program was built without Embree".to_string())
    };
    while rows[0].frame.count() < rounds as usize {
        let turn = own_turn(look);
        rows[0].add(&turn, &first.primitives);
    }
    Ok(Measured { rows, skipped })
}
