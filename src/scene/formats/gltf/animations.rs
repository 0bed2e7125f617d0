//! Animations: nodes whose translation, rotation or scale changes, and all that hangs on them.
//!
//! All animations of a document are played together, from the beginning. One that moves what an earlier one moves is another
//! take of the same thing and is left out as a whole. Weights of morph targets and properties of extensions are not
//! animated, and neither are the joints of skins; that is said.

use super::accessors::{self, Accessors, Elements, Wanted};
use super::findings::Findings;
use super::nodes::{self, Placed};
use super::schema::{AnimationEntry, ChannelEntry, Document, Node};
use super::totals::ElementError;
use crate::memory::MemoryLimit;
use crate::scene::animation::Track;
use crate::scene::animation::curve::{Channel, Curve, Key, Value, Way, joined};
use crate::scene::animation::rig::{Joint, JointNumber, Local, Rig};
use crate::scene::formats::limits::MAX_KEYS;
use crate::scene::formats::text::printable;
use glam::{DAffine3, DQuat, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// How the transform of a node changes.
pub(super) struct NodeTrack {
    translation: Channel<DVec3>,
    rotation: Channel<DQuat>,
    scale: Channel<DVec3>,
}

impl NodeTrack {
    fn of(node: &Node) -> NodeTrack {
        NodeTrack {
            translation: Channel::Still(node.translation.map_or(DVec3::ZERO, DVec3::from)),
            rotation: Channel::Still(node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array)),
            scale: Channel::Still(node.scale.map_or(DVec3::ONE, DVec3::from)),
        }
    }
}

impl Track<DAffine3> for NodeTrack {
    fn at(&self, time: f64) -> Result<DAffine3, String> {
        let rotation = self.rotation.at(time);
        let length = rotation.length();
        // A cubic between quaternions may leave the sphere, and is brought back to it unless it is at its centre.
        if !(length > 1e-6 && length.is_finite()) {
            return Err("its rotation vanishes".into());
        }
        let (scale, translation) = (self.scale.at(time), self.translation.at(time));
        Ok(DAffine3::from_scale_rotation_translation(scale, rotation / length, translation))
    }

    fn range(&self) -> Option<(f64, f64)> {
        joined([self.translation.range(), self.rotation.range(), self.scale.range()])
    }
}

/// What a channel changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Property {
    Translation,
    Rotation,
    Scale,
}

impl Property {
    fn of(path: &str) -> Option<Property> {
        match path {
            "translation" => Some(Property::Translation),
            "rotation" => Some(Property::Rotation),
            "scale" => Some(Property::Scale),
            _ => None,
        }
    }
}

/// Reads animations.
struct Reader<'r, 'a> {
    document: &'r Document,
    accessors: &'r Accessors<'a>,
    limit: MemoryLimit,
    /// Whether each node is part of the scene.
    is_placed: Vec<bool>,
    keys: u64,
    tracks: BTreeMap<usize, NodeTrack>,
    /// Who moves what.
    movers: BTreeMap<(usize, Property), usize>,
}

/// The tracks of all nodes of the scene that an animation moves.
///
/// # Errors
/// An element and a line for channels, samplers and accessors that do not fit together, and for more than [`MAX_KEYS`].
fn read(
    document: &Document,
    accessors: &Accessors,
    placed: &[Placed],
    findings: &mut Findings,
    limit: MemoryLimit,
) -> Result<BTreeMap<usize, NodeTrack>, ElementError> {
    let mut is_placed = vec![false; document.nodes.len()];
    placed.iter().for_each(|place| is_placed[place.index] = true);
    let (tracks, movers) = (BTreeMap::new(), BTreeMap::new());
    let mut reader = Reader { document, accessors, limit, is_placed, keys: 0, tracks, movers };
    for (number, animation) in document.animations.iter().enumerate() {
        reader.play(number, animation, findings)?;
    }
    Ok(reader.tracks)
}

fn describe(number: usize, animation: &AnimationEntry, channel: usize) -> String {
    match animation.name.as_deref() {
        Some(name) => format!("animation {number} `{}`, channel {channel}", printable(name)),
        None => format!("animation {number}, channel {channel}"),
    }
}

