#!/usr/bin/env bash
# Submits a picture to Slurm as strips, and the job that puts them together once all are drawn. Prints the numbers of both.
#
#   submit_tiles.sh SHARDS SCENE OUT.exr [options of render]
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
shards=$1 scene=$2 out=$3
shift 3
array=$(sbatch --parsable --array="1-$shards" "$here/lightbuffer-tiles.sbatch" "$scene" "$out" "$@")
merge=$(sbatch --parsable --dependency="afterok:$array" --kill-on-invalid-dep=yes \
    "$here/lightbuffer-merge.sbatch" "$out" "$shards")
echo "$array $merge"
