//! Names and values beside each other: machines, versions, settings.

use crate::film::grouped;
use crate::measure::bench::Machine;
use askama::Template;

/// A list of them.
#[derive(Debug, Clone, Default, Template)]
#[template(path = "fields.html")]
pub(super) struct Fields {
    entries: Vec<(&'static str, String)>,
}

impl Fields {
    /// One more, unless there is nothing to say.
    pub(super) fn add(&mut self, name: &'static str, value: impl Into<String>) -> &mut Fields {
        let value = value.into();
        if !value.is_empty() {
            self.entries.push((name, value));
        }
        self
    }

    /// All that is known of a machine, but for its Embree.
    pub(super) fn machine(&mut self, machine: &Machine) -> &mut Fields {
        self.add("processor", &machine.cpu).add("cores", grouped(machine.cores as u64));
        self.add("instruction sets", machine.instruction_sets.join(" "));
        if let Some(memory) = machine.memory {
            self.add("memory", format!("{:.1} GiB", memory as f64 / f64::from(1 << 30)));
        }
        self.add("system", format!("{}, kernel {}", machine.os, machine.kernel));
        self
    }
}
