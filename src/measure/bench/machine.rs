//! What it was measured on.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A machine, as far as times depend on it and it says.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// Processors that the program may use.
    pub cores: usize,
    /// Instruction sets beyond those that every such processor has.
    pub instruction_sets: Vec<Cow<'static, str>>,
    /// Bytes of memory; `null` if it does not say.
    pub memory: Option<u64>,
    /// Name and version of the system.
    pub os: String,
    /// Version of its kernel.
    pub kernel: String,
    /// Version of this program.
    pub version: Cow<'static, str>,
    /// Version of Embree; `null` without it.
    pub embree: Option<String>,
    /// Widest instruction set that Embree traverses with; `null` without it.
    pub embree_isa: Option<String>,
}

impl Machine {
    /// This one.
    pub fn here() -> Machine {
        let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
        let unknown = || "unknown".to_string();
        let memory = value_of(&read("/proc/meminfo"), "MemTotal", ':')
            .and_then(|kibibytes| kibibytes.trim_end_matches(" kB").parse::<u64>().ok())
            .map(|kibibytes| kibibytes * 1024);
        let kernel = read("/proc/sys/kernel/osrelease").trim().to_string();
        let [embree, embree_isa] = embree();
        Machine {
            cpu: value_of(&read("/proc/cpuinfo"), "model name", ':').unwrap_or_else(unknown),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            instruction_sets: instruction_sets(),
            memory,
            os: value_of(&read("/etc/os-release"), "PRETTY_NAME", '=')
                .unwrap_or_else(|| std::env::consts::OS.into()),
            kernel: if kernel.is_empty() { unknown() } else { kernel },
            version: env!("CARGO_PKG_VERSION").into(),
            embree,
            embree_isa,
        }
    }
}

/// What stands behind the first line's name, without quotes.
fn value_of(text: &str, name: &str, separator: char) -> Option<String> {
    let line = text.lines().find(|line| line.starts_with(name))?;
    let (_, value) = line.split_once(separator)?;
    Some(value.trim().trim_matches('"').to_string())
}

#[cfg(target_arch = "x86_64")]
fn instruction_sets() -> Vec<Cow<'static, str>> {
    let all = [
        ("AVX", is_x86_feature_detected!("avx")),
        ("AVX2", is_x86_feature_detected!("avx2")),
        ("FMA", is_x86_feature_detected!("fma")),
        ("AVX-512F", is_x86_feature_detected!("avx512f")),
        ("AVX-512BW", is_x86_feature_detected!("avx512bw")),
        ("AVX-512DQ", is_x86_feature_detected!("avx512dq")),
        ("AVX-512VL", is_x86_feature_detected!("avx512vl")),
    ];
    all.into_iter().filter(|(_, there)| *there).map(|(name, _)| name.into()).collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn instruction_sets() -> Vec<Cow<'static, str>> {
    Vec::new()
}

#[cfg(feature = "embree")]
fn embree() -> [Option<String>; 2] {
    let device = crate::embree::Device::new(1).ok();
    [device.as_ref().map(|device| device.version()), device.map(|device| device.instruction_set())]
}

#[cfg(not(feature = "embree"))]
fn embree() -> [Option<String>; 2] {
    [None, None]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_behind_their_names() {
        let text = "NAME=\"Debian\"\nPRETTY_NAME=\"Debian GNU/Linux 12\"\n";
        assert_eq!(value_of(text, "PRETTY_NAME", '=').as_deref(), Some("Debian GNU/Linux 12"));
        assert_eq!(value_of("model name\t: A CPU\n", "model name", ':').as_deref(), Some("A CPU"));
        assert_eq!(value_of(text, "VERSION", '='), None);
    }

    #[test]
    fn a_machine_has_cores() {
        assert!(Machine::here().cores >= 1);
    }
}
