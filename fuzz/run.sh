#!/usr/bin/env bash
# Fuzzes every loader for a number of executions, one target after the other, and prints a table; ends with 1 if there
# are findings.
#
#   RUNS=1200000 SEED=1 fuzz/run.sh [TARGET...]
#
# The coverage that guides libFuzzer comes from LLVM itself, so stable Rust will do.
set -euo pipefail
cd "$(dirname "$0")"

runs=${RUNS:-1200000}
seed=${SEED:-1}
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
    targets=(obj ply nff gltf glb toml picture shadow-buffer exr)
fi
if [[ ! $runs =~ ^[1-9][0-9]*$ ]]; then
    echo "fuzz: RUNS is \`$runs\`, expected how many executions each target gets" >&2
    exit 2
fi
if ! command -v cargo >/dev/null; then
    echo "fuzz: Rust is missing; see the set-up in README.md" >&2
    exit 2
fi
if ! command -v c++ >/dev/null; then
    echo "fuzz: libFuzzer is written in C++; as root, run: apt-get install -y g++" >&2
    exit 2
fi

host=$(rustc -vV | sed -n 's/^host: //p')
flags="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4"
flags+=" -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table"
# With one unit of code generation the linker drops no counters.
flags+=" -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1"
arguments=()
for target in "${targets[@]}"; do
    if [ ! -d "corpus/$target" ]; then
        echo "fuzz: there is no target \`$target\`; expected one of: $(ls corpus | tr '\n' ' ')" >&2
        exit 2
    fi
    arguments+=(--bin "$target")
done
# A target is named, because flags without one would be those of build scripts too.
RUSTFLAGS="$flags" cargo build --quiet --release --locked --target "$host" "${arguments[@]}"

work=$PWD/target/fuzzing
mkdir -p "$work/logs"
row='%-14s %12s %8s %9s %8s %9s %11s %11s\n'
table=$(printf "$row" target executions seconds "per sec" features findings "slowest ms" "memory %")
total=0
found=0
for target in "${targets[@]}"; do
    log=$work/logs/$target.log
    figures=$work/logs/$target.figures
    mkdir -p "$work/corpus/$target" "$work/findings/$target"
    rm -f "$figures"
    echo "fuzz: $target, $runs executions; the log is $log"
    start=$(date +%s)
    code=0
    # A second of processor time is checked for each input by the target itself; the timeout ends what never returns.
    FUZZ_FIGURES=$figures "target/$host/release/$target" -runs="$runs" -seed="$seed" -max_len=8192 -timeout=20 \
        -dict="dictionaries/$target.dict" -artifact_prefix="$work/findings/$target/" -print_final_stats=1 \
        "$work/corpus/$target" "corpus/$target" >"$log" 2>&1 || code=$?
    seconds=$(($(date +%s) - start))
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1)
    features=$(grep -ao ' ft: [0-9]*' "$log" | tail -n 1 | tr -dc 0-9 || true)
    slowest='-'
    memory='-'
    if [ -s "$figures" ]; then
        read -r slowest memory <"$figures"
        slowest=$(awk -v s="$slowest" 'BEGIN { printf "%.1f", s * 1000 }')
        memory=$(awk -v m="$memory" 'BEGIN { printf "%.1f", m * 100 }')
    fi
    findings=0
    if [ $code -ne 0 ]; then
        findings=1
        found=$((found + 1))
        echo "fuzz: $target ended with $code after ${executions:-some} executions; see the end of $log" >&2
    fi
    total=$((total + ${executions:-0}))
    rate=$((${executions:-0} / (seconds > 0 ? seconds : 1)))
    table+=$'\n'$(printf "$row" "$target" "${executions:--}" "$seconds" "$rate" "${features:--}" "$findings" \
        "$slowest" "$memory")
done
echo
echo "$table"
echo
echo "$total executions, $found findings (panics, aborts, more than 1 s of processor time, or more memory than 64 times the"
echo "input and 64 MiB: 100 % in the table). Inputs that are findings are in $work/findings/."
[ $found -eq 0 ]
