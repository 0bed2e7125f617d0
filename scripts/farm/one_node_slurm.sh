#!/usr/bin/env bash
# A Slurm cluster of one node, this machine, that lives in a folder: for trying job files where there is no cluster. As root,
# with Debian's packages slurmctld, slurmd, slurm-client and munge. No accounting, no control groups, ports of its own.
#
#   one_node_slurm.sh start DIR    writes keys and settings into DIR and starts the daemons
#   one_node_slurm.sh stop DIR     ends the daemons that it started, and no others
#
# While it runs, SLURM_CONF=DIR/slurm.conf is all that sbatch, squeue and scancel need.
set -euo pipefail

usage() {
    echo "one_node_slurm.sh: expected start DIR or stop DIR" >&2
    exit 2
}
[ $# -eq 2 ] || usage
command=$1
mkdir -p "$2"
dir=$(cd "$2" && pwd)

# Ends a daemon by the process id that it wrote itself.
end() {
    local file=$dir/$1.pid
    if [ -s "$file" ]; then
        local pid
        pid=$(cat "$file")
        kill "$pid" 2>/dev/null || true
        for _ in $(seq 100); do
            kill -0 "$pid" 2>/dev/null || break
            sleep 0.1
        done
        kill -KILL "$pid" 2>/dev/null || true
        rm -f "$file"
    fi
}

stop() {
    end slurmd
    end slurmctld
    end munged
}

fail() {
    echo "one_node_slurm.sh: $1; the logs end with:" >&2
    tail -n 5 "$dir"/*.log >&2 || true
    stop
    exit 1
}

start() {
    for program in munged slurmctld slurmd sbatch sinfo; do
        command -v "$program" >/dev/null || {
            echo "one_node_slurm.sh: $program is missing: install Debian's slurmctld, slurmd, slurm-client and munge" >&2
            exit 2
        }
    done
    local processors host port
    processors=$(nproc)
    host=$(hostname -s)
    port=${SLURM_TEST_PORT:-36817}
    mkdir -p "$dir/state" "$dir/spool"
    # munged wants to be the only one who can write where its socket is.
    chmod 755 "$dir"
    head -c 1024 /dev/urandom >"$dir/munge.key"
    chmod 400 "$dir/munge.key"
    # A job that is requeued waits until its credential has expired: ten seconds, and not two minutes.
    cat >"$dir/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket,cred_expire=10
CredType=cred/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ProctrackType=proctrack/pgid
TaskPlugin=task/none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_min_interval=100000,bf_interval=1
MinJobAge=600
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=$processors State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    munged --force --key-file="$dir/munge.key" --socket="$dir/munge.socket" --pid-file="$dir/munged.pid" \
        --log-file="$dir/munged.log" --seed-file="$dir/munged.seed" || fail "munged does not start"
    export SLURM_CONF=$dir/slurm.conf
    slurmctld -f "$dir/slurm.conf" || fail "slurmctld does not start"
    slurmd -f "$dir/slurm.conf" || fail "slurmd does not start"
    for _ in $(seq 150); do
        if [ "$(sinfo --noheader --format=%t 2>/dev/null)" = idle ]; then
            return
        fi
        sleep 0.2
    done
    fail "the node does not become idle ($(sinfo --noheader --format='%t %E' 2>&1 || true))"
}

case $command in
start) start ;;
stop) stop ;;
*) usage ;;
esac
