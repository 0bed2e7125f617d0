//! Testers from frame to frame: built when they are first asked for, and kept while nothing moved that they depend on.
//!
//! Who owns what is in the types. A [`Still`](crate::scene::animation::Still) owns the objects of all frames in which they stand
//! still, and a [`SceneIndex`](super::SceneIndex) beside it what was found out about them. A [`Keeper`] borrows both, and testers
//! borrow them through it: when an object moves, that scene ends, and no tester can outlive it. So what a keeper has to
//! compare is the light alone. Cameras are not in it: testers answer for any point of the scene's surfaces, whoever sees it, and those
//! that are made of the points of one view (`irregular-z-buffer`) make that anew with each call.

use super::exact::Arbiter;
use super::{BuildInput, BuildOfScene, SceneTester, ShadowTester, TesterEntry};
use crate::error::Result;
use crate::geometry::LightPosition;
use std::collections::HashMap;
use std::sync::Arc;

/// Where testers come from.
pub trait TesterSource<'a> {
    /// The arbiter of a light.
    ///
    /// # Errors
    /// Too little memory.
    fn arbiter(&mut self, input: &BuildInput<'a>) -> Result<Supplied<Arbiter<'a>>>;

    /// A tester of a light.
    ///
    /// # Errors
    /// Whatever the tester reports while it is built.
    fn tester(
        &mut self,
        entry: &TesterEntry,
        input: &BuildInput<'a>,
    ) -> Result<Supplied<dyn ShadowTester + 'a>>;
}

/// A tester, and whether it was there.
pub struct Supplied<T: ?Sized> {
    /// The tester.
    pub tester: Arc<T>,
    /// Whether it was built for this.
    pub origin: Origin,
}

/// Whether a tester was built when it was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Just then.
    Built,
    /// Before.
    Kept {
        /// The frame in which it, or all of it that takes time, was built.
        since: u32,
    },
}

/// Builds whatever it is asked for and keeps nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Fresh;

impl<'a> TesterSource<'a> for Fresh {
    fn arbiter(&mut self, input: &BuildInput<'a>) -> Result<Supplied<Arbiter<'a>>> {
        Ok(Supplied { tester: Arc::new(Arbiter::new(input)), origin: Origin::Built })
    }

    fn tester(
        &mut self,
        entry: &TesterEntry,
        input: &BuildInput<'a>,
    ) -> Result<Supplied<dyn ShadowTester + 'a>> {
        Ok(Supplied { tester: (entry.build)(input)?.into(), origin: Origin::Built })
    }
}

/// Keeps testers for the frames of one still scene.
///
/// A tester is kept from a frame to the next one, if it was asked for in both and its light is at the same place, bit by bit.
/// What belongs to the scene and to no light ([`TesterEntry::of_scene`]) is kept as long as the keeper.
pub struct Keeper<'a> {
    settings: BuildInput<'a>,
    frame: u32,
    arbiters: Kept<Arbiter<'a>>,
    testers: Kept<dyn ShadowTester + 'a>,
    of_scene: HashMap<&'static str, OfScene<'a>>,
}

/// A scene's part of a tester.
struct OfScene<'a> {
    tester: Box<dyn SceneTester + 'a>,
    since: u32,
}

