//! What decides the pixels of a run, in words: parts of one result agree in all of it.

use super::super::settings::{FRAMES, Settings};
use super::super::view::View;
use super::Args;
use crate::error::Result;
use crate::report::validation::EmbreeFacts;
use crate::scene::Scene;
use crate::shadow::{Resolution, shadow_buffer};

/// The settings of a run, with the list of its frames. Threads, instruction sets and what else no answer depends on stay out;
/// the resolution is in, because facts depend on it.
///
/// # Errors
/// If a file of the scene cannot be read any more.
pub fn settings(
    args: &Args,
    view: &View,
    testers: &[&str],
    embree: Option<&EmbreeFacts>,
) -> Result<Settings> {
    let (scene, size) = (&view.scene, view.size);
    let mut settings = Settings::default();
    let mut add = |name: &str, value: String| settings.add(name, value);
    add("version", env!("CARGO_PKG_VERSION").into());
    add("scene", scene.name.clone());
    add("sceneHash", format!("{:016x}", scene.hash()));
    add("sceneFiles", format!("{:08x}", view.files.checksum()?));
    add("lights", lights(args, scene));
    add("floor", if args.view.no_floor { "none" } else { "as the scene needs" }.into());
    add("camera", view.camera.name.clone());
    add("size", format!("{}x{}", size.width, size.height));
    add("rays", if args.view.corner_rays { "corners" } else { "centres" }.into());
    add("subdivide", args.subdivide.to_string());
    add("depth", args.trees.depth.to_string());
    add("leftOut", args.switches.left_out().join(" "));
    add("shadow", args.tester().unwrap_or_default().into());
    add("testers", testers.join(" "));
    add("verdict", if args.without_verdict() { "no" } else { "yes" }.into());
    add("resolution", resolution(args.run.resolution));
    add("embreeEpsilon", format!("{:e}", args.run.embree_epsilon));
    if let Some(embree) = embree {
        add("embree", embree.version.clone());
    }
    if testers.contains(&shadow_buffer::ENTRY.name) {
        add("shadowBuffer", args.run.shadow_buffer().to_string());
    }
    if let Some(frames) = &args.frames {
        add("framesPerSecond", args.fps.or(view.rate).unwrap_or_default().to_string());
        add(FRAMES, frames.text());
    }
    settings.add_preview(scene.background, args.run.exposure);
    Ok(settings)
}

fn resolution(resolution: Resolution) -> String {
    match resolution {
        Resolution::Auto => "auto".into(),
        Resolution::Cells(cells) => cells.to_string(),
    }
}

/// Where they come from, and their names.
fn lights(args: &Args, scene: &Scene) -> String {
    let from = match (args.lights.rig, args.lights.lights.as_slice()) {
        (Some(count), _) => format!("a ring of {count}"),
        (None, []) => "those of the scene".into(),
        (None, lights) => {
            let place = |light: &glam::Vec3| format!("{:?},{:?},{:?}", light.x, light.y, light.z);
            lights.iter().map(place).collect::<Vec<_>>().join(" ")
        }
    };
    let names: Vec<_> = scene.lights.iter().map(|light| light.name.as_str()).collect();
    format!("{from}: {}", names.join(" "))
}
