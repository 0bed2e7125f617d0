//! What Slurm has given a job, by the variables that it sets. Where its control groups are off, nothing else says so.

/// Threads for a task, if the job says how many.
pub fn threads() -> Option<usize> {
    threads_of(|name| std::env::var(name).ok())
}

/// Memory for the job on this machine, in bytes.
pub fn memory() -> Option<u64> {
    memory_of(|name| std::env::var(name).ok())
}

fn threads_of(variable: impl Fn(&str) -> Option<String>) -> Option<usize> {
    number(&variable("SLURM_CPUS_PER_TASK")?).map(|count| count as usize)
}

/// `SLURM_MEM_PER_NODE`, or `SLURM_MEM_PER_CPU` times the processors of a task, else of the job here. Both are in MiB.
fn memory_of(variable: impl Fn(&str) -> Option<String>) -> Option<u64> {
    let of = |name| number(&variable(name)?);
    let mebibytes = match of("SLURM_MEM_PER_NODE") {
        Some(node) => node,
        None => {
            let processors = of("SLURM_CPUS_PER_TASK").or_else(|| of("SLURM_CPUS_ON_NODE")).unwrap_or(1);
            of("SLURM_MEM_PER_CPU")?.checked_mul(processors)?
        }
    };
    mebibytes.checked_mul(1 << 20)
}

/// 0 means all there is, which is no limit.
fn number(text: &str) -> Option<u64> {
    text.trim().parse().ok().filter(|&number| number > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(set: &[(&str, &str)]) -> (Option<usize>, Option<u64>) {
        let variable = |name: &str| set.iter().find(|pair| pair.0 == name).map(|pair| pair.1.to_owned());
        (threads_of(variable), memory_of(variable))
    }

    #[test]
    fn variables_are_counts_and_mebibytes() {
        assert_eq!(of(&[]), (None, None));
        assert_eq!(of(&[("SLURM_CPUS_PER_TASK", "4")]), (Some(4), None));
        assert_eq!(of(&[("SLURM_MEM_PER_NODE", "2048")]), (None, Some(2 << 30)));
        let each = ("SLURM_MEM_PER_CPU", "512");
        assert_eq!(of(&[each]).1, Some(512 << 20));
        assert_eq!(of(&[each, ("SLURM_CPUS_ON_NODE", "8")]).1, Some(4 << 30));
        assert_eq!(of(&[each, ("SLURM_CPUS_ON_NODE", "8"), ("SLURM_CPUS_PER_TASK", "2")]).1, Some(1 << 30));
    }

    #[test]
    fn what_is_no_count_is_not_set() {
        for bad in ["", "0", "-1", "4G", "99999999999999999999"] {
            assert_eq!(
                of(&[("SLURM_CPUS_PER_TASK", bad), ("SLURM_MEM_PER_NODE", bad)]),
                (None, None),
                "{bad}"
            );
        }
        assert_eq!(of(&[("SLURM_MEM_PER_NODE", "18446744073709551615")]).1, None);
    }
}
