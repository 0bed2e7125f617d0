//! Transforms that hang on each other, and where they are at a time.

use super::Track;
use crate::error::{Error, Result};
use glam::DAffine3;
use std::sync::Arc;

/// The number of a joint in its [`Rig`].
pub type JointNumber = u32;

/// The most joints of a scene; each takes some hundred bytes at each time.
pub const MAX_MOVING_JOINTS: usize = 1 << 20;

/// A space that may move in another one.
#[derive(Clone)]
pub struct Joint {
    /// The space that it is in, a joint of a smaller number; `None` is the world.
    pub parent: Option<JointNumber>,
    /// From the joint's space to that of its parent.
    pub local: Local,
    /// What it is called in messages.
    pub name: Arc<str>,
}

/// A transform that stays, or one that changes.
#[derive(Clone)]
pub enum Local {
    /// Always this.
    Still(DAffine3),
    /// This at each time.
    Moving(Arc<dyn Track<DAffine3>>),
}

/// Spaces that move, those that others hang on before them.
#[derive(Clone, Default)]
pub struct Rig(Vec<Joint>);

impl Rig {
    /// Adds a joint and returns its number.
    ///
    /// # Errors
    /// A line if there are [`MAX_MOVING_JOINTS`] already.
    ///
    /// # Panics
    /// If there is no such parent.
    pub fn add(&mut self, joint: Joint) -> std::result::Result<JointNumber, String> {
        assert!(joint.parent.is_none_or(|parent| (parent as usize) < self.0.len()), "parents come first");
        if self.0.len() == MAX_MOVING_JOINTS {
            return Err(format!("expected at most {MAX_MOVING_JOINTS} nodes and files that move"));
        }
        self.0.push(joint);
        Ok(self.0.len() as JointNumber - 1)
    }

    /// All joints.
    pub fn joints(&self) -> &[Joint] {
        &self.0
    }

    /// From the space of each joint to the world at a time in seconds; finite.
    ///
    /// # Errors
    /// [`Error::Usage`] that names a joint which is nowhere at that time.
    pub fn worlds(&self, time: f64) -> Result<Vec<DAffine3>> {
        let mut worlds: Vec<DAffine3> = Vec::with_capacity(self.0.len());
        for Joint { parent, local, name } in &self.0 {
            let nowhere = |why: &str| Error::Usage(format!("{name} at {time} s: {why}"));
            let local = match local {
                Local::Still(transform) => *transform,
                Local::Moving(track) => track.at(time).map_err(|why| nowhere(&why))?,
            };
            let world = parent.map_or(local, |parent| worlds[parent as usize] * local);
            if !world.is_finite() {
                return Err(nowhere("its transform in the world is not finite"));
            }
            worlds.push(world);
        }
        Ok(worlds)
    }
}

/// Whether two transforms are the same, bit by bit.
pub fn same(one: &DAffine3, other: &DAffine3) -> bool {
    let bits = |transform: &DAffine3| transform.to_cols_array().map(f64::to_bits);
    bits(one) == bits(other)
}