impl Reader<'_, '_> {
    fn play(
        &mut self,
        number: usize,
        animation: &AnimationEntry,
        findings: &mut Findings,
    ) -> Result<(), ElementError> {
        let mut channels = Vec::new();
        for (index, channel) in animation.channels.iter().enumerate() {
            let which = || describe(number, animation, index);
            let at = |why: String| (which(), why);
            let Some(property) = Property::of(&channel.target.path) else {
                let feature = match channel.target.path.as_str() {
                    "weights" => "animated weights of morph targets",
                    _ => "animated properties other than translation, rotation and scale",
                };
                findings.not_drawn(feature, which());
                continue;
            };
            let Some(node) = channel.target.node else { continue };
            let node = self.node(node).map_err(at)?;
            match self.movers.get(&(node, property)) {
                Some(mover) if *mover == number => {
                    let why = "another channel of this animation changes the same";
                    return Err(at(why.into()));
                }
                Some(_) => {
                    findings.other_takes += 1;
                    self.movers.retain(|_, mover| *mover != number);
                    return Ok(());
                }
                None => self.movers.insert((node, property), number),
            };
            channels.push((index, node, property, channel));
        }
        for (index, node, property, channel) in channels {
            let at = |why: String| (describe(number, animation, index), why);
            if self.is_placed[node] {
                self.read_channel(animation, channel, node, property).map_err(at)?;
            }
        }
        Ok(())
    }

    fn node(&self, index: u64) -> Result<usize, String> {
        let nodes = &self.document.nodes;
        let node = usize::try_from(index).ok().filter(|&i| i < nodes.len());
        let node = node.ok_or_else(|| format!("node {index} of {}", nodes.len()))?;
        match nodes[node].matrix {
            Some(_) => Err(format!("node {index} has a matrix, and only its parts can be animated")),
            None => Ok(node),
        }
    }

    fn read_channel(
        &mut self,
        animation: &AnimationEntry,
        channel: &ChannelEntry,
        node: usize,
        property: Property,
    ) -> Result<(), String> {
        let index = channel.sampler;
        let sampler = usize::try_from(index).ok().and_then(|i| animation.samplers.get(i));
        let sampler = sampler.ok_or_else(|| format!("sampler {index} of {}", animation.samplers.len()))?;
        let at = |why: String| format!("sampler {index}: {why}");
        let spline = Spline::of(sampler.interpolation.as_deref()).map_err(at)?;
        // Several channels may share one accessor, so that no bytes of the file bound their sum.
        self.keys =
            self.keys.saturating_add(accessors::find(self.document, sampler.input).map_err(at)?.count);
        if self.keys > MAX_KEYS {
            return Err(format!("all animations together have more than {MAX_KEYS} keys"));
        }
        let bytes = self.keys * size_of::<Key<DQuat>>() as u64;
        self.limit.check("the keys of all animations", bytes).map_err(|error| error.to_string())?;
        let times = self.accessors.read(sampler.input, Wanted::Times);
        let times = times.map_err(|why| at(format!("input: {why}")))?;
        let wanted = if property == Property::Rotation { Wanted::Turns } else { Wanted::Vectors };
        let values = self.accessors.read(sampler.output, wanted);
        let values = values.map_err(|why| at(format!("output: {why}")))?;
        let needed = times.len() * if spline == Spline::Cubic { 3 } else { 1 };
        if values.len() != needed {
            let (found, times) = (values.len(), times.len());
            return Err(at(format!("{found} elements of output, expected {needed} for {times} times")));
        }
        let track = self.tracks.entry(node).or_insert_with(|| NodeTrack::of(&self.document.nodes[node]));
        let vectors = || curve(&times, spline, |i| values.vec3(i)).map_err(at);
        match property {
            Property::Translation => track.translation = Channel::Moving(Arc::new(vectors()?)),
            Property::Scale => track.scale = Channel::Moving(Arc::new(vectors()?)),
            Property::Rotation => {
                let turns = curve(&times, spline, |i| DQuat::from_array(values.numbers(i))).map_err(at)?;
                let is_unit = |key: &Key<DQuat>| (0.5..=2.0).contains(&key.value.length());
                if let Some(key) = turns.keys().iter().position(|key| !is_unit(key)) {
                    return Err(at(format!("expected unit quaternions, and that of key {key} is none")));
                }
                track.rotation = Channel::Moving(Arc::new(turns));
            }
        }
        Ok(())
    }
}

