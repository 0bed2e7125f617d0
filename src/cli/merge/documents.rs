//! What `--json` said about parts becomes one document.

use super::super::output;
use super::super::read_json::{read_json, unexpected};
use super::super::render::facts::{
    Common, Facts, FrameFacts, FrameLightFacts, FramesFacts, LightFacts, ShardFacts,
};
use super::super::render::frame_list::FrameList;
use super::super::render::shard::{Rows, ShardBy};
use super::super::settings::{FRAMES, Settings};
use crate::error::{Error, Place, Result};
use crate::film::FileSet;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fs::File;
use std::path::Path;

/// What one part said.
struct Part<'p> {
    path: &'p Path,
    common: Common,
    shard: ShardFacts,
    settings: Settings,
    content: Content,
}

enum Content {
    /// Of one picture; none of a part without rows.
    Picture(Vec<LightFacts>),
    Frames {
        rate: String,
        frames: Vec<FrameFacts>,
    },
}

impl Part<'_> {
    fn wrong(&self, what: impl Into<String>) -> Error {
        Error::input(self.path, Place::File, what)
    }

    fn rows(&self) -> Result<Rows> {
        self.shard.rows.ok_or_else(|| self.wrong("expected the rows of a shard by tiles"))
    }
}

/// Adds the document, or returns it if it goes to standard output.
///
/// # Errors
/// A line about the first file that is none of such facts, or does not fit those before it, or about what is missing or there
/// twice.
pub fn add(files: &mut FileSet, json: &Path, shards: &[&Path]) -> Result<String> {
    let mut parts: Vec<Part> = shards.iter().map(|path| read(path)).collect::<Result<_>>()?;
    let (first, rest) = parts.split_first().expect("a document");
    rest.iter().try_for_each(|part| agree(part, first))?;
    let by = first.shard.by;
    match by {
        ShardBy::Frames => parts.sort_by_key(|part| (part.shard.of, part.shard.index)),
        ShardBy::Tiles => {
            let rows: Vec<Rows> = parts.iter().map(Part::rows).collect::<Result<_>>()?;
            let mut sorted: Vec<(Rows, Part)> = rows.into_iter().zip(parts).collect();
            sorted.sort_by_key(|(rows, _)| *rows);
            parts = sorted.into_iter().map(|(_, part)| part).collect();
            expect_rows(&parts)?;
        }
    }
    let shards = parts.iter().map(|part| ShardFacts { settings: None, ..part.shard.clone() }).collect();
    let common = parts[0].common.clone();
    // A part without rows says nothing of lights or frames.
    let told = || parts.iter().filter(|part| part.shard.rows.is_none_or(|rows| rows.count > 0));
    let rate = told().find_map(|part| match &part.content {
        Content::Frames { rate, .. } => Some(rate.clone()),
        Content::Picture(_) => None,
    });
    let Some(rate) = rate else {
        let lights = told().map(|part| match &part.content {
            Content::Picture(lights) => (part, lights.clone()),
            Content::Frames { .. } => (part, Vec::new()),
        });
        let lights = together(lights.collect())?;
        let facts = Facts { common, shard: None, shards, lights };
        return output::add_copy(files, Some(json), &facts, String::new);
    };
    let frames = match by {
        ShardBy::Frames => in_order(&parts)?,
        ShardBy::Tiles => of_strips(&told().collect::<Vec<_>>())?,
    };
    let mut facts = FramesFacts::new(common, rate);
    facts.shards = shards;
    frames.into_iter().for_each(|frame| facts.add(frame));
    output::add_copy(files, Some(json), &facts, String::new)
}

fn read(path: &Path) -> Result<Part<'_>> {
    let expected = "facts of a shard of render";
    let wrong = |why: &str| unexpected(path, expected, why);
    let file = File::open(path).map_err(|source| Error::io(path, "read", source))?;
    let value: Value = read_json(file, path, expected)?;
    fn typed<T: DeserializeOwned>(value: Value) -> serde_json::Result<T> {
        serde_json::from_value(value)
    }
    let has_frames = value.get("frames").is_some();
    let read = || -> serde_json::Result<_> {
        Ok(match has_frames {
            true => {
                let FramesFacts { common, frames_per_second: rate, shard, frames, .. } = typed(value)?;
                (common, shard, Content::Frames { rate, frames })
            }
            false => {
                let Facts { common, shard, lights, .. } = typed(value)?;
                (common, shard, Content::Picture(lights))
            }
        })
    };
    let (common, shard, content) = read().map_err(|error| wrong(&error.to_string()))?;
    let shard = shard.ok_or_else(|| wrong("it is none of a shard"))?;
    let settings = shard.settings.clone().ok_or_else(|| wrong("it has no settings"))?;
    Ok(Part { path, common, shard, settings, content })
}

/// Whether a part is of the same run as the first that was named.
fn agree(part: &Part, first: &Part) -> Result<()> {
    let as_in = first.path.display();
    if let Some(difference) = part.settings.difference(&first.settings) {
        return Err(part.wrong(format!("of another run: {difference} as in {as_in}")));
    }
    if part.shard.by != first.shard.by || part.common != first.common {
        return Err(part.wrong(format!("of another run, or divided by something else, than {as_in}")));
    }
    Ok(())
}

/// Every row of the picture once, in parts in the order of their rows.
fn expect_rows(parts: &[Part]) -> Result<()> {
    let height = u64::from(parts[0].common.height);
    let mut next = 0;
    let missing = |end: u64, next: u64| {
        Error::Usage(format!("rows {next} to {} are missing: no document that was named has them", end - 1))
    };
    for part in parts {
        let rows = part.rows()?;
        let first = u64::from(rows.first);
        match rows.count {
            0 => continue,
            _ if rows.end() > height => {
                return Err(part.wrong(format!("rows beyond the {height} of the picture")));
            }
            _ if first < next => {
                let last = next.min(rows.end()) - 1;
                return Err(part.wrong(format!("rows {first} to {last} are in another document too")));
            }
            _ if first > next => return Err(missing(first, next)),
            _ => next = rows.end(),
        }
    }
    if next < height { Err(missing(height, next)) } else { Ok(()) }
}

