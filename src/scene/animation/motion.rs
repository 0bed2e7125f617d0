//! What moves in a scene, without the scene.

use super::curve::joined;
use super::rig::{Joint, JointNumber, Local, Rig};
use crate::error::Result;
use crate::scene::{Camera, Light, ObjectInput};
use glam::DAffine3;
use std::sync::Arc;

/// Something that has a value at every time.
pub trait Track<T>: Send + Sync {
    /// The value at a time in seconds.
    ///
    /// # Errors
    /// A line if there is none then.
    fn at(&self, time: f64) -> std::result::Result<T, String>;

    /// The times of its first and last key.
    fn range(&self) -> Option<(f64, f64)>;
}

/// Geometry in a space that moves. What it is made of, its name and its part in shadows are those of the object that it is
/// part of.
pub trait Placeable: Send + Sync {
    /// Its positions, triangles, surfaces, normals and texture coordinates where a transform takes them; without one they are
    /// as they are, bit by bit.
    ///
    /// # Errors
    /// If a curved surface would not keep its kind.
    fn placed(&self, transform: Option<&DAffine3>) -> Result<ObjectInput>;

    /// Whether it can be placed there, which is found out faster than by doing it.
    ///
    /// # Errors
    /// As [`placed`](Placeable::placed).
    fn check(&self, transform: &DAffine3) -> Result<()>;
}

/// Where something is: in the space of a joint, and moved there once more.
#[derive(Clone, Default)]
pub struct Hold {
    /// The joint that it hangs on; `None` is the world.
    pub joint: Option<JointNumber>,
    /// From its own space to that of the joint, if they differ.
    pub offset: Option<DAffine3>,
}

impl Hold {
    /// From its own space to the world, if that is not the same.
    pub fn transform(&self, worlds: &[DAffine3]) -> Option<DAffine3> {
        match (self.joint, self.offset) {
            (Some(joint), Some(offset)) => Some(worlds[joint as usize] * offset),
            (Some(joint), None) => Some(worlds[joint as usize]),
            (None, offset) => offset,
        }
    }
}

/// A part of an object that moves, or of which another part does.
#[derive(Clone)]
pub struct MovingPart {
    /// What it is in its own space.
    pub geometry: Arc<dyn Placeable>,
    /// Where that is.
    pub hold: Hold,
}

/// An object of which something moves.
#[derive(Clone)]
pub struct MovingObject {
    /// Its place in [`Scene::objects`](crate::scene::Scene::objects).
    pub index: usize,
    /// All that it is made of.
    pub parts: Vec<MovingPart>,
}

/// A value that stays in its own space, or changes there.
#[derive(Clone)]
pub enum Subject<T> {
    /// Always this.
    Still(T),
    /// This at each time.
    Moving(Arc<dyn Track<T>>),
}

/// A light or a camera that moves.
#[derive(Clone)]
pub struct MovingElement<T> {
    /// Its place among the lights or the cameras of the scene, which has its name.
    pub index: usize,
    /// What it is in its own space.
    pub subject: Subject<T>,
    /// Where that is.
    pub hold: Hold,
}

/// What moves in a scene.
#[derive(Clone, Default)]
pub struct Motion {
    /// Spaces that move.
    pub rig: Rig,
    /// By their place in the scene.
    pub objects: Vec<MovingObject>,
    /// The same.
    pub lights: Vec<MovingElement<Light>>,
    /// The same.
    pub cameras: Vec<MovingElement<Camera>>,
}

impl Motion {
    /// Whether nothing moves.
    pub fn is_empty(&self) -> bool {
        self.objects.is_empty() && self.lights.is_empty() && self.cameras.is_empty()
    }

    /// The times in seconds of the first and the last key of all.
    pub fn range(&self) -> Option<(f64, f64)> {
        let joint = |joint: &Joint| match &joint.local {
            Local::Still(_) => None,
            Local::Moving(track) => track.range(),
        };
        let joints = self.rig.joints().iter().map(joint);
        let lights = self.lights.iter().map(|light| light.subject.range());
        joined(joints.chain(lights).chain(self.cameras.iter().map(|camera| camera.subject.range())))
    }
}

impl<T> Subject<T> {
    fn range(&self) -> Option<(f64, f64)> {
        match self {
            Subject::Still(_) => None,
            Subject::Moving(track) => track.range(),
        }
    }
}
