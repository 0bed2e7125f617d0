//! What moves when files are put into one scene.

use super::document;
use super::within;
use crate::error::Result;
use crate::scene::animation::rig::{Joint, JointNumber, Local};
use crate::scene::animation::{Hold, Motion, MovingObject, MovingPart, Placeable, Subject, Track};
use crate::scene::{Camera, Light, ObjectInput};
use glam::DAffine3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A space that may move: that of the scene, of a file in it, or of a part of that.
#[derive(Clone, Default)]
pub(super) struct Space(Hold);

impl Space {
    /// Whether it moves.
    pub(super) fn moves(&self) -> bool {
        self.0.joint.is_some()
    }
}

/// What moves in a scene that is being put together.
#[derive(Default)]
pub(super) struct Movers {
    pub(super) motion: Motion,
}

/// What moves in a file of another format, with the joints that it has got in the scene; by the numbers in that file.
#[derive(Default)]
pub(super) struct Grafted {
    pub(super) objects: BTreeMap<usize, Vec<MovingPart>>,
    pub(super) lights: BTreeMap<usize, (Subject<Light>, Hold)>,
    pub(super) cameras: BTreeMap<usize, (Subject<Camera>, Hold)>,
}

impl Movers {
    /// A space inside another one: moved there for good, or by a track.
    ///
    /// # Errors
    /// A line if too much moves.
    pub(super) fn within(
        &mut self,
        around: &Space,
        still: Option<DAffine3>,
        track: Option<&Arc<dyn Track<DAffine3>>>,
        name: impl Fn() -> String,
    ) -> std::result::Result<Space, String> {
        let Hold { joint, offset } = &around.0;
        let Some(track) = track else {
            return Ok(Space(Hold { joint: *joint, offset: within(*offset, still) }));
        };
        let parent = self.joint_of(around, &name)?;
        let joint = Joint { parent, local: Local::Moving(track.clone()), name: name().into() };
        Ok(Space(Hold { joint: Some(self.motion.rig.add(joint)?), offset: None }))
    }

    /// A joint whose space is this one; `None` is the world.
    fn joint_of(
        &mut self,
        space: &Space,
        name: impl Fn() -> String,
    ) -> std::result::Result<Option<JointNumber>, String> {
        let Hold { joint, offset } = space.0;
        let Some(offset) = offset else { return Ok(joint) };
        let still = Joint { parent: joint, local: Local::Still(offset), name: name().into() };
        self.motion.rig.add(still).map(Some)
    }

    /// Adds what moves in a file that is placed in a space: its joints.
    ///
    /// # Errors
    /// A line if too much moves.
    pub(super) fn graft(&mut self, file: &Motion, around: &Space) -> std::result::Result<Grafted, String> {
        if file.is_empty() {
            return Ok(Grafted::default());
        }
        let root = self.joint_of(around, || "an included file".into())?;
        let first = self.motion.rig.joints().len() as JointNumber;
        for joint in file.rig.joints() {
            let parent = joint.parent.map(|parent| first + parent).or(root);
            self.motion.rig.add(Joint { parent, ..joint.clone() })?;
        }
        let hold = |hold: &Hold| match hold.joint {
            Some(joint) => Hold { joint: Some(first + joint), offset: hold.offset },
            None => Hold { joint: root, offset: hold.offset },
        };
        let part = |part: &MovingPart| MovingPart { geometry: part.geometry.clone(), hold: hold(&part.hold) };
        let parts = |object: &MovingObject| (object.index, object.parts.iter().map(part).collect());
        Ok(Grafted {
            objects: file.objects.iter().map(parts).collect(),
            lights: file.lights.iter().map(|e| (e.index, (e.subject.clone(), hold(&e.hold)))).collect(),
            cameras: file.cameras.iter().map(|e| (e.index, (e.subject.clone(), hold(&e.hold)))).collect(),
        })
    }

    /// Adds an object of a grafted file.
    pub(super) fn add_grafted(&mut self, index: usize, parts: &[MovingPart]) {
        self.motion.objects.push(MovingObject { index, parts: parts.to_vec() });
    }

    /// Adds an object of parts that are in these spaces.
    pub(super) fn add_object(&mut self, index: usize, parts: Vec<ObjectInput>, spaces: Vec<Space>) {
        let part =
            |(input, Space(hold)): (ObjectInput, Space)| MovingPart { geometry: Arc::new(Part(input)), hold };
        let parts = parts.into_iter().zip(spaces).map(part).collect();
        self.motion.objects.push(MovingObject { index, parts });
    }

    /// A light or camera of a file that is placed in a space, if it moves: by itself, as one of a grafted file, or with that
    /// space.
    ///
    /// # Errors
    /// A line if too much moves.
    pub(super) fn element<T: Clone>(
        &mut self,
        around: &Space,
        still: &T,
        own: Option<&document::MovingElement<T>>,
        grafted: Option<&(Subject<T>, Hold)>,
    ) -> std::result::Result<Option<(Subject<T>, Hold)>, String> {
        match (own, grafted) {
            (_, Some(grafted)) => Ok(Some(grafted.clone())),
            (Some(document::MovingElement { subject, track }), None) => {
                let name = || "a light or camera".to_owned();
                let Space(hold) = self.within(around, None, track.as_ref(), name)?;
                Ok(Some((subject.clone(), hold)))
            }
            (None, None) => Ok(around.moves().then(|| (Subject::Still(still.clone()), around.0.clone()))),
        }
    }
}

/// A mesh or a curved surface in its own space.
struct Part(ObjectInput);

impl Placeable for Part {
    fn placed(&self, transform: Option<&DAffine3>) -> Result<ObjectInput> {
        let mut input = self.0.clone();
        if let Some(transform) = transform {
            input.transform(transform)?;
        }
        Ok(input)
    }

    fn check(&self, transform: &DAffine3) -> Result<()> {
        self.0.check_transform(transform)
    }
}
