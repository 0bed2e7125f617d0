//! Many frames of one scene: the loop over them.
//!
//! Frames are drawn in ascending order and get their files one by one, each with its preview at once. Those between which no
//! object moves share one scene and one [`Keeper`]. Which frames there are is said at one place, by the moments that
//! [`render`] begins with: leaving some out leaves the pictures of the others as they are.

use super::super::Outcome;
use super::super::options::ViewOptions;
use super::super::progress::Messages;
use super::super::view::{View, aim};
use super::drawing::{FrameOf, Painter};
use super::facts::{Common, FrameFacts, FrameLightFacts, FramesFacts, ShardFacts};
use super::frame_names::FrameNames;
use super::record::Record;
use super::task::Task;
use super::write_facts;
use crate::error::{Error, Place, Result};
use crate::film::FileSet;
use crate::geometry::LightPosition;
use crate::measure::timed;
use crate::memory::MemoryLimit;
use crate::scene::animation::{Moment, Still};
use crate::scene::{Animation, FrameRate, Scene};
use crate::shadow::{Keeper, SceneIndex};
use glam::Vec3;

/// Frames on their way.
struct Reel<'r> {
    painter: &'r Painter<'r>,
    animation: &'r Animation,
    rate: FrameRate,
    names: &'r FrameNames,
    /// What is left beside the scene at rest.
    limit: MemoryLimit,
    record: Record,
    drawn: Vec<FrameFacts>,
    outcome: Outcome,
}

/// Draws and writes frames, but for those that the record knows to be finished.
///
/// # Errors
/// Before any of them if something is nowhere at one of their times; whatever drawing or writing one of them reports, and
/// those before it stay.
pub fn render(
    painter: &Painter,
    view: View,
    task: &Task,
    frames: &[u32],
    names: &FrameNames,
    mut record: Record,
) -> Result<Outcome> {
    let args = painter.args;
    let size = view.size;
    let animation = Animation { rest: view.scene, motion: view.motion, rate: view.rate };
    let rate = args.fps.or(animation.rate).unwrap_or_default();
    let mut facts = FramesFacts::new(Common::new(painter, &animation.rest.name, size), rate.to_string());
    let moment = |&frame: &u32| Moment { frame, time: rate.seconds(f64::from(frame)) };
    let mut moments: Vec<Moment> = frames.iter().map(moment).collect();
    for moment in &moments {
        animation.check(moment.time).map_err(|error| in_frame(moment.frame, &error))?;
    }
    if animation.motion.is_empty() {
        painter.messages.say("nothing moves in the scene: all frames show the same");
    }
    let limit = match animation.motion.objects.is_empty() {
        true => args.run.memory_limit(),
        false => args.run.memory_limit().beside("the scene at rest", bytes(&animation.rest))?,
    };
    let mut all: Vec<FrameFacts> = Vec::new();
    moments.retain(|moment| {
        let finished: Option<FrameFacts> = record.finished(&names.path(moment.frame));
        let is_left = finished.is_none();
        all.extend(finished);
        is_left
    });
    record.tell(all.len(), frames.len(), painter.messages);
    if frames.is_empty() {
        record.write()?;
    }
    let outcome = record.outcome();
    let mut reel =
        Reel { painter, animation: &animation, rate, names, limit, record, drawn: Vec::new(), outcome };
    for still in animation.stills(moments) {
        reel.draw(&still?)?;
    }
    all.extend(reel.drawn);
    all.sort_by_key(|frame| frame.frame);
    all.into_iter().for_each(|frame| facts.add(frame));
    facts.shard = task.shard.map(|shard| ShardFacts::new(painter, shard, size, facts.seconds()));
    write_facts(args, &facts)?;
    match (frames, task.shard) {
        ([], Some(shard)) => painter
            .messages
            .say(&format!("shard {shard}: nothing to draw, there are fewer frames than shards")),
        _ => painter.messages.say(&facts.summary()),
    }
    Ok(reel.outcome)
}

impl Reel<'_> {
    /// Frames between which no object moves.
    fn draw(&mut self, still: &Still) -> Result<()> {
        let args = self.painter.args;
        if !self.animation.motion.objects.is_empty() {
            warn(&still.scene, still.moments[0].frame, &args.view, self.painter.messages)?;
        }
        let together = if args.rebuild { 1 } else { still.moments.len() };
        for moments in still.moments.chunks(together) {
            let index = args.run.index(&still.scene);
            let nowhere = LightPosition::At(Vec3::ZERO);
            let settings = args.run.build_input(&still.scene, &index, nowhere, self.limit);
            let mut keeper = Keeper::new(settings);
            for &moment in moments {
                keeper.begin(moment.frame);
                self.draw_frame(&still.scene, &index, &mut keeper, moment)?;
            }
        }
        Ok(())
    }

    /// One frame, with its files.
    fn draw_frame<'s>(
        &mut self,
        scene: &'s Scene,
        index: &'s SceneIndex,
        keeper: &mut Keeper<'s>,
        moment: Moment,
    ) -> Result<()> {
        let (painter, path) = (self.painter, self.names.path(moment.frame));
        let sights = self.animation.sights(moment)?;
        let (camera, size) = aim(&sights.cameras, &painter.args.view)?;
        let shot = painter.shot(scene, sights.lights, camera, size)?;
        let work = timed(|| {
            let drawn = painter.draw(&shot, index, keeper, &[], self.limit)?;
            let mut files = FileSet::new();
            let frame = FrameOf { number: moment.frame, rate: self.rate };
            painter.add(&mut files, &path, &shot, &drawn, Some(frame))?;
            files.publish()?;
            Ok(drawn)
        });
        let drawn = work.value.map_err(|error: Error| in_frame(moment.frame, &error))?;
        painter.tell(&shot, &drawn, Some(moment.frame));
        let outcome = if drawn.is_native_wrong() { Outcome::NativeWrong } else { Outcome::Right };
        if outcome == Outcome::NativeWrong {
            self.outcome = outcome;
        }
        let lights = drawn.light_facts(&shot).into_iter().zip(drawn.tester_facts(moment.frame));
        let facts = FrameFacts {
            frame: moment.frame,
            time: moment.time,
            file: path.display().to_string(),
            seconds: work.seconds,
            lights: lights.map(|(light, testers)| FrameLightFacts { light, testers }).collect(),
        };
        self.record.add(&path, outcome, &facts).map_err(|error| in_frame(moment.frame, &error))?;
        painter.messages.say(&format!("wrote {}", path.display()));
        self.drawn.push(facts);
        Ok(())
    }
}

/// The same error with the frame before it.
fn in_frame(frame: u32, error: &Error) -> Error {
    Error::Usage(format!("frame {frame}: {error}"))
}

/// Says what moving objects lose; under `--strict` that is an error.
fn warn(scene: &Scene, frame: u32, options: &ViewOptions, messages: Messages) -> Result<()> {
    for warning in &scene.warnings {
        let warning = format!("frame {frame}: {warning}");
        if options.strict {
            return Err(Error::input(&options.scene, Place::File, format!("{warning} (--strict)")));
        }
        messages.warn(&warning);
    }
    Ok(())
}

/// Memory of a scene, more or less.
fn bytes(scene: &Scene) -> u64 {
    const PRIMITIVE: u64 = 256;
    const OBJECT: u64 = 1024;
    u64::from(scene.primitive_count()) * PRIMITIVE + scene.objects.len() as u64 * OBJECT
}