/// How a sampler goes from key to key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Spline {
    Linear,
    Step,
    Cubic,
}

impl Spline {
    fn of(name: Option<&str>) -> Result<Spline, String> {
        match name.unwrap_or("LINEAR") {
            "LINEAR" => Ok(Spline::Linear),
            "STEP" => Ok(Spline::Step),
            "CUBICSPLINE" => Ok(Spline::Cubic),
            other => Err(format!(
                "expected LINEAR, STEP or CUBICSPLINE as its interpolation, found `{}`",
                printable(other)
            )),
        }
    }
}

/// The keys of a sampler. A cubic one has three elements a key: the slope before it, its value, and the slope after it.
fn curve<T: Value>(times: &Elements, spline: Spline, value: impl Fn(usize) -> T) -> Result<Curve<T>, String> {
    let count = times.len();
    let key = |i: usize| {
        let [time] = times.numbers(i);
        match spline {
            Spline::Linear => Key { time, value: value(i), way: Way::Linear },
            Spline::Step => Key { time, value: value(i), way: Way::Step },
            Spline::Cubic => {
                let arriving = value(3 * (i + 1).min(count - 1));
                let way = Way::Cubic { leaving: value(3 * i + 2), arriving };
                Key { time, value: value(3 * i + 1), way }
            }
        }
    };
    let curve = Curve::new((0..count).map(key).collect())?;
    match curve.range().0 >= 0.0 {
        true => Ok(curve),
        false => Err("expected times from 0 up".into()),
    }
}

/// The spaces of nodes that move, with those that hang on them.
pub(super) struct Joints {
    pub(super) rig: Rig,
    of_node: BTreeMap<usize, JointNumber>,
}

impl Joints {
    /// Reads all animations of a document.
    ///
    /// # Errors
    /// An element and a line for whatever is no animation.
    pub(super) fn read(
        document: &Document,
        accessors: &Accessors,
        placed: &[Placed],
        findings: &mut Findings,
        limit: MemoryLimit,
    ) -> Result<Joints, ElementError> {
        let mut joints = Joints { rig: Rig::default(), of_node: BTreeMap::new() };
        if document.animations.is_empty() {
            return Ok(joints);
        }
        let mut tracks = read(document, accessors, placed, findings, limit)?;
        let worlds: BTreeMap<usize, DAffine3> = match tracks.is_empty() {
            true => BTreeMap::new(),
            false => placed.iter().map(|place| (place.index, place.world)).collect(),
        };
        for place in placed {
            let name = || nodes::describe(document, place.index);
            let at = |why: String| (name(), why);
            let parent = place.parent.and_then(|parent| joints.of_node.get(&parent).copied());
            let (parent, local) = match (parent, tracks.remove(&place.index)) {
                (None, None) => continue,
                (Some(parent), None) => (Some(parent), Local::Still(nodes::local(place.node).map_err(at)?)),
                (Some(parent), Some(track)) => (Some(parent), Local::Moving(Arc::new(track) as _)),
                (None, Some(track)) => {
                    let around = match place.parent {
                        None => None,
                        Some(parent) => {
                            let local = Local::Still(worlds[&parent]);
                            let name = nodes::describe(document, parent).into();
                            Some(joints.rig.add(Joint { parent: None, local, name }).map_err(at)?)
                        }
                    };
                    (around, Local::Moving(Arc::new(track) as _))
                }
            };
            let joint = joints.rig.add(Joint { parent, local, name: name().into() }).map_err(at)?;
            joints.of_node.insert(place.index, joint);
        }
        Ok(joints)
    }

    /// The joint of a node that moves.
    pub(super) fn of(&self, node: usize) -> Option<JointNumber> {
        self.of_node.get(&node).copied()
    }

    /// Whether a joint of a skin moves.
    pub(super) fn move_skin(&self, document: &Document, skin: u64) -> bool {
        let skin = usize::try_from(skin).ok().and_then(|i| document.skins.get(i));
        let mut joints = skin.into_iter().flat_map(|skin| &skin.joints);
        joints.any(|&node| usize::try_from(node).is_ok_and(|node| self.of_node.contains_key(&node)))
    }
}
