//! `lightbuffer info`: what a scene holds and what it calls for.

use super::counts::{Counts, shapes_in_words};
use super::options::{LightOptions, ViewOptions};
use super::progress::Messages;
use super::view::View;
use super::{Outcome, output};
use crate::error::Result;
use crate::film::{FileSet, grouped};
use crate::geometry::LightPosition;
use crate::geometry::convexity::Surface;
use crate::geometry::solid::Refusal;
use crate::memory::MemoryLimit;
use crate::scene::{Light, Object, Scene};
use crate::shadow::SceneIndex;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    view: ViewOptions,
    #[command(flatten)]
    lights: LightOptions,
    /// The same as JSON; - is standard output instead of the text
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// No messages but errors
    #[arg(short, long)]
    quiet: bool,
}

#[derive(Debug, Serialize)]
struct Facts {
    scene: String,
    hash: String,
    objects: usize,
    #[serde(flatten)]
    counts: Counts,
    vertices: usize,
    casting: usize,
    duplicates: usize,
    degenerate: usize,
    non_finite: usize,
    dropped_curved: usize,
    convex_solids: usize,
    convex_sheets: usize,
    closed_solids: usize,
    not_solid: NotSolid,
    /// None where something in the scene has no end.
    low: Option<[f32; 3]>,
    high: Option<[f32; 3]>,
    lights: Vec<LightFacts>,
    cameras: Vec<String>,
    /// None where nothing moves.
    animation: Option<AnimationFacts>,
    added: Vec<String>,
    warnings: Vec<String>,
}

/// What moves, and when.
#[derive(Debug, Serialize)]
struct AnimationFacts {
    /// Seconds of the first and of the last key.
    begin: f64,
    end: f64,
    frames_per_second: String,
    /// The frames that hold both.
    first_frame: u32,
    last_frame: u32,
    /// How many objects move.
    objects: usize,
    lights: Vec<String>,
    cameras: Vec<String>,
}

/// Parts of objects that are no closed solids, by the reason.
#[derive(Debug, Serialize)]
struct NotSolid {
    open: usize,
    turned: usize,
    crossing: usize,
    too_large: usize,
}

#[derive(Debug, Serialize)]
struct LightFacts {
    name: String,
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    towards: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cone: Option<ConeFacts>,
    intensity: [f32; 3],
}

#[derive(Debug, Serialize)]
struct ConeFacts {
    axis: [f32; 3],
    cos_inner: f32,
    cos_outer: f32,
}

pub fn run(args: &Args) -> Result<Outcome> {
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let view =
        View::load(&args.view, &args.lights, MemoryLimit::of_this_machine(), Messages::new(args.quiet))?;
    output::expect_apart(args.json.as_slice(), &view.files)?;
    let facts = facts(&view);
    let mut files = FileSet::new();
    let shown = output::add_copy(&mut files, args.json.as_deref(), &facts, || text(&facts))?;
    output::finish(files, &shown)?;
    Ok(Outcome::Right)
}

fn facts(view: &View) -> Facts {
    let scene = &view.scene;
    let index = SceneIndex::new(scene);
    let surfaces = |wanted: Surface| {
        let objects = scene.objects.iter().zip(index.convexity(scene));
        let convex = objects.filter(|(object, _)| object.count > 0).filter_map(|(_, c)| c.as_ref());
        convex.filter(|convexity| convexity.surface == wanted).count()
    };
    let solids = index.solids(scene);
    let refused = |why: Refusal| solids.refused.get(&why).copied().unwrap_or(0);
    let bounds = scene.bounds();
    Facts {
        scene: scene.name.clone(),
        hash: format!("{:016x}", scene.hash()),
        objects: scene.objects.len(),
        counts: Counts::of(scene),
        vertices: scene.vertices.len(),
        casting: index.casting(scene).len(),
        duplicates: blocking_triangles(scene) - index.casting(scene).len(),
        degenerate: scene.dropped.degenerate,
        non_finite: scene.dropped.non_finite,
        dropped_curved: scene.dropped.curved,
        convex_solids: surfaces(Surface::Closed),
        convex_sheets: surfaces(Surface::Open),
        closed_solids: solids.count(),
        not_solid: NotSolid {
            open: refused(Refusal::Open),
            turned: refused(Refusal::Turned),
            crossing: refused(Refusal::Crossing),
            too_large: refused(Refusal::TooLarge),
        },
        low: bounds.map(|(low, _)| low.to_array()),
        high: bounds.map(|(_, high)| high.to_array()),
        lights: scene.lights.iter().map(light_facts).collect(),
        cameras: scene.cameras.iter().map(|camera| camera.name.clone()).collect(),
        animation: animation_facts(view),
        added: view.added.clone(),
        warnings: scene.warnings.clone(),
    }
}

