#!/usr/bin/env bash
# Frames of an animation by GNU parallel: so many shards, one thread each, as many at a time as there are processors. What
# fails is tried again, and goes on where it was. For several machines add --sshloginfile to PARALLEL, over a shared folder.
#
#   frames_parallel.sh SHARDS SCENE OUT.####.exr FRAMES [options of render]
set -euo pipefail

shards=$1 scene=$2 out=$3 frames=$4
shift 4
# Without the place for the number of a frame.
stem=${out%.exr} stem=${stem//\#/} stem=${stem%.}
parallel --retries 3 --joblog "$stem.jobs.log" --quote \
    "${LIGHTBUFFER:-lightbuffer}" render "$scene" -o "$out" --frames "$frames" --shard "{}/$shards" --resume -t 1 \
    --json "$stem.shard-{}-of-$shards.json" "$@" ::: $(seq "$shards")
