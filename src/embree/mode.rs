//! A way to run Embree, and its name.

use std::fmt;
use std::str::FromStr;

use super::{
    BuildQuality, Coherence, Denormals, Device, Grouping, PacketWidth, QueryOptions, Receiver, Robustness,
    SceneOptions,
};
use crate::{Error, Result};

/// How Embree builds a scene and how it is asked. Its name says all of it: `embree-fast-packet16-high-ftz`,
/// `embree-robust-stream-medium`, and with what is less usual at the end
/// `embree-robust-packet1-low-ftz-excluded-incoherent`. [`Display`](fmt::Display) and [`FromStr`] are each other's
/// inverse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EmbreeMode {
    /// How scenes are built.
    pub scene: SceneOptions,
    /// How they are asked.
    pub query: QueryOptions,
}

/// An option and the word that names it, in the order in which modes are listed.
type Words<T, const N: usize> = [(T, &'static str); N];

const ROBUSTNESS: Words<Robustness, 2> = [(Robustness::Fast, "fast"), (Robustness::Robust, "robust")];
const GROUPING: Words<Grouping, 5> = [
    (Grouping::Packets(PacketWidth::One), "packet1"),
    (Grouping::Packets(PacketWidth::Four), "packet4"),
    (Grouping::Packets(PacketWidth::Eight), "packet8"),
    (Grouping::Packets(PacketWidth::Sixteen), "packet16"),
    (Grouping::Stream, "stream"),
];
const QUALITY: Words<BuildQuality, 3> =
    [(BuildQuality::Low, "low"), (BuildQuality::Medium, "medium"), (BuildQuality::High, "high")];
// The usual choice of these is not in the name.
const DENORMALS: Words<Denormals, 2> = [(Denormals::Kept, ""), (Denormals::Flushed, "-ftz")];
const RECEIVER: Words<Receiver, 2> = [(Receiver::Included, ""), (Receiver::Excluded, "-excluded")];
const COHERENCE: Words<Coherence, 2> = [(Coherence::Coherent, ""), (Coherence::Incoherent, "-incoherent")];

impl EmbreeMode {
    /// What names look like: alternatives in braces, what may be left out in brackets.
    pub const GRAMMAR: &str = "embree-{fast|robust}-{packet1|packet4|packet8|packet16|stream}-\
                               {low|medium|high}[-ftz][-excluded][-incoherent]";

    /// Embree as oracle: robust, the receiver excluded.
    pub const ORACLE: EmbreeMode = EmbreeMode {
        scene: SceneOptions {
            robustness: Robustness::Robust,
            quality: BuildQuality::Medium,
            receiver: Receiver::Excluded,
        },
        query: QueryOptions {
            grouping: Grouping::Packets(PacketWidth::Sixteen),
            coherence: Coherence::Coherent,
            denormals: Denormals::Kept,
        },
    };

    /// Embree as renderers run it: fast, without a filter.
    pub const RIVAL: EmbreeMode = EmbreeMode {
        scene: SceneOptions {
            robustness: Robustness::Fast,
            receiver: Receiver::Included,
            ..EmbreeMode::ORACLE.scene
        },
        ..EmbreeMode::ORACLE
    };

    /// Every mode, in a fixed order: by robustness, quality, grouping, denormals, receiver and coherence. Those that
    /// this Embree may lack are among them, see [`expect_in`](EmbreeMode::expect_in).
    pub fn all() -> impl Iterator<Item = EmbreeMode> {
        ROBUSTNESS.into_iter().flat_map(|(robustness, _)| {
            QUALITY.into_iter().flat_map(move |(quality, _)| {
                GROUPING.into_iter().flat_map(move |(grouping, _)| {
                    DENORMALS.into_iter().flat_map(move |(denormals, _)| {
                        RECEIVER.into_iter().flat_map(move |(receiver, _)| {
                            COHERENCE.into_iter().map(move |(coherence, _)| EmbreeMode {
                                scene: SceneOptions { robustness, quality, receiver },
                                query: QueryOptions { grouping, coherence, denormals },
                            })
                        })
                    })
                })
            })
        })
    }

    /// Whether this is one for a table of speed beside error: without the filter that excludes the receiver, which
    /// costs time, and with rays said to be coherent, as those of neighbouring pixels are. There are 60.
    pub fn is_for_speed(self) -> bool {
        self.scene.receiver == Receiver::Included && self.query.coherence == Coherence::Coherent
    }

    /// That a device can be asked so.
    ///
    /// # Errors
    ///
    /// Streams, if its Embree has none.
    pub fn expect_in(self, device: &Device) -> Result<()> {
        if self.query.grouping == Grouping::Stream && !device.has_streams() {
            return Err(Error::Embree(format!("version {} has no ray streams: no {self}", device.version())));
        }
        Ok(())
    }
}

fn word<T: PartialEq, const N: usize>(words: Words<T, N>, option: T) -> &'static str {
    words.into_iter().find(|(other, _)| *other == option).expect("every option has a word").1
}

impl fmt::Display for EmbreeMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let EmbreeMode { scene, query } = *self;
        let name = format!(
            "embree-{}-{}-{}{}{}{}",
            word(ROBUSTNESS, scene.robustness),
            word(GROUPING, query.grouping),
            word(QUALITY, scene.quality),
            word(DENORMALS, query.denormals),
            word(RECEIVER, scene.receiver),
            word(COHERENCE, query.coherence),
        );
        f.pad(&name)
    }
}