fn animation_facts(view: &View) -> Option<AnimationFacts> {
    let motion = &view.motion;
    let rate = view.rate.unwrap_or_default();
    let (begin, end) = motion.range().filter(|_| !motion.is_empty())?;
    // Whole numbers within what frames can be; rounding of seconds must not add one.
    let whole = |frame: f64, round: fn(f64) -> f64| {
        let nearest = frame.round();
        (if (frame - nearest).abs() < 1e-6 { nearest } else { round(frame) }) as u32
    };
    Some(AnimationFacts {
        begin,
        end,
        frames_per_second: rate.to_string(),
        first_frame: whole(rate.frame(begin), f64::floor),
        last_frame: whole(rate.frame(end), f64::ceil),
        objects: motion.objects.len(),
        lights: motion.lights.iter().map(|light| view.scene.lights[light.index].name.clone()).collect(),
        cameras: motion.cameras.iter().map(|camera| view.scene.cameras[camera.index].name.clone()).collect(),
    })
}

fn light_facts(light: &Light) -> LightFacts {
    let (position, towards) = match light.position() {
        LightPosition::At(point) => (Some(point.to_array()), None),
        LightPosition::Towards(direction) => (None, Some(direction.to_array())),
    };
    let cone = light.cone().map(|cone| ConeFacts {
        axis: cone.axis.to_array(),
        cos_inner: cone.cos_inner,
        cos_outer: cone.cos_outer,
    });
    LightFacts {
        name: light.name.clone(),
        kind: light.kind(),
        position,
        towards,
        cone,
        intensity: light.strength(),
    }
}

fn text(facts: &Facts) -> String {
    let mut out = String::new();
    let count = |n: usize| grouped(n as u64);
    let _ = writeln!(out, "{} (hash {})", facts.scene, facts.hash);
    let _ = writeln!(
        out,
        "  {} objects, {} triangles, {} vertices; {} polygons",
        count(facts.objects),
        count(facts.counts.triangles),
        count(facts.vertices),
        count(facts.counts.polygons)
    );
    if !facts.counts.curved.is_empty() {
        let _ = writeln!(out, "  curved: {}", shapes_in_words(&facts.counts.curved));
    }
    let (transparent, mirrors) = (facts.counts.transparent_objects, facts.counts.mirror_objects);
    if transparent + mirrors + facts.counts.textures > 0 {
        let _ = writeln!(
            out,
            "  {} transparent objects, {} mirrors, {} textures",
            count(transparent),
            count(mirrors),
            count(facts.counts.textures)
        );
    }
    let _ = writeln!(
        out,
        "  cast: {} triangles ({} exact duplicates merged); dropped: {} of zero area, {} not finite, {} curved",
        count(facts.casting),
        count(facts.duplicates),
        count(facts.degenerate),
        count(facts.non_finite),
        count(facts.dropped_curved)
    );
    let _ = writeln!(
        out,
        "  convex, verified: {} solids, {} open sheets",
        count(facts.convex_solids),
        count(facts.convex_sheets)
    );
    let why = &facts.not_solid;
    let _ = writeln!(
        out,
        "  closed solids: {}; other parts: {} open, {} turned, {} crossing themselves, {} too large",
        count(facts.closed_solids),
        count(why.open),
        count(why.turned),
        count(why.crossing),
        count(why.too_large)
    );
    match (facts.low, facts.high) {
        (Some(low), Some(high)) => drop(writeln!(out, "  bounds: {low:?} to {high:?}")),
        _ => drop(writeln!(out, "  bounds: none")),
    }
    for light in &facts.lights {
        let place = match (light.position, light.towards) {
            (Some(position), _) => format!("at {position:?}"),
            (None, towards) => format!("towards {:?}", towards.unwrap_or_default()),
        };
        let _ =
            writeln!(out, "  light {}: {} {place}, intensity {:?}", light.name, light.kind, light.intensity);
    }
    for camera in &facts.cameras {
        let _ = writeln!(out, "  camera {camera}");
    }
    if let Some(animation) = &facts.animation {
        let named = |kind: &str, names: &[String]| match names {
            [] => String::new(),
            names => format!(", {kind} {}", names.join(", ")),
        };
        let _ = writeln!(
            out,
            "  animated from {} to {} s, frames {} to {} at {} a second; what moves: {} objects{}{}",
            animation.begin,
            animation.end,
            animation.first_frame,
            animation.last_frame,
            animation.frames_per_second,
            count(animation.objects),
            named("light", &animation.lights),
            named("camera", &animation.cameras)
        );
    }
    out
}

/// Triangles of opaque objects that cast, exact duplicates counted each.
fn blocking_triangles(scene: &Scene) -> usize {
    let blocks = |object: &&Object| {
        object.shadowing.casts && scene.materials[object.material as usize].transmission.is_none()
    };
    scene.objects.iter().filter(blocks).map(|object| object.count as usize).sum()
}
