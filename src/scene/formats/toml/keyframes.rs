//! Keyframes: what moves, and how.
//!
//! A keyframe says of some keys of its table what they are at a frame. Each key has a curve of its own through the keyframes
//! that name it; keys that none of them names stay. At rest, where no frame is asked for, a key is what the table itself
//! says, and what the first keyframe says that names it where the table says nothing.

use super::document::Complaint;
use super::schema::{
    CameraEntry, CameraKey, InterpolationName, LightEntry, LightKey, RotationEntry, TransformEntry,
    TransformKey,
};
use super::transforms;
use super::values::{Direction, Exactly, Number, OneOrThree, Point, Strength};
use super::{cameras, lights};
use crate::scene::animation::Track;
use crate::scene::animation::curve::{Channel, Curve, Key, Value, Way, joined};
use crate::scene::{Camera, FrameRate, Light};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::sync::Arc;
use toml::Spanned;

/// What every keyframe says.
pub(super) trait Keyframe {
    fn frame(&self) -> f64;
    fn way<T>(&self) -> Way<T>;
    /// Whether it says anything else.
    fn says_something(&self) -> bool;
    fn rotate(&self) -> Option<RotationEntry>;
    fn translate(&self) -> Option<Exactly<Number, 3>>;
    fn scale(&self) -> Option<OneOrThree>;
}

macro_rules! keyframe {
    ($entry:ident, $($key:ident),*; $scale:expr) => {
        impl Keyframe for $entry {
            fn frame(&self) -> f64 {
                self.frame.0
            }

            fn way<T>(&self) -> Way<T> {
                match self.interpolation {
                    Some(InterpolationName::Step) => Way::Step,
                    None | Some(InterpolationName::Linear) => Way::Linear,
                }
            }

            fn says_something(&self) -> bool {
                [$(self.$key.is_some()),*].contains(&true)
            }

            fn rotate(&self) -> Option<RotationEntry> {
                self.rotate
            }

            fn translate(&self) -> Option<Exactly<Number, 3>> {
                self.translate
            }

            fn scale(&self) -> Option<OneOrThree> {
                let scale: fn(&$entry) -> Option<OneOrThree> = $scale;
                scale(self)
            }
        }
    };
}

keyframe!(TransformKey, scale, rotate, translate; |key| key.scale);
keyframe!(LightKey, position, target, direction, towards, intensity, irradiance, rotate, translate; |_| None);
keyframe!(CameraKey, position, target, up, vertical_degrees, half_height, rotate, translate; |_| None);

/// The keyframes of a table, checked but for what they say.
struct Keyframes<'a, K> {
    keys: &'a [Spanned<K>],
    rate: FrameRate,
}

impl<'a, K: Keyframe> Keyframes<'a, K> {
    /// # Errors
    /// A place and a line if there are none, one says nothing, or their frames do not ascend.
    fn new(keys: &'a [Spanned<K>], at: usize, about: &str, rate: FrameRate) -> Result<Self, Complaint> {
        if keys.is_empty() {
            return Err((at, format!("{about}: expected at least one keyframe, found none")));
        }
        for (number, key) in keys.iter().enumerate() {
            let complaint =
                |why: &str| Err((key.span().start, format!("{about}, keyframe {}: {why}", number + 1)));
            if !key.get_ref().says_something() {
                return complaint("it says nothing but its frame");
            }
            let time = |key: &Spanned<K>| rate.seconds(key.get_ref().frame());
            if number > 0 && time(key) <= time(&keys[number - 1]) {
                return complaint("expected a later frame than that before it");
            }
            if !time(key).is_finite() {
                return complaint("its frame is out of range");
            }
        }
        Ok(Keyframes { keys, rate })
    }

