//! What the page reads of the documents: the keys that it shows. Whatever else they hold is passed over, so that
//! documents of a later version are read as well.

use crate::error::{Error, Place, Result};
use crate::measure::bench::Machine;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::path::Path;

/// The longest document that is read, in bytes: that of `bench` with a thousand rows has one and a half million.
const LONGEST: u64 = 256 << 20;

/// Reads a document.
///
/// # Errors
/// In one line what is wrong at which line.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Result<T> {
    let unreadable = |source| Error::io(path, "read", source);
    let length = std::fs::metadata(path).map_err(unreadable)?.len();
    if length > LONGEST {
        return Err(Error::input(path, Place::File, format!("{length} bytes are too long for a document")));
    }
    let text = std::fs::read_to_string(path).map_err(unreadable)?;
    serde_json::from_str(&text).map_err(|error| {
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or(&message);
        Error::input(path, Place::Line(error.line()), message)
    })
}

/// `validate.json`.
#[derive(Debug, Deserialize)]
pub(super) struct Validation {
    pub(super) scene: String,
    pub(super) width: u32,
    pub(super) height: u32,
    #[serde(default)]
    pub(super) version: String,
    #[serde(default)]
    pub(super) threads: u64,
    pub(super) embree: Option<Embree>,
    #[serde(default)]
    pub(super) machine: Option<Machine>,
    /// Words of a command for the same view.
    #[serde(default)]
    pub(super) replay: Vec<String>,
    #[serde(default)]
    pub(super) skipped: Vec<String>,
    pub(super) lights: Vec<Light>,
    #[serde(default)]
    pub(super) cases: Vec<Case>,
    #[serde(default)]
    pub(super) epsilon_sweep: Vec<Epsilon>,
    #[serde(default)]
    pub(super) image_metrics: BTreeMap<String, Metrics>,
    pub(super) totals: Totals,
}

#[derive(Debug, Deserialize)]
pub(super) struct Embree {
    pub(super) version: String,
    pub(super) isa: String,
    #[serde(default)]
    pub(super) epsilon: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Light {
    pub(super) name: String,
    pub(super) queries: u64,
    pub(super) facing_away: u64,
    #[serde(default)]
    pub(super) outside_cone: u64,
    #[serde(default)]
    pub(super) not_receiving: u64,
    pub(super) testers: BTreeMap<String, Tester>,
    pub(super) verdicts: Verdicts,
    #[serde(default)]
    pub(super) wrong_pixels: Vec<WrongPixel>,
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct Tester {
    pub(super) false_shadow: u64,
    pub(super) false_light: u64,
    #[serde(default)]
    pub(super) false_transmittance: u64,
    pub(super) wrong: u64,
    pub(super) undecided: u64,
    pub(super) causes: Option<Causes>,
    pub(super) build_seconds: f64,
    pub(super) ns_per_query: f64,
    pub(super) bytes: u64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
pub(super) struct Causes {
    pub(super) epsilon: u64,
    pub(super) input_rounding: u64,
    pub(super) traversal: u64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Verdicts {
    pub(super) native_wrong: u64,
    pub(super) embree_wrong: u64,
    pub(super) both_wrong: u64,
    pub(super) touching: u64,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrongPixel {
    pub(super) pixel: [u32; 2],
    pub(super) truth: bool,
    pub(super) testers: Vec<String>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Totals {
    #[serde(default)]
    pub(super) queries: u64,
    pub(super) testers: BTreeMap<String, Tester>,
    pub(super) verdicts: Verdicts,
}

/// A hard case.
#[derive(Debug, Deserialize)]
pub(super) struct Case {
    pub(super) number: u64,
    pub(super) name: String,
    pub(super) queries: u64,
    pub(super) testers: BTreeMap<String, CaseTester>,
}

#[derive(Debug, Deserialize)]
pub(super) struct CaseTester {
    /// Absent where it has no answers.
    pub(super) wrong: Option<u64>,
    pub(super) refused: Option<String>,
}

/// Embree with another epsilon.
#[derive(Debug, Deserialize)]
pub(super) struct Epsilon {
    pub(super) tester: String,
    pub(super) epsilon: f64,
    pub(super) false_shadow: u64,
    pub(super) false_light: u64,
}

/// A picture against that of the truth. What is infinite is null.
#[derive(Debug, Deserialize)]
pub(super) struct Metrics {
    pub(super) mse: f64,
    pub(super) mrse: f64,
    pub(super) psnr: Option<f64>,
    pub(super) ssim: Option<f64>,
    pub(super) flip: f64,
}

/// `reproduce.json`, of either paper.
#[derive(Debug, Deserialize)]
pub(super) struct Reproduction {
    pub(super) paper: String,
    #[serde(default)]
    pub(super) version: String,
    #[serde(default)]
    pub(super) threads: u64,
    #[serde(default)]
    pub(super) repetitions: u64,
    #[serde(default)]
    pub(super) environments: Vec<Environment>,
    #[serde(default)]
    pub(super) figures: Vec<Figure>,
}

/// An environment of the 1986 paper.
#[derive(Debug, Deserialize)]
pub(super) struct Environment {
    pub(super) name: String,
    pub(super) figure: u32,
    pub(super) title: String,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) queries: u64,
    pub(super) columns: Vec<Column>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) resolution: Option<u32>,
    pub(super) shadow_testing_seconds: f64,
    pub(super) preprocess_seconds: f64,
    pub(super) total_seconds: f64,
    pub(super) ns_per_query: f64,
    pub(super) tests_per_ray: f64,
    pub(super) bytes: u64,
    pub(super) wrong: u64,
}

/// A figure of the 2004 paper.
#[derive(Debug, Deserialize)]
pub(super) struct Figure {
    pub(super) figure: u32,
    pub(super) title: String,
    #[serde(default)]
    pub(super) pictures: Vec<Picture>,
    pub(super) plot: Option<String>,
    #[serde(default)]
    pub(super) facts: Vec<Fact>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Picture {
    pub(super) png: String,
    pub(super) scene: String,
    pub(super) shadow: String,
    pub(super) queries: u64,
    pub(super) errors: Option<Errors>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Errors {
    pub(super) wrong: u64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Fact {
    pub(super) what: String,
    pub(super) measured: f64,
    pub(super) paper: Option<f64>,
    pub(super) paper_says: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("validate.json");
        let said = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read::<Validation>(&path).unwrap_err().to_string()
        };
        assert!(
            said("{\n \"scene\": 3}")
                .ends_with("validate.json:2: invalid type: integer `3`, expected a string")
        );
        assert!(said("{\"scene\": \"s\"}").ends_with("validate.json:1: missing field `width`"));
        assert!(said("").contains("validate.json:1: EOF"), "{}", said(""));
        std::fs::write(&path, [0xff, 0xfe]).unwrap();
        assert!(read::<Validation>(&path).unwrap_err().to_string().contains("cannot read"));
    }
}