impl<'a> Keeper<'a> {
    /// Nothing yet, for the scene and with the settings of an input; its light means nothing.
    pub fn new(settings: BuildInput<'a>) -> Keeper<'a> {
        Keeper { settings, frame: 0, arbiters: Kept::new(), testers: Kept::new(), of_scene: HashMap::new() }
    }

    /// Begins a frame: what the last one did not ask for goes.
    pub fn begin(&mut self, frame: u32) {
        self.frame = frame;
        self.arbiters.begin();
        self.testers.begin();
    }

    /// Memory in bytes of all that is kept.
    pub fn bytes(&self) -> usize {
        let arbiters = self.arbiters.all().map(Arbiter::bytes).sum::<usize>();
        let testers = self.testers.all().map(ShadowTester::bytes).sum::<usize>();
        arbiters + testers + self.of_scene.values().map(|kept| kept.tester.bytes()).sum::<usize>()
    }

    /// Builds something beside what is kept; if that leaves too little memory for it, in its place.
    fn build<T>(
        &mut self,
        asked: &BuildInput<'a>,
        build: impl Fn(&BuildInput<'a>) -> Result<T>,
    ) -> Result<T> {
        let input = BuildInput { light: asked.light, memory: asked.memory, ..self.settings };
        let kept = self.bytes() as u64;
        let beside = asked.memory.beside("what is kept for other frames", kept);
        let built = beside.and_then(|memory| build(&BuildInput { memory, ..input }));
        match built {
            Err(_) if kept > 0 => {
                self.arbiters.clear();
                self.testers.clear();
                self.of_scene.clear();
                build(&input)
            }
            built => built,
        }
    }

    /// The tester of a light by what is kept of the scene, which is made if it is not there.
    fn under(
        &mut self,
        name: &'static str,
        build: &BuildOfScene,
        asked: &BuildInput<'a>,
    ) -> Result<Supplied<dyn ShadowTester + 'a>> {
        let (frame, light) = (self.frame, asked.light);
        if let Some(OfScene { tester, since }) = self.of_scene.get(name) {
            let origin = Origin::Kept { since: *since };
            return Ok(Supplied { tester: tester.under(light).into(), origin });
        }
        let built = self.build(asked, build)?;
        let tester = built.under(light).into();
        self.of_scene.insert(name, OfScene { tester: built, since: frame });
        Ok(Supplied { tester, origin: Origin::Built })
    }
}

impl<'a> TesterSource<'a> for Keeper<'a> {
    fn arbiter(&mut self, asked: &BuildInput<'a>) -> Result<Supplied<Arbiter<'a>>> {
        let key = Key::new("arbiter", asked.light);
        if let Some((tester, since)) = self.arbiters.find(&key) {
            return Ok(Supplied { tester, origin: Origin::Kept { since } });
        }
        let tester = self.build(asked, |input| Ok(Arc::new(Arbiter::new(input))))?;
        self.arbiters.keep(key, tester.clone(), self.frame);
        Ok(Supplied { tester, origin: Origin::Built })
    }

    fn tester(
        &mut self,
        entry: &TesterEntry,
        asked: &BuildInput<'a>,
    ) -> Result<Supplied<dyn ShadowTester + 'a>> {
        if let Some(build) = entry.of_scene {
            return self.under(entry.name, build, asked);
        }
        let key = Key::new(entry.name, asked.light);
        if let Some((tester, since)) = self.testers.find(&key) {
            return Ok(Supplied { tester, origin: Origin::Kept { since } });
        }
        let tester: Arc<dyn ShadowTester + 'a> = self.build(asked, entry.build)?.into();
        self.testers.keep(key, tester.clone(), self.frame);
        Ok(Supplied { tester, origin: Origin::Built })
    }
}

/// What a tester belongs to beside its scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Key {
    name: &'static str,
    /// The bits of the light's position or direction.
    light: [u32; 4],
}

impl Key {
    fn new(name: &'static str, light: LightPosition) -> Key {
        let (xyz, w) = light.homogeneous();
        let [x, y, z] = xyz.to_array();
        Key { name, light: [x, y, z, w].map(f32::to_bits) }
    }
}

/// Things by their keys.
struct Kept<T: ?Sized>(HashMap<Key, Item<T>>);

struct Item<T: ?Sized> {
    /// The frame that it was built in.
    since: u32,
    /// Whether this frame has asked for it.
    is_asked: bool,
    tester: Arc<T>,
}

impl<T: ?Sized> Kept<T> {
    fn new() -> Kept<T> {
        Kept(HashMap::new())
    }

    fn begin(&mut self) {
        self.0.retain(|_, item| std::mem::take(&mut item.is_asked));
    }

    fn find(&mut self, key: &Key) -> Option<(Arc<T>, u32)> {
        let item = self.0.get_mut(key)?;
        item.is_asked = true;
        Some((item.tester.clone(), item.since))
    }

    fn keep(&mut self, key: Key, tester: Arc<T>, since: u32) {
        self.0.insert(key, Item { since, is_asked: true, tester });
    }

    fn clear(&mut self) {
        self.0.clear();
    }

    fn all(&self) -> impl Iterator<Item = &T> {
        self.0.values().map(|item| item.tester.as_ref())
    }
}
