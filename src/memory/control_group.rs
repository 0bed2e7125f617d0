//! What Linux' control groups allow a process.

use std::path::{Path, PathBuf};

/// The least memory that the process's own control group and those around it allow, of version 1 or 2, in bytes.
pub fn limit() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    least(&groups, |file| std::fs::read_to_string(file).ok())
}

/// The same by the text of `/proc/self/cgroup` and whoever reads files. Groups whose folders are not there, as in a container
/// that sees only a part of them, are passed over.
fn least(groups: &str, read: impl Fn(&Path) -> Option<String>) -> Option<u64> {
    let files = groups.lines().filter_map(files).flatten();
    files.filter_map(|file| bytes(&read(&file)?)).min()
}

/// The files with the limits of a line's group, from its own up to that at the root.
fn files(line: &str) -> Option<Vec<PathBuf>> {
    let mut fields = line.splitn(3, ':');
    let (_, controllers, path) = (fields.next()?, fields.next()?, fields.next()?);
    let (root, name) = match controllers {
        "" => ("/sys/fs/cgroup", "memory.max"),
        _ if controllers.split(',').any(|controller| controller == "memory") => {
            ("/sys/fs/cgroup/memory", "memory.limit_in_bytes")
        }
        _ => return None,
    };
    let path = Path::new(path.trim_start_matches('/'));
    // A path that leads out of the part that is seen would lead to other files than groups'.
    let is_plain = path.components().all(|part| matches!(part, std::path::Component::Normal(_)));
    let groups = path.ancestors().filter(|group| is_plain || group.as_os_str().is_empty());
    Some(groups.map(|group| Path::new(root).join(group).join(name)).collect())
}

/// A limit of version 2 may be `max`; one of version 1 that nobody has set is a number near 2^63.
fn bytes(text: &str) -> Option<u64> {
    text.trim().parse().ok().filter(|&bytes: &u64| bytes < 1 << 62)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn least_of(groups: &str, limits: &[(&str, &str)]) -> Option<u64> {
        let limits: BTreeMap<_, _> = limits.iter().copied().collect();
        least(groups, |file| limits.get(file.to_str()?).map(|text| text.to_string()))
    }

    #[test]
    fn the_least_on_the_way_to_the_root_counts() {
        let groups = "0::/system.slice/slurmstepd.scope/job_7/step_0\n";
        let own = "/sys/fs/cgroup/system.slice/slurmstepd.scope/job_7/step_0/memory.max";
        let job = "/sys/fs/cgroup/system.slice/slurmstepd.scope/job_7/memory.max";
        let root = "/sys/fs/cgroup/memory.max";
        assert_eq!(least_of(groups, &[(own, "max\n"), (job, "1048576\n")]), Some(1 << 20));
        assert_eq!(least_of(groups, &[(own, "4096\n"), (job, "1048576\n")]), Some(4096));
        assert_eq!(least_of(groups, &[(root, "8192\n")]), Some(8192));
        assert_eq!(least_of(groups, &[(own, "max\n"), (root, "max\n")]), None);
        assert_eq!(least_of(groups, &[]), None);
        assert_eq!(least_of("0::/\n", &[(root, "512\n")]), Some(512));
    }

    #[test]
    fn version_1_has_a_folder_for_memory_and_no_word_for_no_limit() {
        let groups = "12:cpu,cpuacct:/a\n7:memory:/slurm/uid_0/job_7\n1:name=systemd:/b\n0::/\n";
        let job = "/sys/fs/cgroup/memory/slurm/uid_0/job_7/memory.limit_in_bytes";
        let root = "/sys/fs/cgroup/memory/memory.limit_in_bytes";
        let unlimited = (root, "9223372036854771712\n");
        assert_eq!(least_of(groups, &[(job, "2147483648\n"), unlimited]), Some(1 << 31));
        assert_eq!(least_of(groups, &[unlimited]), None);
        assert_eq!(least_of(groups, &[("/sys/fs/cgroup/memory/a/memory.limit_in_bytes", "1\n")]), None);
    }

    #[test]
    fn what_is_no_group_is_passed_over() {
        for groups in ["", "x", "0:", "0::/../../etc\n", "::\n"] {
            assert_eq!(least_of(groups, &[("/sys/fs/cgroup/../../etc/memory.max", "1")]), None, "{groups:?}");
        }
        assert_eq!(least_of("0::/../x\n", &[("/sys/fs/cgroup/memory.max", "64\n")]), Some(64));
        assert_eq!(least_of("0::/\n", &[("/sys/fs/cgroup/memory.max", "-1\n")]), None);
    }
}
