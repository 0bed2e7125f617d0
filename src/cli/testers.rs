//! Which testers a run asks.

use super::progress::Messages;
use crate::error::{Error, Result};
use crate::scene::Light;
use crate::shadow::{Basis, REGISTRY, TesterEntry, find, testers};

/// The options that say so.
#[derive(Debug, clap::Args)]
pub struct TesterOptions {
    /// Testers to hold against the truth, separated by commas; modes of Embree by name too, such as
    /// embree-fast-packet16-high-ftz [default: all that fit, and of Embree's modes embree and embree-fast]
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    testers: Vec<String>,
    /// Beside them every mode of Embree that is for speed: packets of 1, 4, 8 and 16 and streams, each fast and robust,
    /// of low, medium and high build quality, with denormals kept and flushed. They have no channels in image.exr
    #[arg(long)]
    embree_modes: bool,
    /// Tester of the picture, the difference map and the verdict map
    #[arg(long, value_name = "TESTER", default_value = "light-buffer")]
    pub shadow: String,
}

impl TesterOptions {
    /// The testers that were asked for, the picture's tester and the truth among them, each once.
    ///
    /// # Errors
    /// A name that no tester has, or a mode that this Embree lacks.
    pub fn choose(&self, messages: Messages) -> Result<Vec<&'static TesterEntry>> {
        for name in self.testers.iter().chain([&self.shadow]) {
            expect_available(find(name)?)?;
        }
        let modes = if self.embree_modes { embree_modes(messages)? } else { Vec::new() };
        let wanted = |entry: &&TesterEntry| {
            entry.basis == Basis::Truth || self.has_mask(entry.name) || modes.contains(&entry.name)
        };
        Ok(testers().filter(wanted).collect())
    }

    /// Whether a tester was asked for by its own name.
    pub fn is_named(&self, name: &str) -> bool {
        self.testers.iter().any(|other| other == name) || name == self.shadow
    }

    /// Whether a tester's mask is a channel of the picture: if it was asked for by its own name or by none.
    pub fn has_mask(&self, name: &str) -> bool {
        let named = self.is_named(name);
        let by_default = self.testers.is_empty() && REGISTRY.iter().any(|entry| entry.name == name);
        let truth = REGISTRY.iter().any(|entry| entry.name == name && entry.basis == Basis::Truth);
        named || by_default || truth
    }
}

/// Fails if the tester cannot be built for one of the lights, so that nobody waits for the truth before that is said.
///
/// # Errors
/// As said.
pub fn expect_lights(entry: &TesterEntry, lights: &[Light]) -> Result<()> {
    match lights.iter().find(|light| !entry.lights.has(light.position())) {
        None => Ok(()),
        Some(light) => Err(Error::Usage(format!(
            "{}: the light {} is infinitely far away, and this tester has no answer for such",
            entry.name, light.name
        ))),
    }
}

/// Fails if the tester is a mode that this Embree lacks, so that nobody waits for the truth before that is said.
///
/// # Errors
/// As said, or if there is no Embree to ask.
#[cfg(feature = "embree")]
pub fn expect_available(entry: &TesterEntry) -> Result<()> {
    use crate::embree::{Device, EmbreeMode};
    let mode = entry.name.parse::<EmbreeMode>();
    mode.map_or(Ok(()), |mode| mode.expect_in(&Device::new(1)?))
}

#[cfg(not(feature = "embree"))]
pub fn expect_available(_: &TesterEntry) -> Result<()> {
    Ok(())
}

/// Names of the modes of `--embree-modes` that this Embree has.
#[cfg(feature = "embree")]
fn embree_modes(messages: Messages) -> Result<Vec<&'static str>> {
    use crate::embree::{Device, EmbreeMode};
    let device = Device::new(1)?;
    if !device.has_streams() {
        messages.say(&format!("Embree {} has no ray streams: those modes are left out", device.version()));
    }
    if !device.flushes_denormals() {
        messages.warn("this processor has no mode for denormals: modes with -ftz are as those without");
    }
    let there = |mode: &EmbreeMode| mode.is_for_speed() && mode.expect_in(&device).is_ok();
    EmbreeMode::all().filter(there).map(|mode| find(&mode.to_string()).map(|entry| entry.name)).collect()
}

#[cfg(not(feature = "embree"))]
fn embree_modes(_: Messages) -> Result<Vec<&'static str>> {
    Err(Error::Usage("--embree-modes: built without the feature `embree`".into()))
}