    /// The curve of a key, if a keyframe names it.
    fn curve<T: Value>(&self, mut value: impl FnMut(&K) -> Option<T>) -> Option<Arc<Curve<T>>> {
        let key = |key: &'a Spanned<K>| {
            let key = key.get_ref();
            let time = self.rate.seconds(key.frame());
            Some(Key { time, value: value(key)?, way: key.way() })
        };
        // All numbers are finite, and times ascend: without a curve there is no key.
        Curve::new(self.keys.iter().filter_map(key).collect()).ok().map(Arc::new)
    }

    /// Whether there is something at each keyframe.
    ///
    /// # Errors
    /// A place and a line of the first at which there is nothing.
    fn check<T>(&self, track: &dyn Track<T>, about: &str) -> Result<(), Complaint> {
        for (number, key) in self.keys.iter().enumerate() {
            let found = track.at(self.rate.seconds(key.get_ref().frame()));
            let complaint = |why| (key.span().start, format!("{about}, keyframe {}: {why}", number + 1));
            found.map_err(complaint)?;
        }
        Ok(())
    }

    /// A light or camera: its track, its table at rest, and how it is moved as a whole.
    ///
    /// # Errors
    /// As [`check`](Keyframes::check), or the place of the keyframes and why they cannot move it.
    fn element<E, T>(
        &self,
        track: impl Track<T> + 'static,
        rest: E,
        at: usize,
        about: &str,
    ) -> Result<Element<E, T>, Complaint> {
        self.check(&track, about)?;
        let moved = self.transform(&TransformEntry::default());
        let moved = moved.map_err(|why| (at, format!("{about}: {why}")))?;
        let own = track.range().is_some().then(|| Arc::new(track) as _);
        Ok(Element { rest, own, moved })
    }

    /// What the first keyframe says that names a key.
    fn first<T>(&self, value: impl Fn(&K) -> Option<T>) -> Option<T> {
        self.keys.iter().find_map(|key| value(key.get_ref()))
    }

    /// How it is moved as a whole, if that is said, beside what its table says of that.
    fn transform(&self, base: &TransformEntry) -> Result<Option<Moved>, String> {
        let says = |key: &K| {
            key.scale().is_some().then_some(()).or(key.rotate().map(drop)).or(key.translate().map(drop))
        };
        if self.first(says).is_none() {
            return Ok(None);
        }
        if base.matrix.is_some() {
            return Err("`keyframes` go with `scale`, `rotate` and `translate`, not with `matrix`".into());
        }
        let vector = |Exactly(numbers): Exactly<Number, 3>| DVec3::from_array(numbers.map(|Number(n)| n));
        for key in self.keys {
            let rest = TransformEntry {
                matrix: None,
                scale: key.get_ref().scale(),
                rotate: key.get_ref().rotate(),
                translate: key.get_ref().translate(),
            };
            transforms::read(&rest)?;
        }
        let mut places = (0..).map(f64::from);
        let turns = Turns {
            all: self.keys.iter().filter_map(|key| key.get_ref().rotate()).collect(),
            place: self.curve(|key| key.rotate().and_then(|_| places.next())),
            still: base.rotate,
        };
        let still = |curve: Option<Arc<Curve<DVec3>>>, still: DVec3| {
            curve.map_or(Channel::Still(still), Channel::Moving)
        };
        let track = TransformTrack {
            scale: still(
                self.curve(|key| key.scale().map(|scale| scale.0)),
                base.scale.map_or(DVec3::ONE, |s| s.0),
            ),
            turns,
            translate: still(
                self.curve(|key| key.translate().map(vector)),
                base.translate.map_or(DVec3::ZERO, vector),
            ),
        };
        let rest = TransformEntry {
            matrix: None,
            scale: base.scale.or(self.first(K::scale)),
            rotate: base.rotate.or(self.first(K::rotate)),
            translate: base.translate.or(self.first(K::translate)),
        };
        Ok(Some(Moved { rest: transforms::read(&rest)?, track: Arc::new(track) }))
    }
}

/// A transform that changes.
pub(super) struct Moved {
    /// At rest.
    pub(super) rest: Option<DAffine3>,
    pub(super) track: Arc<dyn Track<DAffine3>>,
}

/// The transform of a mesh, a surface or an included file, if it has keyframes.
///
/// # Errors
/// A place and a line for keyframes that are none.
pub(super) fn of_transform(
    keys: Option<&Spanned<Vec<Spanned<TransformKey>>>>,
    base: Option<&Spanned<TransformEntry>>,
    about: &str,
    rate: FrameRate,
) -> Result<Option<Moved>, Complaint> {
    let Some(keys) = keys else { return Ok(None) };
    let at = keys.span().start;
    let keyframes = Keyframes::new(keys.get_ref(), at, about, rate)?;
    let base = base.map_or_else(TransformEntry::default, |base| *base.get_ref());
    keyframes.transform(&base).map_err(|why| (at, format!("{about}: {why}")))
}

/// A light or camera with keyframes.
pub(super) struct Element<E, T> {
    /// Its table, at rest.
    pub(super) rest: E,
    /// How it changes in its own space, if it does.
    pub(super) own: Option<Arc<dyn Track<T>>>,
    /// How that space moves, if it does.
    pub(super) moved: Option<Moved>,
}

