//! `lightbuffer render`: a scene becomes an OpenEXR picture, or one for each frame.
//!
//! [`drawing`] makes one picture, [`facts`] is what `--json` says about it, and [`frames`] is the loop over many.

mod agreement;
pub mod drawing;
pub mod facts;
pub mod frame_list;
mod frame_names;
mod frames;
mod manifest;
mod record;
pub mod shard;
mod task;

use self::agreement::settings;
use self::drawing::Painter;
use self::facts::{Common, Facts, LightFacts, ShardFacts};
use self::frame_list::FrameList;
use self::record::Record;
use self::shard::{Shard, ShardBy};
use self::task::{Pictures, Task};
use super::options::{LightOptions, RunOptions, Shadows, Switches, TreeOptions, ViewOptions};
use super::progress::Messages;
use super::settings::Settings;
use super::testers::{expect_available, expect_lights};
use super::view::View;
use super::{Outcome, output, validate};
use crate::atomic::folder_of;
use crate::error::{Error, Result};
use crate::film::{BLOCK_ROWS, FileSet, unique_safe_names};
use crate::measure::timed;
use crate::scene::{FrameRate, Light};
use crate::shadow::shadow_buffer;
use crate::shadow::{Fresh, TesterEntry, find};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
#[command(after_long_help = validate::CHANNELS)]
pub struct Args {
    #[command(flatten)]
    view: ViewOptions,
    #[command(flatten)]
    lights: LightOptions,
    #[command(flatten)]
    trees: TreeOptions,
    #[command(flatten)]
    switches: Switches,
    /// OpenEXR file to write; a PNG preview is written beside it. With --frames a run of # in the name is where the number
    /// of the frame goes, with zeros before it: shot.####.exr is shot.0001.exr, and so is shot.exr
    #[arg(short, long, value_name = "OUT.exr", value_parser = parse_output)]
    output: PathBuf,
    /// A picture for each of these frames, in ascending order: numbers, ranges and ranges with a step, such as
    /// 1-30,40,50-100:2. Frame 0 is the beginning, at 0 seconds, and frame N is N / FPS seconds after it. Without this
    /// option the scene is drawn at rest: as its file says it beside animations and keyframes
    #[arg(long, value_name = "LIST", value_parser = FrameList::parse, allow_hyphen_values = true)]
    frames: Option<FrameList>,
    /// Frames a second, such as 24, 23.976 or 24000/1001 [default: what a TOML scene says, else 24]
    #[arg(long, value_name = "FPS", value_parser = FrameRate::parse, requires = "frames")]
    fps: Option<FrameRate>,
    /// Build every tester anew in each frame, in place of keeping those of lights that stand still among objects that do.
    /// No answer depends on it
    #[arg(long, requires = "frames")]
    rebuild: bool,
    /// Part I of N of the run, for one process of many: without --frames a strip of whole rows, which is written as
    /// OUT.shard-I-of-N.exr and put together by `merge`; with --frames a run of the list. No pixel depends on it
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    /// What the run is divided by [default: frames with --frames, else tiles]
    #[arg(long, value_name = "WHAT", requires = "shard")]
    shard_by: Option<ShardBy>,
    /// Do not draw again what an earlier run with the same settings has finished. OUT.manifest.json (with --shard
    /// OUT.shard-I-of-N.manifest.json) says what that is; it is written with --frames, --shard or this option, after each
    /// picture
    #[arg(long, conflicts_with = "save_shadow_buffers")]
    resume: bool,
    /// Tester of the shadows
    #[arg(long, value_name = "TESTER", default_value = "light-buffer")]
    shadow: String,
    /// Leave out the difference and verdict channels, and the time that Embree and the truth take
    #[arg(long)]
    no_verdict: bool,
    /// Samples a pixel along each side, without difference and verdict channels: 3 is nine a pixel
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    subdivide: u32,
    /// Facts of the run as JSON; - is standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Save the shadow-buffer of each light in this folder, as LIGHT.shadow-buffer, for other views of the scene;
    /// with --shadow shadow-buffer
    #[arg(long, value_name = "DIR", conflicts_with_all = ["no_shadows", "frames", "shard"])]
    save_shadow_buffers: Option<PathBuf>,
    /// Load the shadow-buffer of each light from a folder where they were saved, in place of filling it: those of
    /// another scene, light or size are refused; with --shadow shadow-buffer
    #[arg(long, value_name = "DIR", conflicts_with_all = ["save_shadow_buffers", "no_shadows", "frames"])]
    load_shadow_buffers: Option<PathBuf>,
    #[command(flatten)]
    run: RunOptions,
}

