//! The testers that are compared.

use crate::error::Result;
use crate::shadow::shadow_buffer::ShadowBufferSettings;
use crate::shadow::{BuildInput, ShadowTester, find};

/// A tester as it is set up for the figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contender {
    /// Every object for every shadow ray: the classical tracer's.
    BruteForce,
    /// A shadow-buffer of so many rows, and twice as many columns.
    ShadowBuffer(u32),
    /// The light buffer of the 1986 paper, exact, as it is set up unless something else is asked for.
    LightBuffer,
    /// Embree in its fast mode.
    #[cfg(feature = "embree")]
    Embree,
}

/// A shadow-buffer of the paper's shape.
pub fn buffer_of_rows(rows: u32) -> ShadowBufferSettings {
    ShadowBufferSettings { rows, columns: 2 * rows, ..ShadowBufferSettings::default() }
}

impl Contender {
    /// Those that the paper has not.
    pub const OTHERS: &[Contender] = &[
        Contender::LightBuffer,
        #[cfg(feature = "embree")]
        Contender::Embree,
    ];

    /// In reports.
    pub fn name(self) -> String {
        match self {
            Contender::ShadowBuffer(rows) => format!("shadow-buffer {rows} x {}", 2 * rows),
            _ => self.tester().into(),
        }
    }

    /// The name in the registry.
    pub fn tester(self) -> &'static str {
        match self {
            Contender::BruteForce => "brute-force",
            Contender::ShadowBuffer(_) => "shadow-buffer",
            Contender::LightBuffer => "light-buffer",
            #[cfg(feature = "embree")]
            Contender::Embree => "embree-fast",
        }
    }

    /// Rows, if it has some.
    pub fn rows(self) -> Option<u32> {
        match self {
            Contender::ShadowBuffer(rows) => Some(rows),
            _ => None,
        }
    }

    /// Builds it for one light.
    pub(super) fn build<'a>(self, usual: &BuildInput<'a>) -> Result<Box<dyn ShadowTester + 'a>> {
        let shadow_buffer = self.rows().map_or(usual.shadow_buffer, buffer_of_rows);
        (find(self.tester())?.build)(&BuildInput { shadow_buffer, ..*usual })
    }
}
