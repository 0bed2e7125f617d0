#!/usr/bin/env bash
# `make farm`: the job files, run for real. 64 frames by a Slurm array of 8 and by GNU parallel, a shard killed midway and
# resumed in both, and a picture in strips with its merge job; everything must be byte by byte what a single process writes.
# With a program as the argument, that is what is tried.
set -euo pipefail

cd "$(dirname "$0")/../.."
repository=$PWD
command -v parallel >/dev/null || { echo "farm: GNU parallel is missing: install Debian's parallel" >&2; exit 2; }
LIGHTBUFFER=$(realpath "${1:-target/release/lightbuffer}")
export LIGHTBUFFER
farm=scripts/farm
work=$(mktemp -d)
scene=$(realpath scenes/turntable.toml)
frames=1-64
options=(--size 160x90 --no-verdict -q)
export PARALLEL_HOME=$work/parallel
mkdir -p "$work"/{cluster,single,slurm,parallel,tiles}

began=$(date +%s)
say() {
    echo "farm: $1 ($(($(date +%s) - began)) s)"
}

fail() {
    echo "farm: $1" >&2
    tail -n 5 "$work"/*/*.log >&2 || true
    exit 1
}

end() {
    SLURM_CONF=$work/cluster/slurm.conf scancel --quiet --user=root 2>/dev/null || true
    "$farm/one_node_slurm.sh" stop "$work/cluster" || true
    rm -rf "$work"
}
trap end EXIT

# Whether all pictures of a folder are those of the single process.
expect_same() {
    local picture
    for picture in "$work"/single/turn.*.exr "$work"/single/turn.*.png; do
        cmp "$picture" "$work/$1/$(basename "$picture")" || fail "$1 differs from the single process"
    done
}

# How many pictures a manifest lists.
finished() {
    grep -c '"right"' "$1" 2>/dev/null || true
}

# Waits until the jobs of these numbers have left the queue, and fails unless they ended as is said.
wait_for() {
    local states
    for _ in $(seq 900); do
        states=$(squeue --noheader --states=all --array --format=%T --jobs="$2" | sort -u)
        case $states in
        *PENDING* | *RUNNING* | *COMPLETING* | *CONFIGURING*) sleep 0.1 ;;
        *) break ;;
        esac
    done
    [ "$states" = "$1" ] || fail "jobs $2 are $(echo $states), expected $1"
}

"$LIGHTBUFFER" render "$scene" -o "$work/single/turn.####.exr" --frames "$frames" "${options[@]}" --json "$work/single/turn.json"
"$LIGHTBUFFER" render "$scene" -o "$work/single/still.exr" "${options[@]}"
say "64 frames and a still by a single process"

"$farm/one_node_slurm.sh" start "$work/cluster"
export SLURM_CONF=$work/cluster/slurm.conf
say "a Slurm cluster of one node: $(sinfo --version)"

# Submits tasks of the array of 8, and prints the job's number.
submit() {
    SHARDS=8 sbatch --parsable --chdir="$work/slurm" --array="$1" "$farm/lightbuffer-frames.sbatch" \
        "$scene" "$work/slurm/turn.####.exr" "$frames" "${options[@]}"
}

# Waits until a shard has finished a picture.
wait_for_a_picture() {
    until [ "$(finished "$work/slurm/turn.shard-$1-of-8.manifest.json")" -ge 1 ] 2>/dev/null; do sleep 0.005; done
}

array=$(submit 1-8)
# One task is killed when it has finished a picture and not all of them, and later run again. Another one is requeued then, as
# when a node is wanted for something else: Slurm ends it, and starts it again by itself.
wait_for_a_picture 1
scancel --full --signal=KILL "${array}_1"
wait_for_a_picture 5
scontrol requeue "${array}_5"
wait_for CANCELLED "${array}_1"
kept=$(finished "$work/slurm/turn.shard-1-of-8.manifest.json")
requeued=$(finished "$work/slurm/turn.shard-5-of-8.manifest.json")
[ "$kept" -lt 8 ] && [ "$requeued" -lt 8 ] || fail "no shard was stopped midway: $kept and $requeued of 8 pictures"
# Frames 1 and 33 are the first of those shards.
first=("$work/slurm/turn.0001.exr" "$work/slurm/turn.0033.exr")
before=$(stat --format='%n %i %y' "${first[@]}")
again=$(submit 1)
wait_for COMPLETED "$again"
wait_for COMPLETED "${array}_2,${array}_3,${array}_4,${array}_5,${array}_6,${array}_7,${array}_8"
[ "$before" = "$(stat --format='%n %i %y' "${first[@]}")" ] || fail "a finished picture was drawn again"
expect_same slurm
"$LIGHTBUFFER" merge -q --json "$work/slurm/turn.json" "$work"/slurm/turn.*shard-*-of-8.json
say "the same by a Slurm array of 8; shards were killed after $kept and requeued after $requeued of 8 pictures, and went on"

# A program that says which process draws which shard, and becomes the program.
cat >"$work/parallel/program" <<'PROGRAM'
#!/bin/bash
for argument; do
    case $argument in */8) echo $$ >"$(dirname "$0")/shard-${argument%/8}.pid" ;; esac
done
exec "$PROGRAM" "$@"
PROGRAM
chmod +x "$work/parallel/program"
PROGRAM=$LIGHTBUFFER LIGHTBUFFER=$work/parallel/program \
    "$farm/frames_parallel.sh" 8 "$scene" "$work/parallel/turn.####.exr" "$frames" "${options[@]}" &
parallel=$!
manifest=$work/parallel/turn.shard-1-of-8.manifest.json
until [ "$(finished "$manifest")" -ge 1 ] 2>/dev/null; do sleep 0.005; done
kill -KILL "$(cat "$work/parallel/shard-1.pid")" || fail "shard 1 was over before it could be killed"
kept=$(finished "$manifest")
wait "$parallel" || fail "GNU parallel failed"
expect_same parallel
grep -q '"frame": 64' "$work/slurm/turn.json" || fail "the merged document has no frame 64"
say "the same by GNU parallel; shard 1 was killed after $kept of 8 pictures and tried again"

jobs=$(cd "$work/tiles" && "$repository/$farm/submit_tiles.sh" 4 "$scene" "$work/tiles/still.exr" "${options[@]}")
wait_for COMPLETED "${jobs% *},${jobs#* }"
for picture in still.exr still.png; do
    cmp "$work/single/$picture" "$work/tiles/$picture" || fail "the merged $picture differs from the single process"
done
say "a still in 4 strips, merged by the job that depends on them: the same bytes"
