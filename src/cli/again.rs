//! A command that asks about a pixel of a run again.

use super::validate;
use crate::scene::ImageSize;

/// Words of `lightbuffer replay` for the view of a run of `validate`, but for `--pixel` and `--light NAME`: whatever
/// decides what is seen, where the lights are, or what a tester answers. `size` is that of the image.
pub fn replay(args: &validate::Args, size: ImageSize) -> Vec<String> {
    let mut words: Vec<String> =
        ["lightbuffer".into(), "replay".into(), args.view.scene.to_string_lossy().into_owned()].into();
    let mut option = |name: &str, value: Option<String>| {
        words.push(format!("--{name}"));
        words.extend(value);
    };
    match args.view.corner_rays {
        // The image has a row and a column more than was asked for.
        true => {
            option("size", Some(format!("{}x{}", size.width - 1, size.height - 1)));
            option("corner-rays", None);
        }
        false => option("size", Some(format!("{}x{}", size.width, size.height))),
    }
    if let Some(camera) = &args.view.camera {
        option("camera", Some(camera.clone()));
    }
    if args.view.no_floor {
        option("no-floor", None);
    }
    for light in &args.lights.lights {
        option("light", Some(format!("{},{},{}", light.x, light.y, light.z)));
    }
    if let Some(lights) = args.lights.rig {
        option("lights", Some(lights.to_string()));
    }
    args.run.answer_options(&mut option);
    words
}