/// A light with keyframes, if it has such.
///
/// # Errors
/// A place and a line for keyframes that are none.
pub(super) fn of_light(
    entry: &LightEntry,
    index: usize,
    about: &str,
    rate: FrameRate,
) -> Result<Option<Element<LightEntry, Light>>, Complaint> {
    let Some(keys) = &entry.keyframes else { return Ok(None) };
    let at = keys.span().start;
    let keyframes = Keyframes::new(keys.get_ref(), at, about, rate)?;
    let point = |point: Point| point.0.as_dvec3();
    let direction = |direction: Direction| direction.0.as_dvec3();
    let strength = |Strength(channels): Strength| DVec3::from_array(channels.map(f64::from));
    let track = LightTrack {
        position: keyframes.curve(|key| key.position.map(point)),
        target: keyframes.curve(|key| key.target.map(point)),
        direction: keyframes.curve(|key| key.direction.map(direction)),
        towards: keyframes.curve(|key| key.towards.map(direction)),
        intensity: keyframes.curve(|key| key.intensity.map(strength)),
        irradiance: keyframes.curve(|key| key.irradiance.map(strength)),
        rest: LightEntry {
            position: entry.position.or(keyframes.first(|key| key.position)),
            target: entry.target.or(keyframes.first(|key| key.target)),
            direction: entry.direction.or(keyframes.first(|key| key.direction)),
            towards: entry.towards.or(keyframes.first(|key| key.towards)),
            intensity: entry.intensity.or(keyframes.first(|key| key.intensity)),
            irradiance: entry.irradiance.or(keyframes.first(|key| key.irradiance)),
            keyframes: None,
            ..entry.clone()
        },
        index,
    };
    let rest = track.rest.clone();
    keyframes.element(track, rest, at, about).map(Some)
}

/// A camera with keyframes, if it has such.
///
/// # Errors
/// A place and a line for keyframes that are none.
pub(super) fn of_camera(
    entry: &CameraEntry,
    index: usize,
    about: &str,
    rate: FrameRate,
) -> Result<Option<Element<CameraEntry, Camera>>, Complaint> {
    let Some(keys) = &entry.keyframes else { return Ok(None) };
    let at = keys.span().start;
    let keyframes = Keyframes::new(keys.get_ref(), at, about, rate)?;
    let point = |point: Point| point.0.as_dvec3();
    let number = |Number(number): Number| number;
    let track = CameraTrack {
        position: keyframes.curve(|key| key.position.map(point)),
        target: keyframes.curve(|key| key.target.map(point)),
        up: keyframes.curve(|key| key.up.map(|up| up.0.as_dvec3())),
        vertical_degrees: keyframes.curve(|key| key.vertical_degrees.map(number)),
        half_height: keyframes.curve(|key| key.half_height.map(number)),
        rest: CameraEntry {
            position: entry.position.or(keyframes.first(|key| key.position)),
            target: entry.target.or(keyframes.first(|key| key.target)),
            up: entry.up.or(keyframes.first(|key| key.up)),
            vertical_degrees: entry.vertical_degrees.or(keyframes.first(|key| key.vertical_degrees)),
            half_height: entry.half_height.or(keyframes.first(|key| key.half_height)),
            keyframes: None,
            ..entry.clone()
        },
        index,
    };
    let rest = track.rest.clone();
    keyframes.element(track, rest, at, about).map(Some)
}

/// Scale, rotation and translation over time.
struct TransformTrack {
    scale: Channel<DVec3>,
    turns: Turns,
    translate: Channel<DVec3>,
}

impl Track<DAffine3> for TransformTrack {
    fn at(&self, time: f64) -> Result<DAffine3, String> {
        let matrix3 = self.turns.at(time)? * DMat3::from_diagonal(self.scale.at(time));
        Ok(DAffine3 { matrix3, translation: self.translate.at(time) })
    }

    fn range(&self) -> Option<(f64, f64)> {
        let turns = self.turns.place.as_ref().map(|place| place.range());
        joined([self.scale.range(), turns, self.translate.range()])
    }
}

/// Rotations over time. Around one axis it goes by the angle, so that 0 to 360 degrees is once around; from one axis to
/// another it goes the shortest way.
struct Turns {
    all: Vec<RotationEntry>,
    /// Where between them it is: at 1.5 halfway between the second and the third.
    place: Option<Arc<Curve<f64>>>,
    still: Option<RotationEntry>,
}

