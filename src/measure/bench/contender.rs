//! A tester as it takes part: its parameters, and the order in which it is asked.

use super::Order;
#[cfg(feature = "embree")]
use crate::embree::EmbreeMode;
use crate::shadow::{Basis, Resolution, TesterEntry};

/// On whose side a tester is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Native, and it claims to be exact.
    Native,
    /// Embree.
    Embree,
    /// Native, and its error is measured.
    Approximate,
}

/// One that is measured.
#[derive(Clone)]
pub struct Contender {
    /// Who.
    pub entry: &'static TesterEntry,
    /// The order of the queries.
    pub order: Order,
    /// Cells along an edge of the light buffer, if it has such.
    pub resolution: Option<Resolution>,
    /// The share of a segment that Embree leaves out at its ends.
    pub epsilon: Option<f32>,
}

impl Contender {
    /// On whose side it is.
    pub fn side(&self) -> Side {
        match self.entry.basis {
            Basis::Truth | Basis::Exact => Side::Native,
            Basis::Measured if self.epsilon.is_some() => Side::Embree,
            Basis::Measured => Side::Approximate,
        }
    }

    /// What it was set to, in words.
    pub fn parameter(&self) -> String {
        let resolution = self.resolution.map(|resolution| match resolution {
            Resolution::Auto => "R=auto".to_string(),
            Resolution::Cells(cells) => format!("R={cells}"),
        });
        let epsilon = self.epsilon.map(|epsilon| format!("epsilon={epsilon}"));
        let order = format!("order={}", self.order.name());
        resolution.into_iter().chain(epsilon).chain([order]).collect::<Vec<_>>().join(" ")
    }

    /// The mode of Embree that it is.
    #[cfg(feature = "embree")]
    pub fn mode(&self) -> Option<EmbreeMode> {
        mode_of(self.entry.name)
    }

    /// Whether what is built for one can serve the other: the same tester in another order, or modes of Embree that
    /// differ in how they ask.
    pub fn shares_build(&self, other: &Contender) -> bool {
        #[cfg(feature = "embree")]
        if let Some((one, other)) = self.mode().zip(other.mode()) {
            return one.scene == other.scene;
        }
        self.entry.name == other.entry.name && self.resolution == other.resolution
    }
}

/// The mode of Embree of a tester's name.
#[cfg(feature = "embree")]
pub(super) fn mode_of(name: &str) -> Option<EmbreeMode> {
    match name {
        "embree" => Some(EmbreeMode::ORACLE),
        "embree-fast" => Some(EmbreeMode::RIVAL),
        _ => name.parse().ok(),
    }
}
