//! `lightbuffer replay`: one pixel and one light through every tester.

use super::options::{LightArgument, LightOptions, RunOptions, ViewOptions, parse_light_argument};
use super::progress::Messages;
use super::view::{LookRules, Seen, View};
use super::{Outcome, output};
use crate::error::{Error, Result};
use crate::film::FileSet;
use crate::memory::MemoryLimit;
use crate::report::replay::{
    LightFacts, MeetingFacts, PrimitiveFacts, RayFacts, Replay, Status, TracedFacts,
};
use crate::scene::{ImageSize, Light};
use crate::shadow::Queries;
use crate::shadow::exact::{Arbiter, Contact, Meeting, Occlusion};
use crate::shadow::{Basis, REGISTRY};
use crate::verdict::Cause;
use crate::visibility::SurfacePoint;
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    view: ViewOptions,
    /// Column and row of the pixel, from 0 at the top left
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pixel: [u32; 2],
    /// The light by name [default: the only one]; X,Y,Z puts a point light there instead of the scene's
    /// lights, and may be repeated
    #[arg(long = "light", value_name = "NAME|X,Y,Z", value_parser = parse_light_argument, allow_hyphen_values = true)]
    lights: Vec<LightArgument>,
    /// A fixed ring of N point lights above the scene instead of the scene's lights
    #[arg(long = "lights", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    rig: Option<u32>,
    /// The same as JSON; - is standard output instead of the text
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten)]
    run: RunOptions,
}

pub fn run(args: &Args) -> Result<Outcome> {
    args.run.pool()?.install(|| replay(args, Messages::new(args.run.quiet)))
}

fn replay(args: &Args, messages: Messages) -> Result<Outcome> {
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let lights = LightOptions {
        lights: args.lights.iter().filter_map(LightArgument::position).collect(),
        rig: args.rig,
    };
    let view = View::load(&args.view, &lights, args.run.memory_limit(), messages)?;
    output::expect_apart(args.json.as_slice(), &view.files)?;
    let light =
        choose_light(&view.scene.lights, args.lights.iter().filter_map(LightArgument::name).next_back())?;
    let seen = view.look(LookRules::usual(1), args.run.memory_limit())?;
    let size = seen.hits.size;
    let [x, y] = args.pixel;
    if x >= size.width || y >= size.height {
        return Err(Error::Usage(format!("--pixel {x},{y}: the image is {}x{}", size.width, size.height)));
    }
    let document = document(args, &view, &seen, light)?;
    let mut files = FileSet::new();
    let shown = output::add_copy(&mut files, args.json.as_deref(), &document, || document.text())?;
    output::finish(files, &shown)?;
    let is_exact = |name: &str| REGISTRY.iter().any(|e| e.name == name && e.basis == Basis::Exact);
    let wrong =
        document.testers.iter().any(|(name, &answer)| is_exact(name) && Some(answer) != document.truth);
    Ok(if wrong { Outcome::NativeWrong } else { Outcome::Right })
}

fn choose_light<'v>(lights: &'v [Light], name: Option<&str>) -> Result<&'v Light> {
    let names = || lights.iter().map(|l| l.name.as_str()).collect::<Vec<_>>().join(", ");
    match (name, lights) {
        (Some(name), _) => lights
            .iter()
            .find(|light| light.name == name)
            .ok_or_else(|| Error::Usage(format!("no light `{name}`; the scene has: {}", names()))),
        (None, [only]) => Ok(only),
        (None, _) => Err(Error::Usage(format!("which --light? The scene has: {}", names()))),
    }
}

fn document(args: &Args, view: &View, seen: &Seen, light: &Light) -> Result<Replay> {
    let scene = &view.scene;
    let ImageSize { width, height } = seen.hits.size;
    let pixel = args.pixel[1] * width + args.pixel[0];
    let visible = &seen.forest.nodes;
    let node = visible.pixels[..visible.seen].iter().position(|&p| p == pixel);
    let point = node.map(|i| visible.points[i]);
    let queries = Queries::new(scene, visible, light);
    let direction = view.camera.direction(&view.camera.raster(seen.hits.size), args.pixel[0], args.pixel[1]);
    let mut replay = Replay {
        scene: scene.name.clone(),
        pixel: args.pixel,
        size: [width, height],
        light: LightFacts::new(light),
        status: node.map_or(Status::Background, |node| status(&queries, node as u32)),
        ray: RayFacts { origin: view.camera.origin.to_array(), direction: direction.to_array() },
        primitive: point.and_then(|p| p.primitive()).map(|p| PrimitiveFacts::new(scene, p)),
        point: point.map(|p| p.position.to_array()),
        truth: None,
        touching: false,
        meets: Vec::new(),
        testers: BTreeMap::new(),
        traced: BTreeMap::new(),
        cause: None,
        causes: BTreeMap::new(),
    };
    if let (Status::Query, Some(point)) = (replay.status, point) {
        ask(&mut replay, args, view, light, &point, seen.memory)?;
    }
    Ok(replay)
}

fn status(queries: &Queries, node: u32) -> Status {
    [
        (&queries.nodes, Status::Query),
        (&queries.facing_away, Status::FacingAway),
        (&queries.outside_cone, Status::OutsideCone),
        (&queries.not_receiving, Status::NotReceiving),
    ]
    .into_iter()
    .find(|(nodes, _)| nodes.contains(&node))
    .map_or(Status::Background, |(_, status)| status)
}

fn ask(
    replay: &mut Replay,
    args: &Args,
    view: &View,
    light: &Light,
    point: &SurfacePoint,
    memory: MemoryLimit,
) -> Result<()> {
    let scene = &view.scene;
    let index = args.run.index(scene);
    let input = args.run.build_input(scene, &index, light.position(), memory);
    let arbiter = Arbiter::new(&input);
    let truth = arbiter.decide(point);
    let occluded = truth.occlusion == Occlusion::Occluded;
    replay.truth = Some(occluded);
    replay.touching = truth.contact == Contact::Touching;
    let place = |meeting: &Meeting| match meeting {
        Meeting::Interior => "interior",
        Meeting::Boundary(_) => "boundary",
        _ => "end",
    };
    replay.meets = arbiter
        .meetings(point)
        .into_iter()
        .take(Replay::MOST_MEETINGS)
        .map(|(primitive, meeting)| MeetingFacts {
            primitive: PrimitiveFacts::new(scene, primitive),
            at: place(&meeting),
        })
        .collect();
    for entry in REGISTRY.iter().filter(|entry| entry.lights.has(light.position())) {
        let tester = (entry.build)(&input)?;
        let mut answer = [false];
        tester.occluded(&[*point], &mut answer)?;
        replay.testers.insert(entry.name, answer[0]);
        let Some(ray) = tester.traced_ray(point) else { continue };
        replay.traced.insert(entry.name, TracedFacts::new(&ray));
        if answer[0] != occluded {
            let cause = Cause::of(&arbiter, &ray, answer[0]);
            replay.causes.insert(entry.name, cause);
            replay.cause = replay.cause.or(Some(cause));
        }
    }
    Ok(())
}

fn parse_pixel(text: &str) -> std::result::Result<[u32; 2], String> {
    let sides =
        text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    sides.ok_or_else(|| "expected column and row, such as 640,360".into())
}
