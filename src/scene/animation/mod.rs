//! A scene over time: what of it moves, and the scene at each frame.
//!
//! A file is read once. What it says at rest is a [`Scene`], what moves is a [`Motion`] beside it, and both together are an
//! [`Animation`]. Only what moves is made anew: objects that move are placed from their own numbers, each coordinate rounded
//! once, and all else is taken over bit by bit.
//!
//! Frames between which no object moves share one scene ([`Still`]), whatever lights and cameras do. That is what
//! kept testers borrow ([`Keeper`](crate::shadow::Keeper)), so that none of them can outlive the objects it was made of.
//!
//! [`curve`] is values between keys, [`rig`] transforms that hang on each other; [`frame_rate`] says when a frame is. Loaders
//! bring what is special about their formats as [`Track`] and [`Placeable`].

pub mod curve;
pub mod frame_rate;
mod motion;
pub mod rig;
mod stills;

pub use frame_rate::FrameRate;
pub use motion::{Hold, Motion, MovingElement, MovingObject, MovingPart, Placeable, Subject, Track};
pub use stills::{Moment, Sights, Still, Stills};

use self::rig::same;
use super::{Camera, Dropped, Light, Object, ObjectInput, Scene, SceneBuilder};
use crate::error::{Error, Result};
use crate::float_environment::StandardFloats;
use glam::DAffine3;
use std::borrow::Cow;

/// A scene and how it moves.
#[derive(Clone)]
pub struct Animation {
    /// The scene at rest: as it is without any frame being asked for.
    pub rest: Scene,
    /// What of it moves.
    pub motion: Motion,
    /// Frames a second, if the file says so.
    pub rate: Option<FrameRate>,
}

impl From<Scene> for Animation {
    /// Nothing moves.
    fn from(rest: Scene) -> Animation {
        Animation { rest, motion: Motion::default(), rate: None }
    }
}

/// A time, and where all joints are then.
#[derive(Debug, Clone)]
pub struct Pose {
    time: f64,
    worlds: Vec<DAffine3>,
}

impl Animation {
    /// Where everything is at a time in seconds.
    ///
    /// # Errors
    /// [`Error::Usage`] if something is nowhere then: a transform that is not finite, a camera without a direction.
    pub fn pose(&self, time: f64) -> Result<Pose> {
        let _floats = StandardFloats::new();
        Ok(Pose { time, worlds: self.motion.rig.worlds(time)? })
    }

    /// Finds out whether everything has a place at a time, without placing all of it.
    ///
    /// # Errors
    /// As [`scene_at`](Animation::scene_at).
    pub fn check(&self, time: f64) -> Result<()> {
        let _floats = StandardFloats::new();
        let pose = self.pose(time)?;
        for object in &self.motion.objects {
            for part in &object.parts {
                if let Some(transform) = part.hold.transform(&pose.worlds) {
                    let named = |error| self.of_object(object.index, &pose, &error);
                    part.geometry.check(&transform).map_err(named)?;
                }
            }
        }
        self.lights(&pose)?;
        self.cameras(&pose).map(drop)
    }

    /// The whole scene at a time in seconds.
    ///
    /// # Errors
    /// As [`pose`](Animation::pose), and if a curved surface would not keep its kind.
    pub fn scene_at(&self, time: f64) -> Result<Scene> {
        let pose = self.pose(time)?;
        let mut scene = self.objects(&pose)?.into_owned();
        scene.lights = self.lights(&pose)?;
        scene.cameras = self.cameras(&pose)?;
        Ok(scene)
    }

    /// Whether all objects are in both poses at the same places, bit by bit.
    pub fn is_still(&self, one: &Pose, other: &Pose) -> bool {
        let mut parts = self.motion.objects.iter().flat_map(|object| &object.parts);
        parts.all(|part| match part.hold.joint {
            Some(joint) => same(&one.worlds[joint as usize], &other.worlds[joint as usize]),
            None => true,
        })
    }