/// The preview takes the name with `.png`, which must not be that of the picture itself.
pub fn parse_output(text: &str) -> std::result::Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("exr") => Ok(path),
        _ => Err("expected a name that ends in .exr".into()),
    }
}

impl Args {
    /// Codes of a verdict have no mean, and without shadows there is nothing to judge.
    fn without_verdict(&self) -> bool {
        self.no_verdict || self.subdivide > 1 || self.switches.shadows() == Shadows::Off
    }

    /// Whose shadows the picture has.
    fn tester(&self) -> Option<&str> {
        (self.switches.shadows() == Shadows::On).then_some(self.shadow.as_str())
    }

    /// Only the shadow-buffer has files, and the folder for them must be one.
    fn expect_shadow_buffer(&self, tester: &TesterEntry) -> Result<()> {
        let folders = [
            ("--save-shadow-buffers", &self.save_shadow_buffers),
            ("--load-shadow-buffers", &self.load_shadow_buffers),
        ];
        for (option, _) in folders.iter().filter(|(_, folder)| folder.is_some()) {
            if tester.name != shadow_buffer::ENTRY.name {
                return Err(Error::Usage(format!("{option}: only with --shadow shadow-buffer")));
            }
        }
        self.save_shadow_buffers.as_deref().map_or(Ok(()), output::expect_folder)
    }

    /// Where the buffer of each light is saved or loaded.
    fn shadow_buffer_files(&self, lights: &[Light]) -> Vec<Option<PathBuf>> {
        let folder = self.save_shadow_buffers.as_ref().or(self.load_shadow_buffers.as_ref());
        let names = unique_safe_names(&lights.iter().map(|light| &light.name).collect::<Vec<_>>());
        let file = |name| Some(folder?.join(format!("{name}.shadow-buffer")));
        names.into_iter().map(file).collect()
    }
}

/// The PNG beside a picture.
pub fn preview(picture: &Path) -> PathBuf {
    picture.with_extension("png")
}

pub fn run(args: &Args) -> Result<Outcome> {
    let messages = Messages::new(args.run.quiet);
    args.run.pool()?.install(|| render(args, messages))
}

fn render(args: &Args, messages: Messages) -> Result<Outcome> {
    let tester = args.tester().map(find).transpose()?;
    if let Some(tester) = tester {
        expect_available(tester)?;
        args.expect_shadow_buffer(tester)?;
    }
    let task = Task::of(args)?;
    task.samples().try_for_each(|file| output::expect_writable(&file))?;
    output::warn_of_remains(folder_of(&args.output), messages);
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let view = View::load(&args.view, &args.lights, args.run.memory_limit(), messages)?;
    let results = task.files().chain(args.json.clone());
    output::expect_apart(&results.collect::<Vec<_>>(), &view.files)?;
    tester.map_or(Ok(()), |tester| expect_lights(tester, &view.scene.lights))?;
    let threads = rayon::current_num_threads();
    let embree = if args.without_verdict() {
        None
    } else {
        validate::embree_facts(threads, args.run.embree_epsilon, messages)?
    };
    let mut entries: Vec<_> = tester.into_iter().collect();
    if embree.is_some() && args.shadow != "embree" {
        entries.push(find("embree")?);
    }
    let names: Vec<_> = entries.iter().map(|entry| entry.name).collect();
    // For those all files of the scene are read once more.
    let settings = match &task.manifest {
        Some(_) => settings(args, &view, &names, embree.as_ref())?,
        None => Settings::default(),
    };
    let record = Record::begin(&task, args, &settings)?;
    let painter = Painter { args, tester, entries, embree, messages, settings, tile: task.tile };
    if painter.rows(view.size).count == 0 {
        return nothing(&painter, &view, &task, record);
    }
    match &task.pictures {
        Pictures::One(picture) => render_one(&painter, view, &task, picture, record),
        Pictures::Frames(numbers, names) => frames::render(&painter, view, &task, numbers, names, record),
    }
}

