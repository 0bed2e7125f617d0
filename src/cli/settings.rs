//! What parts of one result must have in common: everything that decides a pixel, by name and as text.

use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Names and values.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Settings(BTreeMap<String, String>);

/// Which frames there are in all: what a shard says beside what decides a pixel.
pub const FRAMES: &str = "frames";

/// Linear Rec. 709 behind everything, which the preview has where nothing is.
const BACKGROUND: &str = "background";

/// In stops, of the preview.
const EXPOSURE: &str = "exposure";

impl Settings {
    /// Adds one.
    pub fn add(&mut self, name: &str, value: impl Into<String>) {
        self.0.insert(name.into(), value.into());
    }

    /// Adds what a preview is made with.
    pub fn add_preview(&mut self, background: [f32; 3], exposure: f32) {
        let [red, green, blue] = background;
        self.add(BACKGROUND, format!("{red:?} {green:?} {blue:?}"));
        self.add(EXPOSURE, format!("{exposure:?}"));
    }

    /// Background and exposure of a preview, if they are there and finite.
    pub fn preview(&self) -> Option<([f32; 3], f32)> {
        let number = |text: &str| text.parse().ok().filter(|number: &f32| number.is_finite());
        let background: Option<Vec<f32>> = self.0.get(BACKGROUND)?.split(' ').map(number).collect();
        Some((background?.try_into().ok()?, number(self.0.get(EXPOSURE)?)?))
    }

    /// The value of a name.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    /// Those without one.
    pub fn without(mut self, name: &str) -> Settings {
        self.0.remove(name);
        self
    }

    /// What is not as expected, in words: the first by name, but where the version differs, that.
    pub fn difference(&self, expected: &Settings) -> Option<String> {
        let names = ["version", "scene"].into_iter().map(str::to_owned);
        let mut names = names.chain(self.0.keys().cloned()).chain(expected.0.keys().cloned());
        let name = names.find(|name| self.get(name) != expected.get(name))?;
        let show = |value: Option<&str>| value.map_or("nothing".into(), |v| format!("`{}`", printable(v)));
        Some(format!(
            "{} is {}, expected {}",
            printable(&name),
            show(self.get(&name)),
            show(expected.get(&name))
        ))
    }

    /// One line of JSON.
    ///
    /// # Errors
    /// Never for text.
    pub fn to_json(&self) -> Result<String> {
        serde_json::to_string(self).map_err(|error| Error::Usage(format!("JSON: {error}")))
    }
}

/// A value of a file that somebody else may have written, short and without what would break a line.
pub fn printable(text: &str) -> String {
    const LONGEST: usize = 120;
    let mut shown: String =
        text.chars().map(|c| if c.is_control() { '?' } else { c }).take(LONGEST).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push_str("...");
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_preview_is_made_with_comes_back_in_bits() {
        let mut settings = Settings::default();
        assert_eq!(settings.preview(), None);
        settings.add_preview([0.1, 1.0 / 3.0, -0.0], -1.5e-7);
        let (background, exposure) = settings.preview().unwrap();
        assert_eq!(background.map(f32::to_bits), [0.1, 1.0 / 3.0, -0.0_f32].map(f32::to_bits));
        assert_eq!(exposure, -1.5e-7);
        for bad in ["", "1 2", "1 2 3 4", "1 2 nan", "1  2 3"] {
            settings.add(BACKGROUND, bad);
            assert_eq!(settings.preview(), None, "{bad}");
        }
    }

    #[test]
    fn the_first_difference_is_a_line() {
        let settings = |pairs: &[(&str, &str)]| {
            let mut settings = Settings::default();
            pairs.iter().for_each(|&(name, value)| settings.add(name, value));
            settings
        };
        let one = settings(&[("version", "1"), ("depth", "4"), ("scene", "a")]);
        assert_eq!(one.difference(&one), None);
        let other = settings(&[("version", "1"), ("depth", "5"), ("scene", "b\n")]);
        assert_eq!(other.difference(&one).unwrap(), "scene is `b?`, expected `a`");
        let missing = settings(&[("version", "1"), ("scene", "a")]);
        assert_eq!(missing.difference(&one).unwrap(), "depth is nothing, expected `4`");
        assert_eq!(one.difference(&missing).unwrap(), "depth is `4`, expected nothing");
    }
}