impl Turns {
    fn at(&self, time: f64) -> Result<DMat3, String> {
        let Some(place) = &self.place else {
            return self.still.as_ref().map_or(Ok(DMat3::IDENTITY), transforms::rotation);
        };
        let place = place.at(time);
        let (whole, share) = (place.floor(), place - place.floor());
        let from = self.all[whole as usize];
        let Some(to) = self.all.get(whole as usize + 1).filter(|_| share > 0.0) else {
            return transforms::rotation(&from);
        };
        if from.axis == to.axis {
            let degrees = Number(f64::between(from.degrees.0, to.degrees.0, share));
            return transforms::rotation(&RotationEntry { degrees, ..from });
        }
        let (from, to) = (quaternion(&from)?, quaternion(to)?);
        Ok(DMat3::from_quat(DQuat::between(from, to, share).normalize()))
    }
}

fn quaternion(turn: &RotationEntry) -> Result<DQuat, String> {
    let axis = transforms::axis(turn)?;
    let (sin, cos) = transforms::sin_cos_degrees(turn.degrees.0 * 0.5);
    Ok(DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos))
}

/// A light's own numbers over time.
struct LightTrack {
    rest: LightEntry,
    index: usize,
    position: Option<Arc<Curve<DVec3>>>,
    target: Option<Arc<Curve<DVec3>>>,
    direction: Option<Arc<Curve<DVec3>>>,
    towards: Option<Arc<Curve<DVec3>>>,
    intensity: Option<Arc<Curve<DVec3>>>,
    irradiance: Option<Arc<Curve<DVec3>>>,
}

fn range<T: Value>(curve: &Option<Arc<Curve<T>>>) -> Option<(f64, f64)> {
    curve.as_ref().map(|curve| curve.range())
}

/// A place at a time, if it changes.
fn place(curve: &Option<Arc<Curve<DVec3>>>, time: f64) -> Option<Point> {
    curve.as_ref().map(|curve| Point(curve.at(time).as_vec3()))
}

/// A direction at a time, if it changes.
fn direction(curve: &Option<Arc<Curve<DVec3>>>, time: f64) -> Result<Option<Direction>, String> {
    match curve.as_ref().map(|curve| curve.at(time).as_vec3()) {
        Some(glam::Vec3::ZERO) => Err("its direction vanishes".into()),
        direction => Ok(direction.map(Direction)),
    }
}

fn strength(curve: &Option<Arc<Curve<DVec3>>>, time: f64) -> Option<Strength> {
    curve.as_ref().map(|curve| Strength(curve.at(time).as_vec3().to_array()))
}

impl Track<Light> for LightTrack {
    fn at(&self, time: f64) -> Result<Light, String> {
        let rest = &self.rest;
        let entry = LightEntry {
            position: place(&self.position, time).or(rest.position),
            target: place(&self.target, time).or(rest.target),
            direction: direction(&self.direction, time)?.or(rest.direction),
            towards: direction(&self.towards, time)?.or(rest.towards),
            intensity: strength(&self.intensity, time).or(rest.intensity),
            irradiance: strength(&self.irradiance, time).or(rest.irradiance),
            ..rest.clone()
        };
        lights::read(&entry, self.index)
    }

    fn range(&self) -> Option<(f64, f64)> {
        let LightTrack { position, target, direction, towards, intensity, irradiance, .. } = self;
        joined([position, target, direction, towards, intensity, irradiance].map(range))
    }
}

/// A camera's own numbers over time.
struct CameraTrack {
    rest: CameraEntry,
    index: usize,
    position: Option<Arc<Curve<DVec3>>>,
    target: Option<Arc<Curve<DVec3>>>,
    up: Option<Arc<Curve<DVec3>>>,
    vertical_degrees: Option<Arc<Curve<f64>>>,
    half_height: Option<Arc<Curve<f64>>>,
}

impl Track<Camera> for CameraTrack {
    fn at(&self, time: f64) -> Result<Camera, String> {
        let rest = &self.rest;
        let number = |curve: &Option<Arc<Curve<f64>>>| curve.as_ref().map(|curve| Number(curve.at(time)));
        let entry = CameraEntry {
            position: place(&self.position, time).or(rest.position),
            target: place(&self.target, time).or(rest.target),
            up: direction(&self.up, time)?.or(rest.up),
            vertical_degrees: number(&self.vertical_degrees).or(rest.vertical_degrees),
            half_height: number(&self.half_height).or(rest.half_height),
            ..rest.clone()
        };
        cameras::read(&entry, self.index)
    }

    fn range(&self) -> Option<(f64, f64)> {
        let CameraTrack { position, target, up, vertical_degrees, half_height, .. } = self;
        let numbers = [vertical_degrees, half_height].map(range);
        joined([position, target, up].map(range).into_iter().chain(numbers))
    }
}