/// One picture of the scene at rest, or a strip of it.
fn render_one(
    painter: &Painter,
    view: View,
    task: &Task,
    picture: &Path,
    mut record: Record,
) -> Result<Outcome> {
    let args = painter.args;
    let common = Common::new(painter, &view.scene.name, view.size);
    let finished: Option<OneFinished> = record.finished(picture);
    let (lights, seconds, outcome) = match finished {
        Some(OneFinished { lights, seconds }) => {
            record.tell(1, 1, painter.messages);
            (lights, seconds, record.outcome())
        }
        None => {
            let buffers = args.shadow_buffer_files(&view.scene.lights);
            let mut folders = FileSet::new();
            if let Some(folder) = &args.save_shadow_buffers {
                folders.folder(folder)?;
            }
            let index = args.run.index(&view.scene);
            let shot =
                painter.shot(&view.scene, view.scene.lights.clone(), view.camera.clone(), view.size)?;
            let work = timed(|| {
                let drawn = painter.draw(&shot, &index, &mut Fresh, &buffers, args.run.memory_limit())?;
                let mut files = FileSet::new();
                painter.add(&mut files, picture, &shot, &drawn, None)?;
                Ok((drawn, files))
            });
            let (drawn, mut files) = work.value?;
            let lights = drawn.light_facts(&shot);
            let outcome = if drawn.is_native_wrong() { Outcome::NativeWrong } else { Outcome::Right };
            let shard = task.shard.map(|shard| ShardFacts::new(painter, shard, view.size, work.seconds));
            let facts = Facts::new(common, shard, lights.clone());
            let shown = output::add_copy(&mut files, args.json.as_deref(), &facts, String::new)?;
            output::finish(files, &shown)?;
            folders.publish()?;
            record.add(picture, outcome, &OneFinished { lights, seconds: work.seconds })?;
            painter.tell(&shot, &drawn, None);
            painter.messages.say(&format!("wrote {}", picture.display()));
            return Ok(outcome);
        }
    };
    let shard = task.shard.map(|shard| ShardFacts::new(painter, shard, view.size, seconds));
    write_facts(args, &Facts::new(common, shard, lights))?;
    Ok(outcome)
}

/// A part without rows: there are more parts than blocks of rows.
fn nothing(painter: &Painter, view: &View, task: &Task, record: Record) -> Result<Outcome> {
    let (args, shard) = (painter.args, task.shard.expect("the whole has rows"));
    painter.messages.say(&format!(
        "shard {shard}: nothing to draw, {} rows are fewer blocks of {BLOCK_ROWS} than shards",
        view.size.height
    ));
    record.write()?;
    let common = Common::new(painter, &view.scene.name, view.size);
    let facts = Facts::new(common, Some(ShardFacts::new(painter, shard, view.size, 0.0)), Vec::new());
    write_facts(args, &facts)?;
    Ok(Outcome::Right)
}

/// What `--json` asks for.
fn write_facts(args: &Args, facts: &impl Serialize) -> Result<()> {
    let mut files = FileSet::new();
    let shown = output::add_copy(&mut files, args.json.as_deref(), facts, String::new)?;
    output::finish(files, &shown)
}

/// What is recorded of a single picture.
#[derive(Serialize, Deserialize)]
struct OneFinished {
    lights: Vec<LightFacts>,
    seconds: f64,
}