/// The frames of runs of the list, each once and all of them.
fn in_order(parts: &[Part]) -> Result<Vec<FrameFacts>> {
    let list = parts[0].settings.get(FRAMES).and_then(|text| FrameList::parse(text).ok());
    let list = list.ok_or_else(|| parts[0].wrong("its settings have no list of frames"))?;
    let mut all: Vec<(&Part, &FrameFacts)> = Vec::new();
    for part in parts {
        if let Content::Frames { frames, .. } = &part.content {
            all.extend(frames.iter().map(|frame| (part, frame)));
        }
    }
    all.sort_by_key(|(_, frame)| frame.frame);
    if let Some(pair) = all.windows(2).find(|pair| pair[0].1.frame == pair[1].1.frame) {
        let (frame, other) = (pair[0].1.frame, pair[0].0.path.display());
        return Err(pair[1].0.wrong(format!("frame {frame} is in {other} too")));
    }
    let has = |frame: &u32| all.binary_search_by_key(frame, |(_, facts)| facts.frame).is_ok();
    let missing: Vec<u32> = list.numbers().iter().copied().filter(|frame| !has(frame)).collect();
    if let [first, ..] = missing.as_slice() {
        let count = missing.len();
        return Err(Error::Usage(format!(
            "{count} of {} frames are missing, frame {first} first: no document that was named has them",
            list.numbers().len()
        )));
    }
    if let Some((part, facts)) =
        all.iter().find(|(_, facts)| list.numbers().binary_search(&facts.frame).is_err())
    {
        return Err(part.wrong(format!("frame {} is not in the list of frames", facts.frame)));
    }
    Ok(all.into_iter().map(|(_, frame)| frame.clone()).collect())
}

/// The frames of strips that all have the same.
fn of_strips(parts: &[&Part]) -> Result<Vec<FrameFacts>> {
    let frames_of = |part: &Part| match &part.content {
        Content::Frames { frames, .. } => frames.clone(),
        Content::Picture(_) => Vec::new(),
    };
    let first = frames_of(parts[0]);
    let numbers = |frames: &[FrameFacts]| frames.iter().map(|frame| frame.frame).collect::<Vec<_>>();
    let mut all: Vec<Vec<(&Part, FrameFacts)>> = vec![Vec::new(); first.len()];
    for part in parts {
        let frames = frames_of(part);
        if numbers(&frames) != numbers(&first) {
            return Err(part.wrong(format!("other frames than in {}", parts[0].path.display())));
        }
        all.iter_mut().zip(frames).for_each(|(all, frame)| all.push((part, frame)));
    }
    all.into_iter().map(frame_of_strips).collect()
}

/// One frame of its strips: seconds are summed, testers are those of all strips.
fn frame_of_strips(strips: Vec<(&Part, FrameFacts)>) -> Result<FrameFacts> {
    let lights = |frame: &FrameFacts| frame.lights.iter().map(|light| light.light.clone()).collect();
    let merged = together(strips.iter().map(|(part, frame)| (*part, lights(frame))).collect())?;
    let testers = |light: usize| {
        let of_strip = |(_, frame): &(&Part, FrameFacts)| {
            frame.lights.get(light).map(|light| light.testers.clone()).unwrap_or_default()
        };
        strips.iter().flat_map(of_strip).collect()
    };
    let lights = merged.into_iter().enumerate();
    let lights = lights.map(|(i, light)| FrameLightFacts { light, testers: testers(i) }).collect();
    let seconds = strips.iter().map(|(_, frame)| frame.seconds).sum();
    let (_, first) = &strips[0];
    Ok(FrameFacts { frame: first.frame, time: first.time, file: first.file.clone(), seconds, lights })
}

/// Lights of the whole from those of its strips: counts and the seconds of building are summed, nanoseconds a query are the
/// mean over queries, bytes the most of any.
fn together(strips: Vec<(&Part, Vec<LightFacts>)>) -> Result<Vec<LightFacts>> {
    let mut strips = strips.into_iter();
    let Some((_, mut all)) = strips.next() else { return Ok(Vec::new()) };
    for (part, lights) in strips {
        if lights.len() != all.len() || lights.iter().zip(&all).any(|(one, other)| one.name != other.name) {
            return Err(part.wrong("other lights than in the document before it"));
        }
        for (sum, light) in all.iter_mut().zip(lights) {
            let nanoseconds = |light: &LightFacts| light.ns_per_query.map(|each| each * light.queries as f64);
            let both = nanoseconds(sum).zip(nanoseconds(&light)).map(|(one, other)| one + other);
            sum.queries = sum.queries.saturating_add(light.queries);
            sum.facing_away = sum.facing_away.saturating_add(light.facing_away);
            sum.outside_cone = sum.outside_cone.saturating_add(light.outside_cone);
            sum.not_receiving = sum.not_receiving.saturating_add(light.not_receiving);
            let shadowed = sum.shadowed.zip(light.shadowed);
            sum.shadowed = shadowed.map(|(one, other)| one.saturating_add(other));
            sum.build_seconds = sum.build_seconds.zip(light.build_seconds).map(|(one, other)| one + other);
            sum.ns_per_query =
                both.map(|both| if sum.queries == 0 { 0.0 } else { both / sum.queries as f64 });
            sum.bytes = sum.bytes.max(light.bytes);
        }
    }
    Ok(all)
}