impl FromStr for EmbreeMode {
    type Err = Error;

    fn from_str(name: &str) -> Result<EmbreeMode> {
        EmbreeMode::all().find(|mode| mode.to_string() == name).ok_or_else(|| {
            Error::Usage(format!("no mode of Embree is called `{name}`; there are: {}", EmbreeMode::GRAMMAR))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_mode_has_a_name_of_its_own_that_reads_back() {
        let names: BTreeSet<String> = EmbreeMode::all().map(|mode| mode.to_string()).collect();
        assert_eq!(names.len(), 2 * 3 * 5 * 2 * 2 * 2);
        for mode in EmbreeMode::all() {
            assert_eq!(mode.to_string().parse::<EmbreeMode>().unwrap(), mode);
        }
        assert_eq!(EmbreeMode::all().filter(|mode| mode.is_for_speed()).count(), 60);
    }

    #[test]
    fn names_are_these() {
        assert_eq!(EmbreeMode::ORACLE.to_string(), "embree-robust-packet16-medium-excluded");
        assert_eq!(EmbreeMode::RIVAL.to_string(), "embree-fast-packet16-medium");
        let mode: EmbreeMode = "embree-fast-packet16-high-ftz".parse().unwrap();
        assert_eq!(mode.scene, SceneOptions { quality: BuildQuality::High, ..EmbreeMode::RIVAL.scene });
        assert_eq!(mode.query, QueryOptions { denormals: Denormals::Flushed, ..EmbreeMode::RIVAL.query });
        let mode: EmbreeMode = "embree-robust-stream-low-excluded-incoherent".parse().unwrap();
        assert_eq!(mode.scene, SceneOptions { quality: BuildQuality::Low, ..EmbreeMode::ORACLE.scene });
        assert_eq!(
            mode.query,
            QueryOptions {
                grouping: Grouping::Stream,
                coherence: Coherence::Incoherent,
                denormals: Denormals::Kept
            }
        );
    }

    /// The grammar is written by hand; it must hold the words that there are.
    #[test]
    fn unknown_names_are_told_what_there_is() {
        for name in [
            "",
            "embree",
            "embree-fast",
            "embree-fast-packet16",
            "embree-fast-packet2-low",
            "embree-fast-stream-low-",
        ] {
            let error = name.parse::<EmbreeMode>().unwrap_err().to_string();
            assert!(error.contains(&format!("`{name}`")) && error.contains(EmbreeMode::GRAMMAR), "{error}");
        }
        let alternatives = |words: &[&str]| format!("{{{}}}", words.join("|"));
        let grammar = format!(
            "embree-{}-{}-{}{}",
            alternatives(&ROBUSTNESS.map(|(_, word)| word)),
            alternatives(&GROUPING.map(|(_, word)| word)),
            alternatives(&QUALITY.map(|(_, word)| word)),
            [DENORMALS[1].1, RECEIVER[1].1, COHERENCE[1].1].map(|word| format!("[{word}]")).concat()
        );
        assert_eq!(grammar, EmbreeMode::GRAMMAR);
    }
}