    /// The scene with its objects as they are in a pose; lights and cameras are at rest. What moving objects lose of their
    /// triangles is [dropped](Scene::dropped) and warned of.
    ///
    /// # Errors
    /// [`Error::Usage`] that names an object which cannot be placed.
    pub fn objects(&self, pose: &Pose) -> Result<Cow<'_, Scene>> {
        if self.motion.objects.is_empty() {
            return Ok(Cow::Borrowed(&self.rest));
        }
        let _floats = StandardFloats::new();
        let mut builder = SceneBuilder::extend(Scene { dropped: Dropped::default(), ..self.bare() });
        let mut moving = self.motion.objects.iter().peekable();
        for (index, object) in self.rest.objects.iter().enumerate() {
            match moving.next_if(|moving| moving.index == index) {
                None => builder.take_over(&self.rest, object),
                Some(moving) => {
                    let named = |error| self.of_object(index, pose, &error);
                    let input = placed(object, moving, pose).map_err(named)?;
                    builder.add_object(input).map_err(named)?;
                }
            }
        }
        Ok(Cow::Owned(builder.finish()))
    }

    /// The lights in a pose.
    ///
    /// # Errors
    /// [`Error::Usage`] that names a light which has no place or no direction.
    pub fn lights(&self, pose: &Pose) -> Result<Vec<Light>> {
        let _floats = StandardFloats::new();
        let mut lights = self.rest.lights.clone();
        for moving in &self.motion.lights {
            let name = lights[moving.index].name.clone();
            let light = moving.at(pose, Light::transformed);
            let light = light.map_err(|why| at(&format!("light `{name}`"), pose, &why))?;
            lights[moving.index] = Light { name, ..light };
        }
        Ok(lights)
    }

    /// The cameras in a pose.
    ///
    /// # Errors
    /// [`Error::Usage`] that names a camera which has no place or no direction.
    pub fn cameras(&self, pose: &Pose) -> Result<Vec<Camera>> {
        let _floats = StandardFloats::new();
        let mut cameras = self.rest.cameras.clone();
        for moving in &self.motion.cameras {
            let name = cameras[moving.index].name.clone();
            let camera = moving.at(pose, Camera::transformed);
            let camera = camera.map_err(|why| at(&format!("camera `{name}`"), pose, &why))?;
            cameras[moving.index] = Camera { name, ..camera };
        }
        Ok(cameras)
    }

    /// The scene at rest without its objects.
    fn bare(&self) -> Scene {
        let rest = &self.rest;
        Scene {
            name: rest.name.clone(),
            vertices: Vec::with_capacity(rest.vertices.len()),
            triangles: Vec::with_capacity(rest.triangles.len()),
            curved: Vec::with_capacity(rest.curved.len()),
            objects: Vec::with_capacity(rest.objects.len()),
            materials: rest.materials.clone(),
            alpha_masks: rest.alpha_masks.clone(),
            textures: rest.textures.clone(),
            lights: rest.lights.clone(),
            cameras: rest.cameras.clone(),
            background: rest.background,
            dropped: rest.dropped,
            // Those of the scene at rest have been said.
            warnings: Vec::new(),
        }
    }

    fn of_object(&self, index: usize, pose: &Pose, why: &Error) -> Error {
        at(&format!("object `{}`", self.rest.objects[index].name), pose, &why.to_string())
    }
}

fn at(what: &str, pose: &Pose, why: &str) -> Error {
    Error::Usage(format!("{what} at {} s: {why}", pose.time))
}

/// An object that moves, as the builder takes it.
fn placed(object: &Object, moving: &MovingObject, pose: &Pose) -> Result<ObjectInput> {
    let place = |part: &MovingPart| part.geometry.placed(part.hold.transform(&pose.worlds).as_ref());
    let parts = moving.parts.iter().map(place).collect::<Result<_>>()?;
    let whole = ObjectInput::join(parts).ok_or_else(|| Error::Usage("it has no parts".into()))?;
    Ok(ObjectInput {
        name: object.name.clone(),
        material: object.material,
        shadowing: object.shadowing,
        polygons: Some(object.polygons),
        ..whole
    })
}

impl<T: Clone> MovingElement<T> {
    fn at(
        &self,
        pose: &Pose,
        transformed: impl Fn(&T, &DAffine3) -> Option<T>,
    ) -> std::result::Result<T, String> {
        let own = match &self.subject {
            Subject::Still(own) => own.clone(),
            Subject::Moving(track) => track.at(pose.time)?,
        };
        match self.hold.transform(&pose.worlds) {
            None => Ok(own),
            Some(transform) => transformed(&own, &transform)
                .ok_or_else(|| "its transform leaves it no place or no direction".into()),
        }
    }
}
